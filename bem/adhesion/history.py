"""Path of loads or approaches that an adhesive contact goes through, and the energy that its jumps lose."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.adhesion.figures import passes_pull_off
from bem.adhesion.laws import AdhesionLaw
from bem.adhesion.solve import AdhesiveSolution, solve_adhesive_contact
from bem.convolution import DisplacementOperator
from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.representation import readable

_UNBALANCED = 0.03
"""Work of a step less the change of energy, over both, above which a step is looked at for a jump."""
_HALVINGS = 4
"""How often a step is halved in the search for a jump."""
_LEFT = 0.5
"""Part of a step's change that a sixteenth of the step has where the contact jumps: without a jump it is about 1/16."""


@readable
@dataclass(frozen=True)
class AdhesiveHistory:
    """States along a path; arrays (n,) over its steps, SI units.

    Attributes
    ----------
    load : total load [N], negative in tension. approach : [m].
    contact_area : [m^2].
    energy : [J], elastic and adhesive.
    jumped : True for a step in which the contact jumps: half of the change of the load (of the approach, under a
        prescribed load) happens within a sixteenth of the step.
    last, lowest : states at the end and at the lowest load.
    status : the first one that is not converged, else converged.
    """

    load: FloatArray
    approach: FloatArray
    contact_area: FloatArray
    energy: FloatArray
    jumped: NDArray[np.bool_]
    last: AdhesiveSolution
    lowest: AdhesiveSolution
    status: Status

    @property
    def lowest_load(self) -> float:
        """Return the lowest load of the path [N]: minus the pull-off force, where the path passes it."""
        return float(self.load.min())

    @property
    def passes_pull_off(self) -> bool:
        """Return True if the lowest load of the path is minus the pull-off force; see `bem.adhesion.figures`."""
        return passes_pull_off(self.load, self.approach, self.contact_area)


def follow_path(
    gap: FloatArray,
    operator: DisplacementOperator,
    law: AdhesionLaw,
    *,
    loads: Sequence[float] | None = None,
    approaches: Sequence[float] | None = None,
    hardness: float | None = None,
    tolerance: float = 1e-6,
    callback: Callable[[int, AdhesiveSolution], object] | None = None,
) -> AdhesiveHistory:
    """Solve an adhesive contact at one load or approach after the other, each from the state before.

    Parameters
    ----------
    gap, operator, law, hardness, tolerance : as in `solve_adhesive_contact`.
    loads, approaches : exactly one of both, [N] or [m], in the order in which they are applied. The path ends where the
        bodies cannot bear a load.
    callback : called with the number of the step and its state after each.

    Raises
    ------
    InputError : an empty path, neither or both of loads and approaches; what `solve_adhesive_contact` refuses.
    """
    name, path = _path(loads, approaches)

    def solve(value: float, start: AdhesiveSolution | None = None) -> AdhesiveSolution:
        return solve_adhesive_contact(
            gap,
            operator,
            law,
            load=value if name == "load" else None,
            approach=value if name == "approach" else None,
            hardness=hardness,
            tolerance=tolerance,
            start=start,
        )

    states: list[AdhesiveSolution] = []
    jumped = []
    for number, value in enumerate(path):
        state = solve(value, states[-1] if states else None)
        if state.status is Status.INFEASIBLE and states:
            break
        largest = max((abs(one.load) for one in states), default=0.0)
        moved = bool(states) and (name == "load" or abs(state.load - states[-1].load) > _UNSEEN * largest)
        jumped.append(moved and _jumps(solve, name, (path[number - 1], value), (states[-1], state)))
        states.append(state)
        if callback is not None:
            callback(number, state)
    failed = [state.status for state in states if state.status is not Status.CONVERGED]
    ended = len(states) < len(path)
    return AdhesiveHistory(
        load=np.array([state.load for state in states]),
        approach=np.array([state.contact.approach for state in states]),
        contact_area=np.array([state.contact.contact_area for state in states]),
        energy=np.array([state.energy for state in states]),
        jumped=np.array(jumped),
        last=states[-1],
        lowest=min(states, key=lambda state: state.load),
        status=failed[0] if failed else Status.INFEASIBLE if ended else Status.CONVERGED,
    )


_UNSEEN = 1e-5
"""Change of the load over the largest of the path below which a step of the approach is no jump: apart, the residual
of the solver is as large."""


def _imbalance(before: AdhesiveSolution, after: AdhesiveSolution) -> float:
    """Return the work of a step, by the trapezoidal rule, less the change of energy, over both."""
    work = 0.5 * (before.load + after.load) * (after.contact.approach - before.contact.approach)
    gained = after.energy - before.energy
    scale = abs(work) + abs(gained)
    return abs(work - gained) / scale if scale > 0 else 0.0


def _jumps(
    solve: Callable[[float, AdhesiveSolution], AdhesiveSolution],
    name: str,
    values: tuple[float, float],
    states: tuple[AdhesiveSolution, AdhesiveSolution],
) -> bool:
    """Return True if the contact jumps in a step between two values of the prescribed quantity.

    The step is halved, each time within the half that changes more. Steps that balance work and energy, and neither
    begin nor end the contact, are not looked at.
    """
    (first, last), (before, after) = values, states
    touched = before.contact.contact_area > 0, after.contact.contact_area > 0
    if touched[0] == touched[1] and _imbalance(before, after) <= _UNBALANCED:
        return False

    def followed(state: AdhesiveSolution) -> float:
        return state.contact.approach if name == "load" else state.load

    whole = abs(followed(after) - followed(before))
    for _ in range(_HALVINGS):
        middle = 0.5 * (first + last)
        between = solve(middle, before)
        if abs(followed(between) - followed(before)) >= abs(followed(after) - followed(between)):
            last, after = middle, between
        else:
            first, before = middle, between
    return abs(followed(after) - followed(before)) > _LEFT * whole


def _path(loads: Sequence[float] | None, approaches: Sequence[float] | None) -> tuple[str, list[float]]:
    """Return the name of the prescribed quantity and its values.

    Raises
    ------
    InputError : an empty path, neither or both of loads and approaches.
    """
    given = [(name, values) for name, values in (("load", loads), ("approach", approaches)) if values is not None]
    if len(given) != 1 or len(given[0][1]) == 0:
        raise InputError("follow_path: give exactly one of loads and approaches, with at least one value")
    return given[0][0], [float(value) for value in given[0][1]]
