"""From nothing to the film of a point contact: starts, nested iteration, and continuation where no start converges.

Smooth films (`solve_nested`):

1. The dry contact, lifted by the film that Nijenbanning, Venner and Moes' (1994) fit gives, on the first grid.
2. From 112 cells along the shorter side on, nested iteration: each finer grid starts from the film of the coarser one.
   Below, the first grid is the only one, as for load sharing's 64 and 96 cells.
3. Where that does not converge: continuation in the oil's viscosity, from oils that thicken less with pressure; then
   dry contacts lifted by thicker films; then starts that were given up as slow.

Films with contact (`solve_with_contact`), on the grid asked for at once:

1. The dry contact, or the lifted one where smooth bodies would not touch.
2. Among steep bumps at creeping speeds Newton's method with mass-conserving cavitation cycles: cells that are full, and
   cells that touch, change back and forth. Swift and Stieber's condition has a film within a dozen steps there, and few
   steps lead from that film to the mass-conserving one. Where no start leads to it either: continuation in the speed.
3. The starts not tried yet. The result is that of the smallest residual.

Cost: nested iteration is 4/3 of the finest grid, where 3 to 6 Newton steps are left. Verified in
tests/lubrication/point/test_point_film.py and test_rough_film.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from bem.contact import solve_contact
from bem.grid import FloatArray
from bem.lubrication.point.grid import GridLevel
from bem.lubrication.point.newton import NewtonOutcome, PointFilmState, newton
from bem.lubrication.point.problem import PointProblem
from bem.numerics.monotone import MonotoneCubic

COARSEST = 56
"""Smallest number of cells along the shorter side of the first grid."""
COARSE_TOLERANCE = 1e-6
"""Largest relative residual on grids before the last, whose films estimate the discretisation error, and of
continuation in viscosity."""
DRY_TOLERANCE, CONTACT_DRY_TOLERANCE = 1e-4, 1e-10
"""Tolerance of the dry contact that a start is made of, without and with contact in the film."""
LIFTS = (1.0, 1.5, 3.0)
"""Films of starts over the expected film, in the order in which they are tried: from thinner films the first step may
fail, from thicker ones Newton's method takes longer."""
MILDEST_OIL, OIL_STEP, LEAST_OIL_STEP = 0.2, 0.25, 0.03
"""Continuation in viscosity: factor on ln(viscosity) to begin with, first and smallest step of the factor. Where a
light load meets an oil that thickens steeply (L > 15) Newton's method cycles from films without the pressure ridge."""
RUPTURE_SLOPE = 0.5
"""x over |y| up to which a start has pressure: the true edge of rupture is found faster from outside."""
LEAST_PRESSURE = 1e-12
"""Smallest ratio of a positive pressure of a start to the largest one."""
CONTACT_LIFTS = (1.0, 2.0)
"""`LIFTS` of films with contact."""
OTHER_SPEEDS = (8.0, 1 / 64, 64.0)
"""Speeds over the one asked for at which continuation begins: thick films, or dry contact."""
SPEED_STEP, SPEED_GROWTH, LEAST_SPEED_STEP = 0.25, 1.5, 0.06
"""Continuation in speed: first step of the power of the speed, growth after each success, smallest step."""
FIRST_STEPS, CONTACT_STEPS = 16, 40
"""Newton steps from a start while others are left, and from the film with Swift and Stieber's condition."""
CONTACT_COARSE_TOLERANCE = 1e-5
"""Largest relative residual of films with contact that only start others."""


@dataclass(frozen=True)
class NestedSolution:
    """Result of nested iteration.

    level, outcome : the last grid and its outcome; steps and cycles are those of all grids.
    coarse : the grid before it and its state; None if that grid has no film.
    convolutions : of all grids, weighted by their cells over those of the last grid.
    """

    level: GridLevel
    outcome: NewtonOutcome
    coarse: tuple[GridLevel, PointFilmState] | None
    convolutions: float


