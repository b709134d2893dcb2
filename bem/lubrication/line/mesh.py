"""Graded meshes that follow the film: fine at the inlet sweep, the constriction, the spike and the exit."""

from __future__ import annotations

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.numerics.monotone import MonotoneCubic

FAR_INLET = 50.0
"""Where the mesh starts: this many times the larger of the exit's abscissa and sqrt(2 R h_min) upstream."""
GROWTH = 0.14
"""Largest change of cell width per distance: keeps the upwind extrapolation of second order."""


def trapezoidal_weights(nodes: FloatArray) -> FloatArray:
    """Weights (n+1,) of the integral of what is linear between ascending nodes (n+1,)."""
    width = np.diff(nodes)
    return 0.5 * (np.append(width, 0.0) + np.append(0.0, width))


def upwind_extrapolation(width: FloatArray) -> FloatArray:
    """How much of the difference between the two nodes upstream reaches from the nearer one to the middle of a cell
    (n,), where the flow runs with the numbering; nothing in the first cell, which has but one."""
    out = np.zeros(len(width))
    out[1:] = 0.5 * width[1:] / width[:-1]
    return out


def cell_densities(
    offset: FloatArray, pressure: FloatArray, film: FloatArray, fluidity: FloatArray, exit_position: float
) -> tuple[FloatArray, FloatArray]:
    """How densely nodes are wanted on each cell, up to a factor: for all that is smooth, and for the spike."""
    width = np.diff(offset)
    middle = np.abs(exit_position + 0.5 * (offset[1:] + offset[:-1]))
    highest = pressure.max()
    half_width = np.sum(0.5 * width * (pressure[1:] + pressure[:-1])) / highest
    half_width = max(half_width, 0.5 * exit_position)  # a spike's height says nothing about the width
    smooth: FloatArray = (
        2 * np.abs(np.diff(film[-1] / film)) / width
        + np.abs(np.diff(fluidity)) / width
        + 0.5 / (middle + half_width)
        + (middle < 1.3 * half_width) / half_width
    )
    return smooth, 0.5 * np.abs(np.diff(pressure)) / (width * highest)


def cell_sizes(offset: FloatArray, smooth: FloatArray, spike: FloatArray, cells: int, smallest: float) -> FloatArray:
    """Wanted cell width at each cell so that `cells` fill the mesh; the spike alone asks for none below `smallest`."""
    width = np.diff(offset)
    reach = GROWTH * 0.5 * (width[1:] + width[:-1])
    factor = float(np.sum((smooth + spike) * width)) / cells
    for _ in range(6):
        size = np.maximum(factor / (smooth + spike), np.minimum(smallest, factor / smooth))
        _limit_growth(size, reach)
        excess = float(np.sum(width / size)) / cells
        factor *= excess
        if abs(excess - 1) < 0.02:
            break
    return size


@compiled
def _limit_growth(size: FloatArray, reach: FloatArray) -> None:
    """No cell is wider than its neighbours' by more than `reach`."""
    for i in range(1, len(size)):
        size[i] = min(size[i], size[i - 1] + reach[i - 1])
    for i in range(len(size) - 2, -1, -1):
        size[i] = min(size[i], size[i + 1] + reach[i])


def redistribute(offset: FloatArray, size: FloatArray, cells: int, kept: int | None) -> FloatArray:
    """Ascending offsets of `cells + 1` nodes with cells of the wanted sizes; node `kept` stays where it is."""
    count = np.concatenate([[0.0], np.cumsum(np.diff(offset) / size)])
    wanted = np.linspace(0.0, count[-1], cells + 1)
    if kept is not None:
        before = int(np.clip(round(count[kept] / count[-1] * cells), 1, cells - 1))
        wanted = np.concatenate(
            [np.linspace(0.0, count[kept], before + 1), np.linspace(count[kept], count[-1], cells - before + 1)[1:]]
        )
    nodes = MonotoneCubic(count, offset)(wanted)
    nodes[0], nodes[-1] = offset[0], offset[-1]
    return nodes
