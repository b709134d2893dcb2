"""ISO/TS 16281 comes back to (C / P)^p; tilt and profile do what elastic slices must."""

import math

import numpy as np
import pytest

from bem.elements.rating_life import (
    LINE_REDUCTION,
    BearingGeometry,
    dynamic_rating,
    life_modification_factor,
    roller_factor,
)
from bem.elements.reference_life import (
    SlicedRollers,
    ball_reference_life,
    edge_stress_factors,
    profile_drop,
    roller_reference_life,
    slice_rollers,
)
from bem.elements.rolling_bearing import share

MANY = 400
BALLS = BearingGeometry("ball", 0.4e-3, 60e-3, MANY)
ROLLERS = BearingGeometry("roller", 0.4e-3, 60e-3, MANY, length=0.8e-3)
NU208 = BearingGeometry("roller", 11e-3, 60e-3, 14, length=11e-3)
ANGLES = [2 * math.pi * i / MANY for i in range(MANY)]


@pytest.mark.parametrize("gamma", [0.05, 0.12, 0.25])
@pytest.mark.parametrize("load", [0.1, 1.0])
def test_many_balls_without_clearance_have_the_basic_life(gamma, load):
    """The constants of the single contacts are those of Sjovall's integrals: each in three digits."""
    bearing = BearingGeometry("ball", 60e-3 * gamma, 60e-3, MANY)
    rating = 3e4
    found = ball_reference_life(bearing, rating, share(load * rating, 1e9, 1.5, 0.0, ANGLES))
    assert found.basic == pytest.approx(1e6 * load**-3, rel=0.015)
    assert found.load == pytest.approx(load * rating, rel=5e-3)


@pytest.mark.parametrize("gamma", [0.05, 0.12, 0.25])
def test_many_evenly_loaded_rollers_outlive_the_basic_life(gamma):
    """By 0.83^-4: C counts an uneven load along the length, and here is none."""
    bearing = BearingGeometry("roller", 60e-3 * gamma, 60e-3, MANY, length=10e-3)
    rating, slices = 5e4, 40
    loads = np.outer(share(rating, 1e8, 10 / 9, 0.0, ANGLES), np.ones(slices)) / slices
    even = loads / edge_stress_factors(slices)
    found = roller_reference_life(bearing, rating, SlicedRollers(even, 10e-3))
    assert found.basic == pytest.approx(1e6 * LINE_REDUCTION**-4, rel=0.02)  # constants are for a power of 1.1


def test_clearance_shortens_life():
    lives = [
        ball_reference_life(BALLS, 3e4, share(3e3, 1e9, 1.5, clearance, ANGLES)).basic for clearance in (0, 2e-5, 1e-4)
    ]
    assert lives == sorted(lives, reverse=True)
    assert lives[2] < 0.7 * lives[0]


def test_slices_carry_the_load_and_are_symmetric():
    rollers = slice_rollers(NU208, 15e3, clearance=20e-6)
    angles = 2 * math.pi * np.arange(14) / 14
    assert (rollers.loads * np.cos(angles)[:, None]).sum() == pytest.approx(15e3, rel=1e-10)
    assert np.allclose(rollers.loads, rollers.loads[:, ::-1], rtol=1e-12)
    assert rollers.loads[0].sum() == rollers.loads.sum(axis=1).max()


def test_straight_rollers_share_as_palmgrens_do():
    """Power 10/9 and the share of the whole roller: only the stiffness differs, and it does not matter without
    clearance."""
    rollers = slice_rollers(NU208, 15e3, profiled=False)
    whole = share(15e3, 1.0, 10 / 9, 0.0, [2 * math.pi * i / 14 for i in range(14)])
    assert rollers.loads.sum(axis=1) == pytest.approx(whole, rel=1e-9, abs=1e-9)
    assert np.ptp(rollers.loads[0]) == pytest.approx(0, abs=1e-9)


