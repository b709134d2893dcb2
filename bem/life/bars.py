"""What the jumps of a life leave open of its figures at the end.

Verified in tests/life/test_life.py: against a life of much shorter jumps.
"""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from bem.life.march import LifeState

_LAST = 4
"""Rows at the end whose slope tells how a figure follows the wear."""


def bars_of_jumps(state: LifeState, columns: Mapping[str, str]) -> dict[str, float]:
    """Errors of figures at the end, by their names, of the columns of `ROW` that they are.

    The errors of the steps' mean depths add up, and go to the bodies as their wear does, which the same pressure makes;
    a figure follows the depth worn as its last rows do, so that a depth too small by as much moves it along that line.
    First order, ours.
    """
    missed = float(state.over("depth_error")[-1])
    depth = state.over("lower_depth") + state.over("upper_depth")
    first = max(len(depth) - _LAST, 0)
    run = float(depth[-1] - depth[first])
    bars = {}
    for name, column in columns.items():
        values = state.over(column)
        if column.endswith("_depth"):
            bars[name] = missed * float(values[-1]) / float(depth[-1]) if depth[-1] > 0 else 0.0
        else:
            steepest = float(np.abs(np.diff(values[first:])).sum())
            bars[name] = steepest / run * missed if run > 0 else 0.0
    return bars
