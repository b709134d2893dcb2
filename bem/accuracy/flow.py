"""Error bars of flow factors: the same patch, deformed and flowed through, on the grid of twice the cell.

Each factor's bar is its difference times a factor, and a share of what the patch changes it by where that difference
happens to pass zero; the residual of contact and flow apart. Where fluid hangs together on one grid and not on the
other the difference is the factor itself. The mean gap of heights that are cut off scatters by cells at their edge,
which another grid says nothing of: its bar is a multiple of that scatter. Factors are set by
`reports/experiments/flow_error_bars.py`: an estimate, no proved bound.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bem.accuracy.bars import GRID, RESIDUAL, ErrorBars, Rule
from bem.accuracy.contact import surface_is_resolved
from bem.flow import FlowFactors
from bem.grid import FloatArray, Grid
from bem.notes.accuracy import NoBar

_SMOOTH = {"pressure_x": 1.0, "pressure_y": 1.0, "friction_sliding": 1.0, "friction_pressure": 1.0}
"""What factors are between smooth walls; others are 0."""
_FACTOR = Rule(0.7, 1.0, edge=0.01, rough_edge=0.01)
RULES: dict[str, Rule] = {
    "pressure_x": _FACTOR,
    "pressure_y": _FACTOR,
    "pressure_xy": Rule(0.8, 1.2, edge=0.01, rough_edge=0.02),
    "shear_x": _FACTOR,
    "friction_sliding": Rule(0.5, 0.6, edge=0.025, rough_edge=0.045),
    # next to contact, where most of it is, edges are as they lie between cells: differences may pass zero
    "friction_shear": Rule(0.7, 0.7, edge=0.06, rough_edge=0.1),
    "friction_pressure": _FACTOR,
    "mean_gap": Rule(0.8, 0.8),
    "contact_area_fraction": Rule(0.6, 0.6, edge=0.006, rough_edge=0.02),
}
"""On the difference, 1/3 of which order two would leave; and of how far the factor is from that of smooth walls."""
_FEW, _FEW_EDGE = 4.0, (0.12, 0.2)
"""Where fewer cells than that touch, neither grid knows how many: twice the share of `friction_shear`, resolved or not.
A spot of a cell or two is there or not with where it lies between centres."""
_SCATTER = 3.2
"""On the scatter of a mean gap: the largest of 25 errors was 3.1 times it, the median one 0.9."""
_RESIDUAL = 10.0
"""Relative change of a factor over the residual."""


def flow_bars(found: FlowFactors, heights: FloatArray, grid: Grid) -> ErrorBars:
    """Bars of factors found with `errors`, an entry for each separation; heights (nx, ny) [m] on the grid."""
    if found.coarser is None:
        return ErrorBars.unknown(RULES, NoBar.EVEN_CELLS, fewest=8)
    resolved = surface_is_resolved(heights, grid)
    touching = found.contact_area_fraction * heights.size
    few = dict.fromkeys(RULES, np.zeros(touching.shape, dtype=bool))
    few["friction_shear"] = (touching > 0) & (touching < _FEW)
    cells, residual = {}, {}
    for name, rule in RULES.items():
        value = getattr(found, name)
        changed = np.abs(value - _SMOOTH.get(name, 0.0))
        rules = [replace(rule, edge=_FEW_EDGE[0], rough_edge=_FEW_EDGE[1]) if each else rule for each in few[name]]
        pairs = zip(rules, value - found.coarser[name], changed, strict=True)
        bars = [each.bar(*pair, resolved=resolved) for each, *pair in pairs]
        scatter = found.mean_gap_scatter if name == "mean_gap" else np.zeros(len(bars))
        cells[name] = np.where(scatter > 0, _SCATTER * scatter, bars)
        residual[name] = _RESIDUAL * found.residual * np.abs(value)
    return ErrorBars.together({GRID: cells, RESIDUAL: residual})
