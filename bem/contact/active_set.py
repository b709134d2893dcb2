"""Primal-dual active set on one grid: conjugate gradients on the active cells, between updates of the set.

The set is fixed while conjugate gradients run (Hintermueller, Ito & Kunisch 2003); it does not change in each of their
iterations as in Polonsky & Keer (1999). Steps 5 to 8 of `bem.contact` and the gradient step of step 10, called by
`problem.GridProblem.solve` on every grid; steps 9 and 10 are called from here. The pressure minimises p.Kp/2 + p.(gap -
approach) over 0 <= p <= cap, with its sum prescribed under load control. An outer iteration

(a) applies the operator in double precision (`GridWorkspace.begin_round`). `_evaluate` sums the energy. If the energy
   has its minimum well before the end of the step, `_backtrack` blends to the minimum, whose displacement takes no
   convolution, and the sums are taken again. Only then follow the approach, the violations and their tolerance: they
   are those of the blend, and the end of a step that was blended is not judged. `_Step.shortened` then projects the
   unconstrained step of that length, because a cell that is active at either end is active between both;
(b) `_next_step`: adds the open cells that overlap and the capped cells that open (`grid_workspace`);
(c) solves for pressures without bounds on the active cells (`pcg`; `gcr` with friction or a prescribed mean gap); and
(d) `_to_bounds`: projects onto the bounds and restores the prescribed load (`bounds`, `controls`).

The energy may rise while the largest violation falls. After a few outer iterations without progress an energy guard
(`_EnergyGuard`) rejects every step that raises the energy, unless the violation fell by a tenth. It replaces the step
by part of it, which unlike the blend of `_backtrack` takes a convolution, or by a projected gradient step that is
shortened as long as it raises the energy. The guard is released at a tenth of the least violation before it was set; in
a guarded run the next outer iteration sets it again. Sets of cells can repeat only where their energies differ by less
than round-off.

Where the projection leaves at most one in eleven cells in contact between the bounds, and fewer than half of the active
cells, unbounded pressures carry no information. They are discarded, convolutions included, for a projected gradient
step whose length is one over the response of a single cell; it may raise the energy.

Friction in the gap and a prescribed mean gap have no energy; where the sets then swing, `solve_on_grid` has other
methods.

Verified in tests/contact/test_contact_oracle.py, tests/contact/test_contact_solver.py and
tests/contact/test_energy_guard.py.
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
from bem.contact.controls import MOSTLY_PLASTIC_RATIO, Control
from bem.contact.grid_workspace import (
    ActiveCells,
    GridResult,
    GridWorkspace,
    InitialPressure,
    IterationBudget,
    SolverParameters,
    Tolerance,
)
from bem.contact.reductions import ContactSums
from bem.contact.sparse_inverse import SparseInverseOnCells
from bem.convolution import DisplacementOperator

FloatArray = NDArray[np.float64]
Report = Callable[[int, float, float, int], None]
"""Called after each outer iteration with CG iterations, violation, largest displacement and cells in contact."""

_ENERGY_FALL = 1e-9
"""Relative fall of the energy that counts as progress under the energy guard."""

_ENERGY_ROUND_OFF = 1e-12
"""Energies closer than this, relative to the sum of their terms, count as equal."""

_SHORTEST_STEP = 0.02
"""Fraction of a step below which the minimum of the energy is not worth going to."""

_LONGEST_STEP = 0.75
"""Fraction of a step above which its end is accepted instead of the minimum; shorter limits let the sets swing."""

_LONGEST_GUARDED_STEP = 0.98
"""The same fraction for the blend by which the energy guard replaces a rejected step; `_backtrack` keeps its own
limit."""

_ROUND_OFF_PATIENCE = 5
"""Outer iterations without progress that are made where the violation is round-off of the transforms."""


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
    gap : one-dimensional; its lowest value is zero on the finest grid only.
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
    previous: _Point | None = None
    best: _Evaluation | None = None
    step: _Step | None = None
    while True:
        grid.begin_round(iterate, keep=previous is not None)
        now = _evaluate(grid, control, iterate, previous, tolerance, progress)
        if report is not None:
            report(
                budget.iterations,
                now.violation,
                now.largest_displacement,
                now.iterate.cells.size + now.iterate.capped.size,
            )
        if now.violation <= now.goal:
            return now.result(grid, converged=True)
        if best is None or now.violation < best.violation:
            best = now
        progress.rounds += 1
        grid.extrapolation.judge(now.violation)
        if budget.left <= 0 or progress.rounds >= parameters.rounds:
            return best.result(grid, last=now)
        current = now.point
        potential = control.potential(current.energy, current.force)
        if progress.stalls(now.violation, potential, current.energy_size, round_off=now.round_off):
            return best.result(grid, last=now, round_off=now.round_off)
        previous = current if has_energy else None
        improved = progress.improves(now.violation)
        progress.set_guard(now.violation, has_energy=has_energy)
        guarded = progress.release_violation > 0 and guard.accepted is not None and not improved
        if guarded and guard.accepted is not None and current.has_higher_energy_than(guard.accepted, now.approach):
            iterate, step = guard.reject_step(grid, control, guard.accepted, current), None
            continue
        guard.accept(current)
        shorter = (
            step.shortened(grid, control, now.step_fraction) if step is not None and now.step_fraction < 1 else None
        )
        if shorter is not None:
            iterate, step = shorter, None
            continue
        step = None  # releases the rows of the sparse inverse before the next ones are connected
        step = _next_step(grid, control, now, budget, has_energy=has_energy)
        if step is None:
            return best.result(grid, last=now)
        iterate = step.iterate
        if step.along_null_space:
            previous = None


class _Point(NamedTuple):
    """A feasible pressure with its approach.

    energy : at approach zero. energy_size : sum of its absolute terms, the scale of its round-off. force : sum of
    pressures.
    """

    iterate: Iterate
    approach: float
    energy: float
    energy_size: float
    force: float

    def has_higher_energy_than(self, other: _Point, approach: float) -> bool:
        """Return True if the energy at an approach is higher than the other's by more than round-off."""
        energy_change = self.energy - other.energy - approach * (self.force - other.force)
        return energy_change > _ENERGY_ROUND_OFF * max(self.energy_size, other.energy_size)


