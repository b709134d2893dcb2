"""Self-affine spectrum fitted to the measured one of a surface: Hurst exponent, roll-off wavelength, misfit.

Takes a `RadialSpectrum` of `describe`. Verified in tests/surfaces/test_self_affine.py on surfaces generated with a
known exponent and roll-off.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.surfaces.describe import RadialSpectrum, radial_spectrum

_SHORTEST = 0.5
"""Upper end of the fit as a fraction of the highest wavenumber: above it, instruments filter and cells alias."""
_LEAST_DENSITY = 1e-12
"""Densities below this fraction of the highest are round-off or a filter, and end the fit."""
_FEWEST_RINGS = 6
"""Rings that the sloping part of the fit needs at least."""
_RISE = 6.0
"""Standard deviations by which the longest waves may lie above the flat part of the fit: 1 % of 600 drawn surfaces with
a plateau exceeded it (squared amplitudes of few waves are chi squared)."""


@dataclass(frozen=True)
class SelfAffineFit:
    """Spectrum C0 below the roll-off wavenumber q_r and C0 (q / q_r)^(-2 (1 + H)) above it, fitted to a measured one.

    Attributes
    ----------
    hurst : H; outside 0 to 1 the surface is not self-affine.
    hurst_error : its standard error: the standard deviation over maps of this size at other places of the surface.
    rolloff_wavelength : 2 pi / q_r [m]; nan without a flat part: if the spectrum rises up to the longest waves of the
        map, or the longest waves lie well above the part that was fitted as flat.
    shortest_wavelength, longest_wavelength : range of the sloping part [m].
    misfit : rms deviation of the measured density from the fit, in decades, over the range of the fit.
    density : C0 [m^4].
    """

    hurst: float
    hurst_error: float
    rolloff_wavelength: float
    shortest_wavelength: float
    longest_wavelength: float
    misfit: float
    density: float

    @property
    def is_self_affine(self) -> bool:
        """Return True if the spectrum falls by a power from -2 to -4: a Hurst exponent between 0 and 1.

        Gaussian autocorrelations and filters leave steeper spectra, which are no power law, white noise a flat one.
        """
        return 0 < self.hurst < 1

    def at(self, wavenumber: FloatArray) -> FloatArray:
        """Return the fitted density [m^4] at wavenumbers [rad/m]; nan at longer waves than were fitted."""
        bend = 2 * math.pi / self.longest_wavelength
        fitted = self.density * (np.maximum(wavenumber, bend) / bend) ** (-2 * (1 + self.hurst))
        beyond = math.isnan(self.rolloff_wavelength) & (np.asarray(wavenumber) < bend * (1 - 1e-9))
        return np.asarray(np.where(beyond, math.nan, fitted))


def self_affine_fit_of_map(
    heights: FloatArray, spacing: tuple[float, float], *, periodic: tuple[bool, bool] = (False, False)
) -> SelfAffineFit | None:
    """Return the self-affine fit of the spectrum of a map; None of maps that are too small or too smooth for one.

    heights : (nx, ny) [m], without holes. spacing : of the cells along x and y [m].
    """
    try:
        return fit_self_affine(radial_spectrum(heights, spacing, periodic=periodic))
    except InputError:
        return None


def fit_self_affine(spectrum: RadialSpectrum) -> SelfAffineFit:
    """Fit a self-affine spectrum with a flat part below the roll-off by least squares of the logarithm.

    A ring of m waves has a density that scatters by 1 / sqrt(m); half the waves of a ring mirror the others. Rings are
    weighted with m. For each ring as the bend the two constants follow from a linear system; the bend of the least
    squares is taken. Waves shorter than four cells are left out, and those that a filter has removed. Where the
    longest waves lie well above the flat part, as of waviness or grooves, it is no plateau: there is no roll-off.

    Raises
    ------
    InputError : too few rings for a slope, a flat surface, or something else than a spectrum.
    """
    if not hasattr(spectrum, "wavenumber"):
        raise InputError(
            f"fit_self_affine: {type(spectrum).__name__} is no spectrum; give radial_spectrum(surface), or "
            "radial_spectrum(heights, spacing)"
        )
    q, density = spectrum.wavenumber, spectrum.density
    highest = float(density.max(initial=0.0))
    used = (q <= _SHORTEST * q.max(initial=0.0)) & (density > _LEAST_DENSITY * highest)
    if not used.all():
        # a filter takes all waves beyond its cut-off: the fit ends before the ring that it cuts through
        used[max(int(np.argmin(used)) - 1, 0) :] = False
    q, density, weight = q[used], density[used], spectrum.modes[used]
    if q.size < _FEWEST_RINGS or highest == 0.0:
        raise InputError(f"spectrum: {q.size} rings of waves must be at least {_FEWEST_RINGS} for a self-affine fit")
    x, y = np.log(q), np.log(density)
    best = min(range(q.size - _FEWEST_RINGS + 1), key=lambda bend: _bent_line(x, y, weight, bend)[2])
    level, slope, squares = _bent_line(x, y, weight, best)
    steep = np.maximum(x - x[best], 0.0)
    residual = y - (level + slope * steep)
    scatter = 2 * spectrum.ring_correlation
    flat = best > 0 and not _rises(density[:best] / math.exp(level), weight[:best], scatter)
    return SelfAffineFit(
        hurst=-slope / 2 - 1,
        hurst_error=_slope_error(x, weight, best, slope, squares, spectrum.ring_correlation) / 2,
        rolloff_wavelength=float(2 * math.pi / q[best]) if flat else math.nan,
        shortest_wavelength=float(2 * math.pi / q[-1]),
        longest_wavelength=float(2 * math.pi / q[best]),
        misfit=float(np.sqrt(np.average(residual**2, weights=weight))) / math.log(10),
        density=math.exp(level),
    )


def _rises(ratio: FloatArray, weight: FloatArray, scatter: float) -> bool:
    """Return True if the longest waves lie well above the flat part of a fit.

    ratio : densities of the rings beyond the bend over that of the flat part, longest waves first. weight : their
    waves. scatter : variance of a mean of these ratios times its number of waves.
    """
    waves = np.cumsum(weight)
    means = np.cumsum(weight * ratio) / waves
    return bool(np.any(means > 1 + _RISE * np.sqrt(scatter / waves)))


def _slope_error(
    x: FloatArray, weight: FloatArray, bend: int, slope: float, squares: float, correlation: float
) -> float:
    """Return the standard error of the slope of the bent line, from the scatter of the rings about it.

    Level, slope and bend are fitted together: the covariance of least squares linearised in all three. Rings that a
    window correlates count as fewer independent ones: the variance is larger by `correlation`, and so many rings less
    are left for the scatter. Before, a fixed bend and independent rings gave two thirds of the scatter over surfaces.
    """
    steep = np.maximum(x - x[bend], 0.0)
    derivatives = [np.ones_like(x), steep]
    if bend > 0:  # the ring at the bend has half the derivative of those beyond it
        derivatives.append(-slope * np.heaviside(x - x[bend], 0.5))
    jacobian = np.stack(derivatives)
    covariance = np.linalg.inv((jacobian * weight) @ jacobian.T)
    independent = max(x.size / correlation - len(derivatives), 1.0)
    return math.sqrt(squares / independent * float(covariance[1, 1]))


def _bent_line(x: FloatArray, y: FloatArray, weight: FloatArray, bend: int) -> tuple[float, float, float]:
    """Return level, slope and weighted sum of squares of a line that is flat up to x[bend]."""
    steep = np.maximum(x - x[bend], 0.0)
    mean_x, mean_y = np.average(steep, weights=weight), np.average(y, weights=weight)
    slope = float(np.sum(weight * (steep - mean_x) * (y - mean_y)) / np.sum(weight * (steep - mean_x) ** 2))
    level = float(mean_y - slope * mean_x)
    return level, slope, float(np.sum(weight * (y - level - slope * steep) ** 2))
