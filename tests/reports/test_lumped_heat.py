"""The stored comparison of lumped and full heat: shown, and one row anew."""

import math

import pytest

from bem.lubrication.inlet_heating import InletHeating, inlet_heating_factor
from bem.lubrication.thermal.checks import COMPARED_LOADINGS, COOL_LOAD, LUMPED_ERRORS, heat_limits, lumped_errors
from reports import lumped_heat, reproducible
from reports.experiments.lumped_heat import case


def test_every_row_is_shown():
    assert lumped_heat.chapter().body.count("<tr>") == 1 + len(lumped_heat.rows())


def test_a_row_is_what_the_solvers_say():
    rows = {row.label: row for row in reproducible.RESULTS["lumped_heat"].rows()}
    assert rows["M 5, L 12, slide-roll 0.5"].verdict() == "in"


@pytest.mark.parametrize(("oil", "loading"), list(zip((12.0, 16.0, 20.0), COMPARED_LOADINGS, strict=True)))
@pytest.mark.parametrize("ratio", sorted(LUMPED_ERRORS))
def test_lumped_heat_says_what_was_found_at_the_nearest_sliding(oil, loading, ratio):
    """Near pure rolling friction was called 10 to 60 % off, where the comparison had 0.5 to 10 %."""
    heaviest = COOL_LOAD if ratio == 2 else math.inf
    rows = [
        one
        for one in lumped_heat.rows()
        if (one["L"], one["slide_roll_ratio"]) == (oil, ratio) and one["M"] <= heaviest
    ]
    film, friction = ([100 * one[key] for one in rows] for key in ("film_error", "traction_error"))
    row = LUMPED_ERRORS[ratio][COMPARED_LOADINGS.index(loading)]
    # written to a tenth of a per cent
    assert row == pytest.approx((min(film), max(film), min(friction), max(friction)), abs=0.051)
    nearest, of_film, of_friction = lumped_errors(loading, ratio * 1.2)
    assert nearest == ratio
    assert of_film[0] <= row[0] <= row[1] <= of_film[1]
    assert of_friction[0] <= row[2] <= row[3] <= of_friction[1]


def test_the_note_on_lumped_heat_is_of_its_sliding_and_loading():
    """A ball's film near pure rolling; between compared loadings errors lie between theirs."""
    (note,) = heat_limits(InletHeating(0.9, 0.073, False), (5.05, 4.95), 3.0, "")
    assert note.values["nearest"] == 0.02
    assert note.values["film"] == (-10.0, -2.0)
    assert note.values["friction"] == (-3.0, 4.0)
    assert "-3 to +4 %" in note
    (note,) = heat_limits(InletHeating(0.9, 1.5, False), (6.2, 3.8), 30.0, "")
    assert note.values["nearest"] == 0.5
    assert note.values["friction"] == (-15.0, 55.0)
    assert heat_limits(InletHeating(0.9, 0.04, False), (5.0, 5.0), 3.0, "") == ()


def test_a_cool_film_of_one_surface_at_rest_is_too_thin():
    """A piston ring at 75 deg of its stroke: 14 % too thin, friction within 1 %, by both models of a flooded film."""
    (note,) = heat_limits(InletHeating(0.9, 0.061, False), (11.0, 0.0), 1.1, "")
    (low, high), (less, more) = note.values["film"], note.values["friction"]
    assert low <= -14.1 <= high
    assert less <= -0.1 <= more
    (warm,) = heat_limits(InletHeating(0.9, 0.061, False), (11.0, 0.0), 30.0, "")
    assert warm.values["reason"] == "slides"


def test_the_loadings_are_those_of_the_experiment():
    for oil, loading in zip((12.0, 16.0, 20.0), COMPARED_LOADINGS, strict=True):
        asked = case(30.0, oil, 0.5, 400)
        used = asked["lubricant"]
        inlet = inlet_heating_factor(
            used.viscosity, used.temperature_viscosity, used.thermal_conductivity, asked["speeds"], 0.01
        )
        assert inlet.loading == pytest.approx(loading, rel=0.04)  # written to two digits
