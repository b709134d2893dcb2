"""Error of the last step of wear by pressure, by step doubling: the step once more, in two halves.

A step wears by one pressure, that of its end (dry, in gross sliding) or of its start, so its error is of first order:
the error is twice the difference between the step and its two halves. No body moves between the halves, since different
places that meet are no error of a step. Wear corrects the errors of earlier steps: where too little came off, the
pressure is higher.

Third bodies: the heights that the halves start from are those after their cuts, and their number is that after the
cycle, so the estimate leaves out the change that they make in one cycle.

Evidence: the largest error of whole loops, against an eighth of their steps, was 0.8 to 1 times the estimate at rest,
0.9 to 2 times where surfaces slid by 1 to 7 cells between steps, and 4 times in ten steps under a pressure that closed
most of the gap.

Knows cycles and states; no scene. Verified in tests/wear/test_local_wear.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from bem.errors import ConvergenceError, InputError
from bem.grid import FloatArray
from bem.wear.contact_step import ContactStart, ContactStep
from bem.wear.criterion import LocalWear
from bem.wear.cycle import wear_cycle
from bem.wear.model import WearModel
from bem.wear.setup import LOWER, UPPER, WearSetup, wearing_bodies
from bem.wear.state import RunningInState


def step_error(
    state: RunningInState,
    setup: WearSetup,
    model: WearModel,
    contact_step: ContactStep,
    start: ContactStart,
    facing: Callable[[FloatArray, int], FloatArray],
    compliance: float,
) -> float | None:
    """Estimate the largest error of the depth that the (first) wearing body lost in the last cycle [m].

    None for laws that wear in pieces, before the first cycle, and where a half cannot be taken: its contact or loop
    of partial slip does not converge, or it slides so far that the law refuses the step.

    Parameters
    ----------
    state : after the cycle.
    setup, model, contact_step : of the loop.
    start : of the first half.
    facing : (rows (n, ny) of a body, LOWER or UPPER) -> those that faced the grid in the last cycle (nx, ny).
    compliance : depth that a whole cycle wears by pressure [m/Pa], for an implicit step.
    """
    wearing = wearing_bodies(setup.bodies, model.wears)
    depths = {body: state.memories[body] for body in wearing}
    if not isinstance(model.criterion_law, LocalWear) or any(depth is None for depth in depths.values()):
        return None
    worn = {body: facing(depth[0], body) for body, depth in depths.items() if depth is not None}
    heights = [facing(state.heights[body], body) + worn.get(body, 0.0) for body in (LOWER, UPPER)]
    # the macroscopic shape of the film follows the heights before the cycle, as in the cycle itself
    standing = UPPER if model.moving == LOWER else LOWER
    start = replace(start, standing_profile=heights[standing].mean(axis=1))
    halves = np.zeros(setup.grid.shape)
    for _ in range(2):
        try:
            contact, removals = wear_cycle(
                (heights[LOWER], heights[UPPER]), setup, model, contact_step, start, compliance=0.5 * compliance
            )
        except (ConvergenceError, InputError):
            return None
        if not removals:  # the contact or its loop of partial slip did not converge
            return None
        start = ContactStart(contact.pressure, contact.memory, last_cycle=start.last_cycle)
        for removal in removals:
            heights[removal.body] = heights[removal.body] - 0.5 * removal.thickness
        halves += 0.5 * removals[0].thickness
    return float(2 * np.abs(halves - worn[removals[0].body]).max())
