"""Paraboloid on anisotropic half-spaces: the contact is an ellipse under a semi-ellipsoidal pressure.

Where a point force gives u = g(theta) / r, the pressure p0 sqrt(1 - x^2/a^2 - y^2/b^2) displaces its ellipse by

    u = p0 a b pi/2 integral over theta from 0 to pi of g / sqrt(W) [1 - (x sin theta - y cos theta)^2 / W],
    W = a^2 sin^2 theta + b^2 cos^2 theta:

a quadratic function, so that the axes follow from both curvatures of the gap. J. R. Willis, J. Mech. Phys. Solids 14
(1966) 163, has the result (not read); here the integral along each chord through the point is taken in closed form.
Ball and isotropic half-space give Hertz. Verified in tests/reference_solutions/test_crystal_hertz.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bem.stiffness import Stiffness

_POINTS = 512
"""Points of the trapezoidal rule over the angles, whose error is that of an analytic, periodic integrand."""


@dataclass(frozen=True)
class CrystalHertz:
    """Contact of a paraboloid with anisotropic half-spaces that respond alike on both sides of the x axis.

    radii : (along x, along y) of the gap x^2 / (2 R_x) + y^2 / (2 R_y) [m].
    semi_axes : (along x, along y) of the ellipse of contact [m].
    maximum_pressure : [Pa]. approach : [m]. load : [N].
    """

    radii: tuple[float, float]
    semi_axes: tuple[float, float]
    maximum_pressure: float
    approach: float
    load: float


def crystal_hertz(stiffnesses: Sequence[Stiffness], radii: tuple[float, float], load: float) -> CrystalHertz:
    """Return the contact of one crystal with a rigid paraboloid, or of two crystals.

    stiffnesses : of the body, or of both bodies. radii : (along x, along y) of the gap [m]. load : [N].
    """
    angles = np.pi / _POINTS * np.arange(_POINTS, dtype=np.float64)
    point = np.sum([one.surface_compliance(angles + np.pi / 2) for one in stiffnesses], axis=0) / (2 * np.pi)
    sine, cosine = np.sin(angles) ** 2, np.cos(angles) ** 2

    def integrals(ratio: float) -> tuple[float, float, float]:
        """Return the integrals of g / sqrt(W), g sin^2 / W^(3/2) and g cos^2 / W^(3/2) for a = 1, b = ratio."""
        width = sine + ratio**2 * cosine
        return (
            float(np.pi * np.mean(point / np.sqrt(width))),
            float(np.pi * np.mean(point * sine / width**1.5)),
            float(np.pi * np.mean(point * cosine / width**1.5)),
        )

    # the ratio of curvatures falls as b / a rises
    low, high = -5.0, 5.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        _, along_x, along_y = integrals(math.exp(middle))
        if along_x * radii[0] < along_y * radii[1]:
            low = middle
        else:
            high = middle
    ratio = math.exp(0.5 * (low + high))
    whole, along_x, _ = integrals(ratio)
    # p0 a b pi/2 along_x / a^3 = 1 / (2 R_x), load = 2/3 pi a b p0, b = ratio a
    a = (1.5 * load * along_x * radii[0]) ** (1 / 3)
    pressure = 1.5 * load / (math.pi * a * a * ratio)
    return CrystalHertz(radii, (a, ratio * a), pressure, pressure * a * ratio * math.pi / 2 * whole, load)
