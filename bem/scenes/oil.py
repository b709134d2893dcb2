"""The table `[oil]`: an oil of the catalogue at a temperature, viscosities of one's own, or the viscosity itself.

Knows scenes and their messages; what oils are is in `bem.lubrication.oils`. Verified in
tests/scenes/test_oil_scenes.py.
"""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import Field, field_validator, model_validator

from bem.errors import InputError
from bem.lubrication.density import DensityLaw, DowsonHigginson
from bem.lubrication.oils.catalogue import find_oil, oil_from_viscosities
from bem.lubrication.shear import BaseOilShear, ShearLaw
from bem.lubrication.viscosity import Roelands, ViscosityLaw
from bem.scenes.common import problem
from bem.scenes.keys import key
from bem.scenes.laws import LawKey, LawTable
from bem.scenes.units import (
    Density,
    HeatCapacity,
    KinematicViscosity,
    PressureViscosity,
    Ratio,
    Softening,
    Temperature,
    ThermalConductivity,
    Viscosity,
)

if TYPE_CHECKING:
    from pydantic_core import PydanticCustomError

    from bem.lubrication import Lubricant, Oil

_NO_FILM = "a positive viscosity; an oil without viscosity makes no film (a dry contact is kind contact or wear)"
_WAYS = "exactly one of grade, viscosities, viscosity"
Base = Literal["mineral", "naphthenic", "pao", "ester", "pag", "water-glycol", "traction"]


