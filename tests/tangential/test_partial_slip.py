"""Partial slip against Cattaneo and Mindlin, their loops, superposition for lines, and by its own certificate."""

import itertools

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem import (
    Body,
    Grid,
    InfeasibleError,
    InputError,
    Layer,
    Material,
    displacement_operator,
    generate_surface,
    solve_contact,
    solve_partial_slip,
)
from bem.convolution import COUNT
from bem.notes import has_code
from bem.notes.contact import PRESSING_PATH
from bem.reference_solutions.partial_slip import PushedBall, spence_stick_share
from bem.tangential import tangential_operator
from bem.tangential.friction_discs import project_to_friction_discs, project_with_force

# CONTACT's example of Cattaneo's shift (Kalker, Vollebregt): R 50 mm, G 200 MPa, nu 0.42, 9.1954 N, friction 0.4
MODULUS, NU, RADIUS, LOAD, FRICTION = 200e6, 0.42, 50e-3, 9.1954, 0.4
SOFT = Material("soft", youngs_modulus=1e8, poissons_ratio=0.3)
SOLID = Material("solid", youngs_modulus=2 * MODULUS * (1 + NU), poissons_ratio=NU)
BODIES = (Body(SOLID), Body(SOLID))
HALF_WIDTH = (3 * LOAD * RADIUS * (1 - NU**2) / (2 * SOLID.youngs_modulus)) ** (1 / 3)


def gap_of_ball(grid):
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    return (x[:, None] ** 2 + y**2) / (2 * RADIUS)


def ball(cells):
    grid = Grid((cells, cells), (2.4 * HALF_WIDTH / cells,) * 2)
    return grid, solve_contact(gap_of_ball(grid), displacement_operator(grid, BODIES), load=LOAD)


@pytest.fixture(scope="module")
def pressed():
    return ball(48)


CLOSED = PushedBall(HALF_WIDTH, LOAD, FRICTION, 2 * (2 - NU) / MODULUS)


def mindlin_shift(share):
    return CLOSED.shift(share * FRICTION * LOAD)


def test_cattaneo_s_shift_of_the_published_example(pressed):
    """Fx = 7/8 of friction x load: shift 8.17e-3 mm in theory, 8.155e-3 by CONTACT, 15 x 15 cells; stick radius a/2."""
    grid, contact = pressed
    solution = solve_partial_slip(contact, grid, BODIES, friction=FRICTION, force=(7 / 8 * FRICTION * LOAD, 0.0))
    assert solution.status == "converged"
    assert solution.residual <= 1e-8
    assert solution.force == pytest.approx([7 / 8 * FRICTION * LOAD, 0.0], abs=1e-12 * LOAD)
    # the closed form lets no cell slip sideways: the exact shift is 0.18 % below it, see the next test
    assert solution.shift[0] == pytest.approx(8.17e-6, rel=4e-3)
    assert abs(solution.shift[1]) < 1e-7 * solution.shift[0]
    radius = np.sqrt(solution.stick_area / (solution.stick_area + solution.slip_area))
    # 0.2 % by what slips sideways, 0.1 % by the cells; counted it is within half a cell
    assert radius == pytest.approx(0.5, rel=3e-3)
    counted = np.sqrt(solution.counted_stick_area / contact.counted_area)
    assert counted == pytest.approx(0.5, abs=0.5 * grid.spacing[0] / HALF_WIDTH)
    assert solution.stick_area + solution.slip_area == pytest.approx(contact.contact_area)


def test_shift_converges_below_mindlin_s_by_what_slips_sideways():
    """0.18 % at nu 0.42 (CONTACT: 0.21 % on 15 x 15 cells); with nu = 0 both directions uncouple and it is exact."""
    shifts = []
    for cells in (32, 64, 128):
        grid, contact = ball(cells)
        solved = solve_partial_slip(contact, grid, BODIES, friction=FRICTION, force=(7 / 8 * FRICTION * LOAD, 0.0))
        shifts.append(solved.shift[0] / mindlin_shift(7 / 8) - 1)
    assert shifts[-1] == pytest.approx(-1.84e-3, abs=2e-4)
    assert abs(shifts[2] - shifts[1]) < abs(shifts[1] - shifts[0]) / 4


