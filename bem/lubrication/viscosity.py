"""Viscosity laws: ln(viscosity / viscosity at ambient pressure) and its derivative with pressure.

To add a law, write one function here and enter it in `VISCOSITY_LAWS`; pressures are never negative.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from bem.grid import FloatArray

ViscosityLaw = Callable[[FloatArray, float, float], tuple[FloatArray, FloatArray]]

ROELANDS_PRESSURE = 1.962e8
"""Pole of Roelands' law [Pa]; Roelands, *Correlational aspects of the viscosity-temperature-pressure
relationship of lubricating oils* (1966)."""
ROELANDS_VISCOSITY = 6.315e-5
"""Viscosity that all oils share at the pole [Pa s]: exp(-9.67)."""


def isoviscous(pressure: FloatArray, viscosity: float, coefficient: float) -> tuple[FloatArray, FloatArray]:
    """The same at every pressure."""
    return np.zeros_like(pressure), np.zeros_like(pressure)


def barus(pressure: FloatArray, viscosity: float, coefficient: float) -> tuple[FloatArray, FloatArray]:
    """mu = mu0 exp(alpha p); Barus (1893)."""
    return coefficient * pressure, np.full_like(pressure, coefficient)


def roelands(pressure: FloatArray, viscosity: float, coefficient: float) -> tuple[FloatArray, FloatArray]:
    """mu = mu0 exp{ln(mu0 / mu_r) [(1 + p/p_r)^z - 1]}, z = alpha p_r / ln(mu0 / mu_r); Roelands (1966).

    The slope at ambient pressure is alpha, as for Barus' law.
    """
    span = math.log(viscosity / ROELANDS_VISCOSITY)
    exponent = coefficient * ROELANDS_PRESSURE / span
    base = 1 + pressure / ROELANDS_PRESSURE
    power = base**exponent
    return span * (power - 1), coefficient * power / base


LARGEST_PRESSURES = {"roelands": 1.0e9, "barus": 0.5e9, "isoviscous": math.inf}
"""Pressures up to which the laws describe oils [Pa]: Roelands fitted measurements up to 1 GPa (ASME 1953); ln(mu) of
oils bends away from Barus' line by about 0.5 GPa (Hamrock, *Fundamentals of fluid film lubrication*, 1994)."""

VISCOSITY_LAWS: dict[str, ViscosityLaw] = {"roelands": roelands, "barus": barus, "isoviscous": isoviscous}
