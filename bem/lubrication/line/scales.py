"""Moes' similarity variables of the line contact (*Lubrication and beyond*, 2000)."""

from __future__ import annotations

import math
from dataclasses import dataclass

from bem.grid import FloatArray
from bem.lubrication.flow_factors import RoughWalls
from bem.lubrication.line.reynolds import Problem
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.shear_profile import shear_flow

RIGID_LOAD = 1e-4


@dataclass(frozen=True)
class Scales:
    """Moes' units: length along the film, film, pressure, and the load M."""

    length: float
    film: float
    pressure: float
    load: float


def scaled_problem(
    scales: Scales, load: float, lubricant: Lubricant, walls: RoughWalls | None = None, sliding: float = 0.0
) -> Problem:
    """The similarity problem of an oil at a load M, between smooth or rough walls that slide at |u1 - u2| [m/s]."""
    unit = scales.pressure

    def log_viscosity(pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        value, slope = lubricant.log_viscosity_ratio(pressure * unit)
        return value, slope * unit

    def density(pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        value, slope = lubricant.density_ratio(pressure * unit)
        return value, slope * unit

    shear = shear_flow(lubricant, sliding, scales.film, unit, scales.length) if lubricant.shears_film else None
    return Problem(load, log_viscosity, density, walls, shear)


def line_scales(load: float, radius: float, contact_modulus: float, entrainment: float, viscosity: float) -> Scales:
    """Moes' units for a case; `entrainment` is |u1 + u2|. A rigid pair gets an E* so high that it does not count."""
    rigid = viscosity * entrainment * radius
    if math.isinf(contact_modulus):
        reduced = (load / RIGID_LOAD) ** 2 / rigid
    else:
        reduced = 2 * contact_modulus
    moes = load / math.sqrt(reduced * rigid)
    speed = viscosity * entrainment / (reduced * radius)
    return Scales(radius * speed**0.25, radius * math.sqrt(speed), reduced * speed**0.25, moes)
