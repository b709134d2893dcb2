"""Results and notes of a contact between the profiles of a wheel and a rail, which several kinds have.

Verified in tests/scenes/test_wheel_rail.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray, Grid
from bem.notes import Note
from bem.notes.contact import CONTACT_BENT, PROFILE_ENDS, SECOND_CONTACT
from bem.scenes import build
from bem.scenes.context import Context, tell
from bem.scenes.records import Figure, Record, Series

if TYPE_CHECKING:
    from bem.contact import ContactSolution
    from bem.profiles import ContactPoint, WheelOnRail
    from bem.profiles.gap import Rows

INCLINED = math.radians(10.0)
"""Difference of the normals [rad] from which pressures on one plane have a wrong direction: its cosine is 1.5 % off."""
TURNED = math.radians(45.0)
"""Turn of the normals across a contact [rad] from which half-spaces turned with the surface are 1 % off for a shaft in
a hole."""
NEAR = 2e-4
"""Gap [m] of a second contact point up to which it is told."""

_given = partial(Figure, optional=True, unjudged=True)
_points = partial(Series, ("contact_point",))
_wheel, _rail = partial(Series, ("wheel_point",)), partial(Series, ("rail_point",))


@dataclass(frozen=True, eq=False, kw_only=True)
class WheelRailRecord(Record):
    """Contact points of a wheel on a rail, the size of the contact, and both profiles; nothing of other shapes."""

    contact_angle: Annotated[
        float | None, _given("deg", "contact angle: of the tangent plane, positive down to the right", headline=True)
    ] = None
    contact_position: Annotated[float | None, _given("m", "position of the contact point on the rail")] = None
    contact_rolling_radius: Annotated[float | None, _given("m", "rolling radius at the contact point")] = None
    contact_length: Annotated[float | None, _given("m", "length of the contact along x, counted in cells")] = None
    contact_width: Annotated[float | None, _given("m", "width of the contact along y, counted in cells")] = None
    second_contact_gap: Annotated[float | None, _given("m", "gap at a second contact point before loading")] = None
    second_contact_angle: Annotated[float | None, _given("deg", "contact angle at a second contact point")] = None
    contact_point_y: Annotated[FloatArray | None, _points("m", "contact points: y on the rail")] = None
    contact_point_z: Annotated[FloatArray | None, _points("m", "contact points: z on the rail, down")] = None
    contact_point_angle: Annotated[FloatArray | None, _points("rad", "contact points: contact angle")] = None
    contact_point_gap: Annotated[FloatArray | None, _points("m", "contact points: gap before loading")] = None
    row_y: Annotated[FloatArray | None, Series(("y",), "m", "rows of cells: y on the rail")] = None
    row_z: Annotated[FloatArray | None, Series(("y",), "m", "rows of cells: z on the rail, down")] = None
    row_angle: Annotated[FloatArray | None, Series(("y",), "rad", "rows of cells: angle of their tangent")] = None
    wheel_profile_y: Annotated[FloatArray | None, _wheel("m", "profile of the wheel on the rail: y")] = None
    wheel_profile_z: Annotated[FloatArray | None, _wheel("m", "profile of the wheel on the rail: z, down")] = None
    rail_profile_y: Annotated[FloatArray | None, _rail("m", "profile of the rail: y")] = None
    rail_profile_z: Annotated[FloatArray | None, _rail("m", "profile of the rail: z, down")] = None


def fields(scene: Any, grid: Grid, contact: ContactSolution) -> dict[str, Any]:
    """Return the fields of `WheelRailRecord`; none where the shape is no wheel on a rail."""
    if scene.shape.kind != "profiles":
        return {}
    placed: WheelOnRail = scene.shape.placed()
    points = placed.contact_points
    first, second = points[0], points[1] if len(points) > 1 else None
    rows = _rows(scene, placed, grid.y)
    touched: NDArray[np.bool_] = np.asarray(contact.pressure > 0)
    wheel_y, wheel_z = _section_of_wheel(placed, first)
    rail_y, rail_z = placed.rail.at(placed.rail.samples)
    return {
        "contact_angle": first.angle,
        "contact_position": first.y,
        "contact_rolling_radius": first.rolling_radius,
        "contact_length": grid.spacing[0] * _extent(np.any(touched, axis=1)),
        "contact_width": grid.spacing[1] * _extent(np.any(touched, axis=0)),
        "second_contact_gap": None if second is None else second.gap,
        "second_contact_angle": None if second is None else second.angle,
        "contact_point_y": np.array([point.y for point in points]),
        "contact_point_z": np.array([point.z for point in points]),
        "contact_point_angle": np.array([point.angle for point in points]),
        "contact_point_gap": np.array([point.gap for point in points]),
        "row_y": first.y + rows.y,
        "row_z": first.z + rows.z,
        "row_angle": rows.angle,
        "wheel_profile_y": wheel_y,
        "wheel_profile_z": wheel_z,
        "rail_profile_y": rail_y,
        "rail_profile_z": rail_z,
    }


def tell_profiles(scene: Any, grid: Grid, contact: ContactSolution, context: Context) -> None:
    """Note a second contact, a contact over which the normals turn, and one that ends with a profile."""
    if scene.shape.kind != "profiles" or not contact.pressure.any():
        return
    from bem.profiles.gap import rows_meet_both

    placed: WheelOnRail = scene.shape.placed()
    first = placed.contact_points[0]
    seconds = [_second_contact(scene, grid, contact, first, other) for other in placed.contact_points[1:]]
    # the nearest one of each kind: profiles with ripples have many
    tell(context, {note.values["reason"]: note for note in reversed(seconds) if note is not None}.values())
    columns = np.flatnonzero((contact.pressure > 0).any(axis=0))
    low, high = max(int(columns[0]) - 1, 0), min(int(columns[-1]) + 1, grid.shape[1] - 1)
    if not rows_meet_both(placed, first, _rows(scene, placed, grid.y[[low, high]])).all():
        tell(context, [PROFILE_ENDS()])
        return
    edges = grid.y[[columns[0], columns[-1]]]
    if scene.shape.conforming:
        turned = float(abs(np.diff(_rows(scene, placed, edges).angle)[0]))
        if turned > TURNED:
            tell(context, [CONTACT_BENT(angle=math.degrees(turned), reason="turned")])
        return
    turned = _turn_across(placed, first, edges)
    if turned > INCLINED:
        tell(context, [CONTACT_BENT(angle=math.degrees(turned), reason="bent")])


def _second_contact(
    scene: Any, grid: Grid, contact: ContactSolution, first: ContactPoint, other: ContactPoint
) -> Note | None:
    """Return the note on a further contact point; None of one that stays far open."""
    across, along = other.y - first.y, other.z - first.z
    beside = math.hypot(across, along)
    turned = abs(other.angle - first.angle)
    conforming = bool(scene.shape.conforming)
    away = across * first.tangent[0] + along * first.tangent[1]
    if conforming:
        away = other.rail_parameter - first.rail_parameter
    inside = abs(away) < 0.5 * grid.lengths[1]
    # the bodies come closer by the approach, less what the load of the first contact moves the surfaces there
    closing = contact.approach * math.cos(turned) - contact.load / (math.pi * build.modulus_of(scene) * beside)
    told: dict[str, Any] = {
        "beside": beside,
        "angle": math.degrees(other.angle),
        "gap": other.gap,
        "closing": max(closing, 0.0),
    }
    if inside:
        return SECOND_CONTACT(reason="inclined" if turned > INCLINED and not conforming else "inside", **told)
    if closing > other.gap:
        return SECOND_CONTACT(reason="left-out", **told)
    return SECOND_CONTACT(reason="open", **told) if other.gap < NEAR else None


def _rows(scene: Any, placed: WheelOnRail, y: FloatArray) -> Rows:
    """Return the rows of cells at the distances y [m] of the grid."""
    from bem.profiles.gap import rows_on_rail, rows_on_tangent_plane

    first = placed.contact_points[0]
    return rows_on_rail(placed, first, y) if scene.shape.conforming else rows_on_tangent_plane(first, y)


def _turn_across(placed: WheelOnRail, point: ContactPoint, y: FloatArray) -> float:
    """Return the angle [rad] between the rail's normals at two distances y along the tangent plane [m]."""
    along = point.tangent
    origin = along[0] * point.y + along[1] * point.z
    dy, dz = placed.rail.slope_at(placed.rail.parameter_where(along, origin + y))
    angles = np.arctan2(dz, dy)
    return float(abs(angles[1] - angles[0]))


def _section_of_wheel(placed: WheelOnRail, point: ContactPoint) -> tuple[FloatArray, FloatArray]:
    """Return y and z [m] of the wheel's locus, lowered until it touches."""
    s = placed.wheel.samples
    turn = placed.silhouette(s)
    _, y, z = placed.wheel_surface(s, turn)
    _, _, here = placed.wheel_surface(np.array([point.wheel_parameter]), np.array([point.turn]))
    known = np.isfinite(turn)
    return y[known], (z + (point.z - here))[known]


def _extent(touched: NDArray[np.bool_]) -> int:
    """Return the number of cells from the first to the last one that is touched."""
    cells = np.flatnonzero(touched)
    return int(cells[-1] - cells[0] + 1) if len(cells) else 0
