"""Error bars of loads per asperity."""

from dataclasses import replace

import numpy as np
import pytest
from error_bar_ratios import rows_of

from reports.experiments.asperity_error_bars import EXPERIMENT
from reports.experiments.judging import judged


def test_bars_cover_errors_of_random_arrays():
    """`reports/experiments/asperity_error_bars.py` has more; these are of another seed."""
    rows = rows_of(EXPERIMENT, np.random.default_rng(3), cases=8)
    assert len(rows) == 8 * 3 * 2
    for name, verdict in judged(rows).items():
        assert verdict["covered"] >= 0.9, name
        assert verdict["median_ratio"] <= 6, name


@pytest.mark.slow
def test_bars_fall_with_the_cell():
    """Half the cell leaves a third of the bar or less on the mean: order two, and scatter."""
    shares = []
    for case in replace(EXPERIMENT, seed=5).drawn(2):
        pair = (case, replace(case, cells=2 * case.cells))
        bars = [np.sum([row["bar"] / row["value"] for row in EXPERIMENT.rows(one, 0)]) for one in pair]
        shares.append(bars[1] / bars[0])
    assert np.mean(shares) < 0.5
