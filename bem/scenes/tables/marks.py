"""Marks of a tool on a generated surface: tables that `feed_marks` and `cross_hatch` of a surface are."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field, model_validator

from bem.scenes.keys import key
from bem.scenes.table import Table, problem
from bem.scenes.units import Angle, Length

_Length = Annotated[Length, Field(gt=0)]


class FeedMarksScene(Table):
    """Turning marks: cusps of a round tool nose, one in each feed."""

    feed: _Length = key(
        "Feed of the tool per revolution, the spacing of the marks; at least four cells.", "basic", example="0.1 mm"
    )
    nose_radius: _Length = key(
        "Nose radius of the tool; the cusps are feed^2 / (8 nose_radius) high.", "basic", example="0.8 mm"
    )

    @model_validator(mode="after")
    def _shallow(self) -> FeedMarksScene:
        if self.feed > self.nose_radius:
            raise problem("feed is longer than nose_radius", "feed <= nose_radius")
        return self


class CrossHatchScene(Table):
    """Honing grooves in two directions."""

    angle: Annotated[Angle, Field(gt=0, lt=math.pi)] = key(
        "Cross-hatch angle between the two directions, halved by the lay.", "basic", example="60 deg"
    )
    spacing: _Length = key("Mean distance of the grooves of one direction.", "basic", example="80 um")
    width: _Length = key("Width of a groove at the surface; at least four cells.", "basic", example="10 um")
    depth: _Length = key("Depth of a groove, whose section is a parabola.", "basic", example="1 um")

    @model_validator(mode="after")
    def _apart(self) -> CrossHatchScene:
        if self.width > self.spacing:
            raise problem("grooves are wider than their spacing", "width <= spacing")
        return self