def test_without_poisson_the_traction_is_cattaneo_s():
    """nu = 0: exact; what is left is of the edge of stick, a line of cells."""
    cork = Material("cork", youngs_modulus=1e9, poissons_ratio=0.0)
    errors = []
    for cells in (32, 64):
        grid = Grid((cells, cells), (2.4 / cells,) * 2)
        x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
        r = np.hypot(x[:, None], y)
        pressure = 1e6 * np.sqrt(np.maximum(1 - r * r, 0))
        total = float(pressure.sum()) * grid.cell_area
        force = (1 - 0.6**3) * 0.3 * total
        solved = solve_partial_slip(pressure, grid, (Body(cork), Body(cork)), friction=0.3, force=(force, 0.0))
        want = PushedBall(1.0, 2 / 3 * np.pi * 1e6, 0.3, 4e-9).traction(r, force * 2 / 3 * np.pi * 1e6 / total)
        errors.append(np.abs(solved.traction[0] - want).mean() / want.mean())
        assert np.abs(solved.traction[1]).max() < 1e-6 * want.max()  # what the tolerance leaves
    assert errors[1] < 6e-3
    assert errors[1] < errors[0] / 1.7


def sticks(cells, share, nu, with_gap):
    """Stick area over Cattaneo's, within cells and counted: mean size of the error over three places of the ball."""
    like = Body(Material("like", youngs_modulus=1e9, poissons_ratio=nu))
    radius = (3 * 10e-3 * (1 - nu**2) / (2 * 1e9)) ** (1 / 3)
    grid = Grid((cells, cells), (2.5 * radius / cells,) * 2)
    exact, found = np.pi * radius**2 * (1 - share) ** (2 / 3), []
    for place in ((0.0, 0.0), (0.31, 0.17), (0.5, 0.24)):
        x, y = (axis - axis.mean() + p * grid.spacing[0] for axis, p in zip((grid.x, grid.y), place, strict=True))
        gap = (x[:, None] ** 2 + y**2) / (2 * 10e-3)
        contact = solve_contact(gap, displacement_operator(grid, (like, like)), load=1.0)
        given = contact if with_gap else contact.pressure
        solved = solve_partial_slip(given, grid, (like, like), friction=0.3, force=(0.3 * share, 0.0), tolerance=1e-6)
        found.append((solved.stick_area / exact - 1, solved.counted_stick_area / exact - 1))
    return np.abs(found).mean(axis=0)


@pytest.mark.parametrize(("share", "nu", "with_gap"), [(0.0, 0.3, True), (0.3, 0.3, True), (0.6, 0.0, False)])
def test_stick_area_has_its_edge_inside_cells(share, nu, with_gap):
    """Against Cattaneo's circle, all of the contact without a force: of second order, a tenth of what counts miss."""
    (fine, counted), (coarse, _) = sticks(64, share, nu, with_gap), sticks(24, share, nu, with_gap)
    assert fine < 1e-3
    assert fine < 0.1 * counted
    assert fine < max(coarse / 4, 5e-4)  # (64 / 24)^2 = 7, of errors that hang on how the circle meets the cells


def test_force_and_shift_are_two_ways_to_one_answer(pressed):
    grid, contact = pressed
    one = solve_partial_slip(contact, grid, BODIES, friction=FRICTION, force=(1.5, 1.0), rotation=0.01)
    two = solve_partial_slip(contact, grid, BODIES, friction=FRICTION, shift=one.shift, rotation=0.01)
    assert two.status == "converged"
    np.testing.assert_allclose(two.force, one.force, rtol=1e-6)  # the stick zone's stiffness times the tolerance
    assert np.abs(two.traction - one.traction).max() < 1e-5 * np.abs(one.traction).max()


def test_directions_are_alike(pressed):
    grid, contact = pressed
    along = solve_partial_slip(contact, grid, BODIES, friction=FRICTION, force=(2.0, 0.0))
    across = solve_partial_slip(contact, grid, BODIES, friction=FRICTION, force=(0.0, 2.0))
    turned = across.traction.swapaxes(1, 2)[::-1]
    assert np.abs(turned - along.traction).max() < 1e-5 * along.traction.max()


