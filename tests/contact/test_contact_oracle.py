"""The fast solver against a slow and certain one (bounded-variable least squares on the dense matrix)."""

import numpy as np
import pytest
from contact_oracles import (
    FREE,
    HALF_Y,
    PERIODIC,
    certain_solution,
    certain_solution_for_load,
    dense,
    operator,
    rough,
)
from hypothesis import given, settings
from hypothesis import strategies as st

from bem.contact import solve_contact

# pressures follow violations by the condition of the dense matrix (below 1e2 on these grids); the oracle's own root in
# the approach is good to about 1e-12
TOLERANCE = 1e-7


@pytest.mark.parametrize("periodic", [FREE, HALF_Y, PERIODIC])
@pytest.mark.parametrize("hardness_ratio", [np.inf, 3.0, 1.2])
@pytest.mark.parametrize("force", [0.02, 1.0, 30.0])
def test_load_control(periodic, hardness_ratio, force):
    op = operator((7, 9), (0.1, 0.13), periodic)
    gap = 0.05 * rough(7, 9, seed=1)
    hardness = hardness_ratio * force / op.grid.cells
    expected = certain_solution_for_load(dense(op), gap, force, hardness)
    cell = op.grid.cell_area
    finite = None if np.isinf(hardness) else hardness
    solution = solve_contact(gap, op, load=force * cell, hardness=finite, tolerance=1e-10)
    assert solution.status == "converged"
    assert np.abs(solution.pressure.ravel() - expected).max() <= TOLERANCE * expected.max()
    assert solution.load == pytest.approx(force * cell, rel=1e-13)  # a sum of 63 numbers


@pytest.mark.parametrize("hardness", [np.inf, 0.3])
@pytest.mark.parametrize("approach", [-0.06, 0.0, 0.1])
def test_approach_control(approach, hardness):
    op = operator((6, 8), (0.1, 0.1), FREE)
    gap = 0.05 * rough(6, 8, seed=2)
    expected = certain_solution(dense(op), gap, approach, hardness)
    finite = None if np.isinf(hardness) else hardness
    solution = solve_contact(gap, op, approach=approach, hardness=finite, tolerance=1e-10)
    assert solution.status == "converged"
    assert np.abs(solution.pressure.ravel() - expected).max() <= TOLERANCE * expected.max()


@pytest.mark.parametrize("hardness", [np.inf, 0.3])
@pytest.mark.parametrize("periodic", [FREE, PERIODIC])
def test_mean_gap_control_agrees_with_load_control(periodic, hardness):
    op = operator((16, 18), (0.1, 0.1), periodic)
    gap = 0.05 * rough(16, 18, seed=3)
    finite = None if np.isinf(hardness) else hardness
    by_load = solve_contact(gap, op, load=0.2, hardness=finite, tolerance=1e-10)
    wanted = float(np.maximum(by_load.gap, 0).mean())
    by_gap = solve_contact(gap, op, mean_gap=wanted, hardness=finite, tolerance=1e-10)
    assert by_gap.status == "converged"
    assert np.maximum(by_gap.gap, 0).mean() == pytest.approx(wanted, abs=2e-10 * gap.std())
    # the load follows the mean gap with a slope of order one in these units
    assert by_gap.load == pytest.approx(by_load.load, rel=1e-7)
    assert np.abs(by_gap.pressure - by_load.pressure).max() <= TOLERANCE * by_load.pressure.max()


@settings(deadline=None, max_examples=25)
@given(
    nx=st.integers(1, 7),
    ny=st.integers(1, 7),
    seed=st.integers(0, 2**16),
    exponent=st.floats(-6, 3),
    ratio=st.one_of(st.none(), st.floats(1.01, 20)),
    periodic=st.booleans(),
)
def test_any_small_problem(nx, ny, seed, exponent, ratio, periodic):
    op = operator((nx, ny), (0.1, 0.2), PERIODIC if periodic else FREE)
    gap = 0.05 * np.random.default_rng(seed).standard_normal((nx, ny))
    force = 10.0**exponent
    hardness = np.inf if ratio is None else ratio * force / (nx * ny)
    expected = certain_solution_for_load(dense(op), gap, force, hardness)
    finite = None if np.isinf(hardness) else hardness
    solution = solve_contact(gap, op, load=force * op.grid.cell_area, hardness=finite, tolerance=1e-10)
    assert solution.status == "converged"
    # the oracle's approach is found to 1e-14 of lengths that may be 1e6 times what a light load moves
    assert np.abs(solution.pressure.ravel() - expected).max() <= 1e-5 * expected.max()
