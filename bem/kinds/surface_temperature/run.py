"""Run of a case of kind `surface-temperature`."""

from __future__ import annotations

from typing import Any

from bem.errors import Status
from bem.kinds.surface_temperature.record import SurfaceTemperatureRecord
from bem.kinds.surface_temperature.scene import SurfaceTemperatureScene
from bem.scenes import build
from bem.scenes.context import Context, error_bars, tell


def run(scene: SurfaceTemperatureScene, context: Context) -> SurfaceTemperatureRecord:
    """Solve the contact, then the temperature of its surfaces."""
    from bem.accuracy import rubbing_bars

    grid = build.grid_of(scene.grid)
    gap = build.undeformed_gap(scene, grid, *build.both_heights(scene, grid, context))
    case = scene.case(grid)
    with context.timer("contact"):
        contact = case.contact(grid, gap)
    with context.timer("temperature"):
        found = case.temperature(grid, contact)
    tell(context, (*contact.notes, *found.notes))
    figures: dict[str, Any] = case.figures(grid, contact, found)
    status = contact.status if contact.status is not Status.CONVERGED else found.status
    wanted = status is Status.CONVERGED
    return SurfaceTemperatureRecord(
        **figures,
        x=grid.x,
        y=grid.y,
        load=contact.load,
        contact_residual=contact.residual,
        temperature_residual=found.residual,
        pressure=contact.pressure,
        surface_temperature=found.temperature,
        heat_lower=found.heat[0],
        heat_made=found.heat.sum(axis=0),
        **error_bars(context, wanted, lambda: rubbing_bars(case, grid, gap, (contact, found))),
        status=status,
        where=f"contact: {contact.status}, temperature: {found.status}",
    )
