"""Sharp surfaces: where a step, a ridge or a tip touches, the pressure has no limit, whatever the cell.

Under a punch the pressure goes like the inverse root of the distance from its edge, under a wedge or a cone like its
logarithm (Johnson, *Contact Mechanics* (1985), sections 2.8 and 5.1-5.2). Two grids do not show it: the logarithm adds
a few per cent from one to the next. Heights do: second differences of a smooth surface change from cell to cell, those
of a sharp one stand alone. Knows of a contact its pressure alone. Verified in tests/accuracy/test_sharp.py.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray, Grid
from bem.numerics.blocks import around, row_blocks

_STEP, _STEPS = 5.0, 0.25
"""Change of the undeformed gap over those on both sides, from which on an edge is sharp; and part of all edges of a
contact that are sharp in a sharp contact: on white noise 0.05 are, by chance."""
_ALONE, _UNUSUAL = 5.0, 8.0
"""Second difference over those two cells away on both sides, and over that which three cells in four of the grid are
below, from which on it is a kink: the largest of 20 surfaces of 64 x 64 cells with waves of four cells and more was
7."""
_UNUSUAL_TIP = 4.5
"""The same where second differences along both axes stand alone in one cell: a tip. A cone's fall like the inverse
distance, so that few of them are small: the least of 300 cones with their tip anywhere in the middle was 4.9, 6.4 and
9.6 on 12, 16 and 24 cells a side; the largest of 1200 surfaces of 12 to 32 cells with waves of two cells and more was
3.4, of 60 surfaces of 64 cells 3.5."""
_FINER = 4.0
"""Refinement on which the pressure of a kink may pass the highest one, for the kink to count: that by which error bars
are judged."""
_ROUND_OFF = 1e-9
"""Second difference over the gap's range below which it is rounding."""


def is_sharp(undeformed: FloatArray, pressure: FloatArray, grid: Grid, modulus: float = math.inf) -> bool:
    """Return True if a contact with an undeformed gap [m] and a pressure [Pa] (both nx, ny) ends at steps or touches at
    kinks.

    modulus : contact modulus of the bodies for waves of two cells [Pa]: it limits the rise of the pressure at kinks;
        with an infinite one all kinks count.
    """
    return _ends_at_steps(undeformed, pressure, grid) or _touches_at_kinks(undeformed, pressure, grid, modulus)


def _ends_at_steps(undeformed: FloatArray, pressure: FloatArray, grid: Grid) -> bool:
    edges, sharp = 0, 0
    for axis in (0, 1):
        n = grid.shape[axis]
        if n < 4:
            continue
        for first, last in row_blocks(grid.shape):
            place = np.arange(first, last) if axis == 0 else np.arange(n)
            steps = np.abs(np.diff(around(undeformed, axis, first, last, 2), axis=0))
            inside = around(pressure, axis, first, last, 1) > 0
            # from a cell to the next; at the ends of the axis one side is unknown
            ends = (inside[2:] != inside[1:-1]) & ((place > 0) & (place < n - 2))[:, None]
            edges += int(np.count_nonzero(ends))
            sharp += int(np.count_nonzero(ends & (steps[2:-1] > _STEP * np.maximum(steps[1:-2], steps[3:]))))
    return sharp > _STEPS * edges


class _Kinks(NamedTuple):
    """Cells where second differences along an axis stand alone, and the pressure of a tip may be the highest.

    cells : their numbers.
    bends : their second differences [m].
    ridges : True where the pressure of a ridge may be the highest, too.
    """

    cells: NDArray[np.int64]
    bends: FloatArray
    ridges: NDArray[np.bool_]


def _touches_at_kinks(undeformed: FloatArray, pressure: FloatArray, grid: Grid, modulus: float) -> bool:
    """Return True if kinks may have the highest pressure.

    A wedge of slope t has E* t/pi arcosh(a/x), a cone E* t/2 arcosh(a/r) (Johnson); slopes change by 2 t there, in a
    cell or two.
    """
    highest, tips = float(pressure.max()), []
    for axis in (0, 1):
        if grid.shape[axis] < 8:
            continue
        kinks = _kinks(undeformed, pressure, grid, axis, modulus * math.log(_FINER), highest)
        if kinks.cells.size == 0:
            continue
        usual = _usual_bend(undeformed, grid, axis)
        if not usual > 0:  # flat
            continue
        unusual = kinks.bends / usual
        if bool((unusual[kinks.ridges] > _UNUSUAL).any()):
            return True
        tips.append(kinks.cells[unusual > _UNUSUAL_TIP])
    return len(tips) == 2 and np.intersect1d(tips[0], tips[1]).size > 0


def _kinks(undeformed: FloatArray, pressure: FloatArray, grid: Grid, axis: int, rise: float, highest: float) -> _Kinks:
    """Return the kinks along an axis, whose pressure may rise by `rise` [Pa] times their change of slope."""
    found = []
    for first, last in row_blocks(grid.shape):
        bend = _bends(undeformed, grid, axis, first, last, 2)
        size = np.abs(bend)
        here, inside = bend[2:-2], np.moveaxis(pressure[first:last], axis, 0)
        # towards the other body: grooves bear nothing
        alone = np.nonzero((inside > 0) & (here > _ALONE * np.maximum(size[:-4], size[4:])))
        kink = here[alone]
        turn = kink + np.maximum(np.maximum(bend[1:-3][alone], bend[3:-1][alone]), 0.0)
        reached = np.full(turn.shape, math.inf) if math.isinf(rise) else rise * (turn / grid.spacing[axis])
        missing = highest - inside[alone]
        counts = reached / 4 >= missing
        row, column = alone[axis] + first, alone[1 - axis]
        found.append((row * grid.shape[1] + column, kink, reached / (2 * math.pi) >= missing, counts))
    parts = [tuple(each[counts] for each in more) for *more, counts in found]
    return _Kinks(*(np.concatenate(each) for each in zip(*parts, strict=True)))


def _bends(undeformed: FloatArray, grid: Grid, axis: int, first: int, last: int, reach: int) -> FloatArray:
    """Return second differences along an axis [m], which comes first, of some rows and `reach` cells on both sides.

    They are zero at a free edge of the grid, which no contact with error bars reaches.
    """
    near = around(undeformed, axis, first, last, reach + 1)
    bend = near[:-2] - 2 * near[1:-1] + near[2:]
    if not grid.periodic[axis]:
        n, begin = grid.shape[axis], first if axis == 0 else 0
        place = (np.arange(bend.shape[0]) + begin - reach) % n
        bend[(place == 0) | (place == n - 1)] = 0.0
    return bend


def _usual_bend(undeformed: FloatArray, grid: Grid, axis: int) -> float:
    """Return the third quartile of second differences along an axis, at least that of rounding [m]."""
    size = np.empty(grid.shape)
    for first, last in row_blocks(grid.shape):
        size[first:last] = np.moveaxis(np.abs(_bends(undeformed, grid, axis, first, last, 0)), 0, axis)
    usual = float(np.quantile(size.reshape(-1), 0.75, overwrite_input=True))
    return max(usual, _ROUND_OFF * float(np.ptp(undeformed)) / _UNUSUAL)
