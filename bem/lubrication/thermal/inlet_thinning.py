"""Thinning of the oil by inlet heating, of line and point contacts.

Shear in the inlet heats the oil and thins the film by a factor (`bem.lubrication.inlet_heating`). The isothermal
solvers have one viscosity, so the film is that of an oil whose viscosity, at every pressure, is the share of its own
with which the central film is thinned by just that factor:

1. Films go like a power of the viscosity; a fit gives the first exponent.
2. The logarithm of the viscosity is found by secants, from the isothermal film on (`find_thinning`). Cost: two or three
   films.

Verified in tests/lubrication/test_thermal_film.py and test_thermal_point.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import ClassVar

from bem.grid import FloatArray
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.viscosity import ViscosityLaw

FACTOR_TOLERANCE = 5e-3
"""Relative tolerance of the thinned film; the factor itself is known to some 0.05."""


@dataclass(frozen=True)
class ThinnedLaw(ViscosityLaw):
    """Viscosity law of an oil whose viscosity is a share of that of another oil at every pressure."""

    name: ClassVar[str] = "thinned"
    law: ViscosityLaw
    share: float

    @property
    def described(self) -> ViscosityLaw:
        """The law of the other oil."""
        return self.law.described

    def log_viscosity_ratio(
        self, pressure: FloatArray, viscosity: float, pressure_viscosity: float
    ) -> tuple[FloatArray, FloatArray]:
        """Return ln of the viscosity ratio of the other oil, and its slope."""
        return self.law.log_viscosity_ratio(pressure, viscosity / self.share, pressure_viscosity)


def thinned_oil(lubricant: Lubricant, share: float) -> Lubricant:
    """Return the oil with a share of its viscosity at every pressure."""
    law = ThinnedLaw(lubricant.viscosity_law, share)
    return replace(lubricant, viscosity=lubricant.viscosity * share, viscosity_law=law)


@dataclass(frozen=True)
class Thinning:
    """Viscosity with which a film is as thin as wanted.

    log_viscosity : ln of the viscosity over that of the oil.
    deviation : of the film from the wanted film, relative; infinite where a film was not found.
    """

    log_viscosity: float
    deviation: float


def find_thinning(
    log_film: Callable[[float], float], wanted: float, exponent: float, films: int, tolerance: float
) -> Thinning:
    """Find the viscosity of a wanted film by secants.

    Parameters
    ----------
    log_film : returns ln of the central film over the isothermal film, at ln of a viscosity over that of the oil; NaN
        where there is no film.
    wanted : ln of the wanted film over the isothermal film.
    exponent : d(log_film)/d(ln viscosity), to begin with.
    films : largest number of films.
    tolerance : on the film, relative.
    """
    ratio, reached, deviation = 0.0, 0.0, abs(math.expm1(-wanted))
    for _ in range(films):
        last = ratio, reached
        ratio += (wanted - reached) / exponent
        reached = log_film(ratio)
        deviation = abs(math.expm1(reached - wanted))
        if not math.isfinite(deviation):
            return Thinning(ratio, math.inf)
        if deviation <= tolerance:
            break
        if reached != last[1] and ratio != last[0]:
            exponent = (reached - last[1]) / (ratio - last[0])
    return Thinning(ratio, deviation)
