"""Starved films of a line contact: the inlet drawn in until the meniscus, or the oil that goes through, is as wanted.

Where the gap begins to be full the pressure is that of the surroundings. Oil that came in a layer fills it there, with
a step in the pressure's gradient (Jakobsson and Floberg, Olsson), and what comes in goes out: the layer is as thick as
the film at the exit. So a meniscus at any place is a film, and supplies are found among those by a secant: coarse ones
by continuation from the flooded film, then on the wanted mesh.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from bem.lubrication.line.continuation import COARSE_TOLERANCE, MIDDLE, from_neighbour, refined, smallest_cell
from bem.lubrication.line.deflection import LineOperator
from bem.lubrication.line.newton import Outcome, State, newton, remesh, stretched
from bem.lubrication.line.reynolds import Problem

FIRST_STEP = 1.0
"""In the logarithm of how far the meniscus is beyond Hertz' contact, on the way in."""
LEAST_STEP = 0.02
MOST = 80
"""Coarse films on the way."""
SECANTS = 16
LONGEST = 0.3
"""Step of these, in that logarithm."""
CALM = 1.2
"""Widths of Hertz' contact before the exit from which a mesh may be stretched for itself."""
NEAR = 0.01
"""What coarse films are to miss the supply by at most."""
NEARLY_FLOODED = 0.95
"""Of the flooded flow, from which the flooded film's own mesh is kept: other meshes differ by more than what lacks."""
LEAST_BRACKET = 0.5
"""Of the flooded flow, below which its mesh says nothing any more."""
_LEAST = 1e-9


def through(problem: Problem, state: State) -> float:
    """Oil that goes through, in Moes' units of the film."""
    return float(problem.dragged(state.film[-1:])[0][0])


class Wanted(Protocol):
    """A supply that films are measured by, over the flooded film on a mesh like their own."""

    def missed(self, state: State, flooded: State) -> float:
        """By how much a film has too much inlet."""

    def error(self, state: State, flooded: State) -> float:
        """How far it is from what is wanted, relative to that."""


@dataclass(frozen=True)
class WantedLayer:
    """A share of the flooded flow that is to go through, missed in ln(it / what lacks), which knows both ends."""

    problem: Problem
    share: float

    def missed(self, state: State, flooded: State) -> float:
        """As `Wanted`."""
        return _odds(self._share(state, flooded)) - _odds(self.share)

    def error(self, state: State, flooded: State) -> float:
        """As `Wanted`."""
        return abs(self._share(state, flooded) / self.share - 1)

    def _share(self, state: State, flooded: State) -> float:
        return through(self.problem, state) / through(self.problem, flooded)


@dataclass(frozen=True)
class WantedDistance:
    """A meniscus at a distance, in Moes' units, missed in logarithms."""

    distance: float

    def missed(self, state: State, flooded: State) -> float:
        """As `Wanted`."""
        return math.log(max(-state.position[0], 1e-300) / self.distance)

    def error(self, state: State, flooded: State) -> float:
        """As `Wanted`."""
        return abs(self.missed(state, flooded))


def _odds(share: float) -> float:
    return math.log(share / max(1 - share, _LEAST))


@dataclass(frozen=True)
class Neighbour:
    """A starved film of another case, at a load M, its unit of pressure over the problem's."""

    state: State
    load: float
    unit: float


def starved(
    problem: Problem,
    flooded: Outcome,
    wanted: Wanted,
    cells: int,
    tolerance: float,
    limit: int,
    near: Neighbour | None = None,
) -> Outcome:
    """From the flooded film of a problem, or from one nearby, to the one that misses nothing; the flooded one where oil
    beyond its mesh would be wanted, of which it hardly knows."""
    if not flooded.converged:
        return flooded
    far = newton(problem, replace(flooded.state, far_field=0.0), tolerance, limit)
    spent = flooded.iterations + far.iterations
    if far.converged and wanted.missed(far.state, flooded.state) <= 0:
        return replace(flooded, iterations=spent)
    search = _Search(problem, flooded.state, wanted, min(cells, MIDDLE), limit)
    if near is not None:
        start = from_neighbour(problem, near.state, near.load, near.unit, cells, tolerance, limit)
        if start.converged and search.share(start.state) < NEARLY_FLOODED:
            start = search.met(start, 1.0, tolerance)
            if start.converged:
                return replace(start, iterations=spent + start.iterations)
        spent += start.iterations
    own = search.on_own_mesh(tolerance)
    if own is not None:
        return search.judged(replace(own, iterations=spent + search.spent), tolerance)
    found, last, slope = search.coarse()
    if not found:
        return replace(last, iterations=spent + search.spent, converged=False)
    fine = refined(problem, last.state, search.cells, cells, tolerance, limit)
    return search.met(replace(fine, iterations=spent + search.spent + fine.iterations), slope, tolerance)


