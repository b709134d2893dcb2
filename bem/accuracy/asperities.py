"""Error bars of loads per asperity of an array: the same array on a grid of twice the cell.

A contact a few cells wide gains and loses cells one by one, so that differences scatter about their order and may pass
zero: the bar is the difference times a factor, and a share of the load that falls with the square of the cells in the
contact's radius. Factors are set by `reports/experiments/asperity_error_bars.py`: an estimate, no proved bound.
"""

from __future__ import annotations

import numpy as np

from bem.accuracy.bars import GRID, RESIDUAL, ErrorBars
from bem.friction.asperity_array import ArrayLoads

_DIFFERENCE, _SHARE = 0.8, 0.15
"""On the difference to twice the cell, and on the load over the square of the cells in Hertz' radius."""
_TOLERANCE = 1e-6
"""What contacts and the interpolation between their loads may add, relative."""


def asperity_bars(found: ArrayLoads, coarser: ArrayLoads, radius: float, cell: float) -> ErrorBars:
    """Errors of `mean_plane` and `from_flat` at each depth, (n,) [N].

    Parameters
    ----------
    found, coarser : on the grid, and on that of twice the cell.
    radius : of the spheres [m].
    cell : of the grid [m].
    """
    at_edge = cell**2 / (radius * found.depth)
    grid, residual = {}, {}
    for name in ("mean_plane", "from_flat"):
        loads, there = getattr(found, name), getattr(coarser, name)
        grid[name] = _DIFFERENCE * np.abs(loads - there) + _SHARE * at_edge * np.abs(loads)
        residual[name] = _TOLERANCE * np.abs(loads)
    return ErrorBars.together({GRID: grid, RESIDUAL: residual})
