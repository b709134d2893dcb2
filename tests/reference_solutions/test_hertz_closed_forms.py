"""Hertz, Westergaard and punches against quadrature, differential identities and limits."""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import quad

from bem.errors import InputError
from bem.reference_solutions.hertz import cylinder_contact, ellipse_contact, sphere_contact
from bem.reference_solutions.punch import CircularPunch, StripPunch
from bem.reference_solutions.westergaard import (
    SinusoidalContact,
    crossed_contact_fraction_light,
    crossed_contact_fraction_near_full,
    crossed_full_contact,
    crossed_full_contact_pressure,
)

ROUND_OFF = 1e-12


def test_sphere_textbook():
    contact = sphere_contact(radius=2e-3, contact_modulus=115e9, load=5.0)
    radius = (0.75 * 5.0 * 2e-3 / 115e9) ** (1 / 3)
    assert contact.semi_axes == pytest.approx((radius, radius), rel=ROUND_OFF)
    assert contact.approach == pytest.approx(radius**2 / 2e-3, rel=ROUND_OFF)
    assert contact.maximum_pressure == pytest.approx(1.5 * 5.0 / (np.pi * radius**2), rel=ROUND_OFF)


def test_sphere_displacement_outside_is_johnson_3_42():
    contact = sphere_contact(radius=1.0, contact_modulus=1.0, approach=0.01)
    a, p0 = contact.semi_axes[0], contact.maximum_pressure
    r = a * np.array([1.0, 1.0001, 1.5, 3, 100])
    expected = p0 / (2 * a) * ((2 * a**2 - r**2) * np.arcsin(a / r) + r * a * np.sqrt(1 - (a / r) ** 2))
    # the textbook form cancels four digits at r = 100 a
    np.testing.assert_allclose(contact.displacement(r, 0), expected, rtol=1e-8)
    np.testing.assert_allclose(contact.displacement(0, r), contact.displacement(r, 0), rtol=ROUND_OFF)
    # far away a point load: P / (pi E* r), next term (a/r)^2 / 10
    assert contact.displacement(1e6 * a, 0) == pytest.approx(contact.load / (np.pi * 1e6 * a), rel=1e-11)


@settings(max_examples=40, deadline=None)
@given(st.floats(-9, 9), st.booleans())
def test_ellipse_touches_without_gap_and_carries_its_load(log_ratio, by_load):
    ratio = 10**log_ratio
    kwargs = {"load": 3.0} if by_load else {"approach": 1e-6}
    contact = ellipse_contact(radii=(0.5, 0.5 * ratio), contact_modulus=2e9, **kwargs)
    a, b = contact.semi_axes
    assert contact.load == pytest.approx(2 / 3 * np.pi * a * b * contact.maximum_pressure, rel=ROUND_OFF)
    s = np.array([0.0, 0.3, 0.7, 0.99, 0.5])
    t = np.array([0.0, 0.4, 0.1, 0.0, -0.8])
    # shape of the ellipse found to round-off; displacement is made of K, D, B near their machine accuracy
    assert np.abs(contact.gap(a * s, b * t)).max() < 1e-11 * contact.approach
    outside = contact.gap(a * np.array([1.2, 0, 1, -2]), b * np.array([0, 1.3, 1, 0.5]))
    assert (outside > 0).all()


def test_ellipse_against_mpmath():
    """Johnson 4.26-4.28 with complete integrals in 40 digits, k prescribed, ratio of radii following."""
    mp.mp.dps = 40
    for k in (0.999999, 0.7, 0.05, 1e-4):
        m = 1 - mp.mpf(k) ** 2
        big_k, big_e = mp.ellipk(m), mp.ellipe(m)
        ratio = (big_e / mp.mpf(k) ** 2 - big_k) / (big_k - big_e)
        contact = ellipse_contact(radii=(float(ratio), 1.0), contact_modulus=1.0, load=1.0)
        a, b = contact.semi_axes
        assert b / a == pytest.approx(k, rel=1e-13)  # ratio itself is rounded to 1e-16
        p0 = mp.mpf(contact.maximum_pressure)
        assert contact.approach == pytest.approx(float(p0 * b * big_k), rel=1e-13)


