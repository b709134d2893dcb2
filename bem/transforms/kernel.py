"""Padded lengths of transforms, and spectra of even and odd kernels from a quarter of their values.

Padding: the transform along a free axis is at least twice as long as the field, so that a convolution does not wrap. A
wave exp(i k y) along a periodic y needs less along a free x (`narrowed_lengths`): outside the loaded cell a half-space
responds with exp(-k |x|) times a low power of k x, because its displacements are harmonic or biharmonic in (x, z) with
the wavenumber k. The transform of the wave is padded only to the distance at which its kernel falls below round-off.
"""

from __future__ import annotations

from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.numerics.blocks import row_blocks
from bem.numerics.fast_length import fast_length
from bem.transforms.count import COUNT

FloatArray = NDArray[Any]

_LOST = 40.0
"""Decay exponent at which a kernel is below round-off: exp(-40) = 4e-18, times powers of k x of at most about 40."""
_FAST = [*(factor << power for power in range(3, 16) for factor in (1, 5, 7, 25)), 280]
"""Lengths at which FFTW's plans without timing are about as fast per point as for powers of two."""


def padded_length(cells: int, periodic: bool) -> int:
    """Return the length of the transform along an axis: `cells` if periodic, else an even fast length >= 2 cells - 1.

    A power of two is taken where it is at most 10 % longer for 512, 3 % beyond: FFTW's plans without timing are fastest
    there.
    """
    if periodic or cells == 1:
        return cells
    fast = 2 * fast_length(cells)
    power = 1 << (fast - 1).bit_length()
    return power if power >= 512 and power <= (1.1 if power == 512 else 1.03) * fast else fast


def padded_shape(cells: tuple[int, int], periodic: tuple[bool, bool]) -> tuple[int, int]:
    """Return `padded_length` of both axes."""
    return padded_length(cells[0], periodic[0]), padded_length(cells[1], periodic[1])


@lru_cache(maxsize=64)
def narrowed_lengths(cells: int, padded: tuple[int, int], decay: float) -> tuple[int, ...]:
    """Return the lengths of the transforms along x of a half-space's kernels, for each wavenumber along a periodic y.

    Parameters
    ----------
    cells : nx of the field.
    padded : (px, py), lengths of the transforms; py is the period, and px >= 2 nx - 1.
    decay : 2 pi spacing_x / (py spacing_y), the decay exponent of the first wave across one cell along x.

    Returns
    -------
    (py // 2 + 1,), never rising, at most px: each at least nx and the range of its kernel, which is `_LOST` over its
    decay exponent and one cell for the load.
    """
    lengths = [padded[0]]
    for wave in range(1, padded[1] // 2 + 1):
        needed = cells + _LOST / (wave * decay) + 1
        lengths.append(min([lengths[-1], *(fast for fast in _FAST if fast >= needed)]))
    return tuple(lengths)


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
    """Return the matrix (offsets, wavenumbers) of the inverse transform of an even spectrum at a few offsets.

    Its columns belong to the non-negative wavenumbers.
    """
    wavenumbers = np.arange(length // 2 + 1)
    weights = np.where((wavenumbers == 0) | (2 * wavenumbers == length), 1.0, 2.0) / length
    return np.asarray(weights * np.cos(2 * np.pi / length * (np.outer(offsets, wavenumbers) % length)))


def _half_spectrum(values: FloatArray, length: int, parity: int) -> FloatArray:
    """Return the real (even) or imaginary (odd) part of the transform along the last axis from half a sequence."""
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
