"""Euclidean projection onto the friction discs abs(q) <= friction x pressure, on request with a given total force.

Cost: one pass over the cells in contact, or one pass per Newton step of the two multipliers of the force.
"""

from __future__ import annotations

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray

_ITERATIONS = 200
"""Limit of the Newton steps for the offset."""

_EXACT = 1e-14
"""Error of the force, relative to the sum of all tractions, at which the Newton iteration ends."""

_ROUNDING = 1e-10
"""Error of the force, relative to the sum of all bounds, below which an error that does not fall is rounding."""

_BACKTRACKS = 60
"""Limit of the trials of a line search."""

_GROWTH = 8.0
"""Growth of the longest step after a step of that length."""


@compiled
def project_to_friction_discs(trial: FloatArray, bound: FloatArray, out: FloatArray) -> None:
    """Write the tractions (2, n) within `bound` (n,) that are nearest to the tractions `trial`."""
    _project(trial, bound, np.zeros(2), out)


@compiled
def project_with_force(trial: FloatArray, bound: FloatArray, traction_sum: FloatArray, out: FloatArray) -> FloatArray:
    """Write the tractions (2, n) within `bound` (n,) whose sum is `traction_sum` (2,) and that are nearest to `trial`.

    They are the projection of trial + offset; returns the offset (2,), the Lagrange multiplier of the sum. The offset
    minimises a convex potential whose gradient is the sum of the tractions less `traction_sum`. Newton's method with a
    trust region: the longest step grows where a step of that length is accepted. A step is shortened if the slope of
    the potential at its end is more than half of the initial slope, with the opposite sign.
    """
    total = bound.sum()
    offset = np.zeros(2)
    sums = _project(trial, bound, offset, out)
    error = np.empty(2)
    trial_offset = np.empty(2)
    limit = 4.0 * bound.max()
    exact = _EXACT + 2e-16 * np.sqrt(bound.size)
    last = np.inf
    for _ in range(_ITERATIONS):
        error[0], error[1] = traction_sum[0] - sums[0], traction_sum[1] - sums[1]
        largest = max(abs(error[0]), abs(error[1]))
        if largest <= exact * sums[5] or last <= largest <= _ROUNDING * total:
            break
        last = largest
        step = _newton_step(sums, error, limit)
        slope = error[0] * step[0] + error[1] * step[1]
        size = max(abs(step[0]), abs(step[1]))
        length = 1.0
        for _ in range(_BACKTRACKS):
            trial_offset[0], trial_offset[1] = offset[0] + length * step[0], offset[1] + length * step[1]
            sums = _project(trial, bound, trial_offset, out)
            end_slope = (traction_sum[0] - sums[0]) * step[0] + (traction_sum[1] - sums[1]) * step[1]
            if end_slope >= -0.5 * slope:
                break
            length *= max(0.1, min(0.5, slope / (slope - end_slope)))
        if length == 1 and size >= 0.999 * limit:
            limit *= _GROWTH
        elif length < 1:
            limit = max(2 * length * size, 1e-3 * bound.max())
        change = max(abs(trial_offset[0] - offset[0]), abs(trial_offset[1] - offset[1]))
        offset[:] = trial_offset
        if change <= 1e-16 * max(abs(offset[0]), abs(offset[1])):
            break
    return offset


@compiled
def _project(trial: FloatArray, bound: FloatArray, offset: FloatArray, out: FloatArray) -> FloatArray:
    """Write the projection of trial + offset onto the discs.

    Returns sums (6,) over the cells: both tractions, their derivatives xx, yy and xy with respect to the offset, and
    absolute values.
    """
    sums = np.zeros(6)
    for k in range(bound.size):
        x, y, limit = trial[0, k] + offset[0], trial[1, k] + offset[1], bound[k]
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
def _newton_step(sums: FloatArray, error: FloatArray, limit: float) -> FloatArray:
    """Return the Newton step of the offset, no longer than `limit`."""
    flat = 1e-14 * (sums[2] + sums[3])
    xx, yy, xy = sums[2] + flat, sums[3] + flat, sums[4]
    determinant = xx * yy - xy * xy
    step = error * np.inf
    if determinant > 0:
        step[0] = (yy * error[0] - xy * error[1]) / determinant
        step[1] = (xx * error[1] - xy * error[0]) / determinant
    longest = max(abs(step[0]), abs(step[1]))
    if not longest < np.inf or not step[0] * error[0] + step[1] * error[1] > 0:  # rounding leaves no curvature
        step = error * (limit / max(abs(error[0]), abs(error[1])))
    elif longest > limit:
        step *= limit / longest
    return step
