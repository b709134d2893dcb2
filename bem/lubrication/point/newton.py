"""Newton's method for the point contact on one grid, steady or at a time.

Which cells carry no pressure is settled with each step: they stay so while more oil would leave than comes in
(Swift-Stieber). As in the line contact, a start's film need not be that of its pressure: the mismatch is carried along
and becomes smaller with each step, so that films are reasonable from the first step on.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.point import loops, supply_loops
from bem.lubrication.point.levels import Level
from bem.lubrication.point.linear import BoolArray, Change, Linear, flows, shortened, solve

LEAST_FILM = 0.3
"""Of a film, what a step leaves of it at least."""
SHORTEST_STEP = 1e-3
FORCING = (1e-3, 1e-2)
"""Least and largest share of the errors that a step's equations are solved to where the last ones are wanted."""
ROUGHLY, QUADRATIC = 0.1, 0.9
"""Largest share anywhere, and share over by how much the last step reduced the squares of the errors (choice 2 of
Eisenstat and Walker 1996, whose factor this is): steps further from the film are not as good as their equations.
Contacts of M 20 to 20,000 on 128 cells a side take two thirds of the cycles that 1e-3 throughout takes, in as many
steps."""
CYCLES = 60
"""Most of a step."""
MOST = 60
"""Steps at the outside, where they go on beyond what was asked for."""
HISTORY = 2
"""Steps back to the errors that one must stay below."""
HALVED_IN, SHORT = 4, 0.125
"""Steps in which squares of errors halve where a start leads to a film, or else are longer than this on average. Of
those that did neither, some crept on by a hundredth of a step each, for 170 to 1,950 cycles, and whether they then came
to a film was up to the last bits of their load. Where steps are as long as halves errors may rest for a few and then
fall: a start that took 26 cycles was led through milder oils in 188 when errors alone counted."""


@dataclass(frozen=True)
class State:
    """Pressures (nx, ny), H0, and films (nx, ny), which need not be those of the pressures."""

    pressure: FloatArray
    film: FloatArray
    datum: float


@dataclass(frozen=True)
class Outcome:
    """State, Newton steps, multigrid cycles, largest relative error, whether the tolerance was met, and whether steps
    were given up since errors hardly fell."""

    state: State
    steps: int
    cycles: int
    residual: float
    converged: bool
    crept: bool = False


@dataclass(frozen=True)
class Balance:
    """What the equations leave of a state.

    mismatch : of its film with that of its pressure. right : balances (nx, ny), of outermost cells pressure less far
    pressure. load : what is missing of it, negative. linear : the equations around the state. through : most oil
    through a line across x, and across y, in time with what cells gain or lose.
    """

    state: State
    mismatch: FloatArray
    right: FloatArray
    load: float
    linear: Linear
    through: tuple[float, float]

    @property
    def empty(self) -> BoolArray:
        """Cells (nx, ny) whose oil has no balance."""
        return self.linear.held

    @property
    def oil(self) -> FloatArray:
        """Pressure of the oil (nx, ny)."""
        return self.state.pressure

    @property
    def mass(self) -> float:
        """Largest difference in oil through lines across the flow, with what leaves at the sides, over all of it."""
        level = self.linear.level
        lost = np.where(self.empty | level.border, 0.0, self.right) * level.cell
        found = float(np.abs(np.cumsum(lost.sum(axis=1))).max()) / self.through[0]
        if level.problem.drag[1] == 0 and level.problem.in_time is None:
            return found
        return max(found, float(np.abs(np.cumsum(lost.sum(axis=0))).max()) / self.through[1])

    @cached_property
    def weight(self) -> FloatArray:
        """From balances to shares of what is dragged along locally."""
        level = self.linear.level
        drag, (dx, dy) = level.problem.drag, level.spacing
        # of bodies at rest, whose film is only looked at, nothing is carried along: shares of the film as it is
        carried = drag[0] / dx + drag[1] / dy + level.problem.storing or 1.0
        weight = 1 / (6 * self.linear.stencil[8].astype(np.float64) * carried)
        x0, x1, y0, y1 = level.problem.rectangle
        mean = level.problem.load / ((x1 - x0) * (y1 - y0))  # where there is no pressure yet
        weight[level.border] = 1 / max(float(self.oil.max()), mean)
        return weight

    @cached_property
    def wrong(self) -> FloatArray:
        """Errors of the cells (nx, ny): of free ones the balance."""
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


