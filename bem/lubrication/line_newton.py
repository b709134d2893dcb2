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

from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import PchipInterpolator

from bem.grid import FloatArray
from bem.lubrication.line_flow import Flow, Parts, Problem, eased
from bem.lubrication.line_kernel import LineOperator
from bem.lubrication.line_linear import DEFLECTION, Change, Equations, solve
from bem.lubrication.line_mesh import FAR_INLET, cell_densities, cell_sizes, redistribute

SHARP_FROM = 1500
"""Cells from which a spike is solved for by itself first: a step of them all costs more than ten of those."""


@dataclass(frozen=True)
class State:
    """Node offsets from the exit (n+1,), their elastic operator, pressure, film, datum H0 and exit X_e.

    The datum is that of the kernel ln|x - x'|, whatever the operator's unit.
    """

    offset: FloatArray
    operator: LineOperator
    pressure: FloatArray
    film: FloatArray
    datum: float
    exit: float

    @property
    def position(self) -> FloatArray:
        """Abscissae of the nodes."""
        return self.exit + self.offset


@dataclass(frozen=True)
class Outcome:
    """State, Newton steps taken, residual, and whether the tolerance was met."""

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


def newton(problem: Problem, start: State, tolerance: float, max_iterations: int = 40) -> Outcome:
    """Solve from `start`, whose film (positive) and pressure need not belong together."""
    offset, operator = start.offset, start.operator
    cells = len(offset) - 1
    width = np.diff(offset)
    quadrature = np.zeros(cells + 1)
    quadrature[1:] += 0.5 * width
    quadrature[:-1] += 0.5 * width
    extrapolation = np.zeros(cells)
    extrapolation[1:] = 0.5 * width[1:] / width[:-1]

    pressure, film, exit_ = start.pressure.copy(), start.film, start.exit
    pressure[-1] = 0.0
    pressure[0] = inlet_pressure(exit_ + offset[0])[0]
    scale = film.copy()
    mismatch = film - (0.5 * (exit_ + offset) ** 2 - DEFLECTION * (operator @ pressure))
    datum, mismatch = float(mismatch[-1]), mismatch - mismatch[-1]

    flow = Flow(problem, width, extrapolation, scale[:-1])

    def elastic(pressure: FloatArray, datum: float, exit_: float, mismatch: FloatArray) -> FloatArray:
        film: FloatArray = datum + 0.5 * (exit_ + offset) ** 2 - DEFLECTION * (operator @ pressure) + mismatch
        return film

    def residual(pressure: FloatArray, film: FloatArray, inlet: float) -> tuple[FloatArray, Parts]:
        through, parts = flow.residual(pressure, film, float(film[-1]))
        return np.append(through, 1 - (quadrature @ pressure + inlet_load(inlet)[0]) / problem.load), parts

    def step(error: FloatArray, parts: Parts, film: FloatArray, pressure: FloatArray) -> Change:
        """Newton step in (P_1 .. P_{n-1}, H0, X_e), and the change of film it brings besides the mismatch."""
        inlet = exit_ + offset[0]
        inlet_slope, load_slope = inlet_pressure(inlet)[1], inlet_load(inlet)[1]
        before, here, after, low, diagonal, high = flow.derivatives(film, parts)
        equations = Equations(
            before=before,
            here=here,
            after=after,
            exit=1 / scale[:-1],
            low=low,
            diagonal=diagonal,
            high=high,
            load=-quadrature / problem.load,
            load_exit=-(quadrature[0] * inlet_slope + load_slope) / problem.load,
            position=exit_ + offset,
            inlet_slope=inlet_slope,
            units=(float(pressure.max()), float(film[-1]), 0.01 * abs(float(offset[0]))),
            right=-error,
            mismatch=mismatch,
        )
        return solve(operator, equations)

    error, parts = residual(pressure, film, exit_ + offset[0])
    iterations, converged = 0, False
    while True:
        largest = max(float(np.abs(error).max()), float(np.abs(mismatch / scale).max()))
        if iterations and largest <= tolerance:
            converged = True
        if converged or iterations == max_iterations or not np.isfinite(largest):
            break
        change = step(error, parts, film, pressure)
        film_change = change.film - mismatch
        if not (np.isfinite(film_change).all() and np.isfinite(change.pressure).all()):
            break
        size = error @ error + (mismatch / scale) @ (mismatch / scale)
        shrinking = film_change < 0
        length = 1.0
        if shrinking.any():
            length = min(1.0, 0.9 * float(np.min(-film[shrinking] / film_change[shrinking])))
        easing = cells >= SHARP_FROM
        while length > 1e-3:
            new_pressure = pressure.copy()
            new_pressure[1:-1] += length * change.pressure
            new_exit = exit_ + length * change.exit
            new_datum = datum + length * change.datum
            new_inlet = new_exit + offset[0]
            if new_inlet < 0:
                new_pressure[0] = inlet_pressure(new_inlet)[0]
                new_mismatch = (1 - length) * mismatch
                new_film = elastic(new_pressure, new_datum, new_exit, new_mismatch)
                if new_film.min() > 0:
                    new_error, new_parts = residual(new_pressure, new_film, new_inlet)
                    off = (new_mismatch / scale) @ (new_mismatch / scale)
                    new_size = new_error @ new_error + off
                    better = eased(flow, operator, new_pressure, new_film, new_error[:-1]) if easing else None
                    if better is not None:
                        its_film = elastic(better, new_datum, new_exit, new_mismatch)
                        easing = bool(its_film.min() > 0)
                        if easing:
                            its_error, its_parts = residual(better, its_film, new_inlet)
                            easing = bool(its_error @ its_error + off < new_size)
                        if easing:
                            new_pressure, new_film, new_error, new_parts = better, its_film, its_error, its_parts
                            new_size = new_error @ new_error + off
                    if new_size < (1 - 0.05 * length) ** 2 * size:
                        break
            length *= 0.5
        else:
            break
        pressure, film, datum, exit_, mismatch = new_pressure, new_film, new_datum, new_exit, new_mismatch
        error, parts = new_error, new_parts
        iterations += 1
    plain = datum + DEFLECTION * operator.log_unit * float(quadrature @ pressure)
    state = State(offset, operator, pressure, film, plain, exit_)
    return Outcome(state, iterations, largest, converged)


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
    pressure = np.maximum(PchipInterpolator(state.offset, state.pressure)(nodes), 0.0)
    film = np.exp(PchipInterpolator(state.offset, np.log(state.film))(nodes))
    return State(nodes, LineOperator.of(nodes), pressure, film, state.datum, state.exit)


def _with_inlet(state: State) -> State:
    """The state cut, or continued by the far field, to where the mesh should start; without its weights."""
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
