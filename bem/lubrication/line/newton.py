"""Newton's method for the steady line contact, in similarity variables and on a mesh tied to the free exit.

With U = mu (u1 + u2) / (E' R) and E' = 2 E* (Moes), lengths along the film are in R U^(1/4), films in R U^(1/2)
and pressures in E' U^(1/4). The problem is then

    rho H^3/m P' = 6 (rho H - H_e),    H = H0 + X^2/2 - 4/pi integral P ln|X - X'| dX',    integral P dX = M

with P = P' = 0 at the exit X_e, where H = H_e, and P -> 8/|X|^3 far upstream. The unknowns are the pressures at
the nodes X_e + s_i (s fixed, s = 0 at the exit), H0 and X_e: the free boundary is a number, so the discrete problem
is smooth and of second order. Couette flow is extrapolated from the two nodes upstream, which keeps the pressure
from oscillating where the oil is too viscous to flow under it.

The elastic equation is linear. A start whose film and pressure do not belong together (interpolated, scaled) is
therefore taken as it is, the mismatch carried along and reduced with each step: mobilities are evaluated on
reasonable films from the first step on. That, more than anything, makes the iteration robust.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.line.deflection import DEFLECTION, LineOperator
from bem.lubrication.line.equations import Equations
from bem.lubrication.line.linear import Change, Linear, again, solve
from bem.lubrication.line.mesh import (
    FAR_INLET,
    cell_densities,
    cell_sizes,
    redistribute,
    trapezoidal_weights,
    upwind_extrapolation,
)
from bem.lubrication.line.reynolds import Flow, Parts, Problem, eased, longest_step
from bem.numerics.monotone import MonotoneCubic

SHARP_FROM = 1500
"""Cells from which a spike is solved for by itself first: a step of them all costs more than ten of those."""
SHORTEST_STEP = 1e-3
CHORDS = 2
"""Steps with the equations of an earlier one that together cost less than half a step with equations of their own."""
CHORD_RATE, LEAST_RATE = 3e-3, 0.1
"""By how much such a step reduces the errors at most, the equations being solved roughly, and must at least."""


MAX_IMBALANCE = 5.0
"""Of the cells of a mesh that was made for another state."""
FEWEST_NODES = 8
"""Of a state that a mesh is made from."""


@dataclass(frozen=True)
class State:
    """Node offsets from the exit (n+1,), their elastic operator, pressure, film, datum H0 and exit X_e.

    The datum is that of the kernel ln|x - x'|, whatever the operator's unit. far_field : 1 where the gap is full from
    far upstream of the nodes on, 0 where it begins to be full at the first of them, a meniscus. linear : equations of
    the last Newton step, for chords from this state to others next to it; None of a state that was not solved for.
    """

    offset: FloatArray
    operator: LineOperator
    pressure: FloatArray
    film: FloatArray
    datum: float
    exit: float
    far_field: float = 1.0
    linear: Linear | None = field(default=None, repr=False, compare=False)

    @property
    def position(self) -> FloatArray:
        """Abscissae of the nodes."""
        return self.exit + self.offset


@dataclass(frozen=True)
class Outcome:
    """State, Newton steps taken (chords as well), residual, and whether the tolerance was met."""

    state: State
    iterations: int
    residual: float
    converged: bool


def inlet_pressure(position: float) -> tuple[float, float]:
    """Pressure far upstream, 8/|X|^3, and its derivative with X."""
    return 8 / abs(position) ** 3, 24 / position**4


def inlet_load(position: float) -> tuple[float, float]:
    """Load upstream of X, 4/X^2, and its derivative with X."""
    return 4 / position**2, 8 / abs(position) ** 3


@dataclass(frozen=True)
class Discretisation:
    """What stays the same during an iteration: the flow through the cells and the film (n+1,) it is measured by, that
    of the start; offsets of the nodes (n+1,) with their trapezoidal weights, and the elastic operator."""

    flow: Flow
    scale: FloatArray
    offset: FloatArray
    quadrature: FloatArray
    operator: LineOperator
    far_field: float

    def inlet_pressure(self, position: float) -> tuple[float, float]:
        """At the first node, and its derivative with X."""
        value, slope = inlet_pressure(position)
        return self.far_field * value, self.far_field * slope

    def inlet_load(self, position: float) -> tuple[float, float]:
        """Upstream of the first node, and its derivative with X."""
        value, slope = inlet_load(position)
        return self.far_field * value, self.far_field * slope

    @property
    def problem(self) -> Problem:
        """What is solved."""
        return self.flow.problem


@dataclass(frozen=True)
class Iterate:
    """Pressure and film at the nodes, datum and exit, by how much the film is not that of the pressure, and the errors
    of the equations: of the flow through each cell, and of the load."""

    pressure: FloatArray
    film: FloatArray
    datum: float
    exit: float
    mismatch: FloatArray
    error: FloatArray
    parts: Parts


@np.errstate(over="ignore", invalid="ignore")  # of iterates that are refused
def newton(problem: Problem, start: State, tolerance: float, max_iterations: int = 40) -> Outcome:
    """Solve from `start`, whose film (positive) and pressure need not belong together.

    A step with the equations of the one before reduces the errors by as much again as that did: where one or two of
    them are enough, they are tried first, each for a tenth of the work (chords); so with those that the start was found
    by, if there are any.
    """
    mesh, at = _begun(problem, start)
    iterations = 0
    linear = None if start.linear is None or start.linear.cells != len(start.offset) - 1 else start.linear
    before = largest = np.inf
    while True:
        before, largest = largest, _largest(mesh, at)
        converged = iterations > 0 and largest <= tolerance
        if converged or iterations == max_iterations or not np.isfinite(largest):
            break
        following = None
        rate = max(largest / before, CHORD_RATE)
        if linear is not None and largest * rate**CHORDS <= tolerance:
            following = _chord(mesh, at, linear, max(tolerance, LEAST_RATE * largest))
        if following is None:
            following, linear = _improved(mesh, at)
        if following is None:
            break
        at = following
        iterations += 1
    datum = at.datum + DEFLECTION * mesh.operator.log_unit * float(mesh.quadrature @ at.pressure)
    state = State(mesh.offset, mesh.operator, at.pressure, at.film, datum, at.exit, mesh.far_field, linear)
    return Outcome(state, iterations, largest, converged)


def _begun(problem: Problem, start: State) -> tuple[Discretisation, Iterate]:
    """The start with the pressures its ends must have; what its film misses is the first mismatch."""
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


def _errors(mesh: Discretisation, pressure: FloatArray, film: FloatArray, exit_: float) -> tuple[FloatArray, Parts]:
    """Of the flow through the cells (n,) and of the load, and what the derivatives share with them."""
    through, parts = mesh.flow.residual(pressure, film, float(film[-1]))
    load = mesh.quadrature @ pressure + mesh.inlet_load(exit_ + mesh.offset[0])[0]
    return np.append(through, 1 - load / mesh.problem.load), parts


def _relative_mismatch(mesh: Discretisation, at: Iterate) -> FloatArray:
    """The mismatch over the film that the flow is measured by."""
    return at.mismatch / mesh.scale


def _largest(mesh: Discretisation, at: Iterate) -> float:
    """The largest error or mismatch."""
    return max(float(np.abs(at.error).max()), float(np.abs(_relative_mismatch(mesh, at)).max()))


def _size(mesh: Discretisation, at: Iterate) -> float:
    """What a step must reduce: squares of the errors and of the mismatch."""
    relative = _relative_mismatch(mesh, at)
    return float(at.error @ at.error + relative @ relative)


def _improved(mesh: Discretisation, at: Iterate) -> tuple[Iterate | None, Linear | None]:
    """A Newton step, as long as films stay positive and the errors become smaller, None where there is none; and the
    equations it was taken from."""
    change, linear = solve(mesh.operator, _equations(mesh, at))
    film_change = change.film - at.mismatch
    if not (np.isfinite(film_change).all() and np.isfinite(change.pressure).all()):
        return None, None
    size = _size(mesh, at)
    length = longest_step(at.film, film_change, 0.9)
    easing = len(mesh.flow.width) >= SHARP_FROM
    while length > SHORTEST_STEP:
        trial = _moved(mesh, at, change, length)
        if trial is not None:
            if easing:
                trial, easing = _spike_eased(mesh, trial)
            if _size(mesh, trial) < (1 - 0.05 * length) ** 2 * size:
                return trial, linear
        length *= 0.5
    return None, None


def _chord(mesh: Discretisation, at: Iterate, linear: Linear, allowed: float) -> Iterate | None:
    """A whole step by the equations of an earlier iterate; None where it leaves larger errors than allowed."""
    trial = _moved(mesh, at, again(linear, at.error, at.mismatch), 1.0)
    return None if trial is None or not _largest(mesh, trial) <= allowed else trial


def _equations(mesh: Discretisation, at: Iterate) -> Equations:
    """Those of the Newton step in (P_1 .. P_{n-1}, H0, X_e)."""
    load, inlet = mesh.problem.load, at.exit + mesh.offset[0]
    inlet_slope, load_slope = mesh.inlet_pressure(inlet)[1], mesh.inlet_load(inlet)[1]
    before, here, after, low, diagonal, high = mesh.flow.derivatives(at.parts)
    return Equations(
        before=before,
        here=here,
        after=after,
        exit=at.parts.dragged_slope[-1] / mesh.flow.scale,
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


def _moved(mesh: Discretisation, at: Iterate, change: Change, length: float) -> Iterate | None:
    """The iterate a step of that length away; None where its inlet or a film is not one."""
    exit_, datum = at.exit + length * change.exit, at.datum + length * change.datum
    inlet = exit_ + mesh.offset[0]
    if not inlet < 0:
        return None
    pressure = at.pressure.copy()
    pressure[1:-1] += length * change.pressure
    pressure[0] = mesh.inlet_pressure(inlet)[0]
    return _iterate(mesh, pressure, datum, exit_, (1 - length) * at.mismatch)


def _iterate(
    mesh: Discretisation, pressure: FloatArray, datum: float, exit_: float, mismatch: FloatArray
) -> Iterate | None:
    """The iterate of these; None where a film is not positive."""
    film = datum + 0.5 * (exit_ + mesh.offset) ** 2 - DEFLECTION * (mesh.operator @ pressure) + mismatch
    if not film.min() > 0:
        return None
    error, parts = _errors(mesh, pressure, film, exit_)
    return Iterate(pressure, film, datum, exit_, mismatch, error, parts)


def _spike_eased(mesh: Discretisation, at: Iterate) -> tuple[Iterate, bool]:
    """The iterate with the flow around its spike put right where that makes the errors smaller, and whether it is
    worth while to try that again."""
    pressure = eased(mesh.flow, mesh.operator, at.pressure, at.film, at.error[:-1])
    if pressure is None:
        return at, True
    better = _iterate(mesh, pressure, at.datum, at.exit, at.mismatch)
    if better is None or not _size(mesh, better) < _size(mesh, at):
        return at, False
    return better, True


def remesh(problem: Problem, state: State, cells: int, smallest: float | None) -> State:
    """The state on a mesh made for it; film and pressure are interpolated and need not belong together.

    The spike draws nodes down to cells of `smallest`, a share of the exit's abscissa; None leaves it alone.
    """
    state = _with_inlet(state)
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
    return State(nodes, LineOperator.of(nodes), pressure, film, state.datum, state.exit, state.far_field)


def carried(problem: Problem, state: State, mesh: State) -> State | None:
    """The state on the mesh of another, stretched to its exit, whose weights are known; None where that is not a mesh
    for it."""
    factor = state.exit / mesh.exit
    nodes, state = mesh.offset * factor, _with_inlet(state)
    inside = np.clip(nodes, state.offset[0], 0.0)
    pressure = np.maximum(MonotoneCubic(state.offset, state.pressure)(inside), 0.0)
    film = np.exp(MonotoneCubic(state.offset, np.log(state.film))(inside))
    operator = mesh.operator.stretched(factor)
    there = State(nodes, operator, pressure, film, state.datum, state.exit, state.far_field)
    return there if mesh_imbalance(problem, there) <= MAX_IMBALANCE else None


def is_start(state: State) -> bool:
    """Return True if a mesh can be made for a state: what did not converge may be anything, down to no pressure at
    all."""
    arrays = (state.pressure, state.film, np.array([state.exit, state.datum]))
    if not all(np.isfinite(array).all() for array in arrays):
        return False
    if state.film.min() <= 0:
        return False
    kept = _with_inlet(state)
    return bool(kept.offset.size >= FEWEST_NODES and kept.pressure.max() > 0)


def _with_inlet(state: State) -> State:
    """The state cut, or continued by the far field, to where the mesh should start; without its weights. A meniscus
    stays where it is."""
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


def densities(problem: Problem, state: State) -> tuple[FloatArray, FloatArray]:
    """Wanted densities of nodes on the cells of a state: smooth part, and the spike's."""
    positive = np.maximum(state.pressure, 0.0)
    fluidity = np.exp(-problem.log_viscosity(positive)[0])
    return cell_densities(state.offset, positive, state.film, fluidity, state.exit)


