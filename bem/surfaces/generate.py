"""Random rough surfaces with a prescribed spectrum and height distribution.

A surface is a sum of waves with prescribed amplitudes and random phases. Where a skewness or kurtosis is asked for,
heights and spectrum are reconciled by iteration: the heights are replaced, rank by rank, by those of a distribution
with these moments, then the amplitudes are put back (Schreiber & Schmitz, *Phys. Rev. Lett.* 77 (1996) 635; Hu &
Tonder, *Int. J. Mach. Tools Manuf.* 32 (1992) 83, filter a translated sequence once, which makes it more Gaussian
again). What is left, in the Gaussian case too, is closed by Newton on a quadratic and a cubic correction that has no
waves outside the spectrum, so skewness, kurtosis and rms height of the sample are met.

Each phase is a function of seed and wavevector alone: the same seed on a finer grid of the same size
gives the same waves and adds finer ones.
"""

from __future__ import annotations

import math
from numbers import Integral

import numpy as np
import scipy.fft as fft

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.surfaces.distributions import standard_quantiles

STATISTICS_TOLERANCE = 1e-6
"""Largest difference between the asked and the given skewness and kurtosis."""

LENGTH_TOLERANCE = 1e-3
"""Relative tolerance of the correlation lengths of the prescribed spectrum."""

SAMPLE_LENGTH_TOLERANCE = 0.15
"""Relative tolerance of the correlation lengths of a surface with prescribed skewness and kurtosis."""

_MODELS = ("gaussian", "exponential")
_ITERATIONS = 12
_SLACKS = (1.0, 3.0, 10.0, 100.0)
"""How far the spectrum may give way, tried in turn; more than 1 is needed where there are few waves only."""


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
    rms_height : Sq [m], met to round-off. Instead of it `rms_slope` (Sdq of the continuous surface) may be given.
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
    lengths = _check(
        grid,
        rms_height,
        seed,
        correlation_length,
        hurst,
        rolloff_wavelength,
        cutoff_wavelength,
        skewness,
        kurtosis,
        autocorrelation,
        rms_slope,
    )
    amplitude = _amplitude(grid, lengths, autocorrelation, hurst, rolloff_wavelength, cutoff_wavelength)
    heights = _standardise(fft.irfft2(amplitude * _phases(grid.shape, int(seed)), grid.shape))
    heights = _impose_moments(heights, amplitude, float(skewness), float(kurtosis))
    if lengths is not None and (skewness, kurtosis) != (0.0, 3.0):
        _check_lengths(heights, grid, lengths)
    if rms_slope is None:
        assert rms_height is not None
        return heights * rms_height
    kx, ky = grid.wavevectors()
    spectrum = np.abs(fft.rfft2(heights)) ** 2 * _multiplicity(grid.shape)
    slope = math.sqrt(float((spectrum * (kx**2 + ky**2)).sum())) / grid.cells
    return heights * (rms_slope / slope)


def check_statistics(
    grid: Grid,
    *,
    rms_height: float | None = None,
    seed: int = 0,
    correlation_length: float | tuple[float, float] | None = None,
    hurst: float | None = None,
    rolloff_wavelength: float | None = None,
    cutoff_wavelength: float | None = None,
    skewness: float = 0.0,
    kurtosis: float = 3.0,
    autocorrelation: str = "gaussian",
    rms_slope: float | None = None,
) -> None:
    """Refuse what `generate_surface` refuses of these arguments, without making heights.

    What only the sample can tell - moments that this spectrum of few waves cannot have - it does not find; nor, on more
    than four million cells, what takes a spectrum to tell.

    Raises
    ------
    InputError : as `generate_surface`.
    """
    lengths = _check(
        grid,
        rms_height,
        seed,
        correlation_length,
        hurst,
        rolloff_wavelength,
        cutoff_wavelength,
        skewness,
        kurtosis,
        autocorrelation,
        rms_slope,
    )
    if grid.cells <= 1 << 22 and (lengths is not None or cutoff_wavelength is not None):
        _amplitude(grid, lengths, autocorrelation, hurst, rolloff_wavelength, cutoff_wavelength)


