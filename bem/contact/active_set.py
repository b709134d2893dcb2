"""Contact on one grid: conjugate gradients on the cells in contact, between updates of which cells those are.

The pressure minimises p.Kp/2 + p.(gap - approach) over 0 <= p <= cap, with its sum given under load control. A round

1. applies the operator in double precision, which gives the true gap, its violations and the energy; if the way
   there led well beyond its lowest point, goes back to it: its displacement follows without another application;
2. takes in the free cells that overlap and the capped cells that open;
3. runs preconditioned conjugate gradients on the cells in contact (single precision transforms, the symmetric part of
   the operator), and
4. sets free what came out below zero, caps what came out above, and restores the load.

Where the way leads upwards from its beginning a round is free to raise the energy while the largest violation falls.
Once it has not for a few rounds, such a round is taken back for a projected gradient step, which always lowers it.
From there on the energy falls, or the violation is the least so far, until a tenth of it is reached: none can repeat.

Where nearly all cells that touch are at the cap, pressures without bounds say nothing: a projected gradient step with
the load restored by one shift takes their place and needs a handful of rounds.

With strong coupling of friction (friction times Dundurs' beta above about 0.5) the symmetric part alone may lead
nowhere; `solve` then takes friction's part of the displacement from one contact to the next.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.contact import passes
from bem.contact.controls import ApproachControl, LoadControl
from bem.contact.long_waves import LongWaves, long_waves
from bem.contact.passes import CAPPED, CONTACT, FREE
from bem.contact.preconditioner import SparseInverse, sparse_inverse
from bem.convolution import DisplacementOperator

FloatArray = NDArray[np.float64]
Control = LoadControl | ApproachControl
Indices = NDArray[np.int64]

_ROUND_OFF = 1e-12
"""Energies closer than this, relative to the sum of their terms, are taken as equal."""

_FALL = 1e-9
"""Fall of the energy, relative to the sum of its terms, that counts as progress where no round may raise it."""

_FEW = 0.1
"""Cells between the bounds over cells at the cap, below which the contact counts as fully plastic."""

_LEAST_SHARE = 0.02
"""Of the way of a round, below which it is not worth to go at all."""

_GREATEST_SHARE = 0.75
"""Of the way of a round to its lowest point, above which its end is taken. 0.5, where the energy just rises, lets the
sets swing for long on some capped and free contacts; at 0.8 rounds that only lack precision are spoiled."""

_RESOLUTION = 4e-16
"""Violations below this share of the lengths they are differences of are round-off."""


@dataclass
class Effort:
    """Iterations of conjugate gradients so far, over all levels, and their limit."""

    limit: int
    iterations: int = 0

    @property
    def left(self) -> int:
        """Iterations that may still be made."""
        return self.limit - self.iterations


@dataclass(frozen=True)
class Tolerance:
    """Largest violation allowed: a length, and a share of the displacement where that is less."""

    length: float
    relative: float

    def of(self, approach: float, displacement: FloatArray, iterate: _Iterate) -> float:
        """The length that holds for a displacement; never below what double precision can resolve."""
        cells = iterate.cells if iterate.cells.size else iterate.capped
        size = float(np.abs(displacement[cells]).max(initial=0.0))
        return max(min(self.length, self.relative * size), _RESOLUTION * (abs(approach) + size))


@dataclass(frozen=True)
class LevelResult:
    """Where a level ended: scaled pressure and displacement (flat), approach, largest violation, and how.

    `fresh` : the displacement is the operator applied to this very pressure, not put together from others.
    `least_mean_gap` : where less was asked for, a bound below which no mean gap exists.
    """

    pressure: FloatArray
    displacement: FloatArray
    approach: float
    violation: float
    converged: bool
    rounds: int
    fresh: bool = True
    least_mean_gap: float | None = None


@dataclass(frozen=True)
class Tuning:
    """Numbers that trade work between rounds and iterations; measured on self-affine surfaces of 256 to 2048 cells."""

    reduction: float = 1e-4
    least_reduction: float = 0.3
    clipping: float = 0.5
    iterations_per_round: int = 80
    final: float = 0.8
    squared_radius: int = 5
    rounds: int = 100
    patience: int = 8
    stall: int = 60


@dataclass
class _Iterate:
    """A feasible pressure: the cells between the bounds, their values, and the cells at the cap."""

    cells: Indices
    values: FloatArray
    capped: Indices


class _Level:
    """Operator, buffers and gap of one grid."""

    def __init__(self, operator: DisplacementOperator, gap: FloatArray, cap: float, tuning: Tuning) -> None:
        self.operator = operator
        self.exact = operator.scaled()
        self.quick = operator.scaled(np.float32, symmetric_part=True)
        self.gap = gap
        self.cap = cap
        self.tuning = tuning
        self.state = np.zeros(gap.size, np.uint8)
        self.pressure = self.exact.transform.zeros_field()
        self.displacement = self.exact.transform.empty_field()
        self.before = self.exact.transform.empty_field()
        self.quick_in = self.quick.transform.zeros_field()
        self.quick_out = self.quick.transform.empty_field()
        names = ("pressure", "displacement", "before", "quick_in", "quick_out")
        self.flat: dict[str, NDArray[Any]] = {name: getattr(self, name).reshape(-1) for name in names}
        self.sparse: SparseInverse | None = None
        self.sparse_cells: Indices | None = None
        self.smooth: LongWaves | None = None

    @property
    def largest_eigenvalue(self) -> float:
        """A bound on the eigenvalues of the symmetric part."""
        real = self.exact.multiplier.real
        assert real is not None
        return float(np.abs(real).max())

    def displace(self, iterate: _Iterate) -> None:
        """Write the displacement of a pressure into the buffer."""
        pressure = self.flat["pressure"]
        passes.scatter(pressure, iterate.cells, iterate.values)
        passes.scatter_value(pressure, iterate.capped, self.cap)
        self.exact.apply(self.pressure, self.displacement)
        passes.scatter_value(pressure, iterate.cells, 0.0)
        passes.scatter_value(pressure, iterate.capped, 0.0)

    def keep(self) -> None:
        """Make the displacement the one before; the next takes the other's buffer."""
        self.displacement, self.before = self.before, self.displacement
        self.flat["displacement"], self.flat["before"] = self.flat["before"], self.flat["displacement"]

    def mark(self, iterate: _Iterate) -> None:
        self.state[:] = FREE
        passes.scatter_value(self.state, iterate.cells, CONTACT)
        passes.scatter_value(self.state, iterate.capped, CAPPED)

    def preconditioner(self, cells: Indices) -> Callable[[FloatArray, FloatArray], float]:
        """Approximate inverse of the kernel on the cells: (residual, out) -> sum of out."""
        if self.sparse is None:
            reach = 2 * math.isqrt(self.tuning.squared_radius)
            self.sparse = sparse_inverse(
                self.operator.grid.shape,
                self.operator.grid.periodic,
                self.operator.near_field(reach),
                self.tuning.squared_radius,
            )
            self.smooth = long_waves(self.operator, self.sparse.near)
        near = self.sparse.on(cells, self.sparse_cells)
        self.sparse_cells = cells
        far = None if self.smooth is None else self.smooth.on(cells, near.row_sums())
        values = np.empty(cells.size)

        def inverse(residual: FloatArray, out: FloatArray) -> float:
            near.spread(residual, values)
            if far is not None:
                far.apply(values)
            return near.collect(values, out)

        return inverse


