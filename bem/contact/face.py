"""The pressures that close the gap on a given set of cells: conjugate gradients, bounds left aside."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.contact import gradients, passes, sets
from bem.contact.controls import ApproachControl, Control, LoadControl
from bem.contact.inner import Ends, Reached, ended, solve_in_one_call, strides
from bem.contact.inverse import Descent, Inverse, Step
from bem.contact.judging import CAPPED, CONTACT
from bem.contact.level import Effort, Indices, Iterate, Level

FloatArray = NDArray[np.float64]

LEFT = 0.05
"""Share of the largest gap that a step without a convolution is taken to leave. Over a hundred contacts (rough, Hertz,
all edges and controls, capped, coated) convolutions fell by 18 % in sum with this, by 13 % with 0.15, by 6 % with 0.3.
"""

LEFT_AT_LAST = 0.1
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
    surface = level.flat["displacement"], level.gap, approach
    cells, values, residual, mean = sets.merge((iterate.cells, iterate.values), found, state, level.cap, surface)
    if capped.size:
        state[found] = CONTACT
        capped = capped[state[capped] == CAPPED]
    return Iterate(cells, values, capped), Opening(residual, mean)


def solve_on_cells(
    level: Level, iterate: Iterate, opening: Opening, control: Control, tolerance: float, effort: Effort
) -> FloatArray:
    """Unbounded pressures on the iterate's cells that bring the gap there (overwritten) nearer to zero."""
    cells, pressure, residual = iterate.cells, iterate.values.copy(), opening.values
    balance = Balance.of(level, iterate, opening, control)
    if balance is None:
        return pressure
    tuning, stride = level.tuning, level.stride
    squares = gradients.squares(residual)
    ends = Ends(
        lowest=squares * tuning.reduction**2,
        enough=squares * tuning.least_reduction**2,
        goal=tuning.final * tolerance,
        clipping=tuning.clipping * level.self_response,
        most=min(tuning.iterations_per_round, effort.left),
        trusted=stride.trusted,
        left=LEFT,
        left_at_last=LEFT_AT_LAST,
    )
    first = Step(math.inf, stride.length, level.cap)  # the first direction is the residual's own
    if cells.size <= passes.BLOCK:
        own = balance.rise, balance.share, balance.shifted
        found = solve_in_one_call(
            balance.inverse, own, cells, pressure, (residual, squares), level.quick_field, level.quick, ends, first
        )
    else:
        found = _pass_by_pass(level, balance, cells, pressure, (residual, squares), ends, first)
    effort.iterations += found.iterations
    stride.length, stride.taken = found.length, found.strode
    return found.pressure


def _pass_by_pass(
    level: Level,
    balance: Balance,
    cells: Indices,
    pressure: FloatArray,
    residual: tuple[FloatArray, float],
    ends: Ends,
    first: Step,
) -> Reached:
    """Conjugate gradients on more cells than one block has: threads share each pass."""
    convolved = level.quick_field.reshape(-1)
    n, made, length, last = cells.size, 0, first.length, first.last
    direction, preconditioned, response, previous = np.zeros(n), np.empty(n), np.empty(n), np.zeros(n)
    (values, squares), way = residual, (direction, response)
    state = pressure, values, previous
    while made < ends.most:
        known = Step(last, length, level.cap)
        descent = balance.descend(state, (preconditioned, direction, response), known)
        if not descent.full > 0:
            break
        beta, last = known.beta(descent.change), descent.full
        made += 1
        if strides(ends, squares, descent.largest, descent.outside):
            return Reached(response, made, length, True)
        slope = gradients.new_direction(direction, preconditioned, beta, values)
        level.quick.apply_to_cells(cells, direction, level.quick_field)
        mean, curvature = gradients.gather_dot(convolved, cells, response, direction)
        if not curvature > 0:
            break
        shift, length = mean / n if balance.kept else 0.0, slope / curvature
        squares, largest, outside = gradients.advance(state, way, shift, length, level.cap)
        if ended(ends, squares, largest, outside):
            break
    return Reached(pressure, made, length, False)


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
            rise, total = _rise(level, cells, inverse)
            return cls(inverse, True, rise, 1 / total, np.empty(cells.size))
        inverse = level.preconditioner(cells)
        if isinstance(control, ApproachControl):
            return cls(inverse, False, np.empty(0), 0.0, np.empty(0))
        rise, total = _rise(level, cells, inverse)
        follows = level.follows(iterate)
        return cls(inverse, False, rise, -follows / max(1 - follows * total, _STEEPEST), np.empty(0))

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
        """The preconditioned residual, and where the step known beforehand leads; as `inverse._descend` takes them."""
        (pressure, residual, previous), (preconditioned, direction, out) = state, way
        full, change = self.precondition(residual, preconditioned, previous)
        turned = (preconditioned, direction, step.beta(change))
        return Descent(full, change, *gradients.stride(pressure, turned, step.length, step.cap, residual, out))


def _rise(level: Level, cells: Indices, inverse: Inverse) -> tuple[FloatArray, float]:
    """The pressures for a rise of the approach, and their sum: the preconditioner's in the first round on a grid. Later
    rounds have them from the one before, with their mean on new cells, while these are the fewer and all sum up to more
    than half of what their number would have: another application of the preconditioner would change no count."""
    rise = np.empty(cells.size)
    total = 0.0 if level.rise is None else gradients.carry(*level.rise, cells, rise)
    if not total > 0:
        rise, total = first_rise(inverse, rise)
    level.rise = cells, rise, total
    return rise, total


def first_rise(inverse: Inverse, out: FloatArray) -> tuple[FloatArray, float]:
    """The preconditioner's pressures for a rise of the approach, and their sum; all alike where there is none."""
    total = inverse(np.ones(out.size), out)
    if not total > 0:
        out[:] = 1.0
        total = float(out.size)
    return out, total
