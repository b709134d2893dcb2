"""Hamilton's and McEwen's stresses against quadrature of point and line loads, equilibrium and textbook values."""

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss

from bem.reference_solutions.hamilton import sphere_stress
from bem.reference_solutions.mcewen import cylinder_stress, sinusoidal_stress

NU = 0.3


def point_load(x, y, z, nu, normal, tangential):
    """Stresses of point forces P along z and Q along x; Johnson (1985), 3.20 and 3.76, regular on the axis."""
    rho = np.sqrt(x * x + y * y + z * z)
    s = rho + z
    k = 1 - 2 * nu
    p = [
        k * (z / rho**3 - 1 / (rho * s) + x * x * (2 * rho + z) / (rho**3 * s**2)) - 3 * z * x * x / rho**5,
        k * (z / rho**3 - 1 / (rho * s) + y * y * (2 * rho + z) / (rho**3 * s**2)) - 3 * z * y * y / rho**5,
        -3 * z**3 / rho**5,
        -3 * y * z * z / rho**5,
        -3 * x * z * z / rho**5,
        k * x * y * (2 * rho + z) / (rho**3 * s**2) - 3 * x * y * z / rho**5,
    ]
    common = 1 / (rho**3 * s**2) + 2 / (rho**2 * s**3)
    q = [
        -3 * x**3 / rho**5 + k * (x / rho**3 - 3 * x / (rho * s**2) + x**3 * common),
        -3 * x * y * y / rho**5 + k * (x / rho**3 - x / (rho * s**2) + x * y * y * common),
        -3 * x * z * z / rho**5,
        -3 * x * y * z / rho**5,
        -3 * x * x * z / rho**5,
        -3 * x * x * y / rho**5 + k * (-y / (rho * s**2) + x * x * y * common),
    ]
    return (normal * np.stack(p) + tangential * np.stack(q)) / (2 * np.pi)


def hertz_by_quadrature(point, nu, friction):
    nodes, weights = leggauss(120)
    beta = np.pi / 4 * (nodes + 1)
    rho = np.sin(beta)[:, None]
    weight = (np.pi / 4 * weights * np.sin(beta) * np.cos(beta) ** 2)[:, None] * 2 * np.pi / 240
    theta = np.arange(240) * 2 * np.pi / 240
    field = point_load(point[0] - rho * np.cos(theta), point[1] - rho * np.sin(theta), point[2], nu, 1.0, friction)
    return (weight * field).sum(axis=(1, 2))


@pytest.mark.parametrize("nu", [0.0, 0.3, 0.49])
@pytest.mark.parametrize("friction", [0.0, 0.7])
@pytest.mark.parametrize(
    "point", [(0.0, 0.0, 0.6), (0.4, -0.3, 0.5), (1.0, 0.0, 0.4), (-1.7, 0.8, 0.3), (3.0, -2.0, 1.9), (0.1, 6.0, 4.0)]
)
def test_sphere_against_quadrature(point, nu, friction):
    got = sphere_stress(*point, contact_radius=1, maximum_pressure=1, poissons_ratio=nu, friction=friction)
    expected = hertz_by_quadrature(point, nu, friction)
    # the quadrature converges geometrically: 240 and 480 angles differ by 1e-12 at z = 0.3
    np.testing.assert_allclose(got, expected, atol=1e-11 * np.abs(expected).max())


def test_sphere_on_axis_is_huber():
    z = np.array([0.0, 1e-9, 0.48, 1.0, 3.999, 4.001, 50.0, 1e4])
    s = sphere_stress(0, 0, z, contact_radius=1, maximum_pressure=1, poissons_ratio=NU)
    with np.errstate(divide="ignore"):
        radial = -(1 + NU) * (1 - z * np.arctan(1 / z)) + 0.5 / (1 + z**2)
    # Huber's own form cancels like z^2 eps: compare where it does not, then its far limit
    np.testing.assert_allclose(s[0][:6], radial[:6], atol=1e-14)
    np.testing.assert_allclose(s[2], -1 / (1 + z**2), rtol=1e-12)
    np.testing.assert_allclose(s[0], s[1], atol=1e-15)
    shear = np.abs(s[0] - s[2])[2] / 2
    assert shear == pytest.approx(0.310, abs=5e-4)  # Johnson 4.26: 0.31 p0 at 0.48 a for nu = 0.3