def test_tilt_moves_load_to_one_end_and_shortens_life():
    rating = dynamic_rating(NU208)
    lives, ends = [], []
    for tilt in (0.0, 1e-3, 3e-3):
        rollers = slice_rollers(NU208, 10e3, tilt=tilt)
        found = roller_reference_life(NU208, rating, rollers)
        lives.append(found.basic)
        ends.append(found.highest_slice / found.mean_of_roller)
        mirrored = roller_reference_life(NU208, rating, slice_rollers(NU208, 10e3, tilt=-tilt))
        assert mirrored.basic == pytest.approx(found.basic, rel=1e-9)
    assert lives == sorted(lives, reverse=True)
    assert ends == sorted(ends)
    assert lives[2] < 0.5 * lives[0]


def test_the_profile_spares_the_ends():
    """Straight rollers have the factor at their ends, profiled ones hardly load these."""
    rating = dynamic_rating(NU208)
    straight, profiled = (
        roller_reference_life(NU208, rating, slice_rollers(NU208, 10e3, profiled=profiled)).basic
        for profiled in (False, True)
    )
    assert profiled > straight
    factors = edge_stress_factors(41)
    assert factors[0] > 2
    assert factors[20] == 1
    assert factors == pytest.approx(factors[::-1])


def test_the_profile_is_logarithmic_and_flat_in_the_middle_of_long_rollers():
    x = np.array([0.0, 2.5e-3])
    assert profile_drop(x, 10e-3, 10e-3) == pytest.approx([0, 3.5e-6 * math.log(1 / 0.75)])
    assert profile_drop(np.array([0.0, 4.9e-3]), 4e-3, 20e-3) == pytest.approx([0, 0])


def test_the_rating_of_rollers_follows_their_dimensions():
    """C grows with Z^(3/4), l^(7/9), D^(29/27) at one gamma."""
    base = dynamic_rating(ROLLERS)
    twice = BearingGeometry("roller", 0.8e-3, 120e-3, MANY, length=0.8e-3)
    assert dynamic_rating(twice) / base == pytest.approx(2 ** (29 / 27))
    assert base == pytest.approx(1.1 * roller_factor(0.4 / 60) * 0.8 ** (7 / 9) * MANY**0.75 * 0.4 ** (29 / 27))


def test_one_factor_for_all_slices_is_that_of_the_whole_bearing():
    rating, rollers = dynamic_rating(NU208), slice_rollers(NU208, 10e3, tilt=2e-3)
    found = roller_reference_life(NU208, rating, rollers)
    assert found.modified(lambda load: 3.0) == pytest.approx(3 * found.basic, rel=1e-12)
    assert found.modified(lambda load: None) is None


def test_evenly_loaded_slices_have_the_load_of_the_whole_bearing():
    loads = np.outer(share(5e3, 1e8, 10 / 9, 0.0, [2 * math.pi * i / 14 for i in range(14)]), np.ones(40)) / 40
    found = roller_reference_life(NU208, 5e4, SlicedRollers(loads / edge_stress_factors(40), 11e-3))
    assert found.slice_loads == pytest.approx(found.load, rel=1e-12)


def test_the_factor_of_every_slice_is_below_that_of_the_reference_load():
    """a_ISO falls with the load and more steeply than it, so that the loaded end decides; a slice without load does not
    fail."""
    rating, rollers = dynamic_rating(NU208), slice_rollers(NU208, 4e3, tilt=3e-3)
    found = roller_reference_life(NU208, rating, rollers)
    assert found.slice_loads.min() == 0
    assert found.slice_loads.max() > found.load

    def factor(load):
        return life_modification_factor("roller", viscosity_ratio=2.0, contamination=0.5, limit_over_load=6e3 / load)

    assert found.modified(factor) < factor(found.load) * found.basic
    assert found.modified(factor) > factor(found.slice_loads.max()) * found.basic
