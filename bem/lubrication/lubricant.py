"""The oil: viscosity, density and shear laws."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.laws import make_laws
from bem.lubrication.density import DensityLaw
from bem.lubrication.shear import ShearLaw
from bem.lubrication.viscosity import ViscosityLaw

if TYPE_CHECKING:
    from bem.lubrication.oils import Oil
    from bem.notes import Note

_LARGEST_LOGARITHM = 600.0
FILM_RHEOLOGIES = ("newtonian", "shear_law")
_UNITS = {
    "temperature": "K",
    "density": "kg/m^3",
    "heat_capacity": "J/(kg K)",
    "thermal_conductivity": "W/(m K)",
    "temperature_viscosity": "1/K",
}


@dataclass(frozen=True)
class Lubricant:
    """An oil at one temperature.

    Parameters
    ----------
    viscosity : dynamic viscosity at ambient pressure [Pa s], positive.
    pressure_viscosity : alpha, slope of ln(viscosity) with pressure at ambient pressure [1/Pa]; 0 is isoviscous.
    viscosity_law : "roelands", "barus" or "isoviscous", the name of a law of your own, or a law.
    density_law : "dowson_higginson", "incompressible", another name or a law.
    shear_law : of the friction, and of the film's flow where `film_rheology` says so: "limited", "newtonian", "eyring",
        "carreau", "base_oil", another name or a law. All of these but "newtonian" carry no more than a limiting shear
        stress that rises linearly with pressure; below that "limited" is Newtonian. "base_oil" is Eyring's law under
        a limit that falls with temperature, with the constants of the oil's base.
    film_rheology : "newtonian": the shear law acts on the friction and not on the film; "shear_law": on both, through
        the profile of stress and speed across the film (`bem.lubrication.shear_profile`).
    temperature : that of the oil [K], from which heat, the limit of "base_oil" and laws of boundary friction over
        temperature start; None where it is not known, as the next four. "base_oil" then has its limit at 40 degC.
    density : at ambient pressure [kg/m^3].
    heat_capacity : per mass [J/(kg K)].
    thermal_conductivity : [W/(m K)].
    temperature_viscosity : beta, -d ln(viscosity)/dT at ambient pressure [1/K].
    oil : the oil it is of at that temperature, which knows it at others; see `of` and `bem.lubrication.oils`.
    base : base of an oil that is not given, for the constants of "base_oil": "mineral" where it is left out.
    **parameters : of the laws, by name: `shear_stress_limit` [Pa] of eyring and carreau (the stress at which thinning
        sets in, no limit), `carreau_exponent`, `limiting_shear_coefficient`, `ambient_shear_strength` [Pa], those of
        your own laws. They are attributes, too.

    Raises
    ------
    InputError : one message per value that is out of range and per law or parameter that is unknown.
    """

    viscosity: float
    pressure_viscosity: float
    viscosity_law: ViscosityLaw
    density_law: DensityLaw
    shear_law: ShearLaw
    temperature: float | None = None
    density: float | None = None
    heat_capacity: float | None = None
    thermal_conductivity: float | None = None
    temperature_viscosity: float | None = None
    oil: Oil | None = None
    film_rheology: str = "newtonian"

    def __init__(
        self,
        viscosity: float,
        *,
        pressure_viscosity: float = 0.0,
        viscosity_law: str | ViscosityLaw = "roelands",
        density_law: str | DensityLaw = "dowson_higginson",
        shear_law: str | ShearLaw = "limited",
        temperature: float | None = None,
        density: float | None = None,
        heat_capacity: float | None = None,
        thermal_conductivity: float | None = None,
        temperature_viscosity: float | None = None,
        oil: Oil | None = None,
        film_rheology: str = "newtonian",
        base: str | None = None,
        **parameters: float | None,
    ) -> None:
        messages = []
        if not (_is_number(viscosity) and viscosity > 0):
            messages.append(
                f"Lubricant: viscosity {viscosity!r} must be positive and finite [Pa s]; an oil without viscosity "
                "makes no film"
            )
        if not (_is_number(pressure_viscosity) and pressure_viscosity >= 0):
            messages.append(
                f"Lubricant: pressure_viscosity {pressure_viscosity!r} must be zero or positive, and finite [1/Pa]"
            )
        heat = {
            "temperature": temperature,
            "density": density,
            "heat_capacity": heat_capacity,
            "thermal_conductivity": thermal_conductivity,
            "temperature_viscosity": temperature_viscosity,
        }
        messages += [
            f"Lubricant: {key} {value!r} must be positive and finite [{_UNITS[key]}], or left out"
            for key, value in heat.items()
            if value is not None and not (_is_number(value) and value > 0)
        ]
        if film_rheology not in FILM_RHEOLOGIES:
            allowed = " or ".join(f'"{name}"' for name in FILM_RHEOLOGIES)
            messages.append(f"Lubricant: film_rheology {film_rheology!r} must be {allowed}")
        chosen = {"viscosity_law": viscosity_law, "density_law": density_law, "shear_law": shear_law}
        laws: dict[str, Any] = {}
        try:
            laws = make_laws("Lubricant", chosen, parameters)
        except InputError as error:
            messages += error.messages
        if not messages:
            refusals = cast(ViscosityLaw, laws["viscosity_law"]).refusals(viscosity, pressure_viscosity)
            messages += [f"Lubricant: {text}" for text in refusals]
        if messages:
            raise InputError(messages)
        laws["shear_law"] = _completed(laws["shear_law"], oil, base)
        values = {"viscosity": float(viscosity), "pressure_viscosity": float(pressure_viscosity), **laws}
        values |= {key: None if value is None else float(value) for key, value in heat.items()}
        for key, value in (values | {"oil": oil, "film_rheology": film_rheology}).items():
            object.__setattr__(self, key, value)

    @classmethod
    def of(
        cls,
        name: str,
        *,
        temperature: float,
        viscosity_index: float | None = None,
        base: str | None = None,
        **laws: Any,
    ) -> Lubricant:
        """An oil of the catalogue at a temperature.

        Parameters
        ----------
        name : name or grade, such as "ISO VG 68", "SAE 5W-30", "PAO 4"; `bem oils` lists them.
        temperature : [K].
        viscosity_index, base : of a grade, see `bem.lubrication.oils.find_oil`.
        **laws : other arguments of `Lubricant`; `pressure_viscosity` in place of the oil's own.

        Raises
        ------
        InputError : an unknown oil, with the nearest known one; a temperature at which it is no liquid.
        """
        from bem.lubrication.oils.catalogue import find_oil

        return find_oil(name, viscosity_index=viscosity_index, base=base).at(temperature, **laws)

    @property
    def notes(self) -> tuple[Note, ...]:
        """Notes on the oil at its temperature: figures extrapolated, flash point, too thick to flow."""
        return () if self.oil is None or self.temperature is None else self.oil.notes(self.temperature)

    @property
    def shears_film(self) -> bool:
        """Return True if the film's flow follows a shear law other than the Newtonian one."""
        if self.film_rheology == "newtonian":
            return False
        return self.shear_law.thins or bool(np.isfinite(self.shear_law.limit(0.0)))

    def __getattr__(self, key: str) -> float:
        """A parameter of one of the laws."""
        if not key.startswith("_"):
            for family in ("viscosity_law", "density_law", "shear_law"):
                law = self.__dict__.get(family)
                if law is not None and key in law.parameters():
                    return float(getattr(law, key))
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {key!r}")

    def log_viscosity_ratio(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """ln(mu / mu0) and its derivative [1/Pa] at pressures >= 0 [Pa]."""
        return self.viscosity_law.log_viscosity_ratio(pressure, self.viscosity, self.pressure_viscosity)

    def viscosity_at(self, pressure: FloatArray) -> FloatArray:
        """Viscosity [Pa s] at pressures >= 0 [Pa]; beyond the range of floating point the largest number in it.

        Long before that a Newtonian oil is no model of friction.
        """
        return self.viscosity * np.exp(np.minimum(self.log_viscosity_ratio(pressure)[0], _LARGEST_LOGARITHM))

    def density_ratio(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Density over that at ambient pressure and its derivative [1/Pa] at pressures >= 0 [Pa]."""
        return self.density_law.density_ratio(pressure)

    def shear_stress(
        self,
        newtonian_stress: FloatArray,
        pressure: FloatArray | float | None = None,
        temperature: FloatArray | float | None = None,
    ) -> FloatArray:
        """Shear stress [Pa] the oil carries where a Newtonian one would carry `newtonian_stress`; odd in it.

        With the pressures there [Pa] no more than the limiting shear stress. Without pressures what the law gives
        before any limit. `temperature` : that of the film [K], which some limits depend on; the oil's by default.
        """
        if pressure is None:
            return self.shear_law.unlimited(newtonian_stress)
        if not self.shear_law.limit_falls_with_temperature:
            return self.shear_law.shear_stress(newtonian_stress, pressure)
        at = self.temperature if temperature is None else temperature
        return self.shear_law.shear_stress(newtonian_stress, pressure, at)

    def limiting_stress(
        self, pressure: FloatArray | float, temperature: FloatArray | float | None = None
    ) -> FloatArray | float:
        """Limiting shear stress [Pa] at pressures [Pa] and temperatures [K], by default the oil's own."""
        return self.shear_law.limit_at(pressure, self.temperature if temperature is None else temperature)


def _completed(law: ShearLaw, oil: Oil | None, base: str | None) -> ShearLaw:
    """Return a shear law with the constants of the oil where the law leaves them open."""
    if None not in law.values().values():
        return law
    from bem.lubrication.rheology import rheology_of

    own = None if oil is None else oil.shear
    return law.of_oil(own or rheology_of(base or (oil.base if oil is not None else None)))


def _is_number(value: object) -> bool:
    try:
        return math.isfinite(value)  # type: ignore[arg-type]
    except TypeError:
        return False
