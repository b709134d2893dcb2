"""One grid of a point contact and the coarser grids of its multigrid cycle: gap, deflection, flux, transfer operators.

Grids share one rectangle; each is about half as fine as the next finer one, down to a grid whose equations are solved
directly. Deflection is a convolution by FFT, O(n log n) for n cells.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix

from bem.convolution import DisplacementOperator
from bem.grid import FloatArray
from bem.lubrication.point import reynolds
from bem.lubrication.point.line_relaxation import REACH
from bem.lubrication.point.problem import PointProblem

DIRECT_CELLS = 1100
"""Largest number of cells of a grid whose equations are solved directly."""
LIGHT_LOAD, DIRECT_CELLS_LIGHT = 1000.0, 300
"""Load M up to which the coarsest of several grids is as small as this: on 256 cells a side contacts with M 20 to 1000
then take up to a tenth more cycles, in three quarters of the time; with M 10,000, L 20 two and a half times as many."""
SEMI_COARSENING = 1.6
"""Ratio of the cells' sides from which only the axis with shorter cells is coarsened."""


@dataclass(frozen=True)
class GridLevel:
    """A problem on one grid.

    problem : the similarity problem.
    shape : (nx, ny) cells.
    is_coarse : whether the grid only serves the coarse-grid correction of a finer one.
    """

    problem: PointProblem
    shape: tuple[int, int]
    is_coarse: bool = False

    @cached_property
    def spacing(self) -> tuple[float, float]:
        """Sides of a cell."""
        x0, x1, y0, y1 = self.problem.rectangle
        return (x1 - x0) / self.shape[0], (y1 - y0) / self.shape[1]

    @cached_property
    def x(self) -> FloatArray:
        """Centres of cells (nx,)."""
        return self.problem.rectangle[0] + self.spacing[0] * (np.arange(self.shape[0], dtype=np.float64) + 0.5)

    @cached_property
    def y(self) -> FloatArray:
        """Centres of cells (ny,)."""
        return self.problem.rectangle[2] + self.spacing[1] * (np.arange(self.shape[1], dtype=np.float64) + 0.5)

    @property
    def cell_area(self) -> float:
        """Area of a cell."""
        return self.spacing[0] * self.spacing[1]

    @cached_property
    def gap(self) -> FloatArray:
        """Gap (nx, ny) of the undeformed bodies at H0 = 0."""
        along, across = self.problem.curvatures
        gap = 0.5 * along * self.x[:, None] ** 2 + 0.5 * across * self.y[None, :] ** 2
        return gap if self.problem.heights is None else gap - self.problem.heights

    def far_source(self, separation: float) -> FloatArray:
        """Return the far pressure times h^2 (nx, ny); zero in the ruptured film and of a starved inlet."""
        if self.problem.starved:
            return np.zeros(self.shape)
        if self.problem.time_terms is None:
            return self._steady_source
        return self.problem.far_field(separation).source(*self._points)

    @cached_property
    def _steady_source(self) -> FloatArray:
        return self.problem.far_field(0.0).source(*self._points)

    @property
    def _points(self) -> tuple[FloatArray, FloatArray]:
        x, y = np.broadcast_arrays(self.x[:, None], self.y[None, :])
        return x, y

    @cached_property
    def boundary(self) -> np.ndarray:
        """Outermost cells (nx, ny)."""
        boundary = np.ones(self.shape, dtype=bool)
        boundary[1:-1, 1:-1] = False
        return boundary

    def flux(self, pressure: FloatArray, film: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the flux (2, nx, ny) and its derivatives (13, nx, ny), see `reynolds`.

        Derivatives have 12 parts where neither oil is entrained along y nor its content is accounted for.
        """
        problem = self.problem
        parts = 12 if problem.entrainment[1] == 0 and problem.layer is None else 13
        flux, derivatives = np.zeros((2, *self.shape)), np.zeros((parts, *self.shape))
        oil = problem.oil(pressure)
        if problem.walls is None:
            reynolds.smooth_wall_flux(pressure, film, oil, self.spacing, problem.entrainment, flux, derivatives)
        else:
            walls = problem.walls.on(film)
            reynolds.rough_wall_flux(pressure, film, oil, walls, self.spacing, problem.entrainment, flux, derivatives)
        return flux, derivatives

    @cached_property
    def elastic_operator(self) -> tuple[DisplacementOperator, float] | None:
        """Displacement operator, and the factor from its result to films; None of rigid bodies."""
        return None if self.problem.operator is None else self.problem.operator(self.shape)

    def deflection(self, pressure: FloatArray) -> FloatArray:
        """Return the deflection (nx, ny) of both bodies, a convolution by FFT."""
        if self.elastic_operator is None:
            return np.zeros(self.shape)
        operator, factor = self.elastic_operator
        out = np.empty(self.shape)
        operator.scaled().apply(pressure, out)
        out *= factor * operator.unit
        return out

    def film(self, pressure: FloatArray, separation: float) -> FloatArray:
        """Return the film (nx, ny) of a pressure: gap + deflection + H0."""
        return self.gap + self.deflection(pressure) + separation

    @property
    def convolutions(self) -> float:
        """Number of convolutions so far on this grid and coarser ones, weighted by cells."""
        own = 0.0 if self.elastic_operator is None else float(self.elastic_operator[0].count.applications)
        if self.coarser is None:
            return own
        ratio = self.coarser.shape[0] * self.coarser.shape[1] / (self.shape[0] * self.shape[1])
        return own + self.coarser.convolutions * ratio

    @cached_property
    def near_influence(self) -> FloatArray:
        """Films (2, REACH + 1, 3) under a unit change of pressure at distances 0, 1, ... along x and 0, 1, 2 along y.

        First of a change of one cell, then of a distributed change (`line_relaxation`).
        """
        return self._near_influence(exchanged=False)

    @cached_property
    def near_influence_across(self) -> FloatArray:
        """`near_influence` with exchanged axes."""
        return self._near_influence(exchanged=True)

    def _near_influence(self, *, exchanged: bool) -> FloatArray:
        if self.elastic_operator is None:
            return np.zeros((2, REACH + 1, 3))
        operator, factor = self.elastic_operator
        table = operator.near_field(REACH + 1) * (operator.unit * factor)
        dx, dy = self.spacing
        along, across = 0.5 * dy**2 / (dx**2 + dy**2), 0.5 * dx**2 / (dx**2 + dy**2)
        distributed = table[1:-1, 1:-1].copy()
        distributed -= along * (table[2:, 1:-1] + table[:-2, 1:-1]) + across * (table[1:-1, 2:] + table[1:-1, :-2])
        both = (table[1:-1, 1:-1], distributed)
        tables = [one.T if exchanged else one for one in both]
        return np.ascontiguousarray([one[REACH:, REACH : REACH + 3] for one in tables])

    @cached_property
    def influence(self) -> FloatArray | None:
        """`deflection` (nx, ny) of a unit pressure on a cell at distances 0, 1, ... along x and y; None if rigid."""
        if self.elastic_operator is None:
            return None
        operator, factor = self.elastic_operator
        nx, ny = self.shape
        most = max(nx, ny)
        table = operator.near_field(most)[most : most + nx, most : most + ny]
        return np.ascontiguousarray(table * (operator.unit * factor))

    @property
    def influence_matrix(self) -> FloatArray | None:
        """Matrix (n, n) of `deflection`; None of rigid bodies."""
        table = self.influence
        if table is None:
            return None
        nx, ny = self.shape
        along = np.abs(np.subtract.outer(np.arange(nx), np.arange(nx)))
        across = np.abs(np.subtract.outer(np.arange(ny), np.arange(ny)))
        return table[along[:, None, :, None], across[None, :, None, :]].reshape(nx * ny, nx * ny)

    @cached_property
    def coarser(self) -> GridLevel | None:
        """Grid of about half as many cells along each axis; None where this one is solved directly."""
        nx, ny = self.shape
        light = self.is_coarse and self.problem.load <= LIGHT_LOAD and self.problem.heights is None
        if nx * ny <= (DIRECT_CELLS_LIGHT if light else DIRECT_CELLS):
            return None
        dx, dy = self.spacing
        if dy >= SEMI_COARSENING * dx:
            shape = ((nx + 1) // 2, ny)
        elif dx >= SEMI_COARSENING * dy:
            shape = (nx, (ny + 1) // 2)
        else:
            shape = ((nx + 1) // 2, (ny + 1) // 2)
        return GridLevel(self.problem, shape, is_coarse=True)

    @cached_property
    def _transfer(self) -> tuple[csr_matrix, csr_matrix, csr_matrix, csr_matrix]:
        """Prolongation along x and y, restriction along x and y."""
        assert self.coarser is not None
        prolongations = [_linear_interpolation(f, c) for f, c in zip(self.shape, self.coarser.shape, strict=True)]
        restrictions = []
        for matrix in prolongations:
            weight = np.asarray(matrix.sum(axis=0)).ravel()
            restrictions.append(csr_matrix(matrix.multiply(1 / weight).T))
        return prolongations[0], prolongations[1], restrictions[0], restrictions[1]

    def prolong(self, coarse: FloatArray) -> FloatArray:
        """Interpolate values (cx, cy) of the coarser grid linearly to this grid."""
        px, py, _, _ = self._transfer
        return np.ascontiguousarray((py @ (px @ coarse).T).T)

    def restrict(self, fine: FloatArray) -> FloatArray:
        """Average values (nx, ny) of this grid around the cells of the coarser grid."""
        _, _, rx, ry = self._transfer
        return np.ascontiguousarray((ry @ (rx @ fine).T).T)


def _linear_interpolation(fine: int, coarse: int) -> csr_matrix:
    """Return the linear interpolation (fine, coarse) between centres of cells of one length."""
    at = np.clip((np.arange(fine) + 0.5) * coarse / fine - 0.5, 0.0, coarse - 1.0)
    first = np.minimum(np.floor(at).astype(int), coarse - 2)
    weight = at - first
    rows = np.repeat(np.arange(fine), 2)
    columns = np.column_stack([first, first + 1]).ravel()
    values = np.column_stack([1 - weight, weight]).ravel()
    return csr_matrix((values, (rows, columns)), shape=(fine, coarse))
