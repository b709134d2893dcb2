"""Anisotropic half-spaces against Stroh's eigenvalues, closed forms, the isotropic limit, and direct sums."""

import math
from itertools import pairwise

import mpmath
import numpy as np
import pytest

from bem import Body, Grid, InputError, Material, displacement_operator
from bem.kernels import anisotropic, half_space, semi_periodic, spectral
from bem.kernels.cell_integrals import cell_table
from bem.kernels.loads import Load
from bem.materials import CATALOGUE
from bem.stiffness import Stiffness

STEEL = Material("steel", youngs_modulus=210e9, poissons_ratio=0.3)
COPPER = {"c11": 168.4e9, "c12": 121.4e9, "c44": 75.4e9}
SODIUM = {"c11": 7.4e9, "c12": 6.2e9, "c44": 4.2e9}
"""A very anisotropic crystal: 2 c44 / (c11 - c12) = 7."""
TITANIUM = {"c11": 162.4e9, "c12": 92.0e9, "c13": 69.0e9, "c33": 180.7e9, "c44": 46.7e9}


def isotropic(material: Material) -> Stiffness:
    shear, nu = material.shear_modulus, material.poissons_ratio
    lame = 2 * shear * nu / (1 - 2 * nu)
    return Stiffness("cubic", c11=lame + 2 * shear, c12=lame, c44=shear)


def triclinic() -> Stiffness:
    root = np.random.default_rng(3).normal(size=(6, 6))
    return Stiffness("general", matrix=(root @ root.T + 3 * np.eye(6)).tolist(), normal=(1, 2, 3), along_x=(1, 0, 0))


SKEW = Stiffness("cubic", **SODIUM, normal=(1, 2, 3))
"""A surface that does not respond alike on both sides of the x axis."""


def stroh(stiffness: Stiffness, angle: float, digits: int = 30) -> float:
    """A from the sextic eigenvalue problem of Stroh in extended precision: u = A c, t = -i q B c."""
    unit = float(np.abs(stiffness.tensor).max())  # so that no digits are lost between stiffnesses and compliances
    tensor, m, n = stiffness.tensor / unit, (math.cos(angle), math.sin(angle), 0.0), (0.0, 0.0, 1.0)
    with mpmath.workdps(digits):
        q, r, t = (
            mpmath.matrix(np.einsum("ijkl,j,l->ik", tensor, one, other).tolist())
            for one, other in ((m, m), (m, n), (n, n))
        )
        inverse = t**-1
        top = [-inverse * r.T, inverse]
        bottom = [r * inverse * r.T - q, -r * inverse]
        whole = mpmath.matrix(6, 6)
        for i in range(3):
            for j in range(3):
                for block in (0, 1):
                    whole[i, j + 3 * block] = top[block][i, j]
                    whole[i + 3, j + 3 * block] = bottom[block][i, j]
        values, vectors = mpmath.eig(whole)
        kept = [k for k in range(6) if mpmath.im(values[k]) > 0]
        a = mpmath.matrix([[vectors[i, k] for k in kept] for i in range(3)])
        b = mpmath.matrix([[vectors[i + 3, k] for k in kept] for i in range(3)])
        return float(mpmath.re((a * (-1j * b) ** -1)[2, 2])) / unit


@pytest.mark.parametrize(
    "stiffness",
    [
        Stiffness("cubic", **COPPER),
        Stiffness("cubic", **COPPER, normal=(1, 1, 1), along_x=(1, -1, 0)),
        Stiffness("cubic", **SODIUM, normal=(1, 2, 3)),
        triclinic(),
    ],
)
def test_compliance_of_the_surface_is_that_of_stroh(stiffness: Stiffness) -> None:
    angles = np.array([0.1, 0.7, 2.0])
    exact = [stroh(stiffness, angle) for angle in angles]
    np.testing.assert_allclose(stiffness.surface_compliance(angles), exact, rtol=2e-14)