@dataclass(frozen=True)
class _Evaluation:
    """A pressure with its true gap.

    step_fraction : fraction of the step that was taken; below one after backtracking.
    violating : cells that violate their state. violation : largest violation. goal : its tolerance.
    largest_displacement : of the cells between the bounds; of the capped cells if none is between.
    round_off : True if the violation is near the resolution of the transforms.
    """

    point: _Point
    step_fraction: float
    violating: NDArray[np.int32]
    violation: float
    goal: float
    largest_displacement: float
    round_off: bool

    @property
    def iterate(self) -> Iterate:
        """Return the pressure."""
        return self.point.iterate

    @property
    def approach(self) -> float:
        """Return the approach of the pressure."""
        return self.point.approach

    def result(
        self,
        grid: GridWorkspace,
        *,
        last: _Evaluation | None = None,
        converged: bool = False,
        round_off: bool = False,
    ) -> GridResult:
        """Return the result on this grid; its buffers are released.

        last : the evaluation whose displacement is in the buffer; if it is not this one, a convolution replaces it.
        """
        step_fraction = self.step_fraction
        if last is not None and last is not self:
            grid.displace(self.iterate)
            step_fraction = 1.0
        pressure, displacement = grid.release(self.iterate)
        return GridResult(
            pressure,
            displacement,
            self.approach,
            self.violation,
            converged=converged,
            exact_displacement=step_fraction == 1,
            round_off=round_off,
        )


