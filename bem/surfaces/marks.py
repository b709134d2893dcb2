"""Marks of a tool on a surface, which have phases that waves of random phase do not have: feed marks and cross-hatch.

Turning leaves a cusp of the tool's round nose in each turn's feed. Honing leaves straight grooves of two directions,
one from each way of the stone, wherever its grains happened to be. Both are functions of the place alone, so they are
the same on every grid of one rectangle; what lies between them is a random surface of `generate`, added by the caller.

Sees the grid. Verified in tests/surfaces/test_surface_marks.py: moments and autocorrelation of cusps, covered area and
heights of grooves, directions, each against its closed form.
"""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray, Grid

Lay = Literal["x", "y"]
CELLS_OF_A_MARK = 4
"""Fewest cells of a feed or of a groove's width."""
DIRECTION_TOLERANCE = math.radians(1.0)
"""By how much the direction of a groove may differ, so that it closes on a grid that repeats."""
_WAVES = 64
"""Highest wave number of a direction that closes that is tried."""


def feed_marks(grid: Grid, *, feed: float, nose_radius: float, seed: int, lay: Lay = "y") -> FloatArray:
    """Cusps (nx, ny) [m] that a round nose leaves, of zero mean over a feed; ridges along `lay`.

    Over one feed f the surface is the parabola t^2 / 2 r of the nose's radius r, -f/2 < t < f/2: peak to valley
    f^2 / 8 r, Sq = f^2 / (12 sqrt(5) r), skewness 0.64, kurtosis 2.14. An arc is (f / 4 r)^2 higher in proportion, 6 %
    where feed and radius are one. Where in a feed the first cell lies, the seed says.

    Parameters
    ----------
    grid : where; along an axis that repeats it holds whole feeds.
    feed, nose_radius : [m].
    seed : integer >= 0.
    lay : axis that the ridges run along.

    Raises
    ------
    InputError : a feed that the grid does not resolve or hold, or over the radius.
    """
    across = 0 if lay == "y" else 1
    side, cell = grid.lengths[across], grid.spacing[across]
    messages = []
    if not 0 < feed <= nose_radius < math.inf:
        messages.append(f"feed {feed:.4g} m with nose_radius {nose_radius:.4g} m: 0 < feed <= nose_radius is needed")
    elif feed < CELLS_OF_A_MARK * cell:
        messages.append(f"feed {feed:.4g} m is shorter than {CELLS_OF_A_MARK} cells ({CELLS_OF_A_MARK * cell:.4g} m)")
    elif grid.periodic[across] and abs(side / feed - max(round(side / feed), 1)) > 1e-6:
        below = math.floor(side / feed)
        fits = " or ".join(f"{count * feed:.5g} m" for count in (below, below + 1) if count)
        messages.append(
            f"the grid repeats along {'xy'[across]} after {side:.5g} m, which is {side / feed:.4g} feeds; take "
            f"{fits}, or a feed of {side / max(below, 1):.5g} m"
        )
    if messages:
        raise InputError([f"feed_marks: {message}" for message in messages])
    phase = np.random.default_rng([seed, 1]).random()
    t = (_places(grid, across) / feed + phase) % 1.0 - 0.5
    cusps = feed**2 / (2 * nose_radius) * (t**2 - 1 / 12)
    line = cusps[:, None] if across == 0 else cusps[None, :]
    return np.array(np.broadcast_to(line, grid.shape), order="C")


def cross_hatch(
    grid: Grid, *, angle: float, spacing: float, width: float, depth: float, seed: int, lay: Lay = "y"
) -> FloatArray:
    """Grooves (nx, ny) [m] of two directions, 0 between them and -depth at the lowest; not of zero mean.

    The grooves of a direction are parabolas of one width w and depth, at places that know nothing of each other; where
    grooves cross, the deeper one counts. Of many grooves exp(-2 w / spacing) of the area lies between them, and below
    the depth z the share 1 - exp(-2 w sqrt(1 - z / depth) / spacing).

    Parameters
    ----------
    grid : where. Where it repeats, both directions close on it, at most a degree off what is asked for.
    angle : between both directions [rad], halved by `lay`.
    spacing : of one direction's grooves on average, across them [m].
    width, depth : of a groove [m].
    seed : integer >= 0.
    lay : axis that halves the angle.

    Raises
    ------
    InputError : numbers out of range; grooves that the grid does not resolve, or that do not close on it.
    """
    messages = []
    cell = max(grid.spacing)
    if min(grid.shape) == 1:
        messages.append(f"a grid of {grid.shape[0]} x {grid.shape[1]} cells has no room for two directions")
    if not 0 < angle < math.pi:
        messages.append(f"angle {angle:.4g} rad must lie between 0 and pi")
    if not (0 < width <= spacing < math.inf and 0 < depth < math.inf):
        messages.append(
            f"width {width:.4g} m, spacing {spacing:.4g} m, depth {depth:.4g} m: positive, and no groove wider than "
            "their spacing"
        )
    elif width < CELLS_OF_A_MARK * cell:
        messages.append(f"width {width:.4g} m is less than {CELLS_OF_A_MARK} cells ({CELLS_OF_A_MARK * cell:.4g} m)")
    if messages:
        raise InputError([f"cross_hatch: {message}" for message in messages])
    normal, period = _normal(grid, 0.5 * angle, spacing, lay)
    places = [_places(grid, axis) for axis in (0, 1)]
    random = np.random.default_rng([seed, 2])
    nearest = np.full(grid.shape, np.inf)
    for sign in (1.0, -1.0):
        along = normal[0] * places[0][:, None] + sign * normal[1] * places[1][None, :]
        sides = normal[0] * grid.lengths[0], sign * normal[1] * grid.lengths[1]
        # ends of the rectangle, not of its cells' middles, with which grooves would move
        ends = min(0.0, sides[1]) - width, sides[0] + max(0.0, sides[1]) + width
        np.minimum(nearest, _to_the_nearest(along, ends, period, spacing, random), out=nearest)
    return np.asarray(-depth * np.maximum(1 - (2 * nearest / width) ** 2, 0.0))


