"""Spur and helical gears with involute flanks: the path of contact, with load, radii and speeds all along.

Geometry of ISO 21771: base circles r_b = m z cos(alpha) / 2, tips r_a = r + m (1 + x), working pressure angle by
inv(alpha_w) = inv(alpha) + 2 tan(alpha) (x1 + x2) / (z1 + z2). At a distance s from the pinion's base point along the
line of action the flanks bend with s and a sin(alpha_w) - s, and move over the contact with omega times that. One pair
carries F = T / r_b1 alone between B and D; where two pairs carry, the share rises from 1/3 to 2/3 and back (ISO/TR
15144-1, flanks without modification, quality 7).

Of helical gears all this is the transverse section's, tan(alpha_t) = tan(alpha_n) / cos(beta), and lines of contact lie
at beta_b to the axes in the plane of action, sin(beta_b) = sin(beta) cos(alpha_n). Across a line the flanks bend with
s / cos(beta_b) and move over it with omega s (both have the same speed along it). The force F / cos(beta_b) presses
evenly on all lines that lie in the plane of action at a time, whose length is exact: no share of a standard's. Stiffer
ends of helical teeth are left out.

At A and E a tip's edge touches, whose pressure is higher than that of the flanks' curvature; tip relief, bending of
teeth and dynamic load are left out. A scene takes each place as steady.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from bem.elements.contact import ElementContact
from bem.elements.model import Contacts, ElementModel
from bem.errors import InputError
from bem.grid import FloatArray
from bem.materials import contact_modulus
from bem.quantities import with_unit
from bem.scenes.common import PositiveLength, PositivePressure, problem
from bem.scenes.units import Angle, Dimension, Number, Ratio, RotationSpeed

Torque = Annotated[float, Dimension("N*m", "a torque", "30 N*m")]
LoadStage = Annotated[float, Number("", "a load stage of the FZG test from 1 to 14", "12")]
Teeth = Annotated[int, Field(strict=True, ge=6, le=2000)]

_ACROSS = 1024
"""Places over the face at which the lines' length is taken, which is piecewise linear: to 1e-6 of the mean."""
_NODES = 12
"""Gauss nodes between two marks of the path: sliding losses within 1e-4 of those with four times as many."""
_DISTANCE_AGREES = 0.01
"""Difference of a centre distance from that of the profile shifts, over the module, up to which both agree."""
_LARGEST_SHIFT = 3.0
"""Profile shift beyond which no tooth is cut: some 1 is the limit of pointed teeth, more only of many teeth."""
_MOST_OVERLAP = 100
"""Lines of contact at a time on the mean, ten times those of the widest herringbones: all are held in memory."""


