"""Coupling of a film with its temperature field: fixed-point iteration with Anderson mixing.

1. Start: a neighbour with its temperatures, else the isothermal film on few cells, else on all cells.
2. A round solves Reynolds' equation at given temperatures, then the energy equation at that film (`_with_heat`). Both
   are solved as far as the residual of the round deserves.
3. The next temperatures are extrapolated from the last rounds (D. G. Anderson, *J. ACM* 12 (1965) 547; H. F. Walker and
   P. Ni, *SIAM J. Numer. Anal.* 49 (2011) 1715).
4. The iteration ends where Reynolds' equation holds at the temperatures of its own film to the tolerance.
"""

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
from bem.lubrication.thermal.columns import FilmColumns, cell_edges, film_columns_of
from bem.lubrication.thermal.cross_film import FlowResistance
from bem.lubrication.thermal.field import TOLERANCE, EnergyGeometry, Field, surface_responses, temperature_field
from bem.lubrication.thermal.heat_source import HeatSource
from bem.lubrication.thermal.layers import HeatedOil, LayeredFilm

MOST_ROUNDS = 80
"""Largest number of rounds."""
COARSE_CELLS, COARSE_RESIDUAL = 400, 1e-3
"""Cells of the first rounds of a film with more cells, and the Reynolds residual that ends them."""
SMOOTHINGS = 4
"""Number of smoothings of the temperatures along the film for Reynolds' equation."""
SETTLED_RESIDUAL = 0.3
"""Reynolds residual below which the spike is in place."""
MISPLACED_RATIO = 3.0
"""Cell at the spike over the wanted one, above which a new mesh is made."""
MOST_MESHES = 3
"""Largest number of new meshes."""
ANDERSON_DEPTH = 6
"""Rounds that the mixing uses."""
LEAST_MIXING = 0.25
"""Smallest share of the mixing."""
FALLING_RATIO, PATIENCE = 0.7, 6
"""Residual over the least so far that counts as a decrease; rounds without a decrease before the mixing is halved."""
EXACTNESS = 0.03
"""Tolerance of the solutions of a round, over the residual of the last round."""
COARSE_TOLERANCE = 1e-3
"""Largest such tolerance."""
LOST_RESIDUAL = 1e-2
"""Residual of a temperature field above which it is discarded."""
FINE_RESIDUAL = 1e-7
"""Residual of the temperature field at the end."""
SHORTEST_STEP = 1 / 64
"""Shortest share of the way from one temperature field to the next that Reynolds' equation follows."""


@dataclass(frozen=True)
class Coupling:
    """Quantities that stay constant during the iteration.

    slide : (u2 - u1)/(u1 + u2). unit : of pressure [Pa]. film_of : returns the result of an outcome.
    columns, layers : of the temperature field, at most. tolerance, limit : of Newton's method for the film.
    """

    problem: Problem
    oil: HeatedOil
    bodies: tuple[Conductor, Conductor]
    slide: float
    unit: float
    film_of: Callable[[Outcome], FilmSolution]
    columns: int
    layers: int
    tolerance: float
    limit: int

    def geometry(self, film_columns: FilmColumns, before: EnergyGeometry | None) -> EnergyGeometry:
        """Return the geometry of the energy equation; the surface responses of the last one are reused on the same
        mesh."""
        lubricant = self.oil.lubricant
        inverse_thickness = np.add.reduceat(
            0.5 * np.diff(film_columns.x) * (1 / film_columns.thickness[1:] + 1 / film_columns.thickness[:-1]),
            np.searchsorted(film_columns.x, film_columns.edges[:-1]),
        )
        width = np.diff(film_columns.edges)
        same = before is not None and len(before.width) == len(width) and np.allclose(before.width, width, rtol=1e-9)
        surface_response = (
            before.surface_response
            if before is not None and same
            else surface_responses(film_columns.edges, self.bodies)
        )
        capacity = (lubricant.density or 0.0) * (lubricant.heat_capacity or 0.0)
        return EnergyGeometry(
            film_columns.edges,
            inverse_thickness,
            lubricant.thermal_conductivity or 0.0,
            capacity,
            self.supply,
            self.bodies,
            self.layers,
            surface_response,
        )

    @property
    def supply(self) -> float:
        """Temperature of the supplied oil [K]."""
        return float(self.oil.lubricant.temperature or 0.0)

    def layered(self, layers: FloatArray) -> LayeredFilm:
        """Return the layers of temperatures at the nodes [K] and, last, their thinning (n, K + 1), see
        `bem.lubrication.line.problem.Layered`."""
        cold, temperature, thinning = self.problem.log_viscosity, layers[:, :-1], layers[:, -1]
        return LayeredFilm.of(self.oil, temperature, cold, self.slide, self.unit, thinning)

    def hot(self, layers: FloatArray) -> Problem:
        """Return the similarity problem with these layers."""
        return replace(self.problem, layered=self.layered(layers))


