"""Steady rolling along +x with creepage and spin: where surfaces stick and slip while they pass through a contact.

In a frame that moves with the contact, a particle at x was at x + dx one cell earlier. While it rolls over the length
of a cell, the first surface slides over the second by the slip

    s = (creepage + spin x r) dx + u(x) - u(x + dx),

where u is the displacement under the tractions q and under the pressure. Coulomb's law holds for this slip: s = 0 where
abs(q) < g, and s = -lambda q with lambda >= 0 where abs(q) = g. This is Kalker's steady state (*Three-Dimensional
Elastic Bodies in Rolling Contact*, 1990) with a backward difference over one cell, of first order.

The problem has no energy but is monotone. It is the fixed point q = P(q - t s), where t is the stiffness of a single
cell and P the projection onto the friction discs. Where a force is given, P projects onto the tractions in the discs
with that force; the creepage is its Lagrange multiplier and finite at every step.

1. Project q - t s; the difference of q and its projection is the projection residual.
2. Solve for the Newton step with GMRES; the derivative of P is known in closed form.
3. Halve the step until the projection residual falls. If no step is short enough, the status says "stalled".

Where the bound falls with the slip speed (`friction_laws`), g belongs to the slip of the same tractions, and the
derivative of P has that of g. Several states may then have one creepage: where a cell's bound falls faster than its own
stiffness lets the traction fall, it can stick or slip (a note says so). The solution is the state that Newton's method
reaches from that of the static coefficient.

Cost: one convolution per GMRES iteration. The linear operator is small for waves across the rolling, so the number of
convolutions grows with the number of cells along it.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, gmres

from bem.contact import ContactSolution
from bem.contact.certificate import CERTIFICATE_MARGIN
from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.notes import Note
from bem.notes.contact import FRICTION_NOT_UNIQUE
from bem.tangential.certificate import certify
from bem.tangential.friction_discs import project_to_friction_discs, project_with_force
from bem.tangential.friction_laws import SlipFriction
from bem.tangential.operator import SlipOperator, tangential_operator
from bem.tangential.problem import (
    LocalFriction,
    check_force,
    check_no_slip_speed,
    check_settings,
    check_vectors,
    displacement_scale,
    friction_bound,
    rounding_scale,
)
from bem.tangential.solution import TangentialSolution
from bem.threads import one_blas_thread

_REDUCTION = 0.03
"""Relative residual of GMRES; affects cost only, and little."""

_HALVINGS = 8
"""Limit of the trials of a line search."""
_KRYLOV, _RESTARTS = 60, 4
"""GMRES steps before a restart, and limit of the restarts."""

_FLAT = 1e-12
"""Relative eigenvalue below which the force does not respond to a uniform offset of the tractions."""


@one_blas_thread
def solve_rolling(
    contact: ContactSolution | FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body],
    *,
    friction: float | FloatArray | SlipFriction,
    creepage: Sequence[float] = (0.0, 0.0),
    spin: float = 0.0,
    force: Sequence[float] | None = None,
    speed: float | None = None,
    tolerance: float = 1e-8,
    max_iterations: int = 200,
) -> TangentialSolution:
    """Solve for the tractions of two bodies that roll steadily along +x over each other, with Coulomb's law.

    Parameters
    ----------
    contact, grid, bodies, friction : as for `solve_partial_slip`.
    creepage : (along x, along y), the velocity of the first body against the second over the rolling velocity. The
        traction on the first body is directed against it.
    spin : angular velocity of the first body against the second about the normal (from x to y) over the rolling
        velocity [1/m], about the grid's centre.
    force : (Fx, Fy) [N], total traction on the first body; the creepage is then part of the solution. Not together
        with a creepage, nor with friction that depends on the slip speed, where several creepages have one force.
    speed : rolling velocity [m/s], for friction that depends on the slip speed.
    tolerance : bound on the residual, see `TangentialSolution`.
    max_iterations : limit of the Newton steps.

    Raises
    ------
    InputError : arguments out of range, one message for each.
    InfeasibleError : a force that friction cannot carry.
    """
    operator = tangential_operator(grid, bodies)
    check_settings(0.0, tolerance, max_iterations)
    check_rolling_speed(friction, speed, force)
    pressure, bound = friction_bound(contact, grid, friction)
    falling = None
    if isinstance(friction, SlipFriction) and friction.depends_on_speed:
        assert speed is not None
        falling = FallingBound(LocalFriction.of(friction, contact, pressure), speed / grid.spacing[0])
    creep, total = _check_creepage(grid, bound, creepage, spin, force)
    inside = slice(None)
    if reaches_the_ends(grid, bound):
        inside = slice(1, -1)
        grid = lengthened(grid)
        operator = tangential_operator(grid, bodies)
        pressure, bound = (np.pad(field, ((1, 1), (0, 0))) for field in (pressure, bound))
    under_pressure = operator.displacement_under_pressure(pressure)
    imposed_slip = rigid_slip(grid, creep, spin) + slip_over_cell(grid, under_pressure)
    problem = RollingProblem(operator, bound, imposed_slip, total)
    result = _solve(problem, CERTIFICATE_MARGIN * tolerance, max_iterations)
    if falling is not None:
        problem = replace(problem, falling=falling)
        result = _solve(problem, CERTIFICATE_MARGIN * tolerance, max_iterations, result)
    failed = Status.MAX_ITERATIONS if result.iterations >= max_iterations else Status.STALLED
    solution = _solution(problem, result, under_pressure, creep * grid.spacing[0], tolerance, failed)
    fields = {name: getattr(solution, name)[:, inside] for name in ("traction", "displacement", "slip")}
    return replace(solution, **fields)


@one_blas_thread
def solve_rolling_problem(
    problem: RollingProblem,
    displacement: FloatArray,
    creepage: FloatArray,
    *,
    tolerance: float,
    max_iterations: int = 200,
    start: FloatArray | None = None,
) -> TangentialSolution:
    """Solve a rolling problem under prescribed creepages, on a surface of any operator.

    Parameters
    ----------
    problem : with a bound that does not fall, and without a given force.
    displacement : of the first surface less the second under the pressure, (2, nx, ny) [m].
    creepage : (2,), for the record; it is part of the problem's imposed slip.
    tolerance, max_iterations : as for `solve_rolling`.
    start : tractions to start from (2, nx, ny) [Pa].
    """
    begin = None if start is None else _RollingResult(start[:, problem.bound > 0], np.zeros(2), 0)
    result = _solve(problem, CERTIFICATE_MARGIN * tolerance, max_iterations, begin)
    failed = Status.MAX_ITERATIONS if result.iterations >= max_iterations else Status.STALLED
    return _solution(problem, result, displacement, creepage * problem.operator.grid.spacing[0], tolerance, failed)


def _check_creepage(
    grid: Grid, bound: FloatArray, creepage: Sequence[float], spin: float, force: Sequence[float] | None
) -> tuple[FloatArray, FloatArray | None]:
    """Return the creepage, and the force over the area of a cell if it is given."""
    messages: list[str] = []
    creep, total = check_vectors({"creepage": creepage, "force": force}, messages)
    if not math.isfinite(spin):
        messages.append(f"spin: {spin!r} must be finite [1/m]")
    if not messages and total is not None and np.any(creepage):
        messages.append("force, creepage: only one of them can be given")
    if messages:
        raise InputError(messages)
    assert creep is not None
    if total is None:
        return creep, None
    check_force(total, bound, grid)
    return creep, total / grid.cell_area


def check_rolling_speed(
    friction: float | FloatArray | SlipFriction, speed: float | None, force: Sequence[float] | None
) -> None:
    """Refuse a speed that is not positive, and friction that depends on the slip speed without a speed or with a force.

    Raises
    ------
    InputError : one message for each.
    """
    if speed is not None and not (math.isfinite(speed) and speed > 0):
        raise InputError(f"speed: {speed!r} must be positive and finite [m/s]")
    if not (isinstance(friction, SlipFriction) and friction.depends_on_speed):
        return
    if speed is None:
        raise InputError(f"speed: the friction law {friction.name!r} needs the rolling speed [m/s]")
    if force is not None:
        check_no_slip_speed(friction, "rolling under a given force (several creepages may have it)")


def reaches_the_ends(grid: Grid, bound: FloatArray) -> bool:
    """Return True if cells with friction lie at a free end along the rolling: u(x + dx) must exist ahead of each."""
    return not grid.periodic[0] and bool(bound[0].any() or bound[-1].any())


def lengthened(grid: Grid) -> Grid:
    """Return the grid with one cell more at each end along the rolling."""
    return Grid((grid.shape[0] + 2, grid.shape[1]), grid.spacing, periodic=grid.periodic)


def rigid_slip(grid: Grid, creepage: FloatArray, spin: float) -> FloatArray:
    """Return the slip over a cell by a creepage (2,) and a spin [1/m] about the grid's centre, (2, nx, ny) [m]."""
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    slip = np.empty((2, *grid.shape))
    slip[0] = (creepage[0] - spin * y[None, :]) * grid.spacing[0]
    slip[1] = (creepage[1] + spin * x[:, None]) * grid.spacing[0]
    return slip