@dataclass
class _Search:
    """For a film that misses nothing; `cells` of the coarse ones, `spent` Newton steps."""

    problem: Problem
    flooded: State
    wanted: Wanted
    cells: int
    limit: int
    spent: int = 0

    def __post_init__(self) -> None:
        self.hertz = 2 * math.sqrt(8 * self.problem.load / math.pi)
        self.reference = self.flooded

    def on_own_mesh(self, tolerance: float) -> Outcome | None:
        """The film on the nodes of the flooded one without the first of them, whose next one is where the meniscus is;
        None where so much lacks that another mesh does."""
        places = np.log(np.maximum(-self.flooded.offset - self.hertz, 1e-300))
        first, last = 0, 0
        while True:
            last = max(int(np.searchsorted(-places, FIRST_STEP - places[last])), last + 1)
            trial = self._shortened(-self.flooded.offset[last], tolerance)
            if not trial.converged or self.share(trial.state) < LEAST_BRACKET:
                return None
            if self.wanted.missed(trial.state, self.flooded) <= 0:
                break
            if self.share(trial.state) < NEARLY_FLOODED:
                return None
            first = last
        while last - first > 1:
            middle = (first + last) // 2
            trial = self._shortened(-self.flooded.offset[middle], tolerance)
            if not trial.converged:
                return None
            first, last = (first, middle) if self.wanted.missed(trial.state, self.flooded) <= 0 else (middle, last)
        return self._between(first, last, tolerance)

    def _between(self, first: int, last: int, tolerance: float) -> Outcome | None:
        """The film with its meniscus between two nodes next to one another, or a little before them."""
        lengths = -self.flooded.offset[[first, last]]
        low, high = lengths[1], lengths[0]
        for _ in range(SECANTS):
            trial = self._shortened(high, tolerance, last + 1)
            if not trial.converged:
                return None
            if self.wanted.missed(trial.state, self.flooded) > 0:
                break
            low, high = high, high + (lengths[0] - lengths[1])
        values = [
            self.wanted.missed(self._shortened(at, tolerance, last + 1).state, self.flooded) for at in (low, high)
        ]
        side = 0
        for _ in range(4 * SECANTS):  # regula falsi, the value that stays halved
            at = low + (high - low) * values[0] / (values[0] - values[1])
            trial = self._shortened(at, tolerance, last + 1)
            miss = self.wanted.missed(trial.state, self.flooded)
            if not trial.converged or self.wanted.error(trial.state, self.flooded) <= tolerance:
                break
            if miss > 0:
                high, values = at, [values[0] / 2 if side > 0 else values[0], miss]
            else:
                low, values = at, [miss, values[1] / 2 if side < 0 else values[1]]
            side = 1 if miss > 0 else -1
        return trial

    def share(self, state: State) -> float:
        """Of the flooded flow."""
        return through(self.problem, state) / through(self.problem, self.flooded)

    def _shortened(self, length: float, tolerance: float, rest: int | None = None) -> Outcome:
        """The film with its meniscus a length before the exit, on the flooded one's nodes from `rest` on (the next)."""
        flooded = self.flooded
        rest = int(np.searchsorted(flooded.offset, -length * (1 - 1e-12), side="right")) if rest is None else rest
        nodes = np.append(-length, flooded.offset[rest:])
        film = np.interp(nodes, flooded.offset, flooded.film)
        pressure = np.append(0.0, flooded.pressure[rest:])
        start = replace(flooded, offset=nodes, pressure=pressure, film=film, far_field=0.0)
        trial = newton(self.problem, replace(start, operator=LineOperator.of(nodes)), tolerance, self.limit)
        self.spent += trial.iterations
        return trial

    def _take_reference(self) -> None:
        """The flooded film on a coarse mesh."""
        if len(self.flooded.offset) != self.cells + 1:
            coarse = remesh(self.problem, self.flooded, self.cells, smallest_cell(self.problem.load))
            outcome = newton(self.problem, coarse, COARSE_TOLERANCE, self.limit)
            self.spent += outcome.iterations
            self.reference = outcome.state if outcome.converged else self.flooded

    def place(self, state: State) -> float:
        """Logarithm of how far the meniscus is beyond Hertz' contact."""
        return math.log(-state.offset[0] - self.hertz)

    def coarse(self) -> tuple[bool, Outcome, float]:
        """Return True if there is one, the last film, and the slope of what is missed with its place."""
        self._take_reference()
        last = Outcome(replace(self.reference, far_field=0.0), 0, 0.0, True)
        place, step, slope = self.place(last.state), FIRST_STEP, 1.0
        above: tuple[float, float] | None = None
        below: tuple[float, float] | None = None
        for _ in range(MOST):
            shorter = _cut(self.problem, last.state, self.hertz + math.exp(place - step), self.cells)
            trial = newton(self.problem, shorter, COARSE_TOLERANCE, self.limit)
            self.spent += trial.iterations
            if not trial.converged:
                step /= 2
                if abs(step) < LEAST_STEP:
                    return False, trial, slope
                continue
            last, place, miss = trial, place - step, self.wanted.missed(trial.state, self.reference)
            if abs(miss) <= NEAR:
                return True, last, slope
            above, below = ((place, miss), below) if miss > 0 else (above, (place, miss))
            if below is None:
                step = min(1.5 * step, FIRST_STEP)
                continue
            if above is None:  # the first step was too long, and what coarse meshes miss beyond is not known
                return True, last, slope
            slope = (above[1] - below[1]) / (above[0] - below[0])
            step = place - min(max(place - miss / slope, below[0]), above[0])
            if abs(step) < 1e-6:
                return True, last, slope
        return False, last, slope

    def met(self, fine: Outcome, slope: float, tolerance: float) -> Outcome:
        """The supply met on the wanted mesh, which is stretched a little: secant."""
        before: tuple[float, float] | None = None
        for _ in range(SECANTS):
            if not fine.converged:
                break
            miss, place = self.wanted.missed(fine.state, self.flooded), self.place(fine.state)
            if self.wanted.error(fine.state, self.flooded) <= tolerance:
                break
            if before is not None and (miss - before[1]) * (place - before[0]) > 0:
                slope = (miss - before[1]) / (place - before[0])
            before, change = (place, miss), min(max(-miss / slope, -LONGEST), LONGEST)
            fine = self._moved(fine, place + change, tolerance)
        return self.judged(fine, tolerance)

    def judged(self, fine: Outcome, tolerance: float) -> Outcome:
        """Converged only where it misses nothing, too."""
        miss = self.wanted.error(fine.state, self.flooded)
        return replace(fine, residual=max(fine.residual, miss), converged=fine.converged and miss <= tolerance)

    def _moved(self, fine: Outcome, place: float, tolerance: float) -> Outcome:
        """The film with its meniscus elsewhere."""
        length, before = self.hertz + math.exp(place), -fine.state.offset[0]
        held = CALM * max(self.hertz, 2 * fine.state.exit)
        if min(length, before) > 2 * held:  # what is sharp stays on its nodes
            nodes = fine.state.offset
            nodes = np.where(nodes < -held, -held + (nodes + held) * (length - held) / (before - held), nodes)
            state = replace(fine.state, offset=nodes, operator=LineOperator.of(nodes))
        else:
            state = replace(stretched(fine.state, length / before, 1.0, 1.0), exit=fine.state.exit)
        outcome = newton(self.problem, state, tolerance, self.limit)
        return replace(outcome, iterations=outcome.iterations + fine.iterations)


def _cut(problem: Problem, state: State, length: float, cells: int) -> State:
    """The state with its meniscus a length before the exit, on a mesh made for it."""
    offset = state.offset
    if length < -offset[0]:
        first = int(np.searchsorted(offset, -length, side="right"))
        nodes = np.append(-length, offset[first:])
        pressure, film = np.interp(nodes, offset, state.pressure), np.interp(nodes, offset, state.film)
    else:
        nodes, pressure, film = offset * (length / -offset[0]), state.pressure, state.film
    pressure = np.append(0.0, pressure[1:])
    bare = replace(state, offset=nodes, pressure=pressure, film=film, operator=LineOperator.of(nodes))
    return remesh(problem, bare, cells, smallest_cell(problem.load))