def _check(
    grid: Grid,
    rms_height: float | None,
    seed: object,
    correlation_length: float | tuple[float, float] | None,
    hurst: float | None,
    rolloff_wavelength: float | None,
    cutoff_wavelength: float | None,
    skewness: float,
    kurtosis: float,
    autocorrelation: str,
    rms_slope: float | None,
) -> tuple[float, float] | None:
    """Refuse what cannot be; return the pair of correlation lengths, or None for a self-affine surface."""
    messages: list[str] = []

    def positive(name: str, value: object, unit: str) -> bool:
        good = isinstance(value, int | float | np.number) and not isinstance(value, bool)
        if not (good and math.isfinite(value) and value > 0):  # type: ignore[arg-type, operator]
            messages.append(f"generate_surface: {name} {value!r} must be positive and finite{unit}")
            return False
        return True

    if not isinstance(grid, Grid):
        raise InputError(f"generate_surface: grid {grid!r} must be a Grid")
    if grid.cells < 4:
        messages.append(f"generate_surface: a grid of {grid.cells} cells is too small for a rough surface")
    if (rms_height is None) == (rms_slope is None):
        messages.append(
            f"generate_surface: give exactly one of rms_height ({rms_height!r}) and rms_slope ({rms_slope!r})"
        )
    elif rms_height is not None:
        positive("rms_height", rms_height, " [m]")
    else:
        positive("rms_slope", rms_slope, "")
    if isinstance(seed, bool) or not isinstance(seed, Integral) or int(seed) < 0:
        messages.append(f"generate_surface: seed {seed!r} must be an integer >= 0")
    if (correlation_length is None) == (hurst is None):
        messages.append(
            f"generate_surface: give exactly one of correlation_length ({correlation_length!r}) and hurst ({hurst!r})"
        )
    lengths: tuple[float, float] | None = None
    if correlation_length is not None:
        pair = correlation_length if isinstance(correlation_length, tuple | list) else (correlation_length,) * 2
        if len(pair) != 2:
            messages.append(
                f"generate_surface: correlation_length {correlation_length!r} must be one length or a pair [m]"
            )
        elif sum([positive("correlation_length", value, " [m]") for value in pair]) == 2:
            lengths = (float(pair[0]), float(pair[1]))
            for axis, name in enumerate("xy"):
                if grid.shape[axis] > 1 and not grid.spacing[axis] <= lengths[axis] <= grid.lengths[axis] / 2:
                    messages.append(
                        f"generate_surface: correlation_length {lengths[axis]:.4g} m along {name} must lie between one "
                        f"cell ({grid.spacing[axis]:.4g} m) and half the grid ({grid.lengths[axis] / 2:.4g} m)"
                    )
        if rolloff_wavelength is not None:
            messages.append("generate_surface: rolloff_wavelength belongs to hurst, not to correlation_length")
    if autocorrelation not in _MODELS:
        messages.append(f"generate_surface: autocorrelation {autocorrelation!r} is not one of {', '.join(_MODELS)}")
    if hurst is not None and not (isinstance(hurst, int | float | np.number) and 0 < hurst <= 1):
        messages.append(f"generate_surface: hurst {hurst!r} must lie above 0 and at most at 1")
    longest = max(grid.lengths)
    shortest = 2 * max(d for d, n in zip(grid.spacing, grid.shape, strict=True) if n > 1 or grid.cells == 1)
    rolloff_good = rolloff_wavelength is None or positive("rolloff_wavelength", rolloff_wavelength, " [m]")
    cutoff_good = cutoff_wavelength is None or positive("cutoff_wavelength", cutoff_wavelength, " [m]")
    if cutoff_wavelength is not None and cutoff_good:
        if cutoff_wavelength < shortest * (1 - 1e-9):
            messages.append(
                f"generate_surface: cutoff_wavelength {cutoff_wavelength!r} m is below two cells, {shortest:.4g} m"
            )
        upper = longest if rolloff_wavelength is None or not rolloff_good else rolloff_wavelength
        if cutoff_wavelength > upper * (1 + 1e-9):
            messages.append(
                f"generate_surface: cutoff_wavelength {cutoff_wavelength!r} m must not exceed "
                f"{'the grid' if upper == longest else 'rolloff_wavelength'} ({upper:.4g} m)"
            )
    if rolloff_wavelength is not None and rolloff_good and rolloff_wavelength < shortest * (1 - 1e-9):
        messages.append(
            f"generate_surface: rolloff_wavelength {rolloff_wavelength!r} m is below two cells, {shortest:.4g} m"
        )
    if not (math.isfinite(skewness) and math.isfinite(kurtosis)):
        messages.append(f"generate_surface: skewness {skewness!r} and kurtosis {kurtosis!r} must be finite")
    elif kurtosis < skewness**2 + 1:
        messages.append(
            f"generate_surface: no distribution has skewness {skewness!r} and kurtosis {kurtosis!r}: kurtosis must be "
            f"at least skewness^2 + 1 = {skewness**2 + 1:.4g}"
        )
    if messages:
        raise InputError(messages)
    return lengths


