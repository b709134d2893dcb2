"""Rough heights that know nothing of the package: waves of a self-affine spectrum with random phases."""

import numpy as np


def self_affine(nx, ny, rng, hurst=0.8, rolloff=2.0, rms=1.0):
    """Heights of that rms down to the cell, with a spectrum that is flat below `rolloff` waves a side."""
    k = np.hypot(np.fft.fftfreq(nx, 1 / nx)[:, None], np.fft.rfftfreq(ny, 1 / ny)[None, :])
    amplitude = np.maximum(k, rolloff) ** (-(1 + hurst))
    amplitude[0, 0] = 0
    heights = np.fft.irfft2(amplitude * np.fft.rfft2(rng.standard_normal((nx, ny))), s=(nx, ny))
    return rms * heights / heights.std()
