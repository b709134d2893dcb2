"""Hertz contact: sphere, ellipse (point contact) and cylinder (line contact).

Johnson, *Contact Mechanics* (1985), sections 4.1-4.2. The elliptic integrals are written with Carlson's symmetric
forms, so nothing cancels as the ellipse becomes a circle, and one formula gives the displacement everywhere.
"""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.arguments import check_positive
from bem.errors import InputError

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class PointContact:
    """Contact of an elliptic paraboloid with gap x^2/2Rx + y^2/2Ry on a half-space; lengths [m], moduli [Pa].

    `semi_axes` (a along x, b along y), `maximum_pressure` p0, `approach` of distant points, `load` [N].
    """

    radii: tuple[float, float]
    contact_modulus: float
    load: float
    approach: float
    semi_axes: tuple[float, float]
    maximum_pressure: float

    @property
    def mean_pressure(self) -> float:
        """Load over contact area [Pa], two thirds of the maximum."""
        return 2 * self.maximum_pressure / 3

    @property
    def contact_area(self) -> float:
        """pi a b [m^2]."""
        return math.pi * self.semi_axes[0] * self.semi_axes[1]

    def pressure(self, x: ArrayLike, y: ArrayLike) -> FloatArray:
        """Pressure [Pa] at (x, y), zero outside the ellipse."""
        a, b = self.semi_axes
        inside = 1 - (np.asarray(x) / a) ** 2 - (np.asarray(y) / b) ** 2
        return self.maximum_pressure * np.sqrt(np.maximum(inside, 0.0))

    def displacement(self, x: ArrayLike, y: ArrayLike) -> FloatArray:
        """Normal displacement [m], both bodies together, inside and outside the contact.

        p0 a b / 2E* times the integral over w from lambda of (1 - x^2/(a^2+w) - y^2/(b^2+w)) / sqrt((a^2+w)(b^2+w)w),
        with lambda = 0 inside and the ellipsoidal coordinate of the point outside (Johnson 3.53, 4.22).
        """
        a, b = self.semi_axes
        x2, y2 = np.broadcast_arrays(np.asarray(x, dtype=np.float64) ** 2, np.asarray(y, dtype=np.float64) ** 2)
        a2, b2 = a * a, b * b
        half = 0.5 * (x2 + y2 - a2 - b2)
        constant = a2 * b2 - x2 * b2 - y2 * a2
        root = np.sqrt(np.maximum(half**2 - constant, 0.0))
        # larger root of w^2 - 2 half w + constant, without cancellation where half < 0
        with np.errstate(divide="ignore", invalid="ignore"):
            outer = np.where(half >= 0, half + root, -constant / np.where(root - half > 0, root - half, 1.0))
        lam = np.where(constant < 0, outer, 0.0)
        from scipy.special import elliprd, elliprf

        sum_f = 2 * elliprf(lam, a2 + lam, b2 + lam)
        sum_a = (2 / 3) * elliprd(lam, b2 + lam, a2 + lam)
        sum_b = (2 / 3) * elliprd(lam, a2 + lam, b2 + lam)
        scale = self.maximum_pressure * a * b / (2 * self.contact_modulus)
        return scale * (sum_f - x2 * sum_a - y2 * sum_b)

    def undeformed_gap(self, x: ArrayLike, y: ArrayLike) -> FloatArray:
        """x^2/2Rx + y^2/2Ry [m]."""
        return np.asarray(x) ** 2 / (2 * self.radii[0]) + np.asarray(y) ** 2 / (2 * self.radii[1])

    def gap(self, x: ArrayLike, y: ArrayLike) -> FloatArray:
        """Deformed gap [m]: undeformed gap + displacement - approach; zero in the contact."""
        return self.undeformed_gap(x, y) + self.displacement(x, y) - self.approach


