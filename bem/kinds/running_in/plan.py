"""Plan of a case of kind `running-in`."""

from __future__ import annotations

from bem.kinds.running_in.scene import RunningInScene
from bem.scenes import film_plans, plans, wearing
from bem.scenes.planner import Plan, Step

_CONVOLUTIONS = 15  # of the two or three contacts of a cycle: 14 and 15 were counted
_SOLVES = 2.5
_CONTACTS = "two or three contacts each, from the last pressure; none in full film"
_DEPTHS_NEEDED = 6


def plan(scene: RunningInScene) -> Plan:
    """Plan one wear loop.

    Raises
    ------
    InputError : a patch that does not fit, a wearing body without yield stress. InfeasibleError : too much load.
    """
    grid = scene.check()
    # what these lack is said before any work
    wearing.third_bodies_and_defect(scene, grid, scene.contact.on_patch(scene.load, grid.lengths))
    loops = 1 if wearing.film_is_halved(scene) else 2  # a film that cannot be halved takes a second one
    film_cells = None if scene.contact.point_radii is None else scene.sharing.film_cells
    return Plan.of(
        plans.surfaces(grid, scene.lower.surface, scene.upper.surface),
        film_plans.tables(scene.sharing.film_points, film_cells, scene.thermal, "cycles and repetitions"),
        Step("a film for every balance", "films are interpolated in the tables", skipped=True),
        *wearing.cycle_steps(
            scene,
            grid,
            convolutions=_CONVOLUTIONS,
            solves=_SOLVES,
            contacts=_CONTACTS,
            usual=_DEPTHS_NEEDED,
            first=4 * _DEPTHS_NEEDED,
            friction=float(scene.contact.boundary_friction != 0),
        ),
        film_plans.heat_of_contacts(scene.thermal, scene.cycles.count, grid.cells),
        wearing.bars_step(scene, grid, _CONVOLUTIONS * loops, _SOLVES * loops),
        plans.figures(grid.cells),
    )
