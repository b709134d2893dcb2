"""Paraboloid on anisotropic half-spaces: the contact is an ellipse under a semi-ellipsoidal pressure.

Where a point force gives u = g(theta) / r, the pressure p0 sqrt(1 - x^2/a^2 - y^2/b^2) displaces its ellipse by

    u = p0 a b pi/2 integral over theta from 0 to pi of g / sqrt(W) [1 - (x sin theta - y cos theta)^2 / W],
    W = a^2 sin^2 theta + b^2 cos^2 theta:

a quadratic function, so that the axes and their direction follow from the curvatures of the gap. J. R. Willis, J. Mech.
Phys. Solids 14 (1966) 163, has the result (not read); here the integral along each chord through the point is taken in
closed form. Ball and isotropic half-space give Hertz. Verified in tests/reference_solutions/test_crystal_hertz.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from bem.grid import FloatArray
from bem.stiffness import Stiffness

_POINTS = 512
"""Points of the trapezoidal rule over the angles, whose error is that of an analytic, periodic integrand."""

_HALVINGS = 60
"""Bisections of the ratio of the axes, and of their angle."""


@dataclass(frozen=True)
class CrystalHertz:
    """Contact of a paraboloid with anisotropic half-spaces.

    radii : (along x, along y) of the gap x^2 / (2 R_x) + y^2 / (2 R_y) [m].
    semi_axes : of the ellipse of contact [m]: along `angle`, and across it. angle : of the first semi-axis from x, at
    least 0 and below pi/2 [rad]; 0 where the surfaces respond alike on both sides of the x axis.
    maximum_pressure : [Pa]. approach : [m]. load : [N].
    """

    radii: tuple[float, float]
    semi_axes: tuple[float, float]
    maximum_pressure: float
    approach: float
    load: float
    angle: float = 0.0


@dataclass(frozen=True)
class _Ellipse:
    """Integrals over the angles from the first axis of an ellipse with a = 1, b = `ratio`, and the curvatures of the
    gap along its axes.

    whole : of g / sqrt(W). along, across, mixed : of g sin^2 / W^(3/2), g cos^2 / W^(3/2) and g sin cos / W^(3/2).
    curvatures : along, across and mixed [1/m].
    """

    ratio: float
    whole: float
    along: float
    across: float
    mixed: float
    curvatures: tuple[float, float, float]

    @property
    def mismatch(self) -> float:
        """Mixed curvature that the pressure leaves over, relative; zero in the axes of the ellipse."""
        return self.mixed / self.along + self.curvatures[2] / self.curvatures[0]


def crystal_hertz(stiffnesses: Sequence[Stiffness], radii: tuple[float, float], load: float) -> CrystalHertz:
    """Return the contact of one crystal with a rigid paraboloid, or of two crystals.

    stiffnesses : of the body, or of both bodies. radii : (along x, along y) of the gap [m]. load : [N].
    """
    angles = np.pi / _POINTS * np.arange(_POINTS, dtype=np.float64)
    point = np.sum([one.surface_compliance(angles + np.pi / 2) for one in stiffnesses], axis=0) / (2 * np.pi)
    angle, ellipse = 0.0, _ellipse(point, radii, 0.0)
    if not all(one.mirror_symmetric for one in stiffnesses):
        # axes turned by a right angle are the same axes exchanged, and the mixed terms change their signs
        low, high = 0.0, 0.5 * math.pi
        sign = math.copysign(1.0, ellipse.mismatch)
        for _ in range(_HALVINGS):
            angle = 0.5 * (low + high)
            ellipse = _ellipse(point, radii, angle)
            if ellipse.mismatch * sign > 0:
                low = angle
            else:
                high = angle
    # p0 a b pi/2 along / a^3 = curvature / 2, load = 2/3 pi a b p0, b = ratio a
    a = (1.5 * load * ellipse.along / ellipse.curvatures[0]) ** (1 / 3)
    pressure = 1.5 * load / (math.pi * a * a * ellipse.ratio)
    approach = pressure * a * ellipse.ratio * math.pi / 2 * ellipse.whole
    return CrystalHertz(radii, (a, ellipse.ratio * a), pressure, approach, load, angle)


def _ellipse(point: FloatArray, radii: tuple[float, float], angle: float) -> _Ellipse:
    """Return the ellipse with an axis at an angle from x whose curvatures along both axes have the ratio of the gap's.

    point : (n,), g at n angles from x over a half turn [m^2/N].
    """
    theta = np.pi / len(point) * np.arange(len(point), dtype=np.float64) - angle
    sine, cosine = np.sin(theta), np.cos(theta)
    c, s = math.cos(angle), math.sin(angle)
    curvatures = (
        c * c / radii[0] + s * s / radii[1],
        s * s / radii[0] + c * c / radii[1],
        c * s * (1 / radii[1] - 1 / radii[0]),
    )

    def ellipse(ratio: float) -> _Ellipse:
        width = sine**2 + ratio**2 * cosine**2
        whole, along, across, mixed = (
            float(np.pi * np.mean(point * part))
            for part in (width**-0.5, sine**2 / width**1.5, cosine**2 / width**1.5, sine * cosine / width**1.5)
        )
        return _Ellipse(ratio, whole, along, across, mixed, curvatures)

    # the ratio of curvatures falls as b / a rises
    low, high = -5.0, 5.0
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        one = ellipse(math.exp(middle))
        if one.along / curvatures[0] < one.across / curvatures[1]:
            low = middle
        else:
            high = middle
    return ellipse(math.exp(0.5 * (low + high)))
