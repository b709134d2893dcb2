"""Half-spaces with surface tension: point force by mpmath, cells by quadrature, images, limits, operators, refusals."""

import math

import mpmath
import numpy as np
import pytest

from bem import Body, Grid, InputError, Material, displacement_operator
from bem.kernels import half_space, semi_periodic, surface_tension
from bem.kernels.loads import Load

PLAIN = Material("gel", youngs_modulus=10e3, poissons_ratio=0.45)


def gel(tension: float) -> Material:
    return Material("gel", youngs_modulus=10e3, poissons_ratio=0.45, surface_tension=tension)


def struve(t: float) -> tuple[float, float]:
    """f, and the integral of t f from 0: pi/2 [H0 - Y0] and pi/2 t [H1 - Y1] - 1."""
    with mpmath.workdps(60):
        at = mpmath.mpf(t)
        value = mpmath.pi / 2 * (mpmath.struveh(0, at) - mpmath.bessely(0, at))
        integral = mpmath.pi / 2 * at * (mpmath.struveh(1, at) - mpmath.bessely(1, at)) - 1
        return float(value), float(integral)


def test_radial_function_and_its_integral_are_those_of_struve_and_neumann() -> None:
    at = np.array([1e-11, 1e-8, 3e-4, 0.02, 0.9, 1.0, 2.1, 7.7, 31.0, 63.9, 64.1, 90.0])
    exact = np.array([struve(t) for t in at])
    radial = surface_tension.radial_function()
    np.testing.assert_allclose(radial.value(at), exact[:, 0], rtol=1e-13)
    np.testing.assert_allclose(radial.integral(at), exact[:, 1], rtol=1e-13)
    far = np.array([1e3, 1e7])
    np.testing.assert_allclose(radial.excess(far), -1 / far**3 + 9 / far**5 - 225 / far**7, rtol=1e-13)
    np.testing.assert_allclose(radial.excess(at[:-2]), exact[:-2, 0] - 1 / at[:-2], rtol=1e-9, atol=1e-14)


def test_point_force_is_the_transform_of_the_symbol() -> None:
    """f = integral of J0(q t) / (1 + q) over q, by mpmath's quadrature over an oscillating tail."""
    with mpmath.workdps(12):
        exact = mpmath.quadosc(lambda q: mpmath.besselj(0, 1.5 * q) / (1 + q), [0, mpmath.inf], omega=1.5)
    assert surface_tension.radial_function().value(np.array([1.5]))[0] == pytest.approx(float(exact), rel=1e-10)


@pytest.mark.parametrize("tension", [3e-5, 0.03, 30.0])
@pytest.mark.parametrize("sides", [(1e-6, 1e-6), (1e-6, 1.7e-6), (6e-6, 1e-6)])
def test_cell_coefficients_match_quadrature(tension: float, sides: tuple[float, float]) -> None:
    material = gel(tension)
    table = surface_tension.surface_table(Grid((20, 12), sides), material)
    length, radial = material.elastocapillary_length, surface_tension.radial_function()
    nodes, weights = np.polynomial.legendre.leggauss(80)
    scale = 1 / (math.pi * material.plane_strain_modulus * length)
    for i, j in ((1, 0), (0, 2), (2, 1), (19, 11)):
        x, y = np.meshgrid(i * sides[0] - 0.5 * sides[0] * nodes, j * sides[1] - 0.5 * sides[1] * nodes, indexing="ij")
        found = np.outer(weights, weights) * radial.value(np.hypot(x, y) / length)
        exact = scale * 0.25 * sides[0] * sides[1] * found.sum()
        assert table[i, j] == pytest.approx(exact, rel=1e-8 if (i, j) == (1, 0) else 1e-12, abs=0)
    # the loaded cell itself, by a rule in polar coordinates on a triangle of half a quarter
    exact = 0.0
    for near, far in ((0.5 * sides[0], 0.5 * sides[1]), (0.5 * sides[1], 0.5 * sides[0])):
        last = math.atan2(far, near)
        for node, weight in zip(nodes, weights, strict=True):
            edge = near / math.cos(0.5 * last * (1 + node))
            # the radial integral with r = edge u^3, which takes the logarithm away
            u = 0.5 * (1 + nodes)
            r = edge * u**3
            inner = np.sum(0.5 * weights * radial.value(r / length) * r * 3 * edge * u**2)
            exact += 4 * 0.5 * last * weight * inner
    assert table[0, 0] == pytest.approx(scale * exact, rel=1e-11, abs=0)


