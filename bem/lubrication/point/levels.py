"""A point contact on grids of one rectangle, each about half as fine as the one before: gap, deflection, transfers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.sparse import csr_matrix

from bem.convolution import DisplacementOperator
from bem.grid import FloatArray
from bem.lubrication.flow_factors import PlaneWalls
from bem.lubrication.point import lines
from bem.lubrication.point.far import Far, far_load

DENSE = 1100
"""Cells of a grid whose matrix is inverted as a whole."""
LIGHT, DENSE_LIGHT = 1000.0, 300
"""Load M up to which the coarsest of several grids is as small as this: on 256 cells a side contacts with M 20 to 1000
take up to a tenth more cycles then, in three quarters of the time; with M 10,000, L 20 two and a half times as many."""
SEMI = 1.6
"""Ratio of spacings from which only the finer axis is made coarser."""


@dataclass(frozen=True, eq=False)
class InTime:
    """What a step in time adds. storing : d(rho H)/dT = storing rho H + history (nx, ny), dH0/dT = storing H0 +
    datum_history. inertia : (a, b), the load that accelerates the ball, a H0 + b."""

    storing: float
    history: FloatArray
    datum_history: float
    inertia: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, eq=False)
class PointProblem:
    """The similarity problem: load M, curvatures (1, Rx/Ry) of the gap along x and y (others where radii change in
    time), entrainment over that of its unit, laws of the oil, the elastic bodies.

    oil : `loops.flows` has what it gives of pressures. rectangle : (x0, x1, y0, y1), the edges of the outermost cells.
    operator : for a shape, the displacement of both bodies and the factor to films from what it makes of pressures in
    their unit; None of rigid bodies. typical_film : what is expected in the middle. heights : (nx, ny) of both surfaces
    out of the bodies, None of smooth ones. in_time : None of a steady film. walls : flow factors, of steady films
    alone; None of smooth walls, and far away walls count as smooth. layer : oil that the surfaces bring along, in
    films, of steady ones alone, less than there is room for on the inlet's outermost cells; infinite of a flooded one
    where account is kept of the oil everywhere, None where it is not.
    """

    load: float
    curvatures: tuple[float, float]
    drag: tuple[float, float]
    oil: Callable[[FloatArray], FloatArray]
    rectangle: tuple[float, float, float, float]
    operator: Callable[[tuple[int, int]], tuple[DisplacementOperator, float]] | None
    typical_film: float
    heights: FloatArray | None = None
    in_time: InTime | None = None
    walls: PlaneWalls | None = None
    layer: float | None = None

    @property
    def starved(self) -> bool:
        """Return True if the gap is not full far away."""
        return self.layer is not None and self.layer < np.inf

    @property
    def storing(self) -> float:
        """Derivative of d(rho H)/dT with rho H."""
        return 0.0 if self.in_time is None else self.in_time.storing

    @property
    def squeeze_slope(self) -> float:
        """Derivative of the squeeze's far pressure times film squared with H0 (`far`)."""
        return -3 / sum(self.curvatures) * self.storing

    def far(self, datum: float) -> Far:
        """What there is far away."""
        squeeze = 0.0
        if self.in_time is not None:
            squeeze = -3 / sum(self.curvatures) * (self.storing * datum + self.in_time.datum_history)
        return Far(self.drag, self.curvatures, squeeze)

    def outside(self, datum: float) -> tuple[float, float]:
        """Load outside the rectangle, and its derivative with H0."""
        if self.starved:
            return 0.0, 0.0
        lifting = 0.0 if self.operator is None else self.load
        return far_load(self.rectangle, self.far(datum), datum, lifting, self.squeeze_slope)

    def wanted(self, datum: float) -> tuple[float, float]:
        """The load that pressures must carry, inertia included, and its derivative with H0."""
        slope, rest = (0.0, 0.0) if self.in_time is None else self.in_time.inertia
        return self.load + slope * datum + rest, slope


