"""Heat shared between two bodies so that their surfaces are equally hot where it is made."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.errors import Status
from bem.grid import FloatArray
from bem.heat.bodies import Conductor
from bem.heat.krylov import gmres
from bem.heat.notes import notes_of
from bem.heat.operators import HeatOperator
from bem.heat.solution import TemperatureSolution

LIMIT = 400
"""Applications of both bodies' operators; the preconditioned system takes some ten to thirty."""


@dataclass(frozen=True)
class Pair:
    """Two half-spaces under one source.

    bodies : conductors. operators : rise of either under the heat that is being made. inverse : of their sum.
    """

    bodies: tuple[Conductor, ...]
    operators: tuple[HeatOperator, ...]
    inverse: HeatOperator


def solve_pair(
    heat: FloatArray, pair: Pair, before: Sequence[FloatArray], guess: FloatArray | None, tolerance: float
) -> TemperatureSolution:
    """The share of each cell's heat, and the temperatures.

    Heat q1 enters the first body and q - q1 the second, where any is made; elsewhere the bodies are apart. Equal
    temperatures b1 + K1 q1 = b2 + K2 (q - q1) there make the linear system (K1 + K2) q1 = K2 q + b2 - b1, whose matrix
    has a positive definite symmetric part.

    Parameters
    ----------
    heat : (nx, ny) [W/m^2].
    pair : the bodies under it.
    before : temperatures without it (bulk and heat made earlier).
    guess : for q1, or None.
    tolerance : of `TemperatureSolution.residual`.
    """
    first, second = pair.operators
    made = heat != 0
    datum = np.array([body.bulk for body in pair.bodies])

    def both(values: FloatArray) -> FloatArray:
        field = _spread(values, made)
        return (first(field) + second(field))[made]

    right = (second(heat) + before[1] - before[0])[made]
    start = 0.5 * heat[made] if guess is None else guess[made]
    values, applications, residual = start, 1, 0.0
    solution = _temperatures(values, heat, pair, before)
    goal, scale = tolerance, 0.0
    for _ in range(3):
        scale = max(float(np.abs(solution[:, made] - datum[:, None]).max(initial=0.0)), abs(datum[1] - datum[0]))
        residual = _mismatch(solution, made, scale)
        if residual <= tolerance or not made.any():
            break
        # 2-norm of the mismatch: as if it were everywhere a third of what is allowed
        found = gmres(both, right, lambda r: pair.inverse(_spread(r, made))[made], values,
                      0.3 * goal * scale * np.sqrt(made.sum()), LIMIT - applications)  # fmt: skip
        values, applications, goal = found.values, applications + found.applications, 0.1 * goal
        solution = _temperatures(values, heat, pair, before)
    residual = _mismatch(solution, made, scale)
    status = (
        Status.CONVERGED
        if residual <= tolerance
        else Status.MAX_ITERATIONS
        if applications >= LIMIT
        else Status.STALLED
    )
    flux = _spread(values, made)
    return assembled(heat, np.stack([flux, heat - flux]), solution, pair.bodies, applications, residual, status)


def assembled(
    heat: FloatArray,
    into: FloatArray,
    surfaces: FloatArray,
    bodies: Sequence[Conductor],
    iterations: int,
    residual: float,
    status: Status,
) -> TemperatureSolution:
    """The result of heat `into` (bodies, nx, ny) each body, whose surfaces are so hot."""
    made = heat != 0
    temperature = surfaces[0].copy()
    if len(surfaces) == 2:
        temperature[made] = 0.5 * (surfaces[0] + surfaces[1])[made]
    total, first = float(heat.sum()), float(into[0].sum())
    size = float(np.abs(heat).sum())
    share = first / total if abs(total) > 1e-12 * size else float("nan")
    partition = np.full(heat.shape, share)
    np.divide(into[0], heat, out=partition, where=made)
    maximum = float(temperature[made].max()) if made.any() else float(surfaces.max())
    mean = float((temperature * np.abs(heat)).sum() / size) if size else float(temperature.mean())
    notes = notes_of(maximum, bodies)
    return TemperatureSolution(
        temperature, partition, maximum, mean, share, into, surfaces, iterations, residual, status, notes
    )


def _temperatures(values: FloatArray, heat: FloatArray, pair: Pair, before: Sequence[FloatArray]) -> FloatArray:
    flux = _spread(values, heat != 0)
    first, second = pair.operators
    return np.stack([before[0] + first(flux), before[1] + second(heat - flux)])


def _mismatch(surfaces: FloatArray, made: NDArray[np.bool_], scale: float) -> float:
    difference = float(np.abs((surfaces[0] - surfaces[1])[made]).max(initial=0.0))
    return difference / scale if scale else difference


def _spread(values: FloatArray, made: NDArray[np.bool_]) -> FloatArray:
    field = np.zeros(made.shape)
    field[made] = values
    return field
