"""Graded meshes that follow the film: fine at the inlet sweep, the constriction, the spike and the exit.

1. `cell_densities` measures how fine the mesh should be on each cell of an existing film.
2. `cell_sizes` turns that into cell widths for a given number of cells, with bounded growth.
3. `redistribute` places the new nodes by equidistribution.
"""

from __future__ import annotations

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.numerics.monotone import MonotoneCubic

FAR_INLET = 50.0
"""Distance of the first node, in units of the larger of the exit's abscissa and sqrt(2 R h_min)."""
GROWTH = 0.14
"""Largest change of the cell width per distance; keeps the upwind extrapolation of second order."""


def trapezoidal_weights(nodes: FloatArray) -> FloatArray:
    """Return the weights (n+1,) of the trapezoidal rule on ascending nodes (n+1,)."""
    width = np.diff(nodes)
    return 0.5 * (np.append(width, 0.0) + np.append(0.0, width))


def upwind_extrapolation(width: FloatArray) -> FloatArray:
    """Return the extrapolation factors (n,) of the Couette flow in the cells: times the difference between the two
    nodes upstream, added to the nearer node, gives the value at the middle of the cell. The first cell has one node
    upstream and factor zero."""
    out = np.zeros(len(width))
    out[1:] = 0.5 * width[1:] / width[:-1]
    return out


def cell_densities(
    offset: FloatArray, pressure: FloatArray, film: FloatArray, fluidity: FloatArray, exit_position: float
) -> tuple[FloatArray, FloatArray]:
    """Return the node densities (n,) for the smooth part of a film and for its spike, up to one factor.

    offset : (n+1,) nodes from the exit. pressure, film, fluidity : (n+1,) at the nodes. exit_position : X_e.
    """
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
    """Return cell widths (n,) with which `cells` cells fill the mesh; the spike asks for none below `smallest`."""
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
    """Limit the width of each cell to that of its neighbours plus `reach`, in place."""
    for i in range(1, len(size)):
        size[i] = min(size[i], size[i - 1] + reach[i - 1])
    for i in range(len(size) - 2, -1, -1):
        size[i] = min(size[i], size[i + 1] + reach[i])


def redistribute(offset: FloatArray, size: FloatArray, cells: int, fixed: int | None) -> FloatArray:
    """Return ascending offsets (cells + 1,) with the given cell sizes; the node numbered `fixed` stays in place."""
    count = np.concatenate([[0.0], np.cumsum(np.diff(offset) / size)])
    wanted = np.linspace(0.0, count[-1], cells + 1)
    if fixed is not None:
        before = int(np.clip(round(count[fixed] / count[-1] * cells), 1, cells - 1))
        wanted = np.concatenate(
            [np.linspace(0.0, count[fixed], before + 1), np.linspace(count[fixed], count[-1], cells - before + 1)[1:]]
        )
    nodes = MonotoneCubic(count, offset)(wanted)
    nodes[0], nodes[-1] = offset[0], offset[-1]
    return nodes
