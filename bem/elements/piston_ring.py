"""A piston ring on its liner: load, speed and film over the stroke, of a barrel face as long as it is high.

The piston is r (1 - cos t) + l - sqrt(l^2 - r^2 sin^2 t) below its upper turning point, r the crank's radius, l the
rod, t the angle; the liner comes over the ring with the piston's speed, of which one half entrains. The ring's tension
F presses with 2 F / D on every length around the bore D (balance of half a ring). Gas, p over what is below, stands
behind the whole height b and on the face above the line of contact, which lies c b over the lower edge: c p b is left.
The face is full of oil to its leading edge. Less oil on the liner, gas pressure at the film's ends, the ring's gap,
tilt and a bore that is not round are left out.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from bem.elements.contact import ElementContact
from bem.elements.model import Contacts, ElementModel
from bem.kinds.traction.along import columns_or_file
from bem.materials import contact_modulus
from bem.notes import Note
from bem.notes.elements import CONTACT_LOST, FILM_BY_SQUEEZE, RING_AT_EDGE
from bem.reference_solutions.line_film import InletFilm
from bem.scenes.common import PositiveLength, Table, problem
from bem.scenes.units import Angle, Force, Pressure, Ratio, RotationSpeed

_LEAST_CROWN = 1e-9
"""How far the middle of a face stands out over its edges at least [m]: the film of a flat one is not this one."""


class GasScene(Table):
    """Pressure over the ring less that below it, over the crank's angle from the upper turning point: one turn, or two
    of a four-stroke engine; linear in between. `path` names a file with these columns."""

    crank_angle: Annotated[list[Angle], Field(min_length=2, max_length=2000)]
    pressure: Annotated[list[Pressure], Field(min_length=2, max_length=2000)]

    @model_validator(mode="before")
    @classmethod
    def _from_file(cls, data: Any) -> Any:
        return columns_or_file(data, ("crank_angle", "pressure"))

    @model_validator(mode="after")
    def _turns(self) -> Self:
        angle = self.crank_angle
        if len(angle) != len(self.pressure):
            raise problem(f"{len(angle)} angles and {len(self.pressure)} pressures", "as many of each")
        if any(b <= a for a, b in pairwise(angle)):
            raise problem("the angles do not rise", "angles in rising order, none twice")
        if abs(angle[0]) > 1e-6 or min(abs(angle[-1] - 2 * math.pi * n) for n in (1, 2)) > 1e-3:
            raise problem(
                f"angles from {math.degrees(angle[0]):.4g} to {math.degrees(angle[-1]):.4g} deg",
                "from 0 to 360 deg, or to 720 deg",
            )
        return self


class PistonRingModel(ElementModel):
    """A ring with a barrel face in a slider-crank engine. Body 1 is the liner, body 2 the ring.

    `tension`: tangential force that closes it. `height`: along the bore. `crown`: where the face touches, from its
    lower edge, over the height. Its oil ends where the face does, and films with such a supply have no full heat.
    """

    element: Literal["piston-ring"] = "piston-ring"
    thermal: Literal["off", "lumped"] = "lumped"
    bore: PositiveLength
    stroke: PositiveLength
    rod: PositiveLength
    speed: Annotated[RotationSpeed, Field(gt=0)]
    height: PositiveLength
    face_radius: PositiveLength
    crown: Annotated[Ratio, Field(gt=0, lt=1)] = 0.5
    tension: Annotated[Force, Field(gt=0)]
    gas: GasScene | None = None
    points: Annotated[int, Field(strict=True, ge=4, le=1440)] = 72

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if not self.rod > 0.5 * self.stroke:
            raise problem("rod is no longer than the crank's radius, half the stroke", "a longer rod")
        if not self.height < self.bore:
            raise problem("height is not below the bore", "height < bore")
        if not self.height < 2 * self.face_radius:
            raise problem("face_radius is below half the height", "a face that is round over its height")
        if self.height**2 < 8 * self.face_radius * _LEAST_CROWN:
            raise problem("face_radius leaves less than 1 nm of a crown: a flat face has no wedge", "a smaller one")
        return self

    @property
    def cycle(self) -> float:
        """Angle of a working cycle, after which all repeats [rad]."""
        return 2 * math.pi if self.gas is None else 2 * math.pi * round(self.gas.crank_angle[-1] / (2 * math.pi))

    def piston_speed(self, angle: float) -> float:
        """Return the speed of the piston, positive downwards [m/s]."""
        crank = 0.5 * self.stroke
        sine, cosine = math.sin(angle), math.cos(angle)
        return self.speed * crank * sine * (1 + crank * cosine / math.sqrt(self.rod**2 - (crank * sine) ** 2))

    def line_load(self, angle: float) -> float:
        """Return the load of the ring on the liner per length [N/m]."""
        gas = 0.0 if self.gas is None else float(np.interp(angle, self.gas.crank_angle, self.gas.pressure))
        return 2 * self.tension / self.bore + self.crown * gas * self.height

    def contacts(self) -> Contacts:
        """Return the contacts over the cycle, beside the turning points, where nothing is entrained.

        They lie half a step beside them, or an eighth at least where the turning points are no whole number of steps.
        """
        step = self.cycle / self.points
        first = 0.5 if self.points % round(self.cycle / math.pi) == 0 else 0.375
        around = math.pi * self.bore
        found, lost = [], 0
        for i in range(self.points):
            angle = (i + first) * step
            load = self.line_load(angle) * around
            if load <= 0:
                lost += 1
                continue
            speed = self.piston_speed(angle)
            # going down, the lower part of the face leads; going up, the upper one
            leads = self.crown if speed > 0 else 1 - self.crown
            found.append(
                ElementContact(
                    f"{math.degrees(angle):.4g} deg", angle, load, (math.inf, self.face_radius), (speed, 0.0),
                    length=around, inlet=leads * self.height,
                )
            )  # fmt: skip
        return Contacts(tuple(found), "angle", "rad", self._notes(found, lost), 1.0, (None, None))

    def _notes(self, found: list[ElementContact], lost: int) -> tuple[Note, ...]:
        notes = []
        if lost:
            notes.append(CONTACT_LOST(lost=lost, all=self.points, reason="ring"))
        modulus = contact_modulus(self.first.build(), self.second.build())
        wide = [one for one in found if one.half_width(modulus) >= min(one.inlet, self.height - one.inlet)]
        if wide:
            notes.append(RING_AT_EDGE(places=len(wide), all=self.points, first=wide[0].name, reason="contact"))
        films = [] if self.oil is None else [self._film(one) for one in found]
        sinking = [one for one, film in zip(found, films, strict=False) if self._lags(one, film.minimum_thickness)]
        if sinking:
            notes.append(FILM_BY_SQUEEZE(places=len(sinking), all=self.points, first=sinking[0].name, reason="ring"))
        beyond = [one for one, film in zip(found, films, strict=False) if film.exit_position > self.height - one.inlet]
        if beyond:
            notes.append(RING_AT_EDGE(places=len(beyond), all=self.points, first=beyond[0].name, reason="film"))
        return tuple(notes)

    def _film(self, one: ElementContact) -> InletFilm:
        assert self.film_oil is not None
        return one.rigid_film(self.film_oil.build().viscosity)

    def _lags(self, one: ElementContact, film: float) -> bool:
        """Return True if a flooded film under this load sinks more slowly than the speed changes, both by time in
        proportion: 1 / sqrt(h) grows linearly (`squeeze_thickness`)."""
        assert self.film_oil is not None
        viscosity, load = self.film_oil.build().viscosity, self.line_load(one.place)
        sinks = 2 * math.sqrt(film) * load / (6 * math.pi * viscosity * one.radius * math.sqrt(2 * one.radius))
        step = 1e-4
        slope = (self.piston_speed(one.place + step) - self.piston_speed(one.place - step)) / (2 * step)
        return sinks < abs(slope / one.speeds[0]) * self.speed
