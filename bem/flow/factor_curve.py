"""A flow factor interpolated over separation, with its asymptotes beyond the table."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bem.grid import FloatArray
from bem.numerics.monotone import MonotoneCubic


@dataclass(frozen=True, eq=False)
class FactorCurve:
    """Monotone interpolation of a flow factor over separation, continued by power laws on both sides.

    Between the values the curve is a monotone piecewise cubic in the logarithms (Fritsch and Carlson). Where the first
    values are zero it is linear from the last zero to the next value.

    Attributes
    ----------
    separation : (n,) rising [m].
    value : (n,) >= 0.
    limit : value at infinite separation.
    decay_exponent : n of value - limit proportional to d^-n beyond the last separation d (second-order perturbation
        theory).
    growth_exponent : n of a value proportional to d^n below the first separation. None takes the slope of the first
        value, or zero if that slope is negative.
    """

    separation: FloatArray
    value: FloatArray
    limit: float
    decay_exponent: float
    growth_exponent: float | None = None

    @cached_property
    def _first(self) -> int:
        """Index of the first value from which on all values are positive."""
        zeros = np.flatnonzero(self.value <= 0)
        return 0 if zeros.size == 0 else int(zeros[-1]) + 1

    @cached_property
    def _cubic(self) -> MonotoneCubic | None:
        """Interpolation of ln value over ln separation; None for a single value."""
        x, y = np.log(self.separation[self._first :]), np.log(self.value[self._first :])
        return MonotoneCubic(x, y) if len(x) > 1 else None

    def __call__(self, separation: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the factor and its derivative [1/m], both of the shape of `separation` (> 0) [m]."""
        h = np.asarray(separation, dtype=np.float64)
        value, slope = np.zeros(h.shape), np.zeros(h.shape)
        first, last = self._first, len(self.value) - 1
        if first > last:
            return value, slope
        low, high = self.separation[first], self.separation[last]
        inside = (h >= low) & (h <= high)
        value[inside], slope[inside] = self._between(h[inside])
        beyond = h > high
        power = (high / h[beyond]) ** self.decay_exponent
        value[beyond] = self.limit + (self.value[last] - self.limit) * power
        slope[beyond] = -self.decay_exponent * (self.value[last] - self.limit) * power / h[beyond]
        below = h < low
        value[below], slope[below] = self._below(h[below])
        return value, slope

    def _between(self, h: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the factor and its derivative inside the table."""
        if self._cubic is None:
            return np.full(h.shape, self.value[-1]), np.zeros(h.shape)
        x = np.log(h)
        value = np.exp(self._cubic(x))
        return value, value * self._cubic.slope(x) / h

    def _below(self, h: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the factor and its derivative below the first positive value."""
        low, start = self.separation[self._first], self.value[self._first]
        if self._first > 0:
            zero = self.separation[self._first - 1]
            open_ = h > zero
            return np.where(open_, start * (h - zero) / (low - zero), 0.0), np.where(open_, start / (low - zero), 0.0)
        power = self.growth_exponent
        if power is None:
            power = max(0.0, float(self._cubic.slope(np.log(low)))) if self._cubic is not None else 0.0
        value = start * (h / low) ** power
        return value, power * value / h
