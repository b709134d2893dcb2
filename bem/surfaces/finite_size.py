"""Standard errors of rms height and rms slope by the finite size of a map.

A map is one cut-out of a surface; another place would give another Sq and Sdq. Knows heights and spacing alone.
Verified in tests/surfaces/test_finite_size.py on cut-outs of random surfaces: coverage of one and two standard errors.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.grid import FloatArray
from bem.surfaces.surface import Surface, check_map, spacing_of

FEWEST_PATCHES = 150
"""Independent patches below which waves as long as the map decide its rms height: of maps with an exponential
autocorrelation, larger ones then have an Sq that is larger by more than half a standard error."""
_FEWEST_CELLS = 8
"""Cells along the shorter axis that an estimate needs at least."""


@dataclass(frozen=True)
class FiniteSizeError:
    """Standard errors of a map by its finite size; nan for flat maps and those of fewer than eight cells along an axis.

    Attributes
    ----------
    Sq : of the rms height [m], with the waves that levelling takes.
    Sdq : of the rms slope.
    patches, slope_patches : independent patches of the map, by heights and by slopes: relative error 1 / sqrt(2 N).
    """

    Sq: float
    Sdq: float
    patches: float
    slope_patches: float


def finite_size_error(
    heights: FloatArray | Surface, spacing: tuple[float, float] | None = None, *, removed: int = 3
) -> FiniteSizeError:
    """Estimate the standard errors of Sq and Sdq: the scatter of maps of this size at other places of the surface.

    The variance of the mean square of a Gaussian field is 2 C0^2 / N, with N the area over the integral of the squared
    autocorrelation (Bendat and Piersol, Random Data, 4th ed. 2010, section 8.4; restated from memory). By Parseval's
    theorem it is the sum of the squared spectrum, which the squares of the map's own periodogram overestimate twofold.
    Other distributions of height change it by (Sku - 1) / 2, those of slope likewise. If the squared heights or slopes
    themselves vary more along the map than that, by the power of their longest waves, this counts: deep valleys
    gather slopes. Levelling takes as many waves as it has parameters; the power of the longest waves says how much of
    Sq they had.

    Waves longer than the map are in no map of this size and in no error.

    Parameters
    ----------
    heights : (nx, ny) [m], levelled.
    spacing : of the points along x and y [m]; that of the surface where a `Surface` is given.
    removed : parameters of the form that was removed: 1 mean, 3 plane, 6 second-order polynomial.

    Raises
    ------
    InputError : heights that are not a finite map, spacings that are not positive.
    """
    heights, spacing = check_map(heights, spacing_of(heights, spacing))
    deviation = heights - heights.mean()
    variance = float(np.mean(deviation**2))
    if min(heights.shape) < _FEWEST_CELLS or not variance > 0:
        return FiniteSizeError(math.nan, math.nan, math.nan, math.nan)
    power = _power(deviation)
    of_heights = _relative_variance(power) * max((float(np.mean(deviation**4)) / variance**2 - 1) / 2, 0.0)
    of_heights = max(of_heights, _power_of_longest(_power(deviation**2), 2) / variance**2)
    lost = 0.5 * removed * max(_power_of_longest(power, 1), _power_of_longest(power, 2)) / float(power.sum())
    along_x = np.diff(deviation, axis=0)[:, :-1] / spacing[0]
    along_y = np.diff(deviation, axis=1)[:-1, :] / spacing[1]
    square = along_x**2 + along_y**2
    mean = float(square.mean())
    slopes = np.cov(along_x.ravel(), along_y.ravel(), bias=True)
    gaussian = 2 * float(np.sum(slopes**2)) / float(np.trace(slopes)) ** 2
    of_slopes = _relative_variance(_power(along_x) + _power(along_y)) * float(square.var()) / (mean**2 * gaussian)
    of_slopes = max(of_slopes, _power_of_longest(_power(square), 2) / mean**2)
    return FiniteSizeError(
        Sq=math.sqrt(variance) * math.hypot(0.5 * math.sqrt(of_heights), lost),
        Sdq=math.sqrt(mean) * 0.5 * math.sqrt(of_slopes),
        patches=2 / of_heights if of_heights > 0 else math.inf,
        slope_patches=2 / of_slopes if of_slopes > 0 else math.inf,
    )


def _power(field: FloatArray) -> FloatArray:
    """Return the periodogram of a field (nx, ny) about its mean; its sum is the variance."""
    return np.asarray(np.abs(np.fft.fft2(field - field.mean())) ** 2 / field.size**2)


def _relative_variance(power: FloatArray) -> float:
    """Return the variance of the mean square of a Gaussian field over the square of its mean."""
    return float(np.sum(power**2)) / float(power.sum()) ** 2


def _power_of_longest(power: FloatArray, shortest: int) -> float:
    """Return the mean power of the waves that fit once to `shortest` times along the map."""
    numbers = [np.minimum(np.arange(n), n - np.arange(n)) for n in power.shape]
    ring = np.maximum(numbers[0][:, None], numbers[1][None, :])
    return float(power[(ring >= 1) & (ring <= shortest)].mean())
