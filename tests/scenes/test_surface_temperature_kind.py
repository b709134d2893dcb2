"""Kind `surface-temperature`: a ball against Tian and Kennedy, shares, messages."""

import math

import numpy as np
import pytest

from bem import CATALOGUE, InfeasibleError, InputError, plan_scene
from bem.notes import has_code
from bem.notes.heat import SURFACE_HOT
from bem.reference_solutions.heat_sources import tian_kennedy
from bem.reference_solutions.hertz import ellipse_contact
from bem.scenes import PlainContext, get_kind, load_scene

STEEL = CATALOGUE["steel-52100"].material


def scene(**changes):
    table = {
        "kind": "surface-temperature",
        "grid": {"shape": 64, "lengths": "400 um"},
        "lower": {"material": "steel-52100"},
        "shape": {"kind": "sphere", "radius": "10 mm"},
        "contact": {"load": "10 N", "friction": 0.1},
        "heat": {"lower_speed": "2 m/s"},
    }
    for key, value in changes.items():
        table, at = dict(table), key.split("__")
        if len(at) == 1:
            table[at[0]] = value
        else:
            table[at[0]] = {**table.get(at[0], {}), at[1]: value}
    return load_scene(table)


def run(**changes):
    kind = get_kind("surface-temperature")
    resolved = kind.resolve(scene(**changes))
    kind.plan(resolved)
    context = PlainContext(resolved)
    return kind.run(resolved, context), context


@pytest.mark.parametrize("speed", [0.05, 2.0, 50.0])
def test_a_ball_under_all_the_heat_is_tian_and_kennedys(speed):
    """A rigid, insulating ball: their interpolation for the semi-ellipsoidal flux is within 2 % (measured: 1.2 %)."""
    record, _ = run(heat__lower_speed=speed)
    exact = ellipse_contact(radii=(0.01, 0.01), contact_modulus=STEEL.plane_strain_modulus, load=10.0)
    radius = exact.semi_axes[0]
    flux = 0.1 * speed * 10.0 / (math.pi * radius**2)
    rise = tian_kennedy("hertz maximum", speed * radius / (2 * STEEL.thermal_diffusivity))
    assert record.maximum_rise == pytest.approx(rise * flux * radius / STEEL.thermal_conductivity, rel=0.02)
    assert record.share_of_lower == 1.0
    assert record.friction_power == pytest.approx(0.1 * speed * 10.0, rel=1e-6)
    assert 0 < record.errors["maximum_temperature"] < 0.02 * record.maximum_rise


def test_two_bodies_share_and_are_cooler():
    alone, _ = run()
    heat = {"lower_speed": 2.0, "upper_speed": -2.0, "lower_bulk": "60 degC", "upper_bulk": "60 degC"}
    pair, _ = run(upper={"material": "steel-52100"}, heat=heat)
    assert pair.share_of_lower == pytest.approx(0.5, abs=1e-6)
    assert pair.friction_power == pytest.approx(2 * alone.friction_power, rel=1e-6)
    assert pair.maximum_rise < alone.maximum_rise  # each takes what one took, and two elastic bodies touch more widely
    assert pair.surface_temperature.max() == pytest.approx(pair.maximum_temperature, rel=1e-9)
    assert np.abs(pair.surface_temperature.min() - 333.15) < 5


def test_rolling_alone_makes_no_heat():
    record, _ = run(upper={"material": "steel-52100"}, heat={"lower_speed": 2.0, "upper_speed": 2.0})
    assert record.friction_power == 0
    assert record.maximum_rise == pytest.approx(0, abs=1e-12)


def test_what_no_steel_stands_is_noted():
    _, context = run(heat__lower_speed=100.0, contact__friction=0.5)
    assert has_code(context.notes, SURFACE_HOT, reason="transforms")


def planned(changes):
    kind = get_kind("surface-temperature")
    return kind.plan(kind.resolve(scene(**changes)))


@pytest.mark.parametrize(
    ("changes", "word"),
    [
        ({"lower": {"material": {"youngs_modulus": 1e9, "poissons_ratio": 0.3}}}, "thermal_conductivity"),
        ({"lower": {"material": "steel-52100", "layer": {"material": "ta-C", "thickness": "1 um"}}}, "layer of ta-C"),
        ({"grid": {"shape": 64, "lengths": "400 um", "periodic": True}}, "periodic along x"),
        ({"heat": {"lower_speed": 1.0, "lower_bulk": "20 K"}}, "heat.lower_bulk"),
    ],
)
def test_mistakes_are_said_by_the_plan(changes, word):
    with pytest.raises(InputError, match=word):
        planned(changes)


def test_the_built_in_scene_is_planned():
    _, plan = plan_scene("flash-temperature")
    assert any(step.name == "surface temperature" and not step.skipped for step in plan.steps)


def test_a_load_beyond_hardness_times_area_is_refused_before_any_work():
    contact = {"load": "1 kN", "friction": 0.1, "behaviour": "capped", "hardness": "1 GPa"}  # the grid carries 160 N
    with pytest.raises(InfeasibleError, match=r"contact.load = 1000 N: beyond hardness x area"):
        plan_scene(scene(contact=contact))
