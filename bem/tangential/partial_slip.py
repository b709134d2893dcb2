"""Partial slip under a given pressure, and the tangential stiffness before slip.

`solve_partial_slip` checks the arguments (`check_step`) and solves one load step (`solve_step`): imposed displacement,
initial tractions, Newton's method (`slip_newton`), certificate. `coupled_slip` calls both for each of its rounds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bem.contact import ContactSolution
from bem.contact.certificate import CERTIFICATE_MARGIN
from bem.contact.grid_workspace import IterationBudget
from bem.errors import ConvergenceError, InputError, Status
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.notes import Note
from bem.notes.contact import PRESSING_PATH
from bem.tangential.certificate import certify, stick_area
from bem.tangential.friction_laws import SlipFriction
from bem.tangential.initial_tractions import jaeger_start, start_from_coarser
from bem.tangential.operator import TangentialOperator, tangential_operator
from bem.tangential.problem import (
    SlipProblem,
    check_force,
    check_no_slip_speed,
    check_settings,
    check_vectors,
    displacement_scale,
    friction_bound,
    rounding_scale,
)
from bem.tangential.slip_newton import SlipResult, solve_slip
from bem.tangential.solution import TangentialSolution
from bem.threads import one_blas_thread

_UNREACHED_BOUND = 1e6
"""Friction bound that no traction reaches, over the traction that moves a single cell by the unit shift."""

_STIFFNESS_STEPS = 200
"""Limit of the Newton steps for the stiffness."""


@one_blas_thread
def solve_partial_slip(
    contact: ContactSolution | FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body],
    *,
    friction: float | FloatArray | SlipFriction,
    force: Sequence[float] | None = None,
    shift: Sequence[float] | None = None,
    rotation: float = 0.0,
    previous: TangentialSolution | None = None,
    tolerance: float = 1e-8,
    max_iterations: int = 1000,
) -> TangentialSolution:
    """Find where two bodies pressed together stick and where they slip, under a tangential force or shift.

    The local pressure is given and does not change. By Coulomb's law the traction never exceeds friction x pressure;
    where the surfaces slip it equals that bound and is directed against the slip. Both directions are solved together,
    with the in-plane displacement under the pressure itself (bodies of different elasticity, layers).

    Parameters
    ----------
    contact : a normal contact, or its pressure (nx, ny) [Pa].
    grid, bodies : as for `displacement_operator`: one body (the other rigid) or (first, second).
    friction : coefficient, a number or a map (nx, ny), not negative; or a law of `bem.tangential.friction_laws`.
    force : (Fx, Fy) [N], total traction on the first body.
    shift : (sx, sy) [m]; exactly one of force and shift. Signs: see
        `TangentialSolution`.
    rotation : [rad], about the grid's centre from x to y, in addition to the shift or the force.
    previous : the previous step, of the same grid and bodies. Sticking cells keep their relative displacement, so that
        a history of forces (and of pressures) is a sequence of calls. None: bodies that touch for the first time; if
        they differ in elasticity, pressure alone makes them slip, and the pressure should grow in steps (a note says
        so).
    tolerance : bound on the residual, see `TangentialSolution`.
    max_iterations : limit of the Newton steps over all grids.

    Raises
    ------
    InputError : arguments out of range, one message for each.
    InfeasibleError : a force that friction cannot carry.

    Notes
    -----
    Cattaneo (1938), Mindlin (1949); Johnson, *Contact Mechanics* (1985), chapter 7; the discrete conditions are those
    of Kalker's CONTACT for shifts. Tractions of bodies that differ in elasticity change the pressure too, see
    `solve_coupled_slip`.
    Cells without friction slide freely and count neither as sticking nor as slipping.
    """
    check_settings(rotation, tolerance, max_iterations)
    step = check_step(
        contact, grid, bodies, friction=friction, force=force, shift=shift, rotation=rotation, previous=previous
    )
    return solve_step(step, tolerance, max_iterations)


@dataclass(frozen=True)
class LoadStep:
    """Checked arguments of one load step of a history.

    pressure, bound : (nx, ny), pressure and friction x pressure [Pa].
    force : (2,) [N], or None. shift : (2,) [m], or None. rotation : [rad].
    previous : solution of the previous load step, or None.
    contact : the normal contact; None if only its pressure is given.
    """

    operator: TangentialOperator
    pressure: FloatArray
    bound: FloatArray
    force: FloatArray | None
    shift: FloatArray | None
    rotation: float
    previous: TangentialSolution | None
    contact: ContactSolution | None


def check_step(
    contact: ContactSolution | FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body],
    *,
    friction: float | FloatArray | SlipFriction,
    force: Sequence[float] | None,
    shift: Sequence[float] | None,
    rotation: float,
    previous: TangentialSolution | None,
) -> LoadStep:
    """Check the arguments of `solve_partial_slip` and return the load step.

    Raises
    ------
    InputError : arguments out of range, one message for each.
    InfeasibleError : a force that friction cannot carry.
    """
    operator = tangential_operator(grid, bodies)
    check_no_slip_speed(friction, "partial slip")
    pressure, bound = friction_bound(contact, grid, friction)
    messages = []
    if (force is None) == (shift is None):
        messages.append("force, shift: exactly one of them must be given")
    if previous is not None and previous.traction.shape != (2, *grid.shape):
        messages.append(f"previous: of shape {previous.traction.shape!r}, not of this grid's {(2, *grid.shape)!r}")
    total, displaced = check_vectors({"force": force, "shift": shift}, messages)
    if messages:
        raise InputError(messages)
    if total is not None:
        check_force(total, bound, grid)
    solved = contact if isinstance(contact, ContactSolution) else None
    return LoadStep(operator, pressure, bound, total, displaced, rotation, previous, solved)


def solve_step(
    step: LoadStep, tolerance: float, max_iterations: int, warm_start: TangentialSolution | None = None
) -> TangentialSolution:
    """Solve one load step.

    The imposed displacement b is the rigid movement (rotation and prescribed shift) less the in-plane displacement
    under the pressure, both as changes since the previous step, plus A q of the previous step. Minus the slip,
    r = b - A q, then vanishes where cells keep their relative displacement.

    warm_start : solution of the same load step under nearly the same pressure; affects cost and rounding only.
    """
    operator, bound, grid, previous = step.operator, step.bound, step.operator.grid, step.previous
    under_pressure = operator.displacement_under_pressure(step.pressure)
    imposed = _rigid_movement(grid, step.rotation, step.shift) - under_pressure
    if previous is not None:
        imposed = imposed + previous.displacement - _rigid_movement(grid, previous.rotation, previous.shift)
    total = None if step.force is None else step.force / grid.cell_area
    budget = IterationBudget(max_iterations)
    problem = SlipProblem(operator, bound, imposed, total)
    result: SlipResult | None = None
    if (bound > 0).any():
        if warm_start is not None:
            start = warm_start.traction - operator.stiffness * warm_start.slip
        else:
            jaeger = jaeger_start(problem) if previous is None else None
            traction = None if previous is None else previous.traction
            start = start_from_coarser(problem, traction, budget) if jaeger is None else jaeger
        result = solve_slip(problem, start, CERTIFICATE_MARGIN * tolerance, budget)
    notes = (PRESSING_PATH(reason="at-once"),) if previous is None and under_pressure.any() else ()
    return _solution(step, problem, result, under_pressure, tolerance, budget, notes)


def _rigid_movement(grid: Grid, rotation: float, shift: FloatArray | None) -> FloatArray:
    """Return the displacement (2, nx, ny) [m] of a small rotation about the grid's centre and a shift."""
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    turned = np.stack([np.broadcast_to(-rotation * y, grid.shape), np.broadcast_to(rotation * x[:, None], grid.shape)])
    return turned if shift is None else turned + shift[:, None, None]