def test_ellipse_displacement_against_quadrature():
    contact = ellipse_contact(radii=(1.0, 0.2), contact_modulus=1.0, load=1e-4)
    a, b = contact.semi_axes
    theta = (np.arange(400) + 0.5) * 2 * np.pi / 400
    nodes, weights = np.polynomial.legendre.leggauss(60)
    beta = np.pi / 4 * (nodes + 1)
    rho, weight = np.sin(beta), np.pi / 4 * weights * np.sin(beta) * np.cos(beta) ** 2
    for point in ((1.5 * a, 0.3 * b), (0.2 * a, 2.5 * b)):
        distance = np.hypot(point[0] - a * rho[:, None] * np.cos(theta), point[1] - b * rho[:, None] * np.sin(theta))
        total = (weight[:, None] / distance).sum() * 2 * np.pi / 400 * a * b * contact.maximum_pressure / np.pi
        # smooth periodic integrand: converged far below this
        assert contact.displacement(*point) == pytest.approx(total, rel=1e-10)


def test_swapping_axes_swaps_the_ellipse():
    one = ellipse_contact(radii=(1.0, 3.0), contact_modulus=1.0, load=1.0)
    two = ellipse_contact(radii=(3.0, 1.0), contact_modulus=1.0, load=1.0)
    assert one.semi_axes == two.semi_axes[::-1]
    assert one.approach == two.approach
    np.testing.assert_array_equal(one.gap(0.7, 2.0), two.gap(2.0, 0.7))


def test_slender_ellipse_tends_to_the_cylinder():
    contact = ellipse_contact(radii=(1e-2, 1e4), contact_modulus=1e9, load=1e3)
    per_length = np.pi / 2 * contact.maximum_pressure * contact.semi_axes[0]
    cylinder = cylinder_contact(radius=1e-2, contact_modulus=1e9, load=per_length)
    # next order is (b/a)^2 log(a/b), 1e-7 here
    assert contact.semi_axes[0] == pytest.approx(cylinder.half_width, rel=1e-6)
    assert contact.maximum_pressure == pytest.approx(cylinder.maximum_pressure, rel=1e-6)


def test_cylinder():
    contact = cylinder_contact(radius=2e-3, contact_modulus=115.4e9, load=10 / 6e-3)
    a = contact.half_width
    assert quad(contact.pressure, -a, a)[0] == pytest.approx(contact.load, rel=1e-6)
    assert contact.maximum_pressure == pytest.approx(contact.contact_modulus * a / (2 * contact.radius), rel=ROUND_OFF)
    for x in (0.6 * a, 1.4 * a, 5 * a):
        # u(x) - u(0) = -(2 / pi E*) integral p ln |(x - s)/s|, with s = a sin t; ln singular points given to quad
        def integrand(t, x=x):
            s = a * np.sin(t)
            return contact.maximum_pressure * a * np.cos(t) ** 2 * np.log(abs((x - s) / s))

        points = [0.0] + ([np.arcsin(x / a)] if x < a else [])
        value = quad(integrand, -np.pi / 2, np.pi / 2, points=points, limit=200)[0]
        expected = -2 / (np.pi * contact.contact_modulus) * value
        assert contact.displacement(x) == pytest.approx(expected, rel=1e-7)  # quad over a logarithm
    assert contact.approach(3 * a) == -contact.displacement(3 * a)


