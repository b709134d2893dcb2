"""The pressures that close the gap on a given set of cells: conjugate gradients, bounds left aside."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.contact import gradients, passes
from bem.contact.controls import ApproachControl, Control, LoadControl
from bem.contact.inverse import Descent, Inverse, Step
from bem.contact.level import Effort, Indices, Iterate, Level
from bem.contact.passes import CAPPED, CONTACT

FloatArray = NDArray[np.float64]

_LEFT = 0.05
"""Share of the largest gap that a step without a convolution is taken to leave. Over a hundred contacts (rough, Hertz,
all edges and controls, capped, coated) convolutions fell by 18 % in sum with this, by 13 % with 0.15, by 6 % with 0.3.
"""

_LEFT_AT_LAST = 0.1
"""The same where the tolerance is to be met: a round more costs what a convolution less saves."""

_STEEPEST = 0.02
"""Fall of the mean gap with the approach, without contact one, that is counted on at least."""


@dataclass(frozen=True)
class Opening:
    """The gap on the cells in contact, and its mean."""

    values: FloatArray
    mean: float


def take_in(level: Level, iterate: Iterate, found: NDArray[np.int32], approach: float) -> tuple[Iterate, Opening]:
    """Add violating cells to those in contact, with the pressure they have; and the gap there."""
    state, capped = level.state, iterate.capped
    found_values = np.zeros(found.size)
    if capped.size:
        found_values[state[found] == CAPPED] = level.cap
        state[found] = CONTACT
        capped = capped[state[capped] == CAPPED]
    count = iterate.cells.size + found.size
    cells, values, residual = np.empty(count, np.int64), np.empty(count), np.empty(count)
    surface = (level.flat["displacement"], level.gap, approach)
    total = passes.merge(
        (iterate.cells, iterate.values), (found, found_values), surface, (cells, values, residual)
    )  # fmt: skip
    return Iterate(cells, values, capped), Opening(residual, total / max(1, count))


def solve_on_cells(
    level: Level, iterate: Iterate, opening: Opening, control: Control, tolerance: float, effort: Effort
) -> FloatArray:
    """Unbounded pressures on the iterate's cells that bring the gap there (overwritten) nearer to zero."""
    cells, pressure, residual = iterate.cells, iterate.values.copy(), opening.values
    balance = Balance.of(level, iterate, opening, control)
    if balance is None:
        return pressure
    tuning = level.tuning
    given, found = level.quick_fields
    given.fill(0.0)
    quick_in, quick_out = given.reshape(-1), found.reshape(-1)
    n = cells.size
    direction, preconditioned, response, previous = np.zeros(n), np.empty(n), np.empty(n), np.zeros(n)
    state, way = (pressure, residual, previous), (direction, response)
    squares = gradients.squares(residual)
    lowest, enough = squares * tuning.reduction**2, squares * tuning.least_reduction**2
    last = math.inf  # the first direction is the residual's own
    for _ in range(min(tuning.iterations_per_round, effort.left)):
        known = Step(last, level.stride.length, level.cap)
        descent = balance.descend(state, (preconditioned, direction, response), known)
        if not descent.full > 0:
            break
        beta, last = known.beta(descent.change), descent.full
        effort.iterations += 1
        if _strides(level, descent, tolerance, closing=_LEFT**2 * squares <= lowest):
            pressure = response
            break
        slope = gradients.new_direction(direction, preconditioned, beta, cells, quick_in, residual)
        level.quick.apply(given, found)
        mean, curvature = gradients.gather_dot(quick_out, cells, response, direction)
        if not curvature > 0:
            break
        shift, step = mean / n if balance.kept else 0.0, slope / curvature
        level.stride.length = step
        squares, largest, outside = gradients.advance(state, way, shift, step, level.cap)
        if squares <= lowest or largest <= tuning.final * tolerance:
            break
        # clipping will bring back a residual of about this size: no use in going far below it
        if squares <= enough and largest <= tuning.clipping * level.self_response * outside:
            break
    return pressure


