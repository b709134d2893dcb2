"""Root of a decreasing function of one variable, found by slope steps, then by a bracketed secant.

Until the root is bracketed, steps follow the slope. Inside the bracket the method is regula falsi with the Illinois
modification, or inverse quadratic interpolation where Chandrupatla's criterion accepts it. Cost: two to five
evaluations for the smooth functions of load sharing. Verified in tests/numerics/test_bracketed_root.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

LONGEST_STEP = 3.0
"""Longest upward step before the root is bracketed. A longer downward step goes to the lower end at once, because the
lower end often is the answer."""
BRACKETING_FACTOR, SMALL_VALUE = 1.2, 0.1
"""Growth factor of each step before the root is bracketed, so that a step crosses the root; and the absolute value
below which the first step is not lengthened, because the slope is accurate enough there."""
SMALLEST_CUT = 0.02
"""Smallest fraction of a bracket that a trial cuts off."""
SMALLEST_BRACKET = 1e-10
"""Width of the bracket at which the search ends."""


@dataclass(frozen=True)
class RootSearch:
    """State of a finished search.

    slope : magnitude of the slope near the last trial, positive.
    next_trial : argument at which the next trial would have been made.
    """

    slope: float
    next_trial: float


def find_decreasing_root(
    evaluate: Callable[[float], tuple[float, bool]],
    start: float,
    slope: float,
    ends: tuple[float, float],
    trials: int,
) -> RootSearch:
    """Find the root of a decreasing function between two ends.

    The caller reads the root from its own record of the last call of `evaluate`.

    Parameters
    ----------
    evaluate : returns the value at an argument, and whether the value counts as zero.
    start : argument of the first trial.
    slope : expected magnitude of the slope at `start`, positive.
    ends : lower and upper end. If the root lies beyond an end, that end is the last trial.
    trials : largest number of trials.

    Notes
    -----
    Illinois: Dowell and Jarratt, *BIT* 11 (1971) 168. Inverse quadratic interpolation: `_parabola_root`.
    """
    first, last = ends
    place, side = min(max(start, first), last), 0
    low: tuple[float, float] | None = None
    high: tuple[float, float] | None = None
    before: tuple[float, float] | None = None
    tried: list[tuple[float, float]] = []
    for trial in range(trials):
        value, met = evaluate(place)
        if before is not None and (value - before[1]) * (place - before[0]) < 0:
            slope = (before[1] - value) / (place - before[0])
        if (place <= first and value <= 0) or (place >= last and value > 0):
            break
        before = (place, value)
        tried.append(before)
        if value > 0:
            low, high = before, (high[0], high[1] / 2) if high and side > 0 else high
        else:
            high, low = before, (low[0], low[1] / 2) if low and side < 0 else low
        side = 1 if value > 0 else -1
        if low is None or high is None:
            step = (1.0 if met else BRACKETING_FACTOR ** (trial + (abs(value) > SMALL_VALUE))) * value / slope
            place = first if step < -LONGEST_STEP else min(max(place + min(step, LONGEST_STEP), first), last)
        else:
            width = high[0] - low[0]
            if width < SMALLEST_BRACKET:
                break
            fraction = (place + value / slope - low[0]) / width if met else low[1] / (low[1] - high[1])
            smooth = _parabola_root(tried, high[0] if value > 0 else low[0])
            if smooth is not None:
                fraction = (smooth - low[0]) / width
            least = 0.0 if met else SMALLEST_CUT
            place = low[0] + width * min(max(fraction, least), 1 - least)
        if met:
            break
    return RootSearch(slope, place)


def _parabola_root(tried: Sequence[tuple[float, float]], opposite: float) -> float | None:
    """Return the root of the inverse quadratic interpolant, or None where it is not to be trusted.

    The three points are the last trial, the trial at `opposite` on the other side of the root, and the latest other
    trial. The criterion of T. R. Chandrupatla, *Advances in Engineering Software* 28 (1997) 145, accepts the
    interpolant only where its root lies between the first two points.
    """
    (a, fa), others = tried[-1], [point for point in tried[:-1] if point[0] != opposite]
    if not others:
        return None
    b, fb = next(point for point in tried if point[0] == opposite)
    c, fc = others[-1]
    if fc in (fa, fb) or c in (a, b):
        return None
    place, value = (a - b) / (c - b), (fa - fb) / (fc - fb)
    if not (1 - math.sqrt(max(1 - place, 0.0)) < value < math.sqrt(max(place, 0.0))):
        return None
    return a + (b - a) * fa / (fb - fa) * fc / (fb - fc) + (c - a) * fa / (fc - fa) * fb / (fc - fb)