def _solution(
    step: LoadStep,
    problem: SlipProblem,
    result: SlipResult | None,
    under_pressure: FloatArray,
    tolerance: float,
    budget: IterationBudget,
    notes: tuple[Note, ...],
) -> TangentialSolution:
    """Certify the tractions and return the solution.

    result : of Newton's method; None without contact. under_pressure : in-plane displacement (2, nx, ny) [m].
    """
    operator, bound, imposed = problem.operator, problem.bound, problem.imposed
    cells, area = bound > 0, operator.grid.cell_area
    traction, elastic = np.zeros_like(imposed), np.zeros_like(imposed)
    shift, residual = np.zeros(2), imposed
    if result is not None:
        traction[:, cells], elastic = result.traction, result.displacement
        shift, residual = result.shift, imposed - elastic + result.shift[:, None, None]
    if step.shift is not None:
        shift = step.shift
    scale = displacement_scale(elastic[:, cells], imposed[:, cells], least=rounding_scale(imposed))
    certificate = certify(operator, bound, traction, residual, scale=scale, traction_sum=problem.traction_sum)
    counted = float(np.count_nonzero(certificate.sticks)) * area
    in_contact = float(np.count_nonzero(cells)) * area
    if step.contact is not None and step.contact.counted_area > 0:  # the area of second order, less frictionless cells
        in_contact *= step.contact.contact_area / step.contact.counted_area
    stuck = in_contact
    if (cells & ~certificate.sticks).any():
        stuck = min(in_contact, stick_area(operator, bound, traction, certificate, step.contact))
    energy = -float((traction * certificate.slip).sum()) * area
    failed = Status.MAX_ITERATIONS if budget.left <= 0 else Status.STALLED
    return TangentialSolution(
        traction=traction,
        force=traction.sum((1, 2)) * area,
        shift=shift,
        rotation=step.rotation,
        displacement=elastic + under_pressure,
        slip=certificate.slip,
        stick_area=stuck,
        slip_area=in_contact - stuck,
        counted_stick_area=counted,
        dissipated_energy=energy,
        cell_energy=energy,
        residual=certificate.residual,
        convolutions=operator.count.weighted,
        iterations=budget.iterations,
        status=Status.CONVERGED if certificate.residual <= tolerance else failed,
        notes=notes,
    )


