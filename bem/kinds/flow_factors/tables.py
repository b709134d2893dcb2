"""Separations of flow factors, and the contact of the roughness: tables of the kind flow-factors."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from bem.scenes.common import GridScene, PositiveLength, PositivePressure, Table, exactly_one, problem
from bem.scenes.keys import key
from bem.scenes.units import Ratio


class PatchGridScene(GridScene):
    """Cells along x (the flow's direction) and y of a patch that repeats along both, as its flow does.

    See `GridScene` for what is taken from measured surfaces.
    """

    periodic: tuple[Annotated[bool, Field(strict=True)], Annotated[bool, Field(strict=True)]] = key(
        "Periodic continuation along x and y, always both: flow factors belong to a repeating patch.",
        "expert",
        default=(True, True),
    )

    @model_validator(mode="after")
    def _repeats(self) -> PatchGridScene:
        if self.periodic != (True, True):
            raise problem("periodic is not true along both axes", "true: the factors are of a patch that repeats")
        return self


class FlowScene(Table):
    """Separations of the surfaces, and how their asperities deform."""

    separations: Annotated[list[PositiveLength], Field(min_length=1, max_length=100)] | None = key(
        "Separations of the undeformed mean planes, one result for each; instead of ratios.",
        "basic",
        default=None,
        example=["0.2 um", "0.4 um"],
    )
    ratios: Annotated[list[Annotated[Ratio, Field(gt=0)]], Field(min_length=1, max_length=100)] | None = key(
        "Separations over the combined rms roughness Sq (lambda ratios); instead of separations.",
        "basic",
        default=None,
        example=[1.0, 2.0, 3.0],
    )
    behaviour: Literal["elastic", "capped", "undeformed"] = key(
        "Deformation of the asperities: capped is limited by the hardness, undeformed cuts overlap off.",
        "basic",
        default="elastic",
    )
    hardness: PositivePressure | None = key(
        'Hardness that limits the contact pressure with behaviour "capped".',
        "advanced",
        default=None,
        reason="that of the softer body",
        example="7 GPa",
    )
    tolerance: Annotated[Ratio, Field(ge=1e-10, le=1e-2)] = key(
        "Relative tolerance of the contact and flow solutions.", "expert", default=1e-6
    )
    errors: bool = key(
        "Error estimate of every result, from a second solution on twice the cell size.",
        "advanced",
        default=True,
        strict=True,
    )

    @model_validator(mode="after")
    def _one_list(self) -> FlowScene:
        exactly_one(self, "separations", "ratios")
        if self.behaviour != "capped" and self.hardness is not None:
            raise problem("hardness is given but nothing is capped", 'behaviour = "capped", or no hardness')
        return self
