"""Colours of films as optical interferometry shows them."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

_INDEX = 1.5
"""Refractive index of oils."""
_FRINGES = 5
"""After which they fade: light is never of one colour."""
_LIGHT = (630e-9, 532e-9, 465e-9)
"""Wavelengths of red, green and blue [m]."""
_DOTS = 700
"""Fewest dots of an interferogram along each axis."""
_SHADES = 1 << 14
"""Entries of a table of colours up to where fringes have faded: neighbours differ by less than one of 255."""
_FADED = 3.0
"""Times `_FRINGES` of the longest wave, where the light is what it stays."""


def colours_of(thickness: NDArray[np.float64]) -> NDArray[np.float64]:
    """Red, green and blue (..., 3) of two beams reflected at both sides of a film [m], dark where it vanishes."""
    phase = 4 * np.pi * _INDEX * thickness[..., None] / np.array(_LIGHT)
    return np.asarray(0.5 * (1 - np.exp(-((phase / (2 * np.pi * _FRINGES)) ** 2)) * np.cos(phase)))


def _finely(thickness: NDArray[np.float64], dots: int) -> NDArray[np.float64]:
    """Interpolated to so many dots that fringes are not made of cells."""
    for axis in (0, 1):
        n = thickness.shape[axis]
        at = np.linspace(0, n - 1, max(n, dots))
        low = np.minimum(at.astype(int), n - 2)
        first, second = np.take(thickness, low, axis), np.take(thickness, low + 1, axis)
        share = np.moveaxis((at - low).reshape(-1, 1), 0, axis)
        thickness = first + share * (second - first)
    return thickness


def finely_coloured(thickness: NDArray[np.float64], dots: int = _DOTS) -> NDArray[np.uint8]:
    """Colours (.., .., 3), of 255, of a film (nx, ny) [m], on more dots than it has cells."""
    step = _FADED * _FRINGES * _LIGHT[0] / (2 * _INDEX) / (_SHADES - 1)
    shade = np.fmax(np.fmin(_finely(thickness / step, dots) + 0.5, _SHADES - 1), 0.0)
    return _shades(step)[shade.astype(np.int64)]


@cache
def _shades(step: float) -> NDArray[np.uint8]:
    """Colours (_SHADES, 3) of films that each are thicker than the one before by a step [m]."""
    return (255 * colours_of(np.arange(_SHADES) * np.float64(step))).astype(np.uint8)
