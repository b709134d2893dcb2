"""Figures of a finished wear loop: strips of the surface, sizes of particles over cycles.

Knows heights, pressures and the tables of `wear.state`; no scene. Verified in tests/wear/test_outcome.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.grid import FloatArray, Grid
from bem.particles import volume_mean_radius


@dataclass(frozen=True)
class StripWear:
    """Surface in a strip along y: rms heights Sq before and after wear, and mean depth worn [m]."""

    rms_before: float
    rms_after: float
    depth: float


def strip_wear(before: FloatArray, after: FloatArray, strip: NDArray[Any]) -> StripWear:
    """Return the wear of heights (nx, ny) [m] in a strip.

    strip : weight of rows (nx,) or cells (nx, ny): True and False, or the fraction that lies within.
    """
    depth = float(np.average(before - after, weights=_weights(strip, before.shape)))
    return StripWear(rms_within(before, strip), rms_within(after, strip), depth)


def rms_within(heights: FloatArray, strip: NDArray[Any]) -> float:
    """Return the rms height Sq of heights (nx, ny) [m] in a strip, weighted as for `strip_wear`."""
    weights = _weights(strip, heights.shape)
    about = heights - np.average(heights, weights=weights)
    return math.sqrt(float(np.average(about**2, weights=weights)))


def share_outside(before: FloatArray, after: FloatArray, strip: NDArray[Any]) -> float:
    """Return the share of the worn volume beside a strip, weighted as for `strip_wear`; 0 where nothing wore."""
    depth = before - after
    total = float(depth.sum())
    if not total > 0:
        return 0.0
    outside = 1.0 - float((depth * _weights(strip, depth.shape)).sum()) / total
    return outside if abs(outside) > _ROUND_OFF else 0.0


def width_of(strip: NDArray[Any], grid: Grid) -> float | None:
    """Return the width of a strip [m]: along x, or of a track (1, ny) along y; None of the whole surface.

    Round-off of the fractions of cells does not count: a fraction of 1 - 1e-16 is a whole cell.
    """
    weights = np.asarray(strip, dtype=np.float64)
    if weights.ndim == 1:
        weights = weights[:, None]
    if float(weights.min()) > 1 - _WHOLE:
        return None
    if weights.shape[0] == 1:
        return float(weights.sum()) * grid.spacing[1]
    return float(weights.sum(axis=0).max()) * grid.spacing[0]


_ROUND_OFF = 1e-12
"""Share of the worn volume outside a region below which it is that of the sums' rounding."""
_WHOLE = 1e-9
"""Part of a cell by which it may miss a strip and still count as inside; fractions have the round-off of positions over
a cell, below 1e-12."""


def _weights(strip: NDArray[Any], shape: tuple[int, ...]) -> FloatArray:
    """Return the weights of rows (nx,) or cells (nx, ny) as those of cells."""
    weights = np.asarray(strip, dtype=np.float64)
    return np.broadcast_to(weights if weights.ndim == 2 else weights[:, None], shape)


def track_of(strip: NDArray[Any]) -> FloatArray:
    """Return the fraction of the cells (1, ny) or (1, 1) on the track of a contact on a body that moves along x.

    strip : (nx,) or (nx, ny), weight of rows or cells in the contact. All places of a track wear alike, so all rows of
    the body have the same weight. Rows (nx,) are those of a contact without ends along y, whose track is everything.
    """
    parts = np.asarray(strip, dtype=np.float64)
    return np.ones((1, 1)) if parts.ndim == 1 else parts.max(axis=0, keepdims=True)


def contact_strip(pressure: FloatArray, rows: FloatArray | None = None, before: FloatArray | None = None) -> FloatArray:
    """Return the fraction of each row (nx,) within the strip in contact.

    rows : as the contact step gave them; None takes whole rows of the pressure (nx, ny) that are in contact anywhere,
    which jump from grid to grid.
    before : strip of the cycle before, which counts without a contact; None for all rows.
    """
    if rows is not None and rows.any():
        return rows
    touched = np.asarray((pressure != 0).any(axis=1))
    if touched.any():
        return touched.astype(np.float64)
    return np.ones(touched.size) if before is None else before


_CUTS = 8
"""Lines along y through a cell, between which the edge of an ellipse is straight enough: areas are within 0.1 % for a
contact four cells wide, and 0.5 % for one within a cell."""


def hertz_fraction(grid: Grid, half_axes: tuple[float, float]) -> FloatArray:
    """Return the fraction of each cell within Hertz' contact of these half-axes [m].

    Rows (nx,) for a cylinder, whose second half-axis is infinite; cells (nx, ny) for an ellipse. Fractions of cells on
    the edge let figures of the area converge with the cell.
    """
    return _parts_inside(grid.x, grid.y, grid.spacing, half_axes)


