"""Random problems that once defeated the solver; each became a fixed case."""

import numpy as np
import pytest
from contact_oracles import FREE, HALF_X, HALF_Y, PERIODIC, operator, rough, violation
from random_surfaces import self_affine

from bem import Body, Grid, Layer, Material, displacement_operator, generate_surface
from bem.contact import solve_contact
from bem.contact.bounds import Iterate, shift_full_contact


def random_problem(seed):
    """A gap of one of five kinds on a random grid, with random boundaries, hardness and control."""
    rng = np.random.default_rng(seed)
    nx, ny = (int(v) for v in rng.integers(2, 90, 2))
    periodic = tuple(bool(v) for v in rng.integers(0, 2, 2))
    side = 1 / max(nx, ny)
    aspect = 10 ** rng.uniform(-1, 1) if rng.random() < 0.3 else 1
    op = operator((nx, ny), (side, side * aspect), periodic)
    kind = rng.integers(0, 5)
    hurst, rolloff = rng.uniform(0.1, 1), rng.uniform(1, 6)
    gap = -self_affine(nx, ny, rng, hurst, rolloff)
    if kind == 1:
        gap = rng.standard_normal((nx, ny))
    elif kind == 2:
        gap = np.round(gap)
    elif kind == 3:
        gap = gap + 20 * np.linspace(-1, 1, nx)[:, None] ** 2
    elif kind == 4:
        gap = np.where(rng.random((nx, ny)) < 0.05, 0, 1.0) + 1e-3 * rng.random((nx, ny))
    gap = gap * 10 ** rng.uniform(-4, 0)
    load = gap.std() * 10 ** rng.uniform(-5, 3)
    control = ("load", "approach", "mean_gap")[rng.integers(0, 3)]
    cap = 10 ** rng.uniform(-3, 2) * gap.std() if rng.random() < 0.5 else None
    drop = gap.mean() - gap.min()
    if control == "load":
        value = load if cap is None else min(load, cap * op.grid.area * rng.uniform(0.01, 1))
    elif control == "approach":
        value = gap.min() + drop * rng.uniform(0, 1 if all(periodic) and cap is None else 2)
    else:
        value = drop * 10 ** rng.uniform(-4, 0.1)
    return gap, op, cap, {control: float(value)}


# plateaus and spikes under heavy approach, soft caps (fully plastic), mean gaps near full contact
@pytest.mark.parametrize("seed", [362, 419, 424, 471, 1177, 1248, *range(6)])
def test_problems_found_by_chance(seed):
    gap, op, cap, control = random_problem(seed)
    solution = solve_contact(gap, op, hardness=cap, **control)
    assert solution.status == "converged"
    reach = np.abs(solution.displacement).max()
    # the independent product agrees to about 1e-12 of what it is made of
    allowed = 1e-8 * gap.std() + 1e-12 * (reach + np.abs(gap).max())
    assert violation(op, gap, solution, np.inf if cap is None else cap) <= allowed


@pytest.mark.parametrize(("cells", "share"), [((19, 2), None), ((1, 31), 0.3), ((29, 28), 1.0)])
def test_flat_gap_pressed_together_periodically(cells, share):
    # displacements would be rounding only: nothing to iterate on, nothing to measure a residual by
    op = operator(cells, (1.0, 1.0), PERIODIC, modulus=1e9)
    load = 1e4 * op.grid.area
    cap = None if share is None else load / op.grid.area / share
    solution = solve_contact(np.full(cells, 3e-5), op, load=load, hardness=cap)
    assert solution.status == "converged"
    assert solution.iterations == 0
    assert solution.residual == 0
    assert (solution.pressure == solution.pressure[0, 0]).all()
    np.testing.assert_allclose(solution.load, load, rtol=1e-13)  # a sum of equal numbers


@pytest.mark.parametrize("periodic", [FREE, PERIODIC, HALF_X, HALF_Y])
def test_flat_gap_held_apart_by_the_lubricant(periodic):
    op = operator((13, 7), (1e-6, 1e-6), periodic, modulus=1e11)
    for hardness in (None, 1e9):
        solution = solve_contact(np.full((13, 7), 2e-9), op, mean_gap=1.3e-9, hardness=hardness)
        assert solution.status == "converged"
        assert solution.load == 0
        assert solution.approach == pytest.approx(0.7e-9, rel=1e-12, abs=0)


@pytest.mark.parametrize(("shape", "approach"), [((1, 1), 0.3e-9), ((1, 5), -1e-9), ((4, 4), 0.3e-9)])
def test_flat_bodies_apart_at_an_approach_that_units_round(shape, approach):
    """These stalled on the last digit of their approach, the only length there is."""
    op = operator(shape, (1e-6, 1.3e-6), FREE, modulus=1e11)
    for gap in (3.7e-9, 5.1e-9, 0.7e-9):
        solution = solve_contact(np.full(shape, gap), op, approach=approach)
        assert solution.status == "converged"
        assert (solution.load, solution.residual) == (0, 0)
        assert solution.approach == approach