@dataclass(slots=True)
class _Progress:
    """Progress so far; decides when to give up and when to set the energy guard.

    A violation is compared with the violation at the last progress, not with the previous one: a slow but steady fall
    is progress as well.

    rounds : outer iterations so far: pressures evaluated, rejected and shortened steps included.
    first_violation, least_violation : of the largest violations so far.
    patience_mark : violation when it last fell by a tenth.
    rounds_without_improvement : outer iterations since then.
    stall_mark : violation when it last fell by three tenths.
    least_energy : so far.
    rounds_without_progress : outer iterations since the stall mark, or in a guarded run the energy, last fell.
    release_violation : violation that releases the energy guard; zero while the guard is off.
    """

    parameters: SolverParameters
    rounds: int = 0
    first_violation: float = math.inf
    least_violation: float = math.inf
    patience_mark: float = math.inf
    rounds_without_improvement: int = 0
    stall_mark: float = math.inf
    least_energy: float = math.inf
    rounds_without_progress: int = 0
    release_violation: float = 0.0

    def stalls(self, violation: float, potential: float, energy_size: float, *, round_off: bool) -> bool:
        """Return True if neither the violation nor, in a guarded run, the energy has fallen for long."""
        fell = self.parameters.guarded and potential < self.least_energy - _ENERGY_FALL * energy_size
        self.least_energy = min(self.least_energy, potential)
        progressed = violation < 0.7 * self.stall_mark
        if progressed:
            self.stall_mark = violation
        self.rounds_without_progress = 0 if progressed or fell else self.rounds_without_progress + 1
        limit = self.parameters.stall_limit
        return self.rounds_without_progress > (min(_ROUND_OFF_PATIENCE, limit) if round_off else limit)

    def improves(self, violation: float) -> bool:
        """Return True if the violation has fallen by a tenth since it last did."""
        self.least_violation = min(self.least_violation, violation)
        improved = violation < 0.9 * self.patience_mark
        if improved:
            self.patience_mark = violation
        self.rounds_without_improvement = 0 if improved else self.rounds_without_improvement + 1
        return improved

    def set_guard(self, violation: float, *, has_energy: bool) -> None:
        """Set the energy guard in a guarded run or after too many outer iterations without progress, or release it."""
        wanted = self.parameters.guarded or self.rounds_without_improvement >= self.parameters.patience
        if wanted and self.release_violation == 0.0 and has_energy:
            self.release_violation = 0.1 * self.least_violation
        elif violation <= self.release_violation:
            self.release_violation = 0.0


@dataclass(slots=True)
class _EnergyGuard:
    """The last accepted pressure, and the steps rejected since.

    rejected : their number. step_length : of the last gradient step among them, zero before the first.
    """

    accepted: _Point | None = None
    rejected: int = 0
    step_length: float = 0.0

    def accept(self, point: _Point) -> None:
        """Accept a pressure, from which the next steps begin."""
        self.accepted, self.rejected, self.step_length = point, 0, 0.0

    def reject_step(self, grid: GridWorkspace, control: Control, last: _Point, refused: _Point) -> Iterate:
        """Replace a step that raised the energy by part of it, or by a gradient step from its beginning.

        The first gradient step cannot raise the energy except by round-off of the displacement; each further one has a
        quarter of the length of the one before. The next `_backtrack` searches the line from the refused pressure,
        whose displacement is still stored, to the replacement: the energy at its minimum is at most that of the
        replacement.

        Energies are compared at the approach of the refused pressure. A blend costs the convolution of the next
        `begin_round`; a gradient step costs one more, for the displacement of the accepted pressure.
        """
        self.rejected += 1
        if self.rejected == 1:
            # sum over differences: the works of both pressures may agree in all digits
            previous, after = (point.iterate.as_field(grid.gap.size, grid.cap) for point in (last, refused))
            slope = float(((after - previous) * (grid.gap + grid.displacement_values - refused.approach)).sum())
            fraction = _least_energy_fraction(last, refused, slope, refused.approach)
            if _SHORTEST_STEP < fraction < _LONGEST_GUARDED_STEP:
                return _blend(last.iterate, refused.iterate, fraction, grid.cap)
        self.step_length = self.step_length / 4 if self.step_length > 0 else 1 / grid.largest_eigenvalue
        grid.swap_displacements()
        grid.displace(last.iterate)
        return _gradient_step(grid, control, last.iterate, last.approach, self.step_length)


