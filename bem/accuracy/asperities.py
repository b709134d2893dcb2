"""Error bars of the loads per asperity of an array: the array on the grid of twice the cell.

A contact a few cells wide gains and loses cells one by one, so that differences scatter about their order and may pass
zero: a floor holds a fraction of the load that falls with the square of the cells in Hertz' radius.

Verified in tests/accuracy/test_asperity_bars.py; judged by the experiment that `RULES` names.
"""

from __future__ import annotations

from bem.accuracy.bars import GRID, RESIDUAL, ErrorBars
from bem.accuracy.richardson import Table, residual_errors, rows
from bem.friction.asperity_array import ArrayLoads

RULES = Table(
    "asperities_error_bars",
    rows("mean_plane from_flat", 0.8, "Second order, of contacts of few cells: 2.4 times Richardson.", cells=0.15),
)
"""Factors on the difference, and on the load over the square of the cells in Hertz' radius (cells)."""
_TOLERANCE = 1e-6
"""Relative error of the contacts' tolerance and of the interpolation between their loads."""


def asperity_bars(found: ArrayLoads, coarser: ArrayLoads, radius: float, cell: float) -> ErrorBars:
    """Return the errors of `mean_plane` and `from_flat` at each depth, (n,) [N].

    Parameters
    ----------
    found, coarser : loads on the grid, and on that of twice the cell.
    radius : of the spheres [m].
    cell : of the grid [m].
    """
    loads, there = ({name: getattr(one, name) for name in RULES} for one in (found, coarser))
    in_radius = cell**2 / (radius * found.depth)
    cells = {name: in_radius * abs(load) for name, load in loads.items()}
    return ErrorBars.together(
        {
            GRID: RULES.errors(loads, there, {"cells": cells}),
            RESIDUAL: residual_errors(_TOLERANCE, loads, factor=1.0),
        }
    )
