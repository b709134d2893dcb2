"""Sums of cosines, of sines and of Chebyshev polynomials by Clenshaw's recurrence.

    b_k = c_k + 2 cos(t) b_(k+1) - b_(k+2)

gives the sum of c_k cos(k t) over k >= 0 as c_0 + cos(t) b_1 - b_2, and that of c_k sin(k t) over k >= 1 as sin(t) b_1
(C. W. Clenshaw, Math. Tables Aids Comput. 9 (1955) 118; not read, standard). Chebyshev polynomials T_k(x) are cos(k t)
at x = cos(t). Verified in tests/numerics/test_clenshaw.py.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from bem.grid import FloatArray


def cosine_sum(coefficients: Sequence[FloatArray] | FloatArray, cosine: FloatArray) -> FloatArray:
    """Return the sum of c_k cos(k t) over k from 0, or of c_k T_k(x).

    coefficients : c_0, c_1, ..., numbers or arrays of the shape of `cosine`. cosine : cos(t), or x.
    """
    first, second = _recurrence(coefficients[1:], cosine)
    return coefficients[0] + cosine * first - second


def sine_sum(coefficients: Sequence[FloatArray] | FloatArray, cosine: FloatArray, sine: FloatArray) -> FloatArray:
    """Return the sum of c_k sin(k t) over k from 1.

    coefficients : c_1, c_2, ..., numbers or arrays of the shape of `cosine`. cosine, sine : cos(t) and sin(t).
    """
    first, _ = _recurrence(coefficients, cosine)
    return sine * first


def _recurrence(coefficients: Sequence[FloatArray] | FloatArray, cosine: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return b_1 and b_2 of the coefficients c_1, c_2, ..."""
    first, second = np.zeros_like(cosine), np.zeros_like(cosine)
    twice = 2 * cosine
    for coefficient in coefficients[::-1]:
        first, second = coefficient + twice * first - second, first
    return first, second
