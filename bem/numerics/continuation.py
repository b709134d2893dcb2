"""Continuation in a positive parameter: follow a solution by factors that shrink where the solver fails.

Each solution is the start of the next. The factor of the parameter grows after an easy success; after a failure its
logarithm is halved, and the last solution is the start again.

Verified in tests/numerics/test_parameter_continuation.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Generic, Protocol, TypeVar

GROWTH = 1.5
"""Growth of the factor after an easy success."""


class Attempt(Protocol):
    """Result of a solver at one value of the parameter."""

    @property
    def converged(self) -> bool:
        """True if the solver converged."""

    @property
    def iterations(self) -> int:
        """Iterations of the solver."""


Solution = TypeVar("Solution", bound=Attempt)


@dataclass(frozen=True)
class FactorRule:
    """Factors of the parameter.

    first : first factor. smallest : factor at which the continuation gives up. largest : bound of the factor.
    easy : a success in fewer iterations lengthens the next step.
    """

    first: float
    smallest: float
    largest: float = math.inf
    easy: float = math.inf


@dataclass(frozen=True)
class Continued(Generic[Solution]):
    """Last converged solution, the parameter that it belongs to, and the iterations of all attempts."""

    last: Solution
    value: float
    iterations: int


def continue_by_factors(
    solve: Callable[[Solution, float, float], Solution], first: Solution, value: float, end: float, rule: FactorRule
) -> Continued[Solution]:
    """Follow a solution from one value of a parameter up to another.

    Parameters
    ----------
    solve : returns the attempt at a new value, from a solution and its value: solve(solution, value, new value).
    first : solution at the first value; if it did not converge, the continuation ends with it.
    value, end : first and last value of the parameter, positive, value <= end.
    rule : factors.
    """
    last, factor, spent = first, rule.first, first.iterations
    while last.converged and value < end and factor > rule.smallest:
        following = min(end, value * factor)
        trial = solve(last, value, following)
        spent += trial.iterations
        if not trial.converged:
            factor = math.sqrt(factor)
            continue
        last, value = trial, following
        if trial.iterations < rule.easy:
            factor = min(factor * GROWTH, rule.largest)
    return Continued(last, value, spent)
