"""A cam under a flat-faced follower: load, curvature and speeds over the cam's angle.

With the lift s over the angle theta, primes for d/d theta: the cam bends at the contact with rho = R_b + s + s'', and
its surface comes with omega rho; the contact wanders on the follower with omega s'', so that the follower's surface
leaves it with that. Their mean, omega (R_b + s + 2 s'') / 2, entrains the oil. The spring and the follower's inertia
press: F = k (s_0 + s) + m omega^2 s''. The follower does not turn; both bodies are as long as the cam is wide, without
edges.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from bem.elements.contact import ElementContact
from bem.elements.model import Contacts, ElementModel
from bem.notes import Note
from bem.notes.elements import CONTACT_LOST, FILM_BY_SQUEEZE, FOLLOWER_PASSED_OFTEN
from bem.scenes.common import PositiveLength, problem
from bem.scenes.units import Angle, Dimension, Force, RotationSpeed

Stiffness = Annotated[float, Dimension("N/m", "a stiffness", "20 N/mm")]
Mass = Annotated[float, Dimension("kg", "a mass", "100 g")]


class CamModel(ElementModel):
    """A cam that lifts a flat-faced follower by a polynomial of the angle, even about the nose. Body 1 is the cam.

    s = lift (1 - t^2)^3 with t = angle / half_angle between the ends of the flanks: lift, speed and acceleration do not
    jump.
    """

    element: Literal["cam-follower"] = "cam-follower"
    base_radius: PositiveLength
    lift: PositiveLength
    half_angle: Annotated[Angle, Field(gt=0.17, lt=math.pi)]
    width: PositiveLength
    stiffness: Annotated[Stiffness, Field(ge=0)]
    preload: Annotated[Force, Field(ge=0)] = 0.0
    mass: Annotated[Mass, Field(ge=0)] = 0.0
    speed: Annotated[RotationSpeed, Field(gt=0)]
    points: Annotated[int, Field(strict=True, ge=5, le=2001)] = 73

    @model_validator(mode="after")
    def _convex(self) -> Self:
        smallest = min(self.curvature(self._angle(i)) for i in range(401))
        if smallest <= 0:
            raise problem(
                f"a flat follower cannot touch a hollow flank (smallest radius {1e3 * smallest:.3g} mm)",
                f"a base_radius above {1e3 * (self.base_radius - smallest):.4g} mm, a wider half_angle or less lift",
            )
        return self

    def _angle(self, i: int) -> float:
        return self.half_angle * (i / 200 - 1)

    def lift_at(self, angle: float) -> tuple[float, float]:
        """Return the lift [m] and its second derivative [m/rad^2] at an angle from the nose."""
        t = angle / self.half_angle
        if abs(t) >= 1:
            return 0.0, 0.0
        q = 1 - t * t
        return self.lift * q**3, self.lift * (24 * t * t * q - 6 * q**2) / self.half_angle**2

    def curvature(self, angle: float) -> float:
        """Return the radius of the cam at the contact [m]."""
        lift, second = self.lift_at(angle)
        return self.base_radius + lift + second

    def contacts(self) -> Contacts:
        """Return the contacts from flank to flank, where the follower is pressed down."""
        found, lost, weights = [], 0, []
        for i in range(self.points):
            angle = self.half_angle * (2 * i / (self.points - 1) - 1)
            lift, second = self.lift_at(angle)
            load = self.preload + self.stiffness * lift + self.mass * self.speed**2 * second
            if load <= 0:
                lost += 1
                continue
            speeds = (self.speed * self.curvature(angle), self.speed * second)
            weights.append((0.5 if i in (0, self.points - 1) else 1.0) / (self.points - 1))
            found.append(
                ElementContact(
                    f"{math.degrees(angle):.3g} deg", angle, load, (self.curvature(angle), math.inf), speeds,
                    length=self.width,
                )
            )  # fmt: skip
        turns, pressed = self.speed / (2 * math.pi), sum(weights)
        nodes = tuple((one, weight / pressed) for one, weight in zip(found, weights, strict=True))
        notes, at_once = self._notes(found, lost), self.half_angle / math.pi * pressed
        return Contacts(tuple(found), "angle", "rad", notes, at_once, (turns, None), nodes=nodes)

    def _notes(self, found: list[ElementContact], lost: int) -> tuple[Note, ...]:
        notes = []
        if lost:
            notes.append(CONTACT_LOST(lost=lost, all=self.points, reason="follower"))
        turns = [
            f"{math.degrees(a.place + (b.place - a.place) * a.mean_speed / (a.mean_speed - b.mean_speed)):.3g} deg"
            for a, b in pairwise(found)
            if (a.mean_speed > 0) != (b.mean_speed > 0)
        ]
        if turns:
            notes.append(FILM_BY_SQUEEZE(angles=", ".join(turns), reason="follower"))
        if self.specific_wear_rate:
            notes.append(FOLLOWER_PASSED_OFTEN())
        return tuple(notes)
