"""Approach or mean gap reached by way of the load, on which both depend monotonically."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from bem.contact.active_set import LevelResult
from bem.contact.controls import ApproachControl, Control, LoadControl, MeanGapControl

FloatArray = NDArray[np.float64]
Solve = Callable[[LoadControl, FloatArray | None, float], LevelResult]

_CLOSE = 0.05
"""A load's solution need be no better than this share of what is still missing."""


def by_load(
    control: Control,
    gap: FloatArray,
    cap: float,
    start: FloatArray | None,
    scale: float,
    tolerance: float,
    solve: Solve,
) -> LevelResult:
    """Solution whose approach or mean gap is as prescribed, to `tolerance`.

    A safeguarded secant iteration in the logarithm of the load; each load starts from the pressure of the one before.
    `solve(control, start, tolerance)` is load control on this grid; `scale` a length to begin with.
    """
    highest = cap * gap.size
    force = float(start.sum()) if start is not None else 0.0
    if not force > 0:
        force = 1e-3 * gap.size * scale
    force = min(force, highest)
    low, high = (0.0, math.inf)
    points: list[tuple[float, float]] = []
    precision = max(tolerance, 0.03 * scale)
    result: LevelResult | None = None
    for _ in range(200):
        if start is not None and start.sum() > 0:
            start = np.minimum(start * (force / start.sum()), cap)
        result = solve(LoadControl(force), start, precision)
        start = result.pressure
        error = _excess(control, result, gap)
        if abs(error) <= tolerance and precision <= tolerance:
            return result
        if abs(error) <= max(2 * precision, tolerance) and precision > tolerance:
            precision = max(tolerance, min(_CLOSE * abs(error), 0.1 * precision))
            points = points[-1:]
            continue
        if error < 0:
            low = max(low, force)
        else:
            high = min(high, force)
        points.append((math.log(force), error))
        previous = force
        force = _next(points, low, high, highest)
        precision = max(tolerance, min(precision, _CLOSE * abs(error)))
        if force == previous:
            break
    assert result is not None
    return result


def _excess(control: Control, result: LevelResult, gap: FloatArray) -> float:
    """How much too far together the bodies are, as a length; rises with the load."""
    if isinstance(control, ApproachControl):
        return result.approach - control.approach
    assert isinstance(control, MeanGapControl)
    opening = gap + result.displacement
    opening -= result.approach
    # round-off and residual of cells in contact must not count as volume
    opening[result.pressure > 0] = 0.0
    return control.mean_gap - float(np.maximum(opening, 0.0).mean())


def _next(points: list[tuple[float, float]], low: float, high: float, highest: float) -> float:
    """The next load: secant in its logarithm within the bracket, else bisection or a factor."""
    trial = math.nan
    if len(points) > 1:
        (x0, e0), (x1, e1) = points[-2:]
        if e1 != e0:
            trial = x1 - e1 * (x1 - x0) / (e1 - e0)
    lower = math.log(low) if low > 0 else -math.inf
    upper = math.log(high) if high < math.inf else math.inf
    if not lower < trial < upper or abs(trial - points[-1][0]) > 3:
        if math.isfinite(lower) and math.isfinite(upper):
            trial = 0.5 * (lower + upper)
        else:
            trial = points[-1][0] + (1.4 if points[-1][1] < 0 else -1.4)
    return min(math.exp(trial), highest)
