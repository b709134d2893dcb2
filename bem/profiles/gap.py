"""Undeformed gap between wheel and rail, over the tangent plane of a contact point or along the profile of the rail.

Rows of cells lie beside one another across the rail. Over the tangent plane a row has the distance y from the contact
point along the common tangent, and all have the common normal; along the rail y is the arc length, and each row has the
rail's normal there. The gap is measured along a row's normal: the height of the wheel less that of the rail. On a body
of revolution the point over a cell is found by Newton's method in arc length and turn; on a prismatic rail in arc
length alone. Verified in tests/profiles/test_gap.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

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

_Surface = Callable[[FloatArray, FloatArray], tuple[FloatArray, ...]]


@dataclass(frozen=True, eq=False)
class Rows:
    """Rows of cells across the rail.

    Attributes
    ----------
    y, z : positions from the contact point, (ny,) [m].
    angle : of their tangents to the horizontal, (ny,) [rad].
    """

    y: FloatArray
    z: FloatArray
    angle: FloatArray

    @property
    def tangent(self) -> tuple[FloatArray, FloatArray]:
        """Lateral directions (y, z)."""
        return np.cos(self.angle), np.sin(self.angle)

    @property
    def normal(self) -> tuple[FloatArray, FloatArray]:
        """Directions from the rail to the wheel (y, z)."""
        return np.sin(self.angle), -np.cos(self.angle)


def rows_on_tangent_plane(point: ContactPoint, y: FloatArray) -> Rows:
    """Return rows at distances y [m] from a contact point along its tangent."""
    along, down = point.tangent
    return Rows(along * y, down * y, np.full_like(y, point.angle))


def rows_on_rail(placed: WheelOnRail, point: ContactPoint, y: FloatArray) -> Rows:
    """Return rows at arc lengths y [m] from a contact point along the rail; straight on beyond its ends."""
    s = point.rail_parameter + y
    inside = np.clip(s, placed.rail.knots[0], placed.rail.knots[-1])
    (across, down), (dy, dz) = placed.rail.at(inside), placed.rail.slope_at(inside)
    return Rows(across - point.y + (s - inside) * dy, down - point.z + (s - inside) * dz, np.arctan2(dz, dy))


def gap_over_tangent_plane(placed: WheelOnRail, point: ContactPoint, grid: Grid) -> FloatArray:
    """Return the undeformed gap (nx, ny) [m] on a grid whose middle is a contact point, zero where they touch.

    Where one of the profiles ends, the gap is `BEYOND` the largest one.
    """
    return _gap(placed, point, grid.x, rows_on_tangent_plane(point, grid.y))


def gap_along_rail(placed: WheelOnRail, point: ContactPoint, grid: Grid) -> FloatArray:
    """Return the undeformed gap (nx, ny) [m] along the rail's normals, y the arc length from a contact point.

    Where one of the profiles ends, the gap is `BEYOND` the largest one.
    """
    return _gap(placed, point, grid.x, rows_on_rail(placed, point, grid.y))


def _gap(placed: WheelOnRail, point: ContactPoint, x: FloatArray, rows: Rows) -> FloatArray:
    gap: FloatArray = _height_of_wheel(placed, point, x, rows) - _height_of_rail(placed, point, x, rows)
    known = np.isfinite(gap)
    if not known.all():
        gap[~known] = (float(gap[known].max()) if known.any() else 0.0) + BEYOND
    return gap


def covered(placed: WheelOnRail, point: ContactPoint, rows: Rows) -> NDArray[np.bool_]:
    """Return True for rows over which both profiles go on."""
    wheel = _on_section(placed.wheel.turned(placed.roll), point.wheel_parameter, rows)
    return np.isfinite(wheel) & np.isfinite(_on_section(placed.rail, point.rail_parameter, rows))


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


def _height_of_wheel(placed: WheelOnRail, point: ContactPoint, x: FloatArray, rows: Rows) -> FloatArray:
    (ty, tz), (ny, nz) = rows.tangent, rows.normal
    origin = placed.wheel_surface(np.array([point.wheel_parameter]), np.array([point.turn]))

    def surface(s: FloatArray, turn: FloatArray) -> tuple[FloatArray, ...]:
        """Return distances from the rows along x, tangent and normal, and derivatives of the first two by s and
        turn."""
        dy, dz = placed.wheel.slope_at(s)
        radius = placed.rolling_radius + placed.wheel.at(s)[1]
        sine, cosine = np.sin(turn), np.cos(turn)
        along, across, down = (one - start[0] for one, start in zip(placed.wheel_surface(s, turn), origin, strict=True))
        across, down = across - rows.y, down - rows.z
        by_s = placed.rotated(dz * sine, dy, dz * cosine)
        by_turn = placed.rotated(radius * cosine, np.zeros_like(s), -radius * sine)
        return (
            along, ty * across + tz * down, ny * across + nz * down,
            by_s[0], ty * by_s[1] + tz * by_s[2], by_turn[0], ty * by_turn[1] + tz * by_turn[2],
        )  # fmt: skip

    on_section = _on_section(placed.wheel.turned(placed.roll), point.wheel_parameter, rows)
    return _heights(surface, on_section, point.turn, point.rolling_radius, x)


def _height_of_rail(placed: WheelOnRail, point: ContactPoint, x: FloatArray, rows: Rows) -> FloatArray:
    (ty, tz), (ny, nz) = rows.tangent, rows.normal
    on_section = _on_section(placed.rail, point.rail_parameter, rows)
    if math.isinf(placed.rail_radius):
        across, down = placed.rail.at(on_section)
        height: FloatArray = ny * (across - point.y - rows.y) + nz * (down - point.z - rows.z)
        return np.broadcast_to(height, (len(x), len(rows.y)))

    def surface(s: FloatArray, turn: FloatArray) -> tuple[FloatArray, ...]:
        (across, down), (dy, dz) = placed.rail.at(s), placed.rail.slope_at(s)
        radius = placed.rail_radius - down
        sine, cosine = np.sin(turn), np.cos(turn)
        across, down = across - point.y - rows.y, placed.rail_radius - radius * cosine - point.z - rows.z
        return (
            radius * sine, ty * across + tz * down, ny * across + nz * down,
            -dz * sine, ty * dy + tz * dz * cosine, radius * cosine, tz * radius * sine,
        )  # fmt: skip

    return _heights(surface, on_section, 0.0, placed.rail_radius - point.z, x)


def _on_section(profile: Profile, start: float, rows: Rows) -> FloatArray:
    """Return the arc lengths (ny,) at which rows' normals meet a profile whose point at `start` is the contact point;
    not-a-number beyond the ends."""
    at = profile.at(np.array([start]))
    y, z = rows.y + float(at[0][0]), rows.z + float(at[1][0])
    along, down = rows.tangent
    if np.ptp(rows.angle) == 0:
        tangent = float(along[0]), float(down[0])
        return profile.parameter_where(tangent, tangent[0] * y + tangent[1] * z)
    found = [
        profile.parameter_where((float(a), float(d)), np.array([a * one + d * two]))[0]
        for a, d, one, two in zip(along, down, y, z, strict=True)
    ]
    return np.array(found)


def _heights(surface: _Surface, on_section: FloatArray, turn: float, radius: float, x: FloatArray) -> FloatArray:
    """Return the heights (nx, ny) [m] of a body of revolution over the cells, not-a-number where it has none.

    Newton's method finds no point over cells that the silhouette of the body leaves out, as beside the tip of a
    flange; continuation from the next cell does not either.

    surface : function of arc length and turn, see `_height_of_wheel`. on_section : arc lengths to start from.
    """
    s = np.broadcast_to(on_section, (len(x), len(on_section))).copy()
    angle = np.broadcast_to(turn + x[:, None] / radius, s.shape).copy()
    for _ in range(_NEWTON_STEPS):
        along, across, _, xs, ts, xt, tt = surface(s, angle)
        off_x = along - x[:, None]
        determinant = xs * tt - xt * ts
        s -= (off_x * tt - xt * across) / determinant
        angle -= (xs * across - ts * off_x) / determinant
    along, across, height, *_ = surface(s, angle)
    met = np.hypot(along - x[:, None], across) < _MET + 1e-12 * radius
    return np.where(met, height, np.nan)
