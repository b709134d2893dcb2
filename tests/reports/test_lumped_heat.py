"""The stored comparison of lumped and full heat: shown, and one row anew."""

import pytest

from bem.lubrication.inlet_heating import InletHeating
from bem.lubrication.thermal.checks import heat_limits
from reports import lumped_heat, reproducible


def test_every_row_is_shown():
    assert lumped_heat.chapter().body.count("<tr>") == 1 + len(lumped_heat.rows())


def test_a_row_is_what_the_solvers_say():
    rows = {row.label: row for row in reproducible.RESULTS["lumped_heat"].rows()}
    assert rows["M 5, L 12, slide-roll 0.5"].verdict() == "in"


@pytest.mark.parametrize(("loading", "most"), [(0.073, "14 %"), (0.26, "14 %"), (1.5, "a third")])
def test_lumped_heat_says_of_pure_rolling_what_was_found_there(loading, most):
    """A ball's film, 7 % too thin in pure rolling, was called up to a third too thin, its friction 10 to 60 % off."""
    (note,) = heat_limits(InletHeating(0.9, loading, False), (5.0, 5.0), 3.0, "")
    assert note.headline.endswith(f"films are too thin, by up to {most}")
    rows = [one for one in lumped_heat.rows() if one["slide_roll_ratio"] == 0.0]
    errors = {oil: [100 * one["film_error"] for one in rows if one["L"] == oil] for oil in (12.0, 16.0, 20.0)}
    said = [f"{-max(one):.0f} to {-min(one):.0f} %" for one in errors.values()]
    assert said == ["1 to 4 %", "4 to 14 %", "5 to 33 %"]
    assert all(words in note for words in said)
