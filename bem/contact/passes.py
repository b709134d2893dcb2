"""Fused passes over a field or over the cells in contact; each reads and writes memory once.

Every pass works in blocks of fixed size, shared between threads; sums are formed over blocks in order, so that a result
has the same bits whatever the number of threads.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from bem.threads import share

FloatArray = NDArray[np.float64]

FREE, CONTACT, CAPPED = 0, 1, 2
"""State of a cell: no pressure; pressure between the bounds; pressure at the cap."""

BLOCK = 1 << 15
"""Entries that one thread works on at a time: enough to hide the call, few enough to share."""

_fast: Any = njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "reassoc", "nsz", "arcp"})
_strict: Any = njit(cache=True, nogil=True, error_model="numpy")


def in_blocks(size: int, results: int, kernel: Callable[..., None], *arguments: Any) -> FloatArray:
    """Call `kernel(start, stop, out, *arguments)` for all blocks of `size` entries; returns (blocks, results)."""
    blocks = -(-size // BLOCK)
    partial = np.zeros((blocks, results))
    if blocks == 1:
        # a tenth of the Python calls of a contact of 256 x 256 cells were spent on sharing what is one thread's
        kernel(0, size, partial[0], *arguments)
        return partial

    def work(_worker: int, block: int) -> None:
        kernel(block * BLOCK, min(size, (block + 1) * BLOCK), partial[block], *arguments)

    share(work, blocks)
    return partial


def sums(size: int, results: int, kernel: Callable[..., None], *arguments: Any) -> list[float]:
    """What a kernel finds, added over the blocks in order."""
    if size <= BLOCK:
        found = np.zeros(results)
        kernel(0, size, found, *arguments)
        return found.tolist()
    return in_blocks(size, results, kernel, *arguments).sum(axis=0).tolist()


class Survey(NamedTuple):
    """What a round is judged by, over some cells with pressures p, gaps g and displacements u.

    Sum, largest and smallest of g + u; largest of |u|; sums of p (g + u / 2), of |p g| + |p u|, of p and of p (g + u).
    """

    total: float
    deepest: float
    nearest: float
    reach: float
    energy: float
    size: float
    force: float
    work: float


def survey(displacement: FloatArray, gap: FloatArray, cells: NDArray[Any], values: FloatArray) -> Survey:
    """Everything that is asked of the cells with pressure in one pass."""
    if cells.size == 0:
        return Survey(0.0, -np.inf, np.inf, 0.0, 0.0, 0.0, 0.0, 0.0)
    partial = in_blocks(cells.size, 8, _survey, displacement, gap, cells, values)
    if partial.shape[0] == 1:
        return Survey(*partial[0].tolist())
    sums = partial.sum(axis=0).tolist()
    deepest, nearest, reach = partial[:, 1].max(), partial[:, 2].min(), partial[:, 3].max()
    return Survey(sums[0], float(deepest), float(nearest), float(reach), *sums[4:])


@_fast
def _survey(start, stop, result, displacement, gap, cells, values):  # type: ignore[no-untyped-def]
    total = 0.0
    deepest = -np.inf
    nearest = np.inf
    reach = 0.0
    energy = 0.0
    size = 0.0
    force = 0.0
    work = 0.0
    cells, values = cells[start:stop], values[start:stop]
    for k in range(cells.size):
        c = np.uint64(cells[k])
        p = values[k]
        g = gap[c]
        u = displacement[c]
        opening = g + u
        total += opening
        deepest = max(deepest, opening)
        nearest = min(nearest, opening)
        reach = max(reach, abs(u))
        by_gap = p * g
        by_displacement = p * u
        energy += by_gap + 0.5 * by_displacement
        size += abs(by_gap) + abs(by_displacement)
        force += p
        work += by_gap + by_displacement
    result[0] = total
    result[1] = deepest
    result[2] = nearest
    result[3] = reach
    result[4] = energy
    result[5] = size
    result[6] = force
    result[7] = work


def find_violations(
    displacement: FloatArray, gap: FloatArray, state: NDArray[np.uint8], approach: float
) -> tuple[NDArray[np.int32], float]:
    """Cells that should not stay free (they overlap) or at the cap (they open), and the largest violation."""
    found = np.empty(gap.size, np.int32)
    partial = in_blocks(gap.size, 2, _find_violations, displacement, gap, state, approach, found)
    if partial.shape[0] == 1:
        count, largest = partial[0].tolist()
        return found[: int(count)], largest
    parts = [found[b * BLOCK : b * BLOCK + int(count)] for b, count in enumerate(partial[:, 0].tolist()) if count]
    cells = np.concatenate(parts) if parts else found[:0]
    return cells, float(partial[:, 1].max())


@_fast
def _find_violations(start, stop, result, displacement, gap, state, approach, found):  # type: ignore[no-untyped-def]
    place = start
    largest = 0.0
    # most stretches have none: these are only counted, without branches
    for first in range(start, stop, 256):
        last = min(first + 256, stop)
        own_state, own_gap, own_displacement = state[first:last], gap[first:last], displacement[first:last]
        count = 0
        for k in range(last - first):
            count += (1.0 - own_state[k]) * (approach - own_gap[k] - own_displacement[k]) > 0
        if count == 0:
            continue
        for c in range(first, last):
            if state[c] == 1:
                continue
            value = approach - gap[c] - displacement[c]
            if state[c] == 2:
                value = -value
            if value > 0:
                found[place] = c
                place += 1
                largest = max(largest, value)
    result[0] = place - start
    result[1] = largest


def separations(displacement: FloatArray, gap: FloatArray, state: NDArray[np.uint8]) -> tuple[float, float]:
    """Largest gap + displacement of cells with pressure, and smallest of cells that are not capped (or infinity)."""
    partial = in_blocks(gap.size, 2, _separations, displacement, gap, state)
    return float(partial[:, 0].max()), float(partial[:, 1].min())


@_strict
def _separations(start, stop, result, displacement, gap, state):  # type: ignore[no-untyped-def]
    deepest = -np.inf
    nearest = np.inf
    for c in range(start, stop):
        value = gap[c] + displacement[c]
        deepest = max(deepest, value if state[c] != 0 else -np.inf)
        nearest = min(nearest, value if state[c] != 2 else np.inf)
    result[0] = deepest
    result[1] = nearest


@_strict
def merge(old, new, surface, merged):  # type: ignore[no-untyped-def]
    """Two ascending sets of cells with their values as one, and gap + displacement - approach there.

    old, new : (cells, values). surface : (displacement, gap, approach). merged : (cells, values, residual), written.
    Returns the sum of the residual.
    """
    cells, values = old
    found, found_values = new
    displacement, gap, approach = surface
    all_cells, all_values, residual = merged
    a = 0
    b = 0
    total = 0.0
    for k in range(all_cells.size):
        if b == found.size or (a < cells.size and cells[a] < found[b]):
            c = cells[a]
            all_values[k] = values[a]
            a += 1
        else:
            c = np.int64(found[b])
            all_values[k] = found_values[b]
            b += 1
        all_cells[k] = c
        opening = gap[c] + displacement[c] - approach
        residual[k] = opening
        total += opening
    return total


def work(displacement: FloatArray, gap: FloatArray, cells: NDArray[Any], values: FloatArray) -> float:
    """Sum of p (gap + displacement) over some cells."""
    return sums(cells.size, 1, _work, displacement, gap, cells, values)[0]


@_fast
def _work(start, stop, result, displacement, gap, cells, values):  # type: ignore[no-untyped-def]
    cells, values = cells[start:stop], values[start:stop]
    total = 0.0
    for k in range(cells.size):
        c = np.uint64(cells[k])
        total += values[k] * (gap[c] + displacement[c])
    result[0] = total


@_fast
def place(field, cells, values, capped, cap):  # type: ignore[no-untyped-def]
    """field[cells] = values, field[capped] = cap, zero elsewhere."""
    field[:] = 0
    for k in range(cells.size):
        field[cells[k]] = values[k]
    for k in range(capped.size):
        field[capped[k]] = cap


@_fast
def mark(state, cells, capped):  # type: ignore[no-untyped-def]
    """The state of every cell."""
    state[:] = FREE
    for k in range(cells.size):
        state[cells[k]] = CONTACT
    for k in range(capped.size):
        state[capped[k]] = CAPPED


@_fast
def positive(cells, values):  # type: ignore[no-untyped-def]
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


@_fast
def settle(cells, values, cap, shape, side):  # type: ignore[no-untyped-def]
    """What clipping to the bounds will add to each square of `side` cells, its values between the bounds make up for in
    proportion to themselves. `cells` ascend: a square is looked up once for all that follow in its row."""
    ny, across = shape[1], (shape[1] - 1) // side + 1
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


def shifted_sum(values: FloatArray, shift: float, cap: float) -> tuple[float, int]:
    """Sum of clip(values + shift, 0, cap) and how many of them are strictly inside."""
    total, inside = sums(values.size, 2, _shifted_sum, values, shift, cap)
    return total, int(inside)


@_fast
def _shifted_sum(start, stop, result, values, shift, cap):  # type: ignore[no-untyped-def]
    total = 0.0
    inside = 0
    values = values[start:stop]
    for k in range(values.size):
        p = values[k] + shift
        if p >= cap:
            total += cap
        elif p > 0:
            total += p
            inside += 1
    result[0] = total
    result[1] = inside


def moments(values: FloatArray) -> tuple[float, float, float]:
    """Minimum, mean and root mean square about the mean; sums are of differences from the first value."""
    first = float(values[0])
    partial = in_blocks(values.size, 2, _least_and_sum, values, first)
    mean = float(partial[:, 1].sum()) / values.size
    about = in_blocks(values.size, 1, _squares_about, values, first, mean)
    return float(partial[:, 0].min()), first + mean, float(np.sqrt(about[:, 0].sum() / values.size))


@_fast
def _least_and_sum(start, stop, result, values, first):  # type: ignore[no-untyped-def]
    lowest = values[start]
    total = 0.0
    values = values[start:stop]
    for k in range(values.size):
        total += values[k] - first
        lowest = min(lowest, values[k])
    result[0] = lowest
    result[1] = total


@_fast
def _squares_about(start, stop, result, values, first, mean):  # type: ignore[no-untyped-def]
    values = values[start:stop]
    total = 0.0
    for k in range(values.size):
        d = values[k] - first - mean
        total += d * d
    result[0] = total


def rescale(values: FloatArray, datum: float, factor: float, out: FloatArray) -> None:
    """out = (values - datum) factor."""
    in_blocks(values.size, 0, _rescale, values, datum, factor, out)


@_fast
def _rescale(start, stop, result, values, datum, factor, out):  # type: ignore[no-untyped-def]
    values, out = values[start:stop], out[start:stop]
    for k in range(values.size):
        out[k] = (values[k] - datum) * factor


def assemble(
    fields: tuple[FloatArray, FloatArray, FloatArray],
    units: tuple[float, float],
    approach: float,
    cap: float,
    results: tuple[FloatArray, FloatArray],
) -> tuple[float, float, float, int, int, float]:
    """Turn scaled results into SI units in place, and judge them from the pressure's own values.

    fields : (pressure, displacement, gap), the first two scaled by `units` of pressure and length. results : (deformed
    gap, plastic depth), written. Returns the largest violation of the contact conditions (infinite for a pressure
    beyond its bounds), the largest displacement, the sum of pressures, the numbers of cells in contact and at the cap,
    and the sum of positive gaps.
    """
    partial = in_blocks(fields[0].size, 6, _assemble, fields, units, approach, cap, results)
    largest, reach = partial[:, 0].max(), partial[:, 1].max()
    force, contact, capped, volume = partial[:, 2:].sum(axis=0)
    return float(largest), float(reach), float(force), int(contact), int(capped), float(volume)


@_strict
def _assemble(start, stop, result, fields, units, approach, cap, results):  # type: ignore[no-untyped-def]
    pressure, displacement, gap = fields
    to_pressure, length = units
    deformed, depth = results
    largest = 0.0
    reach = 0.0
    force = 0.0
    contact = 0
    capped = 0
    volume = 0.0
    for c in range(start, stop):
        p = pressure[c] * to_pressure
        outside = not (p >= 0 and p <= cap * (1 + 1e-14))  # round-off of the units
        p = min(p, cap)
        u = displacement[c] * length
        pressure[c] = p
        displacement[c] = u
        reach = max(reach, abs(u))
        opening = gap[c] + u - approach
        depth[c] = 0.0
        if p <= 0:
            violation = -opening
            opening = max(opening, 0.0)
            volume += opening
        else:
            contact += 1
            force += p
            if p >= cap:
                violation = opening
                capped += 1
                depth[c] = max(-opening, 0.0)
            else:
                violation = abs(opening)
        if outside:
            violation = np.inf
        deformed[c] = opening
        if not violation <= largest:
            largest = violation
    result[0] = largest
    result[1] = reach
    result[2] = force
    result[3] = contact
    result[4] = capped
    result[5] = volume
