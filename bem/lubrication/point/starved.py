"""Starved films of a point contact: the gap is full where an even layer of oil and the backflow fill it.

With mass-conserving cavitation everywhere (`cavitation`) the position of the meniscus follows with the pressure:

1. Solve the flooded film (`start.solve_nested`).
2. Starting from it, solve with the layer on the coarser grid, then on the grid asked for.
3. Where that fails: continuation in the logarithm of the layer, from the oil that goes through the flooded contact.
4. Where that fails, too: a smaller rectangle, of the size that the layer's own film needs, from the dry contact. Light
   contacts whose flooded film is a hundred layers thick and more (M 0.2 to 2, 48 cells a side) need it.

Cost: twice to three times that of the flooded film. Verified in tests/lubrication/point/test_point_supply.py.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.point.certificate import central_film
from bem.lubrication.point.grid import GridLevel
from bem.lubrication.point.newton import NewtonOutcome, PointFilmState, fill_partially, newton
from bem.lubrication.point.problem import Elasticity, ScaledCase, default_rectangle
from bem.lubrication.point.start import (
    COARSE_TOLERANCE,
    NestedSolution,
    add_effort,
    continue_to_end,
    interpolate,
    solve_nested,
)
from bem.lubrication.supply import OilLayer, Starvation

LEAST_STEP = 1 / 8
"""Smallest step of the continuation, over the way from the flooded film in the logarithm of the layer."""
SAMPLES = 8
"""Samples a cell along the line on which the meniscus is looked for."""


def solve_starved(
    case: ScaledCase, flooded: NestedSolution, layer: OilLayer, tolerance: float, most: int, *, free: bool = False
) -> tuple[ScaledCase, NestedSolution]:
    """Solve the film with a layer, starting from the flooded film.

    Returns the flooded film where the layer is thicker than the gap somewhere on the inlet's outermost cells: the
    rectangle does not hold the meniscus.

    Parameters
    ----------
    case, flooded : the flooded case and its film.
    layer : the supply.
    tolerance, most : largest relative residual; Newton steps from one start on one grid.
    free : whether the rectangle may be another one.
    """
    thickness = layer.thickness / case.scales.film
    level, state = flooded.level, flooded.outcome.state
    inlet = level.far_source(state.separation) > 0
    if not flooded.outcome.converged or thickness >= state.film[level.boundary & inlet].min():
        return case, flooded
    problem = replace(case.problem, layer=thickness)
    own = GridLevel(problem, level.shape)
    coarse: tuple[GridLevel, PointFilmState] | None = None
    spent, work = [flooded.outcome], flooded.convolutions
    if flooded.coarse is not None:
        before = GridLevel(problem, flooded.coarse[0].shape)
        first = _continue_in_layer(before, flooded.coarse[1], thickness, COARSE_TOLERANCE, most)
        spent.append(first)
        work += before.convolutions * np.prod(before.shape) / np.prod(own.shape)
        coarse = (before, first.state) if first.converged else None
    outcome = None if coarse is None else newton(own, interpolate(own, *coarse), tolerance, most)
    if outcome is None or not outcome.converged:
        spent += [] if outcome is None else [outcome]
        outcome = _continue_in_layer(own, state, thickness, tolerance, most)
    work += own.convolutions
    if not outcome.converged and free and case.hertz is not None:
        smaller = _on_smaller_rectangle(case, thickness)
        nested = solve_nested(smaller.problem, level.shape, tolerance, most)
        if nested.outcome.converged:
            total = add_effort(nested.outcome, outcome, *spent)
            return smaller, replace(nested, outcome=total, convolutions=work + nested.convolutions)
    return replace(case, problem=problem), NestedSolution(own, add_effort(outcome, *spent), coarse, work)


def _on_smaller_rectangle(case: ScaledCase, layer: float) -> ScaledCase:
    """Return the case with a layer on the default rectangle of a film as thick as the layer."""
    problem = case.problem
    rectangle = default_rectangle(case.hertz, case.scales.ratio, layer, problem.entrainment)
    assert isinstance(problem.operator, Elasticity)
    operator = replace(problem.operator, rectangle=rectangle)
    smaller = replace(problem, rectangle=rectangle, operator=operator, typical_film=layer, layer=layer)
    return replace(case, problem=smaller)


def _continue_in_layer(
    level: GridLevel, flooded: PointFilmState, layer: float, tolerance: float, most: int
) -> NewtonOutcome:
    """Solve with a layer by continuation in its logarithm from the flooded film; the whole way first."""
    problem = level.problem
    first, last = math.log(max(throughput(level, flooded), layer)), math.log(layer)

    def solve_at(t: float, state: PointFilmState | None) -> NewtonOutcome:
        there = replace(problem, layer=layer if t >= 1.0 else math.exp(first + t * (last - first)))
        return newton(GridLevel(there, level.shape), state or flooded, tolerance, most)

    return continue_to_end(solve_at, 1.0, 1.0, LEAST_STEP, start=flooded)


def throughput(level: GridLevel, state: PointFilmState) -> float:
    """Return the oil that goes through the centre, rho h, as a layer."""
    return central_film(level, level.problem.oil(state.pressure)[2] * state.film)


def starvation(case: ScaledCase, film: NestedSolution, flooded: NestedSolution) -> Starvation:
    """Return meniscus, oil layer and reduction of a starved film against the flooded film."""
    if not flooded.outcome.converged:
        return Starvation(math.nan, math.nan, math.nan, math.nan)
    unit, state, full = case.scales.film, film.outcome.state, flooded.outcome.state
    return Starvation(
        meniscus_position=-math.inf if case.problem.layer is None else -_inlet_length(case, film),
        layer=throughput(film.level, state) * unit,
        reduction=central_film(film.level, state.film) / central_film(flooded.level, full.film),
        flooded_layer=throughput(flooded.level, full) * unit,
    )


def _inlet_length(case: ScaledCase, film: NestedSolution) -> float:
    """Return the distance upstream of the origin over which the gap is full [m]; cells filled in part count in part."""
    level, state, problem = film.level, film.outcome.state, case.problem
    assert problem.layer is not None
    oil_mass = problem.oil(state.pressure)[2] * state.film
    content = fill_partially(level, state.pressure, *level.flux(state.pressure, state.film))[1]
    room = oil_mass - problem.layer
    filled: FloatArray = np.where(state.pressure > 0, 1.0, (content - problem.layer) / np.where(room > 0, room, np.inf))
    dx, dy = level.spacing
    step, speed = min(dx, dy) / SAMPLES, math.hypot(*problem.entrainment)
    s = step * (np.arange(SAMPLES * sum(level.shape)) + 0.5)
    i = np.floor((-s * problem.entrainment[0] / speed - problem.rectangle[0]) / dx).astype(int)
    j = np.floor((-s * problem.entrainment[1] / speed - problem.rectangle[2]) / dy).astype(int)
    inside = (i >= 0) & (j >= 0)
    along = filled[i[inside], j[inside]]
    ends = np.flatnonzero(along < 1e-6)
    return float(along[: ends[0] if ends.size else None].clip(0, 1).sum()) * step * case.scales.length
