"""Primal-dual active set on one grid: conjugate gradients on the active cells, between updates of the set.

The pressure minimises p.Kp/2 + p.(gap - approach) over 0 <= p <= cap, with its sum prescribed under load control. An
outer iteration

1. applies the operator in double precision, which gives the true gap, its violations and the energy; if the energy has
   its minimum well before the end of the step, it backtracks to the minimum, whose displacement takes no convolution,
   and then projects the unconstrained step of that length, because a cell that is active at either end is active
   between both;
2. adds the free cells that overlap and the capped cells that open;
3. solves for pressures without bounds on the active cells (`pcg`; `gcr` with friction or a prescribed mean gap); and
4. projects onto the bounds and restores the prescribed load (`bounds`, `controls`).

The energy may rise while the largest violation falls. After a few outer iterations without progress an energy guard
takes back every step that raises the energy and replaces it by part of it, or by a projected gradient step, until a
tenth of the violation is reached; no set of cells can then repeat.

Where nearly all cells in contact are at the cap, unbounded pressures carry no information, and a projected gradient
step takes their place. Friction in the gap and a prescribed mean gap have no energy; where the sets then swing,
`fallbacks` has other methods.

Verified in tests/contact/test_contact_oracle.py and tests/contact/test_contact_solver.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.contact import bounds, gcr, pcg, reductions
from bem.contact.bounds import Iterate, split_cells, split_field
from bem.contact.controls import Control
from bem.contact.grid_workspace import (
    ActiveCells,
    GridResult,
    GridWorkspace,
    Indices,
    InitialPressure,
    IterationBudget,
    SolverParameters,
    Tolerance,
)
from bem.contact.reductions import Survey
from bem.convolution import DisplacementOperator

FloatArray = NDArray[np.float64]
Report = Callable[[int, float, int], None]
"""Called after each outer iteration with CG iterations, violation and cells in contact."""

_ENERGY_FALL = 1e-9
"""Relative fall of the energy that counts as progress under the energy guard."""

_ENERGY_ROUND_OFF = 1e-12
"""Energies closer than this, relative to the sum of their terms, count as equal."""

_SHORTEST_STEP = 0.02
"""Fraction of a step below which the minimum of the energy is not worth going to."""

_LONGEST_STEP = 0.75
"""Fraction of a step above which its end is accepted instead of the minimum; shorter limits let the sets swing."""

_LONGEST_GUARDED_STEP = 0.98
"""The same fraction under the energy guard."""

_ROUND_OFF_PATIENCE = 5
"""Outer iterations without progress that are made where the violation is round-off of the transforms."""

_FEW = 0.1
"""Cells between the bounds over cells at the cap, below which the contact counts as fully plastic."""


def solve_active_set(
    operator: DisplacementOperator,
    gap: FloatArray,
    control: Control,
    cap: float,
    start: InitialPressure,
    tolerance: Tolerance,
    budget: IterationBudget,
    parameters: SolverParameters,
    report: Report | None = None,
) -> GridResult:
    """Solve on one grid until no contact condition is violated by more than the tolerance.

    Parameters
    ----------
    operator : displacement operator of the grid.
    gap : flat, lowest value zero.
    control : prescribed quantity.
    cap : highest pressure; may be infinite.
    start : feasible initial pressure, or None.
    tolerance : largest violation allowed.
    budget : iterations that are left to all grids.
    parameters : numbers that balance outer iterations against CG iterations.
    report : called after each outer iteration.
    """
    grid = GridWorkspace(operator, gap, cap, parameters)
    progress, guard = _Progress(parameters), _EnergyGuard()
    iterate = control.initial_iterate(grid, start)
    has_energy = operator.symmetric and control.has_energy
    before: _Point | None = None
    step: _Step | None = None
    while True:
        grid.begin_round(iterate, keep=before is not None)
        now = _evaluate(grid, control, iterate, before, tolerance, progress)
        if report is not None:
            report(budget.iterations, now.violation, now.iterate.cells.size + now.iterate.capped.size)
        if now.violation <= now.goal:
            return now.result(grid, converged=True)
        progress.rounds += 1
        grid.extrapolation.judge(now.violation)
        if budget.left <= 0 or progress.rounds >= parameters.rounds:
            return now.result(grid)
        current = now.point
        potential = control.potential(current.energy, current.force)
        if progress.stalls(now.violation, potential, current.size, round_off=now.round_off):
            return now.result(grid, round_off=now.round_off)
        before = current if has_energy else None
        improved = progress.improves(now.violation)
        progress.set_guard(now.violation, has_energy=has_energy)
        if progress.release == 0.0:
            guard.accepted = None
        elif guard.accepted is not None and not improved and current.above(guard.accepted, now.approach):
            iterate, step = guard.take_back(grid, control, guard.accepted, current), None
            continue
        guard.accepted, guard.refused = current, 0
        shorter = step.shortened(grid, control, now.length) if step is not None and now.length < 1 else None
        if shorter is not None:
            iterate, step = shorter, None
            continue
        step = _next_step(grid, control, now, budget, symmetric=has_energy)
        if step is None:
            return now.result(grid)
        iterate = step.iterate
        if step.shifted:
            before = None


class _Point(NamedTuple):
    """A feasible pressure with its approach.

    energy : at approach zero. size : sum of the energy's terms. force : sum of pressures.
    """

    iterate: Iterate
    approach: float
    energy: float
    size: float
    force: float

    def above(self, other: _Point, approach: float) -> bool:
        """Return True if the energy at an approach is higher than the other's by more than round-off."""
        rise = self.energy - other.energy - approach * (self.force - other.force)
        return rise > _ENERGY_ROUND_OFF * max(self.size, other.size)


