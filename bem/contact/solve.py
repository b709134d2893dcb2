"""The front door of dry contact: checks, units, coarse to fine, certificate."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from bem.contact import cascade, passes
from bem.contact.active_set import Effort, LevelResult, Tolerance, Tuning, solve_level
from bem.contact.certificate import Request, Units, certify
from bem.contact.controls import ApproachControl, Control, LoadControl, MeanGapControl, scaled_control
from bem.contact.least_gap import least_gap
from bem.contact.search import Solve, approach_by_load, mean_gap_by_approach, mean_gap_by_load, mean_opening
from bem.contact.solution import ContactSolution
from bem.convolution import DisplacementOperator
from bem.errors import InfeasibleError, InputError, Status

FloatArray = NDArray[np.float64]
Callback = Callable[[int, float, float], object]
Report = Callable[[int, float, int], None]

_TIGHTER = 0.9
"""Share of the tolerance that the solver aims at, so that rounding in SI units cannot spoil the certificate."""

_WARY_ROUNDS = 400
"""Limit on rounds that may not raise the energy; a hundred were counted under a layer 38 times as stiff."""

_LAGS = 60
"""Limit on contacts with friction taken from the one before; ten are usual."""

_COARSE_TOLERANCE = 6e-2
"""Violation over roughness that coarse grids are solved to: more is lost in the interpolation anyway."""


def solve_contact(
    gap: FloatArray,
    operator: DisplacementOperator,
    *,
    load: float | None = None,
    approach: float | None = None,
    mean_gap: float | None = None,
    hardness: float | None = None,
    tolerance: float = 1e-8,
    initial_pressure: FloatArray | None = None,
    max_iterations: int = 5000,
    callback: Callback | None = None,
) -> ContactSolution:
    """Pressure between two bodies that may not overlap, elastic or capped at a hardness.

    Parameters
    ----------
    gap : (nx, ny), undeformed gap of the two surfaces [m]; its constant matters only when `approach` is given.
    operator : from `displacement_operator`.
    load, approach, mean_gap : exactly one of total load [N], approach [m] and the mean over the grid of the positive
        part of the deformed gap [m]. On a doubly periodic grid displacements are mean-free: `approach` is by how
        much the means of the undeformed surfaces come closer than `gap` says.
    hardness : cap on the pressure [Pa]; None for purely elastic.
    tolerance : bound on the residual, see `ContactSolution`.
    initial_pressure : (nx, ny), a start near the solution; the coarser grids are then skipped.
    max_iterations : limit on iterations of conjugate gradients over all grids.
    callback : called with iterations, residual and fraction of cells in contact after each round on the grid itself.

    An elastic contact on a free axis may have no answer for a `mean_gap`: a layer much stiffer than its base bends and
    stands off somewhere, however hard it is pressed. Where that is proved the status is "infeasible", and `notes` has a
    bound on the mean gaps there are.

    Raises
    ------
    InputError : arguments out of range, one message for each.
    InfeasibleError : a load above hardness x area; on a doubly periodic grid without hardness, an approach beyond the
        mean of the gap.
    """
    gap, hardness_or_none = _check(
        gap, operator, load, approach, mean_gap, hardness, tolerance, initial_pressure, max_iterations
    )
    grid = operator.grid
    cap = math.inf if hardness_or_none is None else hardness_or_none
    datum, mean, roughness = (float(value) for value in passes.moments(gap.reshape(-1)))
    _refuse_infeasible(operator, load, approach, hardness_or_none, mean, _TIGHTER * tolerance * roughness)
    before = operator.count.weighted

    length = _length_unit(operator, roughness, load, approach, mean_gap, datum, cap)
    to_pressure = length / operator.unit
    control = scaled_control(
        load, approach, mean_gap, cell_force=to_pressure * grid.cell_area, length=length, datum=datum
    )
    scaled_cap = cap / to_pressure
    scaled_gap = np.empty(grid.cells)
    passes.rescale(gap.reshape(-1), datum, 1 / length, scaled_gap)
    effort = Effort(max_iterations)
    scale = roughness / length

    problem = _Problem(tolerance=_TIGHTER * tolerance * scale if scale > 0 else tolerance, scale=scale, effort=effort)
    result = _without_contact(control, scaled_gap) or _pressed_flat(operator, scaled_gap, control, scaled_cap)
    if result is None:
        if initial_pressure is not None:
            pressure = np.clip(initial_pressure.reshape(-1) / to_pressure, 0.0, scaled_cap)
            start = _Start(pressure, _approach_of(operator, scaled_gap, pressure, control, scaled_cap))
        else:
            start = _from_coarser(problem, operator, scaled_gap.reshape(grid.shape), control, scaled_cap)
        report = None
        if callback is not None:
            used = callback

            def report(iterations: int, violation: float, cells: int) -> None:
                used(iterations, violation / (scale or 1.0), cells / grid.cells)

        result = _solve(problem, operator, scaled_gap, control, scaled_cap, start, problem.tolerance, report)
    return certify(
        Request(gap, operator, load, approach, mean_gap, cap, tolerance),
        Units(length, to_pressure, datum),
        roughness,
        result,
        unmet=Status.INFEASIBLE
        if result.least_mean_gap is not None
        else Status.MAX_ITERATIONS
        if effort.left <= 0
        else Status.STALLED,
        iterations=effort.iterations,
        convolutions_before=before,
    )


@dataclass(frozen=True)
class _Problem:
    """What all grids of one problem share: tolerance and roughness in the solver's length, effort, tuning."""

    tolerance: float
    scale: float
    effort: Effort
    tuning: Tuning = field(default_factory=Tuning)


