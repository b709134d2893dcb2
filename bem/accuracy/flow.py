"""Error bars of flow factors: the patch, deformed and flowed through, on the grid of twice the cell.

Where fluid percolates on one grid and not on the other, the difference is the factor itself. The mean gap of heights
that are cut off scatters by the cells at their edge, of which another grid says nothing: its bar is a multiple of that
scatter.

Verified in tests/accuracy/test_flow_bars.py; judged by the experiment that `RULES` names.
"""

from __future__ import annotations

import numpy as np

from bem.accuracy.bars import GRID, RESIDUAL, ErrorBars
from bem.accuracy.coarsened import surface_is_resolved
from bem.accuracy.richardson import Regime, Table, residual_errors, rows
from bem.flow import FlowFactors
from bem.grid import FloatArray, Grid
from bem.notes.accuracy import NoBar

_SMOOTH = {"pressure_x": 1.0, "pressure_y": 1.0, "friction_sliding": 1.0, "friction_pressure": 1.0}
"""Factors between smooth walls; others are 0."""
RULES = Table(
    "flow_error_bars",
    rows(
        "pressure_x pressure_y shear_x friction_pressure",
        (0.7, 1.0),
        "Second order of flow between resolved walls; twice Richardson, three times on unresolved ones.",
        rough=0.01,
    ),
    rows("pressure_xy", (0.8, 1.2), "As the pressure factors; small beside them.", rough=(0.01, 0.02)),
    rows(
        "friction_sliding",
        (0.5, 0.6),
        "The mean of 1/h, integrated between centres; most of it lies beside the contact.",
        rough=(0.025, 0.045),
    ),
    rows(
        "friction_shear",
        0.7,
        "Most of it lies at edges of the contact, whose places between cells decide it: differences may pass zero.",
        rough=(0.06, 0.1),
    ),
    rows("mean_gap", 0.8, "Second order; where heights are cut off, 3.2 times the scatter of cells: the largest of 25 "
         "errors was 3.1 times it.", scatter=3.2),
    rows("contact_area_fraction", 0.6, "Second order, of deformed spots of few cells.", rough=(0.006, 0.02)),
)  # fmt: skip
"""Factors on the difference, and floors on the distance of the factor from that of smooth walls (rough) and on the
scatter of cells at the edge of cut heights (scatter)."""
_FEW = 4.0
"""Cells in contact, below which neither grid knows how many there are: the floor of `friction_shear` is doubled."""


def flow_bars(found: FlowFactors, heights: FloatArray, grid: Grid) -> ErrorBars:
    """Return the error bars of factors that were found with `errors`, an entry for each separation.

    heights : (nx, ny) [m] on the grid.
    """
    if found.coarser is None:
        return ErrorBars.unknown(RULES, NoBar.EVEN_CELLS, fewest=8)
    regime = Regime.RESOLVED if surface_is_resolved(heights, grid) else Regime.UNRESOLVED
    values, coarser = {name: getattr(found, name) for name in RULES}, dict(found.coarser)
    rough = {name: np.abs(value - _SMOOTH.get(name, 0.0)) for name, value in values.items()}
    touching = found.contact_area_fraction * heights.size
    rough["friction_shear"] = np.where((touching > 0) & (touching < _FEW), 2.0, 1.0) * rough["friction_shear"]
    # the difference of mean gaps says nothing of the scatter
    coarser["mean_gap"] = np.where(found.mean_gap_scatter > 0, values["mean_gap"], coarser["mean_gap"])
    indicators = {"rough": rough, "scatter": {"mean_gap": found.mean_gap_scatter}}
    cells = RULES.errors(values, coarser, indicators, regime=regime)
    return ErrorBars.together({GRID: cells, RESIDUAL: residual_errors(found.residual, values)})
