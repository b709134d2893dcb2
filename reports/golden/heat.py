"""Surface temperatures of one and two bodies, steady and over time, at bulk temperatures of their own."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Grid, Material
from bem.heat import TemperatureSolution, flash_temperature, surface_temperature, surface_temperature_history
from reports.golden.record import Case, Record, Trial, attributes, plain_figure

FREE = Grid((36, 24), (2e-6, 3e-6))
STEEL = Body(
    Material(
        "steel",
        youngs_modulus=210e9,
        poissons_ratio=0.3,
        thermal_conductivity=46.0,
        density=7800.0,
        heat_capacity=460.0,
    )
)
BRONZE = Body(
    Material(
        "bronze",
        youngs_modulus=110e9,
        poissons_ratio=0.34,
        thermal_conductivity=60.0,
        density=8800.0,
        heat_capacity=380.0,
    )
)
STEADY: dict[str, dict[str, Any]] = {
    "one": {"bodies": STEEL, "speeds": 2.0},
    "unlike": {"bodies": (STEEL, BRONZE), "speeds": (1.5, 0.2)},
    "unequal-bulk": {"bodies": (STEEL, BRONZE), "speeds": (1.5, -0.3), "bulk": (330.0, 345.0)},
    "periodic": {
        "bodies": (STEEL, BRONZE),
        "speeds": (1.5, 0.2),
        "grid": Grid(FREE.shape, FREE.spacing, periodic=(False, True)),
    },
}
"""Arguments of steady temperatures."""


def cases() -> dict[str, Case]:
    """Temperatures by name."""
    found: dict[str, Case] = {f"steady-{name}": partial(_steady, given) for name, given in STEADY.items()}
    return found | {"flash": _flash, "history": _history}


def _flux(grid: Grid, trial: Trial) -> Any:
    """Heat of an ellipse and of a second spot behind it [W/m^2]."""
    x, y = (axis / half for axis, half in zip((grid.x, grid.y), (20e-6, 25e-6), strict=True))
    ellipse = np.sqrt(np.maximum(1 - x[:, None] ** 2 - y[None, :] ** 2, 0.0))
    spot = np.exp(-(((x[:, None] - 1.2) / 0.2) ** 2) - ((y[None, :] + 0.4) / 0.3) ** 2)
    return 2e8 * (1 + trial.nudge) * (ellipse + np.where(spot > 0.1, spot, 0.0))


def _record(name: str, found: TemperatureSolution) -> dict[str, Any]:
    figures = attributes(found, ("maximum", "mean", "share"))
    figures["status"] = found.status.value
    figures["surfaces"] = float(np.sqrt(np.mean(found.surfaces**2)))
    figures["partition"] = plain_figure(np.mean(found.partition))
    return {f"{name}{key}": value for key, value in figures.items()}


def _steady(given: dict[str, Any], trial: Trial, folder: Path) -> Record:
    given = {"grid": FREE, **given}
    found = surface_temperature(_flux(given["grid"], trial), tolerance=1e-8 * trial.tighter, **given)
    return Record(_record("", found), {"iterations": float(found.iterations)})


def _flash(trial: Trial, folder: Path) -> Record:
    pressure = 4 * _flux(FREE, trial)
    given = {"friction": 0.12, "speeds": (1.2, 0.7), "bulk": (350.0, 350.0)}
    return Record(_record("", flash_temperature(pressure, FREE, (STEEL, BRONZE), **given)))


def _history(trial: Trial, folder: Path) -> Record:
    flux, steps = _flux(FREE, trial), 4
    found = surface_temperature_history(
        np.linspace(0, 4e-5, steps + 1),
        [share * flux for share in (1.0, 0.4, 0.0, 0.7)],
        FREE,
        (STEEL, BRONZE),
        speeds=(1.5, 0.2),
        bulk=(330.0, 345.0),
    )
    return Record({key: value for at, one in enumerate(found) for key, value in _record(f"step-{at}.", one).items()})
