"""Ways to a steady line film: from a neighbour, by continuation in the load or in shear thinning, by mesh refinement.

1. `solve_from_neighbour`: the film of a similar case, stretched to the load, is the start on its own mesh.
2. `solve_from_martin`: without a neighbour, continuation in the load from Martin's film on a coarse mesh that does not
   resolve the spike, with factors of the load that shrink on failure (`continue_in_load`); then `refine_mesh`, the
   spike on ever smaller cells.
3. `continue_in_shear_law`: for an oil that thins strongly, continuation in the stresses from the film of a Newtonian
   oil.
4. `solve_coarse`: a film on 250 cells, for the search for the viscosity that inlet heating leaves.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from bem.lubrication.line.newton import (
    MAX_IMBALANCE,
    LineState,
    Outcome,
    is_usable_start,
    martin_start,
    mesh_imbalance,
    newton,
    remesh,
    rescale,
    spike_cell,
    spike_cells_to_exit,
)
from bem.lubrication.line.problem import Problem
from bem.numerics.continuation import FactorRule, continue_by_factors

ATTEMPTS = ((160, 4.0), (240, 2.0), (200, 1.5))
"""Coarse cells and first factor of the load, tried in turn until the continuation succeeds."""
SPIKE_CELLS = (2e-3, 7e-4, 2.5e-4)
"""Smallest cells at a spike over the exit's abscissa, on the way to the final mesh, up to the load `SHARPER`. Where the
spike has no limit the relative error of the film is about five times the last one."""
SHARPER = 300.0
"""Load M from which the smallest cell follows the length of the outlet. The steepest fall of pressure is in the
constriction there, spike or not (`reports.benchmarks.line_film`)."""
SPIKE_SHIFT = 0.75
"""Exponent of the load with which the distance of the spike from the exit, and the length of the constriction, shrink,
in units of the exit's abscissa."""
MAX_SHIFT = 1.0
"""Cells by which a sharp spike may move on its mesh."""
COARSE_CELLS = 250
"""Cells of a coarse film; its central thickness is within 1e-3 of that on 2000."""
MEDIUM_CELLS = 400
"""Cells on which the spike is refined before the final number of cells."""
COARSE_TOLERANCE = 1e-4
"""Tolerance on the way to the final mesh; the discretisation errors there are larger."""
START_LOAD = 0.3
"""Load M at which Martin's rigid isoviscous film is the first iterate."""
FIRST_THINNING_SHARE = 1e-3
"""Share of all shear stresses with which the continuation in shear thinning begins: the oil is nearly Newtonian."""
FIRST_FACTOR, SMALLEST_THINNING_FACTOR = 4.0, 1.02
"""First factor of the continuation in shear thinning, and the factor at which it gives up."""
SMALLEST_LOAD_FACTOR, LARGEST_LOAD_FACTOR, EASY_STEPS = 1.002, 10.0, 10
"""Factor of the load at which the continuation gives up, its largest factor, and the number of Newton steps below which
the factor grows."""


def smallest_cell(load: float) -> float:
    """Return the smallest cell of the final mesh at a load M, over the exit's abscissa."""
    return SPIKE_CELLS[-1] * min(1.0, (SHARPER / load) ** SPIKE_SHIFT)


def spike_cells(load: float) -> tuple[float, ...]:
    """Return the smallest cells of all meshes on the way: `SPIKE_CELLS`, at high loads more of about their ratio."""
    last = smallest_cell(load)
    steps = math.ceil(math.log(SPIKE_CELLS[1] / last) / math.log(SPIKE_CELLS[1] / SPIKE_CELLS[2]))
    between = (SPIKE_CELLS[1] * (last / SPIKE_CELLS[1]) ** (step / steps) for step in range(1, steps))
    return (*SPIKE_CELLS[:2], *between, last)


@dataclass(frozen=True)
class Neighbour:
    """Film of another case, to start from.

    state : the discrete film.
    load : its load M.
    pressure_ratio : its unit of pressure over that of the problem.
    coarse : whether it is a film on `COARSE_CELLS` cells.
    """

    state: LineState
    load: float
    pressure_ratio: float
    coarse: bool = False

    def scaled_to(self, problem: Problem) -> LineState:
        """Return the state stretched to the load of a problem."""
        factor, film_factor = _scaling(self.load, problem.load)
        return rescale(self.state, factor, problem.load / self.load / factor, film_factor)


