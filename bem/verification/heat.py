"""Surface temperature: a disc at rest and a band over which the body moves, through `surface_temperature`."""

from __future__ import annotations

import numpy as np

from bem.grid import FloatArray, Grid
from bem.heat import surface_temperature
from bem.materials import Body, Material
from bem.reference_solutions.heat_sources import disc_at_rest, moving_band
from bem.verification.patches import disc_means, free_grid
from bem.verification.rows import CLOSED_FORM, Curve
from bem.verification.stored import StoredCase, StoredCurve

STEP = 1 / 80
"""Side of a cell over the disc's radius."""
BAND_STEP = 1 / 200
"""Side of a cell over the band's half-width."""
BODY = Body(
    Material("unit", youngs_modulus=1.0, poissons_ratio=0.3, thermal_conductivity=1.0, density=1.0, heat_capacity=1.0)
)
"""Of conductivity and diffusivity one: the Peclet number of a unit length is half the speed."""
REASON = {
    "heat-disc": "cells of 1/80 of the radius under the mean flux of each",
    "heat-band": "cells of 1/200 of the half-width, halves at the band's edges",
}


def curves(case: StoredCase) -> list[Curve]:
    """Both sides of a stored case, and the closed form where there is one."""
    band = case.problem == "heat-band"
    found = []
    for curve in case.curves:
        values = _band(curve, case.parameters["peclet"]) if band else _disc(curve, case.parameters["profile"])
        found.append(_pair(curve, curve.name, values, 1e-4 if band else 2e-4, REASON[case.problem]))
        x = curve.coordinates[:, 0]
        if band:
            exact = moving_band(x, case.parameters["peclet"])
            found.append(_pair(curve, f"{curve.name}, Jaeger's band", exact, 1e-5, CLOSED_FORM))
        elif case.parameters["profile"] == "uniform":
            inside = curve.only(x <= 1)
            exact = disc_at_rest(inside.coordinates[:, 0])
            found.append(_pair(inside, f"{curve.name}, disc at rest", exact, 1e-5, CLOSED_FORM))
    return found


def _pair(curve: StoredCurve, quantity: str, values: FloatArray, allowance: float, reason: str) -> Curve:
    return Curve(
        quantity, curve.along, curve.unit, curve.coordinates, values, curve.values, curve.error_bar, allowance, reason
    )


def _disc(curve: StoredCurve, profile: str) -> FloatArray:
    x, y, _ = curve.coordinates.T
    where = free_grid(STEP, (-1.0, max(1.0, float(x.max()))), (-1.0, 1.0))
    found = surface_temperature(disc_means(where, profile), where.grid, BODY, speeds=0.0)
    return found.temperature[where.at(x, y)]


def _band(curve: StoredCurve, peclet: float) -> FloatArray:
    x = curve.coordinates[:, 0]
    first, last = (round(float(end) / BAND_STEP) for end in (min(-1.0, x.min()), max(1.0, x.max())))
    at = BAND_STEP * np.arange(first, last + 1)
    cover = np.clip(np.minimum(at + BAND_STEP / 2, 1) - np.maximum(at - BAND_STEP / 2, -1), 0, None) / BAND_STEP
    grid = Grid((at.size, 2), (BAND_STEP, 1.0), periodic=(False, True))
    found = surface_temperature(np.tile(cover[:, None], (1, 2)), grid, BODY, speeds=2 * peclet)
    return found.temperature[np.rint(x / BAND_STEP).astype(int) - first, 0]