@one_blas_thread
def tangential_stiffness(
    contact: ContactSolution | FloatArray, grid: Grid, bodies: Body | tuple[Body, Body], *, tolerance: float = 1e-7
) -> FloatArray:
    """Return the force on the first body over its shift against the second, before any slip.

    A matrix (2, 2) [N/m] over both directions, symmetric. Every cell that carries load moves with the other body: the
    linear problem A q = shift on those cells, solved as partial slip with a bound that no traction reaches.

    Parameters
    ----------
    contact : a normal contact, or its pressure (nx, ny) [Pa]; only the cells that carry load matter.
    grid, bodies : as for `solve_partial_slip`.
    tolerance : relative, of displacements.

    Raises
    ------
    InputError : arguments out of range.
    ConvergenceError : the solution does not meet the tolerance.

    Notes
    -----
    A circle of radius a has 8 a / sum (2 - nu)/G (Mindlin 1949). On a doubly periodic grid the shift is that of the
    mean planes.
    """
    operator = tangential_operator(grid, bodies)
    pressure, _ = friction_bound(contact, grid, 1.0)
    touches = pressure > 0
    if not touches.any():
        return np.zeros((2, 2))
    bound = np.where(touches, _UNREACHED_BOUND * operator.stiffness, 0.0)
    columns = []
    for shift in np.eye(2):
        imposed = np.broadcast_to(shift[:, None, None], (2, *grid.shape))
        problem, budget = SlipProblem(operator, bound, imposed, None), IterationBudget(_STIFFNESS_STEPS)
        result = solve_slip(problem, start_from_coarser(problem, None, budget), tolerance, budget)
        if not result.converged:
            raise ConvergenceError(f"tangential_stiffness: displacements are met to {result.violation:.1e} only")
        columns.append(result.traction.sum(1) * grid.cell_area)
    return np.stack(columns, axis=1)
