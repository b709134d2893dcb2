"""Error bars of random wear loops against loops on a quarter of the cell.

    python -m reports.experiments.wear_error_bars [CASES]

Slices of 4 um with 32 to 64 cells a side, three to eight of them to the correlation length of either surface, capped at
the hardness of steel or, every second one, higher up (2.5 to 12 GPa), 1 to 6 N on 6 mm, sliding 2 to 6 cells a cycle,
24 cycles of which the last 12 count. Such surfaces touch at the hardness alone, and their area is prescribed by it:
every third pair is a fifth as rough and capped at 10 GPa. The finer grid sees the same waves. The result is stored in
`reports/results/wear_error_bars.json`.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from bem.accuracy.wear import RULES
from bem.kinds.wear.errors import at_resolution
from bem.kinds.wear.errors import bars as bars_of_loop
from bem.kinds.wear.solve import wear_down
from bem.scenes import build
from bem.scenes.context import PlainContext
from bem.scenes.kind import get_kind
from bem.scenes.load import load_scene
from reports.experiments.contact_error_bars import waves_through
from reports.experiments.judging import Comparison, Experiment, compare_records, main, worn_bodies

FINER, SIDE = 4, 4e-6


def draw(rng: np.random.Generator) -> dict[str, Any]:
    """A random wear scene."""
    cells = int(rng.choice([32, 40, 48, 64]))
    cell = SIDE / cells
    correlated = float(rng.uniform(3, 8)) * cell
    higher = {"hardness": float(rng.uniform(2.5e9, 12e9))} if rng.random() < 0.5 else {}
    rough = 1.0
    if rng.random() < 1 / 3:
        rough, higher = 0.2, {"hardness": 10e9}
    lower, upper = (rough * 40e-9, rough * 150e-9), (rough * 10e-9, rough * 50e-9)
    return {
        "kind": "wear",
        **worn_bodies(rng, "steel-disk", lower, upper, correlated),
        "cylinder": {
            "radius": 2e-3,
            "width": 6e-3,
            "loads": [float(rng.uniform(1, 6))],
            "friction": float(rng.uniform(0, 0.3)),
            **higher,
        },
        "domain": {"cells": cells, "lengths": SIDE},
        "depths": {"count": int(rng.integers(14, 24)), "spacing": float(rng.uniform(0.8, 1.2)) * cell},
        "wear": {"shift": int(rng.integers(2, 7))},
        "cycles": {"count": 24, "settled": 12, "coarser_grid": True},
    }


def solve(table: dict[str, Any]) -> Comparison:
    """Figures of a loop, their bars, and figures on a quarter of the cell; none of a loop without wear."""
    scene = get_kind("wear").resolved(load_scene(table))
    grid = scene.domain.at(scene.cylinder, build.modulus_of(scene))[0]
    lower, upper = (waves_through(h, 1) for h in build.both_heights(scene, grid, PlainContext(scene.seed)))
    found = wear_down(scene, (lower, upper), PlainContext(scene.seed))
    bars = bars_of_loop(scene, (lower, upper), found)
    fine = (waves_through(lower, FINER), waves_through(upper, FINER))
    truth = wear_down(at_resolution(scene, FINER), fine, PlainContext(scene.seed))
    names = RULES if truth.worn_volume_per_cycle > 0 else ()
    return compare_records(found, truth, bars.values, names, bars.parts)


EXPERIMENT = Experiment("wear_error_bars", draw, solve, cases=60)

if __name__ == "__main__":
    main(EXPERIMENT)
