"""Doubly periodic closed forms: the equations of elasticity, not another formula, are the judge."""

import numpy as np
import pytest

from bem import Body, Grid, InputError, Material
from bem.kernels.loads import STRESS_PARITY, Load
from bem.kernels.spectral import stress_response, surface_response

pytestmark = pytest.mark.internal

NU = 0.3
SOLID = Material("solid", youngs_modulus=2 * (1 + NU), poissons_ratio=NU)
BODY = Body(SOLID)
GRID = Grid((8, 6), (1.0, 0.7), periodic=(True, True))


def spectra(depth, load, grid=GRID, body=BODY):
    """Complex spectra from the real arrays."""
    values = stress_response(grid, body, depth, load).astype(complex)
    for component, (px, py) in enumerate(STRESS_PARITY[load]):
        if px * py < 0:
            values[component] *= 1j
    return values


@pytest.mark.parametrize("load", Load)
def test_equilibrium_and_compatibility_at_every_wavevector(load):
    kx, ky = (np.broadcast_to(k, (8, 4)) for k in GRID.wavevectors())
    keep = np.ones((8, 4), bool)
    keep[0, 0] = keep[4] = keep[:, 3] = False  # mean and highest wavenumbers: see below
    depth, h = 0.6, 2e-3
    # derivatives along z by differences of sixth order: error h^6 q^7 = 1e-15, round-off 1e-16 / h^2 = 1e-10
    stencil = np.arange(-3, 4)
    s = np.array([spectra(depth + n * h, load) for n in stencil])
    first = np.tensordot(np.array([-1, 9, -45, 0, 45, -9, 1]) / 60 / h, s, 1)
    second = np.tensordot(np.array([2, -27, 270, -490, 270, -27, 2]) / 180 / h**2, s, 1)
    s = s[3]
    xx, yy, zz, yz, xz, xy = range(6)
    for residual in (
        1j * kx * s[xx] + 1j * ky * s[xy] + first[xz],
        1j * kx * s[xy] + 1j * ky * s[yy] + first[yz],
        1j * kx * s[xz] + 1j * ky * s[yz] + first[zz],
    ):
        assert np.abs(residual[keep]).max() < 1e-10
    # Beltrami-Michell: Laplacian of the stress + second derivatives of its trace / (1 + nu) = 0
    trace = s[:3].sum(0)
    d = (1j * kx, 1j * ky)
    trace_z, trace_zz = first[:3].sum(0), second[:3].sum(0)
    hessian = [
        d[0] ** 2 * trace, d[1] ** 2 * trace, trace_zz, d[1] * trace_z, d[0] * trace_z, d[0] * d[1] * trace
    ]  # fmt: skip
    for component in range(6):
        laplacian = second[component] - (kx**2 + ky**2) * s[component]
        assert np.abs((laplacian + hessian[component] / (1 + NU))[keep]).max() < 1e-8  # round-off / h^2


@pytest.mark.parametrize("load", Load)
def test_surface_carries_the_load_and_depth_nothing(load):
    top = spectra(0.0, load)
    want = np.zeros(3)
    want[0 if load is Load.NORMAL else 2] = -1
    for component, value in zip((2, 3, 4), want, strict=True):
        np.testing.assert_allclose(top[component], value, atol=1e-15)
    deep = spectra(1e3, load)
    deep[:, 0, 0] = 0
    assert np.abs(deep).max() == 0.0


def test_mean_mode_is_lateral_constraint():
    normal = stress_response(GRID, BODY, 3.0, Load.NORMAL)[:, 0, 0]
    np.testing.assert_allclose(normal, [-NU / (1 - NU), -NU / (1 - NU), -1, 0, 0, 0], rtol=1e-15)
    np.testing.assert_array_equal(stress_response(GRID, BODY, 3.0, Load.TANGENTIAL)[:, 0, 0], [0, 0, 0, 0, -1, 0])
    for load in Load:
        assert surface_response(GRID, BODY, load)[0, 0] == 0


def test_displacement_belongs_to_the_stress():
    # uz from zz: integrate strain ezz = [zz - nu (xx + yy)] / E from the surface down, by Gauss-Laguerre
    kx, ky = GRID.wavevectors()
    q = np.hypot(kx, ky)
    nodes, weights = np.polynomial.laguerre.laggauss(8)
    for load in Load:
        want = surface_response(GRID, BODY, load)
        for i, j in ((1, 0), (0, 1), (2, 2), (7, 1), (3, 2)):
            total = 0.0
            for node, weight in zip(nodes, weights, strict=True):
                s = stress_response(GRID, BODY, node / q[i, j], load)[:, i, j]
                strain = (s[2] - NU * (s[0] + s[1])) / SOLID.youngs_modulus
                total -= weight * np.exp(node) * strain / q[i, j]
            assert want[i, j] == pytest.approx(total, rel=1e-12)  # polynomials times exp(-q z): exact


def test_highest_wavenumbers_have_no_odd_part():
    for load in Load:
        values = stress_response(GRID, BODY, 0.4, load)
        for component, (px, py) in enumerate(STRESS_PARITY[load]):
            if px < 0:
                np.testing.assert_array_equal(values[component, 4], 0)
            if py < 0:
                np.testing.assert_array_equal(values[component, :, 3], 0)


def test_bad_input_is_refused():
    with pytest.raises(InputError, match="periodic"):
        surface_response(Grid((4, 4), (1, 1)), BODY, Load.NORMAL)
    with pytest.raises(InputError, match="depth"):
        stress_response(GRID, BODY, -1.0, Load.NORMAL)
