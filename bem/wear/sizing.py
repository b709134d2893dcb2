"""Sizes of wear particles beside a law that wears by pressure, after a stress criterion that removes nothing.

Archard's law gives a volume and no particles, a stress criterion gives particles and far too large a volume: the number
of particles is the volume of the law over their mean volume (thesis, paper C). Knows states and criteria; no scene.
Verified in tests/wear/test_sizing.py.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bem.wear.loads import BodyCycle, SurfaceLoad
from bem.wear.model import WearModel
from bem.wear.running_in import particle_rows
from bem.wear.setup import WearSetup
from bem.wear.state import PARTICLE_FIELDS, RunningInState


def particles_beside_law(state: RunningInState, setup: WearSetup, model: WearModel) -> NDArray[np.void]:
    """Return the particles that a criterion finds under the contact of the last cycle, as rows of `PARTICLE_FIELDS`.

    setup : grid, bodies and depths of the loop. model : of the loop, with a stress criterion in place of its law.
    """
    if state.pressure is None or not state.pressure.any():
        return np.empty(0, dtype=PARTICLE_FIELDS)
    traction = None if state.rubbing is None else state.rubbing.traction
    acting = SurfaceLoad(state.pressure, float(state.cycles["friction"][-1]), traction)
    shift_distance = abs(model.shift) * setup.grid.spacing[0]
    removals = [
        model.criterion_law.detach(BodyCycle(state.pressure, (acting,), setup, model, body, shift_distance))
        for body in model.checked_wearing_bodies(setup)
    ]
    return np.concatenate([particle_rows(removal, setup.grid, state.cycle) for removal in removals])
