"""Plan of a case of kind `point-film-time`."""

from __future__ import annotations

from bem.kinds.point_film_time.scene import PointFilmTimeScene
from bem.scenes import plans
from bem.scenes.planner import Plan, Step


def plan(scene: PointFilmTimeScene) -> Plan:
    """Plan the computation of one case."""
    (nx, ny), steps, errors = scene.film.cells, scene.march.steps, scene.outputs.errors
    # counted: 3 to 5 Newton steps of 4 to 8 cycles each
    seconds = steps * (0.02 + 9e-6 * nx * ny)
    return Plan.of(
        Step("rough contact", "the film carries all of the load", skipped=True),
        Step("film in time", f"{steps} steps on {nx} x {ny} cells, each by Newton's method with multigrid",
             seconds=seconds, memory=(1200.0 + 40 * steps) * nx * ny),
        plans.error_bars(errors, "marches on half the cells, and of steps twice as long", seconds=1.2 * seconds),
        plans.figures(nx * ny),
    )  # fmt: skip
