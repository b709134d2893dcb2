"""A contact on one grid under any control, and what is done where the plain way fails.

The load, the approach and the mean gap are solved for directly (`active_set`). If that fails: with every round on the
guard of the energy; with friction's part of the displacement taken from the contact before (`_lagged`); an approach by
way of the load; a mean gap by way of the approach, below a hardness also of the load, and where elastic bodies do not
reach it so, `least_gap` says whether it exists.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from bem.contact import passes
from bem.contact.active_set import solve_level
from bem.contact.controls import ApproachControl, Control, LoadControl, MeanGapControl
from bem.contact.least_gap import least_gap
from bem.contact.level import Begin, Effort, Iterate, LevelResult, Tolerance, Tuning
from bem.contact.search import approach_by_load, mean_gap_by_approach, mean_gap_by_load, mean_opening
from bem.convolution import DisplacementOperator

FloatArray = NDArray[np.float64]
Report = Callable[[int, float, int], None]

_WARY_ROUNDS = 400
"""Limit on rounds that may not raise the energy. Of 309 random contacts under layers 10 to 200 times as stiff as their
base five came here, and took 13 to 322."""

_LAGS = 60
"""Limit on contacts with friction taken from the one before; ten are usual."""

_FOLLOWED = 12
"""Rounds without progress before the approach of a mean gap is searched for instead."""

_COUPLED = 10
"""The same with friction in every round: with conjugate residuals they get there or swing, and 25 found no more."""

_SHORT = 5
"""Rounds without progress before friction's part of the displacement is again taken from the contact before."""

OF_FIRST = 0.1
"""Of the violation that a coarse grid begins with, the most that it is left with. That is what the interpolation to it
cost, and the one to the next finer grid costs a third of it. On large grids both are far below a share of the
roughness, most of which is in waves much longer than cells: with that alone self-affine contacts of 2048, 4096 and 8192
cells a side, 7 % in contact, take 11.9, 12.2 and 27.9 convolutions to 1e-6, with this 12.3, 10.8 and 10.9; with 0.2
the largest takes 17.8."""

COARSE_TOLERANCE = 6e-2
"""Violation over roughness that coarse grids are solved to: more is lost in the interpolation anyway. With 0.15 rough
contacts of 128 to 1024 cells take two hundredths fewer convolutions, layered and smaller ones as many more."""


@dataclass(frozen=True)
class Shared:
    """What all grids of one problem share: tolerance and roughness in the solver's length, effort, tuning.

    `of_first` : of the violation that rounds begin with, the share that is allowed at most; on coarse grids."""

    tolerance: float
    roughness: float
    effort: Effort
    tuning: Tuning = field(default_factory=Tuning)
    of_first: float = math.inf

    @property
    def scale(self) -> float:
        """The roughness, or one where the gap is flat."""
        return self.roughness or 1.0

    def allowed(self, tolerance: float) -> Tolerance:
        """A violation as the rounds judge it: of flat gaps relative to the displacement alone."""
        if not self.roughness > 0:
            return Tolerance(math.inf, tolerance)
        return Tolerance(tolerance, tolerance / self.roughness, self.of_first, self.tolerance)


@dataclass(frozen=True)
class Problem:
    """One grid's: operator, gap (flat, lowest value zero), cap; `report` is called after each round."""

    shared: Shared
    operator: DisplacementOperator
    gap: FloatArray
    cap: float
    report: Report | None = None

    def level(self, control: Control, start: Begin, allowed: Tolerance, tuning: Tuning) -> LevelResult:
        """Rounds on this grid."""
        effort = self.shared.effort
        return solve_level(self.operator, self.gap, control, self.cap, start, allowed, effort, tuning, self.report)

    def plain(self, control: Control, start: Begin, tolerance: float) -> LevelResult:
        """Load or approach, from a start, without what is done where that fails."""
        tuning = self.shared.tuning if self.operator.symmetric else replace(self.shared.tuning, stall=_COUPLED)
        return self.level(control, start, self.shared.allowed(tolerance), tuning)

    def followed(self, mean_gap: float, start: Begin, tolerance: float) -> LevelResult:
        """Mean gap, the approach following the displacement."""
        tuning = replace(self.shared.tuning, stall=_FOLLOWED)
        return self.level(MeanGapControl(mean_gap), start, self.shared.allowed(tolerance), tuning)

    def direct(self, control: Control, start: Begin, tolerance: float) -> LevelResult:
        """Load or approach, from a start; see `search.Solve`."""
        shared, allowed = self.shared, self.shared.allowed(tolerance)
        result = self.plain(control, start, tolerance)
        if result.converged or result.resolved or shared.effort.left <= 0:
            return result
        if not self.operator.symmetric:
            return _lagged(self, control, start, allowed)
        # once more from there, with every round on the guard: the energy falls even where the violation long does not;
        # and at last with all pressures of a round exact, which is dear but swings least
        for clipping in (shared.tuning.clipping, 0.0):
            wary = replace(shared.tuning, patience=0, rounds=_WARY_ROUNDS, clipping=clipping)
            result = self.level(control, result.pressure, allowed, wary)
            if result.converged or result.resolved or shared.effort.left <= 0:
                break
        return result