@dataclass(frozen=True)
class Level:
    """One grid: shape, and the problem on it. part : whether it only helps a finer one."""

    problem: PointProblem
    shape: tuple[int, int]
    part: bool = False

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
    def cell(self) -> float:
        """Area of a cell."""
        return self.spacing[0] * self.spacing[1]

    @cached_property
    def gap(self) -> FloatArray:
        """Of the undeformed bodies (nx, ny)."""
        along, across = self.problem.curvatures
        gap = 0.5 * along * self.x[:, None] ** 2 + 0.5 * across * self.y[None, :] ** 2
        return gap if self.problem.heights is None else gap - self.problem.heights

    def far_source(self, datum: float) -> FloatArray:
        """Pressure times film squared far away (nx, ny); zero in the ruptured film and where the gap is not full."""
        if self.problem.starved:
            return np.zeros(self.shape)
        if self.problem.in_time is None:
            return self._steady_source
        return self.problem.far(datum).source(*self._points)

    @cached_property
    def _steady_source(self) -> FloatArray:
        return self.problem.far(0.0).source(*self._points)

    @property
    def _points(self) -> tuple[FloatArray, FloatArray]:
        x, y = np.broadcast_arrays(self.x[:, None], self.y[None, :])
        return x, y

    @cached_property
    def border(self) -> np.ndarray:
        """The outermost cells (nx, ny)."""
        border = np.ones(self.shape, dtype=bool)
        border[1:-1, 1:-1] = False
        return border

    @cached_property
    def kernel(self) -> tuple[DisplacementOperator, float] | None:
        """The operator, and the factor to films."""
        return None if self.problem.operator is None else self.problem.operator(self.shape)

    def deflection(self, pressure: FloatArray) -> FloatArray:
        """Of both bodies under pressures (nx, ny)."""
        if self.kernel is None:
            return np.zeros(self.shape)
        operator, factor = self.kernel
        out = np.empty(self.shape)
        operator.scaled().apply(pressure, out)
        out *= factor * operator.unit
        return out

    @property
    def convolutions(self) -> float:
        """Of this grid and coarser ones so far, weighed by cells."""
        own = 0.0 if self.kernel is None else float(self.kernel[0].count.applications)
        if self.coarser is None:
            return own
        share = self.coarser.shape[0] * self.coarser.shape[1] / (self.shape[0] * self.shape[1])
        return own + self.coarser.convolutions * share

    @cached_property
    def near(self) -> FloatArray:
        """Films under a unit pressure on a cell, and under one with its counterpart around it (`lines.relax`), at
        distances 0 .. along x and 0 .. 2 along y: (2, n, 3)."""
        return self._near(False)

    @cached_property
    def near_across(self) -> FloatArray:
        """The same with the axes exchanged."""
        return self._near(True)

    def _near(self, exchanged: bool) -> FloatArray:
        reach = lines.REACH
        if self.kernel is None:
            return np.zeros((2, reach + 1, 3))
        operator, factor = self.kernel
        table = operator.near_field(reach + 1) * (operator.unit * factor)
        dx, dy = self.spacing
        along, across = 0.5 * dy**2 / (dx**2 + dy**2), 0.5 * dx**2 / (dx**2 + dy**2)
        spread = table[1:-1, 1:-1].copy()
        spread -= along * (table[2:, 1:-1] + table[:-2, 1:-1]) + across * (table[1:-1, 2:] + table[1:-1, :-2])
        both = (table[1:-1, 1:-1], spread)
        ways = [one.T if exchanged else one for one in both]
        return np.ascontiguousarray([one[reach:, reach : reach + 3] for one in ways])

    @cached_property
    def deflections(self) -> FloatArray | None:
        """`deflection` of a unit pressure on a cell, at distances 0 .. along x and y (nx, ny); None of rigid bodies."""
        if self.kernel is None:
            return None
        operator, factor = self.kernel
        nx, ny = self.shape
        most = max(nx, ny)
        table = operator.near_field(most)[most : most + nx, most : most + ny]
        return np.ascontiguousarray(table * (operator.unit * factor))

    @property
    def dense_deflection(self) -> FloatArray | None:
        """The matrix (n, n) of `deflection`; None of rigid bodies."""
        table = self.deflections
        if table is None:
            return None
        nx, ny = self.shape
        along = np.abs(np.subtract.outer(np.arange(nx), np.arange(nx)))
        across = np.abs(np.subtract.outer(np.arange(ny), np.arange(ny)))
        return table[along[:, None, :, None], across[None, :, None, :]].reshape(nx * ny, nx * ny)

    @cached_property
    def coarser(self) -> Level | None:
        """About half as fine; None where this one is small enough to be inverted."""
        nx, ny = self.shape
        light = self.part and self.problem.load <= LIGHT and self.problem.heights is None
        if nx * ny <= (DENSE_LIGHT if light else DENSE):
            return None
        dx, dy = self.spacing
        if dy >= SEMI * dx:
            shape = ((nx + 1) // 2, ny)
        elif dx >= SEMI * dy:
            shape = (nx, (ny + 1) // 2)
        else:
            shape = ((nx + 1) // 2, (ny + 1) // 2)
        return Level(self.problem, shape, part=True)

    @cached_property
    def _between(self) -> tuple[csr_matrix, csr_matrix, csr_matrix, csr_matrix]:
        assert self.coarser is not None
        pairs = [_linear(f, c) for f, c in zip(self.shape, self.coarser.shape, strict=True)]
        means = []
        for matrix in pairs:
            weight = np.asarray(matrix.sum(axis=0)).ravel()
            means.append(csr_matrix(matrix.multiply(1 / weight).T))
        return pairs[0], pairs[1], means[0], means[1]

    def refined(self, coarse: FloatArray) -> FloatArray:
        """Values (cx, cy) of the coarser grid, interpolated linearly."""
        px, py, _, _ = self._between
        return np.ascontiguousarray((py @ (px @ coarse).T).T)

    def averaged(self, fine: FloatArray) -> FloatArray:
        """Means around the cells of the coarser grid."""
        _, _, rx, ry = self._between
        return np.ascontiguousarray((ry @ (rx @ fine).T).T)


def _linear(fine: int, coarse: int) -> csr_matrix:
    """Linear interpolation (fine, coarse) between centres of cells of one length."""
    at = np.clip((np.arange(fine) + 0.5) * coarse / fine - 0.5, 0.0, coarse - 1.0)
    first = np.minimum(np.floor(at).astype(int), coarse - 2)
    share = at - first
    rows = np.repeat(np.arange(fine), 2)
    columns = np.column_stack([first, first + 1]).ravel()
    values = np.column_stack([1 - share, share]).ravel()
    return csr_matrix((values, (rows, columns)), shape=(fine, coarse))
