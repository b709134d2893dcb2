"""Tractions inside discs: Coulomb's bound on every cell, with a total force where one is given."""

from __future__ import annotations

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray

_ROUNDS = 200
_EXACT = 1e-14
"""Miss of the force, relative to the sum of all tractions, at which the search for it ends."""

_ROUNDING = 1e-10
"""Miss of the force, relative to the sum of all bounds, below which a miss that does not fall is rounding."""

_HALVINGS = 60
_GROWTH = 8.0
"""Factor on the longest step of that search after a step of that length."""


@compiled
def _nearest(wanted: FloatArray, bound: FloatArray, offset: FloatArray, out: FloatArray) -> FloatArray:
    """Write the nearest tractions to wanted + offset into `out`.

    Returns the sums (6,) of both tractions, of their derivatives xx, yy, xy by the offset, and of absolute values.
    """
    sums = np.zeros(6)
    for k in range(bound.size):
        x, y, limit = wanted[0, k] + offset[0], wanted[1, k] + offset[1], bound[k]
        length = np.sqrt(x * x + y * y)
        if length > limit:
            ratio = limit / length
            sums[2] += ratio * (y / length) ** 2
            sums[3] += ratio * (x / length) ** 2
            sums[4] -= ratio * (x / length) * (y / length)
            x, y = x * ratio, y * ratio
        else:
            sums[2] += 1.0
            sums[3] += 1.0
        sums[0] += x
        sums[1] += y
        sums[5] += abs(x) + abs(y)
        out[0, k], out[1, k] = x, y
    return sums


@compiled
def _step(sums: FloatArray, miss: FloatArray, limit: float) -> FloatArray:
    """Newton's step of the offset, no longer than `limit`."""
    flat = 1e-14 * (sums[2] + sums[3])
    xx, yy, xy = sums[2] + flat, sums[3] + flat, sums[4]
    determinant = xx * yy - xy * xy
    step = miss * np.inf
    if determinant > 0:
        step[0] = (yy * miss[0] - xy * miss[1]) / determinant
        step[1] = (xx * miss[1] - xy * miss[0]) / determinant
    longest = max(abs(step[0]), abs(step[1]))
    if not longest < np.inf or not step[0] * miss[0] + step[1] * miss[1] > 0:  # no curvature is left to rounding
        step = miss * (limit / max(abs(miss[0]), abs(miss[1])))
    elif longest > limit:
        step *= limit / longest
    return step


@compiled
def nearest_with_force(wanted: FloatArray, bound: FloatArray, force: FloatArray, out: FloatArray) -> FloatArray:
    """Find the tractions (2, n) within `bound` nearest to wanted + offset whose sum is `force`; return the offset (2,).

    The offset minimises a convex potential whose gradient is the sum less the force. Newton's steps are limited to a
    length that grows where they are, and are shortened where they go past the least potential along them by more than
    half of the slope.
    """
    total = bound.sum()
    offset = np.zeros(2)
    sums = _nearest(wanted, bound, offset, out)
    miss = np.empty(2)
    trial = np.empty(2)
    limit = 4.0 * bound.max()
    exact = _EXACT + 2e-16 * np.sqrt(bound.size)
    last = np.inf
    for _ in range(_ROUNDS):
        miss[0], miss[1] = force[0] - sums[0], force[1] - sums[1]
        missed = max(abs(miss[0]), abs(miss[1]))
        if missed <= exact * sums[5] or last <= missed <= _ROUNDING * total:
            break
        last = missed
        step = _step(sums, miss, limit)
        slope = miss[0] * step[0] + miss[1] * step[1]
        size = max(abs(step[0]), abs(step[1]))
        share = 1.0
        for _ in range(_HALVINGS):
            trial[0], trial[1] = offset[0] + share * step[0], offset[1] + share * step[1]
            sums = _nearest(wanted, bound, trial, out)
            left = (force[0] - sums[0]) * step[0] + (force[1] - sums[1]) * step[1]
            if left >= -0.5 * slope:
                break
            share *= max(0.1, min(0.5, slope / (slope - left)))
        if share == 1 and size >= 0.999 * limit:
            limit *= _GROWTH
        elif share < 1:
            limit = max(2 * share * size, 1e-3 * bound.max())
        moved = max(abs(trial[0] - offset[0]), abs(trial[1] - offset[1]))
        offset[:] = trial
        if moved <= 1e-16 * max(abs(offset[0]), abs(offset[1])):
            break
    return offset


@compiled
def nearest(wanted: FloatArray, bound: FloatArray, out: FloatArray) -> None:
    """The tractions (2, n) within `bound` nearest to the wanted ones."""
    _nearest(wanted, bound, np.zeros(2), out)
