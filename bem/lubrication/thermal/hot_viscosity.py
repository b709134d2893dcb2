"""Viscosity of an oil over pressure and temperature, from its viscosity over pressure at one temperature.

Roelands' form (1966): ln(mu/mu_r) over pressure is the same function at every temperature but for a factor,

    ln(mu(p, T)/mu_r) = s(T) ln(mu(p, T0)/mu_r),    s(T) = ln(mu(0, T)/mu_r) / ln(mu(0, T0)/mu_r),

with mu_r = 63.15 uPa s, so that the pressure-viscosity coefficient falls with temperature, too. s follows the viscosity
of the oil over temperature. For an oil known at one temperature, and beyond 300 degrees Celsius, s = ((T - 138 K)/(T0 -
138 K))^-S0 with the slope of ln(mu) there (L. Houpert, *J. Tribol.* 107 (1985) 241). Verified in
tests/lubrication/test_thermal_film.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.oils.oil import COLDEST, HOTTEST
from bem.lubrication.viscosity import ROELANDS_VISCOSITY
from bem.numerics.monotone import MonotoneCubic

POLE = 138.0
"""Temperature at which Roelands' viscosity is infinite [K]."""
LEAST_SPAN = 0.2
"""ln(mu/mu_r) below which the oil is so thin that only the factor exp(-beta (T - T0)) is used."""
_STEP = 5.0
LARGEST_LOGARITHM = 600.0
"""Bound of ln(mu/mu0), so that viscosities stay in floating point."""


@dataclass(frozen=True)
class HotViscosity:
    """Viscosity law of pressure and temperature: pressures [Pa] and temperatures [K], (n,) each -> viscosity [Pa s] and
    its derivative with temperature.

    span : ln(mu0/mu_r). reference : temperature of the lubricant [K]. softening : -d ln(mu)/dT there [1/K].
    exponent : S0, from `hottest` [K] on. log_factor : ln s over temperature up to there; None where only a slope is
        known.
    """

    lubricant: Lubricant
    span: float
    reference: float
    softening: float
    exponent: float
    hottest: float
    log_factor: MonotoneCubic | None

    @classmethod
    def of(cls, lubricant: Lubricant) -> HotViscosity:
        """Return the law of a lubricant that has a temperature and is known at others.

        Raises
        ------
        InputError : a lubricant without temperature or `temperature_viscosity`.
        """
        softening, reference = lubricant.temperature_viscosity, lubricant.temperature
        if softening is None or reference is None:
            raise InputError("lubricant: its heat needs temperature [K] and temperature_viscosity [1/K]")
        span = math.log(lubricant.viscosity / ROELANDS_VISCOSITY)
        log_factor, hottest = None, reference
        if lubricant.oil is not None and span > LEAST_SPAN:
            hottest = min(lubricant.oil.boiling_point or HOTTEST, HOTTEST)
            lowest = max(lubricant.oil.freezing_point or COLDEST, reference - 60.0)
            points = np.linspace(lowest, hottest, max(int((hottest - lowest) / _STEP), 4))
            points = np.unique(np.append(points[np.abs(points - reference) > 0.1 * _STEP], reference))
            logs = np.array([math.log(lubricant.oil.dynamic_viscosity(float(t)) / ROELANDS_VISCOSITY) for t in points])
            own = math.log(lubricant.oil.dynamic_viscosity(reference) / ROELANDS_VISCOSITY)
            log_factor = MonotoneCubic(points, np.log(np.maximum(logs, LEAST_SPAN) / own))
        slope = softening / span if log_factor is None else -float(log_factor.slope(hottest))
        exponent = max(slope, 0.0) * (hottest - POLE)
        return cls(lubricant, span, reference, softening, exponent, hottest, log_factor)

    def log_line(self, temperature: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Return a and b of ln(mu/mu0) = a L + b and their derivatives with temperature [1/K], at temperatures [K] of
        any shape.

        L is ln(mu/mu0) at the temperature of the lubricant and the same pressure.
        """
        if self.span <= LEAST_SPAN:
            one, none = np.ones_like(temperature), np.zeros_like(temperature)
            return one, -self.softening * (temperature - self.reference), none, -self.softening * one
        factor, steepness = self._factor(temperature)
        slope = factor * steepness
        return factor, self.span * (factor - 1), slope, self.span * slope

    def __call__(self, pressure: FloatArray, temperature: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return viscosity [Pa s] and its derivative with temperature [Pa s/K]."""
        at_reference = self.lubricant.log_viscosity_ratio(pressure)[0]
        times, plus, times_slope, plus_slope = self.log_line(temperature)
        value, slope = times * at_reference + plus, times_slope * at_reference + plus_slope
        viscosity = self.lubricant.viscosity * np.exp(np.minimum(value, LARGEST_LOGARITHM))
        return viscosity, viscosity * slope

    def _factor(self, temperature: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return s and d ln(s)/dT."""
        above = np.maximum(temperature, POLE + 1.0) - POLE
        beyond = -self.exponent * np.log(above / (self.hottest - POLE))
        steep = -self.exponent / above
        if self.log_factor is None:
            return np.exp(beyond), steep
        inside = np.clip(temperature, self.log_factor.x[0], self.hottest)
        hot = temperature > self.hottest
        logarithm = self.log_factor(inside) + np.where(hot, beyond, 0.0)
        return np.exp(logarithm), np.where(hot, steep, self.log_factor.slope(inside))
