"""Undeformed gap between wheel and rail over the tangent plane of a contact point.

A cell of the tangent plane has the coordinates (x, y) from the contact point along the rail and along the profiles'
common tangent. The gap is measured along the common normal: the height of the wheel above the plane less that of the
rail. On a body of revolution the point over a cell is found by Newton's method in arc length and turn; on a prismatic
rail in arc length alone. Verified in tests/profiles/test_gap.py.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray, Grid
from bem.profiles.placement import ContactPoint, WheelOnRail
from bem.profiles.profile import Profile

_NEWTON_STEPS = 12
"""Newton steps; from the section's point they converge quadratically within five."""
_MET = 1e-12
"""Distance [m] of a point from the line over its cell at which it counts as found."""
BESIDE = 2e-3
"""Distance [m] from the contact point at which the gap tells the equivalent radius."""
BEYOND = 1e-3
"""Gap [m] beyond the largest one where a profile ends: no body is there."""


def gap_over_tangent_plane(placed: WheelOnRail, point: ContactPoint, grid: Grid) -> FloatArray:
    """Return the undeformed gap (nx, ny) [m] on a grid whose middle is a contact point, zero where they touch.

    Where one of the profiles ends, the gap is `BEYOND` the largest one.
    """
    wheel = _height_of_wheel(placed, point, grid.x, grid.y)
    gap: FloatArray = wheel - _height_of_rail(placed, point, grid.x, grid.y)
    known = np.isfinite(gap)
    if not known.all():
        gap[~known] = (float(gap[known].max()) if known.any() else 0.0) + BEYOND
    return gap


def covered(placed: WheelOnRail, point: ContactPoint, y: FloatArray) -> NDArray[np.bool_]:
    """Return True where both profiles go on at distances y [m] along the tangent plane of a contact point."""
    wheel = _on_section(placed.wheel.turned(placed.roll), point.wheel_parameter, point.tangent, y)
    return np.isfinite(wheel) & np.isfinite(_on_section(placed.rail, point.rail_parameter, point.tangent, y))


def equivalent_radii(placed: WheelOnRail) -> tuple[float, float]:
    """Return the radii (Rx, Ry) [m] of a paraboloid whose gap is about that near the first contact point.

    Along y the mean gap at `BESIDE` on both sides decides, between radii of 0.1 mm and 100 m: a profile of arcs has no
    one curvature. For estimates of size and pressure only.
    """
    point = placed.contact_points[0]
    beside = Grid((1, 2), (BESIDE, 2 * BESIDE))
    gap = float(gap_over_tangent_plane(placed, point, beside).mean())
    radius = math.inf if gap <= 0 else BESIDE**2 / (2 * gap)
    return 1 / placed.rolling_curvature(point), min(max(radius, 1e-4), 100.0)


def _height_of_wheel(placed: WheelOnRail, point: ContactPoint, x: FloatArray, y: FloatArray) -> FloatArray:
    (ty, tz), (ny, nz) = point.tangent, point.normal
    origin = placed.wheel_surface(np.array([point.wheel_parameter]), np.array([point.turn]))

    def surface(s: FloatArray, turn: FloatArray) -> tuple[FloatArray, ...]:
        """Return distances from the contact point along x, tangent and normal, and their derivatives by s and turn."""
        dy, dz = placed.wheel.slope_at(s)
        radius = placed.rolling_radius + placed.wheel.at(s)[1]
        sine, cosine = np.sin(turn), np.cos(turn)
        at = [one - start[0] for one, start in zip(placed.wheel_surface(s, turn), origin, strict=True)]
        by_s = placed.rotated(dz * sine, dy, dz * cosine)
        by_turn = placed.rotated(radius * cosine, np.zeros_like(s), -radius * sine)
        return (
            at[0], ty * at[1] + tz * at[2], ny * at[1] + nz * at[2],
            by_s[0], ty * by_s[1] + tz * by_s[2], by_turn[0], ty * by_turn[1] + tz * by_turn[2],
        )  # fmt: skip

    profile = placed.wheel.turned(placed.roll)
    return _heights(surface, _on_section(profile, point.wheel_parameter, (ty, tz), y), point.turn,
                    point.rolling_radius, x, y)  # fmt: skip


def _height_of_rail(placed: WheelOnRail, point: ContactPoint, x: FloatArray, y: FloatArray) -> FloatArray:
    (ty, tz), (ny, nz) = point.tangent, point.normal
    on_section = _on_section(placed.rail, point.rail_parameter, (ty, tz), y)
    if math.isinf(placed.rail_radius):
        across, down = placed.rail.at(on_section)
        height: FloatArray = ny * (across - point.y) + nz * (down - point.z)
        return np.broadcast_to(height, (len(x), len(y)))

    def surface(s: FloatArray, turn: FloatArray) -> tuple[FloatArray, ...]:
        (across, down), (dy, dz) = placed.rail.at(s), placed.rail.slope_at(s)
        radius = placed.rail_radius - down
        sine, cosine = np.sin(turn), np.cos(turn)
        across, down = across - point.y, placed.rail_radius - radius * cosine - point.z
        return (
            radius * sine, ty * across + tz * down, ny * across + nz * down,
            -dz * sine, ty * dy + tz * dz * cosine, radius * cosine, tz * radius * sine,
        )  # fmt: skip

    return _heights(surface, on_section, 0.0, placed.rail_radius - point.z, x, y)


def _on_section(profile: Profile, start: float, tangent: tuple[float, float], y: FloatArray) -> FloatArray:
    """Return the arc lengths at distances along the tangent from the point at `start`, not-a-number beyond the ends."""
    at = profile.at(np.array([start]))
    origin = tangent[0] * float(at[0][0]) + tangent[1] * float(at[1][0])
    return profile.parameter_where(tangent, origin + y)


def _heights(
    surface: object, on_section: FloatArray, turn: float, radius: float, x: FloatArray, y: FloatArray
) -> FloatArray:
    """Return the heights (nx, ny) [m] of a body of revolution over the cells, not-a-number where it has none.

    surface : function of arc length and turn, see `_height_of_wheel`. on_section : arc lengths at y, to start from.
    """
    assert callable(surface)
    s = np.broadcast_to(on_section, (len(x), len(y))).copy()
    angle = np.broadcast_to(turn + x[:, None] / radius, s.shape).copy()
    for _ in range(_NEWTON_STEPS):
        along, across, _, xs, ts, xt, tt = surface(s, angle)
        off_x, off_y = along - x[:, None], across - y
        determinant = xs * tt - xt * ts
        s -= (off_x * tt - xt * off_y) / determinant
        angle -= (xs * off_y - ts * off_x) / determinant
    along, across, height, *_ = surface(s, angle)
    met = np.hypot(along - x[:, None], across - y) < _MET + 1e-12 * radius
    return np.where(met, height, np.nan)
