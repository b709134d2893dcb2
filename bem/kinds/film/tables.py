"""Cylinder, motion and march of a film in time: tables of the kind film."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from bem.scenes.common import CylinderTable, Force, Table, check_rising, problem
from bem.scenes.units import Length, Speed, Time


class FilmCylinderScene(CylinderTable):
    """The cylinder and the load on its width; `load_end` changes it linearly over the run."""

    load: Annotated[Force, Field(gt=0)]
    load_end: Annotated[Force, Field(gt=0)] | None = None

    def per_length(self, share: float) -> float:
        """The load per unit length [N/m] where so much of the run is over."""
        end = self.load if self.load_end is None else self.load_end
        return (self.load + (end - self.load) * share) / self.width


class MotionScene(Table):
    """Speed of the flat over time; the cylinder stands still.

    table : `speeds` at `times`, linear in between. reciprocating : `speed` cos(2 pi t / `period`).
    """

    kind: Literal["table", "reciprocating"]
    times: Annotated[list[Time], Field(min_length=2, max_length=1000)] | None = None
    speeds: Annotated[list[Speed], Field(min_length=2, max_length=1000)] | None = None
    speed: Annotated[Speed, Field(gt=0)] | None = None
    period: Annotated[Time, Field(gt=0)] | None = None

    @model_validator(mode="after")
    def _complete(self) -> MotionScene:
        wanted = ("times", "speeds") if self.kind == "table" else ("speed", "period")
        given = tuple(name for name in ("times", "speeds", "speed", "period") if getattr(self, name) is not None)
        if given != wanted:
            raise problem(f'kind "{self.kind}" with {", ".join(given) or "nothing"}', " and ".join(wanted))
        if self.times is not None and self.speeds is not None:
            if len(self.times) != len(self.speeds):
                raise problem(f"{len(self.times)} times and {len(self.speeds)} speeds", "as many of each")
            check_rising(self.times, "times")
        return self

    def at(self, time: float) -> float:
        """Speed at a time [m/s]."""
        if self.kind == "table":
            assert self.times is not None
            assert self.speeds is not None
            return float(np.interp(time, self.times, self.speeds))
        assert self.speed is not None
        assert self.period is not None
        return self.speed * math.cos(2 * math.pi * time / self.period)


class MarchScene(Table):
    """How long and how finely; `initial_thickness` where the motion starts from rest.

    cavitation : "swift_stieber" forgets the oil behind a rupture, "mass_conserving" carries it along, so that a film
        that forms again, as after a reversal, has no more than that.
    """

    duration: Annotated[Time, Field(gt=0)]
    steps: Annotated[int, Field(strict=True, ge=2, le=100_000)] = 200
    points: Annotated[int, Field(strict=True, ge=101, le=5000)] = 501
    initial_thickness: Annotated[Length, Field(gt=0)] | None = None
    cavitation: Literal["swift_stieber", "mass_conserving"] = "swift_stieber"
