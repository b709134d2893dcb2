"""In-plane surface displacements under tractions: quadrature, images, many-digit elasticity, Fourier integrals."""

import mpmath as mp
import numpy as np
import pytest
from coated_bodies import coated
from scipy import integrate
from stack_oracle import elasticity
from test_layered_free import by_fourier
from test_semi_periodic import CASES, geometry, images, limit

from bem import Body, Grid, Layer, Material
from bem.kernels import half_space, spectral
from bem.kernels.coefficients import IN_PLANE_PARITY, in_plane_coefficients
from bem.kernels.layered import frequency_response, semi_periodic
from bem.kernels.layered.cells import in_plane_remainder
from bem.kernels.loads import Load

pytestmark = pytest.mark.internal

NU = 0.3
SOLID = Material("solid", youngs_modulus=2 * (1 + NU), poissons_ratio=NU)
SOFT = Material("soft", youngs_modulus=0.7, poissons_ratio=0.45)
BODY = Body(SOLID)
MIXED = [(False, True), (True, False)]


def cerruti(x, y, a, b):
    """2 pi G times (ux under x, uy under y, uy under x) of |x'| < a, |y'| < b, in polars at its centre."""

    def kernels(cosine, sine):
        return 1 - NU + NU * cosine**2, 1 - NU + NU * sine**2, NU * sine * cosine

    if x == y == 0:
        corner = np.arctan2(b, a)
        pieces = [(0, corner), (corner, np.pi / 2)]

        def around(part):
            def integrand(t):
                return 4 * kernels(np.cos(t), np.sin(t))[part] * min(a / np.cos(t), b / np.sin(t) if t > 0 else np.inf)

            return sum(integrate.quad(integrand, *piece, epsabs=1e-15, epsrel=1e-13)[0] for piece in pieces)

        return np.array([around(0), around(1), 0.0])

    def over(part):
        def integrand(v, u):
            r = np.hypot(u, v)
            return kernels(u / r, v / r)[part] / r

        return integrate.dblquad(integrand, x - a, x + a, y - b, y + b, epsabs=1e-15, epsrel=1e-13)[0]

    return np.array([over(0), over(1), over(2) if x and y else 0.0])


@pytest.mark.parametrize("offset", [(0, 0), (0, 2), (3, 1), (40, 17)])
def test_free_coefficients_are_the_integral_of_cerruti(offset):
    """Both directions, from the loaded cell itself to 40 cells away."""
    grid = Grid((41, 18), (1.0, 1.7))
    table = in_plane_coefficients(grid, BODY)[:, *offset]
    want = cerruti(offset[0] * 1.0, offset[1] * 1.7, 0.5, 0.85) / (2 * np.pi * SOLID.shear_modulus)
    assert np.abs(table - want).max() < 1e-12 * np.abs(want).max()  # what the quadrature promises


@pytest.mark.parametrize("case", CASES[:3] + CASES[6:])
def test_mixed_coefficients_are_the_sum_of_images_with_their_datum(case):
    shape, spacing, periodic = case
    grid = Grid(shape, spacing, periodic=periodic)
    axis, period, reference = geometry(grid)
    area, modulus = grid.cell_area / period, SOLID.shear_modulus

    def partial(count):
        x, y = images(grid, count)
        along = half_space.rectangle_displacement(x, y, 0.0, spacing, SOLID, Load.TANGENTIAL)
        across = half_space.rectangle_displacement(y, x, 0.0, spacing[::-1], SOLID, Load.TANGENTIAL)
        total = np.stack([along[0], across[0], along[1]]).sum(-1)
        # lines of load of this length, from the reference distance; each direction's mean along the period
        length = (2 * count + 1) * period
        free, along_period = 1 - axis, axis
        total[free] -= area / (np.pi * modulus) * ((1 - NU) * np.log(length / reference) + NU)
        total[along_period] -= area / (np.pi * modulus) * (np.log(length / reference) - NU)
        return total

    got = in_plane_coefficients(grid, BODY)
    want = limit(partial, grid)
    scale = np.abs(half_space.rectangle_displacement(0, 0, 0, spacing, SOLID, Load.TANGENTIAL)).max()
    # 1e-10 is asked for; the brute force is good to 1e-12
    assert np.abs(got - want).max() < 1e-11 * scale


@pytest.mark.parametrize(("angle", "thin"), [(0.0, 1e-3), (0.4, 0.3), (np.pi / 2, 0.3), (2.5, 4.0)])
def test_stacks_solve_elasticity(thin, angle):
    """Against the equations of elasticity in many digits, tractions along x and along y, one to three layers."""
    stiff = Material("stiff", youngs_modulus=40.0, poissons_ratio=0.2)
    for layers in ((Layer(stiff, 1.0),), (Layer(SOFT, thin), Layer(stiff, 0.5))):
        body = Body(SOLID, layers=layers)
        kx, ky = 1.5 * np.cos(angle), 1.5 * np.sin(angle)
        got = frequency_response.in_plane_response(kx, ky, body)
        with mp.workdps(50):
            under_x, _ = elasticity(body, kx, ky, 0.0, (1, 0, 0))
            under_y, _ = elasticity(body, kx, ky, 0.0, (0, 1, 0))
        want = np.array([under_x[0].real, under_y[1].real, under_x[1].real])
        assert np.abs(got - want).max() < 1e-12 * np.abs(want).max()
        assert under_y[0].real == pytest.approx(under_x[1].real, abs=1e-14 * np.abs(want).max())  # reciprocity


