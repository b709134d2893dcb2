"""Plan of a case of kind `rolling`."""

from __future__ import annotations

from bem.grid import Grid
from bem.kinds.rolling.scene import RollingContactScene
from bem.scenes import sticking
from bem.scenes.planner import Plan, Step

_TRANSFORMS = 6.0 * 2.8
"""For each cell along the rolling: 2 to 3 convolutions were counted from 32 to 256 of them, each of four transforms and
vector passes."""

_STEP = 6.0 * 20
"""Transforms of a step of a history: 14 to 20 convolutions were counted."""


def plan(scene: RollingContactScene) -> Plan:
    """Plan the computation of one case."""
    history = scene.history

    def steps(grid: Grid, points: float) -> tuple[Step, ...]:
        return (
            Step(
                "rolling",
                f"transient, {history.steps(grid.spacing[0])} steps of a cell, "
                f"{sticking.friction_words(scene.roll.friction)}"
                if history is not None
                else f"steady along x, {sticking.friction_words(scene.roll.friction)}",
                transforms=_TRANSFORMS * max(grid.shape[0], 40)
                if history is None
                else _STEP * history.steps(grid.spacing[0]),
                points=points,
                # directions that GMRES keeps, on the cells in contact
                memory=8.0 * points * 6 + 8.0 * grid.cells * 2 * 62,
                kept=8.0 * grid.cells * 10,
                seconds=0.05,
            ),
        )

    return sticking.plan_around(scene, steps, 0.5)
