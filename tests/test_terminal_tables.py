"""Tables on the terminal: within its width, with every number, unit and error bar whole."""

import re

import pytest

from bem.cli._terminal import (
    Terminal,
    figures_within,
    print_numbers,
    print_points,
    print_text,
    scatter_of_places,
    show_warnings,
    table,
    wrapped,
)
from bem.plots.report import with_error
from bem.plots.tables import figure_tables
from bem.runs import run_scene
from bem.scenes import get_kind, kind_names

WIDTHS = [60, 80, 110]
FIGURES = {f"some_long_name_of_figure_{i}_m_s": [10.0**-j * (i + 1.2345) for j in range(9)] for i in range(14)}
ERRORS = {f"{name}_error": [0.01 * value for value in values] for name, values in FIGURES.items()}
RUN = {"scene": "many", "kind": "friction", "status": "converged", "wall_time_s": 1.0}


@pytest.fixture
def shown(monkeypatch, capsys):
    """What a terminal of a width shows, without its colours."""

    def at(width, show):
        monkeypatch.setenv("COLUMNS", str(width))
        monkeypatch.setenv("TERM", "xterm")
        capsys.readouterr()
        with monkeypatch.context() as patched:
            patched.setattr("sys.stdout.isatty", lambda: True)
            show()
        return re.sub(r"\x1b\[[0-9;]*m", "", capsys.readouterr().out)

    return at


def flat(text):
    """Without line breaks: what was wrapped is whole again."""
    return re.sub(r"\s+", " ", text)


@pytest.mark.parametrize("width", WIDTHS)
@pytest.mark.parametrize("rows", [2, 9])
def test_numbers_units_and_errors_are_whole(shown, width, rows):
    figures = {name: values[:rows] for name, values in (FIGURES | ERRORS).items()}
    summary = RUN | {"speed_m_s": [0.1 * (i + 1) for i in range(rows)]} | figures
    text = shown(width, lambda: print_numbers(summary, ["speed_m_s", *FIGURES]))
    assert max(map(len, text.splitlines())) <= width
    assert "…" not in text
    assert "..." not in text
    for values in FIGURES.values():
        for value in values[:rows]:
            assert f"{value:.4g} ± {0.01 * value:.2g}" in text
    assert flat(text).count("(m/s)") >= len(FIGURES)


@pytest.mark.parametrize("width", WIDTHS)
def test_few_cases_become_columns_where_a_table_is_too_wide(shown, width):
    figures = {name: values[:2] for name, values in FIGURES.items()}
    text = shown(width, lambda: print_numbers(RUN | {"speed_m_s": [0.1, 0.2]} | figures, ["speed_m_s", *FIGURES]))
    line = next(line for line in text.splitlines() if line.startswith("some long name of figure 13"))
    assert line.split()[-2:] == ["14.23", "1.423"]


@pytest.mark.parametrize("width", WIDTHS)
def test_every_part_of_a_divided_table_says_which_row_it_is(shown, width):
    summary = RUN | {"speed_m_s": [0.1, *range(2, 10)]} | FIGURES
    lines = shown(width, lambda: print_numbers(summary, ["speed_m_s", *FIGURES])).splitlines()
    tables = sum(line.startswith("───") for line in lines) - 1  # less the one of single figures
    assert tables > 1
    assert sum(line.startswith("0.1 ") for line in lines) == tables


@pytest.mark.parametrize("width", [20, *WIDTHS])
def test_sentences_are_wrapped_between_words_and_never_cut(shown, width):
    sentence = "the film is thinner than the roughness is high at nine of ten positions"
    rows = [("outside the model", sentence), ("minimum film", "1.234e-05 (1.1e-05 to 1.3e-05) m"), ("[b]x[/b]", "[m]")]
    text = shown(width, lambda: table(("figure", "value"), rows, title="a title of some length"))
    assert max(map(len, text.splitlines())) <= width
    words = flat(text).split()
    assert all(word in words for word in sentence.split())
    if width > 20:
        assert "1.234e-05 (1.1e-05 to 1.3e-05) m" in text
    assert "[m]" in text  # a unit, no markup


