"""Figures of a finished wear loop: strips, what is worn in them, sizes over cycles."""

import math

import numpy as np
import pytest

from bem.grid import FloatArray, Grid
from bem.kinds.wear.errors import bars
from bem.kinds.wear.solve import wear_down
from bem.scenes import library
from bem.scenes.context import PlainContext
from bem.scenes.kind import get_kind
from bem.scenes.load import load_scene
from bem.wear.outcome import (
    contact_strip,
    drift,
    hertz_fraction,
    rms_error,
    share_outside,
    sizes_over_cycles,
    strip_wear,
    track_of,
    width_of,
)
from bem.wear.state import PARTICLE_FIELDS

pytestmark = pytest.mark.internal


@pytest.mark.parametrize("half_width", [0.1, 1.0, 1.7, 3.0])
def test_hertz_strip_is_as_wide_as_the_contact(half_width):
    # loads of a few millinewtons on the thesis' grid: no cell's centre is within the contact, and the mean was NaN
    strip = hertz_fraction(Grid((8, 8), (1.0, 1.0)), (half_width, math.inf))
    assert strip.sum() == pytest.approx(2 * half_width, rel=1e-14)
    assert (strip == strip[::-1]).all()


def wavy(cells: int) -> tuple[FloatArray, Grid]:
    grid = Grid((cells, cells), (1.0 / cells, 1.0 / cells))
    x, y = grid.x[:, None], grid.y[None, :]
    return np.sin(20 * x + 1) + np.cos(17 * x) * np.sin(2 * np.pi * y) + 2 * x, grid


@pytest.mark.parametrize("half_axes", [(0.2637, math.inf), (0.2637, 0.18)])
def test_roughness_of_hertz_contact_converges_and_its_error_is_told(half_axes):
    fine, there = wavy(2048)
    exact = strip_wear(fine, fine, hertz_fraction(there, half_axes)).rms_before
    errors, told = [], []
    for cells in (32, 38, 44, 50, 64, 76, 88, 100):
        heights, grid = wavy(cells)
        errors.append(abs(strip_wear(heights, heights, hertz_fraction(grid, half_axes)).rms_before - exact))
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


def worn_cylinder(cells: int):
    """Worn depth and Sq of a cylinder's scar [m], its width over the grid's, and the error bars of a loop."""
    table = library()["wear-cylinder-scar"]
    table["domain"] = {"cells": [cells, 2], "lengths": ["600 um", "4 um"], "periodic": "y"}
    table["cycles"] = {"count": 40, "settled": 4}
    table["wear"]["criterion"] = table["wear"]["criterion"] | {"distance": "535 mm"}
    scene = get_kind("wear").resolved(load_scene(table))
    flat = (np.zeros((cells, 2)), np.zeros((cells, 2)))
    found = wear_down(scene, flat, PlainContext(0))
    of_each = bars(scene, flat, found).values
    return np.array([found.worn_depth, found.Sq_final, found.contact_area_fraction]), of_each


def test_scar_of_archard_wear_converges_with_the_grid():
    """Whole rows made the mean depth over the scar jump by 8 % from 48 to 52 cells, and bars missed that."""
    reference, _ = worn_cylinder(480)
    errors, covered = [], []
    for cells in (36, 40, 44, 48, 52, 60, 72, 96, 128, 160, 240):
        found, bars = worn_cylinder(cells)
        errors.append(np.abs(found / reference - 1))
        told = [bars["worn_depth"], bars["Sq_final"], bars["contact_area_fraction"]]
        covered.append(np.array(told) >= np.abs(found - reference))
    rms = np.array([np.sqrt(np.mean(np.square(part), axis=0)) for part in (errors[:4], errors[-4:])])
    # measured: 0.3, 0.7 and 0.1 % on 36 to 48 cells, 0.07, 0.16 and 0.02 % on 96 to 240
    assert (rms[0] < [0.004, 0.01, 0.003]).all()
    assert (rms[1] < [0.001, 0.003, 0.0005]).all()
    # 3.4 times finer: of first order at least
    assert (rms[0] > 3 * rms[1]).all()
    assert np.mean(covered) >= 0.9
    # a flat as wide as Archard's law makes it, 2 a^3 / 3 R = k s load / width, and a little by elasticity
    assert 600e-6 * reference[2] == pytest.approx(2 * (1.5 * 5e-3 * 1e-15 * 40 * 0.535 * 5e4) ** (1 / 3), rel=0.01)


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


def test_the_share_of_the_volume_outside_a_strip_and_its_width():
    grid = Grid((4, 2), (1e-6, 2e-6), periodic=(True, True))
    depth = np.array([[1.0, 1.0], [3.0, 3.0], [0.0, 0.0], [0.0, 0.0]])
    strip = np.array([0.0, 1.0, 0.5, 0.0])
    assert share_outside(depth, np.zeros_like(depth), strip) == pytest.approx(0.25)
    assert share_outside(depth, depth, strip) == 0.0
    assert width_of(strip, grid) == pytest.approx(1.5e-6)
    assert width_of(np.array([[0.5, 0.0]]), grid) == pytest.approx(1e-6)  # of a track
    assert width_of(np.ones((1, 1)), grid) is None


def test_the_track_of_a_cylinder_is_the_whole_grid():
    """Fractions of 1 - 1e-16 made its width one cell along y, and a contact narrower than a cell left wear outside."""
    grid = Grid((24, 6), (0.1e-6, 16.25e-6))
    for half_width in (1.0e-6, 0.97e-6, 0.03e-6):
        track = track_of(hertz_fraction(grid, (half_width, math.inf)))
        assert width_of(track, grid) is None
        assert share_outside(np.ones(grid.shape), np.zeros(grid.shape), track) == 0.0
    assert width_of(np.full(24, 1 - 1e-15), grid) is None
    narrow = track_of(hertz_fraction(Grid((24, 24), (0.1e-6, 0.1e-6)), (0.8e-6, 0.5e-6)))
    assert narrow.shape == (1, 24)
    assert width_of(narrow, Grid((24, 24), (0.1e-6, 0.1e-6))) == pytest.approx(1.0e-6, rel=1e-2)
