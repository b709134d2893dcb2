"""Error bars of kind `asperities`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.errors import InputError, Status
from bem.grid import Grid
from bem.kinds.asperities.scene import AsperitiesScene
from bem.kinds.asperities.solve import solve_array
from bem.notes.accuracy import NoBar
from bem.scenes.resolutions import cell_at

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.friction.asperity_array import ArrayLoads


_SHARES = {"mean_plane": "load_over_hertz", "from_flat": "load_over_hertz_finite_array"}
"""Ratios of the deepest load to that of an asperity alone."""


def bars_of(scene: AsperitiesScene, grid: Grid, found: ArrayLoads) -> ErrorBars:
    """Estimate errors from the grid of twice the cell; None of each where that one does not reach the depths."""
    from bem.accuracy import ErrorBars, asperity_bars

    try:
        coarser = solve_array(scene, scene.array.grid(grid.lengths[0], coarser=2))
    except InputError:
        coarser = None
    if coarser is None or coarser.status is not Status.CONVERGED:
        return ErrorBars.unknown(_SHARES.values(), NoBar.COARSER_UNSOLVED)
    bars = asperity_bars(found, coarser, scene.array.radius, grid.spacing[0])
    shares = bars.renamed(_SHARES, lambda bar: float(bar[-1] / found.alone[-1]))
    return bars.renamed({"mean_plane": "asperity_load", "from_flat": "asperity_load_window"}) | shares


RESOLUTIONS = (cell_at("array.cell"),)
"""Resolutions that are refined to a requested accuracy."""
