"""Starved films of a line contact: an inlet shortened to a meniscus, whose place meets the condition of the supply.

Where the gap begins to be full the pressure is ambient. Oil that arrived in a layer fills it there, with a step in the
pressure gradient (Jakobsson and Floberg, Olsson). Mass is conserved: the layer is as thick as the film at the exit. So
a meniscus at any place defines a film, and the supply is met by a search over its place:

1. If the flooded film takes no more oil than there is, the flooded film is the answer.
2. From a starved film of a similar case: secants on its own mesh (`MeniscusSearch.meet_condition`).
3. Nearly flooded: the mesh of the flooded film without its first nodes, bisection over the nodes and
   `bem.numerics.bracketed_root` between two of them, because meshes differ by more than the lack of oil.
4. Otherwise: coarse films by continuation from the flooded inlet inwards until the condition is bracketed, then secants
   on the final mesh, which is stretched a little.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from bem.errors import InputError
from bem.lubrication.line.continuation import (
    COARSE_TOLERANCE,
    MEDIUM_CELLS,
    Neighbour,
    refine_mesh,
    smallest_cell,
    solve_from_neighbour,
)
from bem.lubrication.line.deflection import LineOperator
from bem.lubrication.line.newton import LineState, Outcome, newton, remesh, rescale
from bem.lubrication.line.problem import Problem, Scales
from bem.lubrication.supply import OilLayer, Starvation, Supply, inside_hertz
from bem.numerics.bracketed_root import find_decreasing_root
from bem.numerics.monotone import MonotoneCubic

FIRST_STEP = 1.0
"""First step of the continuation, in the logarithm of the distance of the meniscus from the Hertz contact."""
LEAST_STEP = 0.02
"""Shortest step of the continuation."""
MOST_TRIALS = 80
"""Largest number of coarse films."""
SECANTS = 16
"""Largest number of secant steps."""
LONGEST_STEP = 0.3
"""Longest secant step, in that logarithm."""
CALM = 1.2
"""Distance before the exit, in widths of the Hertz contact, upstream of which a mesh is stretched alone."""
COARSE_ERROR = 0.01
"""Largest deviation from the condition that ends the coarse search."""
NEARLY_FLOODED = 0.95
"""Share of the flooded flow above which the mesh of the flooded film stays."""
LEAST_BRACKET = 0.5
"""Share of the flooded flow below which the search on that mesh gives up."""
_SMALLEST_REST = 1e-9


def mass_flow(problem: Problem, state: LineState) -> float:
    """Return the mass flow through the contact, in Moes' units of the film."""
    return float(problem.couette_film(state.film[-1:])[0][0])


class SupplyCondition(Protocol):
    """Condition of a supply, relative to the flooded film on a similar mesh."""

    def excess(self, state: LineState, flooded: LineState) -> float:
        """Return by how much a film has too much inlet; zero where the condition is met."""

    def error(self, state: LineState, flooded: LineState) -> float:
        """Return the relative deviation from the condition."""


@dataclass(frozen=True)
class LayerCondition:
    """A share of the flooded flow that is to pass; excess in the log odds of the share, which resolve both ends."""

    problem: Problem
    share: float

    def excess(self, state: LineState, flooded: LineState) -> float:
        """Return the log odds of the flow less those wanted."""
        return _odds(self._flow_ratio(state, flooded)) - _odds(self.share)

    def error(self, state: LineState, flooded: LineState) -> float:
        """Return the relative deviation of the flow."""
        return abs(self._flow_ratio(state, flooded) / self.share - 1)

    def _flow_ratio(self, state: LineState, flooded: LineState) -> float:
        """Return the flow over the flooded flow."""
        return mass_flow(self.problem, state) / mass_flow(self.problem, flooded)


