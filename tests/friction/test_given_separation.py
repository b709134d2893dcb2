"""Coupled and uncoupled asperities at the film's thickness: separation recomputed, sinking, trends of paper A."""

import math

import numpy as np
import pytest

from bem import Body, Grid, InputError, Lubricant, Material, Status, displacement_operator, generate_surface
from bem.friction.asperities import asperity_loads, find_summits
from bem.friction.balance import Regime
from bem.friction.given_separation import sinking_compliance
from bem.friction.solve import largest_difference, solve_mixed, stribeck_curve

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
MODULUS = STEEL.plane_strain_modulus / 2
SIDE, CELLS, RADIUS, WIDTH = 408e-6, 68, 2e-3, 6e-3
GRID = Grid((CELLS, CELLS), (SIDE / CELLS, SIDE / CELLS), periodic=(True, True))
OIL = Lubricant(
    0.36,
    pressure_viscosity=25e-9,
    density_law="dowson_higginson",
    shear_law="eyring",  # films at 1 GPa would rub as much as the surfaces by the default law
    shear_stress_limit=3e6,
)


def case(length=34e-6, pressure=1e9, model="coupled", **changes):
    """Surfaces of paper A, figures 5 and 6, on cells of 6 um, under a Hertz pressure [Pa]."""
    return {
        "height": generate_surface(GRID, rms_height=240e-9, seed=0, correlation_length=length),
        "grid": GRID,
        "bodies": (Body(STEEL), Body(STEEL)),
        "radius": RADIUS,
        "width": WIDTH,
        "load": math.pi * pressure**2 * RADIUS * WIDTH / MODULUS,
        "lubricant": OIL,
        "boundary_friction": 0.09,
        "film_points": 400,
        "contact_model": model,
        "separation": "film",
    } | changes


def central_film(point):
    return float(np.interp(0.0, point.grid.x, point.film_along_x[1]))


@pytest.mark.internal
def test_the_patch_sinks_as_the_middle_of_a_rectangle_under_uniform_pressure():
    for shape in ((41, 41), (61, 21)):
        free = Grid(shape, (2e-6, 2e-6))
        operator = displacement_operator(free, (Body(STEEL), Body(STEEL)))
        middle = operator(np.full(shape, 1e8))[shape[0] // 2, shape[1] // 2]
        assert sinking_compliance(free) * 1e8 / MODULUS == pytest.approx(middle, rel=1e-10)


@pytest.mark.internal
def test_the_undeformed_planes_are_as_far_apart_as_the_film_is_thick():
    given = case()
    point = solve_mixed(**given, speeds=(0.03, 0.0))
    assert point.status is Status.CONVERGED
    assert point.regime is Regime.MIXED
    pressure = point.contact.pressure
    deflection = displacement_operator(GRID, given["bodies"])(pressure)  # without mean
    rough = given["height"] - given["height"].mean()
    touching = pressure > 0.1 * pressure.max()
    deformed = (rough - deflection)[touching]  # distance of the deformed mean planes, at every place in contact
    assert np.ptp(deformed) < 1e-3 * rough.std()
    sunk = sinking_compliance(GRID) * pressure.mean() / MODULUS
    assert deformed.mean() - sunk == pytest.approx(central_film(point), rel=2e-3)
    assert point.contact_load == pytest.approx(pressure.mean() * SIDE * WIDTH, rel=1e-9)
    assert point.contact_load + point.film_load == pytest.approx(given["load"], rel=1e-9)
    assert not point.oil.matters


@pytest.mark.internal
def test_uncoupled_summits_are_pressed_in_by_what_stands_above_the_film():
    given = case(model="uncoupled")
    point = solve_mixed(**given, speeds=(0.03, 0.0))
    summits = find_summits(given["height"] - given["height"].mean(), GRID)
    depth = summits.height - central_film(point)
    alone = asperity_loads(depth, summits.radius, MODULUS, None)[0].sum() * WIDTH / SIDE
    assert point.contact_load == pytest.approx(alone, rel=2e-3)


def differences(length, pressures):
    """Largest relative differences of friction, uncoupled less coupled, with their sign."""
    found = []
    for pressure in pressures:
        curves = [stribeck_curve([0.03, 0.3], **case(length, pressure, model)) for model in ("coupled", "uncoupled")]
        assert all(point.status is Status.CONVERGED for curve in curves for point in curve)
        apart = [alone.friction - one.friction for one, alone in zip(*curves, strict=True)]
        found.append(math.copysign(largest_difference(*curves), max(apart, key=abs)))
    return found


def test_uncoupled_asperities_overestimate_friction_more_under_load_and_less_for_long_waves():
    """The sign and both trends of figures 5 and 6 of paper A; with the volume of oil kept the sign is the other."""
    short, long = (differences(length, (0.6e9, 1e9)) for length in (34e-6, 57e-6))
    assert 0 < short[0] < short[1]
    assert 0 < long[0] < long[1]
    assert long[0] < short[0]
    assert long[1] < short[1]
    assert 0.2 < short[1] < 0.45  # 32 % near 1 GPa in the source, of one surface


@pytest.mark.internal
def test_planes_too_far_apart_to_touch_are_full_film():
    point = solve_mixed(**case(), speeds=(10.0, 0.0))
    assert point.regime is Regime.FULL_FILM
    assert point.contact_load == 0


@pytest.mark.parametrize(
    ("wrong", "word"),
    [
        ({"grid": Grid((CELLS, CELLS), GRID.spacing, periodic=(False, True))}, "periodic"),
        ({"radius": None, "width": None, "radii": (2e-3, 2e-3)}, "cylinder"),
        ({"separation": "gap"}, "volume, film"),
    ],
)
def test_refuses_contacts_without_such_a_separation(wrong, word):
    with pytest.raises(InputError, match=word):
        solve_mixed(**case() | wrong, speeds=(0.1, 0.0))
