"""Random points of mixed lubrication: cylinders and balls, rough patches and repeated cells, layers, heat, supplies."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Grid, Lubricant, Material, OilLayer, contact_modulus, generate_surface, solve_mixed
from reports.golden.films import COATED, STEEL
from reports.golden.record import Case, Record, Trial, attributes, plain_figure

FIRST = 557_000
"""Seed of the first point."""
BRASS = Material(
    "brass", youngs_modulus=100e9, poissons_ratio=0.34, thermal_conductivity=110.0, density=8500.0, heat_capacity=380.0
)
POLYMER = Material("polymer", youngs_modulus=3e9, poissons_ratio=0.38)
CELLS, BALL_CELLS = (64, 32), (48, 48)
FILM_POINTS, FILM_CELLS = 150, 48
SUPPLY = 333.15
"""Temperature of the oil that is supplied where there is heat [K]."""

CYLINDERS: tuple[dict[str, Any], ...] = (
    {},
    {"hardness": 2e9},
    {"hardness": 6e9, "oil_volume": "patch"},
    {"flat": Body(BRASS), "hardness": 1.5e9},
    {"flat": Body(POLYMER), "pressure": 30e6},
    {"flat": COATED},
    {"contact_model": "uncoupled"},
    {"contact_model": "uncoupled", "asperity_separation": "film"},
    {"separation": "film"},
    {"thermal": "lumped", "hardness": 6e9},
    {"thermal": "full"},
    {"boundary_friction": {"kind": "pressure_dependent", "shear_strength": 5e6, "pressure_coefficient": 0.08}},
    {"supply": 0.4},
    {"shear_law": "eyring", "shear_stress_limit": 5e6},
)
"""Cylinders: what is special about each; the rest is drawn."""

BALLS: tuple[dict[str, Any], ...] = (
    {},
    {"hardness": 4e9},
    {"repeated": True},
    {"ratio": 2.0, "flat": COATED},
    {"contact_model": "uncoupled"},
    {"supply": 0.5},
    {"oil_volume": "hertz"},
)
"""Balls and ellipsoids: what is special about each; the rest is drawn."""


def cases() -> dict[str, Case]:
    """Points by name."""
    lines = {f"cylinder-{at:02d}{_special(one)}": partial(_cylinder, at, one) for at, one in enumerate(CYLINDERS)}
    return lines | {f"ball-{at:02d}{_special(one)}": partial(_ball, at, one) for at, one in enumerate(BALLS)}


def _special(one: dict[str, Any]) -> str:
    words = [value if isinstance(value, str) else key for key, value in one.items()]
    return "".join(f"-{word.replace('_', '-')}" for word in words[:2])


def _cylinder(number: int, special: dict[str, Any], trial: Trial, folder: Path) -> Record:
    rng = np.random.default_rng(FIRST + number)
    flat, radius = special.get("flat", Body(STEEL)), float(rng.uniform(2e-3, 10e-3))
    pressure, width = special.get("pressure", float(rng.uniform(0.15e9, 0.5e9))), 6e-3
    modulus = contact_modulus(flat.material, STEEL)
    half_width = 4 * radius * pressure / modulus
    load = 2 * math.pi * radius * pressure**2 / modulus * width * (1 + trial.nudge)
    repeated = special.get("separation") == "film"
    spacing = 5.0 * half_width / CELLS[0]
    grid = Grid(CELLS, (spacing, spacing), periodic=(repeated, True))
    given = _common(rng, special, grid, load, trial)
    if "supply" in special:
        given["supply"] = OilLayer(special["supply"] * 200e-9)
    if "thermal" in special:
        given["lubricant"] = Lubricant.of("ISO VG 46", temperature=SUPPLY, density_law="incompressible")
    point = solve_mixed(radius=radius, width=width, bodies=(flat, Body(STEEL)), film_points=FILM_POINTS, **given)
    return _record(point)


def _ball(number: int, special: dict[str, Any], trial: Trial, folder: Path) -> Record:
    rng = np.random.default_rng(FIRST + 100 + number)
    flat, radius = special.get("flat", Body(STEEL)), float(rng.uniform(5e-3, 15e-3))
    pressure, modulus = float(rng.uniform(0.4e9, 0.9e9)), contact_modulus(STEEL, STEEL)
    load = math.pi**3 * pressure**3 * radius**2 / (6 * modulus**2) * (1 + trial.nudge)
    half_axis = (3 * load * radius / (4 * modulus)) ** (1 / 3)
    repeated = "repeated" in special
    spacing = (0.5 if repeated else 3.2) * half_axis / BALL_CELLS[0] * special.get("ratio", 1.0) ** 0.5
    grid = Grid(BALL_CELLS, (spacing, spacing), periodic=(repeated, repeated))
    given = _common(rng, special, grid, load, trial)
    if "supply" in special:
        given["supply"] = OilLayer(special["supply"] * 100e-9)
    radii = (radius, radius * special.get("ratio", 1.0))
    return _record(solve_mixed(radii=radii, bodies=(flat, Body(STEEL)), film_cells=FILM_CELLS, **given))


def _common(rng: np.random.Generator, special: dict[str, Any], grid: Grid, load: float, trial: Trial) -> dict[str, Any]:
    """Roughness, oil, speeds and friction; a film about as thick as the surfaces are rough."""
    rms_height = float(rng.uniform(40e-9, 160e-9))
    whole = Grid(grid.shape, grid.spacing, periodic=(True, True))
    height = generate_surface(
        whole, rms_height=rms_height, correlation_length=5 * grid.spacing[0], seed=int(rng.integers(1000))
    )
    laws = {"density_law": "incompressible"}
    laws |= {key: special[key] for key in ("shear_law", "shear_stress_limit") if key in special}
    oil = Lubricant(10 ** rng.uniform(-1.6, -0.6), pressure_viscosity=float(rng.uniform(12e-9, 24e-9)), **laws)
    speed = 10 ** rng.uniform(-2.0, 0.0)
    speeds = ((speed, 0.0), (speed, 0.8 * speed), (0.3 * speed, speed))[rng.integers(3)]
    names = ("hardness", "oil_volume", "contact_model", "asperity_separation", "separation", "thermal")
    return {
        "height": height,
        "grid": grid,
        "load": load,
        "speeds": speeds,
        "lubricant": oil,
        "boundary_friction": special.get("boundary_friction", 0.12),
        "tolerance": 1e-4 * trial.tighter,
        "contact_tolerance": 1e-6 * trial.tighter,
        **{key: special[key] for key in names if key in special},
    }


def _record(point: Any) -> Record:
    names = (
        "friction", "boundary_force", "film_force", "load", "contact_load", "film_load", "lambda_ratio", "minimum_film",
        "contact_area", "imbalance", "oil_imbalance", "contact_temperature", "flash_temperature", "oil_on_contact",
    )  # fmt: skip
    record = Record({"status": point.status.value, "regime": point.regime.value, **attributes(point, names)})
    for name in ("contact", "flash"):
        hot = getattr(point, f"{name}_temperature")
        record.figures[f"{name}_rise"] = None if hot is None else plain_figure(hot - SUPPLY)
    record.figures |= {
        "mean_separation": float(point.separation.mean()),
        "contact_pressure_max": float(point.contact_pressure.max()),
        "film_pressure_max": float(point.film_pressure.max()),
        "film_shear_stress_mean": float(point.film_shear_stress.mean()),
        "oil_share": float(point.oil.share),
        "loaded_friction": float(point.oil.loaded_friction),
        "notes": float(len(point.notes)),
    }
    record.counts = {"films": float(point.evaluations), "contacts": float(point.contact_solves)}
    return record