@dataclass(frozen=True)
class _Start:
    """Pressure (flat) and approach to begin with."""

    pressure: FloatArray | None
    approach: float


def _approach_of(
    operator: DisplacementOperator, gap: FloatArray, pressure: FloatArray, control: Control, cap: float
) -> float:
    """The approach that a given pressure belongs to; needed only where the approach is searched for.

    Bodies overlap where the pressure is at its cap, and the mean over a plastic contact says nothing.
    """
    touching = pressure > 0
    if not isinstance(control, MeanGapControl) or not touching.any() or (pressure >= cap).any():
        return -math.inf
    shape = operator.grid.shape
    displacement = operator.scaled().apply(pressure.reshape(shape), np.empty(shape)).reshape(-1)
    return float((gap + displacement)[touching].mean())


def _without_contact(control: Control, gap: FloatArray) -> LevelResult | None:
    """The result where the bodies do not press on each other at all. The lowest gap is zero."""
    if isinstance(control, LoadControl):
        approach = 0.0 if control.force == 0 else math.inf
    elif isinstance(control, ApproachControl):
        approach = control.approach
    else:
        approach = float(gap.mean()) - control.mean_gap
    if approach > 0:
        return None
    return LevelResult(np.zeros(gap.size), np.zeros(gap.size), approach, 0.0, True, 0)


def _pressed_flat(operator: DisplacementOperator, gap: FloatArray, control: Control, cap: float) -> LevelResult | None:
    """A uniform pressure where a doubly periodic gap is flat: it moves nothing, and iterations see rounding only."""
    if not (isinstance(control, LoadControl) and operator.mean_free and gap.max() == 0):
        return None
    pressure = min(control.force / gap.size, cap)
    return LevelResult(np.full(gap.size, pressure), np.zeros(gap.size), 0.0, 0.0, True, 0)


def _solve(
    problem: _Problem,
    operator: DisplacementOperator,
    gap: FloatArray,
    control: Control,
    cap: float,
    start: _Start,
    tolerance: float,
    report: Report | None = None,
) -> LevelResult:
    """One grid, any control. Controls without a direct way are reached by way of the load."""

    def directly(control: ApproachControl | LoadControl, start: FloatArray | None, tolerance: float) -> LevelResult:
        allowed = Tolerance(
            tolerance if problem.scale > 0 else math.inf, tolerance / problem.scale if problem.scale > 0 else tolerance
        )
        tuning = problem.tuning if operator.symmetric else replace(problem.tuning, stall=25)
        result = solve_level(operator, gap, control, cap, start, allowed, problem.effort, tuning, report)
        if result.converged or problem.effort.left <= 0:
            return result
        if not operator.symmetric:
            return _lagged(problem, operator, gap, control, cap, start, allowed, report)
        # once more from there, with every round on the guard: the energy falls even where the violation long does not;
        # and at last with all pressures of a round exact, which is dear but swings least
        for clipping in (problem.tuning.clipping, 0.0):
            wary = replace(problem.tuning, patience=0, rounds=_WARY_ROUNDS, clipping=clipping)
            result = solve_level(operator, gap, control, cap, result.pressure, allowed, problem.effort, wary, report)
            if result.converged or problem.effort.left <= 0:
                break
        return result

    if isinstance(control, MeanGapControl) and operator.mean_free:
        if control.mean_gap <= tolerance:
            closed = _full_contact(operator, gap)
            if closed.pressure.max() < cap:
                return closed
        if math.isinf(cap):
            # displacements have no mean: the mean gap fixes the approach
            control = ApproachControl(float(gap.mean()) - control.mean_gap)
    scale = problem.scale or 1.0
    if isinstance(control, MeanGapControl):
        # with mean-free displacements there is another way
        # displacements are not negative on average, so the first of these approaches is not enough
        least = float(gap.mean()) - control.mean_gap
        result = mean_gap_by_approach(
            control.mean_gap,
            gap,
            start.pressure,
            scale,
            tolerance,
            directly,
            bracket=(least, math.inf),
            guess=max(start.approach, least),
            patient=not operator.mean_free,
        )
        missed = not result.converged or abs(mean_opening(gap, result) - control.mean_gap) > tolerance
        if not missed or problem.effort.left <= 0:
            return result
        if operator.mean_free:
            return mean_gap_by_load(control.mean_gap, gap, cap, scale, tolerance, directly)
        return result if math.isfinite(cap) else _least_gap(control, operator, gap, result, scale, tolerance, directly)
    result = directly(control, start.pressure, tolerance)
    if isinstance(control, LoadControl) or result.converged or problem.effort.left <= 0:
        return result
    return approach_by_load(control.approach, cap, None, gap.size, scale, tolerance, directly)


