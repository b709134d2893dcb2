"""Newton's method for the point contact on one grid: steady or at a time step, with or without contact of the surfaces.

Equations. The whole pressure P deflects the bodies and carries the load; the oil's pressure q obeys Reynolds' equation
with the film h. Three complementarity conditions are settled with each step by primal-dual active sets:

1. Rupture: q >= 0, and in a ruptured cell (q = 0) more oil would leave than comes in (Swift-Stieber), or the gap is not
   full (mass-conserving, `cavitation`).
2. Contact, where the problem has a least film h_c: P - q >= 0 and h >= h_c, with P = q where h > h_c. Without speed
   q = 0 and P is the dry contact's; without contact P = q.
3. The far field on outermost cells, which is ruptured downstream.

A step:

1. Residuals of all equations around the state (`residual_of`).
2. The linear system of the step, to the accuracy of Eisenstat and Walker (1996), by GMRES (`linear_system`).
3. A line search by halving; pressures are projected to P >= 0, q >= 0, and films stay above `LEAST_FILM_RATIO` of what
   they were and above h_c.

The film of a start need not be that of its pressure: the mismatch is a residual of its own that decreases with each
step, so films are positive from the first step on.

Cost: 5 to 10 steps of 2 to 5 cycles, and two convolutions a trial state beside those of the cycles.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.linalg import LinAlgError

from bem.grid import FloatArray
from bem.lubrication.point import cavitation, reynolds
from bem.lubrication.point.grid import GridLevel
from bem.lubrication.point.linear_system import BoolArray, NewtonSystem, solve_step, to_single_precision

LEAST_FILM_RATIO = 0.3
"""Smallest ratio of a film to the film before the step."""
SHORTEST_STEP = 1e-3
"""Shortest step of the line search."""
FORCING = (1e-3, 1e-2)
"""Least and largest forcing term (accuracy of the linear system) of a step that should be the last."""
LARGEST_FORCING, FORCING_FACTOR = 0.1, 0.9
"""Largest forcing term, and its ratio to the reduction of the squared residual in the last step (choice 2 of Eisenstat
and Walker 1996). Contacts of M 20 to 20,000 on 128 cells a side take two thirds of the cycles that 1e-3 throughout
takes, in as many steps."""
MOST_CYCLES = 60
"""Largest number of cycles of a step."""
MOST_STEPS = 60
"""Largest number of steps where a solve goes on beyond the number asked for."""
HISTORY = 2
"""Number of last steps whose largest squared residual a step must reduce."""
SLOW_STEPS, SHORT_STEP = 4, 0.125
"""A start is slow if in so many steps the squared residual does not halve and steps are shorter than this on average.
Slow starts creep on by a hundredth of a step, for 170 to 1,950 cycles, and converge or not by the last bits of the
load. With the residual alone as criterion, a start that converges in 26 cycles is given up for one of 188."""
CONTACT_HISTORY = 4
"""`HISTORY` with contact: residuals grow where cells begin or cease to touch."""
CONTACT_FORCING = 1e-2
"""`LARGEST_FORCING` with contact: of 11 hard random balls with mass-conserving cavitation 6 have a film with 0.1, 6
with this and 5 with 1e-3, not the same ones."""
CONTACT_TOLERANCE = 0.2
"""Tolerance of a solve with contact over that of the certificate, which counts errors of films in the balances, too."""
CONTACT_PATIENCE = 8
"""Steps in which the residual must reach a new minimum for a solve with contact and mass-conserving cavitation to go on
beyond the number of steps asked for: of 21 films of random balls that need it (40 to 56 cells a side) 7 are lost
without."""


@dataclass(frozen=True)
class PointFilmState:
    """State of a point film on a grid: the unknowns, and the warm start of another solve.

    pressure : (nx, ny) whole pressure P.
    film : (nx, ny); need not be the film of the pressure.
    separation : H0.
    oil_pressure : (nx, ny) pressure q of the oil; P where surfaces do not touch.
    contact : (nx, ny) cells where surfaces touch.
    """

    pressure: FloatArray
    film: FloatArray
    separation: float
    oil_pressure: FloatArray
    contact: BoolArray

    @staticmethod
    def of_oil(pressure: FloatArray, film: FloatArray, separation: float) -> PointFilmState:
        """Return a state in which the oil carries all pressure."""
        return PointFilmState(pressure, film, separation, pressure, np.zeros(pressure.shape, dtype=bool))


@dataclass(frozen=True)
class NewtonOutcome:
    """Result of Newton's method.

    state : last state, or that of the smallest residual.
    steps, cycles : Newton steps and multigrid cycles.
    residual : largest relative residual.
    converged : whether the residual meets the tolerance.
    slow : whether steps were given up since the residual hardly decreased.
    """

    state: PointFilmState
    steps: int
    cycles: int
    residual: float
    converged: bool
    slow: bool = False


@dataclass(frozen=True)
class Residual:
    """Residuals of all equations at a state.

    state, system : the state, and the linear system of a step from it.
    mismatch : (nx, ny) film less the film of the pressure.
    balance : (nx, ny) balances of the oil; of outermost cells pressure less far pressure.
    load : load carried less load required.
    throughput : largest flow of oil through a line across x, and across y, with what cells gain or lose in time.
    """

    state: PointFilmState
    mismatch: FloatArray
    balance: FloatArray
    load: float
    system: NewtonSystem
    throughput: tuple[float, float]

    @property
    def mass(self) -> float:
        """Largest difference in flow through lines across the flow, side leakage included, over the throughput."""
        level = self.system.level
        lost = np.where(self.system.ruptured | level.boundary, 0.0, self.balance) * level.cell_area
        along = float(np.abs(np.cumsum(lost.sum(axis=1))).max()) / self.throughput[0]
        if level.problem.entrainment[1] == 0 and level.problem.time_terms is None:
            return along
        return max(along, float(np.abs(np.cumsum(lost.sum(axis=0))).max()) / self.throughput[1])

    @cached_property
    def weight(self) -> FloatArray:
        """Factor (nx, ny) from balances to ratios to the local Couette flow."""
        level = self.system.level
        problem, (dx, dy) = level.problem, level.spacing
        # bodies at rest carry no oil: relative to the film itself
        carried = problem.entrainment[0] / dx + problem.entrainment[1] / dy + problem.storage_rate or 1.0
        weight = 1 / (6 * self.system.derivatives[8].astype(np.float64) * carried)
        x0, x1, y0, y1 = problem.rectangle
        mean = problem.load / ((x1 - x0) * (y1 - y0))  # where there is no pressure yet
        weight[level.boundary] = 1 / max(float(self.state.oil_pressure.max()), mean)
        return weight

    @cached_property
    def relative_balance(self) -> FloatArray:
        """Relative balances (nx, ny), zero in ruptured cells."""
        return np.where(self.system.ruptured, 0.0, self.balance) * self.weight

    @property
    def largest(self) -> float:
        """Largest relative residual of balances, mass, load and films."""
        load = abs(self.load) / self.system.level.problem.load
        films = np.abs(self.mismatch / self.state.film).max()
        return float(max(np.abs(self.relative_balance).max(), self.mass, load, films))

    @property
    def merit(self) -> float:
        """Merit function of the line search: mean square of the relative residuals."""
        load = self.load / self.system.level.problem.load
        return float((self.relative_balance**2).mean() + ((self.mismatch / self.state.film) ** 2).mean()) + load**2


def residual_of(level: GridLevel, state: PointFilmState, mismatch: FloatArray) -> Residual:
    """Return the residuals of all equations at a state, whose film differs from that of its pressure by `mismatch`."""
    problem, pressure, film = level.problem, state.oil_pressure, state.film
    flux, derivatives = level.flux(pressure, film)
    balance, partial, split = np.zeros(level.shape), None, None
    far, stored = level.far_source(state.separation), 0.0
    if problem.layer is not None:
        partial, _, split = fill_partially(level, pressure, flux, derivatives, level.boundary & (far > 0))
    reynolds.divergence(flux, level.spacing, balance)
    if problem.time_terms is not None:
        gained = 6 * (problem.storage_rate * derivatives[8] + problem.time_terms.history)
        balance += gained
        stored = float(np.abs(gained[1:-1, 1:-1]).sum()) * level.cell_area
    np.copyto(balance, pressure - far / film**2, where=level.boundary)
    outside, outside_slope = problem.outside_load(state.separation)
    required, inertia = problem.required_load(state.separation)
    load = float(state.pressure.sum()) * level.cell_area + outside - required
    inner = (pressure <= 0) & (balance > 0) if partial is None else partial
    ruptured = np.where(level.boundary, far == 0, inner)
    totals = (np.abs(flux[axis, 1:-1, 1:-1].sum(axis=1 - axis)).max() for axis in (0, 1))
    first, second = (float(total) * step + stored for total, step in zip(totals, level.spacing[::-1], strict=True))
    system = NewtonSystem(
        level, pressure, film, to_single_precision(derivatives), ruptured, state.contact, far, outside_slope - inertia,
        split,
    )  # fmt: skip
    return Residual(state, mismatch, balance, load, system, (max(first, 1e-300), max(second, 1e-300)))


def fill_partially(
    level: GridLevel, pressure: FloatArray, flux: FloatArray, derivatives: FloatArray, full: BoolArray | None = None
) -> tuple[BoolArray, FloatArray, FloatArray]:
    """Return ruptured cells, oil contents, and the share of a ruptured cell's outflow along x (nx, ny).

    Mass-conserving cavitation; flux and derivatives change in place. full : outermost cells that are full; none where
    the inlet is starved.
    """
    problem, ruptured, (content, split) = level.problem, np.zeros(level.shape, dtype=bool), np.zeros((2, *level.shape))
    full = np.zeros(level.shape, dtype=bool) if full is None else full
    cavitation.fill_partially(
        pressure, problem.layer, problem.entrainment, level.spacing, full, flux, derivatives, ruptured, content, split
    )
    return ruptured, content, split


@np.errstate(over="ignore", invalid="ignore", divide="ignore")  # of trial states that are refused
def newton(
    level: GridLevel, start: PointFilmState, tolerance: float, most: int = 40, *, give_up_if_slow: bool = False
) -> NewtonOutcome:
    """Solve the equations on a grid.

    Beyond `most` steps a solve with contact and mass-conserving cavitation goes on while its residual or merit function
    reaches new minima (`CONTACT_PATIENCE`), to `MOST_STEPS` at most; without convergence its state is that of the
    smallest residual.

    Parameters
    ----------
    level : grid and problem.
    start : a state with positive films.
    tolerance : largest relative residual.
    most : largest number of steps.
    give_up_if_slow : whether a slow start ends the solve (`SLOW_STEPS`).
    """
    problem = level.problem
    touching = problem.least_film is not None
    history = CONTACT_HISTORY if touching else HISTORY
    most_forcing = CONTACT_FORCING if touching else LARGEST_FORCING
    patience = CONTACT_PATIENCE if touching and problem.layer is not None else 0
    at = residual_of(level, start, start.film - level.film(start.pressure, start.separation))
    steps, cycles = 0, 0
    merits, largests, lengths = [at.merit], list[float](), list[float]()
    best: Residual | None = None
    while True:
        largest = at.largest
        largests.append(largest)
        if patience > 0 and largest <= min(largests):
            best = at
        converged = bool(steps > 0 and largest <= tolerance)
        if converged or not np.isfinite(largest):
            break
        going_on = _reaches_minimum(largests, patience) or _reaches_minimum(merits, patience)
        if steps >= most and (steps >= MOST_STEPS or not going_on):
            break
        if give_up_if_slow and _is_slow(merits, lengths):
            break
        # a meniscus moves cell by cell, and the residual beside it stays as large until it is in place
        bound = max(merits[-history:]) if problem.layer is None else np.inf
        last = float(np.clip(0.3 * tolerance / largest, *FORCING))
        forcing = max(min(FORCING_FACTOR * merits[-1] / merits[-2], most_forcing), last) if steps else most_forcing
        following, length, spent = _advance(at, forcing, bound)
        cycles += spent
        lengths.append(length)
        if following is None:
            break
        at = following
        merits.append(at.merit)
        steps += 1
    slow = give_up_if_slow and not converged and _is_slow(merits, lengths)
    if not converged and best is not None:
        at, largest = best, min(largests)
    return NewtonOutcome(at.state, steps, cycles, largest, converged, slow)


def _advance(at: Residual, forcing: float, bound: float) -> tuple[Residual | None, float, int]:
    """Return the residual after a step (None if there is none), the length of the step, and its cycles."""
    try:
        step, cycles = _newton_step(at, forcing)
    except (RuntimeError, LinAlgError):  # a singular matrix
        return None, 0.0, 0
    return *_line_search(at, step, bound), cycles


def _reaches_minimum(values: list[float], patience: int) -> bool:
    """Return True if one of the last `patience` values is a new minimum."""
    return patience > 0 and min(values[-patience:]) < min(values[:-patience], default=np.inf)


def _is_slow(merits: list[float], lengths: list[float]) -> bool:
    """Return True if the last steps were short and left more than half of the merit function."""
    if len(merits) <= SLOW_STEPS or merits[-1] <= 0.5 * merits[-1 - SLOW_STEPS]:
        return False
    return sum(lengths[-SLOW_STEPS:]) < SLOW_STEPS * SHORT_STEP


@dataclass(frozen=True)
class NewtonStep:
    """Changes of whole pressure, oil's pressure and film (nx, ny), and of H0, of a full step."""

    pressure: FloatArray
    oil_pressure: FloatArray
    film: FloatArray
    separation: float


