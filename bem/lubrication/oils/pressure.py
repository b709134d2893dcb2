"""Pressure-viscosity coefficient over viscosity: named correlations, each with what it was measured on.

The coefficient of this package is the slope of ln(viscosity) at ambient pressure. A correlation of the secant
ln(mu/mu0)/p at a higher pressure gives the slope of Roelands' law through that secant.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from bem.lubrication.viscosity import ROELANDS_PRESSURE, ROELANDS_VISCOSITY
from bem.notes import Note
from bem.notes.lubrication import OIL_DATA_SHORT
from bem.physical_constants import ZERO_CELSIUS

GPA = 1e-9
"""One 1/GPa in 1/Pa."""
_REACH = 2.0
"""How many times thinner or thicker than the oils it was made from a correlation is used without a word."""


@dataclass(frozen=True)
class PressureViscosity:
    """alpha [1/GPa] = factor x viscosity^exponent x B^slope_exponent, or a + b lg(viscosity); B is Walther's slope.

    name : of the correlation, or "given". dynamic : whether the viscosity is dynamic [mPa s], else kinematic [mm^2/s].
    logarithm : (a, b) in place of the powers. viscosity, temperature : ranges that it was made from [the unit, K].
    pressure : of the secant ln(mu/mu0)/p that the formula gives [Pa]; 0 where it gives the slope at ambient pressure.
    error : the largest that was seen, relative. source : in words.
    """

    name: str
    source: str
    dynamic: bool = True
    factor: float = 0.0
    exponent: float = 0.0
    slope_exponent: float = 0.0
    logarithm: tuple[float, float] | None = None
    viscosity: tuple[float, float] = (0.0, math.inf)
    temperature: tuple[float, float] = (0.0, math.inf)
    pressure: float = 0.0
    error: float = 0.0

    @classmethod
    def given(cls, value: float, source: str = "given") -> PressureViscosity:
        """The same at all temperatures [1/Pa]."""
        return cls("given", source, factor=value / GPA)

    def _argument(self, dynamic: float, density: float) -> float:
        return 1e3 * dynamic if self.dynamic else 1e6 * dynamic / density

    def at(self, dynamic: float, density: float, walther_slope: float) -> float:
        """alpha [1/Pa] at a dynamic viscosity [Pa s], density [kg/m^3] and Walther slope."""
        value = self._argument(dynamic, density)
        if self.logarithm is not None:
            return GPA * max(self.logarithm[0] + self.logarithm[1] * math.log10(value), 0.0)
        secant = float(GPA * self.factor * value**self.exponent * walther_slope**self.slope_exponent)
        return secant if self.pressure == 0.0 else ambient_slope(secant, self.pressure, dynamic)

    def note(self, dynamic: float, density: float, temperature: float) -> Note | None:
        """Return a note on a state [Pa s, kg/m^3, K] that the correlation was not made for, else None."""
        value = self._argument(dynamic, density)
        unit = "mPa s" if self.dynamic else "mm^2/s"
        (thin, thick), (cold, hot) = self.viscosity, self.temperature
        # ranges of one temperature are of oils measured there: the viscosity stands for the temperature
        outside = cold < hot and not cold - 10.0 <= temperature <= hot + 10.0
        if thin / _REACH <= value <= _REACH * thick and not outside:
            return None
        at = f" at {cold - ZERO_CELSIUS:.0f} to {hot - ZERO_CELSIUS:.0f} degC" if outside else ""
        return OIL_DATA_SHORT(
            correlation=self.name, thin=thin, thick=thick, unit=unit, at=at, reason="pressure-viscosity"
        )


def ambient_slope(secant: float, pressure: float, viscosity: float) -> float:
    """Return the slope of ln(viscosity) at ambient pressure [1/Pa] of Roelands' law through a secant.

    secant : ln(mu/mu0)/p [1/Pa] at the pressure p [Pa]. viscosity : mu0 [Pa s]; that of Roelands' pole or less leaves
    the secant as it is.
    """
    span = math.log(viscosity / ROELANDS_VISCOSITY)
    if span <= 0:
        return secant
    exponent = math.log1p(secant * pressure / span) / math.log1p(pressure / ROELANDS_PRESSURE)
    return exponent * span / ROELANDS_PRESSURE
