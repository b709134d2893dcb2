"""From a coarser grid to a finer one: what regions carry stays, and what that saves."""

from dataclasses import replace

import numpy as np
import pytest
from contact_oracles import FREE, HALF_X, HALF_Y, PERIODIC, notes_surface, operator, rough

from bem.contact import nested_iteration, solve_contact
from bem.contact.controls import LoadControl
from bem.contact.grid_workspace import IterationBudget
from bem.contact.problem import GridProblem, Settings
from bem.contact.solve_on_grid import solve_on_grid
from bem.threads import set_threads


def _loads(pressure, side, spacing):
    """Of squares of `side` coarse cells; `spacing` of the points in those of the coarser grid, along each axis. A
    point's load lies around it as in linear interpolation, on a periodic surface."""
    totals = pressure
    for axis, step in enumerate(spacing):
        fine = np.moveaxis(totals, axis, 0)
        if step == 0.5:
            fine = 0.5 * fine[::2] + 0.25 * fine[1::2] + 0.25 * np.roll(fine[1::2], 1, axis=0)
        totals = np.moveaxis(np.add.reduceat(fine, np.arange(0, fine.shape[0], side), axis=0), 0, axis)
    return totals


def prolonged(fields, cap, shape, periodic):
    """`nested_iteration.prolong` as a field."""
    cells, values = nested_iteration.prolong(*fields, cap, shape, periodic)
    assert (values > 0).all()
    assert (np.diff(cells) > 0).all()
    fine = np.zeros(shape)
    fine.reshape(-1)[cells] = values
    return fine


def plain(fields, cap, shape, periodic):
    """The same as whole fields in numpy, before regions get their loads."""
    pressure, displacement, gap, approach = fields
    squares, openings = [], []
    root = np.cbrt(np.maximum(gap + displacement - approach, 0.0)) ** 2
    for axis in (0, 1):
        here, root_here = np.moveaxis(pressure, axis, 0), np.moveaxis(root, axis, 0)
        for a, b in ((np.s_[:-1], np.s_[1:]), (np.s_[1:], np.s_[:-1])):
            edges = (here[a] > 0) & (here[a] < cap) & (here[b] <= 0)
            squares.append(here[a][edges] ** 2)
            openings.append(root_here[b][edges])
    scale = np.concatenate(squares).sum() / np.concatenate(openings).sum()
    phi, near = np.where(pressure > 0, pressure**2, -scale * root), pressure > 0
    for axis in (0, 1):
        indices, weights = nested_iteration.interpolation(pressure.shape[axis], shape[axis], periodic[axis])
        phi, near = np.moveaxis(phi, axis, 0), np.moveaxis(near, axis, 0)
        phi = sum(weights[:, k, None] * phi[indices[:, k]] for k in range(4))
        near = np.any([near[indices[:, k]] for k in range(4)], axis=0)
        phi, near = np.moveaxis(phi, 0, axis), np.moveaxis(near, 0, axis)
    return np.where(near & (phi > 0), np.minimum(np.sqrt(np.maximum(phi, 0.0)), cap), 0.0)


@pytest.mark.internal
@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize(
    ("shape", "finer", "periodic"),
    [
        ((32, 24), (64, 48), PERIODIC),
        ((32, 25), (64, 49), HALF_X),
        ((33, 20), (65, 40), HALF_Y),
        ((24, 48), (36, 48), PERIODIC),
        ((1, 30), (1, 60), PERIODIC),
        ((2, 12), (4, 23), HALF_X),
        ((17, 17), (33, 33), FREE),
    ],
)
def test_pressures_on_the_finer_grid_are_those_of_whole_fields(shape, finer, periodic, threads, monkeypatch):
    rng = np.random.default_rng(shape[0])
    monkeypatch.setattr(nested_iteration.reductions, "BLOCK", 5 * finer[1])
    monkeypatch.setattr(nested_iteration, "_restore_square_loads", lambda *_: None)
    set_threads(threads)
    for cap in (np.inf, 0.8):
        for share in (0.03, 0.3):
            pressure = np.where(rng.random(shape) < share, np.minimum(rng.random(shape), cap), 0.0)
            pressure[0, 0], pressure[-1, -1] = 0.5, 0.7  # round the ends
            gap = np.where(pressure > 0, 0.0, rng.random(shape))
            fields = pressure, 0.2 * rng.random(shape), gap, 0.1
            expected = plain(fields, cap, finer, periodic)
            assert 0 < np.count_nonzero(expected) < expected.size
            np.testing.assert_allclose(prolonged(fields, cap, finer, periodic), expected, rtol=1e-9, atol=1e-9)
    set_threads(1)


