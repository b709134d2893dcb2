"""From nothing to the film of a point contact: the dry contact lifted by a film on a coarse grid, then finer ones."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from bem.contact import solve_contact
from bem.grid import FloatArray
from bem.lubrication.point.levels import Level, PointProblem
from bem.lubrication.point.newton import Outcome, State, newton
from bem.numerics.monotone import MonotoneCubic

COARSEST = 56
"""Cells along the shorter side of the first grid, at least."""
ON_THE_WAY = 1e-6
"""Largest relative error on the grids before the last: their films are compared with the last one's."""
DRY = 1e-4
"""Tolerance of the dry contact."""
LIFTS = (1.0, 1.5, 3.0)
"""Films to start with over those expected, in the order in which they are tried: from thinner ones than there are the
first step may lead nowhere, from thicker ones it takes longer."""
MILDEST, BY, LEAST_BY = 0.2, 0.25, 0.03
"""Where no film was found from the dry contact, one is led there through oils that thicken less: the share of
ln(viscosity) to begin with, by how much more it is tried to go on, and the least of that. Where a light load meets an
oil that thickens steeply (L > 15) Newton's method goes round in circles from films without its ridge."""
RUPTURE = 0.5
"""x over |y| up to which a start has pressure: the true edge is found faster from outside."""
LEAST_PRESSURE = 1e-12
"""Of the largest, where there is to be some."""


@dataclass(frozen=True)
class Reached:
    """The last grid with its outcome, and the one before where that converged, too. convolutions : of all grids,
    weighed by their cells over the last one's."""

    level: Level
    outcome: Outcome
    coarse: tuple[Level, State] | None
    convolutions: float


def from_dry(level: Level, lift: float = 1.0) -> State:
    """The dry contact with a film in it, so many times as thick as expected, and the far pressure around."""
    problem = level.problem
    expected = lift * problem.typical_film
    film = level.gap + expected
    dry = np.zeros(level.shape)
    size = 0.0
    if level.kernel is not None:
        operator, factor = level.kernel
        load = problem.load * operator.grid.cell_area / level.cell
        contact = solve_contact(level.gap / factor, operator, load=load, tolerance=DRY)
        dry = contact.pressure
        film = np.maximum(contact.gap, 0.0) * factor + expected
        size = 2 * float(contact.approach) * factor
    # between bodies that are pressed flat it would be far too much
    far = level.far_source(0.0) / (film + size) ** 2
    drag, x, y = problem.drag, level.x[:, None], level.y[None, :]
    full = drag[0] * x + drag[1] * y < RUPTURE * np.abs(drag[0] * y - drag[1] * x)
    far = np.where(full, np.maximum(far, LEAST_PRESSURE * max(far.max(), dry.max())), 0.0)
    pressure = np.where(dry > 0, dry, far)
    pressure *= problem.load / (float(pressure.sum()) * level.cell)
    apart = film - level.gap - level.deflection(pressure)
    inside = pressure >= 0.5 * pressure.max()
    return State(pressure, film, float(np.median(apart[inside])))


def interpolated(level: Level, coarse: Level, state: State) -> State:
    """The state of another grid of the same rectangle."""

    def on(values: FloatArray) -> FloatArray:
        along = MonotoneCubic(coarse.x, values)(np.clip(level.x, coarse.x[0], coarse.x[-1]))
        across = MonotoneCubic(coarse.y, along.T)(np.clip(level.y, coarse.y[0], coarse.y[-1]))
        return np.ascontiguousarray(across.T)

    lift = float(state.film.min())
    film = np.exp(on(np.log(state.film / (coarse.gap + lift)))) * (level.gap + lift)
    return State(np.maximum(on(state.pressure), 0.0), film, state.datum)


