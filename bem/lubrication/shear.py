"""Shear laws: the shear stress an oil carries where a Newtonian one would carry mu times the shear rate.

To add a law, derive from `LimitedShear` (or `ShearLaw`, which has no limit) and register it, here or in a file of your
own. `unlimited` alone will do; its inverse, `newtonian_stress`, is found from it if a law has no formula. A law whose
limit depends on temperature defines `limit_at` and sets `limit_falls_with_temperature`;
one that bends into its limit sets `joins_limit_smoothly`. How laws act across a film is in `shear_profile`.
"""

from __future__ import annotations

import dataclasses
import math
from abc import abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from bem.grid import FloatArray
from bem.laws import Law, parameter, register

if TYPE_CHECKING:
    from bem.lubrication.rheology import ShearRheology

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(20)
_STEPS = 60
_WIDEST = 650.0
_HALVINGS = 60
REFERENCE_TEMPERATURE = 313.15
"""Temperature at which limiting coefficients are given [K]: 40 degrees Celsius."""
SHARPNESS = 6.0
"""Exponent that joins a law to its limit smoothly: 11 % below where the law reaches the limit, 1 % at 0.63 of it."""


@dataclass(frozen=True)
class Moments:
    """Moments of the Newtonian stress X(tau) across a film with tau = middle + half s, -1 < s < 1, all (n,).

    mean : 1/2 integral X ds [Pa]. first : 3/2 integral s X ds [Pa]. X = tau gives the middle and the half stress.
    Derivatives with these two; that of `first` with the middle is three times `mean_by_half`.
    """

    mean: FloatArray
    mean_by_middle: FloatArray
    mean_by_half: FloatArray
    first: FloatArray
    first_by_half: FloatArray


def _straight(law: ShearLaw, newtonian: FloatArray) -> FloatArray:
    """The same."""
    return newtonian


