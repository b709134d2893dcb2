"""A contact of a machine element: what presses how hard, how both surfaces bend, and how fast they come."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from bem.reference_solutions.hertz import LineContact, PointContact, cylinder_contact, ellipse_contact

if TYPE_CHECKING:
    from bem.lubrication import Lubricant
    from bem.reference_solutions.line_film import InletFilm

EVEN = 1.005
"""Highest load per length of a roller over its mean below which its load counts as even."""
WIDE = 0.3
"""Contact half-length a over the smallest radius R of a body from which on its roundness is said: the gap of two nearly
equal circles is 1 + 3/4 (a / R)^2 of its parabola at the edge (series of x^2 / 2 R), here 7 % over it."""


@dataclass(frozen=True)
class ElementContact:
    """One place of a machine element where two bodies touch, body 1 the lower one of a scene.

    Attributes
    ----------
    name : which, such as "inner ring, 40 deg".
    place : where, as the element counts it: an angle [rad] or a distance along the path [m].
    load : [N]; of a sliced line that of its most loaded slice on the whole length.
    radii : of both bodies along the motion [m], negative where hollow.
    across : radius of relative curvature across the motion [m]; infinite for a line.
    length : of a line [m]; None for a point.
    speeds : of both surfaces over the contact, along the motion [m/s].
    inlet : how far before the axis the gap begins to be full of oil [m]; infinite where it is flooded.
    slices : loads per length of equal slices along a roller [N/m], whose highest is load over length; empty where the
        load is even by definition.
    spin : angular speed of the ball against the other body about the normal of their contact [rad/s].
    path : name of the one of several paths that it is on, such as "outer ring"; empty where there is one.
    """

    name: str
    place: float
    load: float
    radii: tuple[float, float]
    speeds: tuple[float, float]
    across: float = math.inf
    length: float | None = None
    inlet: float = math.inf
    slices: tuple[float, ...] = ()
    spin: float = 0.0
    path: str = ""

    @property
    def carried(self) -> float:
        """Load that the contact carries, of a sliced line the sum over its slices [N]."""
        if not self.slices or self.length is None:
            return self.load
        return self.length * sum(self.slices) / len(self.slices)

    @property
    def radius(self) -> float:
        """Radius of relative curvature along the motion [m]."""
        return 1 / (1 / self.radii[0] + 1 / self.radii[1])

    @property
    def mean_speed(self) -> float:
        """Mean speed of the surfaces, which entrains the oil [m/s]."""
        return 0.5 * (self.speeds[0] + self.speeds[1])

    @property
    def slide_roll_ratio(self) -> float:
        """Difference of the speeds over their mean; infinite where that is zero."""
        difference = self.speeds[0] - self.speeds[1]
        return difference / self.mean_speed if self.mean_speed else math.copysign(math.inf, difference)

    def hertz(self, modulus: float) -> LineContact | PointContact:
        """Return the smooth contact by Hertz, with the contact modulus [Pa]."""
        if self.length is not None:
            return cylinder_contact(radius=self.radius, contact_modulus=modulus, load=self.load / self.length)
        return ellipse_contact(radii=(self.radius, self.across), contact_modulus=modulus, load=self.load)

    def half_width(self, modulus: float) -> float:
        """Return the half-width of the contact along the motion [m]."""
        found = self.hertz(modulus)
        return found.half_width if isinstance(found, LineContact) else found.semi_axes[0]

    def line_load(self, modulus: float) -> float:
        """Load per length [N/m]: of a line itself; of a point that of a line of its radius with its highest pressure,
        W = pi R p0^2 / E*."""
        if self.length is not None:
            return self.load / self.length
        return math.pi * self.radius * self.hertz(modulus).maximum_pressure ** 2 / modulus

    def minimum_film(self, modulus: float, oil: Lubricant) -> float:
        """Fit of the minimum film of a line [m], isothermal and flooded, to tell places apart; scenes compute it.

        The thickest of Dowson's fit, that of soft bodies, in which viscosity does not rise with pressure, and of a line
        that of rigid bodies (Martin). Zero where nothing is entrained. Of a bounded inlet the rigid film of the oil as
        it comes.
        """
        if math.isfinite(self.inlet) and self.mean_speed:
            return self.rigid_film(oil.viscosity).minimum_thickness
        from bem.reference_solutions.line_film import (
            MartinFilm,
            dowson_higginson_minimum,
            isoviscous_elastic_minimum,
        )

        if self.mean_speed == 0:
            return 0.0
        load, speed, viscosity = self.line_load(modulus), abs(self.mean_speed), oil.viscosity
        hard = dowson_higginson_minimum(
            load=load, radius=self.radius, contact_modulus=modulus, mean_speed=speed, viscosity=viscosity,
            pressure_viscosity=oil.pressure_viscosity,
        )  # fmt: skip
        soft = isoviscous_elastic_minimum(
            load=load, radius=self.radius, contact_modulus=modulus, mean_speed=speed, viscosity=viscosity
        )
        if self.length is None:
            return max(hard, soft)
        return max(hard, soft, MartinFilm(load, self.radius, viscosity, speed).minimum_thickness)

    def rigid_film(self, viscosity: float) -> InletFilm:
        """Return the film of a line of rigid bodies, in oil of a viscosity [Pa s]; the mean speed is not zero."""
        from bem.reference_solutions.line_film import InletFilm

        assert self.length is not None
        return InletFilm(self.load / self.length, self.radius, viscosity, abs(self.mean_speed), self.inlet)

    def is_wide(self, modulus: float) -> bool:
        """Return True if the contact is as long as the bodies are round, across or along."""
        found = self.hertz(modulus)
        sides = [(self.half_width(modulus), min(map(abs, self.radii)))]
        if isinstance(found, PointContact):
            sides.append((found.semi_axes[1], min(map(abs, self.radii))))
        return any(half > WIDE * radius for half, radius in sides)
