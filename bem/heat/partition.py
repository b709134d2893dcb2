"""Partition of heat between two bodies whose surfaces are equally hot where heat is generated, and the result.

Heat q1 enters the first body and q - q1 the second, in the cells where the source is not zero (the *heated mask*);
elsewhere the bodies exchange none. Equal temperatures b1 + K1 q1 = b2 + K2 (q - q1) in the heated cells give the linear
system

    (K1 + K2) q1 = K2 q + b2 - b1,

whose matrix has a positive definite symmetric part. K1 and K2 are the bodies' operators, b1 and b2 the temperatures
without the present heat (bulk, and what earlier heat has left).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.errors import Status
from bem.grid import FloatArray
from bem.heat.bodies import Conductor
from bem.heat.operators import HeatOperator
from bem.notes import Note
from bem.notes.heat import BULK_HOT, RISE_TRANSFORMS, SURFACE_SOFTENS, SURFACE_TRANSFORMS
from bem.numerics.gmres import gmres
from bem.representation import readable

LIMIT = 400
"""Largest number of applications of both bodies' operators; the preconditioned system takes ten to thirty."""
_SOLVES = 3
"""Largest number of solves, each to a tenth of the tolerance before it: GMRES bounds a 2-norm, not a maximum."""

_ZERO_CELSIUS = 273.15
"""Absolute temperature of 0 C [K]."""
_ABSOLUTE_BULK = 150.0
"""Bulk temperatures from here on are absolute temperatures [K]; with smaller ones the result is a rise."""
_HOT_BULK = 573.15
"""Bulk temperature above which oils and hardened steels fail, 300 C [K]."""
_SOFTENING = 423.15
"""Lowest tempering temperature of through-hardened bearing steel, 150 C [K]."""
_TRANSFORMATION = 1000.0
"""Eutectoid temperature of steel, 727 C [K]."""


@readable
@dataclass(frozen=True)
class TemperatureSolution:
    """Surface temperatures; arrays (nx, ny), SI units.

    Attributes
    ----------
    temperature : [K], above the zero of `bulk`: of the common surface where heat is made, elsewhere of the first body.
    partition : share of the heat that enters the first body; where no heat is made, `share`.
    maximum : [K], of `temperature` where heat is made: the hottest place of either body.
    mean : [K], of `temperature` over the cells where heat is made, weighted by the heat.
    share : of all heat that enters the first body.
    heat : [W/m^2], (bodies, nx, ny): into each body.
    surfaces : [K], (bodies, nx, ny): temperature of each body's own surface.
    iterations : applications of the bodies' operators.
    residual : largest difference between the two surfaces where heat is made, recomputed from `heat`, over the largest
        rise (or difference of bulk temperatures, where that is more); of one body zero.
    status : outcome; `residual` is at most the tolerance if it is converged.
    notes : on the limits of this result.
    """

    temperature: FloatArray
    partition: FloatArray
    maximum: float
    mean: float
    share: float
    heat: FloatArray
    surfaces: FloatArray
    iterations: int
    residual: float
    status: Status
    notes: tuple[Note, ...] = ()


