"""How a cell of the roughness that repeats gives way under a mean pressure: tabulated once, as far as it is asked for.

The cell is solved, periodic, under mean pressures in equal ratios; between them separation, opening and real area are
monotone cubics over the logarithm of the pressure. Below the least of them, where there is next to no contact, the
separation goes on as the logarithm, so that pressures fall to nothing within some separations of the roughness, and
the real area in proportion to the pressure.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from bem.errors import Status
from bem.friction.boundary import BoundaryFriction, filled_part
from bem.grid import FloatArray, Grid
from bem.numerics.monotone import MonotoneCubic

FADES = 0.05
"""Of the largest separation tabulated: over so much more the pressure falls by a factor e."""


@dataclass(frozen=True, eq=False)
class SolvedCell:
    """A cell under a mean pressure [Pa]: distance of the mean planes and mean opening [m], real contact area over that
    of the cell, pressure and displacement (nx, ny) [Pa, m], how well the opening is known [m]."""

    mean_pressure: float
    separation: float
    opening: float
    share: float
    pressure: FloatArray
    displacement: FloatArray
    opening_error: float
    status: Status


@dataclass(frozen=True, eq=False)
class CellLaw:
    """Cells (at least three) in the order of their mean pressures."""

    grid: Grid
    cells: tuple[SolvedCell, ...]

    @classmethod
    def tabulated(
        cls, grid: Grid, solve: Callable[[float, FloatArray | None], SolvedCell], pressures: FloatArray
    ) -> CellLaw:
        """Of mean pressures (n,) [Pa], each cell from the one before."""
        cells: list[SolvedCell] = []
        for pressure in pressures:
            cells.append(solve(float(pressure), cells[-1].pressure if cells else None))
        return cls(grid, tuple(cells))

    @cached_property
    def _curves(self) -> MonotoneCubic:
        columns = [(cell.separation, cell.opening, math.log(cell.share)) for cell in self.cells]
        return MonotoneCubic(self._logarithms, np.array(columns))

    @cached_property
    def _logarithms(self) -> FloatArray:
        return np.log([cell.mean_pressure for cell in self.cells])

    def separation(self, logarithm: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Distance of the mean planes [m] at ln(pressure), and its derivative there, below zero."""
        inside, beyond = self._cut(logarithm)
        slope = np.minimum(self._curves.slope(inside)[..., 0], -1e-9 * self.cells[0].separation)
        slope = np.where(beyond < 0, np.minimum(slope, -FADES * self.cells[0].separation), slope)
        return self._curves(inside)[..., 0] + beyond * slope, slope

    def overlap(self, logarithm: FloatArray) -> FloatArray:
        """By how much the mean opening is more than the distance of the mean planes [m]: what has yielded."""
        values = self._curves(self._cut(logarithm)[0])
        return np.maximum(values[..., 1] - values[..., 0], 0.0)

    def share(self, logarithm: FloatArray) -> FloatArray:
        """Of the cell in contact."""
        inside, beyond = self._cut(logarithm)
        return np.minimum(np.exp(self._curves(inside)[..., 2] + beyond), 1.0)

    def _cut(self, logarithm: FloatArray) -> tuple[FloatArray, FloatArray]:
        inside = np.clip(logarithm, self._logarithms[0], self._logarithms[-1])
        return inside, logarithm - inside

    def mean_coefficient(self, law: BoundaryFriction, pressure: FloatArray, sliding_speed: float) -> float:
        """Force over load of boundary friction where cells are under pressures (n, m) [Pa]."""
        of_cells = [
            law.mean_coefficient(one.pressure, filled_part(one.pressure, one.share * self.grid.area, self.grid), speed)
            for one, speed in ((cell, sliding_speed) for cell in self.cells)
        ]
        at = np.interp(np.log(np.maximum(pressure, 1e-300)), self._logarithms, of_cells)
        return float((at * pressure).sum() / pressure.sum())

    def shown(self, pressure: float) -> tuple[FloatArray, FloatArray]:
        """Pressure and displacement (nx, ny) [Pa, m] of a cell under a mean pressure [Pa]: those of the two tabulated
        beside it, in the proportion that has this mean."""
        known = np.array([cell.mean_pressure for cell in self.cells])
        first = int(np.clip(known.searchsorted(pressure) - 1, 0, len(known) - 2))
        part = float(np.clip((pressure - known[first]) / (known[first + 1] - known[first]), 0.0, 1.0))
        one, other = self.cells[first], self.cells[first + 1]
        return (
            (1 - part) * one.pressure + part * other.pressure,
            (1 - part) * one.displacement + part * other.displacement,
        )

    @property
    def status(self) -> Status:
        """Of the cells."""
        return next((cell.status for cell in self.cells if cell.status is not Status.CONVERGED), Status.CONVERGED)
