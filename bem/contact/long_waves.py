"""What the sparse inverse cannot see: the kernel's smooth part, on a grid a few times coarser.

The kernel on the cells in contact is taken as a near part, whose inverse is the sparse approximation G^T G, plus
P F P^T: F is the kernel of a coarse grid less the near part's own response to long waves, and P is constant on each
coarse cell. Then, with W = G P reduced to its diagonal (each cell has its row sum of G),

    inverse = G^T (1 + W F W^T)^-1 G.

Beyond the range of W the middle factor is one. On it, with D = W^T W (diagonal) and e = D^-1/2 W^T x, it is the inverse
of 1 + D^1/2 F D^1/2: conjugate gradients on the coarse grid, at a small share of a convolution's cost. Begun at zero,
every iterate of theirs keeps the whole positive definite, and a residual reduced to r scales no wave by more than
1 +- r: a rough solution is good enough.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from bem.convolution import DisplacementOperator, ScaledConvolution

FloatArray = NDArray[np.float64]

_LARGEST = 128
"""Cells along the longer side of the coarse grid, if three halvings of the grid come to less than that."""

_REDUCTION = 0.03
"""Of the residual on the coarse grid; 0.1 costs as much outside as it saves inside."""

_ITERATIONS = 20
"""Limit on the coarse grid; reached only where the layer is far stiffer than what it lies on."""


@dataclass(frozen=True)
class LongWaves:
    """Smooth part of an operator on a coarse grid; `rows`, `columns` say which coarse row or column a cell is in."""

    convolution: ScaledConvolution
    rows: NDArray[np.int64]
    columns: NDArray[np.int64]
    field: NDArray[np.float32]

    def on(self, cells: NDArray[Any], row_sums: FloatArray) -> LongWavesOnCells:
        """The middle factor on some cells (flat indices), for a G with these row sums there."""
        blocks = np.empty(cells.size, np.int32)
        root = np.zeros(self.field.size)
        _assign(cells, self.rows, self.columns, self.field.shape[1], row_sums, blocks, root)
        np.sqrt(root, out=root)
        inverse_root = np.divide(1.0, root, out=np.zeros(root.size), where=root > 0)
        return LongWavesOnCells(self, blocks, row_sums, root, inverse_root)


@dataclass(frozen=True)
class LongWavesOnCells:
    """The middle factor on a given set of cells."""

    smooth: LongWaves
    blocks: NDArray[np.int32]
    weights: FloatArray
    root: FloatArray
    inverse_root: FloatArray

    def apply(self, values: FloatArray) -> None:
        """values = (1 + W F W^T)^-1 values, approximately, in place."""
        given = np.zeros(self.root.size)
        _restrict(values, self.blocks, self.weights, given)
        given *= self.inverse_root
        given -= self._solve(given)
        given *= self.inverse_root
        _subtract(values, self.blocks, self.weights, given)

    def _solve(self, given: FloatArray) -> FloatArray:
        """Conjugate gradients for (1 + D^1/2 F D^1/2) e = given, on the whole coarse grid."""
        field = self.smooth.field
        flat = field.reshape(-1)
        solution, residual, direction = np.zeros(given.size), given.copy(), np.zeros(given.size)
        response = np.empty(given.size)
        squares = float((given * given).sum())
        enough = _REDUCTION**2 * squares
        share = 0.0
        for _ in range(_ITERATIONS):
            if not squares > enough:
                break
            _turn(direction, residual, share, self.root, flat)
            self.smooth.convolution.apply(field, field)
            curvature = _respond(flat, self.root, direction, response)
            last, squares = squares, _advance(solution, residual, direction, response, squares / curvature)
            share = squares / last
        return solution


def long_waves(operator: DisplacementOperator, near: float) -> LongWaves | None:
    """Prepare for an operator whose near part responds to long waves with `near`; None where the grid is too small."""
    coarse = operator
    halvings = 0
    while halvings < 3 or max(coarse.grid.shape) > _LARGEST:
        coarser = coarse.coarsened()
        if coarser is None or coarser.grid.cells == coarse.grid.cells:
            break
        coarse = coarser
        halvings += 1
    convolution = coarse.smooth_part(operator, near) if halvings else None
    if convolution is None:
        return None
    rows, columns = (
        np.arange(n) * m // n if periodic else np.minimum(np.arange(n) >> halvings, m - 1)
        for n, m, periodic in zip(operator.grid.shape, coarse.grid.shape, operator.grid.periodic, strict=True)
    )
    return LongWaves(convolution, rows, columns, convolution.transform.zeros_field())


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _assign(cells, rows, columns, width, weights, blocks, diagonal):  # type: ignore[no-untyped-def]
    ny = columns.size
    for k in range(cells.size):
        i = cells[k] // ny
        b = rows[i] * width + columns[cells[k] - i * ny]
        blocks[k] = b
        diagonal[b] += weights[k] * weights[k]


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _restrict(values, blocks, weights, out):  # type: ignore[no-untyped-def]
    for k in range(values.size):
        out[blocks[k]] += weights[k] * values[k]


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _subtract(values, blocks, weights, field):  # type: ignore[no-untyped-def]
    for k in range(values.size):
        values[k] -= weights[k] * field[blocks[k]]


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _turn(direction, residual, share, root, field):  # type: ignore[no-untyped-def]
    for k in range(direction.size):
        d = residual[k] + share * direction[k]
        direction[k] = d
        field[k] = root[k] * d


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _respond(field, root, direction, response):  # type: ignore[no-untyped-def]
    curvature = 0.0
    for k in range(direction.size):
        value = root[k] * field[k] + direction[k]
        response[k] = value
        curvature += value * direction[k]
    return curvature


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _advance(solution, residual, direction, response, step):  # type: ignore[no-untyped-def]
    squares = 0.0
    for k in range(direction.size):
        solution[k] += step * direction[k]
        r = residual[k] - step * response[k]
        residual[k] = r
        squares += r * r
    return squares
