"""Plan of a case of kind `partial-slip`."""

from __future__ import annotations

from bem.grid import Grid
from bem.kinds.partial_slip.pushing import answers, pressing_steps
from bem.kinds.partial_slip.scene import PartialSlipScene
from bem.scenes import sticking
from bem.scenes.planner import SEARCHED_IN_SINGLE, Plan, Step

_TRANSFORMS = 6.0 * 22
"""Transforms of a step: 15 to 23 convolutions were counted on 128 to 512 cells a side, first steps and later ones
alike, each of four transforms and vector passes worth two more."""
_ANSWERED = 4.0
"""Times as much where the pressure follows the tractions: six to nine rounds, each from the one before."""


def plan(scene: PartialSlipScene) -> Plan:
    """Plan the computation of one case."""
    count, pressing = len(scene.push.path()), pressing_steps(scene)
    each = _TRANSFORMS * (_ANSWERED if answers(scene) else 1.0)

    def steps(grid: Grid, points: float) -> tuple[Step, ...]:
        return (
            Step(
                "pressing in steps",
                f"{pressing} contacts: pressure alone makes bodies that differ slip"
                if pressing > 1
                else "pressure does not make these bodies slip, or push.pressing_steps is 1",
                skipped=pressing == 1,
                transforms=(40.0 + each) * (pressing - 1),
                points=points,
                precision=SEARCHED_IN_SINGLE,
            ),
            Step(
                "partial slip",
                f"{count} steps along x, {sticking.friction_words(scene.push.friction)}"
                + (", the pressure follows the tractions" if answers(scene) else ""),
                transforms=each * count,
                points=points,
                memory=8.0 * points * 6 + 8.0 * grid.cells * 40,
                kept=8.0 * grid.cells * 10,
                seconds=0.05 + 0.04 * count,
                precision=SEARCHED_IN_SINGLE if answers(scene) else "",
            ),
            Step(
                "stiffness",
                "normal and tangential, of the contact as a whole, before anything slips",
                skipped=not scene.outputs.stiffness,
                transforms=80.0 + 2 * _TRANSFORMS,
                points=points,
            ),
        )

    return sticking.plan_around(scene, steps, 1.0 if pressing == 1 else 1.5)
