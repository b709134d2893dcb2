"""Steady elastohydrodynamic film of a line contact, from rigid and isoviscous to heavily loaded, without heat.

1. Solve the flooded film, from a neighbour or from scratch (`continuation`).
2. With a supply, solve the starved film (`starved`).
3. Build the result: units, friction, sampling at given positions, notes.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.lubrication.cavitation import Cavitation
from bem.lubrication.checks import Case, notes_on, why_no_line_film
from bem.lubrication.flow_factors import notes_on_factors
from bem.lubrication.line.case import LineCase
from bem.lubrication.line.continuation import (
    Neighbour,
    continue_in_shear_law,
    solve_coarse,
    solve_from_martin,
    solve_from_neighbour,
)
from bem.lubrication.line.friction import film_friction
from bem.lubrication.line.newton import LineState, Outcome, is_usable_start
from bem.lubrication.line.problem import Problem, Scales
from bem.lubrication.line.state import FilmState, sample_state
from bem.lubrication.results import FilmSolution
from bem.lubrication.supply import Supply, checked_supply
from bem.numerics.monotone import MonotoneCubic
from bem.threads import one_blas_thread

MAX_INLET_SHARE = 0.01
"""Largest share of the load upstream of the positions at which a film is asked for."""


@one_blas_thread
def line_film(
    case: LineCase,
    *,
    position: FloatArray | None = None,
    cavitation: Cavitation = Cavitation.SWIFT_STIEBER,
    supply: Supply | float | None = None,
) -> FilmSolution:
    """Solve an isothermal line film; the result keeps its factored equations for a similar film.

    position : ascending abscissae [m] at which to return the film; the mesh by default.
    """
    supply = checked_supply(supply)
    scales, reversed_ = case.scaled(position)
    problem = case.problem(scales)
    flooded = outcome = _flooded(problem, scales, case)
    starvation = None
    if supply is not None:
        # starved films are loaded where there is a supply
        from bem.lubrication.line.starved import solve_starved, starvation_of, supply_condition

        condition = supply_condition(supply, problem, flooded.state, scales)
        if condition is not None:
            near = _starved_neighbour(case.initial, scales)
            effort = case.points - 1, case.tolerance, case.max_iterations
            outcome = solve_starved(problem, flooded, condition, *effort, near)
        starvation = starvation_of(problem, outcome.state, flooded.state, scales, reversed_)
    found = Case(
        position=outcome.state.position * scales.length,
        pressure=np.maximum(outcome.state.pressure, 0.0) * scales.pressure,
        thickness=outcome.state.film * scales.film,
        speeds=(float(case.speeds[0]), float(case.speeds[1])),
        lubricant=case.lubricant,
        radius=case.radius,
        contact_modulus=case.contact_modulus,
        reduction=1.0 if starvation is None else starvation.reduction,
        not_found=None
        if outcome.converged
        else why_no_line_film(case.lubricant, case.load, case.radius, case.contact_modulus),
    )
    film = build_solution(outcome, flooded, case, (scales, reversed_), position)
    notes = notes_on(found) + notes_on_factors(case.flow_factors, film.minimum_thickness)
    film = replace(film, starvation=starvation, notes=notes)
    return film if cavitation is Cavitation.SWIFT_STIEBER else _with_fraction(film, outcome.state, scales, reversed_)


def solve_coarse_film(case: LineCase) -> FilmSolution:
    """Solve the flooded film of a case on a coarse mesh, whatever its points and tolerance.

    `initial` of the case may be a coarse or any other film. Raises as `solve_line_film`.
    """
    units = case.scaled()
    problem = case.problem(units[0])
    initial_state = None if case.initial is None else case.initial.state
    usable = isinstance(initial_state, FilmState) and is_usable_start(initial_state.flooded)
    near = initial_state.flooded_neighbour(units[0]) if isinstance(initial_state, FilmState) and usable else None
    outcome = solve_coarse(problem, near, case.max_iterations)
    film = build_solution(outcome, outcome, case, units)
    assert isinstance(film.state, FilmState)
    return replace(film, state=replace(film.state, coarse=True))


def film_at_positions(film: FilmSolution, position: FloatArray, *, may_reach_beyond: bool = False) -> FilmSolution:
    """Return a steady film at other positions, interpolated from its state.

    The product of stress in the middle of the film and thickness is interpolated: it is about constant upstream of the
    mesh.

    Parameters
    ----------
    film : solution with its state.
    position : (n,) ascending abscissae [m].
    may_reach_beyond : whether much of the film may lie beyond the positions.

    Raises
    ------
    InputError : the film reaches beyond the positions, unless it may.
    """
    own = film.state
    assert isinstance(own, FilmState)
    at = -position[::-1] if own.reversed else position
    upstream = _share_upstream(at, own.state, own.scales, own.load)
    if not may_reach_beyond:
        _check_reach(at, own.state, own.scales, own.load)
    pressure, thickness = film.at(position)
    stress = film.sliding_stress
    if stress is not None:
        stress = np.interp(position, film.position, stress * film.thickness) / thickness
    moved = replace(
        film,
        position=position,
        pressure=pressure,
        thickness=thickness,
        sliding_stress=stress,
        inlet_load_fraction=upstream,
    )
    return moved if film.film_fraction is None else _with_fraction(moved, own.state, own.scales, own.reversed)


def _with_fraction(film: FilmSolution, state: LineState, scales: Scales, reversed_: bool) -> FilmSolution:
    """Return the film with the filled fraction of the gap: below one behind the exit and before a meniscus."""
    exit_film = state.film[-1] * scales.film
    along = film.position * (-1.0 if reversed_ else 1.0)
    ruptured = along > state.exit * scales.length
    if state.far_field == 0:
        ruptured |= along < state.position[0] * scales.length
    return replace(film, film_fraction=np.where(ruptured, exit_film / film.thickness, 1.0))


def _flooded(problem: Problem, scales: Scales, case: LineCase) -> Outcome:
    """Solve the flooded film: from the film of another case if there is one, else or on failure from scratch."""
    cells, tolerance, limit = case.points - 1, case.tolerance, case.max_iterations
    initial_state = None if case.initial is None else case.initial.state
    spent = 0
    if isinstance(initial_state, FilmState) and is_usable_start(initial_state.flooded):
        outcome = solve_from_neighbour(problem, initial_state.flooded_neighbour(scales), cells, tolerance, limit)
        if outcome.converged:
            return outcome
        spent = outcome.iterations
    outcome = solve_from_martin(problem, cells, tolerance, limit)
    if problem.shear is not None and not outcome.converged:
        spent += outcome.iterations
        outcome = continue_in_shear_law(problem, cells, tolerance, limit)
    return replace(outcome, iterations=outcome.iterations + spent)


def _starved_neighbour(initial: FilmSolution | None, scales: Scales) -> Neighbour | None:
    """Return the starved film of another case as a start; None if there is none."""
    initial_state = None if initial is None else initial.state
    if (
        not isinstance(initial_state, FilmState)
        or initial_state.state.far_field == 1
        or not is_usable_start(initial_state.state)
    ):
        return None
    return initial_state.neighbour(scales)


def build_solution(
    outcome: Outcome,
    flooded: Outcome,
    case: LineCase,
    units: tuple[Scales, bool],
    position: FloatArray | None = None,
) -> FilmSolution:
    """Return the result of an outcome in Moes' units, with the isothermal friction of its oil.

    units : as `LineCase.scaled` returns them.
    """
    (scales, reversed_), speeds = units, case.speeds
    state = outcome.state
    x, film = state.position, state.film
    pressure = np.maximum(state.pressure, 0.0)
    central = float(MonotoneCubic(x, film)(0.0))
    status = Status.CONVERGED if outcome.converged else Status.STALLED
    friction = film_friction(state, scales, speeds, reversed_, case.lubricant)
    sign = -1.0 if reversed_ else 1.0

    own_x = x * scales.length
    own_p = pressure * scales.pressure
    own_h = film * scales.film
    beyond = state.far_field * 4 / x[0] ** 2
    upstream = beyond / scales.load
    if position is None:
        at, p, h = own_x, own_p, own_h
    else:
        at = np.asarray(position, dtype=np.float64)
        at = sign * at if sign > 0 else -at[::-1]
        upstream = _check_reach(at, state, scales, scales.load)
        p, h = sample_state(at, state, scales)
    if reversed_:
        at, p, h = -at[::-1], p[::-1], h[::-1]
    return FilmSolution(
        position=at,
        pressure=p,
        thickness=h,
        minimum_thickness=parabolic_minimum(x, film) * scales.film,
        central_thickness=central * scales.film,
        load=float(np.sum(0.5 * np.diff(own_x) * (own_p[1:] + own_p[:-1])) + beyond * scales.pressure * scales.length),
        shear_force=sign * friction.full,
        rolling_force=sign * friction.rolling,
        exit_position=sign * state.exit * scales.length,
        inlet_load_fraction=upstream,
        iterations=outcome.iterations,
        residual=outcome.residual,
        status=status,
        speeds=(float(speeds[0]), float(speeds[1])),
        lubricant=case.lubricant,
        state=FilmState(state, flooded.state, scales.load, scales, reversed_),
    )


def _check_reach(at: FloatArray, state: LineState, scales: Scales, load: float) -> float:
    """Return the share of the load upstream of ascending positions [m]; refuse positions that miss much of the film."""
    x, missing = state.position, _share_upstream(at, state, scales, load)
    if missing > MAX_INLET_SHARE:
        needed = float(np.interp(0.5 * MAX_INLET_SHARE * load, _load_upstream(state), x)) * scales.length
        raise InputError(
            f"position: starts at {at[0]:g} m (along the entrainment), where the film already carries "
            f"{100 * missing:.2g} % of the load; start at {needed:.3g} m or further upstream"
        )
    if at[-1] < x[-1] * scales.length:
        raise InputError(
            f"position: ends at {at[-1]:g} m (along the entrainment), before the film's exit at "
            f"{x[-1] * scales.length:.3g} m; end beyond it"
        )
    return missing


def _share_upstream(at: FloatArray, state: LineState, scales: Scales, load: float) -> float:
    """Return the share of the load M upstream of the first of ascending positions [m]."""
    x, first = state.position, at[0] / scales.length
    carried = state.far_field * 4 / first**2 if first < x[0] else float(np.interp(first, x, _load_upstream(state)))
    return carried / load


def _load_upstream(state: LineState) -> FloatArray:
    """Return the load upstream of each node (n,), in Moes' units."""
    x = state.position
    total = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(x) * (state.pressure[1:] + state.pressure[:-1]))])
    return np.asarray(total + state.far_field * 4 / x[0] ** 2)


def parabolic_minimum(x: FloatArray, film: FloatArray) -> float:
    """Return the minimum of the parabola through the lowest node and its neighbours; the node itself where the parabola
    has no positive minimum."""
    i = int(np.clip(film.argmin(), 1, len(film) - 2))
    left, right = (film[i] - film[i - 1]) / (x[i] - x[i - 1]), (film[i + 1] - film[i]) / (x[i + 1] - x[i])
    curvature = (right - left) / (x[i + 1] - x[i - 1])
    if curvature <= 0:
        return float(film.min())
    slope = left + curvature * (x[i] - x[i - 1])
    at = np.clip(-0.5 * slope / curvature, x[i - 1] - x[i], x[i + 1] - x[i])
    lowest = float(film[i] + slope * at + curvature * at * at)
    return lowest if lowest > 0 else float(film.min())
