"""Coarse-grid correction: the long wavelengths of the kernel that the sparse inverse does not see.

Second level of the preconditioner of step 9 of `bem.contact`. The kernel on the active cells is taken as a near part,
whose inverse is the sparse approximation G^T G, plus P F P^T. F is the kernel of a grid up to eight times coarser
(three halvings, or down to about 16 cells along the longer side, which may be coarser than any grid that is solved),
less 0.85 of the near part's own response to long wavelengths, and zero where that is larger; P is constant on each
coarse cell. G P is replaced by W, which has one entry per row, the row sum of G, in the column of the coarse cell. The
two-level preconditioner is

    inverse = G^T (1 + W F W^T)^-1 G.

With D = W^T W (diagonal) and e = D^-1/2 W^T x the middle factor is the inverse of 1 + D^1/2 F D^1/2, and one beyond the
range of W. Conjugate gradients on the coarse grid, started at zero, keep the whole positive definite, and a residual
reduced to r scales no wave by more than 1 +- r, so a rough solution is sufficient.

Verified in tests/contact/test_contact_preconditioner.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact.sparse_inverse import SparseInverseOnCells
from bem.convolution import DisplacementOperator, ScaledConvolution
from bem.transforms.loops import convolve

FloatArray = NDArray[np.float64]


_HALVINGS = 3
"""Halvings from the grid to the coarse one; coarser cells take more convolutions on large grids."""

_REDUCTION = 0.03
"""Relative reduction of the residual on the coarse grid; less costs as much outside as it saves inside."""

_ITERATIONS = 20
"""Limit of the iterations on the coarse grid; reached only for layers much stiffer than their base."""

_NEAR_FRACTION = 0.85
"""Fraction of the near part's response to long wavelengths; at edges and on small contacts it is below one."""


class Workspace(NamedTuple):
    """Fields of the conjugate gradients on the coarse grid."""

    given: FloatArray
    solution: FloatArray
    residual: FloatArray
    direction: FloatArray
    response: FloatArray
    field: NDArray[np.float32]


@dataclass(frozen=True)
class CoarseCorrection:
    """The smooth part F of an operator on a coarse grid; `rows`, `columns` map cells to coarse rows and columns."""

    convolution: ScaledConvolution
    rows: NDArray[np.int64]
    columns: NDArray[np.int64]
    workspace: Workspace

    @property
    def mapping(self) -> tuple[NDArray[np.int64], NDArray[np.int64], int]:
        """Coarse row of each row, coarse column of each column, and the number of coarse columns."""
        return self.rows, self.columns, self.workspace.field.shape[1]

    def on(self, cells: NDArray[Any], row_sums: FloatArray) -> CoarseCorrectionOnCells:
        """Return the middle factor on the active cells (cell indices), for a G with these row sums."""
        correction = self.allocated(row_sums)
        assign_cells(cells, self.mapping, row_sums, correction.blocks, correction.root, correction.inverse_root)
        return correction

    def allocated(self, row_sums: FloatArray) -> CoarseCorrectionOnCells:
        """Return the middle factor before `assign_cells` has filled it in."""
        root, inverse_root = np.zeros((2, self.workspace.given.size))
        return CoarseCorrectionOnCells(self, np.empty(row_sums.size, np.int32), row_sums, root, inverse_root)


@dataclass(frozen=True)
class CoarseCorrectionOnCells:
    """The middle factor on the active cells.

    blocks : (n,), coarse cell of each cell. weights : (n,), row sums of G. root, inverse_root : D^1/2 and D^-1/2.
    """

    coarse: CoarseCorrection
    blocks: NDArray[np.int32]
    weights: FloatArray
    root: FloatArray
    inverse_root: FloatArray

    def apply(self, values: FloatArray) -> None:
        """Apply (1 + W F W^T)^-1 approximately, in place; one thread, transforms included."""
        convolution = self.coarse.convolution
        with convolution.transform.lock:
            applications = correct(values, self.compiled())
        convolution.counted(applications)

    def compiled(self) -> tuple[Any, ...]:
        """Return the arguments of `correct`; the caller holds the lock of the transform while it runs."""
        coarse = self.coarse
        cells, diagonal = (self.blocks, self.weights), (self.root, self.inverse_root)
        return cells, diagonal, coarse.workspace, coarse.convolution.compiled()


