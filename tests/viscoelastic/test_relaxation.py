"""Creep of Prony series against closed forms and the convolution of both functions."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem.errors import InputError
from bem.relaxation import PronySeries


def test_zener_and_maxwell_have_their_closed_forms():
    solid = PronySeries.zener(0.75, 2.0).creep()
    assert solid.times == pytest.approx((8.0,), rel=1e-14)  # tau / (1 - share)
    assert solid.amounts == pytest.approx((3.0,), rel=1e-14)
    fluid = PronySeries.maxwell(2.0).creep()
    assert fluid.amounts == ()
    assert fluid.compliance(3.0) == pytest.approx(2.5, rel=1e-14)  # 1 + t / tau
    assert fluid.relaxed == math.inf


@settings(max_examples=40, deadline=None)
@given(st.lists(st.tuples(st.floats(0.01, 1), st.floats(-7, 4)), min_size=1, max_size=8), st.floats(0.1, 1.0))
def test_creep_is_the_inverse_of_relaxation(terms, total):
    """In the Laplace variable both are reciprocal, at any rate; equal and close times included."""
    shares = np.array([share for share, _ in terms])
    series = PronySeries(total * shares / shares.sum(), [10**power for _, power in terms])
    creep = series.creep()
    for rate in 10.0 ** np.arange(-5, 8):
        modulus = 1 - sum(g / (1 + rate * t) for g, t in zip(series.shares, series.times, strict=True))
        delayed = sum(c / (1 + rate * t) for c, t in zip(creep.amounts, creep.times, strict=True))
        # the sum over shares loses digits where nearly all of the modulus has relaxed, and a series whose shares leave
        # less than 1e-12 of it is a fluid's
        allowed = 1e-8 + 1e-12 / modulus
        assert modulus * (1 + delayed + creep.flow / rate) == pytest.approx(1, abs=allowed)
    assert all(amount >= 0 for amount in creep.amounts)


def test_mistakes_are_named():
    with pytest.raises(InputError, match="sum of shares is 1"):
        PronySeries([0.6, 0.6], [1.0, 2.0])
    with pytest.raises(InputError, match="time -1"):
        PronySeries([0.6], [-1.0])
    with pytest.raises(InputError, match="2 shares and 1 times"):
        PronySeries([0.6, 0.1], [1.0])


@pytest.mark.parametrize("shares", [(0.2, 0.5, 0.3), (0.2, 0.5, 0.1)])
def test_compliance_of_waves_is_the_reciprocal_of_the_modulus(shares):
    """J*(w) E*(w) = 1 for a fluid and a solid of three times; the flow of a fluid is that of its viscosity."""
    series = PronySeries(shares, [0.01, 0.3, 20.0])
    creep = series.creep()
    for frequency in (1e-3, 0.1, 1.0, 30.0):
        delayed = sum(c / (1 + 1j * frequency * theta) for c, theta in zip(creep.amounts, creep.times, strict=True))
        compliance = 1 + delayed + creep.flow / (1j * frequency)
        assert compliance * series.complex_modulus(frequency) == pytest.approx(1, abs=1e-11)
    assert (creep.flow > 0) == series.fluid