@pytest.mark.internal
@pytest.mark.parametrize("shape", [(64, 64), (64, 90), (40, 32)])
def test_a_region_has_the_same_load_on_the_finer_grid(shape):
    """But for what its neighbours' factors do to the line of cells that they share; half of it was lost here and there
    before."""
    op = operator(shape, (1.0, 1.0), PERIODIC)
    solution = solve_contact(-rough(*shape), op, load=0.15 * shape[0] * shape[1], tolerance=1e-6)
    finer = (2 * shape[0], 2 * shape[1])
    fine = prolonged(
        (solution.pressure, solution.displacement, -rough(*shape), solution.approach), np.inf, finer, PERIODIC
    )
    assert (fine >= 0).all()
    wanted = _loads(solution.pressure, 8, (1.0, 1.0))
    got = _loads(fine, 8, (0.5, 0.5))
    assert np.abs(got - wanted).max() < 0.05 * wanted.mean()


@pytest.mark.internal
def test_regions_with_cells_at_the_cap_are_left_alone():
    pressure = np.zeros((32, 32))
    pressure[2:6, 2:6] = 1.0
    pressure[18:22, 18:22] = 0.5
    fields = (pressure, np.zeros((32, 32)), np.where(pressure > 0, 0.0, 1.0), 0.0)
    fine = prolonged(fields, 1.0, (64, 64), FREE)
    assert (fine[4:11, 4:11] == 1.0).all()  # none came down from the cap
    np.testing.assert_allclose(_loads(fine, 16, (0.5, 0.5))[1, 1], 16 * 0.5, rtol=1e-12)


@pytest.mark.parametrize(("cells", "periodic", "most"), [(256, FREE, 15.5), (512, FREE, 15.0), (256, HALF_X, 15.5)])
def test_dense_contacts_with_ends_begin_with_the_load_where_it_belongs(cells, periodic, most):
    """A third of the surface in contact. In the mean of three 17.3, 17.9 and 16.9 convolutions before regions kept
    their load from grid to grid, 14.2, 13.6 and 14.1 with it."""
    op = operator((cells, cells), (1 / cells, 1 / cells), periodic)
    solutions = [solve_contact(-notes_surface(cells, seed), op, load=0.02) for seed in range(3)]
    assert all(one.status == "converged" for one in solutions)
    assert np.mean([one.convolutions for one in solutions]) <= most


@pytest.mark.internal
@pytest.mark.parametrize(("excess", "kept"), [(1.3, True), (4.0, False)])
def test_a_coarse_result_that_just_misses_its_goal_starts_the_finer_grid(excess, kept, monkeypatch):
    def stalled(problem, control, start, tolerance, *, guarded_rerun):
        result = solve_on_grid(problem, control, start, tolerance, guarded_rerun=guarded_rerun)
        return replace(result, converged=False, violation=excess * tolerance)

    op, gap = operator((64, 64), (1 / 64, 1 / 64), FREE), -notes_surface(64)
    gap -= gap.min()
    rms_gap, budget = float(gap.std()), IterationBudget(1000)
    problem = GridProblem(Settings(1e-8 * rms_gap, rms_gap, budget), op, gap.reshape(-1), np.inf)
    monkeypatch.setattr(nested_iteration, "solve_on_grid", stalled)
    start = nested_iteration.start_from_coarser(problem, LoadControl(40.0))
    assert (start.pressure is not None) is kept


@pytest.mark.internal
def test_prolongation_without_an_opening_at_the_edge_depends_on_no_unit_of_length():
    """The slope of the gap is unknown there; cells farther out are open."""
    pressure, gap = np.zeros((16, 16)), np.zeros((16, 16))
    pressure[6:10, 6:10] = 0.5
    gap[:4], gap[12:], gap[:, :4], gap[:, 12:] = 1.0, 1.0, 1.0, 1.0
    none = np.zeros_like(gap)
    here, there = (prolonged((pressure, none, unit * gap, 0.0), np.inf, (32, 32), PERIODIC) for unit in (1.0, 64.0))
    assert (here == there).all()
