"""Shaft and bush solved as contact: half-angle and pressures through `solve_shaft_in_bush`."""

from __future__ import annotations

import re

import numpy as np
from numpy.polynomial import Chebyshev

from bem.contact.shaft_in_bush import ShaftContact, ShaftInBush, solve_shaft_in_bush
from bem.grid import FloatArray
from bem.materials import Material
from bem.verification.rows import Curve
from bem.verification.stored import StoredCase, StoredCurve

CLEARANCE = 1e-4
"""Radial clearance over the radius; small displacements scale with it."""
ALLOWANCE = 5e-5
REASON = "48 nodes over the contact, exact to 1e-6; what is left is for the reference's error bars being estimates"


def curves(case: StoredCase) -> list[Curve]:
    """Both sides of a stored bush."""
    bodies = _bodies(case)
    return [curve.beside(curve.name, _values(bodies, curve), ALLOWANCE, REASON) for curve in case.curves]


def _bodies(case: StoredCase) -> ShaftInBush:
    """Shaft and bush in units of the bush's Young's modulus and the radius."""
    parameters = case.parameters
    bush = Material("bush", youngs_modulus=1.0, poissons_ratio=parameters["nu"])
    shaft, housing = (_material(name, parameters[name]) for name in ("shaft", "housing"))
    assert shaft is not None
    return ShaftInBush(shaft, bush, 1.0, CLEARANCE, parameters["wall"], housing)


def _material(name: str, figures: tuple[float, float] | None) -> Material | None:
    """A body of modulus and Poisson's ratio."""
    return None if figures is None else Material(name, youngs_modulus=figures[0], poissons_ratio=figures[1])


def _values(bodies: ShaftInBush, curve: StoredCurve) -> FloatArray:
    """The stored curve's points."""
    unit = bodies.modulus * CLEARANCE
    if curve.along == "load":
        contacts = [solve_shaft_in_bush(bodies, unit * load) for load in curve.coordinates[:, 0].tolist()]
        if curve.name == "half_angle":
            return np.array([contact.half_angle for contact in contacts])
        return np.array([contact.maximum_pressure / unit for contact in contacts])
    match = re.search(r"at load ([\d.eE+-]+)$", curve.along)
    assert match is not None
    contact = solve_shaft_in_bush(bodies, unit * float(match[1]))
    return pressure_at(contact, curve.coordinates[:, 0]) / unit


def pressure_at(contact: ShaftContact, angles: FloatArray) -> FloatArray:
    """Pressure at angles inside the contact [rad]: times sqrt(1 - x^2) it is a polynomial through the nodes."""
    nodes, x = contact.angles / contact.half_angle, angles / contact.half_angle
    density = contact.pressures * np.sqrt(1 - nodes**2)
    found = Chebyshev.fit(nodes, density, nodes.size - 1, domain=[-1, 1])(x) / np.sqrt(1 - x**2)
    return np.asarray(found, dtype=float)
