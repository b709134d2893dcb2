"""Features that pass through a point contact, and loads over time: tables of the kind point-film-time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from bem.scenes.common import GridScene, PositiveLength, Table, check_rising, problem
from bem.scenes.keys import key
from bem.scenes.tables.ball import FilmCellsScene
from bem.scenes.units import Angle, Length, Ratio, Time

if TYPE_CHECKING:
    from bem.lubrication import MovingSurface

Carrier = Literal["lower", "upper"]
Place = tuple[Length, Length]


class DentScene(Table):
    """Round dent, or with a negative depth a bump, that a body carries through the contact."""

    depth: Length = key("Depth of the dent; negative for a bump.", "basic", example="0.2 um")
    radius: PositiveLength = key("Radius of the dent.", "basic", example="20 um")
    at: Place = key("Position [x, y] of its centre at the start.", "basic", example=["-200 um", "0 um"])
    of: Carrier = key("Body that carries the dent.", "advanced", default="lower")

    def build(self) -> MovingSurface:
        """The surface."""
        from bem.lubrication import Dent, MovingSurface

        return MovingSurface(Dent(self.depth, self.radius, self.at), self.of)


class WavesScene(Table):
    """Waviness that a body carries through the contact."""

    amplitude: PositiveLength = key("Amplitude of the waviness.", "basic", example="0.1 um")
    wavelength: PositiveLength = key("Wavelength of the waviness.", "basic", example="100 um")
    direction: Angle = key("Direction of the waves, measured from x.", "advanced", default=0.0)
    begin: Length | None = key(
        "Position of the wave front at the start; the surface ahead of it is smooth.",
        "advanced",
        default=None,
        reason="waves everywhere",
        example="-200 um",
    )
    of: Carrier = key("Body that carries the waves.", "advanced", default="lower")

    def build(self) -> MovingSurface:
        """The surface."""
        from bem.lubrication import MovingSurface, Waves

        return MovingSurface(Waves(self.amplitude, self.wavelength, self.direction, self.begin), self.of)


class PatchScene(GridScene):
    """Grid of a patch of the bodies' rough surfaces."""

    at: Place = key("Position [x, y] of the patch's centre at the start.", "advanced", default=(0.0, 0.0))


class OverTimeScene(Table):
    """Changes of speed and load over time, linear between the given times."""

    times: Annotated[list[Time], Field(min_length=2, max_length=1000)] = key(
        "Times, in rising order.", "basic", example=["0 s", "1 ms"]
    )
    speed: Annotated[list[Ratio], Field(min_length=2, max_length=1000)] | None = key(
        "Factors on the entrainment speed at these times; negative runs backwards.",
        "basic",
        default=None,
        example=[1.0, 0.0],
    )
    load: Annotated[list[Annotated[Ratio, Field(gt=0)]], Field(min_length=2, max_length=1000)] | None = key(
        "Factors on the normal load at these times.", "basic", default=None, example=[1.0, 2.0]
    )

    @model_validator(mode="after")
    def _as_many(self) -> OverTimeScene:
        if self.speed is None and self.load is None:
            raise problem("neither speed nor load changes", "speed, load or both")
        for name, values in (("speed", self.speed), ("load", self.load)):
            if values is not None and len(values) != len(self.times):
                raise problem(f"{len(self.times)} times and {len(values)} factors of {name}", "as many of each")
        check_rising(self.times, "times")
        return self

    def factors(self, time: float) -> tuple[float, float]:
        """Factors of speed and load at a time [s]."""
        speed, load = (1.0 if v is None else float(np.interp(time, self.times, v)) for v in (self.speed, self.load))
        return speed, load


class PassingCellsScene(FilmCellsScene):
    """Mesh of the oil film."""

    extent: tuple[Length, Length, Length, Length] | None = key(
        "Edges [x0, x1, y0, y1] of the film mesh.",
        "advanced",
        default=None,
        reason="as far as the film needs at all times",
        example=["-300 um", "200 um", "-250 um", "250 um"],
    )


class BallMarchScene(Table):
    """Duration and time steps."""

    duration: Annotated[Time, Field(gt=0)] = key("Simulated time.", "basic")
    steps: Annotated[int, Field(strict=True, ge=4, le=100_000)] = key(
        "Number of time steps; doubling it shows the error in time.", "basic", default=80
    )
    initial_thickness: PositiveLength | None = key(
        "Film thickness at the start; a motion that starts from rest needs it.",
        "advanced",
        default=None,
        reason="the steady film of smooth bodies",
        example="0.2 um",
    )