@pytest.mark.parametrize("width", WIDTHS)
def test_wide_tables_of_an_element_keep_number_and_place_in_every_part(shown, width):
    head = ("", "where", *(f"quantity {i}" for i in range(12)), "nothing")
    rows = [(str(i), f"position {i}", *(f"{i}.5{j} mm" for j in range(12)), "") for i in range(1, 30)]
    text = shown(width, lambda: table(head, rows, right=range(2, 15), leading=2))
    assert max(map(len, text.splitlines())) <= width
    assert "nothing" not in text  # a column without any text
    for i in range(1, 30):
        for j in range(12):
            assert any(re.match(rf"{i} +position {i} .*\b{i}\.5{j} mm", line) for line in text.splitlines())


def test_columns_without_any_text_are_left_out_when_piped(capsys):
    table(("a", "empty", "b"), [("1", "", "2"), ("3", "", "4")])
    assert capsys.readouterr().out == "a  b\n1  2\n3  4\n"


@pytest.mark.parametrize(("scatter", "said"), [([None, 1e-12], 0), ([1e-12, 0.0016], 1)])
def test_the_scatter_by_the_oil_is_explained_where_it_is_shown(scatter, said, capsys):
    """ "± 0.0016 (oil)" stood at two of four speeds, and no line said of what."""
    lists = {"speed_m_s": [0.03, 0.3], "friction": [0.11, 0.045], "friction_error": [1e-4, 1e-4]}
    summary = lists | {"friction_oil_scatter": scatter, "scene": "a", "kind": "friction", "status": "converged"}
    print_numbers(summary | {"wall_time_s": 1.0, "notes": []}, ["speed_m_s", "friction"])
    shown = capsys.readouterr().out
    assert shown.count("(oil) is the scatter among oils of one base") == said
    assert shown.count("± 0.0016 (oil)") == said


def test_a_sweep_prints_its_figures(capsys):
    points = {
        "over": {"contact.load": "N"},
        "contact.load": [1.0, 2.0],
        "friction": [0.1, 0.2],
        "friction_error": [0.01, 0.02],
    }
    print_points(points)
    assert capsys.readouterr().out.splitlines()[1].endswith("  0.1 ± 0.01")
    print_points({key: value if key == "over" else value[:1] for key, value in points.items()})
    assert "0.1 ± 0.01" in capsys.readouterr().out


def whole_units(head):
    """The unit at the end of a head, such as "(W/(m K))"; not "(if the film carried the whole load)", "(relative)"."""
    return re.findall(r"\((?!under|if|relative)(?:[^()]|\([^()]*\))*\)$", head)


@pytest.mark.parametrize("width", [60, 80])
@pytest.mark.parametrize("kind", kind_names())
def test_records_of_all_kinds_are_shown_whole(shown, kind, width):
    """Several cases: numbers with their errors stand on one line, units of heads too."""
    names = get_kind(kind).headline
    figures = {name: [10.0**-j * (i + 0.12345) for j in range(3)] for i, name in enumerate(names, 1)}
    errors = {f"{name}_error": [0.0321 * value for value in values] for name, values in figures.items()}
    summary = RUN | {"kind": kind} | figures | errors
    text = shown(width, lambda: print_numbers(summary, names))
    assert max(map(len, text.splitlines())) <= width
    tables = figure_tables(summary, names, columns=1000)
    assert sum(len(item.rows) for item in tables) >= 3
    for item in tables:
        for cell in (cell for row in item.rows for cell in row):
            assert re.search(rf"(?<!\S){re.escape(cell)}(?!\S)", text), cell
        for unit in (unit for head in item.head for unit in whole_units(head)):
            assert unit in text


@pytest.mark.parametrize("width", [60, 80])
def test_the_record_of_a_run_is_shown_whole(shown, width, tmp_path):
    done = run_scene("hertz-sphere", tmp_path / "run", settings=["grid.shape=16"], figures=False)
    names = get_kind("contact").headline
    text = shown(width, lambda: print_numbers(done.summary, names))
    assert max(map(len, text.splitlines())) <= width
    for name in (name for name in names if done.summary.get(name) is not None):
        assert with_error(name, done.summary)[1] in text


