"""Skewness and kurtosis of a random surface, met within its spectrum.

Ranks and amplitudes are put back in turn (Schreiber & Schmitz, *Phys. Rev. Lett.* 77 (1996) 635), then Newton's method
on a quadratic and a cubic correction without waves outside the spectrum closes what is left.

Knows heights and amplitudes; no grid, no lengths. Verified in tests/surfaces/test_surface_generate.py: moments of the
sample to STATISTICS_TOLERANCE, nothing outside the spectrum.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from bem.errors import InputError
from bem.grid import FloatArray
from bem.surfaces.ranks import in_order_of
from bem.surfaces.spectrum import multiplicity

STATISTICS_TOLERANCE = 1e-6
"""Largest difference between the asked and the given skewness and kurtosis."""

_ITERATIONS = 12
_SLACKS = (1.0, 3.0, 10.0, 100.0)
"""How far the spectrum may give way, tried in turn; more than 1 is needed where there are few waves only."""


def standardise(heights: FloatArray) -> FloatArray:
    """Heights of zero mean and unit rms."""
    deviation = heights - heights.mean()
    rms = float(np.sqrt(np.mean(deviation**2)))
    deviation /= rms
    deviation -= deviation.mean()
    return deviation


def _moments(z: FloatArray) -> tuple[float, float]:
    square = z * z
    third = float(np.mean(square * z))
    return third, float(np.mean(np.multiply(square, square, out=square)))


def impose_moments(heights: FloatArray, amplitude: FloatArray, skewness: float, kurtosis: float) -> FloatArray:
    """Standardised heights with these moments; a Gaussian request that so few waves cannot meet is returned as it is.

    Raises
    ------
    InputError : moments other than 0 and 3 that this spectrum cannot have.
    """
    gaussian = skewness == 0.0 and kurtosis == 3.0
    if not gaussian:
        heights = _rank_and_spectrum(heights, amplitude, skewness, kurtosis)
    for slack in (1.0,) if gaussian else _SLACKS:
        polished = _polish(heights, amplitude, skewness, kurtosis, slack)
        if polished is not None:
            return polished
    if gaussian:
        return heights
    given = _moments(heights)
    raise InputError(
        f"generate_surface: skewness {skewness!r} and kurtosis {kurtosis!r} cannot be had with this spectrum on "
        f"{heights.shape[0]} x {heights.shape[1]} cells; the nearest found are {given[0]:.3g} and {given[1]:.3g}: "
        "take a shorter correlation length (or roll-off), a larger grid, or milder statistics"
    )


def _rank_and_spectrum(heights: FloatArray, amplitude: FloatArray, skewness: float, kurtosis: float) -> FloatArray:
    from bem.surfaces.distributions import standard_quantiles  # roots and special functions: most surfaces are Gaussian

    target, heights = standard_quantiles(heights.size, skewness, kurtosis), heights.copy()
    for _ in range(_ITERATIONS):
        spectrum = np.fft.rfft2(in_order_of(heights, target))
        spectrum *= _over_size(amplitude, spectrum)
        heights = standardise(np.fft.irfft2(spectrum, heights.shape))
    return heights


def _polish(
    heights: FloatArray, amplitude: FloatArray, skewness: float, kurtosis: float, slack: float
) -> FloatArray | None:
    """z + a P(z^2) + b P(z^3) with a and b by Newton until both moments are met; None if it fails.

    P cuts every wave of the correction down to `slack` times the prescribed amplitude, so nothing leaves the band and
    no wave changes by more than its part.
    """
    total = float((amplitude**2 * multiplicity((heights.shape[0], heights.shape[1]))).sum())
    envelope = amplitude * (slack * heights.size / math.sqrt(total))

    def in_band(exponent: int) -> FloatArray:
        power = heights * heights
        if exponent == 3:
            power *= heights  # the library's powers beyond the second take fifteen times as long
        spectrum = np.fft.rfft2(power)
        del power
        share = _over_size(envelope, spectrum)
        spectrum *= np.minimum(1.0, share, out=share)
        del share
        return np.asarray(np.fft.irfft2(spectrum, heights.shape))

    wanted = np.array([skewness, kurtosis])
    for _ in range(40):
        missed = wanted - _moments(heights)
        if np.abs(missed).max() <= 0.01 * STATISTICS_TOLERANCE:
            return heights
        square, cube = in_band(2), in_band(3)
        coefficients = _newton(heights, square, cube, missed)
        if coefficients is None:
            return None
        # in place of a sum of five fields, with its bits
        square *= coefficients[0]
        cube *= coefficients[1]
        square += heights
        square += cube
        heights = standardise(square)
        del square, cube
    return heights if np.abs(wanted - _moments(heights)).max() <= STATISTICS_TOLERANCE else None


def _over_size(wanted: FloatArray, spectrum: NDArray[np.complex128]) -> FloatArray:
    """Wanted sizes over those of a spectrum, 0 where it has none."""
    size = np.abs(spectrum)
    return np.divide(wanted, size, out=size, where=size > 0)


def _magnitude(field: FloatArray) -> float:
    """The largest, without a field of its own."""
    return float(max(field.max(), -field.min()))


def _newton(z: FloatArray, square: FloatArray, cube: FloatArray, missed: FloatArray) -> FloatArray | None:
    """One damped step; moments of the standardised sum linearised about (0, 0)."""
    skewness, kurtosis = _moments(z)
    columns = []
    for direction in (square, cube):
        product, means = z * direction, []
        means.append(float(product.mean()))
        for _ in range(2):
            product *= z
            means.append(float(product.mean()))
        del product
        along, squares, cubes = means
        columns.append([3 * squares - 3 * skewness * along, 4 * cubes - 4 * kurtosis * along])
    jacobian = np.array(columns).T
    scale = float(np.abs(jacobian).max())
    if not 0 < scale < math.inf or abs(np.linalg.det(jacobian / scale)) < 1e-10:
        return None
    step: FloatArray = np.linalg.solve(jacobian, missed)
    # small enough steps keep the map monotone over most of the heights
    change = step[0] * square
    change += step[1] * cube
    largest = _magnitude(change) / max(1.0, _magnitude(z))
    if not math.isfinite(largest):
        return None
    return step * min(1.0, 0.1 / largest) if largest > 0 else step