def mesh_imbalance(problem: Problem, state: State) -> float:
    """Largest cell over the one wanted there for all that is smooth (about 1: ideal)."""
    smooth, _ = densities(problem, state)
    width = np.diff(state.offset)
    return float(np.max(smooth * width) / np.mean(smooth * width))


def spike_cell(problem: Problem, state: State, cells: int) -> float:
    """The cell width, as a share of the exit's abscissa, that the spike would ask for at most."""
    smooth, spike = densities(problem, state)
    total = np.sum((smooth + spike) * np.diff(state.offset)) / cells
    return float(np.min(total / spike.max()) / state.exit)


def spike_cells_to_exit(state: State) -> float:
    """Distance from the steepest fall of pressure to the exit, in cells as wide as those at the fall."""
    width = np.diff(state.offset)
    steepest = int(np.argmin(np.diff(state.pressure) / width))
    return float(-state.offset[steepest] / width[steepest])


def stretched(state: State, factor: float, pressure_factor: float, film_factor: float) -> State:
    """The state with lengths, pressures and films multiplied; not its datum."""
    return State(
        state.offset * factor,
        state.operator.stretched(factor),
        state.pressure * pressure_factor,
        state.film * film_factor,
        state.datum,
        state.exit * factor,
        state.far_field,
        state.linear,
    )


def martin_start(load: float, cells: int) -> State:
    """Martin's rigid, isoviscous film for a small load M, on a mesh made for it."""
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
    return State(offset, LineOperator.of(offset), pressure, film, lowest, exit_)