@dataclass(frozen=True)
class MeniscusCondition:
    """A meniscus at a distance from the axis, in Moes' units; excess in logarithms."""

    distance: float

    def excess(self, state: LineState, flooded: LineState) -> float:
        """Return ln of the distance over that wanted."""
        return math.log(max(-state.position[0], 1e-300) / self.distance)

    def error(self, state: LineState, flooded: LineState) -> float:
        """Return the absolute logarithmic deviation."""
        return abs(self.excess(state, flooded))


def _odds(share: float) -> float:
    """Return the log odds of a share."""
    return math.log(share / max(1 - share, _SMALLEST_REST))


def supply_condition(supply: Supply, problem: Problem, flooded: LineState, scales: Scales) -> SupplyCondition | None:
    """Return the condition of a supply; None where the supply floods the contact.

    Raises
    ------
    InputError : a meniscus inside the Hertz contact.
    """
    if isinstance(supply, OilLayer):
        share = supply.thickness / scales.film / mass_flow(problem, flooded)
        return LayerCondition(problem, share) if share < 1 else None
    half_width = math.sqrt(8 * problem.load / math.pi) * scales.length
    if supply.distance <= half_width:
        raise InputError(inside_hertz(supply, half_width))
    return MeniscusCondition(supply.distance / scales.length)


def starvation_of(
    problem: Problem, state: LineState, flooded: LineState, scales: Scales, reversed_: bool
) -> Starvation:
    """Return meniscus, oil layers and reduction of the film."""
    first = float(state.position[0]) * scales.length if state.far_field == 0 else -math.inf
    layers = [mass_flow(problem, one) * scales.film for one in (state, flooded)]
    central = [float(MonotoneCubic(one.position, one.film)(0.0)) for one in (state, flooded)]
    return Starvation(-first if reversed_ else first, layers[0], central[0] / central[1], layers[1])


def solve_starved(
    problem: Problem,
    flooded: Outcome,
    condition: SupplyCondition,
    cells: int,
    tolerance: float,
    limit: int,
    near: Neighbour | None = None,
) -> Outcome:
    """Solve for the film that meets the condition of a supply.

    flooded : film with flooded inlet. near : starved film of a similar case. cells : of the final mesh. limit : Newton
        steps of one film.

    Returns the flooded film where the oil would suffice beyond its mesh, where the difference is below its own far
    field.
    """
    if not flooded.converged:
        return flooded
    far = newton(problem, replace(flooded.state, far_field=0.0), tolerance, limit)
    spent = flooded.iterations + far.iterations
    if far.converged and condition.excess(far.state, flooded.state) <= 0:
        return replace(flooded, iterations=spent)
    search = MeniscusSearch(problem, flooded.state, condition, min(cells, MEDIUM_CELLS), limit)
    if near is not None:
        start = solve_from_neighbour(problem, near, cells, tolerance, limit)
        if start.converged and search.flow_ratio(start.state) < NEARLY_FLOODED:
            start = search.meet_condition(start, 1.0, tolerance)
            if start.converged:
                return replace(start, iterations=spent + start.iterations)
        spent += start.iterations
    own = search.search_on_flooded_mesh(tolerance)
    if own is not None:
        return search.with_condition_error(replace(own, iterations=spent + search.spent), tolerance)
    found, last, slope = search.search_coarse()
    if not found:
        return replace(last, iterations=spent + search.spent, converged=False)
    fine = refine_mesh(problem, last.state, search.cells, cells, tolerance, limit)
    return search.meet_condition(replace(fine, iterations=spent + search.spent + fine.iterations), slope, tolerance)


