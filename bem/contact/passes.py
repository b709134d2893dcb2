"""Fused passes over a field or over the cells in contact; each reads and writes memory once.

Every pass works in blocks of fixed size, shared between threads; sums are formed over blocks in order, so that a result
has the same bits whatever the number of threads.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.threads import share

FloatArray = NDArray[np.float64]

BLOCK = 1 << 15
"""Entries that one thread works on at a time: enough to hide the call, few enough to share."""


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

    share(work, blocks, size)
    return partial


def sums(size: int, results: int, kernel: Callable[..., None], *arguments: Any) -> list[float]:
    """What a kernel finds, added over the blocks in order."""
    if size <= BLOCK:
        found = np.zeros(results)
        kernel(0, size, found, *arguments)
        return found.tolist()
    return in_blocks(size, results, kernel, *arguments).sum(axis=0).tolist()


@compiled
def place(field, cells, values, capped, cap):
    """field[cells] = values, field[capped] = cap, zero elsewhere."""
    field[:] = 0
    for k in range(cells.size):
        field[cells[k]] = values[k]
    for k in range(capped.size):
        field[capped[k]] = cap


@compiled
def _shifted_sum(start, stop, result, values, shift, cap):
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


@compiled
def shift_to(values, start, high, wanted, cap, block):
    """The s that makes the sum of clip(values + s, 0, cap) the one wanted: from a first one, between zero and `high`,
    by Newton's method where that stays between. All steps are one call, sums those of blocks in order."""
    low, shift = 0.0, start
    found = np.zeros(2)
    for _ in range(100):
        total, inside = 0.0, 0.0
        for first in range(0, values.size, block):
            _shifted_sum(first, min(values.size, first + block), found, values, shift, cap)
            total += found[0]
            inside += found[1]
        error = total - wanted
        if abs(error) <= 4e-16 * wanted:
            break
        if error > 0:
            high = shift
        else:
            low = shift
        trial = shift - error / inside if inside > 0 else np.nan
        if not low < trial < high:
            trial = 0.5 * (low + high)
        if trial == shift:
            break
        shift = trial
    return shift


def moments(values: FloatArray) -> tuple[float, float, float]:
    """Minimum, mean and root mean square about the mean; sums are of differences from the first value."""
    first = float(values[0])
    partial = in_blocks(values.size, 2, _least_and_sum, values, first)
    mean = float(partial[:, 1].sum()) / values.size
    about = in_blocks(values.size, 1, _squares_about, values, first, mean)
    return float(partial[:, 0].min()), first + mean, float(np.sqrt(about[:, 0].sum() / values.size))


@compiled
def _least_and_sum(start, stop, result, values, first):
    lowest = values[start]
    total = 0.0
    values = values[start:stop]
    for k in range(values.size):
        total += values[k] - first
        lowest = min(lowest, values[k])
    result[0] = lowest
    result[1] = total


@compiled
def _squares_about(start, stop, result, values, first, mean):
    values = values[start:stop]
    total = 0.0
    for k in range(values.size):
        d = values[k] - first - mean
        total += d * d
    result[0] = total


def rescale(values: FloatArray, datum: float, factor: float, out: FloatArray) -> None:
    """out = (values - datum) factor."""
    in_blocks(values.size, 0, _rescale, values, datum, factor, out)


@compiled
def _rescale(start, stop, result, values, datum, factor, out):
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
    gap, plastic depth), written; the latter zero before. Returns the largest violation of the contact conditions
    (infinite for a pressure beyond its bounds), the largest displacement, the sum of pressures, the numbers of cells in
    contact and at the cap, and the sum of positive gaps.
    """
    partial = in_blocks(fields[0].size, 6, _assemble, fields, units, approach, cap, results)
    largest, reach = partial[:, 0].max(), partial[:, 1].max()
    force, contact, capped, volume = partial[:, 2:].sum(axis=0)
    return float(largest), float(reach), float(force), int(contact), int(capped), float(volume)


_STRETCH = 128
"""Cells that are judged at a time: without branches, so in vectors, and what is made of them is still in the cache."""

_MAGNITUDE = np.iinfo(np.int64).max
_INFINITE = int(np.float64(np.inf).view(np.int64))
"""Numbers that are not negative are in the order of their bits, and what is no number comes after infinity: the largest
is found in vectors, which the order of numbers, with those that are none, forbids."""


@compiled
def _assemble(start, stop, result, fields, units, approach, cap, results):
    force, volume, contact, capped = 0.0, 0.0, 0, 0
    bits = np.zeros(2, np.int64)
    violations, openings = np.empty(_STRETCH), np.empty(_STRETCH)
    for first in range(start, stop, _STRETCH):
        last = min(first + _STRETCH, stop)
        pressure, displacement, gap = fields[0][first:last], fields[1][first:last], fields[2][first:last]
        deformed = results[0][first:last]
        given = pressure, displacement, gap
        touching = _judge(given, units, approach, cap, deformed, violations, openings)
        _raise_largest(bits, violations[: gap.size].view(np.int64), displacement.view(np.int64))
        volume += _sum(openings[: gap.size])
        if touching == 0:
            continue
        contact += touching
        for k in range(gap.size):
            p = pressure[k]
            if not p <= 0:
                force += p
                if p >= cap:
                    capped += 1
                    results[1][first + k] = max(-deformed[k], 0.0)
    largest = bits.view(np.float64)
    result[0] = largest[0] if bits[1] <= _INFINITE else np.nan
    result[1] = largest[1]
    result[2] = force
    result[3] = contact
    result[4] = capped
    result[5] = volume


@compiled
def _judge(given, units, approach, cap, deformed, violations, openings):
    """Into SI units; violation, deformed gap and, where no pressure is, its positive part. How many have pressure."""
    pressure, displacement, gap = given
    to_pressure, length = units
    most = cap * (1 + 1e-14)  # round-off of the units
    touching = 0
    for k in range(gap.size):
        p = pressure[k] * to_pressure
        inside = (p >= 0) & (p <= most)
        p = min(p, cap)
        u = displacement[k] * length
        pressure[k] = p
        displacement[k] = u
        opening = gap[k] + u - approach
        apart = max(opening, 0.0)
        free = p <= 0
        deformed[k] = apart if free else opening
        openings[k] = apart if free else 0.0
        violation = -opening if free else opening if p >= cap else abs(opening)
        violations[k] = violation if inside else np.inf
        touching += not free
    return touching


@compiled
def _raise_largest(bits, violations, displacement):
    """Bits of the largest violation above zero, and of the largest displacement either way."""
    largest, reach = bits[0], bits[1]
    for k in range(displacement.size):
        largest = max(largest, violations[k])
        reach = max(reach, displacement[k] & _MAGNITUDE)
    bits[0], bits[1] = largest, reach


@compiled
def _sum(values):
    total = 0.0
    for k in range(values.size):
        total += values[k]
    return total
