"""Make a map periodic without a step where its ends meet.

The periodic component of L. Moisan, "Periodic plus smooth image decomposition", *J. Math. Imaging Vis.* 39 (2011) 161:
the surface less a smooth one that takes up the steps between opposite edges. With `v` the steps (at the cells on
either side of a seam, zero elsewhere), the smooth part solves `Laplacian s = v` with the Laplacian of the wrapped
cells; across the seam the rest is then as rough as elsewhere. Only what lies within a wavelength of a seam changes
much: a wave along the seam decays into the map as exp(-2 pi distance / wavelength).

Verified in tests/surfaces/test_seams.py.
"""

from __future__ import annotations

import numpy as np
import scipy.fft as fft

from bem.grid import FloatArray
from bem.surfaces.surface import Surface


def close_seams(surface: Surface, *, axes: tuple[bool, bool] = (True, True)) -> Surface:
    """The surface made periodic along `axes`, with as many cells as before.

    `metadata["seams_closed"]` says how much that changed, as rms [m] over the map.
    """
    heights = surface.heights
    smooth = np.zeros_like(heights)
    wraps = tuple(bool(wanted) and n > 2 for wanted, n in zip(axes, heights.shape, strict=True))
    if any(wraps):
        smooth = _smooth_part(heights, surface.spacing, (wraps[0], wraps[1]))
    return surface.replace(heights - smooth, seams_closed=float(np.sqrt(np.mean(smooth**2))))


def _smooth_part(heights: FloatArray, spacing: tuple[float, float], wraps: tuple[bool, bool]) -> FloatArray:
    """Of zero mean [m]: five-point Laplacian, wrapped along `wraps`, mirrored at the edges along the other axis."""
    steps = np.zeros_like(heights)
    symbol = np.zeros(heights.shape)
    for axis in (0, 1):
        n, weight = heights.shape[axis], spacing[axis] ** -2
        if wraps[axis]:
            first, last = heights.take(0, axis=axis), heights.take(-1, axis=axis)
            at = [slice(None), slice(None)]
            at[axis] = slice(0, 1)
            steps[tuple(at)] += weight * np.expand_dims(last - first, axis)
            at[axis] = slice(n - 1, n)
            steps[tuple(at)] += weight * np.expand_dims(first - last, axis)
            angle = 2 * np.pi * np.arange(n) / n
        else:
            angle = np.pi * np.arange(n) / n
        symbol = symbol + np.expand_dims(weight * (2 * np.cos(angle) - 2), 1 - axis)
    waves: np.ndarray = steps
    for axis in (0, 1):  # real cosines first: the other transform makes the values complex
        if not wraps[axis]:
            waves = fft.dct(waves, axis=axis)
    for axis in (0, 1):
        if wraps[axis]:
            waves = fft.fft(waves, axis=axis)
    symbol[0, 0] = 1.0
    waves = waves / symbol
    waves[0, 0] = 0.0
    for axis in (0, 1):
        if wraps[axis]:
            waves = fft.ifft(waves, axis=axis)
    smooth: np.ndarray = np.real(waves)
    for axis in (0, 1):
        if not wraps[axis]:
            smooth = fft.idct(smooth, axis=axis)
    return np.ascontiguousarray(smooth)
