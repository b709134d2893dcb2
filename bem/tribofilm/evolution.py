"""Thickness of a tribofilm over time: growth, wear with an optional delay, and the substrate that leaves with it.

    dh/dt   = g(h) - alpha h(t - lag)           (thesis, paper E, eq. 5 and 6)
    dh_w/dt = exp(-C1 h) alpha h(t - lag)       (eq. 7 and 8)

The unknowns are the film grown so far and the film worn so far, so that thickness = initial + grown - worn holds to the
last bit. The right-hand side is stiff where growth falls steeply with thickness: Radau IIA (order 5, L-stable) with
error control. A delay is integrated by the method of steps: over one lag the past is a known, dense function, and the
kinks it carries lie at the ends of the steps.

Knows the balance and a growth rate of the thickness; no contact. Verified in tests/tribofilm/test_film_evolution.py
(closed forms, delays) and test_tribofilm_stiff.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from bem.errors import BemError, ConvergenceError
from bem.grid import FloatArray
from bem.physical_constants import ATOM
from bem.representation import readable
from bem.tribofilm.balance import FilmBalance, checked_times

GrowthRate = Callable[[float], float]
"""mean thickness [m] -> growth rate [m/s]"""


_MOST_EVALUATIONS = 200_000
"""Largest number of evaluations of the rates. An ordinary film takes some hundreds, each of its lags some tens."""

_SHORT = 1e-3
"""Delayed wear is limited to the removal of the whole film within this fraction of the lag, so that no film is
negative."""


@readable
@dataclass(frozen=True, eq=False)
class FilmHistory:
    """Film over time; all arrays have the shape of `time`.

    time [s]; thickness, grown, worn, substrate_wear [m]; growth_rate, wear_rate [m/s]; concentration of substrate [-].
    """

    time: FloatArray
    thickness: FloatArray
    grown: FloatArray
    worn: FloatArray
    substrate_wear: FloatArray
    growth_rate: FloatArray
    wear_rate: FloatArray
    concentration: FloatArray
    evaluations: int

    def wear_depth(self, start: float, end: float) -> float:
        """Return the depth of substrate worn between two times [s] of the history [m]."""
        before, after = np.interp((start, end), self.time, self.substrate_wear)
        return float(after) - float(before)


def evolve_film(
    times: FloatArray,
    growth_rate: GrowthRate,
    *,
    wear_coefficient: float,
    lag: float = 0.0,
    concentration_constant: float = math.inf,
    initial_thickness: float = 0.0,
    tolerance: float = 1e-6,
) -> FilmHistory:
    """Integrate the balance of growth and wear.

    Parameters
    ----------
    times : increasing, the first is the start [s] (cycles if rates are per cycle).
    growth_rate : g(h) >= 0 [m/s].
    wear_coefficient : alpha [1/s]; 0 for none.
    lag : [s]; 0 for none; before the start there is no film to wear.
    concentration_constant : C1 [1/m]; infinite for no substrate wear.
    initial_thickness : at the start [m].
    tolerance : relative, on each of grown, worn and substrate wear; where these are thinner than an atom, relative to
        its height.

    Raises
    ------
    InputError : times that do not increase, negative constants, a lag that fits too often into the time.
    ConvergenceError : the integrator gave up, or took more evaluations than any film should.
    """
    balance = FilmBalance(wear_coefficient, lag, concentration_constant, initial_thickness)
    when = checked_times(times, balance, tolerance)
    past = _Past(when[0], initial_thickness)
    rates = _Rates(balance, growth_rate, past)
    _integrate(rates, when, tolerance)
    states = [past.state(t) for t in when]
    at = np.array([rates(t, state) for t, state in zip(when, states, strict=True)])
    grown, worn, substrate = np.array(states).T
    thickness = np.maximum(initial_thickness + grown - worn, 0.0)
    return FilmHistory(
        time=when,
        thickness=thickness,
        grown=grown,
        worn=worn,
        substrate_wear=substrate,
        growth_rate=at[:, 0],
        wear_rate=np.maximum(at[:, 1], 0.0),
        concentration=balance.concentration(thickness),
        evaluations=rates.evaluations - len(when),
    )


class _Rates:
    """Rates of grown, worn and substrate wear [m/s] at a time and these three [m], counted."""

    def __init__(self, balance: FilmBalance, growth_rate: GrowthRate, past: _Past) -> None:
        self.balance = balance
        self.growth_rate = growth_rate
        self.past = past
        self.evaluations = 0

    def __call__(self, t: float, y: FloatArray) -> FloatArray:
        balance = self.balance
        self.evaluations += 1
        if self.evaluations > _MOST_EVALUATIONS:
            raise ConvergenceError(
                f"tribofilm: the time integration came to {t:.6g} s in {_MOST_EVALUATIONS} evaluations: at a wear of "
                f"{balance.wear_coefficient:g} 1/s after a lag of {balance.lag:g} s the film comes and goes; lower "
                "either"
            )
        # not cut off at zero: wear without a slope there would let Newton's steps diverge
        difference = balance.initial_thickness + float(y[0]) - float(y[1])
        thickness = max(difference, 0.0)
        growth = self.growth_rate(thickness)
        if balance.lag > 0:
            wear = balance.wear_coefficient * self.past(t - balance.lag)
            wear = min(wear, growth + thickness / (_SHORT * balance.lag))
        else:
            wear = balance.wear_coefficient * difference
        constant = balance.concentration_constant
        concentration = math.exp(-constant * thickness) if math.isfinite(constant) else 0.0
        return np.array([growth, wear, concentration * wear])


def _integrate(rates: _Rates, when: FloatArray, tolerance: float) -> None:
    """Integrate from the first time to the last, one lag at a time, appending the solution to the rates' past."""
    begin, last = when[0], when[-1]
    span = last - begin
    step = rates.balance.lag if rates.balance.lag > 0 else span
    state = np.zeros(3)
    while begin < last:
        end = min(begin + step, last)
        if last - end < 1e-9 * span:
            end = last
        solution = _solve_step(rates, (begin, end), state, tolerance)
        rates.past.append(end, solution.sol)
        state = solution.y[:, -1]
        begin = end


