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
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.convolution import DisplacementOperator, ScaledConvolution
from bem.transforms.loops import convolve

FloatArray = NDArray[np.float64]


_HALVINGS = 3
"""Of the grid, to the coarse one. Coarse cells of 16 cells in place of 8 take 1.3 to 4.6 convolutions more at 1024 and
2048 cells a side (periodic and free, 7 and 58 % in contact) and 5 at 4096, those of 32 another 6 to 10."""

_REDUCTION = 0.03
"""Of the residual on the coarse grid; 0.1 costs as much outside as it saves inside."""

_ITERATIONS = 20
"""Limit on the coarse grid; reached only where the layer is far stiffer than what it lies on."""


_NEAR = 0.85
"""Of the near part's response to long waves inside a contact: on its edges, and on small ones, it is less. Rough
contacts of 128 and 256 cells take a sixtieth more convolutions with one, and with 0.7 as well."""


class Workspace(NamedTuple):
    """Fields of the coarse grid between the passes: what is given, and conjugate gradients' own."""

    given: FloatArray
    solution: FloatArray
    residual: FloatArray
    direction: FloatArray
    response: FloatArray
    field: NDArray[np.float32]


@dataclass(frozen=True)
class LongWaves:
    """Smooth part of an operator on a coarse grid; `rows`, `columns` say which coarse row or column a cell is in."""

    convolution: ScaledConvolution
    rows: NDArray[np.int64]
    columns: NDArray[np.int64]
    workspace: Workspace

    def compiled(self) -> tuple[Any, ...]:
        """What compiled loops take; the caller holds the transform's lock while they run."""
        width = self.workspace.field.shape[1]
        return (self.rows, self.columns, width), self.workspace, self.convolution.compiled()

    def on(self, cells: NDArray[Any], row_sums: FloatArray) -> LongWavesOnCells:
        """The middle factor on some cells (flat indices), for a G with these row sums there."""
        width = self.workspace.field.shape[1]
        blocks, (root, inverse_root) = np.empty(cells.size, np.int32), np.zeros((2, self.workspace.given.size))
        _assign(cells, self.rows, self.columns, width, row_sums, blocks, root, inverse_root)
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
        """values = (1 + W F W^T)^-1 values, approximately, in place; one thread, transforms included."""
        convolution = self.smooth.convolution
        with convolution.transform.lock:
            applications = _apply(values, self.compiled(), _REDUCTION, _ITERATIONS)
        convolution.counted(applications)

    def compiled(self) -> tuple[Any, ...]:
        """What the compiled loop takes; the caller holds the transform's lock while it runs."""
        smooth = self.smooth
        cells, diagonal = (self.blocks, self.weights), (self.root, self.inverse_root)
        return cells, diagonal, smooth.workspace, smooth.convolution.compiled()


def long_waves(operator: DisplacementOperator, near: float) -> LongWaves | None:
    """Prepare for an operator whose near part responds to long waves with `near`; None where the grid is too small."""
    coarse = operator
    halvings = 0
    while halvings < _HALVINGS:
        coarser = coarse.coarsened()
        if coarser is None or coarser.grid.cells == coarse.grid.cells:
            break
        coarse = coarser
        halvings += 1
    convolution = coarse.smooth_part(operator, _NEAR * near) if halvings else None
    if convolution is None:
        return None
    rows, columns = (
        _coarse_cells(n, m, periodic, halvings)
        for n, m, periodic in zip(operator.grid.shape, coarse.grid.shape, operator.grid.periodic, strict=True)
    )
    cells = coarse.grid.cells
    fields = np.empty((5, cells))
    return LongWaves(
        convolution,
        rows,
        columns,
        Workspace(fields[0], fields[1], fields[2], fields[3], fields[4], convolution.transform.zeros_field()),
    )


@lru_cache(maxsize=64)
def _coarse_cells(cells: int, onto: int, periodic: bool, halvings: int) -> NDArray[np.int64]:
    """Which of `onto` coarse cells along an axis each cell is in; kept for the next contact."""
    found = np.arange(cells) * onto // cells if periodic else np.minimum(np.arange(cells) >> halvings, onto - 1)
    found.flags.writeable = False
    return found


@compiled
def _assign(cells, rows, columns, width, weights, blocks, root, inverse):
    """The coarse cell of each cell, the root of the sum of squared weights in each coarse cell, and its inverse."""
    ny = columns.size
    line, end, first = 0, 0, 0
    for k in range(cells.size):
        cell = cells[k]
        if cell >= end:
            i = cell // ny
            line, end, first = i * ny, (i + 1) * ny, rows[i] * width
        b = first + columns[np.uint64(cell - line)]
        blocks[k] = b
        root[np.uint64(b)] += weights[k] * weights[k]
    for b in range(root.size):
        if root[b] > 0:
            root[b] = np.sqrt(root[b])
            inverse[b] = 1.0 / root[b]


@compiled
def _apply(values, far, reduction, limit):
    """The middle factor; returns how many convolutions it took."""
    cells, diagonal, workspace, transform = far
    blocks, weights = cells
    root, inverse_root = diagonal
    given, solution = workspace.given, workspace.solution
    given[:] = 0.0
    for k in range(values.size):
        given[np.uint64(blocks[k])] += weights[k] * values[k]
    given *= inverse_root
    applications = _solve(workspace, root, transform, reduction, limit)
    for b in range(given.size):
        given[b] = (given[b] - solution[b]) * inverse_root[b]
    for k in range(values.size):
        values[k] -= weights[k] * given[np.uint64(blocks[k])]
    return applications


@compiled
def _solve(workspace, root, transform, reduction, limit):
    """Conjugate gradients for (1 + D^1/2 F D^1/2) solution = given, on the whole coarse grid."""
    given, solution, residual, direction, response, field = workspace
    room, scratch, factor = transform
    flat = field.reshape(-1)
    squares = 0.0
    for b in range(given.size):
        g = given[b]
        solution[b] = 0.0
        direction[b] = 0.0
        residual[b] = g
        squares += g * g
    enough = reduction**2 * squares
    share = 0.0
    for iteration in range(limit):
        if not squares > enough:
            return iteration
        for b in range(given.size):
            d = residual[b] + share * direction[b]
            direction[b] = d
            flat[b] = root[b] * d
        convolve(room, scratch, factor, field, field)
        curvature = 0.0
        for b in range(given.size):
            value = root[b] * flat[b] + direction[b]
            response[b] = value
            curvature += value * direction[b]
        step = squares / curvature
        last = squares
        squares = 0.0
        for b in range(given.size):
            solution[b] += step * direction[b]
            r = residual[b] - step * response[b]
            residual[b] = r
            squares += r * r
        share = squares / last
    return limit
