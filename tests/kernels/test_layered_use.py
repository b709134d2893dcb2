"""Coated bodies through the operator and the subsurface stresses: Hertz pressure, free against periodic, limits."""

import numpy as np
import pytest
from coated_bodies import assert_layers_of_the_same_change_nothing

from bem import Body, Grid, Layer, Material, displacement_operator, subsurface_stress
from bem.kernels.layered import frequency_response, hankel, waves
from bem.kernels.loads import Load

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
SOFT = Material("soft", youngs_modulus=10e9, poissons_ratio=0.42)
HARD = Material("hard", youngs_modulus=900e9, poissons_ratio=0.2)


def hertz(grid, peak):
    """p0 sqrt(1 - r^2) over the unit disc, averaged over cells by 8 x 8 points."""
    shift = (np.arange(8) + 0.5) / 8 - 0.5
    x = grid.x[:, None, None, None] + shift[:, None] * grid.spacing[0]
    y = grid.y[None, :, None, None] + shift * grid.spacing[1]
    return peak * np.sqrt(np.maximum(0, 1 - x**2 - y**2)).mean(axis=(2, 3))


def spectrum_of_hertz(q):
    """2 pi (sin q - q cos q) / q^3, for unit peak and radius."""
    return np.where(q < 1e-2, 2 * np.pi / 3 * (1 - q**2 / 10), 2 * np.pi * (np.sin(q) - q * np.cos(q)) / q**3)


def quadrature(decay):
    graded = hankel.graded(1e-4, min(1.0, 1 / decay))
    return hankel.gauss_rule(np.union1d(graded, np.linspace(0, 40 / decay, 40 + int(20 / decay))))


@pytest.mark.internal
@pytest.mark.parametrize(
    ("coating", "thickness"),
    [(SOFT, 0.7), (HARD, 0.1), *(pytest.param(*v, marks=pytest.mark.slow) for v in ((SOFT, 0.1), (HARD, 0.7)))],
)
def test_hertz_pressure_on_a_coated_body(coating, thickness):
    """The axis against Hankel integrals of the response; the error falls with the cell as for a root at the edge."""
    body = Body(STEEL, layer=Layer(coating, thickness))
    q, weights = quadrature(2 * thickness)
    added = frequency_response.surface_response(q, 0 * q, body, Load.NORMAL, remainder=True)
    centre = np.pi / (2 * coating.plane_strain_modulus) + np.sum(added * spectrum_of_hertz(q) * q * weights) / (
        2 * np.pi
    )
    depths = np.array([0.5, 1.5]) * thickness
    stress = []
    for depth in depths:
        q, weights = quadrature(depth)
        f = frequency_response.wave_frame_response(q, body, depth)
        lateral = 0.5 * (f[waves.NORMAL_EE] + f[waves.NORMAL_TT])
        measure = spectrum_of_hertz(q) * q * weights / (2 * np.pi)
        stress.append([lateral @ measure, f[waves.NORMAL_SIGMA] @ measure])
    errors = []
    for cells in (17, 51):
        grid = Grid((cells, cells), (2.5 / cells, 2.5 / cells))
        pressure = hertz(grid, 1.0)
        middle = cells // 2
        displacement = displacement_operator(grid, body)(pressure)[middle, middle]
        s = subsurface_stress(pressure, grid, body, depths)[:, :, middle, middle]
        assert s[3:] == pytest.approx(0, abs=1e-12)  # by symmetry, round-off of the transforms
        errors.append([abs(displacement / centre - 1), np.abs(s[[0, 2]].T - stress).max(), np.abs(s[1].T - s[0]).max()])
    assert errors[1][0] < 2e-3
    assert errors[1][1] < 1e-2  # of the peak pressure; cells of 0.05 against depths of 0.05
    assert errors[1][0] < errors[0][0] / 3  # at least first order over a factor of three
    assert errors[1][1] < errors[0][1] / 3
    assert errors[1][2] < 1e-12  # xx = yy on the axis


@pytest.mark.parametrize("periodic", [(True, True), (False, True), pytest.param((True, False), marks=pytest.mark.slow)])
def test_a_large_cell_tends_to_the_free_grid(periodic):
    """A ring of pressure and suction without net load: the images' field falls off with the cell."""
    body = Body(STEEL, layer=Layer(SOFT, 2.0))
    depths = [1.0, 3.0]
    gaps = []
    for cells in (36, 72):
        results = []
        for axes in ((False, False), periodic):
            grid = Grid((cells, cells), (1.0, 1.0), periodic=axes)
            r2 = grid.x[:, None] ** 2 + grid.y**2
            pressure = (1 - r2 / 32) * np.exp(-r2 / 32)
            displacement = displacement_operator(grid, body, friction=0.3)(pressure) * STEEL.youngs_modulus
            stress = subsurface_stress(pressure, grid, body, depths, friction=0.3)
            inner = slice(cells // 2 - 8, cells // 2 + 8)
            results.append((displacement[inner, inner], stress[..., inner, inner]))
        (u0, s0), (u1, s1) = results
        gaps.append((np.abs(u0 - u1).max() / np.abs(u0).max(), np.abs(s0 - s1).max()))
    # doubly periodic grids sample (trigonometric interpolation), free ones have constant cells: (1/4)^2/24 here
    floor = 6e-3 if all(periodic) else 0.0
    assert gaps[1][0] < gaps[0][0] / 3 + floor
    assert gaps[1][1] < gaps[0][1] / 3 + floor
    assert gaps[1][0] < 2e-2
    assert gaps[1][1] < 1e-2


@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, True)])
@pytest.mark.parametrize("thickness", [1e-7, 1e6])
def test_limits_of_the_thickness(periodic, thickness):
    """Nothing is left of a layer of 1e-7 cells; nothing but the layer of one of 1e5 domains."""
    grid = Grid((12, 10), (1.0, 1.0), periodic=periodic)
    pressure = np.zeros(grid.shape)
    pressure[3:7, 2:6] = 1e6
    for coating in (SOFT, HARD):
        body = Body(STEEL, layer=Layer(coating, thickness))
        bare = Body(STEEL if thickness < 1 else coating)
        u = displacement_operator(grid, body, friction=0.2)(pressure)
        v = displacement_operator(grid, bare, friction=0.2)(pressure)
        assert u == pytest.approx(v, abs=1e-4 * np.abs(v).max())  # 20 h / cell, 5 domains / h
        s = subsurface_stress(pressure, grid, body, [0.5], friction=0.2)
        t = subsurface_stress(pressure, grid, bare, [0.5], friction=0.2)
        assert s == pytest.approx(t, abs=1e-4 * 1e6)


@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, True)])
def test_identical_materials_change_nothing(periodic):
    grid = Grid((16, 12), (0.5, 0.5), periodic=periodic)
    assert_layers_of_the_same_change_nothing(grid, STEEL, (1.3,), [0.2, 1.3, 2.0], seed=3)
