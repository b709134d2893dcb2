"""Result of a surface temperature, and notes on temperatures at which the constants of the materials fail."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from bem.errors import Status
from bem.grid import FloatArray
from bem.heat.bodies import Conductor
from bem.notes import Note
from bem.notes.heat import SURFACE_HOT
from bem.physical_constants import ZERO_CELSIUS
from bem.representation import readable

_ABSOLUTE_BULK = 150.0
"""Least bulk temperature that is read as absolute [K]; below it the result is read as a rise."""
_HOT_BULK = 573.15
"""Bulk temperature above which oils and hardened steels fail, 300 C [K]."""
_SOFTENING = 423.15
"""Lowest tempering temperature of through-hardened bearing steel, 150 C [K]."""
_TRANSFORMATION = 1000.0
"""Eutectoid temperature of steel, 727 C [K]."""


@readable
@dataclass(frozen=True)
class TemperatureSolution:
    """Surface temperatures of one or two bodies and the partition of heat; arrays (nx, ny), SI units.

    Attributes
    ----------
    temperature : [K], above the zero of `bulk`: mean of both surfaces where heat is generated, elsewhere of the first
        body.
    partition : fraction of the heat of each cell that enters the first body; `share` where no heat is generated.
    maximum : [K], of `temperature` where heat is generated: the hottest place of either body.
    mean : [K], of `temperature` over the cells where heat is generated, weighted by the heat.
    share : fraction of all heat that enters the first body.
    heat : [W/m^2], (bodies, nx, ny): into each body.
    surfaces : [K], (bodies, nx, ny): temperature of each body's own surface.
    iterations : applications of the bodies' operators.
    residual : largest difference between the two surfaces where heat is generated, recomputed from `heat`, over the
        larger of the largest rise and the difference of bulk temperatures; zero for one body.
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


def build_solution(
    heat: FloatArray,
    heat_into: FloatArray,
    surfaces: FloatArray,
    bodies: Sequence[Conductor],
    iterations: int,
    residual: float,
    status: Status,
) -> TemperatureSolution:
    """Build the result.

    heat : generated flux (nx, ny) [W/m^2].
    heat_into : flux into each body (bodies, nx, ny) [W/m^2]. surfaces : temperatures (bodies, nx, ny) [K].
    """
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


def _notes(maximum: float, bulk: float) -> Iterator[Note]:
    """Yield notes on a maximum temperature and the larger bulk temperature [K] at which the model's constants fail."""
    if bulk < _ABSOLUTE_BULK:
        if maximum > _TRANSFORMATION:
            yield SURFACE_HOT(rise=maximum, reason="rise")
        return
    if bulk > _HOT_BULK:
        yield SURFACE_HOT(bulk=bulk - ZERO_CELSIUS, limit=_HOT_BULK - ZERO_CELSIUS, reason="bulk")
    if maximum > _TRANSFORMATION:
        yield SURFACE_HOT(temperature=maximum - ZERO_CELSIUS, reason="transforms")
    elif maximum > _SOFTENING >= bulk:
        yield SURFACE_HOT(temperature=maximum - ZERO_CELSIUS, reason="softens")
