"""Shear and flow of a generalised Newtonian oil across a film.

The oil between two walls is in equilibrium, so that the shear stress is linear across it whatever its law: tau = tau_m
+ z dp/dx, |z| < h/2. With the Newtonian stress X(tau) that belongs to it (du/dz = X/mu), the sliding speed fixes the
stress in the middle, and the flow follows,

    integral X dz = mu (u2 - u1),    q = h (u1 + u2)/2 - 1/mu integral z X dz,

so that the Poiseuille flow is S h^3/(12 mu) dp/dx with S >= 1: T. F. Conry, S. Wang and C. Cusano, *J. Tribol.* 109
(1987) 648, for Eyring's law in closed form; D. Dowson (1962), Y. Peiran and W. Shizhu, *J. Tribol.* 112 (1990) 1, for
any law.

No stress in the film exceeds the limit tau_L. Where sliding would exceed it the oil slips at the limit, at the wall
where the stress is largest (B. O. Jacobson and B. J. Hamrock, *J. Tribol.* 106 (1984) 275): tau_m = tau_L - h/2
|dp/dx|. There the film moves with the other wall, and without a pressure gradient the flow would be undetermined
between the two walls. An oil is nowhere equally strong all the way across: slip is shared between both walls until
their stresses differ by much more than `SPREAD` tau_L. Verified in tests/lubrication/test_shear_profile.py.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.shear import Moments, ShearLaw

SPREAD = 0.2
"""Half difference of the wall stresses over the limit, from which slip is mostly at one wall: measured limits of one
oil scatter by as much. Films depend on it where all of the contact slips at a slide-to-roll ratio near 2 (half of it
thins them by a fifth, twice of it thickens them by a tenth), and by 3 % at most below a ratio of 1."""
STIFFNESS = 100.0
"""Slope of the flow beyond the limit, over that of an oil without a limit, where the pressure gradient alone exceeds
the limit."""
LEAST_FLUIDITY = 1e-120
"""Lower bound of the fluidity, so that products stay in floating point."""
_STEP = 1e5
"""Step of the pressure [Pa] for the slope of the limit."""


@dataclass(frozen=True)
class Profile:
    """Stress and flow across a film, (n,) each.

    middle : |tau_m| [Pa]. moment : S h/2 dp/dx [Pa]. by_newtonian, by_half, by_limit : derivatives of the moment.
    slip : part of the Newtonian stress that is slip [Pa].
    """

    middle: FloatArray
    moment: FloatArray
    by_newtonian: FloatArray
    by_half: FloatArray
    by_limit: FloatArray
    slip: FloatArray


class Sheared(Protocol):
    """Oil across a film: the law of a uniform oil, or of layers that differ; as of `ShearLaw`."""

    def moments(self, middle: FloatArray, half: FloatArray) -> Moments:
        """Return the moments of the Newtonian stress across the film."""

    def middle_stress(self, newtonian: FloatArray, half: FloatArray) -> FloatArray:
        """Return the stress in the middle at a Newtonian stress of the sliding, without a limit."""


def shear_profile(law: Sheared, newtonian: FloatArray, half: FloatArray, limit: FloatArray | float) -> Profile:
    """Return the profile at Newtonian stresses of the sliding, mu |u1 - u2|/h, at h/2 dp/dx and at limits, (n,) each
    [Pa]."""
    size, sign = np.abs(half), np.sign(half)
    with np.errstate(over="ignore", invalid="ignore"):
        if not np.isfinite(limit).all():
            middle = law.middle_stress(newtonian, size)
            found = _held(law, middle, size)
            return Profile(middle, sign * found[0], sign * found[1], found[2], 0 * size, 0 * size)
        limit = np.broadcast_to(limit, size.shape)
        within, top = np.minimum(size, limit), np.maximum(limit - size, 0.0)
        at_limit = law.moments(top, within)
        slips = (newtonian > at_limit.mean) | (size > limit)
        middle = np.where(slips, top, law.middle_stress(np.minimum(newtonian, at_limit.mean), within))
        held = _held(law, middle, within)
        slip = np.where(slips, newtonian - at_limit.mean, 0.0)
        loose = _slipping(law, slip, size, limit)
        moment, by_newtonian, by_half, by_limit = (np.where(slips, b, a) for a, b in zip(held, loose, strict=True))
    return Profile(middle, sign * moment, sign * by_newtonian, by_half, sign * by_limit, slip)


def _held(law: Sheared, middle: FloatArray, half: FloatArray) -> tuple[FloatArray, ...]:
    """Return the moment and its derivatives with Newtonian stress, half stress and limit, where nothing slips."""
    m = law.moments(middle, half)
    ratio = m.mean_by_half / m.mean_by_middle
    return m.first, 3 * ratio, m.first_by_half - 3 * ratio * m.mean_by_half, np.zeros_like(half)


def _slipping(law: Sheared, slip: FloatArray, half: FloatArray, limit: FloatArray) -> tuple[FloatArray, ...]:
    """Return the moment and the same derivatives where the oil slips at the limit."""
    over = half > limit
    m = law.moments(np.maximum(limit - half, 0.0), np.minimum(half, limit))
    share = half / (SPREAD * limit)
    side, steep = share / np.hypot(1.0, share), np.hypot(1.0, share) ** -3
    stiff = STIFFNESS * m.first_by_half
    moment = m.first + 3 * slip * side + np.where(over, stiff * (half - limit), 0.0)
    turned = 3 * slip * steep / (SPREAD * limit)
    released = 3 * side * (m.mean_by_middle - m.mean_by_half)
    by_half = turned + np.where(over, stiff, m.first_by_half - 3 * m.mean_by_half + released)
    by_limit = np.where(over, m.first_by_half - stiff, 3 * m.mean_by_half - 3 * side * m.mean_by_middle)
    return moment, 3 * side, by_half, by_limit - turned * half / limit


@dataclass(frozen=True)
class EquivalentGradient:
    """Pressure gradient that would cause the same Poiseuille flow of a Newtonian oil, on cells (n,), and its
    derivatives with the true gradient, the film, the mean fluidity and the pressure."""

    gradient: FloatArray
    by_gradient: FloatArray
    by_film: FloatArray
    by_fluidity: FloatArray
    by_pressure: FloatArray


@dataclass(frozen=True)
class ShearFlow:
    """A shear law in similarity units.

    sliding : mu0 |u1 - u2| over the unit of films [Pa]. half_stress : h/2 dp/dx [Pa] of a film and a gradient of one
        unit.
    limit : returns the limiting shear stress [Pa] and its slope, at pressures in their unit.
    """

    law: ShearLaw
    sliding: float
    half_stress: float
    limit: Callable[[FloatArray], tuple[FloatArray | float, FloatArray | float]]

    def of_share(self, share: float) -> ShearFlow:
        """Return the law at a share of all stresses: the smaller, the more Newtonian."""
        return replace(self, sliding=share * self.sliding, half_stress=share * self.half_stress)

    def equivalent_gradient(
        self, gradient: FloatArray, film: FloatArray, fluidity: FloatArray, pressure: FloatArray
    ) -> EquivalentGradient:
        """Return the equivalent gradient of cells with these gradients, films, mean fluidities and pressures, (n,)
        each."""
        fluidity = np.maximum(fluidity, LEAST_FLUIDITY)  # beyond it products would leave floating point
        unit = self.half_stress * film
        newtonian = self.sliding / (fluidity * film)
        limit, slope = self.limit(pressure)
        found = shear_profile(self.law, newtonian, unit * gradient, limit)
        value = found.moment / unit
        by_sliding = found.by_newtonian * newtonian / unit
        return EquivalentGradient(
            gradient=value,
            by_gradient=found.by_half,
            by_film=(found.by_half * gradient - by_sliding - value) / film,
            by_fluidity=-by_sliding / fluidity,
            by_pressure=found.by_limit * slope / unit,
        )


def shear_flow(lubricant: Lubricant, sliding: float, film: float, pressure: float, length: float) -> ShearFlow:
    """Return the shear law of an oil in units of film [m], pressure [Pa] and length [m]; sliding : u1 - u2 of the walls
    [m/s]."""
    law = lubricant.shear_law

    def limit(scaled: FloatArray) -> tuple[FloatArray | float, FloatArray | float]:
        value = lubricant.limiting_stress(scaled * pressure)
        if not np.isfinite(value).all():
            return value, 0.0
        return value, (lubricant.limiting_stress(scaled * pressure + _STEP) - value) / _STEP * pressure

    return ShearFlow(law, lubricant.viscosity * abs(sliding) / film, 0.5 * film * pressure / length, limit)


def middle_stress(
    lubricant: Lubricant,
    newtonian: FloatArray,
    pressure: FloatArray,
    film: FloatArray,
    gradient: FloatArray,
    temperature: FloatArray | None = None,
) -> FloatArray:
    """Return the shear stress in the middle of films [Pa]: the law at the sliding alone, or the profile where the oil's
    film follows its law.

    newtonian : mu (u1 - u2)/h [Pa]. pressure, film, gradient : [Pa], [m], [Pa/m].
    temperature : of the films [K], by default the oil's own.
    """
    if not lubricant.shears_film:
        return lubricant.shear_stress(newtonian, pressure, temperature)
    law, half, size = lubricant.shear_law, 0.5 * film * gradient, np.abs(newtonian)
    limit = lubricant.limiting_stress(pressure, temperature)
    if law.joins_limit_smoothly:
        return np.copysign(smooth_middle(law, size, half, limit), newtonian)
    return np.copysign(shear_profile(law, size, half, limit).middle, newtonian)


def smooth_middle(
    law: ShearLaw,
    newtonian: FloatArray,
    half: FloatArray,
    limit: FloatArray | float,
    layers: Sheared | None = None,
) -> FloatArray:
    """Return the stress in the middle of films [Pa] under a law that joins its limit smoothly.

    The flow slips at the limit sharply (`shear_profile`); the friction joins it as the law does, at the stress that the
    wall of the larger stress leaves to the middle. Arguments as of `shear_profile`; `layers` : of the film, if they
    differ.
    """
    size = np.abs(half)
    top = np.maximum(limit - size, 1e-9 * limit)
    with np.errstate(over="ignore", invalid="ignore"):
        free = (layers or law).middle_stress(newtonian, np.minimum(size, limit))
    return law.under_limit(free, top)
