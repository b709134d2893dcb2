"""A roller on a flat that roll and slide, for the kind traction: load, speeds, the film's points."""

from __future__ import annotations

import math
from typing import Annotated

from pydantic import Field

from bem.scenes.common import CylinderTable, Force, PositivePressure, Table, one_of
from bem.scenes.tables.heat import BulkTemperature
from bem.scenes.units import Ratio, Speed


class RollerScene(CylinderTable):
    """The roller, and the load on its width or the maximum Hertz pressure that it makes."""

    load: Annotated[Force, Field(gt=0)] | None = None
    hertz_pressure: PositivePressure | None = None

    _one_load = one_of("load", "hertz_pressure")

    def per_length(self, contact_modulus: float) -> float:
        """Load per length [N/m]; of a pressure p0 it is pi R p0^2/E*, Johnson (1985), eq. 4.45."""
        if self.load is not None:
            return self.load / self.width
        assert self.hertz_pressure is not None
        return math.pi * self.radius * self.hertz_pressure**2 / contact_modulus


class RollingScene(Table):
    """Speeds of both surfaces over the contact: their mean, and the slide-to-roll ratio, the difference of flat and
    roller over the mean. At a ratio of 2 the roller stands still, at -2 the flat. Temperatures of the bodies far from
    the contact are the oil's where they are not given."""

    mean_speed: Annotated[Speed, Field(gt=0)]
    slide_roll_ratio: Annotated[Ratio, Field(ge=-2, le=2)] = 0.0
    lower_bulk: BulkTemperature | None = None
    upper_bulk: BulkTemperature | None = None

    @property
    def speeds(self) -> tuple[float, float]:
        """Of flat and roller [m/s]."""
        half = 0.5 * self.slide_roll_ratio
        return self.mean_speed * (1 + half), self.mean_speed * (1 - half)


class FilmPointsScene(Table):
    """The film's mesh."""

    points: Annotated[int, Field(strict=True, ge=100, le=20000)] = 1000
