"""Rigid flat punches without friction: circular, strip, and a periodic row of strips.

Johnson, *Contact Mechanics* (1985), sections 2.8 and 3.4; the row follows from the strip by x -> sin(pi x / period).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class CircularPunch:
    """Flat-ended cylinder of `radius` [m] under `load` [N] on a half-space of `contact_modulus` [Pa]."""

    radius: float
    contact_modulus: float
    load: float

    @property
    def approach(self) -> float:
        """P / (2 a E*) [m]."""
        return self.load / (2 * self.radius * self.contact_modulus)

    def pressure(self, r: ArrayLike) -> FloatArray:
        """P / (2 pi a sqrt(a^2 - r^2)) [Pa]; infinite at the edge, zero outside."""
        r2 = np.asarray(r, dtype=np.float64) ** 2
        a2 = self.radius**2
        with np.errstate(divide="ignore"):
            inside = self.load / (2 * np.pi * self.radius * np.sqrt(np.maximum(a2 - r2, 0.0)))
        return np.where(r2 <= a2, inside, 0.0)

    def load_within(self, r: ArrayLike) -> FloatArray:
        """Load [N] carried within radius r: P (1 - sqrt(1 - r^2/a^2)); finite where the pressure is not."""
        share = np.minimum(np.asarray(r, dtype=np.float64) / self.radius, 1.0)
        return self.load * (1 - np.sqrt(1 - share**2))

    def displacement(self, r: ArrayLike) -> FloatArray:
        """Approach below the punch, (2 approach / pi) arcsin(a/r) outside [m]."""
        ratio = self.radius / np.maximum(np.abs(np.asarray(r, dtype=np.float64)), self.radius)
        return 2 * self.approach / np.pi * np.arcsin(ratio)


@dataclass(frozen=True)
class StripPunch:
    """Flat strip |x| <= `half_width` [m] under `load` per length [N/m]; with a `period` [m], one of an endless row.

    In plane strain only differences of displacement mean anything: they are taken from the edge of the strip.
    """

    half_width: float
    contact_modulus: float
    load: float
    period: float = math.inf

    def pressure(self, x: ArrayLike) -> FloatArray:
        """Pressure [Pa]: W / (pi sqrt(a^2 - x^2)).

        In a row (W/L) cos(psi) / sqrt(sin^2 psi_a - sin^2 psi), psi = pi x/L.
        """
        s, t, scale = self._coordinates(x)
        with np.errstate(divide="ignore"):
            inside = scale / np.sqrt(np.maximum(t * t - s * s, 0.0))
        return np.where(s <= t, inside, 0.0)

    def gap(self, x: ArrayLike) -> FloatArray:
        """How much higher than the strip's face the free surface would have to sink [m]: 2W/(pi E*) arccosh(s/t)."""
        s, t, _ = self._coordinates(x)
        return 2 * self.load / (np.pi * self.contact_modulus) * np.arccosh(np.maximum(s / t, 1.0))

    def _coordinates(self, x: ArrayLike) -> tuple[FloatArray, float, FloatArray]:
        x = np.asarray(x, dtype=np.float64)
        if math.isinf(self.period):
            return np.abs(x), self.half_width, np.full_like(x, self.load / np.pi)
        psi = np.pi * x / self.period
        edge = math.sin(math.pi * self.half_width / self.period)
        return np.abs(np.sin(psi)), edge, self.load / self.period * np.abs(np.cos(psi))
