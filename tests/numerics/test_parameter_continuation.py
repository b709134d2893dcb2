"""Continuation by factors: a solver that converges only from near starts, and one that ends at a fold."""

from dataclasses import dataclass

import pytest

from bem.numerics.continuation import FactorRule, continue_by_factors


@dataclass(frozen=True)
class Root:
    value: float
    converged: bool
    iterations: int = 1


def square_root(reach, fold=float("inf")):
    """A solver of x^2 = p that fails for factors of p beyond `reach`, and beyond a fold."""
    asked = []

    def solve(last, old, new):
        asked.append(new)
        assert last.value == pytest.approx(old**0.5)
        return Root(new**0.5, new <= reach * old and new <= fold)

    return solve, asked


def test_the_end_is_reached_with_shorter_steps_after_failures():
    solve, asked = square_root(reach=1.9)
    found = continue_by_factors(solve, Root(1.0, True), 1.0, 100.0, FactorRule(first=4.0, smallest=1.01))
    assert found.value == 100.0
    assert found.last == Root(10.0, True)
    assert found.iterations == 1 + len(asked)
    assert asked[:2] == [4.0, 2.0]  # the factor's logarithm is halved


def test_steps_grow_after_easy_successes_up_to_the_largest():
    solve, asked = square_root(reach=1e9)
    found = continue_by_factors(solve, Root(1.0, True), 1.0, 1e3, FactorRule(2.0, 1.01, largest=4.0))
    assert found.value == 1e3
    assert asked == [2.0, 6.0, 24.0, 96.0, 384.0, 1e3]


def test_steps_stay_after_successes_that_are_not_easy():
    solve, asked = square_root(reach=1e9)
    continue_by_factors(solve, Root(1.0, True), 1.0, 16.0, FactorRule(2.0, 1.01, easy=1))
    assert asked == [2.0, 4.0, 8.0, 16.0]


def test_a_fold_ends_the_continuation_near_it():
    solve, _ = square_root(reach=10.0, fold=7.0)
    found = continue_by_factors(solve, Root(1.0, True), 1.0, 100.0, FactorRule(2.0, 1.001))
    assert found.last.converged
    assert 7.0 / 1.01 <= found.value <= 7.0


def test_a_first_solution_that_did_not_converge_is_returned():
    solve, asked = square_root(reach=10.0)
    found = continue_by_factors(solve, Root(1.0, False), 1.0, 100.0, FactorRule(2.0, 1.001))
    assert found.value == 1.0
    assert not asked
