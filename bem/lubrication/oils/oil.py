"""An oil: what it is at any temperature, and where each figure is from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from bem.arguments import is_finite
from bem.errors import InputError
from bem.lubrication.oils.over_temperature import OverTemperature
from bem.lubrication.oils.pressure import PressureViscosity
from bem.lubrication.rheology import ShearRheology
from bem.notes import Note
from bem.notes.lubrication import OIL_DATA_SHORT, OIL_TOO_HOT, OIL_TOO_THICK
from bem.physical_constants import ZERO_CELSIUS

if TYPE_CHECKING:
    from bem.lubrication.lubricant import Lubricant

COLDEST = 213.15
"""-60 degrees Celsius [K]: no oil of the catalogue is measured there."""
HOTTEST = 573.15
"""300 degrees Celsius [K]: oils crack."""
FLOWS = 150.0
"""Viscosity [Pa s] beyond which gears starve, the limit of SAE J306."""
EXTRAPOLATED = 30.0
"""How far beyond the measured temperatures a viscosity law is used without a word [K]: 40 and 100 degrees Celsius
measured are good from 10 to 130."""


USUAL_PRESSURE_VISCOSITY = {
    "water-glycol": (
        'such as pressure_viscosity = "3 1/GPa": 3 to 6 1/GPa are usual, about a fifth of that of a mineral oil '
        "(order of magnitude, from films a third as thick as a mineral oil's)"
    )
}
"""Usual coefficients of bases that the catalogue has none of, in words."""


@dataclass(frozen=True)
class Line:
    """A figure that is linear in temperature: `value` at `at` [K], `slope` per K; `source` in words."""

    at: float
    value: float
    slope: float
    source: str

    def __call__(self, temperature: float) -> float:
        """The figure at a temperature [K]."""
        return self.value + self.slope * (temperature - self.at)


@dataclass(frozen=True)
class Oil:
    """An oil at ambient pressure, over temperature.

    Attributes
    ----------
    name : such as "ISO VG 68".
    base : "mineral" (paraffinic), "naphthenic", "pao", "ester", "pag", "water-glycol", "traction" or "water", or a word
        of your own.
    viscosity : law of the kinematic viscosity.
    viscosity_source : of its points.
    density, heat_capacity, thermal_conductivity : lines [kg/m^3, J/(kg K), W/(m K)]; None where it is not known.
    pressure_viscosity : correlation of the coefficient, or one that is given; None where it is not known.
    freezing_point, flash_point, boiling_point, largest_service : temperatures [K], None where not known.
    limits_source : source of these temperatures.
    shear : rheology in shear, measured or that of the base; None where it is not known.
    """

    name: str
    base: str
    viscosity: OverTemperature
    viscosity_source: str
    density: Line
    heat_capacity: Line | None = None
    thermal_conductivity: Line | None = None
    pressure_viscosity: PressureViscosity | None = None
    freezing_point: float | None = None
    flash_point: float | None = None
    boiling_point: float | None = None
    largest_service: float | None = None
    limits_source: str = ""
    shear: ShearRheology | None = None

    def check(self, temperature: float) -> None:
        """Refuse a temperature [K] at which it is no liquid.

        Raises
        ------
        InputError : below its freezing or pour point or -60 degC, above its boiling point or 300 degC, or no number.
        """
        low = self.freezing_point or COLDEST
        high = min(self.boiling_point or HOTTEST, HOTTEST)
        if not is_finite(temperature):
            raise InputError(f"{self.name}: temperature {temperature!r} must be a finite number [K]")
        if low <= temperature <= high:
            return
        why = {
            True: "it is solid or does not pour below" if self.freezing_point else "no oil is measured below",
            False: "it boils above" if self.boiling_point and self.boiling_point <= HOTTEST else "oils crack above",
        }[temperature < low]
        limit = low if temperature < low else high
        hint = "; a number without a unit is in K" if 0 <= temperature < 200 else ""
        raise InputError(
            f"{self.name}: temperature {_celsius(temperature)}: {why} {_celsius(limit)}; allowed: {_celsius(low)} to "
            f"{_celsius(high)}{hint}"
        )

    def dynamic_viscosity(self, temperature: float) -> float:
        """Dynamic viscosity [Pa s] at a temperature [K]."""
        return self.viscosity.kinematic(temperature) * self.density(temperature)

    def temperature_viscosity(self, temperature: float) -> float:
        """-d ln(dynamic viscosity)/dT [1/K] at a temperature [K]."""
        return -self.viscosity.logarithm(temperature)[1] - self.density.slope / self.density(temperature)

    def pressure_coefficient(self, temperature: float) -> float:
        """Pressure-viscosity coefficient [1/Pa] at a temperature [K].

        Raises
        ------
        InputError : an oil of which none is known.
        """
        if self.pressure_viscosity is None:
            usual = USUAL_PRESSURE_VISCOSITY.get(self.base)
            raise InputError(
                f"{self.name}: no pressure-viscosity coefficient with a source is known of {self.base} fluids; give "
                f"pressure_viscosity{f', {usual}' if usual else ''}"
            )
        return self.pressure_viscosity.at(
            self.dynamic_viscosity(temperature),
            self.density(temperature),
            self.viscosity.walther_slope(temperature),
        )

    def notes(self, temperature: float) -> tuple[Note, ...]:
        """Return notes on the oil at a temperature [K]: extrapolated properties, flash point, service limit."""
        law, found = self.viscosity, []
        mu = self.dynamic_viscosity(temperature)
        if not law.lowest - EXTRAPOLATED <= temperature <= law.highest + EXTRAPOLATED:
            low, high = law.lowest - ZERO_CELSIUS, law.highest - ZERO_CELSIUS
            found.append(
                OIL_DATA_SHORT(
                    self.name, temperature=temperature - ZERO_CELSIUS, low=low, high=high, reason="viscosity"
                )
            )
        if mu > FLOWS:
            found.append(OIL_TOO_THICK(self.name, viscosity=mu, limit=FLOWS))
        if self.flash_point is not None and temperature > self.flash_point:
            found.append(OIL_TOO_HOT(self.name, limit=self.flash_point - ZERO_CELSIUS, reason="flash-point"))
        if self.largest_service is not None and temperature > self.largest_service:
            found.append(OIL_TOO_HOT(self.name, limit=self.largest_service - ZERO_CELSIUS, reason="service"))
        if self.pressure_viscosity is not None:
            note = self.pressure_viscosity.note(mu, self.density(temperature), temperature)
            found += [] if note is None else [note.at(self.name)]
        return tuple(found)

    def at(self, temperature: float, **laws: Any) -> Lubricant:
        """The lubricant that it is at a temperature [K].

        Parameters
        ----------
        temperature : [K].
        **laws : further arguments of `bem.Lubricant`: viscosity, density and shear law and their parameters;
            `pressure_viscosity`, `density` and the like in place of the oil's own.

        Raises
        ------
        InputError : a temperature at which it is no liquid, an oil without a pressure-viscosity coefficient, and those
            of `bem.Lubricant`.
        """
        from bem.lubrication.lubricant import Lubricant

        self.check(temperature)
        given = {key: value for key, value in laws.items() if value is not None}
        if "pressure_viscosity" not in given:
            given["pressure_viscosity"] = self.pressure_coefficient(temperature)
        own = {
            "temperature": temperature,
            "density": self.density(temperature),
            "heat_capacity": None if self.heat_capacity is None else self.heat_capacity(temperature),
            "thermal_conductivity": None
            if self.thermal_conductivity is None
            else self.thermal_conductivity(temperature),
            "temperature_viscosity": self.temperature_viscosity(temperature),
            "oil": self,
        }
        values = own | given
        return Lubricant(self.viscosity.kinematic(temperature) * values["density"], **values)


def _celsius(temperature: float) -> str:
    return f"{temperature - ZERO_CELSIUS:.6g} degC"
