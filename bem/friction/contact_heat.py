"""How hot rubbing makes the surfaces of a contact in oil, and the boundary friction that they then have.

Friction of the contact and of the oil between its cells heats both bodies, moving half-spaces that are as warm far
away as the oil that comes (`bem.heat`); a body at rest under a cylinder is taken as cool at its radius. Where
the law of boundary friction knows temperature it is told the contact's mean, weighted by pressure, which depends on it
in turn: temperatures are linear in the coefficient, and one number is looked for. Verified in
tests/friction/test_hot_contact.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bem.errors import Status
from bem.friction.boundary import BoundaryFriction, filled_part
from bem.friction.film import PatchFilm
from bem.friction.rough_contact import Pressed
from bem.friction.setup import MixedSetup
from bem.grid import FloatArray
from bem.heat.bodies import conductors_of
from bem.heat.solution import TemperatureSolution
from bem.heat.steady import surface_temperature
from bem.lubrication.with_heat import FilmHeat
from bem.notes import Note

TOLERANCE = 1e-6
"""Difference of both surfaces over the rise; and of the coefficient of friction."""
_HALF = 0.5


@dataclass(frozen=True)
class ContactHeat:
    """Temperatures of the surfaces in contact.

    mean, maximum : over the cells in contact, by pressure, and the highest [K]; temperature : (nx, ny) [K]. law : of
    boundary friction, told the mean. coefficient : of it. status, notes : of the heat conduction.
    """

    mean: float
    maximum: float
    temperature: FloatArray
    law: BoundaryFriction
    coefficient: float
    status: Status
    notes: tuple[Note, ...] = ()


def contact_heat(film: PatchFilm, contact: Pressed, setup: MixedSetup, speeds: tuple[float, float]) -> ContactHeat:
    """Of a contact that carries some load, between surfaces that slide at a pair of speeds [m/s], with heat."""
    heat, law, slide = setup.smooth.heat, setup.boundary_law, abs(speeds[0] - speeds[1])
    assert heat is not None
    bulk = float(setup.lubricant.temperature or 0.0)
    moving = speeds if setup.radius is None else _moving(heat, setup.radius, speeds)
    pressure, touching = contact.pressure, contact.pressure > 0
    filled = filled_part(pressure, contact.area / setup.slices, setup.grid)
    of_oil = np.broadcast_to(np.abs(film.shear_stress), pressure.shape) * np.where(touching, 0.0, slide)

    def conducted(coefficient: float) -> TemperatureSolution:
        made = of_oil + coefficient * slide * pressure
        return surface_temperature(made, setup.grid, heat.bodies, speeds=moving, bulk=(bulk, bulk), tolerance=TOLERANCE)

    def mean(found: TemperatureSolution) -> float:
        return float((found.temperature * pressure).sum() / pressure.sum())

    cold = law.mean_coefficient(pressure, filled, slide)
    found = conducted(cold)
    coefficient = cold
    if law.needs_temperature:
        at, less = mean(found), mean(conducted(_HALF * cold))
        slope = (at - less) / (cold - _HALF * cold) if cold > 0 else 0.0

        def told(value: float) -> BoundaryFriction:
            return law.at_temperature(at + slope * (value - cold))

        def missed(value: float) -> float:
            return told(value).mean_coefficient(pressure, filled, slide) - value

        coefficient = _zero(missed, cold)
        law = told(coefficient)
        found = conducted(coefficient)
    return ContactHeat(
        mean=mean(found),
        maximum=float(found.temperature[touching].max()),
        temperature=found.temperature,
        law=law,
        coefficient=coefficient,
        status=found.status,
        notes=found.notes,
    )


def _zero(missed: Callable[[float], float], near: float) -> float:
    """Where what a coefficient makes of temperature gives itself; temperatures rise with it, so that a law that falls
    with them has one such."""
    from scipy.optimize import brentq  # a sixth of a second, for laws that temperature changes

    high = max(near, 1e-12)
    while missed(high) > 0 and high < 1e3:
        high *= 2
    return float(brentq(missed, 0.0, high, xtol=TOLERANCE * max(near, 1e-12)))


def _moving(heat: FilmHeat, radius: float, speeds: tuple[float, float]) -> tuple[float, float]:
    """Speeds of both bodies [m/s], one at rest moving so slowly that it is cool at the radius."""
    bodies = conductors_of("thermal", heat.bodies, speeds, (0.0, 0.0))
    least = [2 * body.diffusivity / radius for body in bodies]
    first, second = (
        speed if abs(speed) > slow else math.copysign(slow, speed or sum(speeds))
        for speed, slow in zip(speeds, least, strict=True)
    )
    return first, second
