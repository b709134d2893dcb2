"""Zero of a falling function of one number: steps by its slope until the zero lies in a bracket, then secants there,
or parabolas where the function is smooth enough.

Knows numbers only. Verified in tests/friction/test_oil_volume.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

LONGEST_STEP = 3.0
"""Upwards, until there is a bracket; a longer one down goes to the lower end at once, which often is the answer."""
BEYOND, NEAR = 1.2, 0.1
"""By how much each step without a bracket is longer than the slope says, to get one, more each time; and the value
below which the slope is good enough for the first to need none."""
LEAST_SHARE = 0.02
"""Of a bracket, that is always cut off."""
NARROWEST = 1e-10


@dataclass(frozen=True)
class Zero:
    """Where a zero was looked for last: the slope there, as a positive number, and the place to be tried next."""

    slope: float
    ahead: float


def falling_zero(
    evaluate: Callable[[float], tuple[float, bool]],
    start: float,
    slope: float,
    ends: tuple[float, float],
    trials: int,
) -> Zero:
    """Look for the zero of a falling function between two ends.

    Parameters
    ----------
    evaluate : the value at a place, and whether it is near enough to zero.
    start, slope : where to begin, and how
        steeply it falls there.
    ends : an end is the last place tried if the zero is not between them.
    trials : at most.

    Notes
    -----
    Method of Illinois (Dowell and Jarratt, *BIT* 11, 1971, 168): regula falsi, the value that stays halved; the place
    as a parabola of the value instead where `_parabola` has one. It takes a tenth fewer of the films and contacts of
    forty load sharings.
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
            step = (1.0 if met else BEYOND ** (trial + (abs(value) > NEAR))) * value / slope
            place = first if step < -LONGEST_STEP else min(max(place + min(step, LONGEST_STEP), first), last)
        else:
            width = high[0] - low[0]
            if width < NARROWEST:
                break
            share = (place + value / slope - low[0]) / width if met else low[1] / (low[1] - high[1])
            smooth = _parabola(tried, high[0] if value > 0 else low[0])
            if smooth is not None:
                share = (smooth - low[0]) / width
            least = 0.0 if met else LEAST_SHARE
            place = low[0] + width * min(max(share, least), 1 - least)
        if met:
            break
    return Zero(slope, place)


def _parabola(tried: Sequence[tuple[float, float]], across: float) -> float | None:
    """Where the parabola place (value) through three points tried, the last one, that `across` the zero and the latest
    of the others, is at zero; None where there are no three or they are not smooth enough for it to lie between the
    first two: T. R. Chandrupatla, *Advances in Engineering Software* 28 (1997) 145."""
    (a, fa), others = tried[-1], [point for point in tried[:-1] if point[0] != across]
    if not others:
        return None
    b, fb = next(point for point in tried if point[0] == across)
    c, fc = others[-1]
    if fc in (fa, fb) or c in (a, b):
        return None
    place, value = (a - b) / (c - b), (fa - fb) / (fc - fb)
    if not (1 - math.sqrt(max(1 - place, 0.0)) < value < math.sqrt(max(place, 0.0))):
        return None
    return a + (b - a) * fa / (fb - fa) * fc / (fb - fc) + (c - a) * fa / (fc - fa) * fb / (fc - fb)
