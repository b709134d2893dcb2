"""Kernels at the edges of distance, depth, aspect, Poisson's ratio, layers and units: against independent limits."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem import Body, Grid, Layer, Material, displacement_operator, subsurface_stress
from bem.kernels.coefficients import Load, stress_coefficients, surface_coefficients
from bem.kernels.layered.frequency_response import stress_response, surface_response

FREE, SEMI = (False, False), (False, True)


def body(nu=0.3, modulus=1.0, layer=None):
    return Body(Material("body", youngs_modulus=modulus, poissons_ratio=nu), layer=layer)


@pytest.mark.internal
@pytest.mark.parametrize("distance", [10, 100, 1000, 8000])
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.4999, 0.5 - 1e-15])
def test_far_cells_are_point_forces(distance, nu):
    grid = Grid((distance + 1, 2), (1.0, 1.0))
    normal = surface_coefficients(grid, body(nu), Load.NORMAL)[distance, 0]
    # the next term of the square cell's expansion is 1/24 (a/r)^2; then round-off of the corners, eps (r/a)^2
    allowed = 0.1 / distance**2 + 1e-15 * distance**2
    assert normal * math.pi * distance / (1 - nu**2) == pytest.approx(1, rel=allowed)


@pytest.mark.internal
@pytest.mark.parametrize("aspect", [1e-6, 1e-3, 1e3, 1e6])
@pytest.mark.parametrize("load", list(Load))
def test_thin_cells_are_finite_and_turn_with_the_axes(aspect, load):
    here = surface_coefficients(Grid((8, 8), (1.0, aspect)), body(), load)
    assert np.isfinite(here).all()
    if load is Load.NORMAL:
        turned = surface_coefficients(Grid((8, 8), (aspect, 1.0)), body(), load)
        assert np.abs(here - turned.T).max() <= 1e-13 * here.max()
        assert (here > 0).all()


@pytest.mark.internal
@pytest.mark.parametrize("depth", [0.0, 1e-300, 1e-12, 1e-6, 1e-3, 1.0, 1e3, 1e6])
@pytest.mark.parametrize("nu", [0.0, 0.3, 0.5 - 1e-15])
def test_stress_at_any_depth_balances_and_stays_below_the_load(depth, nu):
    for load in Load:
        found = stress_coefficients(Grid((12, 12), (1.0, 1.0)), body(nu), depth, load)
        assert np.isfinite(found).all()
    normal = stress_coefficients(Grid((12, 12), (1.0, 1.0)), body(nu), depth, Load.NORMAL)
    assert normal[2].min() >= -1 - 1e-12  # zz never exceeds the pressure
    if depth >= 1e3:
        # point force at depth z: zz = -3 F / 2 pi z^2; the cells cover a patch far smaller than the depth
        assert normal[2, 0, 0] * 2 * math.pi * depth**2 / 3 == pytest.approx(-1, rel=1e-5)


@pytest.mark.internal
@pytest.mark.parametrize("nu", [0.5 - 1e-3, 0.5 - 1e-9, 0.5 - 1e-15])
def test_incompressible_limit_is_smooth_and_uncoupled(nu):
    grid = Grid((16, 16), (1.0, 1.0))
    limit = surface_coefficients(grid, body(0.0), Load.NORMAL) * 0.75  # (1 - nu^2)/E
    near = surface_coefficients(grid, body(nu), Load.NORMAL)
    assert np.abs(near - limit).max() <= 2 * (0.5 - nu) * limit.max() + 1e-14
    tangential = surface_coefficients(grid, body(nu), Load.TANGENTIAL)
    assert np.abs(tangential).max() <= 2 * (0.5 - nu) * limit.max() + 1e-16


@pytest.mark.internal
@pytest.mark.parametrize("ratio", [1e-6, 1e-4, 1e-2, 1e2, 1e4, 1e6])
@pytest.mark.parametrize("thickness", [1e-6, 1e-3, 1.0, 1e3, 1e6])
def test_layers_of_any_stiffness_and_thickness_lie_between_base_and_layer(ratio, thickness):
    """Energy: a body stiffer everywhere gives less, so the response of each wave lies between the two half-spaces."""
    film = Layer(Material("film", youngs_modulus=ratio, poissons_ratio=0.3), thickness)
    kx, ky = np.array([1e-6, 1e-3, 0.1, 1.0, 10.0, 1e3]), np.zeros(6)
    q_times = surface_response(kx, ky, body(layer=film), Load.NORMAL) * kx
    base, coat = 2 * 0.91, 2 * 0.91 / ratio
    assert np.isfinite(q_times).all()
    assert (q_times >= min(base, coat) * (1 - 1e-9)).all()
    assert (q_times <= max(base, coat) * (1 + 1e-9)).all()
    for load in Load:
        assert np.isfinite(surface_response(kx, ky, body(layer=film), load)).all()
        assert np.isfinite(stress_response(kx, ky, body(layer=film), 0.5 * thickness, load)).all()


@pytest.mark.internal
@pytest.mark.parametrize("periodic", [FREE, SEMI])
@pytest.mark.parametrize("ratio", [1e-6, 1e-2, 1e2, 1e6])
@pytest.mark.parametrize("thickness", [1e-6, 1.0, 1e4])
def test_layered_coefficients_are_finite_positive_and_bounded(periodic, ratio, thickness):
    grid = Grid((12, 12), (1.0, 1.0), periodic=periodic)
    film = Layer(Material("film", youngs_modulus=ratio, poissons_ratio=0.3), thickness)
    found = surface_coefficients(grid, body(layer=film), Load.NORMAL)
    assert np.isfinite(found).all()
    if periodic == FREE:
        base = surface_coefficients(grid, body(), Load.NORMAL)[0, 0]
        coat = surface_coefficients(grid, body(modulus=ratio), Load.NORMAL)[0, 0]
        # the displacement under a load is its energy: monotone in either modulus
        assert min(base, coat) * (1 - 1e-7) <= found[0, 0] <= max(base, coat) * (1 + 1e-7)
    if thickness == 1e-6 and 1e-2 <= ratio <= 1e2:
        bare = surface_coefficients(grid, body(), Load.NORMAL)
        assert np.abs(found - bare).max() <= 1e-3 * bare.max()


@pytest.mark.parametrize("size", [1e-300, 1e-30, 1e-9, 1e9, 1e30])
@pytest.mark.parametrize("periodic", [FREE, SEMI, (True, True)])
def test_units_change_nothing(size, periodic):
    n = 12
    pressure = np.random.default_rng(1).random((n, n))
    reference = displacement_operator(Grid((n, n), (1.0, 1.0), periodic=periodic), body())(pressure)
    scaled = displacement_operator(Grid((n, n), (size, size), periodic=periodic), body())(pressure)
    assert np.abs(scaled / size - reference).max() <= 1e-12 * np.abs(reference).max()
    if size >= 1e-30:  # depth and cell squared leave the range of numbers below
        one = subsurface_stress(pressure, Grid((n, n), (1.0, 1.0), periodic=periodic), body(), [0.7], friction=0.3)
        other = subsurface_stress(
            pressure, Grid((n, n), (size, size), periodic=periodic), body(), [0.7 * size], friction=0.3
        )
        assert np.abs(one - other).max() <= 1e-12 * np.abs(one).max()


@pytest.mark.parametrize("scale", [5e-324, 1e-310, 1e-200, 1e200])
def test_denormal_and_huge_pressures_stay_linear_or_vanish(scale):
    grid = Grid((8, 8), (1.0, 1.0))
    operator = displacement_operator(grid, body())
    pressure = np.zeros(grid.shape)
    pressure[3, 4] = scale
    found = operator(pressure)
    assert np.isfinite(found).all()
    if scale in (1e-200, 1e200):
        pressure[3, 4] = 1.0
        assert np.abs(found / scale - operator(pressure)).max() <= 1e-13


@settings(max_examples=25, deadline=None)
@given(
    nx=st.sampled_from([1, 2, 3, 5, 7, 11, 13, 17, 31]),
    ny=st.sampled_from([1, 2, 3, 5, 7, 11, 13, 17, 31]),
    periodic=st.tuples(st.booleans(), st.booleans()),
    nu=st.floats(0.0, 0.5, exclude_max=True),
    aspect=st.floats(0.1, 10.0),
    seed=st.integers(0, 99),
)
def test_reciprocity_on_prime_grids(nx, ny, periodic, nu, aspect, seed):
    """Work of one load through the displacement of another is that of the other through the first."""
    rng = np.random.default_rng(seed)
    operator = displacement_operator(Grid((nx, ny), (1.0, aspect), periodic=periodic), body(nu))
    a, b = rng.random((nx, ny)), rng.random((nx, ny))
    one, other = (a * operator(b)).sum(), (b * operator(a)).sum()
    size = np.abs(a * operator(b)).sum() + np.abs(b * operator(a)).sum()
    assert abs(one - other) <= 1e-13 * size + 1e-300
