"""The front door of tangential contact: checks, the step's imposed, coarse to fine, certificate."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.contact import ContactSolution
from bem.errors import InfeasibleError, InputError, Status
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.tangential.cascade import slip
from bem.tangential.discs import nearest
from bem.tangential.edge import stuck_area
from bem.tangential.operator import TangentialOperator
from bem.tangential.rounds import Effort, Slipped, Slipping, least_scale, reach, slip_on_grid
from bem.tangential.solution import TangentialSolution
from bem.tangential.straight import pushed_straight
from bem.threads import one_blas_thread

AT_ONCE = (
    "the bodies differ in elasticity, and their whole pressure came at once: surfaces slip while pressure grows, so "
    "that what sticks depends on how it grew (a ball's stick radius comes out half as large); give the contact in "
    "steps, each with the one before as `previous`"
)
"""Note on a first step: Spence (1968), tests/tangential."""

_TIGHTER = 0.9
"""Share of the tolerance that the solver aims at, so that what is formed anew cannot spoil the certificate."""


@one_blas_thread
def solve_partial_slip(
    contact: ContactSolution | FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body],
    *,
    friction: float | FloatArray,
    force: Sequence[float] | None = None,
    shift: Sequence[float] | None = None,
    rotation: float = 0.0,
    previous: TangentialSolution | None = None,
    tolerance: float = 1e-8,
    max_iterations: int = 1000,
) -> TangentialSolution:
    """Where two bodies pressed together stick and where they slip, under a tangential force or shift.

    Coulomb's law with the local pressure, which is given and stays: traction never exceeds friction x pressure, reaches
    it where the surfaces slip, against the slip. Both directions at once, and what the pressure itself moves in the
    plane (bodies of different elasticity, layers).

    Parameters
    ----------
    contact : a normal contact, or its pressure (nx, ny) [Pa].
    grid, bodies : as for `displacement_operator`: one body (the other rigid) or (first, second).
    friction : coefficient, a number or a map (nx, ny), not negative.
    force : (Fx, Fy) [N], total traction on the first body.
    shift : (sx, sy) [m]; exactly one of the two. Signs: see
        `TangentialSolution`.
    rotation : [rad], about the grid's centre from x to y, in addition to the shift or the force.
    previous : the step before, of the same grid and bodies: what sticks keeps what it had, so that a history of forces
        (and of pressures) is a sequence of calls. None: bodies that touch for the first time; where they differ in
        elasticity pressure alone makes them slip, and the pressure should grow in steps (a note says so).
    tolerance : bound on the residual, see `TangentialSolution`.
    max_iterations : limit on rounds of the active set over all grids.

    Raises
    ------
    InputError : arguments out of range, one message for each.
    InfeasibleError : a force that friction cannot carry.

    Notes
    -----
    Cattaneo (1938), Mindlin (1949); Johnson, *Contact Mechanics* (1985), chapter 7; the discrete conditions are those
    of Kalker's CONTACT for shifts. The pressure is not changed by the tractions; of bodies that differ it would be, see
    `solve_coupled_slip`.
    Cells without friction slide freely and count neither as sticking nor as slipping.
    """
    check_numbers(rotation, tolerance, max_iterations)
    request = checked(contact, grid, bodies, friction=friction, force=force, shift=shift, previous=previous)
    return solve_step(request, rotation, previous, tolerance, max_iterations)


def solve_step(
    request: Request,
    rotation: float,
    previous: TangentialSolution | None,
    tolerance: float,
    max_iterations: int,
    near: TangentialSolution | None = None,
) -> TangentialSolution:
    """`solve_partial_slip` of arguments in order; `near` : the same step under nearly the same pressure, a start."""
    operator, bound, grid = request.operator, request.bound, request.operator.grid
    pushed = operator.under_pressure(request.pressure) if operator.coupled else np.zeros((2, *grid.shape))
    movement = _turned(grid, rotation) + (0.0 if request.shift is None else request.shift[:, None, None])
    imposed = movement - pushed
    if previous is not None:
        imposed = imposed + previous.displacement - _turned(grid, previous.rotation) - previous.shift[:, None, None]
    total = None if request.force is None else request.force / grid.cell_area
    effort = Effort(max_iterations)
    found: Slipped | None = None
    if (bound > 0).any():
        problem = Slipping(operator, bound, imposed, total)
        if near is not None:
            found = slip_on_grid(problem, near.traction - problem.stiffness * near.slip, _TIGHTER * tolerance, effort)
        else:
            found = _from_afar(problem, previous, _TIGHTER * tolerance, effort)
    given = request.shift if request.shift is not None else np.zeros(2) if found is None else found.shift
    notes = (AT_ONCE,) if previous is None and pushed.any() else ()
    return _certified(request, found, imposed, pushed, given, rotation, tolerance, effort, notes)


def _from_afar(problem: Slipping, previous: TangentialSolution | None, tolerance: float, effort: Effort) -> Slipped:
    """From a straight push, or from coarser grids."""
    straight = pushed_straight(problem) if previous is None else None
    if straight is not None:
        return slip_on_grid(problem, straight, tolerance, effort)
    return slip(problem, None if previous is None else previous.traction, tolerance, effort)


@dataclass(frozen=True)
class Request:
    """Arguments of `solve_partial_slip` that are in order."""

    operator: TangentialOperator
    pressure: FloatArray
    bound: FloatArray
    force: FloatArray | None
    shift: FloatArray | None
    contact: ContactSolution | None


def checked(
    contact: ContactSolution | FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body],
    *,
    friction: float | FloatArray,
    force: Sequence[float] | None,
    shift: Sequence[float] | None,
    previous: TangentialSolution | None,
) -> Request:
    """Arguments of `solve_partial_slip`, or its messages."""
    operator = tangential_operator(grid, bodies)
    pressure, bound = checked_bound(contact, grid, friction)
    messages = []
    if (force is None) == (shift is None):
        messages.append("force, shift: exactly one of them must be given")
    if previous is not None and previous.traction.shape != (2, *grid.shape):
        messages.append(f"previous: of shape {previous.traction.shape!r}, not of this grid's {(2, *grid.shape)!r}")
    vectors = {}
    for name, given in (("force", force), ("shift", shift)):
        vector = None if given is None else np.asarray(given, dtype=np.float64)
        if vector is not None and not (vector.shape == (2,) and np.isfinite(vector).all()):
            messages.append(f"{name}: {given!r} must be two finite numbers, along x and y")
        vectors[name] = vector
    if messages:
        raise InputError(messages)
    asked = vectors["force"]
    if asked is not None:
        check_force(asked, bound, grid)
    solved = contact if isinstance(contact, ContactSolution) else None
    return Request(operator, pressure, bound, asked, vectors["shift"], solved)


def check_numbers(rotation: float, tolerance: float, max_iterations: int) -> None:
    """Refuse a rotation that is not finite, a tolerance outside (0, 1), a negative limit of rounds (InputError)."""
    messages = []
    if not math.isfinite(rotation):
        messages.append(f"rotation: {rotation!r} must be a finite angle [rad]")
    if not (math.isfinite(tolerance) and 0 < tolerance < 1):
        messages.append(f"tolerance: {tolerance!r} must lie between 0 and 1")
    if not (isinstance(max_iterations, int) and max_iterations >= 0):
        messages.append(f"max_iterations: {max_iterations!r} must be a whole number >= 0")
    if messages:
        raise InputError(messages)


def tangential_operator(grid: Grid, bodies: Body | tuple[Body, Body]) -> TangentialOperator:
    """The operator from tractions on the first of one or two bodies to their displacement against each other.

    Raises
    ------
    InputError : not a Grid, not one or two bodies.
    """
    messages = []
    pair = (bodies,) if isinstance(bodies, Body) else bodies
    if not isinstance(grid, Grid):
        messages.append(f"grid: {grid!r} must be a Grid")
    if not isinstance(pair, tuple | list) or len(pair) not in (1, 2) or not all(isinstance(b, Body) for b in pair):
        messages.append(f"bodies: {bodies!r} must be one Body or a pair of them")
    if not messages and grid.cells == 1 and all(grid.periodic):
        messages.append("grid: one cell that is periodic along both axes has no displacement; give at least two cells")
    if messages:
        raise InputError(messages)
    return TangentialOperator(grid, tuple(pair))


def checked_bound(
    contact: ContactSolution | FloatArray, grid: Grid, friction: float | FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Pressure [Pa], and friction x pressure [Pa], both (nx, ny).

    Raises
    ------
    InputError : a pressure that is not this grid's, negative or not finite; a friction that is negative or no map.
    """
    given = contact.pressure if isinstance(contact, ContactSolution) else contact
    pressure = grid.check_field(given, "contact")
    messages = []
    if (pressure < 0).any():
        messages.append(f"contact: pressures must not be negative; the least is {float(pressure.min())!r} Pa")
    factor = np.asarray(friction, dtype=np.float64)
    if factor.shape not in ((), grid.shape):
        messages.append(f"friction: shape {factor.shape!r} must be a number or a map of shape {grid.shape!r}")
    elif not (np.isfinite(factor).all() and (factor >= 0).all()):
        messages.append("friction: every coefficient must be finite and not negative")
    if messages:
        raise InputError(messages)
    return pressure, np.ascontiguousarray(np.broadcast_to(factor, grid.shape) * pressure)


