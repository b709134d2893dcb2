"""Steady rolling along +x with creepage and spin: where the surfaces stick and slip while they pass through a contact.

In a frame that moves with the contact, what is at x has come from x + dx, one cell ahead. Over a cell's length of
rolling the first surface slides over the second by

    s = (creepage + spin x r) dx + u(x) - u(x + dx),

u = A q + what the pressure moves. Coulomb's law holds for s: none where |q| < g, s = -lambda q where |q| = g. That is
Kalker's steady state (CONTACT; *Three-Dimensional Elastic Bodies in Rolling Contact*, 1990) with the derivative along x
taken over one cell, of first order. It has no energy, but is monotone: Newton on q = P(q - t s), where P projects onto
the friction discs and, where a force is given, onto the tractions in them that have it (the creepage is the multiplier,
finite at every step), with GMRES for the linear systems. Their matrix is of order zero in the wavenumber but small for
waves across the rolling, so that convolutions grow with the cells along it: 2 to 3 for each were counted from 32 to
256. Where a step does not help it is halved; where that does not help either, the status says "stalled".
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, gmres

from bem.contact import ContactSolution
from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.tangential.discs import nearest, nearest_with_force
from bem.tangential.operator import TangentialOperator
from bem.tangential.rounds import least_scale, reach
from bem.tangential.solution import TangentialSolution
from bem.tangential.solve import check_force, check_numbers, checked_bound, tangential_operator
from bem.threads import one_blas_thread

_TIGHTER = 0.9
_REDUCTION = 0.03
"""What a linear system is solved to: 0.1 to 0.01 all take about as many convolutions in all (counted)."""

_HALVINGS = 8
_KRYLOV = 60

_FLAT = 1e-12
"""Share of the largest, below which the force's response to an offset of all tractions counts as none."""


@one_blas_thread
def solve_rolling(
    contact: ContactSolution | FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body],
    *,
    friction: float | FloatArray,
    creepage: Sequence[float] = (0.0, 0.0),
    spin: float = 0.0,
    force: Sequence[float] | None = None,
    tolerance: float = 1e-8,
    max_iterations: int = 200,
) -> TangentialSolution:
    """Tractions of two bodies that roll along +x over each other, steadily, with Coulomb's law.

    Parameters
    ----------
    contact, grid, bodies, friction : as for `solve_partial_slip`.
    creepage : (along x, along y), the velocity of the first body against the second over the rolling velocity. The
        traction on the first body is against it.
    spin : angular velocity of the first body against the second about the normal (from x to y) over the rolling
        velocity [1/m], about the grid's centre.
    force : (Fx, Fy) [N], total traction on the first body; the creepage is then found. Not together with a
        creepage.
    tolerance : bound on the residual, see `TangentialSolution`.
    max_iterations : limit on Newton steps.

    Raises
    ------
    InputError : arguments out of range, one message for each.
    InfeasibleError : a force that friction cannot carry.
    """
    operator = tangential_operator(grid, bodies)
    check_numbers(0.0, tolerance, max_iterations)
    pressure, bound = checked_bound(contact, grid, friction)
    creep, total = _checked(grid, bound, creepage, spin, force)
    if not grid.periodic[0] and (bound[0].any() or bound[-1].any()):  # so that u(x + dx) exists ahead of every cell
        inside = slice(1, -1)
        grid = Grid((grid.shape[0] + 2, grid.shape[1]), grid.spacing, periodic=grid.periodic)
        operator = tangential_operator(grid, bodies)
        pressure, bound = (np.pad(field, ((1, 1), (0, 0))) for field in (pressure, bound))
    else:
        inside = slice(None)
    pushed = operator.under_pressure(pressure) if operator.coupled else np.zeros((2, *grid.shape))
    side = grid.spacing[0]
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    rigid = np.empty((2, *grid.shape))
    rigid[0] = (creep[0] - spin * y[None, :]) * side
    rigid[1] = (creep[1] + spin * x[:, None]) * side
    rolling = Rolling(operator, bound, rigid + passing(grid, pushed), total)
    found = roll(rolling, _TIGHTER * tolerance, max_iterations)
    failed = Status.MAX_ITERATIONS if found.iterations >= max_iterations else Status.STALLED
    solution = _certified(rolling, found, pushed, creep * side, tolerance, failed)
    fields = {name: getattr(solution, name)[:, inside] for name in ("traction", "displacement", "slip")}
    return replace(solution, **fields)


def _checked(
    grid: Grid, bound: FloatArray, creepage: Sequence[float], spin: float, force: Sequence[float] | None
) -> tuple[FloatArray, FloatArray | None]:
    """Creepage, and force over the area of a cell."""
    creep = np.asarray(creepage, dtype=np.float64)
    given = None if force is None else np.asarray(force, dtype=np.float64)
    messages = [
        f"{name}: {value!r} must be two finite numbers, along x and y"
        for name, value, vector in (("creepage", creepage, creep), ("force", force, given))
        if vector is not None and not (vector.shape == (2,) and np.isfinite(vector).all())
    ]
    if not math.isfinite(spin):
        messages.append(f"spin: {spin!r} must be finite [1/m]")
    if not messages and given is not None and creep.any():
        messages.append("force, creepage: only one of them can be given")
    if messages:
        raise InputError(messages)
    if given is None:
        return creep, None
    check_force(given, bound, grid)
    return creep, given / grid.cell_area


