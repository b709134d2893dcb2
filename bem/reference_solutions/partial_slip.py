"""Round and cylindrical Hertz contacts that stick and slip: pushed, twisted, pressed, rolling.

Cattaneo (1938); Mindlin (1949); Mindlin and Deresiewicz (1953); Lubkin (1951); Spence (1968); Carter (1926). Formulas
as in Johnson, *Contact Mechanics* (1985), sections 7.2, 7.4 and 8.3, but for torsion, which is derived here (its
elliptic integrals are often given in another form).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.integrate import quad
from scipy.optimize import brentq
from scipy.special import ellipe, ellipkm1

FloatArray = NDArray[np.float64]


def _hertz(r: ArrayLike, radius: float, load: float) -> FloatArray:
    """Pressure [Pa] of a round contact."""
    share = np.maximum(1 - (np.asarray(r, dtype=np.float64) / radius) ** 2, 0.0)
    return np.asarray(1.5 * load / (math.pi * radius**2) * np.sqrt(share), dtype=np.float64)


@dataclass(frozen=True)
class PushedBall:
    """A round Hertz contact under a tangential force: `contact_radius` [m], `load` [N], `friction`, and `compliance`
    [1/Pa], the sum of (2 - nu)/G of both bodies. Sideways slip is left out, so that it is exact for nu = 0.
    """

    contact_radius: float
    load: float
    friction: float
    compliance: float

    def stick_radius(self, force: float) -> float:
        """[m]."""
        return self.contact_radius * float(np.cbrt(1 - force / (self.friction * self.load)))

    def shift(self, force: float) -> float:
        """[m] from rest."""
        share = 1 - (1 - force / (self.friction * self.load)) ** (2 / 3)
        return 3 * self.friction * self.load / (16 * self.contact_radius) * self.compliance * share

    def traction(self, r: ArrayLike, force: float) -> FloatArray:
        """[Pa] along the force: friction x pressure less that of the circle that sticks."""
        stick = self.stick_radius(force)
        carried = self.load * (stick / self.contact_radius) ** 3
        return self.friction * (_hertz(r, self.contact_radius, self.load) - _hertz(r, stick, carried))

    def cycle_energy(self, peak: float) -> float:
        """Energy [J] of a cycle between a force and its opposite."""
        x = peak / (self.friction * self.load)
        scale = 9 * (self.friction * self.load) ** 2 * self.compliance / (10 * self.contact_radius)
        return scale * (1 - (1 - x) ** (5 / 3) - 5 * x / 6 * (1 + (1 - x) ** (2 / 3)))


@dataclass(frozen=True)
class LimitedBall:
    """A round Hertz contact that is pushed, whose traction is at most the smaller of friction x pressure and a shear
    strength. Sideways slip is left out, so that it is exact for nu = 0.

    Rigid discs of radius t that are shifted by (pi/4) compliance w(t) dt add up to no slip below the least of them;
    that the traction beyond is its bound g is Abel's equation, w = -(2/pi) d/dt of the integral of
    r g / sqrt(r^2 - t^2) from t to a. An infinite friction is the law of Tresca, with the traction of Dugdale's crack.

    contact_radius [m], load [N], friction, shear_limit [Pa]; compliance [1/Pa] is the sum of (2 - nu)/G of both bodies.
    """

    contact_radius: float
    load: float
    friction: float
    shear_limit: float
    compliance: float

    @property
    def limited_radius(self) -> float:
        """Return the radius [m] within which the shear strength is less than friction x pressure."""
        peak = 1.5 * self.load / (math.pi * self.contact_radius**2)
        return self.contact_radius * math.sqrt(max(1 - (self.shear_limit / (self.friction * peak)) ** 2, 0.0))

    def _density(self, t: float) -> float:
        """Return w [Pa]."""
        a, inner = self.contact_radius, self.limited_radius
        if math.isinf(self.friction):
            return 2 / math.pi * self.shear_limit * t / math.sqrt(a * a - t * t)
        slope = self.friction * 1.5 * self.load / (math.pi * a**3)
        if inner <= t:
            return slope * t
        return 2 / math.pi * slope * t * math.atan(math.sqrt((a * a - inner * inner) / (inner * inner - t * t)))

    def _integral(self, stick: float, power: int) -> float:
        """Return the integral of t^power w(t) from the stick radius to the edge.

        In parts that end where the bound changes; t = end sin(angle) removes a root at the end of a part.
        """
        ends = sorted({max(stick, self.limited_radius), self.contact_radius})
        total, start = 0.0, stick
        for end in ends:

            def part(angle: float, end: float = end) -> float:
                t = end * math.sin(angle)
                return t**power * self._density(t) * end * math.cos(angle)

            total += float(quad(part, math.asin(start / end), 0.5 * math.pi, epsabs=0, epsrel=1e-9)[0])
            start = end
        return total

    def shift(self, stick: float) -> float:
        """Return the shift [m] with which a circle of radius `stick` [m] still sticks."""
        return 0.25 * math.pi * self.compliance * self._integral(stick, 0)

    def force(self, stick: float) -> float:
        """Return the force [N] with which a circle of radius `stick` [m] still sticks; all slips at zero."""
        return 2 * math.pi * self._integral(stick, 1)

    def traction(self, r: ArrayLike, stick: float) -> FloatArray:
        """Return the traction [Pa] along the force under the law of Tresca, where the stick radius is `stick` [m]."""
        at = np.asarray(r, dtype=np.float64)
        held = np.sqrt(np.maximum(stick**2 - at**2, 0.0) / (self.contact_radius**2 - stick**2))
        return np.asarray(self.shear_limit * (1 - 2 / math.pi * np.arctan(held)), dtype=np.float64)


@dataclass(frozen=True)
class TwistedBall:
    """A round Hertz contact under a moment about its axis: `compliance` [1/Pa] is the sum of 1/G of both bodies.

    Rigid discs of radius t that turn by w(t) dt under each other (Reissner and Sagoci 1944) add up to no slip below the
    least of them; that the traction beyond is friction x pressure is Abel's equation for w.
    """

    contact_radius: float
    load: float
    friction: float
    compliance: float

    def angle(self, stick: float) -> float:
        """Turn [rad] with which a circle of radius `stick` [m] still sticks."""
        inner = (stick / self.contact_radius) ** 2
        peak = 1.5 * self.load / (math.pi * self.contact_radius**2)
        return 0.5 * self.friction * peak * self.compliance * float(ellipkm1(inner) - ellipe(1 - inner))

    def moment(self, stick: float) -> float:
        """[N m]: 16/3 t^3 w(t) / compliance of each disc, by parts; 3 pi/16 friction x load x radius if all slips."""
        rest = quad(lambda t: 3 * t * t * self.angle(t), stick, self.contact_radius, epsabs=0, epsrel=1e-10)[0]
        return 16 / (3 * self.compliance) * (stick**3 * self.angle(stick) + rest)


def spence_stick_share(friction_over_beta: float) -> float:
    """Stick radius over contact radius of a ball, or any punch that grows like a power, pressed without a push.

    (f / beta) K'(c) = ln((1 + c)/(1 - c)) / 2c with Dundurs' beta.
    """

    def miss(c: float) -> float:
        return float(friction_over_beta * ellipkm1(c * c) - math.log((1 + c) / (1 - c)) / (2 * c))

    return float(brentq(miss, 1e-9, 1 - 1e-12))


def bonded_stiffening(poissons_ratio: float) -> float:
    """Stiffness of a rigid punch, or of a ball at a given contact radius, that sticks to an elastic body over that of
    one without friction: (1 - nu) ln(3 - 4 nu) / (1 - 2 nu), 1 for nu = 1/2.

    Of a ball that is pressed on, each increment is a bonded punch (Spence 1968), and 3/2 x load over approach is it.
    """
    rest = 1 - 2 * poissons_ratio
    return 1.0 if rest == 0 else (1 - poissons_ratio) * math.log1p(2 * rest) / rest


@dataclass(frozen=True)
class RollingCylinder:
    """Like cylinders that roll: contact `half_width` [m], `radius` [m] of relative curvature, `peak_pressure` [Pa],
    `friction`; rolling along +x, the first body carries `share` of friction x load along +x.
    """

    half_width: float
    radius: float
    peak_pressure: float
    friction: float

    def creepage(self, share: float) -> float:
        """Velocity of the first body against the second over the rolling velocity, against the force."""
        return -self.friction * self.half_width / self.radius * (1 - math.sqrt(1 - share))

    def traction(self, x: ArrayLike, share: float) -> FloatArray:
        """[Pa] on the first body: less than friction x pressure where it sticks, next to where it rolls in."""
        a, stick = self.half_width, self.half_width * math.sqrt(1 - share)
        at = np.asarray(x, dtype=np.float64)
        whole = np.sqrt(np.maximum(1 - (at / a) ** 2, 0.0))
        part = stick / a * np.sqrt(np.maximum(1 - ((at - (a - stick)) / stick) ** 2, 0.0))
        return np.asarray(self.friction * self.peak_pressure * (whole - part), dtype=np.float64)
