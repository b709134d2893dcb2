"""Balls under radial and axial load: closed equation of an axial load, radial share, energy; lives by X and Y."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq, minimize

from bem import InputError
from bem.elements.ball_load import share_with_axial_load
from bem.elements.bearing_life import bearing_life
from bem.elements.element import load_element
from bem.elements.rating_life import BearingGeometry, axial_factors, equivalent_load, static_rating
from bem.elements.rolling_bearing import share

COUNT, STIFFNESS, DISTANCE, CLEARANCE = 9, 1e10, 0.5e-3, 12e-6
ANGLES = 2 * math.pi * np.arange(COUNT) / COUNT
GIVEN = {"stiffness": STIFFNESS, "centre_distance": DISTANCE, "clearance": CLEARANCE, "angles": ANGLES}
STEEL = "steel-52100"
BEARING = {
    "element": "rolling-bearing", "bore": "40 mm", "outside": "80 mm", "diameter": "11.9 mm", "count": 9,
    "radial_load": "4 kN", "axial_load": "2 kN", "clearance": "10 um", "speed": "3000 rpm", "first": STEEL,
    "second": STEEL, "oil": {"grade": "ISO VG 68", "temperature": "70 degC"},
}  # fmt: skip


def test_forces_balance():
    found = share_with_axial_load(4e3, 2e3, **GIVEN)
    across = found.loads * np.cos(found.contact_angles)
    assert np.sum(across * np.cos(ANGLES)) == pytest.approx(4e3, rel=1e-9)
    assert np.sum(found.loads * np.sin(found.contact_angles)) == pytest.approx(2e3, rel=1e-9)


def test_without_axial_load_it_is_the_radial_share():
    found = share_with_axial_load(4e3, 0.0, **GIVEN)
    assert found.loads == pytest.approx(share(4e3, STIFFNESS, 1.5, CLEARANCE, ANGLES.tolist()), rel=1e-8, abs=1e-6)
    assert not found.contact_angles.any()


def test_an_axial_load_alone_has_the_contact_angle_of_its_closed_equation():
    """F_a / (Z K A^1.5) = sin(a) (cos(a0) / cos(a) - 1)^1.5, cos(a0) = 1 - c / 2A: Harris and Kotzalas, ch. 7."""
    free = math.acos(1 - CLEARANCE / (2 * DISTANCE))
    scale = 5e3 / (COUNT * STIFFNESS * DISTANCE**1.5)
    angle = brentq(lambda a: math.sin(a) * max(math.cos(free) / math.cos(a) - 1, 0.0) ** 1.5 - scale, free, 1.5)
    found = share_with_axial_load(1e-3, 5e3, **GIVEN)
    assert found.contact_angles == pytest.approx(angle, rel=1e-5)
    assert found.loads == pytest.approx(5e3 / COUNT / math.sin(angle), rel=1e-5)


def test_shifts_are_the_minimum_of_the_potential_energy():
    def energy(shifts):
        distance = np.hypot(DISTANCE - 0.5 * CLEARANCE + 1e-6 * shifts[0] * np.cos(ANGLES), 1e-6 * shifts[1])
        pressed = np.maximum(distance - DISTANCE, 0.0)
        return float(0.4 * STIFFNESS * np.sum(pressed**2.5) - 1e-6 * (4e3 * shifts[0] + 1e3 * shifts[1]))

    found = share_with_axial_load(4e3, 1e3, **GIVEN)
    least = minimize(energy, [20.0, 60.0], method="Nelder-Mead", options={"xatol": 1e-7, "fatol": 1e-14})
    assert least.x == pytest.approx([1e6 * found.radial_shift, 1e6 * found.axial_shift], rel=1e-4)


def test_the_axial_factors_are_those_of_the_table():
    """f_0 F_a / C_0 = 1.03 has Y = 1.55; below and above the table its ends."""
    bearing = BearingGeometry("ball", 11.9e-3, 60e-3, 9)
    factor = static_rating(bearing) / (9 * 11.9**2)
    assert factor == pytest.approx(14.0, abs=0.2)  # ISO 76 at gamma = 0.198
    for step, value in ((1.03, 1.55), (6.89, 1.0), (1e-3, 2.3), (50, 1.0)):
        assert axial_factors(step * 19e3 / factor, 19e3, bearing) == pytest.approx((0.56, value))
    assert equivalent_load(4e3, 2e3, (0.56, 1.5)) == pytest.approx(5240)
    assert equivalent_load(4e3, 100.0, (0.56, 1.5)) == 4e3


@pytest.mark.parametrize("axial", ["0.5 kN", "1 kN", "2 kN", "4 kN", "8 kN"])
def test_the_equivalent_load_agrees_with_the_internal_distribution(axial):
    """Two ways to one life: X and Y of the table, and the loads of all balls. Under an axial load alone, at a normal
    clearance, they are a tenth apart (clearance from 0 to 20 um alone changes the load by 15 %). Under both loads the
    straight lines of X and Y lie above the curve that they stand for, up to a fifth."""
    alone = bearing_life(load_element(BEARING | {"axial_load": axial, "radial_load": "1 N"}))
    assert alone.rating.load == pytest.approx(alone.reference.load, rel=0.1)
    both = bearing_life(load_element(BEARING | {"axial_load": axial}))
    assert 0.8 * both.rating.load < both.reference.load < 1.05 * both.rating.load


def test_contacts_lean_and_have_the_curvature_of_their_angle():
    element = load_element(BEARING)
    loads = element.model.ball_loads
    inner = element.found.contacts[0]
    angle = float(loads.contact_angles[0])
    assert 5 < math.degrees(angle) < 20
    assert inner.radii[0] == pytest.approx(0.5 * (60e-3 / math.cos(angle) - 11.9e-3), rel=1e-12)
    assert inner.load == pytest.approx(loads.loads[0])
    gamma = 11.9 / 60 * math.cos(angle)
    assert inner.speeds[0] == pytest.approx(0.25 * element.model.speed * 60e-3 * (1 - gamma**2), rel=1e-12)
    assert "contact angles" in " ".join(element.found.geometry)


def test_an_axial_load_shortens_life_and_factors_of_a_catalogue_win():
    lives = [bearing_life(load_element(BEARING | {"axial_load": axial})).reference.basic for axial in ("2 kN", "4 kN")]
    without = bearing_life(load_element(BEARING | {"axial_load": "0 N"})).reference.basic
    assert without > lives[0] > lives[1]
    given = bearing_life(load_element(BEARING | {"axial_factors": [0.56, 1.6]}))
    assert given.rating.load == pytest.approx(0.56 * 4e3 + 1.6 * 2e3)
    assert given.static_load == pytest.approx(4e3)


def test_axial_loads_that_are_not_modelled_are_refused():
    rollers = {"rolling": "roller", "length": "11 mm", "diameter": "11 mm", "count": 14}
    with pytest.raises(InputError, match="axial_load of a roller bearing"):
        load_element(BEARING | rollers)
    plain = {key: value for key, value in BEARING.items() if key != "radial_load"}
    with pytest.raises(InputError, match="axial_load beside hertz_pressure"):
        load_element(plain | {"hertz_pressure": "1 GPa"})
    with pytest.raises(InputError, match="axial_factors without axial_load"):
        load_element(BEARING | {"axial_load": "0 N", "axial_factors": [0.56, 1.6]})