def _least_gap(
    control: MeanGapControl,
    operator: DisplacementOperator,
    gap: FloatArray,
    missed: LevelResult,
    scale: float,
    tolerance: float,
    solve: Solve,
) -> LevelResult:
    """A mean gap that the search did not find: below the least there is, or on the way down to it."""

    def at(approach: float, start: FloatArray | None) -> LevelResult:
        return solve(ApproachControl(approach), start, tolerance)

    first = at(float(gap.mean()), None)
    if not first.converged:
        return missed
    found = least_gap(control.mean_gap, operator, gap, first, scale, tolerance, at)
    if found is None:
        return missed
    if found.bracket is None:
        return replace(found.result, converged=False, least_mean_gap=found.bound)
    return mean_gap_by_approach(
        control.mean_gap, gap, found.result.pressure, scale, tolerance, solve, bracket=found.bracket
    )


def _lagged(
    problem: _Problem,
    operator: DisplacementOperator,
    gap: FloatArray,
    control: ApproachControl | LoadControl,
    cap: float,
    start: FloatArray | None,
    allowed: Tolerance,
    report: Report | None,
) -> LevelResult:
    """Friction's part of the displacement taken from the last pressure, over and over: each contact is then without it.

    Slower than friction in every round, but it gets there where the rounds swing: what friction adds varies less from
    one pressure to the next than the sets of cells do.
    """
    shape = operator.grid.shape
    alone = operator.frictionless
    displacement, part = np.empty(shape), np.empty(shape)
    pressure = np.zeros(gap.size) if start is None else start
    last: FloatArray | None = None
    approach, precision, violation, least = 0.0, math.inf, math.inf, math.inf
    fresh = False
    waited = 0
    for _ in range(_LAGS):
        operator.scaled().apply(pressure.reshape(shape), displacement)
        alone.scaled().apply(pressure.reshape(shape), part)
        fresh = True
        coupling = (displacement - part).reshape(-1)
        goal = min(allowed.length, allowed.relative * float(np.abs(displacement).max()))
        if last is not None:
            change = float(np.abs(coupling - last).max())
            violation = precision + change
            waited = 0 if change < 0.9 * least else waited + 1
            least = min(least, change)
            if violation <= goal or problem.effort.left <= 0 or waited > 5:
                break
            tolerance = Tolerance(max(0.3 * allowed.length, 0.1 * change), 0.3 * allowed.relative)
        else:
            tolerance = Tolerance(_COARSE_TOLERANCE * (problem.scale or math.inf), _COARSE_TOLERANCE)
        result = solve_level(
            alone, gap + coupling, control, cap, start, tolerance, problem.effort, problem.tuning, report
        )
        last, approach, precision = coupling, result.approach, result.violation
        pressure = start = result.pressure
        fresh = False
    return LevelResult(pressure, displacement.reshape(-1), approach, violation, violation <= goal, 0, fresh)


def _full_contact(operator: DisplacementOperator, gap: FloatArray) -> LevelResult:
    """The least pressure that closes a doubly periodic gap everywhere."""
    shape = operator.grid.shape
    pressure = operator.scaled_inverse().apply(-gap.reshape(shape), np.empty(shape)).reshape(-1)
    pressure -= pressure.min()
    displacement = operator.scaled().apply(pressure.reshape(shape), np.empty(shape)).reshape(-1)
    return LevelResult(pressure, displacement, float((gap + displacement).mean()), 0.0, True, 1)


