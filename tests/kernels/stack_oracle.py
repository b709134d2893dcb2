"""A many-digit solution of the equations of elasticity for stacks of layers, and the package's answer to the same."""

import itertools

import mpmath as mp
import numpy as np
import pytest

from bem.kernels.layered import frequency_response, waves
from bem.kernels.loads import Load


def elasticity(body, kx, ky, depth, traction):
    """(ux, uy, uz) and (xx, yy, zz, yz, xz, xy) at `depth` under the traction (x, y, z) exp(i k.x) on z = 0.

    Hooke's law and equilibrium as y' = A y for y = (u, sigma.z), its matrix exponential, and the decaying invariant
    subspace of the substrate, in as many digits as the exponentials eat. Shares nothing with the package.
    """
    i = mp.mpc(0, 1)

    def lame(solid):
        e, nu = mp.mpf(solid.youngs_modulus), mp.mpf(solid.poissons_ratio)
        return e / (2 * (1 + nu)), e * nu / ((1 + nu) * (1 - 2 * nu))

    def strains_to_stress(solid):
        """Rows xx, yy, xy of the stress in terms of y."""
        mu, la = lame(solid)
        stretch = mp.matrix([[-la * i * kx / (la + 2 * mu), -la * i * ky / (la + 2 * mu), 0, 0, 0, 1 / (la + 2 * mu)]])
        divergence = mp.matrix([[i * kx, i * ky, 0, 0, 0, 0]]) + stretch
        xx = la * divergence + 2 * mu * mp.matrix([[i * kx, 0, 0, 0, 0, 0]])
        yy = la * divergence + 2 * mu * mp.matrix([[0, i * ky, 0, 0, 0, 0]])
        xy = mu * mp.matrix([[i * ky, i * kx, 0, 0, 0, 0]])
        return stretch, xx, yy, xy

    def system(solid):
        mu, _ = lame(solid)
        stretch, xx, yy, xy = strains_to_stress(solid)
        rows = [
            mp.matrix([[0, 0, -i * kx, 1 / mu, 0, 0]]),
            mp.matrix([[0, 0, -i * ky, 0, 1 / mu, 0]]),
            stretch,
            -(i * kx * xx + i * ky * xy),
            -(i * kx * xy + i * ky * yy),
            mp.matrix([[0, 0, 0, -i * kx, -i * ky, 0]]),
        ]
        a = mp.matrix(6, 6)
        for r, row in enumerate(rows):
            for c in range(6):
                a[r, c] = row[c]
        return a

    kx, ky, depth = mp.mpf(kx), mp.mpf(ky), mp.mpf(depth)
    q = mp.sqrt(kx**2 + ky**2)
    below = system(body.material)
    mix = mp.matrix([[1, 2, -1], [3, 1, 2], [-2, 1, 1], [1, -1, 3], [2, 2, 1], [-1, 3, 2]])
    # the basis of what decays, carried up; `at` keeps it where it is wanted
    basis = (below - q * mp.eye(6)) ** 3 * mix
    interfaces = [mp.mpf(z) for z in itertools.accumulate((layer.thickness for layer in body.layers), initial=0.0)]
    at, solid = None, body.material
    if depth > interfaces[-1] or not body.layers:
        at = mp.expm(below * (depth - interfaces[-1])) * basis
    for layer, top, bottom in reversed(list(zip(body.layers, interfaces, interfaces[1:], strict=False))):
        inside = system(layer.material)
        if at is None and (depth > top or top == 0):
            at, solid = mp.expm(inside * (depth - bottom)) * basis, layer.material
        basis = mp.expm(-inside * (bottom - top)) * basis
    weights = mp.lu_solve(basis[3:6, 0:3], -mp.matrix(traction))  # the outward normal is -z
    y = at * weights
    _, xx, yy, xy = strains_to_stress(solid)
    stress = [(xx * y)[0], (yy * y)[0], y[5], y[4], y[3], (xy * y)[0]]
    return np.array([complex(y[n]) for n in range(3)]), np.array([complex(s) for s in stress])


def package(body, kx, ky, depth, tangential):
    """The same from the package: complex displacement (3,) and stress (6,)."""
    q = np.hypot(kx, ky)
    cosine, sine = kx / q, ky / q
    f = frequency_response.wave_frame_response(np.array([q]), body, depth)[:, 0]
    scale = 2 * body.surface_material.shear_modulus * q
    stress = frequency_response.stress_response(
        [kx], [ky], body, depth, Load.TANGENTIAL if tangential else Load.NORMAL
    )[:, 0].astype(complex)
    if tangential:
        along = 1j * cosine * 1j * f[waves.TANGENTIAL_U]
        across = -sine * f[waves.ACROSS_U]
        normal = 1j * cosine * f[waves.TANGENTIAL_W]
        stress[[0, 1, 2, 5]] *= 1j
    else:
        along, across, normal = 1j * f[waves.NORMAL_U], 0.0, f[waves.NORMAL_W]
        stress[[3, 4]] *= 1j
    return np.array([cosine * along - sine * across, sine * along + cosine * across, normal]) / scale, stress


def disagreement(body, kx, ky, depth, tangential):
    """Largest error of the displacement and of the stress, each over its own largest component."""
    reach = max(depth, sum(layer.thickness for layer in body.layers))
    with mp.workdps(60 + int(3 * np.hypot(kx, ky) * reach)):
        displacement, stress = elasticity(body, kx, ky, depth, (1, 0, 0) if tangential else (0, 0, 1))
    mine, mine_stress = package(body, kx, ky, depth, tangential)
    return max(
        np.abs(mine - displacement).max() / np.abs(displacement).max(),
        np.abs(mine_stress - stress).max() / np.abs(stress).max(),
    )


def assert_finite_and_balanced(q, body, depth, jump):
    """Of waves (1,): no overflow; the surface carries the load; displacements and tractions pass every interface, to
    that part of the largest on the surface."""
    assert np.isfinite(frequency_response.wave_frame_response(q, body, depth)).all()
    surface = frequency_response.wave_frame_response(q, body, 0.0)[:, 0]
    loads = surface[[waves.NORMAL_TAU, waves.NORMAL_SIGMA, waves.TANGENTIAL_TAU, waves.TANGENTIAL_SIGMA, 14]]
    # a thin stiff layer carries up to 1e6 times the load: 1e-15 of that
    assert loads == pytest.approx([0, -1, 1, 0, -1], abs=1e-9)
    keep = [0, 1, 2, 3, 6, 7, 8, 9, 12, 14]
    for interface in body.interfaces:
        above = frequency_response.wave_frame_response(q, body, interface)[:, 0]
        below = frequency_response.wave_frame_response(q, body, float(np.nextafter(interface, np.inf)))[:, 0]
        assert above[keep] == pytest.approx(below[keep], rel=1e-8, abs=jump * np.abs(surface).max())


def off_the_mean_of_a_circle(body, depth, centre, radius):
    """By how much waves of a wavenumber are not the mean of those on a circle around it, over the largest of them."""
    circle = radius * np.exp(2j * np.pi * np.arange(64) / 64)
    here = frequency_response.wave_frame_response(np.array([centre]), body, depth)[:, 0]
    return (
        np.abs(frequency_response.wave_frame_response(centre + circle, body, depth).mean(axis=1) - here).max()
        / np.abs(here).max()
    )
