"""Density laws: density over that at ambient pressure, and its derivative with pressure.

To add a law, write one function here and enter it in `DENSITY_LAWS`; pressures are never negative.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from bem.grid import FloatArray

DensityLaw = Callable[[FloatArray], tuple[FloatArray, FloatArray]]


def incompressible(pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
    """The same at every pressure."""
    return np.ones_like(pressure), np.zeros_like(pressure)


def dowson_higginson(pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
    """rho/rho0 = 1 + 0.6e-9 p / (1 + 1.7e-9 p), p in Pa; Dowson and Higginson, *Elasto-hydrodynamic
    lubrication* (1966)."""
    denominator = 1 + 1.7e-9 * pressure
    return 1 + 0.6e-9 * pressure / denominator, 0.6e-9 / denominator**2


DENSITY_LAWS: dict[str, DensityLaw] = {"incompressible": incompressible, "dowson_higginson": dowson_higginson}
