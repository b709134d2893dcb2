"""Zero of a falling function of one number: steps by its slope until the zero lies in a bracket, then secants there.

Knows numbers only. Verified in tests/friction/test_oil_volume.py.
"""

from __future__ import annotations

from collections.abc import Callable

LONGEST_STEP = 3.0
"""Upwards, until there is a bracket; a longer one down goes to the lower end at once, which often is the answer."""
BEYOND, NEAR = 1.2, 0.1
"""By how much each step without a bracket is longer than the slope says, to get one, more each time; and the value
below which the slope is good enough for the first to need none."""
NARROWEST = 1e-10


def falling_zero(
    evaluate: Callable[[float], tuple[float, bool]],
    start: float,
    slope: float,
    ends: tuple[float, float],
    trials: int,
) -> float:
    """Look for the zero of a falling function between two ends; returns its slope there, as a positive number.

    Parameters
    ----------
    evaluate : the value at a place, and whether it is near enough to zero. start, slope : where to begin, and how
        steeply it falls there. ends : an end is the last place tried if the zero is not between them. trials : at most.

    Method of Illinois (Dowell and Jarratt, *BIT* 11, 1971, 168): regula falsi, the value that stays halved.
    """
    first, last = ends
    place, side = min(max(start, first), last), 0
    low: tuple[float, float] | None = None
    high: tuple[float, float] | None = None
    before: tuple[float, float] | None = None
    for trial in range(trials):
        value, met = evaluate(place)
        if before is not None and (value - before[1]) * (place - before[0]) < 0:
            slope = (before[1] - value) / (place - before[0])
        if met or (place <= first and value <= 0) or (place >= last and value > 0):
            break
        before = (place, value)
        if value > 0:
            low, high = before, (high[0], high[1] / 2) if high and side > 0 else high
        else:
            high, low = before, (low[0], low[1] / 2) if low and side < 0 else low
        side = 1 if value > 0 else -1
        if low is None or high is None:
            step = BEYOND ** (trial + (abs(value) > NEAR)) * value / slope
            place = first if step < -LONGEST_STEP else min(max(place + min(step, LONGEST_STEP), first), last)
            continue
        width = high[0] - low[0]
        if width < NARROWEST:
            break
        place = low[0] + width * min(max(low[1] / (low[1] - high[1]), 0.02), 0.98)
    return slope