def test_thesis_numbers():
    """THESIS.md: 24.3 um = four Hertz half-widths at 10 N; mean 102, maximum 130 MPa at 5.5 N over 6 mm."""
    steel = 210e9 / (1 - 0.3**2) / 2
    contact = cylinder_contact(radius=2e-3, contact_modulus=steel, load=10 / 6e-3)
    assert 4 * contact.half_width == pytest.approx(24.3e-6, rel=2e-3)  # the source gives three digits
    assert contact.maximum_pressure == pytest.approx(175e6, rel=2e-3)
    contact = cylinder_contact(radius=2e-3, contact_modulus=231e9 / 2, load=5.5 / 6e-3)
    assert contact.mean_pressure == pytest.approx(102e6, rel=0.01)
    assert contact.maximum_pressure == pytest.approx(130e6, rel=0.01)


@pytest.mark.parametrize(
    "kwargs",
    [
        {"radius": -1.0, "contact_modulus": 1.0, "load": 1.0},
        {"radius": 1.0, "contact_modulus": float("nan"), "load": 1.0},
        {"radius": 1.0, "contact_modulus": 1.0},
        {"radius": 1.0, "contact_modulus": 1.0, "load": 1.0, "approach": 1.0},
        {"radius": 1.0, "contact_modulus": 1.0, "load": 0.0},
    ],
)
def test_hertz_refuses(kwargs):
    with pytest.raises(InputError, match="Hertz"):
        sphere_contact(**kwargs)


# --- sinusoids ---------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("ratio", [1e-4, 0.1, 0.5, 0.999, 1.0, 3.0])
def test_westergaard_load_and_gap(ratio):
    amplitude, wavelength, modulus = 1e-3, 2.0, 5.0
    star = np.pi * modulus * amplitude / wavelength
    contact = SinusoidalContact(amplitude, wavelength, modulus, ratio * star)
    assert contact.full_contact_pressure == pytest.approx(star, rel=ROUND_OFF)
    a = contact.half_width
    mean = quad(contact.pressure, -a, a, epsabs=0, limit=200)[0] / wavelength
    assert mean == pytest.approx(ratio * star, rel=1e-7)  # square-root ends limit quad
    # spectral solution: displacement of harmonic n is 2 / (E* k_n) times that of the pressure
    n = 2**15
    x = (np.arange(n) + 0.5) / n * wavelength
    spectrum = np.fft.rfft(contact.pressure(x))
    k = 2 * np.pi * np.fft.rfftfreq(n, wavelength / n)
    spectrum[0], spectrum[1:] = 0, spectrum[1:] * 2 / (modulus * k[1:])
    gap = amplitude * (1 - np.cos(2 * np.pi * x / wavelength)) + np.fft.irfft(spectrum, n)
    gap -= gap[0] - contact.gap(x[0])
    # sampled square-root ends: error ~ amplitude n^-3/2
    np.testing.assert_allclose(contact.gap(x), gap, atol=3e-6 * amplitude)


def test_westergaard_tends_to_hertz():
    contact = SinusoidalContact(1e-3, 2.0, 5.0, 1e-9)
    hertz = cylinder_contact(radius=(2.0 / (2 * np.pi)) ** 2 / 1e-3, contact_modulus=5.0, load=2e-9)
    assert contact.half_width == pytest.approx(hertz.half_width, rel=1e-6)  # next order (a/wavelength)^2 ~ 1e-7
    assert contact.gap(3 * hertz.half_width) == pytest.approx(hertz.gap(3 * hertz.half_width), rel=1e-5)


