"""From coarse grids to fine ones: tractions in parts of their bounds, and how much cells slip."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.contact.nested_iteration import sample
from bem.grid import FloatArray, Grid
from bem.tangential.rounds import Effort, Slipped, Slipping, slip_on_grid

_COARSE = 1e-3
"""Relative violation that coarse grids are solved to: more is lost in the interpolation anyway."""

_FEWEST = 4
"""Cells in contact on a coarse grid below which it says nothing."""


def slip(problem: Slipping, before: FloatArray | None, tolerance: float, effort: Effort) -> Slipped:
    """From the solution on the next coarser grid, itself begun in the same way; with the tractions of the step before,
    (2, nx, ny), only the change since then comes from there.
    """
    return slip_on_grid(problem, _from_coarser(problem, before, effort), tolerance, effort)


def _from_coarser(problem: Slipping, before: FloatArray | None, effort: Effort) -> FloatArray:
    """Wanted tractions (2, nx, ny), outside their discs by the slip times the stiffness."""
    grid = problem.operator.grid
    old = np.zeros((2, *grid.shape)) if before is None else before
    coarse = _coarsened(problem)
    if coarse is None:
        return old
    sampled = None if before is None else _sampled(before, coarse.operator.grid.shape, grid)
    found = slip(coarse, sampled, _COARSE, effort)
    cells, bound = found.cells, coarse.bound[found.cells]
    change = found.traction if sampled is None else found.traction - sampled[:, cells]
    shares, unmet = np.zeros((2, *cells.shape)), np.zeros((2, *cells.shape))
    shares[:, cells] = change / bound
    unmet[:, cells] = np.where(found.slips, found.unmet, 0.0)
    fine = _interpolated(np.concatenate([shares, unmet]), cells, grid)
    return np.where(problem.bound > 0, old + fine[:2] * problem.bound + fine[2:] * problem.stiffness, 0.0)


def _sampled(fields: FloatArray, shape: tuple[int, int], grid: Grid) -> FloatArray:
    """Fields (2, nx, ny) on a coarser grid."""
    return np.stack([sample(field, shape, grid.periodic) for field in fields])


def _coarsened(problem: Slipping) -> Slipping | None:
    operator = problem.operator.coarsened()
    grid = problem.operator.grid
    if operator is None or operator.grid.cells == grid.cells:
        return None
    shape = operator.grid.shape
    bound = sample(problem.bound, shape, grid.periodic)
    if np.count_nonzero(bound > 0) < _FEWEST:
        return None
    bound = np.maximum(bound, 0.0)
    imposed = _sampled(problem.imposed, shape, grid)
    # the same share of what friction can carry
    force = None if problem.force is None else problem.force * (bound.sum() / problem.bound.sum())
    return replace(problem, operator=operator, bound=bound, imposed=imposed, force=force)


@dataclass(frozen=True)
class _Neighbours:
    """Along an axis: the coarse points before and after each fine one, and how far it is from the first."""

    before: NDArray[np.int64]
    after: NDArray[np.int64]
    part: FloatArray


def _neighbours(cells: int, onto: int, periodic: bool) -> _Neighbours:
    position = np.arange(onto) * (cells / onto if periodic else 0.5 if onto > cells else 1.0)
    before = np.floor(position).astype(np.int64)
    after = (before + 1) % cells if periodic else np.minimum(before + 1, cells - 1)
    return _Neighbours(before, after, position - before)


def _interpolated(fields: FloatArray, cells: NDArray[np.bool_], grid: Grid) -> FloatArray:
    """Bilinear interpolation among the coarse cells in contact: (parts, nx, ny); 0 where there is none around."""
    weighted = np.concatenate([np.where(cells, fields, 0.0), cells[None].astype(np.float64)])
    for axis in (1, 2):
        along = _neighbours(weighted.shape[axis], grid.shape[axis - 1], grid.periodic[axis - 1])
        part = along.part[:, None] if axis == 1 else along.part
        weighted = weighted.take(along.before, axis) * (1 - part) + weighted.take(along.after, axis) * part
    total = weighted[-1]
    return np.where(total > 0, weighted[:-1] / np.where(total > 0, total, 1.0), 0.0)