@dataclass(frozen=True)
class Start:
    """Pressure (flat) and approach to begin with."""

    pressure: Begin
    approach: float


def solve_on_grid(problem: Problem, control: Control, start: Start, tolerance: float) -> LevelResult:
    """One grid, any control."""
    if isinstance(control, MeanGapControl) and problem.operator.mean_free:
        if control.mean_gap <= tolerance:
            closed = _full_contact(problem.operator, problem.gap)
            if closed.pressure.max() < problem.cap:
                return closed
        if math.isinf(problem.cap):
            # displacements have no mean: the mean gap fixes the approach
            control = ApproachControl(float(problem.gap.mean()) - control.mean_gap)
    if isinstance(control, MeanGapControl):
        return _with_mean_gap(problem, control.mean_gap, start, tolerance)
    if isinstance(control, LoadControl):
        return problem.direct(control, start.pressure, tolerance)
    # displacements without a mean: next to full contact an approach is far harder than a load, and the guard is dear
    first = problem.plain if problem.operator.mean_free else problem.direct
    result = first(control, start.pressure, tolerance)
    if result.converged or result.resolved or problem.shared.effort.left <= 0:
        return result
    cells = problem.gap.size
    return approach_by_load(control.approach, problem.cap, None, cells, problem.shared.scale, tolerance, problem.direct)


def _with_mean_gap(problem: Problem, mean_gap: float, start: Start, tolerance: float) -> LevelResult:
    """The mean gap, else by way of the approach; below a hardness also of the load, and first where most cells that
    touch are at it, at last of approaches up to that at which all are; without one by looking for the least there is.
    """
    gap, cap, scale = problem.gap, problem.cap, problem.shared.scale
    # displacements are not negative on average, so this approach is not enough
    least = float(gap.mean()) - mean_gap
    result = problem.followed(mean_gap, start.pressure, tolerance)
    if result.converged or result.resolved or problem.shared.effort.left <= 0:
        return result

    def by_approach(_before: LevelResult) -> LevelResult:
        guess, patient = max(start.approach, least), not problem.operator.mean_free
        begin, bracket = start.pressure, (least, math.inf)
        return mean_gap_by_approach(
            mean_gap, gap, begin, scale, tolerance, problem.direct, bracket=bracket, guess=guess, patient=patient
        )

    def by_load(before: LevelResult) -> LevelResult:
        return mean_gap_by_load(mean_gap, gap, cap, before.pressure, scale, tolerance, problem.direct)

    def below_plastic(before: LevelResult) -> LevelResult:
        # from where all cells are at the cap none is open: an approach below gives the mean gap, and one is enough
        shape = problem.operator.grid.shape
        sunk = problem.operator.scaled().apply(np.full(shape, cap), np.empty(shape)).reshape(-1)
        bracket = least, float((gap + sunk).max())
        guess = before.approach if bracket[0] < before.approach < bracket[1] else None
        return mean_gap_by_approach(
            mean_gap, gap, before.pressure, scale, tolerance, problem.direct, bracket=bracket, guess=guess
        )

    ways: list[Callable[[LevelResult], LevelResult]] = [by_approach]
    if math.isfinite(cap):
        ways.insert(int(not _mostly_capped(result, cap)), by_load)
        ways.append(below_plastic)
    for way in ways:
        result = way(result)
        missed = not result.converged or abs(mean_opening(gap, result) - mean_gap) > tolerance
        if not missed or problem.shared.effort.left <= 0:
            return result
    return result if math.isfinite(cap) else _least_gap(problem, mean_gap, result, tolerance)


def _mostly_capped(result: LevelResult, cap: float) -> bool:
    """Whether more of the cells that touch are at the cap than below it."""
    return 2 * int(np.count_nonzero(result.pressure >= cap)) > int(np.count_nonzero(result.pressure))


def _least_gap(problem: Problem, mean_gap: float, missed: LevelResult, tolerance: float) -> LevelResult:
    """A mean gap that the search did not find: below the least there is, or on the way down to it."""
    gap, scale = problem.gap, problem.shared.scale

    def at(approach: float, start: FloatArray | None) -> LevelResult:
        return problem.direct(ApproachControl(approach), start, tolerance)

    first = at(float(gap.mean()), None)
    if not first.converged:
        return missed
    found = least_gap(mean_gap, problem.operator, gap, first, scale, tolerance, at)
    if found is None:
        return missed
    if found.bracket is None:
        least = mean_opening(gap, found.result) if found.bound is None else None
        return replace(found.result, converged=False, least_mean_gap=found.bound, least_found=least)
    start = found.result.pressure
    return mean_gap_by_approach(mean_gap, gap, start, scale, tolerance, problem.direct, bracket=found.bracket)


