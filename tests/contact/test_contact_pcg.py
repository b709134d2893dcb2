"""Conjugate gradients on the active cells: vector passes against numpy, solutions against the operator."""

import numpy as np
import pytest
from contact_oracles import FREE, PERIODIC, displacement, notes_surface, operator

from bem.contact import gcr, pcg
from bem.contact.bounds import Iterate
from bem.contact.controls import ApproachControl, LoadControl
from bem.contact.grid_workspace import GridWorkspace, IterationBudget, SolverParameters, carry_to_cells

SIZE = 200
NOTHING = np.empty(0, np.int32)


def test_vector_passes():
    rng = np.random.default_rng(0)
    p, r, t, q, z, w = rng.standard_normal((6, SIZE))
    out = np.empty(SIZE)
    outside, largest = pcg.extrapolate(p, z, t, 0.2, 0.7, 0.9, r, out)
    np.testing.assert_allclose(out, p - 0.7 * (z + 0.2 * t), rtol=0, atol=1e-15)
    assert outside == pytest.approx(max(-out.min(), out.max() - 0.9), rel=1e-14)
    assert largest == np.abs(r).max()
    weights = np.abs(w)
    pcg.subtract_mean(r, weights, weights.sum(), out)
    np.testing.assert_allclose(out, r - (weights @ r) / weights.sum(), rtol=0, atol=1e-13)
    moved, residual, previous = p.copy(), r.copy(), np.empty(SIZE)
    squares, largest, outside = pcg.advance(moved, residual, previous, t, q, 0.3, 0.5, 0.9)
    np.testing.assert_array_equal(previous, r)
    np.testing.assert_allclose(moved, p - 0.5 * t, rtol=0, atol=1e-15)
    np.testing.assert_allclose(residual, r - 0.5 * (q - 0.3), rtol=0, atol=1e-15)
    assert squares == pytest.approx(residual @ residual, rel=1e-13)
    assert largest == np.abs(residual).max()
    assert outside == pytest.approx(max(-moved.min(), moved.max() - 0.9), rel=1e-14)


def test_values_are_carried_from_cells_to_cells():
    before, values = np.array([2, 3, 7, 9]), np.array([1.0, 2.0, 3.0, 4.0])
    out = np.empty(5)
    assert carry_to_cells(before, values, 10.0, np.array([0, 3, 7, 9, 11]), out) == 15.0
    np.testing.assert_array_equal(out, [3.0, 2.0, 3.0, 4.0, 3.0])
    assert carry_to_cells(before, values, 10.0, np.array([0, 3, 4, 9, 11]), out) == 0.0  # most are new
    fallen = np.array([1.0, 0.1, 0.1, 0.1])  # those known have too little of the sum
    assert carry_to_cells(before, fallen, 1.3, np.array([3, 7, 9]), out[:3]) == 0.0


@pytest.mark.parametrize("solver", [pcg, gcr])
@pytest.mark.parametrize("n", [24, 96])
def test_no_cells_take_no_iteration(n, solver):
    workspace = GridWorkspace(operator((n, n), (1 / n, 1 / n), PERIODIC), np.zeros(n * n), np.inf, SolverParameters())
    iterate = Iterate(np.empty(0, np.int64), np.empty(0), np.empty(0, np.int64))
    budget = IterationBudget(9)
    active = workspace.activate(iterate, NOTHING, 0.1, with_unit_approach=False)
    if solver is gcr:
        budget.limit = 0  # the residual has no largest value
    assert solver.close_gap(workspace, active, ApproachControl(0.1), 1e-6, budget).size == 0
    assert budget.iterations == workspace.operator.count.applications == 0


def start(op, n, control, seed):
    """A rough set of active cells with pressures of another surface, and the gap under them."""
    workspace = GridWorkspace(
        op, 0.01 * notes_surface(n, seed, rolloff=4).ravel(), np.inf, SolverParameters(clip_residual_ratio=0.0)
    )
    height = notes_surface(n, rolloff=4).ravel()
    cells = np.flatnonzero(height > np.quantile(height, 0.8))
    iterate = Iterate(cells, 5 + np.random.default_rng(6).random(cells.size), cells[:0])
    workspace.begin_round(iterate, keep=False)
    workspace.extrapolation.trusted = False
    return workspace, workspace.activate(iterate, NOTHING, 0.02, with_unit_approach=control.uses_unit_approach)


@pytest.mark.parametrize("n", [24, 96])  # the smaller has no coarse correction
@pytest.mark.parametrize("periodic", [FREE, PERIODIC])
@pytest.mark.parametrize("control", [LoadControl(30.0), ApproachControl(0.1)])
@pytest.mark.parametrize("solver", [pcg, gcr])
def test_the_gap_is_closed_and_a_load_is_left_alone(n, periodic, control, solver):
    op = operator((n, n), (1 / n, 1 / n), periodic)
    workspace, active = start(op, n, control, 3)
    cells, values, gap = active.iterate.cells, active.iterate.values, active.gap.copy()
    raw = solver.close_gap(workspace, active, control, 0.0, IterationBudget(50))
    change = np.zeros(n * n)
    change[cells] = raw - values
    left = gap + displacement(op, change.reshape(n, n)).ravel()[cells] / op.unit
    if control.zero_sum:
        gap, left = gap - gap.mean(), left - left.mean()
        assert abs(change.sum()) <= 1e-9 * np.abs(change).sum()
    # the iterations end at 1e-4 of the residual
    assert np.linalg.norm(left) <= 3e-4 * np.linalg.norm(gap)


@pytest.mark.parametrize("n", [24, 96])
@pytest.mark.parametrize("control", [LoadControl(30.0), ApproachControl(0.1)])
def test_convolutions_outside_the_kernel_leave_the_bits_alone(n, control, monkeypatch):
    op = operator((n, n), (1 / n, 1 / n), PERIODIC)
    results = []
    for threads in (1, 2):
        monkeypatch.setattr(pcg, "threads_for", lambda _, threads=threads: threads)
        workspace, active = start(op, n, control, 4)
        workspace.extrapolation.trusted = True
        budget, before = IterationBudget(50), op.count.weighted
        raw = pcg.close_gap(workspace, active, control, 1e-6, budget)
        results.append((raw.tobytes(), budget.iterations, workspace.extrapolation.taken, op.count.weighted - before))
    assert results[0][1] >= 2
    assert results[0] == results[1]
