"""The highest pressure of a contact, between the centres of cells.

The square of the pressure is smooth up to the edge of contact (a paraboloid in Hertz' contact), so its top is that of a
paraboloid through the highest cell and its neighbours. A pressure that is constant on cells is, where it is smooth,
p - (dx^2 p_xx + dy^2 p_yy) / 24: the transform of a cell, sin(q dx / 2) / (q dx / 2), times that of such values is
that of p, the waves that cells add cancelling one another in pairs; what p is follows from the same neighbours. On a
ball of R cells 4 / R^2 % of the highest pressure stay, on random waves of five cells 0.1 % on average.

Not where pressures are not smooth: at the hardness, in spots of a cell or two, at the end of a punch, at a free edge of
the grid; there the highest pressure is that of a cell.
"""

from __future__ import annotations

import math

import numpy as np

from bem.grid import FloatArray, Grid
from bem.subcell import around, top


def highest_pressure(pressure: FloatArray, grid: Grid, hardness: float = math.inf) -> float:
    """The highest of pressures (nx, ny) on cells (as waves where both axes are periodic), at most the hardness [Pa]."""
    place = np.unravel_index(int(np.argmax(pressure)), pressure.shape)
    highest = float(pressure[place])
    patch = around(pressure, grid, (int(place[0]), int(place[1])))
    if patch is None or highest <= 0:
        return highest
    beside = np.concatenate([patch[:, 1], patch[1, :]])
    if beside.min() <= 0 or patch.max() >= hardness:
        return highest
    squares = (patch / highest) ** 2
    if patch.min() <= 0:  # outside contact a square is none: corners then say nothing of a twist
        squares[::2, ::2] = 0.0
    found = top(squares)
    if found is None:
        return highest
    bend = 0.0 if all(grid.periodic) else float(beside.sum() - 6 * highest) / 24
    return min(highest * math.sqrt(found) + bend, hardness)