@dataclass(slots=True)
class _Change:
    """How friction's part of the displacement changes from one contact to the next."""

    last: FloatArray | None = None
    size: float = math.inf
    least: float = math.inf
    waited: int = 0

    def by(self, coupling: FloatArray) -> None:
        """Take in the next."""
        if self.last is not None:
            self.size = float(np.abs(coupling - self.last).max())
            self.waited = 0 if self.size < 0.9 * self.least else self.waited + 1
            self.least = min(self.least, self.size)
        self.last = coupling


def _lagged(problem: Problem, control: Control, start: Begin, allowed: Tolerance) -> LevelResult:
    """Friction's part of the displacement taken from the last pressure, over and over: each contact is then without it.

    Slower than friction in every round, but it gets there where the rounds swing: what friction adds varies less from
    one pressure to the next than the sets of cells do. The rounds are tried again from where it hardly changes.
    """
    operator, alone, shape = problem.operator, problem.operator.frictionless, problem.operator.grid.shape
    displacement, part = np.empty(shape), np.empty(shape)
    pressure = _everywhere(problem, start)
    change = _Change()
    ready = COARSE_TOLERANCE * problem.shared.scale
    short = replace(problem.shared.tuning, stall=_SHORT)
    result: LevelResult | None = None
    for _ in range(_LAGS):
        operator.scaled().apply(pressure.reshape(shape), displacement)
        alone.scaled().apply(pressure.reshape(shape), part)
        coupling = (displacement - part).reshape(-1)
        goal = min(allowed.length, allowed.relative * float(np.abs(displacement).max()))
        change.by(coupling)
        if result is None:
            roughness = problem.shared.roughness or math.inf
            tolerance = Tolerance(COARSE_TOLERANCE * roughness, COARSE_TOLERANCE)
        else:
            violation = result.violation + change.size
            if violation <= goal or problem.shared.effort.left <= 0 or change.waited > 5:
                # of this very pressure: its contact, with the displacement that friction gives it
                return replace(
                    result, displacement=displacement.reshape(-1), violation=violation, converged=violation <= goal
                )
            if change.size <= ready:
                # near the contact the sets no longer swing
                ended = problem.level(control, pressure, allowed, short)
                if ended.converged or problem.shared.effort.left <= 0:
                    return ended
                ready = 0.1 * change.size
            share = 0.1 * change.size / float(np.abs(displacement).max())
            tolerance = Tolerance(max(0.3 * allowed.length, 0.1 * change.size), max(0.3 * allowed.relative, share))
        without = replace(problem, operator=alone, gap=problem.gap + coupling)
        result = without.level(control, start, tolerance, problem.shared.tuning)
        pressure = start = result.pressure
    assert result is not None
    return replace(result, converged=False, fresh=False)


def _everywhere(problem: Problem, start: Begin) -> FloatArray:
    """What a grid begins with as a field."""
    if not isinstance(start, Iterate):
        return np.zeros(problem.gap.size) if start is None else start
    full = np.empty(problem.gap.size)
    passes.place(full, start.cells, start.values, start.capped, problem.cap)
    return full


def without_contact(control: Control, gap: FloatArray) -> LevelResult | None:
    """The result where the bodies do not press on each other at all. The lowest gap is zero."""
    if isinstance(control, LoadControl):
        approach = 0.0 if control.force == 0 else math.inf
    elif isinstance(control, ApproachControl):
        approach = control.approach
    else:
        approach = float(gap.mean()) - control.mean_gap
    if approach > 0:
        return None
    return LevelResult(np.zeros(gap.size), np.zeros(gap.size), approach, 0.0, converged=True)


def pressed_flat(
    operator: DisplacementOperator, gap: FloatArray, control: Control, cap: float, *, flat: bool
) -> LevelResult | None:
    """The pressure of full contact where a doubly periodic gap is flat, or `flat` to round-off: uniform but for what
    closes the gap everywhere. Iterations would see rounding only. None where that leaves the bounds."""
    if not (isinstance(control, LoadControl) and operator.mean_free and (flat or gap.max() == 0)):
        return None
    mean = min(control.force / gap.size, cap)
    if gap.max() == 0:
        return LevelResult(np.full(gap.size, mean), np.zeros(gap.size), 0.0, 0.0, converged=True)
    full = _full_contact(operator, gap)
    pressure = full.pressure + (mean - full.pressure.mean())
    if pressure.min() < 0 or pressure.max() > cap:
        return None
    return replace(full, pressure=pressure, fresh=False)


def _full_contact(operator: DisplacementOperator, gap: FloatArray) -> LevelResult:
    """The least pressure that closes a doubly periodic gap everywhere."""
    shape = operator.grid.shape
    pressure = operator.scaled_inverse().apply(-gap.reshape(shape), np.empty(shape)).reshape(-1)
    pressure -= pressure.min()
    displacement = operator.scaled().apply(pressure.reshape(shape), np.empty(shape)).reshape(-1)
    return LevelResult(pressure, displacement, float((gap + displacement).mean()), 0.0, converged=True)
