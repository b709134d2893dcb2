"""Inlet shear heating: factor by which it thins the film of a line contact.

P. K. Gupta, H. S. Cheng, D. Zhu, N. H. Forster and J. B. Schrand, *Tribol. Trans.* 35 (1992) 269: with
L = mu0 beta u^2/k of the mean speed u, slide-to-roll ratio S and Hertz pressure p_h over E' = 2 E*,

    factor = (1 - 13.2 p_h/E' L^0.42) / (1 + 0.213 (1 + 2.23 S^0.83) L^0.64),

fitted to thermal solutions for loads and speeds of bearings. The constants are those that A. Arana, J. Larranaga and
I. Ulacia, *Proc. IMechE J* 233 (2019) 303, eq. 24, quote; they were not checked against the paper itself. The exponent
0.64 agrees with the inlet factor of bearing friction, 1/(1 + 1.84e-9 (n d_m)^1.28 nu^0.64) (SKF, *Rolling bearings*,
2013), which depends on speed^2 times viscosity in the same power. In pure rolling the factor is 2 to 6 % below that of
full heat for L from 0.03 to 11 (ISO VG 68 at 0.8 GPa; tests/lubrication/test_full_thermal.py). At higher loads and
speeds the numerator passes zero; it is bounded by `LEAST_NUMERATOR`, with a note.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

LEAST_NUMERATOR = 0.5
"""Lower bound of the numerator, below which the fit counts as extrapolated: a bound of this code, not of the source."""


@dataclass(frozen=True)
class InletHeating:
    """Factor on the film thickness, thermal loading L, and whether the fit is extrapolated."""

    factor: float
    loading: float
    extrapolated: bool


def inlet_heating_factor(
    viscosity: float, softening: float, conductivity: float, speeds: tuple[float, float], hertz_ratio: float
) -> InletHeating:
    """Return the factor of a flooded inlet.

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
    """Return p_h / E* of a line contact, load per length [N/m]; 0 of rigid bodies. Johnson (1985), eq. 4.45."""
    return math.sqrt(load / (math.pi * radius * contact_modulus))
