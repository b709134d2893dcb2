"""Friction laws of stick and slip: the largest traction on a cell, from its pressure and its slip speed.

To add a law, derive from `SlipFriction`, define `traction_bound`, and register it, here or in a file of your own. A
number in its place is Coulomb's coefficient.

Tractions obey the law of Coulomb with another bound g: abs(q) <= g, no slip where abs(q) < g, and slip against the
traction where abs(q) = g. Laws without a slip speed serve partial slip and rolling. A bound that falls with the slip
speed serves steady rolling only: partial slip has no time.
"""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterable
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bem.grid import FloatArray
from bem.laws import Law, parameter, register

_DIFFERENCE = 1e-6
"""Relative difference of the slip speed for the slope of a law that does not give its own."""


@dataclass(frozen=True)
class SlipFriction(Law):
    """Base class: largest traction [Pa] at a pressure and a slip speed.

    depends_on_speed : whether the bound depends on the slip speed.
    """

    family: ClassVar[str] = "slip_friction"
    depends_on_speed: ClassVar[bool] = False

    @abstractmethod
    def traction_bound(self, pressure: FloatArray, slip_speed: FloatArray) -> FloatArray:
        """Return the largest traction (n,) [Pa], not negative.

        pressure : (n,), positive [Pa]. slip_speed : (n,), not negative [m/s]; zero in laws without speed.
        """

    def slope(self, pressure: FloatArray, slip_speed: FloatArray) -> FloatArray:
        """Return the derivative (n,) of the bound with respect to the slip speed [Pa s/m]; affects cost only.

        A one-sided difference, unless a law has its own.
        """
        if not self.depends_on_speed:
            return np.zeros_like(pressure)
        step = _DIFFERENCE * max(float(slip_speed.max(initial=0.0)), np.finfo(np.float64).tiny / _DIFFERENCE)
        change = self.traction_bound(pressure, slip_speed + step) - self.traction_bound(pressure, slip_speed)
        return np.asarray(change / step)


@register
@dataclass(frozen=True)
class CoulombFriction(SlipFriction):
    """Bound proportional to the pressure: friction x p, the same as a number in place of the law."""

    name: ClassVar[str] = "coulomb"
    cites: ClassVar[tuple[str, ...]] = ("kalker1990",)
    friction: float = parameter("friction coefficient", at_least=0, at_most=10)

    def traction_bound(self, pressure: FloatArray, slip_speed: FloatArray) -> FloatArray:
        """Return friction x p [Pa]."""
        return np.asarray(self.friction * pressure)


@register
@dataclass(frozen=True)
class TrescaFriction(SlipFriction):
    """Constant shear strength of the interface, whatever the pressure: Tresca.

    Bowden and Tabor, *The Friction and Lubrication of Solids* (1950).
    """

    name: ClassVar[str] = "tresca"
    cites: ClassVar[tuple[str, ...]] = ("bowden1950",)
    shear_limit: float = parameter("shear strength of the interface", "Pa", above=0)

    def traction_bound(self, pressure: FloatArray, slip_speed: FloatArray) -> FloatArray:
        """Return the shear strength [Pa]."""
        return np.full_like(pressure, self.shear_limit)


@register
@dataclass(frozen=True)
class CoulombTrescaFriction(SlipFriction):
    """Coulomb's bound up to a shear strength: min(friction x p, shear limit).

    Bowden and Tabor, *The Friction and Lubrication of Solids* (1950).
    """

    name: ClassVar[str] = "coulomb_tresca"
    cites: ClassVar[tuple[str, ...]] = ("bowden1950",)
    friction: float = parameter("friction coefficient", at_least=0, at_most=10)
    shear_limit: float = parameter("shear strength of the interface", "Pa", above=0)

    def traction_bound(self, pressure: FloatArray, slip_speed: FloatArray) -> FloatArray:
        """Return the smaller of friction x p and the shear strength [Pa]."""
        return np.minimum(self.friction * pressure, self.shear_limit)


