"""Tractions inside discs: Coulomb's bound on every cell, with a total force where one is given."""

from __future__ import annotations

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray

_ROUNDS = 200
_EXACT = 1e-14
"""Relative miss of the force at which the search for it ends."""


@compiled
def _nearest(
    wanted: FloatArray, bound: FloatArray, offset: FloatArray, force: FloatArray, out: FloatArray
) -> FloatArray:
    """The nearest tractions to wanted + offset into `out`; sums: of their potential less force x offset, of both
    tractions, and of the potential's second derivatives xx, yy, xy.
    """
    sums = np.zeros(6)
    for k in range(bound.size):
        x, y, limit = wanted[0, k] + offset[0], wanted[1, k] + offset[1], bound[k]
        length = np.sqrt(x * x + y * y)
        if length > limit:
            ratio = limit / length
            sums[0] += limit * (length - 0.5 * limit)
            sums[3] += ratio * (y / length) ** 2
            sums[4] += ratio * (x / length) ** 2
            sums[5] -= ratio * (x / length) * (y / length)
            x, y = x * ratio, y * ratio
        else:
            sums[0] += 0.5 * length * length
            sums[3] += 1.0
            sums[4] += 1.0
        sums[1] += x
        sums[2] += y
        out[0, k], out[1, k] = x, y
    sums[0] -= force[0] * offset[0] + force[1] * offset[1]
    return sums


@compiled
def _step(sums: FloatArray, miss: FloatArray, cells: int, limit: float) -> FloatArray:
    """Newton's step of the offset, no longer than `limit`."""
    xx, yy, xy = sums[3] + 1e-12 * cells, sums[4] + 1e-12 * cells, sums[5]
    determinant = xx * yy - xy * xy
    step = np.empty(2)
    step[0] = (yy * miss[0] - xy * miss[1]) / determinant
    step[1] = (xx * miss[1] - xy * miss[0]) / determinant
    longest = max(abs(step[0]), abs(step[1]))
    if longest > limit:
        step *= limit / longest
    return step


@compiled
def nearest_with_force(wanted: FloatArray, bound: FloatArray, force: FloatArray, out: FloatArray) -> FloatArray:
    """The tractions (2, n) within `bound` nearest to wanted + offset whose sum is `force`; returns the offset (2,).

    The offset minimises a convex potential whose gradient is the sum less the force: Newton with halved steps.
    """
    total = bound.sum()
    offset = np.zeros(2)
    sums = _nearest(wanted, bound, offset, force, out)
    miss = np.empty(2)
    trial = np.empty(2)
    for rounds in range(_ROUNDS):
        miss[0], miss[1] = force[0] - sums[1], force[1] - sums[2]
        if max(abs(miss[0]), abs(miss[1])) <= _EXACT * total:
            break
        step = _step(sums, miss, bound.size, 4.0 * (1 + rounds) * bound.max())
        fall = miss[0] * step[0] + miss[1] * step[1]
        share = 1.0
        before = sums[0]
        for _ in range(40):
            trial[0], trial[1] = offset[0] + share * step[0], offset[1] + share * step[1]
            sums = _nearest(wanted, bound, trial, force, out)
            if sums[0] <= before - 1e-4 * share * fall or abs(sums[0] - before) <= 1e-13 * abs(before):
                break
            share *= 0.5
        offset[:] = trial
    return offset


@compiled
def nearest(wanted: FloatArray, bound: FloatArray, out: FloatArray) -> None:
    """The tractions (2, n) within `bound` nearest to the wanted ones."""
    _nearest(wanted, bound, np.zeros(2), np.zeros(2), out)
