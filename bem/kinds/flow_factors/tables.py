"""Where flow factors are wanted, and how the roughness is pressed together: tables of the kind flow-factors."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from bem.scenes.common import GridScene, PositiveLength, PositivePressure, Table, exactly_one, problem
from bem.scenes.units import Ratio


class PatchGridScene(GridScene):
    """Cells along x (the flow's direction) and y of a patch that repeats along both, as its flow does.

    See `GridScene` for what is taken from measured surfaces.
    """

    periodic: tuple[Annotated[bool, Field(strict=True)], Annotated[bool, Field(strict=True)]] = (True, True)

    @model_validator(mode="after")
    def _repeats(self) -> PatchGridScene:
        if self.periodic != (True, True):
            raise problem("periodic is not true along both axes", "true: the factors are of a patch that repeats")
        return self


class FlowScene(Table):
    """Where: separations of the mean planes, or their ratio to the rms height of both surfaces together.

    behaviour : the roughness is pressed together elastically, capped at the hardness, or not at all (`undeformed`: what
        overlaps is cut off, as in Patir and Cheng's simulations).
    """

    separations: Annotated[list[PositiveLength], Field(min_length=1, max_length=100)] | None = None
    ratios: Annotated[list[Annotated[Ratio, Field(gt=0)]], Field(min_length=1, max_length=100)] | None = None
    behaviour: Literal["elastic", "capped", "undeformed"] = "elastic"
    hardness: PositivePressure | None = None
    tolerance: Annotated[Ratio, Field(ge=1e-10, le=1e-2)] = 1e-6
    errors: bool = Field(default=True, strict=True)

    @model_validator(mode="after")
    def _one_list(self) -> FlowScene:
        exactly_one(self, "separations", "ratios")
        if self.behaviour != "capped" and self.hardness is not None:
            raise problem("hardness is given but nothing is capped", 'behaviour = "capped", or no hardness')
        return self
