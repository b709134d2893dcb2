"""Sampling error of a finite number of positions: rms heights of a life, and film over roughness.

A round samples all offsets of two bodies by J positions. The heights h are those before minus the depths d_j of all
positions j. If the positions were drawn at random, the sum of depths would have an error e with J times the variance of
the d_j at each place. The error of the mean square is

    Sq^2:  2 <h e> + <e^2>,

with the standard error of a sum of J covariances <h d_j>, and the imprint of the positions, J <var_j d_j>. The
positions stay the same over a life, so the depths are proportional to the pressures of the last round, scaled to the
total wear.

The film over the rms height depends on the offset through the rms of the sum of both surfaces alone, which costs
nothing for many more positions. First order, our own. Verified in tests/life/test_sampling.py.
"""

from __future__ import annotations

import math

import numpy as np

from bem.grid import FloatArray
from bem.life.march import LifeState
from bem.life.positions import Passing, facing

MORE = 8
"""Factor on the number of positions for the mean film over roughness."""


def missed_roughness(end: LifeState, passing: Passing) -> tuple[float, float] | None:
    """Return standard errors of the rms heights of (lower, upper), film included [m]; None for a single position."""
    if len(end.contacts) < 2:
        return None
    worn = end.over("lower_depth")[-1], end.over("upper_depth")[-1]
    lower, upper = (
        _missed(heights, depth, _pressures(end, passing, body))
        for body, (heights, depth) in enumerate(zip(_surfaces(end), worn, strict=True))
    )
    return lower, upper


def missed_ratio(end: LifeState, passing: Passing) -> tuple[float, float]:
    """Return relative errors of the mean film over roughness on (the unworn surfaces, those of the end)."""
    more = Passing(MORE * passing.positions, passing.bodies)
    grid_count = len(end.contacts[0].pressure)
    first, last = (
        _part(_mean_inverse(pair, grid_count, more), _mean_inverse(pair, grid_count, passing))
        for pair in (end.first, _surfaces(end))
    )
    return first, last


def _missed(heights: FloatArray, worn: float, pressures: FloatArray) -> float:
    """Return the error of the rms height [m] of heights (rows, ny) [m] from which pressures (positions, rows, ny) wore
    a mean depth `worn` [m]."""
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
    """Return the pressures of the last round on a body, (positions, rows, ny) [Pa]."""
    counts = _row_counts(end.surfaces.heights)
    found = np.zeros((len(end.contacts), *end.surfaces.heights[body].shape))
    for own, one, moved in zip(found, end.contacts, passing.offsets(counts), strict=True):
        own[facing(moved[body], len(one.pressure), counts[body])] = one.pressure
    return found


def _surfaces(end: LifeState) -> tuple[FloatArray, FloatArray]:
    """Return the heights of the end, film included [m]."""
    lower, upper = end.surfaces.heights
    return (lower if end.surfaces.tribofilm is None else lower + end.surfaces.tribofilm), upper


def _row_counts(heights: tuple[FloatArray, FloatArray]) -> tuple[int, int]:
    return len(heights[0]), len(heights[1])


def _mean_inverse(heights: tuple[FloatArray, FloatArray], grid_count: int, passing: Passing) -> float:
    """Return the mean over positions of one over the rms height of both surfaces [1/m]; 0 for smooth surfaces."""
    counts = _row_counts(heights)
    found = []
    for moved in passing.offsets(counts):
        lower, upper = (
            each[facing(offset, grid_count, count)] for each, offset, count in zip(heights, moved, counts, strict=True)
        )
        rms = float((lower + upper).std())
        found.append(1 / rms if rms > 0 else 0.0)
    return float(np.mean(found))


def _part(many: float, few: float) -> float:
    return abs(many / few - 1) if few > 0 else 0.0
