"""Plan of a case of kind `contact`."""

from __future__ import annotations

from bem.kinds.contact.adhesive import zone_is_resolved
from bem.kinds.contact.scene import ContactScene
from bem.scenes import build, plans
from bem.scenes.planner import Plan

ADHESIVE_SOLVES, ADHESIVE_CONVOLUTIONS = 30.0, 250.0
"""Contacts and convolutions of a state with adhesion: means of spheres at Maugis' parameters 0.3 to 3, with jumps."""
UNRESOLVED = 12.0
"""Times as many where cells do not resolve the adhesive zone: cells open and close one after the other."""

RELAXING_STEPS, RELAXING_CONVOLUTIONS, STEADY_CONVOLUTIONS = 38, 9.0, 26.0
"""Steps for each time of a path, convolutions of each step, and convolutions of a steady motion.

Means of six contacts (balls of 64 and 128 cells a side, a cylinder of 256, rough surfaces of 64 and 128) with one to
three relaxation times, on paths that load, hold and unload: 28 to 46 steps, 8 to 13 convolutions each. The last number
is the mean of their steady motion at two speeds (13 to 25) and of the nine speeds of `sliding-hysteresis` (21 to 85).
A modulus that falls to a hundredth or less in steady motion takes more, by proximal steps.
"""


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
    depths, fields = len(scene.wanted_depths()), 7 if outputs.stresses else 1
    capped, stiffness = scene.contact.behaviour == "capped", plans.stiffest(scene.lower.build(), scene.upper.build())
    held = 2.5 if scene.contact.mean_gap is None else 3.5  # how far an even pressure on what touches displaces
    coarser = plans.coarser_contact(grid, depths, capped=capped, stiffness=stiffness, fields=held)
    words = f"{scene.contact.behaviour}, {scene.contact.words()}"
    if scene.contact.times:
        steps = RELAXING_STEPS * len(scene.contact.times)
        contact = plans.contacts(
            grid, RELAXING_CONVOLUTIONS * steps, f"{words}; in time, about {steps} steps", solves=float(steps)
        )
    elif scene.speeds is not None:
        contact = plans.contacts(grid, STEADY_CONVOLUTIONS, f"{words}; in steady motion", solves=1.0)
    elif scene.contact.adhesion is None:
        contact = plans.contact(grid, words, capped=capped, stiffness=stiffness)
    else:
        steps = len(next(iter(scene.contact.path(grid.area).values())))
        more = steps * (1.0 if zone_is_resolved(scene, grid) else UNRESOLVED)
        contact = plans.contacts(
            grid,
            ADHESIVE_CONVOLUTIONS * more,
            f"{words}; adhesive, {steps} {'state' if steps == 1 else 'states'} on the path",
            solves=ADHESIVE_SOLVES * more,
        )
    return Plan.of(
        *bodies,
        contact,
        plans.stresses(grid, stressed, outputs.body, depths, fields=fields, loads=1 if friction == 0 else 2),
        plans.error_bars(outputs.errors, "the contact on the grid of twice the cell", **coarser),
        plans.vtk(outputs.vtk and depths > 0),
        plans.figures(grid.cells, 6.0 if depths else 1.0),  # measured to 8192 cells a side
    )