class GearModel(ElementModel):
    """A pair of external gears: module, teeth, torque and speed of the pinion, which drives and is body 1.

    Tips are at the module times 1 + x over the reference circle where `tip_diameters` does not say otherwise. Module,
    pressure angle and profile shifts of helical gears are those of the normal section. `centre_distance` alone gives
    the sum of both profile shifts, of which each gear gets half; beside them it must agree. The load is the pinion's
    `torque`, or the one that gives `hertz_pressure` at the pitch point. For scuffing: `scuffing_load_stage`, 1 to 14,
    at which the oil fails the FZG test A/8.3/90, and `structure_factor`, 1 for case-hardened steels.
    """

    element: Literal["gear-pair"] = "gear-pair"
    module: PositiveLength
    teeth: tuple[Teeth, Teeth]
    pressure_angle: Annotated[Angle, Field(gt=0.17, lt=0.7)] = math.radians(20)
    helix_angle: Annotated[Angle, Field(ge=0, lt=0.8)] = 0.0
    profile_shifts: tuple[Ratio, Ratio] = (0.0, 0.0)
    centre_distance: PositiveLength | None = None
    tip_diameters: tuple[PositiveLength, PositiveLength] | None = None
    face_width: PositiveLength
    torque: Annotated[Torque, Field(gt=0)] | None = None
    hertz_pressure: PositivePressure | None = None
    speed: Annotated[RotationSpeed, Field(gt=0)]
    points: Annotated[int, Field(strict=True, ge=5, le=2001)] = 41
    scuffing_load_stage: Annotated[LoadStage, Field(ge=1, le=14)] | None = None
    structure_factor: Annotated[Ratio, Field(gt=0, lt=3)] = 1.0

    @model_validator(mode="after")
    def _meshes(self) -> Self:
        if (self.torque is None) == (self.hertz_pressure is None):
            if self.torque is None:
                raise problem("neither torque nor hertz_pressure given", 'one of them: torque = "30 N*m"')
            raise problem("both torque and hertz_pressure given", "one of them; delete the other")
        if self.centre_distance is not None:
            self._check_shifts(self.centre_distance)
        try:
            path = path_of_contact(self)
            if "profile_shifts" in self.model_fields_set and self.centre_distance is not None:
                self._check_distance(self.centre_distance, path)
        except InputError as error:
            raise problem(error.messages[0], "teeth, shifts and pressure angle of gears that mesh") from None
        leaning = path.overlap / path.base_pitch
        if leaning > _MOST_OVERLAP:
            raise problem(
                f"overlap ratio {leaning:.3g}: the face is too wide for its teeth", f"{_MOST_OVERLAP} at most"
            )
        ratio = path.contact_ratio + leaning
        if path.contact_ratio <= 0 or ratio < 1:
            said = f"contact ratio {path.contact_ratio:.3g}"
            more = "1 and more"
            if leaning:
                said, more = f"{said} and overlap ratio {leaning:.3g}", "1 and more of both together"
            if self.tip_diameters is not None:
                usual = " and ".join(with_unit(d, "m") for d in self._usual_tips())
                more = f"{more}; with these teeth tip_diameters are usually {usual}"
            raise problem(f"{said}: below 1 the teeth lose each other", more)
        return self

    def _check_shifts(self, distance: float) -> None:
        """Refuse a centre distance that needs profile shifts which no teeth have."""
        try:
            shifts = self.shifts
        except InputError:  # told with the path of contact
            return
        if max(map(abs, shifts)) > _LARGEST_SHIFT:
            usual = 0.5 * self.module * sum(self.teeth) / math.cos(self.helix_angle)
            raise problem(
                f"centre_distance {with_unit(distance, 'm')} needs profile shifts of "
                f"{' and '.join(f'{one:.3g}' for one in shifts)}",
                f"shifts of {_LARGEST_SHIFT:g} at most; without shifts these gears stand {with_unit(usual, 'm')} apart",
            )

    def _check_distance(self, given: float, path: Path) -> None:
        """Refuse profile shifts that do not give the centre distance to a hundredth of the module."""
        if abs(path.centre_distance - given) > _DISTANCE_AGREES * self.module:
            total = shifts_of_distance(self, given)
            raise problem(
                f"profile_shifts give a centre distance of {1e3 * path.centre_distance:.6g} mm, centre_distance is "
                f"{1e3 * given:.6g} mm",
                f"one of both, or profile_shifts with a sum of {total:.4g}",
            )

    def _usual_tips(self) -> tuple[float, float]:
        """Tip diameters of standard teeth, as high over the reference circle as the module and the shift [m]."""
        lean = math.cos(self.helix_angle)
        pinion, wheel = (self.module * (z / lean + 2 + 2 * x) for z, x in zip(self.teeth, self.shifts, strict=True))
        return pinion, wheel

    @cached_property
    def shifts(self) -> tuple[float, float]:
        """Profile shifts of pinion and wheel: those given, or half each of the sum that the centre distance takes."""
        if self.centre_distance is None or "profile_shifts" in self.model_fields_set:
            return self.profile_shifts
        half = 0.5 * shifts_of_distance(self, self.centre_distance)
        return half, half

    @cached_property
    def pinion_torque(self) -> float:
        """Torque of the pinion [N m]: the one given, or the one that gives the Hertz pressure at the pitch point."""
        if self.torque is not None:
            return self.torque
        assert self.hertz_pressure is not None
        path = path_of_contact(self)
        inclined = math.cos(path.base_helix)
        radius = path.pitch * (path.line - path.pitch) / path.line / inclined
        modulus = contact_modulus(self.first.build(), self.second.build())
        line_load = math.pi * radius * self.hertz_pressure**2 / modulus
        normal = line_load * self.face_width / inclined / path.share(path.pitch)
        return normal * path.base_radii[0] * inclined

    def contacts(self) -> Contacts:
        """Return the contacts by distance from the pitch point C: from A, the wheel's tip, to E, the pinion's."""
        path = path_of_contact(self)
        inclined = math.cos(path.base_helix)
        normal = self.pinion_torque / (path.base_radii[0] * inclined)
        omega = (self.speed, self.speed * self.teeth[0] / self.teeth[1])

        def contact(s: float) -> ElementContact:
            """Return the contact at a distance from the pinion's base point."""
            distances = (s, path.line - s)
            speeds = (omega[0] * distances[0], omega[1] * distances[1])
            if s == path.pitch:  # rolls there, but for rounding
                speeds = (speeds[0], speeds[0])
            return ElementContact(
                f"{1e3 * (s - path.pitch):.3g} mm from C", s - path.pitch, normal * path.share(s),
                (distances[0] / inclined, distances[1] / inclined),
                speeds, length=self.face_width / inclined,
            )  # fmt: skip

        return Contacts(
            tuple(contact(s) for s in _rows(path, self.points)),
            "position",
            "m",
            at_once=path.contact_ratio,
            passes=_turns(omega),
            marks=path.marks,
            marked={name: contact(path.pitch + place) for name, place in path.marks.items()},
            geometry=_geometry(self, path),
            nodes=tuple((contact(s), weight) for s, weight in _quadrature(path)),
        )


