"""Contact on one grid: conjugate gradients on the cells in contact, between updates of which cells those are.

The pressure minimises p.Kp/2 + p.(gap - approach) over 0 <= p <= cap, with its sum given under load control. A round

1. applies the operator in double precision, which gives the true gap, its violations and the energy; if the way
   there led well beyond its lowest point, goes back to it: its displacement follows without another application; and
   from there to where that share of the way leads whose bounds are only then imposed, since all cells that either end
   has in contact are so in between;
2. takes in the free cells that overlap and the capped cells that open;
3. runs preconditioned conjugate gradients (`face`; with friction or a mean gap conjugate residuals, `coupled`) on the
   cells in contact, by single precision transforms; the last step, which step 4 will undo most of or which is to reach
   the tolerance, has a length known beforehand and costs none; and
4. sets free what came out below zero, caps what came out above, region by region at the same load, and restores the
   load of all.

Where the way leads upwards from its beginning a round is free to raise the energy while the largest violation falls.
Once it has not for a few rounds, such a round is taken back for a projected gradient step, which always lowers it.
From there on the energy falls, or the violation is the least so far, until a tenth of it is reached: none can repeat.

Where nearly all cells that touch are at the cap, pressures without bounds say nothing: a projected gradient step with
the load restored by one shift takes their place and needs a handful of rounds.

Friction that couples into the gap, and a mean gap, leave no energy to go by. Where the sets then swing `one_grid` has
another way.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.contact import at_once
from bem.contact.controls import ApproachControl, Control, LoadControl, MeanGapControl
from bem.contact.coupled import solve_coupled
from bem.contact.energy import Accepted, best_share, lowest_point
from bem.contact.face import Opening, solve_on_cells, take_in
from bem.contact.feasible import between, clip, first_pressure, gradient_step, lift
from bem.contact.level import Begin, Effort, Iterate, Level, LevelResult, Tolerance, Tuning
from bem.convolution import DisplacementOperator

FloatArray = NDArray[np.float64]

Close = Callable[[Level, Iterate, Opening, Control, float, Effort], FloatArray]
"""Closes the gap on the cells in contact."""

_FALL = 1e-9
"""Fall of the energy, relative to the sum of its terms, that counts as progress where no round may raise it."""

_RESOLVED = 5
"""Rounds without progress that are made where all that is missed is round-off of the transforms."""

_FEW = 0.1
"""Cells between the bounds over cells at the cap, below which the contact counts as fully plastic."""


def solve_level(
    operator: DisplacementOperator,
    gap: FloatArray,
    control: Control,
    cap: float,
    start: Begin,
    tolerance: Tolerance,
    effort: Effort,
    tuning: Tuning,
    report: Callable[[int, float, int], None] | None = None,
) -> LevelResult:
    """Solve on one grid until no contact condition is violated by more than the tolerance.

    `gap` flat, in units of its own; `cap` may be infinite; `start` a pressure within the bounds or None; `report` is
    called with iterations, violation and cells in contact after each round.
    """
    level = Level(operator, gap, cap, tuning)
    progress, guard = _Progress(tuning), _Guard()
    iterate = first_pressure(level, control, start)
    # a mean gap adds to each displacement what that of all others gives the approach: no energy either
    energetic = operator.symmetric and not isinstance(control, MeanGapControl)
    before: Accepted | None = None
    step: _Step | None = None
    while True:
        level.begin_round(iterate, keep=before is not None)
        now = _judge(level, control, iterate, before, tolerance, progress)
        if report is not None:
            report(effort.iterations, now.violation, now.iterate.cells.size + now.iterate.capped.size)
        if now.violation <= now.goal:
            return now.result(level, converged=True)
        progress.rounds += 1
        level.stride.judge(now.violation)
        if effort.left <= 0 or progress.rounds >= tuning.rounds:
            return now.result(level)
        current = now.reached
        if progress.stalls(now.violation, current.potential(control), current.size, resolved=now.resolved):
            return now.result(level, resolved=now.resolved)
        before = current if energetic else None
        improved = progress.improves(now.violation)
        progress.set_release(now.violation, guarded=energetic)
        if progress.release == 0.0:
            guard.accepted = None
        elif guard.accepted is not None and not improved and current.above(guard.accepted, now.approach):
            iterate, step = guard.take_back(level, control, guard.accepted, current), None
            continue
        guard.accepted, guard.refused = current, 0
        part = step.part(level, control, now.share) if step is not None and now.share < 1 else None
        if part is not None:
            iterate, step = part, None
            continue
        step = _next(level, control, now, effort, solve_on_cells if energetic else solve_coupled)
        if step is None:
            return now.result(level)
        iterate = step.iterate
        if step.lifted:
            before = None


@dataclass(frozen=True)
class _Round:
    """A pressure with its energy and its true gap: cells that violate their state, and by how much all do at most.

    share : of the way of the round to where it was taken back, one where it was not.
    """

    reached: Accepted
    share: float
    found: NDArray[np.int32]
    violation: float
    goal: float
    resolved: bool

    @property
    def iterate(self) -> Iterate:
        """The pressure."""
        return self.reached.iterate

    @property
    def approach(self) -> float:
        """The approach that goes with it."""
        return self.reached.approach

    def result(self, level: Level, *, converged: bool = False, resolved: bool = False) -> LevelResult:
        """As where the level ends."""
        pressure, displacement = level.handed_over(self.iterate)
        reached = pressure, displacement, self.approach, self.violation
        return LevelResult(*reached, converged=converged, fresh=self.share == 1, resolved=resolved)


@dataclass(slots=True)
class _Progress:
    """What has been reached so far: it decides when to give up, and when rounds may no longer raise the energy.

    first : violation at the start. best, mark, lowest : least violation, the same in larger strides, least energy.
    waited : rounds since the latter two got better. unimproved : rounds since `best` did. release : violation at which
    rounds are free again, 0 if free.
    """

    tuning: Tuning
    rounds: int = 0
    first: float = math.inf
    best: float = math.inf
    mark: float = math.inf
    lowest: float = math.inf
    waited: int = 0
    unimproved: int = 0
    release: float = 0.0

    def stalls(self, violation: float, potential: float, size: float, *, resolved: bool) -> bool:
        """Whether there is no use in going on: neither the violation nor, where it must, the energy falls. `resolved`
        where that is round-off."""
        fell = self.tuning.patience == 0 and potential < self.lowest - _FALL * size
        self.waited = 0 if violation < 0.7 * self.mark or fell else self.waited + 1
        self.mark, self.lowest = min(self.mark, violation), min(self.lowest, potential)
        return self.waited > (min(_RESOLVED, self.tuning.stall) if resolved else self.tuning.stall)

    def improves(self, violation: float) -> bool:
        """Whether the violation is the least so far, by a tenth."""
        improved = violation < 0.9 * self.best
        self.unimproved = 0 if improved else self.unimproved + 1
        self.best = min(self.best, violation)
        return improved

    def set_release(self, violation: float, *, guarded: bool) -> None:
        """Put rounds on the guard after too many without improvement, until a tenth of the violation is reached."""
        if self.unimproved >= self.tuning.patience and self.release == 0.0 and guarded:
            self.release = 0.1 * self.best
        elif violation <= self.release:
            self.release = 0.0


@dataclass(slots=True)
class _Guard:
    """The last pressure that was let pass, how many were refused since, and the last gradient step."""

    accepted: Accepted | None = None
    refused: int = 0
    step: float = 0.0

    def take_back(self, level: Level, control: Control, last: Accepted, refused: Accepted) -> Iterate:
        """In place of a round that raised the energy: part of its way, or a gradient step from where it began."""
        self.refused += 1
        share = best_share(level, last, refused, refused.approach) if self.refused == 1 else 0.0
        if share > 0:
            return between(level, control, last.iterate, refused.iterate, share)
        self.step = self.step / 4 if self.refused > 2 else 1 / level.largest_eigenvalue
        level.keep()
        level.displace(last.iterate)
        return gradient_step(level, control, last.iterate, last.approach, self.step)


@dataclass(frozen=True)
class _Step:
    """The next pressure; `lifted` if the way there is not one along which energies may be compared. `begun`, `raw` :
    where it began and the pressures without bounds that it was to reach."""

    iterate: Iterate
    lifted: bool = False
    begun: Iterate | None = None
    raw: FloatArray | None = None

    def part(self, level: Level, control: Control, share: float) -> Iterate | None:
        """Within the bounds from a share of the way to the pressures without. A cell in contact at either end is so all
        along the way between both: rounds that went back there would long keep cells that were let go."""
        if self.begun is None or self.raw is None:
            return None
        values = self.begun.values
        return clip(level, control, self.begun, values + share * (self.raw - values))


def _judge(
    level: Level,
    control: Control,
    iterate: Iterate,
    before: Accepted | None,
    tolerance: Tolerance,
    progress: _Progress,
) -> _Round:
    """The true gap of a pressure, or of the lowest point on the way to it; the displacement is in the buffer."""
    seen, share = level.survey(iterate, None if before is None else before.iterate), 1.0
    lowest = None if before is None else lowest_point(level, before, iterate, seen)
    if lowest is not None:
        iterate, share = lowest
        seen = level.survey(iterate)
    approach = _approach(level, control, iterate, seen.total)
    found, largest = level.violations(iterate, approach)
    violation = max(largest, seen.deepest - approach, approach - seen.nearest)
    if progress.rounds == 0:
        progress.first = violation
    goal = tolerance.of(approach, seen.reach, progress.first)
    resolved = tolerance.resolves(violation, seen.reach)
    return _Round(Accepted.of(iterate, approach, seen), share, found, violation, goal, resolved)


def _approach(level: Level, control: Control, iterate: Iterate, total: float) -> float:
    """The approach that goes with the displacement in the buffer."""
    cells, capped = iterate.cells, iterate.capped
    if isinstance(control, LoadControl):
        if cells.size > _FEW * capped.size:
            return total / cells.size
        # hardly any cell says what the approach is: take the one that is violated least by all others
        deepest, nearest = level.separations(iterate)
        return deepest if deepest <= nearest else 0.5 * (deepest + nearest)
    if isinstance(control, ApproachControl):
        return control.approach
    opening = level.outside_cap(level.gap + level.flat["displacement"], capped)
    return opening - control.mean_gap * level.gap.size / max(1, level.gap.size - capped.size)


def _next(level: Level, control: Control, now: _Round, effort: Effort, close: Close) -> _Step | None:
    """Take in the cells that violate their state, close the gap, and go back into the bounds; None without a cell."""
    if close is solve_on_cells and at_once.fits(level, now.iterate, now.found, control):
        iterate, raw = at_once.close(level, now.iterate, now.found, now.approach, control, now.goal, effort)
        return _within(level, control, now, iterate, raw)
    iterate, opening = take_in(level, now.iterate, now.found, now.approach)
    if iterate.cells.size == 0:
        return None
    if _at_full_contact(level, control, iterate, opening.mean, now.goal):
        lifted = lift(level, iterate, opening.mean)
        if lifted is not None:
            return _Step(lifted, lifted=True)
        # it is at a bound already: what varies is closed first, or the next round would be this one
        opening = Opening(opening.values - opening.mean, 0.0)
    return _within(level, control, now, iterate, close(level, iterate, opening, control, now.goal, effort))


def _within(level: Level, control: Control, now: _Round, iterate: Iterate, raw: FloatArray) -> _Step:
    """Back into the bounds from pressures without."""
    clipped = clip(level, control, iterate, raw.copy())
    if clipped.cells.size <= _FEW * clipped.capped.size and clipped.cells.size < 0.5 * iterate.cells.size:
        # fully plastic: bounds matter, elasticity hardly does, and unbounded pressures say nothing
        return _Step(gradient_step(level, control, iterate, now.approach, 1 / level.self_response))
    return _Step(clipped, begun=iterate, raw=raw)


def _at_full_contact(level: Level, control: Control, iterate: Iterate, mean: float, goal: float) -> bool:
    """Whether a doubly periodic gap is closed everywhere at an approach that this is not the mean gap of."""
    return (
        isinstance(control, ApproachControl)
        and level.operator.mean_free
        and iterate.cells.size == level.gap.size
        and not (math.isinf(level.cap) and mean <= goal)
    )
