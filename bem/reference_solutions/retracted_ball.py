"""Ball that is pressed into a viscoelastic half-space and pulled back at constant speed (Ting 1966), by quadrature.

While the approach h rises, a^2 = R h and W = (4 E / 3 R) int_0^t e(t - s) d(a^3)/ds ds, e being the relaxing modulus
over the instantaneous contact modulus E. While it falls, the contact is that of an earlier time t1, a^2 = R h(t1), with
int_{t1}^t e(t - s) dh/ds ds = 0, and the integral for W ends at t1: the load does not depend on the time between.

Source: T. C. T. Ting, Journal of Applied Mechanics 33 (1966), for paths of the load or the approach; the original was
not read for this code. Verified in tests/viscoelastic/test_history.py: elastic limits, and `bem verify`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from bem.errors import InputError
from bem.relaxation import PronySeries


@dataclass(frozen=True)
class RetractedBall:
    """Contact of a ball whose approach rises from zero and falls back at the same speed; SI units.

    radius : [m]. contact_modulus : instantaneous, of the half-space [Pa]. series : relaxation of the modulus.
    rise : time of the rise [s]. approach : at its end [m].
    """

    radius: float
    contact_modulus: float
    series: PronySeries
    rise: float
    approach: float

    def equal_time(self, time: float) -> float:
        """Return the time while the approach rose at which the contact was the one at `time` [s].

        Raises
        ------
        InputError : a time at which the contact has ended, or before zero.
        """
        from scipy.optimize import brentq

        if 0 <= time <= self.rise:
            return time

        def missed(first: float) -> float:
            """Integral of e(time - s) dh/ds from `first` to `time`, over the speed."""
            return self._relaxed(time - first) - 2 * self._relaxed(time - self.rise)

        if time < 0 or missed(0.0) <= 0:
            raise InputError(f"RetractedBall: time {time!r} is outside of the contact")
        return float(brentq(missed, 0.0, self.rise, xtol=1e-15 * self.rise, rtol=1e-14))

    def contact_radius(self, time: float) -> float:
        """Return the radius of the contact [m]."""
        return float((self.radius * self.approach * self.equal_time(time) / self.rise) ** 0.5)

    def load(self, time: float) -> float:
        """Return the load [N]."""
        from scipy.integrate import quad

        quadrature: Any = quad
        speed, last = self.approach / self.rise, self.equal_time(time)

        def rate(root: float) -> float:
            """Derivative of a^3 by the square root of the time, relaxed."""
            return 3 * (self.radius * speed) ** 1.5 * root**2 * self.series.modulus(time - root**2)

        total = quadrature(rate, 0.0, last**0.5, epsabs=0, epsrel=1e-12)[0]
        return float(4 * self.contact_modulus / (3 * self.radius) * total)

    def _relaxed(self, time: float) -> float:
        """Return the integral of e from zero to a time [s]."""
        pairs = zip(self.series.shares, self.series.times, strict=True)
        return time - sum(g * (time + tau * math.expm1(-time / tau)) for g, tau in pairs)
