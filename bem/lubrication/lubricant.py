"""The oil: viscosity, density and shear laws."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.lubrication.density import DENSITY_LAWS
from bem.lubrication.shear_thinning import AMBIENT_SHEAR_STRENGTH, LIMITING_SHEAR_COEFFICIENT, SHEAR_LAWS
from bem.lubrication.viscosity import LARGEST_PRESSURES, ROELANDS_VISCOSITY, VISCOSITY_LAWS

_LARGEST_LOGARITHM = 600.0


@dataclass(frozen=True)
class Lubricant:
    """An oil at one temperature.

    Parameters
    ----------
    viscosity : dynamic viscosity at ambient pressure [Pa s], positive.
    pressure_viscosity : alpha, slope of ln(viscosity) with pressure at ambient pressure [1/Pa]; 0 is isoviscous.
    viscosity_law : "roelands", "barus" or "isoviscous".
    density_law : "incompressible" or "dowson_higginson".
    shear_law : "limited", "newtonian", "eyring" or "carreau", used for friction and not for the film. All but
        "newtonian" carry no more than `ambient_shear_strength + limiting_shear_coefficient * pressure`; below that
        "limited" is Newtonian.
    shear_stress_limit : the Eyring stress or Carreau's critical stress [Pa]; needed by those laws.
    carreau_exponent : n of Carreau's law, between 0 and 1.
    limiting_shear_coefficient : slope of the limiting shear stress with pressure, positive; measured between 0.04 and
        0.12, Bair and Winer (1979), Hoglund and Jacobson (1986), Bair, *High-pressure rheology* (2007).
    ambient_shear_strength : limiting shear stress at ambient pressure [Pa], positive; 1 to 5 MPa, Hoglund and Jacobson
        (1986).

    Raises
    ------
    InputError : one message per value that is out of range or law that is unknown.
    """

    viscosity: float
    pressure_viscosity: float = 0.0
    viscosity_law: str = "roelands"
    density_law: str = "incompressible"
    shear_law: str = "limited"
    shear_stress_limit: float | None = None
    carreau_exponent: float = 0.5
    limiting_shear_coefficient: float = LIMITING_SHEAR_COEFFICIENT
    ambient_shear_strength: float = AMBIENT_SHEAR_STRENGTH

    def __init__(
        self,
        viscosity: float,
        *,
        pressure_viscosity: float = 0.0,
        viscosity_law: str = "roelands",
        density_law: str = "incompressible",
        shear_law: str = "limited",
        shear_stress_limit: float | None = None,
        carreau_exponent: float = 0.5,
        limiting_shear_coefficient: float = LIMITING_SHEAR_COEFFICIENT,
        ambient_shear_strength: float = AMBIENT_SHEAR_STRENGTH,
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
        for key, value, laws in (
            ("viscosity_law", viscosity_law, VISCOSITY_LAWS),
            ("density_law", density_law, DENSITY_LAWS),
            ("shear_law", shear_law, SHEAR_LAWS),
        ):
            if value not in laws:
                messages.append(f"Lubricant: {key} {value!r} is unknown; choose from {', '.join(sorted(laws))}")
        if not messages and viscosity_law == "roelands" and viscosity <= 1.01 * ROELANDS_VISCOSITY:
            messages.append(
                f"Lubricant: Roelands' law needs a viscosity above {ROELANDS_VISCOSITY:g} Pa s, not {viscosity!r}; "
                'use viscosity_law="barus" or "isoviscous"'
            )
        if shear_law in ("eyring", "carreau") and not (
            shear_stress_limit is not None and _is_number(shear_stress_limit) and shear_stress_limit > 0
        ):
            messages.append(
                f"Lubricant: shear_stress_limit {shear_stress_limit!r} must be positive [Pa] for the {shear_law} law"
            )
        if not (_is_number(carreau_exponent) and 0 < carreau_exponent <= 1):
            messages.append(f"Lubricant: carreau_exponent {carreau_exponent!r} must lie in (0, 1]")
        for name, number, unit in (
            ("limiting_shear_coefficient", limiting_shear_coefficient, ""),
            ("ambient_shear_strength", ambient_shear_strength, " [Pa]"),
        ):
            if not (_is_number(number) and number > 0):
                messages.append(
                    f"Lubricant: {name} {number!r} must be positive and finite{unit}; "
                    'shear_law="newtonian" has no limiting shear stress'
                )
        if messages:
            raise InputError(messages)
        object.__setattr__(self, "viscosity", float(viscosity))
        object.__setattr__(self, "pressure_viscosity", float(pressure_viscosity))
        object.__setattr__(self, "viscosity_law", viscosity_law)
        object.__setattr__(self, "density_law", density_law)
        object.__setattr__(self, "shear_law", shear_law)
        object.__setattr__(
            self, "shear_stress_limit", None if shear_stress_limit is None else float(shear_stress_limit)
        )
        object.__setattr__(self, "carreau_exponent", float(carreau_exponent))
        object.__setattr__(self, "limiting_shear_coefficient", float(limiting_shear_coefficient))
        object.__setattr__(self, "ambient_shear_strength", float(ambient_shear_strength))

    def log_viscosity_ratio(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """ln(mu / mu0) and its derivative [1/Pa] at pressures >= 0 [Pa]."""
        return VISCOSITY_LAWS[self.viscosity_law](pressure, self.viscosity, self.pressure_viscosity)

    def viscosity_at(self, pressure: FloatArray) -> FloatArray:
        """Viscosity [Pa s] at pressures >= 0 [Pa]; beyond the range of floating point the largest number in it.

        Long before that a Newtonian oil is no model of friction.
        """
        return self.viscosity * np.exp(np.minimum(self.log_viscosity_ratio(pressure)[0], _LARGEST_LOGARITHM))

    def density_ratio(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Density over that at ambient pressure and its derivative [1/Pa] at pressures >= 0 [Pa]."""
        return DENSITY_LAWS[self.density_law](pressure)

    @property
    def largest_pressure(self) -> float:
        """Pressure up to which the viscosity law describes oils [Pa]."""
        return LARGEST_PRESSURES[self.viscosity_law]

    def shear_stress(self, newtonian_stress: FloatArray, pressure: FloatArray | float | None = None) -> FloatArray:
        """Shear stress [Pa] the oil carries where a Newtonian one would carry `newtonian_stress`; odd in it.

        With the pressures there [Pa] no more than the limiting shear stress: a sharp cut, as measured flow curves have
        it (Bair and Winer 1979), so that below the limit the law's own values stay to the last bit. Without pressures
        the law's own values.
        """
        scale = self.shear_stress_limit if self.shear_stress_limit is not None else math.inf
        stress = SHEAR_LAWS[self.shear_law](newtonian_stress, scale, self.carreau_exponent)
        if pressure is None or self.shear_law == "newtonian":
            return stress
        limit = self.ambient_shear_strength + self.limiting_shear_coefficient * pressure
        return np.clip(stress, -limit, limit)


def _is_number(value: object) -> bool:
    try:
        return math.isfinite(value)  # type: ignore[arg-type]
    except TypeError:
        return False
