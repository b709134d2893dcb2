"""Scenes of many cases that are timed: all cores against one, in one run."""

from __future__ import annotations

import os
import time
from typing import TYPE_CHECKING

import numpy as np

from bem.benchmarks.measure import Outcome, Timed

if TYPE_CHECKING:
    from bem.campaigns import Computed

SETTINGS = ("repetitions=4", "cylinder.loads=['10 N','5 N']", "cycles.settled=1")


def wear_campaign(cycles: float) -> Timed:
    """`wear-steel-steel` with two loads, four repetitions and so many cycles, on all cores; judged by one process.

    The error is the largest difference of any array from that of one process, which must be none.
    """
    from bem.campaigns import campaign_of, compute
    from bem.runs import plan_scene

    scene, plan = plan_scene("wear-steel-steel", [*SETTINGS, f"cycles.count={int(cycles)}"])
    campaign = campaign_of(scene)
    seconds: list[float] = []

    def solve() -> Computed:
        start = time.perf_counter()
        computed = compute(campaign, plan=plan, workers=os.cpu_count())
        seconds.append(time.perf_counter() - start)
        return computed

    def judge(computed: Computed) -> Outcome:
        start = time.perf_counter()
        alone = compute(campaign, plan=plan, workers=1)
        ratio = (time.perf_counter() - start) / seconds[-1]
        together = computed.outcome.variables
        pairs = [
            (together[name].values, item.values)
            for name, item in alone.outcome.variables.items()
            if not name.endswith("_seconds")  # what it took, not what it gave
        ]
        differing = sum(not np.array_equal(a, b, equal_nan=a.dtype.kind == "f") for a, b in pairs)
        return Outcome(
            {"arrays_differing": float(differing)}, {"cases": float(len(campaign.cases))}, {"speedup": ratio}
        )

    return Timed(solve, judge)