@dataclass(frozen=True)
class ThermalIterate:
    """A film with its heat.

    film, outcome : result, and state of the solver. film_columns, geometry, source, field : of the energy equation.
    applied, computed : (n, K + 1) temperatures and thinning at the nodes (`Coupling.layered`): those with which
        Reynolds' equation was solved, and those of the energy equation.
    residual : of Reynolds' equation at the computed ones. steps, rounds : Newton steps and rounds in total.
    """

    film: FilmSolution
    outcome: Outcome
    film_columns: FilmColumns
    geometry: EnergyGeometry
    source: HeatSource
    field: Field
    applied: FloatArray
    computed: FloatArray
    residual: float
    steps: int = 0
    rounds: int = 0

    def state_for(self, isothermal: FilmSolution, columns: int) -> ThermalState:
        """Return the temperatures as a warm start."""
        supply, exit_, state = self.geometry.supply, abs(self.film.exit_position), self.outcome.state
        layers = self.computed.copy()
        layers[:, :-1] -= supply
        centres = self.geometry.centres / exit_ - 1
        nodes = state.offset / state.exit
        return ThermalState(isothermal, nodes, layers, centres, self.field.rise, self.source.edge, columns)

    def met(self, tolerance: float) -> bool:
        """Return True if Reynolds' equation and the energy equation hold."""
        return self.residual <= tolerance and self.field.residual <= FINE_RESIDUAL


@dataclass(frozen=True)
class HotNeighbour:
    """Film of another case with its temperatures."""

    film: Neighbour
    heat: ThermalState


@dataclass(frozen=True)
class ThermalAttempt:
    """An attempt at a film with heat: the film, None where it is not met, and the Newton steps and rounds spent."""

    found: ThermalIterate | None = None
    steps: int = 0
    rounds: int = 0

    @classmethod
    def of(cls, found: ThermalIterate, tolerance: float) -> ThermalAttempt:
        """Return the attempt of a film, where it is met."""
        return cls(found if found.met(tolerance) else None, found.steps, found.rounds)


def solve_coupled(coupling: Coupling, start: Outcome, near: HotNeighbour | None = None) -> ThermalIterate:
    """Solve for film and temperatures, from a film without heat and, if there is one, a neighbour with its
    temperatures."""
    tried = ThermalAttempt() if near is None else _from_neighbour(coupling, start.state, near)
    steps, rounds = start.iterations + tried.steps, tried.rounds
    if tried.found is None and len(start.state.offset) - 1 > COARSE_CELLS:
        coarse = newton(coupling.problem, _coarse_state(coupling, start.state), COARSE_TOLERANCE, coupling.limit)
        tried = ThermalAttempt(steps=coarse.iterations)
        if coarse.converged:
            tried = _from_coarse(coupling, _cold(coupling, coarse), len(start.state.offset) - 1)
        steps, rounds = steps + tried.steps, rounds + tried.rounds
    if tried.found is not None:
        return replace(tried.found, steps=steps, rounds=rounds)
    at = _cold(coupling, start)
    return _iterate(coupling, replace(at, steps=steps, rounds=rounds + at.rounds))


