"""Runs of fine voxels above yield, column by column, and their union-find.

The stress of a column is interpolated monotonically between its depths, so a run of fine samples above yield is found
from the few intervals with one end above and one end below yield. A column is given by its number in the flattened map.

Knows arrays only. Verified in tests/wear/test_segmentation.py against labels of the whole refined stack.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.grid import FloatArray


class Runs(NamedTuple):
    """Runs of fine samples above yield in some columns.

    columns : (n,) numbers of these columns. first : (n + 1,) index of the first run of each.
    top, bottom : (runs,) first and last sample of each. bottom_depth : (runs,) depth at which the stress
    falls to yield, by linear interpolation between two fine samples [m].
    """

    columns: NDArray[np.int64]
    first: NDArray[np.int64]
    top: NDArray[np.int64]
    bottom: NDArray[np.int64]
    bottom_depth: FloatArray


@compiled
def yielding_columns(stack, strength):
    """Return the columns of a stack (nz, columns) in which any value exceeds the strength (columns,)."""
    above = np.zeros(strength.size, np.bool_)
    for k in range(stack.shape[0]):
        for column in range(strength.size):
            above[column] |= stack[k, column] > strength[column]
    return np.flatnonzero(above)


_TOGETHER = 64
"""Columns gathered at a time, so that the output stays in the cache over all depths."""


@compiled
def gather_columns(stack, candidates, rows):
    """Return the columns (candidates, nz), depth fastest; rows : (nz, n) True for parts of a plane that count."""
    out = np.empty((candidates.size, stack.shape[0]))
    size, part = stack.shape[1] // rows.shape[1], np.empty(_TOGETHER, np.int64)
    for first in range(0, candidates.size, _TOGETHER):
        last = min(first + _TOGETHER, candidates.size)
        for own in range(first, last):
            part[own - first] = candidates[own] // size
        for k in range(stack.shape[0]):
            for own in range(first, last):
                out[own, k] = stack[k, candidates[own]] if rows[k, part[own - first]] else 0.0
    return out


@compiled
def _slope(values, depths, k):
    """Return the Fritsch-Butland slope at sample k: harmonic mean inside, one-sided three-point formula, limited, at
    the ends."""
    n = values.size
    if n == 2:
        return (values[1] - values[0]) / (depths[1] - depths[0])
    if 0 < k < n - 1:
        before, after = depths[k] - depths[k - 1], depths[k + 1] - depths[k]
        rise, fall = (values[k] - values[k - 1]) / before, (values[k + 1] - values[k]) / after
        if rise * fall <= 0.0:
            return 0.0
        first, second = 2 * after + before, after + 2 * before
        return (first + second) / (first / rise + second / fall)
    if k == 0:
        near, far = depths[1] - depths[0], depths[2] - depths[1]
        own, other = (values[1] - values[0]) / near, (values[2] - values[1]) / far
    else:
        near, far = depths[n - 1] - depths[n - 2], depths[n - 2] - depths[n - 3]
        own, other = (values[n - 1] - values[n - 2]) / near, (values[n - 2] - values[n - 3]) / far
    slope = ((2 * near + far) * own - near * other) / (near + far)
    if slope * own <= 0.0:
        return 0.0
    if own * other <= 0.0 and abs(slope) > 3 * abs(own):
        return 3 * own
    return slope


@compiled
def _crossing(values, depths, k, limit, refine, cubic):
    """Return the first fine sample beyond the limit between samples k and k + 1, and the depth of the crossing."""
    falls = values[k] > limit
    span = depths[k + 1] - depths[k]
    upper = lower = 0.0
    if cubic and refine > 1:
        upper, lower = span * _slope(values, depths, k), span * _slope(values, depths, k + 1)
    previous, previous_depth = values[k], depths[k]
    for step in range(1, refine + 1):
        t = step / refine
        if step == refine:
            value = values[k + 1]
        elif cubic:
            value = (
                (1 + 2 * t) * (1 - t) * (1 - t) * values[k]
                + t * (1 - t) * (1 - t) * upper
                + t * t * (3 - 2 * t) * values[k + 1]
                - t * t * (1 - t) * lower
            )
        else:
            value = (1 - t) * values[k] + t * values[k + 1]
        depth = depths[k] + t * span
        if (value > limit) != falls:
            break
        previous, previous_depth = value, depth
    return k * refine + step, previous_depth + (previous - limit) / (previous - value) * (depth - previous_depth)


@compiled
def find_runs(numbers, columns, depths, strength, refine, cubic):
    """Return the runs of the columns `numbers`, of stress (n, nz) and strength (n,).

    Between two depths the interpolant is monotone: an interval with both ends above or both below yield needs no
    sample, one with an end on either side is sampled from above until the side changes.
    """
    n, nz = columns.shape
    first = np.zeros(n + 1, np.int64)
    capacity = n * 2 + 16
    top = np.empty(capacity, np.int64)
    bottom = np.empty(capacity, np.int64)
    bottom_depth = np.empty(capacity, np.float64)
    used = 0
    for column in range(n):
        values = columns[column]
        limit = strength[column]
        if used + nz > capacity:
            grown = 2 * capacity + nz
            top = np.append(top, np.empty(grown - capacity, np.int64))
            bottom = np.append(bottom, np.empty(grown - capacity, np.int64))
            bottom_depth = np.append(bottom_depth, np.empty(grown - capacity, np.float64))
            capacity = grown
        if values[0] > limit:
            top[used] = 0
        for k in range(nz - 1):
            above, below = values[k] > limit, values[k + 1] > limit
            if above == below:
                continue
            sample, depth = _crossing(values, depths, k, limit, refine, cubic)
            if below:
                top[used] = sample
            else:
                bottom[used] = sample - 1
                bottom_depth[used] = depth
                used += 1
        if values[nz - 1] > limit:
            bottom[used] = (nz - 1) * refine
            bottom_depth[used] = depths[nz - 1]
            used += 1
        first[column + 1] = used
    return Runs(numbers, first, top[:used], bottom[:used], bottom_depth[:used])


@compiled
def _root(parent, run):
    while parent[run] != run:
        parent[run] = parent[parent[run]]
        run = parent[run]
    return run


@compiled
def _join(parent, a, b):
    a, b = _root(parent, a), _root(parent, b)
    if a < b:
        parent[b] = a
    else:
        parent[a] = b


@compiled
def connect(runs, shape, periodic, connectivity):
    """Join runs that touch by union-find; return the parent of each.

    Half of the neighbours suffice, the relation being symmetric.

    shape : (nx, ny) of the map. periodic : True where it continues across the edges along x and y.
    """
    nx, ny = shape
    first, top, bottom = runs.first, runs.top, runs.bottom
    slot = np.full(nx * ny, -1, np.int64)
    slot[runs.columns] = np.arange(runs.columns.size)
    parent = np.arange(top.size)
    for own in range(runs.columns.size):
        i, j = runs.columns[own] // ny, runs.columns[own] % ny
        for neighbour in range(4):
            di = 0 if neighbour == 0 else 1
            dj = 1 if neighbour == 0 else neighbour - 2
            diagonal = di != 0 and dj != 0
            if diagonal and connectivity == 6:
                continue
            reach = 0  # how far apart in depth two runs may be and still touch
            if connectivity == 26 or (connectivity == 18 and not diagonal):
                reach = 1
            ii, jj = i + di, j + dj
            if ii >= nx:
                if not periodic[0]:
                    continue
                ii -= nx
            if jj < 0 or jj >= ny:
                if not periodic[1]:
                    continue
                jj %= ny
            other = slot[ii * ny + jj]
            if other < 0:
                continue
            for a in range(first[own], first[own + 1]):
                for b in range(first[other], first[other + 1]):
                    if top[a] <= bottom[b] + reach and top[b] <= bottom[a] + reach:
                        _join(parent, a, b)
    return parent


@compiled
def select_runs(runs, parent, cap, labels, thickness):
    """Select the runs that leave, and return the number of pieces; labels and thickness (columns,) are filled in place.

    cap : True if all material above a run leaves with it.
    """
    columns, first, top = runs.columns, runs.first, runs.top
    reaches_surface = np.zeros(top.size, np.bool_)
    for run in range(top.size):
        if top[run] == 0:
            reaches_surface[_root(parent, run)] = True
    if cap:
        for column in range(columns.size):  # pieces that share a column leave together
            last = -1
            for run in range(first[column], first[column + 1]):
                if reaches_surface[_root(parent, run)]:
                    if last >= 0:
                        _join(parent, last, run)
                        reaches_surface[_root(parent, run)] = True
                    last = run
    name = np.zeros(top.size, np.int32)
    count = 0
    for column in range(columns.size):
        for run in range(first[column], first[column + 1]):
            root = _root(parent, run)
            if not reaches_surface[root] or (not cap and top[run] != 0):
                continue
            if name[root] == 0:
                count += 1
                name[root] = count
            labels[columns[column]] = name[root]
            thickness[columns[column]] = max(thickness[columns[column]], runs.bottom_depth[run])
    return count