def sphere_contact(
    *, radius: float, contact_modulus: float, load: float | None = None, approach: float | None = None
) -> PointContact:
    """Sphere of `radius` [m] on a half-space; exactly one of `load` [N] and `approach` [m].

    a^3 = 3 P R / 4E*, approach = a^2 / R, p0 = 3P / 2 pi a^2 (Johnson 4.22-4.24).

    Raises
    ------
    InputError : values that are not positive, or not exactly one of load and approach.
    """
    return ellipse_contact(radii=(radius, radius), contact_modulus=contact_modulus, load=load, approach=approach)


def ellipse_contact(
    *, radii: tuple[float, float], contact_modulus: float, load: float | None = None, approach: float | None = None
) -> PointContact:
    """Elliptic point contact, exact; `radii` (Rx, Ry) [m] are the relative principal radii of curvature.

    With k = minor/major axis, m = 1 - k^2 and D = (K - E)/m, B = (E - k^2 K)/m (Johnson 4.26-4.28 rewritten):
    ratio of radii = B / (k^2 D), major^3 = 3 P D R_major / (pi E*), approach = 3 P K / (2 pi E* major).
    k is found by bracketing; nothing is fitted.

    Raises
    ------
    InputError : values that are not positive, a ratio of radii above 1e12, or not exactly one of load and approach.
    """
    check_positive("Hertz: ", radius_x=radii[0], radius_y=radii[1], contact_modulus=contact_modulus)
    if (load is None) == (approach is None):
        raise InputError(f"Hertz: give exactly one of load ({load!r}) and approach ({approach!r})")
    larger, smaller = max(radii), min(radii)
    ratio = larger / smaller
    if ratio > 1e12:
        raise InputError(f"Hertz: ratio of radii {ratio:.3g} is above 1e12; use cylinder_contact")
    axes_ratio = 1.0 if ratio == 1 else _axes_ratio(ratio)
    k2 = axes_ratio**2
    integral_k, integral_d = _integrals(k2)
    if load is not None:
        check_positive("Hertz: ", load=load)
        major = (3 * load * integral_d * larger / (math.pi * contact_modulus)) ** (1 / 3)
        approach = 3 * load * integral_k / (2 * math.pi * contact_modulus * major)
    else:
        assert approach is not None
        check_positive("Hertz: ", approach=approach)
        major = math.sqrt(2 * larger * approach * integral_d / integral_k)
        load = 2 * math.pi * contact_modulus * major * approach / (3 * integral_k)
    minor = axes_ratio * major
    return PointContact(
        radii=(float(radii[0]), float(radii[1])),
        contact_modulus=float(contact_modulus),
        load=float(load),
        approach=float(approach),
        semi_axes=(major, minor) if radii[0] >= radii[1] else (minor, major),
        maximum_pressure=3 * load / (2 * math.pi * major * minor),
    )


def ellipse_load(*, radii: tuple[float, float], contact_modulus: float, maximum_pressure: float) -> float:
    """Load [N] of an elliptic contact by its maximum pressure [Pa], with whose third power it goes (Johnson 1985, eq.
    4.24, 4.28); otherwise as `ellipse_contact`.

    Raises
    ------
    InputError : as `ellipse_contact`, and a load beyond numbers.
    """
    check_positive("Hertz: ", maximum_pressure=maximum_pressure)
    one = ellipse_contact(radii=radii, contact_modulus=contact_modulus, load=1.0).maximum_pressure
    # logarithms: the power of a float that is too large raises an error of its own
    if not one > 0 or 3 * math.log(maximum_pressure / one) > math.log(sys.float_info.max):
        raise InputError(
            f"Hertz: radii {radii} take a load beyond numbers at {maximum_pressure:g} Pa; give smaller radii"
        )
    return float((maximum_pressure / one) ** 3)