def slip_over_cell(grid: Grid, displacement: FloatArray) -> FloatArray:
    """Return u(x) - u(x + dx) on the grid, (2, nx, ny) [m]; zero at a free end, which no contact reaches."""
    ahead = np.roll(displacement, -1, axis=1)
    if not grid.periodic[0]:
        ahead[:, -1] = displacement[:, -1]
    return displacement - ahead


@dataclass(frozen=True)
class FallingBound:
    """Bound that falls with the slip speed, on the n cells in contact.

    rate : slip speed over the slip over a cell, the rolling velocity over the length of a cell [1/s].
    """

    friction: LocalFriction
    rate: float

    def bound(self, slip: FloatArray) -> FloatArray:
        """Return the bound (n,) [Pa] at a slip over a cell (2, n) [m]."""
        return self.friction.bound(self.rate * np.hypot(*slip))

    def slope(self, slip: FloatArray) -> FloatArray:
        """Return the derivative of the bound with respect to the size of the slip over a cell, (n,) [Pa/m]."""
        return self.rate * self.friction.slope(self.rate * np.hypot(*slip))


@dataclass(frozen=True)
class RollingProblem:
    """Steady rolling on one grid.

    bound : (nx, ny), friction x pressure [Pa]; that without slip if it falls with the slip speed.
    imposed_slip : (2, nx, ny), slip over a cell without tractions: by creepage, spin and pressure [m].
    traction_sum : (2,), sum of the tractions over the cells, the force over the area of a cell [Pa]; None if the
        creepage is part of `imposed_slip`.
    falling : bound that falls with the slip speed; None if it does not.
    """

    operator: SlipOperator
    bound: FloatArray
    imposed_slip: FloatArray
    traction_sum: FloatArray | None
    falling: FallingBound | None = None