def test_crossed_sinusoids_full_contact():
    lengths, amplitude, modulus = (2.0, 3.0), 1e-3, 7.0
    star = crossed_full_contact_pressure(amplitude, lengths, modulus)
    x, y = np.meshgrid(np.arange(16) / 16 * 2.0, np.arange(24) / 24 * 3.0, indexing="ij")
    pressure = crossed_full_contact(
        x, y, amplitude=amplitude, wavelengths=lengths, contact_modulus=modulus, mean_pressure=star
    )
    assert pressure.min() == pytest.approx(0, abs=1e-12 * star)
    assert pressure.mean() == pytest.approx(star, rel=ROUND_OFF)
    # the half-plane row as its limit
    row = SinusoidalContact(amplitude, 2.0, modulus, 1.0).full_contact_pressure
    assert crossed_full_contact_pressure(amplitude, (2.0, np.inf), modulus) == pytest.approx(row, rel=ROUND_OFF)
    assert crossed_full_contact_pressure(amplitude, (2.0, 2.0), modulus) == pytest.approx(
        np.sqrt(2) * row, rel=ROUND_OFF
    )
    with pytest.raises(InputError, match="full-contact"):
        crossed_full_contact(
            x, y, amplitude=amplitude, wavelengths=lengths, contact_modulus=modulus, mean_pressure=0.99 * star
        )


def test_crossed_sinusoids_light_is_hertz_on_two_crests():
    amplitude, wavelength, modulus, mean = 1e-3, 2.0, 7.0, 1e-9
    crest = wavelength**2 / (4 * np.pi**2 * amplitude)
    hertz = sphere_contact(radius=crest, contact_modulus=modulus, load=mean * wavelength**2 / 2)
    ratio = mean / crossed_full_contact_pressure(amplitude, (wavelength, wavelength), modulus)
    assert crossed_contact_fraction_light(ratio) == pytest.approx(2 * hertz.contact_area / wavelength**2, rel=ROUND_OFF)
    assert crossed_contact_fraction_near_full(1.0) == 1


# --- punches -----------------------------------------------------------------------------------------------------


def test_circular_punch():
    punch = CircularPunch(radius=0.5, contact_modulus=3.0, load=2.0)
    assert punch.load_within(0.5) == 2.0
    for r in (0.1, 0.4):
        slope = (punch.load_within(r + 1e-6) - punch.load_within(r - 1e-6)) / 2e-6
        assert slope / (2 * np.pi * r) == pytest.approx(punch.pressure(r), rel=1e-8)  # central difference
    assert punch.displacement(0.2) == pytest.approx(punch.approach)
    assert punch.displacement(1e6) == pytest.approx(2.0 / (np.pi * 3.0 * 1e6), rel=1e-9)
    assert punch.pressure(0.6) == 0


@pytest.mark.parametrize("period", [np.inf, 3.0])
def test_strip_punch_presses_flat(period):
    punch = StripPunch(half_width=0.5, contact_modulus=3.0, load=2.0, period=period)
    psi = (np.arange(4000) + 0.5) / 4000 * np.pi - np.pi / 2
    if np.isinf(period):
        s, jacobian = 0.5 * np.sin(psi), 0.5 * np.cos(psi)
        potential = lambda d: np.log(np.abs(d))  # noqa: E731
    else:
        edge = np.sin(np.pi * 0.5 / period)
        s = period / np.pi * np.arcsin(edge * np.sin(psi))
        jacobian = period / np.pi * edge * np.cos(psi) / np.cos(np.pi * s / period)
        potential = lambda d: np.log(np.abs(np.sin(np.pi * d / period)))  # noqa: E731
    weight = punch.pressure(s) * jacobian * np.pi / 4000
    assert weight.sum() == pytest.approx(2.0, rel=1e-10)  # smooth after the substitution
    face = [-2 / (np.pi * 3.0) * (weight * potential(x - s)).sum() for x in (s[1700:1703] + s[1701:1704]) / 2]
    edge_value = face[0]
    # midpoint between quadrature nodes: the logarithm's error there is log(2)/n of one node's weight
    np.testing.assert_allclose(face, edge_value, atol=2e-3)
    for x in (0.8, 1.3):
        outside = -2 / (np.pi * 3.0) * (weight * potential(x - s)).sum()
        assert face[1] - outside == pytest.approx(punch.gap(x), abs=1e-3)
    assert punch.gap(0.3) == 0
