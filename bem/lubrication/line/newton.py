"""Newton's method for the steady line contact, in similarity variables and on a mesh tied to the free exit.

    rho H^3/m P' = 6 (rho H - H_e),    H = H0 + X^2/2 - 4/pi integral P ln|X - X'| dX',    integral P dX = M

with P = P' = 0 at the exit X_e, where H = H_e, and P -> 8/|X|^3 far upstream. The unknowns are the pressures at the
nodes X_e + s_i (s fixed, s = 0 at the exit), H0 and X_e: the free boundary is a number, so the discrete problem is
smooth and of second order (K. H. Okamura 1982; L. G. Houpert and B. J. Hamrock, *J. Tribol.* 108 (1986) 411).

1. The elastic equation is linear. A start whose film and pressure do not belong together (interpolated, scaled) is
   therefore taken as it is; the *mismatch* between film and pressure is carried along and reduced with each step.
   Mobilities are evaluated on reasonable films from the first step on, which makes the iteration robust.
2. A step is shortened until films stay positive and the sum of squares of residuals and mismatch falls.
3. On fine meshes the spike is solved by itself before a step is judged (`spike`).
4. Where one or two chord steps are expected to reach the tolerance, they are tried first; each costs a tenth of a step.

`remesh` moves a film to a mesh made for it.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.line.deflection import DEFLECTION, LineOperator
from bem.lubrication.line.linear import FactoredEquations, NewtonEquations, NewtonStep, chord_step, solve_newton_step
from bem.lubrication.line.mesh import (
    FAR_INLET,
    cell_densities,
    cell_sizes,
    redistribute,
    trapezoidal_weights,
    upwind_extrapolation,
)
from bem.lubrication.line.problem import Problem
from bem.lubrication.line.reynolds import Flow, FluxTerms, longest_step
from bem.lubrication.line.spike import solve_spike
from bem.numerics.monotone import MonotoneCubic

SHARP_FROM = 1500
"""Cells from which the spike is solved by itself: a step on all cells costs more than ten local ones."""
SHORTEST_STEP = 1e-3
"""Shortest length of a Newton step."""
CHORDS = 2
"""Chord steps that together cost less than half a Newton step."""
CHORD_RATE, LEAST_RATE = 3e-3, 0.1
"""Best contraction of the residual that a chord step is expected to give, as its factors are approximate. `LEAST_RATE`:
largest contraction factor with which a chord step is accepted."""


MAX_IMBALANCE = 5.0
"""Cell width over the wanted one, above which a mesh made for another state is replaced."""
FEWEST_NODES = 8
"""Fewest nodes of a state from which a mesh is made."""


@dataclass(frozen=True)
class LineState:
    """Film and pressure on a mesh tied to the exit.

    offset : (n+1,) nodes from the exit, ascending, the last one 0.
    operator : elastic deflection on the mesh.
    pressure, film : (n+1,).
    rigid_separation : H0 for the kernel ln|x - x'|, whatever the unit of the operator.
    exit : X_e.
    far_field : 1 where the gap is full from far upstream of the nodes on; 0 where it is full from the first node on, a
        meniscus.
    factored : equations of the last Newton step, for chord steps from this state; None of a state that was not solved
        for.
    """

    offset: FloatArray
    operator: LineOperator
    pressure: FloatArray
    film: FloatArray
    rigid_separation: float
    exit: float
    far_field: float = 1.0
    factored: FactoredEquations | None = field(default=None, repr=False, compare=False)

    @property
    def position(self) -> FloatArray:
        """Abscissae of the nodes (n+1,)."""
        return self.exit + self.offset


@dataclass(frozen=True)
class Outcome:
    """Result of Newton's method.

    iterations : Newton steps, chord steps included.
    residual : largest residual or mismatch, relative to the local film and the load.
    converged : whether the tolerance was met.
    """

    state: LineState
    iterations: int
    residual: float
    converged: bool


def inlet_pressure(position: float) -> tuple[float, float]:
    """Return the pressure far upstream, 8/|X|^3, and its derivative with X."""
    return 8 / abs(position) ** 3, 24 / position**4


def inlet_load(position: float) -> tuple[float, float]:
    """Return the load upstream of X, 4/X^2, and its derivative with X."""
    return 4 / position**2, 8 / abs(position) ** 3


@dataclass(frozen=True)
class Discretisation:
    """Quantities that stay constant during the iteration.

    flow : through the cells.
    scale : (n+1,) film of the start, by which residuals are divided.
    offset, quadrature : (n+1,) nodes from the exit and their trapezoidal weights.
    operator : elastic deflection.
    far_field : as of `LineState`.
    """

    flow: Flow
    scale: FloatArray
    offset: FloatArray
    quadrature: FloatArray
    operator: LineOperator
    far_field: float

    def inlet_pressure(self, position: float) -> tuple[float, float]:
        """Return the pressure at the first node and its derivative with X."""
        value, slope = inlet_pressure(position)
        return self.far_field * value, self.far_field * slope

    def inlet_load(self, position: float) -> tuple[float, float]:
        """Return the load upstream of the first node and its derivative with X."""
        value, slope = inlet_load(position)
        return self.far_field * value, self.far_field * slope

    @property
    def problem(self) -> Problem:
        """Similarity problem that is solved."""
        return self.flow.problem


@dataclass(frozen=True)
class Iterate:
    """Iterate of Newton's method.

    pressure, film : (n+1,).
    rigid_separation : H0 for the kernel of the operator. exit : X_e.
    mismatch : (n+1,) film less the film of the pressure.
    error : (n+1,) residuals of the flow through the cells and of the load.
    parts : terms of the flow for its derivatives.
    """

    pressure: FloatArray
    film: FloatArray
    rigid_separation: float
    exit: float
    mismatch: FloatArray
    error: FloatArray
    parts: FluxTerms


@np.errstate(over="ignore", invalid="ignore")  # of iterates that are refused
def newton(problem: Problem, start: LineState, tolerance: float, max_iterations: int = 40) -> Outcome:
    """Solve from a start, whose film (positive) and pressure need not belong together.

    tolerance : largest residual, relative to the local film and to the load. Factors that the start brings along are
        used for chord steps.
    """
    mesh, at = _initial_iterate(problem, start)
    iterations = 0
    factored = None if start.factored is None or start.factored.cells != len(start.offset) - 1 else start.factored
    before = largest = np.inf
    while True:
        before, largest = largest, _largest_error(mesh, at)
        converged = iterations > 0 and largest <= tolerance
        if converged or iterations == max_iterations or not np.isfinite(largest):
            break
        following = None
        rate = max(largest / before, CHORD_RATE)
        if factored is not None and largest * rate**CHORDS <= tolerance:
            following = _chord_iterate(mesh, at, factored, max(tolerance, LEAST_RATE * largest))
        if following is None:
            following, factored = _newton_step(mesh, at)
        if following is None:
            break
        at = following
        iterations += 1
    rigid_separation = at.rigid_separation + DEFLECTION * mesh.operator.log_unit * float(mesh.quadrature @ at.pressure)
    state = LineState(
        mesh.offset, mesh.operator, at.pressure, at.film, rigid_separation, at.exit, mesh.far_field, factored
    )
    return Outcome(state, iterations, largest, converged)


def _initial_iterate(problem: Problem, start: LineState) -> tuple[Discretisation, Iterate]:
    """Return the discretisation and the first iterate: end pressures set, the rest of the film as mismatch."""
    offset, width = start.offset, np.diff(start.offset)
    pressure, film = start.pressure.copy(), start.film
    pressure[-1] = 0.0
    pressure[0] = start.far_field * inlet_pressure(start.exit + offset[0])[0]
    scale = film.copy()
    flow = Flow(problem, width, upwind_extrapolation(width), scale[:-1])
    mesh = Discretisation(flow, scale, offset, trapezoidal_weights(offset), start.operator, start.far_field)
    missed = film - (0.5 * (start.exit + offset) ** 2 - DEFLECTION * (start.operator @ pressure))
    error, parts = _errors(mesh, pressure, film, start.exit)
    return mesh, Iterate(pressure, film, float(missed[-1]), start.exit, missed - missed[-1], error, parts)


def _errors(mesh: Discretisation, pressure: FloatArray, film: FloatArray, exit_: float) -> tuple[FloatArray, FluxTerms]:
    """Return the residuals of the flow through the cells and of the load (n+1,), and the terms for derivatives."""
    through, parts = mesh.flow.residual(pressure, film, float(film[-1]))
    load = mesh.quadrature @ pressure + mesh.inlet_load(exit_ + mesh.offset[0])[0]
    return np.append(through, 1 - load / mesh.problem.load), parts


def _relative_mismatch(mesh: Discretisation, at: Iterate) -> FloatArray:
    """Return the mismatch over the film of the start (n+1,)."""
    return at.mismatch / mesh.scale


def _largest_error(mesh: Discretisation, at: Iterate) -> float:
    """Return the largest residual or relative mismatch."""
    return max(float(np.abs(at.error).max()), float(np.abs(_relative_mismatch(mesh, at)).max()))


def _merit(mesh: Discretisation, at: Iterate) -> float:
    """Return the merit function of the line search: sum of squares of residuals and relative mismatch."""
    relative = _relative_mismatch(mesh, at)
    return float(at.error @ at.error + relative @ relative)


def _newton_step(mesh: Discretisation, at: Iterate) -> tuple[Iterate | None, FactoredEquations | None]:
    """Take a damped Newton step; return the iterate, None where the search fails, and the factored equations."""
    change, factored = solve_newton_step(mesh.operator, _equations(mesh, at))
    film_change = change.film - at.mismatch
    if not (np.isfinite(film_change).all() and np.isfinite(change.pressure).all()):
        return None, None
    size = _merit(mesh, at)
    length = longest_step(at.film, film_change, 0.9)
    easing = len(mesh.flow.width) >= SHARP_FROM
    while length > SHORTEST_STEP:
        trial = _step_along(mesh, at, change, length)
        if trial is not None:
            if easing:
                trial, easing = _with_spike_solved(mesh, trial)
            if _merit(mesh, trial) < (1 - 0.05 * length) ** 2 * size:
                return trial, factored
        length *= 0.5
    return None, None


def _chord_iterate(mesh: Discretisation, at: Iterate, factored: FactoredEquations, allowed: float) -> Iterate | None:
    """Take a whole chord step; return None where it leaves larger residuals than allowed."""
    trial = _step_along(mesh, at, chord_step(factored, at.error, at.mismatch), 1.0)
    return None if trial is None or not _largest_error(mesh, trial) <= allowed else trial


def _equations(mesh: Discretisation, at: Iterate) -> NewtonEquations:
    """Return the equations of the Newton step in (P_1 .. P_{n-1}, H0, X_e)."""
    load, inlet = mesh.problem.load, at.exit + mesh.offset[0]
    inlet_slope, load_slope = mesh.inlet_pressure(inlet)[1], mesh.inlet_load(inlet)[1]
    before, here, after, low, diagonal, high = mesh.flow.derivatives(at.parts)
    return NewtonEquations(
        before=before,
        here=here,
        after=after,
        exit=at.parts.couette_slope[-1] / mesh.flow.scale,
        low=low,
        diagonal=diagonal,
        high=high,
        load=-mesh.quadrature / load,
        load_exit=-(mesh.quadrature[0] * inlet_slope + load_slope) / load,
        position=at.exit + mesh.offset,
        inlet_slope=inlet_slope,
        units=(float(at.pressure.max()), float(at.film[-1]), 0.01 * abs(float(mesh.offset[0]))),
        right=-at.error,
        mismatch=at.mismatch,
    )


def _step_along(mesh: Discretisation, at: Iterate, change: NewtonStep, length: float) -> Iterate | None:
    """Return the iterate a step of the given length away; None where its inlet or a film is not valid."""
    exit_, rigid_separation = at.exit + length * change.exit, at.rigid_separation + length * change.rigid_separation
    inlet = exit_ + mesh.offset[0]
    if not inlet < 0:
        return None
    pressure = at.pressure.copy()
    pressure[1:-1] += length * change.pressure
    pressure[0] = mesh.inlet_pressure(inlet)[0]
    return _iterate(mesh, pressure, rigid_separation, exit_, (1 - length) * at.mismatch)


def _iterate(
    mesh: Discretisation, pressure: FloatArray, rigid_separation: float, exit_: float, mismatch: FloatArray
) -> Iterate | None:
    """Return the iterate of given unknowns; None where a film is not positive."""
    film = rigid_separation + 0.5 * (exit_ + mesh.offset) ** 2 - DEFLECTION * (mesh.operator @ pressure) + mismatch
    if not film.min() > 0:
        return None
    error, parts = _errors(mesh, pressure, film, exit_)
    return Iterate(pressure, film, rigid_separation, exit_, mismatch, error, parts)


def _with_spike_solved(mesh: Discretisation, at: Iterate) -> tuple[Iterate, bool]:
    """Return the iterate with the spike solved where that lowers the merit function, and False if it did not."""
    pressure = solve_spike(mesh.flow, mesh.operator, at.pressure, at.film, at.error[:-1])
    if pressure is None:
        return at, True
    better = _iterate(mesh, pressure, at.rigid_separation, at.exit, at.mismatch)
    if better is None or not _merit(mesh, better) < _merit(mesh, at):
        return at, False
    return better, True


def remesh(problem: Problem, state: LineState, cells: int, smallest: float | None) -> LineState:
    """Return the state on a mesh of `cells` cells made for it; film and pressure are interpolated.

    smallest : smallest cell at the spike over the exit's abscissa; None does not resolve the spike.
    """
    state = _with_full_inlet(state)
    smooth, spike = densities(problem, state)
    top = int(np.clip(np.argmin(np.diff(state.pressure) / np.diff(state.offset)), 1, len(state.offset) - 2))
    if smallest is None:
        size = cell_sizes(state.offset, smooth, 0 * spike, cells, np.inf)
    else:
        # at a spike everything is sharp: fluidity and film as much as pressure
        middle = 0.5 * (state.offset[1:] + state.offset[:-1])
        near = np.abs(middle - state.offset[top]) < 20 * smallest * state.exit
        limit = 1 / (smallest * state.exit)
        total = np.sum((smooth + spike) * np.diff(state.offset)) / cells
        smooth = np.where(near, np.minimum(smooth, limit * total), smooth)
        size = cell_sizes(state.offset, smooth, spike, cells, smallest * state.exit)
    # the node where the steepest fall begins stays: interpolating across a spike would move it
    nodes = redistribute(state.offset, size, cells, top)
    pressure = np.maximum(MonotoneCubic(state.offset, state.pressure)(nodes), 0.0)
    film = np.exp(MonotoneCubic(state.offset, np.log(state.film))(nodes))
    return LineState(nodes, LineOperator.of(nodes), pressure, film, state.rigid_separation, state.exit, state.far_field)


def interpolate_state(problem: Problem, state: LineState, mesh: LineState) -> LineState | None:
    """Return the state on the mesh of another, stretched to its exit, with the known operator; None where the mesh does
    not suit."""
    factor = state.exit / mesh.exit
    nodes, state = mesh.offset * factor, _with_full_inlet(state)
    inside = np.clip(nodes, state.offset[0], 0.0)
    pressure = np.maximum(MonotoneCubic(state.offset, state.pressure)(inside), 0.0)
    film = np.exp(MonotoneCubic(state.offset, np.log(state.film))(inside))
    operator = mesh.operator.rescale(factor)
    there = LineState(nodes, operator, pressure, film, state.rigid_separation, state.exit, state.far_field)
    return there if mesh_imbalance(problem, there) <= MAX_IMBALANCE else None


def is_usable_start(state: LineState) -> bool:
    """Return True if a mesh can be made for a state. A state that did not converge may lack any pressure."""
    arrays = (state.pressure, state.film, np.array([state.exit, state.rigid_separation]))
    if not all(np.isfinite(array).all() for array in arrays):
        return False
    if state.film.min() <= 0:
        return False
    extended = _with_full_inlet(state)
    return bool(extended.offset.size >= FEWEST_NODES and extended.pressure.max() > 0)


def _with_full_inlet(state: LineState) -> LineState:
    """Return the state cut, or continued by the far field, to the first node of a mesh; a meniscus stays in place. The
    operator is that of the old nodes."""
    if state.far_field == 0:
        return state
    reach = -FAR_INLET * max(state.exit, np.sqrt(2 * state.film.min()))
    position, pressure, film = state.position, state.pressure, state.film
    if position[0] > 0.8 * reach:
        steps = np.geomspace(reach, position[0], 8)[:-1]
        pressure = np.concatenate([8 / np.abs(steps) ** 3, pressure])
        film = np.concatenate([film[0] + 0.5 * (steps**2 - position[0] ** 2), film])
        position = np.concatenate([steps, position])
    elif position[0] < 1.25 * reach:
        first = max(int(np.searchsorted(position, reach)) - 1, 0)
        position, pressure, film = position[first:], pressure[first:], film[first:]
    offset = position - state.exit
    offset[-1] = 0.0
    return replace(state, offset=offset, pressure=pressure, film=film)


def densities(problem: Problem, state: LineState) -> tuple[FloatArray, FloatArray]:
    """Return the wanted node densities (n,) on the cells of a state: smooth part, and spike."""
    positive = np.maximum(state.pressure, 0.0)
    fluidity = np.exp(-problem.log_viscosity(positive)[0])
    return cell_densities(state.offset, positive, state.film, fluidity, state.exit)


def mesh_imbalance(problem: Problem, state: LineState) -> float:
    """Return the largest cell over the wanted one, by the smooth part of the film (about 1: ideal)."""
    smooth, _ = densities(problem, state)
    width = np.diff(state.offset)
    return float(np.max(smooth * width) / np.mean(smooth * width))


def spike_cell(problem: Problem, state: LineState, cells: int) -> float:
    """Return the smallest cell that the spike asks for on `cells` cells, over the exit's abscissa."""
    smooth, spike = densities(problem, state)
    total = np.sum((smooth + spike) * np.diff(state.offset)) / cells
    return float(np.min(total / spike.max()) / state.exit)


