"""What the kinds with stick and slip share: the contact, a word on bodies that differ, stresses under the tractions.

Knows `build` and the solvers. Verified in tests/scenes/test_partial_slip_kind.py and test_rolling_kind.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from bem.grid import FloatArray, Grid
from bem.scenes import build, plans
from bem.scenes.context import Context, tell
from bem.scenes.planner import Plan, Step, padded_points
from bem.scenes.tables.pressing import StressedScene

if TYPE_CHECKING:
    from bem.contact import ContactSolution

FIRST_ORDER = "of first order in the cell at the edges of contact and stick; compare with the grid of twice the cell"
"""Why figures of stick and slip have no error bar."""


def pressed_together(scene: StressedScene, grid: Grid, context: Context) -> tuple[FloatArray, ContactSolution]:
    """The undeformed gap (nx, ny) [m] and the contact without friction."""
    from bem.contact import solve_contact

    gap = build.undeformed_gap(scene, grid, *build.both_heights(scene, grid, context))
    with context.timer("contact"):
        asked = scene.contact.prescribed(grid.area) | scene.contact.accuracy()
        contact = solve_contact(gap, build.operator_of(scene, grid, 0.0), **asked)
    tell(context, contact.notes)
    return gap, contact


def coupled(scene: StressedScene) -> bool:
    """Whether pressure makes the bodies slip, and traction changes the pressure."""
    from bem.convolution import couples

    bodies = build.bodies_of(scene)
    return couples(bodies if isinstance(bodies, tuple) else (bodies,))


def tell_coupled(scene: StressedScene, context: Context) -> None:
    """A note where it does."""
    if coupled(scene):
        context.note(
            "the bodies differ in elasticity, so that tractions change the pressure: the pressure is that of the "
            "contact without friction"
        )


def plan_around(scene: StressedScene, steps: Callable[[Grid, float], Iterable[Step]]) -> Plan:
    """The plan of a kind, whose own steps follow from the grid and the points of its transforms.

    Raises
    ------
    InfeasibleError : a load beyond hardness x area. InputError : surfaces that cannot be generated on the grid.
    """
    grid, outputs = build.grid_of(scene.grid), scene.outputs
    scene.contact.check_load(grid.area)
    stressed = (scene.lower if outputs.body == "lower" else scene.upper).build()
    return Plan.of(
        *plans.of_bodies(scene, grid, 1.0),
        plans.contact(grid, f"{scene.contact.behaviour}, {scene.contact.words()}"),
        *steps(grid, padded_points(grid.shape, grid.periodic)),
        plans.stresses(grid, stressed, outputs.body, len(outputs.wanted_depths()), fields=1, loads=3),
        plans.figures(grid.cells),
    )


def stresses_under(
    scene: StressedScene, grid: Grid, pressure: FloatArray, traction: FloatArray, context: Context
) -> dict[str, Any]:
    """Von Mises stress under the pressure (nx, ny) and the traction (2, nx, ny) on the lower body [Pa], as a record's
    fields; nothing where it is not wanted.
    """
    from bem.stress import stress_below

    depths = np.array(scene.outputs.wanted_depths())
    if not len(depths):
        return {}
    body, sign = scene.stressed()
    with context.timer("stresses"):
        below = stress_below(pressure, grid, body, depths, traction=sign * traction)
    return {
        "depth": below.depths,
        "von_mises": below.von_mises,
        "max_von_mises": below.max_von_mises,
        "max_von_mises_depth": below.max_von_mises_depth,
    }
