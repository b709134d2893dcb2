"""Steady rolling against Carter, Kalker's linear theory and gross sliding, and by its own certificate."""

import numpy as np
import pytest

from bem import Body, Grid, InfeasibleError, InputError, Material, solve_rolling
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
    moved = operator(solution.traction) + operator.under_pressure(pressure)
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
