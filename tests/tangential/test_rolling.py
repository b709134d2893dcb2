"""Steady rolling against Carter, Kalker's linear theory and gross sliding, and by its own certificate."""

import numpy as np
import pytest
from scipy.optimize import brentq

from bem import (
    Body,
    Grid,
    InfeasibleError,
    InputError,
    Material,
    dundurs_beta,
    solve_rolling,
)
from bem.reference_solutions.partial_slip import RollingCylinder
from bem.tangential import tangential_operator

STEEL = Material("steel", youngs_modulus=200e9, poissons_ratio=0.3)


def line(cells, half_width=1e-4, radius=1e-2):
    """A cylinder's Hertz pressure on one row of cells in plane strain."""
    grid = Grid((cells, 1), (2.2 * half_width / cells, 1e-3), periodic=(False, True))
    x = grid.x - grid.x.mean()
    peak = half_width * STEEL.plane_strain_modulus / 2 / (2 * radius)
    return grid, peak * np.sqrt(np.maximum(1 - (x / half_width) ** 2, 0))[:, None]


@pytest.mark.parametrize("share", [0.3, 0.9])
def test_carter_s_cylinder(share):
    """Carter (1926), Johnson eq. 8.15: creepage f a / R (1 - sqrt(1 - share)), stick next to where it rolls in."""
    misses = []
    for cells in (64, 256):
        grid, pressure = line(cells)
        total = float(pressure.sum()) * grid.cell_area
        solution = solve_rolling(
            pressure, grid, (Body(STEEL), Body(STEEL)), friction=0.3, force=(share * 0.3 * total, 0.0)
        )
        assert solution.status == "converged"
        misses.append(solution.creepage[0] / RollingCylinder(1e-4, 1e-2, 1.0, 0.3).creepage(share) - 1)
        stick = solution.stick_area / (solution.stick_area + solution.slip_area)
        assert stick == pytest.approx(np.sqrt(1 - share), abs=1.5 / cells)  # a cell and a half of the edges
        where = np.flatnonzero((np.hypot(*solution.traction) < (1 - 1e-9) * 0.3 * pressure) & (pressure > 0))
        assert where.max() == np.flatnonzero(pressure[:, 0])[-1]  # up to the leading edge
    assert abs(misses[1]) < 2.5e-3
    assert abs(misses[1]) < abs(misses[0])


def test_energy_of_cells_comes_to_that_of_the_balance():
    """Traction x slip, cell by cell, misses force x creepage by what first order leaves: less with finer cells."""
    missed = []
    for cells in (64, 256, 1024):
        grid, pressure = line(cells)
        total = float(pressure.sum()) * grid.cell_area
        solution = solve_rolling(
            pressure, grid, (Body(STEEL), Body(STEEL)), friction=0.3, force=(0.9 * 0.3 * total, 0.0)
        )
        balance = -float(solution.force @ solution.creepage) * grid.spacing[0]
        assert solution.dissipated_energy == pytest.approx(balance, rel=1e-6)
        missed.append(1 + float((solution.traction * solution.slip).sum()) * grid.cell_area / balance)
    assert 0 < missed[2] < 0.5 * missed[1] < 0.25 * missed[0] < 0.03


def round_contact(cells, nu=0.25, modulus=82e9, half_width=1e-3):
    grid = Grid((cells, cells), (2.2 * half_width / cells,) * 2)
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    pressure = 1e9 * np.sqrt(np.maximum(1 - (x[:, None] ** 2 + y**2) / half_width**2, 0))
    material = Material("wheel", youngs_modulus=2 * modulus * (1 + nu), poissons_ratio=nu)
    return grid, pressure, (Body(material), Body(material)), modulus * half_width**2


def test_kalker_s_linear_coefficients():
    """Nothing slips: C11 4.12, C22 3.67, C23 1.47 for a circle at nu 1/4 (Kalker 1967; Johnson, table 8.1)."""
    grid, pressure, bodies, scale = round_contact(32)
    along = solve_rolling(pressure, grid, bodies, friction=1e6, creepage=(1e-4, 0.0))
    across = solve_rolling(pressure, grid, bodies, friction=1e6, creepage=(0.0, 1e-4))
    turning = solve_rolling(pressure, grid, bodies, friction=1e6, spin=0.1)
    # of first order in the cell, which is a fifteenth of the radius; 1.5 % at 64 cells for the spin
    assert -along.force[0] / (scale * 1e-4) == pytest.approx(4.12, rel=0.02)
    assert -across.force[1] / (scale * 1e-4) == pytest.approx(3.67, rel=0.02)
    assert abs(turning.force[1]) / (scale * 1e-3 * 0.1) == pytest.approx(1.47, rel=0.05)
    assert abs(along.force[1]) < 1e-6 * abs(along.force[0])
    for solution in (along, across, turning):
        assert solution.status == "converged"
        assert solution.slip_area == 0


