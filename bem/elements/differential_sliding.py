"""Sliding of a ball within its curved contact with a groove (Heathcote slip and spin), and the friction that it costs.

The contact of a ball in a groove is bent across the motion, so that its points lie at different distances from both
axes of rotation. Ball and ring cannot roll on all of them: they roll on two lines, and slide forwards between and
backwards beside them.

1. Hertz gives the semi-axes a along and b across the motion and the pressure p(x, y). Both bodies are bent alike by the
   pressure, so that the common surface has the mean of their curvatures, 1/R_c = (1/r_ball + 1/r_groove)/2.
2. A point at a distance y from the middle lies y^2 / 2 R_c from the plane of the contact, nearer to the ball's axis and
   further from the ring's, on an outer ring nearer to the centre of both. The surfaces, which come at u in the middle
   and with 1/R = 1/r_ball + 1/r_ring along the motion, differ in speed there by

       u (y^2 - y0^2) / (2 R_c R).

3. At a contact angle alpha ball and rings turn against each other about the normals of their contacts, too: on both
   rings together by the speed of the ring times sin(alpha). A ball grips the ring on which its friction resists the
   spin more, and spins on the other one alone (`spins_on_first`).
4. The sheared oil film has the thickness in the middle of the contact and the temperature of the rolling film; its
   stress follows the oil's own law over the pressure, and acts along the sliding.
5. A free ball takes no tangential force from a ring but the rolling resistance, which is small: y0^2, of either sign,
   is where the stresses along the motion add up to none. Without spin the ball rolls on the lines y = +-y0.
6. The friction power is the integral of stress times sliding speed.

The heat of this sliding is left out, as are the thicker film of the more lightly loaded sides, gyroscopic moments, and
elastic shear of the bodies. Against films with their heat, each solved on a strip of the contact, the power of the
template's ball is 1.4 % too large.

H. L. Heathcote, *Proc. Inst. Automobile Engineers* 15 (1921) 569; K. L. Johnson, *Contact Mechanics* (1985), 8.5, for
dry friction; T. A. Harris, *Rolling Bearing Analysis*, for the curvature of the common surface; A. B. Jones, *J. Basic
Engineering* 81 (1959) 1, for the ring on which the ball spins. The originals but for the second were not read; the
formulas are derived in this file. Verified in tests/elements/test_differential_sliding.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from bem.elements.contact import ElementContact
from bem.grid import FloatArray
from bem.reference_solutions.hertz import PointContact

if TYPE_CHECKING:
    from bem.lubrication import Lubricant
    from bem.lubrication.shear import ShearLaw

CITES = ("heathcote1921",)
"""Source of the sliding within curved contacts, a key of `bem/references.bib`."""
SPIN_CITES = ("jones1959",)
"""Source of the ring on which balls spin."""
STRIPS, POINTS = 200, 16
"""Strips of half a contact across the motion, and points along half of each."""

Stress = Callable[[FloatArray, FloatArray], FloatArray]
"""Shear stress [Pa] at pressures [Pa] and speeds of sliding [m/s] of one shape, odd in the latter."""


@dataclass(frozen=True)
class DifferentialSliding:
    """Sliding of a ball within one contact.

    power : of its friction [W]. speed : mean of the magnitude of the sliding speed, weighted by the pressure [m/s].
    rolling_line : distance y0 of the lines of pure rolling from the middle, over the semi-axis across; not a number
        where there are none (y0^2 < 0).
    heat : highest over the strips along the motion, of friction per length across over the root of the strip's length
        [W/m^1.5], for its flash temperature.
    scatter : of the power to smaller and larger values from the oil's constants [W]; None but with "base_oil".
    """

    power: float
    speed: float
    rolling_line: float
    heat: float
    scatter: tuple[float, float] | None = None


def ball_sliding(contact: ElementContact, modulus: float, stress: Stress) -> DifferentialSliding:
    """Return the sliding of a ball that rolls in a groove, under a law of friction.

    Parameters
    ----------
    contact : of a point, body 2 the ball.
    modulus : contact modulus of both materials [Pa].
    stress : law of friction.
    """
    from scipy.optimize import brentq

    hertz = contact.hertz(modulus)
    assert isinstance(hertz, PointContact)
    along, across = hertz.semi_axes
    common = 1 / (1 / contact.radii[1] - 0.5 / contact.across)
    most = contact.mean_speed * across**2 / (2 * common * contact.radius)
    sides = (1,) if contact.spin == 0 else (-1, 1)  # without spin both are alike
    eta = np.concatenate([side * (np.arange(STRIPS) + 0.5) / STRIPS for side in sides])
    theta = 0.5 * math.pi * (np.arange(POINTS) + 0.5) / POINTS
    height = np.sqrt(1 - eta**2)[:, None]  # half-length of a strip over that of the middle one
    pressure = hertz.maximum_pressure * height * np.cos(theta)
    width = 2 * across / STRIPS / len(sides)  # of a strip, with its like on the other side
    area = 2 * along * width * height * np.cos(theta) * (0.5 * math.pi / POINTS)  # with its like before the middle
    sideways = np.broadcast_to(contact.spin * along * height * np.sin(theta), pressure.shape)

    def slips(square: float) -> FloatArray:
        slip = most * (eta**2 - square) + contact.spin * across * eta
        return np.broadcast_to(slip[:, None], pressure.shape)

    def stresses(slip: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the sliding speed and the stress along it."""
        speed = np.hypot(slip, sideways)
        return speed, stress(pressure, speed)

    def force(square: float) -> float:
        slip = slips(square)
        speed, against = stresses(slip)
        return float(np.sum(area * against * slip / np.maximum(speed, np.finfo(float).tiny)))

    turning = abs(contact.spin) * across / most
    square = float(brentq(force, -turning, 1.0 + turning, xtol=1e-12))
    speed, against = stresses(slips(square))
    weight, power = area * pressure, area * against * speed
    per_length = power.sum(axis=1) / width
    return DifferentialSliding(
        float(power.sum()),
        float(np.sum(weight * speed) / np.sum(weight)),
        math.sqrt(square) if square >= 0 else math.nan,
        float(np.max(per_length / np.sqrt(2 * along * height[:, 0]))),
    )