@dataclass(frozen=True)
class _Evaluation:
    """A pressure with its true gap.

    length : fraction of the step that was taken; below one after backtracking.
    violating : cells that violate their state. violation : largest violation. goal : its tolerance.
    round_off : True if the violation is near the resolution of the transforms.
    """

    point: _Point
    length: float
    violating: NDArray[np.int32]
    violation: float
    goal: float
    round_off: bool

    @property
    def iterate(self) -> Iterate:
        """Return the pressure."""
        return self.point.iterate

    @property
    def approach(self) -> float:
        """Return the approach of the pressure."""
        return self.point.approach

    def result(self, grid: GridWorkspace, *, converged: bool = False, round_off: bool = False) -> GridResult:
        """Return the result on this grid; its buffers are released."""
        pressure, displacement = grid.release(self.iterate)
        return GridResult(
            pressure,
            displacement,
            self.approach,
            self.violation,
            converged=converged,
            exact_displacement=self.length == 1,
            round_off=round_off,
        )


@dataclass(slots=True)
class _Progress:
    """Progress so far; decides when to give up and when to set the energy guard.

    first : first violation. best : least violation. mark, lowest : least violation and energy, for stalling.
    waited : outer iterations since `mark` or `lowest` improved. unimproved : outer iterations since `best` did.
    release : violation that releases the energy guard; zero while the guard is off.
    """

    parameters: SolverParameters
    rounds: int = 0
    first: float = math.inf
    best: float = math.inf
    mark: float = math.inf
    lowest: float = math.inf
    waited: int = 0
    unimproved: int = 0
    release: float = 0.0

    def stalls(self, violation: float, potential: float, size: float, *, round_off: bool) -> bool:
        """Return True if neither the violation nor, under the guard, the energy has fallen for long."""
        fell = self.parameters.patience == 0 and potential < self.lowest - _ENERGY_FALL * size
        self.waited = 0 if violation < 0.7 * self.mark or fell else self.waited + 1
        self.mark, self.lowest = min(self.mark, violation), min(self.lowest, potential)
        limit = self.parameters.stall
        return self.waited > (min(_ROUND_OFF_PATIENCE, limit) if round_off else limit)

    def improves(self, violation: float) -> bool:
        """Return True if the violation is the least so far, by a tenth."""
        improved = violation < 0.9 * self.best
        self.unimproved = 0 if improved else self.unimproved + 1
        self.best = min(self.best, violation)
        return improved

    def set_guard(self, violation: float, *, has_energy: bool) -> None:
        """Set the energy guard after too many outer iterations without progress, or release it."""
        if self.unimproved >= self.parameters.patience and self.release == 0.0 and has_energy:
            self.release = 0.1 * self.best
        elif violation <= self.release:
            self.release = 0.0