def test_mindlin_and_deresiewicz_s_loop_closes_and_dissipates_its_area(pressed):
    """Force up to F, down to -F, up again: Masing's rule on Mindlin's curve, and the loop's area."""
    grid, contact = pressed
    peak = 0.6 * FRICTION * LOAD
    solution, shifts, energy = None, [], []
    for force in np.concatenate([[peak], peak * np.cos(np.linspace(0, 2 * np.pi, 17))[1:]]):
        solution = solve_partial_slip(
            contact, grid, BODIES, friction=FRICTION, force=(force, 0.0), previous=solution, tolerance=1e-6
        )
        assert solution.status == "converged"
        shifts.append(solution.shift[0])
        energy.append(solution.dissipated_energy)
    assert shifts[-1] == pytest.approx(shifts[0], rel=1e-4)  # the loop closes
    # and is symmetric but for what slid sideways the first time, 1.3e-4
    assert shifts[8] == pytest.approx(-shifts[0], rel=3e-4)
    unloaded = shifts[4]  # no force, but a shift is left
    theory = mindlin_shift(0.6) - 2 * mindlin_shift(0.3)
    assert unloaded == pytest.approx(theory, rel=0.02)  # the sideways slip that the closed form leaves out
    cycle = CLOSED.cycle_energy(peak)
    # 0.8 %: cells, and the sideways slip again; what slips in a step does so at the bound, so steps add no error
    assert sum(energy[1:]) == pytest.approx(cycle, rel=0.02)
    assert min(energy) >= 0


def test_growing_load_with_growing_force_sticks():
    """Mindlin and Deresiewicz: where the force grows slower than friction x load nothing slips but the new edge."""
    grid, _ = ball(32)
    gap = gap_of_ball(grid)
    operator = displacement_operator(grid, BODIES)
    solution = None
    for part in (0.25, 0.5, 0.75, 1.0):
        contact = solve_contact(gap, operator, load=part * LOAD)
        force = (0.2 * FRICTION * part * LOAD, 0.0)
        solution = solve_partial_slip(contact, grid, BODIES, friction=FRICTION, force=force, previous=solution)
        assert solution.status == "converged"
    at_once = solve_partial_slip(contact, grid, BODIES, friction=FRICTION, force=force)
    assert solution.slip_area < 0.5 * at_once.slip_area


def stick_radius(nu, steps, tolerance=1e-6):
    """Of an elastic body under a rigid ball, pressed in steps of equal contact radius."""
    soft = Material("soft", youngs_modulus=1e9, poissons_ratio=nu)
    half = (3 * 10e-3 * (1 - nu**2) / (4 * soft.youngs_modulus)) ** (1 / 3)
    grid = Grid((64, 64), (2.3 * half / 64,) * 2)
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    gap, operator = (x[:, None] ** 2 + y**2) / (2 * 10e-3), displacement_operator(grid, Body(soft))
    solution = None
    for step in range(1, steps + 1):
        contact = solve_contact(gap, operator, load=(step / steps) ** 3)
        solution = solve_partial_slip(
            contact, grid, Body(soft), friction=0.2, force=(0.0, 0.0), previous=solution, tolerance=tolerance
        )
        assert solution.status == "converged"
    return np.sqrt(solution.stick_area / (solution.stick_area + solution.slip_area)), solution


@pytest.mark.parametrize("nu", [0.0, 0.3])
def test_pressure_alone_makes_unlike_bodies_slip_as_spence_has_it(nu):
    """Coupling and history together, against a closed form; of first order in the steps, and told where it is one."""
    exact = spence_stick_share(0.2 / ((1 - 2 * nu) / (2 * (1 - nu))))
    found = {steps: stick_radius(nu, steps)[0] for steps in (1, 8, 16)}
    assert found[16] == pytest.approx(exact, rel=0.05)
    # extrapolated: what is left is half a cell of the edge of stick, which has 9 to 20 of them
    assert 2 * found[16] - found[8] == pytest.approx(exact, abs=1 / 28)
    assert found[1] < 0.5 * exact
    _, at_once = stick_radius(nu, 1)
    assert has_code(at_once.notes, PRESSING_PATH, reason="at-once")
    assert not stick_radius(nu, 2)[1].notes


