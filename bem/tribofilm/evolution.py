"""Thickness of a tribofilm over time: growth, wear with an optional delay, and the substrate that leaves with it.

    dh/dt   = g(h) - alpha h(t - lag)           (thesis, paper E, eq. 5 and 6)
    dh_w/dt = exp(-C1 h) alpha h(t - lag)       (eq. 7 and 8)

The unknowns are the film grown so far and the film worn so far, so that thickness = initial + grown - worn holds to the
last bit. The right-hand side is stiff where growth falls steeply with thickness: Radau IIA (order 5, L-stable) with
error control. A delay is integrated by the method of steps: over one lag the past is a known, dense function, and the
kinks it carries lie at the ends of the steps.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from bem.errors import BemError, ConvergenceError, InputError
from bem.grid import FloatArray
from bem.representation import readable

GrowthRate = Callable[[float], float]
"""mean thickness [m] -> growth rate [m/s]"""

_ATOM = 2e-10
"""Height of an atom [m]: thinner films need no relative accuracy."""

MOST_LAGS = 5000
"""Lags within the time: each is integrated by itself, some tens of evaluations."""

_MOST_EVALUATIONS = 200_000
"""Of the rates. An ordinary film takes some hundreds, each of its lags some tens."""

_SHORT = 1e-3
"""Wear may take what is there within this part of the lag, never more: it keeps a delayed film from going negative."""


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
    times : increasing, the first is the start [s] (cycles if rates are per cycle). growth_rate : g(h) >= 0 [m/s].
    wear_coefficient : alpha [1/s]; 0 for none. lag : [s]; 0 for none; before the start there is no film to wear.
    concentration_constant : C1 [1/m]; infinite for no substrate wear.
    initial_thickness : at the start [m].
    tolerance : relative, on each of grown, worn and substrate wear; where these are thinner than an atom, relative to
        its height.

    Raises
    ------
    InputError : times that do not increase, negative constants, a lag that fits too often into the time.
    ConvergenceError : the integrator gave up, or took more evaluations than any film should.
    """
    when = np.asarray(times, dtype=np.float64)
    messages = []
    if when.ndim != 1 or when.size < 2 or not (np.diff(when) > 0).all():
        messages.append("times: at least two increasing values [s]")
    for key, value in (("wear_coefficient", wear_coefficient), ("lag", lag), ("initial_thickness", initial_thickness)):
        if not (math.isfinite(value) and value >= 0):
            messages.append(f"{key} {value!r} must be >= 0 and finite")
    if not messages and 0 < lag * MOST_LAGS < when[-1] - when[0]:
        messages.append(f"lag {lag!r} must be 0 or at least {1 / MOST_LAGS:g} of the time, {when[-1] - when[0]:g} s")
    if not concentration_constant > 0:
        messages.append(f"concentration_constant {concentration_constant!r} must be positive [1/m]")
    if not 0 < tolerance < 1:
        messages.append(f"tolerance {tolerance!r} must lie between 0 and 1")
    if messages:
        raise InputError(messages)

    history = _Past(when[0], initial_thickness)
    span = when[-1] - when[0]
    step = lag if lag > 0 else span
    state = np.array([0.0, 0.0, 0.0])
    evaluations = 0

    def rates(t: float, y: FloatArray) -> FloatArray:
        nonlocal evaluations
        evaluations += 1
        if evaluations > _MOST_EVALUATIONS:
            raise ConvergenceError(
                f"tribofilm: the time integration came to {t:.6g} s in {_MOST_EVALUATIONS} evaluations: at a wear "
                f"of {wear_coefficient:g} 1/s after a lag of {lag:g} s the film comes and goes; lower either"
            )
        # what rounding takes below zero comes back: cut off there, wear had no slope and Newton's steps diverged
        balance = initial_thickness + float(y[0]) - float(y[1])
        thickness = max(balance, 0.0)
        growth = growth_rate(thickness)
        if lag > 0:
            wear = wear_coefficient * history(t - lag)
            wear = min(wear, growth + thickness / (_SHORT * lag))
        else:
            wear = wear_coefficient * balance
        share = math.exp(-concentration_constant * thickness) if math.isfinite(concentration_constant) else 0.0
        return np.array([growth, wear, share * wear])

    accuracy: dict[str, Any] = {"rtol": tolerance, "atol": _ATOM * tolerance}
    begin = when[0]
    while begin < when[-1]:
        end = min(begin + step, when[-1])
        if when[-1] - end < 1e-9 * span:
            end = when[-1]
        # a step that overflows or divides by zero within Radau is repeated with a shorter one
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            try:
                solution = solve_ivp(rates, (begin, end), state, method="Radau", dense_output=True, **accuracy)
            except BemError:
                raise
            except ValueError as error:  # a step without finite numbers in it
                raise ConvergenceError(f"tribofilm: the time integration broke off after {begin:.6g} s") from error
        if not solution.success:
            raise ConvergenceError(
                f"tribofilm: the time integration stopped at {solution.t[-1]:.6g} s: {solution.message}"
            )
        history.append(end, solution.sol)
        state = solution.y[:, -1]
        begin = end

    grown, worn, substrate = np.array([history.state(t) for t in when]).T
    thickness = np.maximum(initial_thickness + grown - worn, 0.0)
    at = np.array([rates(t, np.array([g, w, s])) for t, g, w, s in zip(when, grown, worn, substrate, strict=True)])
    finite = math.isfinite(concentration_constant)
    return FilmHistory(
        time=when,
        thickness=thickness,
        grown=grown,
        worn=worn,
        substrate_wear=substrate,
        growth_rate=at[:, 0],
        wear_rate=np.maximum(at[:, 1], 0.0),
        concentration=np.exp(-concentration_constant * thickness) if finite else np.zeros_like(thickness),
        evaluations=evaluations - len(when),
    )


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
        """Thickness at a past time; nothing before the start."""
        if t < self.start:
            return 0.0
        grown, worn, _ = self.state(t)
        return max(self.initial + grown - worn, 0.0)


def steady_thickness(growth_rate: GrowthRate, wear_coefficient: float, *, longest: float = 1e-3) -> float:
    """Thickness at which growth and wear balance [m]; infinite where growth still wins at `longest`.

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
