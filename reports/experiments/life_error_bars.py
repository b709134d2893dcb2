"""Error bars of random lives against lives with four times the positions on half the cell.

    python -m reports.experiments.life_error_bars [CASES]

Patches of 48 to 56 cells along the sliding, three to eight of them to the correlation length, a cylinder of 2 to 8 mm
at 0.8 to 1.8 GPa and 0.1 to 3 m/s with 2 to 30 % sliding, 4 to 6 positions, one or both bodies passing, 20 to 150 nm
worn, half of them with a tribofilm. The finer grid sees the same waves, with twice the points of the film. The result
is stored in `reports/results/life_error_bars.json`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from bem.accuracy.life import life_figures
from bem.errors import BemError
from bem.kinds.running_in_life import lives
from bem.scenes import build, wearing
from bem.scenes.axes import with_keys
from bem.scenes.context import PlainContext
from bem.scenes.kind import get_kind
from bem.scenes.load import scene_from_table
from reports.experiments.contact_error_bars import waves_through
from reports.experiments.judging import Comparison, Experiment, main

FINER, MORE = 2, 4
FILM = {
    "activation_energy": "0.665 eV",
    "activation_volume": "45 angstrom^3",
    "wear_coefficient": "6.9e-4 1/s",
    "concentration_constant": "1.24e7 1/m",
    "temperature": "90 degC",
}


def draw(rng: np.random.Generator) -> dict[str, Any]:
    """A random scene."""
    cells, radius = int(rng.choice([48, 56])), float(rng.uniform(2e-3, 8e-3))
    hertz, speed, ratio = (
        float(rng.uniform(0.8e9, 1.8e9)),
        10 ** float(rng.uniform(-1, 0.5)),
        float(rng.uniform(0.02, 0.3)),
    )
    length = float(rng.uniform(2.6, 3.4)) * 2 * radius * hertz / 115e9
    spacing = length / cells
    correlated, slid = float(rng.uniform(3, 8)) * spacing, ratio * length
    passes = str(rng.choice(["both", "both", "upper"]))
    worn, cycles = float(rng.uniform(20e-9, 150e-9)), 10 ** float(rng.uniform(4, 6))
    share = np.pi / 4 * hertz * 2 * (2 * radius * hertz / 115e9) / length  # mean pressure of the patch

    def rough(low: float, high: float) -> dict[str, Any]:
        return {"kind": "generated", "rms_height": float(rng.uniform(low, high)), "correlation_length": correlated}

    table: dict[str, Any] = {
        "kind": "running-in-life",
        "seed": int(rng.integers(1 << 30)),
        "lower": {"material": {"catalogue": "steel-52100", "hardness": 4.5e9}, "surface": rough(100e-9, 400e-9)},
        "upper": {"material": {"catalogue": "steel-52100", "hardness": 7e9}, "surface": rough(20e-9, 100e-9)},
        "contact": {
            "radius": radius,
            "width": 2e-3,
            "hertz_pressures": [hertz],
            "boundary_friction": float(rng.uniform(0.08, 0.15)),
            "hardness": 4.1e9,
        },
        "oil": {
            "viscosity": 10 ** float(rng.uniform(-2.5, -1.5)),
            "pressure_viscosity": 18e-9,
            "density_law": "incompressible",
            "shear_law": "limited",
        },
        "speeds": {"values": [speed], "cylinder": (2 - ratio) / (2 + ratio)},
        "grid": {"shape": [cells, cells // 2], "spacing": spacing, "periodic": [False, True]},
        "wear": {
            "law": {"kind": "archard", "specific_wear_rate": worn / (share * slid * cycles), "distance": slid},
            "passes": passes,
            "positions": int(rng.choice([4, 6])),
        },
        "life": {"count": cycles, "tolerance": 0.2, "first_step": 1e-3 * cycles},
        "sharing": {"film_points": 200},
    }
    if rng.uniform() < 0.5:
        table["tribofilm"] = FILM | {"cycle_time": length / speed}
    return table


def solve(table: dict[str, Any]) -> Comparison | None:
    """Figures of a life, their bars, and figures of a life on a finer grid; None where either cannot be run."""
    scene = get_kind("running-in-life").resolved(scene_from_table(table))
    grid, positions = build.grid_of(scene.grid), scene.wear.positions
    lower, upper = (waves_through(h, 1) for h in build.both_heights(scene, grid, PlainContext(scene.seed)))
    keys = wearing.grid_keys(scene, FINER) | {"wear.positions": MORE * positions}
    try:
        end = lives.end_of(scene, (lower, upper))
        bars = lives.bars(scene, (lower, upper), end)
        truth = lives.end_of(with_keys(scene, keys), (waves_through(lower, FINER), waves_through(upper, FINER)))
    except BemError as error:
        print(error)
        return None
    return Comparison(life_figures(end), life_figures(truth), bars.values, bars.parts)


EXPERIMENT = Experiment("life_error_bars", draw, solve, cases=12, seed=1711)

if __name__ == "__main__":
    main(EXPERIMENT)