def solve_level(
    operator: DisplacementOperator,
    gap: FloatArray,
    control: Control,
    cap: float,
    start: FloatArray | None,
    tolerance: Tolerance,
    effort: Effort,
    tuning: Tuning,
    report: Callable[[int, float, int], None] | None = None,
) -> LevelResult:
    """Solve on one grid until no contact condition is violated by more than the tolerance.

    `gap` flat, in units of its own; `cap` may be infinite; `start` a pressure within the bounds or None; `report` is
    called with iterations, violation and cells in contact after each round.
    """
    level = _Level(operator, gap, cap, tuning)
    iterate = _first(level, control, start)
    best = mark = lowest = math.inf
    waited = unimproved = 0
    accepted: _Accepted | None = None
    refused = 0
    step = release = 0.0
    rounds = 0
    before: _Accepted | None = None
    kept = False
    while True:
        if before is not None and not kept:
            level.keep()
        kept = False
        level.displace(iterate)
        current: _Accepted | None = None
        fresh = True
        if before is not None:
            iterate, current = _step_back(level, before, iterate)
            fresh = current is not None
        level.mark(iterate)
        rounds += 1
        residual = np.empty(iterate.cells.size)
        total = passes.gather_sum(level.flat["displacement"], gap, iterate.cells, residual)
        approach = _approach(level, control, iterate, total)
        residual -= approach
        found, largest = passes.find_violations(level.flat["displacement"], gap, level.state, approach)
        violation = max(largest, float(np.abs(residual).max(initial=0.0)))
        if report is not None:
            report(effort.iterations, violation, iterate.cells.size + iterate.capped.size)
        goal = tolerance.of(approach, level.flat["displacement"], iterate)
        if violation <= goal:
            return _result(level, iterate, approach, violation, True, rounds, fresh)
        if effort.left <= 0 or rounds >= tuning.rounds:
            return _result(level, iterate, approach, violation, False, rounds, fresh)
        if current is None:
            current = _Accepted(iterate, approach, *_energy(level, iterate))
        else:
            current = replace(current, approach=approach)
        potential = current.energy - (approach * current.force if isinstance(control, ApproachControl) else 0.0)
        fell = tuning.patience == 0 and potential < lowest - _FALL * current.size
        waited = 0 if violation < 0.7 * mark or fell else waited + 1
        mark, lowest = min(mark, violation), min(lowest, potential)
        if waited > tuning.stall:
            return _result(level, iterate, approach, violation, False, rounds, fresh)
        if operator.symmetric:
            before = current
        improved = violation < 0.9 * best
        unimproved = 0 if improved else unimproved + 1
        best = min(best, violation)
        if unimproved >= tuning.patience and release == 0.0 and operator.symmetric:
            release = 0.1 * best
        elif violation <= release:
            release = 0.0
        if release == 0.0:
            accepted = None
        elif accepted is not None and not improved and current.above(accepted, approach):
            refused += 1
            share = _best_share(level, accepted, current, approach) if refused == 1 else 0.0
            if share > 0:
                iterate = _between(level, control, accepted.iterate, iterate, share)
                continue
            step = step / 4 if refused > 2 else 1 / level.largest_eigenvalue
            level.keep()
            kept = True
            level.displace(accepted.iterate)
            iterate = _gradient_step(level, control, accepted.iterate, accepted.approach, step)
            continue
        accepted, refused = current, 0
        if found.size:
            iterate, residual = _take_in(level, iterate, found, approach)
        if iterate.cells.size == 0:
            return _result(level, iterate, approach, violation, False, rounds, fresh)
        if (
            isinstance(control, ApproachControl)
            and operator.mean_free
            and iterate.cells.size == gap.size
            and not (math.isinf(cap) and residual.mean() <= goal)
        ):
            iterate = _lift(level, iterate, float(residual.mean()))
            before = None
            residual -= residual.mean()
            if iterate.cells.size < gap.size:
                continue
        raw = _conjugate_gradients(level, iterate.cells, iterate.values.copy(), residual, control, goal, effort)
        clipped = _clip(level, control, iterate, raw)
        if clipped.cells.size <= _FEW * clipped.capped.size and clipped.cells.size < 0.5 * iterate.cells.size:
            # fully plastic: bounds matter, elasticity hardly does, and unbounded pressures say nothing
            length = 1 / float(operator.near_field(0)[0, 0])
            iterate = _gradient_step(level, control, iterate, approach, length)
        else:
            iterate = clipped


