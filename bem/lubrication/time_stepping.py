"""Steps in time of any film: BDF2 weights, steps that are halved where they do not converge, what is asked for."""

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

Film = TypeVar("Film")
Speeds = Sequence[float] | Sequence[Sequence[float]]


class Solved(Protocol):
    """What is said of a film at a time."""

    @property
    def status(self) -> Status:
        """Return True if it was found."""

    @property
    def iterations(self) -> int:
        """Newton steps."""


Solution = TypeVar("Solution", bound=Solved)


@dataclass(frozen=True)
class Reached(Generic[Film]):
    """A time [s] and the film there; the time and film a step earlier, None at the start."""

    time: float
    film: Film
    earlier: tuple[float, Film] | None = None


@dataclass(frozen=True)
class Derivative:
    """The derivative at the end of a step, leading * value + history(values before)."""

    leading: float
    step: float
    now: float
    before: float

    @staticmethod
    def at(reached: Reached[Any], time: float, clock: float) -> Derivative:
        """To a time, with the unit of time [s]: of second order (BDF2) but for the first step."""
        step = (time - reached.time) / clock
        if reached.earlier is None:
            return Derivative(1 / step, step, -1.0, 0.0)
        ratio = (time - reached.time) / (reached.time - reached.earlier[0])
        return Derivative((1 + 2 * ratio) / (1 + ratio) / step, step, -(1 + ratio), ratio**2 / (1 + ratio))

    def history(self, reached: Reached[Film], value: Callable[[Film], Any]) -> Any:
        """What the film reached and the one before it add."""
        if reached.earlier is None:
            return self.now * value(reached.film) / self.step
        return (self.now * value(reached.film) + self.before * value(reached.earlier[1])) / self.step


Step = Callable[[Reached[Film], float], tuple[Film, Solution]]


def advance(
    step: Step[Film, Solution], at: Reached[Film], time: float, depth: int = 0
) -> tuple[Reached[Film], Solution]:
    """One step to a time, or as many halves as it takes; where that is not enough, the solution is not converged."""
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
    """All that the next step needs: where the march is, the films so far, and the steady film that it set out from
    where it looked for one."""

    steady: Solution | None
    reached: Reached[Film]
    solutions: tuple[Solution, ...]


def march(
    times: FloatArray,
    state: MarchState[Film, Solution],
    to: Callable[[Reached[Film], float], tuple[Reached[Film], Solution]],
    tell: Callable[[MarchState[Film, Solution]], None],
) -> list[Solution]:
    """From a state to the last of all times, or to the first that is not converged; told of every step."""
    for time in times[len(state.solutions) :]:
        if state.solutions[-1].status is not Status.CONVERGED:
            break
        reached, solution = to(state.reached, float(time))
        state = MarchState(state.steady, reached, (*state.solutions, solution))
        tell(state)
    return list(state.solutions)


@dataclass(frozen=True)
class Schedule:
    """The times asked for (n,) [s], with the loads and the speeds of both surfaces [m/s] at them."""

    times: FloatArray
    loads: list[float]
    speeds: list[Any]


def schedule_of(times: FloatArray, load: Callable[[float], float], speeds: Callable[[float], Any]) -> Schedule:
    """What acts at each of the times; refuses times that do not ascend and what is no function."""
    steps = np.asarray(times, dtype=np.float64)
    if steps.ndim != 1 or len(steps) < 2 or not np.isfinite(steps).all() or not (np.diff(steps) > 0).all():
        raise InputError("times: must be at least two finite, ascending times [s]")
    if not (callable(load) and callable(speeds)):
        raise InputError("load, speeds: must be functions of time; for constants write lambda t: value")
    return Schedule(steps, [load(float(t)) for t in steps], [speeds(float(t)) for t in steps])


def load_messages(schedule: Schedule, unit: str) -> list[str]:
    """What is wrong with loads."""
    return first_of(
        [
            f"load: {w!r} at time {t:g} s must be positive and finite [{unit}]"
            for t, w in zip(schedule.times, schedule.loads, strict=True)
            if not is_positive(w)
        ]
    )


def first_of(messages: Sequence[str]) -> list[str]:
    """One message for one mistake that is there at several times: that of the first."""
    more = f" (and at {len(messages) - 1} more of the times)" if len(messages) > 1 else ""
    return [one + more for one in messages[:1]]


def start_messages(initial: object, initial_thickness: float | None) -> list[str]:
    """What is wrong with the film to start from."""
    messages = []
    if initial is not None and initial_thickness is not None:
        messages.append("initial, initial_thickness: give one of them")
    if initial_thickness is not None and not (math.isfinite(initial_thickness) and initial_thickness > 0):
        messages.append(f"initial_thickness: {initial_thickness!r} must be positive and finite [m]")
    return messages
