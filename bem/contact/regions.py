"""Connected regions (spots) of contact; cells are connected through their sides.

No step of `bem.contact`: accuracy and wear use the spots of a solution. Runs of cells along the rows are joined by
union-find instead of single cells. Verified in tests/contact/test_regions.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact.contact_boundary import wrapped_index
from bem.grid import FloatArray, Grid


def count_spots(pressure: FloatArray, grid: Grid) -> int:
    """Return the number of separate spots of a pressure (nx, ny)."""
    return int(_join_runs(np.ascontiguousarray(pressure), grid.periodic)[1])


def narrow_share(touching: NDArray[np.bool_], periodic: tuple[bool, bool]) -> float:
    """Return the share of the cells in contact (nx, ny) in spots that are one or two cells wide.

    A wider spot has a cell whose four neighbours touch as well; on a grid of a single row, whose two neighbours do.
    """
    grid = Grid((touching.shape[0], touching.shape[1]), (1.0, 1.0), periodic=periodic)
    labels = label_spots(touching.astype(np.float64), grid)
    inside = touching.copy()
    for axis in (0, 1):
        if touching.shape[axis] == 1:
            continue
        for step in (-1, 1):
            beside = np.roll(touching, step, axis)
            if not periodic[axis]:
                beside[(slice(None),) * axis + (0 if step == 1 else -1,)] = False
            inside &= beside
    areas = np.bincount(labels[touching])
    wide = np.unique(labels[inside])
    total = int(areas.sum())
    return 1.0 - float(areas[wide].sum()) / total if total else 0.0


def label_spots(pressure: FloatArray, grid: Grid) -> NDArray[np.int32]:
    """Label the spots of a pressure (nx, ny): 1, 2, ... in the order of their first cells, 0 outside contact."""
    pressure = np.ascontiguousarray(pressure)
    parent, _ = _join_runs(pressure, grid.periodic)
    return np.asarray(_number(pressure, parent))


@compiled
def _join_runs(pressure, wraps):
    """Return the union-find of all runs, numbered row by row, and the number of its trees."""
    nx, ny = pressure.shape
    before = _runs_before(pressure)
    count = before[nx]
    parent = np.arange(count)
    for i in range(nx):
        if wraps[1] and pressure[i, 0] > 0 and pressure[i, ny - 1] > 0:
            count -= _joined(parent, before[i], before[i + 1] - 1)
        k = wrapped_index(i + 1, nx, wraps[0])
        here, there = before[i] - 1, before[k] - 1
        inside, beyond = False, False
        for j in range(ny):
            was_inside, was_beyond = inside, beyond
            inside, beyond = pressure[i, j] > 0, pressure[k, j] > 0
            here += inside and not was_inside
            there += beyond and not was_beyond
            if inside and beyond and not (was_inside and was_beyond):
                count -= _joined(parent, here, there)
    return parent, count


@compiled
def _runs_before(pressure):
    """Return the number of runs before each row, and the total."""
    nx, ny = pressure.shape
    before = np.zeros(nx + 1, np.int64)
    for i in range(nx):
        count = before[i] + (pressure[i, 0] > 0)
        for j in range(1, ny):
            count += (pressure[i, j] > 0) & ~(pressure[i, j - 1] > 0)
        before[i + 1] = count
    return before


@compiled
def _joined(parent, one, other):
    """Join two runs; return True if they were in separate trees."""
    first, second = _root(parent, one), _root(parent, other)
    parent[max(first, second)] = min(first, second)
    return first != second


@compiled
def _root(parent, run):
    while parent[run] != run:
        parent[run] = parent[parent[run]]
        run = parent[run]
    return run


@compiled
def _number(pressure, parent):
    nx, ny = pressure.shape
    names = np.empty(parent.size, np.int32)
    count = 0
    for run in range(parent.size):
        root = _root(parent, run)  # the first of its tree
        if root == run:
            count += 1
            names[run] = count
        else:
            names[run] = names[root]
    labels = np.zeros((nx, ny), np.int32)
    run = -1
    for i in range(nx):
        inside = False
        for j in range(ny):
            was_inside = inside
            inside = pressure[i, j] > 0
            run += inside and not was_inside
            if inside:
                labels[i, j] = names[run]
    return labels
