"""Richardson's estimate: exact on figures of a known order, floors, regimes, and the rules for sums and ratios."""

import numpy as np
import pytest

from bem.accuracy.richardson import (
    Regime,
    Row,
    Table,
    cover_parts,
    follow,
    relative,
    residual_errors,
    rows,
    share_error,
    to_half,
)
from reports import error_bars
from reports.error_bars import RESULTS, TABLES, table_of


def figure(points, order):
    return 3.0 + 7.0 * points**-order


@pytest.mark.parametrize("order", [1, 2, 3])
@pytest.mark.parametrize("ratio", [0.25, 0.5, 0.6, 2.0])
def test_a_figure_of_its_order_has_its_error_whatever_the_ratio_of_the_meshes(order, ratio):
    table = Table("", rows("f", 1 / (2**order - 1), "exact", order=order))
    found, other = ({"f": figure(n, float(order))} for n in (100.0, 100.0 * ratio))
    error = table.errors(found, other, ratio=ratio)["f"]
    assert error == pytest.approx(found["f"] - 3.0, rel=1e-9)


def test_the_difference_to_half_the_points_counts_as_it_is():
    assert to_half(0.5, 1) == to_half(0.5, 2) == to_half(0.5, 3) == 1.0
    assert to_half(2.0, 2) == pytest.approx(4.0)


def test_floors_remain_where_a_difference_passes_zero():
    row = Row(0.5, "", floors={"edge": 0.02, "film": (0.1, 0.3)})
    assert row.error(0.0, {"edge": 5.0}) == pytest.approx(0.1)
    assert row.error(-2.0, {"edge": -5.0, "film": 1.0}) == pytest.approx(1.0 + 0.1 + 0.1)
    assert row.error(0.0, {"film": 1.0}, Regime.UNRESOLVED) == pytest.approx(0.3)
    assert row.error(2.0, {"unknown": 9.0}) == pytest.approx(1.0)


def test_a_row_of_two_numbers_takes_a_sampled_surface_for_an_unresolved_one():
    two, three = Row((1.0, 2.0), ""), Row((1.0, 2.0, 3.0), "")
    assert [two.error(1.0, {}, regime) for regime in Regime] == [1.0, 2.0, 2.0]
    assert [three.error(1.0, {}, regime) for regime in Regime] == [1.0, 2.0, 3.0]


def test_figures_that_are_arrays_have_errors_entry_by_entry():
    table = Table("", rows("a b", 0.5, "", edge=0.1))
    found, other = {"a": np.array([1.0, 2.0])}, {"a": np.array([2.0, 0.0])}
    errors = table.errors(found, other, {"edge": relative(0.5, found)})
    assert list(errors) == ["a"]
    assert errors["a"] == pytest.approx([0.5 + 0.05, 1.0 + 0.1])


def test_figures_with_a_given_sum_share_the_largest_error():
    errors = {"film": 1.0, "contact": 3.0, "friction": 0.1}
    share_error(errors, ("film", "contact"))
    assert errors == {"film": 3.0, "contact": 3.0, "friction": 0.1}
    cover_parts(errors, "friction", ("film",))
    assert errors["friction"] == 3.0


def test_figures_in_proportion_have_one_relative_error():
    errors, sizes = {"heat": 0.1, "load": 1.0}, {"heat": -4.0, "load": 10.0}
    follow(errors, "heat", "load", sizes)
    assert errors["heat"] == pytest.approx(0.4)
    follow(errors, "load", "heat", {"heat": 0.0, "load": 10.0})  # a figure of zero says nothing
    assert errors["load"] == 1.0


def test_the_residual_is_a_floor_of_noise():
    assert residual_errors(1e-6, {"f": -2.0}) == {"f": pytest.approx(2e-5)}


@pytest.mark.parametrize("name", TABLES.values())
def test_tables_name_experiments_that_are_stored(name):
    table = table_of(name)
    assert table
    for experiment in table.experiments:
        assert (RESULTS / f"{experiment}.json").exists()


def test_the_guide_shows_every_row_with_its_reason():
    shown = list(error_bars.factors())
    assert {row[0] for row in shown} == set(TABLES)
    assert all(row[-1] for row in shown)
    (area,) = (row for row in shown if row[0] == "contact" and "contact area" in row[1])
    assert area[2:6] == ("2", "0.33 / 0.33 / 0.4", "0.99 / 0.99 / 1.2", "edge 0.02 / 0.03 / 0.05")