def test_isotropic_stiffness_gives_the_isotropic_surface() -> None:
    stiffness = isotropic(STEEL).oriented((1, 2, 3), (0, 1, 0))
    angles = np.linspace(0, 3, 7)
    np.testing.assert_allclose(stiffness.surface_compliance(angles), 2 / STEEL.plane_strain_modulus, rtol=1e-14)
    assert stiffness.mirror_symmetric
    assert stiffness.poissons_ratio == pytest.approx(0.3, rel=1e-12)


def test_transversely_isotropic_indentation_modulus_across_the_plane_of_isotropy() -> None:
    """M = 2 sqrt((c11 c33 - c13^2) / c11 / (1/c44 + 2 / (sqrt(c11 c33) + c13))): H. A. Elliott (1948), M. T. Hanson
    (1992), as cited by A. Delafargue & F.-J. Ulm, Int. J. Solids Struct. 41 (2004) 7351."""
    c11, _, c13, c33, c44 = TITANIUM.values()
    exact = 2 * math.sqrt((c11 * c33 - c13**2) / c11 / (1 / c44 + 2 / (math.sqrt(c11 * c33) + c13)))
    stiffness = Stiffness("hexagonal", **TITANIUM)
    assert stiffness.plane_strain_modulus == pytest.approx(exact, rel=1e-13)
    assert len(stiffness.harmonics[0]) == 1  # the same in all directions


def test_symmetry_of_the_surface_shows_in_the_harmonics() -> None:
    def orders(normal: tuple[int, int, int], along_x: tuple[int, int, int]) -> set[int]:
        even, _ = Stiffness("cubic", **COPPER, normal=normal, along_x=along_x).harmonics
        return {2 * m for m in range(len(even)) if abs(even[m]) > 1e-12 * even[0]}

    assert {order % 4 for order in orders((0, 0, 1), (1, 0, 0))} == {0}
    assert {order % 6 for order in orders((1, 1, 1), (1, -1, 0))} == {0}
    assert {order % 4 for order in orders((1, 1, 0), (0, 0, 1))} == {0, 2}


def test_axes_of_the_surface_are_right_handed() -> None:
    """A crystal with its x turned towards y, along normal x along_x, has its response at that angle."""
    normal, x = np.array(SKEW.normal), np.array(SKEW.along_x)
    turned = SKEW.oriented(normal, math.cos(0.5) * x + math.sin(0.5) * np.cross(normal, x))
    angles = np.linspace(0, 3, 5)
    np.testing.assert_allclose(turned.surface_compliance(angles), SKEW.surface_compliance(angles + 0.5), rtol=1e-12)


def test_crystal_turned_by_a_symmetry_of_its_own_responds_alike() -> None:
    angles = np.linspace(0, 3, 5)
    first = Stiffness("cubic", **COPPER, normal=(1, 1, 1), along_x=(1, -1, 0)).surface_compliance(angles)
    second = Stiffness("cubic", **COPPER, normal=(-1, 1, 1), along_x=(-1, -1, 0)).surface_compliance(angles)
    np.testing.assert_allclose(first, second, rtol=1e-13)


@pytest.mark.parametrize("stiffness", [Stiffness("cubic", **COPPER, normal=(1, 1, 0), along_x=(0, 0, 1)), SKEW])
def test_point_force_is_the_inverse_transform(stiffness: Stiffness) -> None:
    """A ring of wavevectors under a Gaussian pressure against its direct convolution with g / r."""
    angles = np.arange(400) * (2 * np.pi / 400)
    x, y = 1.3, 0.4
    # pressure exp(-r^2 / 2): the integral over q of exp(-q^2 / 2) cos(q s) is sqrt(pi / 2) exp(-s^2 / 2)
    along = x * np.cos(angles) + y * np.sin(angles)
    harmonic = np.mean(stiffness.surface_compliance(angles) * np.exp(-(along**2) / 2)) * math.sqrt(np.pi / 2)
    # in polar coordinates about the point, the integral over r from 0 to infinity in closed form
    across = (x * np.sin(angles) - y * np.cos(angles)) ** 2
    towards = np.array([math.erf(value / math.sqrt(2)) for value in along])
    direct = np.exp(-across / 2) * math.sqrt(np.pi / 2) * (1 - towards)
    found = 2 * np.pi * np.mean(anisotropic.angular_function(stiffness, angles) * direct)
    assert found == pytest.approx(harmonic, rel=1e-13, abs=0)


