"""Strips: plane strain."""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from bem import InputError, Material
from bem.kernels.half_plane import strip_displacement, strip_stress
from bem.kernels.half_space import rectangle_displacement
from bem.kernels.loads import Load
from bem.kernels.subsurface import rectangle_stress

pytestmark = pytest.mark.internal

NU = 0.3
SOLID = Material("solid", youngs_modulus=2 * (1 + NU), poissons_ratio=NU)


def flamant(x, z, a, load):
    """Johnson (1985), eq. 2.22-2.23 and 2.31: line loads integrated across the strip; xx, zz, xz."""
    mp.mp.dps = 30
    x, z, a = mp.mpf(x), mp.mpf(z), mp.mpf(a)

    def line(s, n):
        u = x - s
        base = -2 / mp.pi / (u * u + z * z) ** 2
        if load is Load.NORMAL:
            return base * (u * u * z, z**3, u * z * z)[n]
        return base * (u**3, u * z * z, u * u * z)[n]

    ends = sorted({-a, a} | ({x} if -a < x < a else set()))
    return np.array([float(mp.quad(lambda s, n=n: line(s, n), ends)) for n in range(3)])


@pytest.mark.parametrize("load", Load)
@pytest.mark.parametrize(
    "point", [(0.3, 0.2, 1), (1.4, 0.5, 1), (9, 6, 1), (15, 0.3, 1), (20000, 100, 1), (3, 2000, 1)]
)
def test_strip_against_quadrature_of_line_loads(point, load):
    x, z, a = point
    got = strip_stress(x, z, 2 * a, NU, load)
    want = flamant(x, z, a, load)
    assert np.abs(got[[0, 2, 4]] - want).max() < 1e-13 * np.abs(want).max()  # round-off of the closed form's end
    assert got[1] == pytest.approx(NU * (got[0] + got[2]), rel=1e-14)
    assert got[3] == got[5] == 0


@pytest.mark.parametrize("load", Load)
def test_strip_is_a_long_rectangle(load):
    for x, z in [(0.3, 0.2), (3, 4), (11.9, 1), (12.1, 1), (-0.7, 0)]:
        strip = strip_stress(x, z, 2.0, NU, load)
        long = rectangle_stress(x, 0, z, (2.0, 1e9), NU, load)
        assert np.abs(strip - long).max() < 1e-6 * np.abs(strip).max()  # the ends: distance / length, 1e-8, times a few


@pytest.mark.parametrize("load", Load)
def test_displacement_and_its_datum(load):
    x = np.array([0.0, 0.4, 1.0, 5.0, 11.9, 12.1, 300.0])
    got = strip_displacement(x, 2.0, SOLID, load, reference_length=7.0)
    long = rectangle_displacement(x, 0, 0, (2.0, 1e12), SOLID, load)[2]
    # differences from x = 0 do not know the datum; the rectangle's ends change them by 300 / 5e11
    np.testing.assert_allclose(got - got[0], long - long[0], rtol=1e-9, atol=1e-12)
    if load is Load.NORMAL:
        mp.mp.dps = 30
        for place, value in zip(x, got, strict=True):
            ends = sorted({-1.0, 1.0} | ({float(place)} if abs(place) < 1 else set()))
            want = -2 / (mp.pi * SOLID.plane_strain_modulus) * mp.quad(lambda s, p=place: mp.log(abs(p - s) / 7), ends)
            assert value == pytest.approx(float(want), rel=1e-13)
        far = strip_displacement(7.0, 1e-6, SOLID, reference_length=7.0)
        assert abs(far) < 1e-20  # a line load displaces nothing at the reference length
    else:
        side = (1 - 2 * NU) / (4 * SOLID.shear_modulus) * 2.0
        np.testing.assert_allclose(got[[0, -1]], [0, side], rtol=1e-14)


@settings(max_examples=100, deadline=None)
@given(st.floats(-300, 300), st.floats(1e-3, 300), st.sampled_from(Load))
def test_halves_parity_and_scaling(x, z, load):
    whole = strip_stress(x, z, 2.0, NU, load)
    halves = strip_stress(x + 0.5, z, 1.0, NU, load) + strip_stress(x - 0.5, z, 1.0, NU, load)
    scale = np.abs(whole).max()
    assert np.abs(whole - halves).max() <= 1e-12 * max(scale, np.abs(halves).max())
    odd = np.array([1, 1, 1, 1, -1, 1]) if load is Load.NORMAL else np.array([-1, -1, -1, 1, 1, 1])
    assert np.abs(strip_stress(-x, z, 2.0, NU, load) - odd * whole).max() <= 1e-13 * scale
    np.testing.assert_array_equal(strip_stress(x * 8, z * 8, 16.0, NU, load), whole)


def test_bad_input_is_refused():
    with pytest.raises(InputError, match="reference_length"):
        strip_displacement(1.0, 1.0, SOLID, reference_length=0.0)
    with pytest.raises(InputError, match="depth"):
        strip_stress(0.0, -1.0, 1.0, NU)
