"""A made-up AFM map of wear particles dried on a plate, for scenes and tests: the thesis' own maps are not public.

Nothing here is measured. Sizes are chosen so that the map shows what the thesis reports of its sample: flat particles
whose number-weighted mean equivalent radius is 175 nm and volume-weighted 358 nm (steel, 10 N, 467 particles), from a
log-normal distribution: mean exp(m + s^2/2), volume-weighted mean exp(m + 7 s^2/2).

Knows the generator of surfaces for the plate. Verified in tests/particles/test_particle_height_map.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from scipy.optimize import brentq
from scipy.special import ndtri

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.surfaces.generate import generate_surface

_PROFILE = 8
"""Power of the particles' profile, thickness (1 - rho^8): steep sides, so a threshold takes little of the rim."""
_FILL = _PROFILE / (_PROFILE + 2)
"""Mean over maximum thickness of that profile."""


@dataclass(frozen=True, eq=False)
class SyntheticMap:
    """Heights (nx, ny) [m] on cells of `spacing` [m], and the particles that were put on the plate.

    equivalent_radius, length, width, thickness : (n,) [m]; angle : (n,) of the length to x [rad];
    position : (n, 2) from the middle of the map [m].
    """

    heights: FloatArray = field(repr=False)
    spacing: tuple[float, float]
    equivalent_radius: FloatArray = field(repr=False)
    length: FloatArray = field(repr=False)
    width: FloatArray = field(repr=False)
    thickness: FloatArray = field(repr=False)
    angle: FloatArray = field(repr=False)
    position: FloatArray = field(repr=False)


def synthetic_afm_map(
    *,
    seed: int,
    shape: tuple[int, int] = (1024, 1024),
    lengths: tuple[float, float] = (20e-6, 20e-6),
    count: int = 120,
    number_mean_radius: float = 175e-9,
    volume_mean_radius: float = 358e-9,
    width_over_thickness: float = 4.5,
    length_over_width: float = 1.35,
    plate_rms: float = 5e-9,
    tilt: tuple[float, float] = (2e-3, -1e-3),
) -> SyntheticMap:
    """A map of `count` elliptic particles that do not touch, on a rough, tilted plate.

    Radii are quantiles of a log-normal distribution, scaled so that the particles on the map have exactly these two
    means, without the scatter of a draw; places and angles are random.

    Parameters
    ----------
    shape, lengths : cells and sides of the map [m].
    seed : the same seed gives the same bits.
    count : of particles.
    number_mean_radius, volume_mean_radius : means of their equivalent radii [m].
    width_over_thickness, length_over_width : mean ratios of their sides.
    plate_rms : roughness of the plate [m].
    tilt : its slopes along x and y.

    Raises
    ------
    InputError : sizes out of range, or more particles than find room.
    """
    _check(count, (number_mean_radius, volume_mean_radius), (width_over_thickness, length_over_width), plate_rms)
    grid = Grid(shape, (lengths[0] / shape[0], lengths[1] / shape[1]))
    radius = _radii(count, number_mean_radius, volume_mean_radius)[::-1]  # largest placed first
    # V = fill pi/4 l w t = 4/3 pi R^3
    thickness = radius * (16 / (3 * _FILL * length_over_width * width_over_thickness**2)) ** (1 / 3)
    width = width_over_thickness * thickness
    length = length_over_width * width
    random = np.random.default_rng(seed)
    angle = random.uniform(0, math.pi, count)
    position = _place(random, length / 2, grid)
    x, y = grid.x[:, None], grid.y[None, :]
    heights = tilt[0] * x + tilt[1] * y
    if plate_rms:
        heights = heights + generate_surface(
            grid, rms_height=plate_rms, seed=seed, hurst=0.8, rolloff_wavelength=min(grid.lengths) / 20
        )
    for i in range(count):
        _add_particle(heights, grid, position[i], angle[i], (length[i], width[i], thickness[i]))
    return SyntheticMap(heights, grid.spacing, radius, length, width, thickness, angle, position)


