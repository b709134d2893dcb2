"""Plan of a case of kind `particles`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bem.kinds.particles.scene import ParticlesScene
from bem.scenes import plans
from bem.scenes.planner import Plan, Step


def plan(scene: ParticlesScene) -> Plan:
    """Plan the computation of one case."""
    cells = 4.0 * 1024**2 if scene.synthetic is None else float(np.prod(scene.synthetic.shape))
    number = "wear volume by Archard over the mean particle volume" if scene.archard else "no wear rate is given"
    spun = "Stokes in the centrifuge" if scene.sedimentation else "no centrifuge is given"
    return Plan.of(
        Step(
            "map",
            "read from its file" if scene.synthetic is None else "made up",
            seconds=1e-7 * cells,
            memory=24 * cells,
        ),
        Step("particles", "level the plate, threshold, label", seconds=3e-7 * cells, memory=40 * cells),
        Step("number of particles", number, skipped=scene.archard is None),
        Step("sedimentation", spun, skipped=scene.sedimentation is None),
        plans.error_bars(scene.outputs.errors, "the map at every second pixel", seconds=1.5e-7 * cells),
        Step("contact and stresses", "the particles are measured, not computed", skipped=True),
        replace(plans.figures(int(cells)), seconds=1.2),  # large maps are drawn thinned
    )
