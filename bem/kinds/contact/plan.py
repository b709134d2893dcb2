"""Plan of a case of kind `contact`."""

from __future__ import annotations

from bem.adhesion.zone import resolved_range, resolving_shape
from bem.grid import Grid
from bem.kinds.contact.adhesive import zone_is_resolved
from bem.kinds.contact.scene import ContactScene
from bem.quantities import si
from bem.reference_solutions.adhesive_sphere import tabor_parameter
from bem.scenes import build, plans
from bem.scenes.planner import Plan, Step, machine_rate, show_seconds, step_seconds

ADHESIVE_CONVOLUTIONS, PER_SOLVE = 250.0, 8.0
"""Convolutions of a state with adhesion between rough surfaces, and convolutions of each of its contacts."""
SPHERE_CONVOLUTIONS = (60.0, 130.0)
"""Convolutions of a state of an adhesive sphere: the first, and the second times the square of Tabor's parameter.

Counted on paths of ten states that press and pull off: 65 at 0.3, 146 to 152 at 1, 417 to 1277 at 2 (64 to 256 cells a
side, most in the state in which the sphere jumps off), 2060 to 6060 at 4, where cells did not resolve the zone.
"""
ADDED_STATES = 6
"""States that are added about the lowest load of a path of approaches: 4 to 12 were counted, and 3 of a fine path."""
MOST_TABOR = 6.0
"""Tabor's parameter above which no counts are known."""
UNRESOLVED = 12.0
"""Times as many between rough surfaces where cells do not resolve the adhesive zone: cells open and close one after the
other."""

RELAXING_STEPS, RELAXING_CONVOLUTIONS, STEADY_CONVOLUTIONS = 38, 9.0, 26.0
"""Steps for each time of a path, convolutions of each step, and convolutions of a steady motion.

Means of six contacts (balls of 64 and 128 cells a side, a cylinder of 256, rough surfaces of 64 and 128) with one to
three relaxation times, on paths that load, hold and unload: 28 to 46 steps, 8 to 13 convolutions each. The last number
is the mean of their steady motion at two speeds (13 to 25) and of the nine speeds of `sliding-hysteresis` (21 to 85).
A modulus that falls to a hundredth or less in steady motion takes more, by proximal steps.
"""

_CURVED_ITERATIONS = 60
"""Products with the matrices of the rows: two for each of 25 to 40 iterations were counted."""


def _curved_step(grid: Grid, words: str) -> Step:
    """Return the step of a contact on a curved surface: ny^2 numbers for each wavenumber along x."""
    matrices = (grid.shape[0] + 1) * grid.shape[1] ** 2
    return Step(
        "contact",
        f"{words}; on the curved surface of the rail, about {_CURVED_ITERATIONS} products with its matrices",
        memory=8.0 * matrices * 3,
        seconds=matrices * (2e-7 + 2e-9 * _CURVED_ITERATIONS),
    )


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
    depths, fields = len(scene.wanted_depths()), 7 if scene.needs_components() else 1
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
    elif scene.shape.conforming:
        contact = _curved_step(grid, words)
    elif scene.contact.adhesion is None:
        contact = plans.contact(grid, words, capped=capped, stiffness=stiffness)
    else:
        contact, cost = _adhesive(scene, grid, words)
        coarser |= cost
    return Plan.of(
        *bodies,
        contact,
        plans.stresses(grid, stressed, outputs.body, depths, fields=fields, loads=1 if friction == 0 else 2),
        plans.error_bars(outputs.errors, "the contact on the grid of twice the cell", **coarser),
        plans.vtk(outputs.vtk and depths > 0),
        plans.figures(grid.cells, 6.0 if depths else 1.0),  # measured to 8192 cells a side
    )


def _adhesive(scene: ContactScene, grid: Grid, words: str) -> tuple[Step, dict[str, float]]:
    """Return the step of an adhesive path, and the cost of the same path on the grid of twice the cell."""
    steps = len(next(iter(scene.contact.path(grid.area).values())))
    twice = Grid(
        (max(grid.shape[0] // 2, 1), max(grid.shape[1] // 2, 1)),
        (2 * grid.spacing[0], 2 * grid.spacing[1]),
        periodic=grid.periodic,
    )
    if scene.contact.approach is not None and steps > 2:
        solved, states = (
            steps + ADDED_STATES,
            f"{steps} states on the path and about {ADDED_STATES} more at its lowest load",
        )
    else:
        solved, states = steps, f"{steps} {'state' if steps == 1 else 'states'} on the path"
    fine, coarse = (solved * _convolutions(scene, one) for one in (grid, twice))
    how = "time within a factor of about 3, more with jumps"
    if not zone_is_resolved(scene, grid):
        how = f"time unknown: the cells do not resolve adhesion; {_resolving(scene, grid, solved)}"
    contact = plans.contacts(grid, fine, f"{words}; adhesive, {states}; {how}", solves=fine / PER_SOLVE)
    cost = plans.coarser_contacts(grid, coarse, 2.0) | {"seconds": plans.SOLVE * coarse / PER_SOLVE}
    return contact, cost


def _resolving(scene: ContactScene, grid: Grid, states: int) -> str:
    """Return what resolves the adhesive zone, and the time of the path then."""
    law, modulus = scene.contact.adhesion, build.modulus_of(scene)
    assert law is not None
    shape = resolving_shape(law, modulus, grid)
    if shape is None:
        return f"set contact.adhesion.range to {si(resolved_range(law, modulus, grid), 'm')} or more at the same work"
    nx, ny = shape
    finer = Grid(shape, (grid.lengths[0] / nx, grid.lengths[1] / ny), periodic=grid.periodic)
    convolutions = states * _convolutions(scene, finer)
    seconds = step_seconds(plans.contacts(finer, convolutions, "", solves=convolutions / PER_SOLVE), machine_rate())
    return f"set grid.shape to {nx} x {ny} or more, for which this step takes about {show_seconds(seconds)}"


def _convolutions(scene: ContactScene, grid: Grid) -> float:
    """Return the convolutions of a state with adhesion."""
    law, radius = scene.contact.adhesion, scene.shape.radius
    assert law is not None
    if scene.shape.kind == "sphere" and radius is not None:
        tabor = min(tabor_parameter(law.work, radius, build.modulus_of(scene), law.range), MOST_TABOR)
        return SPHERE_CONVOLUTIONS[0] + SPHERE_CONVOLUTIONS[1] * tabor * tabor
    return ADHESIVE_CONVOLUTIONS * (1.0 if zone_is_resolved(scene, grid) else UNRESOLVED)
