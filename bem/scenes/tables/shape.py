"""The table `[shape]`."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field, model_validator

from bem.errors import InputError
from bem.scenes.common import PositiveLength, Table, problem
from bem.scenes.keys import key
from bem.scenes.profile import ProfileScene
from bem.scenes.units import Angle, Length

if TYPE_CHECKING:
    from bem.profiles import WheelOnRail

_NEEDED: dict[str, tuple[str, ...]] = {
    "flat": (),
    "sphere": ("radius",),
    "cylinder": ("radius",),
    "ellipsoid": ("radius", "radius_y"),
    "sinusoid": ("amplitude", "wavelength"),
    "profiles": ("wheel", "rail", "rolling_radius"),
}
_OPTIONAL: dict[str, tuple[str, ...]] = {"profiles": ("rail_radius", "lateral", "roll", "yaw", "conforming")}


class ShapeScene(Table):
    """Smooth shape of the upper body, which touches at the middle of the grid."""

    kind: Literal["flat", "sphere", "cylinder", "ellipsoid", "sinusoid", "profiles"] = key(
        "Shape: flat, sphere, cylinder (along y), ellipsoid, sinusoid, or profiles of a wheel (upper body) on a rail.",
        "basic",
        default="flat",
    )
    radius: PositiveLength | None = key(
        "Radius of the sphere or cylinder; of an ellipsoid along x.", "basic", default=None, example="10 mm"
    )
    radius_y: PositiveLength | None = key("Radius of the ellipsoid along y.", "advanced", default=None, example="20 mm")
    amplitude: PositiveLength | None = key("Amplitude of the sinusoid.", "advanced", default=None, example="1 um")
    wavelength: PositiveLength | None = key("Wavelength of the sinusoid.", "advanced", default=None, example="50 um")
    wheel: ProfileScene | None = key(
        "Profile of the wheel, its origin at the tape circle: a name of the catalogue, or a table with path.",
        "advanced",
        default=None,
        example="s1002",
    )
    rail: ProfileScene | None = key(
        "Profile of the rail: a name of the catalogue, or a table with path.",
        "advanced",
        default=None,
        example={"catalogue": "60e1", "inclination": "-1.432 deg"},
    )
    rolling_radius: PositiveLength | None = key(
        "Radius of the wheel at the origin of its profile.", "advanced", default=None, example="460 mm"
    )
    rail_radius: PositiveLength | None = key(
        "Radius of a roller at the origin of the rail's profile.",
        "advanced",
        default=None,
        reason="a straight rail",
        example="500 mm",
    )
    lateral: Length | None = key(
        "Position of the wheel's origin to the right (+y) of the rail's.",
        "advanced",
        default=None,
        reason="0",
        example="2 mm",
    )
    roll: Annotated[Angle, Field(ge=-0.3, le=0.3)] | None = key(
        "Rotation of the wheel about x, right side down.", "advanced", default=None, reason="0", example="0.1 deg"
    )
    yaw: Annotated[Angle, Field(ge=-0.3, le=0.3)] | None = key(
        "Rotation of the wheel about the vertical, right side backwards.",
        "advanced",
        default=None,
        reason="0",
        example="0.5 deg",
    )

    conforming: bool | None = key(
        "Solve on the curved surface of the rail, y its arc length, not on the tangent plane; for the kinds contact "
        "and rolling.",
        "advanced",
        default=None,
        reason="false",
        strict=True,
    )

    @model_validator(mode="after")
    def _parameters(self) -> ShapeScene:
        wanted, also = _NEEDED[self.kind], _OPTIONAL.get(self.kind, ())
        given = tuple(name for name in type(self).model_fields if name != "kind" and getattr(self, name) is not None)
        if not set(wanted) <= set(given) <= {*wanted, *also}:
            more = f", and {', '.join(also)}" if also else ""
            raise problem(
                f"a {self.kind} has {', '.join(given) or 'no parameters'}",
                f"{' and '.join(wanted) or 'none'} for this kind{more}",
            )
        if self.kind == "profiles":
            try:
                _ = self.placed().contact_points
            except InputError as error:
                raise problem(*_mistake_and_remedy(error.messages[0])) from None
        return self

    @property
    def radii(self) -> tuple[float, float]:
        """Radii of the shape along x and y [m], infinite where it does not bend (none of a sinusoid); of profiles those
        of a paraboloid near the contact point."""
        if self.kind in ("flat", "sinusoid"):
            return math.inf, math.inf
        if self.kind == "profiles":
            from bem.profiles.gap import equivalent_radii

            return equivalent_radii(self.placed())
        assert self.radius is not None
        return self.radius, {"sphere": self.radius, "ellipsoid": self.radius_y}.get(self.kind) or math.inf

    def placed(self) -> WheelOnRail:
        """Return the wheel on the rail, of a shape of profiles; the same object for the same values."""
        assert self.wheel is not None
        assert self.rail is not None
        assert self.rolling_radius is not None
        return _placed(
            self.wheel.build(),
            self.rail.build(),
            self.rolling_radius,
            self.rail_radius or math.inf,
            self.lateral or 0.0,
            self.roll or 0.0,
            self.yaw or 0.0,
        )


@lru_cache(maxsize=64)
def _placed(*values: Any) -> WheelOnRail:
    """Return the wheel on the rail of these values."""
    from bem.profiles import WheelOnRail

    return WheelOnRail(*values)


def _mistake_and_remedy(message: str) -> tuple[str, str]:
    """Return what a message says is wrong, and what it says is allowed."""
    what, _, allowed = message.partition("; allowed: ")
    return what, allowed or "profiles that touch"