def test_force_is_what_its_creepage_gives():
    grid, pressure, bodies, _ = round_contact(24)
    total = float(pressure.sum()) * grid.cell_area
    one = solve_rolling(pressure, grid, bodies, friction=0.3, force=(0.15 * total, 0.05 * total), spin=0.2)
    two = solve_rolling(pressure, grid, bodies, friction=0.3, creepage=one.creepage, spin=0.2)
    assert one.status == two.status == "converged"
    assert one.force == pytest.approx([0.15 * total, 0.05 * total], rel=1e-7)
    np.testing.assert_allclose(two.force, one.force, rtol=1e-6)
    assert two.dissipated_energy == pytest.approx(one.dissipated_energy, rel=1e-5)
    # friction's power is what the creepages and the spin's moment put in: force x creepage at least comes back
    assert two.dissipated_energy > 0


def test_large_creepage_slides_everywhere():
    grid, pressure, bodies, _ = round_contact(16)
    total = float(pressure.sum()) * grid.cell_area
    solution = solve_rolling(pressure, grid, bodies, friction=0.3, creepage=(0.03, 0.04))
    assert solution.status == "converged"
    assert solution.stick_area == 0
    np.testing.assert_allclose(solution.force, [-0.3 * total * 0.6, -0.3 * total * 0.8], rtol=0.02)


def test_certificate_holds_from_the_traction_alone():
    """Coulomb's law for the slip over a cell, formed here, with spin and bodies that differ."""
    grid, pressure, (first, _), _ = round_contact(24)
    bodies = (first, Body(Material("soft", youngs_modulus=5e9, poissons_ratio=0.1)))
    solution = solve_rolling(pressure, grid, bodies, friction=0.2, creepage=(2e-3, 1e-3), spin=2.0)
    assert solution.status == "converged"
    operator = tangential_operator(grid, bodies)
    moved = operator(solution.traction) + operator.displacement_under_pressure(pressure)
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    slip = moved.copy()
    slip[:, :-1] -= moved[:, 1:]
    slip[0] += (2e-3 - 2.0 * y[None, :]) * grid.spacing[0]
    slip[1] += (1e-3 + 2.0 * x[:, None]) * grid.spacing[0]
    bound = 0.2 * pressure
    size = np.hypot(*solution.traction)
    sticks = (bound > 0) & (size < (1 - 1e-6) * bound)
    scale = np.abs(slip).max()
    assert sticks.any()
    assert np.abs(slip[:, sticks]).max() < 1e-6 * scale
    slides = (bound > 0) & ~sticks
    assert (slip * solution.traction).sum(0)[slides].max() < 1e-6 * scale * bound.max()
    assert (size <= bound * (1 + 1e-12)).all()


def test_messages():
    grid, pressure, bodies, _ = round_contact(8)
    with pytest.raises(InputError, match="only one of them"):
        solve_rolling(pressure, grid, bodies, friction=0.3, creepage=(1e-3, 0.0), force=(1.0, 0.0))
    with pytest.raises(InfeasibleError, match="must be less than friction x load"):
        solve_rolling(pressure, grid, bodies, friction=0.3, force=(1e9, 0.0))
    with pytest.raises(InputError, match="spin"):
        solve_rolling(pressure, grid, bodies, friction=0.3, spin=np.inf)
    still = solve_rolling(np.zeros(grid.shape), grid, bodies, friction=0.3, creepage=(1e-3, 0.0))
    assert still.status == "converged"
    assert not still.traction.any()


PAIRS = {
    "aluminium": (70e9, 0.33),
    "PEEK": (3.6e9, 0.38),
    "bronze": (110e9, 0.34),
    "rubber": (5e6, 0.49),
    "glass": (64e9, 0.2),
}