@dataclass(frozen=True)
class Preconditioner:
    """The two-level approximate inverse on the active cells; `values` (n,) is scratch.

    `coarse` is None without a coarse correction (`coarse_correction`).
    """

    near: SparseInverseOnCells
    coarse: CoarseCorrectionOnCells | None
    values: FloatArray

    def __call__(self, residual: FloatArray, out: FloatArray) -> float:
        """Write the preconditioned residual to `out`; return its sum."""
        self.near.spread(residual, self.values)
        if self.coarse is not None:
            self.coarse.apply(self.values)
        return self.near.collect(self.values, out)


def coarse_correction(operator: DisplacementOperator, near: float) -> CoarseCorrection | None:
    """Prepare the correction of an operator whose sparse inverse has the response `near` to long wavelengths.

    Returns None where the grid is too small, or where the near response leaves nothing of the spectrum.
    """
    coarse = operator
    halvings = 0
    while halvings < _HALVINGS:
        coarser = coarse.coarsened()
        if coarser is None or coarser.grid.cells == coarse.grid.cells:
            break
        coarse = coarser
        halvings += 1
    convolution = coarse.smooth_part(operator, _NEAR_FRACTION * near) if halvings else None
    if convolution is None:
        return None
    rows, columns = (
        _coarse_cells(n, m, periodic, halvings)
        for n, m, periodic in zip(operator.grid.shape, coarse.grid.shape, operator.grid.periodic, strict=True)
    )
    cells = coarse.grid.cells
    fields = np.empty((5, cells))
    return CoarseCorrection(
        convolution,
        rows,
        columns,
        Workspace(fields[0], fields[1], fields[2], fields[3], fields[4], convolution.transform.zeros_field()),
    )


@lru_cache(maxsize=64)
def _coarse_cells(cells: int, onto: int, periodic: bool, halvings: int) -> NDArray[np.int64]:
    """Return the coarse cell, of `onto` along an axis, that each cell belongs to.

    On a free axis coarse point k lies on fine point 2^halvings k, the first of its cells: the coarse grid is shifted by
    less than half a coarse cell, alike for all cells, and a common shift leaves a convolution unchanged.
    """
    coarse = np.arange(cells) * onto // cells if periodic else np.minimum(np.arange(cells) >> halvings, onto - 1)
    coarse.flags.writeable = False
    return coarse


@compiled
def assign_cells(cells, mapping, weights, blocks, root, inverse):
    """Write the coarse cell of each cell, and D^1/2 and D^-1/2 of each coarse cell (`root` is zero on entry)."""
    rows, columns, width = mapping
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
def correct(values, far):
    """Apply the middle factor in place; return the number of convolutions."""
    cells, diagonal, workspace, transform = far
    blocks, weights = cells
    root, inverse_root = diagonal
    given, solution = workspace.given, workspace.solution
    given[:] = 0.0
    for k in range(values.size):
        given[np.uint64(blocks[k])] += weights[k] * values[k]
    given *= inverse_root
    applications = _solve(workspace, root, transform, _REDUCTION, _ITERATIONS)
    for b in range(given.size):
        given[b] = (given[b] - solution[b]) * inverse_root[b]
    for k in range(values.size):
        values[k] -= weights[k] * given[np.uint64(blocks[k])]
    return applications


@compiled
def _solve(workspace, root, transform, reduction, limit):
    """Solve (1 + D^1/2 F D^1/2) solution = given by conjugate gradients; return the number of convolutions."""
    given, solution, residual, direction, response, field = workspace
    plan, scratch, factor = transform
    field_values = field.reshape(-1)
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
            field_values[b] = root[b] * d
        convolve(plan, scratch, factor, field, field)
        curvature = 0.0
        for b in range(given.size):
            value = root[b] * field_values[b] + direction[b]
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
