"""Flash temperature against Jaeger's band; the FZG test gears scuff at their own load stage."""

import math
import tomllib

import numpy as np
import pytest

from bem import CATALOGUE, contact_modulus
from bem.elements.contact import ElementContact
from bem.elements.element import element_template, load_element
from bem.elements.gear_scuffing import base_of, friction_of_gear_tests, mean_flash_temperature, scuffing_of
from bem.elements.running import run_contact
from bem.elements.scuffing import (
    BULK_WEIGHT,
    flash_temperature,
    gear_test_friction,
    integral_temperature,
    lubricant_factor,
    permissible_contact_temperature,
    permissible_integral_temperature,
    scuffing_test_friction,
)
from bem.heat.bodies import Conductor
from bem.heat.line_contact import band_temperatures

STEEL = CATALOGUE["case-hardened-steel"].material
MODULUS = contact_modulus(STEEL, STEEL)
BODIES = (STEEL, STEEL)
FZG_A = {
    "profile_shifts": [0.8532, -0.5], "tip_diameters": ["88.77 mm", "112.5 mm"], "face_width": "20 mm",
    "speed": "2170 rpm", "points": 201, "rms_roughness": "620 nm",
}  # fmt: skip
"""Test gears A of ISO 14635-1 at 8.3 m/s, flanks of Ra 0.35 um."""


def line(speeds, load=5e3):
    return ElementContact("line", 0.0, load, (8e-3, 12e-3), speeds, length=14e-3)


def gears(**changes):
    return load_element(tomllib.loads(element_template("gear-pair")) | {"name": "gears"} | changes)


@pytest.mark.parametrize("speed", [5.0, 20.0])
def test_the_flash_temperature_is_that_of_a_fast_band(speed):
    """One body at rest takes no heat in Blok's limit: the other one alone, solved by superposed bands."""
    contact, friction = line((speed, 0.0)), 0.04
    found = flash_temperature(contact, friction, modulus=MODULUS, bodies=BODIES)
    half, pressure = contact.half_width(MODULUS), contact.hertz(MODULUS).maximum_pressure
    edges = np.linspace(-half, half, 401)
    middles = 0.5 * (edges[1:] + edges[:-1])
    heat = friction * pressure * np.sqrt(1 - (middles / half) ** 2) * speed
    body = Conductor(STEEL.thermal_conductivity, STEEL.thermal_diffusivity, speed, 0.0)
    exact = float(np.max(band_temperatures(edges, body) @ heat))
    assert found == pytest.approx(exact, rel=0.02)


def test_the_flash_temperature_shares_heat_between_both_bodies():
    """Equal tops: with heat parts that make both surfaces equally hot, as B sqrt(u)."""
    both = flash_temperature(line((4.0, 1.0)), 0.05, modulus=MODULUS, bodies=BODIES)
    alone = flash_temperature(line((4.0, 0.0)), 0.05, modulus=MODULUS, bodies=BODIES)
    assert both / alone == pytest.approx(3 / 4 * 2 / 3)
    assert flash_temperature(line((3.0, 3.0)), 0.05, modulus=MODULUS, bodies=BODIES) == 0
    assert flash_temperature(line((4.0, 1.0)), -0.05, modulus=MODULUS, bodies=BODIES) == pytest.approx(both)
    # w / sqrt(a) grows with the load to the power 3/4
    heavy = flash_temperature(line((4.0, 1.0), load=10e3), 0.05, modulus=MODULUS, bodies=BODIES)
    assert heavy / both == pytest.approx(2**0.75)


@pytest.mark.parametrize("stage", [6, 9, 12])
def test_the_test_gears_scuff_at_their_own_stage(stage):
    """The permissible integral temperature is that of these gears in the test at that stage."""
    element = gears(**FZG_A, torque=f"{3.726 * stage**2} N*m")
    friction = friction_of_gear_tests(element)
    mean = mean_flash_temperature(element, friction.scuffing)
    found = integral_temperature(90 + BULK_WEIGHT * mean, mean)
    assert found == pytest.approx(permissible_integral_temperature(stage, viscosity_40=100e-6), rel=0.15)


