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


@_fast
def place(field, cells, values, capped, cap):  # type: ignore[no-untyped-def]
    """field[cells] = values, field[capped] = cap, zero elsewhere."""
    field[:] = 0
    for k in range(cells.size):
        field[cells[k]] = values[k]
    for k in range(capped.size):
        field[capped[k]] = cap


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
