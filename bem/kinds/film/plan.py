"""Plan of a case of kind `film`."""

from __future__ import annotations

from bem.kinds.film.scene import FilmScene
from bem.scenes import plans
from bem.scenes.planner import Plan, Step


def plan(scene: FilmScene) -> Plan:
    """Plan the computation of one case."""
    n, errors = scene.march.points, scene.outputs.errors
    why = f"{scene.march.steps} steps on {n} points, each by Newton's method"
    seconds = scene.march.steps * 1.6 * (0.002 + 2e-11 * n**3 + 1e-8 * n**2)
    return Plan.of(
        Step("film in time", why, seconds=seconds, memory=8.0 * n * n * 6),
        plans.error_bars(errors, "marches on half the points, and of steps twice as long", seconds=0.35 * seconds),
        Step("rough contact", "both surfaces are smooth", skipped=True),
        plans.figures(),
    )