def lifted_dry_contact(level: GridLevel, lift: float = 1.0) -> PointFilmState:
    """Return the dry contact, lifted by `lift` times the expected film, with the far pressure around it."""
    problem = level.problem
    expected = lift * problem.typical_film
    film = level.gap + expected
    dry = np.zeros(level.shape)
    size = 0.0
    if level.elastic_operator is not None:
        operator, factor = level.elastic_operator
        load = problem.load * operator.grid.cell_area / level.cell_area
        contact = solve_contact(level.gap / factor, operator, load=load, tolerance=DRY_TOLERANCE)
        dry = contact.pressure
        film = np.maximum(contact.gap, 0.0) * factor + expected
        size = 2 * float(contact.approach) * factor
    # between bodies that are pressed flat the far pressure alone is far too large
    far = level.far_source(0.0) / (film + size) ** 2
    entrainment, x, y = problem.entrainment, level.x[:, None], level.y[None, :]
    full = entrainment[0] * x + entrainment[1] * y < RUPTURE_SLOPE * np.abs(entrainment[0] * y - entrainment[1] * x)
    far = np.where(full, np.maximum(far, LEAST_PRESSURE * max(far.max(), dry.max())), 0.0)
    pressure = np.where(dry > 0, dry, far)
    pressure *= problem.load / (float(pressure.sum()) * level.cell_area)
    separation = film - level.gap - level.deflection(pressure)
    inside = pressure >= 0.5 * pressure.max()
    return PointFilmState.of_oil(pressure, film, float(np.median(separation[inside])))


def interpolate(level: GridLevel, coarse: GridLevel, state: PointFilmState) -> PointFilmState:
    """Return a state on another grid of the same rectangle, by monotone cubics of pressure and of film over gap."""

    def on(values: FloatArray) -> FloatArray:
        along = MonotoneCubic(coarse.x, values)(np.clip(level.x, coarse.x[0], coarse.x[-1]))
        across = MonotoneCubic(coarse.y, along.T)(np.clip(level.y, coarse.y[0], coarse.y[-1]))
        return np.ascontiguousarray(across.T)

    lift = float(state.film.min())
    film = np.exp(on(np.log(state.film / (coarse.gap + lift)))) * (level.gap + lift)
    return PointFilmState.of_oil(np.maximum(on(state.pressure), 0.0), film, state.separation)


