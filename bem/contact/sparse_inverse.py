"""Factorised sparse approximate inverse (FSAI) of the kernel on the active cells: K^-1 ~ G^T G, without a transform.

Preconditioner of step 9 of `bem.contact`, and the correction of removed tension in step 10. Row k of the triangular
factor G solves the small system of the kernel on cell k and on those of its ten preceding neighbours that are active,
scaled to (G K G^T)_kk = 1 (Kolotilina & Yeremin, SIAM J. Matrix Anal. Appl. 14, 1993). At the seam of a periodic axis
neighbours wrap around, so that rows there are not triangular; G^T G is positive definite all the same. The row depends
on the bit pattern of active neighbours only, so every pattern is solved once per kernel (`Patterns`). With a diagonal
added to the kernel (curvature of friction discs in `bem.tangential`), each cell has a row of its own.

G sees near neighbours only; `coarse_correction` adds long wavelengths between G and its transpose. Verified against the
definition of G in tests/contact/test_sparse_rows.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.threads import ForkSafeLock

FloatArray = NDArray[np.float64]

REACH = 2
"""Largest distance of a neighbour along an axis [cells]; the near field reaches twice as far."""

OFFSETS = np.array([(-2, -1), (-2, 0), (-2, 1), *((-1, j) for j in range(-2, 3)), (0, -2), (0, -1)], np.int64)
"""Stencil: the offsets that precede a cell in memory order within the square root of five cells."""

NEIGHBOURS = 10
"""Number of offsets; grids with a very short axis use fewer."""

_OWN, _SUM, _ENTRIES = np.uint64(NEIGHBOURS), np.uint64(NEIGHBOURS + 1), np.uint64(NEIGHBOURS + 2)


class SparseRows(NamedTuple):
    """Rows of G on n active cells.

    columns : (n, NEIGHBOURS), numbers of the neighbours; the cell itself where a neighbour is missing.
    pattern : (n,), row of `table` with the values.
    table : (patterns, NEIGHBOURS + 2), values of the neighbours, zero where one is missing; value of the cell itself;
        sum of the row.
    """

    columns: NDArray[np.int32]
    pattern: NDArray[np.int32]
    table: FloatArray


@dataclass(frozen=True)
class Patterns:
    """Rows of G for all 2^m patterns of active neighbours, solved on demand.

    offsets : (m, 2), the usable part of the stencil.
    near_field : (w, w), the kernel near its origin.
    table : (2^m, NEIGHBOURS + 2), as in `SparseRows`.
    solved : (2^m,), 1 for the patterns that are filled in.
    """

    offsets: NDArray[np.int64]
    near_field: FloatArray
    table: FloatArray
    solved: NDArray[np.uint8]

    def solve(self, wanted: NDArray[np.int32], *, unsolved: bool) -> None:
        """Fill in the rows of the patterns `wanted`; contacts in several threads share the table, so one at a time."""
        with _SOLVING:
            if unsolved:
                _solve_patterns(wanted, self.offsets, self.near_field, self.table, self.solved)


_SOLVING = ForkSafeLock(whole=True)


@lru_cache(maxsize=64)
def patterns(short_x: bool, short_y: bool, width: int, near_field: bytes) -> Patterns:
    """Return the table of a kernel, cached so that later contacts with the same kernel find its rows solved."""
    usable = [not ((short_x and i != 0) or (short_y and j != 0)) for i, j in OFFSETS]
    offsets = np.ascontiguousarray(OFFSETS[np.array(usable, dtype=bool)])
    count = 1 << offsets.shape[0]
    kernel = np.frombuffer(near_field).reshape(width, width).copy()
    known = Patterns(offsets, kernel, np.zeros((count, NEIGHBOURS + 2)), np.zeros(count, np.uint8))
    known.solve(np.array([count - 1], np.int32), unsolved=True)
    return known


@dataclass(frozen=True)
class SparseInverse:
    """The approximate inverse of the kernel of a grid."""

    shape: tuple[int, int]
    periodic: tuple[bool, bool]
    patterns: Patterns

    @property
    def near_response(self) -> float:
        """Response of (G^T G)^-1 to a uniform unit pressure, on a cell with all its neighbours."""
        return float(1 / self.patterns.table[-1, -1] ** 2)

    def on(self, cells: NDArray[Any], diagonal: FloatArray | None = None) -> SparseInverseOnCells:
        """Return the inverse on the active cells (ascending cell indices), with a diagonal (n,) added to the kernel."""
        known = self.patterns
        columns, pattern, unsolved = connect(cells, (*self.shape, *self.periodic), known.offsets, known.solved)
        known.solve(pattern, unsolved=unsolved)
        if diagonal is None:
            return SparseInverseOnCells(SparseRows(columns, pattern, known.table))
        table = _solve_rows(columns, pattern, known.offsets, known.near_field, known.table, diagonal)
        return SparseInverseOnCells(SparseRows(columns, np.arange(cells.size, dtype=np.int32), table))


@dataclass(frozen=True)
class SparseInverseOnCells:
    """The factor G on the active cells."""

    rows: SparseRows

    def row_sums(self) -> FloatArray:
        """Return G applied to a constant."""
        out = np.empty(self.rows.pattern.size)
        write_row_sums(self.rows, out)
        return out

    def spread(self, residual: FloatArray, out: FloatArray) -> None:
        """Write G residual to `out`."""
        apply_factor(self.rows, residual, out)

    def collect(self, values: FloatArray, out: FloatArray) -> float:
        """Write G^T values to `out`; return its sum."""
        return float(apply_transpose(self.rows, values, out))


def sparse_inverse(shape: tuple[int, int], periodic: tuple[bool, bool], near_field: FloatArray) -> SparseInverse:
    """Prepare the inverse of an operator whose kernel near the origin is `near_field` (offset zero in the middle)."""
    # on a very short axis, neighbours that would wrap on to one another are left out
    short = shape[0] <= 2 * REACH, shape[1] <= 2 * REACH
    return SparseInverse(shape, periodic, patterns(*short, near_field.shape[0], near_field.tobytes()))


@compiled
def connect(cells, grid, offsets, solved):
    """Connect the active cells (ascending) to their active neighbours.

    grid : (nx, ny, periodic along x, periodic along y). offsets, solved : as in `Patterns`.

    Returns columns and patterns as in `SparseRows`, and whether a pattern is unsolved. The numbers of the active cells
    in a grid line and in the two lines before it are written to dense buffers, in which neighbours are looked up.
    """
    nx, ny, wrap_x, wrap_y = grid
    n, m, width = cells.size, offsets.shape[0], ny + 2 * REACH
    columns, pattern = np.empty((n, NEIGHBOURS), np.int32), np.empty(n, np.int32)
    starts, place = np.zeros(nx + 1, np.int64), 0  # first cell of each line
    for row in range(nx):
        while place < n and cells[place] < (row + 1) * ny:
            place += 1
        starts[row + 1] = place
    lines = np.full(3 * width, -1, np.int32)  # three lines, each with columns beyond both ends
    positions = np.empty(m, np.int64)
    unsolved = False
    for step in range(-REACH if wrap_x else 0, nx):
        row = (step + nx) % nx
        first = step % 3 * width
        line = lines[first : first + width]
        line[:] = -1
        shift = REACH - row * ny
        for k in range(starts[row], starts[row + 1]):
            line[cells[k] + shift] = k
        if wrap_y:
            line[0], line[1] = line[ny], line[ny + 1]
            line[ny + 2], line[ny + 3] = line[2], line[3]
        if step < 0:
            continue
        for a in range(m):
            positions[a] = (step + offsets[a, 0] + 3) % 3 * width + offsets[a, 1] + shift
        for k in range(starts[row], starts[row + 1]):
            cell, bits = cells[np.uint64(k)], 0
            for a in range(m):
                number = lines[np.uint64(positions[a] + cell)]
                columns[np.uint64(k), a] = number if number >= 0 else k
                bits |= (number >= 0) << a
            for a in range(m, NEIGHBOURS):
                columns[k, a] = k
            pattern[k] = bits
            unsolved |= solved[bits] == 0
    return columns, pattern, unsolved


@compiled
def write_row_sums(rows, out):
    """Write G applied to a constant."""
    for k in range(out.size):
        out[k] = rows.table[np.uint64(rows.pattern[k]), _SUM]


@compiled
def apply_factor(rows, residual, out):
    """Write G residual to `out`."""
    columns, pattern, table = rows.columns.reshape(-1), rows.pattern, rows.table.reshape(-1)
    for k in range(residual.size):
        row, first = np.uint64(pattern[k]) * _ENTRIES, np.uint64(k) * _OWN
        s = table[row + _OWN] * residual[k]
        for a in range(NEIGHBOURS):
            s += table[row + np.uint64(a)] * residual[np.uint64(columns[first + np.uint64(a)])]
        out[k] = s


@compiled
def apply_transpose(rows, values, out):
    """Write G^T values to `out`; return its sum."""
    columns, pattern, table = rows.columns.reshape(-1), rows.pattern, rows.table.reshape(-1)
    out[:] = 0.0
    total = 0.0
    for k in range(values.size):
        row, first = np.uint64(pattern[k]) * _ENTRIES, np.uint64(k) * _OWN
        s = values[k]
        for a in range(NEIGHBOURS):
            out[np.uint64(columns[first + np.uint64(a)])] += table[row + np.uint64(a)] * s
        out[k] += table[row + _OWN] * s
        total += table[row + _SUM] * s
    return total


@compiled
def _solve_patterns(pattern, offsets, near_field, table, solved):
    """Write the rows of the patterns that are unsolved."""
    work, diagonal = _workspace(), np.zeros(NEIGHBOURS + 1)
    for k in range(pattern.size):
        bits = pattern[k]
        if solved[bits] == 0:
            solved[bits] = 1
            _solve_row(bits, offsets, near_field, diagonal, work, table[bits])


@compiled
def _solve_rows(columns, pattern, offsets, near_field, table, diagonal):
    """Return the rows (n, NEIGHBOURS + 2) of the kernel with a diagonal (n,); those of `table` where that is zero."""
    n = pattern.size
    out = np.zeros((n, NEIGHBOURS + 2))
    work, added = _workspace(), np.empty(NEIGHBOURS + 1)
    for k in range(n):
        largest = added[NEIGHBOURS] = diagonal[k]
        for a in range(NEIGHBOURS):
            added[a] = diagonal[columns[k, a]]
            largest = max(largest, added[a])
        if largest > 0:
            _solve_row(pattern[k], offsets, near_field, added, work, out[k])
        else:
            out[k] = table[pattern[k]]
    return out


@compiled
def _workspace():
    """Return room for a Cholesky factor, the entries of its cells, and a row of its inverse."""
    return np.empty((NEIGHBOURS + 1, NEIGHBOURS + 1)), np.empty(NEIGHBOURS + 1, np.int64), np.empty(NEIGHBOURS + 1)


@compiled
def _solve_row(bits, offsets, near_field, diagonal, work, out):
    """Write the row of G of a pattern to `out`, zero on entry, with its sum.

    The row is the last one of (L L^T)^-1 over the root of its last entry, where L L^T is the kernel on the cell and its
    active neighbours. diagonal : (NEIGHBOURS + 1,), added to the kernel by neighbour, of the cell itself last.
    """
    factor, entries, row = work
    middle = near_field.shape[0] // 2
    n = 0
    for a in range(offsets.shape[0]):
        if bits >> a & 1:
            entries[n] = a
            n += 1
    entries[n] = NEIGHBOURS
    n += 1
    for a in range(n):
        one = entries[a]
        for b in range(a + 1):
            two = entries[b]
            di = (offsets[one, 0] if one < NEIGHBOURS else 0) - (offsets[two, 0] if two < NEIGHBOURS else 0)
            dj = (offsets[one, 1] if one < NEIGHBOURS else 0) - (offsets[two, 1] if two < NEIGHBOURS else 0)
            s = near_field[middle + di, middle + dj]
            if a == b:
                s += diagonal[one]
            for c in range(b):
                s -= factor[a, c] * factor[b, c]
            if a > b:
                factor[a, b] = s / factor[b, b]
            elif s > 1e-12 * near_field[middle, middle]:
                factor[a, a] = np.sqrt(s)
            else:  # not positive definite: scale by the diagonal
                out[_OWN] = out[_SUM] = 1 / np.sqrt(abs(near_field[middle, middle]) + diagonal[NEIGHBOURS])
                return
    row[n - 1] = 1 / factor[n - 1, n - 1] ** 2
    for a in range(n - 2, -1, -1):
        s = 0.0
        for c in range(a + 1, n):
            s -= factor[c, a] * row[c]
        row[a] = s / factor[a, a]
    scale = 1 / np.sqrt(row[n - 1])
    for a in range(n):
        out[entries[a]] = row[a] * scale
        out[_SUM] += row[a] * scale