@dataclass(frozen=True)
class _RollingResult:
    """Tractions (2, n) [Pa] on the cells in contact, and the slip over a cell by the creepage of the force (2,) [m]."""

    traction: FloatArray
    creep: FloatArray
    iterations: int


@dataclass(frozen=True)
class _State:
    """Tractions and their projection, on the n cells in contact.

    traction : q, (2, n) [Pa].
    slip : s, (2, n) [m], without the creepage of a given force.
    trial : (2, n) [Pa], q - t s plus the offset.
    offset : (2,) [Pa], minus t x the slip over a cell by the creepage of the force.
    projection_residual : (2, n) [Pa], q less the projection of `trial`.
    bound : (n,) [Pa], at the slip.
    """

    traction: FloatArray
    slip: FloatArray
    trial: FloatArray
    offset: FloatArray
    projection_residual: FloatArray
    bound: FloatArray


@dataclass(frozen=True)
class _ReducedRolling:
    """The problem on the n cells in contact.

    bound : (n,) [Pa]. imposed_slip : (2, n) [m]. stiffness : t [Pa/m], of a single cell.
    """

    problem: RollingProblem
    cells: NDArray[np.bool_]
    bound: FloatArray
    imposed_slip: FloatArray
    stiffness: float

    def elastic_slip(self, traction: FloatArray) -> FloatArray:
        """Return the slip over a cell under tractions, (2, n) [m]."""
        grid = self.problem.operator.grid
        full = np.zeros((2, *grid.shape))
        full[:, self.cells] = traction
        return slip_over_cell(grid, self.problem.operator.apply(full))[:, self.cells]

    def project(self, traction: FloatArray, slip: FloatArray) -> _State:
        """Project q - t s onto the friction discs, with the total force if it is given, and return the state."""
        trial = traction - self.stiffness * slip
        allowed = np.empty_like(trial)
        offset = np.zeros(2)
        bound = self.bound if self.problem.falling is None else self.problem.falling.bound(slip)
        if self.problem.traction_sum is None:
            project_to_friction_discs(trial, bound, allowed)
        else:
            offset = project_with_force(trial, bound, self.problem.traction_sum, allowed)
        return _State(traction, slip, trial + offset[:, None], offset, traction - allowed, bound)

    def jacobian(self, state: _State) -> Callable[[FloatArray], FloatArray]:
        """Return the map from a change of the tractions (2 n,) to the change of the projection residual (2 n,)."""
        length = np.hypot(*state.trial)
        slips = length > state.bound
        normal = np.where(slips, state.trial / np.where(slips, length, 1.0), 0.0)
        ratio = np.where(slips, state.bound / np.where(slips, length, 1.0), 1.0)
        fall: FloatArray | None = None
        if self.problem.falling is not None:  # derivative of the bound with respect to the slip, (2, n) [Pa/m]
            size = np.hypot(*state.slip)
            fall = self.problem.falling.slope(state.slip) * state.slip / np.where(size > 0, size, 1.0)
        inverse: FloatArray | None = None
        if self.problem.traction_sum is not None:  # inverse of the derivative of the force by a uniform offset
            mixed = -float((ratio * normal[0] * normal[1]).sum())
            xx, yy = (float((ratio * (1 - part**2)).sum()) for part in normal)
            inverse = np.asarray(np.linalg.pinv([[xx, mixed], [mixed, yy]], rcond=_FLAT, hermitian=True))

        def projected(values: FloatArray) -> FloatArray:
            return ratio * (values - normal * (normal * values).sum(0))

        def apply(change: FloatArray) -> FloatArray:
            traction = np.asarray(change).reshape(2, -1)
            slip = self.elastic_slip(traction)
            allowed = projected(traction - self.stiffness * slip)
            if fall is not None:
                allowed += normal * (fall * slip).sum(0)
            if inverse is not None:
                offset = inverse @ allowed.sum(1)
                allowed -= projected(np.broadcast_to(offset[:, None], allowed.shape))
            return (traction - allowed).ravel()

        return apply

    def converged(self, state: _State, tolerance: float) -> bool:
        """Return True if the projection residual, and the error of the force inside the discs, meet the tolerance."""
        least = rounding_scale(self.problem.imposed_slip, state.traction / self.stiffness)
        scale = displacement_scale(state.slip, self.imposed_slip, state.offset / self.stiffness, least=least)
        if float(np.abs(state.projection_residual).max()) > tolerance * self.stiffness * scale:
            return False
        if self.problem.traction_sum is None:
            return True
        inside = np.empty_like(state.traction)
        project_to_friction_discs(state.traction, state.bound, inside)
        return float(np.abs(inside.sum(1) - self.problem.traction_sum).max()) <= tolerance * float(self.bound.sum())