@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, False), (True, True)])
def test_certificate_holds_from_the_traction_alone(periodic):
    """Rough, coated, dissimilar: Coulomb's conditions formed here from the operator, on every kind of grid."""
    grid = Grid((48, 40), (1e-6, 1.2e-6), periodic=periodic)
    around = Grid(grid.shape, grid.spacing, periodic=(True, True))
    height = generate_surface(around, rms_height=20e-9, seed=3, correlation_length=6e-6)
    steel = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
    hard = Material("hard", youngs_modulus=400e9, poissons_ratio=0.2)
    bodies = (Body(steel, layer=Layer(hard, 2e-6)), Body(steel))
    contact = solve_contact(height.max() - height, displacement_operator(grid, bodies), load=0.05)
    friction = np.full(grid.shape, 0.3)
    friction[:20] = 0.1
    force = (0.5 * float((friction * contact.pressure).sum()) * grid.cell_area, 0.0)
    solution = solve_partial_slip(contact, grid, bodies, friction=friction, force=force)
    assert solution.status == "converged"
    operator = tangential_operator(grid, bodies)
    displacement = operator(solution.traction) + operator.displacement_under_pressure(contact.pressure)
    np.testing.assert_allclose(solution.displacement, displacement, rtol=0, atol=1e-14 * np.abs(displacement).max())
    slip = displacement - solution.shift[:, None, None]
    bound = friction * contact.pressure
    size = np.hypot(*solution.traction)
    inside = (bound > 0) & (size < (1 - 1e-6) * bound)
    scale = np.abs(displacement).max()
    assert inside.any()
    assert np.abs(slip[:, inside]).max() < 1e-6 * scale
    assert (size <= bound * (1 + 1e-12)).all()
    sliding = (bound > 0) & ~inside
    along = (slip * solution.traction).sum(0)[sliding]
    cross = (slip[0] * solution.traction[1] - slip[1] * solution.traction[0])[sliding]
    assert along.max() < 1e-6 * scale * bound.max()  # against the slip
    assert np.abs(cross).max() < 1e-6 * scale * bound.max()  # and parallel to it


@settings(max_examples=15)
@given(
    seed=st.integers(0, 10**6),
    share=st.floats(0.01, 0.99),
    angle=st.floats(0, 6.28),
    nu=st.floats(0.0, 0.49),
    ratio=st.floats(-2, 2),
    layered=st.booleans(),
)
def test_random_contacts_converge(seed, share, angle, nu, ratio, layered):
    grid = Grid((32, 32), (1.0, 1.0), periodic=(True, True))
    height = generate_surface(grid, rms_height=1.0, seed=seed, hurst=0.8, rolloff_wavelength=16, cutoff_wavelength=4)
    first = Material("first", youngs_modulus=100.0, poissons_ratio=nu)
    second = Material("second", youngs_modulus=100.0 * 10**ratio, poissons_ratio=0.3)
    bodies = (Body(first, layer=Layer(second, 2.0)) if layered else Body(first), Body(second))
    contact = solve_contact(height.max() - height, displacement_operator(grid, bodies), load=2.0 * 1024)
    force = share * 0.4 * contact.load * np.array([np.cos(angle), np.sin(angle)])
    solution = solve_partial_slip(contact, grid, bodies, friction=0.4, force=force)
    assert solution.status == "converged", (solution.residual, solution.iterations)


def test_a_history_keeps_what_sticks(pressed):
    """The same force again changes nothing; a smaller one unloads from the edge only."""
    grid, contact = pressed
    first = solve_partial_slip(contact, grid, BODIES, friction=FRICTION, force=(2.0, 0.0))
    again = solve_partial_slip(contact, grid, BODIES, friction=FRICTION, force=(2.0, 0.0), previous=first)
    assert np.abs(again.traction - first.traction).max() < 1e-5 * first.traction.max()
    assert again.dissipated_energy < 1e-6 * first.dissipated_energy
    back = solve_partial_slip(contact, grid, BODIES, friction=FRICTION, force=(1.0, 0.0), previous=again)
    fresh = solve_partial_slip(contact, grid, BODIES, friction=FRICTION, force=(1.0, 0.0))
    assert np.abs(back.traction - fresh.traction).max() > 0.1 * fresh.traction.max()
    assert back.shift[0] > fresh.shift[0]


@pytest.mark.internal
def test_kernels_are_evaluated_once_for_a_history():
    """Every call makes an operator of its own; the spectra are shared, on the grid and on the coarser ones."""
    grid = Grid((40, 40), (1e-5, 1e-5))
    bodies = (Body(SOLID, layer=Layer(SOFT, 3e-5)), Body(SOLID))
    pressure = np.zeros(grid.shape)
    pressure[10:30, 10:30] = 1e6
    COUNT.reset()
    first = solve_partial_slip(pressure, grid, bodies, friction=0.3, force=(1e-3, 0.0))
    made = COUNT.in_plane, COUNT.tangential
    assert made[0] == 2 * 2  # both bodies, on two grids
    assert made[1] == 2 * 2  # both directions of both bodies
    solve_partial_slip(pressure, grid, bodies, friction=0.3, force=(2e-3, 0.0), previous=first)
    assert (COUNT.in_plane, COUNT.tangential) == made