def solve_from_neighbour(problem: Problem, near: Neighbour, cells: int, tolerance: float, limit: int) -> Outcome:
    """Solve from the film of another case.

    The mesh of that film stays as long as a sharp spike stays on its fine cells; a film without a sharp spike is
    remeshed to `cells`. Otherwise the film is solved anew from a coarse mesh upwards, which finds a spike that has
    moved in few and cheap steps. A film of `COARSE_CELLS` cells of the same case (`near.coarse`) is refined directly.
    """
    if near.coarse and near.load == problem.load and near.pressure_ratio == 1:
        return _refine_from_coarse(problem, near.state, cells, tolerance, limit)
    state = start_from_neighbour(problem, near, cells)
    if state is None:
        return refine_mesh(problem, near.scaled_to(problem), ATTEMPTS[0][0], cells, tolerance, limit)
    outcome = newton(problem, state, tolerance, min(limit, 20))
    if outcome.converged and mesh_imbalance(problem, outcome.state) > MAX_IMBALANCE:
        again = newton(problem, remesh(problem, outcome.state, cells, smallest_cell(problem.load)), tolerance, limit)
        outcome = replace(again, iterations=again.iterations + outcome.iterations)
    return outcome


def start_from_neighbour(problem: Problem, near: Neighbour, cells: int) -> LineState | None:
    """Return the start on `cells` cells from the film of another case; None where a sharp spike would leave its fine
    cells."""
    state = near.scaled_to(problem)
    change = max(abs(math.log(problem.load / near.load)), abs(math.log(near.pressure_ratio)))
    same = len(state.offset) == cells + 1
    moves = not same or SPIKE_SHIFT * change * spike_cells_to_exit(state) > MAX_SHIFT
    if moves and spike_cell(problem, state, min(cells, MEDIUM_CELLS)) < SPIKE_CELLS[0]:
        return None
    return state if same else remesh(problem, state, cells, smallest_cell(problem.load))


def _scaling(old: float, new: float) -> tuple[float, float]:
    """Return the factors of length and film from one load M to another.

    The half-width grows like M^(1/2) once it is Hertz'. Films go like M^(-1) where rigid and like M^(-1/5) where
    elastic.
    """

    def film(load: float) -> float:
        return (load**-1.5 + 1.0 / load**0.3) ** (2 / 3)

    return typical_half_width(new) / typical_half_width(old), film(new) / film(old)


def typical_half_width(load: float) -> float:
    """Return the half-width of the pressure at a load M: Hertz' and the rigid film's, combined."""
    return math.sqrt(8 * load / math.pi + 2 * 2.4475 / load)


def continue_in_shear_law(problem: Problem, cells: int, tolerance: float, limit: int) -> Outcome:
    """Solve by continuation in the stresses, from the film of a Newtonian oil."""
    shear = problem.shear
    assert shear is not None
    coarse = min(cells, MEDIUM_CELLS)
    newtonian = solve_from_martin(replace(problem, shear=None), coarse, COARSE_TOLERANCE, limit)

    def solve(last: Outcome, share: float, target: float) -> Outcome:
        at, start = replace(problem, shear=shear.of_share(target)), last.state
        if mesh_imbalance(at, start) > MAX_IMBALANCE:
            start = remesh(at, start, coarse, None)
        return newton(at, start, COARSE_TOLERANCE, limit)

    found = continue_by_factors(
        solve, newtonian, FIRST_THINNING_SHARE, 1.0, FactorRule(FIRST_FACTOR, SMALLEST_THINNING_FACTOR)
    )
    if found.value < 1.0:
        residual = max(found.last.residual, 1 - found.value)
        return replace(found.last, iterations=found.iterations, residual=residual, converged=False)
    final = refine_mesh(problem, found.last.state, coarse, cells, tolerance, limit)
    return replace(final, iterations=found.iterations + final.iterations)


def solve_from_martin(problem: Problem, cells: int, tolerance: float, limit: int) -> Outcome:
    """Solve by continuation in the load from Martin's film on a coarse mesh, then on finer meshes."""
    spent = 0
    attempts = (((cells, 4.0),) if cells < ATTEMPTS[0][0] else ()) + ATTEMPTS
    for coarse, first_step in attempts:
        last = continue_in_load(problem, coarse, first_step, limit)
        spent += last.iterations
        if last.converged:
            final = refine_mesh(problem, last.state, coarse, cells, tolerance, limit)
            spent += final.iterations
            if final.converged:
                return replace(final, iterations=spent)
            last = final
    return replace(last, iterations=spent)


