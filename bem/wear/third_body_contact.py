"""The contact of a cycle with particles between the surfaces: contact and particles share the load.

Verified in tests/wear/test_third_bodies.py.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bem.contact import ContactSolution, solve_contact
from bem.convolution import displacement_operator
from bem.errors import Status
from bem.grid import FloatArray
from bem.wear.cycle import ContactOutcome, ContactStep, WearSetup, dry_contact, outcome_of
from bem.wear.loads import LOWER, UPPER
from bem.wear.third_bodies import BALANCE, ThirdBodies, ThirdBodyLoad, share


def third_body_contact(
    setup: WearSetup, particles: ThirdBodies, slide: float, *, tolerance: float = 1e-6, compliance: float = 0.0
) -> ContactStep:
    """As `dry_contact`, with particles that share the load; slide : of the bodies in a cycle [m].

    Raises
    ------
    InputError : a surface without hardness.
    """
    hardnesses = particles.hardnesses(setup.bodies)
    if particles.number_per_area == 0:
        return dry_contact(setup, tolerance=tolerance, compliance=compliance)
    operator = displacement_operator(setup.grid, setup.bodies, friction=setup.friction, compliance=compliance)

    def carried(gap: FloatArray) -> float:
        return particles.number_per_area * float(particles.indented(gap, hardnesses)[0].sum()) * setup.grid.cell_area

    def step(heights: FloatArray, last_pressure: FloatArray | None) -> ContactOutcome:
        undeformed = setup.gap - heights
        last: list[ContactSolution] = []

        def solved(load: float) -> ContactSolution:
            last[:] = [
                solve_contact(
                    undeformed,
                    operator,
                    load=load,
                    hardness=setup.hardness,
                    tolerance=tolerance,
                    initial_pressure=last[0].pressure if last else last_pressure,
                )
            ]
            return last[0]

        open_gap = undeformed - undeformed.min()
        own, apart = share(
            setup.load,
            lambda load: carried(solved(load).gap),
            carried(open_gap),
            lambda away: carried(open_gap + away),
            particles.diameter,
        )
        if own > 0:
            found, gap = outcome_of(last[0], setup), last[0].gap
        else:
            nothing = np.zeros(setup.grid.shape)
            found = ContactOutcome(nothing, 0.0, 0.0, 0.0, setup.friction, 0.0, 0.0, Status.CONVERGED)
            gap = open_gap + apart
        depths, load = particles.indented(gap, hardnesses)[1], carried(gap)
        cut = tuple(particles.cut(depths[body], hardnesses[body], slide) for body in (LOWER, UPPER))
        if abs(found.load + load - setup.load) > BALANCE * setup.load and found.status is Status.CONVERGED:
            found = replace(found, status=Status.STALLED, residual=abs(found.load + load - setup.load) / setup.load)
        return replace(found, third_bodies=ThirdBodyLoad(load, (cut[LOWER], cut[UPPER])))

    return step
