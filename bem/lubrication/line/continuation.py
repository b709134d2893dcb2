"""Ways to a steady line film: from a neighbour's, from Martin's by continuation in the load, for a strongly thinning
oil from that of a Newtonian one; a pressure spike is refined little by little."""

from __future__ import annotations

import math
from dataclasses import replace

from bem.lubrication.line.newton import (
    MAX_IMBALANCE,
    Outcome,
    State,
    is_start,
    martin_start,
    mesh_imbalance,
    newton,
    remesh,
    spike_cell,
    spike_cells_to_exit,
    stretched,
)
from bem.lubrication.line.reynolds import Problem

ATTEMPTS = ((160, 4.0), (240, 2.0), (200, 1.5))
"""Coarse cells and first factor of the load, tried in turn until the continuation arrives."""
SPIKE_CELLS = (2e-3, 7e-4, 2.5e-4)
"""Smallest cells at a spike, as shares of the exit's abscissa, on the way to the last mesh, up to the load `SHARPER`.
The film is off by about five times the last one where the spike has no limit."""
SHARPER = 300.0
"""Load M from which the last of these cells follow the outlet's length. The steepest fall of pressure is in the
constriction there, spike or not: on cells of the same size the least film was 0.1 % too thick at M = 1e3, 1.5 % at
1e4, whatever the number of nodes; it is within 0.02 % on 2000 now (`bem.benchmarks.line_film`)."""
SPIKE_SHIFT = 0.75
"""A spike's distance from the exit, and the length of the constriction, go about like M^(-3/4), in units of the exit's
abscissa."""
MAX_SHIFT = 1.0
"""Cells by which a sharp spike may move on its mesh."""
SKETCH = 250
"""Cells of a sketch: centres of films on them were within 1e-3 of those on 400 or 2000."""
MIDDLE = 400
COARSE_TOLERANCE = 1e-4
"""On the way: a start needs no more, its mesh is off by more than that."""
START_LOAD = 0.3
LEAST_SHARE = 1e-3
"""Of all stresses, from which thinning sets in where it must do so step by step."""
FIRST_FACTOR = 4.0


def smallest_cell(load: float) -> float:
    """Of the last mesh at a load M, as a share of the exit's abscissa."""
    return SPIKE_CELLS[-1] * min(1.0, (SHARPER / load) ** SPIKE_SHIFT)


def spike_cells(load: float) -> tuple[float, ...]:
    """Those of all meshes on the way to it: `SPIKE_CELLS`, and more of about their ratio."""
    last = smallest_cell(load)
    steps = math.ceil(math.log(SPIKE_CELLS[1] / last) / math.log(SPIKE_CELLS[1] / SPIKE_CELLS[2]))
    between = (SPIKE_CELLS[1] * (last / SPIKE_CELLS[1]) ** (step / steps) for step in range(1, steps))
    return (*SPIKE_CELLS[:2], *between, last)


def from_neighbour(
    problem: Problem,
    kept: State,
    load: float,
    unit: float,
    cells: int,
    tolerance: float,
    limit: int,
    sketch: bool = False,
) -> Outcome:
    """From the solution of another case, at a load M, its unit of pressure over the problem's: on its mesh as long as a
    sharp spike stays on its fine cells, else anew from a coarse mesh upwards, where a spike that has moved is found in
    few and cheap steps. A sketch of the same case is the coarse mesh itself."""
    if sketch and load == problem.load and unit == 1:
        return _of_sketch(problem, kept, cells, tolerance, limit)
    state = neighbour(problem, kept, load, unit, cells)
    if state is None:
        return refined(problem, _like(problem, kept, load), ATTEMPTS[0][0], cells, tolerance, limit)
    outcome = newton(problem, state, tolerance, min(limit, 20))
    if outcome.converged and mesh_imbalance(problem, outcome.state) > MAX_IMBALANCE:
        again = newton(problem, remesh(problem, outcome.state, cells, smallest_cell(problem.load)), tolerance, limit)
        outcome = replace(again, iterations=again.iterations + outcome.iterations)
    return outcome


