"""A length of the material: pressures and tractions averaged over a disc along the surface.

Knows grids and loads. Verified in tests/wear/test_criteria_with_length.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled, inlined
from bem.grid import FloatArray, Grid
from bem.wear.loads import SurfaceLoad

_PARTS = 16
"""Points per side by which the part of a cell within the disc is counted: areas to a thousandth of a cell."""


class Offsets(NamedTuple):
    """Cells around a centre: offsets (n,) along x and y, and a value of each."""

    x: NDArray[np.int64]
    y: NDArray[np.int64]
    value: FloatArray


def disc(grid: Grid, diameter: float) -> Offsets:
    """Return the fractions of a disc's area in the cells around its centre; their sum is one."""
    reach = [int(np.ceil(0.5 * diameter / h + 0.5)) for h in grid.spacing]
    parts = (np.arange(_PARTS) + 0.5) / _PARTS - 0.5
    x, y = ((np.arange(-n, n + 1)[:, None] + parts).ravel() * h for n, h in zip(reach, grid.spacing, strict=True))
    inside = x[:, None] ** 2 + y[None, :] ** 2 < (0.5 * diameter) ** 2
    shape = (2 * reach[0] + 1, _PARTS, 2 * reach[1] + 1, _PARTS)
    counted = inside.reshape(shape).sum(axis=(1, 3)).astype(np.float64)
    if not counted.any():  # smaller than a part of a cell
        counted[reach[0], reach[1]] = 1.0
    i, j = np.nonzero(counted)
    return Offsets(i - reach[0], j - reach[1], counted[i, j] / counted.sum())


def averaged(pressure: FloatArray, grid: Grid, diameter: float) -> FloatArray:
    """Return the mean of a pressure (nx, ny) over a disc around each cell, zero beyond a free edge."""
    return np.asarray(_spread(np.ascontiguousarray(pressure), disc(grid, diameter), grid.periodic))


def averaged_loads(loads: Sequence[SurfaceLoad], grid: Grid, diameter: float) -> list[SurfaceLoad]:
    """Return loads whose stresses are those of the given loads averaged over a disc [m] along the surface."""
    return [
        SurfaceLoad(
            averaged(load.pressure, grid, diameter),
            load.friction,
            None if load.traction is None else np.stack([averaged(part, grid, diameter) for part in load.traction]),
        )
        for load in loads
    ]


@inlined
def _neighbour(i, j, offsets, n, shape, wraps):
    """Return the cell at an offset from [i, j] across periodic edges, and True if it is on the grid."""
    k, m = i + offsets.x[n], j + offsets.y[n]
    if wraps[0]:
        k %= shape[0]
    if wraps[1]:
        m %= shape[1]
    return k, m, 0 <= k < shape[0] and 0 <= m < shape[1]


@compiled
def _spread(field, offsets, wraps):
    nx, ny = field.shape
    out = np.zeros((nx, ny))
    for i in range(nx):
        for j in range(ny):
            value = field[i, j]
            if value == 0.0:
                continue
            for n in range(offsets.x.size):
                k, m, inside = _neighbour(i, j, offsets, n, field.shape, wraps)
                if inside:
                    out[k, m] += offsets.value[n] * value
    return out
