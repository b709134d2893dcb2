"""Spikes of an instrument: one test for their removal, for the caution on them and for the proposal to remove them.

`despike` makes them missing, `count_spikes` counts them in heights, `spikes_of` in a surface that was read. Verified in
tests/surfaces/test_spikes_on_slopes_and_lays.py, test_gaussian_maps_have_no_spikes.py and
test_self_affine_maps_have_no_spikes.py.
"""

from __future__ import annotations

import math

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.surfaces.filter import trend
from bem.surfaces.surface import Surface, check_map

LEAST_SPIKE = 3.0
"""Smallest threshold of `despike`, in standard deviations: below it much of a sound surface would go."""
SPIKE = 6.0
"""Standard deviations off the neighbours from which a point counts as a spike where nothing else is asked."""
MOST_SPIKES = 0.005
"""Share of points that may be spikes of an instrument; more points that stand out are texture."""

_HALF = 3
"""Half the length of the lines through a point, in points; the median of seven sees no spike of three."""
_DIRECTIONS = ((1, 0), (0, 1), (1, 1), (1, -1), (2, 1), (1, 2), (2, -1), (1, -2))
"""Directions of the lines, in points along x and y."""
_POINTS_AT_ONCE = 1 << 15
"""Points whose neighbourhoods are in memory together: some 40 MB."""


def despike(heights: FloatArray, spacing: tuple[float, float], threshold: float = SPIKE) -> FloatArray:
    """Heights with the spikes of an instrument made missing (nan), for `fill_missing`.

    A point is a spike where it stands out from its neighbours by more than `threshold` standard deviations in three
    ways, after the second-order form of the map and the slope at the point are subtracted:

    1. its difference from the median of the 5 x 5 points around it, in standard deviations of this difference over the
       map;
    2. the same difference, in standard deviations of the 25 points about their median: the summits of a smooth map
       differ from the median by their curvature, as their neighbours do;
    3. its differences from the median of 7 points on each of eight lines through it, in standard deviations of the
       first: a groove or ridge of a ground surface shares its height with its neighbours along the lay (multistage
       median, Nieminen, Heinonen and Neuvo, *IEEE Trans. Pattern Anal. Mach. Intell.* 9 (1987) 74; quoted from memory).

    Standard deviations are 1.4826 times the median absolute value, so that spikes do not count in them (Hampel, *J. Am.
    Stat. Assoc.* 69 (1974) 383). A plane or a parabola added to the heights changes nothing but rounding.

    At 6, Gaussian roughness loses nothing: self-affine, smooth or with a lay of up to 20 times the length (tests).
    Lone particles and pits of up to 3 x 3 points go with the spikes. Spots that are four points long in any direction
    stay (but for corners of large ones): more than half of the seven points on a line are theirs.

    heights : (nx, ny) [m], nan where points are missing. threshold : at least 3.

    Raises
    ------
    InputError : heights that are no map, a threshold below 3.
    """
    from scipy.ndimage import distance_transform_edt, median_filter

    if not (math.isfinite(threshold) and threshold >= LEAST_SPIKE):
        raise InputError(f"despike: threshold {threshold!r} must be at least {LEAST_SPIKE:g} standard deviations")
    heights, spacing = check_map(heights, spacing, missing=True)
    known = ~np.isnan(heights)
    if not known.any():
        return heights
    level = heights - trend(heights, curved=True)
    # the first look fills holes with the nearest points, and goes on with the last ones across an edge
    nearest = distance_transform_edt(~known, sampling=spacing, return_distances=False, return_indices=True)
    whole = level[tuple(nearest)]
    difference = np.abs(whole - median_filter(whole, size=5, mode="nearest"))
    deviation = 1.4826 * float(np.median(difference[known]))
    if deviation == 0:
        return heights
    spikes = known & (difference > threshold * deviation)
    level = np.pad(level, _HALF, constant_values=math.nan)
    for points in np.array_split(np.argwhere(spikes), math.ceil(int(spikes.sum()) / _POINTS_AT_ONCE) or 1):
        ix, iy = points.T
        spikes[ix, iy] = _stands_out(_windows(level, points), threshold, deviation)
    return np.where(spikes, np.nan, heights)


def _median(values: FloatArray) -> FloatArray:
    """Return the median of each row of (m, n) without its missing values (nan); nan where all are missing."""
    ordered = np.sort(values, axis=1)  # nan last
    known = np.count_nonzero(~np.isnan(ordered), axis=1)
    rows = np.arange(len(values))
    return np.asarray(0.5 * (ordered[rows, np.maximum(known - 1, 0) // 2] + ordered[rows, known // 2]))


def _windows(heights: FloatArray, points: np.ndarray) -> FloatArray:
    """Return the 7 x 7 points around each point less the slope there, (m, 7, 7) [m].

    heights : (nx + 6, ny + 6), nan where missing and outside the map. points : (m, 2), indices in the map.
    The slope is the median of the differences of neighbours among the middle 5 x 5 points: spikes do not count in it.
    """
    size = 2 * _HALF + 1
    windows = np.lib.stride_tricks.sliding_window_view(heights, (size, size))[points[:, 0], points[:, 1]]
    middle = windows[:, 1:-1, 1:-1]
    steps = np.arange(-_HALF, _HALF + 1)
    along_x, along_y = (np.nan_to_num(_median(np.diff(middle, axis=axis).reshape(-1, 20))) for axis in (1, 2))
    return np.asarray(
        windows - along_x[:, None, None] * steps[None, :, None] - along_y[:, None, None] * steps[None, None, :]
    )


def _stands_out(windows: FloatArray, threshold: float, deviation: float) -> np.ndarray:
    """Return which middles of windows stand out from the 5 x 5 points around them, and from the lines through them.

    windows : (m, 7, 7) [m], nan where missing; a line with less than half of its points tells nothing.
    deviation : standard deviation over the map of the difference from the median [m].
    """
    middle = windows[:, _HALF, _HALF]
    around = windows[:, 1:-1, 1:-1].reshape(-1, 25)
    median = _median(around)
    local = 1.4826 * _median(np.abs(around - median[:, None]))
    found = np.abs(middle - median) > threshold * np.maximum(deviation, local)
    for direction in _DIRECTIONS:
        ix, iy = _line(direction)
        line = windows[:, ix, iy]
        short = np.count_nonzero(~np.isnan(line), axis=1) <= _HALF
        found &= short | (np.abs(middle - _median(line)) > threshold * deviation)
    return np.asarray(found)


def _line(direction: tuple[int, int]) -> tuple[np.ndarray, np.ndarray]:
    """Return the indices in a window of the points nearest to a line through its middle."""
    steps = np.arange(-_HALF, _HALF + 1)
    longer = max(abs(part) for part in direction)
    ix, iy = (np.sign(steps * part) * ((2 * np.abs(steps * part) + longer) // (2 * longer)) for part in direction)
    return ix + _HALF, iy + _HALF


def count_spikes(heights: FloatArray, spacing: tuple[float, float], threshold: float = SPIKE) -> int:
    """Return the number of points that `despike` would make missing."""
    return int(np.count_nonzero(np.isnan(despike(heights, spacing, threshold)) & ~np.isnan(heights)))


def spikes_of(surface: Surface, threshold: float = SPIKE) -> int:
    """Return the number of spikes in a surface: those that reading its file with `despike` takes out.

    Points that were filled do not count. Where the points are more than can be spikes of an instrument, they are
    texture and the number is zero.
    """
    found = count_spikes(surface.measured_heights, surface.spacing, threshold)
    return found if found < MOST_SPIKES * surface.heights.size else 0
