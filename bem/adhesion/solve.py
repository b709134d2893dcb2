"""One state of an adhesive contact: the bounded contact of `bem.contact` inside a fixed point of the attraction.

The total traction is p - s(g): a contact pressure p >= 0 where the bodies touch, less the attraction at the gap g. For
a *given* field of attraction a, the rest is a contact without adhesion of bodies whose undeformed gap is less by K a, K
being the displacement operator. The state with a = s(g) is a fixed point:

1. Begin with the attraction of the state before, in a history, or without any.
2. Subtract K a from the undeformed gap and solve the contact (`solve_contact`) at the prescribed approach, or under the
   prescribed load plus the force of a.
3. Compare a with s(g); the residual is the largest difference over the strength of the law, and over the highest
   attraction where the bodies do not touch. End if it is small enough. The attraction of bodies apart is zero where
   s(g) is below the tolerance times the strength.
4. Replace a by s(g), or by its extrapolation from the last states (`_Extrapolation`); go on with 2.

Bodies come closer where they attract each other more, and attract each other more where they are closer. The plain
replacement in 4 therefore rises from too weak an attraction to the next state above, and falls from too strong a one to
the next state below. It converges where the compliance of the bodies times the slope of s, with the touching cells
held, has a spectral radius below one, which is the condition that the state is stable under the prescribed quantity. At
an instability it leaves the state that vanishes and follows the jump. Extrapolation, which may hover about a state that
is no longer there, is suspended while it does not pay.

Cost: a contact a step, started from the one before: some ten convolutions. Six to ten steps where the attraction acts
far (Tabor parameter below one), some thirty at a Tabor parameter of three, hundreds in a jump.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from bem.adhesion.laws import AdhesionLaw
from bem.arguments import is_finite, is_positive
from bem.contact import ContactSolution, solve_contact
from bem.convolution import DisplacementOperator
from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.representation import readable

Callback = Callable[[int, float], object]

_DEPTH = 6
"""States that an extrapolation uses."""
_PATIENCE, _PLAIN = 8, 12
"""Steps without a new least residual after which extrapolation is suspended, and for how many steps."""
_SHARE = 0.1
"""Error of the gap that the contact may leave, over that which the tolerance of the attraction allows."""


@readable
@dataclass(frozen=True)
class AdhesiveSolution:
    """State of an adhesive contact; arrays (nx, ny), SI units.

    Attributes
    ----------
    contact : pressure, gap and approach, with the displacement by both pressure and attraction in the gap; its `load`
        and `displacement` are those of the pressure alone.
    attraction : [Pa], traction that pulls the bodies together.
    load : [N], of the pressure less the attraction; negative in tension.
    energy : [J], elastic and adhesive; zero for bodies far apart.
    steps : contacts that were solved. convolutions : applications of the operator in all of them.
    residual : largest difference of the attraction and the law at the gap, over the strength of the law; of bodies
        apart, over the highest attraction. Attraction below the tolerance times the strength is zero there.
    status : converged if the residual is at most the tolerance and the contact converged; infeasible where the bodies
        cannot bear the load that pulls them.
    """

    contact: ContactSolution
    attraction: FloatArray
    load: float
    energy: float
    steps: int
    convolutions: float
    residual: float
    status: Status

    @property
    def traction(self) -> FloatArray:
        """Return the total traction on the surfaces [Pa], positive where they are pressed together."""
        return self.contact.pressure - self.attraction


def solve_adhesive_contact(
    gap: FloatArray,
    operator: DisplacementOperator,
    law: AdhesionLaw,
    *,
    load: float | None = None,
    approach: float | None = None,
    hardness: float | None = None,
    tolerance: float = 1e-6,
    start: AdhesiveSolution | None = None,
    max_steps: int = 3000,
    callback: Callback | None = None,
) -> AdhesiveSolution:
    """Solve for pressure and attraction between two bodies that adhere.

    Parameters
    ----------
    gap : (nx, ny), undeformed gap of the two surfaces [m].
    operator : from `displacement_operator`, without friction.
    law : of the attraction.
    load, approach : exactly one of the total load [N], negative if it pulls, and the approach [m], negative for bodies
        that stand apart; on a doubly periodic grid the approach is that of the means of the surfaces.
    hardness : cap on the contact pressure [Pa]; None for purely elastic.
    tolerance : of the residual, see `AdhesiveSolution`.
    start : state before, in a history; without one the bodies come from far apart.
    max_steps : largest number of contacts that are solved.
    callback : called with the number of contacts and the residual after each.

    Notes
    -----
    Several states may belong to one load or approach. The one that is found is the next above the attraction of the
    start, if that is too weak, or the next below it, if it is too strong: approach and retraction differ.

    Raises
    ------
    InputError : arguments out of range, one message for each; what `solve_contact` refuses.
    """
    _check_arguments(operator, law, load, approach, tolerance, start)
    before = operator.count.weighted
    accuracy = _contact_tolerance(gap, law, tolerance)
    attraction = np.zeros(operator.grid.shape) if start is None else start.attraction
    pressure = None if start is None else start.contact.pressure
    extrapolation = _Extrapolation(law.strength)
    steps = 0
    while True:
        pull = float(attraction.sum()) * operator.grid.cell_area
        # under tension beyond the attraction the bodies part: there is no contact that carries less than nothing
        holds = load is None or load + pull >= 0
        contact = solve_contact(
            gap - operator(attraction) if attraction.any() else gap,
            operator,
            load=None if load is None else max(load + pull, 0.0),
            approach=approach,
            hardness=hardness,
            tolerance=accuracy,
            initial_pressure=pressure,
        )
        pressure, steps = contact.pressure, steps + 1
        wanted = law.traction(contact.gap, operator.grid)
        apart = not contact.pressure.any()
        highest = float(wanted.max())
        none = apart and highest <= tolerance * law.strength
        scale = highest if apart and not none else law.strength
        residual = float(np.max(np.abs(wanted - attraction))) / scale
        if callback is not None:
            callback(steps, residual)
        if not holds and not extrapolation.suspend():
            status = Status.INFEASIBLE
            break
        if none and attraction.any() and steps < max_steps:
            attraction = np.zeros_like(attraction)
            continue
        if holds and (residual <= tolerance or steps == max_steps):
            status = Status.CONVERGED if residual <= tolerance else Status.MAX_ITERATIONS
            status = status if contact.status is Status.CONVERGED else contact.status
            break
        attraction = extrapolation.next(attraction, wanted, residual) if holds else extrapolation.plain
    return AdhesiveSolution(
        contact=contact,
        attraction=attraction,
        load=contact.load - float(attraction.sum()) * operator.grid.cell_area,
        energy=_energy(contact, attraction, operator, law),
        steps=steps,
        convolutions=operator.count.weighted - before,
        residual=residual,
        status=status,
    )


@dataclass
class _Extrapolation:
    """Next attraction from the last ones: Anderson's extrapolation (1965), or the plain replacement while that is safe.

    strength : highest traction [Pa]; extrapolated ones are limited to it.
    """

    strength: float
    states: list[FloatArray] = field(default_factory=list)
    changes: list[FloatArray] = field(default_factory=list)
    least: float = math.inf
    worse: int = 0
    plain_left: int = 0
    plain: FloatArray = field(default_factory=lambda: np.zeros((0, 0)))

    def next(self, attraction: FloatArray, wanted: FloatArray, residual: float) -> FloatArray:
        """Return the next attraction from one and the law's at its gap."""
        self.plain = wanted
        self.worse = 0 if residual < self.least else self.worse + 1
        self.least = min(self.least, residual)
        if self.worse >= _PATIENCE:
            self.suspend()
        if self.plain_left > 0:
            self.plain_left -= 1
            if self.plain_left == 0:
                self.least = math.inf  # the state may be another one after a jump
            return wanted
        self.states = [*self.states[-_DEPTH + 1 :], attraction.ravel()]
        self.changes = [*self.changes[-_DEPTH + 1 :], (wanted - attraction).ravel()]
        if len(self.states) == 1:
            return wanted
        change = np.diff(self.changes, axis=0).T
        moved = np.diff(self.states, axis=0).T
        weights = np.linalg.lstsq(change, self.changes[-1], rcond=1e-10)[0]
        found = wanted.ravel() - (moved + change) @ weights
        return np.asarray(np.clip(found, 0.0, self.strength).reshape(wanted.shape))

    def suspend(self) -> bool:
        """Go on with plain steps for a while; return False if they already are or nothing was extrapolated."""
        if self.plain_left > 0 or not self.states:
            return False
        self.plain_left, self.worse = _PLAIN, 0
        self.states, self.changes = [], []
        return True


