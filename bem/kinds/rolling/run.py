"""Run of a case of kind `rolling`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bem.errors import Status
from bem.kinds.rolling.errors import bars_of
from bem.kinds.rolling.record import RollingRecord
from bem.kinds.rolling.scene import RollingContactScene
from bem.kinds.rolling.solve import rolled_figures, solve_rolling_contact
from bem.scenes import sticking
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.sticking import Site

if TYPE_CHECKING:
    from bem.tangential import TangentialSolution


def run(scene: RollingContactScene, context: Context) -> RollingRecord:
    """Solve the contact, then what sticks while it rolls."""
    site = sticking.pressed_together(scene, context)
    with context.timer("rolling"):
        found = solve_rolling_contact(scene, site)
    tell(context, found.notes)
    sticking.tell_coupled(scene, context)
    below = sticking.stresses_under(scene, site.grid, site.contact.pressure, found.traction, context)
    wanted = scene.outputs.errors and Status.CONVERGED is site.contact.status is found.status
    errors = error_bars(context, wanted, lambda: bars_of(scene, site, found, below))
    return _record(site, found, rolled_figures(site, found, scene.roll.spin) | sticking.stress_figures(below), errors)


def _record(site: Site, found: TangentialSolution, extra: dict[str, Any], errors: dict[str, Any]) -> RollingRecord:
    grid, contact = site.grid, site.contact
    slid = found.slip / grid.spacing[0]
    energy = -(found.traction * slid).sum(axis=0)
    work = found.dissipated_energy / grid.spacing[0]
    status = contact.status if contact.status is not Status.CONVERGED else found.status
    return RollingRecord(
        x=grid.x,
        y=grid.y,
        **sticking.stuck(grid, contact, found),
        **extra,
        resolved_work=float(energy.sum()) * grid.cell_area / work if work > 0 else 1.0,
        slip_residual=found.residual,
        convolutions=found.convolutions,
        slip=np.hypot(*slid),
        friction_energy=energy,
        **errors,
        status=status,
        where=f"contact: {contact.status.message}; rolling: {found.status.message}, residual {found.residual:.1e}",
    )