@dataclass(slots=True)
class _EnergyGuard:
    """The last accepted pressure, the refused steps since, and the length of the last gradient step."""

    accepted: _Point | None = None
    refused: int = 0
    step: float = 0.0

    def take_back(self, grid: GridWorkspace, control: Control, last: _Point, refused: _Point) -> Iterate:
        """Replace a step that raised the energy by part of it, or by a gradient step from its beginning."""
        self.refused += 1
        length = _energy_minimum(grid, last, refused, refused.approach) if self.refused == 1 else 0.0
        if length > 0:
            ends = (point.iterate.as_field(grid.gap.size, grid.cap) for point in (last, refused))
            first, second = ends
            raw = (1 - length) * first + length * second
            return split_field(control.project(raw, grid.cap), grid.cap)
        self.step = self.step / 4 if self.refused > 2 else 1 / grid.largest_eigenvalue
        grid.swap_displacements()
        grid.displace(last.iterate)
        return _gradient_step(grid, control, last.iterate, last.approach, self.step)


@dataclass(frozen=True)
class _Step:
    """The next pressure.

    shifted : True if energies cannot be compared along the step (shift of a full contact).
    begun, raw : the active cells with their pressures, and the pressures without bounds that the step was to reach.
    """

    iterate: Iterate
    shifted: bool = False
    begun: Iterate | None = None
    raw: FloatArray | None = None

    def shortened(self, grid: GridWorkspace, control: Control, length: float) -> Iterate | None:
        """Return the projection of the unconstrained step at a fraction of its length."""
        if self.begun is None or self.raw is None:
            return None
        values = self.begun.values
        return _to_bounds(grid, control, self.begun, values + length * (self.raw - values))


def _evaluate(
    grid: GridWorkspace,
    control: Control,
    iterate: Iterate,
    before: _Point | None,
    tolerance: Tolerance,
    progress: _Progress,
) -> _Evaluation:
    """Evaluate the pressure whose displacement is in the buffer, or the minimum of the energy on the way to it."""
    survey, length = grid.survey(iterate, None if before is None else before.iterate), 1.0
    backtracked = None if before is None else _backtrack(grid, before, iterate, survey)
    if backtracked is not None:
        iterate, length = backtracked
        survey = grid.survey(iterate)
    approach = control.approach(grid, iterate, survey.total)
    violating, largest = grid.violations(iterate, approach)
    violation = max(largest, survey.deepest - approach, approach - survey.nearest)
    if progress.rounds == 0:
        progress.first = violation
    point = _Point(iterate, approach, survey.energy, survey.size, survey.force)
    goal = tolerance.bound(approach, survey.reach, progress.first)
    return _Evaluation(point, length, violating, violation, goal, tolerance.is_round_off(violation, survey.reach))


def _backtrack(grid: GridWorkspace, before: _Point, iterate: Iterate, survey: Survey) -> tuple[Iterate, float] | None:
    """Return the minimum of the energy along a step, and its fraction of the step; None to accept the end.

    Changes of the set that are each right can be too many together, and the sets would swing ever wider. The
    displacement of the minimum replaces that in the buffer without a convolution. `survey` is that of the end.
    """
    displacement, approach = grid.flat["displacement"], before.approach
    slope = survey.work - survey.work_of_other - approach * (survey.force - before.force)
    rise = survey.energy - before.energy - approach * (survey.force - before.force)
    curvature = 2 * (slope - rise)
    if not curvature > 10 * _ENERGY_ROUND_OFF * max(survey.size, before.size):
        return None
    length = 1 - slope / curvature
    if not _SHORTEST_STEP < length < _LONGEST_STEP:
        return None
    reductions.in_blocks(displacement.size, 0, bounds.mix, displacement, grid.flat["before"], length)
    ends = _pressed(before.iterate, grid.cap), _pressed(iterate, grid.cap)
    cells, values = bounds.blend(*ends, length, grid.cap)
    if before.iterate.capped.size == 0 and iterate.capped.size == 0:
        return Iterate(cells, values, iterate.capped), length
    return split_cells(cells, values, grid.cap), length


