"""Plan of a case of kind `traction`."""

from __future__ import annotations

from bem.kinds.traction.scene import TractionScene
from bem.scenes import plans
from bem.scenes.planner import Plan, Step


def plan(scene: TractionScene) -> Plan:
    """Plan the computation of one case."""
    points, hot, errors = scene.film.points, scene.thermal != "off", scene.outputs.errors
    starved, waves = scene.supply is not None, scene.by_waves
    heat = {"off": 0.0, "lumped": 0.05, "full": 0.4 + 5e-4 * points}[scene.thermal]
    seconds = 0.04 + 4e-5 * points + (0.15 if starved else 0.0)
    return Plan(
        (
            Step("rough contact", "the surfaces are smooth, the film carries all of the load", skipped=True),
            *([Step("waves", "of the roughness of both bodies, by Fourier transforms", seconds=0.3)] if waves else []),
            Step(
                "film",
                f"Newton's method on {points} points" + (", flooded and then with its supply" if starved else ""),
                seconds=seconds,
                memory=600.0 * points,
            ),
            Step(
                "heat",
                _HEAT[scene.thermal],
                skipped=not hot,
                seconds=heat,
                memory=2e7 if scene.thermal != "full" else 2e8,
            ),
            Step(
                "error bars",
                "the same on half the points" if errors else "outputs.errors is false",
                skipped=not errors,
                seconds=0.5 * seconds + 0.5 * heat,
            ),
            plans.figures(),
        )
    )


_HEAT = {
    "off": 'thermal is "off"',
    "lumped": "inlet heating, mean temperature of the oil along the film",
    "full": "temperature along and across the film, in turns with the film",
}