@dataclass(frozen=True)
class Pair:
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
    heat: FloatArray, pair: Pair, before: Sequence[FloatArray], guess: FloatArray | None, tolerance: float
) -> TemperatureSolution:
    """Solve for the partition of heat and the surface temperatures of a pair.

    Parameters
    ----------
    heat : source (nx, ny) [W/m^2].
    pair : the bodies.
    before : temperature of each surface (nx, ny) without the present heat [K].
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

    right = (second(heat) + before[1] - before[0])[heated_mask]
    values = 0.5 * heat[heated_mask] if guess is None else guess[heated_mask]
    surfaces = _surface_temperatures(values, heat, pair, before)
    applications, goal, scale = 1, tolerance, 0.0
    for _ in range(_SOLVES):
        largest_rise = float(np.abs(surfaces[:, heated_mask] - bulk[:, None]).max(initial=0.0))
        scale = max(largest_rise, abs(bulk[1] - bulk[0]))
        if _mismatch(surfaces, heated_mask, scale) <= tolerance or not heated_mask.any():
            break
        # 2-norm of a mismatch that is everywhere 0.3 of what is allowed
        norm_goal = 0.3 * goal * scale * np.sqrt(heated_mask.sum())
        solved = gmres(sum_of_operators, right, precondition, values, norm_goal, LIMIT - applications)
        values, applications, goal = solved.values, applications + solved.applications, 0.1 * goal
        surfaces = _surface_temperatures(values, heat, pair, before)
    residual = _mismatch(surfaces, heated_mask, scale)
    unmet = Status.MAX_ITERATIONS if applications >= LIMIT else Status.STALLED
    status = Status.CONVERGED if residual <= tolerance else unmet
    flux = _on_grid(values, heated_mask)
    heat_into = np.stack([flux, heat - flux])
    return temperature_solution(heat, heat_into, surfaces, pair.bodies, applications, residual, status)


def temperature_solution(
    heat: FloatArray,
    heat_into: FloatArray,
    surfaces: FloatArray,
    bodies: Sequence[Conductor],
    iterations: int,
    residual: float,
    status: Status,
) -> TemperatureSolution:
    """Build the result from the heat into each body and the temperature of each surface, both (bodies, nx, ny)."""
    heated_mask = heat != 0
    temperature = surfaces[0].copy()
    if len(surfaces) == 2:
        temperature[heated_mask] = 0.5 * (surfaces[0] + surfaces[1])[heated_mask]
    total, first = float(heat.sum()), float(heat_into[0].sum())
    size = float(np.abs(heat).sum())
    share = first / total if abs(total) > 1e-12 * size else float("nan")
    partition = np.full(heat.shape, share)
    np.divide(heat_into[0], heat, out=partition, where=heated_mask)
    maximum = float(temperature[heated_mask].max()) if heated_mask.any() else float(surfaces.max())
    mean = float((temperature * np.abs(heat)).sum() / size) if size else float(temperature.mean())
    notes = tuple(_notes(maximum, max(body.bulk for body in bodies)))
    return TemperatureSolution(
        temperature, partition, maximum, mean, share, heat_into, surfaces, iterations, residual, status, notes
    )


def _surface_temperatures(values: FloatArray, heat: FloatArray, pair: Pair, before: Sequence[FloatArray]) -> FloatArray:
    """Return the temperature of both surfaces (2, nx, ny) for the heat into the first body in the heated cells."""
    flux = _on_grid(values, heat != 0)
    first, second = pair.operators
    return np.stack([before[0] + first(flux), before[1] + second(heat - flux)])


def _mismatch(surfaces: FloatArray, heated_mask: NDArray[np.bool_], scale: float) -> float:
    """Largest difference of the two surfaces in the heated cells, over `scale` if it is not zero."""
    difference = float(np.abs((surfaces[0] - surfaces[1])[heated_mask]).max(initial=0.0))
    return difference / scale if scale else difference


def _on_grid(values: FloatArray, heated_mask: NDArray[np.bool_]) -> FloatArray:
    """Return a field with these values in the heated cells and zero elsewhere."""
    field = np.zeros(heated_mask.shape)
    field[heated_mask] = values
    return field


def _notes(maximum: float, bulk: float) -> Iterator[Note]:
    """Yield notes on a maximum temperature and the larger bulk temperature [K] at which the model's constants fail."""
    if bulk < _ABSOLUTE_BULK:
        if maximum > _TRANSFORMATION:
            yield RISE_TRANSFORMS(rise=maximum)
        return
    if bulk > _HOT_BULK:
        yield BULK_HOT(bulk=bulk - _ZERO_CELSIUS, limit=_HOT_BULK - _ZERO_CELSIUS)
    if maximum > _TRANSFORMATION:
        yield SURFACE_TRANSFORMS(temperature=maximum - _ZERO_CELSIUS)
    elif maximum > _SOFTENING >= bulk:
        yield SURFACE_SOFTENS(temperature=maximum - _ZERO_CELSIUS)