def smooth_load(*, radii: tuple[float, float], contact_modulus: float, maximum_pressure: float) -> float:
    """Load of a smooth contact by its maximum pressure [Pa]: on the whole [N], per length [N/m] where radii[1] is
    infinite.

    Of a line W = pi R p0^2 / E* (Johnson 1985, eq. 4.45), of a point `ellipse_load`.

    Raises
    ------
    InputError : as `ellipse_load`.
    """
    if math.isfinite(radii[1]):
        return ellipse_load(radii=radii, contact_modulus=contact_modulus, maximum_pressure=maximum_pressure)
    check_positive("Hertz: ", radius=radii[0], contact_modulus=contact_modulus, maximum_pressure=maximum_pressure)
    return math.pi * radii[0] * maximum_pressure * maximum_pressure / contact_modulus


def _integrals(k2: float) -> tuple[float, float]:
    """Carlson's R_F(0, k^2, 1) and R_D(0, k^2, 1) / 3; of a circle without loading special functions."""
    if k2 == 1:
        return math.pi / 2, math.pi / 4
    from scipy.special import elliprd, elliprf

    return float(elliprf(0.0, k2, 1.0)), float(elliprd(0.0, k2, 1.0)) / 3


def _axes_ratio(ratio: float) -> float:
    from scipy.optimize import brentq
    from scipy.special import elliprd

    def mismatch(log_k: float) -> float:
        k2 = math.exp(2 * log_k)
        # B / (k^2 D) with B = k^2 R_D(0, 1, k^2) / 3 and D = R_D(0, k^2, 1) / 3
        return math.log(float(elliprd(0.0, 1.0, k2)) / float(elliprd(0.0, k2, 1.0))) - math.log(ratio)

    return math.exp(brentq(mismatch, -20.0, 0.0, xtol=1e-16, rtol=8.9e-16))


@dataclass(frozen=True)
class LineContact:
    """Contact of a cylinder with axis y on a half-space; `load` per unit length [N/m], lengths [m], moduli [Pa]."""

    radius: float
    contact_modulus: float
    load: float
    half_width: float
    maximum_pressure: float

    @property
    def mean_pressure(self) -> float:
        """Load over contact width [Pa], pi/4 of the maximum."""
        return math.pi * self.maximum_pressure / 4

    def pressure(self, x: ArrayLike) -> FloatArray:
        """Pressure [Pa], zero outside |x| <= half_width."""
        return self.maximum_pressure * np.sqrt(np.maximum(1 - (np.asarray(x) / self.half_width) ** 2, 0.0))

    def gap(self, x: ArrayLike) -> FloatArray:
        """Deformed gap [m]: a^2/2R (s sqrt(s^2-1) - arccosh s), s = |x|/a, outside the contact."""
        s = np.maximum(np.abs(np.asarray(x)) / self.half_width, 1.0)
        return self.half_width**2 / (2 * self.radius) * (s * np.sqrt(s * s - 1) - np.arccosh(s))

    def displacement(self, x: ArrayLike) -> FloatArray:
        """Normal displacement [m] less that at x = 0; in plane strain only differences mean anything."""
        return self.gap(x) - np.asarray(x) ** 2 / (2 * self.radius)

    def approach(self, distance: float) -> float:
        """Approach [m] with the surface at `distance` from the middle as datum.

        A half-plane under a line load sinks without bound, so an approach needs its datum.
        """
        return -float(self.displacement(distance))


def cylinder_contact(*, radius: float, contact_modulus: float, load: float) -> LineContact:
    """Cylinder on a half-space, `load` per unit length [N/m]: a^2 = 4WR/pi E*, p0 = 2W/pi a (Johnson 4.43-4.45).

    Raises
    ------
    InputError : values that are not positive.
    """
    check_positive("Hertz: ", radius=radius, contact_modulus=contact_modulus, load=load)
    half_width = math.sqrt(4 * load * radius / (math.pi * contact_modulus))
    return LineContact(
        radius=float(radius),
        contact_modulus=float(contact_modulus),
        load=float(load),
        half_width=half_width,
        maximum_pressure=2 * load / (math.pi * half_width),
    )
