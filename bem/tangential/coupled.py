"""Contact and partial slip together: of bodies that differ tractions lift the surfaces, and the pressure answers.

By turns: the contact under the gap that the last tractions leave, then stick and slip under its pressure. Each answers
the other by the bodies' mismatch (Dundurs' beta, at most 1/2) times as much, so that it closes in by a factor of two
to ten a round. What is judged is the pair at the end: the contact once more under the gap that its own tractions make.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bem.contact import ContactSolution, solve_contact
from bem.convolution import displacement_operator
from bem.errors import InputError, Status
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.representation import readable
from bem.tangential.solution import TangentialSolution
from bem.tangential.solve import check_numbers, checked, solve_step, tangential_operator
from bem.threads import one_blas_thread

_INNER = 0.1
"""Share of the tolerance that the contact and the slip of a round are solved to."""


@readable
@dataclass(frozen=True)
class CoupledSolution:
    """A contact and its tractions, each under the other.

    Attributes
    ----------
    contact : its gap has what the tractions move, its displacement is that of the pressure alone.
    tangential : stick and slip under its pressure; its convolutions and iterations are those of all rounds.
    normal_displacement : (nx, ny) [m], by which the tractions press the surfaces apart, both together.
    rounds : of contact and slip by turns.
    residual : the largest of both residuals, and of how far the contact misses its gap under the tractions at the end,
        over its largest displacement.
    status : outcome; `residual` is at most the tolerance if it is converged.
    notes : of both.
    """

    contact: ContactSolution
    tangential: TangentialSolution
    normal_displacement: FloatArray
    rounds: int
    residual: float
    status: Status
    notes: tuple[str, ...] = ()


@one_blas_thread
def solve_coupled_slip(
    gap: FloatArray,
    grid: Grid,
    bodies: Body | tuple[Body, Body],
    *,
    friction: float | FloatArray,
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
    """Two bodies pressed together and pushed along, where the tractions change the pressure.

    Parameters
    ----------
    gap : undeformed (nx, ny) [m].
    load, approach, mean_gap, hardness : as for `solve_contact`; exactly one of the first
        three.
    grid, bodies, friction, force, shift, rotation : as for `solve_partial_slip`.
    previous : the step before, of the same grid and bodies, under any load.
    tolerance : bound on the residual, see `CoupledSolution`.
    max_iterations : limit of each contact and of each partial slip.
    max_rounds : of both by turns.

    Raises
    ------
    InputError : arguments out of range, one message for each.
    InfeasibleError : a force that friction cannot carry, a load that the hardness cannot.

    Notes
    -----
    Spence, Proc. R. Soc. A 305 (1968), J. Elasticity 5 (1975); Johnson, *Contact Mechanics* (1985), section 5.4. Stick
    hangs on how the load grew: of bodies that differ it should come in steps.
    """
    check_numbers(rotation, tolerance, max_iterations)
    if not (isinstance(max_rounds, int) and max_rounds >= 1):
        raise InputError(f"max_rounds: {max_rounds!r} must be a whole number >= 1")
    if not (previous is None or isinstance(previous, CoupledSolution)):
        raise InputError(f"previous: {type(previous).__name__} must be a CoupledSolution, or None")
    operator, tangential = displacement_operator(grid, bodies), tangential_operator(grid, bodies)
    gap = grid.check_field(gap, "gap")
    inner: dict[str, Any] = {"tolerance": _INNER * tolerance, "max_iterations": max_iterations}
    asked: dict[str, Any] = {"load": load, "approach": approach, "mean_gap": mean_gap, "hardness": hardness}
    before = None if previous is None else previous.tangential
    moved = np.zeros(grid.shape) if previous is None else previous.normal_displacement
    pressure = None if previous is None else previous.contact.pressure
    near: TangentialSolution | None = None
    rounds, convolutions, iterations = 0, 0.0, 0
    while True:
        rounds += 1
        contact = solve_contact(gap + moved, operator, initial_pressure=pressure, **asked, **inner)
        pressure = contact.pressure
        request = checked(contact, grid, bodies, friction=friction, force=force, shift=shift, previous=before)
        near = solve_step(request, rotation, before, _INNER * tolerance, max_iterations, near)
        convolutions, iterations = convolutions + near.convolutions, iterations + near.iterations
        answer = tangential.normal_displacement(near.traction)
        missed = _missed(contact, answer - moved, free=approach is None)
        residual = max(contact.residual + missed, near.residual)
        if residual <= tolerance or rounds >= max_rounds:
            break
        moved = answer
    status = Status.CONVERGED if residual <= tolerance else Status.MAX_ITERATIONS
    if Status.CONVERGED not in (contact.status, status):
        status = contact.status
    near = replace(near, convolutions=convolutions, iterations=iterations)
    return CoupledSolution(contact, near, answer, rounds, residual, status, (*contact.notes, *near.notes))


def _missed(contact: ContactSolution, change: FloatArray, *, free: bool) -> float:
    """How far a contact is off where its gap changes by that much (nx, ny) [m], over its largest displacement; the
    bodies may move together where they are `free` to.
    """
    touches = contact.pressure > 0
    reach = float(np.abs(contact.displacement).max())
    if not touches.any() or not reach > 0:
        return 0.0
    inside = change[touches]
    middle = 0.5 * float(inside.max() + inside.min()) if free else 0.0
    overlap = float((-(contact.gap + change - middle))[~touches].max(initial=0.0))
    return max(float(np.abs(inside - middle).max()), overlap) / reach
