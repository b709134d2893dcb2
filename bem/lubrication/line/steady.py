"""Steady elastohydrodynamic film of a line contact, from rigid and isoviscous to heavily loaded."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.lubrication.cavitation import Cavitation
from bem.lubrication.checks import Case, notes_on, why_no_line_film
from bem.lubrication.flow_factors import notes_on_factors
from bem.lubrication.line.case import LineCase
from bem.lubrication.line.continuation import from_neighbour, from_newtonian, from_scratch
from bem.lubrication.line.friction import friction_forces
from bem.lubrication.line.newton import Outcome, State, is_start
from bem.lubrication.line.reynolds import Problem
from bem.lubrication.line.scales import Scales
from bem.lubrication.line.starved import Neighbour, Wanted, WantedDistance, WantedLayer, starved, through
from bem.lubrication.line.state import KeptSteady, sampled_state
from bem.lubrication.results import FilmSolution
from bem.lubrication.supply import OilLayer, Starvation, Supply, checked_supply, inside_hertz
from bem.numerics.monotone import MonotoneCubic
from bem.threads import one_blas_thread

MAX_INLET_SHARE = 0.01


@one_blas_thread
def line_film(
    case: LineCase,
    *,
    position: FloatArray | None = None,
    cavitation: Cavitation = Cavitation.SWIFT_STIEBER,
    supply: Supply | float | None = None,
) -> FilmSolution:
    """Solve an isothermal line film; a neighbour can start from the equations it keeps."""
    supply = checked_supply(supply)
    scales, reversed_ = case.scaled(position)
    problem = case.problem(scales)
    flooded = outcome = _flooded(problem, scales, case)
    starvation = None
    if supply is not None:
        wanted = _wanted(supply, problem, flooded.state, scales)
        if wanted is not None:
            near = _starved_neighbour(case.initial, scales)
            outcome = starved(problem, flooded, wanted, case.points - 1, case.tolerance, case.max_iterations, near)
        starvation = _starvation(problem, outcome.state, flooded.state, scales, reversed_)
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
    film = solution_of(outcome, flooded, case, (scales, reversed_), position)
    notes = notes_on(found) + notes_on_factors(case.flow_factors, film.minimum_thickness)
    film = replace(film, starvation=starvation, notes=notes)
    return film if cavitation is Cavitation.SWIFT_STIEBER else _with_fraction(film, outcome, scales, reversed_)


def _with_fraction(film: FilmSolution, outcome: Outcome, scales: Scales, reversed_: bool) -> FilmSolution:
    """With the share of the gap that is filled: all of it but where the film is ruptured, behind its exit and before
    its meniscus."""
    exit_film = outcome.state.film[-1] * scales.film
    along = film.position * (-1.0 if reversed_ else 1.0)
    ruptured = along > outcome.state.exit * scales.length
    if outcome.state.far_field == 0:
        ruptured |= along < outcome.state.position[0] * scales.length
    return replace(film, film_fraction=np.where(ruptured, exit_film / film.thickness, 1.0))


def _flooded(problem: Problem, scales: Scales, case: LineCase) -> Outcome:
    """From the film of another case where that will do, else from nothing."""
    cells, tolerance, limit = case.points - 1, case.tolerance, case.max_iterations
    kept = None if case.initial is None else case.initial.state
    spent = 0
    if isinstance(kept, KeptSteady) and is_start(kept.flooded):
        unit = kept.scales.pressure / scales.pressure
        outcome = from_neighbour(problem, kept.flooded, kept.load, unit, cells, tolerance, limit, kept.sketch)
        if outcome.converged:
            return outcome
        spent = outcome.iterations
    outcome = from_scratch(problem, cells, tolerance, limit)
    if problem.shear is not None and not outcome.converged:
        spent += outcome.iterations
        outcome = from_newtonian(problem, cells, tolerance, limit)
    return replace(outcome, iterations=outcome.iterations + spent)


def _starved_neighbour(initial: FilmSolution | None, scales: Scales) -> Neighbour | None:
    """The film of another case, if that is starved and a start."""
    kept = None if initial is None else initial.state
    if not isinstance(kept, KeptSteady) or kept.state.far_field == 1 or not is_start(kept.state):
        return None
    return Neighbour(kept.state, kept.load, kept.scales.pressure / scales.pressure)


def _wanted(supply: Supply, problem: Problem, flooded: State, scales: Scales) -> Wanted | None:
    """What is wanted of a film by a supply; None where that floods the contact.

    Raises
    ------
    InputError : a meniscus inside Hertz' contact.
    """
    if isinstance(supply, OilLayer):
        share = supply.thickness / scales.film / through(problem, flooded)
        return WantedLayer(problem, share) if share < 1 else None
    half_width = math.sqrt(8 * problem.load / math.pi) * scales.length
    if supply.distance <= half_width:
        raise InputError(inside_hertz(supply, half_width))
    return WantedDistance(supply.distance / scales.length)


def _starvation(problem: Problem, state: State, flooded: State, scales: Scales, reversed_: bool) -> Starvation:
    first = float(state.position[0]) * scales.length if state.far_field == 0 else -math.inf
    layers = [through(problem, one) * scales.film for one in (state, flooded)]
    central = [float(MonotoneCubic(one.position, one.film)(0.0)) for one in (state, flooded)]
    return Starvation(-first if reversed_ else first, layers[0], central[0] / central[1], layers[1])


def solution_of(
    outcome: Outcome,
    flooded: Outcome,
    case: LineCase,
    units: tuple[Scales, bool],
    position: FloatArray | None = None,
) -> FilmSolution:
    """What is said of an outcome in Moes' units, as `LineCase.scaled` gives them, with the friction of its oil at one
    temperature."""
    (scales, reversed_), speeds = units, case.speeds
    state = outcome.state
    x, film = state.position, state.film
    pressure = np.maximum(state.pressure, 0.0)
    central = float(MonotoneCubic(x, film)(0.0))
    status = Status.CONVERGED if outcome.converged else Status.STALLED
    friction = friction_forces(state, scales, speeds, reversed_, case.lubricant)
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
        p, h = sampled_state(at, state, scales)
    if reversed_:
        at, p, h = -at[::-1], p[::-1], h[::-1]
    return FilmSolution(
        position=at,
        pressure=p,
        thickness=h,
        minimum_thickness=lowest_film(x, film) * scales.film,
        central_thickness=central * scales.film,
        load=float(np.sum(0.5 * np.diff(own_x) * (own_p[1:] + own_p[:-1])) + beyond * scales.pressure * scales.length),
        shear_force=sign * friction.full,
        rolling_force=sign * friction.rolling,
        striated_shear_force=sign * friction.striated,
        exit_position=sign * state.exit * scales.length,
        inlet_load_fraction=upstream,
        iterations=outcome.iterations,
        residual=outcome.residual,
        status=status,
        speeds=(float(speeds[0]), float(speeds[1])),
        lubricant=case.lubricant,
        state=KeptSteady(state, flooded.state, scales.load, scales, reversed_),
    )


def _check_reach(at: FloatArray, state: State, scales: Scales, load: float) -> float:
    """Share of the load upstream of ascending positions [m]; refuses positions that leave out much of the film."""
    x, first = state.position, at[0] / scales.length
    total = np.concatenate([[0.0], np.cumsum(0.5 * np.diff(x) * (state.pressure[1:] + state.pressure[:-1]))])
    total += state.far_field * 4 / x[0] ** 2
    missed = state.far_field * 4 / first**2 if first < x[0] else float(np.interp(first, x, total))
    if missed > MAX_INLET_SHARE * load:
        needed = float(np.interp(0.5 * MAX_INLET_SHARE * load, total, x)) * scales.length
        raise InputError(
            f"position: starts at {at[0]:g} m (along the entrainment), where the film already carries "
            f"{100 * missed / load:.2g} % of the load; start at {needed:.3g} m or further upstream"
        )
    if at[-1] < x[-1] * scales.length:
        raise InputError(
            f"position: ends at {at[-1]:g} m (along the entrainment), before the film's exit at "
            f"{x[-1] * scales.length:.3g} m; end beyond it"
        )
    return missed / load


def lowest_film(x: FloatArray, film: FloatArray) -> float:
    """Minimum of the parabola through the lowest node and its neighbours; that node where no such film is left (of one
    that stalled)."""
    i = int(np.clip(film.argmin(), 1, len(film) - 2))
    left, right = (film[i] - film[i - 1]) / (x[i] - x[i - 1]), (film[i + 1] - film[i]) / (x[i + 1] - x[i])
    curvature = (right - left) / (x[i + 1] - x[i - 1])
    if curvature <= 0:
        return float(film.min())
    slope = left + curvature * (x[i] - x[i - 1])
    at = np.clip(-0.5 * slope / curvature, x[i - 1] - x[i], x[i + 1] - x[i])
    lowest = float(film[i] + slope * at + curvature * at * at)
    return lowest if lowest > 0 else float(film.min())