def test_sphere_surface():
    r = np.array([0.0, 0.3, 0.999999, 1.0, 1.000001, 2.0, 7.0])
    s = sphere_stress(r, 0, 0, contact_radius=1, maximum_pressure=1, poissons_ratio=NU)
    inside = np.sqrt(np.maximum(1 - r**2, 0))
    np.testing.assert_allclose(s[2], -inside, atol=1e-14)
    k = (1 - 2 * NU) / 3
    with np.errstate(divide="ignore", invalid="ignore"):
        radial = np.where(r < 1, k / r**2 * (1 - inside**3) - inside, k / r**2)  # Johnson 3.43, 3.44
    radial[0] = -(1 + 2 * NU) / 2
    np.testing.assert_allclose(s[0], radial, atol=1e-14)
    assert s[0][3] == pytest.approx((1 - 2 * NU) / 3, rel=1e-12)


def test_sphere_sliding_surface_traction():
    rng = np.random.default_rng(1)
    x, y = rng.uniform(-1.5, 1.5, (2, 200))
    s = sphere_stress(x, y, 0, contact_radius=1, maximum_pressure=2, poissons_ratio=NU, friction=0.4)
    pressure = 2 * np.sqrt(np.maximum(1 - x * x - y * y, 0))
    np.testing.assert_allclose(s[2], -pressure, atol=1e-13)
    np.testing.assert_allclose(s[4], -0.4 * pressure, atol=1e-13)
    np.testing.assert_allclose(s[3], 0, atol=1e-13)


def test_sphere_equilibrium_and_compatibility():
    """div sigma = 0 and the trace is harmonic, by central differences at random points."""
    rng = np.random.default_rng(2)
    points = np.stack([*rng.uniform(-2, 2, (2, 30)), rng.uniform(0.2, 2, 30)])
    h = 2e-3

    def stress(offset):
        return sphere_stress(
            *(points + np.asarray(offset)[:, None]),
            contact_radius=1,
            maximum_pressure=1,
            poissons_ratio=NU,
            friction=0.5,
        )

    full = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2]])  # component of sigma_ij in the stored order
    steps = np.eye(3) * h
    # fourth-order differences: error h^4 x sixth derivatives ~ 1e-8
    slopes = [(8 * (stress(e) - stress(-e)) - (stress(2 * e) - stress(-2 * e))) / (12 * h) for e in steps]
    for i in range(3):
        assert np.abs(sum(slopes[j][full[i, j]] for j in range(3))).max() < 1e-6

    def trace(offset):
        return stress(offset)[:3].sum(axis=0)

    laplacian = sum(trace(e) + trace(-e) - 2 * trace(0 * e) for e in steps) / h**2
    assert np.abs(laplacian).max() < 5e-4  # second order: h^2/12 x fourth derivatives, up to 1e2 at z = 0.2


def test_sphere_near_and_far_forms_meet():
    angle = np.linspace(0, np.pi / 2, 7)
    inner, outer = ((4 + d) * np.stack([np.sin(angle), 0 * angle, np.cos(angle)]) for d in (-1e-13, 1e-13))
    kwargs = {"contact_radius": 1, "maximum_pressure": 1, "poissons_ratio": NU, "friction": 0.5}
    np.testing.assert_allclose(sphere_stress(*inner, **kwargs), sphere_stress(*outer, **kwargs), atol=1e-12)


def test_sphere_scales():
    kwargs = {"poissons_ratio": NU, "friction": 0.2}
    one = sphere_stress(0.3, 0.2, 0.5, contact_radius=1, maximum_pressure=1, **kwargs)
    two = sphere_stress(0.3e-6, 0.2e-6, 0.5e-6, contact_radius=1e-6, maximum_pressure=4e9, **kwargs)
    np.testing.assert_allclose(two, 4e9 * one, rtol=1e-13)


# --- cylinder ----------------------------------------------------------------------------------------------------


def mcewen(x, z, p0):
    """McEwen's m and n, Johnson 4.49; half-width 1."""
    inner = 1 - x * x + z * z
    root = np.sqrt(inner**2 + 4 * x * x * z * z)
    m = np.sqrt(0.5 * (root + inner))
    n = np.sign(x) * np.sqrt(0.5 * (root - inner))
    ratio = (z * z + n * n) / (m * m + n * n)
    return -p0 * (m * (1 + ratio) - 2 * z), -p0 * m * (1 - ratio), p0 * n * (m * m - z * z) / (m * m + n * n)


