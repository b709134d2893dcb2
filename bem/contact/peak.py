"""The highest pressure of a contact, between the centres of cells.

The square of the pressure is smooth up to the edge of contact (a paraboloid in Hertz' contact), so its top is that of a
paraboloid through the highest cell and its neighbours. Pressures that are constant on cells would be
p - (dx^2 p_xx + dy^2 p_yy) / 24 if p were smooth everywhere: the transform of a cell, sin(q dx / 2) / (q dx / 2), times
that of such values is that of p, the waves that cells add cancelling one another in pairs. The edge of contact, where p
is not smooth, gives some of it back, in proportion: two fifths of balls of 3 to 20 cells, half of cylinders, a third to
a half of rough contacts. Three fifths are taken; on balls of R cells no mean error stays, and 0.8 / R^2 % of scatter
from place to place.

Not corrected are spots of fewer than 1.5 cells to the radius: on waves of two to four cells that would be 4 % off
where a cell's pressure is 1.3 % off. Nothing is looked for in spots of a cell, at the hardness, at the end of a punch,
at a free edge of the grid; there the highest pressure is that of a cell.
"""

from __future__ import annotations

import math

import numpy as np

from bem.grid import FloatArray, Grid
from bem.numerics.subcell import around, top

_SMOOTH = 0.6
"""Of what a pressure without edges would be above its cells."""
_LEAST_RADIUS = 1.5
"""Cells across the radius of the ball that would bend as much: below, nothing is corrected."""


def highest_pressure(pressure: FloatArray, grid: Grid, hardness: float = math.inf) -> float:
    """The highest of pressures (nx, ny) on cells (as waves where both axes are periodic), at most the hardness [Pa]."""
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
    if min(map(min, rows)) <= 0:  # outside contact a square is none: corners then say nothing of a twist
        squares[::2, ::2] = 0.0
    found = top(squares)
    if found is None:
        return highest
    bend = 0.0 if all(grid.periodic) else below + highest + above + left + highest + right - 6 * highest
    if -bend * _LEAST_RADIUS**2 > 2 * highest:
        bend = 0.0
    return min(highest * math.sqrt(found) + _SMOOTH * bend / 24, hardness)
