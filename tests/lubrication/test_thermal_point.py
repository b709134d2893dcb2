"""Lumped heat of a ball's film: energy, the line contact as limit, inlet heating, load sharing with it."""

import math
from dataclasses import replace

import numpy as np
import pytest

from bem import (
    Body,
    Grid,
    InputError,
    Lubricant,
    Material,
    Status,
    generate_surface,
    solve_line_film,
    solve_mixed,
    surface_temperature,
)
from bem.friction.point_film import film_with_heat, film_without_heat
from bem.friction.setup import MixedSetup
from bem.friction.smooth import PointContact
from bem.lubrication.inlet_heating import InletHeating
from bem.lubrication.thermal import lumped_point
from bem.lubrication.thermal.bodies import moving_bodies
from bem.lubrication.thermal.lumped_point import add_heat, find_oil_thinning, point_heat
from bem.lubrication.thermal.model import FilmHeat
from bem.notes import has_code
from bem.notes.friction import POINT_FILM_SCALED
from bem.notes.lubrication import HEAT_LEFT_OUT, HEAT_NOT_FOUND, LUMPED_HEAT_LIMIT, VISCOSITY_EXTRAPOLATED
from bem.reference_solutions.hertz import ellipse_contact

ELASTIC = {"youngs_modulus": 210e9, "poissons_ratio": 0.3}
STEEL = Body(Material("steel", **ELASTIC, thermal_conductivity=46.0, density=7800.0, heat_capacity=470.0))
MODULUS = 210e9 / 2 / (1 - 0.3**2)
OIL = Lubricant.of("ISO VG 68", temperature=333.15, density_law="incompressible")
HEAT = FilmHeat("lumped", (STEEL, STEEL))
LONG = PointContact((5e-3, 0.25), MODULUS, OIL, heat=HEAT)


@pytest.fixture(scope="module")
def long():
    return film_with_heat(LONG, (1.2, 0.8), 40.0, 64)


@pytest.mark.internal
def test_long_ellipse_is_the_line_contact(long):
    """Half-axes 1 : 12, on the line through the middle: film to 0.5 %, rise of the oil 6.8 and 6.9 K."""
    peak = ellipse_contact(radii=LONG.radii, contact_modulus=MODULUS, load=40.0).maximum_pressure
    case = {
        "load": math.pi * 5e-3 * peak**2 / MODULUS, "radius": 5e-3, "contact_modulus": MODULUS, "speeds": (1.2, 0.8),
        "lubricant": OIL, "points": 300,
    }  # fmt: skip
    line = solve_line_film(**case, thermal="lumped", bodies=(STEEL, STEEL))
    middle = long.y.size // 2
    pressure, rise = long.pressure[:, middle], long.temperature[:, middle] - 333.15
    assert long.status is Status.CONVERGED
    assert long.central_thickness == pytest.approx(line.central_thickness, rel=5e-3)
    assert (rise * pressure).sum() / pressure.sum() == pytest.approx(line.mean_temperature - 333.15, rel=0.05)


@pytest.mark.internal
def test_energy_closes(long):
    """What friction makes on the lines goes into the bodies or on with the oil; it is that of both forces."""
    across = ellipse_contact(radii=LONG.radii, contact_modulus=MODULUS, load=40.0).semi_axes[1]
    heat = point_heat(long, OIL, moving_bodies("test", OIL, (STEEL, STEEL), (1.2, 0.8), None, across))
    assert heat.power == pytest.approx(sum(heat.into) + heat.carried, rel=1e-9)
    sliding = 0.5 * abs(long.shear_force[0, 0] - long.shear_force[1, 0]) * 0.4
    rolling = abs(long.rolling_force[0]) * 2.0
    assert heat.power == pytest.approx(sliding + rolling, rel=0.02)  # lines far from the contact have none
    assert heat.into[0] == pytest.approx(heat.into[1], rel=0.2)
    assert (heat.surfaces <= heat.temperature.max()).all()


@pytest.mark.internal
def test_the_film_is_as_thin_as_inlet_heating_says_and_friction_falls():
    ball, speeds = PointContact((0.01, 0.01), MODULUS, OIL, heat=HEAT), (3.0, 2.6)
    cold = film_without_heat(replace(ball, heat=None), speeds, 20.0, 48)
    hot, back = (film_with_heat(ball, pair, 20.0, 48) for pair in (speeds, (-3.0, -2.6)))
    assert 0.9 < hot.central_thickness / cold.central_thickness < 0.96
    assert hot.friction < cold.friction
    assert hot.mean_temperature > 333.15 + 5
    # the other way round it is the same, mirrored
    np.testing.assert_allclose(back.temperature[::-1], hot.temperature, rtol=1e-6)
    assert back.shear_force[0, 0] == pytest.approx(-hot.shear_force[0, 0], rel=1e-6)