@dataclass(frozen=True)
class Path:
    """The path of contact, in distances [m] from the pinion's base point T1 along the line of action.

    `start` A, `single` B and D between which one pair carries, `pitch` C, `end` E; `line` is T1 T2; teeth follow one
    another by `base_pitch`. `base_helix` [rad] inclines lines of contact, which cross the `face_width` [m].
    """

    base_radii: tuple[float, float]
    centre_distance: float
    working_angle: float
    line: float
    start: float
    single: tuple[float, float]
    pitch: float
    end: float
    base_pitch: float
    base_helix: float
    face_width: float

    @property
    def contact_ratio(self) -> float:
        """Transverse contact ratio: mean number of lines, as long as the face is wide, that touch at a time."""
        return (self.end - self.start) / self.base_pitch

    @property
    def overlap(self) -> float:
        """Length along the path by which a line of contact leans while it crosses the face [m]."""
        return self.face_width * math.tan(self.base_helix)

    @property
    def marks(self) -> dict[str, float]:
        """Places on the path by their letters in ISO 21771, as distances [m] from the pitch point C, in order.

        A is the start of contact and E its end. B and D are the inner and outer points of single contact, one base
        pitch from E and from A. Helical teeth have no single contact: B and D are left out. So is C where it lies
        outside the path, as with large profile shifts.
        """
        places = {"A": self.start, "C": self.pitch, "E": self.end}
        if not self.base_helix and self.contact_ratio < 2:
            places |= {"B": self.single[0], "D": self.single[1]}
        inside = {name: s - self.pitch for name, s in places.items() if self.start <= s <= self.end}
        return dict(sorted(inside.items(), key=lambda item: (item[1], item[0])))

    def share(self, s: float) -> float:
        """Return the share of the normal force on a line of contact as long as the face is wide.

        Of helical teeth it is the mean over that line.
        """
        if self.base_helix:
            starts = s - self.overlap * (np.arange(_ACROSS) + 0.5) / _ACROSS
            return float(np.mean(1 / self.lines(starts)))
        b, d = self.single
        if b <= s <= d:
            return 1.0
        if s < b:
            return (1 + (s - self.start) / (b - self.start)) / 3
        return (1 + (self.end - s) / (self.end - d)) / 3

    def lines(self, starts: FloatArray) -> FloatArray:
        """Return the length of all lines of contact of helical teeth, over that of a line across the whole face.

        starts : distances [m] at which one of the lines meets the edge of the face.
        """
        around = math.ceil((self.end - self.start + 2 * self.overlap) / self.base_pitch) + 1
        offset = self.base_pitch * np.arange(-around, around + 1)
        low = np.asarray(starts)[..., None] + offset
        inside = np.minimum(low + self.overlap, self.end) - np.maximum(low, self.start)
        return np.asarray(np.maximum(inside, 0.0).sum(axis=-1) / self.overlap)


def _rows(path: Path, points: int) -> list[float]:
    """Return even distances from the pinion's base point [m], the row nearest to each mark moved onto it.

    A mark whose nearest rows stand for other marks has no row of its own, as with few points.
    """
    places = np.linspace(path.start, path.end, points)
    places[-1] = path.end
    marked = {0, points - 1}
    for place in path.marks.values():
        nearest = int(np.argmin(abs(places - (path.pitch + place))))
        if nearest not in marked:
            places[nearest] = path.pitch if place == 0 else path.pitch + place
            marked.add(nearest)
    return [float(place) for place in places]


def _quadrature(path: Path) -> list[tuple[float, float]]:
    """Return Gauss nodes [m] and weights of a mean along the path, on each piece between marks.

    At B and D the load of spur gears jumps, at C the sliding has a kink.
    """
    ends = sorted({path.start, path.end, *(path.pitch + place for place in path.marks.values())})
    at, weights = np.polynomial.legendre.leggauss(_NODES)
    found = []
    for low, high in pairwise(ends):
        half = 0.5 * (high - low)
        found += [
            (float(low + half * (1 + x)), float(w * half / (path.end - path.start)))
            for x, w in zip(at, weights, strict=True)
        ]
    return found


