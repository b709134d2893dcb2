"""Plan of a case of kind `running-in-life`."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bem.kinds.running_in_life import lives
from bem.kinds.running_in_life.scene import RunningInLifeScene
from bem.scenes import film_plans, plans
from bem.scenes.planner import Plan, Step, padded_points
from bem.scenes.tables.film_defect import film_defect

_CONVOLUTIONS = 7  # of the contacts of a pass, each from the last: 2 to 7 were counted
_SECONDS = 0.008  # of a pass besides: films from the table, friction, what wears
_JUMPS = 25  # steps of a life of a million cycles, each of three rounds


def plan(scene: RunningInLifeScene) -> Plan:
    """Plan one life.

    Raises
    ------
    InputError : a patch that does not fit, a law without the hardness it needs. InfeasibleError : too much load.
    """
    grid, life = scene.check(), scene.life
    scene.wear.rates(scene.bodies, scene.friction)
    film_defect(scene)
    if scene.fatigue is not None:
        scene.fatigue.build(scene.bodies)
    if scene.particles is not None:
        scene.particles.build(grid, scene.bodies, scene.contact.hardness, lives.on_grid(scene))
    decades = max(np.log2(max(life.count / life.first_step, 2.0)) / 20, 0.1)
    passes = 3 * scene.wear.positions * _JUMPS * decades * max(0.05 / life.tolerance, 0.5)
    # stresses and damage of both bodies at each depth, by cells
    fatigue = 0.0 if scene.fatigue is None else 1.2e-6 * grid.cells * scene.fatigue.depths.count * passes
    film_cells = None if scene.contact.point_radii is None else scene.sharing.film_cells
    return Plan.of(
        plans.surfaces(grid, scene.lower.surface, scene.upper.surface),
        film_plans.tables(scene.sharing.film_points, film_cells, scene.thermal, "passes"),
        replace(
            plans.contacts(
                grid,
                _CONVOLUTIONS * passes,
                f"about {passes / scene.wear.positions / 3:.0f} jumps, each once whole and in two halves, of "
                f"{scene.wear.positions} positions",
            ),
            seconds=_SECONDS * passes,
        ),
        film_plans.heat_of_contacts(scene.thermal, passes, grid.cells),
        Step("tribofilm", "grows cell by cell where surfaces touch", skipped=scene.tribofilm is None, seconds=0.1),
        Step(
            "fatigue",
            "stresses of every position after each jump",
            skipped=scene.fatigue is None,
            seconds=fatigue,
        ),
        Step(
            "pieces",
            "sizes that the criterion finds after each jump",
            skipped=scene.particles is None,
            seconds=0.02 * passes / 3,
        ),
        Step(
            "error bars",
            "a life on twice the cell, and there one of half the positions" if life.coarser_lives else JUMPS_ALONE,
            skipped=not life.coarser_lives,
            kept=0.0,
            transforms=3.0 * _CONVOLUTIONS * passes,
            seconds=1.5 * _SECONDS * passes + 0.6 * fatigue,
            points=padded_points(grid.shape, grid.periodic) // 4,
        ),
        plans.figures(grid.cells),
    )


JUMPS_ALONE = "what the cycle jumps leave open alone, since life.coarser_lives is false"
