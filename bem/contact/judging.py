"""What a round is judged by, in as few passes over the cells with pressure and over the field: energy, approach, and
which cells violate their state.

Cells of one block of `passes` are looked at in one compiled call, more of them in blocks that threads share.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact import passes
from bem.contact.ordered import ABOVE_ALL, BELOW_ALL, number_at, place_of

FloatArray = NDArray[np.float64]
Cells = tuple[NDArray[np.int64], FloatArray, NDArray[np.int64]]
"""A pressure: cells between the bounds, their values, and cells at the cap."""

FREE, CONTACT, CAPPED = 0, 1, 2
"""State of a cell: no pressure; pressure between the bounds; pressure at the cap."""

SMALL = 4
"""Blocks of a field that one thread searches for violations: sharing them would take longer."""

NOTHING: Cells = (np.empty(0, np.int64), np.empty(0), np.empty(0, np.int64))
"""No pressure."""


class Survey(NamedTuple):
    """What a round is judged by, over the cells with pressures p, gaps g and displacements u.

    Sum, largest and smallest of g + u, and largest of |u|, of the cells between the bounds; of all the sums of
    p (g + u / 2), of |p g| + |p u|, of p and of p (g + u); and of q (g + u), q another pressure.
    """

    total: float
    deepest: float
    nearest: float
    reach: float
    energy: float
    size: float
    force: float
    work: float
    work_of_other: float


def survey(displacement: FloatArray, gap: FloatArray, pressure: Cells, cap: float, other: Cells = NOTHING) -> Survey:
    """Everything that is asked of the cells of a pressure, and what another one's work is."""
    if max(pressure[0].size, pressure[2].size, other[0].size, other[2].size) <= passes.BLOCK:
        found: tuple[float, ...] = _survey_all(displacement, gap, pressure, cap, other)
        return Survey(*found)
    seen = _in_blocks(displacement, gap, pressure[0], pressure[1])
    if pressure[2].size:
        seen = _both(seen, _in_blocks(displacement, gap, pressure[2], np.full(pressure[2].size, cap)))
    work = passes.sums(other[0].size, 1, _work, displacement, gap, other[0], other[1])[0]
    if other[2].size:
        work += passes.sums(other[2].size, 1, _work, displacement, gap, other[2], np.full(other[2].size, cap))[0]
    judged: list[float] = [*seen.tolist(), work]
    return Survey(*judged)


def _in_blocks(displacement: FloatArray, gap: FloatArray, cells: NDArray[Any], values: FloatArray) -> FloatArray:
    """`_survey` of any number of cells."""
    partial = passes.in_blocks(cells.size, 8, _survey, displacement, gap, cells, values)
    if partial.shape[0] == 1:
        return np.asarray(partial[0])
    seen = partial.sum(axis=0)
    seen[1] = partial[:, 1].max(initial=-np.inf)
    seen[2] = partial[:, 2].min(initial=np.inf)
    seen[3] = partial[:, 3].max(initial=0.0)
    return np.asarray(seen)


@compiled
def _survey_all(displacement, gap, pressure, cap, other):
    cells, values, capped = pressure
    seen, work = np.zeros(8), np.zeros(1)
    _survey(0, cells.size, seen, displacement, gap, cells, values)
    if capped.size:
        more = np.zeros(8)
        _survey(0, capped.size, more, displacement, gap, capped, np.full(capped.size, cap))
        seen = _both(seen, more)
    cells, values, capped = other
    _work(0, cells.size, work, displacement, gap, cells, values)
    total = work[0]
    if capped.size:
        _work(0, capped.size, work, displacement, gap, capped, np.full(capped.size, cap))
        total += work[0]
    return seen[0], seen[1], seen[2], seen[3], seen[4], seen[5], seen[6], seen[7], total