# all of these stalled by way of the approach: next to full contact the mean gap hangs on the last few cells
@pytest.mark.parametrize(("share", "seed"), [(0.017, 0), (0.002, 2), (0.017, 4), (0.002, 5)])
def test_mean_gap_near_full_contact_below_a_high_cap(seed, share):
    op = operator((11, 78), (1.0, 3.2), PERIODIC)
    gap = rough(11, 78, seed=seed, hurst=0.3)
    capped = solve_contact(gap, op, mean_gap=share, hardness=1e4)
    assert capped.status == "converged"
    assert violation(op, gap, capped, 1e4) <= 1e-8 * gap.std() + 1e-12 * np.abs(capped.displacement).max()
    # no pressure reaches the cap, so it changes nothing; mean gap and pressure are both exact to the residual
    assert capped.convolutions < 600  # 6000 if the search went on by the approach
    elastic = solve_contact(gap, op, mean_gap=share)
    assert capped.plastic_area == 0
    np.testing.assert_allclose(capped.pressure, elastic.pressure, atol=1e-5 * elastic.pressure.max())


@pytest.mark.parametrize("shape", [(17, 18), (22, 25), (18, 1)])
def test_mean_gap_of_zero_with_friction_beside_a_rigid_body(shape):
    """Full contact was written down without what friction adds to the gap, and stalled after two convolutions."""
    grid = Grid(shape, (1.0, 1.0), periodic=PERIODIC)
    body = Body(Material("cork", youngs_modulus=1.0, poissons_ratio=0.0))
    op = displacement_operator(grid, body, friction=0.9)
    gap = rough(*shape, seed=3)
    solution = solve_contact(gap, op, mean_gap=0.0)
    assert solution.status == "converged"
    closed = gap + op(solution.pressure)
    assert np.ptp(closed) <= 1e-12 * gap.std()
    assert solution.pressure.min() == 0.0


@pytest.mark.parametrize(
    ("shape", "low", "rounding"),
    [((13, 61), 1, 0.0), ((13, 61), 1, 1e-13), ((13, 61), 6, 1e-15), ((13, 61), 12, 0.0), ((7, 31), 1, 1e-15)],
)
def test_approach_of_a_step_near_full_contact(shape, low, rounding):
    """On the coarse grids the mean gap of the step is another: the approach was beyond it, where there is no answer. A
    cell taken in without pressure made contact full: the pressure was to fall until a cell has none, and one had none,
    so that rounds repeated to the last bit."""
    op = operator(shape, (1.0, 1.0), PERIODIC)
    gap = np.where(np.arange(shape[0])[:, None] < low, 0.0, 1.0 + rounding) * np.ones((1, shape[1]))
    solution = solve_contact(gap, op, approach=gap.mean() - 0.1 * gap.std())
    assert solution.status == "converged"
    assert violation(op, gap, solution) <= 1e-8 * gap.std() + 1e-12 * np.abs(solution.displacement).max()
    assert np.ptp(solution.pressure, axis=1).max() <= 1e-6 * solution.pressure.max()  # nothing varies along the step
    # 15 to 20; 37 to 158 with rounds that repeat
    assert solution.convolutions < 30


@pytest.mark.internal
@pytest.mark.parametrize("shift", [-0.1, 0.1])
def test_full_contact_is_moved_to_a_bound_once(shift):
    """Uniformly, which no displacement answers; there the cells that are at a bound are the ones out of contact."""
    values = np.random.default_rng(1).uniform(0.1, 1.9, 20)
    full = Iterate(np.arange(20), values, np.empty(0, np.int64))
    moved = shift_full_contact(full, shift, 2.0)
    assert moved.cells.size == 19
    assert moved.capped.size == (shift < 0)
    np.testing.assert_allclose(np.ptp(moved.values - values[moved.cells]), 0.0, atol=1e-15)
    values[3] = 0.0 if shift > 0 else 2.0
    assert shift_full_contact(full, shift, 2.0) is None


@pytest.mark.parametrize("seed", [0, 2])
def test_mean_gap_below_a_film_on_a_soft_base(seed):
    """By the approach the cells in contact swing from round to round; one such case used up all 5000 iterations."""
    film = Material("film", youngs_modulus=1e12, poissons_ratio=0.45)
    bases = [Material("base", youngs_modulus=modulus, poissons_ratio=0.0) for modulus in (5e9, 5e6)]
    grid = Grid((48, 32), (2e-8, 2e-8), periodic=(True, True))
    gap = -generate_surface(grid, rms_height=1e-9, correlation_length=3e-8, seed=seed)
    op = displacement_operator(grid, (Body(bases[0], layer=Layer(film, 3e-8)), Body(bases[1])))
    solution = solve_contact(gap, op, mean_gap=4e-11)
    assert solution.status == "converged"
    opening = gap + op(solution.pressure) - solution.approach
    assert np.abs(opening[solution.pressure > 0]).max() <= 1e-8 * gap.std()
    assert np.maximum(opening, 0).mean() == pytest.approx(4e-11, rel=1e-6, abs=0)  # to the residual
    assert solution.iterations < 600  # 330 by way of the load, 1300 to 1400 on the guard of the energy


