"""Plan of a case of kind `wear`."""

from __future__ import annotations

import numpy as np

from bem.errors import InfeasibleError
from bem.kinds.wear.scene import WearScene
from bem.scenes import build, plans, wearing
from bem.scenes.planner import Plan, Step
from bem.wear.criterion import StressCriterion

_CONVOLUTIONS = 18  # of one warm-started contact solve, coarse levels included
_SHARING = 7  # contacts until particles that stay have their share of the load
_DEPTHS_NEEDED = 8  # before a depth is met at which nothing yields, on average
_DEPTHS_AT_FIRST = 40  # the same in the first cycle, of sharp asperities


def plan(scene: WearScene) -> Plan:
    """Plan one case.

    Raises
    ------
    InfeasibleError : a load beyond hardness times the slice's area. InputError : surfaces that cannot be generated.
    """
    grid, load = scene.domain.at(scene.cylinder, build.modulus_of(scene))
    if (scene.cylinder.hardness or np.inf) * grid.area < load:
        whole = load * scene.cylinder.width / grid.lengths[1]
        raise InfeasibleError(
            f"cylinder.loads: {whole:g} N is beyond hardness x area of the domain; allowed: a smaller load, a larger "
            "domain or a higher hardness"
        )
    particles, _ = wearing.third_bodies_and_defect(scene, grid, load)  # what these lack is said before any work
    solves = 1 if particles is None else _SHARING
    depths = {"usual": _DEPTHS_NEEDED, "first": _DEPTHS_AT_FIRST}
    cycles = {"convolutions": solves * _CONVOLUTIONS, "solves": solves, **depths}
    larger = "raise domain.lengths" if scene.domain.lengths else "raise domain.half_widths or the load"
    return Plan.of(
        *plans.of_bodies(scene, grid, scene.cylinder.friction, min(scene.depths.count, _DEPTHS_NEEDED), larger=larger),
        *wearing.cycle_steps(
            scene, grid, contacts="each from the last pressure", friction=scene.cylinder.friction, **cycles
        ),
        Step("kernels of an earlier run", _KERNELS, skipped=True),
        *(
            [Step(f"deeper stresses, down to {scene.depths.count} depths", _DEEPER, skipped=True)]
            if isinstance(scene.wear.criterion, StressCriterion)
            else []
        ),
        wearing.bars_step(scene, grid, _CONVOLUTIONS, solves),
        plans.figures(grid.cells),
    )


_KERNELS = "not kept on disk: made once for all cycles, in a few per cent of the run's time"
_DEEPER = "no piece that reaches the surface gets past a depth at which nothing yields"