def _parts_inside(
    x: FloatArray, y: FloatArray, spacing: tuple[float, float], half_axes: tuple[float, float]
) -> FloatArray:
    """Return fractions as `hertz_fraction`, for cells with their centres at x (nx,) and y (ny,) [m]."""
    (a, b), (dx, dy) = half_axes, spacing
    low, high = (np.clip(x + side * dx / 2, -a, a) for side in (-1, 1))
    if math.isinf(b):
        return np.asarray((high - low) / dx)
    inside = np.zeros((x.size, y.size))
    for cut in (np.arange(_CUTS) + 0.5) / _CUTS:
        reach = b * np.sqrt(1 - ((low + cut * (high - low)) / a) ** 2)[:, None]
        below, above = (np.clip(y + side * dy / 2, -reach, reach) for side in (-1, 1))
        inside += (above - below) / dy
    return np.asarray(inside * ((high - low) / dx)[:, None] / _CUTS)


_OF_HALVES = 0.85
"""Factor on the change of the rms height by half the rows and columns: one third for order two, but cells on the edge
and few cells to a wave converge more slowly. Fitted on 200 surfaces against quarters of the cell."""


def rms_error(heights: FloatArray, grid: Grid, half_axes: tuple[float, float]) -> float:
    """Estimate the discretisation error of the rms height within Hertz' contact [m].

    It is the rms change by every second row and column of the heights (nx, ny) [m], over all ways to choose them.
    """
    spacing = (2 * grid.spacing[0], 2 * grid.spacing[1])

    def rms(x: slice, y: slice, of: tuple[float, float]) -> float:
        within = _parts_inside(grid.x[x], grid.y[y], of, half_axes)
        return rms_within(heights[x, y], within)

    every, ways = slice(None), [[slice(first, None, 2) for first in range(min(n, 2))] for n in grid.shape]
    whole = rms(every, every, grid.spacing)
    return _OF_HALVES * math.sqrt(np.mean([(rms(x, y, spacing) - whole) ** 2 for x in ways[0] for y in ways[1]]))


@dataclass(frozen=True)
class SettledMeans:
    """Means over cycles: contact area over the grid's, mean contact pressure [Pa], nan without a contact, and volume
    worn per cycle [m^3]."""

    contact_area_fraction: float
    mean_contact_pressure: float
    worn_volume_per_cycle: float


def settled_means(cycles: NDArray[np.void], area: float) -> SettledMeans:
    """Return the means of a table of `CYCLE_FIELDS`; area : of the grid [m^2]."""
    touching = cycles[cycles["contact_area"] > 0]
    pressure = (touching["contact_load"] / touching["contact_area"]).mean() if touching.size else np.nan
    return SettledMeans(
        float(cycles["contact_area"].mean() / area),
        float(pressure),
        float(cycles["volume"].mean()),
    )


def criterion_wear_rate(cycles: NDArray[np.void], load: float, cycle_distance: float) -> float | None:
    """Return the wear volume by load and distance [m^3/(N m)]; None without sliding.

    cycles : table of `CYCLE_FIELDS`. load : [N]. cycle_distance : slid in what one computed cycle stands for [m].
    """
    return float(cycles["volume"].mean() / (load * cycle_distance)) if cycle_distance > 0 else None


def drift(series: ArrayLike, window: int = 25, tolerance: float = 0.02) -> float | None:
    """Return the relative change of a figure at the end of a loop; None where it has settled, or for a single cycle.

    The change is that between the means over the last `window` cycles (or the last half of fewer) and over as many
    before them, relative to the larger. The figure has settled if the change is below the tolerance, as in the stop
    rule (`running_in.Settled`), or below two standard errors of the difference.
    """
    values = np.asarray(series, dtype=np.float64)
    values = values[np.isfinite(values)]
    window = min(window, values.size // 2)
    if window == 0:
        return None
    before, after = values[-2 * window : -window], values[-window:]
    change, scale = float(after.mean() - before.mean()), max(abs(before.mean()), abs(after.mean()))
    scatter = math.sqrt((before.var() + after.var()) / max(window - 1, 1))
    return None if abs(change) <= max(tolerance * scale, 2 * scatter) else float(change / scale)


def sizes_over_cycles(cycles: ArrayLike, particles: NDArray[np.void]) -> tuple[FloatArray, FloatArray]:
    """Return the volume-mean radius [m] (nan without particles) and the number of the particles of each cycle."""
    volumes = [particles["volume"][particles["cycle"] == cycle] for cycle in np.asarray(cycles)]
    radius = np.array([volume_mean_radius(volume) or np.nan for volume in volumes])
    return radius, np.array([float(volume.size) for volume in volumes])