def _solve(
    problem: RollingProblem, tolerance: float, limit: int, start: _RollingResult | None = None
) -> _RollingResult:
    """Iterate from `start`, or from tractions of zero; under a force from the tractions nearest to full sliding."""
    cells = problem.bound > 0
    if not cells.any():
        return _RollingResult(np.zeros((2, 0)), np.zeros(2), 0)
    imposed_slip = problem.imposed_slip[:, cells]
    reduced = _ReducedRolling(problem, cells, problem.bound[cells], imposed_slip, problem.operator.stiffness)
    state = reduced.project(np.zeros_like(reduced.imposed_slip), reduced.imposed_slip)
    if problem.traction_sum is not None and reduced.imposed_slip.any():
        traction = -state.projection_residual
        state = reduced.project(traction, reduced.imposed_slip + reduced.elastic_slip(traction))
    if start is not None:
        state = reduced.project(start.traction, imposed_slip + reduced.elastic_slip(start.traction))
    iterations = 0
    while iterations < limit and not reduced.converged(state, tolerance):
        iterations += 1
        next_state = _backtrack(reduced, state, _newton_step(reduced, state))
        if next_state is None:
            break
        state = next_state
    return _RollingResult(state.traction, 0.0 - state.offset / reduced.stiffness, iterations)