def continue_in_load(problem: Problem, coarse: int, first_step: float, limit: int) -> Outcome:
    """Solve on a coarse mesh that does not resolve the spike, by continuation in the load from Martin's film.

    first_step : first factor of the load. Where the load is not reached, the residual is at least the missing share of
    it.
    """

    def solve(last: Outcome, load: float, target: float) -> Outcome:
        at, start = replace(problem, load=load), last.state
        if mesh_imbalance(at, start) > MAX_IMBALANCE:
            start = remesh(at, start, coarse, None)
        start = Neighbour(start, load, 1.0).scaled_to(replace(problem, load=target))
        return newton(replace(problem, load=target), start, COARSE_TOLERANCE, limit)

    load = min(problem.load, START_LOAD)
    martin = newton(replace(problem, load=load), martin_start(load, coarse), COARSE_TOLERANCE, limit)
    rule = FactorRule(first_step, SMALLEST_LOAD_FACTOR, LARGEST_LOAD_FACTOR, EASY_STEPS)
    found = continue_by_factors(solve, martin, load, problem.load, rule)
    last, left = found.last, abs(1 - found.value / problem.load)
    converged = last.converged and left == 0
    return replace(last, iterations=found.iterations, residual=max(last.residual, left), converged=converged)


def solve_coarse(problem: Problem, near: Neighbour | None, limit: int) -> Outcome:
    """Solve on `COARSE_CELLS` cells, the spike on the coarsest of `SPIKE_CELLS`.

    From the film of another case: directly, or by a mesh that does not resolve the spike. Where that fails: by
    continuation in the load.
    """
    coarse, first_step = ATTEMPTS[0]
    spent = 0
    if near is not None:
        state = near.scaled_to(problem)
        direct = _refine_coarse(problem, state, limit)
        if direct.converged:
            return direct
        blunt = newton(problem, remesh(problem, state, coarse, None), COARSE_TOLERANCE, limit)
        spent = direct.iterations + blunt.iterations
        if blunt.converged:
            outcome = _refine_coarse(problem, blunt.state, limit)
            spent += outcome.iterations
            if outcome.converged:
                return replace(outcome, iterations=spent)
    outcome = continue_in_load(problem, coarse, first_step, limit)
    spent += outcome.iterations
    if outcome.converged:
        outcome = _refine_coarse(problem, outcome.state, limit)
        spent += outcome.iterations
    return replace(outcome, iterations=spent)


def _refine_coarse(problem: Problem, state: LineState, limit: int) -> Outcome:
    """Solve on the coarse mesh from a state near it."""
    return newton(problem, remesh(problem, state, COARSE_CELLS, SPIKE_CELLS[0]), COARSE_TOLERANCE, limit)


def _refine_from_coarse(problem: Problem, coarse: LineState, cells: int, tolerance: float, limit: int) -> Outcome:
    """Solve on the final mesh from the coarse film of the same case."""
    middle = min(cells, MEDIUM_CELLS)
    wanted = spike_cell(problem, coarse, middle)
    _, *finer = spike_cells(problem.load)
    sizes = [size for size in finer if size > wanted]
    stages: list[tuple[int, float | None]] = [(middle, size) for size in sizes]
    if cells > middle or finer[-1] not in sizes:
        stages.append((cells, finer[-1]))
    return _solve_stages(problem, coarse, stages, tolerance, limit)


def refine_mesh(problem: Problem, state: LineState, coarse: int, cells: int, tolerance: float, limit: int) -> Outcome:
    """Solve on the final number of cells from a film on a coarse mesh, the spike on ever smaller cells."""
    middle = min(cells, MEDIUM_CELLS)
    stages: list[tuple[int, float | None]] = [(coarse, None)]
    wanted = spike_cell(problem, state, middle)
    sizes = spike_cells(problem.load)
    stages += [(middle, smallest) for smallest in sizes if smallest > wanted or smallest == sizes[-1]]
    if cells > middle:
        stages.append((cells, sizes[-1]))
    return _solve_stages(problem, state, stages, tolerance, limit)


def _solve_stages(
    problem: Problem, state: LineState, stages: list[tuple[int, float | None]], tolerance: float, limit: int
) -> Outcome:
    """Solve on one mesh after the other, given by cells and smallest cell at the spike; only the last to the
    tolerance."""
    spent = 0
    for level, (size, smallest) in enumerate(stages):
        goal = tolerance if level == len(stages) - 1 else COARSE_TOLERANCE
        outcome = newton(problem, remesh(problem, state, size, smallest), goal, limit)
        spent += outcome.iterations
        state = outcome.state
        if not outcome.converged and not is_usable_start(state):
            break
    return replace(outcome, iterations=spent)
