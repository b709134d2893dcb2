"""Catalogued profiles: two sources of one rail agree, pieces meet, radii are those of the arcs."""

import math

import numpy as np
import pytest

from bem.errors import InputError
from bem.profiles import catalogued_profile
from bem.profiles.catalogue import PROFILE_NAMES


def test_the_inclined_60e1_is_nearly_rail_a_of_en15302():
    """Heads from two sources, arcs of the same radii, which meet elsewhere: 0.04 mm along the normal, 0 at the top."""
    tilt = math.atan(1 / 20)
    rail, inclined = catalogued_profile("en15302-rail-a"), catalogued_profile("60e1").turned(-tilt)
    right = 17.5966e-3 - 300e-3 * math.sin(tilt)  # by the centres of the arcs of 300 mm
    down = 299.48349e-3 - 300e-3 * math.cos(tilt)
    places = np.linspace(-32e-3, 38.6e-3, 300)
    one = rail.parameter_where((1.0, 0.0), places)
    two = inclined.parameter_where((1.0, 0.0), places - right)
    dy, dz = rail.slope_at(one)
    apart = (inclined.at(two)[1] + down - rail.at(one)[1]) * dy / np.hypot(dy, dz)
    assert np.abs(apart).max() < 45e-6
    assert np.abs(apart[np.abs(places - 3e-3) < 7e-3]).max() < 1e-9


@pytest.mark.parametrize(
    ("name", "place", "radius"),
    [
        ("60e1", 0.0, 300.0),
        ("60e1", 18.0, 80.0),
        ("60e1", -31.0, 13.0),
        ("en15302-wheel-a", -33.0, 14.0),
        ("en15302-wheel-a", 5.0, 345.0),
        ("s1002", -36.5, 13.0),
    ],
)
def test_arcs_have_their_radii(name, place, radius):
    profile = catalogued_profile(name)
    s = profile.parameter_where((1.0, 0.0), np.array([1e-3 * place]))
    assert abs(float(profile.curvature(s)[0])) * 1e-3 * radius == pytest.approx(1, rel=2e-3)


@pytest.mark.parametrize("name", PROFILE_NAMES)
def test_pieces_meet_without_a_kink(name):
    """The direction turns by no more than an arc of 8 mm turns it between points; wheel A has a chamfer."""
    profile = catalogued_profile(name)
    y, z = profile.at(profile.knots)
    if name == "en15302-wheel-a":
        y, z = y[y < 29.9e-3], z[y < 29.9e-3]
    direction = np.unwrap(np.arctan2(np.diff(z), np.diff(y)))
    assert np.abs(np.diff(direction)).max() < 0.21 / 8
    assert abs(float(profile.at(profile.parameter_where((1.0, 0.0), np.array([0.0])))[1][0])) < 1e-3


def test_unknown_names_are_refused():
    with pytest.raises(InputError, match="allowed: 60e1"):
        catalogued_profile("60e9")
