"""Figures of a finished wear loop: strips of the surface, sizes of particles over cycles.

Knows heights, pressures and the tables of `wear.state`; no scene. Verified in tests/wear/test_outcome.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.grid import FloatArray, Grid
from bem.particles import volume_mean_radius


@dataclass(frozen=True)
class StripWear:
    """A surface in a strip along y before and after wear [m]: its rms heights Sq, and the mean depth worn."""

    rms_before: float
    rms_after: float
    depth: float


def strip_wear(before: FloatArray, after: FloatArray, strip: NDArray[np.bool_]) -> StripWear:
    """Of heights (nx, ny) [m] in those rows (nx,) or cells (nx, ny)."""
    depth = float((before - after)[strip].mean())
    return StripWear(float(before[strip].std()), float(after[strip].std()), depth)


def contact_strip(pressure: FloatArray) -> NDArray[np.bool_]:
    """The rows (nx,) of a pressure (nx, ny) that are in contact anywhere; all where none is."""
    touched = np.asarray((pressure != 0).any(axis=1))
    return touched if touched.any() else ~touched


def hertz_strip(x: FloatArray, half_width: float) -> NDArray[np.bool_]:
    """The rows at x (nx,) [m] within Hertz' contact; of one narrower than a cell, those next to the axis."""
    nearest = float(np.abs(x).min()) * (1 + 1e-9)  # on either side of it
    return np.abs(x) <= max(half_width, nearest)


def hertz_area(grid: Grid, half_axes: tuple[float, float]) -> NDArray[np.bool_]:
    """What of a grid lies within Hertz' contact of these half-axes [m]: rows (nx,) of a cylinder's, cells (nx, ny) of
    an ellipse; of a contact narrower than a cell those next to its middle."""
    (a, b), x, y = half_axes, grid.x, grid.y
    if math.isinf(b):
        return hertz_strip(x, a)
    a, b = (max(half, float(np.abs(at).min()) * 1.5) for half, at in zip(half_axes, (x, y), strict=True))
    return np.asarray((x[:, None] / a) ** 2 + (y[None, :] / b) ** 2 <= 1)


@dataclass(frozen=True)
class SettledMeans:
    """Means over cycles: contact area over that of the grid, pressure over the contact [Pa], volume worn [m^3]; the
    pressure over cycles with contact, nan without any."""

    contact_area_fraction: float
    mean_contact_pressure: float
    worn_volume_per_cycle: float


def settled_means(cycles: NDArray[np.void], area: float) -> SettledMeans:
    """Of rows of `CYCLE_FIELDS`, on a grid of an area [m^2]."""
    touching = cycles[cycles["contact_area"] > 0]
    pressure = (touching["contact_load"] / touching["contact_area"]).mean() if touching.size else np.nan
    return SettledMeans(
        float(cycles["contact_area"].mean() / area),
        float(pressure),
        float(cycles["volume"].mean()),
    )


def criterion_wear_rate(cycles: NDArray[np.void], load: float, slide: float) -> float | None:
    """What leaves by load and distance [m^3/(N m)], of rows of `CYCLE_FIELDS` with a slide [m] each, under a load [N];
    None where nothing slides."""
    return float(cycles["volume"].mean() / (load * slide)) if slide > 0 else None


def step_error(memory: FloatArray | None) -> float | None:
    """What the steps of a local law leave open of the depth worn [m], an estimate of first order; None without steps.

    A step has the pressure of its end, and half of what the next changes is its error. Those of earlier steps shrink:
    where too little left, the pressure is higher from then on. So it is half the change between the last two steps,
    at most, where both wear; `memory` : their depths, (2, rows, ny) [m].
    """
    if memory is None:
        return None
    both = (memory > 0).all(axis=0)
    return float(0.5 * np.abs(memory[1] - memory[0])[both if both.any() else ...].max())


def drift(series: ArrayLike, window: int = 25, tolerance: float = 0.02) -> float | None:
    """By how much of itself a figure still changes at the last cycle; None where it has settled, or of one cycle.

    The mean over the last `window` cycles, or the last half of fewer, against that of as many before them, relative to
    the larger: settled where that is below the tolerance, as of the rule that stops a loop (`running_in.Settled`), or
    below two standard errors of the difference as cycles scatter.
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
    """Volume-mean radius [m] (not-a-number where nothing came off) and number of the particles of each cycle."""
    volumes = [particles["volume"][particles["cycle"] == cycle] for cycle in np.asarray(cycles)]
    radius = np.array([volume_mean_radius(volume) or np.nan for volume in volumes])
    return radius, np.array([float(volume.size) for volume in volumes])
