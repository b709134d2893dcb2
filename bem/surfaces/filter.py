"""Change a surface: level it, fill holes, crop, resample, make it periodic, filter by wavelength, scale it."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable

import numpy as np
import scipy.fft as fft

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.quantities import si
from bem.surfaces.surface import Surface, check_map

DETRENDINGS = ("plane", "curvature", "none")
MOST_MISSING = 0.5
"""Largest fraction of missing points that is filled; beyond it a map is mostly invention."""


class MirrorWarning(UserWarning):
    """A surface was made periodic by mirroring: its statistics stay, its ridges and correlation at the seams do not."""


def detrend(heights: FloatArray, spacing: tuple[float, float], method: str = "plane") -> FloatArray:
    """Remove the least-squares plane or second-order polynomial; missing points (nan) stay missing and do not count.

    heights : (nx, ny) [m]; method : "plane", "curvature" (plane, x^2, xy, y^2) or "none" (nothing, not even the mean).

    Raises
    ------
    InputError : an unknown method.
    """
    if method not in DETRENDINGS:
        raise InputError(f"detrend: {method!r} is not one of {', '.join(DETRENDINGS)}")
    if method == "none":
        return np.array(heights, dtype=np.float64)
    heights, spacing = check_map(heights, spacing, missing=True)
    return heights - trend(heights, curved=method == "curvature")


def trend(heights: FloatArray, *, curved: bool) -> FloatArray:
    """The least-squares plane (or second-order polynomial) through the points that are there, at every point [m]."""
    nx, ny = heights.shape
    known = ~np.isnan(heights)
    if not known.any():
        return np.zeros_like(heights)
    # coordinates scaled to [-1, 1]: the fit is then well conditioned whatever the units
    x = np.linspace(-1, 1, nx)[:, None] if nx > 1 else np.zeros((1, 1))
    y = np.linspace(-1, 1, ny)[None, :] if ny > 1 else np.zeros((1, 1))
    terms = [np.ones((nx, ny)), x + 0 * y, y + 0 * x]
    if curved:
        terms += [x * x + 0 * y, y * y + 0 * x, x * y]
    scale = float(np.abs(heights[known]).max()) or 1.0
    target = np.where(known, heights / scale, 0.0)
    # numpy's own sums: a threaded matrix product would give other bits on other numbers of threads
    inside = [np.where(known, term, 0.0) for term in terms]
    normal = np.array([[float(np.sum(a * b)) for b in terms] for a in inside])
    right = np.array([float(np.sum(a * target)) for a in inside])
    coefficients = np.linalg.lstsq(normal, right, rcond=1e-13)[0]
    fitted = np.zeros((nx, ny))
    for coefficient, term in zip(coefficients, terms, strict=True):
        fitted += scale * coefficient * term
    return fitted


def level_lines(heights: FloatArray) -> FloatArray:
    """Remove the offset of each scan line, its median about the median of all points; missing points (nan) stay.

    heights : (nx, ny) [m], a scan line for each iy. Waves across the lines that are as wide as the map go too.
    """
    known = ~np.isnan(heights)
    measured = known.any(axis=0)
    offsets = np.zeros(heights.shape[1])
    offsets[measured] = np.nanmedian(heights[:, measured], axis=0)
    whole = float(np.median(heights[known])) if known.any() else 0.0
    return heights - np.where(measured, offsets - whole, 0.0)[None, :]


_GAP = 10
"""Missing points side by side that make a gap; fewer are lone points, as noise leaves them."""


def points_in_gaps(missing: np.ndarray) -> int:
    """Return how many of the missing points of a map (nx, ny) lie in connected gaps of ten and more."""
    from scipy.ndimage import label

    sizes = np.bincount(label(missing)[0].ravel())[1:]
    return int(sizes[sizes >= _GAP].sum())


def fill_missing(heights: FloatArray, spacing: tuple[float, float]) -> FloatArray:
    """Fill missing points (nan) with the harmonic surface through their neighbours: no new peak, no new valley.

    Laplace's equation on the cells of each hole, with its rim as given and no flux across the edge of the map.

    Raises
    ------
    InputError : more than half of the points are missing.
    """
    from scipy.sparse import coo_matrix
    from scipy.sparse.linalg import spsolve

    heights, spacing = check_map(heights, spacing, missing=True)
    holes = np.isnan(heights)
    missing = int(holes.sum())
    if missing == 0:
        return heights
    if missing > MOST_MISSING * heights.size:
        raise InputError(
            f"{missing} of {heights.size} points are missing; at most {MOST_MISSING:.0%} are filled: "
            "crop the map to a part that was measured"
        )
    index = np.full(heights.shape, -1, dtype=np.int64)
    index[holes] = np.arange(missing)
    # what is known is taken as deviation from its mean: a large offset must not cost digits
    offset = float(np.nanmean(heights))
    rows: list[np.ndarray] = []
    columns: list[np.ndarray] = []
    entries: list[FloatArray] = []
    diagonal = np.zeros(missing)
    right = np.zeros(missing)
    ix, iy = np.nonzero(holes)
    for axis, step in ((0, 1), (0, -1), (1, 1), (1, -1)):
        jx, jy = (ix + step, iy) if axis == 0 else (ix, iy + step)
        inside = (jx >= 0) & (jx < heights.shape[0]) & (jy >= 0) & (jy < heights.shape[1])
        weight = (min(spacing) / spacing[axis]) ** 2
        here = np.flatnonzero(inside)
        there = index[jx[here], jy[here]]
        diagonal[here] += weight
        unknown = there >= 0
        rows.append(here[unknown])
        columns.append(there[unknown])
        entries.append(np.full(int(unknown.sum()), -weight))
        right[here[~unknown]] += weight * (heights[jx[here[~unknown]], jy[here[~unknown]]] - offset)
    rows.append(np.arange(missing))
    columns.append(np.arange(missing))
    entries.append(diagonal)
    matrix = coo_matrix(
        (np.concatenate(entries), (np.concatenate(rows), np.concatenate(columns))), shape=(missing, missing)
    )
    filled = heights.copy()
    filled[holes] = offset + np.asarray(spsolve(matrix.tocsc(), right))
    # round-off may pass the largest rim value by an ulp: the maximum principle holds exactly
    return np.clip(filled, np.nanmin(heights), np.nanmax(heights))


def crop(surface: Surface, lengths: tuple[float, float], *, centre: tuple[float, float] = (0.0, 0.0)) -> Surface:
    """Cut out whole cells of a rectangle of `lengths` [m] around `centre` [m], measured from the middle of the map.

    Raises
    ------
    InputError : a rectangle smaller than a cell or reaching beyond the map.
    """
    starts, counts, messages = [], [], []
    for axis, name in enumerate("xy"):
        n, d = surface.shape[axis], surface.spacing[axis]
        count = round(lengths[axis] / d) if math.isfinite(lengths[axis]) else 0
        start = round(centre[axis] / d + (n - count) / 2) if math.isfinite(centre[axis]) else -1
        if count < 1 or start < 0 or start + count > n:
            messages.append(
                f"crop: {lengths[axis]!r} m around {centre[axis]!r} m along {name} must be at least one cell "
                f"({d:.4g} m) and lie inside the map, {n * d:.4g} m long"
            )
        starts.append(start)
        counts.append(count)
    if messages:
        raise InputError(messages)
    inside = tuple(slice(start, start + count) for start, count in zip(starts, counts, strict=True))
    filled = None if surface.filled is None or not surface.filled[inside].any() else surface.filled[inside]
    notes = {**surface.metadata, "cropped_from": surface.shape}
    return Surface(surface.heights[inside], surface.spacing, notes, filled)


def resample(
    surface: Surface, grid: Grid, *, centre: tuple[float, float] = (0.0, 0.0), method: str = "spline"
) -> Surface:
    """Heights at the cell centres of `grid`, whose middle is put at `centre` [m] from the middle of the map.

    Parameters
    ----------
    surface : heights [m] and spacing [m] of the map.
    grid : of the result, (nx, ny) cells.
    centre : (x, y) of the grid's middle, from the middle of the map [m].
    method : "spline": cubic spline through the heights; where the grid is coarser than the map, wavelengths that it
        cannot hold (below two of its cells) are removed first. "fourier": trigonometric interpolation of a periodic
        surface, exact for what both can hold; the grid must then cover exactly the map and `centre` may be anything.

    Raises
    ------
    InputError : a grid that reaches beyond the map (crop the grid, or use mirror_to_periodic), an unknown method.
    """
    if method == "fourier":
        return _resample_fourier(surface, grid, centre)
    if method != "spline":
        raise InputError(f"resample: method {method!r} is not one of spline, fourier")
    from scipy.interpolate import RectBivariateSpline  # a third of a second, for measured surfaces only

    messages = []
    targets = []
    for axis, name in enumerate("xy"):
        half = 0.5 * surface.lengths[axis]
        reach = 0.5 * grid.lengths[axis] + abs(centre[axis])
        if not reach <= half * (1 + 1e-9):
            middle = f" around {si(centre[axis], 'm', 6)}" if centre[axis] else ""
            messages.append(
                f"the grid is {si(grid.lengths[axis], 'm', 6)} long along {name}{middle}, the map only "
                f"{si(surface.lengths[axis], 'm', 6)}"
            )
        targets.append((grid.x if axis == 0 else grid.y) + centre[axis])
    if messages:
        raise InputError(f"resample: {'; '.join(messages)}; use a smaller grid, or mirror_to_periodic first")
    heights = surface.heights
    offset = float(heights.mean())
    heights = heights - offset
    for axis in (0, 1):
        if grid.spacing[axis] > surface.spacing[axis] * (1 + 1e-9):
            nyquist = _transmission(2 * grid.spacing[axis], "sharp")
            heights = _transmit(heights, surface.spacing, (False, False), nyquist, axis=axis)
    sources = surface.grid()
    for axis in (0, 1):
        if heights.shape[axis] == 1:  # one cell: constant along that axis
            heights = np.repeat(heights, 2, axis=axis)
    knots = [_knots(sources.x), _knots(sources.y)]
    spline = RectBivariateSpline(
        knots[0], knots[1], heights, kx=min(3, heights.shape[0] - 1), ky=min(3, heights.shape[1] - 1), s=0
    )
    values = spline(*(np.clip(t, k[0], k[-1]) for t, k in zip(targets, knots, strict=True)))
    return surface.replace(values + offset, spacing=grid.spacing, resampled_from=surface.spacing)


def _knots(centres: FloatArray) -> FloatArray:
    return centres if len(centres) > 1 else np.array([centres[0] - 1.0, centres[0] + 1.0])


def _resample_fourier(surface: Surface, grid: Grid, centre: tuple[float, float]) -> Surface:
    messages = [
        f"resample: with method 'fourier' the grid must be as long as the map along {name}, {have!r} m, not {want!r} m"
        for name, have, want in zip("xy", surface.lengths, grid.lengths, strict=True)
        if not math.isclose(have, want, rel_tol=1e-9)
    ]
    if messages:
        raise InputError(messages)
    values = surface.heights
    for axis in (0, 1):
        n, m = surface.shape[axis], grid.shape[axis]
        if n == m and centre[axis] == 0:
            continue
        spectrum = fft.rfft(values, axis=axis)
        # where an even count meets another grid its Nyquist wave is ambiguous: dropped
        kept = (min(n, m) - 1) // 2 + 1
        first_target = 0.5 * grid.spacing[axis] - 0.5 * grid.lengths[axis] + centre[axis]
        first_source = 0.5 * surface.spacing[axis] - 0.5 * surface.lengths[axis]
        phase = np.exp(2j * np.pi * np.arange(kept) * (first_target - first_source) / surface.lengths[axis])
        moved = spectrum.take(np.arange(kept), axis=axis) * (phase[:, None] if axis == 0 else phase[None, :])
        values = fft.irfft(moved, m, axis=axis) * (m / n)
    return surface.replace(values, spacing=grid.spacing, resampled_from=surface.spacing)


def mirror_to_periodic(surface: Surface, *, axes: tuple[bool, bool] = (True, True)) -> Surface:
    """Make a surface periodic along `axes` by putting its mirror image beside it; twice as many cells along each.

    Warns
    -----
    MirrorWarning : always; the seams are symmetric ridges and valleys that the real surface does not have.
    """
    values = surface.heights
    for axis, wanted in enumerate(axes):
        if wanted:
            values = np.concatenate([values, np.flip(values, axis=axis)], axis=axis)
    warnings.warn(
        "surface made periodic by mirroring: heights and slopes keep their statistics, but the surface is symmetric "
        "about its seams",
        MirrorWarning,
        stacklevel=2,
    )
    return surface.replace(values, mirrored=tuple(bool(a) for a in axes))


def low_pass(
    surface: Surface, wavelength: float, *, periodic: tuple[bool, bool] = (False, False), kind: str = "gaussian"
) -> Surface:
    """Keep wavelengths above `wavelength` [m] (waviness).

    kind : "gaussian" (ISO 16610-21: half transmission at the wavelength) or "sharp". Free axes are mirrored at the
    edges, so nothing leaks from one side to the other.

    Raises
    ------
    InputError : a wavelength that is not positive, an unknown kind.
    """
    values = _transmit(surface.heights, surface.spacing, periodic, _transmission(wavelength, kind))
    return surface.replace(values, low_pass=float(wavelength))


def high_pass(
    surface: Surface, wavelength: float, *, periodic: tuple[bool, bool] = (False, False), kind: str = "gaussian"
) -> Surface:
    """Keep wavelengths below `wavelength` [m] (roughness): what `low_pass` with the same arguments leaves out."""
    low = low_pass(surface, wavelength, periodic=periodic, kind=kind)
    return surface.replace(surface.heights - low.heights, high_pass=float(wavelength))


def scale_to_rms(surface: Surface, rms_height: float) -> Surface:
    """Scale the deviation from the mean so that Sq is `rms_height` [m] exactly; the mean becomes zero.

    Raises
    ------
    InputError : a target that is not positive, or a flat surface.
    """
    deviation = surface.heights - surface.heights.mean()
    rms = float(np.sqrt(np.mean(deviation**2)))
    if not (math.isfinite(rms_height) and rms_height > 0):
        raise InputError(f"rms_height {rms_height!r} must be positive and finite [m]")
    if rms <= 8 * np.finfo(float).eps * float(np.abs(surface.heights).max()):
        raise InputError("a flat surface cannot be scaled to an rms height")
    return surface.replace(deviation * (rms_height / rms), scaled_from_rms=rms)


def _transmission(wavelength: float, kind: str) -> Callable[[FloatArray], FloatArray]:
    messages = []
    if not (math.isfinite(wavelength) and wavelength > 0):
        messages.append(f"wavelength {wavelength!r} must be positive and finite [m]")
    if kind not in ("gaussian", "sharp"):
        messages.append(f"kind {kind!r} is not one of gaussian, sharp")
    if messages:
        raise InputError(messages)
    cutoff = 2 * math.pi / wavelength
    if kind == "sharp":
        return lambda q: (q <= cutoff * (1 + 1e-12)).astype(np.float64)
    return lambda q: np.exp(-math.log(2) * (q / cutoff) ** 2)


def _transmit(
    heights: FloatArray,
    spacing: tuple[float, float],
    periodic: tuple[bool, bool],
    transmission: Callable[[FloatArray], FloatArray],
    axis: int | None = None,
) -> FloatArray:
    """Multiply the waves by transmission(wavenumber): complex waves along periodic axes, cosines along free ones."""
    wavenumbers = []
    values: np.ndarray = heights
    for ax in (0, 1):
        n, d = heights.shape[ax], spacing[ax]
        if axis is not None and ax != axis:
            wavenumbers.append(np.zeros(n))
        elif periodic[ax]:
            values = fft.fft(values, axis=ax)
            wavenumbers.append(2 * np.pi * fft.fftfreq(n, d))
        else:
            parts = fft.dct(np.real(values), axis=ax)
            values = parts + 1j * fft.dct(np.imag(values), axis=ax) if np.iscomplexobj(values) else parts
            wavenumbers.append(np.pi * np.arange(n) / (n * d))
    values = values * transmission(np.hypot(wavenumbers[0][:, None], wavenumbers[1][None, :]))
    for ax in (1, 0):
        if axis is not None and ax != axis:
            continue
        if periodic[ax]:
            values = fft.ifft(values, axis=ax)
        else:
            parts = fft.idct(np.real(values), axis=ax)
            values = parts + 1j * fft.idct(np.imag(values), axis=ax) if np.iscomplexobj(values) else parts
    return np.ascontiguousarray(np.real(values))