def roller(name, cells, half_width=1e-4, filled=0.8):
    """A roller of that material on steel: grid, Hertz pressure, bodies, half width over radius."""
    modulus, nu = PAIRS[name]
    contact_modulus = 1 / ((1 - nu**2) / modulus + (1 - STEEL.poissons_ratio**2) / STEEL.youngs_modulus)
    grid = Grid((cells, 1), (2 * half_width / filled / cells, 1e-2), periodic=(False, True))
    radius, x = 1e-2, grid.x
    pressure = half_width * contact_modulus / (2 * radius) * np.sqrt(np.maximum(1 - (x / half_width) ** 2, 0))
    bodies = (Body(Material(name, youngs_modulus=modulus, poissons_ratio=nu)), Body(STEEL))
    return grid, pressure[:, None], bodies, half_width / radius


def friction_work(solution, grid):
    """Energy over the distance rolled, mean traction x slip, formed anew from tractions and displacements."""
    slip = solution.creepage[:, None, None] * grid.spacing[0] + solution.displacement
    slip[:, :-1] -= solution.displacement[:, 1:]
    slip[:, -1] -= solution.displacement[:, -1]
    mean = 0.5 * (solution.traction + np.pad(solution.traction[:, 1:], ((0, 0), (0, 1), (0, 0))))
    return -float((mean * slip).sum()) * grid.spacing[1]


@pytest.mark.parametrize("seed", range(2))
def test_random_rollers_of_unlike_bodies_meet_their_force(seed):
    """Friction from 1e-4 to 0.3, forces from none to near sliding: 69 of 192 once stalled, with creepages to 1e28."""
    rng = np.random.default_rng(seed)
    for _ in range(25):
        name, friction = rng.choice(list(PAIRS)), 10 ** rng.uniform(-4, np.log10(0.3))
        share = rng.choice([0.0, rng.uniform(0.0, 0.95)]) * rng.choice([-1.0, 1.0])
        cells = int(rng.choice([16, 37, 64, 100]))
        grid, pressure, bodies, slope = roller(name, cells, filled=rng.uniform(0.6, 1.0))
        limit = friction * float(pressure.sum()) * grid.cell_area
        solution = solve_rolling(pressure, grid, bodies, friction=friction, force=(share * limit, 0.0))
        assert solution.status == "converged", (name, friction, share, cells)
        assert np.abs(solution.force - [share * limit, 0.0]).max() <= 1e-8 * limit
        assert np.abs(solution.creepage).max() <= slope * (0.5 + 2 * friction)
        assert abs(solution.creepage[1]) <= 1e-9 * slope
        again = solve_rolling(pressure, grid, bodies, friction=friction, creepage=solution.creepage)
        assert again.status == "converged"
        # what a creepage gives is known to the tolerance of the slip, a larger one of tractions the less friction is
        assert np.abs(again.force - solution.force).max() <= 1e-4 * limit


@pytest.mark.parametrize("name", ["aluminium", "rubber"])
def test_unlike_rollers_of_little_friction_creep_by_what_pressure_strains_them(name):
    """As friction vanishes pressure alone moves the surfaces, by du/dx = 2 beta p / E* (Johnson, eq. 2.25 of both).

    Where p is above p_c the slip is forwards, elsewhere backwards; without a force each half of the load slides one
    way: in a Hertz contact x sqrt(1 - x^2) + asin x = pi/4 at x_c = 0.404 a. The creepage is that strain at p_c.
    """
    middle = 0.5 * brentq(lambda angle: angle + np.sin(angle) - np.pi / 2, 0.0, np.pi / 2)  # twice asin(x_c)
    misses = []
    for cells in (100, 400):
        grid, pressure, bodies, slope = roller(name, cells)  # p_0 = E* a / 2 R
        solution = solve_rolling(pressure, grid, bodies, friction=1e-4, force=(0.0, 0.0))
        assert solution.status == "converged"
        strain = dundurs_beta(bodies[0].material, bodies[1].material) * slope * np.cos(middle)
        misses.append(solution.creepage[0] / -strain - 1)
    assert abs(misses[1]) < 3e-3
    assert abs(misses[1]) < 2e-3 + abs(misses[0])


