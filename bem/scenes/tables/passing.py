"""What passes through a point contact, and what acts on it over time: tables of the kind point-film-time."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from bem.scenes.common import GridScene, PositiveLength, Table, check_rising, problem
from bem.scenes.tables.ball import FilmCellsScene
from bem.scenes.units import Angle, Length, Ratio, Time

if TYPE_CHECKING:
    from bem.lubrication import MovingSurface

Carrier = Literal["lower", "upper"]
Place = tuple[Length, Length]


class DentScene(Table):
    """A round dent (negative depth: a bump) on the `lower` or `upper` body, at a place of the contact at first."""

    depth: Length
    radius: PositiveLength
    at: Place
    of: Carrier = "lower"

    def build(self) -> MovingSurface:
        """The surface."""
        from bem.lubrication import Dent, MovingSurface

        return MovingSurface(Dent(self.depth, self.radius, self.at), self.of)


class WavesScene(Table):
    """Waviness on the `lower` or `upper` body, with a direction from x; `begin`: its front at first, ahead of which
    the body is smooth."""

    amplitude: PositiveLength
    wavelength: PositiveLength
    direction: Angle = 0.0
    begin: Length | None = None
    of: Carrier = "lower"

    def build(self) -> MovingSurface:
        """The surface."""
        from bem.lubrication import MovingSurface, Waves

        return MovingSurface(Waves(self.amplitude, self.wavelength, self.direction, self.begin), self.of)


class PatchScene(GridScene):
    """The patch of the bodies' rough surfaces (`lower.surface`, `upper.surface`) and where its centre is at first."""

    at: Place = (0.0, 0.0)


class OverTimeScene(Table):
    """Factors on mean speed and load at some times, linear in between; negative speeds run backwards."""

    times: Annotated[list[Time], Field(min_length=2, max_length=1000)]
    speed: Annotated[list[Ratio], Field(min_length=2, max_length=1000)] | None = None
    load: Annotated[list[Annotated[Ratio, Field(gt=0)]], Field(min_length=2, max_length=1000)] | None = None

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
        """Of speed and load at a time [s]."""
        speed, load = (1.0 if v is None else float(np.interp(time, self.times, v)) for v in (self.speed, self.load))
        return speed, load


class PassingCellsScene(FilmCellsScene):
    """The film's grid; `extent`: its edges x0, x1, y0, y1 around the origin, by default where the films of all times
    need no more."""

    extent: tuple[Length, Length, Length, Length] | None = None


class BallMarchScene(Table):
    """How long and in how many steps; `initial_thickness`: the gap that it begins with where that is not the steady
    film of smooth bodies."""

    duration: Annotated[Time, Field(gt=0)]
    steps: Annotated[int, Field(strict=True, ge=4, le=100_000)] = 80
    initial_thickness: PositiveLength | None = None
