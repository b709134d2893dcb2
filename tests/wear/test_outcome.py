"""Figures of a finished wear loop: strips, what is worn in them, sizes over cycles."""

import math

import numpy as np
import pytest

from bem.grid import FloatArray, Grid
from bem.wear.outcome import contact_strip, drift, hertz_area, rms_error, sizes_over_cycles, strip_wear
from bem.wear.state import PARTICLE_FIELDS


@pytest.mark.parametrize("half_width", [0.1, 1.0, 1.7, 3.0])
def test_hertz_strip_is_as_wide_as_the_contact(half_width):
    # loads of a few millinewtons on the thesis' grid: no cell's centre is within the contact, and the mean was NaN
    strip = hertz_area(Grid((8, 8), (1.0, 1.0)), (half_width, math.inf))
    assert strip.sum() == pytest.approx(2 * half_width, rel=1e-14)
    assert (strip == strip[::-1]).all()


def wavy(cells: int) -> tuple[FloatArray, Grid]:
    grid = Grid((cells, cells), (1.0 / cells, 1.0 / cells))
    x, y = grid.x[:, None], grid.y[None, :]
    return np.sin(20 * x + 1) + np.cos(17 * x) * np.sin(2 * np.pi * y) + 2 * x, grid


@pytest.mark.parametrize("half_axes", [(0.2637, math.inf), (0.2637, 0.18)])
def test_roughness_of_hertz_contact_converges_and_its_error_is_told(half_axes):
    fine, there = wavy(2048)
    exact = strip_wear(fine, fine, hertz_area(there, half_axes)).rms_before
    errors, told = [], []
    for cells in (32, 38, 44, 50, 64, 76, 88, 100):
        heights, grid = wavy(cells)
        errors.append(abs(strip_wear(heights, heights, hertz_area(grid, half_axes)).rms_before - exact))
        told.append(rms_error(heights, grid, half_axes))
    # whole cells at the edge are of first order, and 0.5 % off with these
    assert np.mean(errors[4:]) < 0.4 * np.mean(errors[:4])
    assert np.mean(errors) < 1.5e-3 * exact
    assert sum(t >= e for t, e in zip(told, errors, strict=True)) >= 7


def test_contact_strip_is_the_rows_that_touch_or_all():
    pressure = np.zeros((4, 3))
    assert contact_strip(pressure).all()
    pressure[2, 1] = 1e9
    assert contact_strip(pressure).tolist() == [0.0, 0.0, 1.0, 0.0]


def test_strip_wear_sees_the_strip_only():
    before = np.zeros((4, 2))
    before[1:3] = [[1.0, -1.0], [1.0, -1.0]]
    before[0] = 100.0
    after = before.copy()
    after[1:3, 0] -= 0.5  # the upper half of a square wave loses half its height
    strip = np.array([False, True, True, False])
    found = strip_wear(before, after, strip)
    # population deviation of +-1 and of 0.5, -1; round-off of four numbers
    assert (found.rms_before, found.rms_after) == pytest.approx((1.0, 0.75), rel=1e-14)
    assert found.depth == pytest.approx(0.25, rel=1e-14)


def test_sizes_over_cycles_count_each_cycle_by_volume():
    particles = np.zeros(3, PARTICLE_FIELDS)
    particles["cycle"] = [1, 1, 3]
    radii = np.array([1.0, 2.0, 5.0])
    particles["volume"] = 4 / 3 * np.pi * radii**3
    radius, number = sizes_over_cycles([1, 2, 3], particles)
    # mean radius by volume of 1 and 2: (1 + 16) / 9
    assert radius[[0, 2]] == pytest.approx([17 / 9, 5.0], rel=1e-14)
    assert np.isnan(radius[1])
    assert number.tolist() == [2, 0, 1]


def test_drift_tells_a_trend_from_scatter():
    rng = np.random.default_rng(3)
    scatter = rng.standard_normal(200)
    assert drift(0.14 * (1 + 0.001 * scatter)) is None  # within the tolerance
    assert drift(1 + 0.2 * scatter) is None  # scatters by more than the tolerance, but goes nowhere
    # 0.2 % a cycle: means of windows that lie 25 cycles apart
    assert drift(np.exp(0.002 * np.arange(200)) * (1 + 0.01 * scatter)) == pytest.approx(1 - np.exp(-0.05), abs=0.01)
    assert drift(np.linspace(2.0, 1.0, 4)) < -0.3  # of fewer cycles half against half
    assert drift([1.0, 0.9]) == pytest.approx(-0.1)
    assert drift([1.0]) is None
    assert drift(np.zeros(60)) is None
