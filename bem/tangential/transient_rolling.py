"""Transient rolling along +x: steps of the distance rolled, under a history of creepages or forces.

In a frame that moves with the contact, a particle at x was at x + dx one step, a cell, earlier. In the step the first
surface slides over the second by

    s = (creepage + spin x r) dx + u(x) - u'(x + dx),

where u and u' are the displacements after and before the step, under tractions and pressure. Coulomb's law holds for
this slip (Kalker 1990). With u' known, each step is a convex problem like partial slip, which `slip_newton` solves: the
imposed displacement is u'(x + dx) less the movement of the bodies. The steady state of `solve_rolling` is that in which
u' = u, so that a long history under a constant creepage ends there, to the tolerance. The method is of first order in
the cell, which is the step.

A line contact under a changing force moves by a length that depends on the depth of the bodies and on the datum of the
displacements: its force should be given, and its creepage is known where the force is constant. Cost of a step: about
that of a later step of partial slip.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.contact import ContactSolution
from bem.contact.certificate import CERTIFICATE_MARGIN
from bem.contact.grid_workspace import IterationBudget
from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.representation import readable
from bem.tangential.certificate import certify
from bem.tangential.friction_laws import SlipFriction
from bem.tangential.operator import TangentialOperator, tangential_operator
from bem.tangential.problem import (
    SlipProblem,
    check_force,
    check_no_slip_speed,
    check_settings,
    displacement_scale,
    friction_bound,
    rounding_scale,
)
from bem.tangential.rolling import lengthened, reaches_the_ends, rigid_slip
from bem.tangential.slip_newton import solve_slip
from bem.tangential.solution import TangentialSolution
from bem.threads import one_blas_thread

_TIGHTENINGS = 4
"""Limit of the solutions of a step, each with a tighter tolerance of displacements."""


@readable
@dataclass(frozen=True)
class RollingHistory:
    """Transient rolling: curves over n steps, and the state after the last one.

    Attributes
    ----------
    distance : (n,), rolled since the start [m].
    force : (n, 2) [N], total traction on the first body.
    creepage : (n, 2), velocity of the first body against the second over the rolling velocity, in each step.
    stick_fraction : (n,), area of the cells that stick over that of the cells with friction.
    friction_work : (n,), energy of friction in the step over the distance rolled in it [N].
    residual : largest relative violation of Coulomb's law of all steps.
    status : outcome; `residual` is at most the tolerance if it is converged.
    last : tractions, slip and displacement after the last step.
    """

    distance: FloatArray
    force: FloatArray
    creepage: FloatArray
    stick_fraction: FloatArray
    friction_work: FloatArray
    residual: float
    status: Status
    last: TangentialSolution


@one_blas_thread
def solve_transient_rolling(
    contact: ContactSolution | FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body],
    *,
    friction: float | FloatArray | SlipFriction,
    creepage: ArrayLike | None = None,
    force: ArrayLike | None = None,
    spin: float = 0.0,
    start: TangentialSolution | None = None,
    tolerance: float = 1e-7,
    max_iterations: int = 200,
    after: Callable[[int, int], None] = lambda done, total: None,
) -> RollingHistory:
    """Roll in steps of a cell under a history of creepages or of forces.

    Parameters
    ----------
    contact, grid, bodies, friction : as for `solve_partial_slip`; the pressure does not change.
    creepage : (n, 2), of each step, as for `solve_rolling`.
    force : (n, 2) [N], at the end of each step, total traction on the first body; exactly one of creepage and force.
    spin : as for `solve_rolling`, constant [1/m].
    start : state before the first step, such as partial slip under a force; None: no traction.
    tolerance : bound on the residual of each step, see `TangentialSolution`.
    max_iterations : limit of the Newton steps of a step.
    after : is called with the number of steps done and their total.

    Raises
    ------
    InputError : arguments out of range, one message for each.
    InfeasibleError : a force that friction cannot carry.
    """
    operator = tangential_operator(grid, bodies)
    check_settings(0.0, tolerance, max_iterations)
    check_no_slip_speed(friction, "transient rolling")
    pressure, bound = friction_bound(contact, grid, friction)
    given = _check_history(grid, creepage, force, spin, start)
    if force is not None:
        for total in given:
            check_force(total, bound, grid)
    traction = np.zeros((2, *grid.shape)) if start is None else start.traction
    inside = slice(None)
    if reaches_the_ends(grid, bound):
        inside, grid = slice(1, -1), lengthened(grid)
        operator = tangential_operator(grid, bodies)
        pressure, bound = (np.pad(field, ((1, 1), (0, 0))) for field in (pressure, bound))
        traction = np.pad(traction, ((0, 0), (1, 1), (0, 0)))
    under_pressure = operator.displacement_under_pressure(pressure)
    march = _March(operator, bound, under_pressure, tolerance, max_iterations)
    state = _Step(
        traction, operator.apply(traction) + under_pressure, np.zeros((2, *grid.shape)), np.zeros(2), bound > 0
    )
    rows, residual, iterations, status = [], 0.0, 0, Status.CONVERGED
    for number, value in enumerate(given):
        moved = rigid_slip(grid, np.zeros(2) if force is not None else value, spin)
        state = march.step(state, moved, value / grid.cell_area if force is not None else None)
        creep = state.creep if force is not None else value
        contact_cells = max(int(np.count_nonzero(bound)), 1)
        sticking = float(np.count_nonzero(state.sticks)) / contact_cells if bound.any() else 1.0
        rows.append([*state.traction.sum((1, 2)) * grid.cell_area, *creep, sticking, state.work])
        residual, iterations = max(residual, state.residual), iterations + state.iterations
        if state.status is not Status.CONVERGED:
            status = state.status
        after(number + 1, len(given))
    table = np.array(rows)
    stuck = float(np.count_nonzero(state.sticks)) * grid.cell_area
    last = TangentialSolution(
        traction=state.traction[:, inside],
        force=table[-1, :2].copy(),
        shift=np.zeros(2),
        rotation=0.0,
        creepage=table[-1, 2:4].copy(),
        displacement=state.displacement[:, inside],
        slip=state.slip[:, inside],
        stick_area=stuck,
        slip_area=float(np.count_nonzero(bound)) * grid.cell_area - stuck,
        counted_stick_area=stuck,
        dissipated_energy=state.work * grid.spacing[0],
        cell_energy=-float((state.traction * state.slip).sum()) * grid.cell_area,
        residual=residual,
        convolutions=operator.count.weighted,
        iterations=iterations,
        status=status,
    )
    distance = grid.spacing[0] * np.arange(1.0, len(table) + 1)
    return RollingHistory(distance, table[:, :2], table[:, 2:4], table[:, 4], table[:, 5], residual, status, last)


def _check_history(
    grid: Grid, creepage: ArrayLike | None, force: ArrayLike | None, spin: float, start: TangentialSolution | None
) -> FloatArray:
    """Return the history (n, 2) of creepages or forces."""
    messages = []
    if (creepage is None) == (force is None):
        messages.append("creepage, force: exactly one of them must be given")
    name, given = ("creepage", creepage) if force is None else ("force", force)
    history = np.asarray(np.zeros((1, 2)) if given is None else given, dtype=np.float64)
    if history.ndim != 2 or history.shape[1] != 2 or not len(history) or not np.isfinite(history).all():
        messages.append(f"{name}: must be an array (n, 2) of finite numbers, one row for each step of a cell")
    if not math.isfinite(spin):
        messages.append(f"spin: {spin!r} must be finite [1/m]")
    if start is not None and start.traction.shape != (2, *grid.shape):
        messages.append(f"start: of shape {start.traction.shape!r}, not of this grid's {(2, *grid.shape)!r}")
    if messages:
        raise InputError(messages)
    return history


@dataclass(frozen=True)
class _Step:
    """State after a step.

    traction [Pa], displacement [m], slip in the step [m] : (2, nx, ny). creep : (2,), creepage of a given force.
    sticks : (nx, ny). work : energy of friction over the distance rolled [N].
    """

    traction: FloatArray
    displacement: FloatArray
    slip: FloatArray
    creep: FloatArray
    sticks: NDArray[np.bool_]
    work: float = 0.0
    residual: float = 0.0
    iterations: int = 0
    status: Status = Status.CONVERGED


@dataclass(frozen=True)
class _March:
    """Constants of a march: operator, friction bound and tolerances, which all steps share.

    bound : (nx, ny) [Pa]. under_pressure : (2, nx, ny), in-plane displacement under the pressure [m].
    """

    operator: TangentialOperator
    bound: FloatArray
    under_pressure: FloatArray
    tolerance: float
    max_iterations: int

    def step(self, before: _Step, moved: FloatArray, traction_sum: FloatArray | None) -> _Step:
        """Roll over one cell.

        moved : (2, nx, ny), slip over a cell by creepage and spin [m]. traction_sum : (2,), force over the area of a
        cell [Pa]; None if the creepage is part of `moved`.
        """
        grid, cells = self.operator.grid, self.bound > 0
        earlier = ahead(grid, before.displacement, keep_end=True)
        imposed = earlier - self.under_pressure - moved
        problem = SlipProblem(self.operator, self.bound, imposed, traction_sum)
        budget = IterationBudget(self.max_iterations)
        trial, goal = before.traction - self.operator.stiffness * before.slip, CERTIFICATE_MARGIN * self.tolerance
        for _ in range(_TIGHTENINGS):
            traction, elastic, shift = np.zeros_like(imposed), np.zeros_like(imposed), np.zeros(2)
            if cells.any():
                result = solve_slip(problem, trial, goal, budget)
                traction[:, cells], elastic, shift = result.traction, result.displacement, result.shift
            residual = imposed - elastic + shift[:, None, None]
            least = rounding_scale(imposed[:, cells], traction / self.operator.stiffness)
            slip_scale = displacement_scale(residual[:, cells], moved[:, cells], shift, least=least)
            certificate = certify(
                self.operator, self.bound, traction, residual, scale=slip_scale, traction_sum=traction_sum
            )
            if certificate.residual <= self.tolerance or budget.left <= 0:
                break
            # the solver's tolerance is relative to displacements, which are far larger than the slip of a step
            displaced = displacement_scale(elastic[:, cells], imposed[:, cells], least=slip_scale)
            goal = min(0.5 * goal, 0.5 * self.tolerance * slip_scale / displaced)
            trial = traction + self.operator.stiffness * np.where(certificate.sticks, 0.0, residual)
        mean = 0.5 * (traction + ahead(grid, before.traction, keep_end=False))
        work = float((mean * residual).sum()) * grid.cell_area / grid.spacing[0]
        failed = Status.MAX_ITERATIONS if budget.left <= 0 else Status.STALLED
        return _Step(
            traction,
            elastic + self.under_pressure,
            certificate.slip,
            -shift / grid.spacing[0],
            certificate.sticks,
            max(work, 0.0),
            certificate.residual,
            budget.iterations,
            Status.CONVERGED if certificate.residual <= self.tolerance else failed,
        )


def ahead(grid: Grid, field: FloatArray, *, keep_end: bool) -> FloatArray:
    """Return the field (2, nx, ny) at x + dx; at a free end its last value if `keep_end`, else zero."""
    moved = np.roll(field, -1, axis=1)
    if not grid.periodic[0]:
        moved[:, -1] = field[:, -1] if keep_end else 0.0
    return moved
