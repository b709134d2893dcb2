"""Junctions: contact spots that act together, their drag, and the half spheres that come off under them.

Knows contact maps; no stress. Verified in tests/wear/test_criteria_with_length.py.
"""

from __future__ import annotations

import time
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact.regions import label_spots
from bem.grid import FloatArray, Grid
from bem.wear.loads import BodyCycle, BodyWear
from bem.wear.segmentation import Segmentation

_PARTS = 4
"""Points per side by which the depth of a half sphere in a cell is averaged, before scaling to the exact volume."""


class Junctions(NamedTuple):
    """Groups of contact spots.

    labels : (nx, ny) group of each cell, 1, 2, ..., 0 outside. diameter : (n,) of the circle of the group's area [m].
    middle : (n, 2) centre in cells. extent : (n,) along x [m]. dragged : (n,) largest drag of its columns [m].
    """

    labels: NDArray[np.int32]
    diameter: FloatArray
    middle: FloatArray
    extent: FloatArray
    dragged: FloatArray


def junction_removal(cycle: BodyCycle, critical: float) -> BodyWear:
    """Return half spheres under the junctions of at least a critical size [m] that were dragged over their own size.

    A cycle drags by the shift of the moving body, also in pure rolling, where nothing slides.

    The memory is one plane: drag of each column without a break in contact [m], reset where a piece came off. The own
    size is the diameter or, for a junction longer across than along the sliding, its extent along x: the largest drag
    of a column by an asperity that passes.
    """
    start = time.perf_counter()
    grid, pressure = cycle.setup.grid, cycle.pressure
    before = np.zeros(grid.shape) if cycle.memory is None else cycle.memory[0]
    drag = np.where(pressure > 0, before + cycle.shift_distance, 0.0)
    found = junctions(pressure, drag, grid)
    far = found.dragged >= np.minimum(found.diameter, found.extent) * (1 - 1e-9)
    ripe = np.flatnonzero((found.diameter >= critical) & far)
    interfaces = cycle.solid.interfaces
    deepest = interfaces[0] if interfaces and cycle.model.within_layer else np.inf
    pieces = half_spheres(found.middle[ripe], found.diameter[ripe], grid, deepest)
    taken = np.isin(found.labels, ripe + 1) | (pieces.labels > 0)
    return BodyWear(cycle.body, pieces, 0, 0.0, time.perf_counter() - start, np.where(taken, 0.0, drag)[None])


def junctions(pressure: FloatArray, drag: FloatArray, grid: Grid) -> Junctions:
    """Return the contact spots of a pressure (nx, ny), grouped where their distance is below the width of the smaller.

    drag : (nx, ny) drag of each column [m].
    """
    labels = label_spots(pressure, grid)
    count = int(labels.max())
    areas, middles = _areas(labels, count, grid.periodic)
    sizes = np.array(grid.spacing)
    diameters = np.sqrt(4 / np.pi * areas * grid.cell_area)
    wraps = np.where(grid.periodic, np.array(grid.shape) * sizes, np.inf)
    parent = _merge(middles * sizes, diameters, wraps)
    roots, group = np.unique(parent, return_inverse=True)
    joined = np.concatenate([[0], group + 1]).astype(np.int32)[labels]
    area, middle = _areas(joined, len(roots), grid.periodic)
    extent, dragged = _reach(joined, drag, len(roots))
    return Junctions(joined, np.sqrt(4 / np.pi * area * grid.cell_area), middle, extent * sizes[0], dragged)


@compiled
def _areas(labels, count, wraps):
    """Return number of cells and mean position of each label; on a periodic axis relative to its first cell."""
    nx, ny = labels.shape
    area = np.zeros(count)
    total = np.zeros((count, 2))
    first = np.full((count, 2), -1.0)
    for i in range(nx):
        for j in range(ny):
            n = labels[i, j] - 1
            if n < 0:
                continue
            if first[n, 0] < 0:
                first[n, 0], first[n, 1] = i, j
            dx, dy = i - first[n, 0], j - first[n, 1]
            if wraps[0]:
                dx -= nx * np.floor(dx / nx + 0.5)
            if wraps[1]:
                dy -= ny * np.floor(dy / ny + 0.5)
            area[n] += 1
            total[n, 0] += dx
            total[n, 1] += dy
    for n in range(count):
        for axis in range(2):
            total[n, axis] = first[n, axis] + total[n, axis] / max(area[n], 1.0)
    return area, total


@compiled
def _root(parent, n):
    while parent[n] != n:
        n = parent[n]
    return n


