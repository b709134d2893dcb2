"""Uncertain inputs of kind `friction`: changes of a point's figures by the derivatives of its balance."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from bem.errors import BemError
from bem.grid import Grid
from bem.kinds.friction.scene import FrictionScene
from bem.scenes import build
from bem.scenes.context import Context
from bem.scenes.uncertain import deviations, moved, relative_step

if TYPE_CHECKING:
    from bem.friction.sensitivity import PointInputs
    from bem.friction.setup import MixedSetup
    from bem.friction.solution import MixedSolution


def by_tangent(scene: FrictionScene, key: str) -> bool:
    """Return True if the derivatives of the balance propagate a key: not of a grid or a mesh, nor with flow factors or
    roughness that the film flattens."""
    if scene.by_waves or scene.sharing.flow_factors != "off":
        return False
    return not key.startswith(("grid.", "film.", "sharing."))


class InputEnds:
    """Inputs of all points of a curve on both sides of each uncertain key.

    ends : by key, number of standard deviations between both sides, and scene, set-up and heights of each.
    """

    def __init__(self, scene: FrictionScene, grid: Grid, setup: MixedSetup, height: Any, context: Context) -> None:
        from bem.friction.sensitivity import step_of

        self.setup, self.height = setup, height
        self.ends: dict[str, tuple[float, list[tuple[Any, MixedSetup, Any]]]] = {}
        for key, deviation in deviations(scene).items():
            if not by_tangent(scene, key):
                continue
            step, sides = relative_step(scene, key, deviation, step_of(setup)), []
            for side in (-1, 1):
                one = moved(scene, key, deviation, side * step)
                lower, upper = build.both_heights(one, grid, context) if ".surface." in key else (height, 0.0)
                sides.append((one.speeds.build(), one.curve_setup("off"), lower + upper))
            self.ends[key] = (2 * step, sides)

    def changes(self, number: int, solution: MixedSolution) -> dict[str, dict[str, float]]:
        """Return the change of the figures of a point with one standard deviation of each key; none where a trial does
        not converge."""
        from dataclasses import asdict

        from bem.friction.sensitivity import PointInputs, point_derivatives

        if not self.ends:
            return {}

        def inputs(speeds: Any, setup: MixedSetup, height: Any) -> PointInputs:
            first, second = speeds[number]
            return PointInputs(setup, height, (float(first), float(second)))

        changes = {key: (inputs(*sides[0]), inputs(*sides[1]), step) for key, (step, sides) in self.ends.items()}
        here = PointInputs(self.setup, self.height, solution.speeds)
        try:
            return {key: asdict(one) for key, one in point_derivatives(solution, here, changes).items()}
        except BemError:
            return {}


def over_speeds(points: list[dict[str, dict[str, float]]]) -> dict[str, dict[str, Any]]:
    """Return the changes of all speeds as arrays by key and figure; not-a-number where a speed has none."""
    import numpy as np

    keys = dict.fromkeys(key for point in points for key in point)
    figures = dict.fromkeys(name for point in points for one in point.values() for name in one)
    return {
        key: {name: np.array([point.get(key, {}).get(name, np.nan) for point in points]) for name in figures}
        for key in keys
    }
