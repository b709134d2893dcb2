"""Amplitude, slope and correlation of a surface: the parameters of ISO 25178-2, and its spectrum."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.numerics.fast_length import fast_length
from bem.representation import readable
from bem.surfaces.surface import Surface, check_map, spacing_of


@dataclass(frozen=True)
class SurfaceDescription:
    """Parameters of a surface about its mean height; names and definitions of ISO 25178-2 where there is one.

    Attributes
    ----------
    Sq, Sa : rms and mean absolute height [m].
    Sz : highest peak to lowest valley [m].
    Ssk, Sku : skewness, kurtosis (Gaussian: 0, 3); nan for a flat surface.
    Sdq : rms slope, sqrt(slope_x^2 + slope_y^2), from differences of neighbouring cells.
    slope_x, slope_y : rms slope along each axis; nan where an axis has one cell.
    autocorrelation_length_x, autocorrelation_length_y : where the autocorrelation along the axis falls to 1/e [m].
    decay_length_x, decay_length_y : where it falls to 0.2 [m] (the level of ISO's Sal). The four lengths are nan
        where the autocorrelation does not fall so far within half the map.
    """

    Sq: float
    Sa: float
    Sz: float
    Ssk: float
    Sku: float
    Sdq: float
    slope_x: float
    slope_y: float
    autocorrelation_length_x: float
    autocorrelation_length_y: float
    decay_length_x: float
    decay_length_y: float

    @property
    def autocorrelation_length(self) -> float:
        """Geometric mean of the 1/e lengths along x and y [m]; the one that exists where the other does not."""
        return _geometric_mean(self.autocorrelation_length_x, self.autocorrelation_length_y)

    @property
    def decay_length(self) -> float:
        """Geometric mean of the 0.2 lengths along x and y [m]; the one that exists where the other does not."""
        return _geometric_mean(self.decay_length_x, self.decay_length_y)


STEEPEST_SURFACE = 1.0
"""Rms slope Sdq above which the unit of heights is doubted; ground and honed surfaces have 0.05 to 0.5."""
LEAST_HEIGHT = 0.5e-9
"""Rms height Sq [m] below which the unit of heights is doubted; polished silicon and mica have 0.1 nm to 0.3 nm."""


def height_unit_doubt(rms_height: float, rms_slope: float) -> str:
    """Return why the unit of a map's heights is doubted: "steep", "smooth", or "" where it is not.

    rms_height : Sq [m]; a flat map (0) is not doubted. rms_slope : Sdq.
    """
    if rms_slope > STEEPEST_SURFACE:
        return "steep"
    return "smooth" if 0 < rms_height < LEAST_HEIGHT else ""


def describe_surface(
    heights: FloatArray | Surface,
    spacing: tuple[float, float] | None = None,
    *,
    periodic: tuple[bool, bool] = (False, False),
) -> SurfaceDescription:
    """Describe heights (nx, ny) [m] with cells of `spacing` (dx, dy) [m]; nothing but the mean is removed.

    spacing : that of the surface where a `Surface` is given.
    periodic : whether slopes and autocorrelation go on across the edges along x and y.

    Raises
    ------
    InputError : heights that are not a finite map, spacings that are not positive.
    """
    heights, spacing = check_map(heights, spacing_of(heights, spacing))
    deviation = heights - heights.mean()
    variance = float(np.mean(deviation**2))
    rms = math.sqrt(variance)
    # a flat map leaves round-off of its mean, which must not be taken for roughness
    flat = rms <= 8 * np.finfo(float).eps * float(np.abs(heights).max())
    if flat:
        deviation = np.zeros_like(heights)
        rms = 0.0
    unit = deviation if flat else deviation / rms
    slopes = rms_slopes(deviation, spacing, periodic)
    lengths = [_decay(unit, spacing, periodic, axis, level) for level in (math.exp(-1), 0.2) for axis in (0, 1)]
    return SurfaceDescription(
        Sq=rms,
        Sa=float(np.abs(deviation).mean()),
        Sz=float(np.ptp(heights)),
        Ssk=math.nan if flat else float(np.mean(unit**3)),
        Sku=math.nan if flat else float(np.mean(unit**4)),
        Sdq=rms_slope(slopes),
        slope_x=slopes[0],
        slope_y=slopes[1],
        autocorrelation_length_x=lengths[0],
        autocorrelation_length_y=lengths[1],
        decay_length_x=lengths[2],
        decay_length_y=lengths[3],
    )


def rms_slopes(
    heights: FloatArray, spacing: tuple[float, float], periodic: tuple[bool, bool] = (False, False)
) -> tuple[float, float]:
    """Return the rms slopes along x and y from differences of neighbouring cells; nan where an axis has one cell."""
    return _rms_slope(heights, spacing, periodic, 0), _rms_slope(heights, spacing, periodic, 1)


def rms_slope(slopes: tuple[float, float]) -> float:
    """Return the rms gradient sqrt(slope_x^2 + slope_y^2); an axis of one cell (nan) does not count."""
    return math.sqrt(sum(slope * slope for slope in slopes if not math.isnan(slope)))


def autocorrelation(heights: FloatArray, axis: int, *, periodic: bool = False) -> FloatArray:
    """Autocorrelation along one axis, averaged over the other: 1 at lag 0, lags 0..n//2 cells.

    Along a free axis each lag is the mean over the pairs that exist, so long lags are not biased to zero.
    """
    deviation = np.asarray(heights, dtype=np.float64) - np.mean(heights)
    n = deviation.shape[axis]
    size = n if periodic else fast_length(n + n // 2 + 1)
    if not periodic:
        deviation = np.pad(deviation, [(0, size - n if i == axis else 0) for i in (0, 1)])
    power = np.abs(np.fft.rfft(deviation, axis=axis)) ** 2
    raw = np.fft.irfft(power.sum(axis=1 - axis), size)[: n // 2 + 1]
    if not periodic:
        raw = raw * n / (n - np.arange(n // 2 + 1))
    return raw / raw[0] if raw[0] > 0 else np.full_like(raw, math.nan)


_HANN_CORRELATION = 35 / 18
"""Sum of the correlation coefficients of the periodogram of white noise over all lags along an axis with a Hann window
w: mean(w^4) / mean(w^2)^2 (Percival and Walden, Spectral Analysis for Physical Applications, 1993, section 6.6;
restated from memory). Across rings of waves it is that where both axes are free."""


@readable
@dataclass(frozen=True, eq=False)
class RadialSpectrum:
    """Power spectral density averaged over directions.

    Attributes
    ----------
    wavenumber : (n,) angular, mean over each ring [rad/m].
    density : (n,) [m^4], two-dimensional; Sq^2 = integral of density q dq / 2 pi.
    modes : (n,) number of wavevectors in each ring; fewer than ten scatter.
    ring_correlation : variance of a mean over many rings over that of rings that scatter independently; 1 of periodic
        maps. The Hann window of free axes mixes neighbouring waves.
    """

    wavenumber: FloatArray
    density: FloatArray
    modes: FloatArray
    ring_correlation: float = 1.0


def radial_spectrum(
    heights: FloatArray | Surface,
    spacing: tuple[float, float] | None = None,
    *,
    periodic: tuple[bool, bool] = (False, False),
) -> RadialSpectrum:
    """Radially averaged power spectral density of heights (nx, ny) [m] on cells of `spacing` [m].

    The spacing is that of the surface where a `Surface` is given.
    Along free axes a Hann window hides the step from edge to edge; it is normalised to keep Sq^2. Rings are as wide as
    the coarser of the two wavevector steps and go up to the smaller of the two Nyquist wavenumbers.

    Raises
    ------
    InputError : heights that are not a finite map of at least 4 x 4 cells.
    """
    from scipy import fft  # brings special functions along, and no scene asks for this

    heights, spacing = check_map(heights, spacing_of(heights, spacing))
    if min(heights.shape) < 4:
        raise InputError(f"heights: shape {heights.shape} must be at least (4, 4) for a radial spectrum")
    deviation = heights - heights.mean()
    for axis, wraps in enumerate(periodic):
        if not wraps:
            n = heights.shape[axis]
            window = np.sin(np.pi * (np.arange(n) + 0.5) / n) ** 2
            window /= math.sqrt(float(np.mean(window**2)))
            deviation = deviation * (window[:, None] if axis == 0 else window[None, :])
    deviation -= deviation.mean()
    nx, ny = heights.shape
    area = nx * spacing[0] * ny * spacing[1]
    power = np.abs(fft.fft2(deviation)) ** 2 * area / (nx * ny) ** 2
    kx = 2 * np.pi * fft.fftfreq(nx, spacing[0])[:, None]
    ky = 2 * np.pi * fft.fftfreq(ny, spacing[1])[None, :]
    q = np.hypot(kx, ky)
    step = 2 * np.pi / min(nx * spacing[0], ny * spacing[1])
    rings = int(math.pi / max(spacing) / step)
    ring = np.rint(q / step).astype(np.int64).ravel()
    inside = (ring >= 1) & (ring <= rings)
    counts = np.bincount(ring[inside], minlength=rings + 1)[1:]
    sums = np.bincount(ring[inside], power.ravel()[inside], minlength=rings + 1)[1:]
    means = np.bincount(ring[inside], q.ravel()[inside], minlength=rings + 1)[1:]
    keep = counts > 0
    free = 2 - sum(periodic)
    return RadialSpectrum(
        means[keep] / counts[keep],
        sums[keep] / counts[keep],
        counts[keep].astype(np.float64),
        ring_correlation=_HANN_CORRELATION ** (free / 2),
    )


def _rms_slope(deviation: FloatArray, spacing: tuple[float, float], periodic: tuple[bool, bool], axis: int) -> float:
    n = deviation.shape[axis]
    if n < 2:
        return math.nan
    steps = (
        np.diff(deviation, axis=axis, append=deviation.take([0], axis=axis))
        if periodic[axis]
        else np.diff(deviation, axis=axis)
    )
    return float(np.sqrt(np.mean(steps**2))) / spacing[axis]


def _decay(
    unit: FloatArray, spacing: tuple[float, float], periodic: tuple[bool, bool], axis: int, level: float
) -> float:
    if unit.shape[axis] < 2:
        return math.nan
    correlation = autocorrelation(unit, axis, periodic=periodic[axis])
    below = np.flatnonzero(correlation < level)
    if below.size == 0:
        return math.nan
    i = int(below[0])
    fraction = (correlation[i - 1] - level) / (correlation[i - 1] - correlation[i])
    return float((i - 1 + fraction) * spacing[axis])


def _geometric_mean(a: float, b: float) -> float:
    if math.isnan(a) or math.isnan(b):
        return b if math.isnan(a) else a
    return math.sqrt(a * b)