def path_of_contact(model: GearModel) -> Path:
    """Return the path of contact of a pair.

    Raises
    ------
    InputError : gears that cannot mesh, or whose involute ends before the path does (undercut).
    """
    normal, helix, (z1, z2) = model.pressure_angle, model.helix_angle, model.teeth
    angle = math.atan(math.tan(normal) / math.cos(helix))
    radii = [0.5 * model.module * z / math.cos(helix) for z in (z1, z2)]
    base = [r * math.cos(angle) for r in radii]
    shifts = sum(model.shifts)
    working = _inverse_involute(math.tan(angle) - angle + 2 * math.tan(normal) * shifts / (z1 + z2))
    distance = (base[0] + base[1]) / math.cos(working)
    line = distance * math.sin(working)
    tips = [r + model.module * (1 + x) for r, x in zip(radii, model.shifts, strict=True)]
    if model.tip_diameters is not None:
        tips = [0.5 * d for d in model.tip_diameters]
    reach = [math.sqrt(max(tip**2 - rb**2, 0.0)) for tip, rb in zip(tips, base, strict=True)]
    start, end = line - reach[1], reach[0]
    pitch = math.pi * model.module * math.cos(angle) / math.cos(helix)
    if start <= 0 or end >= line:
        raise InputError("the tip of one gear meets the other below its base circle (undercut)")
    single = (max(end - pitch, start), min(start + pitch, end))
    if not helix and (end - start) >= 2 * pitch:
        raise InputError(f"contact ratio {(end - start) / pitch:.3g}: three pairs at once are not shared here")
    where = base[0] * math.tan(working)
    base_helix = math.asin(math.sin(helix) * math.cos(normal))
    found = (distance, working, line, start, single, where, end, pitch, base_helix, model.face_width)
    return Path((base[0], base[1]), *found)


def shifts_of_distance(model: GearModel, distance: float) -> float:
    """Return the sum of both profile shifts that a centre distance [m] takes (ISO 21771).

    From cos(alpha_w) = (r_b1 + r_b2) / a and the involute equation of the working pressure angle.

    Raises
    ------
    InputError : a centre distance at which the base circles meet.
    """
    angle = math.atan(math.tan(model.pressure_angle) / math.cos(model.helix_angle))
    base = 0.5 * model.module * sum(model.teeth) / math.cos(model.helix_angle) * math.cos(angle)
    if base >= distance:
        raise InputError(f"centre_distance: {1e3 * distance:.6g} mm is below the sum of the base radii")
    working = math.acos(base / distance)
    involutes = (math.tan(working) - working) - (math.tan(angle) - angle)
    return involutes * sum(model.teeth) / (2 * math.tan(model.pressure_angle))


def _inverse_involute(value: float) -> float:
    """Return the angle a [rad] of a value of the involute function tan(a) - a."""
    from scipy.optimize import brentq

    if not 0 < value < 3:
        raise InputError("the shifts leave no working pressure angle")
    return float(brentq(lambda a: math.tan(a) - a - value, 1e-6, 1.3, xtol=1e-16, rtol=1e-15))


def _turns(omega: tuple[float, float]) -> tuple[float, float]:
    """Return the revolutions of both gears [1/s]: a flank passes the contact once in each."""
    return omega[0] / (2 * math.pi), omega[1] / (2 * math.pi)


def _geometry(model: GearModel, path: Path) -> tuple[str, ...]:
    """Return sentences with the figures of the path of contact."""
    marks = path.marks
    named = ", ".join(f"{name} {1e3 * place:.4g} mm" for name, place in marks.items())
    helical = "" if "B" in marks else "; helical teeth have no points B and D of single contact"
    said = [
        f"On the path {named} from C{helical}. Contact ratio {path.contact_ratio:.4g}, working pressure angle "
        f"{math.degrees(path.working_angle):.4g} deg, centre distance {1e3 * path.centre_distance:.6g} mm; teeth pass "
        f"the path in {1e3 * (path.end - path.start) / (model.speed * path.base_radii[0]):.3g} ms."
    ]
    if model.shifts != model.profile_shifts:
        said.append(
            f"Each gear has a profile shift of {model.shifts[0]:.4g}, half of the sum that the centre distance takes: "
            "give profile_shifts if yours are divided otherwise."
        )
    if path.base_helix:
        lengths = path.lines(path.base_pitch * np.arange(_ACROSS) / _ACROSS)
        shortest, longest = float(lengths.min()), float(lengths.max())
        said.append(
            f"Helix {math.degrees(path.base_helix):.4g} deg on the base circles, overlap ratio "
            f"{path.overlap / path.base_pitch:.4g}. The load lies evenly on lines of contact {shortest:.4g} to "
            f"{longest:.4g} faces long together; a place's load is the mean over the face, and "
            f"up to {100 * (path.contact_ratio / shortest - 1):.2g} % more where they are shortest."
        )
    return tuple(said)
