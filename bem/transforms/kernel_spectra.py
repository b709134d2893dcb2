"""Spectra of kernels that are even or odd along each axis, from a quarter of their values."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.numerics.blocks import row_blocks
from bem.transforms.count import COUNT

FloatArray = NDArray[Any]


def kernel_spectrum(
    coefficients: FloatArray,
    padded: tuple[int, int],
    parity: tuple[int, int],
    lengths: tuple[int, ...] | None = None,
) -> FloatArray:
    """Return the spectrum of a kernel that is even (+1) or odd (-1) along each axis, from its non-negative offsets.

    Parameters
    ----------
    coefficients : (mx, my), value at offset (i, j); at -i it is parity_x times that, likewise along y. Offsets beyond
        half the padded length are ignored (a periodic axis repeats them), missing ones are zero.
    padded : (px, py), lengths of the transform.
    parity : (+-1, +-1).
    lengths : (py // 2 + 1,), of the transforms along x for each wavenumber along y; px for all by default.

    Returns
    -------
    (py // 2 + 1, px // 2 + 1), real, in double precision; zero beyond half of a shorter length. The true spectrum is
    this times i for each odd axis (a factor -1 if both are), and at px - k it is parity_x times that at k.
    """
    result = np.ascontiguousarray(half_spectrum(coefficients, padded[1], parity[1]).T)
    COUNT.kernels += 1
    if lengths is None:
        return np.ascontiguousarray(half_spectrum(result, padded[0], parity[0]))
    narrow = np.zeros((len(lengths), padded[0] // 2 + 1))
    for length in set(lengths):
        rows = np.array(lengths) == length
        narrow[rows, : length // 2 + 1] = half_spectrum(result[rows], length, parity[0])
    return narrow


def offset_cosines(length: int, offsets: NDArray[np.int64]) -> FloatArray:
    """Return the matrix of the inverse transform of an even spectrum at a few offsets: (offsets, length // 2 + 1).

    It multiplies the spectrum at the non-negative wavenumbers.
    """
    wavenumbers = np.arange(length // 2 + 1)
    weights = np.where((wavenumbers == 0) | (2 * wavenumbers == length), 1.0, 2.0) / length
    return np.asarray(weights * np.cos(2 * np.pi / length * (np.outer(offsets, wavenumbers) % length)))


def half_spectrum(values: FloatArray, length: int, parity: int) -> FloatArray:
    """Return the transform along the last axis of even (odd) sequences from half of each: real (imaginary) part.

    values : (rows, m), at the non-negative offsets. Returns (rows, length // 2 + 1).
    """
    half = length // 2 + 1
    given = min(half, values.shape[1])
    result = np.empty((values.shape[0], half))
    for first, last in row_blocks((values.shape[0], length)):
        whole = np.zeros((last - first, length))
        whole[:, :given] = values[first:last, :given]
        if parity == -1:  # zero at offset zero, and at half a period
            whole[:, 0] = 0
            if length % 2 == 0:
                whole[:, length // 2] = 0
        whole[:, half:] = parity * whole[:, length - half : 0 : -1]
        spectrum = np.fft.rfft(whole, axis=1)
        result[first:last] = spectrum.real if parity == 1 else spectrum.imag
    return result
