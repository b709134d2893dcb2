"""Plan of a case of kind `running-in`."""

from __future__ import annotations

from dataclasses import replace

from bem.errors import InputError
from bem.grid import Grid
from bem.kinds.running_in.errors import at_resolution
from bem.kinds.running_in.scene import RunningInScene
from bem.scenes import build, film_plans, plans, wearing
from bem.scenes.axes import with_keys
from bem.scenes.planner import Plan, Step

_CONVOLUTIONS = 15  # of the two or three contacts of a cycle: 14 and 15 were counted
_SOLVES = 2.5
_CONTACTS = "two or three contacts each, from the last pressure; none in full film"
_DEPTHS_NEEDED = 6
_CYCLE = 5e-3
"""Processor time of a cycle besides [s]: on few cells the steps of the program cost more than the arrays. Measured,
with it the error bars of 56 x 56 cells are planned as 4 s and take 6 s, those of 72 x 72 cells as 8 s and 9 s."""


def plan(scene: RunningInScene) -> Plan:
    """Plan one wear loop.

    Raises
    ------
    InputError : a patch that does not fit, a wearing body without yield stress. InfeasibleError : too much load.
    """
    grid = scene.check()
    # what these lack is said before any work
    wearing.third_bodies_and_defect(scene, grid, scene.contact.on_patch(scene.load, grid.lengths))
    return Plan.of(
        plans.surfaces(grid, scene.lower.surface, scene.upper.surface),
        *_loop(scene, grid),
        _bars(scene, grid),
        plans.figures(grid.cells),
    )


def _loop(scene: RunningInScene, grid: Grid) -> tuple[Step, ...]:
    """Return the steps of a wear loop with its films."""
    film_cells = None if scene.contact.point_radii is None else scene.sharing.film_cells
    return (
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
    )


def _bars(scene: RunningInScene, grid: Grid) -> Step:
    """Return the step of the error bars: the loop on twice the cell, with films of its own.

    A film that cannot be halved takes a second loop, with twice the points of the film.
    """
    step = wearing.bars_step(scene, grid, 0, 0.0)
    if step.skipped or any(n % 2 for n in grid.shape):
        return step
    try:
        coarser = [at_resolution(scene, 0.5)]
        if not wearing.film_is_halved(scene):
            coarser.append(with_keys(coarser[0], wearing.film_keys(coarser[0], 2.0)))
        done = [item for one in coarser for item in _loop(one, build.grid_of(one.grid)) if not item.skipped]
    except InputError:  # the coarser loop cannot be made, and there are no error bars
        return step
    transformed = sum(item.transforms * item.points for item in done)
    cycles = _CYCLE * scene.cycles.count * len(coarser)
    return replace(step, transforms=transformed / step.points, seconds=sum(item.seconds for item in done) + cycles)
