"""Plan of a case of kind `contact`."""

from __future__ import annotations

from bem.kinds.contact.scene import ContactScene
from bem.scenes import build, plans
from bem.scenes.planner import Plan


def plan(scene: ContactScene) -> Plan:
    """Plan the computation of one case.

    Raises
    ------
    InfeasibleError : a load beyond hardness x area. InputError : surfaces that cannot be generated on the grid.
    """
    grid, outputs, friction = build.grid_of(scene.grid), scene.outputs, scene.contact.friction
    bodies = plans.of_bodies(scene, grid, friction, aside=True)
    scene.contact.check_load(grid.area)
    stressed = (scene.lower if outputs.body == "lower" else scene.upper).build()
    depths, fields = len(outputs.wanted_depths()), 7 if outputs.stresses else 1
    capped, stiffness = scene.contact.behaviour == "capped", plans.stiffest(scene.lower.build(), scene.upper.build())
    held = 2.5 if scene.contact.mean_gap is None else 3.5  # how far an even pressure on what touches displaces
    coarser = plans.coarser_contact(grid, depths, capped=capped, stiffness=stiffness, fields=held)
    return Plan.of(
        *bodies,
        plans.contact(grid, f"{scene.contact.behaviour}, {scene.contact.words()}", capped=capped, stiffness=stiffness),
        plans.stresses(grid, stressed, outputs.body, depths, fields=fields, loads=1 if friction == 0 else 2),
        plans.error_bars(outputs.errors, "the contact on the grid of twice the cell", **coarser),
        plans.vtk(outputs.vtk and depths > 0),
        plans.figures(grid.cells, 6.0 if depths else 1.0),  # measured to 8192 cells a side
    )