def _check(count: int, radii: tuple[float, float], ratios: tuple[float, float], plate_rms: float) -> None:
    messages = []
    if not (1 <= count <= 10**6):
        messages.append(f"synthetic_afm_map: count {count!r} must be at least 1")
    if not 0 < radii[0] < radii[1] < math.inf:
        messages.append(
            f"synthetic_afm_map: number_mean_radius {radii[0]!r} must be positive and below "
            f"volume_mean_radius {radii[1]!r} [m]"
        )
    for name, value in zip(("width_over_thickness", "length_over_width"), ratios, strict=True):
        if not (math.isfinite(value) and value >= 1):
            messages.append(f"synthetic_afm_map: {name} {value!r} must be at least 1")
    if not (math.isfinite(plate_rms) and plate_rms >= 0):
        messages.append(f"synthetic_afm_map: plate_rms {plate_rms!r} must not be negative [m]")
    if messages:
        raise InputError(messages)


def _add_particle(
    heights: FloatArray, grid: Grid, position: FloatArray, angle: float, sides: tuple[float, float, float]
) -> None:
    """Add, in place, an elliptic particle of (length, width, thickness) [m] with its length at `angle` to x."""
    length, width, thickness = sides
    reach = length / 2
    near_x = np.flatnonzero(np.abs(grid.x - position[0]) <= reach)
    near_y = np.flatnonzero(np.abs(grid.y - position[1]) <= reach)
    if near_x.size == 0 or near_y.size == 0:
        return
    dx, dy = grid.x[near_x][:, None] - position[0], grid.y[near_y][None, :] - position[1]
    along = (dx * math.cos(angle) + dy * math.sin(angle)) / (length / 2)
    across = (-dx * math.sin(angle) + dy * math.cos(angle)) / (width / 2)
    rho2 = along**2 + across**2
    heights[np.ix_(near_x, near_y)] += thickness * np.maximum(1 - rho2 ** (_PROFILE // 2), 0.0)


def _radii(count: int, number_mean: float, volume_mean: float) -> FloatArray:
    normal = ndtri((np.arange(count) + 0.5) / count)

    def ratio(spread: float) -> float:
        radius = np.exp(spread * (normal - normal[-1]))
        return float((radius**4).sum() / (radius**3).sum() / radius.mean())

    # one particle of a radius far beyond all others: the volume mean is it, the number mean 1/count of it
    if not volume_mean / number_mean < 0.95 * count:
        raise InputError(
            f"synthetic_afm_map: {count} particles cannot have a volume mean {volume_mean / number_mean:.3g} times "
            "their number mean"
        )
    spread = brentq(lambda s: ratio(s) - volume_mean / number_mean, 0.0, 50.0, xtol=1e-14)
    radius = np.exp(spread * (normal - normal[-1]))
    return np.asarray(radius * (number_mean / radius.mean()))


def _place(random: np.random.Generator, reach: FloatArray, grid: Grid) -> FloatArray:
    """Random places whose circles of `reach` neither touch each other nor the border; largest first."""
    gap = 2 * max(grid.spacing)
    half = np.array(grid.lengths) / 2
    placed = np.empty((len(reach), 2))
    for i, size in enumerate(reach):
        free = half - size - gap
        for _ in range(2000):
            if (free <= 0).any():
                break
            place = random.uniform(-free, free)
            if (np.hypot(*(placed[:i] - place).T) > reach[:i] + size + gap).all():
                placed[i] = place
                break
        else:
            free = np.zeros(2)
        if (free <= 0).any():
            raise InputError(
                f"synthetic_afm_map: particle {i + 1} of {len(reach)} finds no room on {grid.lengths[0]:.4g} x "
                f"{grid.lengths[1]:.4g} m; take fewer or smaller particles, or a larger map"
            )
    return placed
