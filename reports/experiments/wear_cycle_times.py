"""What a wear cycle costs under each criterion, over one under the source's: processor time, in one run.

    python -m reports.experiments.wear_cycle_times

The steel pair of `wear_lengths` on 240 x 120 cells, depths 95 nm apart. The criteria take turns, cycle by cycle, so
that what else the machine does falls on all alike: on the same surfaces, those that the source's criterion wears, and
each on its own, which stay rougher and yield deeper where less comes off. A ratio is that of the medians over the
cycles after the first ten. Local wear asks for no stresses. The result is stored in
`reports/results/wear_cycle_times.json`.
"""

from __future__ import annotations

import json
import os
import time
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from bem import Grid
from bem.wear import RunningInState, WearModel, run_in
from reports.experiments.wear_lengths import LENGTH, RADIUS, WIDTH, Case, surfaces

RESULT = Path(__file__).resolve().parents[1] / "results" / "wear_cycle_times.json"
CRITERIA: dict[str, Any] = {
    "von_mises": "von_mises",
    "averaged_von_mises": "averaged_von_mises",
    "junction": "junction",
    "low_cycle_fatigue": "low_cycle_fatigue",
    "averaged_fatigue": {"kind": "low_cycle_fatigue", "averaging_length": 300e-9},
    "archard": {"kind": "archard", "specific_wear_rate": 1e-14, "distance": 203e-9},
}
CYCLES, FIRST, SEEDS = 25, 10, (1, 2)


def one_seed(seed: int, *, same: bool) -> tuple[dict[str, list[float]], dict[str, float]]:
    """Processor times [s] of the cycles of each criterion, and how many depths it computed; on the same surfaces or on
    its own."""
    case = Case("cells", "101 nm")
    grid = Grid((case.cells, case.cells // 2), (LENGTH / case.cells,) * 2, periodic=(False, True))
    lower, upper = surfaces(case, seed)
    states: dict[str, RunningInState | None] = dict.fromkeys(CRITERIA)
    times: dict[str, list[float]] = {name: [] for name in CRITERIA}
    for cycle in range(1, CYCLES + 1):
        source = states["von_mises"]
        for name, criterion in CRITERIA.items():
            now = states[name]
            if same and now is not None and source is not None:
                now = replace(now, heights=source.heights, pressure=source.pressure)
            began = time.process_time()
            states[name] = run_in(
                lower,
                upper,
                grid=grid,
                bodies=case.bodies,
                load=case.load * grid.lengths[1] / WIDTH,
                gap=np.broadcast_to(grid.x[:, None] ** 2 / (2 * RADIUS), grid.shape),
                depths=np.arange(0.0, 4e-6, case.spacing),
                friction=case.friction,
                cycles=cycle,
                model=WearModel(criterion=criterion, shift=2, wears="lower"),
                state=now,
            ).state
            times[name].append(time.process_time() - began)
    ends = {name: state for name, state in states.items() if state is not None}
    return times, {name: float(end.cycles["depths_computed"][FIRST:].mean()) for name, end in ends.items()}


def main() -> None:
    """Run all, and store ratios to the source's criterion."""
    rows: list[dict[str, Any]] = []
    for seed in SEEDS:
        for same in (True, False):
            times, depths = one_seed(seed, same=same)
            medians = {name: float(np.median(values[FIRST:])) for name, values in times.items()}
            found = [
                {
                    "criterion": name,
                    "seed": seed,
                    "surfaces": "same" if same else "own",
                    "seconds": value,
                    "depths_computed": depths[name],
                    "ratio": value / medians["von_mises"],
                }
                for name, value in medians.items()
            ]
            print(same, {row["criterion"]: round(float(str(row["ratio"])), 2) for row in found}, depths, flush=True)
            rows += found
    stored = {"cells": [240, 120], "cycles": CYCLES, "load_average": os.getloadavg()[0], "rows": rows}
    RESULT.write_text(json.dumps(stored, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