class OilScene(LawTable):
    """The oil; see `bem.Lubricant`. The laws' parameters stand beside them.

    Either `grade` with `temperature`: a name or grade of the catalogue (`bem oils` lists them), with `viscosity_index`
    and `base` in place of the usual ones; or `viscosities` with `temperature`: kinematic, [["40 degC", "68 mm^2/s"],
    ["100 degC", "8.6 mm^2/s"]], joined by `temperature_law`; or `viscosity` at the temperature of the contact. What
    else is given here (`pressure_viscosity`, `density`, ...) replaces the oil's own. `film_rheology = "shear_law"` lets
    the shear law act on the film and not on the friction alone. `shear_law = "base_oil"`, the default, has the
    constants of the oil's base; beside `viscosity` it takes `base`, too, and has those of a mineral oil without it.
    """

    grade: str | None = key(
        "Oil of the catalogue by name or grade (`bem oils` lists them), at the given temperature.",
        "basic",
        default=None,
        example="ISO VG 68",
    )
    viscosities: Annotated[list[tuple[Temperature, KinematicViscosity]], Field(min_length=2, max_length=64)] | None = (
        key(
            "Measured kinematic viscosities at two or more temperatures; instead of grade.",
            "advanced",
            default=None,
            example=[["40 degC", "68 mm^2/s"], ["100 degC", "8.6 mm^2/s"]],
        )
    )
    viscosity: Viscosity | None = key(
        "Dynamic viscosity at ambient pressure and the temperature of the contact; instead of grade.",
        "advanced",
        default=None,
        example="20 mPa*s",
    )
    temperature: Temperature | None = key(
        "Temperature of the oil at the inlet; a bare number is in kelvin.", "basic", default=None
    )
    viscosity_index: Annotated[Ratio, Field(ge=-100, le=450)] | None = key(
        "Viscosity index of the grade.", "advanced", default=None, reason="the usual one of the base oil", example=95
    )
    base: Base | None = key(
        "Base oil, which decides viscosity index, pressure-viscosity coefficient, density and thermal constants.",
        "advanced",
        default=None,
        reason="that of the grade, else mineral",
    )
    temperature_law: Literal["walther", "vogel", "andrade", "table"] | None = key(
        "Viscosity-temperature law through measured viscosities: walther (ASTM D341), vogel, andrade or table.",
        "advanced",
        default=None,
    )
    pressure_viscosity: Annotated[PressureViscosity, Field(ge=0)] | None = key(
        "Pressure-viscosity coefficient alpha at the oil's temperature.",
        "advanced",
        default=None,
        reason="that of the grade, or 0 beside viscosity",
        example="20 1/GPa",
    )
    density: Annotated[Density, Field(gt=0)] | None = key(
        "Density.", "advanced", default=None, reason="that of the oil"
    )
    heat_capacity: Annotated[HeatCapacity, Field(gt=0)] | None = key(
        "Specific heat capacity.", "advanced", default=None, reason="that of the oil", example="2000 J/(kg*K)"
    )
    thermal_conductivity: Annotated[ThermalConductivity, Field(gt=0)] | None = key(
        "Thermal conductivity.", "advanced", default=None, reason="that of the oil", example="0.14 W/(m*K)"
    )
    temperature_viscosity: Annotated[Softening, Field(gt=0)] | None = key(
        "Temperature-viscosity coefficient beta = -d ln(viscosity)/dT.",
        "advanced",
        default=None,
        reason="that of the oil",
    )
    viscosity_law: Annotated[ViscosityLaw, LawKey("viscosity_law", beside=True)] = key(
        "Pressure-viscosity law.",
        "advanced",
        default=Roelands(),
        reason="roelands, as Barus' law overestimates viscosity at high pressure",
    )
    density_law: Annotated[DensityLaw, LawKey("density_law", beside=True)] = key(
        "Density-pressure law; dowson_higginson blunts the pressure spike.",
        "advanced",
        default=DowsonHigginson(),
        reason="dowson_higginson, as oils give way by 10 to 25 % at 0.5 GPa and above",
    )
    shear_law: Annotated[ShearLaw, LawKey("shear_law", beside=True)] = key(
        "Rheology at high shear: shear thinning and limiting shear stress of the oil.",
        "advanced",
        default=BaseOilShear(),
        reason="Eyring's law under a limit that falls with temperature, with constants measured on oils of the base; "
        "limited, one limit for any oil, gives 1.4 to 3 times the measured friction",
    )
    film_rheology: Literal["newtonian", "shear_law"] = key(
        "Viscosity in the Reynolds equation: newtonian, or generalised by shear_law, which thins the film.",
        "advanced",
        default="newtonian",
    )

    def check_point_film(self) -> None:
        """Refuse a shear law in the film of a point contact."""
        if self.film_rheology == "shear_law":
            raise problem('film_rheology = "shear_law"', '"newtonian": the film of a point contact follows no other')

    @field_validator("grade")
    @classmethod
    def _spelt_out(cls, grade: str | None) -> str | None:
        if grade is None:
            return None
        try:
            name = find_oil(grade).name
            return grade if "mineral" in grade.lower() else name  # "ISO VG 100" would be of any base
        except InputError as error:
            if "viscosity_index is missing" in str(error):  # known when the whole table is
                return grade
            raise _said(error) from None

    @model_validator(mode="after")
    def _complete(self) -> OilScene:
        given = [name for name in ("grade", "viscosities", "viscosity") if getattr(self, name) is not None]
        if len(given) != 1:
            raise problem(f"{' and '.join(given)} are given" if given else "no oil", _WAYS)
        if self.viscosity is not None:
            for name in ("viscosity_index", "base", "temperature_law"):
                if name == "base" and self.shear_law.name == BaseOilShear.name:
                    continue
                if getattr(self, name) is not None:
                    raise problem(f"{name} beside viscosity", f"{name} with grade or viscosities")
            if self.viscosity <= 0:
                raise problem(f"viscosity {self.viscosity:g} Pa s", _NO_FILM)
        elif self.temperature is None:
            raise problem(f"{given[0]} without temperature", 'temperature with it, such as "60 degC"')
        elif self.grade is not None and self.temperature_law is not None:
            raise problem("temperature_law beside grade", "temperature_law with viscosities")
        elif self.viscosities is not None and self.viscosity_index is not None:
            raise problem("viscosity_index beside viscosities", "viscosity_index with grade")
        try:
            self.build()
        except InputError as error:
            raise _said(error) from None
        return self

    @property
    def oil(self) -> Oil | None:
        """The oil at all temperatures; None where only a viscosity is given."""
        if self.grade is not None:
            return find_oil(self.grade, viscosity_index=self.viscosity_index, base=self.base)
        if self.viscosities is not None:
            return oil_from_viscosities(dict(self.viscosities), base=self.base or "mineral", law=self.temperature_law)
        return None

    def build(self) -> Lubricant:
        """As `bem.Lubricant`.

        Raises
        ------
        InputError : an oil that is no liquid at its temperature.
        """
        from bem.lubrication import Lubricant

        laws: dict[str, Any] = {
            "viscosity_law": self.viscosity_law,
            "density_law": self.density_law,
            "shear_law": self.shear_law,
            "film_rheology": self.film_rheology,
            "density": self.density,
            "heat_capacity": self.heat_capacity,
            "thermal_conductivity": self.thermal_conductivity,
            "temperature_viscosity": self.temperature_viscosity,
        }
        oil = self.oil
        if oil is not None:
            assert self.temperature is not None
            return oil.at(self.temperature, pressure_viscosity=self.pressure_viscosity, **laws)
        assert self.viscosity is not None
        return Lubricant(
            self.viscosity,
            pressure_viscosity=self.pressure_viscosity or 0.0,
            temperature=self.temperature,
            base=self.base,
            **laws,
        )


def _said(error: InputError) -> PydanticCustomError:
    """An oil's message as scenes say it."""
    text, _, allowed = re.sub('^oil "[^"]*": ', "", error.messages[0]).partition("; allowed: ")
    return problem(text, allowed or "`bem oils` lists names, grades and their ranges")