def _lift(level: _Level, iterate: _Iterate, mean: float) -> _Iterate:
    """Change the pressure of doubly periodic full contact uniformly until a cell reaches a bound.

    This leaves the displacement as it is, so it is the only way out of a mean gap that is not the wanted one.
    """
    values = iterate.values
    values = values - values.min() if mean > 0 else values + (level.cap - values.max())
    inside = (values > 0) & (values < level.cap)
    capped = iterate.cells[values >= level.cap]
    return _Iterate(iterate.cells[inside], values[inside], capped)


@dataclass(frozen=True)
class _Accepted:
    """A pressure with its energy at approach zero, the size of the terms in it, its sum, and its work on the gap."""

    iterate: _Iterate
    approach: float
    energy: float
    size: float
    force: float
    work: float

    def above(self, other: _Accepted, approach: float) -> bool:
        """Whether the energy is higher than the other's by more than round-off."""
        rise = self.energy - other.energy - approach * (self.force - other.force)
        return rise > _ROUND_OFF * max(self.size, other.size)


def _energy(level: _Level, iterate: _Iterate) -> tuple[float, float, float, float]:
    displacement = level.flat["displacement"]
    energy, size, force, work = passes.energy(displacement, level.gap, iterate.cells, iterate.values)
    if iterate.capped.size:
        values = np.full(iterate.capped.size, level.cap)
        more = passes.energy(displacement, level.gap, iterate.capped, values)
        energy, size, force, work = energy + more[0], size + more[1], force + more[2], work + more[3]
    return energy, size, force, work


