"""Kinetics, properties and wear of a tribofilm, and how it is rubbed: tables of the kind tribofilm."""

from __future__ import annotations

from typing import Annotated, Literal

import numpy as np
from pydantic import Field, model_validator

from bem.scenes.axes import Model, with_keys
from bem.scenes.common import Loads, Table, Variant, problem
from bem.scenes.laws import LawKey
from bem.scenes.units import Energy, InverseLength, Length, Rate, Ratio, Speed, Temperature, Time, Volume
from bem.tribofilm.balance import FilmBalance
from bem.tribofilm.growth import GrowthLaw, StressActivatedGrowth
from bem.tribofilm.properties import PropertyLaw


class FilmScene(Table):
    """The film: kinetics, properties, wear.

    Growth is stress-activated, of the energy, volume and prefactor given, or that of another law, `growth`.
    """

    growth: Annotated[GrowthLaw, LawKey("growth")] | None = None
    prefactor: Annotated[Speed, Field(gt=0)] = 1e-2
    activation_energy: Annotated[Energy, Field(gt=0)] | None = None
    activation_volume: Annotated[Volume, Field(ge=0)] | None = None
    hardness: Annotated[PropertyLaw, LawKey("film_property")]
    youngs_modulus: Annotated[PropertyLaw, LawKey("film_property")]
    poissons_ratio: Annotated[Ratio, Field(gt=-1, lt=0.5)] = 0.3
    wear_coefficient: Annotated[Rate, Field(ge=0)]
    lag: Annotated[Time, Field(ge=0)] = 0.0
    concentration_constant: Annotated[InverseLength, Field(gt=0)] | None = None
    initial_thickness: Annotated[Length, Field(ge=0)] = 0.0
    average: Literal["contact", "nominal"] = "contact"
    feedback: Literal["mean", "local"] = "mean"
    local_tolerance: Annotated[Ratio, Field(gt=0, lt=1)] = 1e-2

    @model_validator(mode="after")
    def _one_kinetics(self) -> FilmScene:
        own = {key: getattr(self, key) for key in ("activation_energy", "activation_volume")}
        if self.growth is not None and any(value is not None for value in own.values()):
            raise problem(f"growth with {' and '.join(k for k, v in own.items() if v is not None)}", "one of them")
        if self.growth is None and None in own.values():
            missing = " and ".join(key for key, value in own.items() if value is None)
            raise problem(f"no {missing}", "activation_energy with activation_volume, or growth, another law")
        return self

    def kinetics(self) -> GrowthLaw:
        """The law of growth."""
        if self.growth is not None:
            return self.growth
        assert self.activation_energy is not None
        assert self.activation_volume is not None
        return StressActivatedGrowth(self.prefactor, self.activation_energy, self.activation_volume)

    def balance(self) -> FilmBalance:
        """As `bem.tribofilm.balance.FilmBalance`."""
        constant = self.concentration_constant or np.inf
        return FilmBalance(self.wear_coefficient, self.lag, constant, self.initial_thickness)


class VariantScene(Variant):
    """A film that differs from the scene's in what is given here."""

    wear_coefficient: Annotated[Rate, Field(ge=0)] | None = None
    lag: Annotated[Time, Field(ge=0)] | None = None
    activation_volume: Annotated[Volume, Field(ge=0)] | None = None
    activation_energy: Annotated[Energy, Field(gt=0)] | None = None

    def applied(self, scene: Model) -> Model:
        """The scene with these changes in it."""
        return with_keys(scene, {f"film.{key}": value for key, value in self.changes().items()})


class RubbingScene(Table):
    """Loads, temperatures and how long; `cycle` converts cycles to time for figures against cycles."""

    loads: Loads
    temperatures: Annotated[list[Annotated[Temperature, Field(gt=0)]], Field(min_length=1, max_length=64)]
    friction: Annotated[Ratio, Field(ge=0, le=2)] = 0.1
    duration: Annotated[Time, Field(gt=0)]
    points: Annotated[int, Field(strict=True, ge=2, le=100_000)] = 241
    report: tuple[Annotated[Time, Field(ge=0)], Annotated[Time, Field(ge=0)]] | None = None
    cycle: Annotated[Time, Field(gt=0)] | None = None

    @model_validator(mode="after")
    def _within(self) -> RubbingScene:
        if self.report is not None and not self.report[0] < self.report[1] <= self.duration:
            raise problem(f"report {self.report} s", "two times, the second later and not after duration")
        return self
