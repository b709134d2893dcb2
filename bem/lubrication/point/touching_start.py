"""From nothing to the film of a point contact whose surfaces touch: starts, and ways to it where none leads there.

Where account is kept of the oil no errors need become smaller (`newton.iterate`), and among steep bumps at creeping
speeds Newton's method goes round in circles, cells that are full, and those that touch, changing back and forth, or
away to errors without bounds. Swift and Stieber's condition, which lets oil come from nowhere, has a film within a
dozen steps there, and from it there are few to the film with account of the oil. What has none then (steep bumps that
rub, a few cells a wavelength) goes the same two ways, and the least wrong of all that was tried is handed back. Knows
what `touching_newton` knows; verified in tests/lubrication/point/test_rough_film.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from bem.contact import solve_contact
from bem.lubrication.point.cascade import from_dry
from bem.lubrication.point.levels import Level, PointProblem
from bem.lubrication.point.touching_newton import TouchingOutcome, TouchingState, newton

DRY = 1e-10
"""Tolerance of the dry contact that a film begins from."""
LIFTS = (1.0, 2.0)
"""Films to start with over those expected of smooth bodies."""
OTHER_SPEEDS = (8.0, 1 / 64, 64.0)
"""Over the one asked for, at which films are begun where no start leads to it: thick ones, or dry contact."""
STRIDE, LEAST_STRIDE = 0.25, 0.06
"""Of the way from there, in powers of the speed."""
FIRST, STEPS = 16, 40
"""Newton steps where other ways are left, and where account of the oil is not kept."""
ON_THE_WAY = 1e-5
"""Largest error of films on the way."""
Film = Callable[[PointProblem, TouchingState, float, int], TouchingOutcome]
"""Of a problem from a start within a tolerance, in so many steps."""


def reached(level: Level, least: float, goal: float) -> TouchingOutcome:
    """The film on a grid, with a least film in its unit; the least wrong outcome where nothing leads to it. Steps and
    cycles are those of all that was tried."""
    tried: list[TouchingOutcome] = []
    asked: list[TouchingOutcome] = []

    def film(problem: PointProblem, start: TouchingState, tolerance: float, most: int) -> TouchingOutcome:
        own = problem is level.problem
        tried.append(newton(level if own else Level(problem, level.shape), start, least, tolerance, most))
        if own:
            asked.append(tried[-1])
        return tried[-1]

    # dry contact is likeliest where smooth bodies would touch, too
    slow = level.problem.typical_film < least
    found = film(level.problem, _dry(level, least) if slow else _lifted(level, least, LIFTS[0]), goal, FIRST)
    if not found.converged:
        _led(level, least, goal, film)
        found = min(asked, key=lambda one: (not one.converged, _wrong(one)))
    return replace(found, steps=sum(one.steps for one in tried), cycles=sum(one.cycles for one in tried))


def _wrong(outcome: TouchingOutcome) -> float:
    """Its largest error, of what is no number without bounds."""
    return math.inf if math.isnan(outcome.residual) else outcome.residual


def _led(level: Level, least: float, goal: float, film: Film) -> None:
    """Try from a film without account of the oil, found from any start, else from other speeds; then from the starts
    that were not tried."""
    free = replace(level.problem, layer=None)
    dry, *lifted = _dry(level, least), *(_lifted(level, least, lift) for lift in LIFTS)
    starts = [dry, *lifted] if level.problem.typical_film < least else [*lifted, dry]
    torn = next((one for start in starts if (one := film(free, start, ON_THE_WAY, STEPS)).converged), None)
    for speed in OTHER_SPEEDS:
        if torn is None:
            torn = _from_speed(free, speed, dry if speed < 1 else lifted[-1], film)
    if torn is not None and film(level.problem, torn.state, goal, STEPS).converged:
        return
    for start in starts:
        if film(level.problem, start, goal, STEPS).converged:
            return


def _from_speed(problem: PointProblem, speed: float, state: TouchingState, film: Film) -> TouchingOutcome | None:
    """From a speed over the one asked for, to that; None where that leads nowhere."""
    at, stride = 0.0, 0.0
    while True:
        place = min(at + stride, 1.0)
        factor = speed ** (1 - place)
        there = replace(problem, drag=(factor * problem.drag[0], factor * problem.drag[1]))
        outcome = film(there, state, ON_THE_WAY, FIRST)
        if not outcome.converged:
            stride /= 2
            if stride < LEAST_STRIDE:
                return None
        elif place == 1:
            return outcome
        else:
            at, state, stride = place, outcome.state, 1.5 * stride or STRIDE


def _dry(level: Level, least: float) -> TouchingState:
    assert level.kernel is not None
    operator, factor = level.kernel
    load = level.problem.load * operator.grid.cell_area / level.cell
    contact = solve_contact(level.gap / factor, operator, load=load, tolerance=DRY)
    touching = (contact.pressure > 0) & ~level.border
    pressure = np.where(touching, contact.pressure, 0.0)
    film = np.where(touching, least, np.maximum(contact.gap * factor, 0.0) + least)
    return TouchingState(pressure, film, least - float(contact.approach) * factor, 0 * pressure, touching)


def _lifted(level: Level, least: float, lift: float) -> TouchingState:
    start = from_dry(level, lift)
    nowhere = np.zeros(level.shape, dtype=bool)
    return TouchingState(start.pressure, np.maximum(start.film, 1.01 * least), start.datum, start.pressure, nowhere)
