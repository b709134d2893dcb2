"""Layered frequency response against a many-digit solution of the equations of elasticity, limits and invariances."""

import mpmath as mp
import numpy as np
import pytest
from coated_bodies import coated, material
from hypothesis import given, settings
from hypothesis import strategies as st
from pairwise import pairwise
from stack_oracle import assert_finite_and_balanced, disagreement, off_the_mean_of_a_circle

from bem import Body, Grid, Layer
from bem.errors import InputError
from bem.kernels import spectral
from bem.kernels.layered import frequency_response, waves
from bem.kernels.loads import Load

PAIRS = [(1e-3, 0.2, 0.35), (0.05, 0.4999, 0.1), (1.0, 0.3, 0.3), (20.0, -0.6, 0.45), (1e3, 0.25, -0.3)]


@pytest.mark.parametrize(("ratio", "nu1", "nu2"), PAIRS)
@pytest.mark.parametrize("tangential", [False, True])
def test_elasticity_is_solved(ratio, nu1, nu2, tangential):
    """Both sides of the switch at q h = 1, in the layer, on the interface and below, oblique wavevectors."""
    for qh, angle in ((1e-3, 0.4), (0.7, 2.0), (1.3, -1.1), (9.0, 0.9)):
        kx, ky = qh * np.cos(angle), qh * np.sin(angle)
        for depth in (0.4, 1.0, 1.7):
            body = coated(ratio, nu1, nu2, 1.0)
            # round-off: a dozen sums and products, and pi-like loss of half a digit in the smaller of two waves
            assert disagreement(body, kx, ky, depth, tangential) < 1e-13


def test_elasticity_is_solved_widely():
    worst = 0.0
    for case in pairwise(
        {
            "body": ((1e6, 0.3, 0.2), (1e-6, 0.3, 0.2), (1e-3, 0.4999999, 0.3), (300.0, 0.3, 0.499), (1e3, -0.9, 0.1)),
            "qh": (1e-6, 1e-4, 1e-2, 0.2, 0.99, 1.01, 3.0, 30.0),
            "depth": (0.0, 0.5, 1.0, 1.01, 2.0),
            "tangential": (False, True),
        }
    ):
        qh = case["qh"]
        found = disagreement(
            coated(*case["body"], 1.0), qh * np.cos(0.7), qh * np.sin(0.7), case["depth"], case["tangential"]
        )
        worst = max(worst, found)
    assert worst < 1e-12  # measured 6e-14, at a ratio of 1e6


def closed_form(q, body):
    """Normal displacement of the surface under pressure, the closed form of the literature, in 50 digits."""
    with mp.workdps(50):
        one, two = body.layer.material, body.material
        nu1, nu2 = mp.mpf(one.poissons_ratio), mp.mpf(two.poissons_ratio)
        mu1 = mp.mpf(one.youngs_modulus) / (2 * (1 + nu1))
        m = mu1 / (mp.mpf(two.youngs_modulus) / (2 * (1 + nu2)))
        x = mp.mpf(q) * mp.mpf(body.layer.thickness)
        ell = 1 - 4 * (1 - nu1) / (1 + m * (3 - 4 * nu2))
        k = (m - 1) / (m + 3 - 4 * nu1)
        e = mp.exp(-2 * x)
        ratio = (1 + 4 * x * k * e - ell * k * e**2) / (1 - (ell + k + 4 * k * x**2) * e + ell * k * e**2)
        return float((1 - nu1) / (mu1 * mp.mpf(q)) * ratio)


@pytest.mark.internal
@settings(deadline=None, max_examples=30, derandomize=True)
@given(
    ratio=st.floats(-6, 6).map(lambda e: 10.0**e),
    qh=st.floats(-6, 3).map(lambda e: 10.0**e),
    nu1=st.floats(-0.9, 0.499999),
    nu2=st.floats(-0.9, 0.499999),
)
def test_normal_displacement_keeps_its_digits(ratio, qh, nu1, nu2):
    body = coated(ratio, nu1, nu2, 0.25)
    q = qh / 0.25
    value = frequency_response.surface_response(q, 0.0, body, Load.NORMAL)
    assert value == pytest.approx(closed_form(q, body), rel=1e-11)  # the figure promised for any ratio


@settings(deadline=None, max_examples=60, derandomize=True)
@given(
    ratio=st.floats(-3, 3).map(lambda e: 10.0**e),
    qh=st.floats(-6, 6).map(lambda e: 10.0**e),
    nu1=st.floats(-0.9, 0.499),
    nu2=st.floats(-0.9, 0.499),
    depth=st.floats(0, 3),
)
def test_finite_everywhere_and_forces_balance(ratio, qh, nu1, nu2, depth):
    """No overflow; tractions pass the interface unbroken; the surface carries the load."""
    body = coated(ratio, nu1, nu2, 1.0)
    q = np.array([qh])
    # the step of one last digit in depth, times q
    assert_finite_and_balanced(q, body, depth, jump=1e-10)


