"""Path of loads or approaches that an adhesive contact goes through, and the energy that its jumps lose."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.adhesion.figures import LOWEST_LOAD_TOLERANCE, load_between_steps, passes_pull_off
from bem.adhesion.laws import AdhesionLaw
from bem.adhesion.solve import AdhesiveSolution, solve_adhesive_contact
from bem.convolution import DisplacementOperator
from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.representation import readable

_UNBALANCED = 0.03
"""Work of a step less the change of energy, over the largest force times the step plus that change, above which a step
is searched for a jump."""
_HALVINGS, _MOST_HALVINGS = 6, 9
"""How often a part of a step is halved before it is judged, and where this leaves it open, at most."""
_AROUND = 3
"""A part is compared with the one around it that is halved so many times less, eight times as long."""
_SMOOTH, _JUMP = 0.4, 0.7
"""Change within a part over the changes in the eight times longer part around it, below and above which it is smooth or
a jump; their mean at the most halvings. About 1/8 of a smooth path, more where it is steeper than around; 1 at a
jump."""
_PROBE_TOLERANCE = 1e-4
"""Tolerance of states that are solved to search a step, at least."""
_MOST_SOLVED = 18
"""States solved in the search of one step. A change that is spread over the step leaves all parts wider."""
_LEAST_JUMP = 0.125
"""Smallest jump that is searched for, over all changes within the step."""


@readable
@dataclass(frozen=True)
class AdhesiveHistory:
    """States along a path; arrays (n,) over its steps, SI units.

    Attributes
    ----------
    load : total load [N], negative in tension. approach : [m].
    contact_area : [m^2].
    energy : [J], elastic and adhesive.
    jumped : True for a step in which the contact jumps: more than half of what the load (the approach, under a
        prescribed load) changes up and down in an eighth of the step, it changes in a sixty-fourth.
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

    @property
    def lowest_load_error(self) -> float:
        """Return by how much the load may be lower between two steps of prescribed approaches [N]."""
        return self.lowest_load - float(load_between_steps(self.load, self.approach).min(initial=self.lowest_load))


def follow_path(
    gap: FloatArray,
    operator: DisplacementOperator,
    law: AdhesionLaw,
    *,
    loads: Sequence[float] | None = None,
    approaches: Sequence[float] | None = None,
    hardness: float | None = None,
    tolerance: float = 1e-6,
    refined: bool = False,
    callback: Callable[[int, AdhesiveSolution], object] | None = None,
) -> AdhesiveHistory:
    """Solve an adhesive contact at one load or approach after the other, each from the state before.

    Parameters
    ----------
    gap, operator, law, hardness, tolerance : as in `solve_adhesive_contact`.
    loads, approaches : exactly one of both, [N] or [m], in the order in which they are applied. The path ends where the
        bodies cannot bear a load.
    refined : steps are added about the lowest load of approaches until no lower one, by more than a two-hundredth of
        it, lies between two steps; the arrays of the history then have the added steps too.
    callback : called with the number of the step and its state after each of the given ones.

    Raises
    ------
    InputError : an empty path, neither or both of loads and approaches; what `solve_adhesive_contact` refuses.
    """
    name, path = _path(loads, approaches)

    def solve(value: float, start: AdhesiveSolution | None = None, accuracy: float = tolerance) -> AdhesiveSolution:
        return solve_adhesive_contact(
            gap,
            operator,
            law,
            load=value if name == "load" else None,
            approach=value if name == "approach" else None,
            hardness=hardness,
            tolerance=accuracy,
            start=start,
        )

    states: list[AdhesiveSolution] = []
    for number, value in enumerate(path):
        state = solve(value, states[-1] if states else None)
        if state.status is Status.INFEASIBLE and states:
            break
        states.append(state)
        if callback is not None:
            callback(number, state)
    ended = len(states) < len(path)
    if refined and name == "approach":
        _refine_lowest_load(states, solve)
    failed = [state.status for state in states if state.status is not Status.CONVERGED]

    def probe(value: float, start: AdhesiveSolution) -> AdhesiveSolution:
        return solve(value, start, max(tolerance, _PROBE_TOLERANCE))

    largest = np.maximum.accumulate([abs(state.load) for state in states])
    jumped = [False]
    for before, state, most in zip(states[:-1], states[1:], largest[1:], strict=True):
        moved = name == "load" or abs(state.load - before.load) > _UNSEEN * most
        jumped.append(moved and _jumps(probe, _Part(name, before, state)))
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