@pytest.mark.parametrize(("sides", "periodic"), [((1.0, 1.0), False), ((1.0, 7.0), False), ((3.0, 2.0), True)])
def test_isotropic_table_is_that_of_boussinesq(sides: tuple[float, float], periodic: bool) -> None:
    for axes in ((False, periodic), (periodic, False)):
        grid = Grid((30, 21), sides, periodic=axes)
        found = anisotropic.surface_table(grid, Material("as steel", stiffness=isotropic(STEEL)))
        if periodic:
            exact = semi_periodic.surface_table(grid, STEEL, Load.NORMAL)
        else:
            exact = half_space.surface_table(grid.shape, sides, STEEL, Load.NORMAL)
        np.testing.assert_allclose(found, exact, rtol=1e-13, atol=1e-13 * np.abs(exact).max())


@pytest.mark.parametrize("crystal", [COPPER, SODIUM])
def test_cell_coefficients_match_adaptive_quadrature(crystal: dict[str, float]) -> None:
    """In polar coordinates about the point the radial integral is the length of the ray in the cell."""
    stiffness = Stiffness("cubic", **crystal, normal=(1, 1, 0), along_x=(0, 0, 1))
    dx, dy = 1.0, 1.6
    table = anisotropic.surface_table(Grid((30, 30), (dx, dy)), Material("crystal", stiffness=stiffness))
    even = stiffness.harmonics[0] * (-1.0) ** np.arange(len(stiffness.harmonics[0])) / (2 * np.pi)

    def g(theta: float) -> float:
        return float(np.polynomial.chebyshev.chebval(math.cos(2 * theta), even))

    for i, j in ((0, 0), (1, 0), (0, 1), (3, 2), (8, 1), (29, 29)):
        left, low = i * dx - dx / 2, j * dy - dy / 2

        def chord(theta: float, left: float = left, low: float = low) -> float:
            c, s = math.cos(theta), math.sin(theta)
            ends = [sorted(((start) / d, (start + side) / d)) for start, side, d in ((left, dx, c), (low, dy, s)) if d]
            return max(0.0, min(e[1] for e in ends) - max(0.0, *(e[0] for e in ends)))

        corners = {math.atan2(low + v, left + u) for u in (0, dx) for v in (0, dy)}
        if (i, j) == (0, 0):
            corners |= {-math.pi, math.pi, -math.pi / 2, 0.0, math.pi / 2}
        elif i == 0 or j == 0:
            corners |= {math.atan2(j, i)}
        exact = 0.0
        nodes, weights = np.polynomial.legendre.leggauss(60)
        breaks = sorted(corners)
        for first, last in pairwise(breaks):
            theta = 0.5 * (first + last) + 0.5 * (last - first) * nodes
            exact += 0.5 * (last - first) * sum(w * g(t) * chord(t) for w, t in zip(weights, theta, strict=True))
        assert table[i, j] == pytest.approx(exact, rel=1e-12, abs=0)


@pytest.mark.parametrize("odd", [False, True])
def test_near_and_far_rules_agree_where_they_meet(odd: bool) -> None:
    even, sines = SKEW.harmonics
    point = anisotropic.OddCrystalPoint(sines) if odd else anisotropic.CrystalPoint(even)
    for distance in (12.1, 30.1):
        at = np.array([distance]), np.linspace(0, distance, 15)
        far = cell_table(*at, (2.0, 2.0), point)
        near = point.near(np.full(15, distance), at[1], 1.0, 1.0)
        np.testing.assert_allclose(far[0], near, rtol=1e-12, atol=1e-13 * np.abs(near).max())
    long = cell_table(np.array([0.0, 4.0]), np.array([0.0, 15.0, 40.0]), (2.0, 10.0), point)
    pieces = [
        cell_table(np.array([0.0, 4.0]), np.array([0.0, 15.0, 40.0]) - s, (2.0, 2.0), point) for s in (-4, -2, 0, 2, 4)
    ]
    np.testing.assert_allclose(long, sum(pieces), rtol=1e-12, atol=1e-13 * np.abs(long).max())