def neighbour(problem: Problem, kept: State, load: float, unit: float, cells: int) -> State | None:
    """The solution of another case, see `from_neighbour`, as that of this one would be, on so many cells; None where a
    sharp spike is not on its fine cells then."""
    state = _like(problem, kept, load)
    change = max(abs(math.log(problem.load / load)), abs(math.log(unit)))
    same = len(state.offset) == cells + 1
    moves = not same or SPIKE_SHIFT * change * spike_cells_to_exit(state) > MAX_SHIFT
    if moves and spike_cell(problem, state, min(cells, MIDDLE)) < SPIKE_CELLS[0]:
        return None
    return state if same else remesh(problem, state, cells, smallest_cell(problem.load))


def _like(problem: Problem, kept: State, load: float) -> State:
    """The solution at another load M, stretched."""
    factor, film_factor = _scaling(load, problem.load)
    return stretched(kept, factor, problem.load / load / factor, film_factor)


def _scaling(old: float, new: float) -> tuple[float, float]:
    """Factors of length and film from one load M to another: half-width like M^(1/2) once it is Hertz', and
    films like M^(-1) where rigid, M^(-1/5) where elastic."""

    def film(load: float) -> float:
        return (load**-1.5 + 1.0 / load**0.3) ** (2 / 3)

    return typical_half_width(new) / typical_half_width(old), film(new) / film(old)


def typical_half_width(load: float) -> float:
    """Half-width of the pressure at a load M: Hertz' and the rigid film's, joined."""
    return math.sqrt(8 * load / math.pi + 2 * 2.4475 / load)


def from_newtonian(problem: Problem, cells: int, tolerance: float, limit: int) -> Outcome:
    """From the film of a Newtonian oil, with thinning from a small share of all stresses on."""
    assert problem.shear is not None
    coarse = min(cells, MIDDLE)
    last = from_scratch(replace(problem, shear=None), coarse, COARSE_TOLERANCE, limit)
    spent, share, factor = last.iterations, LEAST_SHARE, FIRST_FACTOR
    while last.converged and factor > 1.02:
        target = min(share * factor, 1.0)
        at = replace(problem, shear=problem.shear.of_share(target))
        start = last.state
        if mesh_imbalance(at, start) > MAX_IMBALANCE:
            start = remesh(at, start, coarse, None)
        trial = newton(at, start, COARSE_TOLERANCE, limit)
        spent += trial.iterations
        if not trial.converged:
            factor = math.sqrt(factor)
            continue
        last, share, factor = trial, target, factor * 1.5
        if share == 1.0:
            last = refined(problem, last.state, coarse, cells, tolerance, limit)
            return replace(last, iterations=spent + last.iterations)
    return replace(last, iterations=spent, residual=max(last.residual, 1 - share), converged=False)


def from_scratch(problem: Problem, cells: int, tolerance: float, limit: int) -> Outcome:
    """Continuation in the load from Martin's film on a coarse mesh, then finer ones."""
    spent = 0
    attempts = (((cells, 4.0),) if cells < ATTEMPTS[0][0] else ()) + ATTEMPTS
    for coarse, first_step in attempts:
        last = climbed(problem, coarse, first_step, limit)
        spent += last.iterations
        if last.converged:
            final = refined(problem, last.state, coarse, cells, tolerance, limit)
            spent += final.iterations
            if final.converged:
                return replace(final, iterations=spent)
            last = final
    return replace(last, iterations=spent)


