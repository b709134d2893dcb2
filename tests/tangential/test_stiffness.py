"""Tangential stiffness before slip: circles of any material, a plane that sticks, cells that do not matter."""

import numpy as np
import pytest

from bem import Body, Grid, Layer, Material, solve_partial_slip, tangential_stiffness

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
BRASS = Material("brass", youngs_modulus=100e9, poissons_ratio=0.37)


def disc(cells):
    grid = Grid((cells, cells), (2.2e-3 / cells,) * 2)
    x, y = grid.x - grid.x.mean(), grid.y - grid.y.mean()
    return grid, np.where(x[:, None] ** 2 + y**2 < 1e-6, 1.0, 0.0)


def test_mindlin_s_circle():
    """8 a / sum (2 - nu)/G (Johnson 1985, eq. 7.42): uniform displacement lets nothing move sideways at nu = 0 only.

    Elsewhere the true stiffness of a circle that sticks lies above Mindlin's, which forbids no sideways movement: with
    bodies of like elasticity by less than 0.2 %.
    """
    for bodies in ((Body(STEEL), Body(BRASS)), (Body(STEEL), Body(STEEL))):
        exact = 8e-3 / sum((2 - b.material.poissons_ratio) / b.material.shear_modulus for b in bodies)
        found = []
        for cells in (64, 128):
            grid, pressure = disc(cells)
            stiffness = tangential_stiffness(pressure, grid, bodies)
            assert stiffness[0, 0] == pytest.approx(stiffness[1, 1], rel=1e-6)
            assert abs(stiffness[0, 1]) < 1e-6 * stiffness[0, 0]
            radius = np.sqrt(pressure.sum() * grid.cell_area / np.pi)
            found.append(stiffness[0, 0] * 1e-3 / radius / exact - 1)
        # of first order in the cell: the traction is infinite at the edge
        assert abs(found[1]) < 0.7 * abs(found[0]) < 0.02


def test_it_is_where_partial_slip_begins():
    grid, pressure = disc(48)
    bodies = (Body(STEEL, layers=[Layer(BRASS, 0.2e-3)]), Body(STEEL, layers=[Layer(BRASS, 0.2e-3)]))
    pushed = solve_partial_slip(1e6 * pressure, grid, bodies, friction=1e3, shift=(1e-9, 0.0))
    assert pushed.slip_area == 0
    stiffness = tangential_stiffness(pressure, grid, bodies)
    assert stiffness[:, 0] == pytest.approx(pushed.force / 1e-9, rel=1e-6, abs=1e-6 * stiffness[0, 0])


def test_no_contact_has_none():
    grid, pressure = disc(16)
    assert not tangential_stiffness(0 * pressure, grid, Body(STEEL)).any()
