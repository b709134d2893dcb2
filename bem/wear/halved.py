"""What the steps of wear by pressure leave open: the last one once more, in two halves at the same place.

A step wears by one pressure, of its end (dry contacts) or its start, so that its error is of first order: two halves
leave half of it, and the step's own error is twice what they change. No body moves between the halves:
what another place of it presses on is no error of a step. It is that of the last step. Wear corrects what earlier steps
left: where too little came off there is more pressure. The largest error of whole loops, against an eighth of their
steps, was 0.8 to 1 times it at rest and 0.9 to 2 times it where surfaces slid by 1 to 7 cells between steps; 4 times it
in ten steps under a pressure that closed most of the gap, where little is corrected.

Knows cycles and states; no scene. Verified in tests/wear/test_local_wear.py.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from bem.errors import ConvergenceError, Status
from bem.grid import FloatArray
from bem.wear.criterion import LocalWear
from bem.wear.cycle import ContactStep, WearModel, wear_cycle
from bem.wear.setup import LOWER, UPPER, WearSetup
from bem.wear.state import RunningInState


def step_error(
    state: RunningInState,
    setup: WearSetup,
    model: WearModel,
    half_step: ContactStep,
    facing: Callable[[FloatArray, int], FloatArray],
) -> float | None:
    """Largest error of a depth that the (first) wearing body lost in the last cycle [m], an estimate of first order.

    None of laws that wear in pieces, before the first cycle, and where the contact of a half does not converge.

    Parameters
    ----------
    state : after the cycle.
    setup, model : of the loop.
    half_step : contact of half a cycle: one that wears by the pressure of its end gives way by half as much.
    facing : (rows (n, ny) of a body, LOWER or UPPER) -> those that faced the grid in the last cycle (nx, ny).
    """
    wearing = setup.wearing(model)
    depths = {body: state.memories[body] for body in wearing}
    if not isinstance(model.law, LocalWear) or any(depth is None for depth in depths.values()):
        return None
    worn = {body: facing(depth[0], body) for body, depth in depths.items() if depth is not None}
    heights = [facing(state.heights[body], body) + worn.get(body, 0.0) for body in (LOWER, UPPER)]
    pressure, halves = state.pressure, np.zeros(setup.grid.shape)
    for _ in range(2):
        try:
            contact, removals = wear_cycle((heights[LOWER], heights[UPPER]), setup, model, half_step, pressure)
        except ConvergenceError:
            return None
        if contact.status is not Status.CONVERGED:
            return None
        pressure = contact.pressure
        for removal in removals:
            heights[removal.body] = heights[removal.body] - 0.5 * removal.thickness
        halves += 0.5 * removals[0].thickness
    return float(2 * np.abs(halves - worn[removals[0].body]).max())
