"""The curve of starved line contacts against the integral over the whole gap, and its limits."""

import math

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

from bem.reference_solutions.starved_inlet import inlet_length, starved_film

RADIUS, HALF_WIDTH = 10e-3, 1e-4


def gap(distance):
    """Of Hertz' contact, at a distance before its edge [m]."""
    s = 1 + distance / HALF_WIDTH
    beyond = math.sqrt(s * s - 1)
    return HALF_WIDTH**2 / (2 * RADIUS) * (s * beyond - math.log(s + beyond))


def filled(thickness, distance):
    """Integral of H/(h + H)^3 over the inlet; d = z^2, next to the edge H goes like d^1.5."""
    return quad(lambda z: gap(z * z) / (thickness + gap(z * z)) ** 3 * 2 * z, 0, math.sqrt(distance), limit=400)[0]


def test_the_gap_is_as_wide_as_the_film_there():
    thickness = 1e-10  # the next term of the gap is of the order of distance over half-width
    assert gap(inlet_length(HALF_WIDTH, RADIUS, thickness)) == pytest.approx(thickness, rel=1e-3, abs=0)


@pytest.mark.parametrize("length", [0.05, 1.0, 6.0])
def test_film_over_inlet_is_the_integral_over_the_gap(length):
    """Of thin films, whose inlet is next to the edge: its length is 4e-4 of the contact here."""
    flooded = 1e-10
    inlet, reduction = starved_film(np.array([length]))
    distance = inlet[0] * inlet_length(HALF_WIDTH, RADIUS, flooded)
    goal = filled(flooded, 1e3 * inlet_length(HALF_WIDTH, RADIUS, flooded))
    film = brentq(lambda h: filled(h, distance) / goal - 1, 1e-5 * flooded, flooded, xtol=1e-18)
    assert film / flooded == pytest.approx(reduction[0], rel=2e-3)


def test_flooded_far_out_and_dry_at_the_edge():
    inlet, reduction = starved_film(np.geomspace(1e-4, 1e6, 300))
    assert (np.diff(reduction) > 0).all()
    assert (np.diff(inlet) > 0).all()
    assert reduction[-1] == pytest.approx(1, rel=1e-6)
    # G(t) -> t^2.5/2.5: film ~ t^1.875, inlet ~ t^2.25
    slope = np.log(reduction[1] / reduction[0]) / np.log(inlet[1] / inlet[0])
    assert slope == pytest.approx(1.875 / 2.25, rel=1e-3)