@pytest.mark.internal
def test_strong_heat_is_found():
    """A ball that slides at 5 m/s over a disc at rest: the oil warms by 140 K, at which the stress depends on it."""
    hot = film_with_heat(PointContact((5e-3, 5e-3), MODULUS, OIL, heat=HEAT), (5.0, 0.0), 20.0, 32)
    assert hot.status is Status.CONVERGED
    assert hot.mean_temperature > 333.15 + 100


@pytest.mark.internal
def test_heat_that_is_not_found_is_not_shown(monkeypatch):
    monkeypatch.setattr(lumped_point, "RESIDUAL", -1.0)
    found = film_with_heat(PointContact((5e-3, 5e-3), MODULUS, OIL, heat=HEAT), (5.0, 0.0), 20.0, 32)
    assert found.status is Status.STALLED
    assert np.isnan([found.mean_temperature, found.maximum_temperature, found.friction]).all()
    assert np.isnan(found.temperature).all()
    assert found.central_thickness > 0
    assert has_code(found.notes, HEAT_NOT_FOUND, reason="lumped")


@pytest.mark.internal
@pytest.mark.parametrize(
    ("radii", "speeds", "most", "told"),
    [((5e-3, 5e-3), (3.0, 2.6), 0.08, False), ((5e-2, 5e-3), (3.0, 1.0), 0.7, True)],
)
def test_surfaces_beside_heat_that_spreads_across(radii, speeds, most, told):
    """Under the same heat, with what is conducted from line to line, surfaces are less warm: by as much as is said."""
    contact = PointContact(radii, MODULUS, OIL, heat=HEAT)
    half_axes = ellipse_contact(radii=radii, contact_modulus=MODULUS, load=20.0).semi_axes
    film = film_with_heat(contact, speeds, 20.0, 32)
    heat = point_heat(film, OIL, moving_bodies("test", OIL, (STEEL, STEEL), speeds, None, half_axes[1]))
    grid = Grid(film.pressure.shape, (film.x[1] - film.x[0], film.y[1] - film.y[0]))
    for flux, surface, speed in zip(heat.fluxes, heat.surfaces, speeds, strict=True):
        whole = float((surface_temperature(flux, grid, STEEL, speeds=speed).temperature * film.pressure).sum())
        lines = float(((surface - 333.15) * film.pressure).sum())
        assert 0.02 < lines / whole - 1 < most
    assert has_code(film.notes, LUMPED_HEAT_LIMIT, reason="spreads") is told


@pytest.mark.internal
def test_slow_films_have_no_heat():
    ball, speeds = PointContact((0.01, 0.01), MODULUS, OIL, heat=HEAT), (0.02, 0.019)
    cold, hot = film_without_heat(replace(ball, heat=None), speeds, 20.0, 48), film_with_heat(ball, speeds, 20.0, 48)
    assert hot.central_thickness == pytest.approx(cold.central_thickness, rel=5e-3)
    assert hot.mean_temperature == pytest.approx(333.15, abs=0.2)
    assert hot.friction == pytest.approx(cold.friction, rel=5e-3)


@pytest.mark.internal
def test_thinned_oil_by_a_power_law():
    """Of films that go with the power 0.6 of the viscosity; where there is none, it is said."""
    inlet = InletHeating(0.7, 0.1, False)
    found = find_oil_thinning(OIL, inlet, lambda one: one.viscosity**0.6, 0.7)
    oil = found.oil(OIL, inlet)
    assert found.exponent == pytest.approx(0.6)
    assert (oil.viscosity / OIL.viscosity) ** 0.6 == pytest.approx(0.7)
    assert found.deviation < 5e-3
    # it is as much stiffer under pressure as it was
    pressure = np.array([1e9])
    assert oil.log_viscosity_ratio(pressure)[0] == OIL.log_viscosity_ratio(pressure)[0]
    assert find_oil_thinning(OIL, inlet, lambda _: math.nan, 0.7).deviation == math.inf


@pytest.mark.internal
def test_thinned_oil_keeps_the_notes_of_its_law():
    """A ball at 1.5 GPa, fast enough for its inlet to heat: the note names the oil's law and its limit."""
    ball = PointContact((5e-3, 5e-3), MODULUS, OIL, heat=HEAT)
    load = 1.5e9**3 / ellipse_contact(radii=ball.radii, contact_modulus=MODULUS, load=1.0).maximum_pressure ** 3
    film = film_with_heat(ball, (8.0, 6.0), load, 48)
    assert film.lubricant.viscosity < 0.9 * OIL.viscosity
    (note,) = [one for one in film.notes if one.code == VISCOSITY_EXTRAPOLATED.code]
    assert note.values["law"] == OIL.viscosity_law.name
    assert note.values["limit"] == OIL.viscosity_law.largest_pressure