def _solve_step(rates: _Rates, between: tuple[float, float], state: FloatArray, tolerance: float) -> Any:
    # films thinner than an atom need no relative accuracy
    accuracy: dict[str, Any] = {"rtol": tolerance, "atol": ATOM * tolerance}
    # a step that overflows or divides by zero within Radau is repeated with a shorter one
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        try:
            solution = solve_ivp(rates, between, state, method="Radau", dense_output=True, **accuracy)
        except BemError:
            raise
        except ValueError as error:  # a step without finite numbers in it
            raise ConvergenceError(f"tribofilm: the time integration broke off after {between[0]:.6g} s") from error
    if not solution.success:
        raise ConvergenceError(f"tribofilm: the time integration stopped at {solution.t[-1]:.6g} s: {solution.message}")
    return solution


class _Past:
    """Dense solution of the steps so far; before the start there is no film under wear."""

    def __init__(self, start: float, initial_thickness: float) -> None:
        self.start = start
        self.initial = initial_thickness
        self.ends: list[float] = []
        self.pieces: list[Callable[[float], FloatArray]] = []

    def append(self, end: float, piece: Callable[[float], FloatArray]) -> None:
        self.ends.append(end)
        self.pieces.append(piece)

    def state(self, t: float) -> FloatArray:
        if t <= self.start or not self.pieces:
            return np.zeros(3)
        index = min(int(np.searchsorted(self.ends, t)), len(self.pieces) - 1)
        return np.asarray(self.pieces[index](t))

    def __call__(self, t: float) -> float:
        """Return the thickness at a past time; zero before the start."""
        if t < self.start:
            return 0.0
        grown, worn, _ = self.state(t)
        return max(self.initial + grown - worn, 0.0)


def steady_thickness(growth_rate: GrowthRate, wear_coefficient: float, *, longest: float = 1e-3) -> float:
    """Return the thickness at which growth and wear balance [m]; infinite if growth exceeds wear at `longest`.

    g(h) - alpha h falls with h wherever growth does not increase with thickness, so bisection finds the one root.
    """
    if wear_coefficient <= 0 or growth_rate(longest) > wear_coefficient * longest:
        return math.inf
    low, high = 0.0, longest
    for _ in range(200):
        middle = 0.5 * (low + high)
        if growth_rate(middle) > wear_coefficient * middle:
            low = middle
        else:
            high = middle
        if high - low <= 1e-15 * high:
            break
    return 0.5 * (low + high)
