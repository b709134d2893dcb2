"""The waves through the heights of a periodic surface, on the cells of another grid of the same rectangle.

Heights stand at the centres of cells, which lie elsewhere on a finer grid: the waves are moved along. What a surface is
made of does not change with the grid, so that a contact can be solved on several and compared.

Knows arrays. Verified in tests/surfaces/test_surface_waves.py: closed forms, there and back.
"""

from __future__ import annotations

import numpy as np

from bem.grid import FloatArray


def on_cells(heights: FloatArray, shape: tuple[int, int]) -> FloatArray:
    """Heights (nx, ny) of a periodic surface at the centres of the cells of another `shape` of the same rectangle.

    Of an even number of cells the wave of two cells is taken as a cosine about their centres. A coarser grid gets the
    waves that it can hold: those of more than two of its cells. The same shape gives the same bits.
    """
    for axis in (0, 1):
        if heights.shape[axis] != shape[axis]:
            heights = _along(heights, axis, shape[axis])
    return np.ascontiguousarray(heights)


def _along(heights: FloatArray, axis: int, m: int) -> FloatArray:
    """The same along one axis, on so many cells."""
    from scipy import fft  # brings special functions along, and most surfaces are drawn on their own cells

    n = heights.shape[axis]
    waves = np.moveaxis(fft.fft(heights, axis=axis), axis, 0)
    most = (min(n, m) - 1) // 2
    moved = np.zeros((m, waves.shape[1]), dtype=np.complex128)
    number = np.concatenate([np.arange(most + 1), np.arange(-most, 0)])
    moved[number] = waves[number]
    if n % 2 == 0 and m > n:
        moved[n // 2] = moved[m - n // 2] = waves[n // 2] / 2
    # the first centre lies half a cell from the edge
    moved *= np.exp(2j * np.pi * fft.fftfreq(m, 1 / m) * (0.5 / m - 0.5 / n))[:, None]
    return np.moveaxis(fft.ifft(moved, axis=0).real * (m / n), 0, axis)
