"""Spur gears with involute flanks: the path of contact, with load, radii and speeds all along.

Geometry of ISO 21771: base circles r_b = m z cos(alpha) / 2, tips r_a = r + m (1 + x), working pressure angle by
inv(alpha_w) = inv(alpha) + 2 tan(alpha) (x1 + x2) / (z1 + z2). At a distance s from the pinion's base point along the
line of action the flanks bend with s and a sin(alpha_w) - s, and move over the contact with omega times that. One pair
carries F = T / r_b1 alone between B and D; where two pairs carry, the share rises from 1/3 to 2/3 and back (ISO/TR
15144-1, flanks without modification, quality 7).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from bem.elements.contact import ElementContact
from bem.elements.model import Contacts, ElementModel
from bem.errors import InputError
from bem.scenes.common import PositiveLength, problem
from bem.scenes.units import Angle, Dimension, Rate, Ratio

Torque = Annotated[float, Dimension("N*m", "a torque", "30 N*m")]
Teeth = Annotated[int, Field(strict=True, ge=6, le=2000)]


class GearModel(ElementModel):
    """A pair of external spur gears: module, teeth, torque and speed of the pinion, which drives and is body 1.

    Tips are at the module times 1 + x over the reference circle where `tip_diameters` does not say otherwise.
    """

    element: Literal["gear-pair"] = "gear-pair"
    module: PositiveLength
    teeth: tuple[Teeth, Teeth]
    pressure_angle: Annotated[Angle, Field(gt=0.17, lt=0.7)] = math.radians(20)
    profile_shifts: tuple[Ratio, Ratio] = (0.0, 0.0)
    tip_diameters: tuple[PositiveLength, PositiveLength] | None = None
    face_width: PositiveLength
    torque: Annotated[Torque, Field(gt=0)]
    speed: Annotated[Rate, Field(gt=0)]
    points: Annotated[int, Field(strict=True, ge=5, le=2001)] = 41

    @model_validator(mode="after")
    def _meshes(self) -> Self:
        try:
            path = path_of_contact(self)
        except InputError as error:
            raise problem(error.messages[0], "teeth, shifts and pressure angle of gears that mesh") from None
        if path.contact_ratio < 1:
            raise problem(f"contact ratio {path.contact_ratio:.3g}: below 1 the teeth lose each other", "1 and more")
        return self

    def contacts(self) -> Contacts:
        """By distance from the pitch point C: from A, where the wheel's tip comes in, to E, the end of the pinion's."""
        path = path_of_contact(self)
        normal = self.torque / path.base_radii[0]
        omega = (self.speed, self.speed * self.teeth[0] / self.teeth[1])
        found = []
        for i in range(self.points):
            s = path.start + (path.end - path.start) * i / (self.points - 1)
            radii = (s, path.line - s)
            found.append(
                ElementContact(
                    f"{1e3 * (s - path.pitch):.3g} mm from C", s - path.pitch, normal * path.share(s), radii,
                    (omega[0] * radii[0], omega[1] * radii[1]), length=self.face_width,
                )
            )  # fmt: skip
        return Contacts(tuple(found), "position", "m", _notes(self, path), path.contact_ratio, _turns(omega))


@dataclass(frozen=True)
class Path:
    """The path of contact, in distances [m] from the pinion's base point T1 along the line of action.

    `start` A, `single` B and D between which one pair carries, `pitch` C, `end` E; `line` is T1 T2.
    """

    base_radii: tuple[float, float]
    centre_distance: float
    working_angle: float
    line: float
    start: float
    single: tuple[float, float]
    pitch: float
    end: float
    contact_ratio: float

    def share(self, s: float) -> float:
        """Of the normal force at a distance."""
        b, d = self.single
        if b <= s <= d:
            return 1.0
        if s < b:
            return (1 + (s - self.start) / (b - self.start)) / 3
        return (1 + (self.end - s) / (self.end - d)) / 3


def path_of_contact(model: GearModel) -> Path:
    """The path of a pair.

    Raises
    ------
    InputError : gears that cannot mesh, or whose involute ends before the path does (undercut).
    """
    angle, (z1, z2) = model.pressure_angle, model.teeth
    radii = [0.5 * model.module * z for z in (z1, z2)]
    base = [r * math.cos(angle) for r in radii]
    shifts = sum(model.profile_shifts)
    working = _inverse_involute(math.tan(angle) - angle + 2 * math.tan(angle) * shifts / (z1 + z2))
    distance = (base[0] + base[1]) / math.cos(working)
    line = distance * math.sin(working)
    tips = [r + model.module * (1 + x) for r, x in zip(radii, model.profile_shifts, strict=True)]
    if model.tip_diameters is not None:
        tips = [0.5 * d for d in model.tip_diameters]
    reach = [math.sqrt(max(tip**2 - rb**2, 0.0)) for tip, rb in zip(tips, base, strict=True)]
    start, end = line - reach[1], reach[0]
    pitch = math.pi * model.module * math.cos(angle)
    if start <= 0 or end >= line:
        raise InputError("the tip of one gear meets the other below its base circle (undercut)")
    single = (max(end - pitch, start), min(start + pitch, end))
    if (end - start) >= 2 * pitch:
        raise InputError(f"contact ratio {(end - start) / pitch:.3g}: three pairs at once are not shared here")
    where = base[0] * math.tan(working)
    return Path((base[0], base[1]), distance, working, line, start, single, where, end, (end - start) / pitch)


def _inverse_involute(value: float) -> float:
    """The angle whose tan(a) - a this is."""
    from scipy.optimize import brentq

    if not 0 < value < 3:
        raise InputError("the shifts leave no working pressure angle")
    return float(brentq(lambda a: math.tan(a) - a - value, 1e-6, 1.3, xtol=1e-16, rtol=1e-15))


def _turns(omega: tuple[float, float]) -> tuple[float, float]:
    """Of both gears [1/s]: each flank passes once in one."""
    return omega[0] / (2 * math.pi), omega[1] / (2 * math.pi)


def _notes(model: GearModel, path: Path) -> tuple[str, ...]:
    return (
        f"contact ratio {path.contact_ratio:.4g}, working pressure angle {math.degrees(path.working_angle):.4g} deg, "
        f"centre distance {1e3 * path.centre_distance:.6g} mm",
        "at A and E a tip's edge touches: its pressure is higher than that of the flanks' curvature, which a "
        "half-space under smooth bodies does not carry; tip relief, bending of teeth and dynamic load are left out",
        "a scene takes each place as steady: teeth pass the path in "
        f"{1e3 * (path.end - path.start) / (model.speed * path.base_radii[0]):.3g} ms",
    )
