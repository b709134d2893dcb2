"""Amplitudes and phases of the waves of a random surface, as half spectra (nx, ny // 2 + 1) of a real transform.

Correlated surfaces take the transform of their autocorrelation, its periodic images summed; self-affine ones a power of
the wavenumber with a roll-off. Each phase is a function of seed and wavevector alone.

Knows the grid and the request; no heights. Verified in tests/surfaces/test_surface_generate.py: spectra and correlation
lengths against their formulas, phases across grids.
"""

from __future__ import annotations

import math

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.surfaces.request import Request

LENGTH_TOLERANCE = 1e-3
"""Relative tolerance of the correlation lengths of the prescribed spectrum."""


def spectrum_of(grid: Grid, request: Request) -> FloatArray:
    """Amplitudes of the waves of a checked request.

    Raises
    ------
    InputError : lengths that no surface of zero mean on this grid has; a cut-off that leaves no wave.
    """
    if request.lengths is not None:
        return _correlated_amplitude(grid, request.lengths, request.autocorrelation, request.cutoff_wavelength)
    assert request.hurst is not None
    amplitude = _self_affine_amplitude(grid, request.hurst, request.rolloff_wavelength)
    _restrict(amplitude, grid, request.cutoff_wavelength)
    return amplitude


def correlation_lengths(power: FloatArray, grid: Grid) -> tuple[float, float]:
    """Lags at which the autocorrelation of a half spectrum of squares falls to 1/e [m]; 0 along an axis of one cell."""
    correlation = np.fft.irfft2(power, grid.shape)
    found = [0.0, 0.0]
    for axis in (0, 1):
        if grid.shape[axis] > 1:
            along = (correlation[:, 0] if axis == 0 else correlation[0]) / correlation[0, 0]
            found[axis] = _first_crossing(along) * grid.spacing[axis]
    return found[0], found[1]


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
    for _ in range(30):
        amplitude = _model_amplitude(grid, (model_lengths[0], model_lengths[1]), model)
        _restrict(amplitude, grid, cutoff_wavelength)
        given = correlation_lengths(amplitude**2, grid)
        done = True
        for axis in (0, 1):
            if grid.shape[axis] == 1:
                continue
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
    return np.sqrt(np.maximum(np.fft.rfft2(whole).real, 0.0))


def _self_affine_amplitude(grid: Grid, hurst: float, rolloff_wavelength: float | None) -> FloatArray:
    kx, ky = grid.wavevectors()
    q = np.hypot(kx, ky)
    q[0, 0] = 1.0
    exponent = 0.5 + hurst if min(grid.shape) == 1 else 1.0 + hurst  # half of 1 + 2H, 2 + 2H
    floor = 0.0 if rolloff_wavelength is None else 2 * np.pi / rolloff_wavelength
    q = np.maximum(q, floor)
    return (q / q.min()) ** -exponent


def phases(shape: tuple[int, int], seed: int) -> np.ndarray:
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


def to_centres(waves: np.ndarray, shape: tuple[int, int]) -> None:
    """Move waves (nx, ny // 2 + 1), in place, so that the first centre lies half a cell from the grid's corner.

    Phases are those at the corner, heights stand at the centres of cells: so the same waves stand at the same places on
    every grid of one rectangle. The wave of two cells is taken as a cosine about their centres, as in `waves.on_cells`.
    """
    for axis, n in enumerate(shape):
        number = np.arange(waves.shape[axis])
        number = np.where(2 * number < n, number, number - n)
        turn = np.where(2 * np.abs(number) == n, 1.0, np.exp(1j * np.pi * number / n))
        waves *= turn[:, None] if axis == 0 else turn[None, :]


def _mix(code: np.ndarray) -> np.ndarray:
    """Finaliser of splitmix64 (Steele, Lea & Flood, OOPSLA 2014)."""
    code = code + np.uint64(0x9E3779B97F4A7C15)
    code = (code ^ (code >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    code = (code ^ (code >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return code ^ (code >> np.uint64(31))


def multiplicity(shape: tuple[int, int]) -> FloatArray:
    """How often each wave of the half spectrum counts."""
    ny = shape[1]
    count = np.full(ny // 2 + 1, 2.0)
    count[0] = 1.0
    if ny % 2 == 0:
        count[-1] = 1.0
    return count[None, :]