def test_images_along_a_periodic_axis_are_summed() -> None:
    """Against sums over 121 and 364 images, extrapolated: their error falls as 1 / (K + 1/2)^2, here by 9."""
    stiffness = Stiffness("cubic", **COPPER, normal=(1, 1, 0))
    grid = Grid((12, 9), (1.0, 1.0), periodic=(False, True))
    even = stiffness.harmonics[0]
    as_stiff = Material("as stiff", youngs_modulus=2 / even.sum(), poissons_ratio=0.0)
    point = even * (-1.0) ** np.arange(len(even)) / (2 * np.pi)
    point[0] -= even.sum() / (2 * np.pi)
    x, y = np.arange(12.0), np.arange(9.0)
    sums, total = {}, np.zeros(grid.shape)
    for k in range(365):
        for side in (1, -1) if k else (1,):
            total += cell_table(x, y + side * 9.0 * k, (1.0, 1.0), anisotropic.CrystalPoint(point))
        if k in (40, 121, 364):
            sums[k] = total.copy()
    once = [(9 * sums[b] - sums[a]) / 8 for a, b in ((40, 121), (121, 364))]
    exact = semi_periodic.surface_table(grid, as_stiff, Load.NORMAL) + (81 * once[1] - once[0]) / 80
    found = anisotropic.surface_table(grid, Material("copper", stiffness=stiffness))
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-11 * np.abs(found).max())
    turned = anisotropic.surface_table(
        Grid((9, 12), (1.0, 1.0), periodic=(True, False)),
        Material("copper", stiffness=stiffness.oriented((1, 1, 0), (0, 0, 1))),
    )
    np.testing.assert_allclose(turned.T, found, rtol=1e-12, atol=1e-13 * np.abs(found).max())


def test_surface_that_is_not_symmetric_about_x_matches_quadrature() -> None:
    """Tensor Gauss rules of the point force over the cell, on both sides of the x axis."""
    dx, dy = 1.0, 1.6
    material, grid = Material("crystal", stiffness=SKEW), Grid((30, 30), (dx, dy))
    even = anisotropic.surface_table(grid, material)
    odd = anisotropic.odd_surface_table(grid, material)
    assert np.abs(odd[1:, 1:] / even[1:, 1:]).max() > 0.03
    nodes, weights = np.polynomial.legendre.leggauss(120)
    for i, j in ((1, 2), (3, 2), (8, 1), (29, 29)):
        for side in (1, -1):
            x, y = np.meshgrid(i * dx - dx / 2 * nodes, side * j * dy - dy / 2 * nodes, indexing="ij")
            point = anisotropic.angular_function(SKEW, np.arctan2(y, x)) / np.hypot(x, y)
            exact = dx * dy / 4 * float(weights @ point @ weights)
            assert even[i, j] + side * odd[i, j] == pytest.approx(exact, rel=1e-12, abs=0)
    assert max(np.abs(odd[0]).max(), np.abs(odd[:, 0]).max()) < 1e-14 * np.abs(odd).max()


def test_images_of_the_odd_part_are_summed() -> None:
    """Against sums over images on both sides, extrapolated. Exchanged axes transpose."""
    material = Material("crystal", stiffness=SKEW)
    found = anisotropic.odd_surface_table(Grid((8, 9), (1.0, 1.0), periodic=(False, True)), material)
    sines = SKEW.harmonics[1]
    point = anisotropic.OddCrystalPoint(sines * (-1.0) ** np.arange(1, len(sines) + 1) / (2 * np.pi))
    x, y = np.arange(8.0), np.arange(9.0)
    sums, total = {}, np.zeros((8, 9))
    for k in range(365):
        for side in (1, -1) if k else (1,):
            total += cell_table(x, y + side * 9.0 * k, (1.0, 1.0), point)
        if k in (40, 121, 364):
            sums[k] = total.copy()
    once = [(9 * sums[b] - sums[a]) / 8 for a, b in ((40, 121), (121, 364))]
    np.testing.assert_allclose(found, (81 * once[1] - once[0]) / 80, rtol=0, atol=1e-11 * np.abs(found).max())
    y_first = SKEW.oriented(SKEW.normal, np.cross(SKEW.normal, SKEW.along_x))  # x and y become y and -x
    turned = anisotropic.odd_surface_table(
        Grid((9, 8), (1.0, 1.0), periodic=(True, False)), Material("turned", stiffness=y_first)
    )
    np.testing.assert_allclose(-turned.T, found, rtol=0, atol=1e-12 * np.abs(found).max())