@dataclass(frozen=True)
class _Step:
    """The next pressure.

    along_null_space : True if a uniform pressure on doubly periodic bodies was added, which displaces nothing: energies
    cannot be compared.
    initial, near, trial : the active cells with their pressures, the sparse inverse on them, and the pressures without
    bounds that the step was to reach.
    """

    iterate: Iterate
    along_null_space: bool = False
    initial: Iterate | None = None
    near: SparseInverseOnCells | None = None
    trial: FloatArray | None = None

    def shortened(self, grid: GridWorkspace, control: Control, step_fraction: float) -> Iterate | None:
        """Return the projection of the unconstrained step at a fraction of its length."""
        if self.initial is None or self.near is None or self.trial is None:
            return None
        values = self.initial.values
        return _to_bounds(grid, control, self.initial, self.near, values + step_fraction * (self.trial - values))


def _evaluate(
    grid: GridWorkspace,
    control: Control,
    iterate: Iterate,
    previous: _Point | None,
    tolerance: Tolerance,
    progress: _Progress,
) -> _Evaluation:
    """Evaluate the pressure whose displacement is in the buffer, or the minimum of the energy on the way to it.

    Order: sums, blend to the minimum, sums of the blend, approach, violations, tolerance.
    """
    sums, step_fraction = grid.contact_sums(iterate, None if previous is None else previous.iterate), 1.0
    backtracked = None if previous is None else _backtrack(grid, previous, iterate, sums)
    if backtracked is not None:
        iterate, step_fraction = backtracked
        sums = grid.contact_sums(iterate)
    approach = control.approach(grid, iterate, sums.separation_sum)
    violating, largest = grid.violations(iterate, approach)
    violation = max(largest, sums.largest_separation - approach, approach - sums.smallest_separation)
    if progress.rounds == 0:
        progress.first_violation = violation
    point = _Point(iterate, approach, sums.energy, sums.energy_size, sums.force)
    displacement = sums.largest_displacement
    goal = tolerance.bound(approach, displacement, progress.first_violation)
    round_off = tolerance.is_near_round_off(violation, displacement)
    return _Evaluation(point, step_fraction, violating, violation, goal, displacement, round_off)


def _backtrack(
    grid: GridWorkspace, previous: _Point, iterate: Iterate, sums: ContactSums
) -> tuple[Iterate, float] | None:
    """Return the minimum of the energy along a step, and its fraction of the step; None to accept the end.

    Changes of the set that are each right can be too many together, and the sets would swing ever wider. The
    displacement of the minimum replaces that in the buffer without a convolution. `sums` is that of the end, whose
    approach is not known yet: energies are compared at the approach of the previous pressure.
    """
    end = _Point(iterate, previous.approach, sums.energy, sums.energy_size, sums.force)
    slope = sums.work - sums.work_of_other - previous.approach * (sums.force - previous.force)
    fraction = _least_energy_fraction(previous, end, slope, previous.approach, 10 * _ENERGY_ROUND_OFF)
    if not _SHORTEST_STEP < fraction < _LONGEST_STEP:
        return None
    displacement = grid.displacement_values
    reductions.run_blocks(displacement.size, 0, bounds.mix, displacement, grid.previous_values, fraction)
    return _blend(previous.iterate, iterate, fraction, grid.cap), fraction


def _least_energy_fraction(old: _Point, new: _Point, slope: float, approach: float, least: float = 0.0) -> float:
    """Return the fraction of a step with the least energy; not-a-number where the curvature is not positive.

    slope : derivative of the energy along the step at its end. least : curvature over the energies' terms that is
    round-off.
    """
    energy_change = new.energy - old.energy - approach * (new.force - old.force)
    curvature = 2 * (slope - energy_change)
    if not curvature > least * max(new.energy_size, old.energy_size):
        return math.nan
    return 1 - slope / curvature


