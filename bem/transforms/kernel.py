"""Padded lengths, and spectra of even and odd kernels from a quarter of their values."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.numerics.blocks import row_blocks
from bem.numerics.fast_length import fast_length
from bem.transforms.count import COUNT

FloatArray = NDArray[Any]


def padded_length(cells: int, periodic: bool) -> int:
    """Length of the transform along an axis: the axis itself if periodic, else an even fast length >= 2 cells - 1.

    A power of two serves where it is little longer, since plans made without timing are so much better for it: up to a
    tenth for 512, up to 3 % beyond. Measured, a convolution of 240 cells along x gains a seventh with 512 for 480, of
    500 or 1000 cells a tenth to a third; 1024 for 960 would lose.
    """
    if periodic or cells == 1:
        return cells
    fast = 2 * fast_length(cells)
    power = 1 << (fast - 1).bit_length()
    return power if power >= 512 and power <= (1.1 if power == 512 else 1.03) * fast else fast


def padded_shape(cells: tuple[int, int], periodic: tuple[bool, bool]) -> tuple[int, int]:
    """As `padded_length`, of both axes."""
    return padded_length(cells[0], periodic[0]), padded_length(cells[1], periodic[1])


def kernel_spectrum(
    coefficients: FloatArray,
    padded: tuple[int, int],
    parity: tuple[int, int],
    lengths: tuple[int, ...] | None = None,
) -> FloatArray:
    """Spectrum of a kernel that is even (+1) or odd (-1) along each axis, from its non-negative offsets only.

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
    result = np.ascontiguousarray(_half_spectrum(coefficients, padded[1], parity[1]).T)
    COUNT.kernels += 1
    if lengths is None:
        return np.ascontiguousarray(_half_spectrum(result, padded[0], parity[0]))
    narrow = np.zeros((len(lengths), padded[0] // 2 + 1))
    for length in set(lengths):
        rows = np.array(lengths) == length
        narrow[rows, : length // 2 + 1] = _half_spectrum(result[rows], length, parity[0])
    return narrow


def offset_cosines(length: int, offsets: NDArray[np.int64]) -> FloatArray:
    """Inverse transform of an even spectrum at a few offsets, from non-negative wavenumbers: (offsets, wavenumbers)."""
    wavenumbers = np.arange(length // 2 + 1)
    weights = np.where((wavenumbers == 0) | (2 * wavenumbers == length), 1.0, 2.0) / length
    return np.asarray(weights * np.cos(2 * np.pi / length * (np.outer(offsets, wavenumbers) % length)))


def _half_spectrum(values: FloatArray, length: int, parity: int) -> FloatArray:
    """Real or imaginary part of the transform along the last axis of an even or odd sequence, from its first half."""
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