def _from_neighbour(coupling: Coupling, start: LineState, near: HotNeighbour) -> ThermalAttempt:
    """Start with the temperatures of a neighbour: on the film's own cells where they nearly fit, else on few cells
    first."""
    cells = len(start.offset) - 1
    state = start_from_neighbour(coupling.problem, near.film, cells)
    at = _start_from_heat(
        coupling, near, start if state is None else state, COARSE_RESIDUAL if cells > COARSE_CELLS else math.inf
    )
    if at is not None:
        return ThermalAttempt.of(_iterate(coupling, at), coupling.tolerance)
    if cells <= COARSE_CELLS and state is None:
        return ThermalAttempt()
    at = _start_from_heat(coupling, near, start if cells <= COARSE_CELLS else _coarse_state(coupling, start), math.inf)
    if at is None:
        return ThermalAttempt()
    if cells > COARSE_CELLS:
        return _from_coarse(coupling, at, cells)
    return ThermalAttempt.of(_iterate(coupling, at), coupling.tolerance)


def _start_from_heat(coupling: Coupling, near: HotNeighbour, state: LineState, most: float) -> ThermalIterate | None:
    """Return the film from a state with the temperatures of a neighbour; None where Newton's method fails or the first
    residual exceeds `most`."""
    layers = near.heat.at_nodes(state.offset / state.exit, coupling.layers, coupling.supply)
    hot = coupling.hot(layers)
    left = newton(hot, state, coupling.tolerance, 0).residual
    if not left <= most:
        return None
    outcome = newton(hot, state, max(coupling.tolerance, min(EXACTNESS * left, COARSE_TOLERANCE)), coupling.limit)
    if not outcome.converged:
        return None
    return replace(_with_heat(coupling, outcome, layers, near.heat, left), steps=outcome.iterations, rounds=1)


def _coarse_state(coupling: Coupling, state: LineState) -> LineState:
    """Return a state on few cells."""
    return remesh(coupling.problem, state, COARSE_CELLS, smallest_cell(coupling.problem.load))


def _from_coarse(coupling: Coupling, coarse: ThermalIterate, cells: int) -> ThermalAttempt:
    """Iterate on few cells, then on all."""
    found = _iterate(coupling, coarse, COARSE_RESIDUAL)
    fine = _on_cells(coupling, found, cells) if found.residual <= COARSE_RESIDUAL else None
    if fine is None:
        return ThermalAttempt(None, found.steps, found.rounds)
    fine = replace(fine, steps=found.steps + fine.steps, rounds=found.rounds + 1)
    return ThermalAttempt.of(_iterate(coupling, fine), coupling.tolerance)


def _cold(coupling: Coupling, start: Outcome) -> ThermalIterate:
    """Return the first iterate of a film without heat."""
    applied = np.full((len(start.state.offset), coupling.layers + 1), coupling.oil.viscosity.reference)
    applied[:, -1] = 0.0
    return replace(_with_heat(coupling, start, applied, None, 1.0), steps=start.iterations, rounds=1)


def _on_cells(coupling: Coupling, coarse: ThermalIterate, cells: int) -> ThermalIterate | None:
    """Return an iterate on more cells; None where Newton's method fails there."""
    state = remesh(coupling.problem, coarse.outcome.state, cells, smallest_cell(coupling.problem.load))
    at_nodes = interpolate_columns(coarse.outcome.state.offset, coarse.computed, state.offset)
    fine = newton(coupling.hot(at_nodes), state, COARSE_TOLERANCE, coupling.limit)
    if not fine.converged:
        return None
    return replace(_with_heat(coupling, fine, at_nodes, coarse, coarse.residual), steps=fine.iterations)