def hatch_angle(grid: Grid, angle: float, spacing: float, lay: Lay = "y") -> float:
    """The angle between both directions [rad] that `cross_hatch` draws: the one asked for, or that which closes.

    Raises
    ------
    InputError : none near it closes.
    """
    normal, _ = _normal(grid, 0.5 * angle, spacing, lay)
    across, along = (0, 1) if lay == "y" else (1, 0)
    return 2 * math.atan2(normal[along], normal[across])


def _places(grid: Grid, axis: int) -> FloatArray:
    """Middles of the cells from the grid's edge [m]."""
    return np.asarray((np.arange(grid.shape[axis]) + 0.5) * grid.spacing[axis], dtype=np.float64)


def _normal(grid: Grid, half: float, spacing: float, lay: Lay) -> tuple[tuple[float, float], float | None]:
    """Unit normal of one direction (the other one has its second sign turned), and after how much of it [m] the grooves
    repeat; None on a grid that does not."""
    across, along = (0, 1) if lay == "y" else (1, 0)
    if not any(grid.periodic):
        wave, period = (math.cos(half), math.sin(half)), None
    else:
        wave = _closing(grid.lengths[across], grid.lengths[along], half, spacing, lay)
        length = math.hypot(*wave)
        wave, period = (wave[0] / length, wave[1] / length), 1 / length
    return (wave if lay == "y" else (wave[1], wave[0])), period


def _closing(across: float, along: float, half: float, spacing: float, lay: Lay) -> tuple[float, float]:
    """Wave vector (m / across, n / along), m and n without a common factor, nearest in direction to the one asked for
    among those that hold a groove at least.

    Raises
    ------
    InputError : none is near.
    """
    found = [
        (abs(math.atan2(n / along, m / across) - half), m, n)
        for m in range(1, _WAVES)
        for n in range(1, _WAVES)
        if math.gcd(m, n) == 1 and math.hypot(m / across, n / along) * spacing <= 1
    ]
    off, m, n = min(found, default=(math.inf, 0, 0))
    if off > DIRECTION_TOLERANCE:
        closes = (
            f"; {2 * math.degrees(math.atan2(n / along, m / across)):.4g} deg is the nearest that does" if m else ""
        )
        first, second = ("x", "y") if lay == "y" else ("y", "x")
        fits = max(across, spacing / math.cos(half)), max(across / math.tan(half), spacing / math.sin(half))
        raise InputError(
            f"cross_hatch: grooves {math.degrees(2 * half):.4g} deg from each other, {spacing:.4g} m apart, do not "
            f"close on a grid that repeats after {across:.4g} m along {first} and {along:.4g} m along {second}{closes}"
            f"; {fits[0]:.4g} m and {fits[1]:.4g} m do, or a larger grid"
        )
    return m / across, n / along


def _to_the_nearest(
    along: FloatArray, ends: tuple[float, float], period: float | None, spacing: float, random: np.random.Generator
) -> FloatArray:
    """How far each cell is from the middle of the nearest groove of one direction [m], across it; middles lie between
    both ends, or anywhere in a period."""
    low, high = ends
    room = high - low if period is None else period
    middles = np.sort(random.random(max(1, round(room / spacing)))) * room
    at = along - low if period is None else along % room
    if period is not None:
        middles = np.concatenate([middles[-1:] - room, middles, middles[:1] + room])
    after = np.searchsorted(middles, at)
    left = middles[np.maximum(after - 1, 0)]
    right = middles[np.minimum(after, middles.size - 1)]
    return np.minimum(np.abs(at - left), np.abs(right - at))
