"""Density laws: density over that at ambient pressure, and its derivative with pressure.

To add a law, derive from `DensityLaw` and register it, here or in a file of your own; pressures are never negative.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bem.grid import FloatArray
from bem.laws import Law, register


@dataclass(frozen=True)
class DensityLaw(Law):
    """Density over pressure."""

    family: ClassVar[str] = "density_law"

    @abstractmethod
    def density_ratio(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """rho/rho0 and its derivative [1/Pa] at pressures >= 0 [Pa]."""


@register
@dataclass(frozen=True)
class Incompressible(DensityLaw):
    """The same density at every pressure."""

    name: ClassVar[str] = "incompressible"

    def density_ratio(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """One."""
        return np.ones_like(pressure), np.zeros_like(pressure)


@register
@dataclass(frozen=True)
class DowsonHigginson(DensityLaw):
    """rho/rho0 = 1 + 0.6e-9 p / (1 + 1.7e-9 p), p in Pa; Dowson and Higginson, *Elasto-hydrodynamic lubrication*
    (1966)."""

    name: ClassVar[str] = "dowson_higginson"
    cites: ClassVar[tuple[str, ...]] = ("dowson1966",)

    def density_ratio(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """The ratio above."""
        denominator = 1 + 1.7e-9 * pressure
        return 1 + 0.6e-9 * pressure / denominator, 0.6e-9 / denominator**2