def passing(grid: Grid, displacement: FloatArray) -> FloatArray:
    """u(x) - u(x + dx) on the grid (2, nx, ny); 0 at a free end, which no contact reaches."""
    ahead = np.roll(displacement, -1, axis=1)
    if not grid.periodic[0]:
        ahead[:, -1] = displacement[:, -1]
    return displacement - ahead


def _mean_along(grid: Grid, traction: FloatArray) -> FloatArray:
    """Mean traction (2, nx, ny) [Pa] on a particle between x + dx and x.

    Its product with u(x) - u(x + dx), u = A q, sums to zero for every q, as A is symmetric and the same everywhere:
    what tractions store they give back. The sum of its products with the slip therefore is the work of creepage, spin
    and pressure. Tractions at x alone, after the step, miss it by the first order of the cell.
    """
    ahead = np.roll(traction, -1, axis=1)
    if not grid.periodic[0]:
        ahead[:, -1] = 0.0
    return 0.5 * (traction + ahead)


@dataclass(frozen=True)
class Rolling:
    """A problem: bound (nx, ny) [Pa]; `rigid` (2, nx, ny), what the surfaces slide by without tractions [m]; force
    (2,), the sum of the tractions over the cells [Pa], or None where the creepage is part of `rigid`.
    """

    operator: TangentialOperator
    bound: FloatArray
    rigid: FloatArray
    force: FloatArray | None


@dataclass(frozen=True)
class Rolled:
    """Tractions (2, n) on the cells in contact, and by what creepage adds over a cell [m]."""

    traction: FloatArray
    creep: FloatArray
    iterations: int


@dataclass(frozen=True)
class _Cells:
    """The problem on the n cells in contact; unknown are the tractions (2, n) [Pa].

    bound : (n,) [Pa]. rigid : (2, n) [m]. stiffness : t [Pa/m], of one cell alone.
    """

    problem: Rolling
    cells: NDArray[np.bool_]
    bound: FloatArray
    rigid: FloatArray
    stiffness: float

    def elastic_slip(self, traction: FloatArray) -> FloatArray:
        """Slip over a cell that tractions cause, (2, n) [m]."""
        grid = self.problem.operator.grid
        full = np.zeros((2, *grid.shape))
        full[:, self.cells] = traction
        return passing(grid, self.problem.operator.apply(full))[:, self.cells]

    def state(self, traction: FloatArray, slip: FloatArray) -> _State:
        """Project q - t s onto the friction discs; with a force, onto the tractions in them whose sum is the force."""
        wanted = traction - self.stiffness * slip
        allowed = np.empty_like(wanted)
        offset = np.zeros(2)
        if self.problem.force is None:
            nearest(wanted, self.bound, allowed)
        else:
            offset = nearest_with_force(wanted, self.bound, self.problem.force, allowed)
        return _State(traction, slip, wanted + offset[:, None], offset, traction - allowed)

    def derivative(self, state: _State) -> Callable[[FloatArray], FloatArray]:
        """Return the Jacobian of the miss as a function of a change of the tractions (2 n,)."""
        length = np.hypot(state.wanted[0], state.wanted[1])
        slips = length > self.bound
        normal = np.where(slips, state.wanted / np.where(slips, length, 1.0), 0.0)
        share = np.where(slips, self.bound / np.where(slips, length, 1.0), 1.0)
        inverse: FloatArray | None = None
        if self.problem.force is not None:  # of how the force answers to a uniform offset of all wanted tractions
            mixed = -float((share * normal[0] * normal[1]).sum())
            own = [float((share * (1 - part**2)).sum()) for part in normal]
            inverse = np.asarray(np.linalg.pinv([[own[0], mixed], [mixed, own[1]]], rcond=_FLAT, hermitian=True))

        def projected(values: FloatArray) -> FloatArray:
            return share * (values - normal * (normal * values).sum(0))

        def apply(change: FloatArray) -> FloatArray:
            traction = np.asarray(change).reshape(2, -1)
            moved = projected(traction - self.stiffness * self.elastic_slip(traction))
            if inverse is not None:
                offset = inverse @ moved.sum(1)
                moved -= projected(np.broadcast_to(offset[:, None], moved.shape))
            return (traction - moved).ravel()

        return apply


@dataclass(frozen=True)
class _State:
    """Tractions q (2, n) [Pa] and their slip s (2, n) [m] without the creepage that is to be found.

    wanted : (2, n) [Pa], q - t s plus the offset. offset : (2,) [Pa], minus t x the creepage to be found, over a cell.
    miss : (2, n) [Pa], q less the projection of `wanted`.
    """

    traction: FloatArray
    slip: FloatArray
    wanted: FloatArray
    offset: FloatArray
    miss: FloatArray


