"""Sliding of balls within their curved contacts: closed forms, rigid kinematics, films solved strip by strip."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.special import ellipe

from bem.accuracy import traction_figures
from bem.elements.answer import answer, friction_power
from bem.elements.differential_sliding import ball_sliding, film_stress, sliding_in_film, spins_on_first
from bem.elements.element import load_element
from bem.elements.rolling_bearing import usual_ball_moment
from bem.elements.running import run_all, run_contact
from bem.kinds.traction.run import case_of
from bem.scenes.load import load_scene

DEEP_GROOVE = {
    "element": "rolling-bearing",
    "bore": "50 mm",
    "outside": "90 mm",
    "diameter": "12.7 mm",
    "count": 10,
    "radial_load": "7 kN",
    "clearance": "10 um",
    "speed": "1500 rpm",
    "first": "steel-52100",
    "second": "steel-52100",
    "oil": {"grade": "ISO VG 68", "temperature": "65 degC", "shear_law": "base_oil"},
}
INNER, OUTER = 0, 1


@pytest.fixture(scope="module")
def bearing():
    return load_element(DEEP_GROOVE)


def shape(element, contact):
    """Return semi-axes along and across, the largest pressure, and the speed of sliding of the sides over the lines."""
    hertz = contact.hertz(element.modulus)
    ball, groove = 0.5 * 12.7e-3, 0.52 * 12.7e-3
    bent = 2 / (1 / ball + 1 / groove)  # radius of the common surface
    along, across = hertz.semi_axes
    return along, across, hertz.maximum_pressure, contact.mean_speed * across**2 / (2 * bent * contact.radius)


@pytest.mark.parametrize("ring", [INNER, OUTER])
def test_dry_friction_is_that_of_the_closed_form(bearing, ring):
    """Coulomb: strips carry (3/4)(1 - eta^2) of the load, half of it within the lines eta0 of pure rolling."""
    contact = bearing.found.contacts[ring]
    most = shape(bearing, contact)[-1]
    found = ball_sliding(contact, bearing.modulus, lambda pressure, sliding: 0.05 * pressure * np.sign(sliding))
    line = 2 * math.sin(math.asin(0.5) / 3)  # root of 3 eta - eta^3 = 1
    power = 1.5 * (2 / 15 - 2 / 3 * line**2 + 4 * (line**3 / 3 - line**5 / 15))
    assert found.rolling_line == pytest.approx(line, rel=5e-3)  # within a strip
    assert found.speed == pytest.approx(most * power, rel=1e-3)
    assert found.power == pytest.approx(0.05 * contact.load * most * power, rel=1e-3)


def test_newtonian_friction_is_that_of_the_closed_form(bearing):
    """One viscosity over thickness: no force at the mean of eta^2 over the ellipse, 1/4; mean of eta^4 is 1/8."""
    contact = bearing.found.contacts[INNER]
    along, across, _, most = shape(bearing, contact)
    found = ball_sliding(contact, bearing.modulus, lambda pressure, sliding: 2e5 * sliding)
    assert found.rolling_line == pytest.approx(0.5, rel=1e-4)
    assert found.power == pytest.approx(2e5 * most**2 * math.pi * along * across / 16, rel=2e-3)  # midpoint rule
    heat = 2e5 * (most * 0.25) ** 2 * 2 * along / math.sqrt(2 * along)  # of the middle strip
    eta = np.linspace(0, 1, 2001)
    strips = (1 - 4 * eta**2) ** 2 * (1 - eta**2) ** 0.25
    assert found.heat == pytest.approx(heat * strips.max(), rel=2e-3)


@pytest.mark.parametrize("ring", [INNER, OUTER])
def test_the_speed_of_sliding_is_that_of_turning_rigid_bodies(bearing, ring):
    """Ring and ball turn about parallel axes, seen from the cage; points of the common surface have their own radii."""
    contact = bearing.found.contacts[ring]
    _, across, _, most = shape(bearing, contact)
    ball, side = 0.5 * 12.7e-3, 1 if ring == INNER else -1
    race = 35e-3 - side * ball
    bent = 2 / (1 / ball + 1 / (0.52 * 12.7e-3))
    rise = across**2 / (2 * bent)  # of the sides of the contact, towards the ball's axis
    turning = contact.mean_speed / race, contact.mean_speed / ball  # equal speeds in the middle
    slip = turning[0] * (race + side * rise) - turning[1] * (ball - rise)
    assert slip == pytest.approx(most, rel=1e-9)


@pytest.mark.parametrize("ring", [INNER, OUTER])
def test_a_ball_that_only_spins_has_the_closed_moment(bearing, ring):
    """3/8 mu Q b E(e) by Coulomb's friction, at a spin beside which the curvature counts little."""
    contact = bearing.found.contacts[ring]
    along, across, _, most = shape(bearing, contact)
    spin = 300 * most / across
    found = ball_sliding(
        replace(contact, spin=spin), bearing.modulus, lambda pressure, sliding: 0.05 * pressure * np.sign(sliding)
    )
    moment = 3 / 8 * 0.05 * contact.load * across * ellipe(1 - (along / across) ** 2)
    assert found.power == pytest.approx(moment * spin, rel=2e-3)
    still = ball_sliding(replace(contact, spin=1e-9), bearing.modulus, lambda pressure, sliding: 1e5 * sliding)
    assert still.power == pytest.approx(
        ball_sliding(contact, bearing.modulus, lambda pressure, sliding: 1e5 * sliding).power, rel=1e-9
    )


