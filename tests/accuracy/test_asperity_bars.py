"""Error bars of loads per asperity."""

from dataclasses import replace

import numpy as np
from error_bar_ratios import rows_of

from bem.accuracy import asperity_bars
from reports.experiments.asperity_error_bars import EXPERIMENT
from reports.experiments.judging import judged


def test_bars_cover_errors_of_random_arrays():
    """`reports/experiments/asperity_error_bars.py` has more; these are of another seed."""
    rows = rows_of(EXPERIMENT, np.random.default_rng(3), cases=8)
    assert len(rows) == 8 * 3 * 2
    for name, verdict in judged(rows).items():
        assert verdict["covered"] >= 0.9, name
        assert verdict["median_ratio"] <= 6, name


def relative_bars(case, cells):
    """Sum of the bars of an array on so many cells a side, each over its value."""
    found, coarser = case.loads(cells), case.loads(cells // 2)
    bars = asperity_bars(found, coarser, case.radius, case.spacing / cells).values
    assert set(bars) == {"mean_plane", "from_flat"}
    return sum(np.sum(bar / getattr(found, name)) for name, bar in bars.items())


def test_bars_fall_with_the_cell():
    """Half the cell leaves a third of the bar or less on the mean: order two, and scatter."""
    cases = replace(EXPERIMENT, seed=5).drawn(2)
    shares = [relative_bars(case, 2 * case.cells) / relative_bars(case, case.cells) for case in cases]
    assert np.mean(shares) < 0.5