def balance(level: Level, state: State, mismatch: FloatArray) -> Balance:
    """What the equations leave of a state."""
    problem, pressure, film = level.problem, state.pressure, state.film
    flow, stencil = flows(level, pressure, film)
    out, empty, split = np.zeros(level.shape), None, None
    if problem.layer is not None:
        empty, _, split = partly_filled(level, pressure, flow, stencil)
    loops.divergence(flow, level.spacing, out)
    far, stored = level.far_source(state.datum), 0.0
    if problem.in_time is not None:
        gained = 6 * (problem.storing * stencil[8] + problem.in_time.history)
        out += gained
        stored = float(np.abs(gained[1:-1, 1:-1]).sum()) * level.cell
    np.copyto(out, pressure - far / film**2, where=level.border)
    outside, tail_slope = problem.outside(state.datum)
    wanted, inertia = problem.wanted(state.datum)
    held = np.where(level.border, far == 0, (pressure <= 0) & (out > 0)) if empty is None else empty
    load = float(pressure.sum()) * level.cell + outside - wanted
    totals = (np.abs(flow[axis, 1:-1, 1:-1].sum(axis=1 - axis)).max() for axis in (0, 1))
    first, second = (float(total) * step + stored for total, step in zip(totals, level.spacing[::-1], strict=True))
    linear = Linear(level, pressure, film, held, shortened(stencil), far, tail_slope - inertia, split)
    return Balance(state, mismatch, out, load, linear, (max(first, 1e-300), max(second, 1e-300)))


def partly_filled(
    level: Level, pressure: FloatArray, flow: FloatArray, stencil: FloatArray, full: BoolArray | None = None
) -> tuple[BoolArray, FloatArray, FloatArray]:
    """Cells of a starved contact that are not full, contents, and the share of what leaves those along x (nx, ny);
    flow and stencil become theirs. full : outermost cells that bring as much as there is room for."""
    problem, empty, (content, split) = level.problem, np.zeros(level.shape, dtype=bool), np.zeros((2, *level.shape))
    full = np.zeros(level.shape, dtype=bool) if full is None else full
    supply_loops.contents(
        pressure, problem.layer, problem.drag, level.spacing, full, flow, stencil, empty, content, split
    )
    return empty, content, split


def own_film(level: Level, pressure: FloatArray, datum: float) -> FloatArray:
    """The film of pressures."""
    return level.gap + level.deflection(pressure) + datum


B = TypeVar("B", bound=Balance)


def iterate(
    at: B,
    step: Callable[[B, float, float], tuple[B | None, int]],
    tolerance: float,
    most: int,
    history: int,
    *,
    roughly: float | None = None,
    patience: int = 0,
) -> tuple[B, int, int, float, bool]:
    """Steps from a balance to one within the tolerance: the last one, steps, cycles, its largest relative error, and
    whether that is so.

    step : of a balance, the share of errors that its equations are solved to, and the size its errors are to stay
    below, the next balance, None where there is none, and cycles. history : steps back to the largest size allowed.
    roughly : largest share that equations are solved to, as of smooth bodies if None. patience : errors may grow on the
    way. Beyond `most`, steps go on while errors or sizes had a new minimum in so many steps, to `MOST` at the outside;
    without an end the balance is the least wrong one, not the last.
    """
    steps = cycles = 0
    roughly = ROUGHLY if roughly is None else roughly
    sizes, errors, least_wrong = [at.size], [], None
    while True:
        largest = at.largest
        errors.append(largest)
        if patience > 0 and largest <= min(errors):
            least_wrong = at
        converged = steps > 0 and largest <= tolerance
        if converged or not np.isfinite(largest):
            break
        if steps >= most and (steps >= MOST or not (_falls(errors, patience) or _falls(sizes, patience))):
            break
        # a meniscus moves by what is wrong at it, cell by cell: errors there are as large until it is in its place
        wanted = max(sizes[-history:]) if at.linear.level.problem.layer is None else np.inf
        last = float(np.clip(0.3 * tolerance / largest, *FORCING))
        share = max(min(QUADRATIC * sizes[-1] / sizes[-2], roughly), last) if steps else roughly
        following, spent = step(at, share, wanted)
        cycles += spent
        if following is None:
            break
        at = following
        sizes.append(at.size)
        steps += 1
    if not converged and least_wrong is not None:
        at, largest = least_wrong, min(errors)
    return at, steps, cycles, largest, bool(converged)


