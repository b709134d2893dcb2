"""Lengths of padded transforms.

Free axis of n cells: the transform has at least 2 n - 1 entries, an even number, so that a convolution does not wrap; a
single cell is not padded. Periodic axis: no padding.

A wave exp(i k y) along a periodic y needs less along a free x (`narrowed_lengths`): outside the loaded cell a
half-space responds with exp(-k |x|) times a low power of k x, because its displacements are harmonic or biharmonic in
(x, z) with the wavenumber k. The transform of the wave is padded only to the distance at which its kernel is below
round-off. Stresses (`bem.stress`) use these lengths; the displacement operator pads all waves alike.
"""

from __future__ import annotations

from functools import lru_cache

from bem.numerics.fast_length import fast_length

_ROUND_OFF_EXPONENT = 40.0
"""Decay exponent at which a kernel is below round-off: exp(-40) = 4e-18, times powers of k x of at most about 40."""
_FAST = [*(factor << power for power in range(3, 16) for factor in (1, 5, 7, 25)), 280]
"""Lengths at which FFTW's plans without timing are about as fast per point as for powers of two."""


def padded_length(cells: int, periodic: bool) -> int:
    """Return the length of the transform along an axis: an even fast length >= 2 cells - 1, or `cells` without padding.

    Periodic axes and single cells are not padded. A power of two is taken where it is at most 10 % longer for 512, 3 %
    beyond: FFTW's plans without timing are fastest there.
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
    """Return the lengths of the transforms along x for each wavenumber along a periodic y, for half-space kernels.

    Parameters
    ----------
    cells : nx of the field.
    padded : (px, py), lengths of the transforms; py is the period, and px >= 2 nx - 1.
    decay : 2 pi spacing_x / (py spacing_y), the decay exponent of the first wave across one cell along x.

    Returns
    -------
    (py // 2 + 1,), never rising, at most px. Each length is at least nx, plus `_ROUND_OFF_EXPONENT` over the decay
    exponent of the wave (the range of its kernel), plus one cell for the load.
    """
    lengths = [padded[0]]
    for wave in range(1, padded[1] // 2 + 1):
        needed = cells + _ROUND_OFF_EXPONENT / (wave * decay) + 1
        lengths.append(min([lengths[-1], *(fast for fast in _FAST if fast >= needed)]))
    return tuple(lengths)
