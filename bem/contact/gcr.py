"""Generalised conjugate residuals on the active cells, where the equations are not symmetric.

Step 9 of `bem.contact` with friction in the gap or a prescribed mean gap (`pcg` otherwise). Friction that couples into
the gap adds a skew part A to the kernel S. The preconditioned S is close to one, so the least residual over all
directions falls by a / (1 + sqrt(1 + a^2)) per iteration, where a is the norm of the preconditioned A: 0.24 where
friction times Dundurs' beta is one half. Conjugate gradients on S alone would diverge for a above one.

A prescribed mean gap makes the approach follow the mean displacement, so that each pressure moves all cells. One
convolution gives that mean together with the gap, and the pressure of a unit approach preconditions it.

Eisenstat, Elman & Schultz, SIAM J. Numer. Anal. 20, 1983; the rate is that of Concus & Golub, 1976.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from bem.contact import pcg
from bem.contact.controls import Control
from bem.contact.grid_workspace import ActiveCells, GridWorkspace, IterationBudget

FloatArray = NDArray[np.float64]

_DIRECTIONS = 10
"""Directions that the next one is made orthogonal to."""

_SAFETY = 2.0
"""Factor on the expected residual of an extrapolated step where the tolerance is to be met."""


@dataclass(slots=True)
class _State:
    """Pressure, residual and normalised directions.

    squares : sum of squared residuals. reduction : relative residual of an iteration, expected of the next one.
    length : of the last step along the preconditioned residual. directions : with responses of norm one.
    """

    pressure: FloatArray
    residual: FloatArray
    squares: float
    reduction: float = 1.0
    length: float = 1.0
    directions: list[tuple[FloatArray, FloatArray]] = field(default_factory=list)

    def step(self, direction: FloatArray, response: FloatArray) -> bool:
        """Minimise the residual along an orthogonalised direction (both overwritten); False if it has no response."""
        for earlier, earlier_response in self.directions:
            component = float(earlier_response @ response)
            direction -= component * earlier
            response -= component * earlier_response
        size = math.sqrt(float(response @ response))
        if not size > 0:
            return False
        direction /= size
        response /= size
        self.directions = [*self.directions[1 - _DIRECTIONS :], (direction, response)]
        step = float(response @ self.residual)
        self.pressure -= step * direction
        self.residual -= step * response
        self.length = step / size
        squares = float(self.residual @ self.residual)
        # one good step does not make the next as good
        expected = 0.5 * self.reduction if self.reduction < 1 else 0.0
        self.reduction = max(expected, math.sqrt(squares / self.squares))
        self.squares = squares
        return True


def close_gap(
    grid: GridWorkspace, active: ActiveCells, control: Control, goal: float, budget: IterationBudget
) -> FloatArray:
    """Return pressures without bounds on the active cells that bring their gap (overwritten) closer to zero.

    Under a prescribed load the gap is brought closer to a uniform value, which is a change of the approach.
    """
    iterate, residual, parameters = active.iterate, active.gap, grid.parameters
    cells = iterate.cells
    if control.zero_sum:
        residual -= active.mean_residual
        if cells.size == 1:
            return iterate.values.copy()
    inverse = grid.preconditioner_on(active)
    unit_approach, coefficient = np.empty(0), 0.0
    if control.uses_unit_approach:
        _, unit_approach, total = grid.find_unit_approach(active)
        coefficient = control.unit_approach_coefficient(grid, iterate, total)
    weighted = np.empty(cells.size if control.zero_sum else 0)
    now = _State(iterate.values.copy(), residual, float(residual @ residual))
    lowest, enough = now.squares * parameters.relative_residual**2, now.squares * parameters.clip_allowed_below**2

    def ends(pressure: FloatArray, reduction: float, safety: float) -> bool:
        """Return True if a pressure that leaves a fraction of the residual meets a criterion."""
        squares, largest = reduction**2 * now.squares, reduction * float(np.abs(residual).max())
        if squares <= lowest or safety * largest <= parameters.tolerance_fraction * goal:
            return True
        # clipping will bring back a residual of about this size
        outside = float(np.maximum(-pressure, pressure - grid.cap).max())
        return squares <= enough and largest <= parameters.clip_residual_ratio * grid.self_response * outside

    for _ in range(min(parameters.iterations_per_round, budget.left)):
        direction, right_side = np.empty(cells.size), residual
        if control.zero_sum:
            pcg.subtract_mean(residual, unit_approach, 1 / coefficient, weighted)
            right_side = weighted
        pcg.constrain(direction, unit_approach, coefficient * inverse(right_side, direction), residual, residual)
        budget.iterations += 1
        if now.directions and grid.extrapolation.trusted:
            trial = now.pressure - now.length * direction
            if ends(trial, now.reduction, _SAFETY):
                grid.extrapolation.taken = True
                return trial
        grid.single.apply_to_cells(cells, direction, grid.single_field)
        response = grid.single_field.reshape(-1)[cells].astype(np.float64)
        response -= control.approach_change(response, grid, iterate)
        if not now.step(direction, response) or ends(now.pressure, 1.0, 1.0):
            break
    return now.pressure