def test_rollers_of_the_report_at_half_of_what_slides():
    """200 cells of 1.2 um x 10 mm, friction 0.02, which stalled at a creepage of 6e12.

    It lies between the creepage of like bodies and the strain that the highest pressure makes.
    """
    grid, pressure, bodies, slope = roller("aluminium", 200, half_width=1e-4, filled=200 / 240)
    total = float(pressure.sum()) * grid.cell_area
    assert grid.spacing[0] == pytest.approx(1.2e-6)
    solution = solve_rolling(pressure, grid, bodies, friction=0.02, force=(0.01 * total, 0.0))
    assert solution.status == "converged"
    assert solution.force == pytest.approx([0.01 * total, 0.0], abs=1e-8 * 0.02 * total)
    strained = dundurs_beta(bodies[0].material, bodies[1].material) * slope
    assert -strained < solution.creepage[0] < RollingCylinder(1e-4, 1e-2, 1.0, 0.02).creepage(0.5)


def test_mirrored_forces_of_unlike_bodies_mirror_across_the_rolling():
    grid, pressure, (first, _), _ = round_contact(16)
    bodies = (first, Body(Material("soft", youngs_modulus=5e9, poissons_ratio=0.1)))
    total = float(pressure.sum()) * grid.cell_area
    one, two = (
        solve_rolling(pressure, grid, bodies, friction=0.01, force=(0.003 * total, sign * 0.004 * total), spin=sign)
        for sign in (1, -1)
    )
    assert one.status == two.status == "converged"
    signs = np.array([1.0, -1.0])
    np.testing.assert_allclose(two.creepage, signs * one.creepage, rtol=1e-5)
    # of tractions only as many digits as the slip's tolerance leaves
    np.testing.assert_allclose(
        two.traction, signs[:, None, None] * one.traction[:, :, ::-1], atol=1e-4 * 0.01 * pressure.max()
    )


def test_what_is_not_converged_has_the_force_and_a_finite_creepage():
    grid, pressure, bodies, slope = roller("PEEK", 100)
    limit = 1e-3 * float(pressure.sum()) * grid.cell_area
    for steps in (0, 1):
        solution = solve_rolling(
            pressure, grid, bodies, friction=1e-3, force=(0.5 * limit, 0.0), max_iterations=steps, tolerance=1e-12
        )
        assert solution.status == "max_iterations"
        assert np.abs(solution.creepage).max() <= slope


@pytest.mark.parametrize(("name", "friction", "share"), [("aluminium", 0.1, 0.2), ("rubber", 0.02, 0.2)])
def test_energy_of_unlike_rollers_is_that_of_fine_cells(name, friction, share):
    """Tractions after the slip against what pressure moves miss 11 % at 200 cells: the mean before and after 1 %."""
    work = []
    for cells in (200, 1600):
        grid, pressure, bodies, _ = roller(name, cells)
        limit = friction * float(pressure.sum()) * grid.cell_area
        solution = solve_rolling(pressure, grid, bodies, friction=friction, force=(share * limit, 0.0))
        assert solution.status == "converged"
        work.append(solution.dissipated_energy / grid.spacing[0])
        assert work[-1] == pytest.approx(friction_work(solution, grid), rel=1e-6)
        assert 0 < solution.cell_energy < solution.dissipated_energy
        # creepage and pressure put in what friction takes
        pushed = tangential_operator(grid, bodies).displacement_under_pressure(pressure)
        mean = 0.5 * (solution.traction[:, :-1] + solution.traction[:, 1:])
        put_in = -float(solution.force @ solution.creepage)
        put_in -= float((mean * (pushed[:, :-1] - pushed[:, 1:])).sum()) * grid.spacing[1]
        assert work[-1] == pytest.approx(put_in, rel=1e-6)
    assert work[0] == pytest.approx(work[1], rel=0.015)


def test_contact_that_reaches_the_end_of_its_grid_is_that_on_a_longer_one():
    grid, pressure, bodies, _ = roller("bronze", 40, filled=1.0)
    longer = Grid((60, 1), grid.spacing, periodic=grid.periodic)
    force = (0.02 * float(pressure.sum()) * grid.cell_area, 0.0)
    one = solve_rolling(pressure, grid, bodies, friction=0.05, force=force)
    two = solve_rolling(np.pad(pressure, ((10, 10), (0, 0))), longer, bodies, friction=0.05, force=force)
    assert one.status == two.status == "converged"
    assert one.traction.shape == (2, *grid.shape)
    np.testing.assert_allclose(one.creepage, two.creepage, rtol=1e-6)
    np.testing.assert_allclose(one.traction, two.traction[:, 10:-10], atol=1e-5 * np.abs(two.traction).max())
    assert one.dissipated_energy == pytest.approx(two.dissipated_energy, rel=1e-5)