@pytest.mark.parametrize(("amplitude", "hardness"), [(1e-22, None), (1e-19, 2e9), (1e-16, None)])
def test_a_plate_flat_to_round_off_is_in_full_contact(amplitude, hardness):
    # a load pressed it to 700 iterations and stalled: displacements are rounded by more than the roughness
    n, spacing, load = 32, 1e-6, 1.0
    body = Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3))
    grid = Grid((n, n), (spacing, spacing), periodic=(True, True))
    waves = np.repeat(np.cos(2 * np.pi * np.arange(n) / n)[:, None], n, axis=1)
    gap = amplitude * (waves + 0.1 * np.random.default_rng(1).standard_normal((n, n)))
    found = solve_contact(gap, displacement_operator(grid, (body, body)), load=load, hardness=hardness)
    assert found.status.value == "converged"
    assert found.contact_area == pytest.approx(grid.area, rel=1e-12)
    assert found.load == pytest.approx(load, rel=1e-12)
    mean = load / grid.area
    # full contact (Johnson 13.2): each wave of height a and number q lowers the pressure by E* q a / 2
    modulus = body.material.plane_strain_modulus / 2
    change = -2 * np.mean((found.pressure - mean) * waves)
    height = 2 * np.mean(gap * waves)
    expected = modulus * (2 * np.pi / (n * spacing)) * height / 2
    assert change == pytest.approx(expected, abs=1e-14 * mean, rel=1e-4)  # pressures are rounded at 1e-16 of the mean


@pytest.mark.parametrize("periodic", [FREE, HALF_X])
def test_a_gap_flat_beside_its_displacement_is_closed_in_a_few_rounds(periodic):
    """Pressed flat at ten million times their roughness, 13 x 61 cells took 460 convolutions: the rounds went after
    less of the displacement than transforms resolve."""
    shape = (13, 61)
    op = operator(shape, (1.0, 1.0), periodic)
    gap = -rough(*shape)
    even = op(np.ones(shape)).max()
    load = 1e7 / even * gap.size
    solution = solve_contact(gap, op, load=load)
    assert solution.status == "converged"
    assert solution.convolutions <= 35  # 24 and 29 counted
    assert solution.residual <= 1e-12  # what it is closed to
    # the same by elimination: closed everywhere at one approach, at this load
    matrix = np.array([op(one.reshape(shape)).ravel() for one in np.eye(gap.size)]).T
    bordered = np.block([[matrix, -np.ones((gap.size, 1))], [np.ones((1, gap.size)), np.zeros((1, 1))]])
    exact = np.linalg.solve(bordered, np.append(-gap.ravel(), load))[:-1]
    assert np.abs(solution.pressure.ravel() - exact).max() <= 1e-11 * exact.max()


@pytest.mark.parametrize(
    ("cells", "periodic", "ratio"), [(80, HALF_X, 1e8), (256, FREE, 1e8), (256, HALF_X, 1e6), (80, FREE, 1e6)]
)
def test_larger_flat_gaps_are_closed_in_as_few_rounds(cells, periodic, ratio):
    """What transforms of many cells resolve is more than 1e-13 of the displacement: where rounds went after that, they
    took 408 to 504 convolutions at 256 cells."""
    op = operator((cells, cells), (1.0, 0.7), periodic)
    gap = np.random.default_rng(1).random((cells, cells))
    load = ratio / op(np.ones(gap.shape)).max() * gap.size * 0.7
    solution = solve_contact(gap, op, load=load)
    assert solution.status == "converged"
    assert solution.convolutions <= 30  # 20 to 25 counted


@pytest.mark.parametrize(("cells", "periodic"), [(96, FREE), (64, HALF_X)])
def test_gaps_just_above_flat_are_given_up_where_all_that_is_left_is_round_off(cells, periodic):
    """A 1e-8 of a roughness of 3e-6 of the displacement is less than transforms resolve: 430 convolutions were spent on
    that; 36 and 32 counted."""
    op = operator((cells, cells), (1 / cells, 1 / cells), periodic)
    reach = solve_contact(np.zeros((cells, cells)), op, load=1.0).displacement.max()
    gap = -3e-6 * reach * rough(cells, cells)
    solution = solve_contact(gap, op, load=1.0)
    opening = gap + op(solution.pressure) - solution.approach
    assert np.abs(opening[solution.pressure > 0]).max() <= 1e-12 * reach
    assert opening.min() >= -1e-12 * reach
    assert (solution.status == "converged") == (solution.residual <= 1e-8)
    assert solution.convolutions <= 45
