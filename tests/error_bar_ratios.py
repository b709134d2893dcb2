"""What tests of error bars ask of experiments' rows."""

import numpy as np


def rows_of(experiment, rng, cases):
    """Return an experiment's rows of the next cases that the generator draws."""
    return [row for number in range(cases) for row in experiment.rows(experiment.draw(rng), number)]


def known_rows(rows):
    """Rows with a bar and an error that is more than the reference's own."""
    return [row for row in rows if row["bar"] is not None and row["error"] > 1e-7 * abs(row["value"])]


def ratios_of(rows, more_than):
    """Bars over errors, of more than so many rows."""
    ratios = np.array([row["bar"] / row["error"] for row in known_rows(rows)])
    assert len(ratios) > more_than
    return ratios