@compiled
def _merge(middle, diameter, lengths):
    """Join spots whose circles are closer than the width of the smaller by union-find; return the root of each.

    lengths : of the periods, infinite along free axes.
    """
    count = diameter.size
    parent = np.arange(count)
    order = np.argsort(middle[:, 0])
    widest = diameter.max() if count else 0.0
    for a in range(count):
        one = order[a]
        for step in range(1, count):
            b = a + step
            turned = 0.0
            if b >= count:
                if not np.isfinite(lengths[0]):
                    break
                b, turned = b - count, lengths[0]
            other = order[b]
            dx = middle[other, 0] + turned - middle[one, 0]
            # spots farther apart than three halves of the smaller and half of the larger do not join
            if dx > 1.5 * diameter[one] + 0.5 * widest and dx > 0.5 * diameter[one] + 1.5 * widest:
                break
            dy = abs(middle[other, 1] - middle[one, 1])
            if np.isfinite(lengths[1]):
                dy -= lengths[1] * np.floor(dy / lengths[1] + 0.5)
            between = np.hypot(dx, dy) - 0.5 * (diameter[one] + diameter[other])
            if between < min(diameter[one], diameter[other]):
                first, second = _root(parent, one), _root(parent, other)
                parent[max(first, second)] = min(first, second)
    for n in range(count):
        parent[n] = _root(parent, n)
    return parent


@compiled
def _reach(labels, drag, count):
    """Return the number of rows that each label covers, and the largest drag of its columns."""
    nx, ny = labels.shape
    rows = np.zeros(count)
    last = np.full(count, -1, np.int64)
    dragged = np.zeros(count)
    for i in range(nx):
        for j in range(ny):
            n = labels[i, j] - 1
            if n >= 0:
                if last[n] != i:
                    rows[n] += 1
                    last[n] = i
                dragged[n] = max(dragged[n], drag[i, j])
    return rows, dragged


def half_spheres(middle: FloatArray, diameter: FloatArray, grid: Grid, deepest: float) -> Segmentation:
    """Return half spheres below the surface; where two overlap, the column belongs to the deeper one.

    middle : (n, 2) centres in cells. diameter : (n,) [m]. deepest : depth at which pieces end [m]. Each has the volume
    pi d^3/12 on any grid, except for parts beyond a free edge or `deepest`.
    """
    labels = np.zeros(grid.shape, np.int32)
    thickness = np.zeros(grid.shape)
    _carve(middle, 0.5 * diameter, np.array(grid.spacing), grid.periodic, labels, thickness)
    np.minimum(thickness, deepest, out=thickness)
    kept = np.unique(labels[labels > 0])
    names = np.zeros(len(diameter) + 1, np.int32)
    names[kept] = np.arange(1, kept.size + 1)
    return Segmentation(names[labels], thickness, kept.size, np.zeros(kept.size + 1, np.bool_))


@compiled
def _carve(middle, radius, spacing, wraps, labels, thickness):
    nx, ny = labels.shape
    for n in range(radius.size):
        r = radius[n]
        low = np.floor(middle[n] - r / spacing - 1.0).astype(np.int64)
        size = np.ceil(2 * r / spacing + 3.0).astype(np.int64)
        depth = np.zeros((size[0], size[1]))
        for a in range(size[0]):
            for b in range(size[1]):
                for p in range(_PARTS * _PARTS):
                    x = (low[0] + a - 0.5 + (p // _PARTS + 0.5) / _PARTS - middle[n, 0]) * spacing[0]
                    y = (low[1] + b - 0.5 + (p % _PARTS + 0.5) / _PARTS - middle[n, 1]) * spacing[1]
                    depth[a, b] += np.sqrt(max(r * r - x * x - y * y, 0.0))
        total = depth.sum() * spacing[0] * spacing[1]
        if total == 0.0:  # smaller than the distance of points: the cell of its centre
            depth[int(np.floor(middle[n, 0] + 0.5)) - low[0], int(np.floor(middle[n, 1] + 0.5)) - low[1]] = 1.0
            total = spacing[0] * spacing[1]
        depth *= 2 * np.pi / 3 * r**3 / total
        for a in range(size[0]):
            for b in range(size[1]):
                i, j = low[0] + a, low[1] + b
                if wraps[0]:
                    i %= nx
                if wraps[1]:
                    j %= ny
                if 0 <= i < nx and 0 <= j < ny and depth[a, b] > thickness[i, j]:
                    thickness[i, j] = depth[a, b]
                    labels[i, j] = n + 1