def _blend(old: Iterate, new: Iterate, fraction: float, cap: float) -> Iterate:
    """Return (1 - fraction) old + fraction new: cells open at both ends stay open, capped ones capped."""
    cells, values = bounds.blend(bounds.loaded_cells(old, cap), bounds.loaded_cells(new, cap), fraction, cap)
    if old.capped.size == 0 and new.capped.size == 0:
        return Iterate(cells, values, new.capped)
    return split_cells(cells, values, cap)


def _gradient_step(grid: GridWorkspace, control: Control, iterate: Iterate, approach: float, step: float) -> Iterate:
    """Take a projected gradient step; a step up to one over the largest eigenvalue cannot raise the energy."""
    trial = np.empty(grid.gap.size)
    reductions.run_blocks(trial.size, 0, bounds.descend, grid.displacement_values, grid.gap, approach, step, trial)
    trial[iterate.cells] += iterate.values
    trial[iterate.capped] += grid.cap
    return split_field(control.project(trial, grid.cap), grid.cap)


def _next_step(
    grid: GridWorkspace, control: Control, now: _Evaluation, budget: IterationBudget, *, has_energy: bool
) -> _Step | None:
    """Activate the violating cells, close the gap and project onto the bounds; None without an active cell."""
    active = grid.activate(now.iterate, now.violating, now.approach, with_unit_approach=control.uses_unit_approach)
    if active.iterate.cells.size == 0:
        return None
    if _is_full_contact(grid, control, active, now.goal):
        shifted = bounds.shift_full_contact(active.iterate, active.mean_residual, grid.cap)
        if shifted is not None:
            return _Step(shifted, along_null_space=True)
        # a cell is at a bound already: close the varying part of the gap first
        active = replace(active, gap=active.gap - active.mean_residual, mean_residual=0.0)
    solver = pcg if has_energy else gcr
    trial = solver.close_gap(grid, active, control, now.goal, budget)
    iterate = active.iterate
    clipped = _to_bounds(grid, control, iterate, active.near, trial.copy())
    if (
        clipped.cells.size <= MOSTLY_PLASTIC_RATIO * clipped.capped.size
        and clipped.cells.size < 0.5 * iterate.cells.size
    ):
        # fully plastic: unbounded pressures carry no information
        return _Step(_gradient_step(grid, control, iterate, now.approach, 1 / grid.self_response))
    return _Step(clipped, initial=iterate, near=active.near, trial=trial)


def _to_bounds(
    grid: GridWorkspace, control: Control, iterate: Iterate, near: SparseInverseOnCells, trial: FloatArray
) -> Iterate:
    """Project trial pressures (overwritten) on the active cells onto the bounds, and restore the load.

    The sparse inverse corrects the neighbours of removed tension, or squares of cells keep the load that will be
    clipped; `Control.restore` clips.
    """
    mean_free = grid.operator.mean_free
    if control.keeps_load_of_squares(capped=math.isfinite(grid.cap), mean_free=mean_free):
        shape = grid.operator.grid.shape
        bounds.redistribute_clipped_load(iterate.cells, trial, grid.cap, shape, bounds.SQUARE_SIDE)
    else:
        bounds.eliminate_tension(near, trial)
    return control.restore(grid, iterate, trial)


def _is_full_contact(grid: GridWorkspace, control: Control, active: ActiveCells, goal: float) -> bool:
    """Return True if a doubly periodic gap is closed everywhere at a prescribed approach that is not its mean."""
    return (
        control.leaves_uniform_pressure
        and grid.operator.mean_free
        and active.iterate.cells.size == grid.gap.size
        and not (math.isinf(grid.cap) and active.mean_residual <= goal)
    )