@pytest.mark.parametrize("periodic", [(False, False), (False, True), (True, False)])
@pytest.mark.parametrize("shape", [(12, 9), (13, 8)])
def test_operator_of_a_surface_that_is_not_symmetric_is_the_sum_over_cells(
    shape: tuple[int, int], periodic: tuple[bool, bool]
) -> None:
    material, grid = Material("crystal", stiffness=SKEW), Grid(shape, (1.0, 1.6), periodic=periodic)
    tables = anisotropic.surface_table(grid, material), anisotropic.odd_surface_table(grid, material)
    i, j = (np.subtract.outer(np.arange(n), np.arange(n)) for n in shape)
    at = np.abs(i)[:, None, :, None], np.abs(j)[None, :, None, :]
    sign = np.sign(i)[:, None, :, None] * np.sign(j)[None, :, None, :]
    pressure = np.random.default_rng(0).uniform(0, 1, shape)
    exact = np.einsum("ijkl,kl->ij", tables[0][at] + sign * tables[1][at], pressure)
    found = displacement_operator(grid, Body(material))(pressure)
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-13 * np.abs(exact).max())


def test_waves_of_a_surface_that_is_not_symmetric_and_full_contact_under_them() -> None:
    """Each wave has its own A; the inverse operator returns the pressure."""
    grid = Grid((15, 11), (1.0, 1.6), periodic=(True, True))
    operator = displacement_operator(grid, Body(Material("crystal", stiffness=SKEW)))
    pressure = np.random.default_rng(0).uniform(0, 1, grid.shape)
    kx, ky = (2 * np.pi * np.fft.fftfreq(n, d) for n, d in zip(grid.shape, grid.spacing, strict=True))
    q, angles = np.hypot(kx[:, None], ky), np.arctan2(ky, kx[:, None])
    q[0, 0] = np.inf
    exact = np.fft.ifft2(np.fft.fft2(pressure) * SKEW.surface_compliance(angles.ravel()).reshape(q.shape) / q).real
    found = operator(pressure)
    np.testing.assert_allclose(found, exact, rtol=0, atol=1e-13 * np.abs(exact).max())
    back = np.empty(grid.shape)
    operator.scaled_inverse().apply(found / operator.unit, back)
    np.testing.assert_allclose(back, pressure - pressure.mean(), rtol=0, atol=1e-13)


def test_pair_of_crystals_adds_both_odd_parts() -> None:
    """A crystal and its mirror image about x have none together."""
    mirrored = SKEW.oriented(np.array(SKEW.normal) * (1, 1, -1), np.array(SKEW.along_x) * (1, 1, -1))
    bodies = tuple(Body(Material("crystal", stiffness=one)) for one in (SKEW, mirrored))
    for periodic in ((False, False), (True, True)):
        grid = Grid((16, 12), (1.0, 1.6), periodic=periodic)
        pressure = np.random.default_rng(1).uniform(0, 1, grid.shape)
        pressure += pressure[:, ::-1]
        pair = displacement_operator(grid, bodies)(pressure)
        one, other = (displacement_operator(grid, body)(pressure) for body in bodies)
        np.testing.assert_allclose(pair, one + other, rtol=0, atol=1e-13 * np.abs(pair).max())
        np.testing.assert_allclose(other, one[:, ::-1], rtol=0, atol=1e-12 * np.abs(one).max())
        assert np.abs(one - one[:, ::-1]).max() > 1e-3 * np.abs(one).max()