@pytest.mark.parametrize(("stage", "most"), [(6, 1.2), (9, 1.35), (12, 1.4)])
def test_the_contact_temperature_of_the_test_gears_at_their_own_stage(stage, most):
    """Safety 1 is due; the friction of films, which leaves asperities out, would have 1.5 to 2.2."""
    element = gears(**FZG_A | {"points": 11}, torque=f"{3.726 * stage**2} N*m", scuffing_load_stage=stage)
    end = element.found.contacts[-1]
    friction = friction_of_gear_tests(element).scuffing
    by_tests = flash_temperature(end, friction, modulus=element.modulus, bodies=element.bodies)
    found = scuffing_of(element, [run_contact(element, end)])
    assert found.flash == by_tests
    assert 1 < found.contact_safety < most


def test_permissible_temperatures_of_stage_twelve():
    """404 degC of contact and 364 degC integral for a mineral oil ISO VG 100 and case-hardened gears."""
    assert permissible_contact_temperature(12) == pytest.approx(404)
    assert permissible_integral_temperature(12, viscosity_40=100e-6) == pytest.approx(364, abs=1)
    assert permissible_contact_temperature(12, factor=0.8) < 404
    assert permissible_contact_temperature(10, structure=0.45) < permissible_contact_temperature(10)


def test_the_friction_of_gear_tests_of_a_hand_calculation():
    """FZG C at 200 N m: 422 N/mm, 6.58 m/s, 8.38 mm, 12.3 mPa s, Ra 0.28 um: 0.0463."""
    given = {"line_load": 422e3, "sum_speed": 6.58, "radius": 8.38e-3, "viscosity": 12.3e-3, "roughness": 0.28e-6}
    assert gear_test_friction(**given) == pytest.approx(0.0463, rel=2e-3)
    assert friction_of_gear_tests(gears()).power == pytest.approx(0.0463, rel=5e-3)
    fast = given | {"sum_speed": 500.0}
    assert scuffing_test_friction(**fast) == scuffing_test_friction(**given | {"sum_speed": 50.0})


def test_oils_of_other_bases_rub_less():
    factors = [lubricant_factor(base, 6.0) for base in ("mineral", "pao", "pag")]
    assert factors == [1.0, 0.8, 0.75]
    assert lubricant_factor("pag", 60.0) < 0.5
    oil = tomllib.loads(element_template("gear-pair"))["oil"] | {"base": "pao"}
    assert base_of(gears(oil=oil)) == "pao"


@pytest.fixture(scope="module")
def solved():
    element = gears(points=5, scuffing_load_stage=12)
    return element, [run_contact(element, one) for one in (element.found.contacts[0], element.found.contacts[3])]


@pytest.mark.internal
def test_safety_against_scuffing(solved):
    element, runs = solved
    found = scuffing_of(element, runs)
    oil = 363.15
    by_tests = [
        flash_temperature(one.contact, found.friction, modulus=element.modulus, bodies=element.bodies) for one in runs
    ]
    assert found.flash == max(by_tests) > max(one.flash for one in runs)
    smooth = gears(points=5, scuffing_load_stage=12, rms_roughness=None)
    assert scuffing_of(smooth, runs).flash == max(one.flash for one in runs)
    assert scuffing_of(smooth, runs).friction is None
    assert found.bulk == pytest.approx(oil + 0.7 * found.mean_flash)
    assert found.estimated
    assert found.contact_safety == pytest.approx((404 + 273.15 - oil) / (found.contact - oil))
    assert found.integral_safety == pytest.approx(364.4 / (found.integral - 273.15), rel=1e-3)
    assert 1 < found.integral_safety < 4
    hotter = element.at_bulk(oil + 60)
    warm = scuffing_of(hotter, runs)
    assert warm.bulk == oil + 60
    assert not warm.estimated
    assert warm.contact_safety < found.contact_safety


@pytest.mark.internal
def test_flash_temperature_of_a_solved_film(solved):
    element, runs = solved
    for one in runs:
        own = flash_temperature(one.contact, one.friction, modulus=element.modulus, bodies=element.bodies)
        assert one.flash == own > 0


def test_without_thermal_constants_or_temperature_there_is_none(solved):
    element, _ = solved
    iron = {"name": "bare", "youngs_modulus": "206 GPa", "poissons_ratio": 0.3}
    bare = gears(first=iron)
    assert mean_flash_temperature(bare, 0.05) is None
    assert math.isfinite(mean_flash_temperature(element, 0.05))
    assert scuffing_of(element, []) is None
