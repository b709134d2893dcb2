"""Wear criteria: one scalar from the six stresses, compared with one strength.

A criterion is a function `(stress (6, ...)) -> (...)` in pascal, entered in `CRITERIA` under its name; material yields
where it exceeds the yield stress. Add one by writing the function and its entry.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from bem.grid import FloatArray
from bem.stress import von_mises


@dataclass(frozen=True)
class Criterion:
    """A named equivalent stress.

    `von_mises_factor` is the largest ratio of this equivalent stress to the von Mises stress of the same state, so that
    a bound on von Mises bounds it too; None where there is none and nothing may be skipped by that bound.
    """

    name: str
    equivalent_stress: Callable[[FloatArray], FloatArray]
    von_mises_factor: float | None


def principal_stresses(stress: FloatArray) -> FloatArray:
    """Principal stresses, shape (3, ...), ascending [Pa], of stresses (6, ...) in the order xx, yy, zz, yz, xz, xy.

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


def tresca(stress: FloatArray) -> FloatArray:
    """Tresca's equivalent stress, largest minus smallest principal stress [Pa]; equals the yield stress at yield."""
    principal = principal_stresses(stress)
    return np.asarray(principal[2] - principal[0])


def maximum_tension(stress: FloatArray) -> FloatArray:
    """Largest principal stress [Pa], zero where all are compressive: brittle detachment."""
    return np.asarray(np.maximum(principal_stresses(stress)[2], 0.0))


CRITERIA = {
    criterion.name: criterion
    for criterion in (
        Criterion("von_mises", von_mises, 1.0),
        # Tresca's hexagon touches von Mises' circle at pure tension and leaves it by 2/sqrt(3) at pure shear
        Criterion("tresca", tresca, 2 / np.sqrt(3)),
        Criterion("maximum_tension", maximum_tension, None),
    )
}