_UNSEEN = 0.05
"""Change of the load over the largest of the path so far below which a step of the approach is not searched for a jump:
cells that open or close one after the other change it by up to 4 % where the adhesive zone has 2.5 of them."""

_MOST_ADDED = 12
"""Steps that are added about the lowest load at most; four to eight are usual."""


def _refine_lowest_load(
    states: list[AdhesiveSolution], solve: Callable[[float, AdhesiveSolution], AdhesiveSolution]
) -> None:
    """Add states to a path of approaches until none of its steps may pass a much lower load than the lowest one.

    Each halves a step, and starts from the state before: one beside the lowest load first, then any other.
    """
    for _ in range(_MOST_ADDED):
        load = np.array([state.load for state in states])
        approach = np.array([state.contact.approach for state in states])
        between, lowest = load_between_steps(load, approach), int(load.argmin())
        lower = np.flatnonzero(between < load[lowest] - LOWEST_LOAD_TOLERANCE * abs(load[lowest]))
        if not lower.size:
            return
        beside = lower[(lower == lowest) | (lower == lowest - 1)]
        step = min(beside if beside.size else lower, key=lambda one: between[one])
        states.insert(step + 1, solve(0.5 * (approach[step] + approach[step + 1]), states[step]))


@dataclass(frozen=True, eq=False)
class _Part:
    """Part of a step between two states.

    name : prescribed quantity, load or approach.
    place : halves that lead to it from the whole step, 0 for the first half and 1 for the second.
    """

    name: str
    before: AdhesiveSolution
    after: AdhesiveSolution
    place: tuple[int, ...] = ()

    @property
    def change(self) -> float:
        """Return the change of the load, or of the approach under a prescribed load, without its sign."""
        load, approach = self.after.load - self.before.load, self.after.contact.approach - self.before.contact.approach
        return abs(approach if self.name == "load" else load)

    @property
    def middle(self) -> float:
        """Return the prescribed quantity in the middle."""
        if self.name == "load":
            return 0.5 * (self.before.load + self.after.load)
        return 0.5 * (self.before.contact.approach + self.after.contact.approach)

    @property
    def smooth(self) -> bool:
        """Return True if work and change of energy agree, and the contact neither begins nor ends."""
        if (self.before.contact.contact_area > 0) != (self.after.contact.contact_area > 0):
            return False
        moved, gained = (
            self.after.contact.approach - self.before.contact.approach,
            self.after.energy - self.before.energy,
        )
        work = 0.5 * (self.before.load + self.after.load) * moved
        scale = max(abs(self.before.load), abs(self.after.load)) * abs(moved) + abs(gained)
        return abs(work - gained) <= _UNBALANCED * scale

    def halves(self, middle: AdhesiveSolution) -> list[_Part]:
        """Return both halves."""
        first = _Part(self.name, self.before, middle, (*self.place, 0))
        return [first, _Part(self.name, middle, self.after, (*self.place, 1))]


def _jumps(solve: Callable[[float, AdhesiveSolution], AdhesiveSolution], whole: _Part) -> bool:
    """Return True if the contact jumps in a step: some of its change does not shrink with the part that it happens in.

    Of the parts that are not smooth, the one that changes most is halved again and again. A load that turns within the
    step counts with its changes up and down, and shrinks as the part does.
    """
    parts = [whole]
    while not all(part.smooth for part in parts):
        most = max((part for part in parts if not part.smooth), key=lambda part: part.change)
        if most.change < _LEAST_JUMP * sum(part.change for part in parts) or len(parts) > _MOST_SOLVED:
            return False
        halvings = len(most.place)
        if halvings >= _HALVINGS:
            around = most.place[:-_AROUND]
            left = most.change / sum(part.change for part in parts if part.place[: len(around)] == around)
            if not _SMOOTH < left < _JUMP or halvings == _MOST_HALVINGS:
                return left > 0.5 * (_SMOOTH + _JUMP)
        parts.remove(most)
        parts += most.halves(solve(most.middle, most.before))
    return False


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