def test_spin_is_that_of_turning_rigid_bodies():
    """Rings and ball seen from the cage; the ball turns about any axis in the plane of its contacts."""
    bearing = load_element(DEEP_GROOVE | {"axial_load": "1.5 kN"})
    contacts = [one for one in bearing.found.contacts if one.spin]
    shared = bearing.model.ball_loads
    angles = shared.contact_angles[shared.loads > 0]
    assert len(bearing.found.contacts) == 2 * len(angles) == 2 * len({one.place for one in contacts})
    for contact, angle in zip(contacts, angles, strict=True):
        normal = np.array([math.cos(angle), math.sin(angle)])  # radial, axial
        cage = 0.4 * bearing.model.speed
        rings = {"inner": np.array([0.0, bearing.model.speed - cage]), "outer": np.array([0.0, -cage])}
        for tilt in (0.0, 0.1, angle):
            ball = -900.0 * np.array([-math.sin(tilt), math.cos(tilt)])
            spins = [(ball - ring) @ normal for ring in rings.values()]
            assert abs(spins[0] - spins[1]) == pytest.approx(abs(contact.spin), rel=1e-9)
    power = friction_power(bearing, run_all(bearing, most=2))
    plain = load_element(DEEP_GROOVE | {"axial_load": "1.5 kN"})
    without = [replace(one, spin=0.0) for one in plain.found.contacts]
    rolling = sum(run_contact(plain, one).sliding.power for one in without)
    assert power.within_contacts > 1.02 * rolling


def test_a_ball_grips_the_ring_that_resists_its_spin_more(bearing):
    inner, outer = bearing.found.contacts[:2]
    assert spins_on_first((replace(inner, load=0.5 * inner.load), outer), bearing.modulus)
    assert not spins_on_first((replace(inner, load=2 * inner.load), outer), bearing.modulus)


def test_power_agrees_with_films_solved_on_strips(bearing):
    """Each strip as a line film of its own, with heat, at its load and slide-to-roll ratio, by Gauss' rule."""
    contact = bearing.found.contacts[INNER]
    scene = load_scene(bearing.scene(contact, "traction"))
    case = case_of(scene)
    figures = traction_figures(case, case.on(300))
    found = sliding_in_film(
        contact, bearing.modulus, case.lubricant, figures["central_thickness"], figures["film_temperature"]
    )
    _, across, _, most = shape(bearing, contact)
    nodes, weights = np.polynomial.legendre.leggauss(4)
    line = found.rolling_line  # where the stress turns
    ends = ((0.0, line), (line, 1.0))
    at = np.concatenate([low + 0.5 * (high - low) * (nodes + 1) for low, high in ends])
    weight_at = np.concatenate([(high - low) * weights for low, high in ends])  # of both sides
    power, force = 0.0, 0.0
    for node, weight in zip(at, weight_at, strict=True):
        sliding = most * (node**2 - line**2)
        speeds = contact.mean_speed + 0.5 * sliding, contact.mean_speed - 0.5 * sliding
        strip = replace(case, load=case.load * (1 - node**2), speeds=speeds)
        drag = traction_figures(strip, strip.on(300))["sliding_traction"] * strip.load * across * weight
        power += drag * sliding
        force += drag
    assert found.power == pytest.approx(power, rel=0.03)
    assert abs(force) < 0.02 * found.power / found.speed


def test_the_sliding_is_in_power_flash_and_scatter(bearing):
    contact = bearing.found.contacts[INNER]
    one = run_contact(bearing, contact)
    assert one.power == pytest.approx(one.rolling_power + one.sliding.power, rel=1e-9)
    assert one.slid == pytest.approx(contact.load * one.sliding.speed)
    down, up = one.scatter
    assert 0.02 < down * one.slid / one.sliding.power < 0.5
    assert 0.02 < up * one.slid / one.sliding.power < 0.5
    heat = one.sliding.power / (2 * contact.hertz(bearing.modulus).semi_axes[1])  # mean over the strips
    effusivity = math.sqrt(46.0 * 7800.0 * 470.0)
    mean = heat / (effusivity * math.sqrt(contact.mean_speed * 2 * contact.half_width(bearing.modulus)))
    assert mean / 2 < one.flash < 3 * mean
    rough = load_element(DEEP_GROOVE | {"rms_roughness": "200 nm"})
    touching = run_contact(rough, rough.found.contacts[INNER])
    share = touching.asperity_share
    assert share > 0.05
    mixed = friction_power(rough, [touching]).with_asperities / friction_power(rough, [touching]).film
    sliding = (1 - share) * touching.sliding.power + 0.12 * share * touching.slid
    assert mixed == pytest.approx((touching.rolling_power + sliding) / touching.power)


def test_oil_films_have_about_half_of_the_usual_friction_moment(bearing):
    """The usual estimate, a mean of measurements, has cage, churning and seals besides."""
    power = friction_power(bearing, run_all(bearing, most=4))
    assert 0.25 < power.film / bearing.model.speed / usual_ball_moment(bearing.model.load, bearing.model.bore) < 0.9
    assert power.within_contacts > power.film - power.within_contacts
    said = dict(answer(bearing, run_all(bearing, most=2)))
    assert "highest flash temperature of sliding within the contact" in said["temperatures"]


def test_cold_stress_is_that_of_the_oil(bearing):
    """Without a temperature the law has the oil's own."""
    oil = bearing.model.oil.build()
    pressure, sliding = np.full(3, 1e9), np.array([-0.1, 0.0, 0.2])
    stress = film_stress(oil, 3e-7, None)(pressure, sliding)
    assert stress == pytest.approx(oil.shear_stress(oil.viscosity_at(pressure) * sliding / 3e-7, pressure))
    assert film_stress(oil, 3e-7, oil.temperature)(pressure, sliding) == pytest.approx(stress, rel=1e-6)
