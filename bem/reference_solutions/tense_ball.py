"""Rigid ball on a half-space with surface tension: a one-dimensional integral equation.

The Hankel transform of the pressure is written as the cosine transform of a function phi on (0, a). Abel's transform of
the displacement under a paraboloid of radius R then says that in the contact |x| < a

    1/E integral of phi(t) C(x - t) over -a < t < a = delta - x^2 / R,
    C(z) = integral of cos(q z) / (1 + q s) over q > 0 = g(|z| / s) / s,

with E the plane-strain modulus, s = 2 gamma / E the elastocapillary length, delta the approach, and g the auxiliary
function of the cosine integral. phi is expanded in Chebyshev polynomials over sqrt(a^2 - t^2), and delta is the one at
which phi vanishes at t = a: the pressure is then finite. The load is pi times the integral of phi. Without
tension phi = E / pi (delta - x^2 / R): Hertz. With tension alone the surface is a film under the pressure 2 gamma / R.

Derived here; J. M. Long & G. F. Wang, Mech. Mater. 56 (2013) 65, solve the same contact by another equation (not read).
Verified in tests/reference_solutions/test_tense_ball.py against both limits.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import sici

from bem.numerics.blocks import FloatArray

_GRADED = 0.5 ** np.arange(0, 52, 2.0)
"""Ends of panels about the logarithm of the kernel, over the distance to the end of the interval."""


@dataclass(frozen=True)
class TenseBall:
    """Contact of a rigid ball with a half-space whose surface is under tension.

    radius : of the ball [m]. contact_radius : a [m]. approach : of the ball [m]. load : [N].
    maximum_pressure : in the middle [Pa].
    """

    radius: float
    contact_radius: float
    approach: float
    load: float
    maximum_pressure: float


def tense_ball(
    contact_radius: float, radius: float, modulus: float, surface_tension: float, terms: int = 24
) -> TenseBall:
    """Return the contact of a given radius.

    contact_radius, radius : a and R [m]. modulus : E / (1 - nu^2) [Pa]. surface_tension : gamma [N/m], positive.
    terms : Chebyshev polynomials of even order; a tenth of a in s needs about 20.
    """
    length = 2 * surface_tension / (modulus * contact_radius)  # in units of a
    at = np.cos((np.arange(terms) + 0.5) * np.pi / (2 * terms))  # 0 < x < 1
    orders = 2 * np.arange(terms)
    matrix = np.empty((terms, terms))
    for row, x in enumerate(at):
        middle = math.asin(x)
        offsets, weights = _graded(middle)
        angles = middle + offsets
        distance = np.abs(2 * np.sin(0.5 * offsets) * np.cos(middle + 0.5 * offsets))
        kernel = _auxiliary(distance / length) / length
        matrix[row] = np.cos(orders[:, None] * (np.pi / 2 - angles)) @ (weights * kernel)
    # both right-hand sides, then the approach at which the sum of coefficients, phi at the edge, vanishes
    one, square = (np.linalg.solve(matrix, side) for side in (np.ones(terms), at**2))
    approach = float(square.sum() / one.sum())
    coefficients = (approach * one - square) * (modulus * contact_radius / radius * contact_radius)
    nodes, gauss = np.polynomial.legendre.leggauss(200)
    theta = 0.25 * np.pi * (1 + nodes)
    # phi a = F(theta) / cos(theta), t = a sin(theta): p(0) = -integral of dphi / t
    series = np.cos(orders[:, None] * (np.pi / 2 - theta))
    slope = orders[:, None] * np.sin(orders[:, None] * (np.pi / 2 - theta))
    phi = coefficients @ series / np.cos(theta)
    change = (coefficients @ slope) / np.cos(theta) + phi * np.tan(theta)
    pressure = -float(np.sum(0.25 * np.pi * gauss * change / np.sin(theta))) / contact_radius
    return TenseBall(
        radius,
        contact_radius,
        approach * contact_radius**2 / radius,
        math.pi**2 * contact_radius * float(coefficients[0]),
        pressure,
    )


def _auxiliary(z: FloatArray) -> FloatArray:
    """Return g(z) = integral over u from 0 to infinity of cos(z u) / (1 + u) (NIST Handbook, section 6.2)."""
    sine, cosine = sici(z)
    return np.asarray(-cosine * np.cos(z) - (sine - 0.5 * np.pi) * np.sin(z))


def _graded(middle: float) -> tuple[FloatArray, FloatArray]:
    """Return Gauss nodes, from `middle`, and weights on (-pi/2, pi/2), graded towards `middle`."""
    nodes, weights = np.polynomial.legendre.leggauss(16)
    found, amounts = [], []
    for end in (-np.pi / 2, np.pi / 2):
        for outer, inner in zip(_GRADED, np.append(_GRADED[1:], 0.0), strict=True):
            low, high = inner * (end - middle), outer * (end - middle)
            found.append(0.5 * (low + high) + 0.5 * (high - low) * nodes)
            amounts.append(0.5 * abs(high - low) * weights)
    return np.concatenate(found), np.concatenate(amounts)