def check_force(force: FloatArray, bound: FloatArray, grid: Grid) -> None:
    """Refuse a force (2,) [N] that friction x pressure `bound` (nx, ny) cannot carry (InfeasibleError)."""
    most, asked = float(bound.sum()) * grid.cell_area, math.hypot(*force)
    if not asked < most and (most > 0 or asked > 0):
        raise InfeasibleError(
            f"force: {asked!r} N must be less than friction x load = {most!r} N; beyond it everything slides"
        )


def _turned(grid: Grid, rotation: float) -> FloatArray:
    """Displacement (2, nx, ny) [m] of a small rotation about the grid's centre."""
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    return np.stack(
        [np.broadcast_to(-rotation * y[None, :], grid.shape), np.broadcast_to(rotation * x[:, None], grid.shape)]
    )


def _certified(
    request: Request,
    found: Slipped | None,
    imposed: FloatArray,
    pushed: FloatArray,
    shift: FloatArray,
    rotation: float,
    tolerance: float,
    effort: Effort,
    notes: tuple[str, ...],
) -> TangentialSolution:
    """Everything from the tractions and what the operator makes of just these; `converged` is said of that."""
    operator, bound = request.operator, request.bound
    area = operator.grid.cell_area
    traction = np.zeros((2, *operator.grid.shape))
    elastic = np.zeros_like(traction)
    if found is not None:
        traction[:, found.cells] = found.traction
        elastic = found.field
    unmet = imposed - elastic
    if request.force is not None:
        unmet = unmet + shift[:, None, None]
    cells = bound > 0
    violation, slips = _violation(operator, bound[cells], traction[:, cells], unmet[:, cells])
    scale = reach(elastic[:, cells], imposed[:, cells], least_scale(imposed))
    residual = violation / scale if scale > 0 else 0.0
    force = traction.sum((1, 2)) * area
    if request.force is not None:
        most = float(bound.sum()) * area
        residual = max(residual, float(np.abs(force - request.force).max()) / most if most > 0 else 0.0)
    slid = np.zeros_like(traction)
    slid[:, cells] = np.where(slips, -unmet[:, cells], 0.0)
    sticks = np.zeros_like(cells)
    sticks[cells] = ~slips
    rubs = stuck = float(np.count_nonzero(cells)) * area
    if request.contact is not None and request.contact.counted_area > 0:  # its edge, less what has no friction
        rubs = stuck = rubs * request.contact.contact_area / request.contact.counted_area
    if slips.any():
        stuck = min(rubs, stuck_area(operator, bound, traction, slid, sticks, request.contact))
    failed = Status.MAX_ITERATIONS if effort.left <= 0 else Status.STALLED
    return TangentialSolution(
        traction=traction,
        force=force,
        shift=shift,
        rotation=rotation,
        displacement=elastic + pushed,
        slip=slid,
        stick_area=stuck,
        slip_area=rubs - stuck,
        counted_stick_area=float(np.count_nonzero(sticks)) * area,
        dissipated_energy=-float((traction * slid).sum()) * area,
        cell_energy=-float((traction * slid).sum()) * area,
        residual=residual,
        convolutions=operator.count.weighted,
        iterations=effort.rounds,
        status=Status.CONVERGED if residual <= tolerance else failed,
        notes=notes,
    )


def _violation(
    operator: TangentialOperator, bound: FloatArray, traction: FloatArray, unmet: FloatArray
) -> tuple[float, NDArray[np.bool_]]:
    """Largest violation of Coulomb's conditions [m], and which cells slip (n,)."""
    stiffness = 2 / sum(operator.compliance)
    wanted = traction + stiffness * unmet
    allowed = np.empty_like(wanted)
    nearest(wanted, bound, allowed)
    return float(np.abs(allowed - traction).max(initial=0.0)) / stiffness, np.hypot(wanted[0], wanted[1]) > bound
