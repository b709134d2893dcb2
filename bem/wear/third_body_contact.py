"""The contact of a cycle with particles between the surfaces: contact and particles share the load.

Verified in tests/wear/test_third_bodies.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Protocol, runtime_checkable

import numpy as np

from bem.contact import ContactSolution, solve_contact
from bem.convolution import displacement_operator
from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.numerics.bracketed_root import find_decreasing_root
from bem.wear.cycle import ContactOutcome, ContactStep, dry_contact, outcome_of
from bem.wear.setup import LOWER, UPPER, WearSetup
from bem.wear.third_bodies import ThirdBodies, ThirdBodyLoad

BALANCE = 1e-6
"""Of the load: what contact and particles may miss it by."""
MET = 0.3 * BALANCE
_TRIALS = 60


def third_body_contact(
    setup: WearSetup, particles: ThirdBodies, slide: float, *, tolerance: float = 1e-6, compliance: float = 0.0
) -> ContactStep:
    """As `dry_contact`, with particles that share the load; slide : of the bodies in a cycle [m].

    Raises
    ------
    InputError : a surface without hardness; a slide in which particles cut deeper than they lie.
    """
    hardnesses = particles.hardnesses(setup.bodies)
    particles.check_slide(slide, hardnesses)
    if particles.number_per_area == 0:
        return dry_contact(setup, tolerance=tolerance, compliance=compliance)
    operator = displacement_operator(setup.grid, setup.bodies, friction=setup.friction, compliance=compliance)

    def step(heights: FloatArray, last_pressure: FloatArray | None) -> ContactOutcome:
        undeformed = setup.gap - heights

        def solve(*, load: float | None = None, approach: float | None = None) -> ContactSolution:
            return solve_contact(
                undeformed,
                operator,
                load=load,
                approach=approach,
                hardness=setup.hardness,
                tolerance=tolerance,
                initial_pressure=sharing.tried[-1].pressure if sharing.tried else last_pressure,
            )

        def carried(gap: FloatArray) -> float:
            return particles.carried(gap, hardnesses, setup.grid.cell_area)

        sharing = BodiesAndContact(setup.load, carried, undeformed, solve)
        last = sharing.found()
        convolutions = sum(contact.convolutions for contact in sharing.tried)
        depths, load = particles.indented(last.gap, hardnesses)[1], carried(last.gap)
        cut = tuple(particles.cut(depths[body], hardnesses[body], slide) for body in (LOWER, UPPER))
        found = replace(outcome_of(last, setup, operator), convolutions=convolutions)
        missing = abs(found.load + load - setup.load) / setup.load
        if missing > BALANCE and found.status is Status.CONVERGED:
            found = replace(found, status=Status.STALLED, residual=missing)
        told = ThirdBodyLoad(load, (cut[LOWER], cut[UPPER]), particles.number_per_area)
        return replace(found, third_bodies=told)

    return step


def steps_with_bodies(
    setup: WearSetup, slide: float, contact_step: ContactStep | None, compliance: float
) -> Callable[[ThirdBodies], ContactStep]:
    """Contact steps by the particles that there are: dry ones, or those of a contact that takes particles
    (`bem.wear.mixed.MixedContact`).

    Raises
    ------
    InputError : a contact step that takes none.
    """
    if contact_step is None:
        return lambda particles: third_body_contact(setup, particles, slide, compliance=compliance)
    if not isinstance(contact_step, TakesBodies):
        raise InputError(
            "third bodies share the load of dry contacts and of a MixedContact; allowed: one of these, or no third "
            "bodies"
        )
    taking = contact_step
    return lambda particles: taking.bearing(particles, slide)


@runtime_checkable
class TakesBodies(Protocol):
    """A contact step between whose surfaces there may be particles."""

    def bearing(self, particles: ThirdBodies, slide: float) -> ContactStep:
        """The step with particles; slide : of the bodies in a cycle [m]."""


@dataclass(frozen=True, eq=False)
class BodiesAndContact:
    """One search for how contact and particles share a load [N].

    carried : load [N] of the particles in gaps (nx, ny) [m]. undeformed : gap (nx, ny) [m]. solve : the contact under a
    load [N] or at an approach [m], by name. goal : what may be missed, over the load. tried : contacts so far.
    """

    load: float
    carried: Callable[[FloatArray], float]
    undeformed: FloatArray
    solve: Callable[..., ContactSolution]
    goal: float = MET
    tried: list[ContactSolution] = field(default_factory=list)

    def found(self) -> ContactSolution:
        """The contact with which both carry the load; one that touches nowhere where the particles carry all."""
        touching = float(self.undeformed.min())
        if 1 - self.carried(self.undeformed - touching) / self.load <= self.goal:
            self.tried.append(self.solve(approach=touching - self._apart(touching)))
        else:
            self._balance(touching)
        return self.tried[-1]

    def _apart(self, touching: float) -> float:
        """How far particles hold the bodies apart beyond their touching [m]."""
        from scipy.optimize import brentq  # a fifth of a second to load, and most loops have no third bodies

        def beyond(away: float) -> float:
            return self.carried(self.undeformed - touching + away) - self.load

        if beyond(0.0) <= 0:
            return 0.0
        far = float(np.ptp(self.undeformed)) + 1e-12
        while beyond(far) > 0:
            far *= 2
        return float(brentq(beyond, 0.0, far, xtol=1e-18))

    def _missing(self, contact: ContactSolution) -> tuple[float, bool]:
        """What is not carried with a contact, over the load; and whether that is nothing."""
        self.tried.append(contact)
        missing = 1 - (contact.load + self.carried(contact.gap)) / self.load
        return missing, abs(missing) <= self.goal

    def _balance(self, touching: float) -> None:
        """Search over the contact's load; where the gap jumps with it, cells at the hardness sinking under one load
        until the next ones touch, over the approach in between."""
        sides: dict[bool, tuple[float, ContactSolution]] = {}

        def under(share: float) -> tuple[float, bool]:
            if share == 0:
                return 1 - self.carried(self.undeformed - touching) / self.load, False
            missing, met = self._missing(self.solve(load=share * self.load))
            sides[missing > 0] = share, self.tried[-1]
            return missing, met or jumps()

        def jumps() -> bool:
            return len(sides) == 2 and sides[False][0] - sides[True][0] <= 0.3 * self.goal

        find_decreasing_root(under, 1.0, 1.0, (0.0, 1.0), _TRIALS)
        if not jumps():
            return
        (_, far), (_, near) = sides[True], sides[False]

        def pressed(place: float) -> tuple[float, bool]:
            return self._missing(self.solve(approach=far.approach + place * (near.approach - far.approach)))

        find_decreasing_root(pressed, 0.5, 1.0, (0.0, 1.0), _TRIALS)
