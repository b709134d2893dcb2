"""Sets of cells with their pressures: taking cells in, and going back into the bounds; each a single compiled call."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact.judging import CAPPED

FloatArray = NDArray[np.float64]


@compiled
def merge(old, found, state, cap, surface):
    """Cells (ascending) with their values and those found (as well) as one: cells, values, gap + displacement less the
    approach there, and the mean of that. What is found has no pressure, or the cap's.

    old : (cells, values). surface : (displacement, gap, approach).
    """
    cells, values = old
    displacement, gap, approach = surface
    count = cells.size + found.size
    all_cells, all_values, residual = np.empty(count, np.int64), np.empty(count), np.empty(count)
    a = 0
    b = 0
    total = 0.0
    for k in range(count):
        if b == found.size or (a < cells.size and cells[a] < found[b]):
            c = np.uint64(cells[a])
            all_values[k] = values[a]
            a += 1
        else:
            c = np.uint64(found[b])
            all_values[k] = cap if state[c] == CAPPED else 0.0
            b += 1
        all_cells[k] = c
        opening = gap[c] + displacement[c] - approach
        residual[k] = opening
        total += opening
    return all_cells, all_values, residual, total / max(1, count)


@compiled
def blend(old, new, share, cap):
    """Two pressures, (cells, values) with ascending cells, as one at a share of the way from the first to the second. A
    cell at the cap in both stays there whatever the rounding, one without pressure is left out."""
    cells, values = old
    more, more_values = new
    count = cells.size + more.size
    both, mixed = np.empty(count, np.int64), np.empty(count)
    a = 0
    b = 0
    k = 0
    while a < cells.size or b < more.size:
        from_old = b == more.size or (a < cells.size and cells[a] <= more[b])
        from_new = a == cells.size or (b < more.size and more[b] <= cells[a])
        both[k] = cells[a] if from_old else more[b]
        value = 0.0
        if from_old:
            value = values[a] * (1 - share)
        if from_new:
            value += share * more_values[b]
        if from_old and from_new and values[a] == cap and more_values[b] == cap:
            value = cap
        mixed[k] = value
        a += from_old
        b += from_new
        k += value > 0
    return both[:k].copy(), mixed[:k].copy()


@compiled
def mix(start, stop, result, displacement, earlier, share):
    """displacement = share displacement + (1 - share) earlier."""
    displacement, earlier = displacement[start:stop], earlier[start:stop]
    rest = 1 - share
    for k in range(displacement.size):
        displacement[k] = displacement[k] * share + earlier[k] * rest


@compiled
def descend(start, stop, result, displacement, gap, approach, step, out):
    """out = -step (gap + displacement - approach)."""
    displacement, gap, out = displacement[start:stop], gap[start:stop], out[start:stop]
    for k in range(out.size):
        out[k] = -(step * (gap[k] + displacement[k] - approach))


@compiled
def held(pressure, cap):
    """Of a field: cells with a pressure above zero and below the cap, their pressures, and cells at the cap."""
    inside, capped = 0, 0
    for k in range(pressure.size):
        inside += pressure[k] > 0
        capped += pressure[k] >= cap
    inside -= capped
    cells, values, others = np.empty(inside, np.int64), np.empty(inside), np.empty(capped, np.int64)
    a = 0
    b = 0
    for k in range(pressure.size):
        p = pressure[k]
        if p >= cap:
            others[b] = k
            b += 1
        elif p > 0:
            cells[a] = k
            values[a] = p
            a += 1
    return cells, values, others


@compiled
def positive(cells, values):
    """The cells with values above zero, these, and their sum; what is given where that is all of them."""
    kept = 0
    total = 0.0
    for k in range(cells.size):
        if values[k] > 0:
            kept += 1
            total += values[k]
    if kept == cells.size:
        return cells, values, total
    kept_cells, kept_values = np.empty(kept, cells.dtype), np.empty(kept)
    kept = 0
    for k in range(cells.size):
        if values[k] > 0:
            kept_cells[kept] = cells[k]
            kept_values[kept] = values[k]
            kept += 1
    return kept_cells, kept_values, total


_MOST = 0.5
"""Of its pressure between the bounds: the most that a region makes up for. At 0.9 free contacts of 512 cells take a
convolution more, and a region that hardly touches loses its pressure for rounds."""


@compiled
def settle(cells, values, cap, shape, side):
    """What clipping to the bounds will add to each square of `side` cells, its values between the bounds make up for in
    proportion to themselves. `cells` ascend: a square is looked up once for all that follow in its row."""
    ny, across = shape[1], (shape[1] - 1) // side + 1
    outside = 0
    for k in range(cells.size):
        outside += not 0 <= values[k] < cap
    if outside == 0:
        return
    excess = np.zeros(((shape[0] - 1) // side + 1) * across)
    inside = np.zeros(excess.size)
    squares = np.empty(cells.size, np.int32)
    row, first, stop, b = 0, 0, 0, np.uint64(0)
    for k in range(cells.size):
        cell = cells[k]
        if cell >= stop:
            while cell >= first + ny:
                row += 1
                first += ny
            column = np.uint64(cell - first) // np.uint64(side)
            b = np.uint64(row // side * across) + column
            stop = first + min(ny, np.int64(column + np.uint64(1)) * side)
        squares[k] = b
        value = values[k]
        if value <= 0:
            excess[b] -= value
        elif value >= cap:
            excess[b] += cap - value
        else:
            inside[b] += value
    for square in range(excess.size):
        share = excess[square] / inside[square] if inside[square] > 0 else 0.0
        excess[square] = 1 - max(-_MOST, min(_MOST, share))
    for k in range(cells.size):
        if 0 < values[k] < cap:
            values[k] *= excess[np.uint64(squares[k])]
