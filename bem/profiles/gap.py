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
"""Newton steps to the point over a cell: from the point of the section they converge quadratically within five."""
_POINT_TOLERANCE = 1e-12
"""Distance of a point from the normal line of its cell at which the point counts as found, in metres and in radii of
the body: far above the rounding of positions, far below any deflection."""
SAMPLED_OFFSET = 2e-3
"""Distance [m] from the contact point, to either side across the rail, of the two gaps that give the equivalent radius:
within the contact of wheel and rail, which is some millimetres wide."""
ABSENT_BODY_GAP = 1e-3
"""Gap [m] where a profile has ended, over the largest gap elsewhere: ten times any deflection, so that no cell touches
where there is no body."""
_SMALLEST_RADIUS, _LARGEST_RADIUS = 1e-4, 100.0
"""Bounds [m] of the equivalent radius across the rail: a sharper edge and a flatter face are no contact of Hertz."""


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
    tangent_y, tangent_z = point.tangent
    return Rows(tangent_y * y, tangent_z * y, np.full_like(y, point.angle))


def rows_on_rail(placed: WheelOnRail, point: ContactPoint, y: FloatArray) -> Rows:
    """Return rows at arc lengths y [m] from a contact point along the rail; straight on beyond its ends."""
    arc_length = point.rail_parameter + y
    inside = np.clip(arc_length, placed.rail.knots[0], placed.rail.knots[-1])
    (rail_y, rail_z), (slope_y, slope_z) = placed.rail.at(inside), placed.rail.slope_at(inside)
    beyond = arc_length - inside
    return Rows(rail_y - point.y + beyond * slope_y, rail_z - point.z + beyond * slope_z, np.arctan2(slope_z, slope_y))


def gap_over_tangent_plane(placed: WheelOnRail, point: ContactPoint, grid: Grid) -> FloatArray:
    """Return the undeformed gap (nx, ny) [m] on a grid whose middle is a contact point, zero where they touch.

    Where one of the profiles has ended, the gap is larger than the largest one by `ABSENT_BODY_GAP`.
    """
    return _gap(placed, point, grid.x, rows_on_tangent_plane(point, grid.y))


def gap_along_rail(placed: WheelOnRail, point: ContactPoint, grid: Grid) -> FloatArray:
    """Return the undeformed gap (nx, ny) [m] along the rail's normals, y the arc length from a contact point.

    Where one of the profiles has ended, the gap is larger than the largest one by `ABSENT_BODY_GAP`.
    """
    return _gap(placed, point, grid.x, rows_on_rail(placed, point, grid.y))


def _gap(placed: WheelOnRail, point: ContactPoint, x: FloatArray, rows: Rows) -> FloatArray:
    """Return the gap (nx, ny) [m] of cells at x (nx,) [m] of the rows, along the rows' normals."""
    gap: FloatArray = _height_of_wheel(placed, point, x, rows) - _height_of_rail(placed, point, x, rows)
    known = np.isfinite(gap)
    if not known.all():
        gap[~known] = (float(gap[known].max()) if known.any() else 0.0) + ABSENT_BODY_GAP
    return gap


def rows_meet_both(placed: WheelOnRail, point: ContactPoint, rows: Rows) -> NDArray[np.bool_]:
    """Return True (ny,) for rows whose normal meets both profiles."""
    wheel = _arc_lengths_on_section(placed.wheel.turned(placed.roll), point.wheel_parameter, rows)
    return np.isfinite(wheel) & np.isfinite(_arc_lengths_on_section(placed.rail, point.rail_parameter, rows))


def equivalent_radii(placed: WheelOnRail) -> tuple[float, float]:
    """Return the radii (Rx, Ry) [m] of a paraboloid whose gap is about that near the first contact point.

    Ry follows from the mean of the gaps at `SAMPLED_OFFSET` on both sides, because a profile of arcs has no one
    curvature; it is bounded. For estimates of size and pressure only.
    """
    point = placed.contact_points[0]
    two_sides = Grid((1, 2), (SAMPLED_OFFSET, 2 * SAMPLED_OFFSET))
    gap = float(gap_over_tangent_plane(placed, point, two_sides).mean())
    radius = math.inf if gap <= 0 else SAMPLED_OFFSET**2 / (2 * gap)
    return 1 / placed.rolling_curvature(point), min(max(radius, _SMALLEST_RADIUS), _LARGEST_RADIUS)


@dataclass(frozen=True, eq=False)
class _SurfacePoints:
    """Points of a body of revolution over a table of cells, in the frame of each row of cells; arrays (nx, ny).

    Attributes
    ----------
    x : distance from the contact point along the rolling direction [m].
    across, height : distances from the row along its tangent and along its normal [m].
    x_by_arc, across_by_arc : derivatives of x and across by the arc length of the profile.
    x_by_turn, across_by_turn : derivatives of x and across by the turn about the axis [m/rad].
    """

    x: FloatArray
    across: FloatArray
    height: FloatArray
    x_by_arc: FloatArray
    across_by_arc: FloatArray
    x_by_turn: FloatArray
    across_by_turn: FloatArray


