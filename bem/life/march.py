"""March of a life through many cycles, in steps with error control by step doubling.

1. Make each step once whole and once in two halves (`advance`).
2. Their difference is the error of the halves, since a round is of first order. Accept the halves if it is within the
   tolerance; else halve the step.
3. Double the next step where the error is below 0.4 of the tolerance (`bem.life.steps`). Steps double and halve from
   the first one, so that operators are reused. A step cut to the longest allowed or to the end of the life is no power
   of two of the first, nor are those that follow if it was rejected.

A state holds all that the next step needs, so a life that is stopped and resumed ends in the same bits. Cycle jumps
with step doubling are our own. Cost: three rounds per step; each half that becomes a whole step is reused.

Verified in tests/life/test_life.py: against cycle by cycle, order in the tolerance, volume, resuming.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bem.errors import ConvergenceError
from bem.grid import FloatArray
from bem.life.positions import PositionContact, mean_over
from bem.life.steps import next_trial
from bem.life.surfaces import LifeCase, Round, Surfaces, solve_round
from bem.wear.contact_step import ContactStart
from bem.wear.setup import LOWER, UPPER

ROW = (
    *("cycles", "step", "friction", "boundary_friction", "oil_friction", "contact_share", "area_share"),
    *("minimum_film", "lambda_ratio", "lower_rms", "upper_rms", "lower_depth", "upper_depth", "tribofilm_thickness"),
    *("contact_temperature", "flash_temperature", "step_error", "depth_error"),
)
"""Columns of a row, of the unworn surfaces or at the end of a step: SI units; means over the positions of its last
round and over whole surfaces; the flash temperature is the highest of any position."""

_ROUND_OFF = float(np.finfo(np.float64).eps)
"""Round-off of heights relative to the largest, by one subtraction against two."""
_THIN = 1e-10
"""Thickness below which the tolerance of the tribofilm is absolute [m]."""
_SMALLEST = 2.0**-30
"""Smallest step relative to the first; the march fails below it."""


@dataclass(frozen=True, eq=False)
class LifeState:
    """All that the next step needs, and the record so far.

    cycles : so far. step : next trial [cycles].
    surfaces : now. first : heights before the first cycle [m].
    table : rows of columns `ROW`, (n, len(ROW)): the unworn surfaces first, then one row per step.
    rejected : number of steps that were halved.
    contacts : of the positions of the last round. convolutions : so far.
    damage : (3, nz, rows, ny) of a body's material so far: estimate, upper and lower bracket; None where not counted.
    damage_rates : (2, nz, rows, ny) damage per cycle now: of all positions as one path, and as the mean over positions
        each on its own path; None where not counted.
    """

    cycles: float
    step: float
    surfaces: Surfaces
    first: tuple[FloatArray, FloatArray]
    table: FloatArray
    rejected: int = 0
    contacts: tuple[PositionContact, ...] = ()
    damage: FloatArray | None = None
    convolutions: float = 0.0
    damage_rates: FloatArray | None = None

    def over(self, name: str) -> FloatArray:
        """Return a column of the table."""
        return np.asarray(self.table[:, ROW.index(name)])


def run_life(
    case: LifeCase,
    lower_heights: FloatArray,
    upper_heights: FloatArray,
    *,
    state: LifeState | None = None,
    callback: Callable[[LifeState], LifeState | None] | None = None,
) -> LifeState:
    """March two bodies through `case.cycles` cycles.

    Parameters
    ----------
    case : parts of the life that stay the same.
    lower_heights, upper_heights : (rows, ny) heights out of each body [m], of the substrates; at least the grid's rows.
    state : state to resume from; the heights are then ignored.
    callback : called with the state after every step; it may return the state with the damage of the step added.

    Raises
    ------
    ConvergenceError : a contact that did not converge, or steps that shrink without end.
    """
    state = initial_state(case, lower_heights, upper_heights) if state is None else state
    while state.cycles < case.cycles:
        state = advance(case, state)
        if callback is not None:
            state = callback(state) or state
    return state


def initial_state(case: LifeCase, lower: FloatArray, upper: FloatArray) -> LifeState:
    """Return the state before the first cycle, with the friction of the unworn surfaces (rows, ny) [m]."""
    tribofilm = None if case.tribofilm is None else np.full(np.shape(lower), case.tribofilm.balance.initial_thickness)
    heights = (np.array(lower, dtype=np.float64), np.array(upper, dtype=np.float64))
    unworn = Surfaces(heights, tribofilm, (ContactStart(),) * case.passing.positions)
    found = solve_round(case, unworn, 0.0)
    row = _row(found, heights, 0.0, 0.0, (0.0, 0.0))
    return LifeState(
        0.0, case.first_step, found.surfaces, heights, row[None], contacts=found.contacts, convolutions=_spent(found)
    )


def advance(case: LifeCase, state: LifeState) -> LifeState:
    """Advance by one step, halved until its error is within the tolerance."""
    step = min(state.step, case.longest, case.cycles - state.cycles)
    rejected, spent = state.rejected, state.convolutions
    whole = solve_round(case, state.surfaces, step)
    spent += _spent(whole)
    while True:
        half = solve_round(case, state.surfaces, 0.5 * step)
        end = solve_round(case, half.surfaces, 0.5 * step)
        spent += _spent(half) + _spent(end)
        error, missed = _error(state.surfaces, whole.surfaces, end.surfaces)
        if error <= case.tolerance:
            break
        step, whole, rejected = 0.5 * step, half, rejected + 1
        if step < _SMALLEST * case.first_step:
            raise ConvergenceError(f"cycle jumps shrink without end after {state.cycles:.6g} cycles")
    cycles = case.cycles if step >= case.cycles - state.cycles else state.cycles + step
    last = float(state.table[-1, -1])
    row = _row(end, state.first, cycles, step, (error, last + missed))
    return LifeState(
        cycles,
        next_trial(state.step, step, error, case.tolerance, rejected=rejected > state.rejected),
        end.surfaces,
        state.first,
        np.vstack([state.table, row]),
        rejected,
        end.contacts,
        state.damage,
        spent,
        state.damage_rates,
    )


def _spent(found: Round) -> float:
    return sum(one.convolutions for one in found.contacts)


def _error(before: Surfaces, whole: Surfaces, halves: Surfaces) -> tuple[float, float]:
    """Return the relative error of a step in two halves, the largest over bodies and tribofilm, and the error of the
    mean depth worn of both bodies [m].

    The error of a body is the rms over its surface relative to that of the depth worn in the step, so that the errors
    of all steps add up to the same fraction of the whole wear. The error of the tribofilm is relative to its thickness,
    since a film forgets its past.
    """
    worst, missed = 0.0, 0.0
    for body in (LOWER, UPPER):
        difference = whole.heights[body] - halves.heights[body]
        worn = float(np.sqrt(np.mean((before.heights[body] - halves.heights[body]) ** 2)))
        missed += abs(float(difference.mean()))
        apart, heights = float(np.sqrt(np.mean(difference**2))), before.heights[body]
        # differences below the round-off of heights are no error: steps that wear less than that grow
        if worn > 0 and apart > _ROUND_OFF * float(np.abs(heights).max()):
            worst = max(worst, apart / worn)
    if whole.tribofilm is not None and halves.tribofilm is not None:
        apart = float(np.abs(whole.tribofilm - halves.tribofilm).mean())
        worst = max(worst, apart / max(float(halves.tribofilm.mean()), _THIN))
    return worst, missed


def _row(
    found: Round,
    first: tuple[FloatArray, FloatArray],
    cycles: float,
    step: float,
    errors: tuple[float, float],
) -> FloatArray:
    """Return a row of the table, the columns as in `ROW`."""
    surfaces, contacts = found.surfaces, found.contacts
    lower, upper = surfaces.heights
    tribofilm = np.zeros(lower.shape) if surfaces.tribofilm is None else surfaces.tribofilm
    boundary, oil, *others = (mean_over(contacts, name) for name in _OF_CONTACTS)
    warm, hottest = mean_over(contacts, "contact_temperature"), max(one.flash_temperature for one in contacts)
    return np.array(
        [
            *(cycles, step, boundary + oil, boundary, oil, *others),
            *(float((lower + tribofilm).std()), float(upper.std())),
            *(float((first[body] - surfaces.heights[body]).mean()) for body in (LOWER, UPPER)),
            *(float(tribofilm.mean()), warm, hottest, *errors),
        ]
    )


_OF_CONTACTS = (*("boundary_friction", "oil_friction", "contact_share", "area_share", "minimum_film", "lambda_ratio"),)
