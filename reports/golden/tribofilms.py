"""Tribofilms: growth laws, properties over thickness, and growth with wear, lag, substrate and initial film."""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bem import Grid, Material
from bem.tribofilm import (
    FadingSubstrate,
    FilmContact,
    StressActivatedGrowth,
    Table,
    evolve_film,
    grow_local_film,
    grow_tribofilm,
)
from reports.golden.record import Case, Record, Trial, plain_figure

IRON = Material("iron", youngs_modulus=210e9, poissons_ratio=0.3, hardness=8e9)
GROWTH = StressActivatedGrowth.from_electron_volts(1e-2, 0.6, 3.8)
HARDNESS = FadingSubstrate(
    substrate=6e9, film=2e9, length=30e-9, temperature_slope=2e-3, substrate_temperature_slope=5e-4
)
MODULUS = Table(
    thickness=(0.0, 40e-9, 120e-9), value=(2.1e11, 1.3e11, 9e10), temperature=(300.0, 400.0), factor=(1, 0.8)
)
BALANCES: dict[str, dict[str, float]] = {
    "wear": {"wear_coefficient": 2e-3, "concentration_constant": 2e7},
    "lag": {"wear_coefficient": 2e-3, "concentration_constant": 2e7, "lag": 150.0},
    "initial": {"wear_coefficient": 3e-3, "concentration_constant": 5e7, "initial_thickness": 30e-9},
    "initial-lag": {"wear_coefficient": 2e-3, "lag": 200.0, "initial_thickness": 30e-9},
}
"""Constants of growth and wear."""


def cases() -> dict[str, Case]:
    """Films by name."""
    found: dict[str, Case] = {f"evolved-{name}": partial(_evolved, given) for name, given in BALANCES.items()}
    found |= {f"mean-{name}": partial(_mean, BALANCES[name]) for name in ("lag", "initial-lag")}
    return found | {"local": _local, "warm": _warm, "laws": _laws}


def _contact(trial: Trial, **change: Any) -> FilmContact:
    """A rough tip on a flat that conducts no heat."""
    grid = Grid((24, 20), (2e-9, 2e-9))
    x, y = grid.x[:, None], grid.y[None, :]
    gap = (x**2 + y**2) / (2 * 60e-9) + 0.4e-9 * np.cos(x / 3e-9) * np.cos(y / 4e-9)
    given: dict[str, Any] = {
        "gap": gap,
        "grid": grid,
        "substrate": IRON,
        "counterface": None,
        "load": 8e-7 * (1 + trial.nudge),
        "growth": GROWTH,
        "hardness": HARDNESS,
        "modulus": MODULUS,
        "temperature": 360.0,
        "contact_tolerance": 1e-8 * trial.tighter,
    }
    return FilmContact(**{**given, **change})


def _history(found: Any) -> dict[str, float]:
    figures = {}
    for name in ("thickness", "grown", "worn", "substrate_wear"):
        values = getattr(found, name)
        figures |= {f"{name}.{at}": float(value) for at, value in enumerate(values[1:])}
    return figures


def _evolved(given: dict[str, float], trial: Trial, folder: Path) -> Record:
    rate = 2e-10 * (1 + trial.nudge)
    times = np.linspace(0, 800, 5)
    found = evolve_film(
        times, lambda thickness: rate * np.exp(-thickness / 60e-9), tolerance=1e-8 * trial.tighter, **given
    )
    return Record(_history(found), {"evaluations": float(found.evaluations)})


def _mean(given: dict[str, float], trial: Trial, folder: Path) -> Record:
    found = grow_tribofilm(np.linspace(0, 800, 9), _contact(trial), **given)
    figures: dict[str, Any] = _history(found.history) | {
        "map": float(np.sqrt(np.mean(found.film_map**2))),
        "pressure": float(np.sqrt(np.mean(found.film_pressure**2))),
        "steady": plain_figure(found.steady),
    }
    return Record(figures, {"contact_solves": float(found.contacts_solved)})


def _local(trial: Trial, folder: Path) -> Record:
    given = BALANCES["initial"] | {"initial_thickness": 2e-9}
    found = grow_local_film(np.linspace(0, 400, 3), _contact(trial), **given)
    figures = _history(found) | {"map": float(np.sqrt(np.mean(found.film_map**2)))}
    return Record(figures, {"contact_solves": float(found.contacts_solved)})


def _warm(trial: Trial, folder: Path) -> Record:
    """Growth where rubbing heats each spot, averaged over the nominal area."""
    warm = {"thermal_conductivity": 46.0, "density": 7800.0, "heat_capacity": 460.0}
    steel = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, hardness=7e9, **warm)
    contact = _contact(trial, substrate=steel, counterface=steel, speeds=(0.0, 40.0), average="nominal")
    found = grow_tribofilm(np.linspace(0, 400, 3), contact, **BALANCES["wear"])
    warmest = max(sample.temperature for sample in found.contacts)
    return Record(_history(found.history) | {"temperature": float(warmest), "hardness": contact.hardness_at(50e-9)})


def _laws(trial: Trial, folder: Path) -> Record:
    """Growth over stress and temperature; hardness and modulus over thickness and temperature."""
    stress = np.array([0.0, 5e8, 2e9]) * (1 + trial.nudge)
    figures = {f"growth.{at}": float(value) for at, value in enumerate(GROWTH.rate(stress, 360.0))}
    figures |= {f"hotter.{at}": float(value) for at, value in enumerate(GROWTH.rate(stress, 400.0))}
    for name, law in {"hardness": HARDNESS, "modulus": MODULUS}.items():
        figures |= {f"{name}.{at}": law(thickness, 360.0) for at, thickness in enumerate((0.0, 20e-9, 90e-9))}
        figures |= {f"{name}_cold.{at}": law(thickness, 280.0) for at, thickness in enumerate((0.0, 20e-9, 90e-9))}
    return Record(figures)
