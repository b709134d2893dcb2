"""What the load sharing at one speed leaves to the next: where its balance is looked for, and films to start from.

Starts decide nothing but the effort. Knows solutions of load sharing; no solver. Verified in
tests/friction/test_continuation.py.
"""

from __future__ import annotations

import dataclasses
import math

from bem.friction.balance import Balance, BalanceStart, Regime
from bem.friction.film import PatchFilm
from bem.friction.setup import MixedSetup
from bem.friction.solution import Continuation, MixedSolution
from bem.lubrication import FilmSolution
from bem.lubrication.line_kept import without_equations

MOST_BEGUN = 0.999
"""Share of the load with which a film is looked for first."""
LEAST_APART, HIGHEST_POWER = 0.05, 2.5
"""Logarithms of two speeds that tell how shares of the load go with the speed; and the highest power that is taken:
next to full film there is none."""


def first_trial(setup: MixedSetup, speeds: tuple[float, float], initial: MixedSolution | None) -> BalanceStart:
    """Where the balance is looked for first, by a solution at another speed or of other heights."""
    if initial is None or initial.grid != setup.grid or initial.contact is None:
        return BalanceStart(0.5 * setup.load)
    before = min(initial.film_load / initial.load, MOST_BEGUN)
    odds = before / (1 - before) * _faster(speeds, initial) ** initial.continuation.speed_power
    share = min(odds / (1 + odds), MOST_BEGUN)
    pressure = None if setup.repeated_cell else initial.contact_pressure
    start = BalanceStart.after(before, initial.balance_slope, setup.load, share * setup.load, pressure)
    return dataclasses.replace(start, refinement=initial.continuation.refinement)


def continuation(
    speeds: tuple[float, float], balance: Balance, load: float, whole: PatchFilm, initial: MixedSolution | None
) -> Continuation:
    """What a balance under a load [N], found from a solution, leaves to the next speed."""
    power = _speed_power(speeds, balance, load, initial)
    solution = whole.solution
    if not isinstance(solution, FilmSolution):
        return Continuation(power, balance.refinement)
    return Continuation(power, balance.refinement, dataclasses.replace(whole, solution=without_equations(solution)))


def _faster(speeds: tuple[float, float], initial: MixedSolution) -> float:
    """Entrainment over that of a solution."""
    return abs(sum(speeds)) / abs(sum(initial.speeds))


def _speed_power(speeds: tuple[float, float], balance: Balance, load: float, initial: MixedSolution | None) -> float:
    """Where two speeds do not tell, that of the solution before. At a given thickness a film carries in proportion to
    the speed: one is the first guess."""
    if initial is None:
        return 1.0
    shares = initial.film_load / initial.load, balance.film.load / load
    apart = math.log(_faster(speeds, initial))
    mixed = balance.regime is Regime.MIXED and initial.regime is Regime.MIXED
    if not mixed or abs(apart) < LEAST_APART or max(shares) >= MOST_BEGUN:
        return initial.continuation.speed_power
    change = math.log(shares[1] / (1 - shares[1])) - math.log(shares[0] / (1 - shares[0]))
    return min(max(change / apart, 0.0), HIGHEST_POWER)