@pytest.mark.internal
def test_no_film_is_solved_for_an_inlet_that_hardly_thins():
    slight = find_oil_thinning(OIL, InletHeating(0.997, 0.001, False), lambda _: pytest.fail("a film"), 0.7)
    assert (slight.exponent, slight.deviation) == (0.7, pytest.approx(0.003))


GRID = Grid((48, 48), (6.5e-6, 6.5e-6))
MIXED = {
    "grid": GRID, "bodies": (STEEL, STEEL), "radii": (0.01, 0.01), "load": 20.0, "lubricant": OIL,
    "boundary_friction": 0.12, "film_cells": 48, "oil_volume": "loaded",
}  # fmt: skip


def test_load_sharing_has_it():
    whole = Grid(GRID.shape, GRID.spacing, periodic=(True, True))
    height = generate_surface(whole, rms_height=150e-9, correlation_length=20e-6, seed=3)
    cold, hot = (solve_mixed(**MIXED, height=height, speeds=(1.0, 0.5), thermal=heat) for heat in ("off", "lumped"))
    assert hot.status is Status.CONVERGED
    assert hot.regime.value == "mixed"
    assert hot.film_load + hot.contact_load == pytest.approx(20.0, rel=2e-4)
    assert hot.contact_load > cold.contact_load
    assert hot.friction < cold.friction
    assert 333.15 < hot.film.mean_temperature < hot.film.maximum_temperature
    assert 333.15 < hot.contact_temperature < hot.flash_temperature
    assert not has_code(hot.notes, HEAT_LEFT_OUT, reason="sliding")


def test_a_ball_at_rest_has_its_own_heat():
    """Heat under a ball has a steady temperature at rest: that of a body that hardly moves."""
    height = np.zeros(GRID.shape)
    height[::4] = 4e-7
    still, slow = (solve_mixed(**MIXED, height=height, speeds=(0.05, ball), thermal="lumped") for ball in (0.0, 1e-5))
    assert still.contact_temperature == pytest.approx(slow.contact_temperature, abs=1e-2)
    assert still.contact_temperature > 333.15 + 1
    assert not any("cylinder" in note for note in still.notes)


@pytest.mark.internal
@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"thermal": "full"}, "not there for the film of a ball"),
        ({"lubricant": Lubricant(0.03, pressure_viscosity=18e-9, density_law="incompressible")}, "the lubricant lacks"),
        ({"bodies": STEEL}, "give a pair"),
        ({"grid": Grid((16, 16), (2e-6, 2e-6), periodic=(True, True))}, "a cell that repeats has no heat"),
    ],
)
def test_bad_input_is_said(wrong, said):
    with pytest.raises(InputError, match=said):
        MixedSetup(**MIXED | {"thermal": "lumped"} | wrong)


@pytest.mark.internal
def test_films_with_heat_are_continuous_in_the_load():
    """The viscosity was taken from the nearest of loads a factor of three apart: half way between two the film jumped
    by 4 %, and rough surfaces had two balances."""
    oil = Lubricant.of("ISO VG 68", temperature=313.15)
    contact, speeds, middle = PointContact((10e-3, 10e-3), MODULUS, oil, heat=HEAT), (8.0, 6.0), 3**2.5
    less, more = (
        film_with_heat(contact, speeds, load, 48).central_thickness
        for load in (middle * (1 - 1e-6), middle * (1 + 1e-6))
    )
    assert more == pytest.approx(less, rel=1e-4)


@pytest.mark.internal
def test_the_hottest_oil_of_a_film_extrapolated_in_load_is_not_judged(long, monkeypatch):
    """A ball in pure rolling, its oil 3 K warmer in the mean, was told of oil above 130 degC at places not solved."""
    judged = []
    monkeypatch.setattr(lumped_point, "notes_of_heat", lambda _, hottest: judged.append(hottest) or ())
    axes = ellipse_contact(radii=LONG.radii, contact_modulus=MODULUS, load=40.0).semi_axes
    scaled = replace(long, notes=(POINT_FILM_SCALED(reason="thin", factors=""),))
    made = [add_heat(film, OIL, (STEEL, STEEL), axes, InletHeating(1.0, 0.0, False), 0.0) for film in (long, scaled)]
    assert judged[0] == pytest.approx(made[0].maximum_temperature)
    assert made[1].mean_temperature <= judged[1] < judged[0]