def _strides(level: Level, descent: Descent, tolerance: float, *, closing: bool) -> bool:
    """Whether a step of a length known beforehand ends the round.

    The preconditioned kernel is close to one, so the convolution that would tell the length says little: the round to
    come applies the operator anyway, and goes back along the way if it was too long. The step is the last where it is
    to reach the tolerance, what clipping will undo, or (`closing`) what single precision can.
    """
    stride, largest, outside = level.stride, descent.largest, descent.outside
    if not stride.trusted:
        return False
    clipped = _LEFT * largest <= level.tuning.clipping * level.self_response * outside
    stride.taken = clipped or closing or _LEFT_AT_LAST * largest <= level.tuning.final * tolerance
    return stride.taken


@dataclass(frozen=True)
class Balance:
    """The preconditioner; under load control with directions whose sum is zero.

    `rise` : pressures near those for a rise of the approach. `share` : of them, in the sum of what the preconditioner
    gives, that is taken off: all of it under load control; at a given mean gap less than none, since the approach
    follows the mean displacement. `shifted` : room for a residual less its mean weighed by them, which keeps the
    preconditioner symmetric whatever they are.
    """

    inverse: Inverse
    kept: bool
    rise: FloatArray
    share: float
    shifted: FloatArray

    @classmethod
    def of(cls, level: Level, iterate: Iterate, opening: Opening, control: Control) -> Balance | None:
        """For these cells; frees the residual of its mean under load control. None if a load leaves nothing to do."""
        cells = iterate.cells
        if isinstance(control, LoadControl):
            values = opening.values
            values -= opening.mean
            if cells.size == 1:
                return None
            inverse = level.preconditioner(cells)
            rise = _rise(level, cells, inverse)
            return cls(inverse, True, rise, 1 / float(rise.sum()), np.empty(cells.size))
        inverse = level.preconditioner(cells)
        if isinstance(control, ApproachControl):
            return cls(inverse, False, np.empty(0), 0.0, np.empty(0))
        rise = _rise(level, cells, inverse)
        follows = level.follows(iterate)
        return cls(inverse, False, rise, -follows / max(1 - follows * float(rise.sum()), _STEEPEST), np.empty(0))

    def precondition(self, residual: FloatArray, out: FloatArray, previous: FloatArray) -> tuple[float, float]:
        """Write the preconditioned residual z; returns z.r and z.(r - r_previous)."""
        given = residual
        if self.kept:
            gradients.weighed_free(residual, self.rise, 1 / self.share, self.shifted)
            given = self.shifted
        total = self.inverse(given, out)
        return gradients.turn(out, self.rise, self.share * total, residual, previous)

    def descend(
        self,
        state: tuple[FloatArray, FloatArray, FloatArray],
        way: tuple[FloatArray, FloatArray, FloatArray],
        step: Step,
    ) -> Descent:
        """The preconditioned residual, and where the step known beforehand leads; as `Inverse.descend` takes them."""
        (pressure, residual, previous), (preconditioned, direction, out) = state, way
        if residual.size <= passes.BLOCK:
            return self.inverse.descend(state, way, (self.rise, self.share, self.shifted), step)
        full, change = self.precondition(residual, preconditioned, previous)
        turned = (preconditioned, direction, step.beta(change))
        return Descent(full, change, *gradients.stride(pressure, turned, step.length, step.cap, residual, out))


def _rise(level: Level, cells: Indices, inverse: Inverse) -> FloatArray:
    """The pressures for a rise of the approach: the preconditioner's in the first round on a grid. Later rounds have
    them from the one before, with their mean on new cells, while these are the fewer and all sum up to more than half
    of what their number would have: another application of the preconditioner would change no count."""
    rise = np.empty(cells.size)
    if level.rise is not None:
        before, values = level.rise
        known, total = gradients.carry(before, values, cells, rise)
        if 2 * known > cells.size and 2 * total * values.size > values.sum() * known > 0:
            rise[np.isnan(rise)] = total / known
            level.rise = cells, rise
            return rise
    if not inverse(np.ones(cells.size), rise) > 0:
        rise[:] = 1.0
    level.rise = cells, rise
    return rise
