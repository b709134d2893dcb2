"""First pressure and approach of the own rows, from a contact on few cells that rank 0 solves alone.

The gap is sampled at every 2, 4, 8, ... cells, so that at most `_MOST_CELLS` are left. The serial solver takes seconds
for them; its pressure is interpolated linearly. The start affects cost and rounding only.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from bem.contact import ContactSolution, solve_contact
from bem.convolution import displacement_operator
from bem.distributed.ranks import Ranks, computed_on_first, own_slice
from bem.grid import Grid
from bem.materials import Body

FloatArray = NDArray[np.float64]

_MOST_CELLS = 1 << 18
"""Most cells of the coarse grid: 512 x 512."""

_TOLERANCE = 1e-4
"""Tolerance of the coarse contact, whose discretisation error is larger."""


def coarse_start(
    gap: FloatArray,
    grid: Grid,
    bodies: tuple[Body, ...],
    ranks: Ranks,
    *,
    load: float | None,
    approach: float | None,
    cap: float,
) -> tuple[FloatArray, float]:
    """Return the own rows of a first pressure [Pa], and the coarse contact's approach [m]; collective.

    gap : own rows [m]. load [N] or approach [m] : the prescribed one; the other is None.
    """
    factor = 2
    while grid.cells // factor**2 > _MOST_CELLS:
        factor *= 2
    samples = [_samples(cells, factor, periodic) for cells, periodic in zip(grid.shape, grid.periodic, strict=True)]
    coarse = _sampled_gap(gap, grid, ranks, samples)
    shape = (samples[0].size, samples[1].size)
    spacing = [
        side * (cells / sampled if periodic or sampled == 1 else factor)
        for side, cells, sampled, periodic in zip(grid.spacing, grid.shape, shape, grid.periodic, strict=True)
    ]
    coarse_grid = Grid(shape, (spacing[0], spacing[1]), periodic=grid.periodic)

    def solve() -> tuple[FloatArray, float]:
        assert coarse is not None
        hardness = cap if math.isfinite(cap) else None
        operator = displacement_operator(coarse_grid, bodies if len(bodies) == 2 else bodies[0])
        largest_load = math.inf if hardness is None else hardness * coarse_grid.area
        largest_approach = float(coarse.mean()) if all(grid.periodic) and hardness is None else math.inf
        contact: ContactSolution = solve_contact(
            coarse,
            operator,
            load=None if load is None else min(load, largest_load),
            approach=None if approach is None else min(approach, largest_approach),
            hardness=hardness,
            tolerance=_TOLERANCE,
        )
        return contact.pressure, contact.approach

    pressure, coarse_approach = computed_on_first(ranks, solve)
    rows = np.arange(grid.shape[0])[own_slice(grid.shape[0], ranks)]
    along_x = _interpolation(rows, shape[0], spacing[0] / grid.spacing[0], grid.periodic[0])
    columns = np.arange(grid.shape[1])
    along_y = _interpolation(columns, shape[1], spacing[1] / grid.spacing[1], grid.periodic[1])
    (low, high, weight), (left, right, share) = along_x, along_y
    by_rows = pressure[low] * (1 - weight[:, None]) + pressure[high] * weight[:, None]
    return np.clip(by_rows[:, left] * (1 - share) + by_rows[:, right] * share, 0.0, cap), coarse_approach


def _samples(cells: int, factor: int, periodic: bool) -> NDArray[np.int64]:
    """Return the cells that are sampled along an axis: evenly spaced on a period, every `factor`-th on a free axis."""
    count = max(1, -(-cells // factor))
    if periodic:
        return np.arange(count) * cells // count
    return np.arange(count) * factor


def _sampled_gap(gap: FloatArray, grid: Grid, ranks: Ranks, samples: list[NDArray[np.int64]]) -> FloatArray | None:
    """Return the sampled gap on rank 0, None on the others."""
    own = own_slice(grid.shape[0], ranks)
    own_samples = samples[0][(samples[0] >= own.start) & (samples[0] < own.stop)] - own.start
    whole = np.empty((samples[0].size, samples[1].size)) if ranks.rank == 0 else None
    ranks.collect_rows(np.ascontiguousarray(gap[own_samples][:, samples[1]]), whole)
    return whole


def _interpolation(
    cells: NDArray[np.int64], coarse_cells: int, factor: float, periodic: bool
) -> tuple[NDArray[np.int64], NDArray[np.int64], FloatArray]:
    """Return for fine cells along an axis the two coarse cells beside each, and the weight of the second.

    coarse_cells : number along the axis. factor : side of a coarse cell over that of a fine one.
    """
    place = cells / factor
    low = np.minimum(place.astype(np.int64), coarse_cells - 1)
    high = (low + 1) % coarse_cells if periodic else np.minimum(low + 1, coarse_cells - 1)
    return low, high, np.minimum(place - low, 1.0)
