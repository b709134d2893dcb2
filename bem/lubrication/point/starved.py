"""Starved films of a point contact: an even layer comes in, the gap is full where it and what flows back fill it.

With the content m of cells that are not full (`supply_loops`) the balance of oil holds everywhere, at the meniscus as
behind the contact (Jakobsson and Floberg 1957, Olsson 1965), and where the meniscus is comes out with the pressure.
Films are found by Newton's method from the flooded one, on coarse grids first; at once, or over thicker layers. Light
contacts whose flooded film is very many layers thick (M 0.2 to 2, a hundred layers and more, 48 cells a side) stall so:
they are looked for on a grid as small as the layer's own film wants, from the dry contact.
Verified in tests/lubrication/point/test_point_supply.py.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.lubrication.point.cascade import ON_THE_WAY, Reached, interpolated, solved
from bem.lubrication.point.kept import central_film
from bem.lubrication.point.levels import Level
from bem.lubrication.point.linear import flows
from bem.lubrication.point.newton import Outcome, State, newton, partly_filled
from bem.lubrication.point.setting import Operators, Setting, default_rectangle
from bem.lubrication.supply import OilLayer, Starvation, Supply, checked_supply

HALVINGS = 3
"""Of the step in the logarithm of the layer, from the flooded film's own where nothing is found at once."""
PER_CELL = 8
"""Samples of a cell along a line."""


def checked_layer(
    supply: object, flow_factors: object, entrainment: tuple[float, float] = (1.0, 0.0)
) -> OilLayer | None:
    """The layer that reaches a point contact.

    Raises
    ------
    InputError : no supply, or one that point contacts do not have.
    """
    found: Supply | None = checked_supply(supply)
    if found is None:
        return None
    if not isinstance(found, OilLayer):
        raise InputError(
            "supply: an InletDistance is a line contact's; the meniscus of a point contact is curved and comes out of "
            "the solve: give an OilLayer"
        )
    if not (isinstance(flow_factors, str) and flow_factors == "off"):
        raise InputError('supply: not there with flow_factors for point contacts; leave one out, flow_factors="off"')
    if 0.0 not in entrainment:
        raise InputError("supply: entrainment at an angle has none yet; let both speeds point along x or along y")
    return found


def starved(
    setting: Setting, flooded: Reached, layer: OilLayer, tolerance: float, most: int, *, free: bool = False
) -> tuple[Setting, Reached]:
    """From the flooded film to that with a layer; the flooded one where the layer is thicker than the gap somewhere on
    the edge of the grid: oil beyond would be wanted, of which it knows nothing. free : whether the edges of the grid
    may be others."""
    wanted = layer.thickness / setting.scales.film
    level, state = flooded.level, flooded.outcome.state
    inlet = level.far_source(state.datum) > 0
    if not flooded.outcome.converged or wanted >= state.film[level.border & inlet].min():
        return setting, flooded
    problem = replace(setting.problem, layer=wanted)
    own = Level(problem, level.shape)
    coarse: tuple[Level, State] | None = None
    steps, cycles, work = flooded.outcome.steps, flooded.outcome.cycles, flooded.convolutions
    if flooded.coarse is not None:
        before = Level(problem, flooded.coarse[0].shape)
        first = _lowered(before, flooded.coarse[1], wanted, ON_THE_WAY, most)
        steps, cycles = steps + first.steps, cycles + first.cycles
        work += before.convolutions * np.prod(before.shape) / np.prod(own.shape)
        coarse = (before, first.state) if first.converged else None
    outcome = None if coarse is None else newton(own, interpolated(own, *coarse), tolerance, most)
    if outcome is None or not outcome.converged:
        spent = (0, 0) if outcome is None else (outcome.steps, outcome.cycles)
        outcome = _lowered(own, state, wanted, tolerance, most)
        steps, cycles = steps + spent[0], cycles + spent[1]
    work += own.convolutions
    if not outcome.converged and free and setting.hertz is not None:
        near = _as_small_as(setting, wanted)
        again = solved(near.problem, level.shape, tolerance, most)
        if again.outcome.converged:
            return near, _with_effort(again, steps + outcome.steps, cycles + outcome.cycles, work)
    return replace(setting, problem=problem), _with_effort(Reached(own, outcome, coarse, 0.0), steps, cycles, work)


