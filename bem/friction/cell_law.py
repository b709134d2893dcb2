"""Constitutive law of a periodic rough cell: separation, opening and real area as functions of the mean pressure.

The cell is solved under mean pressures in a geometric sequence. Between them separation, opening and the logarithm of
the real area are monotone cubics over ln(pressure). Below the lowest pressure there is hardly any contact: the
separation is extrapolated linearly in ln(pressure), so that the pressure decays exponentially with the separation, and
the real area is proportional to the pressure.
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
from bem.notes import Note
from bem.numerics.monotone import MonotoneCubic

FADES = 0.05
"""Smallest decay length of the pressure beyond the table, as a fraction of the largest tabulated separation."""


@dataclass(frozen=True, eq=False)
class SolvedCell:
    """Solution of a periodic cell under a mean pressure.

    Attributes
    ----------
    mean_pressure : [Pa].
    separation : distance of the mean planes [m].
    opening : mean gap [m].
    share : real contact area over the area of the cell.
    pressure, displacement : (nx, ny) [Pa, m].
    opening_error : error of the opening that the contact's tolerance leaves [m].
    status : outcome.
    perimeter : length of the contact's boundary [m].
    notes : of the contact solver, such as on an area that the cells do not resolve.
    """

    mean_pressure: float
    separation: float
    opening: float
    share: float
    pressure: FloatArray
    displacement: FloatArray
    opening_error: float
    status: Status
    perimeter: float = 0.0
    notes: tuple[Note, ...] = ()


@dataclass(frozen=True, eq=False)
class CellLaw:
    """Law of a periodic cell, from at least three solutions in the order of their mean pressures."""

    grid: Grid
    cells: tuple[SolvedCell, ...]

    @classmethod
    def tabulated(
        cls, grid: Grid, solve: Callable[[float, FloatArray | None], SolvedCell], pressures: FloatArray
    ) -> CellLaw:
        """Solve the cell under mean pressures (n,) [Pa], each from the one before, and return the law."""
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
        """Return the distance of the mean planes [m] at ln(pressure), and its derivative, which is negative."""
        inside, beyond = self._cut(logarithm)
        slope = np.minimum(self._curves.slope(inside)[..., 0], -1e-9 * self.cells[0].separation)
        slope = np.where(beyond < 0, np.minimum(slope, -FADES * self.cells[0].separation), slope)
        return self._curves(inside)[..., 0] + beyond * slope, slope

    def overlap(self, logarithm: FloatArray) -> FloatArray:
        """Return mean opening less distance of the mean planes [m]: the overlap of cells that yielded."""
        values = self._curves(self._cut(logarithm)[0])
        return np.maximum(values[..., 1] - values[..., 0], 0.0)

    def share(self, logarithm: FloatArray) -> FloatArray:
        """Return the fraction of the cell in contact at ln(pressure)."""
        inside, beyond = self._cut(logarithm)
        return np.minimum(np.exp(self._curves(inside)[..., 2] + beyond), 1.0)

    def perimeter(self, logarithm: FloatArray) -> FloatArray:
        """Return the length of the contact's boundary over the area of the cell [1/m] at ln(pressure)."""
        lengths = [cell.perimeter / self.grid.area for cell in self.cells]
        inside, beyond = self._cut(logarithm)
        return np.asarray(np.interp(inside, self._logarithms, lengths) * np.exp(np.minimum(beyond, 0.0)))

    def _cut(self, logarithm: FloatArray) -> tuple[FloatArray, FloatArray]:
        inside = np.clip(logarithm, self._logarithms[0], self._logarithms[-1])
        return inside, logarithm - inside

    def mean_coefficient(self, law: BoundaryFriction, pressure: FloatArray, sliding_speed: float) -> float:
        """Return boundary friction force over load of cells under mean pressures (n, m) [Pa]."""
        of_cells = [
            law.mean_coefficient(one.pressure, filled_part(one.pressure, one.share * self.grid.area, self.grid), speed)
            for one, speed in ((cell, sliding_speed) for cell in self.cells)
        ]
        at = np.interp(np.log(np.maximum(pressure, 1e-300)), self._logarithms, of_cells)
        return float((at * pressure).sum() / pressure.sum())

    def shown(self, pressure: float) -> tuple[FloatArray, FloatArray]:
        """Return pressure and displacement (nx, ny) [Pa, m] of a cell under a mean pressure [Pa].

        They are interpolated linearly between the two neighbours in the table.
        """
        known = np.array([cell.mean_pressure for cell in self.cells])
        first = int(np.clip(known.searchsorted(pressure) - 1, 0, len(known) - 2))
        part = float(np.clip((pressure - known[first]) / (known[first + 1] - known[first]), 0.0, 1.0))
        one, other = self.cells[first], self.cells[first + 1]
        return (
            (1 - part) * one.pressure + part * other.pressure,
            (1 - part) * one.displacement + part * other.displacement,
        )

    def notes_at(self, pressure: float) -> tuple[Note, ...]:
        """Return the notes on the tabulated cell whose mean pressure is nearest to a pressure [Pa] on a log scale."""
        return self.cells[int(np.argmin(np.abs(self._logarithms - math.log(pressure))))].notes

    @property
    def status(self) -> Status:
        """Status of the first solution that is not converged, else converged."""
        return next((cell.status for cell in self.cells if cell.status is not Status.CONVERGED), Status.CONVERGED)
