"""Columns of a spectrum times those of a factor, by address: every parity, against the quarter mirrored number by
number."""

import numpy as np
import pytest
from numba import njit

from bem.transforms import loops
from bem.transforms.padded import COMPLEX

pytestmark = pytest.mark.internal


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("parities", [(1, -1), (-1, 1), (1, 0), (-1, 0), (0, 1), (0, -1), (0, 0), (loops.ONE, 0)])
def test_a_column_times_a_factor_is_the_product_with_its_quarter_mirrored(dtype, parities):
    """By address, in rows of a larger array: what lies beside a column stays as it is."""
    for length in (1, 2, 7, 16, 37):
        check_column(dtype, length, parities)


def check_column(dtype, length, parities):
    random, half = np.random.default_rng(length), length // 2 + 1
    parts = [random.normal(size=(3, half + 2)).astype(dtype) for _ in range(2)]
    given = (random.normal(size=(4, length)) + 1j * random.normal(size=(4, length))).astype(COMPLEX[np.dtype(dtype)])
    target, scale = np.full((2, length + 1), 7.0, given.dtype), dtype(0.3)
    nothing = np.empty((0, 0), dtype)
    kept = [part if abs(parity) == 1 else nothing for part, parity in zip(parts, parities, strict=True)]
    _one_column(loops.Factor(*kept, *parities), 2, given, target, scale, length)
    whole = np.zeros(length, complex)
    for k in range(length):
        mirrored = k >= half
        for unit, part, parity in zip((1, 1j), parts, parities, strict=True):
            if abs(parity) == 1:
                whole[k] += unit * (parity * part[2, length - k] if mirrored else part[2, k])
    expected = given[3] * (1.0 if parities[0] == loops.ONE else whole) * scale
    tiny = 8 * np.finfo(dtype).eps * np.abs(given).max() * max(1.0, float(np.abs(whole).max()))
    assert np.abs(target[1, :length] - expected).max() <= tiny
    assert (target[0] == 7).all()
    assert target[1, length] == 7


@njit
def _one_column(factor, number, given, target, scale, length):
    """From the fourth row of `given` into the second of `target`."""
    source, result = given.ctypes.data + 3 * given.strides[0], target.ctypes.data + target.strides[0]
    loops.multiply_column(loops.factor_rows(factor), number, source, result, scale, length)
