"""The result of heat conduction under a contact."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.errors import Status
from bem.representation import readable

FloatArray = NDArray[np.float64]


@readable
@dataclass(frozen=True)
class TemperatureSolution:
    """Surface temperatures; arrays (nx, ny), SI units.

    Attributes
    ----------
    temperature : [K], above the zero of `bulk`: of the common surface where heat is made, elsewhere of the first body.
    partition : share of the heat that enters the first body; where no heat is made, `share`.
    maximum : [K], of `temperature` where heat is made: the hottest place of either body.
    mean : [K], of `temperature` over the cells where heat is made, weighed by the heat.
    share : of all heat that enters the first body.
    heat : [W/m^2], (bodies, nx, ny): into each body.
    surfaces : [K], (bodies, nx, ny): temperature of each body's own surface.
    iterations : applications of the bodies' operators.
    residual : largest difference between the two surfaces where heat is made, recomputed from `heat`, over the largest
        rise (or difference of bulk temperatures, where that is more); of one body zero.
    status : outcome; `residual` is at most the tolerance if it is converged.
    notes : sentences on what this temperature should not be believed in.
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
    notes: tuple[str, ...] = ()
