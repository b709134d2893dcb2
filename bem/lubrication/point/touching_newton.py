"""Newton's method for a steady point film whose surfaces touch where it would be thinner than a least film.

The whole pressure P deflects the bodies, the oil has its own, q. Where surfaces touch the film is the least one,
h = h_c, and P - q >= 0 is what they carry; elsewhere P = q and h > h_c. The oil's balance holds for q everywhere with
the films there are. So without speed q vanishes and P is the dry contact's, and where nothing touches the film is that
of `newton`. Which cells touch and which carry no pressure is settled with each step.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.linalg import LinAlgError

from bem.grid import FloatArray
from bem.lubrication.point import loops
from bem.lubrication.point.levels import Level
from bem.lubrication.point.linear import BoolArray, flows, shortened, solve
from bem.lubrication.point.newton import CYCLES, FORCING, LEAST_FILM, SHORTEST_STEP, own_film, partly_filled
from bem.lubrication.point.touching import TouchingLinear

HISTORY = 4
"""Steps back to the errors that one must stay below: they grow where cells begin or cease to touch."""


@dataclass(frozen=True)
class TouchingState:
    """Whole pressures and the oil's, films and cells that touch, all (nx, ny); H0. Films are the least one where cells
    touch, the oil's pressure is the whole one where they do not."""

    pressure: FloatArray
    oil: FloatArray
    film: FloatArray
    touching: BoolArray
    datum: float


@dataclass(frozen=True)
class TouchingBalance:
    """What the equations leave of a state, as `newton.Balance`; right : balances of the oil."""

    state: TouchingState
    mismatch: FloatArray
    right: FloatArray
    load: float
    linear: TouchingLinear
    through: tuple[float, float]

    @property
    def empty(self) -> BoolArray:
        """Cells whose oil has no pressure and no balance."""
        return self.linear.held | self.linear.dry

    @property
    def mass(self) -> float:
        """Largest difference in oil through lines across the flow, with what leaves at the sides, over all of it."""
        level = self.linear.level
        lost = np.where(self.empty | level.border, 0.0, self.right) * level.cell
        found = float(np.abs(np.cumsum(lost.sum(axis=1))).max()) / self.through[0]
        if level.problem.drag[1] == 0:
            return found
        return max(found, float(np.abs(np.cumsum(lost.sum(axis=0))).max()) / self.through[1])

    @cached_property
    def weight(self) -> FloatArray:
        """From balances to shares of what is dragged along locally."""
        level, linear = self.linear.level, self.linear
        weight = 1 / (linear.scale * self.state.film)
        x0, x1, y0, y1 = level.problem.rectangle
        mean = level.problem.load / ((x1 - x0) * (y1 - y0))
        weight[level.border] = 1 / max(float(self.state.oil.max()), mean)
        return weight

    @cached_property
    def wrong(self) -> FloatArray:
        """Errors of the balances (nx, ny)."""
        return np.where(self.empty, 0.0, self.right) * self.weight

    @property
    def largest(self) -> float:
        """Largest relative error of balances, mass, load and films."""
        load = abs(self.load) / self.linear.level.problem.load
        films = np.abs(self.mismatch / self.state.film).max()
        return float(max(np.abs(self.wrong).max(), self.mass, load, films))

    @property
    def size(self) -> float:
        """What a step must reduce: mean squares of the errors."""
        load = self.load / self.linear.level.problem.load
        return float((self.wrong**2).mean() + ((self.mismatch / self.state.film) ** 2).mean()) + load**2


def balance(level: Level, state: TouchingState, mismatch: FloatArray) -> TouchingBalance:
    """What the equations leave of a state."""
    problem = level.problem
    flow, stencil = flows(level, state.oil, state.film)
    out = np.zeros(level.shape)
    far = level.far_source(state.datum)
    torn = None if problem.layer is None else _torn(level, state, flow, stencil, far > 0)
    loops.divergence(flow, level.spacing, out)
    np.copyto(out, state.oil - far / state.film**2, where=level.border)
    outside, tail_slope = problem.outside(state.datum)
    empty = np.where(level.border, far == 0, (state.oil <= 0) & (out > 0) if torn is None else torn)
    load = float(state.pressure.sum()) * level.cell + outside - problem.load
    totals = (np.abs(flow[axis, 1:-1, 1:-1].sum(axis=1 - axis)).max() for axis in (0, 1))
    first, second = (float(total) * step for total, step in zip(totals, level.spacing[::-1], strict=True))
    dry, held = empty & state.touching, empty & ~state.touching
    half = shortened(stencil)
    linear = TouchingLinear(level, state.oil, state.film, held, half, far, tail_slope, state.touching, dry)
    return TouchingBalance(state, mismatch, out, load, linear, (max(first, 1e-300), max(second, 1e-300)))


