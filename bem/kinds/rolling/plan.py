"""Plan of a case of kind `rolling`."""

from __future__ import annotations

from bem.grid import Grid
from bem.kinds.rolling.scene import RollingContactScene
from bem.scenes import sticking
from bem.scenes.planner import Plan, Step

_TRANSFORMS = 6.0 * 2.8
"""For each cell along the rolling: 2 to 3 convolutions were counted from 32 to 256 of them, each of four transforms and
vector passes."""


def plan(scene: RollingContactScene) -> Plan:
    """Plan the computation of one case."""

    def steps(grid: Grid, points: float) -> tuple[Step, ...]:
        return (
            Step(
                "rolling",
                f"steady along x, friction {scene.roll.friction:g}",
                transforms=_TRANSFORMS * max(grid.shape[0], 40),
                points=points,
                # directions that GMRES keeps, on the cells in contact
                memory=8.0 * points * 6 + 8.0 * grid.cells * 2 * 62,
                kept=8.0 * grid.cells * 10,
                seconds=0.05,
            ),
        )

    return sticking.plan_around(scene, steps, 0.5)