def _from_coarser(
    problem: _Problem, operator: DisplacementOperator, gap: FloatArray, control: Control, cap: float
) -> _Start:
    """Pressure interpolated from the solution on the next coarser grid, itself begun in the same way."""
    nothing = _Start(None, -math.inf)
    coarse = operator.coarsened()
    if coarse is None or coarse.grid.cells == operator.grid.cells:
        return nothing
    periodic = operator.grid.periodic
    # the kernel's unit may differ by a power of two between grids, and a force is a sum over cells
    factor = coarse.unit / operator.unit
    coarse_gap = cascade.sample(gap, coarse.grid.shape, periodic)
    there = control
    if isinstance(control, ApproachControl) and operator.mean_free:
        # what matters is how far it is from the mean gap: beyond that, elastic contact would have no solution
        there = ApproachControl(control.approach + float(coarse_gap.mean() - gap.mean()))
    if isinstance(control, LoadControl):
        there = LoadControl(control.force * factor * operator.grid.cell_area / coarse.grid.cell_area)
    flat = coarse_gap.reshape(-1)
    if _without_contact(there, flat) is not None:
        return nothing
    start = _from_coarser(problem, coarse, coarse_gap, there, cap * factor)
    tolerance = max(problem.tolerance, _COARSE_TOLERANCE * (problem.scale or 1.0))
    result = _solve(problem, coarse, flat, there, cap * factor, start, tolerance)
    shape = coarse.grid.shape
    fine = cascade.prolong(
        result.pressure.reshape(shape),
        result.displacement.reshape(shape),
        coarse_gap,
        result.approach,
        cap * factor,
        gap.shape,
        periodic,
    )
    fine /= factor
    return _Start(fine.reshape(-1), result.approach)


def _length_unit(
    operator: DisplacementOperator,
    roughness: float,
    load: float | None,
    approach: float | None,
    mean_gap: float | None,
    datum: float,
    cap: float,
) -> float:
    """Power of two [m] near the roughness; near the displacement to come where the gap is flat."""
    length = roughness
    if not length > 0:
        if load is not None:
            length = load / operator.grid.area * operator.unit
        elif approach is not None:
            length = abs(approach - datum)
        elif mean_gap is not None:
            length = mean_gap
    if not (length > 0 and math.isfinite(length)):
        return 1.0
    return 2.0 ** round(math.log2(length))


def _check(
    gap: FloatArray,
    operator: DisplacementOperator,
    load: float | None,
    approach: float | None,
    mean_gap: float | None,
    hardness: float | None,
    tolerance: float,
    initial_pressure: FloatArray | None,
    max_iterations: int,
) -> tuple[FloatArray, float | None]:
    if not isinstance(operator, DisplacementOperator):
        raise InputError(f"solve_contact: operator {operator!r} must come from displacement_operator")
    messages = []
    checked = gap
    for name, values in (("gap", gap), ("initial_pressure", initial_pressure)):
        if name == "gap" or values is not None:
            try:
                array = operator.grid.check_field(values, f"solve_contact: {name}")
                if name == "gap":
                    checked = array
                elif array.min() < 0:
                    messages.append(
                        f"solve_contact: initial_pressure has a minimum of {array.min()!r} Pa; it must be >= 0"
                    )
            except InputError as error:
                messages.extend(error.messages)
    controls = {"load": load, "approach": approach, "mean_gap": mean_gap}
    given = {name: value for name, value in controls.items() if value is not None}
    if len(given) != 1:
        messages.append(
            f"solve_contact: give exactly one of load, approach and mean_gap, not {', '.join(given) or 'none of them'}"
        )
    for name, value in given.items():
        if not _is_number(value) or (name != "approach" and value < 0):
            bound = "" if name == "approach" else " and not negative"
            messages.append(f"solve_contact: {name} {value!r} must be finite{bound}")
    if hardness is not None and not (_is_number(hardness) and hardness > 0):
        messages.append(f"solve_contact: hardness {hardness!r} must be positive and finite [Pa], or None")
    if not (_is_number(tolerance) and 0 < tolerance < 1):
        messages.append(f"solve_contact: tolerance {tolerance!r} must lie between 0 and 1")
    if isinstance(max_iterations, bool) or not isinstance(max_iterations, int) or max_iterations < 1:
        messages.append(f"solve_contact: max_iterations {max_iterations!r} must be a positive integer")
    if messages:
        raise InputError(messages)
    return checked, None if hardness is None else float(hardness)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float | np.floating | np.integer) and math.isfinite(value)


def _refuse_infeasible(
    operator: DisplacementOperator,
    load: float | None,
    approach: float | None,
    hardness: float | None,
    mean: float,
    slack: float,
) -> None:
    if load is not None and hardness is not None:
        most = hardness * operator.grid.area
        if load > most * (1 + 1e-12):
            raise InfeasibleError(
                f"solve_contact: load {load!r} N is more than hardness x area = {most!r} N can carry; "
                "lower the load or raise the hardness"
            )
    if approach is not None and hardness is None and operator.mean_free and approach > mean + slack:
        raise InfeasibleError(
            f"solve_contact: approach {approach!r} m is beyond the mean gap {mean!r} m; on a doubly periodic grid "
            "elastic bodies in full contact cannot come closer"
        )
