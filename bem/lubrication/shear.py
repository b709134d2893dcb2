"""Shear laws: the shear stress an oil carries where a Newtonian one would carry mu du/h, for friction.

To add a law, derive from `LimitedShear` (or `ShearLaw`, which has no limit) and register it, here or in a file of your
own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bem.grid import FloatArray
from bem.laws import Law, parameter, register


@dataclass(frozen=True, kw_only=True)
class ShearLaw(Law):
    """Shear stress over Newtonian shear stress and pressure; odd in the shear stress."""

    family: ClassVar[str] = "shear_law"

    def unlimited(self, newtonian: FloatArray) -> FloatArray:
        """Shear stress [Pa] at Newtonian shear stresses [Pa], before any limit."""
        raise NotImplementedError

    def limit(self, pressure: FloatArray | float) -> FloatArray | float:
        """Largest shear stress [Pa] at pressures [Pa]; infinite unless a law says otherwise."""
        return math.inf

    def shear_stress(self, newtonian: FloatArray, pressure: FloatArray | float) -> FloatArray:
        """Shear stress [Pa]: a sharp cut at the limit, as measured flow curves have it (Bair and Winer 1979), so that
        below it `unlimited` stays to the last bit."""
        limit = self.limit(pressure)
        return np.clip(self.unlimited(newtonian), -limit, limit)


@register
@dataclass(frozen=True, kw_only=True)
class Newtonian(ShearLaw):
    """Stress in proportion to the shear rate, without a limit."""

    name: ClassVar[str] = "newtonian"

    def unlimited(self, newtonian: FloatArray) -> FloatArray:
        """The same."""
        return newtonian


@register
@dataclass(frozen=True, kw_only=True)
class LimitedShear(ShearLaw):
    """Newtonian up to tau_a + Lambda p."""

    name: ClassVar[str] = "limited"
    limiting_shear_coefficient: float = parameter(
        "slope of the limiting shear stress with pressure",
        default=0.08,
        above=0,
        source="the middle of 0.04 to 0.12: Bair and Winer, J. Lubr. Technol. 101 (1979) 251, Hoglund and Jacobson, "
        "J. Tribol. 108 (1986) 571, Bair, High-pressure rheology (2007)",
    )
    ambient_shear_strength: float = parameter(
        "limiting shear stress at ambient pressure",
        "Pa",
        default=5e6,
        above=0,
        source="the upper end of the 1 to 5 MPa of Hoglund and Jacobson (1986)",
    )

    def unlimited(self, newtonian: FloatArray) -> FloatArray:
        """The same."""
        return newtonian

    def limit(self, pressure: FloatArray | float) -> FloatArray | float:
        """tau_a + Lambda p."""
        return self.ambient_shear_strength + self.limiting_shear_coefficient * pressure


@register
@dataclass(frozen=True, kw_only=True)
class Eyring(LimitedShear):
    """tau = tau0 asinh(mu du/h / tau0), tau0 the Eyring stress; Eyring (1936), Johnson and Tevaarwerk (1977)."""

    name: ClassVar[str] = "eyring"
    shear_stress_limit: float = parameter("Eyring stress, where thinning begins", "Pa", above=0)

    def unlimited(self, newtonian: FloatArray) -> FloatArray:
        """The stress above."""
        return self.shear_stress_limit * np.arcsinh(newtonian / self.shear_stress_limit)


@register
@dataclass(frozen=True, kw_only=True)
class Carreau(LimitedShear):
    """tau = mu rate [1 + (mu rate / G)^2]^((n - 1)/2), G the critical stress, n the exponent; Bair (2007)."""

    name: ClassVar[str] = "carreau"
    shear_stress_limit: float = parameter("critical stress, where thinning begins", "Pa", above=0)
    carreau_exponent: float = parameter(
        "slope of ln(stress) with ln(rate) far beyond it", default=0.5, above=0, at_most=1
    )

    def unlimited(self, newtonian: FloatArray) -> FloatArray:
        """The stress above."""
        # hypot: the square of a Newtonian stress at high pressure is beyond floating point
        return newtonian * np.hypot(1.0, newtonian / self.shear_stress_limit) ** (self.carreau_exponent - 1)
