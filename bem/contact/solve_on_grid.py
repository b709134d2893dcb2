"""Solution on one grid under any control: the active set, and fallbacks where that stalls.

Steps 2, 4 and 11 of `bem.contact`. `solve_on_grid` is called for every grid. It first solves for the prescribed
quantity by the active set alone, through `problem.GridProblem.solve`. Fallbacks follow only if that stalls:

(a) load, or approach unless displacements have no mean, symmetric operator: again with the energy guard on from the
   first outer iteration, and then without the end of conjugate gradients by clipping, too; each rerun starts from the
   pressure with the smallest violation of the solution before it, in a new workspace;
(b) friction in the gap: the frictional part of the displacement is lagged, so that each contact is frictionless;
(c) approach: a secant search over the load;
(d) mean gap: a secant search over the approach and, below a hardness, over the load; elastic bodies for which neither
   succeeds may have no such mean gap (`mean_gap_limits`).

The secant searches are safeguarded by a bracket, start every contact from the pressure of the one before, and ask of it
no more precision than the next step can use. Both pairs of quantities depend on one another monotonically, except for
the mean gap below stiff layers.

Verified in tests/contact/test_contact_found_cases.py and tests/contact/test_reported_stalls.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.contact.bounds import Iterate
from bem.contact.controls import ApproachControl, Control, LoadControl, MeanGapControl
from bem.contact.grid_workspace import GridResult, InitialPressure, Tolerance, mean_opening
from bem.contact.problem import GridProblem
from bem.convolution import DisplacementOperator

FloatArray = NDArray[np.float64]

COARSE_TOLERANCE = 6e-2
"""Bound on the violation of coarse grids, over the rms gap and over the displacement; they aim at a tenth of the first
violation as well (`nested_iteration`)."""

_GUARDED_ROUNDS = 400
"""Limit of outer iterations under the energy guard; contacts below stiff layers take up to three hundred."""

_LAGGED_CONTACTS = 60
"""Limit of contacts with lagged friction; ten are usual."""

_MEAN_GAP_STALL = 12
"""Outer iterations without progress under a prescribed mean gap before the secant search."""

_FRICTION_STALL = 10
"""Outer iterations without progress with friction in the gap before friction is lagged."""

_LAGGED_STALL = 5
"""Outer iterations without progress with friction, in a trial between lagged contacts."""

_PRECISION = 0.05
"""Precision of a contact of the secant search, relative to the remaining error."""

_SECANT_STEPS = 100

_LARGEST_LOGARITHM = 600.0
"""Logarithm of the largest load of the secant search."""


@dataclass(frozen=True)
class Start:
    """Initial pressure, and its approach, which only a prescribed mean gap uses."""

    pressure: InitialPressure
    approach: float


def solve_on_grid(
    problem: GridProblem, control: Control, start: Start, tolerance: float, *, guarded_rerun: bool = True
) -> GridResult:
    """Solve on one grid under any control.

    guarded_rerun : False on coarse grids, where a stalled contact is not repeated under the energy guard.
    """
    mean_free = problem.operator.mean_free
    if isinstance(control, MeanGapControl):
        if mean_free and control.mean_gap <= tolerance:
            closed = full_contact(problem.operator, problem.gap)
            if closed.pressure.max() < problem.cap:
                return closed
        if not (mean_free and math.isinf(problem.cap)):
            return _solve_mean_gap(problem, control, start, tolerance)
        # displacements have no mean: the mean gap fixes the approach
        control = ApproachControl(float(problem.gap.mean()) - control.mean_gap)
    if not isinstance(control, ApproachControl):
        return _solve_with_fallbacks(problem, control, start.pressure, tolerance, rerun=guarded_rerun)
    # where displacements have no mean, a load is far easier than an approach near full contact
    first = _solve_directly if mean_free or not guarded_rerun else _solve_with_fallbacks
    result = first(problem, control, start.pressure, tolerance)
    if _is_final(problem, result) or not (guarded_rerun or mean_free):
        return result
    return _approach_by_load(problem, control, tolerance)


def _is_final(problem: GridProblem, result: GridResult) -> bool:
    """Return True if no fallback can improve a result, or no iterations are left."""
    return result.converged or result.round_off or problem.settings.budget.left <= 0


def _solve_directly(problem: GridProblem, control: Control, start: InitialPressure, tolerance: float) -> GridResult:
    """Solve for a load or an approach without fallbacks."""
    parameters = problem.settings.parameters
    if not problem.operator.symmetric:
        parameters = replace(parameters, stall_limit=_FRICTION_STALL)
    return problem.solve(control, start, problem.settings.allowed(tolerance), parameters)


def _solve_with_fallbacks(
    problem: GridProblem, control: Control, start: InitialPressure, tolerance: float, *, rerun: bool = True
) -> GridResult:
    """Solve for a load or an approach; repeat with lagged friction or, if `rerun`, under the energy guard."""
    settings, allowed = problem.settings, problem.settings.allowed(tolerance)
    result = _solve_directly(problem, control, start, tolerance)
    if _is_final(problem, result):
        return result
    if not problem.operator.symmetric:
        return _solve_with_lagged_friction(problem, control, start, allowed)
    for ratio in (settings.parameters.clip_residual_ratio, 0.0) if rerun else ():
        guarded = replace(settings.parameters, guarded=True, rounds=_GUARDED_ROUNDS, clip_residual_ratio=ratio)
        result = problem.solve(control, result.pressure, allowed, guarded)
        if _is_final(problem, result):
            break
    return result


def _solve_mean_gap(problem: GridProblem, control: MeanGapControl, start: Start, tolerance: float) -> GridResult:
    """Solve for a mean gap directly, else by secant searches.

    Below a hardness the searches over load and approach both apply, the load first where most cells in contact are at
    the cap; a last search over the approach is bracketed by the one at which all cells are at the cap. Without a
    hardness, the least mean gap decides whether the prescribed one exists.
    """
    settings, gap, cap, mean_gap = problem.settings, problem.gap, problem.cap, control.mean_gap
    # displacements are not negative on average, so this approach is too small
    least = float(gap.mean()) - mean_gap
    parameters = replace(settings.parameters, stall_limit=_MEAN_GAP_STALL)
    result = problem.solve(control, start.pressure, settings.allowed(tolerance), parameters)
    if _is_final(problem, result):
        return result

    excess = _mean_gap_excess(gap, mean_gap)

    def by_approach(_last: GridResult) -> GridResult:
        guess, patient = max(start.approach, least), not problem.operator.mean_free
        return _search_approach(
            problem, excess, start.pressure, tolerance, (least, math.inf), guess=guess, patient=patient
        )

    def by_load(last: GridResult) -> GridResult:
        # at the largest load all cells are at the cap and none is open, so a solution exists
        return _search_load(problem, excess, last.pressure, tolerance)

    def by_plastic_approach(last: GridResult) -> GridResult:
        # where all cells are at the cap none is open: that approach bounds the search
        shape = problem.operator.grid.shape
        sunk = problem.operator.scaled().apply(np.full(shape, cap), np.empty(shape)).reshape(-1)
        bracket = least, float((gap + sunk).max())
        guess = last.approach if bracket[0] < last.approach < bracket[1] else None
        return _search_approach(problem, excess, last.pressure, tolerance, bracket, guess=guess)

    searches: list[Callable[[GridResult], GridResult]] = [by_approach]
    if math.isfinite(cap):
        mostly_capped = 2 * int(np.count_nonzero(result.pressure >= cap)) > int(np.count_nonzero(result.pressure))
        searches.insert(0 if mostly_capped else 1, by_load)
        searches.append(by_plastic_approach)
    for search in searches:
        result = search(result)
        missed = not result.converged or abs(excess(result)) > tolerance
        if not missed or settings.budget.left <= 0:
            return result
    return result if math.isfinite(cap) else _below_least_mean_gap(problem, mean_gap, result, tolerance)


def _below_least_mean_gap(problem: GridProblem, mean_gap: float, missed: GridResult, tolerance: float) -> GridResult:
    """Decide whether a mean gap that was not found exists, and find it if it does."""
    from bem.contact.mean_gap_limits import least_mean_gap  # only where a mean gap is not found

    gap = problem.gap

    def solve_at(approach: float, start: FloatArray | None) -> GridResult:
        return _solve_with_fallbacks(problem, ApproachControl(approach), start, tolerance)

    first = solve_at(float(gap.mean()), None)
    if not first.converged:
        return missed
    outcome = least_mean_gap(mean_gap, problem.operator, gap, first, problem.settings.scale, tolerance, solve_at)
    if outcome is None:
        return missed
    if outcome.bracket is None:
        found = mean_opening(gap, outcome.result) if outcome.bound is None else None
        return replace(outcome.result, converged=False, least_mean_gap=outcome.bound, least_found=found)

    excess = _mean_gap_excess(gap, mean_gap)
    return _search_approach(problem, excess, outcome.result.pressure, tolerance, outcome.bracket)


def _mean_gap_excess(gap: FloatArray, mean_gap: float) -> Callable[[GridResult], float]:
    """Return the function by how much a prescribed mean gap exceeds that of a contact."""

    def excess(contact: GridResult) -> float:
        return mean_gap - mean_opening(gap, contact)

    return excess


def _approach_by_load(problem: GridProblem, control: ApproachControl, tolerance: float) -> GridResult:
    """Search the load whose approach is the prescribed one."""
    return _search_load(problem, lambda result: result.approach - control.distance, None, tolerance)


def _search_approach(
    problem: GridProblem,
    excess: Callable[[GridResult], float],
    start: InitialPressure,
    tolerance: float,
    bracket: tuple[float, float],
    *,
    guess: float | None = None,
    patient: bool = True,
) -> GridResult:
    """Search the approach at which the excess is zero."""
    scale = problem.settings.scale
    search = _SecantSearch(problem, ApproachControl, excess, tolerance, scale, patient)
    return search.run(guess if guess is not None else 0.5 * sum(bracket), bracket, scale, start)


def _search_load(
    problem: GridProblem, excess: Callable[[GridResult], float], start: FloatArray | None, tolerance: float
) -> GridResult:
    """Search the logarithm of the load at which the excess is zero."""
    most, cells, scale = problem.cap * problem.gap.size, problem.gap.size, problem.settings.scale

    def control(logarithm: float) -> LoadControl:
        return LoadControl(min(math.exp(min(logarithm, _LARGEST_LOGARITHM)), most))

    force = float(start.sum()) if start is not None else 0.0
    guess = math.log(force if force > 0 else 1e-3 * cells * scale)
    highest = math.log(most) if math.isfinite(most) else math.inf
    search = _SecantSearch(problem, control, excess, tolerance, scale)
    return search.run(min(guess, highest), (-math.inf, highest), 1.0, start)


@dataclass(frozen=True)
class _SecantSearch:
    """Safeguarded secant search for the zero of an excess that rises with x.

    control : of x. excess : of the contact under that control. tolerance : of the excess. scale : of the excess.
    patient : if False, the search ends at the first contact that does not converge.
    """

    problem: GridProblem
    control: Callable[[float], ApproachControl | LoadControl]
    excess: Callable[[GridResult], float]
    tolerance: float
    scale: float
    patient: bool = True

    def run(self, x: float, bracket: tuple[float, float], step: float, start: InitialPressure) -> GridResult:
        """Search from x within a bracket; `step` is the first step.

        Without an upper bound the search also ends where the excess falls, because a zero need not exist.
        """
        tolerance, (low, high) = self.tolerance, bracket
        precision = max(tolerance, 0.03 * self.scale)
        points: list[tuple[float, float]] = []
        while True:
            result = _solve_with_fallbacks(self.problem, self.control(x), start, precision)
            start = result.pressure
            error = self.excess(result)
            if abs(error) <= tolerance and precision <= tolerance:
                return result
            if len(points) >= _SECANT_STEPS or not (self.patient or result.converged):
                return result
            falls = any(x > other and error < less - 2 * precision for other, less in points)
            if math.isinf(bracket[1]) and error < 0 and falls:
                return result
            if abs(error) <= 2 * precision and precision > tolerance:
                precision = max(tolerance, min(_PRECISION * abs(error), 0.1 * precision))
                points = points[-1:]
                continue
            if error < 0:
                low = max(low, x)
            else:
                high = min(high, x)
            points.append((x, error))
            previous = x
            x = _next_point(points, low, high, step)
            if x == previous or not math.isfinite(x):
                return result
            precision = max(tolerance, min(precision, _PRECISION * abs(error)))


def _next_point(points: list[tuple[float, float]], low: float, high: float, step: float) -> float:
    """Return a secant step within the bracket, else a bisection, else a growing step outwards."""
    x1, e1 = points[-1]
    trial = math.nan
    if len(points) > 1:
        x0, e0 = points[-2]
        if e1 != e0:
            longest = 4 * max(abs(x1 - x0), step)
            trial = min(max(x1 - e1 * (x1 - x0) / (e1 - e0), x1 - longest), x1 + longest)
    elif step == step and e1:
        trial = x1 - math.copysign(min(step, abs(e1) * 1.5) if abs(e1) < step else step, e1)
    stuck = len(points) > 6 and abs(points[-1][1]) > 0.5 * abs(points[-4][1])
    if not low < trial < high or stuck:
        if math.isfinite(low) and math.isfinite(high):
            return 0.5 * (low + high)
        outwards = 2.0 * max(abs(x1 - points[-2][0]), 1e-3 * step) if len(points) > 1 else step
        trial = x1 + outwards if e1 < 0 else x1 - outwards
        trial = min(max(trial, low), high)
    return trial


@dataclass(slots=True)
class _CouplingChange:
    """Change of the frictional displacement from one lagged contact to the next.

    size : of the last change. mark : size when it last fell by a tenth. waited : contacts since.
    """

    last: FloatArray | None = None
    size: float = math.inf
    mark: float = math.inf
    waited: int = 0

    def update(self, coupling: FloatArray) -> None:
        """Record the next frictional displacement."""
        if self.last is not None:
            self.size = float(np.abs(coupling - self.last).max())
            fell = self.size < 0.9 * self.mark
            if fell:
                self.mark = self.size
            self.waited = 0 if fell else self.waited + 1
        self.last = coupling


def _solve_with_lagged_friction(
    problem: GridProblem, control: Control, start: InitialPressure, allowed: Tolerance
) -> GridResult:
    """Iterate over frictionless contacts whose gap includes the frictional displacement of the last pressure.

    Slower than friction in every outer iteration, but stable where the sets swing: the frictional displacement varies
    less from one pressure to the next than the sets of cells. Once it hardly changes, the coupled solver is tried
    again.
    """
    settings, operator, shape = problem.settings, problem.operator, problem.operator.grid.shape
    frictionless = operator.frictionless
    displacement, part = np.empty(shape), np.empty(shape)
    pressure = _as_field(problem, start)
    change = _CouplingChange()
    ready = COARSE_TOLERANCE * settings.scale
    short = replace(settings.parameters, stall_limit=_LAGGED_STALL)
    result: GridResult | None = None
    for _ in range(_LAGGED_CONTACTS):
        operator.scaled().apply(pressure.reshape(shape), displacement)
        frictionless.scaled().apply(pressure.reshape(shape), part)
        coupling = (displacement - part).reshape(-1)
        goal = min(allowed.absolute, allowed.relative * float(np.abs(displacement).max()))
        change.update(coupling)
        if result is None:
            rms_gap = settings.rms_gap or math.inf
            tolerance = Tolerance(COARSE_TOLERANCE * rms_gap, COARSE_TOLERANCE)
        else:
            violation = result.violation + change.size
            if violation <= goal or settings.budget.left <= 0 or change.waited > 5:
                return replace(
                    result, displacement=displacement.reshape(-1), violation=violation, converged=violation <= goal
                )
            if change.size <= ready:
                coupled = problem.solve(control, pressure, allowed, short)
                if coupled.converged or settings.budget.left <= 0:
                    return coupled
                ready = 0.1 * change.size
            relative = 0.1 * change.size / float(np.abs(displacement).max())
            tolerance = Tolerance(max(0.3 * allowed.absolute, 0.1 * change.size), max(0.3 * allowed.relative, relative))
        lagged = replace(problem, operator=frictionless, gap=problem.gap + coupling)
        result = lagged.solve(control, start, tolerance, settings.parameters)
        pressure = start = result.pressure
    assert result is not None
    return replace(result, converged=False, exact_displacement=False)


def _as_field(problem: GridProblem, start: InitialPressure) -> FloatArray:
    """Return an initial pressure as a field."""
    if isinstance(start, Iterate):
        return start.as_field(problem.gap.size, problem.cap)
    return np.zeros(problem.gap.size) if start is None else start


def without_contact(control: Control, gap: FloatArray) -> GridResult | None:
    """Return the result where the bodies do not press on each other; None otherwise."""
    approach = control.approach_without_contact(gap)
    if approach > 0:
        return None
    return GridResult(np.zeros(gap.size), np.zeros(gap.size), approach, 0.0, converged=True)


def pressed_flat(
    operator: DisplacementOperator, gap: FloatArray, control: Control, cap: float, *, flat: bool
) -> GridResult | None:
    """Return full contact of a doubly periodic gap under a load, where the gap is flat to round-off.

    The pressure is uniform plus the part that closes the gap; iterations would see rounding only. Returns None for
    other problems, and where the pressure leaves its bounds.
    """
    if not (isinstance(control, LoadControl) and operator.mean_free and (flat or gap.max() == 0)):
        return None
    mean = min(control.force / gap.size, cap)
    if gap.max() == 0:
        return GridResult(np.full(gap.size, mean), np.zeros(gap.size), 0.0, 0.0, converged=True)
    full = full_contact(operator, gap)
    pressure = full.pressure + (mean - full.pressure.mean())
    if pressure.min() < 0 or pressure.max() > cap:
        return None
    return replace(full, pressure=pressure, exact_displacement=False)


def full_contact(operator: DisplacementOperator, gap: FloatArray) -> GridResult:
    """Return the least pressure that closes a doubly periodic gap everywhere."""
    shape = operator.grid.shape
    pressure = operator.scaled_inverse().apply(-gap.reshape(shape), np.empty(shape)).reshape(-1)
    pressure -= pressure.min()
    displacement = operator.scaled().apply(pressure.reshape(shape), np.empty(shape)).reshape(-1)
    return GridResult(pressure, displacement, float((gap + displacement).mean()), 0.0, converged=True)
