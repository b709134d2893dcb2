"""Where a surface is sharp: at a step, a ridge or a tip that touches, pressure has no limit, whatever the cell.

Johnson, *Contact Mechanics* (1985), section 2.8 and 5.1-5.2: under a punch the pressure goes like the inverse root of
the distance from its edge, under a wedge or a cone like its logarithm. Two grids do not show it: what the logarithm
adds from one to the next is a few per cent. Heights do: of a smooth surface second differences change from cell to
cell, of a sharp one they stand alone. Knows no contact but its pressure. Verified in tests/accuracy/test_sharp.py.
"""

from __future__ import annotations

import math

import numpy as np

from bem.grid import FloatArray, Grid

_STEP, _STEPS = 5.0, 0.25
"""An edge is sharp where the undeformed gap changes by so many times what it does on both sides; a contact has sharp
edges where that holds for this share of all edges (by chance on a surface of white noise: 0.05)."""
_ALONE, _UNUSUAL = 5.0, 8.0
"""A kink is where a second difference is so many times those two cells away on both sides, and so many times what three
cells in four of the grid are below: the largest of 20 surfaces of 64 x 64 cells with waves of four and more was 7."""
_UNUSUAL_TIP = 4.5
"""The same where second differences along both axes stand alone in one cell: under a tip. A cone's fall like the
inverse distance, so that few cells have few that are small: of 300 cones with their tip anywhere in the middle the
least was 4.9, 6.4 and 9.6 times them on 12, 16 and 24 cells a side; of 1200 surfaces of 12 to 32 cells with waves of
two and more the largest was 3.4, of 60 of 64 cells 3.5."""
_FINER = 4.0
"""Kinks count whose pressure may pass the highest one's on cells so many times finer, which bars are judged by."""
_ROUND_OFF = 1e-9
"""Of the gap's range: below it second differences say nothing."""


def is_sharp(undeformed: FloatArray, pressure: FloatArray, grid: Grid, modulus: float = math.inf) -> bool:
    """Whether a contact with that undeformed gap [m] and pressure [Pa] (both nx, ny) ends at steps or touches at kinks.

    modulus : contact modulus of the bodies for waves of two cells [Pa], which says how far pressures at kinks may rise;
        infinite, all kinks count.
    """
    return _ends_at_steps(undeformed, pressure, grid) or _touches_at_kinks(undeformed, pressure, grid, modulus)


def _ends_at_steps(undeformed: FloatArray, pressure: FloatArray, grid: Grid) -> bool:
    inside = pressure > 0
    edges, sharp = 0, 0
    for axis in (0, 1):
        if grid.shape[axis] < 4:
            continue
        steps = np.moveaxis(np.abs(np.diff(undeformed, axis=axis)), axis, 0)
        ends = np.moveaxis(np.diff(inside.astype(np.int8), axis=axis) != 0, axis, 0)[1:-1]
        edges += int(ends.sum())
        sharp += int((ends & (steps[1:-1] > _STEP * np.maximum(steps[:-2], steps[2:]))).sum())
    return sharp > _STEPS * edges


def _touches_at_kinks(undeformed: FloatArray, pressure: FloatArray, grid: Grid, modulus: float) -> bool:
    """Whether there are kinks that may have the highest pressure. Johnson: a wedge of slope t has E* t/pi arcosh(a/x),
    a cone E* t/2 arcosh(a/r); slopes change by 2 t there, in a cell or two."""
    inside, missing = pressure > 0, float(pressure.max()) - pressure
    rise = modulus * math.log(_FINER)
    ridges: list[FloatArray] = []
    round_off = _ROUND_OFF * float(np.ptp(undeformed))
    over: list[FloatArray] = []
    for axis in (0, 1):
        n = grid.shape[axis]
        if n < 8:
            continue
        # across a free edge of the grid nothing follows; no contact that has bars reaches it
        bend = np.roll(undeformed, 1, axis) - 2 * undeformed + np.roll(undeformed, -1, axis)
        if not grid.periodic[axis]:
            np.moveaxis(bend, axis, 0)[[0, -1]] = 0.0
        size = np.abs(bend)
        beside = np.maximum(np.roll(size, 2, axis), np.roll(size, -2, axis))
        usual = max(float(np.quantile(size, 0.75)), round_off / _UNUSUAL)
        if not usual > 0:  # flat
            continue
        # towards the other body: what is grooved bears nothing
        alone = inside & (bend > _ALONE * beside)
        next_to = np.maximum(np.roll(bend, 1, axis), np.roll(bend, -1, axis))
        turns = np.where(alone, (bend + np.maximum(next_to, 0.0)) / grid.spacing[axis], 0.0)
        reached = np.full(turns.shape, math.inf) if math.isinf(rise) else rise * turns
        over.append(np.where(alone & (reached / 4 >= missing), bend / usual, 0.0))
        ridges.append(np.where(alone & (reached / (2 * math.pi) >= missing), bend / usual, 0.0))
    ridge = any(bool((each > _UNUSUAL).any()) for each in ridges)
    return ridge or (len(over) == 2 and bool((np.minimum(*over) > _UNUSUAL_TIP).any()))