@pytest.mark.parametrize("unit", [1e-6, 1e6])
def test_units_change_nothing(pressed, unit):
    """Lengths and moduli in other units: the same tractions over pressure, slip over length."""
    grid, contact = pressed
    other = Grid(grid.shape, tuple(unit * side for side in grid.spacing))
    material = Material("same", youngs_modulus=SOLID.youngs_modulus / unit, poissons_ratio=NU)
    one = solve_partial_slip(contact, grid, BODIES, friction=FRICTION, force=(2.0, 1.0))
    two = solve_partial_slip(
        contact.pressure / unit, other, (Body(material), Body(material)), friction=FRICTION, force=(2.0 * unit, unit)
    )
    assert two.status == "converged"
    assert two.iterations == one.iterations
    # tractions follow the tolerance, 1e-8 of the displacement, weighed by the shortest waves of 37 cells
    assert np.abs(two.traction * unit - one.traction).max() < 1e-6 * np.abs(one.traction).max()


def test_nothing_presses_and_nothing_rubs(pressed):
    grid, contact = pressed
    for pressure, friction in ((np.zeros(grid.shape), 0.3), (contact, 0.0)):
        solution = solve_partial_slip(pressure, grid, BODIES, friction=friction, shift=(1e-6, 0.0))
        assert solution.status == "converged"
        assert not solution.traction.any()


def test_messages(pressed):
    grid, contact = pressed
    with pytest.raises(InfeasibleError, match=r"must be less than friction x load = 3\.67"):
        solve_partial_slip(contact, grid, BODIES, friction=FRICTION, force=(3.7, 0.0))
    with pytest.raises(InputError, match="exactly one"):
        solve_partial_slip(contact, grid, BODIES, friction=FRICTION)
    with pytest.raises(InputError, match="friction: every coefficient"):
        solve_partial_slip(contact, grid, BODIES, friction=-0.1, shift=(0.0, 0.0))
    with pytest.raises(InputError, match="must not be negative"):
        solve_partial_slip(-contact.pressure, grid, BODIES, friction=0.1, shift=(0.0, 0.0))
    with pytest.raises(InputError, match="two finite numbers"):
        solve_partial_slip(contact, grid, BODIES, friction=0.1, force=3.0)
    with pytest.raises(InputError, match="rotation"):
        solve_partial_slip(contact, grid, BODIES, friction=0.1, shift=(0.0, 0.0), rotation=np.nan)
    other = solve_partial_slip(np.zeros((4, 4)), Grid((4, 4), (1.0, 1.0)), BODIES, friction=0.1, shift=(0.0, 0.0))
    with pytest.raises(InputError, match="previous"):
        solve_partial_slip(contact, grid, BODIES, friction=0.1, shift=(0.0, 0.0), previous=other)


TOUCHING = {
    "one cell": [(3, 3)],
    "a pair": [(3, 3), (4, 3)],
    "a corner": [(0, 0)],
    "opposite corners": [(0, 0), (7, 7)],
    "a row": [(i, 4) for i in range(8)],
}


@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, True)])
@pytest.mark.parametrize("touching", list(TOUCHING))
def test_few_cells_in_contact_converge(touching, periodic):
    """The first step of every growing load: one cell without a force moves by rounding alone, and took 1000 rounds."""
    grid = Grid((8, 8), (1e-6, 1.2e-6), periodic=periodic)
    pressure = np.zeros(grid.shape)
    for k, cell in enumerate(TOUCHING[touching]):
        pressure[cell] = 1e8 / (1 + 0.3 * k)
    pairs = [BODIES, (Body(SOFT), Body(SOLID)), Body(SOFT)]
    for bodies, friction, share in itertools.product(pairs, (1e-4, 0.03, 1.0), (0.0, 1e-9, 0.3, 1 - 1e-6)):
        limit = friction * float(pressure.sum()) * grid.cell_area
        force = share * limit * np.array([0.6, 0.8])
        solution = solve_partial_slip(pressure, grid, bodies, friction=friction, force=force)
        assert solution.status == "converged", (friction, share)
        assert solution.iterations < 60
        assert np.abs(solution.force - force).max() <= 1e-8 * limit
        assert (np.hypot(*solution.traction) <= friction * pressure * (1 + 1e-12)).all()
        again = solve_partial_slip(pressure, grid, bodies, friction=friction, shift=solution.shift)
        assert again.status == "converged", (friction, share)