def _newton_step(reduced: _ReducedRolling, state: _State) -> FloatArray:
    """Return the Newton step (2, n) [Pa]."""
    size = state.projection_residual.size
    matrix = LinearOperator((size, size), matvec=reduced.jacobian(state), dtype=np.float64)
    step, _ = gmres(matrix, -state.projection_residual.ravel(), rtol=_REDUCTION, restart=_KRYLOV, maxiter=_RESTARTS)
    return np.asarray(step, dtype=np.float64).reshape(2, -1)


def _backtrack(reduced: _ReducedRolling, state: _State, step: FloatArray) -> _State | None:
    """Return the state after the step, halved until the projection residual falls; None if it does not."""
    slip = reduced.elastic_slip(step)
    before = float(np.linalg.norm(state.projection_residual))
    length = 1.0
    for _ in range(_HALVINGS):
        after = reduced.project(state.traction + length * step, state.slip + length * slip)
        if float(np.linalg.norm(after.projection_residual)) <= (1 - 0.1 * length) * before:
            return after
        length *= 0.5
    return None


def _solution(
    problem: RollingProblem,
    result: _RollingResult,
    under_pressure: FloatArray,
    creep: FloatArray,
    tolerance: float,
    failed: Status,
) -> TangentialSolution:
    """Project the tractions onto the discs, certify them and return the solution.

    creep : (2,), slip over a cell by the prescribed creepage [m]. failed : status if the tolerance is not met.
    """
    operator, grid, bound, imposed_slip = problem.operator, problem.operator.grid, problem.bound, problem.imposed_slip
    cells, area = bound > 0, grid.cell_area
    traction, allowed = np.zeros((2, *grid.shape)), np.empty_like(result.traction)
    project_to_friction_discs(result.traction, bound[cells], allowed)
    traction[:, cells] = allowed
    elastic = operator.apply(traction)
    notes: tuple[Note, ...] = ()
    if problem.falling is not None and cells.any():  # the bound is that of the slip of the returned tractions
        moved = (imposed_slip + slip_over_cell(grid, elastic))[:, cells]
        bound = np.zeros_like(bound)
        bound[cells] = problem.falling.bound(moved)
        steepest = -float(problem.falling.slope(moved).min()) / operator.stiffness
        notes = (FRICTION_NOT_UNIQUE(times=steepest),) if steepest > 1 else ()
    if problem.traction_sum is not None:
        creep = result.creep
        imposed_slip = imposed_slip + creep[:, None, None]
    slip = imposed_slip + slip_over_cell(grid, elastic)
    least = rounding_scale(problem.imposed_slip, traction / operator.stiffness)
    scale = displacement_scale(slip[:, cells], problem.imposed_slip[:, cells], creep, least=least)
    certificate = certify(operator, bound, traction, -slip, scale=scale, traction_sum=problem.traction_sum)
    stuck, in_contact = (float(np.count_nonzero(where)) * area for where in (certificate.sticks, cells))
    return TangentialSolution(
        traction=traction,
        force=traction.sum((1, 2)) * area,
        shift=np.zeros(2),
        rotation=0.0,
        creepage=creep / grid.spacing[0],
        displacement=elastic + under_pressure,
        slip=certificate.slip,
        stick_area=stuck,
        slip_area=in_contact - stuck,
        counted_stick_area=stuck,
        dissipated_energy=max(-float((_mean_traction(grid, traction) * slip).sum()) * area, 0.0),
        cell_energy=-float((traction * certificate.slip).sum()) * area,
        residual=certificate.residual,
        convolutions=operator.count.weighted,
        iterations=result.iterations,
        status=Status.CONVERGED if certificate.residual <= tolerance else failed,
        notes=notes,
    )


def _mean_traction(grid: Grid, traction: FloatArray) -> FloatArray:
    """Return the mean traction (2, nx, ny) [Pa] on a particle on its way from x + dx to x.

    Its product with u(x) - u(x + dx), u = A q, sums to zero for every q, because A is symmetric and the same
    everywhere: tractions return the energy that they store. The sum of its products with the slip is therefore the work
    of creepage, spin and pressure. With the traction at x alone, after the slip, the error is of first order in the
    cell.
    """
    ahead = np.roll(traction, -1, axis=1)
    if not grid.periodic[0]:
        ahead[:, -1] = 0.0
    return 0.5 * (traction + ahead)