@dataclass(frozen=True, kw_only=True)
class ShearLaw(Law):
    """Shear stress over Newtonian shear stress and pressure; odd in the shear stress."""

    family: ClassVar[str] = "shear_law"

    @abstractmethod
    def unlimited(self, newtonian: FloatArray) -> FloatArray:
        """Shear stress [Pa] at Newtonian shear stresses [Pa], before any limit."""

    def limit(self, pressure: FloatArray | float) -> FloatArray | float:
        """Largest shear stress [Pa] at pressures [Pa]; infinite unless a law says otherwise."""
        return math.inf

    def limit_at(self, pressure: FloatArray | float, temperature: FloatArray | float | None) -> FloatArray | float:
        """Largest shear stress [Pa] at pressures [Pa] and temperatures [K]; of most laws the same at all of them."""
        return self.limit(pressure)

    def under_limit(self, stress: FloatArray, limit: FloatArray | float) -> FloatArray:
        """Shear stress [Pa] that a limit leaves of a law's stress: a sharp cut, as measured flow curves have it (Bair
        and Winer 1979), so that below it `unlimited` stays to the last bit."""
        return np.clip(stress, -limit, limit)

    def shear_stress(
        self,
        newtonian: FloatArray,
        pressure: FloatArray | float,
        temperature: FloatArray | float | None = None,
    ) -> FloatArray:
        """Shear stress [Pa] under the limit at pressures [Pa] and temperatures [K]."""
        return self.under_limit(self.unlimited(newtonian), self.limit_at(pressure, temperature))

    def of_oil(self, rheology: ShearRheology) -> ShearLaw:
        """Return the law with constants of an oil where it leaves them open; most laws leave none open."""
        return self

    limit_falls_with_temperature: ClassVar[bool] = False
    """True if the limit depends on temperature (`limit_at`)."""
    joins_limit_smoothly: ClassVar[bool] = False
    """True if the stress bends into the limit (`under_limit`); False if it is cut there."""

    @property
    def thins(self) -> bool:
        """Return True if the stress is another than the Newtonian one below the limit."""
        return type(self).unlimited is not _straight

    def newtonian_stress(self, stress: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Newtonian shear stress [Pa] at shear stresses [Pa], the inverse of `unlimited`, and its slope: by halving the
        exponent unless a law has a formula."""
        if not self.thins:
            return stress, np.ones_like(stress)
        size = np.abs(stress)
        low, high = np.full_like(size, -_WIDEST), np.full_like(size, _WIDEST)
        for _ in range(_HALVINGS):
            middle = 0.5 * (low + high)
            below = self.unlimited(np.exp(middle)) < size
            low, high = np.where(below, middle, low), np.where(below, high, middle)
        found = np.exp(0.5 * (low + high))
        step = 1e-5 * found
        slope = 2 * step / (self.unlimited(found + step) - self.unlimited(found - step))
        return np.where(size > 0, np.copysign(found, stress), 0.0), slope

    def moments(self, middle: FloatArray, half: FloatArray) -> Moments:
        """Compute the moments of the Newtonian stress across a film, see `Moments`: by Gauss' rule unless a law has a
        formula."""
        if not self.thins:
            one, none = np.ones_like(middle), np.zeros_like(middle)
            return Moments(middle, one, none, half, one)
        value, slope = self.newtonian_stress(middle[:, None] + half[:, None] * _NODES)
        return Moments(
            mean=0.5 * value @ _WEIGHTS,
            mean_by_middle=0.5 * slope @ _WEIGHTS,
            mean_by_half=0.5 * slope @ (_WEIGHTS * _NODES),
            first=1.5 * value @ (_WEIGHTS * _NODES),
            first_by_half=1.5 * slope @ (_WEIGHTS * _NODES**2),
        )

    def middle_stress(self, newtonian: FloatArray, half: FloatArray) -> FloatArray:
        """Shear stress in the middle of a film [Pa] (n,) at which the mean of the Newtonian stress is that of the
        sliding, `newtonian` >= 0 [Pa], before any limit. Newton's method from above, where the mean is convex."""
        middle = self.unlimited(newtonian)
        if not self.thins:
            return middle
        for _ in range(_STEPS):
            found = self.moments(middle, half)
            change = (found.mean - newtonian) / found.mean_by_middle
            middle = np.maximum(middle - change, 0.0)
            if (np.abs(change) <= 1e-13 * middle + 1e-15 * half).all():
                break
        return middle


@register
@dataclass(frozen=True, kw_only=True)
class Newtonian(ShearLaw):
    """Stress in proportion to the shear rate, without a limit."""

    name: ClassVar[str] = "newtonian"
    unlimited = _straight


@register
@dataclass(frozen=True, kw_only=True)
class LimitedShear(ShearLaw):
    """Newtonian up to tau_a + Lambda p."""

    name: ClassVar[str] = "limited"
    cites: ClassVar[tuple[str, ...]] = ("bair1979",)
    limiting_shear_coefficient: float = parameter(
        "limiting shear stress coefficient: slope of the limiting shear stress with pressure",
        default=0.08,
        above=0,
        source="the middle of 0.04 to 0.12: Bair and Winer, J. Lubr. Technol. 101 (1979) 251, Hoglund and Jacobson, "
        "J. Tribol. 108 (1986) 571, Bair, High-pressure rheology (2007)",
    )
    ambient_shear_strength: float = parameter(
        "limiting shear stress at ambient pressure",
        "Pa",
        default=5e6,
        above=0,
        source="the upper end of the 1 to 5 MPa of Hoglund and Jacobson (1986)",
    )
    unlimited = _straight

    def limit(self, pressure: FloatArray | float) -> FloatArray | float:
        """tau_a + Lambda p."""
        return self.ambient_shear_strength + self.limiting_shear_coefficient * pressure


@register
@dataclass(frozen=True, kw_only=True)
class Eyring(LimitedShear):
    """tau = tau0 asinh(mu du/h / tau0), tau0 the Eyring stress; Eyring (1936), Johnson and Tevaarwerk (1977)."""

    name: ClassVar[str] = "eyring"
    cites: ClassVar[tuple[str, ...]] = ("eyring1936", "johnson1977", "conry1987")
    shear_stress_limit: float = parameter("Eyring stress, where shear thinning begins", "Pa", above=0)

    def unlimited(self, newtonian: FloatArray) -> FloatArray:
        """The stress above."""
        return self.shear_stress_limit * np.arcsinh(newtonian / self.shear_stress_limit)

    def newtonian_stress(self, stress: FloatArray) -> tuple[FloatArray, FloatArray]:
        """tau0 sinh(tau / tau0)."""
        share = stress / self.shear_stress_limit
        return self.shear_stress_limit * np.sinh(share), np.cosh(share)

    def moments(self, middle: FloatArray, half: FloatArray) -> Moments:
        """Closed forms; Conry, Wang and Cusano, J. Tribol. 109 (1987) 648."""
        unit = self.shear_stress_limit
        odd, even = np.sinh(middle / unit), np.cosh(middle / unit)
        value, slope, curve = _hyperbolic(half / unit)
        return Moments(unit * odd * value, even * value, odd * slope, 3 * unit * even * slope, 3 * even * curve)

    def middle_stress(self, newtonian: FloatArray, half: FloatArray) -> FloatArray:
        """The closed form of that."""
        unit = self.shear_stress_limit
        return np.asarray(unit * np.arcsinh(newtonian / unit / _hyperbolic(half / unit)[0]))


def _hyperbolic(x: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """sinh(x)/x and its first two derivatives."""
    small = np.abs(x) < 1
    safe, square = np.where(small, 1.0, x), np.where(small, x * x, 0.0)
    value, slope, curve = np.ones_like(x), np.zeros_like(x), np.zeros_like(x)
    power = 1.0  # x^(2k - 2) / (2k + 1)!
    term = np.ones_like(x)
    for k in range(1, 10):
        power /= 2 * k * (2 * k + 1)
        curve += 2 * k * (2 * k - 1) * power * term
        slope += 2 * k * power * term
        term = term * square
        value += power * term
    sinh, cosh = np.sinh(safe) / safe, np.cosh(safe) / safe
    rise = cosh - sinh / safe
    return (
        np.where(small, value, sinh),
        np.where(small, x * slope, rise),
        np.where(small, curve, sinh - 2 * rise / safe),
    )


@register
@dataclass(frozen=True, kw_only=True)
class Carreau(LimitedShear):
    """tau = mu rate [1 + (mu rate / G)^a]^((n - 1)/a), G the critical stress, n the exponent; Carreau's a is 2, another
    one Yasuda's; Bair (2007)."""

    name: ClassVar[str] = "carreau"
    cites: ClassVar[tuple[str, ...]] = ("bair2007",)
    shear_stress_limit: float = parameter("critical shear stress, where shear thinning begins", "Pa", above=0)
    carreau_exponent: float = parameter(
        "power-law exponent of stress over shear rate, far above the critical stress", default=0.5, above=0, at_most=1
    )
    yasuda_exponent: float = parameter(
        "Yasuda exponent: how sharply shear thinning begins; 2 is Carreau's law",
        default=2.0,
        at_least=0.1,
        at_most=20,
        source="2: Carreau, Trans. Soc. Rheol. 16 (1972) 99; another: Yasuda, Armstrong and Cohen, Rheol. Acta 20 "
        "(1981) 163",
    )

    def unlimited(self, newtonian: FloatArray) -> FloatArray:
        """The stress above."""
        share = newtonian / self.shear_stress_limit
        if self.yasuda_exponent == 2:
            # hypot: the square of a Newtonian stress at high pressure is beyond floating point
            return newtonian * np.hypot(1.0, share) ** (self.carreau_exponent - 1)
        size = np.log(np.maximum(np.abs(share), 1e-300))
        grown = np.logaddexp(0.0, self.yasuda_exponent * size) / self.yasuda_exponent
        return newtonian * np.exp((self.carreau_exponent - 1) * grown)

    def newtonian_stress(self, stress: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Newton's method for the logarithm, from below, where it is concave."""
        n, a = self.carreau_exponent, self.yasuda_exponent
        wanted = np.log(np.maximum(np.abs(stress) / self.shear_stress_limit, 1e-300))
        at = np.maximum(wanted, wanted / n)
        for _ in range(_STEPS):
            grown = np.logaddexp(0.0, a * at)
            steep = 1 + (n - 1) * -np.expm1(-grown)
            change = (wanted - at - (n - 1) / a * grown) / steep
            at = at + change
            if np.abs(change).max(initial=0.0) < 1e-15 * (1 + np.abs(at).max(initial=0.0)):
                break
        steep = 1 + (n - 1) * -np.expm1(-np.logaddexp(0.0, a * at))
        value = self.shear_stress_limit * np.exp(at)
        return np.copysign(value, stress), np.exp(at - wanted) / steep


@dataclass(frozen=True)
class StressSlopes:
    """Shear stress and its derivatives, each (n,).

    stress : [Pa]. by_newtonian : with the Newtonian stress [-]. by_limit : with the limiting stress [-].
    by_eyring : with the Eyring stress [-]. by_pressure : at constant Newtonian stress [-].
    by_temperature : at constant Newtonian stress [Pa/K].
    """

    stress: FloatArray
    by_newtonian: FloatArray
    by_limit: FloatArray
    by_eyring: FloatArray
    by_pressure: FloatArray
    by_temperature: FloatArray


@register
@dataclass(frozen=True, kw_only=True)
class BaseOilShear(Eyring):
    """Eyring's law under a limiting stress that falls with temperature, with the constants of the oil's base.

    tau_e = tau0 asinh(mu du/dz / tau0) before the limit, tau = tau_e [1 + (tau_e / tau_L)^6]^(-1/6) with it, and
    tau_L = (tau_a + Lambda p) exp(-k (T - 40 degC)), T the temperature of the film. A constant that is not given is
    that of the oil (`bem.lubrication.rheology`), of a mineral oil where the base is not known.
    """

    name: ClassVar[str] = "base_oil"
    limit_falls_with_temperature: ClassVar[bool] = True
    joins_limit_smoothly: ClassVar[bool] = True
    shear_stress_limit: float = parameter(
        "Eyring stress, where thinning begins", "Pa", default=None, above=0, source="by default that of the oil's base"
    )
    limiting_shear_coefficient: float = parameter(
        "slope of the limiting shear stress with pressure, at 40 degC",
        default=None,
        above=0,
        source="by default that of the oil's base",
    )
    limiting_shear_softening: float = parameter(
        "k, relative fall of the limiting shear stress with temperature",
        "1/K",
        default=None,
        at_least=0,
        source="by default that of the oil's base",
    )
    ambient_shear_strength: float = parameter(
        "limiting shear stress at ambient pressure and 40 degC",
        "Pa",
        default=None,
        above=0,
        source="by default that of the oil's base",
    )

    def of_oil(self, rheology: ShearRheology) -> ShearLaw:
        """Return the law with the oil's constants where none are given."""
        own = rheology.parameters()
        missing: dict[str, Any] = {key: own[key] for key, value in self.values().items() if value is None}
        return dataclasses.replace(self, **missing)

    def limit(self, pressure: FloatArray | float) -> FloatArray | float:
        """The limit at 40 degC."""
        return self.ambient_shear_strength + self.limiting_shear_coefficient * pressure

    def limit_at(self, pressure: FloatArray | float, temperature: FloatArray | float | None) -> FloatArray | float:
        """The limit above; at 40 degC where no temperature is known."""
        if temperature is None:
            return self.limit(pressure)
        warmer = np.subtract(temperature, REFERENCE_TEMPERATURE)
        return np.asarray(self.limit(pressure) * np.exp(-self.limiting_shear_softening * warmer))

    def under_limit(self, stress: FloatArray, limit: FloatArray | float) -> FloatArray:
        """The smooth join above."""
        less, more = np.minimum(np.abs(stress), limit), np.maximum(np.abs(stress), limit)
        return np.copysign(less * (1 + (less / more) ** SHARPNESS) ** (-1 / SHARPNESS), stress)

    def slopes(
        self,
        newtonian: FloatArray,
        pressure: FloatArray | float,
        temperature: FloatArray | float | None = None,
    ) -> StressSlopes:
        """Return the shear stress with its exact derivatives.

        Parameters
        ----------
        newtonian : (n,) stress of the oil without a limit [Pa].
        pressure : (n,) [Pa].
        temperature : (n,) [K]; None is 40 degC.
        """
        unit, limit = self.shear_stress_limit, np.asarray(self.limit_at(pressure, temperature))
        share = newtonian / unit
        free = unit * np.arcsinh(share)
        size = np.abs(free)
        ratio = np.minimum(size, limit) / np.maximum(size, limit)
        near = (1 + ratio**SHARPNESS) ** (-1 - 1 / SHARPNESS)
        far = ratio ** (SHARPNESS + 1) * near
        by_free = np.where(size < limit, near, far)
        by_limit = np.copysign(np.where(size < limit, far, near), newtonian)
        steep = 1 / np.hypot(1.0, share)
        softened = limit / np.asarray(self.limit(pressure))
        return StressSlopes(
            stress=self.under_limit(free, limit),
            by_newtonian=by_free * steep,
            by_limit=by_limit,
            by_eyring=by_free * (np.arcsinh(share) - share * steep),
            by_pressure=by_limit * self.limiting_shear_coefficient * softened,
            by_temperature=-by_limit * self.limiting_shear_softening * limit,
        )
