"""Terminal tables of several paths of contact: ends and pitch point of each, and its mean friction power."""

import pytest

from bem.plots.tables import FigureTable, ends_of_paths, mean_power_of_paths


def summary(points, oils):
    place = [1e-3 * (i**1.5 * 12 / (points - 1) ** 1.5 - 5.5) for i in range(points)]
    return {
        "over": {"oil.base": "1", "position_m": "m"},
        "oil.base": [oil for oil in oils for _ in place],
        "position_m": place * len(oils),
        "friction_power_W": [(1 + k) * 1e6 * abs(x) for k in range(len(oils)) for x in place],
    }


def table(data):
    rows = tuple(zip(data["oil.base"], data["position_m"], strict=True))
    return FigureTable("", ("oil.base", "position"), rows, 2)


def test_long_tables_of_paths_show_ends_and_pitch_point():
    data = summary(41, ["pao", "mineral"])
    short = ends_of_paths(data, table(data))
    assert [row[0] for row in short.rows] == ["pao"] * 3 + ["mineral"] * 3
    first, middle, last = (row[1] for row in short.rows[:3])
    assert (first, last) == (min(data["position_m"]), max(data["position_m"]))
    assert abs(middle) == min(map(abs, data["position_m"]))
    assert "6 of 82 rows" in short.title


def test_short_tables_and_single_paths_are_whole():
    for data in (summary(9, ["pao", "mineral"]), summary(90, ["pao"])):
        assert ends_of_paths(data, table(data)) == table(data)
    assert mean_power_of_paths(summary(90, ["pao"])) is None


def test_the_mean_power_of_uneven_rows_is_an_integral():
    data = summary(41, ["pao", "mineral"])
    means = mean_power_of_paths(data)
    exact = 1e6 * (5.5e-3**2 + 6.5e-3**2) / 2 / 12e-3
    values = [float(row[-1]) for row in means.rows]
    assert values == pytest.approx([exact, 2 * exact], rel=2e-3)
    assert [row[0] for row in means.rows] == ["pao", "mineral"]