def _falls(values: list[float], patience: int) -> bool:
    """Return True if there was a new minimum among so many last ones."""
    return patience > 0 and min(values[-patience:]) < min(values[:-patience], default=np.inf)


def line_search(trial: Callable[[float], B], size: float) -> tuple[B | None, float]:
    """The balance after the longest step, of halves of a whole one, whose errors are smaller than `size`, and its
    length; None where there is none. trial : the balance after a step of some length."""
    length = 1.0
    while length > SHORTEST_STEP:
        after = trial(length)
        if np.isfinite(after.size) and after.size < (1 - 0.05 * length) ** 2 * size:
            return after, length
        length *= 0.5
    return None, 0.0


@np.errstate(over="ignore", invalid="ignore")  # of iterates that are refused
def newton(level: Level, start: State, tolerance: float, most: int = 40, *, creeping: bool = True) -> Outcome:
    """Solve on a grid from a start with positive films. creeping : steps may go on where errors hardly fall."""
    mismatch = start.film - own_film(level, start.pressure, start.datum)
    sizes: list[float] = []
    lengths: list[float] = []

    def step(at: Balance, forcing: float, size: float) -> tuple[Balance | None, int]:
        sizes.append(at.size)
        if not creeping and _creeps(sizes, lengths):
            return None, 0
        change, cycles = _change(at, forcing)
        following, length = _improved(at, change, size)
        lengths.append(length)
        return following, cycles

    # no name for the first balance: it and its factors would be kept to the end
    at, steps, cycles, largest, converged = iterate(balance(level, start, mismatch), step, tolerance, most, HISTORY)
    crept = not (creeping or converged) and _creeps(sizes, lengths)
    return Outcome(at.state, steps, cycles, largest, converged, crept)


def _creeps(sizes: list[float], lengths: list[float]) -> bool:
    """Return True if the last steps were short and left more than half of the squares of errors."""
    if len(sizes) <= HALVED_IN or sizes[-1] <= 0.5 * sizes[-1 - HALVED_IN]:
        return False
    return sum(lengths[-HALVED_IN:]) < HALVED_IN * SHORT


def _change(at: Balance, forcing: float) -> tuple[Change, int]:
    """The Newton step, and the cycles it took."""
    linear = at.linear
    level = linear.level
    known = np.where(linear.held, -at.state.pressure, 0.0)
    film = -at.mismatch
    if known.any():
        film = film + level.deflection(known)
    done = linear.balances(known, film)
    np.copyto(done, known + linear.far_slope * film, where=level.border)
    right = np.where(linear.held, 0.0, -at.right - done)
    load = -at.load - float(known.sum()) * level.cell
    solved = solve(linear, right, load, at.weight, forcing, CYCLES)
    return Change(solved.change.pressure + known, solved.change.datum), solved.cycles


def _improved(at: Balance, change: Change, size: float) -> tuple[Balance | None, float]:
    """A step as long as errors become smaller than `size`, and its length; None where there is none."""
    level, state = at.linear.level, at.state
    film_change = level.deflection(change.pressure) + change.datum - at.mismatch

    def trial(length: float) -> Balance:
        wanted = state.pressure + length * change.pressure
        film = state.film + length * film_change
        pressure = np.maximum(wanted, 0.0)
        if (wanted < 0).any():
            film = film + level.deflection(pressure - wanted)
        # a film that would vanish stays, as mismatch
        kept = np.maximum(film, LEAST_FILM * state.film)
        mismatch = (1 - length) * at.mismatch + (kept - film)
        return balance(level, State(pressure, kept, state.datum + length * change.datum), mismatch)

    return line_search(trial, size)