def _restrict(amplitude: FloatArray, grid: Grid, cutoff_wavelength: float | None) -> None:
    """Take out, in place, the mean and the waves beyond the cutoff."""
    kx, ky = grid.wavevectors()
    if cutoff_wavelength is not None:
        amplitude[np.hypot(kx, ky) > 2 * np.pi / cutoff_wavelength * (1 + 1e-9)] = 0.0
    amplitude[0, 0] = 0.0
    # amplitudes below round-off of the largest are noise of a transform, not waves
    amplitude[amplitude < 1e-9 * amplitude.max()] = 0.0
    if not amplitude.any():
        raise InputError(
            f"generate_surface: no wave of the grid, {grid.lengths[0]:.4g} x {grid.lengths[1]:.4g} m, is as long as "
            f"cutoff_wavelength {cutoff_wavelength!r} m; enlarge the grid or lower it"
        )


def _amplitude(
    grid: Grid,
    lengths: tuple[float, float] | None,
    autocorrelation: str,
    hurst: float | None,
    rolloff_wavelength: float | None,
    cutoff_wavelength: float | None,
) -> FloatArray:
    """Amplitudes of the waves (nx, ny // 2 + 1): of given correlation lengths, or self-affine where there are none."""
    if lengths is not None:
        return _correlated_amplitude(grid, lengths, autocorrelation, cutoff_wavelength)
    assert hurst is not None
    amplitude = _self_affine_amplitude(grid, hurst, rolloff_wavelength)
    _restrict(amplitude, grid, cutoff_wavelength)
    return amplitude


def _correlated_amplitude(
    grid: Grid, lengths: tuple[float, float], model: str, cutoff_wavelength: float | None
) -> FloatArray:
    """Amplitudes of a surface whose autocorrelation, its mean and cut-off waves gone, falls to 1/e at `lengths`.

    Taking out the mean of a finite surface shortens its correlation (an exponential one of an eighth of the side by
    15 %), so the lengths of the model are corrected until the surface's own are as asked.

    Raises
    ------
    InputError : lengths that no surface of zero mean on this grid has.
    """
    model_lengths = list(lengths)
    given = [0.0, 0.0]
    for _ in range(30):
        amplitude = _model_amplitude(grid, (model_lengths[0], model_lengths[1]), model)
        _restrict(amplitude, grid, cutoff_wavelength)
        correlation = fft.irfft2(amplitude**2, grid.shape)
        done = True
        for axis in (0, 1):
            if grid.shape[axis] == 1:
                continue
            along = (correlation[:, 0] if axis == 0 else correlation[0]) / correlation[0, 0]
            given[axis] = _first_crossing(along) * grid.spacing[axis]
            ratio = lengths[axis] / given[axis]
            if abs(ratio - 1) > LENGTH_TOLERANCE:
                done = False
                model_lengths[axis] *= min(max(ratio, 0.5), 2.0)
        if done:
            return amplitude
        if max(m / side for m, side in zip(model_lengths, grid.lengths, strict=True)) > 1:
            break
    raise InputError(
        f"generate_surface: correlation_length {lengths!r} m cannot be had on a grid of {grid.lengths[0]:.4g} x "
        f"{grid.lengths[1]:.4g} m"
        + (f" without waves below {cutoff_wavelength:.4g} m" if cutoff_wavelength is not None else "")
        + f"; the nearest found are {given[0]:.4g} and {given[1]:.4g} m"
    )


def _check_lengths(heights: FloatArray, grid: Grid, lengths: tuple[float, float]) -> None:
    correlation = fft.irfft2(np.abs(fft.rfft2(heights)) ** 2, grid.shape)
    for axis in (0, 1):
        if grid.shape[axis] == 1:
            continue
        along = (correlation[:, 0] if axis == 0 else correlation[0]) / correlation[0, 0]
        given = _first_crossing(along) * grid.spacing[axis]
        if abs(given / lengths[axis] - 1) > SAMPLE_LENGTH_TOLERANCE:
            raise InputError(
                f"generate_surface: with this skewness and kurtosis the correlation length along {'xy'[axis]} is "
                f"{given:.4g} m instead of {lengths[axis]:.4g} m on {grid.lengths[axis]:.4g} m; take a shorter one, a "
                "larger grid, or milder statistics"
            )