@pytest.mark.internal
@pytest.mark.parametrize("nu", [-0.5, 0.0, 0.3, 0.4999])
def test_identical_materials_are_a_half_space(nu):
    body = coated(1.0, nu, nu, 0.3, 70e9)
    q = np.geomspace(1e-6, 1e6, 60) / 0.3
    g = body.material.shear_modulus
    assert np.array_equal(
        frequency_response.wave_frame_response(q, body, 0.2, remainder=True)[:, q * 0.3 > 1],
        np.zeros((15, (q * 0.3 > 1).sum())),
    )
    for depth in (0.0, 0.1, 0.3, 0.5):
        f = frequency_response.wave_frame_response(q, body, depth)
        s, decay = q * depth, np.exp(-q * depth)
        expected = np.stack(  # Johnson (1985) 13.2 and the transform of Cerruti's solution
            [
                (1 - 2 * nu - s) * decay,
                (2 * (1 - nu) + s) * decay,
                s * decay,
                -(1 + s) * decay,
            ]
        )
        assert f[:4] == pytest.approx(expected, abs=4e-15)  # round-off
        assert f[waves.ACROSS_TZ] == pytest.approx(-decay, abs=2e-15)
    w = frequency_response.surface_response(q, 0.0, body, Load.NORMAL)
    assert w == pytest.approx((1 - nu) / (g * q), rel=1e-14, abs=0)


@pytest.mark.internal
def test_thin_and_thick_layers_tend_to_their_half_spaces():
    one, two = material(40.0, 0.2), material(3.0, 0.4)
    for thickness, solid in ((1e-9, two), (1e6, one)):
        body = Body(two, layer=Layer(one, thickness))
        value = frequency_response.surface_response([1.0], [0.5], body, Load.NORMAL)
        expected = (1 - solid.poissons_ratio) / (solid.shear_modulus * np.hypot(1.0, 0.5))
        assert value == pytest.approx(expected, rel=1e-7)  # thin: first order in q h m = 4e-8


@pytest.mark.internal
def test_incompressible_thin_layer_on_a_rigid_base():
    """nu = 1/2, q h << 1 << G2/G1: the squeezed film q^2 h^3 / 3 G1; a compressible one (1-2nu) h / 2(1-nu) G1."""
    q, h = 1e-2, 1.0
    tight = coated(1e-12, 0.5 - 1e-15, 0.3, h, 1e12)
    assert frequency_response.surface_response(q, 0.0, tight, Load.NORMAL) == pytest.approx(q**2 * h**3 / 3, rel=1e-3)
    loose = coated(1e-12, 0.3, 0.3, h, 1e12)
    assert frequency_response.surface_response(q, 0.0, loose, Load.NORMAL) == pytest.approx(0.4 / 1.4 * h, rel=1e-3)


@pytest.mark.internal
def test_stiff_layer_on_a_soft_base_is_a_plate():
    """1/m << (q h)^3: normal displacement tends to p / (bending stiffness q^4 + 2 G2 (2-2nu2)/(3-4nu2) q ...)."""
    nu1, q, h, m = 0.3, 1e-2, 1.0, 1e10
    body = coated(m, nu1, 0.2, h)
    bending = m * h**3 / (6 * (1 - nu1))
    assert frequency_response.surface_response(q, 0.0, body, Load.NORMAL) == pytest.approx(
        1 / (bending * q**4), rel=1e-3
    )


def test_complex_wavenumbers_continue_the_real_ones():
    """Cauchy: the mean over a small circle is the value at its centre, on both sides of the switch and across it."""
    body = coated(30.0, 0.25, 0.4, 1.0)
    for centre in (0.6, 1.0, 2.0):
        for depth in (0.0, 0.5, 1.5):
            # trapezoidal rule on a circle: round-off
            assert off_the_mean_of_a_circle(body, depth, centre, 0.3) <= 1e-13


@pytest.mark.internal
@pytest.mark.parametrize("load", list(Load))
def test_doubly_periodic_grids(load):
    """Identical materials give the homogeneous responses; a layered one has the same symmetries and mean mode."""
    grid = Grid((12, 10), (0.3, 0.5), periodic=(True, True))
    solid = material(2.0, 0.3)
    same = Body(solid, layer=Layer(solid, 0.7))
    plain = Body(solid)
    assert spectral.surface_response(grid, same, load) == pytest.approx(
        spectral.surface_response(grid, plain, load), abs=1e-15
    )
    for depth in (0.0, 0.4, 0.7, 1.0):
        assert spectral.stress_response(grid, same, depth, load) == pytest.approx(
            spectral.stress_response(grid, plain, depth, load), abs=5e-15
        )
    other = Body(solid, layer=Layer(material(9.0, 0.2), 0.7))
    stress = spectral.stress_response(grid, other, 0.3, load)
    lateral = -0.2 / 0.8
    assert stress[:, 0, 0] == pytest.approx(
        [lateral, lateral, -1, 0, 0, 0] if load is Load.NORMAL else [0, 0, 0, 0, -1, 0]
    )
    assert spectral.surface_response(grid, other, load)[0, 0] == 0
    assert np.abs(stress[4 if load is Load.NORMAL else 0, 6]).max() == 0  # odd in kx at the highest wavenumber
    with pytest.raises(InputError):
        spectral.stress_response(grid, other, -0.1, load)


@pytest.mark.internal
def test_bad_input_is_named():
    for body, depth in ((Body(material(1.0, 0.3)), 0.0), (coated(2.0, 0.3, 0.3, 1.0), 1.1)):
        with pytest.raises(InputError, match="outermost layer only"):
            frequency_response.wave_frame_response(np.ones(1), body, depth, remainder=True)
