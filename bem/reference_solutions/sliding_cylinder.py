"""Rigid cylinder that slides or rolls without friction over a Zener half-space (Hunter 1961), in closed form.

With l the length of the retarded and m = l / (1 + c) that of the relaxing memory, c the delayed over the instantaneous
compliance, u - l u' = (1 + c) K (p - m p') for a contact that moves along +x. In the contact u' = -x / R, which gives

phi = p - m p' = [A0 + A1 T1(t) + A2 T2(t)] / sqrt(1 - t^2), t = (x - x0) / a,
A0 = W / (pi a), A1 = E* (l - x0) / (2 (1 + c) R), A2 = -E* a / (4 (1 + c) R).

Half-width a and centre x0 follow from p = 0 at both ends, A0 I0 - A1 I1 + A2 I2 = 0 at a / m, and from the slope of the
surface that comes to the front, (x0 + a) / R = 2 (1 + c) / E* zeta (A0 M0 + A1 M1 + A2 M2), zeta = a / l, with
M0 = e^zeta K0, M1 = e^zeta K1 - 1 / zeta, M2 = e^zeta K2 - 2 / zeta - 2 / zeta^2.

Derived here; S. C. Hunter, Journal of Applied Mechanics 28 (1961), who has the solution, could not be read.
Verified in tests/viscoelastic/test_steady.py: elastic limits and first orders at slow and at fast motion.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from bem.errors import InputError


@dataclass(frozen=True)
class SlidingCylinder:
    """Steady contact of a rigid cylinder that moves along +x; SI units.

    load : per length [N/m].
    radius : [m].
    contact_modulus : instantaneous, of the half-space [Pa].
    share : part of the modulus that relaxes.
    length : speed times relaxation time [m].

    Raises
    ------
    InputError : values that are not positive, a share of one or more.
    """

    load: float
    radius: float
    contact_modulus: float
    share: float
    length: float

    def __post_init__(self) -> None:
        values = (self.load, self.radius, self.contact_modulus, self.share, self.length)
        if not all(math.isfinite(value) and value > 0 for value in values) or self.share >= 1:
            raise InputError("SlidingCylinder: all values must be positive and finite, and the share below one")

    @property
    def _softening(self) -> float:
        """Return 1 + c, the relaxed over the instantaneous compliance."""
        return 1 / (1 - self.share)

    def _state(self, a: float) -> tuple[float, float, float]:
        """Return centre, A1 and the error of the slope at the front for a half-width."""
        from scipy.special import ive, kve

        relaxing, soft = self.length, self._softening
        retarded = relaxing * soft
        z, zeta = a / relaxing, a / retarded
        a0 = self.load / (math.pi * a)
        a2 = -self.contact_modulus * a / (4 * soft * self.radius)
        a1 = (a0 * ive(0, z) + a2 * ive(2, z)) / ive(1, z)
        centre = retarded - 2 * soft * self.radius * a1 / self.contact_modulus
        m0, m1, m2 = kve(0, zeta), kve(1, zeta) - 1 / zeta, kve(2, zeta) - 2 / zeta - 2 / zeta**2
        slope = 2 * soft / self.contact_modulus * zeta * (a0 * m0 + a1 * m1 + a2 * m2)
        return float(centre), float(a1), float((centre + a) / self.radius - slope)

    @cached_property
    def half_width(self) -> float:
        """Return half the width of the contact [m], between those of the instantaneous and of the relaxed modulus."""
        from scipy.optimize import brentq

        stiff = math.sqrt(4 * self.load * self.radius / (math.pi * self.contact_modulus))
        ends = 0.999 * stiff, 1.001 * stiff * math.sqrt(self._softening)
        return float(brentq(lambda a: self._state(a)[2], *ends, xtol=1e-14 * stiff, rtol=1e-13))

    @property
    def centre(self) -> float:
        """Return the middle of the contact ahead of the axis of the cylinder [m]."""
        return self._state(self.half_width)[0]

    @property
    def friction(self) -> float:
        """Return the hysteresis friction over the load: the arm of the pressure over the radius."""
        a = self.half_width
        centre, a1, _ = self._state(a)
        return (centre + math.pi * a**2 * a1 / (2 * self.load) - self.length) / self.radius
