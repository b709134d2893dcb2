"""The pressures that close the gap on a given set of cells where the equations are not symmetric: generalised conjugate
residuals, bounds left aside.

Friction that couples into the gap: the kernel is S + A, with A skew: the tractions along x that the pressures bring.
The preconditioned S is close to one, so that residuals that are least over all directions so far fall by
a / (1 + sqrt(1 + a^2)) an iteration, where a is the most that the preconditioned A does to any: 0.24 where friction
times Dundurs' beta is a half. Conjugate gradients on S alone would leave a to the next round, and lead nowhere where a
is above one.

A mean gap: the approach is the mean of gap + displacement less it, so that each pressure moves all cells. A convolution
gives that mean beside the gap on the cells, and the pressures that go with a rise of the approach precondition it.

Eisenstat, Elman & Schultz, SIAM J. Numer. Anal. 20, 1983; the rate is that of Concus & Golub, 1976.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from bem.contact.controls import Control, MeanGapControl
from bem.contact.face import Balance, Opening
from bem.contact.level import Effort, Iterate, Level

FloatArray = NDArray[np.float64]

_KEPT = 10
"""Directions that the next is made free of."""

_SURE = 2.0
"""By how much a step of known length may leave more than the one before did, where the tolerance is to be met."""


@dataclass(slots=True)
class _Residuals:
    """Pressure and residual, what the iterations so far did to it, and their directions with responses of length one.

    left : share of the residual that an iteration leaves; `length` : of its step along the preconditioned residual.
    """

    pressure: FloatArray
    residual: FloatArray
    squares: float
    left: float = 1.0
    length: float = 1.0
    ways: list[tuple[FloatArray, FloatArray]] = field(default_factory=list)

    def go(self, direction: FloatArray, response: FloatArray) -> bool:
        """Along a direction, made free of those before, to the least residual; both arrays are overwritten. False
        where nothing answers."""
        for before, answer in self.ways:
            share = float(answer @ response)
            direction -= share * before
            response -= share * answer
        size = math.sqrt(float(response @ response))
        if not size > 0:
            return False
        direction /= size
        response /= size
        self.ways = [*self.ways[1 - _KEPT :], (direction, response)]
        step = float(response @ self.residual)
        self.pressure -= step * direction
        self.residual -= step * response
        self.length = step / size
        squares = float(self.residual @ self.residual)
        # one good step does not make the next as good
        self.left = max(0.5 * self.left if self.left < 1 else 0.0, math.sqrt(squares / self.squares))
        self.squares = squares
        return True


def solve_coupled(
    level: Level, iterate: Iterate, opening: Opening, control: Control, tolerance: float, effort: Effort
) -> FloatArray:
    """Unbounded pressures on the iterate's cells that bring the gap there (overwritten) nearer to zero."""
    balance = Balance.of(level, iterate, opening, control)
    if balance is None:
        return iterate.values.copy()
    tuning, residual = level.tuning, opening.values
    now = _Residuals(iterate.values.copy(), residual, float(residual @ residual))
    lowest, enough = now.squares * tuning.reduction**2, now.squares * tuning.least_reduction**2

    def ends(pressure: FloatArray, left: float, sure: float) -> bool:
        """Whether the round ends with a pressure that leaves a share of the residual."""
        squares, largest = left**2 * now.squares, left * float(np.abs(residual).max())
        if squares <= lowest or sure * largest <= tuning.final * tolerance:
            return True
        # clipping will bring back a residual of about this size: no use in going far below it
        outside = float(np.maximum(-pressure, pressure - level.cap).max())
        return squares <= enough and largest <= tuning.clipping * level.self_response * outside

    respond = _response(level, iterate, control, balance)
    for _ in range(min(tuning.iterations_per_round, effort.left)):
        direction = np.empty(residual.size)
        balance.precondition(residual, direction, residual)
        effort.iterations += 1
        if now.ways and level.stride.trusted:
            trial = now.pressure - now.length * direction
            if ends(trial, now.left, _SURE):
                level.stride.taken = True
                return trial
        if not now.go(direction, respond(direction)) or ends(now.pressure, 1.0, 1.0):
            break
    return now.pressure


def _response(level: Level, iterate: Iterate, control: Control, balance: Balance) -> Callable[[FloatArray], FloatArray]:
    """Of the gap on the cells to a direction: less its mean under load control, less what the approach follows by
    where the mean gap is given."""
    found = level.quick_field
    sunk = found.reshape(-1)

    def respond(direction: FloatArray) -> FloatArray:
        level.quick.apply_to_cells(iterate.cells, direction, found)
        response = sunk[iterate.cells].astype(np.float64)
        if balance.kept:
            response -= response.mean()
        elif isinstance(control, MeanGapControl):
            response -= level.outside_cap(sunk, iterate.capped)
        return response

    return respond