def roll(problem: Rolling, tolerance: float, limit: int) -> Rolled:
    """Newton until the miss is at most tolerance x the largest slip; from tractions of zero, or from those nearest to
    full sliding that have the force.
    """
    cells = problem.bound > 0
    if not cells.any():
        return Rolled(np.zeros((2, 0)), np.zeros(2), 0)
    stiffness = 2 / sum(problem.operator.compliance)
    on = _Cells(problem, cells, problem.bound[cells], problem.rigid[:, cells], stiffness)
    state = on.state(np.zeros_like(on.rigid), on.rigid)
    if problem.force is not None and on.rigid.any():
        traction = -state.miss
        state = on.state(traction, on.rigid + on.elastic_slip(traction))
    iterations = 0
    while iterations < limit and not _enough(on, state, tolerance):
        iterations += 1
        moved = _shortened(on, state, _newton_step(on, state))
        if moved is None:
            break
        state = moved
    return Rolled(state.traction, 0.0 - state.offset / stiffness, iterations)


def _enough(on: _Cells, state: _State, tolerance: float) -> bool:
    """Return True if the miss, and the force that tractions inside their discs miss, are within the tolerance."""
    least = least_scale(on.problem.rigid, state.traction / on.stiffness)
    scale = max(reach(state.slip, on.rigid, least), float(np.abs(state.offset).max()) / on.stiffness)
    if float(np.abs(state.miss).max()) > tolerance * on.stiffness * scale:
        return False
    if on.problem.force is None:
        return True
    inside = np.empty_like(state.traction)
    nearest(state.traction, on.bound, inside)
    return float(np.abs(inside.sum(1) - on.problem.force).max()) <= tolerance * float(on.bound.sum())


def _newton_step(on: _Cells, state: _State) -> FloatArray:
    size = state.miss.size
    matrix = LinearOperator((size, size), matvec=on.derivative(state), dtype=np.float64)
    step, _ = gmres(matrix, -state.miss.ravel(), rtol=_REDUCTION, restart=_KRYLOV, maxiter=4)
    return np.asarray(step, dtype=np.float64).reshape(2, -1)


def _shortened(on: _Cells, state: _State, step: FloatArray) -> _State | None:
    """The step, halved until the miss falls; None where it does not."""
    along = on.elastic_slip(step)
    size = float(np.linalg.norm(state.miss))
    share = 1.0
    for _ in range(_HALVINGS):
        moved = on.state(state.traction + share * step, state.slip + share * along)
        if float(np.linalg.norm(moved.miss)) <= (1 - 0.1 * share) * size:
            return moved
        share *= 0.5
    return None


def _certified(
    problem: Rolling, found: Rolled, pushed: FloatArray, creep: FloatArray, tolerance: float, failed: Status
) -> TangentialSolution:
    """Everything formed anew from the tractions; `converged` is said of that. `failed` : the status if not."""
    operator, grid, bound = problem.operator, problem.operator.grid, problem.bound
    cells = bound > 0
    traction = np.zeros((2, *grid.shape))
    traction[:, cells] = found.traction
    length = np.hypot(traction[0], traction[1])
    traction *= np.where(length > bound, bound / np.where(length > bound, length, 1.0), 1.0)
    elastic = operator.apply(traction)
    rigid = problem.rigid
    if problem.force is not None:
        creep = found.creep
        rigid = rigid + creep[:, None, None]
    slip = rigid + passing(grid, elastic)
    stiffness = 2 / sum(operator.compliance)
    wanted = traction[:, cells] - stiffness * slip[:, cells]
    allowed = np.empty_like(wanted)
    nearest(wanted, bound[cells], allowed)
    slips = np.hypot(wanted[0], wanted[1]) > bound[cells]
    violation = float(np.abs(allowed - traction[:, cells]).max(initial=0.0)) / stiffness
    least = least_scale(problem.rigid, traction / stiffness)
    scale = max(reach(slip[:, cells], problem.rigid[:, cells], least), float(np.abs(creep).max()))
    residual = violation / scale if scale > 0 else 0.0
    if problem.force is not None and cells.any():
        residual = max(residual, float(np.abs(traction.sum((1, 2)) - problem.force).max() / bound.sum()))
    slid = np.zeros_like(slip)
    slid[:, cells] = np.where(slips, slip[:, cells], 0.0)
    return TangentialSolution(
        traction=traction,
        force=traction.sum((1, 2)) * grid.cell_area,
        shift=np.zeros(2),
        rotation=0.0,
        creepage=creep / grid.spacing[0],
        displacement=elastic + pushed,
        slip=slid,
        stick_area=float(np.count_nonzero(~slips)) * grid.cell_area,
        slip_area=float(np.count_nonzero(slips)) * grid.cell_area,
        counted_stick_area=float(np.count_nonzero(~slips)) * grid.cell_area,
        dissipated_energy=max(-float((_mean_along(grid, traction) * slip).sum()) * grid.cell_area, 0.0),
        cell_energy=-float((traction * slid).sum()) * grid.cell_area,
        residual=residual,
        convolutions=operator.count.weighted,
        iterations=found.iterations,
        status=Status.CONVERGED if residual <= tolerance else failed,
    )
