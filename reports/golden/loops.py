"""Random wear loops of few cycles: criteria of `bem.run_in`, and replaceable parts that scenes reach.

A loop is short on purpose: pieces are cut where a stress exceeds a strength, so a change of a stress by its last bit
moves a whole voxel, and the cycles after it start from another surface.
"""

from __future__ import annotations

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Grid, Layer, Material, generate_surface, run_in, run_scene
from reports.golden.record import Case, Record, Trial, plain_figure
from reports.golden.scenes import record_of_run

FIRST = 558_000
"""Seed of the first loop."""
CYCLES = 3
HARD = Material("hard steel", youngs_modulus=210e9, poissons_ratio=0.3, hardness=6e9)
SOFT = Material("soft steel", youngs_modulus=210e9, poissons_ratio=0.3, hardness=1.8e9)
FILM = Layer(Material("film", youngs_modulus=120e9, poissons_ratio=0.3, hardness=1.5e9), 150e-9)

CRITERIA: dict[str, dict[str, Any]] = {
    "von-mises": {"criterion": "von_mises"},
    "tresca-coated": {"criterion": "tresca", "lower": Body(SOFT, layer=FILM)},
    "averaged": {"criterion": {"kind": "averaged_von_mises", "averaging_length": 400e-9}},
    "archard": {"criterion": {"kind": "archard", "specific_wear_rate": 5e-15, "distance": 0.5}},
    "energy-rough-counterface": {
        "criterion": {"kind": "energy", "energy_wear_rate": 2e-14, "distance": 0.5},
        "upper_rms": 60e-9,
    },
}
"""Loops of `bem.run_in`: what is special about each; the rest is drawn."""

WEAR: dict[str, Any] = {
    "kind": "wear",
    "repetitions": 1,
    "lower": {
        "material": "steel-disk",
        "surface": {"kind": "generated", "rms_height": "120 nm", "correlation_length": "0.4 um"},
    },
    "upper": {
        "material": "steel-cylinder",
        "surface": {"kind": "generated", "rms_height": "30 nm", "correlation_length": "0.3 um"},
    },
    "cylinder": {"radius": "2 mm", "width": "6 mm", "loads": ["2.5 N"], "friction": 0.16},
    "domain": {"cells": 40, "lengths": "4 um"},
    "depths": {"count": 20, "spacing": "95 nm"},
    "cycles": {"count": 3, "settled": 2},
}
MIXED: dict[str, Any] = {
    "kind": "running-in",
    "lower": {
        "material": "steel-disk-110HV",
        "surface": {"kind": "generated", "rms_height": "120 nm", "correlation_length": "2 um"},
    },
    "upper": {"material": "steel-cylinder"},
    "contact": {"radius": "2 mm", "width": "6 mm", "loads": ["5.5 N"], "boundary_friction": 0.15},
    "oil": {
        "viscosity": "0.36 Pa*s",
        "pressure_viscosity": "25 1/GPa",
        "density_law": "incompressible",
        "shear_law": "limited",
    },
    "grid": {"shape": [64, 32], "spacing": "0.8 um", "periodic": [False, True]},
    "depths": {"count": 16, "spacing": "90 nm"},
    "cycles": {"count": 3, "settled": 2, "averaged": 2},
}
SCENES: dict[str, dict[str, Any]] = {
    "third-bodies": WEAR
    | {
        "wear": {
            "wears": "both",
            "frame": "disk",
            "criterion": "tresca",
            "connectivity": 26,
            "removal": "top_run",
            "third_bodies": {"diameter": "300 nm", "number_per_area": 1e11, "friction": 0.1, "shed": 0.2},
        }
    },
    "fatigue": WEAR | {"wear": {"criterion": {"kind": "low_cycle_fatigue", "passes": 2000}, "refine": 5}},
    "boundary-film": WEAR
    | {
        "wear": {
            "criterion": {"kind": "archard", "specific_wear_rate": "5e-15 m^2/N", "distance": "1 m"},
            "film_defect": {
                "adsorption_energy": "0.8 eV",
                "sliding_speed": "0.01 m/s",
                "temperature": "80 degC",
            },
        }
    },
    "mixed": MIXED | {"speeds": {"values": ["0.01 m/s", "0.1 m/s"]}, "sharing": {"oil_volume": "patch"}},
    "mixed-energy": MIXED
    | {
        "speeds": {"values": ["0.03 m/s"]},
        "wear": {"criterion": {"kind": "energy", "energy_wear_rate": "1e-15 m^2/N", "distance": "1 m"}},
    },
}
"""Loops of scenes."""


def cases() -> dict[str, Case]:
    """Loops by name."""
    found: dict[str, Case] = {
        f"run-in-{name}": partial(_run_in, number, special) for number, (name, special) in enumerate(CRITERIA.items())
    }
    return found | {f"scene-{name}": partial(_scene, name, table) for name, table in SCENES.items()}


def _run_in(number: int, special: dict[str, Any], trial: Trial, folder: Path) -> Record:
    rng = np.random.default_rng(FIRST + number)
    grid = Grid((48, 40), (100e-9, 100e-9), periodic=(False, True))
    whole = Grid(grid.shape, grid.spacing, periodic=(True, True))
    seeds = rng.integers(1000, size=2)
    lower, upper = (
        generate_surface(whole, rms_height=rms, correlation_length=500e-9, seed=int(seed))
        for rms, seed in zip((float(rng.uniform(60e-9, 120e-9)), special.get("upper_rms", 20e-9)), seeds, strict=True)
    )
    loop = run_in(
        lower,
        upper,
        grid=grid,
        bodies=(special.get("lower", Body(SOFT)), Body(HARD)),
        load=0.12 * SOFT.hardness * grid.area * (1 + trial.nudge),
        depths=np.arange(12) * 60e-9,
        friction=float(rng.uniform(0.1, 0.3)),
        cycles=CYCLES,
        criterion=special["criterion"],
    )
    rows, particles = loop.cycles, loop.particles
    worn = lower - loop.lower_heights
    record = Record(
        {
            "status": loop.status.value,
            "particles": float(len(particles)),
            "volume": float(rows["volume"].sum()),
            "first_volume": float(rows["volume"][0]),
            "contact_area": float(rows["contact_area"].mean()),
            "plastic_area": float(rows["plastic_area"].mean()),
            "rms_height": float(rows["rms_height"][-1]),
            "worn_depth_max": float(worn.max()),
            "pressure_max": float(loop.pressure.max()) if loop.pressure is not None else None,
            "step_error": plain_figure(loop.step_error),
            "notes": float(len(loop.notes)),
        },
        {"convolutions": float(rows["convolutions"].sum()), "depths": float(rows["depths_computed"].sum())},
    )
    for name in ("volume", "length", "width", "thickness"):
        record.figures[f"particle_{name}"] = float(particles[name].mean()) if len(particles) else None
    return record


def _scene(name: str, table: dict[str, Any], trial: Trial, folder: Path) -> Record:
    from reports.golden.scenes import nudged

    return record_of_run(run_scene(nudged(table | {"name": name}, trial), folder / "run", figures=False, workers=1))
