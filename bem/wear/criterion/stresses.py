"""Criteria of stresses point by point: von Mises (the source's), Tresca, the largest tension. None has a length."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from bem.grid import FloatArray
from bem.laws import parameter, register
from bem.wear.criterion.base import StressCriterion


def principal_stresses(stress: FloatArray) -> FloatArray:
    """Return principal stresses (3, ...), ascending [Pa], of stresses (6, ...) in the order xx, yy, zz, yz, xz, xy.

    Trigonometric solution of the characteristic cubic (Malvern 1969, section 3.3), from the invariants of the deviator.
    """
    xx, yy, zz, yz, xz, xy = stress
    mean = (xx + yy + zz) / 3
    a, b, c = xx - mean, yy - mean, zz - mean
    half_second = (a * a + b * b + c * c) / 2 + yz * yz + xz * xz + xy * xy
    third = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz)
    radius = 2 * np.sqrt(half_second / 3)
    with np.errstate(divide="ignore", invalid="ignore"):
        cosine = np.where(radius > 0, 4 * third / radius**3, 1.0)
    angle = np.arccos(np.clip(cosine, -1, 1)) / 3
    largest = mean + radius * np.cos(angle)
    smallest = mean + radius * np.cos(angle + 2 * np.pi / 3)
    return np.stack([smallest, 3 * mean - largest - smallest, largest])


@register
@dataclass(frozen=True)
class VonMises(StressCriterion):
    """Von Mises stress; equals the yield stress at yield."""

    name: ClassVar[str] = "von_mises"
    cites: ClassVar[tuple[str, ...]] = ("akchurin2017",)

    @property
    def is_von_mises(self) -> bool:
        """True unless a derived law defines an equivalent stress of its own."""
        return type(self).equivalent_stress is VonMises.equivalent_stress

    @property
    def von_mises_factor(self) -> float | None:
        """One for von Mises stress itself."""
        return 1.0 if self.is_von_mises else None

    def equivalent_stress(self, stress: FloatArray) -> FloatArray:
        """Return the von Mises stress."""
        from bem.stress import von_mises  # kernels and transforms are not loaded for a name

        return von_mises(stress)


@register
@dataclass(frozen=True)
class Tresca(StressCriterion):
    """Largest minus smallest principal stress; equals the yield stress at yield."""

    name: ClassVar[str] = "tresca"
    cites: ClassVar[tuple[str, ...]] = ("johnson1985",)

    @property
    def von_mises_factor(self) -> float:
        """Tresca's hexagon touches von Mises' circle at pure tension and leaves it by 2/sqrt(3) at pure shear."""
        return float(2 / np.sqrt(3))

    def equivalent_stress(self, stress: FloatArray) -> FloatArray:
        """Return the largest minus the smallest principal stress."""
        principal = principal_stresses(stress)
        return np.asarray(principal[2] - principal[0])


@register
@dataclass(frozen=True)
class MaximumTension(StressCriterion):
    """Largest principal stress, zero where all are compressive: brittle detachment.

    Tension is largest at the surface, so by default there is no skin.
    """

    name: ClassVar[str] = "maximum_tension"
    cites: ClassVar[tuple[str, ...]] = ("johnson1985",)
    skin_depth: float = parameter(
        "depth below the surface down to which the stress counts as that at this depth",
        "m",
        default=0.0,
        at_least=0,
        source="a choice: tension is largest at the surface",
        keyword_only=True,
    )

    def equivalent_stress(self, stress: FloatArray) -> FloatArray:
        """Return the largest principal stress, at least zero."""
        return np.asarray(np.maximum(principal_stresses(stress)[2], 0.0))
