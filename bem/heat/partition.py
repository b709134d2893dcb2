"""Partition of heat between two bodies whose surfaces are equally hot where heat is generated.

Heat q1 enters the first body and q - q1 the second, in the cells where the source is not zero (the *heated mask*);
elsewhere the bodies exchange none. Equal temperatures b1 + K1 q1 = b2 + K2 (q - q1) in the heated cells give the linear
system

    (K1 + K2) q1 = K2 q + b2 - b1,

whose matrix has a positive definite symmetric part. K1 and K2 are the bodies' operators, b1 and b2 the *background*
temperatures without the present heat (bulk, and the rise by earlier heat). It is Blok's condition (1937) for each cell
in place of the maximum.

1. GMRES solves the system (`bem.numerics.gmres`), preconditioned by `operators.approximate_inverse`. Cost: two
   convolutions and one for the preconditioner per iteration, ten to thirty iterations.
2. Both surfaces are recomputed. If their largest difference exceeds the tolerance, GMRES continues with a tenth of its
   goal, because it bounds a 2-norm; at most three solves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.errors import Status
from bem.grid import FloatArray
from bem.heat.bodies import Conductor
from bem.heat.operators import HeatOperator
from bem.heat.solution import TemperatureSolution, build_solution
from bem.numerics.gmres import gmres

TOLERANCE = 1e-8
"""Default bound on the difference of the two surfaces, over the largest rise."""
_MAX_APPLICATIONS = 400
"""Limit of the applications of both bodies' operators."""
_SOLVES = 3
"""Limit of the solves, each to a tenth of the goal of the last one."""


@dataclass(frozen=True)
class BodyPair:
    """Two half-spaces under one heat source.

    Attributes
    ----------
    bodies : two conductors.
    operators : temperature rise of each body under the present heat.
    preconditioner : approximate inverse of the sum of both operators.
    """

    bodies: tuple[Conductor, ...]
    operators: tuple[HeatOperator, ...]
    preconditioner: HeatOperator


def solve_partition(
    heat: FloatArray, pair: BodyPair, background: Sequence[FloatArray], guess: FloatArray | None, tolerance: float
) -> TemperatureSolution:
    """Solve for the partition of heat and the surface temperatures of a pair.

    Parameters
    ----------
    heat : source (nx, ny) [W/m^2].
    pair : the bodies.
    background : temperature of each surface (nx, ny) without the present heat [K].
    guess : initial guess (nx, ny) of the heat into the first body [W/m^2]; None takes half.
    tolerance : bound on `TemperatureSolution.residual`.
    """
    first, second = pair.operators
    heated_mask = heat != 0
    bulk = np.array([body.bulk for body in pair.bodies])

    def sum_of_operators(values: FloatArray) -> FloatArray:
        flux = _on_grid(values, heated_mask)
        return (first(flux) + second(flux))[heated_mask]

    def precondition(residual: FloatArray) -> FloatArray:
        return pair.preconditioner(_on_grid(residual, heated_mask))[heated_mask]

    right = (second(heat) + background[1] - background[0])[heated_mask]
    values = 0.5 * heat[heated_mask] if guess is None else guess[heated_mask]
    surfaces = _surface_temperatures(values, heat, pair, background)
    applications, goal, scale = 1, tolerance, 0.0
    for _ in range(_SOLVES):
        largest_rise = float(np.abs(surfaces[:, heated_mask] - bulk[:, None]).max(initial=0.0))
        scale = max(largest_rise, abs(bulk[1] - bulk[0]))
        if _mismatch(surfaces, heated_mask, scale) <= tolerance or not heated_mask.any():
            break
        # 2-norm of a mismatch that is everywhere 0.3 of what is allowed
        norm_goal = 0.3 * goal * scale * np.sqrt(heated_mask.sum())
        solved = gmres(sum_of_operators, right, precondition, values, norm_goal, _MAX_APPLICATIONS - applications)
        values, applications, goal = solved.values, applications + solved.applications, 0.1 * goal
        surfaces = _surface_temperatures(values, heat, pair, background)
    residual = _mismatch(surfaces, heated_mask, scale)
    unmet = Status.MAX_ITERATIONS if applications >= _MAX_APPLICATIONS else Status.STALLED
    status = Status.CONVERGED if residual <= tolerance else unmet
    flux = _on_grid(values, heated_mask)
    heat_into = np.stack([flux, heat - flux])
    return build_solution(heat, heat_into, surfaces, pair.bodies, applications, residual, status)


def _surface_temperatures(
    values: FloatArray, heat: FloatArray, pair: BodyPair, background: Sequence[FloatArray]
) -> FloatArray:
    """Return the temperature of both surfaces (2, nx, ny) for the heat into the first body in the heated cells."""
    flux = _on_grid(values, heat != 0)
    first, second = pair.operators
    return np.stack([background[0] + first(flux), background[1] + second(heat - flux)])


def _mismatch(surfaces: FloatArray, heated_mask: NDArray[np.bool_], scale: float) -> float:
    """Return the largest difference of the two surfaces in the heated cells, over `scale` if it is not zero."""
    difference = float(np.abs((surfaces[0] - surfaces[1])[heated_mask]).max(initial=0.0))
    return difference / scale if scale else difference


def _on_grid(values: FloatArray, heated_mask: NDArray[np.bool_]) -> FloatArray:
    """Return a field with these values in the heated cells and zero elsewhere."""
    field = np.zeros(heated_mask.shape)
    field[heated_mask] = values
    return field
