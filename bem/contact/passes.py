"""Fused passes over a field or over the cells in contact; each reads and writes memory once.

Every pass works in blocks of fixed size, shared between threads; sums are formed over blocks in order, so that a result
has the same bits whatever the number of threads.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

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


def gather_sum(displacement: FloatArray, gap: FloatArray, cells: NDArray[Any], out: FloatArray) -> float:
    """out = (gap + displacement)[cells]; returns its sum."""
    return float(in_blocks(cells.size, 1, _gather_sum, displacement, gap, cells, out)[:, 0].sum())


@_fast
def _gather_sum(start, stop, result, displacement, gap, cells, out):  # type: ignore[no-untyped-def]
    total = 0.0
    for k in range(start, stop):
        c = cells[k]
        value = gap[c] + displacement[c]
        out[k] = value
        total += value
    result[0] = total


def find_violations(
    displacement: FloatArray, gap: FloatArray, state: NDArray[np.uint8], approach: float
) -> tuple[NDArray[np.int32], float]:
    """Cells that should not stay free (they overlap) or at the cap (they open), and the largest violation."""
    found = np.empty(gap.size, np.int32)
    partial = in_blocks(gap.size, 2, _find_violations, displacement, gap, state, approach, found)
    parts = [found[b * BLOCK : b * BLOCK + int(count)] for b, count in enumerate(partial[:, 0]) if count]
    cells = np.concatenate(parts) if parts else found[:0]
    return cells, float(partial[:, 1].max(initial=0.0))


@_fast
def _find_violations(start, stop, result, displacement, gap, state, approach, found):  # type: ignore[no-untyped-def]
    place = start
    largest = 0.0
    # most stretches have none: these are only counted, without branches
    for first in range(start, stop, 256):
        last = min(first + 256, stop)
        count = 0
        for c in range(first, last):
            value = approach - gap[c] - displacement[c]
            count += ((state[c] == 0) & (value > 0)) | ((state[c] == 2) & (value < 0))
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
def merge(cells, values, found, found_values, displacement, gap, approach, all_cells, all_values, residual):  # type: ignore[no-untyped-def]
    """Two ascending sets of cells with their values as one, and gap + displacement - approach there."""
    a = 0
    b = 0
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
        residual[k] = gap[c] + displacement[c] - approach


def energy(
    displacement: FloatArray, gap: FloatArray, cells: NDArray[Any], values: FloatArray
) -> tuple[float, float, float, float]:
    """Sum of p (gap + displacement / 2), of its magnitude, of p, and of p (gap + displacement) over some cells."""
    energy, size, force, work = in_blocks(cells.size, 4, _energy, displacement, gap, cells, values).sum(axis=0)
    return float(energy), float(size), float(force), float(work)


@_fast
def _energy(start, stop, result, displacement, gap, cells, values):  # type: ignore[no-untyped-def]
    total = 0.0
    size = 0.0
    force = 0.0
    work = 0.0
    for k in range(start, stop):
        c = cells[k]
        p = values[k]
        by_gap = p * gap[c]
        by_displacement = p * displacement[c]
        total += by_gap + 0.5 * by_displacement
        size += abs(by_gap) + abs(by_displacement)
        force += p
        work += by_gap + by_displacement
    result[0] = total
    result[1] = size
    result[2] = force
    result[3] = work


def work(displacement: FloatArray, gap: FloatArray, cells: NDArray[Any], values: FloatArray) -> float:
    """Sum of p (gap + displacement) over some cells."""
    return float(in_blocks(cells.size, 1, _work, displacement, gap, cells, values)[:, 0].sum())


@_fast
def _work(start, stop, result, displacement, gap, cells, values):  # type: ignore[no-untyped-def]
    total = 0.0
    for k in range(start, stop):
        total += values[k] * (gap[cells[k]] + displacement[cells[k]])
    result[0] = total


@_fast
def scatter(field, cells, values):  # type: ignore[no-untyped-def]
    """field[cells] = values."""
    for k in range(cells.size):
        field[cells[k]] = values[k]


@_fast
def scatter_value(field, cells, value):  # type: ignore[no-untyped-def]
    """field[cells] = value."""
    for k in range(cells.size):
        field[cells[k]] = value


def squares(values: FloatArray) -> float:
    """Sum of squares."""
    return float(in_blocks(values.size, 1, _squares, values)[:, 0].sum())


@_fast
def _squares(start, stop, result, values):  # type: ignore[no-untyped-def]
    total = 0.0
    for k in range(start, stop):
        total += values[k] * values[k]
    result[0] = total


def turn(
    preconditioned: FloatArray, rise: FloatArray, share: float, residual: FloatArray, previous: FloatArray
) -> tuple[float, float]:
    """z -= share rise; return z.r and z.(r - r_previous)."""
    full, change = in_blocks(residual.size, 2, _turn, preconditioned, rise, share, residual, previous).sum(axis=0)
    return float(full), float(change)


@_fast
def _turn(start, stop, result, preconditioned, rise, share, residual, previous):  # type: ignore[no-untyped-def]
    full = 0.0
    change = 0.0
    for k in range(start, stop):
        z = preconditioned[k] - share * rise[k] if share else preconditioned[k]
        preconditioned[k] = z
        full += z * residual[k]
        change += z * (residual[k] - previous[k])
    result[0] = full
    result[1] = change


def new_direction(
    direction: FloatArray,
    preconditioned: FloatArray,
    beta: float,
    cells: NDArray[Any],
    field: NDArray[Any],
    residual: FloatArray,
) -> float:
    """t = z + beta t, also written to field[cells]; returns t.r."""
    partial = in_blocks(cells.size, 1, _new_direction, direction, preconditioned, beta, cells, field, residual)
    return float(partial[:, 0].sum())


@_fast
def _new_direction(start, stop, result, direction, preconditioned, beta, cells, field, residual):  # type: ignore[no-untyped-def]
    slope = 0.0
    for k in range(start, stop):
        t = preconditioned[k] + beta * direction[k]
        direction[k] = t
        field[cells[k]] = t
        slope += t * residual[k]
    result[0] = slope


def gather_dot(field: NDArray[Any], cells: NDArray[Any], out: FloatArray, direction: FloatArray) -> tuple[float, float]:
    """out = field[cells]; returns its sum and its product with the direction."""
    total, product = in_blocks(cells.size, 2, _gather_dot, field, cells, out, direction).sum(axis=0)
    return float(total), float(product)


@_fast
def _gather_dot(start, stop, result, field, cells, out, direction):  # type: ignore[no-untyped-def]
    total = 0.0
    product = 0.0
    for k in range(start, stop):
        value = np.float64(field[cells[k]])
        out[k] = value
        total += value
        product += value * direction[k]
    result[0] = total
    result[1] = product


def advance(
    pressure: FloatArray,
    residual: FloatArray,
    previous: FloatArray,
    direction: FloatArray,
    response: FloatArray,
    mean: float,
    step: float,
    cap: float,
) -> tuple[float, float, float]:
    """p -= step t, r -= step (q - mean), keeping the old r; returns |r|^2, max |r| and how far p left the bounds."""
    partial = in_blocks(pressure.size, 3, _advance, pressure, residual, previous, direction, response, mean, step, cap)
    return float(partial[:, 0].sum()), float(partial[:, 1].max()), float(partial[:, 2].max())


@_fast
def _advance(start, stop, result, pressure, residual, previous, direction, response, mean, step, cap):  # type: ignore[no-untyped-def]
    squares = 0.0
    largest = 0.0
    outside = 0.0
    for k in range(start, stop):
        p = pressure[k] - step * direction[k]
        pressure[k] = p
        outside = max(outside, max(-p, p - cap))
        r = residual[k]
        previous[k] = r
        r -= step * (response[k] - mean)
        residual[k] = r
        squares += r * r
        largest = max(largest, abs(r))
    result[0] = squares
    result[1] = largest
    result[2] = outside


def shifted_sum(values: FloatArray, shift: float, cap: float) -> tuple[float, int]:
    """Sum of clip(values + shift, 0, cap) and how many of them are strictly inside."""
    total, inside = in_blocks(values.size, 2, _shifted_sum, values, shift, cap).sum(axis=0)
    return float(total), int(inside)


@_fast
def _shifted_sum(start, stop, result, values, shift, cap):  # type: ignore[no-untyped-def]
    total = 0.0
    inside = 0
    for k in range(start, stop):
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
    for k in range(start, stop):
        total += values[k] - first
        lowest = min(lowest, values[k])
    result[0] = lowest
    result[1] = total


@_fast
def _squares_about(start, stop, result, values, first, mean):  # type: ignore[no-untyped-def]
    total = 0.0
    for k in range(start, stop):
        d = values[k] - first - mean
        total += d * d
    result[0] = total


def rescale(values: FloatArray, datum: float, factor: float, out: FloatArray) -> None:
    """out = (values - datum) factor."""
    in_blocks(values.size, 0, _rescale, values, datum, factor, out)


@_fast
def _rescale(start, stop, result, values, datum, factor, out):  # type: ignore[no-untyped-def]
    for k in range(start, stop):
        out[k] = (values[k] - datum) * factor


def assemble(
    pressure: FloatArray,
    displacement: FloatArray,
    gap: FloatArray,
    to_pressure: float,
    length: float,
    approach: float,
    cap: float,
    deformed: FloatArray,
    depth: FloatArray,
) -> tuple[float, float, float, int, int, float]:
    """Turn scaled results into SI units in place, and judge them from the pressure's own values.

    Writes the deformed gap and the plastic depth; returns the largest violation of the contact conditions (infinite for
    a pressure beyond its bounds), the largest displacement, the sum of pressures, the numbers of cells in contact and
    at the cap, and the sum of positive gaps.
    """
    partial = in_blocks(
        gap.size, 6, _assemble, pressure, displacement, gap, to_pressure, length, approach, cap, deformed, depth
    )
    largest, reach = partial[:, 0].max(), partial[:, 1].max()
    force, contact, capped, volume = partial[:, 2:].sum(axis=0)
    return float(largest), float(reach), float(force), int(contact), int(capped), float(volume)


@_strict
def _assemble(  # type: ignore[no-untyped-def]
    start, stop, result, pressure, displacement, gap, to_pressure, length, approach, cap, deformed, depth
):
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
