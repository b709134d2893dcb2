"""The tables that scenes with an oil film share."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
from pydantic import Field, model_validator

from bem.friction.boundary import BoundaryFriction, boundary_law
from bem.scenes.common import Force, PositiveLength, PositivePressure, Table, problem
from bem.scenes.laws import LawOrNumber
from bem.scenes.units import Pressure, Ratio, Speed


class SpeedsScene(Table):
    """Speeds of the flat: a list, or `count` of them from `first` to `last` in equal ratios.

    The cylinder moves with `cylinder` times the flat's speed: 0 is pure sliding, 1 pure rolling. Speeds against x are
    negative; without entrainment (speed 0, or `cylinder` -1) there is no steady film.
    """

    values: Annotated[list[Speed], Field(min_length=1, max_length=512)] | None = None
    first: Speed | None = None
    last: Speed | None = None
    count: Annotated[int, Field(strict=True, ge=2, le=512)] = 20
    cylinder: Ratio = 0.0

    @model_validator(mode="before")
    @classmethod
    def _from_list(cls, data: Any) -> Any:
        if isinstance(data, int | float | str):
            data = [data]
        return {"values": data} if isinstance(data, list | tuple) else data

    @model_validator(mode="after")
    def _complete(self) -> SpeedsScene:
        ends = (self.first, self.last)
        if (self.values is None) == (None in ends) and not (self.values is None and ends == (None, None)):
            raise problem("both or neither of values and first, last", "values, or first with last")
        if self.values is None and None in ends:
            raise problem("no speeds", "values, or first with last")
        given = self.values if self.values is not None else [v for v in ends if v is not None]
        if any(v == 0 for v in given):
            raise problem(
                "a speed of zero entrains no oil, so there is no steady film",
                "speeds other than 0; kind film marches through standstill",
            )
        if self.values is None and math.copysign(1, given[0]) != math.copysign(1, given[1]):
            raise problem("a range in equal ratios cannot pass through zero", "first and last of the same sign")
        if self.cylinder == -1:
            raise problem("cylinder -1: the surfaces move against each other and entrain no oil", "cylinder above -1")
        if self.cylinder < -1:
            raise problem(f"cylinder {self.cylinder:g}: it moves faster than the flat", "cylinder above -1")
        return self

    def build(self) -> list[tuple[float, float]]:
        """Pairs (u1, u2) of flat and cylinder [m/s]."""
        if self.values is not None:
            flat = [float(v) for v in self.values]
        else:
            assert self.first is not None
            assert self.last is not None
            flat = [float(v) for v in np.sign(self.first) * np.geomspace(abs(self.first), abs(self.last), self.count)]
        return [(v, self.cylinder * v) for v in flat]


class LubricatedScene(Table):
    """The contact as a whole: a cylinder along y on a flat. Loads are on its full width.

    Loads may be given as maximum Hertz pressures of the smooth contact instead. `hardness` defaults to the softer
    body's. `boundary_friction` is a coefficient, or a law with its parameters.
    """

    radius: PositiveLength
    width: PositiveLength
    loads: Annotated[list[Annotated[Force, Field(gt=0)]], Field(min_length=1, max_length=64)] | None = None
    hertz_pressures: Annotated[list[Annotated[Pressure, Field(gt=0)]], Field(min_length=1, max_length=64)] | None = None
    boundary_friction: Annotated[
        float | BoundaryFriction, LawOrNumber("boundary_friction", number=Annotated[Ratio, Field(ge=0, le=2)])
    ]
    hardness: PositivePressure | None = None

    @model_validator(mode="after")
    def _one_load(self) -> LubricatedScene:
        if (self.loads is None) == (self.hertz_pressures is None):
            raise problem("loads and hertz_pressures", "exactly one of loads, hertz_pressures")
        return self

    def nominal_friction(
        self, load: float, contact_modulus: float, speeds: tuple[float, float], temperature: float | None = None
    ) -> float:
        """Boundary friction as one number, before any contact is known: of a law at the hardness, or else at the mean
        pressure of the smooth contact under a load on the full width [N], at speeds (u1, u2) [m/s] and the oil's
        temperature [K]."""
        law = boundary_law(self.boundary_friction).at_temperature(temperature)
        if law.constant is not None or speeds[0] == speeds[1]:
            return law.constant or 0.0
        smooth = math.sqrt(math.pi * contact_modulus * load / self.width / self.radius) / 4
        return law.coefficient(self.hardness or smooth, abs(speeds[0] - speeds[1]))

    def forces(self, contact_modulus: float) -> list[float]:
        """Loads on the full width [N]; p0 = sqrt(W E* / (pi R)) per unit length, Johnson (1985), eq. 4.45."""
        if self.loads is not None:
            return [float(v) for v in self.loads]
        assert self.hertz_pressures is not None
        return [math.pi * self.radius * p * p / contact_modulus * self.width for p in self.hertz_pressures]


class FilmMeshScene(Table):
    """The film's mesh of `points`, graded and as long as the inlet needs, which the solver sees to.

    With `from`, `to` the film is also given on `count` equal steps there; they must reach the inlet and hold the rough
    patch.
    """

    points: Annotated[int, Field(strict=True, ge=100, le=20000)] = 2000
    start: float | None = None
    end: float | None = None
    count: Annotated[int, Field(strict=True, ge=50, le=20000)] = 2000

    @model_validator(mode="before")
    @classmethod
    def _lengths(cls, data: Any) -> Any:
        from bem.scenes.units import LENGTH

        if isinstance(data, dict):
            data = {key: LENGTH.parse(v) if key in ("start", "end") and v is not None else v for key, v in data.items()}
        return data

    @model_validator(mode="after")
    def _both(self) -> FilmMeshScene:
        if (self.start is None) != (self.end is None):
            raise problem("one of start and end", "start with end, or neither")
        if self.start is not None and self.end is not None and self.start >= self.end:
            raise problem(f"start {self.start:g} m is not below end {self.end:g} m", "start below end")
        return self

    def positions(self) -> Any:
        """Abscissae [m], or None."""
        return None if self.start is None or self.end is None else np.linspace(self.start, self.end, self.count)
