"""Standard errors by the finite size of a map: coverage on cut-outs of random surfaces, closed forms, invariances."""

import math

import numpy as np
import pytest

from bem.errors import InputError
from bem.surfaces import Surface, finite_size_error
from bem.surfaces.filter import detrend

N = 64
"""Cells of a cut-out along an axis."""


def random_field(shape, density, seed):
    """White Gaussian noise through the square root of a spectral density of angular wavenumbers along x and y."""
    kx, ky = (2 * np.pi * np.fft.fftfreq(n) for n in shape)
    squares = density(kx[:, None], ky[None, :])
    squares[0, 0] = 0.0
    noise = np.random.default_rng(seed).normal(size=shape)
    field = np.fft.ifft2(np.fft.fft2(noise) * np.sqrt(squares)).real
    return field / math.sqrt(squares.sum() / math.prod(shape))  # expected variance 1


def gaussian(length, ratio=1.0):
    """Autocorrelation exp(-(x / length)^2 - (y / (ratio length))^2)."""
    return lambda kx, ky: np.exp(-((kx * length) ** 2 + (ratio * ky * length) ** 2) / 4)


def self_affine(rolloff):
    """Hurst exponent 0.8 between a roll-off wavelength and four cells."""
    q = 2 * np.pi / rolloff

    def density(kx, ky):
        size = np.hypot(kx, ky)
        return np.where(size > np.pi / 2, 0.0, np.maximum(size, q) ** -3.6)

    return density


def cut_outs(density, change=lambda z: z):
    """200 levelled cut-outs, one correlation length and more apart, as Sq, Sdq and their errors."""
    found = []
    for seed in range(13):
        field = change(random_field((512, 512), density, seed))
        for i in range(0, 512, 2 * N):
            for j in range(0, 512, 2 * N):
                heights = detrend(field[i : i + N, j : j + N], (1.0, 1.0), "plane")
                error = finite_size_error(heights, (1.0, 1.0))
                slope = math.sqrt(np.mean(np.diff(heights, axis=0) ** 2) + np.mean(np.diff(heights, axis=1) ** 2))
                found.append((heights.std(), error.Sq, slope, error.Sdq))
    return np.array(found[:200])


@pytest.mark.parametrize(
    ("density", "change"),
    [
        (gaussian(3.5), lambda z: z),
        (gaussian(2.0, ratio=3.0), lambda z: z),
        (self_affine(16.0), lambda z: z),
        (gaussian(3.5), lambda z: np.exp(0.4 * z)),  # skewness 1.3, kurtosis 6
    ],
    ids=["gaussian", "ridged", "self-affine", "skewed"],
)
def test_200_cut_outs_scatter_as_their_errors_say(density, change):
    """One and two standard errors about the mean of all hold 68 and 95 %; of 200 draws within 3 sigma, 10 and 5 %."""
    draws = cut_outs(density, change)
    for value, error in ((draws[:, 0], draws[:, 1]), (draws[:, 2], draws[:, 3])):
        deviation = np.abs(value - value.mean()) / error
        assert np.mean(deviation < 1) == pytest.approx(0.68, abs=0.10)
        assert np.mean(deviation < 2) == pytest.approx(0.95, abs=0.05)
        assert np.sqrt(np.mean(error**2)) == pytest.approx(value.std(), rel=0.2)


def test_patches_of_a_gaussian_autocorrelation():
    """The integral of exp(-2 r^2 / l^2) is pi l^2 / 2; the mean of 20 maps of 128 l^2 / pi patches within 10 %."""
    found = [finite_size_error(random_field((160, 160), gaussian(5.0), seed), (1.0, 1.0)).patches for seed in range(20)]
    assert np.mean(found) == pytest.approx(160**2 / (np.pi * 25 / 2), rel=0.1)


def test_units_and_scale_change_nothing_but_the_unit():
    heights = random_field((64, 48), gaussian(4.0), 1)
    plain = finite_size_error(heights, (1.0, 1.0))
    small = finite_size_error(Surface(1e-7 * heights, (1e-6, 1e-6), {}))
    assert small.Sq == pytest.approx(1e-7 * plain.Sq, rel=1e-10, abs=0)
    assert small.Sdq == pytest.approx(0.1 * plain.Sdq, rel=1e-10)
    assert (small.patches, small.slope_patches) == pytest.approx((plain.patches, plain.slope_patches), rel=1e-9)
    turned = finite_size_error(heights.T, (1.0, 1.0))
    assert (turned.Sq, turned.Sdq) == pytest.approx((plain.Sq, plain.Sdq), rel=1e-10)


def test_flat_and_tiny_maps_have_none():
    for heights in (np.zeros((32, 32)), random_field((4, 64), gaussian(1.0), 0)):
        assert math.isnan(finite_size_error(heights, (1.0, 1.0)).Sq)
    with pytest.raises(InputError):
        finite_size_error(np.full((32, 32), np.nan), (1.0, 1.0))