def _step_back(level: _Level, before: _Accepted, iterate: _Iterate) -> tuple[_Iterate, _Accepted | None]:
    """The lowest point between a round's ends, if the round went well beyond it; the displacement there replaces the
    one in the buffer, without a convolution. Else the round's end, with its energy.

    Changes of the sets that are each right by themselves can be too many together: without this they swing ever wider,
    or for long.
    """
    displacement, approach = level.flat["displacement"], before.approach
    now = _Accepted(iterate, approach, *_energy(level, iterate))
    # the energy's slope where the round ended, along the way from its beginning
    slope = now.work - _work(level, before.iterate) - approach * (now.force - before.force)
    rise = now.energy - before.energy - approach * (now.force - before.force)
    curvature = 2 * (slope - rise)
    if not curvature > 10 * _ROUND_OFF * max(now.size, before.size):
        return iterate, now
    share = 1 - slope / curvature
    if not _LEAST_SHARE < share < _GREATEST_SHARE:
        return iterate, now
    earlier = level.flat["before"]
    earlier *= 1 - share
    displacement *= share
    displacement += earlier
    full = _everywhere(level, before.iterate)
    full *= 1 - share
    full[iterate.cells] += share * iterate.values
    full[iterate.capped] += share * level.cap
    # a cell at the cap at both ends must stay there whatever the rounding
    full[np.intersect1d(before.iterate.capped, iterate.capped, assume_unique=True)] = level.cap
    capped = np.flatnonzero(full >= level.cap)
    inside = np.flatnonzero((full > 0) & (full < level.cap))
    return _Iterate(inside, full[inside], capped), None


def _work(level: _Level, iterate: _Iterate) -> float:
    """Sum of p (gap + displacement), with the displacement in the buffer."""
    total = passes.work(level.flat["displacement"], level.gap, iterate.cells, iterate.values)
    if iterate.capped.size:
        total += passes.work(
            level.flat["displacement"], level.gap, iterate.capped, np.full(iterate.capped.size, level.cap)
        )
    return total


def _first(level: _Level, control: Control, start: FloatArray | None) -> _Iterate:
    """A feasible pressure to begin with."""
    cells = level.gap.size
    nothing = np.empty(0, np.int64)
    if start is None:
        if isinstance(control, LoadControl):
            return _Iterate(np.arange(cells), np.full(cells, control.force / cells), nothing)
        overlapping = np.flatnonzero(level.gap < control.approach)
        return _Iterate(overlapping, np.zeros(overlapping.size), nothing)
    capped = np.flatnonzero(start >= level.cap)
    inside = np.flatnonzero((start > 0) & (start < level.cap))
    iterate = _Iterate(inside, start[inside].copy(), capped)
    if isinstance(control, LoadControl):
        if inside.size == 0 and capped.size == 0:
            return _first(level, control, None)
        return _restore_load(level, control, iterate, iterate.values)
    return iterate


def _approach(level: _Level, control: Control, iterate: _Iterate, total: float) -> float:
    """The approach that goes with the displacement in the buffer."""
    if isinstance(control, ApproachControl):
        return control.approach
    cells, capped = iterate.cells, iterate.capped
    if cells.size > _FEW * capped.size:
        return total / cells.size
    # hardly any cell says what the approach is: take the one that is violated least by all others
    deepest, nearest = passes.separations(level.flat["displacement"], level.gap, level.state)
    return deepest if deepest <= nearest else 0.5 * (deepest + nearest)


