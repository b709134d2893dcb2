"""The similarity problem of a line contact in Moes' variables (*Lubrication and beyond*, 2000).

With U = mu0 (u1 + u2)/(E' R) and E' = 2 E*, lengths along the film are in R U^(1/4), films in R U^(1/2) and pressures
in E' U^(1/4).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.flow_factors import RoughWalls
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.shear_profile import ShearFlow, shear_flow

RIGID_LOAD = 1e-4
"""Load M of a pair of rigid bodies: E* is chosen such that the deflection is negligible."""


class Layered(Protocol):
    """Properties of an oil that vary across the film, at the nodes of one mesh: Dowson's generalised Reynolds
    equation."""

    @property
    def leaving(self) -> float:
        """Couette flow at the exit over that of the supplied oil."""

    def drag(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the Couette flow at the nodes over that of the supplied oil, and its slope with the pressure."""

    def log_viscosity(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ln of the viscosity ratio of the uniform oil with the same Poiseuille flow at the nodes, and its
        slope."""

    def log_sliding_viscosity(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ln of the viscosity ratio of the uniform oil with the same Couette stress at the nodes, and its
        slope."""

    @property
    def thinning(self) -> FloatArray:
        """ln of the Poiseuille flow through shear-thinning layers over that through the uniform oils of the same
        stress, at the nodes."""

    def cut(self, nodes: slice) -> Layered:
        """Return the properties at some of the nodes."""


@dataclass(frozen=True)
class Problem:
    """Reynolds' equation and load in similarity variables.

    load : M; infinite where the rigid-body separation is given instead.
    log_viscosity, density : laws of the scaled pressure; each returns value and slope.
    walls : flow factors of rough walls; None for smooth walls.
    shear : shear law across the film; None for a Newtonian film.
    layered : properties that vary across the film; None for uniform oil.
    """

    load: float
    log_viscosity: Callable[[FloatArray], tuple[FloatArray, FloatArray]]
    density: Callable[[FloatArray], tuple[FloatArray, FloatArray]]
    walls: RoughWalls | None = None
    shear: ShearFlow | None = None
    layered: Layered | None = None

    def flowing(self, pressure: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return ln of the viscosity ratio of the Poiseuille flow at the nodes, and its slope with the pressure."""
        return self.log_viscosity(pressure) if self.layered is None else self.layered.log_viscosity(pressure)

    def poiseuille_cube(self, thickness: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return phi_x H^3, the factor of the Poiseuille flow, and half its derivative with the film."""
        if self.walls is not None:
            return self.walls.poiseuille_cube(thickness)
        return thickness**3, 1.5 * thickness**2

    def couette_film(self, film: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return H + k s phi_s, the factor of the Couette flow, and its derivative with the film."""
        return (film, np.ones_like(film)) if self.walls is None else self.walls.couette_film(film)


@dataclass(frozen=True)
class Scales:
    """Moes' units of length along the film [m], film [m] and pressure [Pa], and the load M."""

    length: float
    film: float
    pressure: float
    load: float


def scaled_problem(
    scales: Scales, load: float, lubricant: Lubricant, walls: RoughWalls | None = None, sliding: float = 0.0
) -> Problem:
    """Return the similarity problem of an oil at a load M.

    walls : flow factors; None for smooth walls. sliding : u1 - u2 of the walls [m/s].
    """
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
    """Return Moes' units of a case.

    load : per unit length [N/m]. entrainment : |u1 + u2| [m/s]. viscosity : at ambient pressure [Pa s]. Rigid bodies
        get the modulus at which M is `RIGID_LOAD`.
    """
    rigid = viscosity * entrainment * radius
    if math.isinf(contact_modulus):
        reduced = (load / RIGID_LOAD) ** 2 / rigid
    else:
        reduced = 2 * contact_modulus
    moes = load / math.sqrt(reduced * rigid)
    speed = viscosity * entrainment / (reduced * radius)
    return Scales(radius * speed**0.25, radius * math.sqrt(speed), reduced * speed**0.25, moes)
