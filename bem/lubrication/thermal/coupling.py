"""A film and its temperature field, each solved for with the other as it is, until both hold at once."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from dataclasses import field as field_of
from itertools import pairwise

import numpy as np

from bem.grid import FloatArray
from bem.heat.bodies import Conductor
from bem.lubrication.line.continuation import MAX_IMBALANCE, Neighbour, smallest_cell, start_from_neighbour
from bem.lubrication.line.newton import LineState, Outcome, mesh_imbalance, newton, remesh, spike_cell
from bem.lubrication.line.problem import Problem
from bem.lubrication.line.state import ThermalState, interpolate_columns
from bem.lubrication.results import FilmSolution
from bem.lubrication.thermal.columns import Strip, cell_edges, strip_of
from bem.lubrication.thermal.cross_film import Given
from bem.lubrication.thermal.field import TOLERANCE, Duct, Field, temperature_field, warming_of
from bem.lubrication.thermal.heat_source import Made
from bem.lubrication.thermal.layers import HotFilm, Oil

MOST_ROUNDS = 80
SKETCH, SKETCHED = 400, 1e-3
"""Cells, and residual, with which films of more cells begin: on 2000 the first rounds, which are far from a film, took
ten times as long."""
SMOOTHED = 4
"""Times that temperatures are smoothed for the flow."""
SETTLED = 0.3
"""Residual from which a spike is where it will be."""
MISPLACED = 3.0
"""Cells at a spike over what they should be, from which a mesh is made anew."""
MOST_MESHES = 3
MEMORY = 6
"""Rounds that the next one learns from."""
LEAST_MIXING = 0.25
FALLING, PATIENCE = 0.7, 6
"""Of the least residual so far, what counts as less; rounds that may go by without."""
EXACTNESS = 0.03
"""Of a round, over the error that the last one left."""
COARSE = 1e-3
LOST = 1e-2
"""Of a field, from which it is none: the round before is kept."""
FINE = 1e-7
"""Of the field at the end."""
SHORTEST_SHARE = 1 / 64
"""Of the way from one temperature field to the next that Reynolds' equation follows."""


@dataclass(frozen=True)
class Coupling:
    """What stays the same. unit : of pressure [Pa]. film_of : what is said of an outcome; columns, layers : of the
    heat, at most."""

    problem: Problem
    oil: Oil
    bodies: tuple[Conductor, Conductor]
    slide: float
    unit: float
    film_of: Callable[[Outcome], FilmSolution]
    columns: int
    layers: int
    tolerance: float
    limit: int

    def duct(self, strip: Strip, before: Duct | None) -> Duct:
        """The film as a place for heat; bodies warm as in the duct before where the mesh is the same."""
        lubricant = self.oil.lubricant
        slender = np.add.reduceat(
            0.5 * np.diff(strip.x) * (1 / strip.thickness[1:] + 1 / strip.thickness[:-1]),
            np.searchsorted(strip.x, strip.edges[:-1]),
        )
        width = np.diff(strip.edges)
        same = before is not None and len(before.width) == len(width) and np.allclose(before.width, width, rtol=1e-9)
        warming = before.warming if before is not None and same else warming_of(strip.edges, self.bodies)
        capacity = (lubricant.density or 0.0) * (lubricant.heat_capacity or 0.0)
        return Duct(
            strip.edges,
            slender,
            lubricant.thermal_conductivity or 0.0,
            capacity,
            self.supply,
            self.bodies,
            self.layers,
            warming,
        )

    @property
    def supply(self) -> float:
        """Temperature of the oil as it comes [K]."""
        return float(self.oil.lubricant.temperature or 0.0)

    def layered(self, layers: FloatArray) -> HotFilm:
        """Temperatures at the nodes [K] and, last, the thinning of layers (n, K + 1), see
        `reynolds.Layered`."""
        cold, temperature, thinning = self.problem.log_viscosity, layers[:, :-1], layers[:, -1]
        return HotFilm.of(self.oil, temperature, cold, self.slide, self.unit, thinning)

    def hot(self, layers: FloatArray) -> Problem:
        """Reynolds' problem with these."""
        return replace(self.problem, layered=self.layered(layers))


