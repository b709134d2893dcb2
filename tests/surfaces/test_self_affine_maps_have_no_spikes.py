"""Spikes of an instrument: none in self-affine Gaussian maps, and spots of up to three points a side."""

import numpy as np
import pytest

from bem import Grid, generate_surface
from bem.surfaces.spikes import count_spikes, despike

CELLS = 320
SPACING = (1e-6, 1e-6)


def self_affine(hurst: float, longest: float, shortest: float, seed: int) -> np.ndarray:
    """A quarter of a periodic Gaussian map, so that its edges do not meet; waves in points, flat above `longest`."""
    frequency = np.fft.fftfreq(2 * CELLS)
    size = np.hypot(frequency[:, None], frequency[None, :])
    amplitude = np.maximum(size, 1 / longest) ** -(1 + hurst) * (size <= 1 / shortest)
    noise = np.fft.fft2(np.random.default_rng(seed).standard_normal(size.shape))
    return 1e-7 * np.fft.ifft2(noise * amplitude).real[:CELLS, :CELLS] / amplitude.std()


@pytest.mark.parametrize("hurst", [0.5, 0.75, 1.0])
@pytest.mark.parametrize(("longest", "shortest"), [(16, 1), (16, 3), (1000, 1), (1000, 2), (1000, 5), (100, 10)])
def test_self_affine_maps_raise_no_alarm(hurst, longest, shortest):
    """None of 100,000 points, where one in 10,000 would do; of 3.7 million points a threshold of 4 took three."""
    assert count_spikes(self_affine(hurst, longest, shortest, seed=round(10 * hurst)), SPACING) == 0


SURFACE = generate_surface(
    Grid((96, 96), SPACING, periodic=(True, True)), rms_height=1e-7, seed=1, correlation_length=4e-6
)


@pytest.mark.parametrize(("along", "across"), [(1, 1), (1, 3), (2, 2), (3, 2), (3, 3), (1, 4), (4, 1), (3, 4), (4, 4)])
def test_spots_are_found_up_to_three_points_in_every_direction(along, across):
    """The median of seven points on a line is that of the spot from four points on: what the documentation says."""
    spot = np.zeros((96, 96), dtype=bool)
    spot[40 : 40 + along, 50 : 50 + across] = True
    found = np.isnan(despike(SURFACE + np.where(spot, 2e-6, 0.0), SPACING))
    np.testing.assert_array_equal(found, spot if max(along, across) <= 3 else np.zeros_like(spot))
