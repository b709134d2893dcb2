"""Prescribed quantities reached by way of another, where their own way fails: the mean gap by the approach, a hard
approach by the load.

Both pairs depend on one another monotonically, but for the mean gap below stiff layers (see `least_gap`), which below a
hardness falls again as all yields. A safeguarded secant iteration starts each solution from the pressure of the one
before and asks of it no more precision than the next step can use.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.contact.controls import ApproachControl, LoadControl
from bem.contact.level import Begin, LevelResult

FloatArray = NDArray[np.float64]
Solve = Callable[[ApproachControl | LoadControl, Begin, float], LevelResult]

_CLOSE = 0.05
"""Share of what is still missing that a solution need be precise to."""

_STEPS = 100

_LARGEST = 600.0
"""Logarithm of a load beyond which there is no use in looking."""


def mean_opening(gap: FloatArray, result: LevelResult) -> float:
    """Mean positive gap; round-off and residual of cells in contact must not count as volume."""
    opening = gap + result.displacement
    opening -= result.approach
    opening[result.pressure > 0] = 0.0
    return float(np.maximum(opening, 0.0).mean())


def mean_gap_by_approach(
    mean_gap: float,
    gap: FloatArray,
    start: Begin,
    scale: float,
    tolerance: float,
    solve: Solve,
    *,
    bracket: tuple[float, float],
    guess: float | None = None,
    patient: bool = True,
) -> LevelResult:
    """Solution whose mean positive gap is `mean_gap`, to `tolerance`, between two approaches, the first not enough.

    Without patience the search ends at the first contact that does not converge; in any case, where no approach is
    known to be enough, where the mean gap grows with it.
    """

    def excess(result: LevelResult) -> float:
        return mean_gap - mean_opening(gap, result)

    quest = _Quest(ApproachControl, excess, solve, tolerance, scale, patient)
    return _search(quest, guess if guess is not None else 0.5 * sum(bracket), bracket, scale, start)


def mean_gap_by_load(
    mean_gap: float, gap: FloatArray, cap: float, start: FloatArray, scale: float, tolerance: float, solve: Solve
) -> LevelResult:
    """Solution whose mean positive gap is `mean_gap`, to `tolerance`, below a finite cap, from a pressure.

    The load is bounded, and at its most all cells are at the cap and none is open: there is such a solution, also where
    the mean gap grows with the approach before it falls. Next to full contact an approach would have to be exact to far
    less than the mean gap.
    """
    return _by_load(lambda result: mean_gap - mean_opening(gap, result), cap, start, gap.size, scale, tolerance, solve)


def approach_by_load(
    approach: float, cap: float, start: FloatArray | None, cells: int, scale: float, tolerance: float, solve: Solve
) -> LevelResult:
    """Solution whose approach is `approach`, to `tolerance`."""
    return _by_load(lambda result: result.approach - approach, cap, start, cells, scale, tolerance, solve)


def _by_load(
    excess: Callable[[LevelResult], float],
    cap: float,
    start: FloatArray | None,
    cells: int,
    scale: float,
    tolerance: float,
    solve: Solve,
) -> LevelResult:
    """Zero of an excess that rises with the load."""

    def control(logarithm: float) -> LoadControl:
        return LoadControl(min(math.exp(min(logarithm, _LARGEST)), cap * cells))

    force = float(start.sum()) if start is not None else 0.0
    guess = math.log(force if force > 0 else 1e-3 * cells * scale)

    highest = math.log(cap * cells) if math.isfinite(cap) else math.inf
    quest = _Quest(control, excess, solve, tolerance, scale)
    return _search(quest, min(guess, highest), (-math.inf, highest), 1.0, start)


@dataclass(frozen=True)
class _Quest:
    """What is searched: x -> control -> contact -> excess, which is to be zero to the tolerance; `length` is its scale.

    patient : as in `mean_gap_by_approach`.
    """

    control: Callable[[float], ApproachControl | LoadControl]
    excess: Callable[[LevelResult], float]
    solve: Solve
    tolerance: float
    length: float
    patient: bool = True


def _search(quest: _Quest, x: float, bracket: tuple[float, float], step: float, start: Begin) -> LevelResult:
    """Zero of an excess that rises with x, from a pressure; `step` is a first step of x."""
    tolerance, (low, high) = quest.tolerance, bracket
    precision = max(tolerance, 0.03 * quest.length)
    points: list[tuple[float, float]] = []
    while True:
        result = quest.solve(quest.control(x), start, precision)
        start = result.pressure
        error = quest.excess(result)
        if abs(error) <= tolerance and precision <= tolerance:
            return result
        if len(points) >= _STEPS or not (quest.patient or result.converged):
            return result
        if (
            math.isinf(bracket[1])
            and error < 0
            and any(x > other and error < less - 2 * precision for other, less in points)
        ):
            return result  # it falls, and nothing says that there is a zero beyond
        if abs(error) <= 2 * precision and precision > tolerance:
            precision = max(tolerance, min(_CLOSE * abs(error), 0.1 * precision))
            points = points[-1:]
            continue
        if error < 0:
            low = max(low, x)
        else:
            high = min(high, x)
        points.append((x, error))
        previous = x
        x = _next(points, low, high, step)
        if x == previous or not math.isfinite(x):
            return result
        precision = max(tolerance, min(precision, _CLOSE * abs(error)))


def _next(points: list[tuple[float, float]], low: float, high: float, step: float) -> float:
    """Secant step within the bracket, else bisection, else a step outwards that grows."""
    x1, e1 = points[-1]
    trial = math.nan
    if len(points) > 1:
        x0, e0 = points[-2]
        if e1 != e0:
            reach = 4 * max(abs(x1 - x0), step)
            trial = min(max(x1 - e1 * (x1 - x0) / (e1 - e0), x1 - reach), x1 + reach)
    elif step == step and e1:
        trial = x1 - math.copysign(min(step, abs(e1) * 1.5) if abs(e1) < step else step, e1)
    stuck = len(points) > 6 and abs(points[-1][1]) > 0.5 * abs(points[-4][1])
    if not low < trial < high or stuck:
        if math.isfinite(low) and math.isfinite(high):
            return 0.5 * (low + high)
        reach = 2.0 * max(abs(x1 - points[-2][0]), 1e-3 * step) if len(points) > 1 else step
        trial = x1 + reach if e1 < 0 else x1 - reach
        trial = min(max(trial, low), high)
    return trial
