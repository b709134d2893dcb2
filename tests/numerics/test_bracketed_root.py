"""Root of a decreasing function: smooth ones, roots beyond the ends, and the criterion of the interpolant."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem.numerics.bracketed_root import _parabola_root, find_decreasing_root


@pytest.mark.internal
@settings(max_examples=80, deadline=None)
@given(st.floats(-9, 9), st.floats(-9, 9), st.floats(0.1, 4.0), st.floats(0.2, 3.0))
def test_zero_of_a_falling_function(zero, start, steepness, slope):
    """Arcus tangent plus a line: its slope at the zero is up to eleven times that far away."""
    tried = []

    def evaluate(place):
        value = -math.atan(steepness * (place - zero)) - 0.1 * (place - zero)
        tried.append((place, value))
        return value, abs(value) < 1e-9

    found = find_decreasing_root(evaluate, start, slope, (-10.0, 10.0), 60)
    assert tried[-1][0] == pytest.approx(zero, abs=1e-8)
    # what would be tried next is no worse than what will do, whatever the arc's curvature
    assert found.next_trial == pytest.approx(zero, abs=1e-7)
    assert len(tried) < 30


@pytest.mark.internal
@pytest.mark.parametrize("place", [-1.0, 0.4, 2.0])
def test_a_parabola_of_the_value_is_met_at_once_and_a_jump_between_two_places_as_before(place):
    def root(value):
        return place - value - 0.1 * value**2

    points = [(root(value), value) for value in (0.7, -0.4, 0.2)]
    assert _parabola_root(points, points[1][0]) == pytest.approx(place, abs=1e-12)
    # three places of which two have one side's value: the parabola would lie anywhere
    assert _parabola_root([(0.0, 1.0), (1.0, -0.2), (0.9, 1.0)], 1.0) is None
    assert _parabola_root([(0.0, 1.01), (1.0, -0.2), (0.9, 1.0)], 1.0) is None
    assert _parabola_root(points[:2], points[0][0]) is None


@pytest.mark.internal
@pytest.mark.parametrize(("zero", "end"), [(-20, -10.0), (20, 10.0)])
def test_a_zero_beyond_the_ends_gives_the_end(zero, end):
    tried = []
    found = find_decreasing_root(lambda x: (tried.append(x) or zero - x, False), 1.0, 1.0, (-10.0, 10.0), 60)
    assert tried[-1] == end
    assert len(tried) <= 6
    assert found.slope == pytest.approx(1.0, rel=1e-12)
    assert found.next_trial == end
