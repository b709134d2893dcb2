"""Error bars of kind `flow-factors`."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.grid import FloatArray, Grid
from bem.scenes.resolutions import CELLS

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.flow import FlowFactors


def bars_of(found: FlowFactors, heights: FloatArray, grid: Grid, pair: float) -> ErrorBars:
    """Estimate errors of the flow factors, with that of roughness on both walls."""
    from bem.accuracy import flow_bars

    bars = flow_bars(found, heights, grid)
    return bars | bars.renamed({"shear_x": "shear_pair"}, lambda error: abs(pair) * error)


RESOLUTIONS = (CELLS,)
"""Resolutions that are refined to a requested accuracy."""
