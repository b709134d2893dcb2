"""Tables on the terminal: within its width, with every number, unit and error bar whole."""

import re

import pytest

from bem.cli._terminal import print_numbers, print_points, table

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
