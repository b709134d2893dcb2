"""Plan of a case of kind `running-in-life`."""

from __future__ import annotations

import math
from dataclasses import replace

from bem.grid import Grid
from bem.kinds.running_in_life import lives
from bem.kinds.running_in_life.scene import RunningInLifeScene
from bem.scenes import build, film_plans, plans
from bem.scenes.checks.surfaces_of import rough_surface
from bem.scenes.planner import Plan, Step, padded_points
from bem.scenes.tables.film_defect import film_defect

_CONVOLUTIONS = 7  # of the contacts of a pass, each from the last: 2 to 7 were counted
_SECONDS = 0.008  # of a pass besides: films from the table, friction, what wears


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
    jumps = foreseen_jumps(scene, grid)
    passes = 3.0 * scene.wear.positions * jumps  # a jump is three rounds
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
                f"about {jumps} jumps, each once whole and in two halves, of {scene.wear.positions} positions",
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


def foreseen_jumps(scene: RunningInLifeScene, grid: Grid) -> int:
    """Return the number of jumps by the rule of the life, for the error that the roughness and the wear rate lead to.

    A tribofilm and a boundary film with defects change it by a fraction and are left out.
    """
    from bem.life.steps import error_per_cycle, foreseen_steps

    life, wear = scene.life, scene.wear
    found = [rough_surface(body, getattr(scene, body).surface, grid, scene.seed) for body in ("lower", "upper")]
    rough = [one for one in found if one is not None]
    height = math.hypot(*(one.rms_height for one in rough))
    # smooth surfaces wear over the length of the grid
    wavenumber = math.hypot(*(one.rms_slope for one in rough)) / height if height > 0 else 2 * math.pi / grid.lengths[0]
    compliance = wear.distance * sum(wear.rates(scene.bodies, scene.friction))
    error = error_per_cycle(compliance, build.modulus_of(scene), wavenumber, wear.positions)
    return foreseen_steps(life.count, life.first_step, lives.longest_jump(scene), life.tolerance, error)


JUMPS_ALONE = "what the cycle jumps leave open alone, since life.coarser_lives is false"
