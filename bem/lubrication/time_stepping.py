"""Time stepping of any film: BDF2 with adaptive halving, the loop over the output times, and checks of the schedule.

1. `march` goes from each output time to the next and reports its state, from which it can be resumed.
2. `advance` takes one step; a step that does not converge is split into two halves, recursively.
3. `Derivative` has the coefficients of the backward differentiation formula of second order for unequal steps (first
   order for the first step), L-stable.

Verified in tests/lubrication/test_line_film_transient.py and point/test_point_march.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Generic, Protocol, TypeVar

import numpy as np

from bem.arguments import is_positive
from bem.errors import InputError, Status
from bem.grid import FloatArray

MAX_HALVINGS = 8
"""Largest number of times that a step is halved."""

Film = TypeVar("Film")
Speeds = Sequence[float] | Sequence[Sequence[float]]


class Solved(Protocol):
    """Result of a film at a time."""

    @property
    def status(self) -> Status:
        """Outcome of the step."""

    @property
    def iterations(self) -> int:
        """Newton steps."""


Solution = TypeVar("Solution", bound=Solved)


@dataclass(frozen=True)
class Reached(Generic[Film]):
    """A time [s] and the film there, with the time and film of the step before; None at the start."""

    time: float
    film: Film
    earlier: tuple[float, Film] | None = None


@dataclass(frozen=True)
class Derivative:
    """Time derivative at the end of a step: leading * value + history(earlier values)."""

    leading: float
    step: float
    now: float
    before: float

    @staticmethod
    def at(reached: Reached[Any], time: float, clock: float) -> Derivative:
        """Return the coefficients for a step to a time, in units of `clock` [s]."""
        step = (time - reached.time) / clock
        if reached.earlier is None:
            return Derivative(1 / step, step, -1.0, 0.0)
        ratio = (time - reached.time) / (reached.time - reached.earlier[0])
        return Derivative((1 + 2 * ratio) / (1 + ratio) / step, step, -(1 + ratio), ratio**2 / (1 + ratio))

    def history(self, reached: Reached[Film], value: Callable[[Film], Any]) -> Any:
        """Return the contribution of the earlier values."""
        if reached.earlier is None:
            return self.now * value(reached.film) / self.step
        return (self.now * value(reached.film) + self.before * value(reached.earlier[1])) / self.step


Step = Callable[[Reached[Film], float], tuple[Film, Solution]]


def advance(
    step: Step[Film, Solution], at: Reached[Film], time: float, depth: int = 0
) -> tuple[Reached[Film], Solution]:
    """Take one step to a time, or as many halves as it needs; where that is not enough, the solution has another
    status."""
    film, solution = step(at, time)
    if solution.status is Status.CONVERGED or depth == MAX_HALVINGS:
        return Reached(time, film, (at.time, at.film)), solution
    middle, halfway = advance(step, at, 0.5 * (at.time + time), depth + 1)
    if halfway.status is not Status.CONVERGED:
        return middle, halfway
    reached, solution = advance(step, middle, time, depth + 1)
    both = solution.iterations + halfway.iterations
    return reached, replace(solution, iterations=both)  # type: ignore[type-var]


@dataclass(frozen=True, eq=False)
class MarchState(Generic[Film, Solution]):
    """State from which a march goes on.

    steady : steady film that the march began with; None where the first film was given.
    reached : time and film so far. solutions : results at the output times so far.
    """

    steady: Solution | None
    reached: Reached[Film]
    solutions: tuple[Solution, ...]


def march(
    times: FloatArray,
    state: MarchState[Film, Solution],
    to: Callable[[Reached[Film], float], tuple[Reached[Film], Solution]],
    tell: Callable[[MarchState[Film, Solution]], None],
) -> list[Solution]:
    """March from a state to the last output time, or to the first result that did not converge; `tell` gets every
    state."""
    for time in times[len(state.solutions) :]:
        if state.solutions[-1].status is not Status.CONVERGED:
            break
        reached, solution = to(state.reached, float(time))
        state = MarchState(state.steady, reached, (*state.solutions, solution))
        tell(state)
    return list(state.solutions)


@dataclass(frozen=True)
class Schedule:
    """Output times (n,) [s], with the loads and the speeds of both surfaces [m/s] at them."""

    times: FloatArray
    loads: list[float]
    speeds: list[Any]


def schedule_of(times: FloatArray, load: Callable[[float], float], speeds: Callable[[float], Any]) -> Schedule:
    """Return loads and speeds at the output times.

    Raises
    ------
    InputError : times that do not ascend, or a load or speeds that are no functions.
    """
    steps = np.asarray(times, dtype=np.float64)
    if steps.ndim != 1 or len(steps) < 2 or not np.isfinite(steps).all() or not (np.diff(steps) > 0).all():
        raise InputError("times: must be at least two finite, ascending times [s]")
    if not (callable(load) and callable(speeds)):
        raise InputError("load, speeds: must be functions of time; for constants write lambda t: value")
    return Schedule(steps, [load(float(t)) for t in steps], [speeds(float(t)) for t in steps])


def load_messages(schedule: Schedule, unit: str) -> list[str]:
    """Return messages about invalid loads."""
    return first_of(
        [
            f"load: {w!r} at time {t:g} s must be positive and finite [{unit}]"
            for t, w in zip(schedule.times, schedule.loads, strict=True)
            if not is_positive(w)
        ]
    )


def first_of(messages: Sequence[str]) -> list[str]:
    """Return the first of several equal mistakes, with the number of the others."""
    more = f" (and at {len(messages) - 1} more of the times)" if len(messages) > 1 else ""
    return [one + more for one in messages[:1]]


def start_messages(initial: object, initial_thickness: float | None) -> list[str]:
    """Return messages about the first film."""
    messages = []
    if initial is not None and initial_thickness is not None:
        messages.append("initial, initial_thickness: give one of them")
    if initial_thickness is not None and not (math.isfinite(initial_thickness) and initial_thickness > 0):
        messages.append(f"initial_thickness: {initial_thickness!r} must be positive and finite [m]")
    return messages
