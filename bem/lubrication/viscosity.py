"""Viscosity laws: ln(viscosity / viscosity at ambient pressure) and its derivative with pressure.

To add a law, derive from `ViscosityLaw` and register it, here or in a file of your own; pressures are never negative.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bem.grid import FloatArray
from bem.laws import Law, register

ROELANDS_PRESSURE = 1.962e8
"""Pole of Roelands' law [Pa]; Roelands, *Correlational aspects of the viscosity-temperature-pressure
relationship of lubricating oils* (1966)."""
LARGEST_EXPONENT = 10.0
"""z of Roelands' law up to which it is taken: eight times that of any oil."""
ROELANDS_VISCOSITY = 6.315e-5
"""Viscosity that all oils share at the pole [Pa s]: exp(-9.67)."""


@dataclass(frozen=True)
class ViscosityLaw(Law):
    """Viscosity over pressure of an oil with the viscosity mu0 [Pa s] at ambient pressure and the slope alpha [1/Pa] of
    ln(mu) there, whatever the law.

    `largest_pressure`: up to which the law describes oils [Pa].
    """

    family: ClassVar[str] = "viscosity_law"
    largest_pressure: ClassVar[float] = math.inf

    @property
    def described(self) -> ViscosityLaw:
        """The law by which an oil is known to its user: itself, but for a law that alters another."""
        return self

    @abstractmethod
    def log_viscosity_ratio(
        self, pressure: FloatArray, viscosity: float, pressure_viscosity: float
    ) -> tuple[FloatArray, FloatArray]:
        """ln(mu / mu0) and its derivative [1/Pa] at pressures >= 0 [Pa]."""

    def refusals(self, viscosity: float, pressure_viscosity: float) -> Iterable[str]:
        """Messages about an oil that the law does not hold for; none by default."""
        return ()


@register
@dataclass(frozen=True)
class Isoviscous(ViscosityLaw):
    """The same viscosity at every pressure."""

    name: ClassVar[str] = "isoviscous"

    def log_viscosity_ratio(
        self, pressure: FloatArray, viscosity: float, pressure_viscosity: float
    ) -> tuple[FloatArray, FloatArray]:
        """Zero."""
        return np.zeros_like(pressure), np.zeros_like(pressure)


@register
@dataclass(frozen=True)
class Barus(ViscosityLaw):
    """mu = mu0 exp(alpha p); Barus (1893). ln(mu) of oils bends away from this line by about 0.5 GPa (Hamrock,
    *Fundamentals of fluid film lubrication*, 1994)."""

    name: ClassVar[str] = "barus"
    cites: ClassVar[tuple[str, ...]] = ("barus1893",)
    largest_pressure: ClassVar[float] = 0.5e9

    def log_viscosity_ratio(
        self, pressure: FloatArray, viscosity: float, pressure_viscosity: float
    ) -> tuple[FloatArray, FloatArray]:
        """alpha p."""
        return pressure_viscosity * pressure, np.full_like(pressure, pressure_viscosity)


@register
@dataclass(frozen=True)
class Roelands(ViscosityLaw):
    """mu = mu0 exp{ln(mu0 / mu_r) [(1 + p/p_r)^z - 1]}, z = alpha p_r / ln(mu0 / mu_r); Roelands (1966), fitted to
    measurements up to 1 GPa (ASME 1953)."""

    name: ClassVar[str] = "roelands"
    cites: ClassVar[tuple[str, ...]] = ("roelands1966",)
    largest_pressure: ClassVar[float] = 1.0e9

    def log_viscosity_ratio(
        self, pressure: FloatArray, viscosity: float, pressure_viscosity: float
    ) -> tuple[FloatArray, FloatArray]:
        """The exponent above."""
        span = math.log(viscosity / ROELANDS_VISCOSITY)
        exponent = pressure_viscosity * ROELANDS_PRESSURE / span
        base = 1 + pressure / ROELANDS_PRESSURE
        power = base**exponent
        return span * (power - 1), pressure_viscosity * power / base

    def refusals(self, viscosity: float, pressure_viscosity: float) -> Iterable[str]:
        """The oil must be more viscous than the pole, and its exponent z one of a liquid: 0.2 to 1.2."""
        if viscosity <= 1.01 * ROELANDS_VISCOSITY:
            yield (
                f"Roelands' law needs a viscosity above {ROELANDS_VISCOSITY:g} Pa s, not {viscosity!r}; "
                'use viscosity_law="barus" or "isoviscous"'
            )
        elif (exponent := pressure_viscosity * ROELANDS_PRESSURE / math.log(viscosity / ROELANDS_VISCOSITY)) > (
            LARGEST_EXPONENT
        ):
            yield (
                f"pressure_viscosity {pressure_viscosity!r} 1/Pa makes Roelands' exponent {exponent:.3g}, that of oils "
                f"is 0.2 to 1.2 and up to {LARGEST_EXPONENT:g} is taken; check the units: 20 1/GPa are 20e-9"
            )
