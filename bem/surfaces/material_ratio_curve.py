"""Material ratio curve (Abbott-Firestone) of a surface, and the functional parameters of its core, peaks and valleys.

Sees heights and no grid: the curve does not know where a height lies. Verified in tests/surfaces/test_material_ratio.py
against Gaussian and uniform heights in closed form.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.representation import readable

_CORE = 0.4
"""Fraction of the points that the secant of the core spans (ISO 21920-2, ISO 25178-2)."""


@readable
@dataclass(frozen=True, eq=False)
class MaterialRatio:
    """Material ratio curve and its parameters.

    Attributes
    ----------
    ratio : (n,) fraction of the surface that lies above `height`, rising from 0 to 1.
    height : (n,) [m] about the mean height, falling.
    Sk : height of the core [m].
    Spk, Svk : reduced height of the peaks above the core and reduced depth of the valleys below it [m].
    Smr1, Smr2 : fraction of the surface above the core, and above the bottom of the core.
    """

    ratio: FloatArray
    height: FloatArray
    Sk: float
    Spk: float
    Svk: float
    Smr1: float
    Smr2: float

    @property
    def core(self) -> tuple[float, float]:
        """Heights of the top and the bottom of the core [m], where its straight line is at ratios 0 and 1."""
        top = float(np.interp(self.Smr1, self.ratio, self.height))
        return top, top - self.Sk

    def thinned(self, points: int = 400) -> tuple[FloatArray, FloatArray]:
        """Return ratios and heights of at most so many points of the curve, both ends among them, for drawing."""
        count = self.ratio.size
        chosen = np.unique(np.linspace(0, count - 1, min(points, count)).round().astype(np.int64))
        return self.ratio[chosen], self.height[chosen]


def material_ratio(heights: FloatArray) -> MaterialRatio:
    """Return the material ratio curve of heights [m] of any shape and its parameters after ISO 25178-2.

    Of all secants that span 40 % of the points the flattest lies in the core. The straight line of least squares
    through the points of that span, drawn out to ratios 0 and 1, gives the top and the bottom of the core. The area
    between the curve and the top is that of a triangle of the base Smr1 and the height Spk; likewise Svk below the
    bottom. A flat surface has zeros and Smr1 = 0, Smr2 = 1. Source: ISO 25178-2:2021 and ISO 13565-2:1996, whose
    construction is restated here; not checked against the standards' own text.

    Raises
    ------
    InputError : fewer than ten heights, or heights that are not finite.
    """
    falling = -np.sort(-np.asarray(heights, dtype=np.float64).ravel())
    count = falling.size
    if count < 10 or not np.isfinite(falling).all():
        raise InputError(f"heights: {count} heights must be at least 10, all finite, for a material ratio curve")
    falling -= falling.mean()
    ratio = (np.arange(count) + 0.5) / count
    span = max(2, round(_CORE * count))
    first = int(np.argmin(falling[: count - span] - falling[span:]))
    core = slice(first, first + span + 1)
    slope, intercept = np.polyfit(ratio[core] - ratio[core].mean(), falling[core], 1)
    top = float(intercept - slope * ratio[core].mean())
    bottom = top + float(slope)
    above = np.maximum(falling - top, 0.0)
    below = np.maximum(bottom - falling, 0.0)
    peaks, valleys = (float(np.count_nonzero(part)) / count for part in (above, below))
    return MaterialRatio(
        ratio=ratio,
        height=falling,
        Sk=top - bottom,
        Spk=2.0 * float(above.mean()) / peaks if peaks > 0 else 0.0,
        Svk=2.0 * float(below.mean()) / valleys if valleys > 0 else 0.0,
        Smr1=peaks,
        Smr2=1.0 - valleys,
    )