def spins_on_first(contacts: tuple[ElementContact, ElementContact], modulus: float) -> bool:
    """Return True if a ball spins on the first of its two contacts and grips the other one.

    One friction coefficient resists the spin with the moment 3/8 mu Q b E, E the complete elliptic integral of the
    second kind of the eccentricity, b the larger semi-axis.
    """
    from scipy.special import ellipe

    moments = []
    for one in contacts:
        hertz = one.hertz(modulus)
        assert isinstance(hertz, PointContact)
        short, long = sorted(hertz.semi_axes)
        moments.append(one.load * long * ellipe(1 - (short / long) ** 2))
    return bool(moments[0] <= moments[1])


def sliding_in_film(
    contact: ElementContact, modulus: float, lubricant: Lubricant, thickness: float, temperature: float | None
) -> DifferentialSliding:
    """Return the sliding of a ball in an oil film of one thickness [m] and temperature [K], by default the oil's own.

    contact, modulus : as of `ball_sliding`.
    """
    from bem.lubrication.oil_scatter import constants_scatter
    from bem.lubrication.shear import BaseOilShear

    found = ball_sliding(contact, modulus, film_stress(lubricant, thickness, temperature))
    if not isinstance(lubricant.shear_law, BaseOilShear):
        return found

    def power(law: BaseOilShear) -> float:
        return ball_sliding(contact, modulus, film_stress(lubricant, thickness, temperature, law)).power

    scatter = constants_scatter(lubricant, power)
    return replace(found, scatter=(scatter.down, scatter.up))


def film_stress(
    lubricant: Lubricant, thickness: float, temperature: float | None, law: ShearLaw | None = None
) -> Stress:
    """Return the law of friction of an oil film of one thickness [m] and temperature [K], by default the oil's own.

    law : in place of the oil's own shear law.
    """
    from bem.lubrication.thermal.hot_viscosity import HotViscosity

    shear = lubricant.shear_law if law is None else law
    warm = None if temperature is None or lubricant.temperature_viscosity is None else HotViscosity.of(lubricant)
    at = lubricant.temperature if temperature is None else temperature

    def stress(pressure: FloatArray, sliding: FloatArray) -> FloatArray:
        flat = pressure.ravel()
        if warm is None or temperature is None:
            viscosity = lubricant.viscosity_at(flat)
        else:
            viscosity = warm(flat, np.full_like(flat, temperature))[0]
        newtonian = viscosity * sliding.ravel() / thickness
        return shear.shear_stress(newtonian, flat, at).reshape(pressure.shape)

    return stress
