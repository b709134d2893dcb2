"""Error bars of loads per asperity."""

import numpy as np
import pytest

from reports.experiments.asperity_error_bars import draw, rows_of
from reports.experiments.judging import judged


def test_bars_cover_errors_of_random_arrays():
    """`reports/experiments/asperity_error_bars.py` has more; these are of another seed."""
    rng = np.random.default_rng(3)
    rows = [row for _ in range(8) for row in rows_of(draw(rng))]
    assert len(rows) == 8 * 3 * 2
    for name, verdict in judged(rows).items():
        assert verdict["covered"] >= 0.9, name
        assert verdict["median_ratio"] <= 6, name


@pytest.mark.slow
def test_bars_fall_with_the_cell():
    """Half the cell leaves a third of the bar or less on the mean: order two, and scatter."""
    rng = np.random.default_rng(5)
    shares = []
    for _ in range(4):
        case = draw(rng)
        finer = type(case)(case.radius, case.height, case.depth, case.spacing, 2 * case.cells)
        bars = [np.sum([row["bar"] / row["value"] for row in rows_of(it)]) for it in (case, finer)]
        shares.append(bars[1] / bars[0])
    assert np.mean(shares) < 0.5