def spike_cells_to_exit(state: LineState) -> float:
    """Return the distance from the steepest fall of pressure to the exit, in cells of the width at the fall."""
    width = np.diff(state.offset)
    steepest = int(np.argmin(np.diff(state.pressure) / width))
    return float(-state.offset[steepest] / width[steepest])


def rescale(state: LineState, factor: float, pressure_factor: float, film_factor: float) -> LineState:
    """Return the state with lengths, pressures and films multiplied; its rigid-body separation is left as it is."""
    return LineState(
        state.offset * factor,
        state.operator.rescale(factor),
        state.pressure * pressure_factor,
        state.film * film_factor,
        state.rigid_separation,
        state.exit * factor,
        state.far_field,
        state.factored,
    )


def martin_start(load: float, cells: int) -> LineState:
    """Return Martin's rigid isoviscous film for a small load M, on a mesh made for it."""
    lowest = 2.4475 / load
    scale = np.sqrt(2 * lowest)
    near = np.linspace(0.0, 3.0, cells // 2 + 1)
    far = 3.0 * (FAR_INLET / 3.0) ** np.linspace(0.0, 1.0, cells - cells // 2 + 1)[1:]
    offset = -scale * np.concatenate([near, far])[::-1]
    offset[-1] = 0.0
    exit_ = 0.4751 * scale
    film = lowest + 0.5 * (exit_ + offset) ** 2
    gradient = 6 * (film - film[-1]) / film**3
    pressure = np.concatenate([[0.0], np.cumsum(0.5 * (gradient[1:] + gradient[:-1]) * np.diff(offset))])
    pressure = np.maximum(pressure + inlet_pressure(exit_ + offset[0])[0], 0.0)
    pressure[-1] = 0.0
    return LineState(offset, LineOperator.of(offset), pressure, film, lowest, exit_)
