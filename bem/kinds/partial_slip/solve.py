"""Solver calls of kind `partial-slip` that a run and its error bars share."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from bem.errors import InfeasibleError, Status
from bem.kinds.partial_slip.scene import PartialSlipScene
from bem.notes import Note
from bem.notes.scenes import JOINT_CLOSED, PART_UNSOLVED
from bem.scenes import build
from bem.scenes.sticking import Site

_PROBE = 1e-3
"""Displacement for the normal stiffness, as a fraction of the approach from first touch, or of the range of gaps."""


def stiffness(
    scene: PartialSlipScene, site: Site, note: Callable[[Note], None] = lambda note: None
) -> dict[str, float]:
    """Compute the stiffness of the contact as a whole [N/m]: load over approach, by its difference, and force over
    shift where all sticks."""
    from bem.contact import solve_contact
    from bem.tangential import tangential_stiffness

    contact = site.contact
    if not contact.load > 0:
        return {"normal_stiffness": 0.0, "tangential_stiffness": 0.0}
    if all(site.grid.periodic) and contact.pressure.min() > 0:
        note(JOINT_CLOSED())
        return {}
    asked = scene.contact.accuracy() | {"hardness": scene.contact.hardness, "initial_pressure": contact.pressure}
    operator = build.operator_of(scene, site.grid, 0.0)
    step = _PROBE * max(abs(contact.approach), float(np.ptp(contact.gap)))
    near = [solve_contact(site.gap, operator, approach=contact.approach - step, **asked)]
    try:
        near.append(solve_contact(site.gap, operator, approach=contact.approach + step, **asked))
    except InfeasibleError:  # nearly closed: no room for a step further
        near.append(contact)
    for found in near:
        if found.status is not Status.CONVERGED:
            note(
                PART_UNSOLVED(
                    part="contact for the normal stiffness",
                    message=found.status.message,
                    residual=found.residual,
                    action="Take a larger tolerance, or more iterations",
                )
            )
    stuck = tangential_stiffness(contact, site.grid, build.bodies_of(scene), tolerance=scene.push.tolerance)
    return {
        "normal_stiffness": (near[1].load - near[0].load) / (near[1].approach - near[0].approach),
        "tangential_stiffness": float(stuck[0, 0]),
    }