def grid_shapes(shape: tuple[int, int]) -> list[tuple[int, int]]:
    """Return the shapes of nested iteration, from coarse to this one, each twice as fine."""
    shapes = [shape]
    while min(shapes[0]) // 2 >= COARSEST:
        shapes.insert(0, (-(-shapes[0][0] // 2), -(-shapes[0][1] // 2)))
    return shapes


def solve_nested(problem: PointProblem, shape: tuple[int, int], tolerance: float, most: int) -> NestedSolution:
    """Solve a problem on a grid of this shape by nested iteration.

    tolerance : largest relative residual on the last grid. most : Newton steps from one start on one grid.
    """
    coarse: tuple[GridLevel, PointFilmState] | None = None
    outcome: NewtonOutcome | None = None
    steps = cycles = 0
    work = 0.0
    for one in grid_shapes(shape):
        level, before, coarse = GridLevel(problem, one), coarse, None
        outcome = _solve_on_grid(level, before, tolerance if one == shape else COARSE_TOLERANCE, most)
        steps, cycles = steps + outcome.steps, cycles + outcome.cycles
        if outcome.converged:
            coarse = (level, outcome.state)
        work += level.convolutions * one[0] * one[1]
    assert outcome is not None
    final = replace(outcome, steps=steps, cycles=cycles)
    return NestedSolution(level, final, before, work / (shape[0] * shape[1]))


def add_effort(outcome: NewtonOutcome, *earlier: NewtonOutcome) -> NewtonOutcome:
    """Return an outcome with the steps and cycles of earlier ones added to its own."""
    steps, cycles = (sum(getattr(one, name) for one in (outcome, *earlier)) for name in ("steps", "cycles"))
    return replace(outcome, steps=steps, cycles=cycles)


def _solve_on_grid(
    level: GridLevel, before: tuple[GridLevel, PointFilmState] | None, tolerance: float, most: int
) -> NewtonOutcome:
    """Solve on one grid from the first start that converges; steps and cycles are those of all starts.

    A start that is slow is given up, and taken up again where no other start converges either.
    """
    first, *lifted = [partial(lifted_dry_contact, level, lift) for lift in LIFTS]
    nearest = [first] if before is None else [partial(interpolate, level, *before), first]
    outcome = _solve_from_first(level, nearest, tolerance, most)
    others: list[Callable[..., NewtonOutcome]] = [partial(_solve_from_first, starts=lifted)]
    if level.problem.oil(np.ones(1))[0, 0] != 0.0:  # continuation needs an oil that thickens with pressure
        others.insert(0, _continue_in_viscosity)
    others.append(partial(_solve_from_first, starts=[*nearest, *lifted], give_up_if_slow=False))
    slow = False
    for other in others:
        slow = slow or outcome.slow
        if outcome.converged or (other is others[-1] and not slow):
            break
        outcome = add_effort(other(level, tolerance=tolerance, most=most), outcome)
    return outcome


def _solve_from_first(
    level: GridLevel,
    starts: Sequence[Callable[[], PointFilmState]],
    tolerance: float,
    most: int,
    *,
    give_up_if_slow: bool = True,
) -> NewtonOutcome:
    """Solve from the first of some starts that converges, else return the outcome of the last one."""
    steps, cycles, slow = 0, 0, False
    for start in starts:
        outcome = newton(level, start(), tolerance, most, give_up_if_slow=give_up_if_slow)
        steps, cycles, slow = steps + outcome.steps, cycles + outcome.cycles, slow or outcome.slow
        if outcome.converged:
            break
    return replace(outcome, steps=steps, cycles=cycles, slow=slow)


def continue_to_end(
    solve_at: Callable[[float, PointFilmState | None], NewtonOutcome],
    first: float,
    step: float,
    least_step: float,
    *,
    start: PointFilmState | None = None,
    growth: float = 1.0,
) -> NewtonOutcome:
    """Solve a family of problems of a parameter t up to t = 1, each from the state before; halve the step on failure.

    Parameters
    ----------
    solve_at : outcome at t from a state.
    first : first t.
    step : step after the first success; after each further one `growth` times the last.
    least_step : step below which to give up.
    growth : of the step from one success to the next.
    start : state at t = 0; without it a failure at the first t ends the continuation.

    Returns
    -------
    Outcome at the last t tried, with steps and cycles of all, converged only at t = 1.
    """
    t, reached, state, spent = first, 0.0 if start is not None else None, start, list[NewtonOutcome]()
    while True:
        outcome = solve_at(t, state)
        spent.append(outcome)
        if outcome.converged:
            if t >= 1.0:
                break
            step *= growth if reached is not None else 1.0
            reached, state = t, outcome.state
        else:
            step *= 0.5
            if reached is None or step < least_step:
                break
        t = min(reached + step, 1.0)
    return replace(add_effort(outcome, *spent[:-1]), converged=outcome.converged)


def _continue_in_viscosity(level: GridLevel, tolerance: float, most: int) -> NewtonOutcome:
    """Solve by continuation from an oil that thickens less with pressure."""

    def solve_at(factor: float, state: PointFilmState | None) -> NewtonOutcome:
        at = level if factor >= 1.0 else GridLevel(_with_milder_oil(level.problem, factor), level.shape)
        starts = [partial(lifted_dry_contact, at, lift) for lift in LIFTS] if state is None else [lambda: state]
        return _solve_from_first(at, starts, tolerance if factor >= 1.0 else COARSE_TOLERANCE, most)

    return continue_to_end(solve_at, MILDEST_OIL, OIL_STEP, LEAST_OIL_STEP)


def _with_milder_oil(problem: PointProblem, factor: float) -> PointProblem:
    """Return the problem with an oil of a factor on ln(viscosity); films go with the root of the factor, about."""
    film = problem.typical_film * factor**0.5
    return replace(problem, oil=partial(_milder_oil, problem.oil, factor), typical_film=film)


def _milder_oil(oil: Callable[[FloatArray], FloatArray], factor: float, pressure: FloatArray) -> FloatArray:
    """Return the properties of an oil with a factor on ln(viscosity)."""
    return oil(pressure) * np.array([factor, factor, 1.0, 1.0]).reshape(4, *(1,) * np.ndim(pressure))


# ---- films with contact


def solve_with_contact(level: GridLevel, tolerance: float) -> NewtonOutcome:
    """Solve a problem with contact on a grid; without convergence the outcome is that of the smallest residual.

    Steps and cycles are those of all starts.
    """
    problem = level.problem
    assert problem.least_film is not None
    all_outcomes: list[NewtonOutcome] = []
    outcomes: list[NewtonOutcome] = []  # of the problem itself

    def solve(one: PointProblem, start: PointFilmState, tolerance: float, most: int) -> NewtonOutcome:
        own = one is problem
        outcome = newton(level if own else GridLevel(one, level.shape), start, tolerance, most)
        all_outcomes.append(outcome)
        if own:
            outcomes.append(outcome)
        return outcome

    # dry contact is the likelier start where smooth bodies would touch, too
    touching = problem.typical_film < problem.least_film
    first = _dry_contact(level) if touching else _lifted_start(level, CONTACT_LIFTS[0])
    if not solve(problem, first, tolerance, FIRST_STEPS).converged:
        _solve_from_other_starts(level, tolerance, solve)
    best = min(outcomes, key=lambda one: (not one.converged, math.inf if math.isnan(one.residual) else one.residual))
    return replace(best, steps=sum(one.steps for one in all_outcomes), cycles=sum(one.cycles for one in all_outcomes))


Solve = Callable[[PointProblem, PointFilmState, float, int], NewtonOutcome]
"""Solution of a problem from a start to a tolerance in a number of steps."""


def _solve_from_other_starts(level: GridLevel, tolerance: float, solve: Solve) -> None:
    """Try the film with Swift and Stieber's condition, from any start or by continuation in speed, then all starts."""
    problem = level.problem
    assert problem.least_film is not None
    swift_stieber = replace(problem, layer=None)
    dry, *lifted = _dry_contact(level), *(_lifted_start(level, lift) for lift in CONTACT_LIFTS)
    starts = [dry, *lifted] if problem.typical_film < problem.least_film else [*lifted, dry]
    found: NewtonOutcome | None = None
    for start in starts:
        outcome = solve(swift_stieber, start, CONTACT_COARSE_TOLERANCE, CONTACT_STEPS)
        if outcome.converged:
            found = outcome
            break
    for speed in OTHER_SPEEDS:
        if found is None:
            outcome = _continue_in_speed(swift_stieber, speed, dry if speed < 1 else lifted[-1], solve)
            found = outcome if outcome.converged else None
    if found is not None and solve(problem, found.state, tolerance, CONTACT_STEPS).converged:
        return
    for start in starts:
        if solve(problem, start, tolerance, CONTACT_STEPS).converged:
            return


def _continue_in_speed(problem: PointProblem, speed: float, start: PointFilmState, solve: Solve) -> NewtonOutcome:
    """Solve by continuation from another speed, relative to the one asked for."""

    def solve_at(t: float, state: PointFilmState | None) -> NewtonOutcome:
        factor = speed ** (1 - t)
        entrainment = (factor * problem.entrainment[0], factor * problem.entrainment[1])
        there = replace(problem, entrainment=entrainment)
        return solve(there, state or start, CONTACT_COARSE_TOLERANCE, FIRST_STEPS)

    return continue_to_end(solve_at, 0.0, SPEED_STEP, LEAST_SPEED_STEP, growth=SPEED_GROWTH)


def _dry_contact(level: GridLevel) -> PointFilmState:
    """Return the dry contact at the least film, without oil pressure."""
    assert level.elastic_operator is not None
    assert level.problem.least_film is not None
    least, (operator, factor) = level.problem.least_film, level.elastic_operator
    load = level.problem.load * operator.grid.cell_area / level.cell_area
    contact = solve_contact(level.gap / factor, operator, load=load, tolerance=CONTACT_DRY_TOLERANCE)
    touching = (contact.pressure > 0) & ~level.boundary
    pressure = np.where(touching, contact.pressure, 0.0)
    film = np.where(touching, least, np.maximum(contact.gap * factor, 0.0) + least)
    separation = least - float(contact.approach) * factor
    return PointFilmState(pressure, film, separation, 0 * pressure, touching)


def _lifted_start(level: GridLevel, lift: float) -> PointFilmState:
    """Return the lifted dry contact with films above the least one."""
    start = lifted_dry_contact(level, lift)
    assert level.problem.least_film is not None
    return replace(start, film=np.maximum(start.film, 1.01 * level.problem.least_film))
