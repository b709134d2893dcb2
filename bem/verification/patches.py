"""Loads on grids: a disc of pressure as the means over its cells, grids on whose points a reference has values, and
what the operators make of a load there.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from bem.convolution import displacement_operator
from bem.grid import FloatArray, Grid
from bem.kernels.loads import Load
from bem.materials import Body
from bem.tangential.operator import TangentialOperator


@dataclass(frozen=True)
class PointGrid:
    """A grid whose cell `origin` has its middle at the point `centre`.

    Cells are squares except along an axis with a single row.
    """

    grid: Grid
    origin: tuple[int, int]
    centre: tuple[float, float] = (0.0, 0.0)

    @property
    def axes(self) -> tuple[FloatArray, FloatArray]:
        """Coordinates of the cells' centres along x and y."""
        x, y = (
            np.asarray(c + (np.arange(n) - o) * d, dtype=np.float64)
            for n, o, d, c in zip(self.grid.shape, self.origin, self.grid.spacing, self.centre, strict=True)
        )
        return x, y

    def at(self, x: FloatArray, y: FloatArray) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
        """Indices of the cells whose centres are the points (x, y); ValueError where there is none."""
        found = []
        parts = zip((x, y), self.origin, self.grid.spacing, self.grid.shape, self.centre, strict=True)
        for values, origin, step, count, centre in parts:
            index = (np.asarray(values, dtype=float) - centre) / step + origin
            rounded = np.rint(index)
            if np.any(np.abs(index - rounded) > 1e-6) or np.any(rounded < 0) or np.any(rounded >= count):
                raise ValueError(f"points {values!r} are not all centres of cells of side {step}")
            found.append(rounded.astype(np.int64))
        return found[0], found[1]


DISPLACEMENTS = ("tangential_displacement", "transverse_displacement", "normal_displacement")
"""Names of references, along x, y and z."""


def surface_displacement(name: str, grid: Grid, body: Body, given: FloatArray, load: Load) -> FloatArray:
    """One of DISPLACEMENTS through the operators, of a pressure or a traction along x of the size `given`, (nx, ny)."""
    if name == "normal_displacement":
        pressed = displacement_operator(grid, body)(given)
        return pressed if load is Load.NORMAL else displacement_operator(grid, body, friction=1.0)(given) - pressed
    operator = TangentialOperator(grid, (body,))
    if load is Load.NORMAL:
        found = operator.displacement_under_pressure(given)
    else:
        found = operator(np.stack([given, np.zeros_like(given)]))
    return found[DISPLACEMENTS.index(name)]


def free_grid(step: float, x: tuple[float, float], y: tuple[float, float]) -> PointGrid:
    """Square cells of side `step` from x[0] to x[1] and y[0] to y[1], rounded outwards to whole cells; free."""
    low = [int(np.floor(span[0] / step + 1e-9)) for span in (x, y)]
    high = [int(np.ceil(span[1] / step - 1e-9)) for span in (x, y)]
    shape = (high[0] - low[0] + 1, high[1] - low[1] + 1)
    return PointGrid(Grid(shape, (step, step)), (-low[0], -low[1]))


def window(step: float, half: int, centre: tuple[float, float]) -> PointGrid:
    """(2 half + 1)^2 cells around a point."""
    return PointGrid(Grid((2 * half + 1, 2 * half + 1), (step, step)), (half, half), centre)


def disc_means(where: PointGrid, profile: str, radius: float = 1.0) -> FloatArray:
    """Mean over each cell of a unit pressure on a disc: `uniform`, or `hertz` with sqrt(1 - r^2/radius^2); (nx, ny).

    Across y the integral is in closed form, along x by Gauss points on each cell cut at the edge of the disc.
    """
    x, y = where.axes
    dx, dy = where.grid.spacing
    nodes, weights = np.polynomial.legendre.leggauss(12)
    total = np.zeros(where.grid.shape)
    for i, centre in enumerate(x):
        for low, high in _pieces(centre - dx / 2, centre + dx / 2, y, dy, radius):
            # the edge's slope is infinite at x = +-radius: a quadratic map there keeps the rule sharp
            at, weight = _mapped(low, high, nodes, weights, radius)
            half = np.sqrt(np.maximum(radius**2 - at**2, 0.0))[:, None]
            upper, lower = np.clip(y + dy / 2, -half, half), np.clip(y - dy / 2, -half, half)
            if profile == "uniform":
                along = upper - lower
            else:
                along = (_hertz(upper, half) - _hertz(lower, half)) / radius
            total[i] += weight @ along
    return total / (dx * dy)


def _hertz(y: FloatArray, half: FloatArray) -> FloatArray:
    """Primitive of sqrt(half^2 - y^2)."""
    safe = np.maximum(half, 1e-300)
    inside: FloatArray = 0.5 * (y * np.sqrt(np.maximum(half**2 - y**2, 0.0)) + half**2 * np.arcsin(y / safe))
    return inside


def _pieces(low: float, high: float, y: FloatArray, dy: float, radius: float) -> Iterable[tuple[float, float]]:
    """A column cut where the circle crosses the cells' sides."""
    low, high = max(low, -radius), min(high, radius)
    if low >= high:
        return
    sides = np.append(y - dy / 2, y[-1] + dy / 2)
    crossing = np.sqrt(np.maximum(radius**2 - sides**2, 0.0))
    cuts = np.unique(np.concatenate([crossing, -crossing, [0.0]]))
    inner = cuts[(cuts > low + 1e-12) & (cuts < high - 1e-12)]
    edges = [low, *inner.tolist(), high]
    yield from pairwise(edges)


def _mapped(
    low: float, high: float, nodes: FloatArray, weights: FloatArray, radius: float
) -> tuple[FloatArray, FloatArray]:
    length = high - low
    t, w = 0.5 * (nodes + 1), 0.5 * weights
    if high >= radius - 1e-12:
        return high - length * (1 - t) ** 2, w * 2 * length * (1 - t)
    if low <= -radius + 1e-12:
        return low + length * t**2, w * 2 * length * t
    return low + length * t, w * length