def _contact_tolerance(gap: FloatArray, law: AdhesionLaw, tolerance: float) -> float:
    """Return the tolerance of the contacts: over the rms gap, what the attraction's tolerance allows of its range."""
    spread = float(np.std(gap))
    if not spread > 0:
        return 1e-8
    return float(np.clip(_SHARE * tolerance * law.range / spread, 1e-13, 1e-8))


def _energy(
    contact: ContactSolution, attraction: FloatArray, operator: DisplacementOperator, law: AdhesionLaw
) -> float:
    """Return elastic energy, half the traction times its displacement, and that of adhesion [J]."""
    traction = contact.pressure - attraction
    elastic = 0.5 * float(np.sum(traction * operator(traction)))
    adhesive = float(np.sum(law.energy(contact.gap, operator.grid)))
    return (elastic + adhesive) * operator.grid.cell_area


def _check_arguments(
    operator: DisplacementOperator,
    law: AdhesionLaw,
    load: float | None,
    approach: float | None,
    tolerance: float,
    start: AdhesiveSolution | None,
) -> None:
    """Check what `solve_contact` does not.

    Raises
    ------
    InputError : one message for each mistake.
    """
    if not isinstance(operator, DisplacementOperator):
        raise InputError(f"solve_adhesive_contact: operator {operator!r} must come from displacement_operator")
    messages = []
    if not isinstance(law, AdhesionLaw):
        messages.append(f"solve_adhesive_contact: law {law!r} must be an AdhesionLaw")
    if not operator.symmetric:
        messages.append("solve_adhesive_contact: the operator must be without friction")
    given = {name: value for name, value in (("load", load), ("approach", approach)) if value is not None}
    if len(given) != 1:
        messages.append("solve_adhesive_contact: give exactly one of load and approach")
    messages += [
        f"solve_adhesive_contact: {name} {value!r} must be finite"
        for name, value in given.items()
        if not is_finite(value)
    ]
    if not is_positive(tolerance):
        messages.append(f"solve_adhesive_contact: tolerance {tolerance!r} must be positive")
    if start is not None and start.attraction.shape != operator.grid.shape:
        messages.append(
            f"solve_adhesive_contact: start of shape {start.attraction.shape} is not of {operator.grid.shape}"
        )
    if messages:
        raise InputError(messages)