@compiled
def _both(inside, capped):
    """A survey with that of the cells at the cap."""
    seen = inside.copy()
    if inside[2] == np.inf:  # no cell between the bounds
        seen[3] = capped[3]
    for k in range(4, 8):
        seen[k] += capped[k]
    return seen


@compiled
def _survey(start, stop, result, displacement, gap, cells, values):
    total = 0.0
    deepest, nearest, reach = BELOW_ALL, ABOVE_ALL, place_of(0.0)
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
        place, far, known = place_of(opening), place_of(abs(u)), opening == opening
        deepest = max(deepest, place if known else BELOW_ALL)
        nearest = min(nearest, place if known else ABOVE_ALL)
        reach = max(reach, far if u == u else BELOW_ALL)
        by_gap = p * g
        by_displacement = p * u
        energy += by_gap + 0.5 * by_displacement
        size += abs(by_gap) + abs(by_displacement)
        force += p
        work += by_gap + by_displacement
    result[0] = total
    result[1] = number_at(deepest)
    result[2] = number_at(nearest)
    result[3] = number_at(reach)
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
def mark(state, cells, capped):
    """The state of every cell."""
    state[:] = FREE
    for k in range(cells.size):
        state[np.uint64(cells[k])] = CONTACT
    for k in range(capped.size):
        state[np.uint64(capped[k])] = CAPPED


def find_violations(
    displacement: FloatArray, gap: FloatArray, state: NDArray[np.uint8], pressure: Cells, approach: float
) -> tuple[NDArray[np.int32], float]:
    """Cells that should not stay free (they overlap) or at the cap (they open), and the largest violation; the state of
    every cell is written."""
    found = np.empty(gap.size, np.int32)
    if gap.size <= SMALL * passes.BLOCK:
        count, largest = _mark_and_find(displacement, gap, state, pressure, approach, found)
        return found[: int(count)], largest
    mark(state, pressure[0], pressure[2])
    partial = passes.in_blocks(gap.size, 2, _find_violations, displacement, gap, state, approach, found)
    starts = range(0, gap.size, passes.BLOCK)
    parts = [found[start : start + int(count)] for start, count in zip(starts, partial[:, 0].tolist(), strict=True)]
    return np.concatenate(parts), float(partial[:, 1].max())


@compiled
def _mark_and_find(displacement, gap, state, pressure, approach, found):
    mark(state, pressure[0], pressure[2])
    result = np.zeros(2)
    _find_violations(0, gap.size, result, displacement, gap, state, approach, found)
    return result[0], result[1]


@compiled
def _find_violations(start, stop, result, displacement, gap, state, approach, found):
    place = start
    largest = 0.0
    # most stretches have none: these are only counted, without branches, 1 less the state being the sign that counts
    for first in range(start, stop, 256):
        last = min(first + 256, stop)
        own_state, own_gap, own_displacement = state[first:last], gap[first:last], displacement[first:last]
        count = 0
        for k in range(last - first):
            count += (1.0 - own_state[k]) * (approach - own_gap[k] - own_displacement[k]) > 0
        if count == 0:
            continue
        for c in range(first, last):
            if state[c] == CONTACT:
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
    """Largest gap + displacement of cells with pressure, and smallest of cells that are not capped (or infinity)."""
    partial = passes.in_blocks(gap.size, 2, _separations, displacement, gap, state)
    return float(partial[:, 0].max()), float(partial[:, 1].min())


@compiled
def _separations(start, stop, result, displacement, gap, state):
    displacement, gap, state = displacement[start:stop], gap[start:stop], state[start:stop]
    deepest, nearest = BELOW_ALL, ABOVE_ALL
    for k in range(gap.size):
        value = gap[k] + displacement[k]
        place, known = place_of(value), value == value
        deepest = max(deepest, place if known & (state[k] != FREE) else BELOW_ALL)
        nearest = min(nearest, place if known & (state[k] != CAPPED) else ABOVE_ALL)
    result[0] = number_at(deepest)
    result[1] = number_at(nearest)
