"""Run of a case of kind `rolling`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from bem.errors import Status
from bem.kinds.rolling.curved_rail import bars_on_curved_rail, roll_on_curved_rail
from bem.kinds.rolling.errors import bars_of
from bem.kinds.rolling.record import RollingRecord
from bem.kinds.rolling.scene import RollingContactScene
from bem.kinds.rolling.solve import history_curves, rolled_figures, solve_rolling_contact, solve_rolling_history
from bem.scenes import sticking, wheel_rail
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.sticking import Site

if TYPE_CHECKING:
    from bem.tangential import TangentialSolution


def run(scene: RollingContactScene, context: Context) -> RollingRecord:
    """Solve the contact, then what sticks while it rolls."""
    if scene.shape.conforming:
        return _run_on_curved_rail(scene, context)
    site = sticking.pressed_together(scene, context)
    curves: dict[str, Any] = {}
    with context.timer("rolling"):
        if scene.history is None:
            found = solve_rolling_contact(scene, site)
        else:
            history = solve_rolling_history(
                scene, site, lambda done, total: context.progress(done, total, "steps of a cell")
            )
            found, curves = history.last, history_curves(scene, site, history)
    tell(context, found.notes)
    sticking.tell_coupled(scene, context)
    below = sticking.stresses_under(scene, site.grid, site.contact.pressure, found.traction, context)
    wanted = scene.outputs.errors and Status.CONVERGED is site.contact.status is found.status
    errors = error_bars(context, wanted, lambda: bars_of(scene, site, found, below))
    return _record(
        scene,
        site,
        found,
        rolled_figures(site, found, scene.roll.spin) | sticking.stress_figures(below) | curves,
        errors,
    )


def _run_on_curved_rail(scene: RollingContactScene, context: Context) -> RollingRecord:
    """Solve pressures and tractions on the curved surface of the rail together."""
    site, solved = roll_on_curved_rail(scene, context)
    found = solved.rolling
    wanted = scene.outputs.errors and Status.CONVERGED is site.contact.status is found.status
    errors = error_bars(context, wanted, lambda: bars_on_curved_rail(scene, site, solved))
    figures = rolled_figures(site, found, scene.roll.spin) | {"lateral_force": solved.lateral_force}
    return _record(scene, site, found, figures, errors)


def _record(
    scene: RollingContactScene, site: Site, found: TangentialSolution, extra: dict[str, Any], errors: dict[str, Any]
) -> RollingRecord:
    """Return the results of a case; `extra` has figures and curves, `errors` the error bars."""
    grid, contact = site.grid, site.contact
    slip_per_length = found.slip / grid.spacing[0]
    energy = -(found.traction * slip_per_length).sum(axis=0)
    work = found.dissipated_energy / grid.spacing[0]
    status = contact.status if contact.status is not Status.CONVERGED else found.status
    return RollingRecord(
        x=grid.x,
        y=grid.y,
        **sticking.stuck(grid, contact, found, scene.roll.friction),
        **wheel_rail.fields(scene, grid, contact),
        **extra,
        resolved_work=float(energy.sum()) * grid.cell_area / work if work > 0 else 1.0,
        spin=scene.roll.spin if scene.shape.kind == "profiles" else None,
        slip_residual=found.residual,
        convolutions=found.convolutions,
        slip=np.hypot(*slip_per_length),
        friction_energy=energy,
        **errors,
        status=status,
        where=f"contact: {contact.status.message}; rolling: {found.status.message}, residual {found.residual:.1e}",
    )
