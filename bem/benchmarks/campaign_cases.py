"""What a user waits for where there are many cases: a whole scene on all cores against one, a sweep of small points.

Verified in tests/benchmarks/test_campaign_cases.py: both run at their smallest sizes.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from bem.benchmarks.measure import Outcome, Timed

if TYPE_CHECKING:
    from bem.results import FinishedRun
    from bem.runs import FinishedSweep

_PARTS = ("writing results", "figures and report")


def wear_campaign(cycles: float) -> Timed:
    """`bem run wear-steel-steel` with so many cycles (200 are the scene as it is), all cores against one.

    From Enter to the report: libraries, processes, figures. The error is how many arrays differ, which must be none.
    Fewer than 10 cycles are of two small cases without figures, for tests.
    """
    settings = [] if cycles == 200 else ["--set", f"cycles.count={int(cycles)}", "--set", "cycles.settled=1"]
    if cycles < 10:
        small = ("repetitions=1", 'cylinder.loads=["2.5 N", "5 N"]', "domain.cells=96", "depths.count=24")
        settings += [*(part for one in small for part in ("--set", one)), "--no-figures"]

    def run(workers: int) -> tuple[FinishedRun, float]:
        from bem.results import open_run

        with tempfile.TemporaryDirectory() as folder:
            bem = [sys.executable, "-P", "-m", "bem"]
            command = [*bem, "run", "wear-steel-steel", *settings, "--workers", str(workers)]
            start = time.perf_counter()
            subprocess.run([*command, "--out", f"{folder}/run"], check=True, capture_output=True)
            seconds = time.perf_counter() - start
            found = open_run(f"{folder}/run")
            for item in found.arrays.values():
                _ = item.values  # read before the folder goes
        return found, seconds

    def judge(solved: tuple[FinishedRun, float]) -> Outcome:
        together, seconds = solved
        alone, seconds_alone = run(1)
        differing = sum(
            not np.array_equal(together.arrays[name].values, item.values, equal_nan=item.values.dtype.kind == "f")
            for name, item in alone.arrays.items()
            if not name.endswith("_seconds")  # what it took, not what it gave
        )
        values = {"one_core_s": seconds_alone, "all_cores_s": seconds, "speedup": seconds_alone / seconds}
        return Outcome({"arrays_differing": float(differing)}, {"cores": float(os.cpu_count() or 1)}, values)

    return Timed(lambda: run(os.cpu_count() or 1), judge)


def sweep_of_spheres(points: float) -> Timed:
    """`bem sweep hertz-sphere` over so many loads at 64 cells a side in this process: what points cost beside physics.

    The error is how many points are missing. `outside_solver` is the share of the wall time that is not in the stages
    of the points' own runs: planning, folders, files, hashes, the dataset and its figure.
    """
    from bem.runs import run_sweep

    seconds: list[float] = []

    def solve() -> FinishedSweep:
        over = [f"contact.load=1 N:10 N:{int(points)}"]
        start = time.perf_counter()
        done = run_sweep("hertz-sphere", over, tempfile.mkdtemp(), settings=["grid.shape=64"], workers=1)
        seconds.append(time.perf_counter() - start)
        return done

    def judge(done: FinishedSweep) -> Outcome:
        from bem.results import open_run

        runs = [open_run(path) for path in (Path(done.path) / "points").iterdir()]
        spent = [s for run in runs for stage, s in run.summary["seconds_by_stage"].items() if stage not in _PARTS]
        missing = float(np.isnan(done.dataset["load_N"].values).sum())
        values = {"points_per_second": len(runs) / seconds[-1], "outside_solver": 1 - sum(spent) / seconds[-1]}
        return Outcome({"points_missing": missing}, {"points": float(len(runs))}, values)

    return Timed(solve, judge)
