"""Marks of a tool on a generated surface: tables that `feed_marks` and `cross_hatch` of a surface are."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field, model_validator

from bem.scenes.table import Table, problem
from bem.scenes.units import Angle, Length

_Length = Annotated[Length, Field(gt=0)]


class FeedMarksScene(Table):
    """Cusps of a round tool nose, one in each feed; see `bem.surfaces.feed_marks`. Of process turned both are known."""

    feed: _Length
    nose_radius: _Length

    @model_validator(mode="after")
    def _shallow(self) -> FeedMarksScene:
        if self.feed > self.nose_radius:
            raise problem("feed is longer than nose_radius", "feed <= nose_radius")
        return self


class CrossHatchScene(Table):
    """Grooves of two directions; see `bem.surfaces.cross_hatch`. Of process honed all are known.

    `angle` lies between both directions, halved by `lay`; `spacing` is the mean one of one direction's grooves.
    """

    angle: Annotated[Angle, Field(gt=0, lt=math.pi)]
    spacing: _Length
    width: _Length
    depth: _Length

    @model_validator(mode="after")
    def _apart(self) -> CrossHatchScene:
        if self.width > self.spacing:
            raise problem("grooves are wider than their spacing", "width <= spacing")
        return self
