"""Tables of cases compare oils: every key of the oil is a column, and a grade with its own base needs none."""

import pytest

from bem import InputError
from bem.elements.cases import load_cases, notes_of_cases
from bem.elements.element import MODELS, element_template
from bem.lubrication.oils.catalogue import find_oil
from bem.lubrication.thermal.checks import lumped_errors
from bem.notes.checks import SLOPES_LARGE
from bem.notes.lubrication import LUMPED_HEAT_LIMIT

CAM_OIL = """
[oil]
grade = "ISO VG 68"
base = "pao"
viscosity_index = 150
temperature = "60 degC"
"""


@pytest.fixture(params=MODELS)
def file(request, tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(element_template(request.param).partition("\n[oil]")[0].partition("[gas]")[0] + CAM_OIL)
    return path


def test_oils_are_compared_in_every_element(file, tmp_path):
    rows = tmp_path / "oils.csv"
    rows.write_text(
        "oil.grade, oil.base, oil.temperature [degC]\nISO VG 68, ester, 60\nPAO 10, , 70\nISO VG 46, pao, 80\n"
    )
    oils = [one.model.oil.oil for one in load_cases(file, rows)]
    assert [one.base for one in oils] == ["ester", "pao", "pao"]
    assert [one.name for one in oils] == ["ester 68", "PAO 10", "pao VG 46"]


def test_a_grade_with_its_own_base_takes_the_place_of_the_files(file, tmp_path):
    rows = tmp_path / "oils.csv"
    rows.write_text("oil.grade\nPAO 40\nISO VG 32\n")
    first, second = (one.model.oil for one in load_cases(file, rows))
    assert (first.base, first.viscosity_index, first.oil.name) == (None, None, "PAO 40")
    assert (second.base, second.viscosity_index) == ("pao", 150)
    rows.write_text("oil.grade, oil.base\nPAO 40, ester\n")
    with pytest.raises(InputError, match=r"has its own viscosity index and base; leave the cell of oil\.base empty"):
        load_cases(file, rows)
    rows.write_text("oil.grade, oil.base\nester 32, pao\n")
    with pytest.raises(InputError, match=r"has its own base ester; leave the cell of oil\.base empty"):
        load_cases(file, rows)


def test_keys_of_tables_are_columns(tmp_path):
    file, rows = tmp_path / "gears.toml", tmp_path / "rows.csv"
    file.write_text(element_template("gear-pair"))
    rows.write_text("heat_balance.conductance [W/K]\n20\n40\n")
    assert [one.model.heat_balance.conductance for one in load_cases(file, rows)] == [20, 40]
    rows.write_text("oil.bas\npao\n")
    with pytest.raises(InputError, match=r'did you mean "oil\.base"'):
        load_cases(file, rows)
    with pytest.raises(InputError) as refused:
        load_cases(file, tmp_path / "missing.csv")
    (message,) = refused.value.messages
    assert "cannot be read" in message
    assert message.endswith("a text file whose columns are keys of the element's file, or name")


def test_a_grade_with_a_digit_too_many_proposes_the_grade_without_it():
    for number, meant in ((4600, 460), (50, 46), (20, 22)):
        with pytest.raises(InputError, match=f'did you mean "ISO VG {meant}"'):
            find_oil(f"ISO VG {number}")


def test_a_note_on_films_of_several_cases_is_one_line():
    """It says at how many positions of its rows it is of; other rows are not named, another reason is another line."""

    def fast(where, loading, ratio):
        nearest, film, friction = lumped_errors(loading, ratio)
        about = {"loading": loading, "limit": 0.1, "nearest": nearest, "film": film, "friction": friction, "remedy": ""}
        return LUMPED_HEAT_LIMIT(where, reason="fast", **about)

    notes = [fast(f"at {k} of 12 positions (B to {k})", 0.1 * k, 0.1) for k in (2, 3)]
    whole = fast("", 1.4, 0.5)
    (one,) = notes_of_cases([notes[:1], notes[1:], [], [whole]])
    assert one.where == "rows 1, 2, 4, at 2 to 12 of 12 positions"
    assert one.values["loading"] == (0.2, 1.4)
    assert one.values["nearest"] == (0.1, 0.5)
    low, high = notes[0].values["film"], whole.values["film"]
    assert one.values["film"] == (min(low[0], high[0]), max(low[1], high[1]))
    (one,) = notes_of_cases([notes[:1], [whole]])
    assert one.where == "at 2 to 12 of 12 positions"
    other = fast("at 2 of 7 positions (1 to 2)", 0.2, 0.1)
    (one,) = notes_of_cases([notes[:1], [other]])
    assert one.where == "at some positions"
    (same,) = notes_of_cases([notes[:1], notes[:1]])
    assert same.where == notes[0].where
    slides = LUMPED_HEAT_LIMIT("at 1 of 12 positions", reason="slides", slide=0.5, remedy="")
    found = [note.where for note in notes_of_cases([notes[:1], [slides]])]
    assert found == ["row 1, at 2 of 12 positions (B to 2)", "row 2, at 1 of 12 positions"]


def test_wide_contacts_of_several_cases_are_one_line():
    """At other places in each row: the line names none of them."""
    places = [("contact 3", " and 2 more places"), ("contact 7", "")]
    notes = [SLOPES_LARGE(first=first, others=others, limit=0.2, reason="element") for first, others in places]
    (one,) = notes_of_cases([notes[:1], notes[1:]])
    assert "at some places:" in str(one)
    assert one.where == ""
    (same,) = notes_of_cases([notes[:1], notes[:1]])
    assert "contact 3 and 2 more places" in str(same)
