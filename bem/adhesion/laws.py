"""Adhesion laws: the traction that pulls two surfaces together, over the gap between them.

To add a law, derive from `AdhesionLaw`, define `traction` and `energy`, and register it, here or in a file of your own.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bem.grid import FloatArray, Grid
from bem.laws import Law, parameter, register


@dataclass(frozen=True)
class AdhesionLaw(Law):
    """Base class: attraction that falls with the gap, from `strength` at zero gap to nothing."""

    family: ClassVar[str] = "adhesion"
    work: float = parameter("work of adhesion, the integral of the traction over the gap", "J/m^2", above=0)
    range: float = parameter("length over which the attraction acts", "m", above=0)

    beyond_range: ClassVar[str] = "zero once its highest value is below the tolerance times the strength"
    """What becomes of the attraction at gaps beyond the range, in words."""

    @property
    def strength(self) -> float:
        """Return the traction at zero gap [Pa]."""
        return self.work / self.range

    @abstractmethod
    def traction(self, gap: FloatArray, grid: Grid) -> FloatArray:
        """Return the mean traction over each cell [Pa] at gaps (nx, ny) [m]; it must not rise with the gap."""

    @abstractmethod
    def energy(self, gap: FloatArray, grid: Grid) -> FloatArray:
        """Return the energy per area [J/m^2] at gaps (nx, ny) [m]: minus the work at zero gap, zero far away."""


@register
@dataclass(frozen=True)
class ExponentialAdhesion(AdhesionLaw):
    """Traction work / range exp(-gap / range), as in the Contact-Mechanics Challenge.

    Source: Mueser and others, Tribol. Lett. 65 (2017) 118.
    """

    name: ClassVar[str] = "exponential"
    cites: ClassVar[tuple[str, ...]] = ("mueser2017",)
    beyond_range = (
        "it falls by a factor of 2.7 with each range of the gap, and is zero once its highest value is below the "
        "tolerance times the strength"
    )

    def traction(self, gap: FloatArray, grid: Grid) -> FloatArray:
        """Return the traction [Pa] at gaps (nx, ny) [m]."""
        return np.asarray(self.strength * np.exp(-np.maximum(gap, 0.0) / self.range))

    def energy(self, gap: FloatArray, grid: Grid) -> FloatArray:
        """Return the energy per area [J/m^2] at gaps (nx, ny) [m]."""
        return np.asarray(-self.work * np.exp(-np.maximum(gap, 0.0) / self.range))


@register
@dataclass(frozen=True)
class DugdaleAdhesion(AdhesionLaw):
    """Constant traction work / range up to a gap of `range`, none beyond: Dugdale's law in Maugis' theory.

    A cell that the edge of the attractive zone cuts has the part of the traction that lies within, found from the slope
    of the gap: whole cells would hold the edge back as friction would. Source: Maugis, J. Colloid Interface Sci. 150
    (1992) 243.
    """

    name: ClassVar[str] = "dugdale"
    cites: ClassVar[tuple[str, ...]] = ("maugis1992",)
    beyond_range = "zero at gaps beyond its range"

    def traction(self, gap: FloatArray, grid: Grid) -> FloatArray:
        """Return the mean traction over each cell [Pa] at gaps (nx, ny) [m], linear within a cell."""
        rise = np.zeros(gap.shape)
        for axis in (0, 1):
            rise = np.hypot(rise, np.abs(_central_difference(gap, axis, periodic=grid.periodic[axis])))
        inside = 0.5 + (self.range - gap) / np.maximum(rise, np.finfo(np.float64).tiny)
        return np.asarray(self.strength * np.clip(inside, 0.0, 1.0))

    def energy(self, gap: FloatArray, grid: Grid) -> FloatArray:
        """Return the energy per area [J/m^2] at gaps (nx, ny) [m]."""
        return np.asarray(-self.strength * np.maximum(self.range - np.maximum(gap, 0.0), 0.0))


def _central_difference(gap: FloatArray, axis: int, *, periodic: bool) -> FloatArray:
    """Return by how much the gap changes over a cell along an axis."""
    if gap.shape[axis] < 2:
        return np.zeros(gap.shape)
    if periodic:
        return np.asarray(0.5 * (np.roll(gap, -1, axis) - np.roll(gap, 1, axis)))
    return np.asarray(np.gradient(gap, axis=axis))