def _first_crossing(correlation: FloatArray) -> float:
    """Lag in cells at which a correlation falls to 1/e, linear between cells as in `describe_surface`; inf if never."""
    level = math.exp(-1)
    below = np.flatnonzero(correlation < level)
    if below.size == 0:
        return math.inf
    i = int(below[0])
    return i - 1 + float((correlation[i - 1] - level) / (correlation[i - 1] - correlation[i]))


def _model_amplitude(grid: Grid, lengths: tuple[float, float], model: str) -> FloatArray:
    """Square root of the transform of the autocorrelation, its periodic images summed: exact at every lag."""
    reach = 5.0 if model == "gaussian" else 14.0  # exp(-25), exp(-14): images beyond change nothing
    squares = []
    for axis in (0, 1):
        n, d, length = grid.shape[axis], grid.spacing[axis], lengths[axis]
        images = math.ceil(reach * length / (n * d) - 0.5) if n > 1 else 0
        lag = (
            np.arange(n // 2 + 1)[:, None] + n * np.arange(-images - 1, images + 1)[None, :]
            if n > 1
            else np.zeros((1, 1))
        )
        squares.append((lag * d / length) ** 2)
    if model == "gaussian":
        quarter = np.exp(-squares[0]).sum(axis=1)[:, None] * np.exp(-squares[1]).sum(axis=1)[None, :]
    else:
        quarter = np.zeros((squares[0].shape[0], squares[1].shape[0]))
        for i in range(squares[0].shape[1]):
            for j in range(squares[1].shape[1]):
                quarter += np.exp(-np.sqrt(squares[0][:, i, None] + squares[1][None, :, j]))
    nx, ny = grid.shape
    full_x = quarter[np.minimum(np.arange(nx), nx - np.arange(nx))]
    whole = full_x[:, np.minimum(np.arange(ny), ny - np.arange(ny))]
    return np.sqrt(np.maximum(fft.rfft2(whole).real, 0.0))


def _self_affine_amplitude(grid: Grid, hurst: float, rolloff_wavelength: float | None) -> FloatArray:
    kx, ky = grid.wavevectors()
    q = np.hypot(kx, ky)
    q[0, 0] = 1.0
    exponent = 0.5 + hurst if min(grid.shape) == 1 else 1.0 + hurst  # half of 1 + 2H, 2 + 2H
    floor = 0.0 if rolloff_wavelength is None else 2 * np.pi / rolloff_wavelength
    q = np.maximum(q, floor)
    return (q / q.min()) ** -exponent


def _phases(shape: tuple[int, int], seed: int) -> np.ndarray:
    """exp(i phase) of every wave of the real transform; a function of seed and integer wavevector only."""
    nx, ny = shape
    ix = np.where(np.arange(nx) <= nx // 2, np.arange(nx), np.arange(nx) - nx)[:, None] + np.zeros(
        (1, ny // 2 + 1), dtype=np.int64
    )
    iy = np.arange(ny // 2 + 1)[None, :] + np.zeros((nx, 1), dtype=np.int64)
    # (kx, 0) and (-kx, 0), likewise on the Nyquist line, are one wave and its conjugate
    paired = (iy == 0) | ((ny % 2 == 0) & (iy == ny // 2))
    flipped = paired & (ix < 0)
    code = np.where(flipped, -ix, ix).astype(np.uint64) * np.uint64(0x9E3779B97F4A7C15)
    code = _mix(code ^ _mix(iy.astype(np.uint64) + _mix(np.full(1, seed & (2**64 - 1), dtype=np.uint64))))
    if seed >> 64:  # longer seeds: fold the rest in, so that no two seeds are the same
        code = _mix(code ^ _mix(np.full(1, (seed >> 64) & (2**64 - 1), dtype=np.uint64)))
    uniform = (code >> np.uint64(11)).astype(np.float64) * 2.0**-53
    phase = np.exp(2j * np.pi * uniform)
    phase = np.where(flipped, phase.conj(), phase)
    real = paired & ((ix == 0) | ((nx % 2 == 0) & (ix == nx // 2)))
    return np.where(real, np.where(uniform < 0.5, 1.0, -1.0), phase)


def _mix(code: np.ndarray) -> np.ndarray:
    """Finaliser of splitmix64 (Steele, Lea & Flood, OOPSLA 2014)."""
    code = code + np.uint64(0x9E3779B97F4A7C15)
    code = (code ^ (code >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    code = (code ^ (code >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return code ^ (code >> np.uint64(31))


def _multiplicity(shape: tuple[int, int]) -> FloatArray:
    """How often each wave of the half spectrum counts."""
    ny = shape[1]
    count = np.full(ny // 2 + 1, 2.0)
    count[0] = 1.0
    if ny % 2 == 0:
        count[-1] = 1.0
    return count[None, :]


def _standardise(heights: FloatArray) -> FloatArray:
    deviation = heights - heights.mean()
    rms = float(np.sqrt(np.mean(deviation**2)))
    deviation = deviation / rms
    return deviation - deviation.mean()


def _moments(z: FloatArray) -> tuple[float, float]:
    square = z * z
    return float(np.mean(square * z)), float(np.mean(square * square))


def _impose_moments(heights: FloatArray, amplitude: FloatArray, skewness: float, kurtosis: float) -> FloatArray:
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
    target = standard_quantiles(heights.size, skewness, kurtosis)
    for _ in range(_ITERATIONS):
        ranked = np.empty(heights.size)
        ranked[np.argsort(heights, axis=None, kind="stable")] = target
        spectrum = fft.rfft2(ranked.reshape(heights.shape))
        size = np.abs(spectrum)
        spectrum *= np.divide(amplitude, size, out=np.zeros_like(size), where=size > 0)
        heights = _standardise(fft.irfft2(spectrum, heights.shape))
    return heights


def _polish(
    heights: FloatArray, amplitude: FloatArray, skewness: float, kurtosis: float, slack: float
) -> FloatArray | None:
    """z + a P(z^2) + b P(z^3) with a and b by Newton until both moments are met; None if it fails.

    P cuts every wave of the correction down to `slack` times the prescribed amplitude, so nothing leaves the band and
    no wave changes by more than its share.
    """
    power = float((amplitude**2 * _multiplicity((heights.shape[0], heights.shape[1]))).sum())
    envelope = amplitude * (slack * heights.size / math.sqrt(power))

    def in_band(field: FloatArray) -> FloatArray:
        spectrum = fft.rfft2(field)
        size = np.abs(spectrum)
        spectrum *= np.minimum(1.0, np.divide(envelope, size, out=np.zeros_like(size), where=size > 0))
        return np.asarray(fft.irfft2(spectrum, field.shape))

    wanted = np.array([skewness, kurtosis])
    for _ in range(40):
        missed = wanted - _moments(heights)
        if np.abs(missed).max() <= 0.01 * STATISTICS_TOLERANCE:
            return heights
        square = in_band(heights * heights)
        cube = in_band(heights**3)
        coefficients = _newton(heights, square, cube, missed)
        if coefficients is None:
            return None
        heights = _standardise(heights + coefficients[0] * square + coefficients[1] * cube)
    return heights if np.abs(wanted - _moments(heights)).max() <= STATISTICS_TOLERANCE else None


def _newton(z: FloatArray, square: FloatArray, cube: FloatArray, missed: FloatArray) -> FloatArray | None:
    """One damped step; moments of the standardised sum linearised about (0, 0)."""
    skewness, kurtosis = _moments(z)
    columns = []
    for direction in (square, cube):
        along = float(np.mean(z * direction))
        columns.append(
            [
                3 * float(np.mean(z * z * direction)) - 3 * skewness * along,
                4 * float(np.mean(z**3 * direction)) - 4 * kurtosis * along,
            ]
        )
    jacobian = np.array(columns).T
    scale = float(np.abs(jacobian).max())
    if not 0 < scale < math.inf or abs(np.linalg.det(jacobian / scale)) < 1e-10:
        return None
    step: FloatArray = np.linalg.solve(jacobian, missed)
    # small enough steps keep the map monotone over most of the heights
    largest = float(np.abs(step[0] * square + step[1] * cube).max() / max(1.0, np.abs(z).max()))
    if not math.isfinite(largest):
        return None
    return step * min(1.0, 0.1 / largest) if largest > 0 else step
