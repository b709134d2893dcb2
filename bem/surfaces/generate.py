"""Random rough surfaces with a prescribed spectrum and height distribution.

A surface is a sum of waves with prescribed amplitudes and random phases. Where a skewness or kurtosis is asked for,
heights and spectrum are reconciled by iteration: the heights are replaced, rank by rank, by those of a distribution
with these moments, then the amplitudes are put back (Schreiber & Schmitz, *Phys. Rev. Lett.* 77 (1996) 635; Hu &
Tonder, *Int. J. Mach. Tools Manuf.* 32 (1992) 83, filter a translated sequence once, which makes it more Gaussian
again). What is left, in the Gaussian case too, is closed by Newton on a quadratic and a cubic correction that has no
waves outside the spectrum, so skewness, kurtosis and rms height of the sample are met.

Each phase is a function of seed and wavevector alone: the same seed on a finer grid of the same size
gives the same waves at the same places and adds finer ones.

Knows the request, its spectrum and its moments, each a file of its own. Verified in
tests/surfaces/test_surface_generate.py.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.surfaces.moments import impose_moments, standardise
from bem.surfaces.request import Request, check
from bem.surfaces.spectrum import correlation_lengths, multiplicity, phases, spectrum_of, to_centres

SAMPLE_LENGTH_TOLERANCE = 0.15
"""Relative tolerance of the correlation lengths of a surface with prescribed skewness and kurtosis."""


def generate_surface(
    grid: Grid,
    *,
    rms_height: float | None = None,
    seed: int,
    correlation_length: float | tuple[float, float] | None = None,
    hurst: float | None = None,
    rolloff_wavelength: float | None = None,
    cutoff_wavelength: float | None = None,
    skewness: float = 0.0,
    kurtosis: float = 3.0,
    autocorrelation: str = "gaussian",
    rms_slope: float | None = None,
) -> FloatArray:
    """Heights (nx, ny) [m] of a periodic random surface, of zero mean.

    Parameters
    ----------
    grid : where; the surface repeats with its lengths whatever `grid.periodic` says.
    rms_height : Sq [m], met to round-off.
    rms_slope : instead of `rms_height`: Sdq of the continuous surface.
    seed : integer >= 0; the same seed gives the same bits.
    correlation_length : lag at which the autocorrelation falls to 1/e [m]; a pair for different lengths along x and y.
        Met to 0.1 % by the prescribed spectrum; at most about a quarter of the grid's side can be had.
    autocorrelation : "gaussian", exp(-(r/l)^2), or "exponential", exp(-r/l), whose slope grows with every refinement of
        the grid.
    hurst : instead of a correlation length: exponent H in (0, 1] of a self-affine spectrum, density ~ q^(-2-2H)
        (q^(-1-2H) on a grid of one row).
    rolloff_wavelength : above it the self-affine spectrum is flat [m]; the longest wave of the grid if not given.
    cutoff_wavelength : no waves shorter than this [m]; two cells if not given.
    skewness, kurtosis : of the heights. Met to 1e-6, within the spectrum's band. Its shape gives way by a few per cent
        when they are far from 0 and 3, and by up to 15 % of the correlation length where there are few waves. A surface
        of so few waves that it cannot be Gaussian (fewer than about a hundred) is returned as near to the default
        0 and 3 as its waves are.

    Raises
    ------
    InputError : arguments out of range or that exclude each other; kurtosis below skewness^2 + 1, which no distribution
        has; skewness and kurtosis that this spectrum on this grid cannot have.
    """
    request = Request(
        rms_height=rms_height,
        seed=seed,
        correlation_length=correlation_length,
        hurst=hurst,
        rolloff_wavelength=rolloff_wavelength,
        cutoff_wavelength=cutoff_wavelength,
        skewness=skewness,
        kurtosis=kurtosis,
        autocorrelation=autocorrelation,
        rms_slope=rms_slope,
    )
    check(grid, request)
    amplitude = spectrum_of(grid, request)
    waves = phases(grid.shape, int(seed))
    waves *= amplitude
    to_centres(waves, grid.shape)
    heights = standardise(np.fft.irfft2(waves, grid.shape))
    del waves
    heights = impose_moments(heights, amplitude, float(skewness), float(kurtosis))
    if request.lengths is not None and (skewness, kurtosis) != (0.0, 3.0):
        _check_lengths(heights, grid, request.lengths)
    if rms_slope is None:
        assert rms_height is not None
        return heights * rms_height
    return heights * (rms_slope / _rms_slope(heights, grid))


def check_statistics(grid: Grid, **statistics: Any) -> None:
    """Refuse what `generate_surface` refuses of these arguments, without making heights.

    What only the sample can tell - moments that this spectrum of few waves cannot have - it does not find; nor, on more
    than four million cells, what takes a spectrum to tell.

    Raises
    ------
    InputError : as `generate_surface`.
    """
    request = Request(**statistics)
    check(grid, request)
    if grid.cells <= 1 << 22 and (request.lengths is not None or request.cutoff_wavelength is not None):
        spectrum_of(grid, request)


def _rms_slope(heights: FloatArray, grid: Grid) -> float:
    """Sdq of the continuous surface through the heights."""
    kx, ky = grid.wavevectors()
    spectrum = np.abs(np.fft.rfft2(heights)) ** 2 * multiplicity(grid.shape)
    return math.sqrt(float((spectrum * (kx**2 + ky**2)).sum())) / grid.cells


def _check_lengths(heights: FloatArray, grid: Grid, lengths: tuple[float, float]) -> None:
    found = correlation_lengths(np.abs(np.fft.rfft2(heights)) ** 2, grid)
    for axis, given in enumerate(found):
        if grid.shape[axis] > 1 and abs(given / lengths[axis] - 1) > SAMPLE_LENGTH_TOLERANCE:
            raise InputError(
                f"generate_surface: with this skewness and kurtosis the correlation length along {'xy'[axis]} is "
                f"{given:.4g} m instead of {lengths[axis]:.4g} m on {grid.lengths[axis]:.4g} m; take a shorter one, a "
                "larger grid, or milder statistics"
            )