@dataclass
class MeniscusSearch:
    """Search for the place of the meniscus.

    cells : of the coarse films. spent : Newton steps so far.
    """

    problem: Problem
    flooded: LineState
    condition: SupplyCondition
    cells: int
    limit: int
    spent: int = 0

    def __post_init__(self) -> None:
        self.hertz = 2 * math.sqrt(8 * self.problem.load / math.pi)
        self.reference = self.flooded

    def search_on_flooded_mesh(self, tolerance: float) -> Outcome | None:
        """Return the film on the nodes of the flooded film without the first of them; None where so much oil lacks that
        another mesh does."""
        places = np.log(np.maximum(-self.flooded.offset - self.hertz, 1e-300))
        first, last = 0, 0
        while True:
            last = max(int(np.searchsorted(-places, FIRST_STEP - places[last])), last + 1)
            trial = self._on_flooded_nodes(-self.flooded.offset[last], tolerance)
            if not trial.converged or self.flow_ratio(trial.state) < LEAST_BRACKET:
                return None
            if self.condition.excess(trial.state, self.flooded) <= 0:
                break
            if self.flow_ratio(trial.state) < NEARLY_FLOODED:
                return None
            first = last
        while last - first > 1:
            middle = (first + last) // 2
            trial = self._on_flooded_nodes(-self.flooded.offset[middle], tolerance)
            if not trial.converged:
                return None
            first, last = (first, middle) if self.condition.excess(trial.state, self.flooded) <= 0 else (middle, last)
        return self._between(first, last, tolerance)

    def _between(self, first: int, last: int, tolerance: float) -> Outcome | None:
        """Return the film with its meniscus between two neighbouring nodes, or a little upstream of them; None where it
        lies downstream."""
        lengths = -self.flooded.offset[[first, last]]
        low, high = lengths[1], lengths[0]
        for _ in range(SECANTS):
            trial = self._on_flooded_nodes(high, tolerance, last + 1)
            if not trial.converged:
                return None
            if self.condition.excess(trial.state, self.flooded) > 0:
                break
            low, high = high, high + (lengths[0] - lengths[1])
        excess_low = self.condition.excess(self._on_flooded_nodes(low, tolerance, last + 1).state, self.flooded)
        if excess_low > 0:
            return None
        slope = self.condition.excess(trial.state, self.flooded) - excess_low

        def evaluate(part: float) -> tuple[float, bool]:
            nonlocal trial
            trial = self._on_flooded_nodes(low + part * (high - low), tolerance, last + 1)
            error = self.condition.error(trial.state, self.flooded)
            return -self.condition.excess(trial.state, self.flooded), not trial.converged or error <= tolerance

        find_decreasing_root(evaluate, -excess_low / slope, slope, (0.0, 1.0), 4 * SECANTS)
        return trial

    def flow_ratio(self, state: LineState) -> float:
        """Return the flow over the flooded flow."""
        return mass_flow(self.problem, state) / mass_flow(self.problem, self.flooded)

    def _on_flooded_nodes(self, length: float, tolerance: float, rest: int | None = None) -> Outcome:
        """Solve with the meniscus `length` before the exit, on the nodes of the flooded film from number `rest` on."""
        flooded = self.flooded
        rest = int(np.searchsorted(flooded.offset, -length * (1 - 1e-12), side="right")) if rest is None else rest
        nodes = np.append(-length, flooded.offset[rest:])
        film = np.interp(nodes, flooded.offset, flooded.film)
        pressure = np.append(0.0, flooded.pressure[rest:])
        start = replace(flooded, offset=nodes, pressure=pressure, film=film, far_field=0.0)
        trial = newton(self.problem, replace(start, operator=LineOperator.of(nodes)), tolerance, self.limit)
        self.spent += trial.iterations
        return trial

    def _solve_reference(self) -> None:
        """Solve the flooded film on a coarse mesh."""
        if len(self.flooded.offset) != self.cells + 1:
            start = remesh(self.problem, self.flooded, self.cells, smallest_cell(self.problem.load))
            outcome = newton(self.problem, start, COARSE_TOLERANCE, self.limit)
            self.spent += outcome.iterations
            self.reference = outcome.state if outcome.converged else self.flooded

    def log_distance(self, state: LineState) -> float:
        """Return ln of the distance of the meniscus from the Hertz contact."""
        return math.log(-state.offset[0] - self.hertz)

    def search_coarse(self) -> tuple[bool, Outcome, float]:
        """Return whether the coarse search succeeded, its last film, and the slope of the excess with the log
        distance."""
        self._solve_reference()
        last = Outcome(replace(self.reference, far_field=0.0), 0, 0.0, True)
        log_distance, step, slope = self.log_distance(last.state), FIRST_STEP, 1.0
        above: tuple[float, float] | None = None
        below: tuple[float, float] | None = None
        for _ in range(MOST_TRIALS):
            shorter = _cut(self.problem, last.state, self.hertz + math.exp(log_distance - step), self.cells)
            trial = newton(self.problem, shorter, COARSE_TOLERANCE, self.limit)
            self.spent += trial.iterations
            if not trial.converged:
                step /= 2
                if abs(step) < LEAST_STEP:
                    return False, trial, slope
                continue
            last, log_distance, miss = trial, log_distance - step, self.condition.excess(trial.state, self.reference)
            if abs(miss) <= COARSE_ERROR:
                return True, last, slope
            above, below = ((log_distance, miss), below) if miss > 0 else (above, (log_distance, miss))
            if below is None:
                step = min(1.5 * step, FIRST_STEP)
                continue
            if above is None:  # the first step was too long, and what coarse meshes miss beyond is not known
                return True, last, slope
            slope = (above[1] - below[1]) / (above[0] - below[0])
            step = log_distance - min(max(log_distance - miss / slope, below[0]), above[0])
            if abs(step) < 1e-6:
                return True, last, slope
        return False, last, slope

    def meet_condition(self, fine: Outcome, slope: float, tolerance: float) -> Outcome:
        """Meet the condition on the final mesh by secants; the mesh is stretched a little."""
        before: tuple[float, float] | None = None
        for _ in range(SECANTS):
            if not fine.converged:
                break
            miss, log_distance = self.condition.excess(fine.state, self.flooded), self.log_distance(fine.state)
            if self.condition.error(fine.state, self.flooded) <= tolerance:
                break
            if before is not None and (miss - before[1]) * (log_distance - before[0]) > 0:
                slope = (miss - before[1]) / (log_distance - before[0])
            before, change = (log_distance, miss), min(max(-miss / slope, -LONGEST_STEP), LONGEST_STEP)
            fine = self._at_meniscus(fine, log_distance + change, tolerance)
        return self.with_condition_error(fine, tolerance)

    def with_condition_error(self, fine: Outcome, tolerance: float) -> Outcome:
        """Return the outcome with the deviation from the condition in its residual and convergence."""
        miss = self.condition.error(fine.state, self.flooded)
        return replace(fine, residual=max(fine.residual, miss), converged=fine.converged and miss <= tolerance)

    def _at_meniscus(self, fine: Outcome, log_distance: float, tolerance: float) -> Outcome:
        """Solve with the meniscus at another log distance."""
        length, before = self.hertz + math.exp(log_distance), -fine.state.offset[0]
        fixed = CALM * max(self.hertz, 2 * fine.state.exit)
        if min(length, before) > 2 * fixed:  # what is sharp stays on its nodes
            nodes = fine.state.offset
            nodes = np.where(nodes < -fixed, -fixed + (nodes + fixed) * (length - fixed) / (before - fixed), nodes)
            state = replace(fine.state, offset=nodes, operator=LineOperator.of(nodes))
        else:
            state = replace(rescale(fine.state, length / before, 1.0, 1.0), exit=fine.state.exit)
        outcome = newton(self.problem, state, tolerance, self.limit)
        return replace(outcome, iterations=outcome.iterations + fine.iterations)


def _cut(problem: Problem, state: LineState, length: float, cells: int) -> LineState:
    """Return the state with its meniscus `length` before the exit, on a mesh made for it."""
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
