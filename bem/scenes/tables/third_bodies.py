"""Particles that stay between surfaces that wear: a table of the kinds wear and running-in."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Self

from pydantic import Field, model_validator

from bem.scenes.common import PositiveLength, PositivePressure, Table, problem
from bem.scenes.keys import key
from bem.scenes.units import NumberPerArea, Ratio, WearCoefficient

if TYPE_CHECKING:
    from bem.wear.third_bodies import ThirdBodies


class ThirdBodiesScene(Table):
    """Third bodies: wear particles between the surfaces, which carry load, roll and cut."""

    diameter: PositiveLength = key("Diameter of the spherical particles.", "basic", example="0.3 um")
    number_per_area: Annotated[NumberPerArea, Field(ge=0)] | None = key(
        "Number of particles per area; or give specific_wear_rate and residence.", "basic", default=None
    )
    specific_wear_rate: Annotated[WearCoefficient, Field(gt=0)] | None = key(
        "Specific wear rate at which particles form.", "basic", default=None
    )
    residence: PositiveLength | None = key(
        "Sliding distance after which a particle has left the contact.", "basic", default=None, example="1 mm"
    )
    kept: Annotated[Ratio, Field(gt=0, le=1)] = key(
        "Fraction of the worn volume that becomes such particles.", "advanced", default=1.0
    )
    hardness: PositivePressure | None = key(
        "Hardness of the particles.", "advanced", default=None, reason="harder than both surfaces", example="10 GPa"
    )
    friction: Annotated[Ratio, Field(ge=0, le=2)] = key(
        "Rolling friction coefficient of the particles.", "advanced", default=0.0
    )
    removed: Annotated[Ratio, Field(ge=0, le=1)] = key(
        "Fraction of a particle's groove that is cut off; the rest is ploughed aside.", "advanced", default=0.0
    )
    shed: Annotated[Ratio, Field(ge=0, le=1)] = key(
        "Fraction of the worn volume of a cycle that joins the particles.", "advanced", default=0.0
    )
    leaving: Annotated[Ratio, Field(ge=0, le=1)] = key(
        "Fraction of the particles that leaves in a cycle.",
        "advanced",
        default=0.0,
        reason="0; with shed = 0 their number stays",
    )

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        found = self.specific_wear_rate is not None and self.residence is not None
        if (self.number_per_area is None) != found or (self.specific_wear_rate is None) != (self.residence is None):
            raise problem(
                "neither number_per_area alone nor specific_wear_rate and residence",
                "number_per_area [1/m^2], or specific_wear_rate with residence",
            )
        return self

    def build(self, pressure: float) -> ThirdBodies:
        """Build the third bodies of surfaces under a mean pressure [Pa]."""
        from bem.wear.third_bodies import ThirdBodies

        number_per_area = self.number_per_area
        if number_per_area is None:
            assert self.specific_wear_rate is not None
            assert self.residence is not None
            worn = self.kept * self.specific_wear_rate * pressure * self.residence
            number_per_area = worn / (math.pi / 6 * self.diameter**3)
        hardness = math.inf if self.hardness is None else self.hardness
        return ThirdBodies(
            self.diameter, number_per_area, hardness, self.friction, self.removed, self.shed, self.leaving
        )