def _take_in(
    level: _Level, iterate: _Iterate, found: NDArray[np.int32], approach: float
) -> tuple[_Iterate, FloatArray]:
    """Add violating cells to those in contact, with the pressure they have."""
    state, capped = level.state, iterate.capped
    found_values = np.zeros(found.size)
    if capped.size:
        found_values[state[found] == CAPPED] = level.cap
        state[found] = CONTACT
        capped = capped[state[capped] == CAPPED]
    total = iterate.cells.size + found.size
    cells, values, residual = np.empty(total, np.int64), np.empty(total), np.empty(total)
    displacement, gap = level.flat["displacement"], level.gap
    passes.merge(
        iterate.cells, iterate.values, found, found_values, displacement, gap, approach, cells, values, residual
    )
    return _Iterate(cells, values, capped), residual


def _conjugate_gradients(
    level: _Level,
    cells: Indices,
    pressure: FloatArray,
    residual: FloatArray,
    control: Control,
    tolerance: float,
    effort: Effort,
) -> FloatArray:
    """Unbounded pressures on the cells that bring the gap there nearer to zero."""
    tuning = level.tuning
    balanced = isinstance(control, LoadControl)
    if balanced:
        residual -= residual.mean()
        if cells.size == 1:
            return pressure
    precondition = level.preconditioner(cells)
    # pressures for a rise of the approach: what brings the sum of a direction to zero
    rise, rise_total = np.empty(cells.size), 1.0
    if balanced:
        rise_total = precondition(np.ones(cells.size), rise)
        if not rise_total > 0:
            rise[:] = 1.0
            rise_total = float(cells.size)
    quick_in, quick_out = level.flat["quick_in"], level.flat["quick_out"]
    n = cells.size
    direction, preconditioned, response, previous = np.zeros(n), np.empty(n), np.empty(n), np.zeros(n)
    squares = passes.squares(residual)
    lowest, enough = squares * tuning.reduction**2, squares * tuning.least_reduction**2
    self_response = float(level.operator.near_field(0)[0, 0])
    beta = 0.0
    last = 1.0
    for iteration in range(min(tuning.iterations_per_round, effort.left)):
        total = precondition(residual, preconditioned)
        full, change = passes.turn(preconditioned, rise, total / rise_total if balanced else 0.0, residual, previous)
        if not full > 0:
            break
        beta = max(0.0, change / last) if iteration else 0.0
        last = full
        slope = passes.new_direction(direction, preconditioned, beta, cells, quick_in, residual)
        level.quick.apply(level.quick_in, level.quick_out)
        effort.iterations += 1
        mean, curvature = passes.gather_dot(quick_out, cells, response, direction)
        if not curvature > 0:
            break
        squares, largest, outside = passes.advance(
            pressure,
            residual,
            previous,
            direction,
            response,
            mean / n if balanced else 0.0,
            slope / curvature,
            level.cap,
        )
        if squares <= lowest or largest <= tuning.final * tolerance:
            break
        # clipping will bring back a residual of about this size: no use in going far below it
        if squares <= enough and largest <= tuning.clipping * self_response * outside:
            break
    passes.scatter_value(quick_in, cells, 0.0)
    return pressure


def _clip(level: _Level, control: Control, iterate: _Iterate, raw: FloatArray) -> _Iterate:
    """Back into the bounds, with the load restored."""
    if isinstance(control, LoadControl):
        return _restore_load(level, control, iterate, raw)
    below = raw <= 0
    above = raw >= level.cap
    if not (below.any() or above.any()):
        return _Iterate(iterate.cells, raw, iterate.capped)
    inside = ~(below | above)
    capped = np.sort(np.concatenate([iterate.capped, iterate.cells[above]])) if above.any() else iterate.capped
    return _Iterate(iterate.cells[inside], raw[inside], capped)