def _iterate(coupling: Coupling, at: ThermalIterate, tolerance: float = 0.0) -> ThermalIterate:
    """Iterate until film and temperatures are met, or Reynolds' residual meets a tolerance, or no more rounds help."""
    steps, rounds, history, remeshed = at.steps, at.rounds, AndersonMixing(), 0
    most = rounds - 1 + MOST_ROUNDS
    while True:
        done = at.met(coupling.tolerance) or at.residual <= tolerance
        if done or rounds >= most or not np.isfinite(at.residual):
            return replace(at, steps=steps, rounds=rounds)
        goal = max(coupling.tolerance, min(EXACTNESS * at.residual, COARSE_TOLERANCE))
        outcome, applied, spent = _follow_temperatures(coupling, at.outcome, at.applied, history.following(at), goal)
        steps += spent
        if outcome is not None and remeshed < MOST_MESHES and _needs_mesh(coupling.problem, outcome.state, at.residual):
            remeshed += 1
            state = remesh(
                coupling.problem, outcome.state, len(outcome.state.offset) - 1, smallest_cell(coupling.problem.load)
            )
            at_nodes = interpolate_columns(outcome.state.offset, applied, state.offset)
            refined = newton(coupling.hot(at_nodes), state, goal, coupling.limit)
            steps += refined.iterations
            if refined.converged:
                outcome, applied, history = refined, at_nodes, AndersonMixing(mixing=history.mixing)
        following = None if outcome is None else _with_heat(coupling, outcome, applied, at, at.residual)
        rounds += 1
        if following is not None and following.field.residual <= LOST_RESIDUAL:
            at = following
        elif history.mixing > LEAST_MIXING:
            history = AndersonMixing(mixing=0.5 * history.mixing)
        else:
            return replace(at, steps=steps, rounds=rounds)


def _with_heat(
    coupling: Coupling,
    outcome: Outcome,
    applied: FloatArray,
    near: ThermalIterate | ThermalState | None,
    residual: float,
) -> ThermalIterate:
    """Return the iterate of a film: solve its energy equation, from the last round or another case, and evaluate
    Reynolds' residual.

    residual : of the last round, which sets the tolerance.
    """
    film = coupling.film_of(outcome)
    before = near if isinstance(near, ThermalIterate) else None
    same_mesh = before is not None and before.outcome.state.offset is outcome.state.offset
    known_edges = before.source.edge if before is not None and same_mesh else None
    if isinstance(near, ThermalState):
        known_edges = near.edges_of(outcome.state.offset / outcome.state.exit, coupling.columns)

    def edges(x: FloatArray, pressure: FloatArray) -> FloatArray:
        return cell_edges(x, pressure, coupling.columns) if known_edges is None else x[known_edges]

    film_columns = film_columns_of(film, edges, coupling.oil.unheated_work)
    layered, pressure = coupling.layered(applied), np.maximum(outcome.state.pressure, 0.0)
    solved_with = FlowResistance(layered.log_viscosity(pressure)[0], layered.centre(pressure))
    geometry = coupling.geometry(film_columns, None if before is None else before.geometry)
    made = HeatSource.of(coupling.oil, film_columns, solved_with)
    warm = before is not None and before.field.residual <= LOST_RESIDUAL
    guess = np.full((geometry.columns, coupling.layers + 2), geometry.supply)
    if before is not None and warm:
        guess = interpolate_columns(before.geometry.centres, before.field.temperature, geometry.centres)
    elif isinstance(near, ThermalState):
        warm = True
        guess = near.in_columns(geometry.centres / abs(film.exit_position) - 1, coupling.layers, geometry.supply)
    wanted = max(TOLERANCE, min(EXACTNESS * residual, COARSE_TOLERANCE))
    field = temperature_field(geometry, made, guess, wanted, damping=0.0 if warm else 1.0)
    warm_layers = _smooth(field.oil)
    found = np.column_stack([made.at_nodes(warm_layers), made.cross_film_flow(warm_layers).thinning])
    left = newton(coupling.hot(found), outcome.state, coupling.tolerance, 0).residual
    return ThermalIterate(film, outcome, film_columns, geometry, made, field, applied, found, left)


