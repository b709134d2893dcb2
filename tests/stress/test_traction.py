"""Stresses under tractions of their own: against those of friction x pressure, exchanged axes and Cattaneo's ball."""

import numpy as np
import pytest

from bem import Body, Grid, InputError, Layer, Material, subsurface_stress
from bem.reference_solutions.hamilton import sphere_stress
from bem.stress import summarise_stress, von_mises, von_mises_field
from bem.verification.patches import disc_means, free_grid

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3, yield_stress=1e9)
COATED = Body(STEEL, layers=[Layer(Material("film", youngs_modulus=50e9, poissons_ratio=0.2), 1.5e-6)])
DEPTHS = [0.0, 0.7e-6, 2e-6]


def close(found, expected):
    # sums of transforms in another order: round-off of the largest
    assert np.abs(found - expected).max() <= 1e-8 * np.abs(expected).max()


@pytest.mark.parametrize("periodic", [(False, False), (True, True), (True, False), (False, True)])
@pytest.mark.parametrize("body", [Body(STEEL), COATED], ids=["bare", "coated"])
def test_along_x_it_is_friction_and_along_y_the_same_with_axes_exchanged(periodic, body):
    grid = Grid((12, 10), (1e-6, 0.8e-6), periodic=periodic)
    rng = np.random.default_rng(5)
    pressure, other = rng.random((2, *grid.shape)) * 1e9
    nothing = np.zeros(grid.shape)
    sliding = subsurface_stress(pressure, grid, body, DEPTHS, friction=0.3)
    close(subsurface_stress(pressure, grid, body, DEPTHS, traction=[0.3 * pressure, nothing]), sliding)
    turned = Grid(grid.shape[::-1], grid.spacing[::-1], periodic=periodic[::-1])
    along_y = subsurface_stress(pressure.T.copy(), turned, body, DEPTHS, friction=0.3)
    expected = along_y[[1, 0, 2, 4, 3, 5]].swapaxes(2, 3)
    close(subsurface_stress(pressure, grid, body, DEPTHS, traction=[nothing, 0.3 * pressure]), expected)
    both = subsurface_stress(pressure, grid, body, DEPTHS, traction=[0.3 * other, -0.2 * pressure])
    parts = [subsurface_stress(nothing, grid, body, DEPTHS, traction=t)
             for t in ([0.3 * other, nothing], [nothing, -0.2 * pressure])]  # fmt: skip
    close(both, subsurface_stress(pressure, grid, body, DEPTHS) + parts[0] + parts[1])
    close(von_mises_field(pressure, grid, body, DEPTHS, traction=[0.3 * other, -0.2 * pressure]), von_mises(both))


@pytest.mark.internal
def test_a_traction_on_a_large_grid_is_friction():
    grid = Grid((300, 260), (1e-6, 1e-6))
    pressure = np.random.default_rng(6).random(grid.shape)
    found = von_mises_field(pressure, grid, Body(STEEL), [2e-6], traction=[0.3 * pressure, 0 * pressure])
    close(found, von_mises_field(pressure, grid, Body(STEEL), [2e-6], friction=0.3))


def test_below_cattaneo_s_ball():
    """Traction f p of the whole contact less that of the circle that sticks: Hamilton's stresses of two balls."""
    friction, stick, step = 0.4, 0.6, 1 / 40
    where = free_grid(step, (-1.2, 1.2), (-1.0, 1.0))
    pressure = disc_means(where, "hertz")
    traction = friction * (pressure - stick * disc_means(where, "hertz", stick))
    depths = np.array([0.2, 0.45, 0.8])
    x, y = np.array([0.0, 0.5, -1.0, 0.8]), np.array([0.0, 0.25, 0.5, -0.6])
    body = Body(Material("unit", youngs_modulus=1.0, poissons_ratio=0.3, yield_stress=0.5))
    found = summarise_stress(
        pressure, where.grid, body, depths, traction=np.stack([traction, 0 * traction]), components=True
    )
    i, j = where.at(x, y)
    ball = {"poissons_ratio": 0.3, "maximum_pressure": 1.0}
    small = {"poissons_ratio": 0.3, "maximum_pressure": stick, "contact_radius": stick}
    for k, z in enumerate(depths):
        exact = sphere_stress(x, y, z, contact_radius=1.0, friction=friction, **ball)
        exact = exact - sphere_stress(x, y, z, friction=friction, **small) + sphere_stress(x, y, z, **small)
        # as Hamilton's own gate with cells of 1/40: 2e-3 of the largest pressure
        assert np.abs(found.stress[:, k, i, j] - exact).max() < 2e-3


def test_messages():
    grid = Grid((4, 4), (1.0, 1.0))
    with pytest.raises(InputError, match="one of them"):
        subsurface_stress(np.ones((4, 4)), grid, Body(STEEL), [1.0], friction=0.1, traction=np.ones((2, 4, 4)))
    with pytest.raises(InputError, match=r"traction .* of shape \(2, 4, 4\)"):
        subsurface_stress(np.ones((4, 4)), grid, Body(STEEL), [1.0], traction=np.ones((4, 4)))
