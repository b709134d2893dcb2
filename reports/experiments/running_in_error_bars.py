"""Error bars of random running-in loops against loops on a quarter of the cell.

    python -m reports.experiments.running_in_error_bars [CASES]

Patches of 51 um by 26 um with 80 to 112 cells along the sliding, three to eight of them to the correlation length, a
cylinder of 2 mm under 3 to 8 N on 6 mm at 1 mm/s to 0.3 m/s, 12 cycles of which the last six count. The finer grid sees
the same waves, with four times the depths and points of the film. The result is stored in
`reports/results/running_in_error_bars.json`.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from bem.accuracy.wear import BY_LOAD, MIXED_RULES
from bem.errors import BemError
from bem.kinds.running_in.errors import at_resolution
from bem.kinds.running_in.errors import bars as bars_of_loop
from bem.kinds.running_in.solve import wear_down
from bem.scenes import build
from bem.scenes.context import PlainContext
from bem.scenes.kind import get_kind
from bem.scenes.load import scene_from_table
from reports.experiments.contact_error_bars import waves_through
from reports.experiments.judging import Comparison, Experiment, compare_records, main, worn_bodies

FINER, SIDE = 4, 51.2e-6


def draw(rng: np.random.Generator) -> dict[str, Any]:
    """A random scene."""
    cells = int(rng.choice([80, 96, 112]))
    cell = SIDE / cells
    correlated = float(rng.uniform(3, 8)) * cell
    return {
        "kind": "running-in",
        **worn_bodies(rng, "steel-disk-110HV", (60e-9, 200e-9), (10e-9, 60e-9), correlated),
        "contact": {
            "radius": 2e-3,
            "width": 6e-3,
            "loads": [float(rng.uniform(3, 8))],
            "boundary_friction": float(rng.uniform(0.08, 0.2)),
        },
        "oil": {
            "viscosity": 0.36,
            "pressure_viscosity": 25e-9,
            "density_law": "incompressible",
            "shear_law": "limited",
        },
        "speeds": [10 ** float(rng.uniform(-3, math.log10(0.3)))],
        "grid": {"shape": [cells, cells // 2], "spacing": cell},
        "depths": {"count": int(rng.integers(8, 14)), "spacing": float(rng.uniform(0.15, 0.25)) * cell},
        "wear": {"shift": int(rng.integers(2, 6))},
        "cycles": {"count": 12, "settled": 6, "averaged": 6, "coarser_grid": True},
        "sharing": {"film_points": 200},
    }


def solve(table: dict[str, Any]) -> Comparison | None:
    """Figures of a loop, their bars, and figures on a quarter of the cell; None where either cannot be run."""
    scene = get_kind("running-in").resolved(scene_from_table(table))
    grid = build.grid_of(scene.grid)
    lower, upper = (waves_through(h, 1) for h in build.both_heights(scene, grid, PlainContext(scene.seed)))
    fine = (waves_through(lower, FINER), waves_through(upper, FINER))
    try:
        found = wear_down(scene, (lower, upper), PlainContext(scene.seed))
        bars = bars_of_loop(scene, (lower, upper), found)
        truth = wear_down(at_resolution(scene, FINER), fine, PlainContext(scene.seed))
    except BemError as error:
        print(error)
        return None
    # no temperatures without heat; volumes of pieces, which these loops shed, follow the worn depth
    known = [name for name in MIXED_RULES if name != BY_LOAD and getattr(found, name) is not None]
    return compare_records(found, truth, bars.values, known, bars.parts)


EXPERIMENT = Experiment("running_in_error_bars", draw, solve, cases=30, seed=2612)

if __name__ == "__main__":
    main(EXPERIMENT)