@dataclass(frozen=True)
class Heated:
    """A film with its heat: what is said of the film, its strip, duct, heat and field, the temperatures and the
    thinning at the nodes that it was given and those found (n, K + 1), see `Coupling.layered`, Reynolds' residual at
    these, Newton steps and rounds in all."""

    film: FilmSolution
    outcome: Outcome
    strip: Strip
    duct: Duct
    made: Made
    field: Field
    given: FloatArray
    found: FloatArray
    residual: float
    steps: int = 0
    rounds: int = 0

    def kept(self, isothermal: FilmSolution, columns: int) -> ThermalState:
        """For the next one to start from."""
        supply, exit_, state = self.duct.supply, abs(self.film.exit_position), self.outcome.state
        layers = self.found.copy()
        layers[:, :-1] -= supply
        middles = self.duct.middles / exit_ - 1
        nodes = state.offset / state.exit
        return ThermalState(isothermal, nodes, layers, middles, self.field.rise, self.made.edge, columns)

    def met(self, tolerance: float) -> bool:
        """Return True if Reynolds' equation holds at the temperatures, and they at the film."""
        return self.residual <= tolerance and self.field.residual <= FINE


@dataclass(frozen=True)
class HotNeighbour:
    """Film of another case with its temperatures."""

    film: Neighbour
    heat: ThermalState


@dataclass(frozen=True)
class Tried:
    """A film with its heat, None where it is not met; the Newton steps and rounds that went into it."""

    found: Heated | None = None
    steps: int = 0
    rounds: int = 0

    @classmethod
    def of(cls, found: Heated, tolerance: float) -> Tried:
        """A film, where it is met."""
        return cls(found if found.met(tolerance) else None, found.steps, found.rounds)


def coupled(coupling: Coupling, start: Outcome, near: HotNeighbour | None = None) -> Heated:
    """From a film without heat and, where that will do, a neighbour with its own; else on few cells at first, where
    film and heat find each other."""
    tried = Tried() if near is None else _from_neighbour(coupling, start.state, near)
    steps, rounds = start.iterations + tried.steps, tried.rounds
    if tried.found is None and len(start.state.offset) - 1 > SKETCH:
        sketch = newton(coupling.problem, _sketch_of(coupling, start.state), COARSE, coupling.limit)
        tried = Tried(steps=sketch.iterations)
        if sketch.converged:
            tried = _from_sketch(coupling, _cold(coupling, sketch), len(start.state.offset) - 1)
        steps, rounds = steps + tried.steps, rounds + tried.rounds
    if tried.found is not None:
        return replace(tried.found, steps=steps, rounds=rounds)
    at = _cold(coupling, start)
    return _rounds(coupling, replace(at, steps=steps, rounds=rounds + at.rounds))


def _from_neighbour(coupling: Coupling, start: LineState, near: HotNeighbour) -> Tried:
    """With its heat on the film's own cells, where that is nearly met, else on few of them first."""
    cells = len(start.offset) - 1
    state = start_from_neighbour(coupling.problem, near.film, cells)
    at = _given(coupling, near, start if state is None else state, SKETCHED if cells > SKETCH else math.inf)
    if at is not None:
        return Tried.of(_rounds(coupling, at), coupling.tolerance)
    if cells <= SKETCH and state is None:
        return Tried()
    at = _given(coupling, near, start if cells <= SKETCH else _sketch_of(coupling, start), math.inf)
    if at is None:
        return Tried()
    if cells > SKETCH:
        return _from_sketch(coupling, at, cells)
    return Tried.of(_rounds(coupling, at), coupling.tolerance)


def _given(coupling: Coupling, near: HotNeighbour, state: LineState, most: float) -> Heated | None:
    """A film that begins as a state does, with the heat of a neighbour; None where that is not found, or leaves a
    residual of more than the most."""
    layers = near.heat.at_nodes(state.offset / state.exit, coupling.layers, coupling.supply)
    hot = coupling.hot(layers)
    left = newton(hot, state, coupling.tolerance, 0).residual
    if not left <= most:
        return None
    outcome = newton(hot, state, max(coupling.tolerance, min(EXACTNESS * left, COARSE)), coupling.limit)
    if not outcome.converged:
        return None
    return replace(_heated(coupling, outcome, layers, near.heat, left), steps=outcome.iterations, rounds=1)


def _sketch_of(coupling: Coupling, state: LineState) -> LineState:
    return remesh(coupling.problem, state, SKETCH, smallest_cell(coupling.problem.load))


