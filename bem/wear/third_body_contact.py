"""The contact of a cycle with particles between the surfaces: contact and particles share the load.

Verified in tests/wear/test_third_bodies.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from scipy.optimize import brentq

from bem.contact import ContactSolution, solve_contact
from bem.convolution import displacement_operator
from bem.errors import Status
from bem.friction.falling_zero import falling_zero
from bem.grid import FloatArray
from bem.wear.cycle import ContactOutcome, ContactStep, WearSetup, dry_contact, outcome_of
from bem.wear.loads import LOWER, UPPER
from bem.wear.third_bodies import ThirdBodies, ThirdBodyLoad

BALANCE = 1e-6
"""Of the load: what contact and particles may miss it by."""
_MET = 0.3 * BALANCE
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

        sharing = _Sharing(setup, particles, hardnesses, undeformed - undeformed.min(), solve)
        found, gap = sharing.found()
        depths, load = particles.indented(gap, hardnesses)[1], sharing.carried(gap)
        cut = tuple(particles.cut(depths[body], hardnesses[body], slide) for body in (LOWER, UPPER))
        missing = abs(found.load + load - setup.load) / setup.load
        if missing > BALANCE and found.status is Status.CONVERGED:
            found = replace(found, status=Status.STALLED, residual=missing)
        return replace(found, third_bodies=ThirdBodyLoad(load, (cut[LOWER], cut[UPPER])))

    return step


@dataclass(frozen=True, eq=False)
class _Sharing:
    """One search. open_gap : (nx, ny) [m], of bodies that just touch. solve : the contact under a load [N] or at an
    approach [m], by name. tried : contacts so far."""

    setup: WearSetup
    particles: ThirdBodies
    hardnesses: tuple[float, float]
    open_gap: FloatArray
    solve: Callable[..., ContactSolution]
    tried: list[ContactSolution] = field(default_factory=list)

    def carried(self, gap: FloatArray) -> float:
        """Load [N] of the particles in gaps (nx, ny) [m]."""
        force, _ = self.particles.indented(gap, self.hardnesses)
        return self.particles.number_per_area * float(force.sum()) * self.setup.grid.cell_area

    def found(self) -> tuple[ContactOutcome, FloatArray]:
        """The contact and the gap (nx, ny) [m] with which both carry the load."""
        setup = self.setup
        if 1 - self.carried(self.open_gap) / setup.load <= _MET:
            nothing = np.zeros(setup.grid.shape)
            contact = ContactOutcome(nothing, 0.0, 0.0, 0.0, setup.friction, 0.0, 0.0, Status.CONVERGED)
            return contact, self.open_gap + self._apart()
        self._balance()
        last, convolutions = self.tried[-1], sum(contact.convolutions for contact in self.tried)
        return replace(outcome_of(last, setup), convolutions=convolutions), last.gap

    def _apart(self) -> float:
        """How far particles hold the bodies apart beyond their touching [m]."""
        diameter = self.particles.diameter

        def beyond(away: float) -> float:
            return self.carried(self.open_gap + away) - self.setup.load

        return float(brentq(beyond, 0.0, diameter, xtol=1e-15 * diameter)) if beyond(0.0) > 0 else 0.0

    def _missing(self, contact: ContactSolution) -> tuple[float, bool]:
        """What is not carried with a contact, over the load; and whether that is nothing."""
        self.tried.append(contact)
        missing = 1 - (contact.load + self.carried(contact.gap)) / self.setup.load
        return missing, abs(missing) <= _MET

    def _balance(self) -> None:
        """Search over the contact's load; where the gap jumps with it, cells at the hardness sinking under one load
        until the next ones touch, over the approach in between."""
        sides: dict[bool, tuple[float, ContactSolution]] = {}

        def under(share: float) -> tuple[float, bool]:
            if share == 0:
                return 1 - self.carried(self.open_gap) / self.setup.load, False
            missing, met = self._missing(self.solve(load=share * self.setup.load))
            sides[missing > 0] = share, self.tried[-1]
            return missing, met or jumps()

        def jumps() -> bool:
            return len(sides) == 2 and sides[False][0] - sides[True][0] <= 0.3 * _MET

        falling_zero(under, 1.0, 1.0, (0.0, 1.0), _TRIALS)
        if not jumps():
            return
        (_, far), (_, near) = sides[True], sides[False]

        def pressed(place: float) -> tuple[float, bool]:
            return self._missing(self.solve(approach=far.approach + place * (near.approach - far.approach)))

        falling_zero(pressed, 0.5, 1.0, (0.0, 1.0), _TRIALS)
