"""Error bars of load sharing with lumped heat against references on four times finer grids and films: contact and
flash temperatures.

    python -m reports.experiments.heated_mixed_error_bars [CASES]

Contacts of `mixed_error_bars` between bodies that conduct, under oil of 320 to 370 K that thins with temperature. The
result is stored in `reports/results/heated_mixed_error_bars.json`.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from bem import Body, Lubricant, Material
from reports.experiments.judging import judge
from reports.experiments.mixed_error_bars import draw, rows_of

RESULT = Path(__file__).resolve().parents[1] / "results" / "heated_mixed_error_bars.json"
GRADES = ("ISO VG 10", "ISO VG 32", "ISO VG 100", "ISO VG 320")


def heated_rows(rng: np.random.Generator) -> list[dict[str, Any]]:
    """Bar and true error of every figure."""
    words, setup, heights, speeds = draw(rng)
    bodies = setup.bodies if isinstance(setup.bodies, tuple) else (setup.bodies,)
    hot = replace(
        setup,
        bodies=(_conducting(bodies[0]), _conducting(bodies[-1])),
        lubricant=Lubricant.of(str(rng.choice(GRADES)), temperature=float(rng.uniform(320, 370))),
        thermal="lumped",
    )
    # film ratios as drawn: films go with speed times viscosity
    factor = setup.lubricant.viscosity / hot.lubricant.viscosity
    factor = min(factor, 20 / max(abs(speed) for speed in speeds))
    return rows_of((words, hot, heights, (factor * speeds[0], factor * speeds[1])))


def _conducting(body: Body) -> Body:
    steel = body.material.youngs_modulus > 150e9
    heat = (46.0, 7800.0, 460.0) if steel else (60.0, 8800.0, 380.0)
    names = ("thermal_conductivity", "density", "heat_capacity")
    elastic = {"youngs_modulus": body.material.youngs_modulus, "poissons_ratio": body.material.poissons_ratio}
    return Body(Material(body.material.name, **elastic, **dict(zip(names, heat, strict=True))))


if __name__ == "__main__":
    judge(heated_rows, RESULT, cases=9, seed=2618)
