"""What few positions leave open of heights and of films over them, against many draws and against all offsets."""

from dataclasses import replace

import numpy as np
import pytest

from bem import Grid, generate_surface
from bem.life.march import ROW, LifeState
from bem.life.positions import Passing, PositionContact
from bem.life.sampling import missed_ratio, missed_roughness
from bem.life.surfaces import Surfaces
from bem.wear import ContactStart

pytestmark = pytest.mark.internal

GRID = Grid((48, 16), (1e-6, 1e-6), periodic=(True, True))
RNG = np.random.default_rng(5)
NONE = np.zeros((48, 1))


def rough(seed, rms):
    return generate_surface(GRID, rms_height=rms, seed=seed, correlation_length=3e-6)


def life(first, heights, pressures):
    """A state whose last round pressed so, position by position, and wore the lower body from `first` to `heights`."""
    contacts = tuple(
        PositionContact(p, 0.1, 0.1, 0.0, 1.0, 0.1, 0.0, 0.0, 0.0, ContactStart(), NONE) for p in pressures
    )
    upper = np.zeros(GRID.shape)
    row = dict.fromkeys(ROW, 0.0) | {"lower_depth": float((first - heights).mean())}
    return LifeState(
        1.0,
        1.0,
        Surfaces((heights, upper), None, ()),
        (first, upper),
        np.array([list(row.values())]),
        contacts=contacts,
    )


def test_the_scatter_of_draws_is_what_is_said_of_each():
    """Positions drawn at random from pressures on the tips of a surface and another's, 200 times: the rms of the
    roughness less that of endless positions is 0.72 of what is said, a sum of imprint and standard error."""
    first = rough(1, 200e-9)
    offered = [np.maximum(first + rough(10 + k, 300e-9) - 150e-9, 0.0) for k in range(120)]
    mean = np.mean(offered, axis=0)
    depth = 60e-9 / mean.mean()
    endless = (first - depth * mean).std()
    off, said = [], []
    for _ in range(200):
        pressures = [offered[k] for k in RNG.choice(120, 5, replace=False)]
        worn = first - depth * np.mean(pressures, axis=0)
        off.append(worn.std() - endless)
        # the lower body rests: rows face where they are
        said.append(missed_roughness(life(first, worn, pressures), Passing(5, (False, True)))[0])
    ratio = np.sqrt(np.mean(np.square(off)) / np.mean(np.square(said)))
    print(ratio, np.mean(np.abs(off) <= said))
    assert 0.6 < ratio < 0.85
    assert np.mean(np.abs(off) <= said) > 0.8


def test_pressures_go_to_the_rows_that_were_under_them():
    """The same round seen from a body that rests and from one that passes has the same covariances."""
    heights = rough(2, 100e-9)
    passing = Passing(4, (True, True))
    pressures = [np.maximum(rough(30 + k, 1e9), 0.0) for k in range(4)]
    moved = [low for low, _ in passing.offsets((48, 48))]
    rests = life(heights + 1e-8, heights, pressures)
    passing_body = life(
        heights + 1e-8, heights, [np.roll(p, shift, 0) for p, shift in zip(pressures, moved, strict=True)]
    )
    one = missed_roughness(rests, Passing(4, (False, True)))[0]
    assert one == pytest.approx(missed_roughness(passing_body, passing)[0], rel=1e-12, abs=0)
    assert one > 0


def test_films_over_roughness_are_averaged_over_all_offsets():
    lower, upper = rough(3, 100e-9), rough(4, 100e-9)
    end = life(lower, lower, [np.ones(GRID.shape)] * 6)
    end = replace(end, first=(lower, upper), surfaces=Surfaces((lower, upper), None, ()))
    passing = Passing(6, (False, True))

    def inverse(offsets):
        return np.mean([1 / (lower + np.roll(upper, shift, 0)).std() for shift in offsets])

    exact = abs(inverse(range(48)) / inverse(range(0, 48, 8)) - 1)
    assert exact > 1e-3
    assert missed_ratio(end, passing) == pytest.approx((exact, exact), rel=1e-9)


def test_a_single_position_says_nothing_of_heights():
    flat = np.zeros(GRID.shape)
    end = life(flat + 1e-9, flat, [np.ones(GRID.shape)])
    assert missed_roughness(end, Passing(1, (True, True))) is None
    assert missed_ratio(end, Passing(1, (True, True))) == (0.0, 0.0)
