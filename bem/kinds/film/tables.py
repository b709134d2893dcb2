"""Cylinder, motion and march of a film in time: tables of the kind film."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from bem.scenes.common import CylinderTable, Force, PositivePressure, Table, check_rising, one_of, problem
from bem.scenes.keys import key
from bem.scenes.units import Length, Speed, Time


class FilmCylinderScene(CylinderTable):
    """The cylinder on the flat, and its load, or the Hertz pressure under it."""

    load: Annotated[Force, Field(gt=0)] | None = key(
        "Normal load on the width; instead of hertz_pressure.", "basic", default=None, example="200 N"
    )
    hertz_pressure: PositivePressure | None = key(
        "Maximum Hertz pressure of the smooth contact; instead of load.", "basic", default=None, example="0.5 GPa"
    )
    load_end: Annotated[Force, Field(gt=0)] | None = key(
        "Normal load at the end of the run, reached linearly.",
        "advanced",
        default=None,
        reason="a constant load",
        example="100 N",
    )

    _one_load = one_of("load", "hertz_pressure")

    def force(self, contact_modulus: float) -> float:
        """Load on the width at the start [N], as given or by the maximum pressure."""
        if self.load is not None:
            return self.load
        assert self.hertz_pressure is not None
        return self.load_under(self.hertz_pressure, contact_modulus)

    def per_length(self, share: float, contact_modulus: float) -> float:
        """The load per unit length [N/m] where so much of the run is over."""
        start = self.force(contact_modulus)
        end = start if self.load_end is None else self.load_end
        return (start + (end - start) * share) / self.width


class MotionScene(Table):
    """Speed of the flat over time; the cylinder stands still."""

    kind: Literal["table", "reciprocating"] = key(
        "Motion of the flat: table (speeds at times) or reciprocating (speed x cos(2 pi t / period)).", "basic"
    )
    times: Annotated[list[Time], Field(min_length=2, max_length=1000)] | None = key(
        "Times of the table, in rising order.", "basic", default=None, example=["0 s", "10 ms"]
    )
    speeds: Annotated[list[Speed], Field(min_length=2, max_length=1000)] | None = key(
        "Speeds of the flat at these times, linear in between.", "basic", default=None, example=["0.2 m/s", "0 m/s"]
    )
    speed: Annotated[Speed, Field(gt=0)] | None = key(
        "Speed amplitude of the reciprocating motion.", "basic", default=None, example="0.1 m/s"
    )
    period: Annotated[Time, Field(gt=0)] | None = key(
        "Period of the reciprocating motion.", "basic", default=None, example="20 ms"
    )

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
    """Duration and time steps."""

    duration: Annotated[Time, Field(gt=0)] = key("Simulated time.", "basic")
    steps: Annotated[int, Field(strict=True, ge=2, le=100_000)] = key(
        "Number of time steps; doubling it shows the error in time.", "basic", default=200
    )
    points: Annotated[int, Field(strict=True, ge=101, le=5000)] = key(
        "Number of nodes of the film mesh.", "advanced", default=501
    )
    initial_thickness: Annotated[Length, Field(gt=0)] | None = key(
        "Film thickness at the start; a motion that starts from rest needs it.",
        "advanced",
        default=None,
        reason="the steady film",
        example="0.2 um",
    )
    cavitation: Literal["swift_stieber", "mass_conserving"] = key(
        "Cavitation model: swift_stieber (Reynolds condition) or mass_conserving (Jakobsson, Floberg, Olsson).",
        "advanced",
        default="swift_stieber",
        reason="swift_stieber, the faster one; after a reversal use mass_conserving",
    )