def test_no_tension_is_boussinesq_and_its_effect_is_of_first_order() -> None:
    grid = Grid((12, 9), (1e-6, 1e-6))
    plain = half_space.surface_table(grid.shape, grid.spacing, PLAIN, Load.NORMAL)
    off = [np.abs(surface_tension.surface_table(grid, gel(t)) - plain).max() / plain.max() for t in (1e-9, 1e-8)]
    assert off[0] < 1e-6
    assert off[1] / off[0] == pytest.approx(10, rel=0.02)


def test_images_along_a_periodic_axis_are_summed() -> None:
    """Sums over cells of a period are those of a strip, and the table is that of many images."""
    for tension in (3e-4, 30.0):
        material = gel(tension)
        strip = surface_tension.surface_table(Grid((6, 1), (1e-6, 4e-6), periodic=(False, True)), material)
        cells = surface_tension.surface_table(Grid((6, 4), (1e-6, 1e-6), periodic=(False, True)), material)
        np.testing.assert_allclose(cells.sum(axis=1), strip[:, 0], rtol=0, atol=1e-11 * np.abs(strip).max())
        turned = surface_tension.surface_table(Grid((4, 6), (1e-6, 1e-6), periodic=(True, False)), material)
        np.testing.assert_array_equal(turned, cells.T)
    plain = semi_periodic.surface_table(Grid((6, 8), (1e-6, 1e-6), periodic=(False, True)), PLAIN, Load.NORMAL)
    excess = surface_tension.TenseExcess(gel(3e-4).elastocapillary_length / 1e-6)
    x, y = np.arange(6.0), np.arange(8.0)
    sums, total = {}, np.zeros((6, 8))
    for k in range(122):
        for side in (1, -1) if k else (1,):
            total += surface_tension.cell_table(x, y + side * 8.0 * k, (1.0, 1.0), excess)
        if k in (13, 40, 121):
            sums[k] = total.copy()
    once = [(9 * sums[b] - sums[a]) / 8 for a, b in ((13, 40), (40, 121))]
    exact = plain + 1e-6 / (math.pi * PLAIN.plane_strain_modulus) * (81 * once[1] - once[0]) / 80
    found = surface_tension.surface_table(Grid((6, 8), (1e-6, 1e-6), periodic=(False, True)), gel(3e-4))
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-11 * np.abs(found).max())


def test_a_wave_of_pressure_gives_the_symbol() -> None:
    material = gel(0.05)
    grid = Grid((24, 16), (1e-6, 1e-6), periodic=(True, True))
    wave = np.cos(2 * np.pi * 3 * np.arange(24) / 24)[:, None] * np.ones(16)
    q = 2 * np.pi * 3 / 24e-6
    operator = displacement_operator(grid, Body(material))
    exact = wave / (0.5 * material.plane_strain_modulus * q + 0.05 * q * q)
    np.testing.assert_allclose(operator(wave), exact, rtol=0, atol=1e-12 * np.abs(exact).max())
    assert operator.modulus_at(q) == pytest.approx(material.plane_strain_modulus + 2 * 0.05 * q, rel=1e-12)


def test_operator_adds_both_bodies() -> None:
    grid = Grid((14, 12), (1e-6, 1e-6))
    pressure = np.random.default_rng(1).uniform(0, 1e3, grid.shape)
    single = [displacement_operator(grid, Body(one))(pressure) for one in (gel(0.02), gel(0.05), PLAIN)]
    for pair, exact in (((0.02, 0.05), single[0] + single[1]), ((0.02, None), single[0] + single[2])):
        bodies = tuple(Body(PLAIN if tension is None else gel(tension)) for tension in pair)
        found = displacement_operator(grid, bodies)(pressure)
        np.testing.assert_allclose(found, exact, rtol=1e-12, atol=1e-13 * exact.max())


def test_a_tension_that_is_none_is_refused() -> None:
    with pytest.raises(InputError, match=r"surface_tension 0\.0 must be positive"):
        gel(0.0)