@pytest.mark.parametrize(("ratio", "nu1", "nu2"), [(8.0, 0.2, 0.3), (0.05, 0.45, 0.1)])
def test_layers_against_the_double_fourier_integral(ratio, nu1, nu2, monkeypatch):
    """Knows no Bessel function, no table and no cell integration."""
    grid = Grid((5, 4), (1.0, 0.7))
    body = coated(ratio, nu1, nu2, 0.8)
    got = in_plane_remainder(grid, body)
    for component in range(3):

        def response(kx, ky, body, load, *, remainder, component=component):
            return frequency_response.in_plane_response(kx, ky, body, remainder=remainder)[component]

        with monkeypatch.context() as patch:
            patch.setattr(frequency_response, "surface_response", response)
            for i, j in [(0, 0), (1, 0), (2, 3), (4, 1)]:
                want = by_fourier(body, None, Load.NORMAL, i * 1.0, j * 0.7, 1.0, 0.7)[0]
                # round-off of 1e5 terms that oscillate, as for the normal displacement
                assert got[component, i, j] == pytest.approx(want, abs=1e-12 * np.abs(got).max())


@pytest.mark.parametrize("periodic", [(False, False), *MIXED])
def test_layers_of_the_base_s_material_change_nothing_and_thick_ones_are_a_half_space(periodic):
    grid = Grid((8, 20), (1.0, 0.5), periodic=periodic)
    bare = in_plane_coefficients(grid, BODY)
    same = in_plane_coefficients(grid, Body(SOLID, layer=Layer(SOLID, 2.0)))
    assert np.abs(same - bare).max() < 1e-14 * np.abs(bare).max()
    # a base at a depth of 1e7 cells moves the surface by cell / depth of a coefficient, on a mixed grid not even that
    thick = in_plane_coefficients(grid, Body(SOFT, layer=Layer(SOLID, 1e9)))
    assert np.abs(thick - bare).max() < 1e-8 * np.abs(bare).max()
    # a thin layer adds its thickness over the cell
    error = [
        np.abs(in_plane_coefficients(grid, Body(SOLID, layer=Layer(SOFT, h))) - bare).max() for h in (1e-6, 1e-7, 1e-8)
    ]
    assert error[2] < 3e-7 * np.abs(bare).max()  # 12 h over the cell with a base three times as stiff
    assert error[0] / error[1] == pytest.approx(10, rel=1e-3)  # first order in h, and no constant left


@pytest.mark.parametrize("periodic", MIXED)
def test_a_whole_period_of_cells_is_plane_or_antiplane_strain(periodic):
    """A layered body's mean along the period depends on the free axis alone, and no mixed component is left."""
    grid = Grid((12, 9), (0.7, 1.1), periodic=periodic)
    along = 0 if periodic[0] else 1
    table = in_plane_coefficients(grid, coated(4.0, 0.25, 0.4, 0.6))
    mirrored = table[2].sum(along)
    assert np.abs(mirrored).max() < 1e-13 * np.abs(table).max()
    one_row = Grid(
        tuple(1 if a == along else n for a, n in enumerate(grid.shape)),
        tuple(grid.lengths[a] if a == along else d for a, d in enumerate(grid.spacing)),
        periodic=periodic,
    )
    whole = in_plane_coefficients(one_row, coated(4.0, 0.25, 0.4, 0.6)).sum(1 + along)
    assert np.abs(table.sum(1 + along) - whole)[:2].max() < 1e-11 * np.abs(whole).max()


@pytest.mark.parametrize("body", [BODY, coated(6.0, 0.2, 0.35, 3.0)], ids=["bare", "coated"])
def test_spectral_responses_have_the_parity_and_the_symmetry_of_the_grid(body):
    grid = Grid((12, 9), (1.0, 1.4), periodic=(True, True))
    turned = Grid((9, 12), (1.4, 1.0), periodic=(True, True))
    kernel = np.fft.irfft2(spectral.in_plane_response(grid, body), grid.shape)
    other = np.fft.irfft2(spectral.in_plane_response(turned, body), turned.shape)
    np.testing.assert_allclose(other.swapaxes(1, 2)[[1, 0, 2]], kernel, rtol=0, atol=1e-14 * np.abs(kernel).max())
    for part, (along_x, along_y) in zip(kernel, IN_PLANE_PARITY, strict=True):
        for axis, sign in ((0, along_x), (1, along_y)):
            mirrored = np.roll(np.flip(part, axis), 1, axis)
            np.testing.assert_allclose(mirrored, sign * part, rtol=0, atol=1e-14 * np.abs(kernel).max())


def test_a_period_grows_into_free_space():
    """Differences of a mixed grid's coefficients come to those of a free grid as the period grows: images are far."""
    free = in_plane_coefficients(Grid((6, 6), (1.0, 1.0)), BODY)
    misses = []
    for cells in (64, 128):
        mixed = in_plane_coefficients(Grid((6, cells), (1.0, 1.0), periodic=(False, True)), BODY)[:, :, :6]
        change = (mixed - mixed[:, :1, :1]) - (free - free[:, :1, :1])
        misses.append(np.abs(change).max() / np.abs(free).max())
    assert misses[1] < 1e-4
    assert misses[0] / misses[1] == pytest.approx(8, rel=0.1)  # images at a distance L: r^2 / L^3


def test_identical_layers_leave_a_mixed_remainder_of_zero():
    grid = Grid((6, 8), (1.0, 1.0), periodic=(False, True))
    assert np.abs(semi_periodic.in_plane_remainder(grid, Body(SOLID, layer=Layer(SOLID, 0.5)))).max() < 1e-16