@dataclass
class AndersonMixing:
    """Anderson mixing of the temperatures that Reynolds' equation is solved with.

    mixing : share of the way to the computed temperatures, halved where residuals do not fall: columns that heat each
        other by way of density, film and pressure oscillate.
    applied, found : of the last rounds. least : residual so far; since : rounds without a lower one.
    """

    mixing: float = 1.0
    applied: list[FloatArray] = field_of(default_factory=list)
    found: list[FloatArray] = field_of(default_factory=list)
    least: float = np.inf
    since: int = 0

    def following(self, at: ThermalIterate) -> FloatArray:
        """Return the temperatures of the next round."""
        self.since = 0 if at.residual < FALLING_RATIO * self.least else self.since + 1
        self.least = min(self.least, at.residual)
        if self.since > PATIENCE and self.mixing > LEAST_MIXING:
            self.mixing, self.since, self.applied, self.found = 0.5 * self.mixing, 0, [], []
        found = at.applied + self.mixing * (at.computed - at.applied)
        self.applied, self.found = [*self.applied, at.applied][-ANDERSON_DEPTH:], [*self.found, found][-ANDERSON_DEPTH:]
        if len(self.applied) == 1:
            return found
        missed = [(b - a).ravel() for a, b in zip(self.applied, self.found, strict=True)]
        changes = np.stack([b - a for a, b in pairwise(missed)], axis=1)
        weights = np.linalg.lstsq(changes, missed[-1], rcond=1e-10)[0]
        steps = [b - a for a, b in pairwise(self.found)]
        return found - sum(weight * step for weight, step in zip(weights, steps, strict=True))


def _needs_mesh(problem: Problem, state: LineState, residual: float) -> bool:
    """Return True if the mesh is too coarse somewhere for the film, or the spike not where its cells are fine."""
    if mesh_imbalance(problem, state) > MAX_IMBALANCE:
        return True
    if residual > SETTLED_RESIDUAL:
        return False
    width = np.diff(state.offset)
    top = int(np.argmin(np.diff(state.pressure) / width))
    wanted = max(spike_cell(problem, state, len(width)), smallest_cell(problem.load)) * state.exit
    return bool(width[top] > MISPLACED_RATIO * wanted)


def _follow_temperatures(
    coupling: Coupling, outcome: Outcome, applied: FloatArray, wanted: FloatArray, tolerance: float
) -> tuple[Outcome | None, FloatArray, int]:
    """Solve the film at the wanted temperatures, or as far towards them as Newton's method converges; return the
    outcome, its temperatures, and the Newton steps."""
    share, spent = 1.0, 0
    while share >= SHORTEST_STEP:
        temperature = applied + share * (wanted - applied)
        trial = newton(coupling.hot(temperature), outcome.state, tolerance, coupling.limit)
        spent += trial.iterations
        if trial.converged:
            return trial, temperature, spent
        share *= 0.5
    return None, applied, spent


def _smooth(oil: FloatArray) -> FloatArray:
    """Return temperatures of columns (m, K) smoothed along the film, up to fourth order in the width.

    Without smoothing a spike narrower than a column would depend on the column that it is in. The smoothing error is
    added back once, itself smoothed (twicing: R. W. Hamming, *Digital Filters*, 1989).
    """
    once = _binomial(oil)
    return once + _binomial(oil - once)


def _binomial(oil: FloatArray) -> FloatArray:
    """Return temperatures after `SMOOTHINGS` binomial smoothings."""
    for _ in range(SMOOTHINGS):
        padded = np.vstack([oil[:1], oil, oil[-1:]])
        oil = 0.25 * (padded[:-2] + 2 * padded[1:-1] + padded[2:])
    return oil