def _as_small_as(setting: Setting, layer: float) -> Setting:
    """On a grid around the film that a layer makes, in films."""
    problem = setting.problem
    rectangle = default_rectangle(setting.hertz, setting.scales.ratio, layer, problem.drag)
    assert isinstance(problem.operator, Operators)
    operator = replace(problem.operator, rectangle=rectangle)
    return replace(
        setting,
        problem=replace(problem, rectangle=rectangle, operator=operator, typical_film=layer, layer=layer),
    )


def _with_effort(reached: Reached, steps: int, cycles: int, work: float) -> Reached:
    """With what was spent before."""
    one = reached.outcome
    outcome = replace(one, steps=steps + one.steps, cycles=cycles + one.cycles)
    return replace(reached, outcome=outcome, convolutions=work + reached.convolutions)


def _lowered(level: Level, flooded: State, wanted: float, tolerance: float, most: int) -> Outcome:
    """From a flooded film to that with a layer: at once, or by halves of the way in its logarithm."""
    problem, state = level.problem, flooded
    last, step = math.log(max(through(level, flooded), wanted)), math.inf
    steps = cycles = 0
    for _ in range(4 * 2**HALVINGS):
        at = max(math.log(wanted), last - step)
        there = at == math.log(wanted)
        trial = newton(Level(replace(problem, layer=math.exp(at)), level.shape), state, tolerance, most)
        steps, cycles = steps + trial.steps, cycles + trial.cycles
        if trial.converged and there:
            break
        if trial.converged:
            state, last = trial.state, at
            continue
        step = 0.5 * (last - math.log(wanted) if math.isinf(step) else step)
        if step * 2**HALVINGS < last - math.log(wanted) or step == 0:
            break
    return replace(trial, steps=steps, cycles=cycles)


def through(level: Level, state: State) -> float:
    """Oil that goes through the middle, as a layer in films."""
    return central_film(level, level.problem.oil(state.pressure)[2] * state.film)


def content(level: Level, pressure: FloatArray, film: FloatArray) -> FloatArray:
    """Oil in the gap of a starved contact (nx, ny), as a layer in films."""
    flow, stencil = flows(level, pressure, film)
    return partly_filled(level, pressure, flow, stencil)[1]


def starvation(setting: Setting, reached: Reached, flooded: Reached) -> Starvation:
    """What the layer makes of the flooded film."""
    if not flooded.outcome.converged:
        return Starvation(math.nan, math.nan, math.nan, math.nan)
    unit, state = setting.scales.film, reached.outcome.state
    other = flooded.outcome.state
    return Starvation(
        meniscus_position=-math.inf if setting.problem.layer is None else -_filled_inlet(setting, reached),
        layer=through(reached.level, state) * unit,
        reduction=central_film(reached.level, state.film) / central_film(flooded.level, other.film),
        flooded_layer=through(flooded.level, other) * unit,
    )


def _filled_inlet(setting: Setting, reached: Reached) -> float:
    """How far the gap is full upstream of the origin [m]; a cell that is full in part counts in part."""
    level, state, problem = reached.level, reached.outcome.state, setting.problem
    assert problem.layer is not None
    held, full = content(level, state.pressure, state.film), problem.oil(state.pressure)[2] * state.film
    room = full - problem.layer
    share = np.where(state.pressure > 0, 1.0, (held - problem.layer) / np.where(room > 0, room, np.inf))
    dx, dy = level.spacing
    step, speed = min(dx, dy) / PER_CELL, math.hypot(*problem.drag)
    s = step * (np.arange(PER_CELL * sum(level.shape)) + 0.5)
    i = np.floor((-s * problem.drag[0] / speed - problem.rectangle[0]) / dx).astype(int)
    j = np.floor((-s * problem.drag[1] / speed - problem.rectangle[2]) / dy).astype(int)
    inside = (i >= 0) & (j >= 0)
    along = share[i[inside], j[inside]]
    ends = np.flatnonzero(along < 1e-6)
    return float(along[: ends[0] if ends.size else None].clip(0, 1).sum()) * step * setting.scales.length
