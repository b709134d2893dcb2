"""A life of many cycles in jumps whose error is known: each is made once whole and once in two halves.

The halves stay; their difference from the whole is the halves' own error, since a round is of first order. Steps are
powers of two times the first (but the last, and the longest allowed), so that operators are made once. A state holds
all that the next step needs: a life that is stopped goes on to the same bits. Cycle jumps with step doubling are ours.

Verified in tests/life/test_life.py: against cycle by cycle, order in the tolerance, volume, resuming.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bem.errors import ConvergenceError
from bem.friction.balance import BalanceStart
from bem.grid import FloatArray
from bem.life.passes import Pass, mean_over
from bem.life.surfaces import LifeCase, Round, Surfaces, round_of
from bem.wear.setup import LOWER, UPPER

ROW = (
    *("cycles", "step", "friction", "boundary_friction", "film_friction", "contact_share", "area_share"),
    *("minimum_film", "lambda_ratio", "lower_rms", "upper_rms", "lower_depth", "upper_depth", "film_thickness"),
    *("contact_temperature", "flash_temperature", "step_error", "depth_error"),
)
"""A step's end as a row of numbers: SI units; means over the positions of its last round and over whole surfaces;
the flash temperature is the highest of any position."""

_ROUND_OFF = float(np.finfo(np.float64).eps)
"""Of the largest height: one subtraction against two, each rounded by half of it at most."""
_THIN = 1e-10
"""Films thinner than this [m] are held to an absolute instead of a relative tolerance."""
_SMALLEST = 2.0**-30
"""Of the first step: a step below it will not help."""


@dataclass(frozen=True, eq=False)
class LifeState:
    """All that the next step needs, and the record so far.

    cycles : so far. step : to try next [cycles]. surfaces : now; first : heights before the first cycle. rows : (n,
    len(ROW)). rejected : how many steps were made shorter. passes : of the last round. damage : (5, nz, rows, ny) of a
    body's material where it is counted: so far, at most and at least, and of a cycle as one path and position by
    position. convolutions : spent.
    """

    cycles: float
    step: float
    surfaces: Surfaces
    first: tuple[FloatArray, FloatArray]
    rows: FloatArray
    rejected: int = 0
    passes: tuple[Pass, ...] = ()
    damage: FloatArray | None = None
    convolutions: float = 0.0

    def over(self, name: str) -> FloatArray:
        """A column of the rows."""
        return np.asarray(self.rows[:, ROW.index(name)])


def run_life(
    case: LifeCase,
    lower_heights: FloatArray,
    upper_heights: FloatArray,
    *,
    state: LifeState | None = None,
    callback: Callable[[LifeState], LifeState | None] | None = None,
) -> LifeState:
    """Wear two bodies over `case.cycles` cycles.

    Parameters
    ----------
    case : what stays the same.
    lower_heights, upper_heights : (rows, ny) heights out of each body [m], of the substrates; at least the grid's rows.
    state : to go on from; the heights are then ignored.
    callback : called with the state after every step; it may hand back another one, with the damage that the step did.

    Raises
    ------
    ConvergenceError : a contact that did not converge, or steps that shrink without end.
    """
    state = begun(case, lower_heights, upper_heights) if state is None else state
    while state.cycles < case.cycles:
        state = advance(case, state)
        if callback is not None:
            state = callback(state) or state
    return state


def begun(case: LifeCase, lower: FloatArray, upper: FloatArray) -> LifeState:
    """Before the first cycle, with the friction of unworn surfaces (rows, ny) [m]."""
    film = None if case.film is None else np.full(np.shape(lower), case.film.balance.initial_thickness)
    heights = (np.array(lower, dtype=np.float64), np.array(upper, dtype=np.float64))
    unworn = Surfaces(heights, film, (BalanceStart(),) * case.passing.positions)
    found = round_of(case, unworn, 0.0)
    row = _row(found, heights, 0.0, 0.0, (0.0, 0.0))
    return LifeState(
        0.0, case.first_step, found.surfaces, heights, row[None], passes=found.passes, convolutions=_spent(found)
    )


def advance(case: LifeCase, state: LifeState) -> LifeState:
    """One jump, made shorter until its error is within the tolerance."""
    step = min(state.step, case.longest, case.cycles - state.cycles)
    rejected, spent = state.rejected, state.convolutions
    whole = round_of(case, state.surfaces, step)
    spent += _spent(whole)
    while True:
        half = round_of(case, state.surfaces, 0.5 * step)
        end = round_of(case, half.surfaces, 0.5 * step)
        spent += _spent(half) + _spent(end)
        error, missed = _error(state.surfaces, whole.surfaces, end.surfaces)
        if error <= case.tolerance:
            break
        step, whole, rejected = 0.5 * step, half, rejected + 1
        if step < _SMALLEST * case.first_step:
            raise ConvergenceError(f"cycle jumps shrink without end after {state.cycles:.6g} cycles")
    cycles = case.cycles if step >= case.cycles - state.cycles else state.cycles + step
    last = float(state.rows[-1, -1])
    row = _row(end, state.first, cycles, step, (error, last + missed))
    longer = 2.0 if error < 0.4 * case.tolerance else 1.0
    tried = step if step >= state.step or rejected > state.rejected else state.step
    return LifeState(
        cycles,
        tried * longer,
        end.surfaces,
        state.first,
        np.vstack([state.rows, row]),
        rejected,
        end.passes,
        state.damage,
        spent,
    )


def _spent(found: Round) -> float:
    return sum(one.convolutions for one in found.passes)


def _error(before: Surfaces, whole: Surfaces, halves: Surfaces) -> tuple[float, float]:
    """Relative error of a step made in two halves, the largest over bodies and film; and that of the mean depth worn of
    both bodies [m].

    Of a body the rms over the surface relative to that of what wore in the step, so that the errors of all steps add up
    to the same part of all that wears; of the film relative to its thickness, since what it was is forgotten.
    """
    worst, missed = 0.0, 0.0
    for body in (LOWER, UPPER):
        difference = whole.heights[body] - halves.heights[body]
        worn = float(np.sqrt(np.mean((before.heights[body] - halves.heights[body]) ** 2)))
        missed += abs(float(difference.mean()))
        apart, heights = float(np.sqrt(np.mean(difference**2))), before.heights[body]
        # heights tell no less than their round-off: steps that wear less grow, however they differ
        if worn > 0 and apart > _ROUND_OFF * float(np.abs(heights).max()):
            worst = max(worst, apart / worn)
    if whole.film is not None and halves.film is not None:
        apart = float(np.abs(whole.film - halves.film).mean())
        worst = max(worst, apart / max(float(halves.film.mean()), _THIN))
    return worst, missed


def _row(
    found: Round,
    first: tuple[FloatArray, FloatArray],
    cycles: float,
    step: float,
    errors: tuple[float, float],
) -> FloatArray:
    """As `ROW`."""
    surfaces, passes = found.surfaces, found.passes
    lower, upper = surfaces.heights
    film = np.zeros(lower.shape) if surfaces.film is None else surfaces.film
    boundary, oil, *others = (mean_over(passes, name) for name in _OF_PASSES)
    warm, hottest = mean_over(passes, "contact_temperature"), max(one.flash_temperature for one in passes)
    return np.array(
        [
            *(cycles, step, boundary + oil, boundary, oil, *others),
            *(float((lower + film).std()), float(upper.std())),
            *(float((first[body] - surfaces.heights[body]).mean()) for body in (LOWER, UPPER)),
            *(float(film.mean()), warm, hottest, *errors),
        ]
    )


_OF_PASSES = (*("boundary_friction", "film_friction", "contact_share", "area_share", "minimum_film", "lambda_ratio"),)
