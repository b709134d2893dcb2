"""Clenshaw's recurrence against sums term by term, and Chebyshev polynomials outside the interval of cosines."""

import numpy as np
import pytest

from bem.numerics.clenshaw import cosine_sum, sine_sum

ANGLES = np.linspace(-3.0, 3.0, 41)


@pytest.mark.parametrize("count", [1, 2, 3, 12])
def test_sums_of_cosines_and_sines(count):
    coefficients = np.random.default_rng(count).normal(size=count)
    cosines = sum(c * np.cos(k * ANGLES) for k, c in enumerate(coefficients))
    sines = sum(c * np.sin(k * ANGLES) for k, c in enumerate(coefficients, start=1))
    np.testing.assert_allclose(cosine_sum(coefficients, np.cos(ANGLES)), cosines, rtol=0, atol=1e-13)
    np.testing.assert_allclose(sine_sum(coefficients, np.cos(ANGLES), np.sin(ANGLES)), sines, rtol=0, atol=1e-13)


def test_coefficients_of_each_point():
    columns = np.random.default_rng(4).normal(size=(5, ANGLES.size))
    expected = sum(column * np.cos(k * ANGLES) for k, column in enumerate(columns))
    np.testing.assert_allclose(cosine_sum(columns, np.cos(ANGLES)), expected, rtol=0, atol=1e-13)


def test_chebyshev_polynomials_beyond_their_interval():
    coefficients, x = np.array([0.3, -1.0, 2.0, 0.5]), np.array([-1.7, 0.2, 1.4])
    np.testing.assert_allclose(
        cosine_sum(coefficients, x), np.polynomial.chebyshev.chebval(x, coefficients), rtol=1e-13, atol=0
    )
