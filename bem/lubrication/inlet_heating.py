"""Inlet shear heating: by how much the film of a line contact is thinner than the isothermal one.

Gupta, Cheng, Zhu, Forster and Schrand, J. Tribol. 114 (1992) 55: with L = mu0 beta u^2/k of the mean speed u, slide-to-
roll ratio S and Hertz pressure p_h over E' = 2 E*,

    factor = (1 - 13.2 p_h/E' L^0.42) / (1 + 0.213 (1 + 2.23 S^0.83) L^0.64),

fitted to thermal solutions of loads and speeds as bearings have. The constants are written from memory of how others
quote them: they were not compared with the paper, and no test holds them against a thermal solution. Beyond those loads
and speeds the numerator passes zero; it is kept at `LEAST_NUMERATOR`, and said. That films follow it is verified in
tests/lubrication/test_thermal_film.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

LEAST_NUMERATOR = 0.5
"""Below it the fit, which no film follows to zero, is called extrapolated: our own bound, not the source's."""


@dataclass(frozen=True)
class InletHeating:
    """Factor on the film thickness, the thermal loading L, and whether the fit is extrapolated."""

    factor: float
    loading: float
    extrapolated: bool


def inlet_heating_factor(
    viscosity: float, softening: float, conductivity: float, speeds: tuple[float, float], hertz_ratio: float
) -> InletHeating:
    """The factor of a flooded inlet.

    Parameters
    ----------
    viscosity : at ambient pressure [Pa s].
    softening : -d ln(viscosity)/dT [1/K].
    conductivity : of the oil [W/(m K)].
    speeds : of both surfaces [m/s].
    hertz_ratio : Hertz pressure over E*.
    """
    mean = 0.5 * abs(sum(speeds))
    if mean == 0:
        return InletHeating(1.0, 0.0, False)
    loading = viscosity * softening * mean**2 / conductivity
    slide = abs(speeds[0] - speeds[1]) / mean
    numerator = 1 - 6.6 * hertz_ratio * loading**0.42
    factor = max(numerator, LEAST_NUMERATOR) / (1 + 0.213 * (1 + 2.23 * slide**0.83) * loading**0.64)
    return InletHeating(factor, loading, numerator < LEAST_NUMERATOR)


def hertz_over_modulus(load: float, radius: float, contact_modulus: float) -> float:
    """p_h / E* of a line contact, load per length [N/m]; 0 of rigid bodies. Johnson (1985), eq. 4.45."""
    return math.sqrt(load / (math.pi * radius * contact_modulus))
