"""Self-affine fit: it finds what a surface was generated with, and says where a surface is none."""

import math

import numpy as np
import pytest

from bem import Grid, InputError, Surface, generate_surface
from bem.surfaces import detrend, fit_self_affine, radial_spectrum

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


def drawn_heights(seed, hurst, rolloff, cells, spacing, elongation=1.0):
    """A map cut out of a Gaussian surface of twice its size, drawn by numpy: each wave has an amplitude of its own.

    elongation : by which waves are longer along y than along x.
    """
    rng = np.random.default_rng(seed)
    q = (
        2
        * np.pi
        * np.hypot(np.fft.fftfreq(2 * cells, spacing)[:, None], elongation * np.fft.rfftfreq(2 * cells, spacing))
    )
    amplitude = np.maximum(q * rolloff / (2 * np.pi), 1.0) ** -(1 + hurst)
    noise = rng.standard_normal((2 * cells, 2 * cells))
    return 1e-7 * np.fft.irfft2(np.fft.rfft2(noise) * amplitude, (2 * cells, 2 * cells))[:cells, :cells]


def test_two_thirds_of_drawn_surfaces_lie_within_the_error_of_the_exponent():
    """Bars of 0.015 stood beside a scatter of 0.023: 42 % within one, 75 % within two."""
    spacing = (5e-7, 5e-7)
    off = []
    for seed in range(60):
        heights = detrend(drawn_heights(seed, 0.7, 3e-5, 200, 5e-7), spacing, "plane")
        found = fit_self_affine(radial_spectrum(heights, spacing))
        off.append((found.hurst - 0.7) / found.hurst_error)
    within = [np.mean(np.abs(off) < bars) for bars in (1, 2)]
    assert 0.55 < within[0] < 0.8, "68 % of normal deviates; 60 of them scatter by 6 %"
    assert within[1] > 0.88, "95 %"


def test_a_cut_off_ends_the_fit_and_a_rise_to_the_longest_waves_has_no_rolloff():
    heights = generate_surface(GRID, rms_height=5e-8, seed=3, hurst=0.5, cutoff_wavelength=1e-6)
    found = fit_self_affine(radial_spectrum(heights, GRID.spacing, periodic=(True, True)))
    assert found.hurst == pytest.approx(0.5, abs=0.02)
    assert found.shortest_wavelength > 0.9e-6
    assert math.isnan(found.rolloff_wavelength)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_lay_above_the_flat_part_leaves_no_rolloff(seed):
    """A plateau that the longest waves of a ground surface exceed seven to thirteen times was given as a roll-off."""
    plain = fit_self_affine(radial_spectrum(drawn_heights(seed, 0.7, 1e-5, 128, 5e-7), (5e-7, 5e-7)))
    assert 0.5e-5 < plain.rolloff_wavelength < 2e-5
    assert np.isfinite(plain.at(np.array([1e5, 1e6]))).all()
    found = fit_self_affine(radial_spectrum(drawn_heights(seed, 0.7, 2e-5, 128, 5e-7, elongation=8), (5e-7, 5e-7)))
    assert math.isnan(found.rolloff_wavelength)
    bend = 2 * math.pi / found.longest_wavelength
    np.testing.assert_array_equal(np.isnan(found.at(np.array([0.5, 1, 2]) * bend)), [True, False, False])


def test_nine_of_ten_drawn_surfaces_with_a_plateau_keep_their_rolloff():
    maps = (detrend(drawn_heights(seed, 0.7, 2e-5, 100, 5e-7), (5e-7, 5e-7)) for seed in range(40))
    kept = [math.isfinite(fit_self_affine(radial_spectrum(one, (5e-7, 5e-7))).rolloff_wavelength) for one in maps]
    assert sum(kept) >= 36


def test_a_surface_in_place_of_its_spectrum_is_refused_with_what_to_give():
    surface = Surface(drawn_heights(0, 0.7, 1e-5, 64, 5e-7), (5e-7, 5e-7))
    with pytest.raises(InputError, match=r"Surface is no spectrum; give radial_spectrum\(surface\)"):
        fit_self_affine(surface)
    assert fit_self_affine(radial_spectrum(surface)) == fit_self_affine(
        radial_spectrum(surface.heights, surface.spacing)
    )


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