def _pressed(iterate: Iterate, cap: float) -> tuple[Indices, FloatArray]:
    """Return all cells with pressure in ascending order, and their pressures."""
    if iterate.capped.size == 0:
        return iterate.cells, iterate.values
    cells = np.concatenate([iterate.cells, iterate.capped])
    values = np.concatenate([iterate.values, np.full(iterate.capped.size, cap)])
    order = np.argsort(cells, kind="stable")
    return cells[order], values[order]


def _energy_minimum(grid: GridWorkspace, old: _Point, new: _Point, approach: float) -> float:
    """Return the fraction of a step with the least energy; zero if the energy rises from the start.

    The displacement of the new pressure is in the buffer.
    """
    size, cap = grid.gap.size, grid.cap
    change = new.iterate.as_field(size, cap) - old.iterate.as_field(size, cap)
    slope = float((change * (grid.gap + grid.flat["displacement"] - approach)).sum())
    rise = new.energy - old.energy - approach * (new.force - old.force)
    curvature = 2 * (slope - rise)
    if not curvature > 0:
        return 0.0
    length = 1 - slope / curvature
    return length if _SHORTEST_STEP < length < _LONGEST_GUARDED_STEP else 0.0


def _gradient_step(grid: GridWorkspace, control: Control, iterate: Iterate, approach: float, step: float) -> Iterate:
    """Take a projected gradient step; one over the largest eigenvalue cannot raise the energy."""
    raw = np.empty(grid.gap.size)
    reductions.in_blocks(raw.size, 0, bounds.descend, grid.flat["displacement"], grid.gap, approach, step, raw)
    raw[iterate.cells] += iterate.values
    raw[iterate.capped] += grid.cap
    return split_field(control.project(raw, grid.cap), grid.cap)


def _next_step(
    grid: GridWorkspace, control: Control, now: _Evaluation, budget: IterationBudget, *, symmetric: bool
) -> _Step | None:
    """Activate the violating cells, close the gap and project onto the bounds; None without an active cell."""
    active = grid.activate(now.iterate, now.violating, now.approach, with_rise=control.coupled)
    if active.iterate.cells.size == 0:
        return None
    if _is_full_contact(grid, control, active, now.goal):
        shifted = bounds.shift_full_contact(active.iterate, active.mean_gap, grid.cap)
        if shifted is not None:
            return _Step(shifted, shifted=True)
        # a cell is at a bound already: close the varying part of the gap first
        active = replace(active, gap=active.gap - active.mean_gap, mean_gap=0.0)
    solver = pcg if symmetric else gcr
    raw = solver.close_gap(grid, active, control, now.goal, budget)
    iterate = active.iterate
    clipped = _to_bounds(grid, control, iterate, raw.copy())
    if clipped.cells.size <= _FEW * clipped.capped.size and clipped.cells.size < 0.5 * iterate.cells.size:
        # fully plastic: unbounded pressures carry no information
        return _Step(_gradient_step(grid, control, iterate, now.approach, 1 / grid.self_response))
    return _Step(clipped, begun=iterate, raw=raw)


def _to_bounds(grid: GridWorkspace, control: Control, iterate: Iterate, raw: FloatArray) -> Iterate:
    """Project trial pressures (overwritten) on the active cells onto the bounds, and restore the load.

    Neighbours make up for tension that is removed, regions for load that a cap clips.
    """
    near = grid.near_on(iterate.cells)
    mean_free = grid.operator.mean_free
    if near is None or control.keeps_regional_load(capped=math.isfinite(grid.cap), mean_free=mean_free):
        shape = grid.operator.grid.shape
        bounds.redistribute_clipped_load(iterate.cells, raw, grid.cap, shape, bounds.REGION)
    else:
        bounds.eliminate_tension(near, raw)
    return control.restore(grid, iterate, raw)


def _is_full_contact(grid: GridWorkspace, control: Control, active: ActiveCells, goal: float) -> bool:
    """Return True if a doubly periodic gap is closed everywhere at a prescribed approach that is not its mean."""
    return (
        control.leaves_uniform_pressure
        and grid.operator.mean_free
        and active.iterate.cells.size == grid.gap.size
        and not (math.isinf(grid.cap) and active.mean_gap <= goal)
    )
