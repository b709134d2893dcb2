"""Contact of wheel and rail on their curved surface: solver call, results and error bars."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from bem.grid import FloatArray, Grid
from bem.kinds.contact.response import Response
from bem.kinds.contact.scene import ContactScene
from bem.scenes import build
from bem.scenes.context import Context

if TYPE_CHECKING:
    from bem.accuracy import ContactCase, ErrorBars
    from bem.contact import ContactSolution
    from bem.profiles.curved_contact import CurvedContact
    from bem.stress import StressSummary


def solve_on_curved_rail(scene: ContactScene, grid: Grid, undeformed: FloatArray, tolerance: float) -> CurvedContact:
    """Solve the contact of a scene on a grid whose y is the arc length of the rail."""
    from bem.profiles.curved_contact import solve_curved_contact
    from bem.profiles.curved_surface import CurvedSurface
    from bem.profiles.gap import rows_on_rail

    placed = scene.shape.placed()
    point = placed.contact_points[0]
    rows, bodies = rows_on_rail(placed, point, grid.y), build.bodies_of(scene)
    surface = CurvedSurface(grid, rows.y, rows.z, rows.angle, bodies if isinstance(bodies, tuple) else (bodies,))
    return solve_curved_contact(
        undeformed,
        surface,
        point.angle,
        load=scene.contact.load_on(grid.area),
        approach=scene.contact.approach,
        tolerance=tolerance,
        max_iterations=scene.contact.max_iterations,
    )


@dataclass(frozen=True, eq=False)
class CurvedRailResponse(Response):
    """Elastic contact on the curved surface."""

    solved: CurvedContact

    @property
    def contact(self) -> ContactSolution:
        """See `Response`."""
        return self.solved.contact

    def figures(self, scene: ContactScene) -> dict[str, Any]:
        """See `Response`."""
        return {"lateral_force": self.solved.lateral_force}

    def bars(self, scene: ContactScene, case: ContactCase, below: StressSummary | None, context: Context) -> ErrorBars:
        """See `Response`; of the lateral force it is the difference to the grid of twice the cell."""
        from bem.accuracy import Coarser, ErrorBars, contact_bars
        from bem.accuracy.bars import GRID
        from bem.accuracy.coarsened import COARSER_TOLERANCE, half_grid, is_narrow
        from bem.contact.certificate import free_edges_reached
        from bem.errors import Status
        from bem.notes.accuracy import NoBar

        names = ("lateral_force",)
        reason = NoBar.FREE_EDGE if free_edges_reached(case.grid.periodic, self.contact.pressure) else None
        if is_narrow(case):
            reason = NoBar.FEW_CELLS_WIDE
        if reason is not None:
            return contact_bars(case, Coarser(None, None, reason)) | ErrorBars.unknown(names, reason)
        grid = half_grid(case.grid)
        there = solve_on_curved_rail(scene, grid, build.shape_of(scene.shape, grid), COARSER_TOLERANCE)
        if there.contact.status is not Status.CONVERGED:
            failed = Coarser(None, None, NoBar.COARSER_UNSOLVED)
            return contact_bars(case, failed) | ErrorBars.unknown(names, NoBar.COARSER_UNSOLVED)
        lateral = abs(there.lateral_force - self.solved.lateral_force)
        own = ErrorBars.together({GRID: {"lateral_force": lateral}})
        return contact_bars(case, Coarser(grid, there.contact)) | own
