"""Digits that a convolution takes off, by the eigenvalues of the preconditioned kernel."""

import numpy as np
import pytest

from bem import solve_contact
from reports import performance
from reports.experiments import preconditioned_spectrum
from reports.experiments.contact_convolutions import SLOPE, heights, operator
from reports.experiments.kept import found


@pytest.mark.parametrize("kind", ["periodic", "free"])
def test_the_preconditioned_kernel_is_near_one(kind):
    row = preconditioned_spectrum.row(kind, 48, 0.2)
    assert 0.6 < row["least"] <= row["inner"][0] <= row["inner"][1] <= row["largest"] < 1.4
    assert row["digits_of_gradients"] > row["digits_of_steps"] > 0.4


def test_a_contact_takes_about_the_convolutions_that_the_digits_say():
    """From the interpolated start, some 0.2 of the roughness, to 1e-8 on the finest grid, and up to 4 on others."""
    row = preconditioned_spectrum.row("free", 64, 0.4)
    contact = solve_contact(-heights(64, 0), operator(64, "free"), load=0.5 * 0.4 * SLOPE)
    digits = -np.log10(1e-8 / 0.2)
    assert digits / row["digits_of_gradients"] < contact.convolutions < digits / row["digits_of_steps"] + 4


def test_the_page_shows_what_is_stored():
    body = performance._digits_a_convolution()
    assert body.count("<tr>") == len(found("preconditioned_spectrum")) + 1
    for row in found("preconditioned_spectrum"):
        assert f"{row['least']:.2f}" in body
