"""Steady rolling along +x with creepage and spin: where the surfaces stick and slip while they pass through a contact.

In a frame that moves with the contact, what is at x has come from x + dx, one cell ahead. Over a cell's length of
rolling the first surface slides over the second by

    s = (creepage + spin x r) dx + u(x) - u(x + dx),

u = A q + what the pressure moves. Coulomb's law holds for s: none where |q| < g, s = -lambda q where |q| = g. That is
Kalker's steady state (CONTACT; *Three-Dimensional Elastic Bodies in Rolling Contact*, 1990) with the derivative along x
taken over one cell, of first order. It has no energy; Newton on q = nearest(q - t s) with GMRES for the
linear systems. Their matrix is of order zero in the wavenumber but small for waves across the rolling, so that
convolutions grow with the cells along it: 2 to 3 for each were counted from 32 to 256. Where a step does not help
it is halved; where that does not help either, the status says "stalled".
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse.linalg import LinearOperator, gmres

from bem.contact import ContactSolution
from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.tangential.discs import nearest
from bem.tangential.operator import TangentialOperator
from bem.tangential.rounds import reach
from bem.tangential.solution import TangentialSolution
from bem.tangential.solve import check_force, check_numbers, checked_bound, tangential_operator
from bem.threads import one_blas_thread

_TIGHTER = 0.9
_REDUCTION = 0.03
"""What a linear system is solved to: 0.1 to 0.01 all take about as many convolutions in all (counted)."""

_HALVINGS = 8
_KRYLOV = 60


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
    pushed = operator.under_pressure(pressure) if operator.coupled else np.zeros((2, *grid.shape))
    side = grid.spacing[0]
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    rigid = np.empty((2, *grid.shape))
    rigid[0] = (creep[0] - spin * y[None, :]) * side
    rigid[1] = (creep[1] + spin * x[:, None]) * side
    rolling = Rolling(operator, bound, rigid + passing(grid, pushed), total)
    found = roll(rolling, _TIGHTER * tolerance, max_iterations)
    failed = Status.MAX_ITERATIONS if found.iterations >= max_iterations else Status.STALLED
    return _certified(rolling, found, pushed, creep * side, tolerance, failed)


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
    """u(x) - u(x + dx) on the grid (2, nx, ny); beyond a free end nothing comes in strained."""
    ahead = np.roll(displacement, -1, axis=1)
    if not grid.periodic[0]:
        ahead[:, -1] = displacement[:, -1]
    return displacement - ahead


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
    """The problem on the cells in contact; unknowns are (2 n + 2,): tractions, and t x creep over a cell."""

    problem: Rolling
    cells: NDArray[np.bool_]
    bound: FloatArray
    rigid: FloatArray
    stiffness: float
    weight: float

    def slid(self, traction: FloatArray) -> FloatArray:
        """What tractions add to the slip, (2, n)."""
        grid = self.problem.operator.grid
        full = np.zeros((2, *grid.shape))
        full[:, self.cells] = traction
        return passing(grid, self.problem.operator.apply(full))[:, self.cells]

    def parts(self, unknown: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Tractions (2, n) and the offset (2,)."""
        return unknown[:-2].reshape(2, -1), unknown[-2:]

    def wanted(self, unknown: FloatArray, slip: FloatArray) -> FloatArray:
        """q - t s, (2, n), where the slip leaves the offset out."""
        traction, offset = self.parts(unknown)
        return traction - self.stiffness * slip - offset[:, None]

    def miss(self, unknown: FloatArray, wanted: FloatArray) -> FloatArray:
        """q - nearest(wanted), and what is missed of the force."""
        traction, offset = self.parts(unknown)
        allowed = np.empty_like(wanted)
        nearest(wanted, self.bound, allowed)
        force = self.problem.force
        balance = offset if force is None else (traction.sum(1) - force) * self.weight
        return np.concatenate([(traction - allowed).ravel(), balance])

    def derivative(self, wanted: FloatArray) -> Callable[[FloatArray], FloatArray]:
        """The Jacobian of `miss` applied to a change of the unknowns."""
        length = np.hypot(wanted[0], wanted[1])
        slips = length > self.bound
        normal = np.where(slips, wanted / np.where(slips, length, 1.0), 0.0)
        share = np.where(slips, self.bound / np.where(slips, length, 1.0), 1.0)
        free = self.problem.force is not None

        def apply(change: FloatArray) -> FloatArray:
            traction, offset = self.parts(np.asarray(change).ravel())
            moved = traction - self.stiffness * self.slid(traction) - offset[:, None]
            moved = share * (moved - normal * (normal * moved).sum(0))
            balance = traction.sum(1) * self.weight if free else offset
            return np.concatenate([(traction - moved).ravel(), balance])

        return apply


def roll(problem: Rolling, tolerance: float, limit: int) -> Rolled:
    """Newton from tractions of zero until the miss is at most tolerance x the largest slip."""
    cells = problem.bound > 0
    if not cells.any():
        return Rolled(np.zeros((2, 0)), np.zeros(2), 0)
    bound = problem.bound[cells]
    stiffness = 2 / sum(problem.operator.compliance)
    on = _Cells(problem, cells, bound, problem.rigid[:, cells], stiffness, 1 / math.sqrt(bound.size))
    unknown = np.zeros(2 * bound.size + 2)
    slip = on.rigid
    wanted = on.wanted(unknown, slip)
    miss = on.miss(unknown, wanted)
    iterations = 0
    while iterations < limit:
        size = float(np.abs(miss).max())
        if size <= tolerance * stiffness * _scale(on, slip, unknown):
            break
        iterations += 1
        step = _newton_step(on, wanted, miss)
        moved = _shortened(on, unknown, slip, step, float(np.linalg.norm(miss)))
        if moved is None:
            break
        unknown, slip, wanted, miss = moved
    traction, offset = on.parts(unknown)
    return Rolled(traction, offset / stiffness, iterations)


def _scale(on: _Cells, slip: FloatArray, unknown: FloatArray) -> float:
    return max(reach(slip, on.rigid), float(np.abs(unknown[-2:]).max()) / on.stiffness)


def _newton_step(on: _Cells, wanted: FloatArray, miss: FloatArray) -> FloatArray:
    matrix = LinearOperator((miss.size, miss.size), matvec=on.derivative(wanted), dtype=np.float64)
    step, _ = gmres(matrix, -miss, rtol=_REDUCTION, restart=_KRYLOV, maxiter=4)
    return np.asarray(step, dtype=np.float64)


def _shortened(
    on: _Cells, unknown: FloatArray, slip: FloatArray, step: FloatArray, size: float
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray] | None:
    """The step, halved until the miss falls; None where it does not."""
    along = on.slid(on.parts(step)[0])
    share = 1.0
    for _ in range(_HALVINGS):
        moved = unknown + share * step
        there = slip + share * along
        wanted = on.wanted(moved, there)
        miss = on.miss(moved, wanted)
        if float(np.linalg.norm(miss)) <= (1 - 0.1 * share) * size:
            return moved, there, wanted, miss
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
    scale = max(reach(slip[:, cells], problem.rigid[:, cells]), float(np.abs(creep).max()))
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
        # what tractions store they give back, so that passing(elastic) takes nothing but where it is cut into cells
        dissipated_energy=-float((traction * rigid).sum()) * grid.cell_area,
        residual=residual,
        convolutions=operator.count.weighted,
        iterations=found.iterations,
        status=Status.CONVERGED if residual <= tolerance else failed,
    )
