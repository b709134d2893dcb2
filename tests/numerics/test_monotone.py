"""Monotone cubics against scipy's, to the bit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.interpolate import PchipInterpolator

from bem.numerics.monotone import MonotoneCubic

pytestmark = pytest.mark.internal


@pytest.mark.parametrize("points", [2, 3, 4, 50, 2000])
@pytest.mark.parametrize("columns", [(), (5,), (2, 3)])
def test_values_are_those_of_scipy(points, columns):
    rng = np.random.default_rng(points)
    x = np.cumsum(rng.random(points) + 0.1)
    values = np.cumsum(rng.normal(size=(points, *columns)), axis=0)
    values[points // 2] = values[points // 2 - 1]  # a plateau
    at = np.concatenate([np.linspace(x[0], x[-1], 101), x, [x[0] - 0.3, x[-1] + 0.2]])
    ours, scipys = MonotoneCubic(x, values), PchipInterpolator(x, values)
    assert ours(at).tobytes() == scipys(at).tobytes()
    assert ours.slope(at).tobytes() == scipys.derivative()(at).tobytes()
    assert float(MonotoneCubic(x, values.reshape(points, -1)[:, 0])(x[1])) == values.reshape(points, -1)[1, 0]


@settings(deadline=None, max_examples=200, derandomize=True)
@given(st.lists(st.tuples(st.floats(1e-3, 10), st.floats(-1e3, 1e3)), min_size=2, max_size=30))
def test_any_values_are_those_of_scipy_and_overshoot_nowhere(rows):
    steps, values = np.array(rows).T
    x = np.cumsum(steps)
    at = np.linspace(x[0], x[-1], 57)
    found = MonotoneCubic(x, values)(at)
    assert found.tobytes() == PchipInterpolator(x, values)(at).tobytes()
    # round-off of values of a thousand
    assert found.min() >= values.min() - 1e-10
    assert found.max() <= values.max() + 1e-10
