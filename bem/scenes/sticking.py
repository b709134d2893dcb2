"""Parts shared by the kinds with stick and slip: contact, dissimilar bodies, stresses under tractions, error bars.

Knows `build` and the solvers. Verified in tests/scenes/test_partial_slip_kind.py and test_rolling_kind.py.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from bem.grid import FloatArray, Grid
from bem.notes.accuracy import NoBar
from bem.notes.contact import FRICTION_ON_PRESSURE
from bem.scenes import build, plans, wheel_rail
from bem.scenes.context import Context, tell
from bem.scenes.planner import Plan, Step, padded_points
from bem.scenes.records import Figure, GridRecord, Series, grid_map
from bem.scenes.tables.pressing import StressedScene
from bem.scenes.wheel_rail import WheelRailRecord
from bem.tangential.friction_laws import SlipFriction

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.accuracy.richardson import Table
    from bem.contact import ContactSolution
    from bem.scenes.tables.tangential import PushedScene, RolledScene
    from bem.stress import StressSummary
    from bem.tangential import TangentialSolution


@dataclass(frozen=True)
class Site:
    """Contact in which bodies stick and slip: grid, undeformed gap (nx, ny) [m], the frictionless contact; `rough` :
    the gap counts from first touch; `centre` [m] : centre of rotation, from the middle of the grid."""

    grid: Grid
    gap: FloatArray
    contact: ContactSolution
    rough: bool
    centre: tuple[float, float] = (0.0, 0.0)

    def coarser(self, grid: Grid, contact: ContactSolution) -> Site:
        """On every second cell, whose middle lies half a cell beside that of an even number of them."""
        from bem.contact.nested_iteration import sample

        gap = np.array(sample(self.gap, grid.shape, grid.periodic))
        middles = [
            0.5 * ((n - 1) * d - (m - 1) * e)
            for n, d, m, e in zip(self.grid.shape, self.grid.spacing, grid.shape, grid.spacing, strict=True)
        ]
        centre = (self.centre[0] + middles[0], self.centre[1] + middles[1])
        return Site(grid, gap - gap.min() if self.rough else gap, contact, self.rough, centre)

    def carried(self, turn: float) -> tuple[float, float]:
        """Return the displacement along x and y that a rotation about `centre` adds to one about the middle of the
        grid."""
        return turn * self.centre[1], -turn * self.centre[0]


@dataclass(frozen=True, eq=False, kw_only=True)
class StickRecord(GridRecord, WheelRailRecord):
    """A contact that sticks and slips, and the stresses under it where they are asked for; of several steps, the last
    one's."""

    load: Annotated[float, Figure("N", "load")]
    contact_area_fraction: Annotated[float, Figure("", "real contact area over that of the grid")]
    pressure: Annotated[FloatArray, grid_map("Pa", "contact pressure")]
    traction_x: Annotated[FloatArray, grid_map("Pa", "traction on the lower body along x")]
    traction_y: Annotated[FloatArray, grid_map("Pa", "traction on the lower body along y")]
    stick_state: Annotated[FloatArray, grid_map("1", "0 open, 1 sticks, 2 slips")]
    traction_bound: Annotated[FloatArray | None, grid_map("Pa", "largest traction without slip")] = None
    depth: Annotated[FloatArray | None, Series(("depth",), "m", "depth below the surface")] = None
    von_mises: Annotated[FloatArray | None, Series(("depth", "x", "y"), "Pa", "von Mises stress")] = None
    contact_residual: Annotated[float, Figure("", "relative residual of the contact", unjudged=True)]


def stuck(
    grid: Grid, contact: ContactSolution, found: TangentialSolution, friction: float | SlipFriction
) -> dict[str, Any]:
    """The fields of `StickRecord`, but for stresses."""
    return {
        "load": contact.load,
        "contact_area_fraction": contact.contact_area / grid.area,
        "pressure": contact.pressure,
        "traction_x": found.traction[0],
        "traction_y": found.traction[1],
        "stick_state": np.where(contact.pressure > 0, np.where(found.slip.any(axis=0), 2.0, 1.0), 0.0),
        "traction_bound": static_bound(friction, contact, grid) if isinstance(friction, SlipFriction) else None,
        "contact_residual": contact.residual,
    }


def friction_limit(friction: float | SlipFriction, site: Site) -> float:
    """Return the largest tangential force [N] that the contact carries: friction x load, or the sum of the law's bounds
    without slip."""
    if not isinstance(friction, SlipFriction):
        return friction * site.contact.load
    return float(static_bound(friction, site.contact, site.grid).sum()) * site.grid.cell_area


def static_bound(friction: SlipFriction, contact: ContactSolution, grid: Grid) -> FloatArray:
    """Return the largest traction without slip (nx, ny) [Pa] by a law of friction."""
    from bem.tangential.problem import friction_bound

    return friction_bound(contact, grid, friction)[1]


def friction_words(friction: float | SlipFriction) -> str:
    """Return a coefficient or a law in words."""
    return f"friction {friction:g}" if isinstance(friction, float) else f"friction law {friction.name}"


def pressed_together(scene: StressedScene, context: Context) -> Site:
    """The contact without friction."""
    from bem.contact import solve_contact

    grid = build.grid_of(scene.grid)
    lower, upper = build.both_heights(scene, grid, context)
    gap = build.undeformed_gap(scene, grid, lower, upper)
    with context.timer("contact"):
        asked = scene.contact.prescribed(grid.area) | scene.contact.accuracy()
        contact = solve_contact(gap, build.operator_of(scene, grid, 0.0), **asked)
    tell(context, contact.notes)
    wheel_rail.tell_profiles(scene, grid, contact, context)
    return Site(grid, gap, contact, bool(lower.any() or upper.any()))


