"""Balance of a tribofilm in four constants: wear coefficient, lag, substrate concentration, initial thickness.

Knows numbers only; `evolution` (mean thickness) and `local_film` (cell by cell) integrate it. Verified in
tests/tribofilm/test_film_evolution.py and test_local_film.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray

MOST_LAGS = 5000
"""Largest number of lags within the time; each is integrated by itself, some tens of evaluations."""


@dataclass(frozen=True)
class FilmBalance:
    """Constants of growth and wear.

    wear_coefficient : alpha [1/s]; 0 for none. lag : of the wear [s]; 0 for none.
    concentration_constant : C1 [1/m]; infinite for no substrate in the film. initial_thickness : at the start [m].
    """

    wear_coefficient: float
    lag: float = 0.0
    concentration_constant: float = math.inf
    initial_thickness: float = 0.0

    def concentration(self, thickness: FloatArray) -> FloatArray:
        """Return the fraction of substrate in the worn film, exp(-C1 h) (thesis, paper E, eq. 7); zero without C1."""
        if not math.isfinite(self.concentration_constant):
            return np.zeros_like(thickness)
        return np.asarray(np.exp(-self.concentration_constant * thickness))

    def thickest(self, fastest_growth: float, duration: float) -> float:
        """Return an upper bound of the thickness [m] after a time [s] of growth at most `fastest_growth` [m/s].

        It is the initial thickness plus all growth; without a lag at most the thickness at which wear balances growth.
        """
        grown = self.initial_thickness + fastest_growth * duration
        if self.wear_coefficient > 0 and not self.lag > 0:
            return min(grown, max(self.initial_thickness, fastest_growth / self.wear_coefficient))
        return grown


def checked_times(times: FloatArray, balance: FilmBalance, tolerance: float) -> FloatArray:
    """Return the times (nt,) [s] of a film under a balance, checked.

    Raises
    ------
    InputError : times that do not increase, negative constants, a lag that fits too often into the time, a tolerance
        beyond 0 and 1.
    """
    when = np.asarray(times, dtype=np.float64)
    messages = []
    if when.ndim != 1 or when.size < 2 or not (np.diff(when) > 0).all():
        messages.append("times: at least two increasing values [s]")
    for key in ("wear_coefficient", "lag", "initial_thickness"):
        value = getattr(balance, key)
        if not (math.isfinite(value) and value >= 0):
            messages.append(f"{key} {value!r} must be >= 0 and finite")
    lag, constant = balance.lag, balance.concentration_constant
    if not messages and 0 < lag * MOST_LAGS < when[-1] - when[0]:
        messages.append(f"lag {lag!r} must be 0 or at least {1 / MOST_LAGS:g} of the time, {when[-1] - when[0]:g} s")
    if not constant > 0:
        messages.append(f"concentration_constant {constant!r} must be positive [1/m]")
    if not 0 < tolerance < 1:
        messages.append(f"tolerance {tolerance!r} must lie between 0 and 1")
    if messages:
        raise InputError(messages)
    return when