def test_one_cell_sticks_without_moving():
    """Unlike bodies, no force: pressure moves the surfaces around a cell, and not the cell."""
    grid = Grid((9, 9), (1e-6, 1e-6))
    pressure = np.zeros(grid.shape)
    pressure[4, 4] = 1e8
    solution = solve_partial_slip(pressure, grid, (Body(SOFT), Body(SOLID)), friction=0.2, force=(0.0, 0.0))
    moved = np.abs(solution.displacement).max()
    assert solution.status == "converged"
    assert moved > 0
    assert np.abs(solution.displacement[:, 4, 4]).max() < 1e-12 * moved
    assert np.abs(solution.traction).max() < 1e-9 * 0.2 * 1e8
    assert solution.slip_area == 0


def test_a_shift_of_planes_that_nothing_holds_slides_them():
    """A mean traction moves nothing on a doubly periodic grid: even pressure slips by all of a shift."""
    grid = Grid((24, 1), (1e-6, 1e-6), periodic=(True, True))
    solution = solve_partial_slip(np.full(grid.shape, 1e9), grid, BODIES, friction=0.05, shift=(1e-6, 0.0))
    assert solution.status == "converged"
    np.testing.assert_allclose(solution.traction[0], 0.05e9, rtol=1e-9)
    np.testing.assert_allclose(solution.slip[0], -1e-6, rtol=1e-9)


@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, False), (True, True)])
@pytest.mark.parametrize("turned", [False, True])
def test_edge_of_stick_on_one_row_of_cells(periodic, turned):
    """The edge's direction came of differences between neighbours along both axes, of which a row has one."""
    shape = (1, 48) if turned else (48, 1)
    grid = Grid(shape, (1e-6, 1e-6), periodic=periodic)
    x = np.linspace(-1, 1, 48)
    pressure = 1e7 * np.sqrt(np.maximum(1 - (1.3 * x) ** 2, 0)).reshape(shape)
    limit = 0.3 * float(pressure.sum()) * grid.cell_area
    force = (0.0, 0.5 * limit) if turned else (0.5 * limit, 0.0)
    for bodies in (BODIES, (Body(SOFT), Body(SOLID))):
        solution = solve_partial_slip(pressure, grid, bodies, friction=0.3, force=force)
        assert solution.status == "converged"
        assert 0 < solution.stick_area < float((pressure > 0).sum()) * grid.cell_area
        assert abs(solution.stick_area - solution.counted_stick_area) <= 2.1 * grid.cell_area


def test_one_cell_that_is_periodic_both_ways_is_refused():
    grid = Grid((1, 1), (1e-6, 1e-6), periodic=(True, True))
    with pytest.raises(InputError, match="grid"):
        solve_partial_slip(np.full((1, 1), 1e6), grid, BODIES, friction=0.1, force=(0.0, 0.0))


@pytest.mark.internal
def test_nearest_tractions_have_their_force_however_far_the_slip():
    """Wanted tractions of 1e-6 to 1e7 bounds, forces from none to sliding: steps of the offset were too short."""
    rng = np.random.default_rng(5)
    for _ in range(400):
        n = int(rng.choice([1, 2, 3, 10, 200]))
        bound = rng.uniform(0.1, 1, n) if rng.random() < 0.5 else np.ones(n)
        size = 10 ** rng.uniform(-6, 7)
        wanted = rng.normal(size=(2, n)) * size
        wanted[1] *= rng.choice([0.0, 1.0])
        share = rng.choice([0.0, 10 ** rng.uniform(-9, 0), rng.uniform(0, 1), 1 - 10 ** rng.uniform(-8, -1)])
        angle = rng.choice([0.0, rng.uniform(0, 7)])
        force = share * bound.sum() * np.array([np.cos(angle), np.sin(angle)])
        out, inside = np.empty_like(wanted), np.empty_like(wanted)
        offset = project_with_force(wanted, bound, force, out)
        # the rounding of wanted + offset
        allowed = 1e-12 + 1e-14 * max(size, float(np.abs(offset).max()))
        assert np.abs(out.sum(1) - force).max() <= allowed * bound.sum()
        project_to_friction_discs(wanted + offset[:, None], bound, inside)
        np.testing.assert_array_equal(out, inside)