def _height_of_wheel(placed: WheelOnRail, point: ContactPoint, x: FloatArray, rows: Rows) -> FloatArray:
    """Return the heights (nx, ny) [m] of the wheel along the rows' normals; not-a-number where there is no wheel."""
    (ty, tz), (ny, nz) = rows.tangent, rows.normal
    origin = placed.wheel_surface(np.array([point.wheel_parameter]), np.array([point.turn]))

    def surface_points(arc_length: FloatArray, turn: FloatArray) -> _SurfacePoints:
        """Return the points of the wheel at arc lengths and turns."""
        slope_y, slope_z = placed.wheel.slope_at(arc_length)
        radius = placed.rolling_radius + placed.wheel.at(arc_length)[1]
        sine, cosine = np.sin(turn), np.cos(turn)
        px, py, pz = (
            value - start[0] for value, start in zip(placed.wheel_surface(arc_length, turn), origin, strict=True)
        )
        py, pz = py - rows.y, pz - rows.z
        by_arc = placed.rotated(slope_z * sine, slope_y, slope_z * cosine)
        by_turn = placed.rotated(radius * cosine, np.zeros_like(arc_length), -radius * sine)
        return _SurfacePoints(
            x=px,
            across=ty * py + tz * pz,
            height=ny * py + nz * pz,
            x_by_arc=by_arc[0],
            across_by_arc=ty * by_arc[1] + tz * by_arc[2],
            x_by_turn=by_turn[0],
            across_by_turn=ty * by_turn[1] + tz * by_turn[2],
        )

    on_section = _arc_lengths_on_section(placed.wheel.turned(placed.roll), point.wheel_parameter, rows)
    return _heights(surface_points, on_section, point.turn, point.rolling_radius, x)


def _height_of_rail(placed: WheelOnRail, point: ContactPoint, x: FloatArray, rows: Rows) -> FloatArray:
    """Return the heights (nx, ny) [m] of rail or roller along the rows' normals; not-a-number where it has ended."""
    (ty, tz), (ny, nz) = rows.tangent, rows.normal
    on_section = _arc_lengths_on_section(placed.rail, point.rail_parameter, rows)
    if math.isinf(placed.rail_radius):
        rail_y, rail_z = placed.rail.at(on_section)
        height: FloatArray = ny * (rail_y - point.y - rows.y) + nz * (rail_z - point.z - rows.z)
        return np.broadcast_to(height, (len(x), len(rows.y)))

    def surface_points(arc_length: FloatArray, turn: FloatArray) -> _SurfacePoints:
        """Return the points of the roller at arc lengths and turns."""
        (py, depth), (slope_y, slope_z) = placed.rail.at(arc_length), placed.rail.slope_at(arc_length)
        radius = placed.rail_radius - depth
        sine, cosine = np.sin(turn), np.cos(turn)
        py, pz = py - point.y - rows.y, placed.rail_radius - radius * cosine - point.z - rows.z
        return _SurfacePoints(
            x=radius * sine,
            across=ty * py + tz * pz,
            height=ny * py + nz * pz,
            x_by_arc=-slope_z * sine,
            across_by_arc=ty * slope_y + tz * slope_z * cosine,
            x_by_turn=radius * cosine,
            across_by_turn=tz * radius * sine,
        )

    return _heights(surface_points, on_section, 0.0, placed.rail_radius - point.z, x)


def _arc_lengths_on_section(profile: Profile, start: float, rows: Rows) -> FloatArray:
    """Return the arc lengths (ny,) at which rows' normals meet a profile; not-a-number beyond its ends.

    start : arc length [m] of the profile's contact point, the origin of the rows.
    """
    origin = profile.at(np.array([start]))
    y, z = rows.y + float(origin[0][0]), rows.z + float(origin[1][0])
    tangents_y, tangents_z = rows.tangent
    if np.ptp(rows.angle) == 0:
        tangent = float(tangents_y[0]), float(tangents_z[0])
        return profile.parameter_where(tangent, tangent[0] * y + tangent[1] * z)
    found = [
        profile.parameter_where((float(ty), float(tz)), np.array([ty * row_y + tz * row_z]))[0]
        for ty, tz, row_y, row_z in zip(tangents_y, tangents_z, y, z, strict=True)
    ]
    return np.array(found)


def _heights(
    surface_points: Callable[[FloatArray, FloatArray], _SurfacePoints],
    on_section: FloatArray,
    turn: float,
    radius: float,
    x: FloatArray,
) -> FloatArray:
    """Return the heights (nx, ny) [m] of a body of revolution over the cells, not-a-number where it has none.

    Newton's method in arc length and turn finds the point on the normal line of each cell. It finds none over cells
    that the silhouette of the body leaves out, as beside the tip of a flange; continuation from the next cell does not
    either.

    surface_points : of arc lengths and turns (nx, ny). on_section : arc lengths (ny,) to start from [m].
    turn : of the contact point [rad]. radius : about the axis, there [m]. x : positions of the cells (nx,) [m].
    """
    arc_length = np.broadcast_to(on_section, (len(x), len(on_section))).copy()
    angle = np.broadcast_to(turn + x[:, None] / radius, arc_length.shape).copy()
    for _ in range(_NEWTON_STEPS):
        at = surface_points(arc_length, angle)
        x_error = at.x - x[:, None]
        determinant = at.x_by_arc * at.across_by_turn - at.x_by_turn * at.across_by_arc
        arc_length -= (x_error * at.across_by_turn - at.x_by_turn * at.across) / determinant
        angle -= (at.x_by_arc * at.across - at.across_by_arc * x_error) / determinant
    at = surface_points(arc_length, angle)
    found = np.hypot(at.x - x[:, None], at.across) < _POINT_TOLERANCE + _POINT_TOLERANCE * radius
    return np.where(found, at.height, np.nan)
