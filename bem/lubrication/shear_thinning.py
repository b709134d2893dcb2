"""Shear laws: the shear stress an oil carries at a Newtonian shear stress mu du/h, for friction.

To add a law, write one function here and enter it in `SHEAR_LAWS`.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from bem.grid import FloatArray

ShearLaw = Callable[[FloatArray, float, float], FloatArray]


LIMITING_SHEAR_COEFFICIENT = 0.08
"""Slope of the limiting shear stress with pressure: the middle of the 0.04 to 0.12 that were measured; Bair and Winer,
J. Lubr. Technol. 101 (1979) 251, Hoglund and Jacobson, J. Tribol. 108 (1986) 571, Bair (2007)."""
AMBIENT_SHEAR_STRENGTH = 5e6
"""Limiting shear stress at ambient pressure [Pa]: the upper end of the 1 to 5 MPa of Hoglund and Jacobson (1986)."""


def newtonian(stress: FloatArray, limit: float, exponent: float) -> FloatArray:
    """Stress in proportion to the shear rate."""
    return stress


def eyring(stress: FloatArray, limit: float, exponent: float) -> FloatArray:
    """tau = tau0 asinh(mu du/h / tau0), tau0 the Eyring stress; Eyring (1936), Johnson and Tevaarwerk (1977)."""
    return limit * np.arcsinh(stress / limit)


def carreau(stress: FloatArray, limit: float, exponent: float) -> FloatArray:
    """tau = mu rate [1 + (mu rate / G)^2]^((n - 1)/2), G the critical stress, n the exponent; Bair (2007)."""
    return stress * (1 + (stress / limit) ** 2) ** (0.5 * (exponent - 1))


SHEAR_LAWS: dict[str, ShearLaw] = {"limited": newtonian, "newtonian": newtonian, "eyring": eyring, "carreau": carreau}
