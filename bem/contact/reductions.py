"""Fused reductions over a field or over the cells with pressure; each pass reads and writes memory once.

The passes of steps 1, 6, 7 and 12 of `bem.contact`. Passes over whole fields work in blocks of fixed size that threads
share. Sums are formed block by block in order, so a result has the same bits for every number of threads.

- `contact_sums`: energy over the cells with pressure, sum and extremes of gap + displacement between the bounds;
- `find_violations`: the state of each cell, and the cells that violate it;
- `assemble`: the certificate, and the results in SI units;
- `moments`, `rescale`, `scatter`, `shift_to`: statistics, units, scattering, and the Newton iteration for a shift.

Verified in tests/contact/test_contact_reductions.py.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact.cell_states import CAPPED, ELASTIC, OPEN
from bem.threads import share

FloatArray = NDArray[np.float64]
Cells = tuple[NDArray[np.int64], FloatArray, NDArray[np.int64]]
"""A pressure: cells between the bounds, their values, and cells at the cap."""

NO_PRESSURE: Cells = (np.empty(0, np.int64), np.empty(0), np.empty(0, np.int64))

BLOCK = 1 << 15
"""Entries of a block: enough to hide the call of a thread, few enough to share the work."""

_ONE_THREAD = 4
"""Blocks of a field up to which one thread searches for violations: sharing the work would take longer."""


def run_blocks(size: int, results: int, kernel: Callable[..., None], *arguments: Any) -> FloatArray:
    """Call `kernel(start, stop, out, *arguments)` for all blocks of `size` entries; return the results (blocks,
    results)."""
    blocks = -(-size // BLOCK)
    partial = np.zeros((blocks, results))
    if blocks == 1:
        kernel(0, size, partial[0], *arguments)
        return partial

    def work(_worker: int, block: int) -> None:
        kernel(block * BLOCK, min(size, (block + 1) * BLOCK), partial[block], *arguments)

    share(work, blocks, size)
    return partial


def sums(size: int, results: int, kernel: Callable[..., None], *arguments: Any) -> list[float]:
    """Return the results of a kernel, summed over the blocks in order."""
    if size <= BLOCK:
        found = np.zeros(results)
        kernel(0, size, found, *arguments)
        return found.tolist()
    return run_blocks(size, results, kernel, *arguments).sum(axis=0).tolist()


@compiled
def scatter(field, cells, values, capped, cap):
    """Scatter a pressure to a field: `values` on `cells`, `cap` on `capped`, zero elsewhere."""
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
    """Return the shift s in (0, high) for which clip(values + s, 0, cap) sums to `wanted`.

    Newton's method from `start`, with bisection where a step leaves the bracket; sums are formed in blocks.
    """
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
    """Return minimum, mean and standard deviation; sums are of differences from the first value."""
    first = float(values[0])
    partial = run_blocks(values.size, 2, _least_and_sum, values, first)
    mean = float(partial[:, 1].sum()) / values.size
    about = run_blocks(values.size, 1, _squares_about, values, first, mean)
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
    """Write (values - datum) * factor to `out`."""
    run_blocks(values.size, 0, _rescale, values, datum, factor, out)


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
    """Convert scaled results to SI units in place and evaluate the contact conditions.

    fields : (pressure, displacement, gap), one-dimensional; the first two scaled by `units` (pressure [Pa], length
        [m]).
    results : (deformed gap, plastic depth), written; the plastic depth is zero on entry.

    Returns
    -------
    Largest violation of the contact conditions [m] (infinite for a pressure out of bounds, not-a-number for such a
    displacement), largest displacement [m], sum of pressures [Pa], numbers of cells in contact and at the cap, and sum
    of the positive gaps [m].
    """
    partial = run_blocks(fields[0].size, 6, _assemble, fields, units, approach, cap, results)
    largest, largest_displacement = partial[:, 0].max(), partial[:, 1].max()
    force, contact, capped, volume = partial[:, 2:].sum(axis=0)
    return float(largest), float(largest_displacement), float(force), int(contact), int(capped), float(volume)


_STRETCH = 128
"""Cells of a stretch that is evaluated without branches, in vector instructions, while it is in the cache."""

_MAGNITUDE = np.iinfo(np.int64).max
_INFINITE = int(np.float64(np.inf).view(np.int64))
"""Nonnegative floats are ordered as their bits, with not-a-number after infinity: an integer maximum vectorises."""


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
        touching = _evaluate(given, units, approach, cap, deformed, violations, openings)
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
def _evaluate(given, units, approach, cap, deformed, violations, openings):
    """Convert to SI units; write violations, deformed gaps and open gaps; return the number of cells with pressure."""
    pressure, displacement, gap = given
    to_pressure, length = units
    most = cap * (1 + 1e-14)  # a uniform first pressure at the cap is force / cells, which rounds
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
        is_open = p <= 0
        deformed[k] = apart if is_open else opening
        openings[k] = apart if is_open else 0.0
        violation = -opening if is_open else opening if p >= cap else abs(opening)
        violations[k] = violation if inside else np.inf
        touching += not is_open
    return touching


@compiled
def _raise_largest(bits, violations, displacement):
    """Update the bits of the largest violation and of the largest absolute displacement."""
    largest, largest_displacement = bits[0], bits[1]
    for k in range(displacement.size):
        largest = max(largest, violations[k])
        largest_displacement = max(largest_displacement, displacement[k] & _MAGNITUDE)
    bits[0], bits[1] = largest, largest_displacement


@compiled
def _sum(values):
    total = 0.0
    for k in range(values.size):
        total += values[k]
    return total


class ContactSums(NamedTuple):
    """Reductions over the cells with pressure p, undeformed gap g and displacement u.

    separation_sum, largest_separation, smallest_separation : sum, maximum and minimum of g + u over the cells between
        the bounds.
    largest_displacement : maximum of abs(u) over the cells between the bounds, or over the capped cells if there are
        none between.
    energy : sum of p (g + u / 2) over all cells with pressure.
    energy_size : sum of abs(p g) + abs(p u), the scale of the energy's round-off.
    force : sum of p.
    work : sum of p (g + u).
    work_of_other : sum of q (g + u) for another pressure q.
    """

    separation_sum: float
    largest_separation: float
    smallest_separation: float
    largest_displacement: float
    energy: float
    energy_size: float
    force: float
    work: float
    work_of_other: float


def contact_sums(
    displacement: FloatArray, gap: FloatArray, pressure: Cells, cap: float, other: Cells = NO_PRESSURE
) -> ContactSums:
    """Return the reductions of a pressure, and the work of another pressure on the same displacement."""
    if max(pressure[0].size, pressure[2].size, other[0].size, other[2].size) <= BLOCK:
        found: tuple[float, ...] = _sum_all_cells(displacement, gap, pressure, cap, other)
        return ContactSums(*found)
    seen = _sum_cells_in_blocks(displacement, gap, pressure[0], pressure[1])
    if pressure[2].size:
        seen = _add_capped(seen, _sum_cells_in_blocks(displacement, gap, pressure[2], np.full(pressure[2].size, cap)))
    work = sums(other[0].size, 1, _work, displacement, gap, other[0], other[1])[0]
    if other[2].size:
        work += sums(other[2].size, 1, _work, displacement, gap, other[2], np.full(other[2].size, cap))[0]
    judged: list[float] = [*seen.tolist(), work]
    return ContactSums(*judged)


def _sum_cells_in_blocks(
    displacement: FloatArray, gap: FloatArray, cells: NDArray[Any], values: FloatArray
) -> FloatArray:
    """Return `_sum_cells` of any number of cells."""
    partial = run_blocks(cells.size, 8, _sum_cells, displacement, gap, cells, values)
    if partial.shape[0] == 1:
        return np.asarray(partial[0])
    seen = partial.sum(axis=0)
    seen[1] = partial[:, 1].max(initial=-np.inf)
    seen[2] = partial[:, 2].min(initial=np.inf)
    seen[3] = partial[:, 3].max(initial=0.0)
    return np.asarray(seen)


@compiled
def _sum_all_cells(displacement, gap, pressure, cap, other):
    cells, values, capped = pressure
    seen, work = np.zeros(8), np.zeros(1)
    _sum_cells(0, cells.size, seen, displacement, gap, cells, values)
    if capped.size:
        more = np.zeros(8)
        _sum_cells(0, capped.size, more, displacement, gap, capped, np.full(capped.size, cap))
        seen = _add_capped(seen, more)
    cells, values, capped = other
    _work(0, cells.size, work, displacement, gap, cells, values)
    total = work[0]
    if capped.size:
        _work(0, capped.size, work, displacement, gap, capped, np.full(capped.size, cap))
        total += work[0]
    return seen[0], seen[1], seen[2], seen[3], seen[4], seen[5], seen[6], seen[7], total


@compiled
def _add_capped(inside, capped):
    """Add the survey of the cells at the cap to that of the cells between the bounds."""
    seen = inside.copy()
    if inside[2] == np.inf:  # no cell between the bounds
        seen[3] = capped[3]
    for k in range(4, 8):
        seen[k] += capped[k]
    return seen


@compiled
def _sum_cells(start, stop, result, displacement, gap, cells, values):
    total = 0.0
    largest_separation, smallest_separation, largest_displacement = -np.inf, np.inf, 0.0
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
        if opening > largest_separation:
            largest_separation = opening
        if opening < smallest_separation:
            smallest_separation = opening
        if abs(u) > largest_displacement:
            largest_displacement = abs(u)
        by_gap = p * g
        by_displacement = p * u
        energy += by_gap + 0.5 * by_displacement
        size += abs(by_gap) + abs(by_displacement)
        force += p
        work += by_gap + by_displacement
    result[0] = total
    result[1] = largest_separation
    result[2] = smallest_separation
    result[3] = largest_displacement
    result[4] = energy
    result[5] = size
    result[6] = force
    result[7] = work


@compiled
def _work(start, stop, result, displacement, gap, cells, values):
    cells, values = cells[start:stop], values[start:stop]
    total = 0.0
    for k in range(cells.size):
        c = np.uint64(cells[k])
        total += values[k] * (gap[c] + displacement[c])
    result[0] = total


@compiled
def mark_states(state, cells, capped):
    """Write the state of every cell."""
    state[:] = OPEN
    for k in range(cells.size):
        state[np.uint64(cells[k])] = ELASTIC
    for k in range(capped.size):
        state[np.uint64(capped[k])] = CAPPED


def find_violations(
    displacement: FloatArray, gap: FloatArray, state: NDArray[np.uint8], pressure: Cells, approach: float
) -> tuple[NDArray[np.int32], float]:
    """Write the state of every cell; return the open and capped cells that violate it, and their largest violation.

    Open cells violate their state where the bodies overlap, cells at the cap where the gap opens. The gap of the cells
    between the bounds is not looked at.
    """
    found = np.empty(gap.size, np.int32)
    if gap.size <= _ONE_THREAD * BLOCK:
        count, largest = _mark_and_find(displacement, gap, state, pressure, approach, found)
        return found[: int(count)], largest
    mark_states(state, pressure[0], pressure[2])
    partial = run_blocks(gap.size, 2, _find_violations, displacement, gap, state, approach, found)
    starts = range(0, gap.size, BLOCK)
    parts = [found[start : start + int(count)] for start, count in zip(starts, partial[:, 0].tolist(), strict=True)]
    return np.concatenate(parts), float(partial[:, 1].max())


@compiled
def _mark_and_find(displacement, gap, state, pressure, approach, found):
    mark_states(state, pressure[0], pressure[2])
    result = np.zeros(2)
    _find_violations(0, gap.size, result, displacement, gap, state, approach, found)
    return result[0], result[1]


@compiled
def _find_violations(start, stop, result, displacement, gap, state, approach, found):
    place = start
    largest = 0.0
    # most stretches have no violation: count without branches; 1 - state is the sign of a violation
    for first in range(start, stop, 256):
        last = min(first + 256, stop)
        own_state, own_gap, own_displacement = state[first:last], gap[first:last], displacement[first:last]
        count = 0
        for k in range(last - first):
            count += (1.0 - own_state[k]) * (approach - own_gap[k] - own_displacement[k]) > 0
        if count == 0:
            continue
        for c in range(first, last):
            if state[c] == ELASTIC:
                continue
            value = approach - gap[c] - displacement[c]
            if state[c] == CAPPED:
                value = -value
            if value > 0:
                found[place] = c
                place += 1
                largest = max(largest, value)
    result[0] = place - start
    result[1] = largest


def separations(displacement: FloatArray, gap: FloatArray, state: NDArray[np.uint8]) -> tuple[float, float]:
    """Return the largest gap + displacement of cells with pressure, and the smallest of cells below the cap."""
    partial = run_blocks(gap.size, 2, _separations, displacement, gap, state)
    return float(partial[:, 0].max()), float(partial[:, 1].min())


@compiled
def _separations(start, stop, result, displacement, gap, state):
    displacement, gap, state = displacement[start:stop], gap[start:stop], state[start:stop]
    largest_separation, smallest_separation = -np.inf, np.inf
    for k in range(gap.size):
        value = gap[k] + displacement[k]
        if state[k] != OPEN and value > largest_separation:
            largest_separation = value
        if state[k] != CAPPED and value < smallest_separation:
            smallest_separation = value
    result[0] = largest_separation
    result[1] = smallest_separation
