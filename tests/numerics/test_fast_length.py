"""Fast transform lengths against scipy's."""

import pytest
import scipy.fft

from bem.numerics.fast_length import fast_length

pytestmark = pytest.mark.internal


def test_fast_lengths_are_those_of_scipy():
    for length in (*range(1, 300), 1023, 4097, 16385):
        assert fast_length(length) == scipy.fft.next_fast_len(length, real=True)