@dataclass(frozen=True)
class Coarse:
    """Solution on the grid of twice the cell size: figures with error bars, the contact under its tractions, these
    tractions (2, nx, ny) on the lower body [Pa], whether all of it converged; and figures with half the steps of the
    load, where it has any, with their contact and tractions."""

    figures: dict[str, float]
    contact: ContactSolution
    traction: FloatArray
    converged: bool
    fewer: dict[str, float] | None = None
    fewer_left: tuple[ContactSolution, FloatArray] | None = None


@dataclass(frozen=True)
class Found:
    """Input of the error bars: figures, the contact under its tractions, rules, the figures that are `given`, the
    largest residual, friction x load [N], stresses."""

    figures: dict[str, float]
    contact: ContactSolution
    rules: Table
    given: tuple[str, ...]
    residual: float
    limit: float
    below: StressSummary | None


def bars(scene: StressedScene, site: Site, found: Found, again: Callable[[Site], Coarse]) -> ErrorBars:
    """Error bars of figures that have rules, of contact and stresses, from what `again` finds on the coarser grid."""
    from bem.accuracy import ContactCase, ErrorBars, contact_bars, solve_coarser, stress_bars
    from bem.accuracy.sticking import sticking_bars

    given = scene.contact.prescribed(site.grid.area)
    prescribed = [name for name in found.given if name in found.figures]
    operator = build.operator_of(scene, site.grid, 0.0)
    case = ContactCase(operator, site.gap, site.contact, **given, from_touch=site.rough)
    coarser = solve_coarser(case, scene.contact.max_iterations)
    if coarser.grid is None or coarser.solution is None:
        return ErrorBars.unknown(found.figures, coarser.why, prescribed=prescribed)
    there = again(site.coarser(coarser.grid, coarser.solution))
    # both under their tractions: where the pressure follows them, that it does is no error
    case, coarser = replace(case, solution=found.contact), replace(coarser, solution=there.contact)
    of_contact = contact_bars(case, coarser).renamed({name: name for name in ("load", "contact_area_fraction")})
    if not there.converged:
        return ErrorBars.unknown(found.figures, NoBar.COARSER_UNSOLVED, prescribed=prescribed) | of_contact
    own = sticking_bars(
        found.rules, case, found.figures, there.figures, found.residual, there.fewer, found.given, found.limit
    )
    if found.below is None:
        return own | of_contact
    body, sign = scene.stressed()
    below = replace(found.below, yielded_volume=None)
    fewer = None
    if there.fewer_left is not None:
        contact, traction = there.fewer_left
        fewer = contact.pressure, sign * traction
    return own | of_contact | stress_bars(case, coarser, body, below, traction=sign * there.traction, fewer=fewer)


def coupled(scene: StressedScene) -> bool:
    """Return True if pressure makes the bodies slip, and traction changes the pressure."""
    from bem.convolution import couples

    bodies = build.bodies_of(scene)
    return couples(bodies if isinstance(bodies, tuple) else (bodies,))


def tell_coupled(scene: StressedScene, context: Context) -> None:
    """A note that it is not followed, where it does."""
    if coupled(scene):
        context.note(FRICTION_ON_PRESSURE(reason="left-out"))


def plan_around(scene: PushedScene | RolledScene, steps: Callable[[Grid, float], Iterable[Step]], again: float) -> Plan:
    """The plan of a kind, whose own steps follow from the grid and the points of its transforms; its error bars take
    `again` times as many, on a quarter of the points.

    Raises
    ------
    InfeasibleError : a load beyond hardness x area. InputError : surfaces that cannot be generated on the grid.
    """
    grid, outputs = build.grid_of(scene.grid), scene.outputs
    scene.contact.check_load(grid.area)
    stressed = (scene.lower if outputs.body == "lower" else scene.upper).build()
    points = padded_points(grid.shape, grid.periodic)
    own = tuple(steps(grid, points))
    capped, stiffness = scene.contact.behaviour == "capped", plans.stiffest(scene.lower.build(), scene.upper.build())
    depths = len(scene.wanted_depths())
    coarser = plans.coarser_contact(grid, depths, capped=capped, stiffness=stiffness, fields=14.5)
    coarser["transforms"] += again * sum(step.transforms for step in own if not step.skipped)
    return Plan.of(
        *plans.of_bodies(scene, grid, 1.0),
        plans.contact(grid, f"{scene.contact.behaviour}, {scene.contact.words()}", capped=capped, stiffness=stiffness),
        *own,
        plans.stresses(grid, stressed, outputs.body, depths, fields=1, loads=3),
        plans.error_bars(outputs.errors, "the same on the grid of twice the cell", **coarser),
        plans.figures(grid.cells),
    )


def stresses_under(
    scene: StressedScene, grid: Grid, pressure: FloatArray, traction: FloatArray, context: Context
) -> StressSummary | None:
    """Stresses under the pressure (nx, ny) and the traction (2, nx, ny) on the lower body [Pa]; None where they are not
    wanted.
    """
    from bem.stress import summarise_stress

    depths = np.array(scene.wanted_depths())
    if not len(depths):
        return None
    body, sign = scene.stressed()
    with context.timer("stresses"):
        return summarise_stress(pressure, grid, body, depths, traction=sign * traction)


def stress_figures(below: StressSummary | None) -> dict[str, Any]:
    """Von Mises stress as a record's fields."""
    if below is None:
        return {}
    return {
        "depth": below.depths,
        "von_mises": below.von_mises,
        "max_von_mises": below.max_von_mises,
        "max_von_mises_depth": below.max_von_mises_depth,
    }
