"""Maximum pressure of a contact, between the centres of cells.

The square of the pressure is smooth up to the boundary of contact (a paraboloid in Hertz contact), so its maximum is
that of a paraboloid through the highest cell and its neighbours. Where p is smooth everywhere, pressures constant on
cells would be p - (dx^2 p_xx + dy^2 p_yy) / 24. The boundary of contact, where p is not smooth, reduces this correction
in proportion; three fifths of it are applied, which leaves no mean error on balls.

No correction is applied to spots of fewer than 1.5 cells per radius. Spots of one cell, cells at the hardness, the ends
of punches and free edges of the grid return the highest cell. Part of step 12 of `bem.contact`. Verified in
tests/contact/test_peak_pressure.py.
"""

from __future__ import annotations

import math

import numpy as np

from bem.grid import FloatArray, Grid
from bem.numerics.subcell import around, top

_SMOOTH = 0.6
"""Fraction of the correction of an everywhere smooth pressure."""

_LEAST_RADIUS = 1.5
"""Cells per radius of the osculating ball below which nothing is corrected."""


def highest_pressure(pressure: FloatArray, grid: Grid, hardness: float = math.inf) -> float:
    """Return the maximum of a pressure (nx, ny) on cells, or on waves if doubly periodic; at most the hardness [Pa]."""
    place = divmod(int(np.argmax(pressure)), pressure.shape[1])
    highest = float(pressure[place])
    patch = around(pressure, grid, place)
    if patch is None or highest <= 0:
        return highest
    rows: list[list[float]] = patch.tolist()
    below, above, left, right = rows[0][1], rows[2][1], rows[1][0], rows[1][2]
    if min(below, above, left, right) <= 0 or max(map(max, rows)) >= hardness:
        return highest
    squares = (patch / highest) ** 2
    if min(map(min, rows)) <= 0:  # outside contact the square is no paraboloid: ignore the corners
        squares[::2, ::2] = 0.0
    found = top(squares)
    if found is None:
        return highest
    bend = 0.0 if all(grid.periodic) else below + above + left + right - 4 * highest
    if -bend * _LEAST_RADIUS**2 > 2 * highest:
        bend = 0.0
    return min(highest * math.sqrt(found) + _SMOOTH * bend / 24, hardness)
