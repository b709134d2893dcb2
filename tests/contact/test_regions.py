"""Spots of contact against a walk from cell to cell, and what they hold."""

import tracemalloc

import numpy as np
import pytest

from bem import Grid, generate_surface
from bem.contact.regions import count_spots, label_spots, narrow_share

pytestmark = pytest.mark.internal


def walked(inside, periodic):
    """Numbers of spots in the order of their first cells, by walking to every neighbour."""
    labels, count = np.zeros(inside.shape, int), 0
    for first in np.argwhere(inside):
        if labels[tuple(first)]:
            continue
        count += 1
        waiting = [tuple(first)]
        while waiting:
            cell = waiting.pop()
            if not inside[cell] or labels[cell]:
                continue
            labels[cell] = count
            for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
                there = list(cell)
                there[axis] += step
                if periodic[axis]:
                    there[axis] %= inside.shape[axis]
                if 0 <= there[axis] < inside.shape[axis]:
                    waiting.append(tuple(there))
    return labels


def test_spots_hang_together_through_sides_and_round_a_periodic_grid():
    pressure = np.array(
        [
            [1, 1, 0, 0, 2],
            [0, 0, 3, 0, 0],
            [0, 3, 3, 0, 4],
            [5, 0, 0, 0, 4],
        ],
        dtype=float,
    )
    counts = {(False, False): 5, (True, False): 3, (False, True): 3, (True, True): 2}
    for periodic, count in counts.items():
        assert count_spots(pressure, Grid((4, 5), (1.0, 1.0), periodic=periodic)) == count
    assert count_spots(np.zeros((3, 3)), Grid((3, 3), (1.0, 1.0))) == 0


@pytest.mark.parametrize("periodic", [(False, False), (True, False), (False, True), (True, True)])
def test_spots_are_those_of_a_walk(periodic):
    """From single cells to holes; at six cells in ten spots just begin to reach from side to side."""
    rng = np.random.default_rng(0)
    for shape in ((1, 1), (1, 9), (9, 1), (2, 2), (17, 23), (40, 31)):
        for share in (0.1, 0.5, 0.6, 0.9, 1.0):
            pressure = np.where(rng.random(shape) < share, 1.0, 0.0)
            grid, expected = Grid(shape, (1.0, 1.0), periodic=periodic), walked(pressure > 0, periodic)
            assert np.array_equal(label_spots(pressure, grid), expected)
            assert count_spots(pressure, grid) == expected.max()


def test_spots_hold_no_field():
    """Eight bytes a run: half a cell's where every second cell touches. A field of numbers was eight, with one of what
    touches nine, for a contact of any area."""
    grid = Grid((512, 512), (1.0, 1.0), periodic=(True, True))
    heights = generate_surface(grid, rms_height=1.0, seed=1, hurst=0.8, cutoff_wavelength=8.0)
    rough = np.maximum(heights - np.quantile(heights, 0.75), 0.0)
    chequered = np.indices(grid.shape).sum(axis=0) % 2 * 1.0
    for pressure, most in ((rough, 1.0), (chequered, 4.1)):
        assert count_spots(pressure, grid) > 10
        tracemalloc.start()
        try:
            count_spots(pressure, grid)
            assert tracemalloc.get_traced_memory()[1] < most * grid.cells
        finally:
            tracemalloc.stop()


@pytest.mark.parametrize("wraps", [(False, False), (True, True)])
def test_spots_of_one_or_two_cells_are_told_from_wider_ones(wraps):
    touching = np.zeros((12, 12), dtype=bool)
    touching[2:5, 2:5] = True  # nine cells, one of them inside
    assert narrow_share(touching, wraps) == 0.0
    touching[8, 2:11] = True  # nine cells in a row
    assert narrow_share(touching, wraps) == pytest.approx(0.5)
    touching[2:5, 2:5] = False
    touching[0, 0:3] = touching[1, 1] = touching[11, 1] = True  # a cross over the seam
    assert narrow_share(touching, wraps) == pytest.approx(9 / 14 if wraps[0] else 1.0)
