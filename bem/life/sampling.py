"""What few positions leave open of the heights of a life, and of the film over them.

A round stands for all offsets of two bodies by so many of them. Heights h are those before less the depths d_j of all
positions j, and where these were drawn at random the sum of depths is off by e, whose variance at each place is J times
that of the d_j. Of the mean square that leaves

    Sq^2:  2 <h e> + <e^2>,

the standard error of a sum of J covariances <h d_j>, and the imprint of these positions, J <var_j d_j>. The positions
stay the same over a life, so depths go as the pressures of the last round, scaled to what wore in all.

A film over the rms height hangs on the offset by the rms of the sum of both surfaces alone: that is had for many more
positions at no cost. First order, ours. Verified in tests/life/test_sampling.py.
"""

from __future__ import annotations

import math

import numpy as np

from bem.grid import FloatArray
from bem.life.march import LifeState
from bem.life.passes import Passing, facing

MORE = 8
"""Times the positions over which a film's ratio is averaged."""


def missed_roughness(end: LifeState, passing: Passing) -> tuple[float, float] | None:
    """Standard error of the rms heights of (lower, upper) body, its film on it [m]; None of a single position."""
    if len(end.passes) < 2:
        return None
    worn = end.over("lower_depth")[-1], end.over("upper_depth")[-1]
    lower, upper = (
        _missed(heights, depth, _pressures(end, passing, body))
        for body, (heights, depth) in enumerate(zip(_surfaces(end), worn, strict=True))
    )
    return lower, upper


def missed_ratio(end: LifeState, passing: Passing) -> tuple[float, float]:
    """By what part of itself the mean film over roughness is off, on (the unworn surfaces, those of the end), which are
    as the positions left them."""
    more = Passing(MORE * passing.positions, passing.bodies)
    rows = len(end.passes[0].pressure)
    first, last = (
        _part(_mean_inverse(pair, rows, more), _mean_inverse(pair, rows, passing))
        for pair in (end.first, _surfaces(end))
    )
    return first, last


def _missed(heights: FloatArray, worn: float, pressures: FloatArray) -> float:
    """Of a body of heights (rows, ny) [m] from which the pressures (positions, rows, ny) took a mean depth [m]."""
    mean = float(pressures.mean())
    if not (mean > 0 and worn > 0):
        return 0.0
    count, depth, rms = len(pressures), worn / mean, float(heights.std())
    above = heights - heights.mean()
    covariances = depth * np.array([(above * pressure).mean() for pressure in pressures])
    square = depth**2 * float(pressures.var(axis=0, ddof=1).mean()) / count
    imprint = math.sqrt(rms**2 + square) - rms
    return (float(covariances.std(ddof=1)) / (math.sqrt(count) * rms) if rms > 0 else 0.0) + imprint


def _pressures(end: LifeState, passing: Passing, body: int) -> FloatArray:
    """What each position of the last round presses on a body with, (positions, rows, ny) [Pa]."""
    counts = _rows(end.surfaces.heights)
    found = np.zeros((len(end.passes), *end.surfaces.heights[body].shape))
    for own, one, moved in zip(found, end.passes, passing.offsets(counts), strict=True):
        own[facing(moved[body], len(one.pressure), counts[body])] = one.pressure
    return found


def _surfaces(end: LifeState) -> tuple[FloatArray, FloatArray]:
    """Heights of the end with the film on them [m]."""
    lower, upper = end.surfaces.heights
    return (lower if end.surfaces.film is None else lower + end.surfaces.film), upper


def _rows(heights: tuple[FloatArray, FloatArray]) -> tuple[int, int]:
    return len(heights[0]), len(heights[1])


def _mean_inverse(heights: tuple[FloatArray, FloatArray], rows: int, passing: Passing) -> float:
    """Mean over positions of one over the rms height of both surfaces on the grid's rows [1/m]; 0 of smooth ones."""
    counts = _rows(heights)
    found = []
    for moved in passing.offsets(counts):
        lower, upper = (
            each[facing(offset, rows, count)] for each, offset, count in zip(heights, moved, counts, strict=True)
        )
        rms = float((lower + upper).std())
        found.append(1 / rms if rms > 0 else 0.0)
    return float(np.mean(found))


def _part(many: float, few: float) -> float:
    return abs(many / few - 1) if few > 0 else 0.0