def shapes_up_to(shape: tuple[int, int]) -> list[tuple[int, int]]:
    """Shapes from a coarse one to this one, each twice as fine."""
    shapes = [shape]
    while min(shapes[0]) // 2 >= COARSEST:
        shapes.insert(0, (-(-shapes[0][0] // 2), -(-shapes[0][1] // 2)))
    return shapes


def solved(problem: PointProblem, shape: tuple[int, int], tolerance: float, most: int) -> Reached:
    """The film on a grid of this shape."""
    coarse: tuple[Level, State] | None = None
    outcome: Outcome | None = None
    steps = cycles = 0
    work = 0.0
    for one in shapes_up_to(shape):
        level, before, coarse = Level(problem, one), coarse, None
        goal = tolerance if one == shape else ON_THE_WAY
        outcome = _found(level, before, goal, most)
        steps, cycles = steps + outcome.steps, cycles + outcome.cycles
        if outcome.converged:
            coarse = (level, outcome.state)
        work += level.convolutions * one[0] * one[1]
    assert outcome is not None
    final = replace(outcome, steps=steps, cycles=cycles)
    return Reached(level, final, before, work / (shape[0] * shape[1]))


def _found(level: Level, before: tuple[Level, State] | None, goal: float, most: int) -> Outcome:
    """The film from the first start from which there is one, else what the last left; steps and cycles are of all.

    A start whose errors hardly fall is left for the others, and gone on with where they find nothing either."""
    first, *lifted = [partial(from_dry, level, lift) for lift in LIFTS]
    nearest = [first] if before is None else [partial(interpolated, level, *before), first]
    outcome = _first_found(level, nearest, goal, most)
    others: list[Callable[..., Outcome]] = [partial(_first_found, starts=lifted)]
    if level.problem.oil(np.ones(1))[0, 0] != 0.0:  # an isoviscous oil has none that is milder
        others.insert(0, _by_way_of_milder_oils)
    others.append(partial(_first_found, starts=[*nearest, *lifted], creeping=True))
    crept = False
    for more in others:
        crept = crept or outcome.crept
        if outcome.converged or (more is others[-1] and not crept):
            break
        following = more(level, goal=goal, most=most)
        spent = (outcome.steps + following.steps, outcome.cycles + following.cycles)
        outcome = replace(following, steps=spent[0], cycles=spent[1])
    return outcome


def _first_found(
    level: Level, starts: Sequence[Callable[[], State]], goal: float, most: int, *, creeping: bool = False
) -> Outcome:
    """The film from the first of some starts from which there is one, else what the last left."""
    steps, cycles, crept = 0, 0, False
    for start in starts:
        outcome = newton(level, start(), goal, most, creeping=creeping)
        steps, cycles, crept = steps + outcome.steps, cycles + outcome.cycles, crept or outcome.crept
        if outcome.converged:
            break
    return replace(outcome, steps=steps, cycles=cycles, crept=crept)


def _by_way_of_milder_oils(level: Level, goal: float, most: int) -> Outcome:
    """The film that follows from those of oils that thicken less, else what the last of them left."""
    found, steps, cycles = None, 0, 0
    reached, share, by = 0.0, MILDEST, BY
    while True:
        there = share >= 1.0
        at = level if there else Level(_with_milder_oil(level.problem, share), level.shape)
        if found is None:
            starts = [partial(from_dry, at, lift) for lift in LIFTS]
        else:
            starts = [partial(State, found.pressure, found.film, found.datum)]
        outcome = _first_found(at, starts, goal if there else ON_THE_WAY, most)
        steps, cycles = steps + outcome.steps, cycles + outcome.cycles
        if outcome.converged:
            found, reached = outcome.state, share
        else:
            by *= 0.5
        ended = there if outcome.converged else found is None or by < LEAST_BY
        if ended:
            return replace(outcome, steps=steps, cycles=cycles, converged=outcome.converged and there)
        share = min(reached + by, 1.0)


def _with_milder_oil(problem: PointProblem, share: float) -> PointProblem:
    """Films go by about the root of how steeply oils thicken."""
    film = problem.typical_film * share**0.5
    return replace(problem, oil=partial(_milder, problem.oil, share), typical_film=film)


def _milder(oil: Callable[[FloatArray], FloatArray], share: float, pressure: FloatArray) -> FloatArray:
    """What `loops.flows` takes of an oil whose viscosity grows with a share of the exponent."""
    return oil(pressure) * np.array([share, share, 1.0, 1.0]).reshape(4, *(1,) * np.ndim(pressure))
