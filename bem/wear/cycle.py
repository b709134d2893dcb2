"""One sliding cycle: contact, traction, then the removal that the criterion finds on each wearing body.

Verified in tests/wear/test_cycle.py.
"""

from __future__ import annotations

from dataclasses import replace

from bem.errors import Status
from bem.grid import FloatArray
from bem.wear.contact_step import ContactOutcome, ContactStart, ContactStep
from bem.wear.loads import BodyCycle, BodyWear, SurfaceLoad, stress_range_loads
from bem.wear.model import WearModel
from bem.wear.setup import LOWER, UPPER, WearSetup, wearing_bodies


def wear_cycle(
    heights: tuple[FloatArray, FloatArray],
    setup: WearSetup,
    model: WearModel,
    contact_step: ContactStep,
    start: ContactStart | None = None,
    last_loads: tuple[SurfaceLoad | None, SurfaceLoad | None] = (None, None),
    memories: tuple[FloatArray | None, FloatArray | None] = (None, None),
    compliance: float = 0.0,
) -> tuple[ContactOutcome, list[BodyWear]]:
    """Solve the contact of one cycle and apply the criterion to each wearing body. Nothing is changed in place.

    Parameters
    ----------
    heights : (nx, ny) of the lower and upper body as they face each other [m].
    setup, model : of the loop.
    contact_step : contact of the cycle.
    start : what the contact starts from; None for a cold start.
    last_loads : loads of the last cycle on the material of the lower and of the upper body that is on the grid now;
        None for no load. Used for ranges of stress only.
    memories : what the criterion stored of that material, (planes, nx, ny).
    compliance : depth that each place wears by pressure in the cycle [m/Pa], for an implicit step.

    Returns
    -------
    Contact, and the removal of each wearing body; no removal where the contact or its loop of partial slip did not
    converge, since stresses of such a pressure or traction mean nothing.
    """
    contact = contact_step(heights[LOWER] + heights[UPPER], start, compliance)
    if contact.status is not Status.CONVERGED:
        return contact, []
    rubbing = model.traction_law.rub(contact.pressure, contact.friction, setup)
    if rubbing is not None and rubbing.status is not Status.CONVERGED:
        return replace(contact, rubbing=rubbing), []
    acting = SurfaceLoad(contact.pressure, contact.friction, None if rubbing is None else rubbing.traction)
    slid = None if rubbing is None else model.traction_law.loops_per_cycle * rubbing.slid
    shift_distance = abs(model.shift) * setup.grid.spacing[0]
    judged = _without_residual_stress(setup) if model.stress_range else setup
    removals = []
    for body in wearing_bodies(setup.bodies, model.wears):
        loads = stress_range_loads(acting, last_loads[body]) if model.stress_range else (acting,)
        cycle = BodyCycle(
            contact.pressure, loads, judged, model, body, shift_distance, memories[body], slid, contact.temperature
        )
        removals.append(model.criterion_law.detach(cycle))
    return contact if rubbing is None else replace(contact, rubbing=rubbing), removals


def _without_residual_stress(setup: WearSetup) -> WearSetup:
    """Return the setup for ranges of stress: a residual stress does not change from cycle to cycle."""
    lower, upper = (body.without_residual_stress() for body in setup.bodies)
    return replace(setup, bodies=(lower, upper))
