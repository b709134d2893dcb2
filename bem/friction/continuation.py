"""Warm start of a balance from the solution at another speed, and of the next speed from a balance.

The log odds of the film load, ln(film load / contact load), change about in proportion to the logarithm of the speed.
The factor (`speed_power`) is that of the last two speeds. A solution in full film or on another grid predicts no film
load: the balance then starts from half of the load. Starts affect cost and rounding only where a case has one balance,
as it has while the volume mismatch decreases with the film load. Verified in tests/friction/test_continuation.py.
"""

from __future__ import annotations

import dataclasses
import math

from bem.friction.balance import Balance, BalanceStart, Continuation, Regime
from bem.friction.film import PatchFilm
from bem.friction.setup import MixedSetup
from bem.friction.solution import MixedSolution
from bem.lubrication import FilmSolution
from bem.lubrication.line.state import without_factors

LARGEST_START = 0.999
"""Largest fraction of the load with which a first film is solved."""
LEAST_DISTANCE, LARGEST_POWER = 0.05, 2.5
"""Smallest difference of two logarithms of speeds from which the power is computed, and the largest power. Next to full
film the odds tend to infinity, and so does the power."""


def start_from_solution(setup: MixedSetup, speeds: tuple[float, float], initial: MixedSolution | None) -> BalanceStart:
    """Return the warm start of a balance from a solution at another speed or of other heights."""
    if initial is None:
        return BalanceStart()
    whole = initial.continuation.whole_film
    if initial.grid != setup.grid or initial.contact is None:
        return BalanceStart(whole_film=whole)
    before = min(initial.film_load / initial.load, LARGEST_START)  # film load over load at the other speed
    odds = before / (1 - before) * _speed_ratio(speeds, initial) ** initial.continuation.speed_power
    share = min(odds / (1 + odds), LARGEST_START)
    pressure = None if setup.repeated_cell else initial.contact_pressure
    start = BalanceStart.from_similar(before, initial.balance_slope, setup.load, share * setup.load, pressure)
    return dataclasses.replace(start, refinement=initial.continuation.refinement, whole_film=whole)


def continuation_from(
    speeds: tuple[float, float], balance: Balance, load: float, whole: PatchFilm, initial: MixedSolution | None
) -> Continuation:
    """Return the parts of the next speed's warm start that a solution does not hold otherwise.

    Parameters
    ----------
    speeds : (u1, u2) of the balance [m/s].
    balance : balance at these speeds.
    load : its load [N].
    whole : coarse film under the whole load at these speeds.
    initial : solution at the speed before.
    """
    power, solution = _speed_power(speeds, balance, load, initial), whole.solution
    if not isinstance(solution, FilmSolution):
        return Continuation(balance.refinement, power)
    return Continuation(balance.refinement, power, dataclasses.replace(whole, solution=without_factors(solution)))


def _speed_ratio(speeds: tuple[float, float], initial: MixedSolution) -> float:
    """Return the entrainment over that of a solution."""
    return abs(sum(speeds)) / abs(sum(initial.speeds))


def _speed_power(speeds: tuple[float, float], balance: Balance, load: float, initial: MixedSolution | None) -> float:
    """Return the power of the speed that the odds of the film load follow, from the last two mixed speeds.

    Where these do not determine it, the power of the solution before. The first guess is 1, because a film of given
    thickness carries a load in proportion to the speed.
    """
    if initial is None:
        return 1.0
    shares = initial.film_load / initial.load, balance.film.load / load
    distance = math.log(_speed_ratio(speeds, initial))
    mixed = balance.regime is Regime.MIXED and initial.regime is Regime.MIXED
    if not mixed or abs(distance) < LEAST_DISTANCE or max(shares) >= LARGEST_START:
        return initial.continuation.speed_power
    change = math.log(shares[1] / (1 - shares[1])) - math.log(shares[0] / (1 - shares[0]))
    return min(max(change / distance, 0.0), LARGEST_POWER)