def _torn(level: Level, state: TouchingState, flow: FloatArray, stencil: FloatArray, full: BoolArray) -> BoolArray:
    """Cells that are not full, as `newton.partly_filled`; outermost ones that are `full` go on as they were."""
    before = flow.copy(), stencil[11:].copy()
    empty, _ = partly_filled(level, state.oil, flow, stencil)
    full = full & level.border
    for now, then in zip((flow, stencil[11:]), before, strict=True):
        now[:, full] = then[:, full]
    return empty


@dataclass(frozen=True)
class TouchingOutcome:
    """State, Newton steps, multigrid cycles, largest relative error, and whether the tolerance was met."""

    state: TouchingState
    steps: int
    cycles: int
    residual: float
    converged: bool


@dataclass(frozen=True)
class TouchingChange:
    """Of whole pressures, the oil's and films (nx, ny), and of H0."""

    pressure: FloatArray
    oil: FloatArray
    film: FloatArray
    datum: float


@np.errstate(over="ignore", invalid="ignore", divide="ignore")  # of iterates that are refused
def newton(level: Level, start: TouchingState, least: float, tolerance: float, most: int = 60) -> TouchingOutcome:
    """Solve on a grid from a start, with a least film in its unit."""
    at = balance(level, start, start.film - own_film(level, start.pressure, start.datum))
    steps = cycles = 0
    sizes = [at.size]
    while True:
        largest = at.largest
        converged = steps > 0 and largest <= tolerance
        if converged or steps == most or not np.isfinite(largest):
            break
        try:
            change, spent = _change(at, float(np.clip(0.3 * tolerance / largest, *FORCING)))
        except (RuntimeError, LinAlgError):  # a singular matrix: nothing more can be done from here
            break
        cycles += spent
        wanted = max(sizes[-HISTORY:]) if level.problem.layer is None else np.inf
        following = _improved(at, change, least, wanted)
        if following is None:
            break
        at = following
        sizes.append(at.size)
        steps += 1
    return TouchingOutcome(at.state, steps, cycles, largest, bool(converged))


def _change(at: TouchingBalance, forcing: float) -> tuple[TouchingChange, int]:
    """The Newton step, and the cycles it took."""
    linear, state = at.linear, at.state
    level, touching = linear.level, state.touching
    known = np.where(linear.held, -state.pressure, 0.0)
    film = -at.mismatch
    if known.any():
        film = film + level.deflection(known)
    emptied = np.where(linear.dry, -state.oil, 0.0)
    missing = at.right + linear.balances(np.where(touching, emptied, known), film)
    first = linear.oil_change(missing)
    fixed = np.where(touching, emptied + first, known)
    done = linear.balances(fixed, film)
    np.copyto(done, known + linear.far_slope * film, where=level.border)
    right = np.where(linear.held, 0.0, -at.right - done)
    np.copyto(right, -linear.scale * film, where=touching)
    load = -at.load - float(known.sum()) * level.cell
    solved = solve(linear, right, load, at.weight, forcing, CYCLES)
    pressure = solved.change.pressure + known
    by_pressure = level.deflection(solved.change.pressure) + solved.change.datum
    _, answer = linear.answered(solved.change.pressure, by_pressure)
    oil = np.where(touching, fixed + answer, pressure)
    film_change = film + by_pressure
    return TouchingChange(pressure, oil, film_change, solved.change.datum), solved.cycles


def _improved(at: TouchingBalance, change: TouchingChange, least: float, size: float) -> TouchingBalance | None:
    """A step as long as errors become smaller than `size`; None where there is none."""
    length = 1.0
    while length > SHORTEST_STEP:
        trial = _stepped(at, change, least, length)
        if np.isfinite(trial.size) and trial.size < (1 - 0.05 * length) ** 2 * size:
            return trial
        length *= 0.5
    return None


def _stepped(at: TouchingBalance, change: TouchingChange, least: float, length: float) -> TouchingBalance:
    """The state after a step, with what touches then."""
    level, state = at.linear.level, at.state
    wanted = state.pressure + length * change.pressure
    film = state.film + length * change.film
    pressure = np.maximum(wanted, 0.0)
    oil = np.maximum(state.oil + length * change.oil, 0.0)
    stays = state.touching & (pressure > oil)
    oil = np.where(stays, oil, pressure)
    if (wanted < 0).any():
        film = film + level.deflection(pressure - wanted)
    kept = np.maximum(film, np.maximum(LEAST_FILM * state.film, least))
    left = state.touching & ~stays & (film >= least)
    touching = (stays | (kept <= least)) & ~level.border & ~left
    kept = np.where(touching, least, kept)
    mismatch = (1 - length) * at.mismatch + (kept - film)
    after = TouchingState(pressure, oil, kept, touching, state.datum + length * change.datum)
    return balance(level, after, mismatch)