def _newton_step(at: Residual, forcing: float) -> tuple[NewtonStep, int]:
    """Return the step, and the cycles that its system took."""
    system, state = at.system, at.state
    level, contact = system.level, state.contact
    # known changes: pressures of newly ruptured cells become zero, the mismatch of films vanishes
    known = np.where(system.fixed, -state.pressure, 0.0)
    film = -at.mismatch
    if known.any():
        film = film + level.deflection(known)
    oil = known
    if system.touches:
        oil = np.where(contact, np.where(system.ruptured, -state.oil_pressure, 0.0), known)
        balances = at.balance + system.balance_change(oil, film)
        oil = oil + system.oil_change(balances)
    change = system.balance_change(oil, film)
    np.copyto(change, known + system.far_slope * film, where=level.boundary)
    right = np.where(system.fixed, 0.0, -at.balance - change)
    if system.touches:
        np.copyto(right, -system.film_scale * film, where=contact)
    load = -at.load - float(known.sum()) * level.cell_area
    solution = solve_step(system, right, load, at.weight, forcing, MOST_CYCLES)
    pressure = solution.change.pressure + known
    deflection = level.deflection(solution.change.pressure) + solution.change.separation
    if system.touches:
        oil = np.where(contact, oil + system.eliminate_oil(solution.change.pressure, deflection)[1], pressure)
    else:
        oil = pressure
    return NewtonStep(pressure, oil, film + deflection, solution.change.separation), solution.cycles


