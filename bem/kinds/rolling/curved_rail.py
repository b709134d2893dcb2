"""Steady rolling of a wheel on the curved surface of a rail: solver call, site, and error bars."""

from __future__ import annotations

from typing import TYPE_CHECKING

from bem.errors import Status
from bem.grid import Grid
from bem.kinds.rolling.scene import RollingContactScene
from bem.kinds.rolling.solve import rolled_figures
from bem.scenes import build, wheel_rail
from bem.scenes.context import Context, tell
from bem.scenes.sticking import Site

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.profiles.curved_rolling import CurvedRolling


def solve_on_curved_rail(scene: RollingContactScene, grid: Grid, tolerance: float) -> tuple[Site, CurvedRolling]:
    """Solve pressures and tractions of a scene on a grid whose y is the arc length of the rail."""
    from bem.profiles.curved_rolling import Rolling, solve_curved_rolling
    from bem.profiles.curved_surface import CurvedSurface
    from bem.profiles.gap import rows_on_rail

    placed, roll = scene.shape.placed(), scene.roll
    point = placed.contact_points[0]
    rows, bodies = rows_on_rail(placed, point, grid.y), build.bodies_of(scene)
    surface = CurvedSurface(grid, rows.y, rows.z, rows.angle, bodies if isinstance(bodies, tuple) else (bodies,))
    gap = build.shape_of(scene.shape, grid)
    assert isinstance(roll.friction, float)
    found = solve_curved_rolling(
        gap,
        surface,
        point.angle,
        Rolling((roll.creepage, roll.creepage_across), roll.spin, placed.rolling_curvature(point)),
        friction=roll.friction,
        load=scene.contact.load_on(grid.area),
        approach=scene.contact.approach,
        tolerance=tolerance,
        slip_tolerance=roll.tolerance,
        max_iterations=scene.contact.max_iterations,
    )
    return Site(grid, gap, found.contact, False), found


def roll_on_curved_rail(scene: RollingContactScene, context: Context) -> tuple[Site, CurvedRolling]:
    """Solve the contact of a scene under friction, and note what its profiles do."""
    grid = build.grid_of(scene.grid)
    with context.timer("rolling"):
        site, found = solve_on_curved_rail(scene, grid, scene.contact.tolerance)
    tell(context, found.contact.notes)
    wheel_rail.tell_profiles(scene, grid, found.contact, context)
    return site, found


def bars_on_curved_rail(scene: RollingContactScene, site: Site, found: CurvedRolling) -> ErrorBars:
    """Estimate errors from the same rolling on the grid of twice the cell; of the resultant of the pressures it is the
    difference to that grid."""
    from bem.accuracy import Coarser, ContactCase, ErrorBars, contact_bars
    from bem.accuracy.bars import GRID
    from bem.accuracy.coarsened import COARSER_TOLERANCE, half_grid, is_narrow
    from bem.accuracy.sticking import ROLL_RULES, sticking_bars
    from bem.contact.certificate import free_edges_reached
    from bem.notes.accuracy import NoBar

    given = scene.contact.prescribed(site.grid.area)
    case = ContactCase(build.operator_of(scene, site.grid, 0.0), site.gap, site.contact, **given)
    figures = rolled_figures(site, found.rolling, scene.roll.spin)
    creepages = ("creepage", "creepage_across")
    reason = NoBar.FREE_EDGE if free_edges_reached(site.grid.periodic, site.contact.pressure) else None
    if is_narrow(case):
        reason = NoBar.FEW_CELLS_WIDE
    unknown = (*figures, "lateral_force", "load", "contact_area_fraction")
    prescribed = [name for name in unknown if name in (*case.prescribed, *creepages)]
    if reason is not None:
        return ErrorBars.unknown(unknown, reason, prescribed=prescribed)
    there, coarse = solve_on_curved_rail(scene, half_grid(site.grid), COARSER_TOLERANCE)
    if not coarse.contact.status is coarse.rolling.status is Status.CONVERGED:
        return ErrorBars.unknown(unknown, NoBar.COARSER_UNSOLVED, prescribed=prescribed)
    friction = scene.roll.friction
    assert isinstance(friction, float)
    of_contact = contact_bars(case, Coarser(there.grid, there.contact))
    residual = max(site.contact.residual, found.rolling.residual)
    own = sticking_bars(
        ROLL_RULES,
        case,
        figures,
        rolled_figures(there, coarse.rolling, scene.roll.spin),
        residual,
        None,
        creepages,
        friction * site.contact.load,
    )
    lateral = ErrorBars.together({GRID: {"lateral_force": abs(coarse.lateral_force - found.lateral_force)}})
    return own | lateral | of_contact.renamed({name: name for name in ("load", "contact_area_fraction")})