@dataclass(frozen=True)
class FallingFriction(SlipFriction):
    """Base class: coefficient that falls from the static one to the kinetic one with the slip speed."""

    depends_on_speed: ClassVar[bool] = True
    static_friction: float = parameter("friction coefficient at zero slip speed", above=0, at_most=10)
    kinetic_friction: float = parameter("friction coefficient at high slip speed", at_least=0, at_most=10)
    half_speed: float = parameter("slip speed at which half of the difference is left", "m/s", above=0)

    def rules(self) -> Iterable[str]:
        """Refuse a coefficient that rises with the slip speed."""
        if self.kinetic_friction > self.static_friction:
            yield f"kinetic_friction {self.kinetic_friction!r} must not exceed static_friction {self.static_friction!r}"

    @abstractmethod
    def remainder(self, ratio: FloatArray) -> FloatArray:
        """Return the part (n,) of the difference that is left at slip speeds over `half_speed`: 1 at 0, 1/2 at 1."""

    @abstractmethod
    def remainder_slope(self, ratio: FloatArray) -> FloatArray:
        """Return the derivative (n,) of `remainder`."""

    def traction_bound(self, pressure: FloatArray, slip_speed: FloatArray) -> FloatArray:
        """Return the coefficient at the slip speed times the pressure [Pa]."""
        drop = self.static_friction - self.kinetic_friction
        return np.asarray((self.kinetic_friction + drop * self.remainder(slip_speed / self.half_speed)) * pressure)

    def slope(self, pressure: FloatArray, slip_speed: FloatArray) -> FloatArray:
        """Return the derivative (n,) of the bound with respect to the slip speed [Pa s/m]."""
        drop = (self.static_friction - self.kinetic_friction) / self.half_speed
        return np.asarray(drop * self.remainder_slope(slip_speed / self.half_speed) * pressure)


@register
@dataclass(frozen=True)
class LinearlyFallingFriction(FallingFriction):
    """Coefficient that falls linearly to the kinetic one, which it has from twice the half-value speed on.

    Vollebregt and Schuttelaars, J. Sound Vib. 331 (2012) 2141, whose text was not read.
    """

    name: ClassVar[str] = "falling_linear"
    cites: ClassVar[tuple[str, ...]] = ("vollebregt2012",)

    def remainder(self, ratio: FloatArray) -> FloatArray:
        """Return 1 - ratio / 2, and zero beyond a ratio of 2."""
        return np.maximum(1 - 0.5 * ratio, 0.0)

    def remainder_slope(self, ratio: FloatArray) -> FloatArray:
        """Return the derivative (n,)."""
        return np.where(ratio < 2, -0.5, 0.0)


@register
@dataclass(frozen=True)
class RationallyFallingFriction(FallingFriction):
    """Coefficient kinetic + (static - kinetic) / (1 + v / half_speed).

    Vollebregt and Schuttelaars, J. Sound Vib. 331 (2012) 2141, whose text was not read.
    """

    name: ClassVar[str] = "falling_rational"
    cites: ClassVar[tuple[str, ...]] = ("vollebregt2012",)

    def remainder(self, ratio: FloatArray) -> FloatArray:
        """Return 1 / (1 + ratio)."""
        return np.asarray(1 / (1 + ratio))

    def remainder_slope(self, ratio: FloatArray) -> FloatArray:
        """Return the derivative (n,)."""
        return np.asarray(-1 / (1 + ratio) ** 2)


@register
@dataclass(frozen=True)
class ExponentiallyFallingFriction(FallingFriction):
    """Coefficient kinetic + (static - kinetic) 2^(-v / half_speed).

    Polach, Wear 258 (2005) 992, whose text was not read, has the same form with exp(-B v) for locomotives.
    """

    name: ClassVar[str] = "falling_exponential"
    cites: ClassVar[tuple[str, ...]] = ("polach2005",)

    def remainder(self, ratio: FloatArray) -> FloatArray:
        """Return 2^(-ratio)."""
        return np.asarray(np.exp2(-ratio))

    def remainder_slope(self, ratio: FloatArray) -> FloatArray:
        """Return the derivative (n,)."""
        return np.asarray(-np.log(2) * np.exp2(-ratio))