def climbed(problem: Problem, coarse: int, first_step: float, limit: int) -> Outcome:
    """On a coarse mesh, whose spike is left alone, from Martin's film by continuation in the load; the first factor of
    which may be `first_step`. Where it does not arrive, the residual is at least the share of the load that is left."""
    load, step = min(problem.load, START_LOAD), first_step
    last = newton(replace(problem, load=load), martin_start(load, coarse), COARSE_TOLERANCE, limit)
    spent = last.iterations
    while last.converged and load < problem.load and step > 1.002:
        target = min(problem.load, load * step)
        factor, film_factor = _scaling(load, target)
        at = replace(problem, load=load)
        start = last.state
        if mesh_imbalance(at, start) > MAX_IMBALANCE:
            start = remesh(at, start, coarse, None)
        start = stretched(start, factor, target / load / factor, film_factor)
        trial = newton(replace(problem, load=target), start, COARSE_TOLERANCE, limit)
        spent += trial.iterations
        if trial.converged:
            step = min(step * 1.5, 10.0) if trial.iterations < 10 else step
            last, load = trial, target
        else:
            step = math.sqrt(step)
    left = abs(1 - load / problem.load)
    return replace(last, iterations=spent, residual=max(last.residual, left), converged=last.converged and left == 0)


def sketched(problem: Problem, kept: State | None, load: float, limit: int) -> Outcome:
    """A film on `SKETCH` cells, its spike on the coarsest of `SPIKE_CELLS`: from that of another case, at a load M,
    at once or by a mesh that leaves the spike alone; where that will not do, by continuation in the load."""
    coarse, first_step = ATTEMPTS[0]
    spent = 0
    if kept is not None:
        factor, film_factor = _scaling(load, problem.load)
        state = stretched(kept, factor, problem.load / load / factor, film_factor)
        at_once = _drawn(problem, state, limit)
        if at_once.converged:
            return at_once
        blunt = newton(problem, remesh(problem, state, coarse, None), COARSE_TOLERANCE, limit)
        spent = at_once.iterations + blunt.iterations
        if blunt.converged:
            outcome = _drawn(problem, blunt.state, limit)
            spent += outcome.iterations
            if outcome.converged:
                return replace(outcome, iterations=spent)
    outcome = climbed(problem, coarse, first_step, limit)
    spent += outcome.iterations
    if outcome.converged:
        outcome = _drawn(problem, outcome.state, limit)
        spent += outcome.iterations
    return replace(outcome, iterations=spent)


def _drawn(problem: Problem, state: State, limit: int) -> Outcome:
    """A sketch from a state near it."""
    return newton(problem, remesh(problem, state, SKETCH, SPIKE_CELLS[0]), COARSE_TOLERANCE, limit)


def _of_sketch(problem: Problem, sketch: State, cells: int, tolerance: float, limit: int) -> Outcome:
    """The film that a sketch is of: as `refined`, from the cells at its spike on."""
    middle = min(cells, MIDDLE)
    wanted = spike_cell(problem, sketch, middle)
    _, *finer = spike_cells(problem.load)
    sizes = [size for size in finer if size > wanted]
    stages: list[tuple[int, float | None]] = [(middle, size) for size in sizes]
    if cells > middle or finer[-1] not in sizes:
        stages.append((cells, finer[-1]))
    return _staged(problem, sketch, stages, tolerance, limit)


def refined(problem: Problem, state: State, coarse: int, cells: int, tolerance: float, limit: int) -> Outcome:
    """From a coarse solution to the wanted number of cells, a spike refined little by little."""
    middle = min(cells, MIDDLE)
    stages: list[tuple[int, float | None]] = [(coarse, None)]
    wanted = spike_cell(problem, state, middle)
    sizes = spike_cells(problem.load)
    stages += [(middle, smallest) for smallest in sizes if smallest > wanted or smallest == sizes[-1]]
    if cells > middle:
        stages.append((cells, sizes[-1]))
    return _staged(problem, state, stages, tolerance, limit)


def _staged(
    problem: Problem, state: State, stages: list[tuple[int, float | None]], tolerance: float, limit: int
) -> Outcome:
    """On one mesh after the other, of so many cells and such cells at the spike; only the last to the tolerance."""
    spent = 0
    for level, (size, smallest) in enumerate(stages):
        goal = tolerance if level == len(stages) - 1 else COARSE_TOLERANCE
        outcome = newton(problem, remesh(problem, state, size, smallest), goal, limit)
        spent += outcome.iterations
        state = outcome.state
        if not outcome.converged and not is_start(state):
            break
    return replace(outcome, iterations=spent)
