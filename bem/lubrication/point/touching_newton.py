"""Newton's method for a steady point film whose surfaces touch where it would be thinner than a least film.

The whole pressure P deflects the bodies, the oil has its own, q. Where surfaces touch the film is the least one,
h = h_c, and P - q >= 0 is what they carry; elsewhere P = q and h > h_c. The oil's balance holds for q everywhere with
the films there are. So without speed q vanishes and P is the dry contact's, and where nothing touches the film is that
of `newton`. Which cells touch and which carry no pressure is settled with each step.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.linalg import LinAlgError

from bem.grid import FloatArray
from bem.lubrication.point import loops
from bem.lubrication.point.levels import Level
from bem.lubrication.point.linear import BoolArray, flows, shortened, solve
from bem.lubrication.point.newton import (
    CYCLES,
    LEAST_FILM,
    Balance,
    Outcome,
    State,
    iterate,
    line_search,
    own_film,
    partly_filled,
)
from bem.lubrication.point.touching import TouchingLinear

HISTORY = 4
"""Steps back to the errors that one must stay below: they grow where cells begin or cease to touch."""
ROUGHLY = 1e-2
"""Largest share that a step's equations are solved to: with a tenth, as of smooth bodies, some films in which account
is kept of the oil are lost, with 1e-3 others (11 hard ones of random balls: 6, 6 and 5 found)."""
PATIENCE = 8
"""Steps in which errors or their size must have had a new minimum for more to be taken than asked for: of 21 films of
random balls that took some of these (40 to 56 cells a side), 7 were lost without."""


@dataclass(frozen=True)
class TouchingState(State):
    """Whole pressures, films and H0, as `State`; the oil's pressures and cells that touch, (nx, ny). Films are the
    least one where cells touch, the oil's pressure is the whole one where they do not."""

    oil: FloatArray
    touching: BoolArray


@dataclass(frozen=True)
class TouchingBalance(Balance):
    """As `Balance`; right : balances of the oil."""

    state: TouchingState
    linear: TouchingLinear

    @property
    def empty(self) -> BoolArray:
        """Cells (nx, ny) whose oil has no pressure and no balance."""
        return self.linear.held | self.linear.dry

    @property
    def oil(self) -> FloatArray:
        """Pressure of the oil (nx, ny)."""
        return self.state.oil


def balance(level: Level, state: TouchingState, mismatch: FloatArray) -> TouchingBalance:
    """What the equations leave of a state."""
    problem = level.problem
    flow, stencil = flows(level, state.oil, state.film)
    out = np.zeros(level.shape)
    far = level.far_source(state.datum)
    torn, split = None, None
    if problem.layer is not None:
        torn, _, split = partly_filled(level, state.oil, flow, stencil, level.border & (far > 0))
    loops.divergence(flow, level.spacing, out)
    np.copyto(out, state.oil - far / state.film**2, where=level.border)
    outside, tail_slope = problem.outside(state.datum)
    empty = np.where(level.border, far == 0, (state.oil <= 0) & (out > 0) if torn is None else torn)
    load = float(state.pressure.sum()) * level.cell + outside - problem.load
    totals = (np.abs(flow[axis, 1:-1, 1:-1].sum(axis=1 - axis)).max() for axis in (0, 1))
    first, second = (float(total) * step for total, step in zip(totals, level.spacing[::-1], strict=True))
    dry, held = empty & state.touching, empty & ~state.touching
    half = shortened(stencil)
    linear = TouchingLinear(level, state.oil, state.film, held, half, far, tail_slope, split, state.touching, dry)
    through = max(first, 1e-300), max(second, 1e-300)
    return TouchingBalance(state, mismatch, out, load, linear, through)


@dataclass(frozen=True)
class TouchingOutcome(Outcome):
    """As `Outcome`."""

    state: TouchingState


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
    mismatch = start.film - own_film(level, start.pressure, start.datum)
    patience = 0 if level.problem.layer is None else PATIENCE

    def step(at: TouchingBalance, forcing: float, size: float) -> tuple[TouchingBalance | None, int]:
        try:
            change, cycles = _change(at, forcing)
        except (RuntimeError, LinAlgError):  # a singular matrix: nothing more can be done from here
            return None, 0
        return line_search(lambda length: _stepped(at, change, least, length), size)[0], cycles

    at, steps, cycles, largest, converged = iterate(
        balance(level, start, mismatch), step, tolerance, most, HISTORY, roughly=ROUGHLY, patience=patience
    )
    return TouchingOutcome(at.state, steps, cycles, largest, converged)


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
    after = TouchingState(pressure, kept, state.datum + length * change.datum, oil, touching)
    return balance(level, after, mismatch)
