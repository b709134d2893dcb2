"""Contact and partial slip together: tractions of bodies that differ change the gap, and the pressure responds.

`solve_partial_slip` couples one way: the given pressure moves the surfaces in the plane. Here the coupling is two-way,
by fixed-point iteration over rounds:

1. Solve the normal contact with the gap plus the normal displacement under the tractions of the last round.
2. Solve partial slip under its pressure, warm-started from the tractions of the last round.
3. Compute the normal displacement under the new tractions. Its change is an error of the gap of step 1.
4. Repeat until the residual of the contact plus this error, and the residual of slip, meet the tolerance.

Pressure and tractions respond to each other through the bodies' mismatch only (Dundurs' beta, at most 1/2), so the
error falls by a factor of two to ten a round. The certificate belongs to the returned pair of pressure and tractions.
Cost of a round: one contact, one partial slip, and one convolution.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from bem.contact import ContactSolution, solve_contact
from bem.convolution import displacement_operator
from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.notes import Note
from bem.representation import readable
from bem.tangential.friction_laws import SlipFriction
from bem.tangential.operator import tangential_operator
from bem.tangential.partial_slip import check_step, solve_step
from bem.tangential.problem import check_settings
from bem.tangential.solution import TangentialSolution
from bem.threads import one_blas_thread

_SUBPROBLEM_FRACTION = 0.1
"""Fraction of the tolerance to which the contact and the partial slip of a round are solved."""


@readable
@dataclass(frozen=True)
class CoupledSolution:
    """A contact and its tractions, each under the other.

    Attributes
    ----------
    contact : its gap includes the displacement under the tractions, its displacement is that of the pressure alone.
    tangential : stick and slip under its pressure; convolutions and iterations are those of all rounds.
    normal_displacement : (nx, ny) [m], by which the tractions press the surfaces apart, sum of both.
    rounds : number of contacts, each followed by slip.
    residual : the larger of slip's residual and of the contact's, to which the change of its gap under the last
        tractions is added, over its largest displacement.
    status : outcome; `residual` is at most the tolerance if it is converged.
    notes : of both.
    """

    contact: ContactSolution
    tangential: TangentialSolution
    normal_displacement: FloatArray
    rounds: int
    residual: float
    status: Status
    notes: tuple[Note, ...] = ()


@one_blas_thread
def solve_coupled_slip(
    gap: FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body],
    *,
    friction: float | FloatArray | SlipFriction,
    load: float | None = None,
    approach: float | None = None,
    mean_gap: float | None = None,
    hardness: float | None = None,
    force: Sequence[float] | None = None,
    shift: Sequence[float] | None = None,
    rotation: float = 0.0,
    previous: CoupledSolution | None = None,
    tolerance: float = 1e-6,
    max_iterations: int = 2000,
    max_rounds: int = 40,
) -> CoupledSolution:
    """Solve for pressure and tractions of two bodies pressed together, where the tractions change the pressure.

    Parameters
    ----------
    gap : undeformed (nx, ny) [m].
    load, approach, mean_gap, hardness : as for `solve_contact`; exactly one of the first
        three.
    grid, bodies, friction, force, shift, rotation : as for `solve_partial_slip`.
    previous : the previous step, of the same grid and bodies, under any load.
    tolerance : bound on the residual, see `CoupledSolution`.
    max_iterations : limit of each contact and of each partial slip.
    max_rounds : limit of the rounds of contact and slip.

    Raises
    ------
    InputError : arguments out of range, one message for each.
    InfeasibleError : a force that friction cannot carry, a load that the hardness cannot.

    Notes
    -----
    Spence, Proc. R. Soc. A 305 (1968), J. Elasticity 5 (1975); Johnson, *Contact Mechanics* (1985), section 5.4. The
    sticking area depends on how the load grew: for bodies that differ, load them in steps.
    """
    check_settings(rotation, tolerance, max_iterations)
    if not (isinstance(max_rounds, int) and max_rounds >= 1):
        raise InputError(f"max_rounds: {max_rounds!r} must be a whole number >= 1")
    if not (previous is None or isinstance(previous, CoupledSolution)):
        raise InputError(f"previous: {type(previous).__name__} must be a CoupledSolution, or None")
    normal_operator, tangential_map = displacement_operator(grid, bodies), tangential_operator(grid, bodies)
    gap = grid.check_field(gap, "gap")
    displacement = np.zeros(grid.shape) if previous is None else previous.normal_displacement
    pressure = None if previous is None else previous.contact.pressure
    slip: TangentialSolution | None = None
    rounds, convolutions, iterations = 0, 0.0, 0
    while True:
        rounds += 1
        contact = solve_contact(
            gap + displacement,
            normal_operator,
            load=load,
            approach=approach,
            mean_gap=mean_gap,
            hardness=hardness,
            tolerance=_SUBPROBLEM_FRACTION * tolerance,
            initial_pressure=pressure,
            max_iterations=max_iterations,
        )
        pressure = contact.pressure
        step = check_step(
            contact,
            grid,
            bodies,
            friction=friction,
            force=force,
            shift=shift,
            rotation=rotation,
            previous=None if previous is None else previous.tangential,
        )
        slip = solve_step(step, _SUBPROBLEM_FRACTION * tolerance, max_iterations, slip)
        convolutions, iterations = convolutions + slip.convolutions, iterations + slip.iterations
        response = tangential_map.normal_displacement(slip.traction)
        error = _gap_violation(contact, response - displacement, approach_free=approach is None)
        residual = max(contact.residual + error, slip.residual)
        if residual <= tolerance or rounds >= max_rounds:
            break
        displacement = response
    status = Status.CONVERGED if residual <= tolerance else Status.MAX_ITERATIONS
    if Status.CONVERGED not in (contact.status, status):
        status = contact.status
    slip = replace(slip, convolutions=convolutions, iterations=iterations)
    return CoupledSolution(contact, slip, response, rounds, residual, status, (*contact.notes, *slip.notes))


def _gap_violation(contact: ContactSolution, change: FloatArray, *, approach_free: bool) -> float:
    """Return the violation of the contact conditions after a change of the gap, over the largest displacement.

    In contact the gap must not change, except by an approach that is free; elsewhere the surfaces must not overlap.

    change : (nx, ny), change of the gap [m].
    approach_free : True if the approach is unknown (load or mean gap prescribed).
    """
    touches = contact.pressure > 0
    scale = float(np.abs(contact.displacement).max())
    if not touches.any() or not scale > 0:
        return 0.0
    inside = change[touches]
    middle = 0.5 * float(inside.max() + inside.min()) if approach_free else 0.0
    overlap = float((-(contact.gap + change - middle))[~touches].max(initial=0.0))
    return max(float(np.abs(inside - middle).max()), overlap) / scale