def test_cylinder_is_mcewen():
    rng = np.random.default_rng(3)
    x, z = rng.uniform(-3, 3, 100), rng.uniform(0.01, 3, 100)
    s = cylinder_stress(x, z, half_width=1, maximum_pressure=2, poissons_ratio=NU)
    xx, zz, xz = mcewen(x, z, 2)
    np.testing.assert_allclose(s[0], xx, atol=1e-12)
    np.testing.assert_allclose(s[2], zz, atol=1e-12)
    # with z into the body McEwen's shear changes sign with the axis
    np.testing.assert_allclose(np.abs(s[4]), np.abs(xz), atol=1e-12)
    np.testing.assert_allclose(s[1], NU * (xx + zz), atol=1e-12)


@pytest.mark.parametrize("friction", [0.0, 0.6])
def test_cylinder_against_line_loads(friction):
    t = (np.arange(2000) + 0.5) / 2000 * np.pi - np.pi / 2
    weight = np.cos(t) ** 2 * np.pi / 2000
    for x, z in ((0.0, 0.5), (0.8, 0.3), (-2.0, 1.0), (1.0, 0.2)):
        d = x - np.sin(t)
        rho4 = (d * d + z * z) ** 2
        # Johnson 2.23-2.24
        xx = -2 / np.pi * (weight * (z * d * d + friction * d**3) / rho4).sum()
        zz = -2 / np.pi * (weight * (z**3 + friction * d * z * z) / rho4).sum()
        xz = -2 / np.pi * (weight * (z * z * d + friction * d * d * z) / rho4).sum()
        s = cylinder_stress(x, z, half_width=1, maximum_pressure=1, poissons_ratio=NU, friction=friction)
        # periodic midpoint rule on an analytic integrand: far below this
        np.testing.assert_allclose(s[[0, 2, 4]], [xx, zz, xz], atol=1e-12)


def test_cylinder_surface_and_depth_of_largest_shear():
    x = np.array([-2.0, -1.0, -0.5, 0.0, 0.9, 1.0, 3.0])
    s = cylinder_stress(x, 0, half_width=1, maximum_pressure=1, poissons_ratio=NU, friction=0.3)
    pressure = np.sqrt(np.maximum(1 - x * x, 0))
    np.testing.assert_allclose(s[2], -pressure, atol=1e-15)
    np.testing.assert_allclose(s[4], -0.3 * pressure, atol=1e-15)
    tail = np.where(np.abs(x) > 1, x - np.sign(x) * np.sqrt(np.maximum(x * x - 1, 0)), x)
    np.testing.assert_allclose(s[0], -pressure - 0.6 * tail, atol=1e-15)  # Johnson 7.6: -2 f p0 x / a inside
    z = np.linspace(0.5, 1.2, 701)
    s = cylinder_stress(0, z, half_width=1, maximum_pressure=1, poissons_ratio=NU)
    shear = np.abs(s[0] - s[2]) / 2
    assert z[shear.argmax()] == pytest.approx(0.786, abs=1e-3)  # Johnson 4.47
    assert shear.max() == pytest.approx(0.300, abs=5e-4)


@pytest.mark.parametrize("friction", [0.0, 0.4])
def test_sinusoidal_pressure(friction):
    """Surface tractions, equilibrium and harmonic trace; far below nothing."""
    k, h = 3.0, 1e-3
    rng = np.random.default_rng(5)
    x, z = rng.uniform(-2, 2, 40), rng.uniform(0.01, 1.5, 40)

    def stress(dx=0.0, dz=0.0):
        return sinusoidal_stress(x + dx, z + dz, wavenumber=k, amplitude=2.0, poissons_ratio=NU, friction=friction)

    surface = sinusoidal_stress(x, 0, wavenumber=k, amplitude=2.0, poissons_ratio=NU, friction=friction)
    np.testing.assert_allclose(surface[2], -2 * np.cos(k * x), atol=1e-14)
    np.testing.assert_allclose(surface[4], -2 * friction * np.cos(k * x), atol=1e-14)
    along = (stress(h) - stress(-h)) / (2 * h)
    down = (stress(0, h) - stress(0, -h)) / (2 * h)
    # second-order differences: h^2 k^3 / 6
    np.testing.assert_allclose(along[0] + down[4], 0, atol=5e-5)
    np.testing.assert_allclose(along[4] + down[2], 0, atol=5e-5)
    trace = [s[0] + s[2] for s in (stress(h), stress(-h), stress(0, h), stress(0, -h), stress())]
    np.testing.assert_allclose((sum(trace[:4]) - 4 * trace[4]) / h**2, 0, atol=1e-3)  # round-off over h^2 and h^2 k^4
    assert np.abs(sinusoidal_stress(0.3, 20.0, wavenumber=k, amplitude=2.0, poissons_ratio=NU)).max() < 1e-20