def test_operator_adds_both_bodies_and_keeps_isotropic_digits() -> None:
    crystal = Body(CATALOGUE["copper-crystal"].material)
    stiff = Material("as steel", stiffness=isotropic(STEEL))
    rng = np.random.default_rng(0)
    for periodic in ((False, False), (False, True), (True, True)):
        grid = Grid((20, 18), (1e-6, 1e-6), periodic=periodic)
        pressure = rng.uniform(0, 1e8, grid.shape)
        one = displacement_operator(grid, crystal)(pressure)
        pair = displacement_operator(grid, (crystal, Body(STEEL)))(pressure)
        steel = displacement_operator(grid, Body(STEEL))(pressure)
        np.testing.assert_allclose(pair, one + steel, rtol=1e-12, atol=1e-13 * np.abs(pair).max())
        same = displacement_operator(grid, Body(stiff))(pressure)
        np.testing.assert_allclose(same, steel, rtol=1e-12, atol=1e-13 * np.abs(steel).max())


def test_effective_modulus_is_that_of_the_mean_over_directions() -> None:
    material = CATALOGUE["iron-crystal"].material
    operator = displacement_operator(Grid((8, 8), (1e-6, 1e-6)), Body(material))
    assert operator.contact_modulus == pytest.approx(material.stiffness.plane_strain_modulus, rel=1e-12)
    assert operator.modulus_at(1e6) == pytest.approx(operator.contact_modulus, rel=1e-12)
    grid = Grid((16, 16), (1e-6, 1e-6), periodic=(True, True))
    response = spectral.surface_response(grid, Body(material), Load.NORMAL)
    kx, ky = grid.wavevectors()
    angle = np.arctan2(*np.broadcast_arrays(ky, kx))[1:8, 1:8]
    exact = material.stiffness.surface_compliance(angle.ravel()).reshape(angle.shape) / np.hypot(kx, ky)[1:8, 1:8]
    np.testing.assert_allclose(response[1:8, 1:8], exact, rtol=1e-12)
    assert response[0, 0] == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"crystal": "cubic", "c11": 1.0, "c12": 2.0, "c44": 1.0}, "not positive definite"),
        ({"crystal": "cubic", "c11": 1.0, "c44": 1.0}, "a cubic crystal has c11, c12, c44"),
        ({"crystal": "icosahedral", "c11": 1.0}, "allowed: cubic"),
        ({"crystal": "general"}, "needs matrix"),
        ({"crystal": "cubic", "c11": 3.0, "c12": 1.0, "c44": 1.0, "normal": (0, 0, 0)}, "not all zero"),
        ({"crystal": "cubic", "c11": 3.0, "c12": 1.0, "c44": 1.0, "along_x": (0, 0, 2)}, "is the normal"),
    ],
)
def test_wrong_crystals_are_refused(arguments: dict, message: str) -> None:
    with pytest.raises(InputError, match=message):
        Stiffness(**arguments)


def test_constants_beside_a_stiffness_must_follow_from_it() -> None:
    stiffness = Stiffness("cubic", **COPPER)
    material = Material("copper", stiffness=stiffness)
    again = Material("copper", stiffness=stiffness, youngs_modulus=material.youngs_modulus)
    assert again == material
    with pytest.raises(InputError, match="given beside stiffness"):
        Material("copper", stiffness=stiffness, youngs_modulus=120e9)


@pytest.mark.parametrize(
    ("crystal", "constants"),
    [
        ("trigonal", {"c11": 86.7, "c12": 7.0, "c13": 11.9, "c14": -17.9, "c33": 107.2, "c44": 57.9}),
        ("tetragonal", {"c11": 271.0, "c12": 175.0, "c13": 147.0, "c33": 480.0, "c44": 124.0, "c66": 193.0}),
    ],
)
def test_crystals_have_their_symmetry(crystal: str, constants: dict[str, float]) -> None:
    """A turn by 120 or 90 degrees about the axis leaves the stiffness tensor as it is."""
    stiffness = Stiffness(crystal, **constants)
    angle = 2 * np.pi / (3 if crystal == "trigonal" else 4)
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])
    turned = np.einsum("ia,jb,kc,ld,abcd->ijkl", turn, turn, turn, turn, stiffness.tensor)
    np.testing.assert_allclose(turned, stiffness.tensor, atol=1e-12 * np.abs(turned).max())
