"""Particles that stay between surfaces that wear: a table of the kinds wear and running-in."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Self

from pydantic import Field, model_validator

from bem.scenes.common import PositiveLength, PositivePressure, Table, problem
from bem.scenes.units import Ratio, WearCoefficient

if TYPE_CHECKING:
    from bem.wear.third_bodies import ThirdBodies


class ThirdBodiesScene(Table):
    """Particles that stay between the surfaces, `number_per_area` of them [1/m^2]; see `bem.wear.third_bodies`.

    The number is given, or found: the share `kept` of what Archard's wear rate makes within a sliding length of
    `residence`. Without `hardness` they are harder than the surfaces. From cycle to cycle the share `shed` of what
    wears joins them, and the share `leaving` of those there leaves; with neither their number stays.
    """

    diameter: PositiveLength
    number_per_area: Annotated[float, Field(ge=0)] | None = None
    specific_wear_rate: Annotated[WearCoefficient, Field(gt=0)] | None = None
    residence: PositiveLength | None = None
    kept: Annotated[Ratio, Field(gt=0, le=1)] = 1.0
    hardness: PositivePressure | None = None
    friction: Annotated[Ratio, Field(ge=0, le=2)] = 0.0
    removed: Annotated[Ratio, Field(ge=0, le=1)] = 0.0
    shed: Annotated[Ratio, Field(ge=0, le=1)] = 0.0
    leaving: Annotated[Ratio, Field(ge=0, le=1)] = 0.0

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
        """Of surfaces under a mean pressure [Pa]."""
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