SENTENCE = "steel (E 207 GPa, hardness 7 GPa, heat 46.6 W/(m K)), alpha 20.6 1/GPa at 40 degC, friction 0.071 ± 0.0032"


@pytest.mark.parametrize("width", range(24, 81, 7))
def test_a_line_ends_neither_in_a_number_nor_before_its_unit_or_error(width):
    lines = wrapped(SENTENCE, width, "  ").split("\n")
    assert max(map(len, lines)) <= width
    assert " ".join(line.strip() for line in lines) == SENTENCE
    for part in ("207 GPa", "7 GPa", "46.6 W/(m K)", "20.6 1/GPa", "40 degC", "0.071 ± 0.0032"):
        assert any(part in line for line in lines), part


@pytest.mark.parametrize("width", [60, 80])
def test_cells_and_heads_keep_numbers_with_units(shown, width):
    rows = [("lower", SENTENCE, "1"), ("contact_area_fraction_error_residual", SENTENCE, "2")]
    text = shown(width, lambda: table(("body", "what it is", "thermal conductivity (W/(m K))"), rows))
    assert max(map(len, text.splitlines())) <= width
    for part in ("7 GPa", "46.6 W/(m K)", "0.071 ± 0.0032"):
        assert text.count(part) >= 2
    assert "(W/(m K))" in text
    assert re.search(r"contact_area_fraction_(error_)? ", text)  # a long name ends its line behind a mark


@pytest.mark.parametrize("width", [60, 80])
def test_notes_and_sentences_are_wrapped_on_a_terminal(shown, width, capsys, monkeypatch):
    note = f"The film is thin. {SENTENCE}. Use more points."
    text = shown(width, lambda: show_warnings([note, note + " Again."]))
    assert max(map(len, text.splitlines())) <= width
    assert sum(line.startswith("  - ") for line in text.splitlines()) == 2
    text = shown(width, lambda: print_text(note))
    assert flat(text).strip() == note
    assert max(map(len, text.splitlines())) <= width
    monkeypatch.setattr("sys.stderr.isatty", lambda: True)
    monkeypatch.setenv("COLUMNS", str(width))
    with Terminal() as terminal:
        terminal.say(note)
    said = capsys.readouterr().err
    assert max(map(len, said.splitlines())) <= width
    assert "0.071 ± 0.0032" in said


def test_sentences_are_one_line_when_piped(capsys):
    print_text(SENTENCE + SENTENCE)
    assert capsys.readouterr().out == SENTENCE + SENTENCE + "\n"


@pytest.mark.parametrize("room", [-3, 10, 15, 40])
def test_progress_shows_whole_figures_only(room):
    text = figures_within({"friction": 0.0774123, "contact_load": 12.5}, room)
    assert text in ("", "friction 0.07741", "friction 0.07741  contact load 12.5")
    assert len(text) <= max(room, 0)
    assert ("contact load 12.5" in text) == (room == 40)


def test_a_sweep_over_places_has_mean_and_standard_deviation():
    """Six places gave six rows; the mean and the scatter that a paper gives were left to the reader."""
    figures = {
        "over": {"lower.surface.path": ""},
        "lower.surface.path": ["a.al3d", "b.al3d", "c.al3d"],
        "contact_area_fraction": [0.01, 0.02, 0.06],
        "contact_area_fraction_error": [0.001, 0.001, 0.001],
        "max_pressure_Pa": [1e9, 1e9, None],
        "load_N": [0.02, 0.02 * (1 + 1e-10), 0.02],
    }
    rows = scatter_of_places(figures)
    assert [row[0] for row in rows] == ["contact area fraction"], "a place without a value has no mean"
    assert rows[0][1:] == ("3 %", "2.646 %")
    assert scatter_of_places(figures | {"over": {"contact_load": "N"}, "contact_load": [1, 2, 3]}) == []
    assert scatter_of_places(figures | {"lower.surface.path": ["a.al3d", "a.al3d", "c.al3d"]}) == []