def _restore_load(level: _Level, control: LoadControl, iterate: _Iterate, raw: FloatArray) -> _Iterate:
    """Clip, and bring the sum to the given force."""
    cap = level.cap
    cells, capped = iterate.cells, iterate.capped
    if math.isinf(cap):
        inside = raw > 0
        if not inside.all():
            cells, raw = cells[inside], raw[inside]
        return _Iterate(cells, raw * (control.force / raw.sum()), capped)
    wanted = control.force - cap * capped.size
    if not 0 <= wanted <= cap * cells.size:
        # the cells at the cap alone are too many, or not enough with all others: let them take part in the shift
        raw = np.concatenate([raw, np.full(capped.size, cap)])
        cells = np.concatenate([cells, capped])
        order = np.argsort(cells, kind="stable")
        cells, raw = cells[order], raw[order]
        capped = np.empty(0, np.int64)
        wanted = control.force
        if wanted > cap * cells.size:
            everything = np.zeros(level.gap.size)
            everything[cells] = raw
            cells, raw = np.arange(level.gap.size), everything
    values = _shifted(raw, wanted, cap)
    above = values >= cap
    inside = (values > 0) & ~above
    if above.any():
        capped = np.sort(np.concatenate([capped, cells[above]]))
    cells, values = cells[inside], values[inside]
    return _Iterate(cells, values, capped)


def _shifted(raw: FloatArray, wanted: float, cap: float) -> FloatArray:
    """clip(raw + s, 0, cap) with the s that makes its sum the one wanted; `wanted` is within what the bounds allow.

    A safeguarded Newton iteration on a piecewise linear function. Counted from the largest number, which takes part
    whatever the sum, s has all its digits however small the sum is beside the numbers.
    """
    if not wanted > 0:
        return np.zeros(raw.size)
    top = float(raw.max())
    below = raw - top
    low, high = 0.0, cap - float(below.min())
    shift = max(top, 0.0)
    for _ in range(100):
        total, inside = passes.shifted_sum(below, shift, cap)
        error = total - wanted
        if abs(error) <= 4e-16 * wanted:
            break
        if error > 0:
            high = shift
        else:
            low = shift
        trial = shift - error / inside if inside else math.nan
        if not low < trial < high:
            trial = 0.5 * (low + high)
        if trial == shift:
            break
        shift = trial
    below += shift
    return np.clip(below, 0.0, cap, out=below)


def _everywhere(level: _Level, iterate: _Iterate) -> FloatArray:
    full = np.zeros(level.gap.size)
    full[iterate.cells] = iterate.values
    full[iterate.capped] = level.cap
    return full


def _project(level: _Level, control: Control, raw: FloatArray) -> _Iterate:
    """The nearest pressure within the bounds that carries the load."""
    if isinstance(control, LoadControl):
        values = _shifted(raw, control.force, level.cap if math.isfinite(level.cap) else control.force)
    else:
        values = np.clip(raw, 0.0, level.cap)
    capped = np.flatnonzero(values >= level.cap)
    inside = np.flatnonzero((values > 0) & (values < level.cap))
    return _Iterate(inside, values[inside], capped)


def _best_share(level: _Level, old: _Accepted, new: _Accepted, approach: float) -> float:
    """Where on the way from one pressure to the next the energy is least, from both energies and the slope at the end.

    The displacement of the new pressure is in the buffer. 0 if the energy rises from the start.
    """
    change = _everywhere(level, new.iterate) - _everywhere(level, old.iterate)
    slope = float((change * (level.gap + level.flat["displacement"] - approach)).sum())
    rise = new.energy - old.energy - approach * (new.force - old.force)
    curvature = 2 * (slope - rise)
    if not curvature > 0:
        return 0.0
    share = 1 - slope / curvature
    return share if _LEAST_SHARE < share < 0.98 else 0.0


def _between(level: _Level, control: Control, old: _Iterate, new: _Iterate, share: float) -> _Iterate:
    """Part of the way from one pressure to another; feasible because the bounds and the load are convex."""
    return _project(level, control, (1 - share) * _everywhere(level, old) + share * _everywhere(level, new))


def _gradient_step(level: _Level, control: Control, iterate: _Iterate, approach: float, step: float) -> _Iterate:
    """A projected gradient step; one over the largest eigenvalue cannot raise the energy."""
    gradient = level.gap + level.flat["displacement"] - approach
    return _project(level, control, _everywhere(level, iterate) - step * gradient)


def _result(
    level: _Level, iterate: _Iterate, approach: float, violation: float, converged: bool, rounds: int, fresh: bool
) -> LevelResult:
    """Hand over the level's own buffers; it is done with them."""
    pressure = level.flat["pressure"]
    passes.scatter(pressure, iterate.cells, iterate.values)
    passes.scatter_value(pressure, iterate.capped, level.cap)
    return LevelResult(pressure, level.flat["displacement"], approach, violation, converged, rounds, fresh)
