"""The energy guard of the active set, and the rules by which progress is judged."""

import numpy as np
import pytest

from bem import Body, Grid, Material, displacement_operator
from bem.contact.active_set import _EnergyGuard, _Point, _Progress
from bem.contact.bounds import Iterate, split_field
from bem.contact.controls import ApproachControl, LoadControl
from bem.contact.grid_workspace import GridWorkspace, SolverParameters


def _point(grid: GridWorkspace, iterate: Iterate) -> _Point:
    """Return a point at approach one; the displacement of the pressure is then in the buffer."""
    grid.displace(iterate)
    sums = grid.contact_sums(iterate)
    return _Point(iterate, 1.0, sums.energy, sums.energy_size, sums.force)


@pytest.mark.parametrize("cap", [1.0, np.inf])
def test_part_of_a_refused_step_keeps_open_cells_open_and_capped_cells_capped(cap):
    operator = displacement_operator(
        Grid((16, 16), (1.0, 1.0)), Body(Material("unit", youngs_modulus=1.0, poissons_ratio=0.3))
    )
    checked = 0
    for seed in range(400):
        rng = np.random.default_rng(seed)
        grid = GridWorkspace(operator, 3 * rng.random(256), cap, SolverParameters())
        first = np.clip(rng.normal(0.3, 0.7, 256), 0.0, 1.0)
        second = np.where(rng.random(256) < 0.5, first, np.clip(rng.normal(0.3, 0.7, 256), 0.0, 1.0))
        inside = (second > 0) & (second < 1)
        second[inside] *= (first.sum() - second[~inside].sum()) / second[inside].sum()
        if second.max() > 1 or second.min() < 0:
            continue
        ends = split_field(first, cap), split_field(second, cap)
        control = LoadControl(float(first.sum()))
        # the refused pressure comes last: its displacement stays in the buffer
        last, refused = (_point(grid, end) for end in ends)
        guard = _EnergyGuard()
        blended = guard.reject_step(grid, control, last, refused).as_field(256, cap)
        between = (blended - first)[first != second] / (second - first)[first != second]
        if not np.ptp(between) < 1e-6:
            continue  # a gradient step
        checked += 1
        assert np.array_equal(blended > 0, (first > 0) | (second > 0))
        if np.isfinite(cap):
            assert (blended[(first == cap) & (second == cap)] == cap).all()
        assert blended.sum() == pytest.approx(control.force, rel=1e-12)
    assert checked >= 20


def test_a_gradient_step_that_raises_the_energy_again_is_shortened():
    operator = displacement_operator(
        Grid((16, 16), (1.0, 1.0)), Body(Material("unit", youngs_modulus=1.0, poissons_ratio=0.3))
    )
    grid = GridWorkspace(operator, np.random.default_rng(0).random(256), np.inf, SolverParameters())
    pressure = np.full(256, 5.0)
    last = _point(grid, split_field(pressure, np.inf))
    guard = _EnergyGuard()
    guard.accept(last)
    lengths = []
    for _ in range(3):
        # a step of no length has no minimum on the way: each replacement is a gradient step from its beginning
        step = guard.reject_step(grid, ApproachControl(1.0), last, last).as_field(256, np.inf) - pressure
        lengths.append(np.abs(step).max())
        grid.begin_round(last.iterate, keep=True)
    assert lengths[0] / np.array(lengths) == pytest.approx([1.0, 4.0, 16.0], rel=1e-9)
    guard.accept(last)
    step = guard.reject_step(grid, ApproachControl(1.0), last, last).as_field(256, np.inf) - pressure
    assert np.abs(step).max() == pytest.approx(lengths[0], rel=1e-9)


@pytest.mark.parametrize("factor", [0.8, 0.95])
def test_a_steady_fall_of_the_violation_is_progress(factor):
    progress = _Progress(SolverParameters(rounds=1000))
    for count in range(200):
        violation = factor**count
        assert not progress.stalls(violation, 0.0, 1.0, round_off=False)
        progress.improves(violation)
        progress.set_guard(violation, has_energy=True)
        assert progress.release_violation == 0


def test_no_fall_of_the_violation_sets_the_guard_and_then_stalls():
    parameters = SolverParameters()
    progress = _Progress(parameters)
    guarded = stalled = None
    for count in range(100):
        stalls = progress.stalls(1.0 + count % 2, 0.0, 1.0, round_off=False)
        progress.improves(1.0 + count % 2)
        progress.set_guard(1.0 + count % 2, has_energy=True)
        guarded = count if guarded is None and progress.release_violation > 0 else guarded
        stalled = count if stalled is None and stalls else stalled
    assert (guarded, stalled) == (parameters.patience, parameters.stall_limit + 1)