def _from_sketch(coupling: Coupling, sketch: Heated, cells: int) -> Tried:
    """Rounds on few cells, and then on all."""
    found = _rounds(coupling, sketch, SKETCHED)
    fine = _on_cells(coupling, found, cells) if found.residual <= SKETCHED else None
    if fine is None:
        return Tried(None, found.steps, found.rounds)
    fine = replace(fine, steps=found.steps + fine.steps, rounds=found.rounds + 1)
    return Tried.of(_rounds(coupling, fine), coupling.tolerance)


def _cold(coupling: Coupling, start: Outcome) -> Heated:
    """The heat of a film without any."""
    kept = np.full((len(start.state.offset), coupling.layers + 1), coupling.oil.viscosity.reference)
    kept[:, -1] = 0.0
    return replace(_heated(coupling, start, kept, None, 1.0), steps=start.iterations, rounds=1)


def _on_cells(coupling: Coupling, sketch: Heated, cells: int) -> Heated | None:
    """On so many cells from fewer, with the steps that took; None where Reynolds' equation is not followed there."""
    state = remesh(coupling.problem, sketch.outcome.state, cells, smallest_cell(coupling.problem.load))
    there = interpolate_columns(sketch.outcome.state.offset, sketch.found, state.offset)
    fine = newton(coupling.hot(there), state, COARSE, coupling.limit)
    if not fine.converged:
        return None
    return replace(_heated(coupling, fine, there, sketch, sketch.residual), steps=fine.iterations)


def _rounds(coupling: Coupling, at: Heated, tolerance: float = 0.0) -> Heated:
    """Film and temperatures in turn, until both are met, Reynolds' equation to a tolerance that is left, or no more."""
    steps, rounds, history, remeshed = at.steps, at.rounds, History(), 0
    most = rounds - 1 + MOST_ROUNDS
    while True:
        done = at.met(coupling.tolerance) or at.residual <= tolerance
        if done or rounds >= most or not np.isfinite(at.residual):
            return replace(at, steps=steps, rounds=rounds)
        goal = max(coupling.tolerance, min(EXACTNESS * at.residual, COARSE))
        outcome, kept, spent = _followed(coupling, at.outcome, at.given, history.following(at), goal)
        steps += spent
        if (
            outcome is not None
            and remeshed < MOST_MESHES
            and _is_misplaced(coupling.problem, outcome.state, at.residual)
        ):
            remeshed += 1
            state = remesh(
                coupling.problem, outcome.state, len(outcome.state.offset) - 1, smallest_cell(coupling.problem.load)
            )
            there = interpolate_columns(outcome.state.offset, kept, state.offset)
            again = newton(coupling.hot(there), state, goal, coupling.limit)
            steps += again.iterations
            if again.converged:
                outcome, kept, history = again, there, History(mixing=history.mixing)
        following = None if outcome is None else _heated(coupling, outcome, kept, at, at.residual)
        rounds += 1
        if following is not None and following.field.residual <= LOST:
            at = following
        elif history.mixing > LEAST_MIXING:
            history = History(mixing=0.5 * history.mixing)
        else:
            return replace(at, steps=steps, rounds=rounds)


def _heated(
    coupling: Coupling, outcome: Outcome, given: FloatArray, near: Heated | ThermalState | None, residual: float
) -> Heated:
    """The heat of a film that was solved for as it was given, see `Heated`, to a share of the residual before; from
    that of the round before, or of another case."""
    film = coupling.film_of(outcome)
    before = near if isinstance(near, Heated) else None
    kept = before is not None and before.outcome.state.offset is outcome.state.offset
    places = before.made.edge if before is not None and kept else None
    if isinstance(near, ThermalState):
        places = near.edges_of(outcome.state.offset / outcome.state.exit, coupling.columns)

    def edges(x: FloatArray, pressure: FloatArray) -> FloatArray:
        return cell_edges(x, pressure, coupling.columns) if places is None else x[places]

    strip = strip_of(film, edges, coupling.oil.unheated_work)
    layered, pressure = coupling.layered(given), np.maximum(outcome.state.pressure, 0.0)
    solved_with = Given(layered.log_viscosity(pressure)[0], layered.centre(pressure))
    duct = coupling.duct(strip, None if before is None else before.duct)
    made = Made.of(coupling.oil, strip, solved_with)
    warm = before is not None and before.field.residual <= LOST
    guess = np.full((duct.columns, coupling.layers + 2), duct.supply)
    if before is not None and warm:
        guess = interpolate_columns(before.duct.middles, before.field.temperature, duct.middles)
    elif isinstance(near, ThermalState):
        warm = True
        guess = near.in_columns(duct.middles / abs(film.exit_position) - 1, coupling.layers, duct.supply)
    wanted = max(TOLERANCE, min(EXACTNESS * residual, COARSE))
    field = temperature_field(duct, made, guess, wanted, held=0.0 if warm else 1.0)
    warm_layers = _smoothed(field.oil)
    found = np.column_stack([made.at_nodes(warm_layers), made.across(warm_layers).thinning])
    left = newton(coupling.hot(found), outcome.state, coupling.tolerance, 0).residual
    return Heated(film, outcome, strip, duct, made, field, given, found, left)