def _line_search(at: Residual, step: NewtonStep, bound: float) -> tuple[Residual | None, float]:
    """Return the residual after the longest step, of halves of a full one, that reduces the merit function.

    bound : value that the merit function must stay below. Returns None and 0 where no step does.
    """
    length = 1.0
    while length > SHORTEST_STEP:
        after = _after_step(at, step, length)
        if np.isfinite(after.merit) and after.merit < (1 - 0.05 * length) ** 2 * bound:
            return after, length
        length *= 0.5
    return None, 0.0


def _after_step(at: Residual, step: NewtonStep, length: float) -> Residual:
    """Return the residual after a part of a step, projected to its bounds, with the cells that touch then."""
    level, state = at.system.level, at.state
    least = level.problem.least_film
    trial = state.pressure + length * step.pressure
    film = state.film + length * step.film
    pressure = np.maximum(trial, 0.0)
    if (trial < 0).any():
        film = film + level.deflection(pressure - trial)
    # a film below its bound is raised to it, the rest stays as mismatch
    bounded = np.maximum(film, LEAST_FILM_RATIO * state.film)
    oil, contact = pressure, state.contact
    if least is not None:
        bounded = np.maximum(bounded, least)
        oil = np.maximum(state.oil_pressure + length * step.oil_pressure, 0.0)
        stays = state.contact & (pressure > oil)
        oil = np.where(stays, oil, pressure)
        leaves = state.contact & ~stays & (film >= least)
        contact = (stays | (bounded <= least)) & ~level.boundary & ~leaves
        bounded = np.where(contact, least, bounded)
    mismatch = (1 - length) * at.mismatch + (bounded - film)
    after = PointFilmState(pressure, bounded, state.separation + length * step.separation, oil, contact)
    return residual_of(level, after, mismatch)
