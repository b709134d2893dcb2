"""Shorter transforms along a free axis for the waves of a periodic one, whose kernels fall off exponentially.

Outside the loaded cell, what a half-space does under a load exp(i k y) falls along x like exp(-k |x|) times a low power
of k x: it is harmonic or biharmonic in (x, z) with the wavenumber k. A wave's transform need not be padded by a whole
field then, only by the distance at which its kernel is lost beside the largest value in double precision.
"""

from __future__ import annotations

from functools import lru_cache

_LOST = 40.0
"""exp(-40) = 4e-18: with the powers of k x, at most some 40, less than half of a double's last digit."""
_FAST = [*(factor << power for power in range(3, 16) for factor in (1, 5, 7, 25)), 280]
"""Lengths at which plans that FFTW makes without timing are about as good a point as for powers of two."""


@lru_cache(maxsize=64)
def narrowed_lengths(cells: int, padded: tuple[int, int], decay: float) -> tuple[int, ...]:
    """Lengths of the transforms along x of a half-space's kernels, for each wavenumber along a periodic y.

    Parameters
    ----------
    cells : nx of the field.
    padded : (px, py), lengths of the transforms; py is the period, and px >= 2 nx - 1.
    decay : 2 pi spacing_x / (py spacing_y): how far the first wave falls in a cell along x.

    Returns
    -------
    (py // 2 + 1,), never rising, px at most: each at least nx and the reach of its kernel, which is `_LOST` over its
    decay and a cell, the load's own.
    """
    lengths = [padded[0]]
    for wave in range(1, padded[1] // 2 + 1):
        needed = cells + _LOST / (wave * decay) + 1
        lengths.append(min([lengths[-1], *(fast for fast in _FAST if fast >= needed)]))
    return tuple(lengths)
