"""Steps of a life: their rule, and the number that a plan foresees of them."""

import pytest

from bem.life.steps import error_per_cycle, foreseen_steps, next_trial


@pytest.mark.internal
@pytest.mark.parametrize(
    ("asked", "made", "error", "rejected", "then"),
    [
        (8.0, 8.0, 0.01, False, 16.0),
        (8.0, 8.0, 0.03, False, 8.0),
        (8.0, 4.0, 0.03, True, 4.0),  # halved
        (8.0, 5.0, 0.03, False, 8.0),  # cut to the longest allowed
        (8.0, 5.0, 0.01, False, 16.0),
    ],
)
def test_steps_double_below_four_tenths_of_the_tolerance(asked, made, error, rejected, then):
    assert next_trial(asked, made, error, 0.05, rejected=rejected) == then


@pytest.mark.internal
def test_steps_double_until_their_error_is_near_the_tolerance():
    # 1, 2, 4, ... 512 are 1023 cycles
    assert foreseen_steps(1023.0, 1.0, 1e9, 0.05, 0.0) == 10
    assert foreseen_steps(1024.0, 1.0, 1e9, 0.05, 0.0) == 11
    # an error of 0.4 of the tolerance at 32 cycles: 1 + 2 + ... + 16 are 31 cycles, and 30 steps of 32 are left
    assert foreseen_steps(31 + 960.0, 1.0, 1e9, 0.05, 0.021 / 32) == 5 + 30
    # none longer than ten cycles: 1 + 2 + 4 + 8, then tens
    assert foreseen_steps(15 + 100.0, 1.0, 10.0, 0.05, 0.0) == 4 + 10
    # the first is halved twice
    assert foreseen_steps(100.0, 10.0, 1e9, 0.05, 0.05 / 3) == 40
    assert foreseen_steps(0.5, 1.0, 1e9, 0.05, 0.0) == 1


@pytest.mark.internal
def test_wear_that_relaxes_pressure_faster_takes_shorter_steps():
    one = error_per_cycle(6e-22, 115e9, 1.3e5, 8)
    assert error_per_cycle(6e-21, 115e9, 1.3e5, 8) == pytest.approx(10 * one)
    assert error_per_cycle(6e-22, 115e9, 1.3e5, 32) < 0.5 * one
