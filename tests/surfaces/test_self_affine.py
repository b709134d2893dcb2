"""Self-affine fit: it finds what a surface was generated with, and says where a surface is none."""

import math

import numpy as np
import pytest

from bem import Grid, InputError, generate_surface
from bem.surfaces import fit_self_affine, radial_spectrum

GRID = Grid((256, 256), (1e-7, 1e-7), periodic=(True, True))


@pytest.mark.parametrize("hurst", [0.3, 0.8])
@pytest.mark.parametrize("periodic", [True, False])
def test_finds_the_exponent_and_the_rolloff_of_a_generated_surface(hurst, periodic):
    heights = generate_surface(GRID, rms_height=5e-8, seed=3, hurst=hurst, rolloff_wavelength=6.4e-6)
    found = fit_self_affine(radial_spectrum(heights, GRID.spacing, periodic=(periodic, periodic)))
    # the generator's amplitudes have no scatter; the window of a free map mixes neighbouring rings
    assert found.hurst == pytest.approx(hurst, abs=4 * found.hurst_error + 0.005)
    assert found.hurst_error < (0.03 if not periodic else 0.01)
    # the ring is one of 25.6 um / 1, 2, 3 ...: the fourth or one beside it
    assert 25.6e-6 / 5.5 < found.rolloff_wavelength < 25.6e-6 / 2.5
    assert found.misfit < (0.08 if not periodic else 0.02)
    assert found.shortest_wavelength == pytest.approx(4e-7, rel=0.05)


def test_a_cut_off_ends_the_fit_and_a_rise_to_the_longest_waves_has_no_rolloff():
    heights = generate_surface(GRID, rms_height=5e-8, seed=3, hurst=0.5, cutoff_wavelength=1e-6)
    found = fit_self_affine(radial_spectrum(heights, GRID.spacing, periodic=(True, True)))
    assert found.hurst == pytest.approx(0.5, abs=0.02)
    assert found.shortest_wavelength > 0.9e-6
    assert math.isnan(found.rolloff_wavelength)


def test_a_gaussian_autocorrelation_is_not_self_affine():
    heights = generate_surface(GRID, rms_height=5e-8, seed=3, correlation_length=1e-6)
    found = fit_self_affine(radial_spectrum(heights, GRID.spacing, periodic=(True, True)))
    assert found.hurst > 1
    assert found.misfit > 0.2


def test_follows_units():
    heights = generate_surface(GRID, rms_height=5e-8, seed=4, hurst=0.7, rolloff_wavelength=6.4e-6)
    one = fit_self_affine(radial_spectrum(heights, GRID.spacing, periodic=(True, True)))
    other = fit_self_affine(radial_spectrum(1e3 * heights, (1e-4, 1e-4), periodic=(True, True)))
    assert other.hurst == pytest.approx(one.hurst, rel=1e-9)
    assert other.rolloff_wavelength == pytest.approx(1e3 * one.rolloff_wavelength, rel=1e-9)
    q = np.array([1e5, 1e6, 1e7])
    assert one.at(q) == pytest.approx(other.at(1e-3 * q) * 1e-12, rel=1e-9)


def test_refuses_flat_and_small_maps():
    with pytest.raises(InputError, match="rings"):
        fit_self_affine(radial_spectrum(np.zeros((32, 32)), (1e-7, 1e-7)))
    with pytest.raises(InputError, match="at least 6"):
        fit_self_affine(radial_spectrum(np.random.default_rng(0).random((8, 8)), (1e-7, 1e-7)))
