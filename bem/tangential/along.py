"""Displacements along one direction under tractions along it: an even kernel, as the normal contact's.

So that what is made for the normal contact serves here: its preconditioner (`inverse`) and its solver (`straight`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from bem.convolution import DisplacementOperator, Spectra
from bem.tangential.operator import TangentialOperator


@dataclass(frozen=True)
class AlongOperator(DisplacementOperator):
    """Displacement along a direction under tractions along it, as a normal contact's operator; without what is odd."""

    plane: TangentialOperator = field(kw_only=True)
    direction: tuple[float, float] = field(kw_only=True)

    @classmethod
    def of(cls, plane: TangentialOperator, direction: tuple[float, float]) -> AlongOperator:
        """Along a unit vector; an application counts as half of one in the plane."""
        return cls(
            plane.grid, plane.bodies, count=plane.count, weight=0.5 * plane.weight, plane=plane, direction=direction
        )

    @cached_property
    def _spectra(self) -> Spectra:
        x, y = self.direction
        even = x * x * self.plane.spectra.xx + y * y * self.plane.spectra.yy
        unit = 2.0 ** round(math.log2(float(np.abs(even).max())))
        return Spectra(even / unit, None, unit)

    def coarsened(self) -> AlongOperator | None:
        """On a grid of half as many cells along each axis; None where that grid is too small."""
        if not self._coarser:
            plane = self.plane.coarsened()
            self._coarser.append(None if plane is None else AlongOperator.of(plane, self.direction))
        coarser = self._coarser[0]
        assert coarser is None or isinstance(coarser, AlongOperator)
        return coarser
