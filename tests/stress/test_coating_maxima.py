"""Highest stresses at the depths of a coating: at the edge of the contact, beyond the grid, and without waves."""

import numpy as np
import pytest

from bem import Body, Grid, Layer, Material, displacement_operator, solve_contact, subsurface_stress
from bem.stress import coating_maxima, depth_maxima, edge_tension, highest_principal, von_mises

STEEL = Material("steel", youngs_modulus=200e9, poissons_ratio=0.3)


def coated(modulus, *thicknesses):
    layers = (Layer(Material("coat", youngs_modulus=modulus, poissons_ratio=0.25), one) for one in thicknesses)
    return Body(STEEL, layers=tuple(layers))


def maxima_of(pressure, grid, body, depths, friction=0.0):
    depths = np.array(depths)
    stress = subsurface_stress(pressure, grid, body, depths, friction=friction)
    return stress, coating_maxima(stress, von_mises(stress), depths, pressure, grid, body, friction)


def ball(grid, radius=6.0):
    """Pressure [Pa] of a ball in contact over that many cells."""
    gap = 5e-4 * (grid.x[:, None] ** 2 + grid.y**2)
    load = 4 / 3 * STEEL.plane_strain_modulus * 1e-3 * radius**3
    return solve_contact(gap, displacement_operator(grid, Body(STEEL)), load=load).pressure


def test_the_edge_counts_at_the_surface_and_at_no_other_depth():
    grid, body, depths = Grid((20, 20), (1.0, 1.0)), coated(60e9, 1.5), [0.0, 0.5, 1.5, 1.6]
    pressure = ball(grid)
    stress, found = maxima_of(pressure, grid, body, depths, 0.2)
    points = depth_maxima(stress, von_mises(stress), np.array(depths), body)
    edge = edge_tension(stress[:, 0], pressure, grid, body, 0.2)
    assert found.edge == edge
    assert edge.tension > 1.1 * points.principal[0]
    assert 0 < edge.pressure < pressure.max()
    assert found.highest.principal.tolist() == [edge.tension, *points.principal[1:]]
    assert found.of_points.principal.tolist() == points.principal.tolist()
    _, below = maxima_of(pressure, grid, body, depths[1:], 0.2)
    assert below.highest.principal.tolist() == points.principal[1:].tolist()
    assert below.edge.tension == -np.inf


@pytest.mark.parametrize("periodic", [(False, False), (False, True)])
def test_tension_of_a_layer_beyond_a_grid_is_that_of_a_wider_grid(periodic):
    """The second of two soft layers under a rubbed contact is in tension behind it, outside a grid that fits it."""
    body, friction, depths = coated(60e9, 2.0, 6.0), 0.4, [0.0, 2.0, 2.01, 5.0, 8.0, 8.01]
    grid = Grid((30, 12), (1.0, 2.0), periodic=periodic)
    across = np.inf if periodic[1] else 5.0
    pressure = np.where((np.abs(grid.x[:, None]) < 12) & (np.abs(grid.y) < across), 1e9, 0.0)
    _, found = maxima_of(pressure, grid, body, depths, friction)
    wide = np.pad(pressure, [(0, 0) if one else (3 * n, 3 * n) for one, n in zip(periodic, grid.shape, strict=True)])
    around = Grid(wide.shape, grid.spacing, periodic=periodic)
    exact = highest_principal(subsurface_stress(wide, around, body, depths, friction=friction))[2].max()
    assert found.highest.principal[2] == pytest.approx(exact, rel=0.02)
    assert found.of_points.principal[2] < 0.95 * exact


def test_an_interface_close_to_the_surface_of_a_periodic_grid_has_no_tension_of_waves():
    """Without friction zz beside the contact is of the order of the square of the depth; waves of two cells add some
    per mille of the pressure. Six times the cells a side show what is real."""
    depths = [0.0, 0.4, 0.41]
    real = {}
    for finer in (1, 6):
        grid = Grid((32 * finer, 32 * finer), (1 / finer, 1 / finer), periodic=(True, True))
        stress, found = maxima_of(ball(grid), grid, coated(200e9, 0.4), depths)
        real[finer] = found.highest.tension[1], found.of_points.tension[1], stress[2, 1].min()
    exact, lowest = real[6][0], real[6][2]
    assert exact < 1e-4 * abs(lowest)
    assert real[1][1] > 1e-3 * abs(lowest)
    assert abs(real[1][0] - exact) < 0.2 * abs(real[1][1] - exact)


def test_deep_interfaces_and_grids_with_a_free_axis_keep_the_tension_of_points():
    body, depths = coated(100e9, 0.4, 2.0), [0.0, 0.4, 0.41, 2.4, 2.5]
    for periodic, number in (((True, True), 3), ((True, True), 4), ((False, True), 1)):
        grid = Grid((24, 24), (1.0, 1.0), periodic=periodic)
        pressure = ball(grid)
        stress, found = maxima_of(pressure, grid, body, depths, 0.3)
        points = depth_maxima(stress, von_mises(stress), np.array(depths), body)
        assert found.highest.tension[number] >= points.tension[number]
        assert found.smoothed[number] == points.tension[number]