@dataclass
class History:
    """What films were solved with, see `Heated`, and what was found of them: where both will be the same, by the
    secants between the last of them (Anderson, J. ACM 12 (1965) 547; Walker and Ni, SIAM J. Numer. Anal. 49 (2011)
    1715).

    mixing : share of the way to what was found, halved where residuals do not fall: columns that heat each other by way
    of density, film and pressure swing about. least : residual so far; since : rounds that did not lower it.
    """

    mixing: float = 1.0
    given: list[FloatArray] = field_of(default_factory=list)
    found: list[FloatArray] = field_of(default_factory=list)
    least: float = np.inf
    since: int = 0

    def following(self, at: Heated) -> FloatArray:
        """What to go on with."""
        self.since = 0 if at.residual < FALLING * self.least else self.since + 1
        self.least = min(self.least, at.residual)
        if self.since > PATIENCE and self.mixing > LEAST_MIXING:
            self.mixing, self.since, self.given, self.found = 0.5 * self.mixing, 0, [], []
        found = at.given + self.mixing * (at.found - at.given)
        self.given, self.found = [*self.given, at.given][-MEMORY:], [*self.found, found][-MEMORY:]
        if len(self.given) == 1:
            return found
        missed = [(b - a).ravel() for a, b in zip(self.given, self.found, strict=True)]
        changes = np.stack([b - a for a, b in pairwise(missed)], axis=1)
        weights = np.linalg.lstsq(changes, missed[-1], rcond=1e-10)[0]
        steps = [b - a for a, b in pairwise(self.found)]
        return found - sum(weight * step for weight, step in zip(weights, steps, strict=True))


def _is_misplaced(problem: Problem, state: LineState, residual: float) -> bool:
    """Return True if a mesh is too coarse somewhere for the film, or a spike of pressure not where its cells are
    fine."""
    if mesh_imbalance(problem, state) > MAX_IMBALANCE:
        return True
    if residual > SETTLED:
        return False
    width = np.diff(state.offset)
    top = int(np.argmin(np.diff(state.pressure) / width))
    wanted = max(spike_cell(problem, state, len(width)), smallest_cell(problem.load)) * state.exit
    return bool(width[top] > MISPLACED * wanted)


def _followed(
    coupling: Coupling, outcome: Outcome, kept: FloatArray, wanted: FloatArray, tolerance: float
) -> tuple[Outcome | None, FloatArray, int]:
    """The film with the wanted temperatures and thinning, or as far towards them as it can be followed from what it
    had."""
    share, spent = 1.0, 0
    while share >= SHORTEST_SHARE:
        temperature = kept + share * (wanted - kept)
        trial = newton(coupling.hot(temperature), outcome.state, tolerance, coupling.limit)
        spent += trial.iterations
        if trial.converged:
            return trial, temperature, spent
        share *= 0.5
    return None, kept, spent


def _smoothed(oil: FloatArray) -> FloatArray:
    """Temperatures of columns (m, K) as the flow sees them: less rough from one column to the next, by what is of
    fourth order in width: else where a spike narrower than a column stands would follow from which column it is in.
    What a smoothing takes is given back once, itself smoothed (Hamming, Digital filters (1989): twicing)."""
    once = _binomial(oil)
    return once + _binomial(oil - once)


def _binomial(oil: FloatArray) -> FloatArray:
    for _ in range(SMOOTHED):
        padded = np.vstack([oil[:1], oil, oil[-1:]])
        oil = 0.25 * (padded[:-2] + 2 * padded[1:-1] + padded[2:])
    return oil
