"""The preconditioner of a round: along the push and across it apart, on the cells that may move that way.

What sticks may move both ways, what slips along the tangent of its disc only, where the disc's curvature adds to the
stiffness. Along the push the inverse is that of the cells that stick; across it that of all cells, with the curvature
on the diagonal. Each is the sparse inverse and the long waves of the normal contact (`bem.contact`) for the kernel of
that direction alone. Counted on balls and rough contacts of 256 cells: 7 to 11 iterations for five digits, where one
sparse inverse for both directions, damped by the curvature, took 12 to 29.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact.coarse_correction import CoarseCorrection, CoarseCorrectionOnCells, coarse_correction
from bem.contact.sparse_inverse import (
    IrregularRows,
    PackedRows,
    Patterns,
    SparseInverse,
    SparseInverseOnCells,
    neighbours,
    pack,
    row_of_inverse,
    sparse_inverse,
)
from bem.grid import FloatArray
from bem.tangential.along import AlongOperator
from bem.tangential.operator import TangentialOperator

_SQUARED_RADIUS = 5
"""Of the sparse inverse's stencil in cells; 2 takes a twentieth more convolutions (counted), 8 as many."""


@dataclass(frozen=True)
class _Kernel:
    """One direction's on a grid: the sparse inverse's table and the long waves, both over `unit` [m/Pa]."""

    unit: float
    sparse: SparseInverse
    waves: CoarseCorrection | None

    @classmethod
    def of(cls, operator: AlongOperator) -> _Kernel:
        """For this direction."""
        grid, near = operator.grid, operator.near_field(2 * math.isqrt(_SQUARED_RADIUS))
        sparse = sparse_inverse(grid.shape, grid.periodic, near, _SQUARED_RADIUS)
        return cls(operator.unit, sparse, coarse_correction(operator, sparse.near_response))

    def on(self, numbers: NDArray[np.int64], diagonal: FloatArray | None = None) -> _Part:
        """On cells of these flat indices, with a diagonal (n,) added to the kernel [m/Pa]."""
        near = self.sparse.on(numbers)
        if diagonal is not None:
            near = _with_diagonal(near, self.sparse.patterns, diagonal / self.unit)
        return _Part(near, None if self.waves is None else self.waves.on(numbers, near.row_sums()), self.unit)


@dataclass(frozen=True)
class _Part:
    """One direction's inverse on given cells."""

    near: SparseInverseOnCells
    far: CoarseCorrectionOnCells | None
    unit: float

    def apply(self, values: FloatArray) -> FloatArray:
        """(n,) [m] to (n,) [Pa]."""
        spread, out = np.empty_like(values), np.empty_like(values)
        self.near.spread(values, spread)
        if self.far is not None:
            self.far.apply(spread)
        self.near.collect(spread, out)
        return out / self.unit


@dataclass(frozen=True)
class Inverses:
    """What the rounds of a grid share: the direction (2,) of the push, the kernels along it and across it."""

    push: FloatArray
    along: _Kernel
    across: _Kernel

    @classmethod
    def of(cls, operator: TangentialOperator, push: FloatArray) -> Inverses:
        """For tractions that are mostly along the unit vector `push`."""
        across = (-float(push[1]), float(push[0]))
        one, two = (AlongOperator.of(operator, way) for way in ((float(push[0]), float(push[1])), across))
        return cls(push, _Kernel.of(one), _Kernel.of(two))

    def on(
        self, numbers: NDArray[np.int64], slips: NDArray[np.bool_], normal: FloatArray, curvature: FloatArray
    ) -> InverseOnCells:
        """On cells of these flat indices.

        Parameters
        ----------
        numbers : (n,).
        slips : (n,), which of them slip.
        normal : (2, n), of their discs where they do.
        curvature : (n,), what their discs add to the stiffness there [m/Pa], 0 where cells stick.
        """
        sticks = ~slips
        normal = np.where(slips, normal, self.push[:, None])
        tangent = np.stack([-normal[1], normal[0]])
        tangent *= np.where(self.push[0] * tangent[1] < self.push[1] * tangent[0], -1.0, 1.0)
        stuck = self.along.on(numbers[sticks]) if sticks.any() else None
        return InverseOnCells(
            sticks, self.push, tangent, stuck, self.across.on(numbers, curvature if slips.any() else None)
        )


