"""Workspace of one grid: operator, gap, buffers and preconditioner; tolerances, limits and results.

Step 8 of `bem.contact` (`GridWorkspace.activate`), and the state that steps 6 to 10 share. Pressures and gaps are
one-dimensional and in the solver's units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact import reductions
from bem.contact.bounds import Iterate, merge
from bem.contact.cell_states import CAPPED, ELASTIC
from bem.contact.coarse_correction import CoarseCorrection, Preconditioner, coarse_correction
from bem.contact.reductions import NO_PRESSURE, ContactSums
from bem.contact.sparse_inverse import REACH, SparseInverse, SparseInverseOnCells, SparseRows, connect, sparse_inverse
from bem.convolution import DisplacementOperator

FloatArray = NDArray[np.float64]
Indices = NDArray[np.int64]

InitialPressure = FloatArray | Iterate | None
"""A feasible field, an iterate, or None for the first pressure of the control: uniform under a load, else none."""

_RESOLUTION = 4e-16
"""Violations below this fraction of the lengths they are differences of are round-off."""

_FLAT = 1e-6
"""A gap with an rms value below this fraction of the displacement is flat: its residual is relative to the
displacement."""

_FLAT_RESOLUTION = 1e-12
"""Largest violation aimed at for a flat gap, relative to the displacement. The certificate allows the tolerance times
the displacement there, which may be more than the whole gap; this one resolves the gap as far as the transforms do."""


def is_flat(rms_gap: float, displacement: float) -> bool:
    """Return True if a gap is flat compared with a displacement [m]."""
    return rms_gap <= _FLAT * displacement


@dataclass
class IterationBudget:
    """CG iterations on all grids so far, and their limit."""

    limit: int
    iterations: int = 0

    @property
    def left(self) -> int:
        """Return the iterations that remain."""
        return self.limit - self.iterations

    def part(self, fraction: float) -> IterationBudget:
        """Return a budget that ends after a fraction of the iterations that remain."""
        return IterationBudget(self.iterations + int(fraction * max(self.left, 0)), self.iterations)


@dataclass(frozen=True)
class Tolerance:
    """Largest violation allowed, from largest displacement u (`ContactSums`), approach d and first violation v:

    max(min(absolute, relative u, max(coarse_reduction v, coarse_floor)), _RESOLUTION (|d| + u)).

    absolute : bound on the violation.
    relative : bound relative to the displacement. Where absolute <= _FLAT relative u the gap is flat, and the minimum
        is min(relative, _FLAT_RESOLUTION) u.
    coarse_reduction : on coarse grids, bound relative to the first violation; infinite on the finest grid.
    coarse_floor : lower limit of the bound by `coarse_reduction`.
    """

    absolute: float
    relative: float
    coarse_reduction: float = math.inf
    coarse_floor: float = 0.0

    @staticmethod
    def is_near_round_off(violation: float, displacement: float) -> bool:
        """Return True if a violation is at most `_FLAT_RESOLUTION` of the displacement, on flat gaps and others."""
        return violation <= _FLAT_RESOLUTION * displacement

    def bound(self, approach: float, displacement: float, first: float) -> float:
        """Return the bound at an approach, largest displacement and first violation; never below round-off."""
        goal = min(self.absolute, self.relative * displacement)
        if math.isfinite(self.coarse_reduction):
            goal = min(goal, max(self.coarse_reduction * first, self.coarse_floor))
        if is_flat(self.absolute, self.relative * displacement):
            goal = min(self.relative, _FLAT_RESOLUTION) * displacement
        return max(goal, _RESOLUTION * (abs(approach) + displacement))


@dataclass(frozen=True)
class GridResult:
    """Result on one grid: scaled pressure and displacement (one-dimensional), approach, and largest violation.

    exact_displacement : True if the displacement is the operator applied to this pressure, not a combination of others.
    round_off : not converged, and the remaining violation is round-off of the transforms; fallbacks would not help.
    least_mean_gap : lower bound on every mean gap, where a smaller one was prescribed.
    least_found : least mean gap found, where a smaller one was neither found nor excluded.
    """

    pressure: FloatArray
    displacement: FloatArray
    approach: float
    violation: float
    converged: bool = False
    exact_displacement: bool = True
    round_off: bool = False
    least_mean_gap: float | None = None
    least_found: float | None = None


def mean_opening(gap: FloatArray, result: GridResult) -> float:
    """Return the mean positive gap of a contact; round-off in contact does not count as volume."""
    opening = gap + result.displacement
    opening -= result.approach
    opening[result.pressure > 0] = 0.0
    return float(np.maximum(opening, 0.0).mean())


@dataclass(frozen=True)
class SolverParameters:
    """Numbers that balance outer iterations against CG iterations.

    CG has residual r (gap) and pressure p. It ends at the first of the three conditions below, at the limit of
    iterations, where the curvature along a direction is not positive, or after a last step of extrapolated length that
    is expected to meet one of the conditions (`pcg`).

    relative_residual : ends CG at |r|_2 <= relative_residual |r_0|_2.
    tolerance_fraction : ends CG at max|r| <= tolerance_fraction tolerance.
    clip_residual_ratio : ends CG at max|r| <= clip_residual_ratio K00 max(-p, p - cap), where K00 is the response of a
        cell to its own pressure: clipping would bring back a residual of the same size.
    clip_allowed_below : the condition on clipping applies only at |r|_2 <= clip_allowed_below |r_0|_2; `pcg` has no
        such restriction before an extrapolated step.
    iterations_per_round : limit of CG iterations in an outer iteration.
    rounds : limit of outer iterations.
    patience : outer iterations without a fall of the violation by a tenth before the energy guard is set.
    guarded : True if the energy guard is set from the first outer iteration.
    stall_limit : outer iterations without a fall of the violation by three tenths, or in a guarded run of the energy,
        before the solver gives up.
    """

    relative_residual: float = 1e-4
    clip_allowed_below: float = 0.3
    clip_residual_ratio: float = 0.3
    iterations_per_round: int = 80
    tolerance_fraction: float = 0.8
    rounds: int = 100
    patience: int = 8
    guarded: bool = False
    stall_limit: int = 60


@dataclass(slots=True)
class Extrapolation:
    """Final CG step of extrapolated length, without a convolution; disabled once it fails to halve the violation.

    It stays disabled as long as the workspace exists: for the rest of a solution on a grid; a rerun has a new one.

    step_length : of the last CG step, kept between outer iterations; the length of the next extrapolated step. One at
        the start.
    trusted : False once an extrapolated step has failed. taken : True if the last CG step was extrapolated.
    """

    step_length: float = 1.0
    trusted: bool = True
    taken: bool = False
    previous_violation: float = math.inf

    def judge(self, violation: float) -> None:
        """Compare the violation with that of the previous outer iteration."""
        if self.taken and violation > 0.5 * self.previous_violation:
            self.trusted = False
        self.taken, self.previous_violation = False, violation


class UnitApproachPressure(NamedTuple):
    """Pressure of a unit approach on the active cells, K^-1 1 approximated by the preconditioner, and its sum."""

    cells: Indices
    pressure: FloatArray
    total: float


_UNKNOWN_UNIT_APPROACH = UnitApproachPressure(np.empty(0, np.int64), np.empty(0), 0.0)


@dataclass(frozen=True)
class ActiveCells:
    """The active cells of an outer iteration, those that violated their state included.

    iterate : their pressures. gap : (n,), gap + displacement - approach (overwritten by solvers). mean_residual : its
        mean, unrelated to a prescribed mean gap.
    near : the sparse inverse. unit_approach : pressure of a unit approach; total 0 where unknown.
    """

    iterate: Iterate
    gap: FloatArray
    mean_residual: float
    near: SparseInverseOnCells
    unit_approach: UnitApproachPressure


def _single_field(field: FloatArray) -> NDArray[np.float32]:
    """Return a single-precision field in the memory of a double-precision one."""
    return field.reshape(-1).view(np.float32).reshape(2, *field.shape)[0]


class GridWorkspace:
    """Operator, gap, buffers and preconditioner of one grid, for one call of `solve_active_set`."""

    def __init__(
        self, operator: DisplacementOperator, gap: FloatArray, cap: float, parameters: SolverParameters
    ) -> None:
        self.operator = operator
        self.double = operator.scaled()
        self.single = operator.scaled(np.float32)
        self.gap = gap
        self.cap = cap
        self.parameters = parameters
        self.state = np.zeros(gap.size, np.uint8)
        self.displacement = self.double.transform.empty_field()
        self.previous_displacement = self.double.transform.empty_field()
        # one-dimensional views
        self.displacement_values: NDArray[Any] = self.displacement.reshape(-1)
        self.previous_values: NDArray[Any] = self.previous_displacement.reshape(-1)
        # single-precision results share memory with the previous displacement, which CG does not need
        self.single_field, self._other_field = (
            _single_field(self.previous_displacement),
            _single_field(self.displacement),
        )
        self._swapped = False
        self.self_response = float(operator.near_field(0)[0, 0])
        self.extrapolation = Extrapolation()
        self.unit_approach = _UNKNOWN_UNIT_APPROACH
        self.sparse: SparseInverse | None = None
        self.coarse: CoarseCorrection | None = None

    @property
    def largest_eigenvalue(self) -> float:
        """Return a bound on the eigenvalues of the symmetric part of the operator."""
        real = self.double.multiplier.real
        assert real is not None
        return float(np.abs(real).max())

    def mean_below_cap(self, field: NDArray[Any], capped: Indices) -> float:
        """Return the mean of a field (one-dimensional) over the cells below the cap."""
        total = float(field.sum(dtype=np.float64) - field[capped].sum(dtype=np.float64))
        return total / max(1, field.size - capped.size)

    def mean_displacement_per_force(self, iterate: Iterate) -> float:
        """Return the mean displacement below the cap per unit sum of pressures, for the displacement in the buffer."""
        force = float(iterate.values.sum())
        if iterate.capped.size:
            force += self.cap * iterate.capped.size
        return self.mean_below_cap(self.displacement_values, iterate.capped) / force if force > 0 else 0.0

    def displace(self, iterate: Iterate) -> None:
        """Write the displacement of a pressure to the buffer."""
        if iterate.capped.size == 0:
            self.double.apply_to_cells(iterate.cells, iterate.values, self.displacement)
            return
        reductions.scatter(self.displacement_values, iterate.cells, iterate.values, iterate.capped, self.cap)
        self.double.apply(self.displacement, self.displacement)

    def swap_displacements(self) -> None:
        """Make the displacement the previous one, once in an outer iteration."""
        if self._swapped:
            return
        self._swapped = True
        self.displacement, self.previous_displacement = self.previous_displacement, self.displacement
        self.displacement_values, self.previous_values = self.previous_values, self.displacement_values
        self.single_field, self._other_field = self._other_field, self.single_field

    def begin_round(self, iterate: Iterate, *, keep: bool) -> None:
        """Write the displacement of a pressure to the buffer; `keep` the last displacement as the previous one."""
        if keep:
            self.swap_displacements()
        self._swapped = False
        self.displace(iterate)

    def contact_sums(self, iterate: Iterate, other: Iterate | None = None) -> ContactSums:
        """Return the reductions of a pressure with its displacement, and the work of another pressure there."""
        other_pressure = NO_PRESSURE if other is None else (other.cells, other.values, other.capped)
        pressure = iterate.cells, iterate.values, iterate.capped
        return reductions.contact_sums(self.displacement_values, self.gap, pressure, self.cap, other_pressure)

    def separations(self, iterate: Iterate) -> tuple[float, float]:
        """Return the largest gap + displacement of cells with pressure, and the smallest of cells below the cap."""
        reductions.mark_states(self.state, iterate.cells, iterate.capped)
        return reductions.separations(self.displacement_values, self.gap, self.state)

    def violations(self, iterate: Iterate, approach: float) -> tuple[NDArray[np.int32], float]:
        """Write all states; return the open and capped cells that violate theirs, and their largest violation."""
        pressure = iterate.cells, iterate.values, iterate.capped
        return reductions.find_violations(self.displacement_values, self.gap, self.state, pressure, approach)

    def sparse_inverse(self) -> SparseInverse:
        """Return the sparse inverse of this grid; the coarse correction is prepared with it."""
        if self.sparse is None:
            grid = self.operator.grid
            self.sparse = sparse_inverse(grid.shape, grid.periodic, self.operator.near_field(2 * REACH))
            self.coarse = coarse_correction(self.operator, self.sparse.near_response)
        return self.sparse

    def activate(
        self, iterate: Iterate, violating: NDArray[np.int32], approach: float, *, with_unit_approach: bool
    ) -> ActiveCells:
        """Add the violating cells to those between the bounds, and connect the rows of the sparse inverse.

        The pressure of a unit approach is carried over from the previous outer iteration, if `with_unit_approach`.
        """
        sparse, capped = self.sparse_inverse(), iterate.capped
        known = sparse.patterns
        merged, columns, pattern, unsolved, unit_approach, total = _activate(
            (iterate.cells, iterate.values),
            violating,
            (self.state, self.cap),
            (self.displacement_values, self.gap, approach),
            (*sparse.shape, *sparse.periodic),
            (known.offsets, known.solved),
            (self.unit_approach.cells, self.unit_approach.pressure, self.unit_approach.total),
            with_unit_approach,
        )
        known.solve(pattern, unsolved=unsolved)
        cells, values, gap, mean_residual = merged
        near = SparseInverseOnCells(SparseRows(columns, pattern, known.table))
        if capped.size:
            self.state[violating] = ELASTIC
            capped = capped[self.state[capped] == CAPPED]
        return ActiveCells(
            Iterate(cells, values, capped), gap, mean_residual, near, UnitApproachPressure(cells, unit_approach, total)
        )

    def find_unit_approach(self, active: ActiveCells) -> UnitApproachPressure:
        """Return the pressure of a unit approach on the active cells; one preconditioning where it is unknown."""
        unit_approach = active.unit_approach
        if not unit_approach.total > 0:
            total = self.preconditioner_on(active)(np.ones(unit_approach.pressure.size), unit_approach.pressure)
            if not total > 0:
                unit_approach.pressure[:] = 1.0
                total = float(unit_approach.pressure.size)
            unit_approach = UnitApproachPressure(unit_approach.cells, unit_approach.pressure, total)
        self.unit_approach = unit_approach
        return unit_approach

    def preconditioner_on(self, active: ActiveCells) -> Preconditioner:
        """Return the two-level approximate inverse on the active cells."""
        cells, near = active.iterate.cells, active.near
        coarse = None if self.coarse is None else self.coarse.on(cells, near.row_sums())
        return Preconditioner(near, coarse, np.empty(cells.size))

    def release(self, iterate: Iterate) -> tuple[FloatArray, FloatArray]:
        """Return the pressure as a field and the displacement; both own the buffers of the workspace."""
        pressure = self.previous_values
        reductions.scatter(pressure, iterate.cells, iterate.values, iterate.capped, self.cap)
        return pressure, self.displacement_values


@compiled
def _activate(old, violating, states, surface, grid, known, unit_approach, with_unit_approach):
    """Merge the cells, connect the sparse inverse, carry over the pressure of a unit approach; see `activate`."""
    merged = merge(old, violating, states[0], states[1], surface)
    cells = merged[0]
    columns, pattern, unsolved = connect(cells, grid, known[0], known[1])
    carried, total = np.empty(cells.size if with_unit_approach else 0), 0.0
    if with_unit_approach:
        total = carry_to_cells(unit_approach[0], unit_approach[1], unit_approach[2], cells, carried)
    return merged, columns, pattern, unsolved, carried, total


@compiled
def carry_to_cells(previous_cells, values, total, cells, out):
    """Carry values (their sum is `total`) from the cells `previous_cells` to `cells`; both ascend. Returns the new sum.

    New cells get the mean of the carried values. Returns zero where at most half of the cells are known, or where the
    carried values sum to at most half of their share of the total.
    """
    a = 0
    known = 0
    sum_known = 0.0
    for k in range(cells.size):
        while a < previous_cells.size and previous_cells[a] < cells[k]:
            a += 1
        if a < previous_cells.size and previous_cells[a] == cells[k]:
            out[k] = values[a]
            known += 1
            sum_known += values[a]
        else:
            out[k] = np.nan
    if not (2 * known > cells.size and 2 * sum_known * values.size > total * known > 0):
        return 0.0
    mean = sum_known / known
    carried = 0.0
    for k in range(cells.size):
        if np.isnan(out[k]):
            out[k] = mean
        carried += out[k]
    return carried