@dataclass(frozen=True)
class InverseOnCells:
    """On given cells: along the push on those that stick, along `tangent` (2, n) on all."""

    sticks: NDArray[np.bool_]
    push: FloatArray
    tangent: FloatArray
    stuck: _Part | None
    every: _Part

    def apply(self, values: FloatArray) -> FloatArray:
        """Displacements (2, n) [m] to tractions (2, n) [Pa]; symmetric and positive where cells may move."""
        out = np.asarray(self.tangent * self.every.apply((self.tangent * values).sum(0)))
        if self.stuck is not None:
            stuck = self.stuck.apply((self.push @ values)[self.sticks])
            out[:, self.sticks] += self.push[:, None] * stuck
        return out


def _with_diagonal(on: SparseInverseOnCells, patterns: Patterns, diagonal: FloatArray) -> SparseInverseOnCells:
    """The sparse inverse of the kernel with a diagonal (n,) added: rows of their own where it is not zero around."""
    rows, irregular = on.rows, on.irregular
    near_field = patterns.near_field
    table, packed = _rows_with_diagonal(rows, irregular, patterns.offsets, near_field, patterns.table, diagonal)
    own = np.arange(diagonal.size, dtype=np.int32)
    return SparseInverseOnCells(
        PackedRows(rows.upper, rows.lower, own, packed),
        IrregularRows(irregular.cells, irregular.columns, irregular.cells, table),
    )


@compiled
def _rows_with_diagonal(
    rows: PackedRows,
    irregular: IrregularRows,
    offsets: Any,
    near_field: FloatArray,
    table: FloatArray,
    diagonal: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Rows (n, m + 1) of G, one for each cell, as `bem.contact.sparse_inverse` makes those of a pattern; and packed."""
    n, m = diagonal.size, offsets.shape[0]
    middle = near_field.shape[0] // 2
    out, packed = np.zeros((n, m + 1)), np.zeros((n, rows.table.shape[1]))
    factor = np.empty((m + 1, m + 1))
    active = np.empty(m + 1, np.int64)
    row = np.empty(m + 1)
    columns = np.empty(m, np.int64)
    listed = 0
    for k in range(n):
        bits = rows.pattern[k] & (table.shape[0] - 1)
        apart = listed < irregular.cells.size and irregular.cells[listed] == k
        if apart:
            columns[:] = irregular.columns[listed]
            listed += 1
        else:
            neighbours(rows, k, columns)
        added = diagonal[k]
        count = 0
        for a in range(m):
            if bits >> a & 1:
                active[count] = a
                count += 1
                added = max(added, diagonal[columns[a]])
        active[count] = m
        count += 1
        if added > 0:
            for a in range(count):
                one = active[a]
                for b in range(a + 1):
                    two = active[b]
                    di = (offsets[one, 0] if one < m else 0) - (offsets[two, 0] if two < m else 0)
                    dj = (offsets[one, 1] if one < m else 0) - (offsets[two, 1] if two < m else 0)
                    s = near_field[middle + di, middle + dj]
                    for c in range(b):
                        s -= factor[a, c] * factor[b, c]
                    if a == b:
                        s += diagonal[columns[one]] if one < m else diagonal[k]
                        factor[a, a] = np.sqrt(max(s, 1e-12 * near_field[middle, middle]))
                    else:
                        factor[a, b] = s / factor[b, b]
            row_of_inverse(factor, active[:count], row, out[k])
        else:
            out[k] = table[bits]
        pack(out[k], bits, packed[k])
        if apart:
            packed[k, : packed.shape[1] - 1] = 0.0
    return out, packed
