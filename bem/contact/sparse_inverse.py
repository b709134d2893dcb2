"""Factorised sparse approximate inverse (FSAI) of the kernel on the active cells: K^-1 ~ G^T G, without a transform.

Row k of the triangular factor G solves the small system of the kernel on cell k and on those of its ten preceding
neighbours that are active, scaled to (G K G^T)_kk = 1 (Kolotilina & Yeremin, SIAM J. Matrix Anal. Appl. 14, 1993). The
row depends on the bit pattern of active neighbours only, so every pattern is solved once per kernel (`Patterns`).

The active cells are listed in ascending order, so the active neighbours in one grid line are consecutive. A *packed*
row stores the number of the first neighbour in each line, and its pattern. *Irregular* rows store the number of every
neighbour: those that cross a periodic edge, the first and last cells of the list, and all rows of other stencils.

G sees near neighbours only; `coarse_correction` adds long wavelengths between G and its transpose. Verified against the
definition of G in tests/contact/test_sparse_rows.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.threads import ForkSafeLock
from bem.transforms.loops import first_from

FloatArray = NDArray[np.float64]

SQUARED_RADIUS = 5
"""Squared radius of the packed stencil: three neighbours two lines before a cell, five in the line before, two in its
own line."""

NEIGHBOURS = 10
"""Neighbours of the packed stencil; no other stencil has as many."""

ENTRIES = 12
"""Entries of a packed row: neighbours two lines before from entry 0, one line before from entry 3, in the own line up
to entry 9, the cell itself (10), the row sum (11). Active neighbours of a line are consecutive; missing ones leave
zeros."""

HEAD, TAIL = 2, 4
"""Cells at the ends of the list with irregular rows, so that no packed row reads beyond the list."""

_BIT_COUNTS = np.array([bits.bit_count() for bits in range(32)], np.int64)


class PackedRows(NamedTuple):
    """Packed rows of G.

    upper, lower : (n,), number of the first active neighbour two lines and one line before the cell.
    pattern : (n,), row of `table` with the values; irregular cells have a row of zeros.
    table : (patterns, ENTRIES).
    """

    upper: NDArray[np.int32]
    lower: NDArray[np.int32]
    pattern: NDArray[np.int32]
    table: FloatArray


class IrregularRows(NamedTuple):
    """Rows of G with all their columns.

    cells : (s,), numbers of the cells.
    columns : (s, m), numbers of their neighbours; the cell itself where a neighbour is missing.
    pattern : (s,), row of `table` with the values.
    table : (patterns, m + 1), zero where a neighbour is missing.
    """

    cells: NDArray[np.int32]
    columns: NDArray[np.int32]
    pattern: NDArray[np.int32]
    table: FloatArray


def stencil(squared_radius: int) -> NDArray[np.int64]:
    """Return the offsets (m, 2) that precede a cell in memory order within the radius."""
    reach = int(np.sqrt(squared_radius))
    return np.array(
        [
            (i, j)
            for i in range(-reach, 1)
            for j in range(-reach, reach + 1)
            if i * i + j * j <= squared_radius and (i, j) < (0, 0)
        ],
        dtype=np.int64,
    ).reshape(-1, 2)


@dataclass(frozen=True)
class Patterns:
    """Rows of G for all 2^m patterns of active neighbours, solved on demand.

    offsets : (m, 2), the stencil.
    near_field : (w, w), the kernel near its origin.
    table : (2^m, m + 1), values by offset, the cell itself last.
    packed : (2 * 2^m, ENTRIES), the packed rows; the second half, for irregular cells, has the row sums only.
    solved : (2^m,), 1 for the patterns that are filled in.
    """

    offsets: NDArray[np.int64]
    near_field: FloatArray
    table: FloatArray
    packed: FloatArray
    solved: NDArray[np.uint8]

    def solve(self, wanted: NDArray[np.int32], *, unsolved: bool) -> None:
        """Fill in the rows of the patterns `wanted`; contacts in several threads share the table, so one at a time."""
        with _SOLVING:
            if unsolved:
                _solve_patterns(wanted, self.offsets, self.near_field, self.table, self.packed, self.solved)


_SOLVING = ForkSafeLock(whole=True)


@lru_cache(maxsize=64)
def patterns(squared_radius: int, short_x: bool, short_y: bool, width: int, near_field: bytes) -> Patterns:
    """Return the table of a kernel, cached so that later contacts with the same kernel find its rows solved."""
    offsets = stencil(squared_radius)
    usable = [not ((short_x and i != 0) or (short_y and j != 0)) for i, j in offsets]
    offsets = np.ascontiguousarray(offsets[np.array(usable, dtype=bool)])
    m, count = offsets.shape[0], 1 << offsets.shape[0]
    kernel = np.frombuffer(near_field).reshape(width, width).copy()
    tables = np.zeros((count, m + 1)), np.zeros((2 * count, ENTRIES))
    known = Patterns(offsets, kernel, *tables, np.zeros(count, np.uint8))
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
        return float(1 / self.patterns.table[-1].sum() ** 2)

    def on(self, cells: NDArray[Any], diagonal: FloatArray | None = None) -> SparseInverseOnCells:
        """Return the inverse on the active cells (ascending flat indices), with a diagonal (n,) added to the kernel."""
        known = self.patterns
        rows, irregular, unsolved = connect(cells, (*self.shape, *self.periodic), known.offsets, known.solved)
        known.solve(rows[2], unsolved=unsolved)
        inverse = self.of_rows(rows, irregular)
        return inverse if diagonal is None else inverse.with_diagonal(known, diagonal)

    def of_rows(
        self,
        rows: tuple[NDArray[Any], NDArray[Any], NDArray[Any]],
        irregular: tuple[NDArray[Any], NDArray[Any], NDArray[Any]],
    ) -> SparseInverseOnCells:
        """Return the inverse from the arrays that `connect` returns; their patterns must be solved."""
        known = self.patterns
        return SparseInverseOnCells(PackedRows(*rows, known.packed), IrregularRows(*irregular, known.table))


@dataclass(frozen=True)
class SparseInverseOnCells:
    """The factor G on the active cells."""

    rows: PackedRows
    irregular: IrregularRows

    def with_diagonal(self, patterns: Patterns, diagonal: FloatArray) -> SparseInverseOnCells:
        """Return the factor of the kernel with a diagonal (n,) added; every cell has its own row of the tables."""
        rows, irregular = self.rows, self.irregular
        table, packed = _solve_rows_with_diagonal(
            rows, irregular, patterns.offsets, patterns.near_field, patterns.table, diagonal
        )
        own = np.arange(diagonal.size, dtype=np.int32)
        return SparseInverseOnCells(
            PackedRows(rows.upper, rows.lower, own, packed),
            IrregularRows(irregular.cells, irregular.columns, irregular.cells, table),
        )

    def row_sums(self) -> FloatArray:
        """Return G applied to a constant."""
        out = np.empty(self.rows.pattern.size)
        write_row_sums(self.rows, out)
        return out

    def spread(self, residual: FloatArray, out: FloatArray) -> None:
        """Write G residual to `out`."""
        apply_factor(self.rows, self.irregular, residual, out)

    def collect(self, values: FloatArray, out: FloatArray) -> float:
        """Write G^T values to `out`; return its sum."""
        return float(apply_transpose(self.rows, self.irregular, values, out))


def sparse_inverse(
    shape: tuple[int, int], periodic: tuple[bool, bool], near_field: FloatArray, squared_radius: int = SQUARED_RADIUS
) -> SparseInverse:
    """Prepare the inverse of an operator whose kernel near the origin is `near_field` (offset zero in the middle)."""
    # on a very short axis, neighbours that would wrap on to one another are left out
    reach = 2 * math.isqrt(squared_radius)
    short = shape[0] <= reach, shape[1] <= reach
    return SparseInverse(shape, periodic, patterns(squared_radius, *short, near_field.shape[0], near_field.tobytes()))


@compiled
def connect(cells, grid, offsets, solved):
    """Connect the active cells (ascending) to their active neighbours.

    grid : (nx, ny, periodic along x, periodic along y). offsets, solved : as in `Patterns`.

    Returns the arrays of the packed rows (upper, lower, pattern), those of the irregular rows (cells, columns,
    pattern), and whether a pattern is unsolved.
    """
    n = cells.size
    upper, lower, pattern = np.empty(n, np.int32), np.empty(n, np.int32), np.empty(n, np.int32)
    listed, lines = np.empty(n, np.int32), np.empty(grid[0] + 1, np.int32)
    count, unsolved = n, True
    if n > 0 and offsets.shape[0] == NEIGHBOURS:
        count, unsolved = _connect_packed(cells, grid, solved, (upper, lower, pattern, listed, lines))
    else:
        for k in range(n):
            listed[k] = upper[k] = lower[k] = k
        for i in range(lines.size):
            lines[i] = first_from(cells, i * grid[1], 0, n)
    listed = listed[:count].copy()
    columns, own = np.empty((count, offsets.shape[0]), np.int32), np.empty(count, np.int32)
    if _connect_irregular((cells, lines), grid, offsets, solved, listed, columns, own, pattern):
        unsolved = True
    return (upper, lower, pattern), (listed, columns, own), unsolved


@compiled
def _connect_packed(cells, grid, solved, rows):
    """Write patterns and first neighbours by sliding windows over the two lines before each cell.

    Also lists the irregular cells and the first cell of each line; returns the number of irregular cells and whether a
    pattern is unsolved.
    """
    _, ny, wrap_x, wrap_y = grid
    upper, lower, pattern, listed, lines = rows
    n = cells.size
    cell = cells[0]
    ahead = np.uint64(0)  # the first cells beyond both windows
    further = np.uint64(0)
    line = cell // ny * ny
    for i in range(line // ny + 1):
        lines[i] = 0
    last = cell - ny
    near, far, own = (
        0,
        0,
        0,
    )  # bits from the left: five columns one line before, three two lines before, two in this line
    edge = 2 * ny if wrap_x else 0
    left, right = (2, ny - 2) if wrap_y else (0, ny)
    irregular, unsolved = 0, False
    for k in range(n):
        cell = cells[np.uint64(k)]
        if cell >= line + ny:
            for i in range(line // ny + 1, cell // ny + 1):
                lines[i] = k
            line = cell // ny * ny
            near, far, own = 0, 0, 0
        step = min(cell - last, 8)
        near >>= step
        far >>= step
        if k > 0:
            own >>= step
        ahead, near = _slide_window(cells, ahead, near, cell - ny - 2, min(cell - ny + 2, line - 1))
        further, far = _slide_window(cells, further, far, cell - 2 * ny - 1, min(cell - 2 * ny + 1, line - ny - 1))
        j = cell - line
        if j < 2:  # remove the ends of the lines before from the windows
            near &= 28 if j == 0 else 30
            far &= 6 if j == 0 else 7
            own &= 0 if j == 0 else 2
        lower[k] = ahead - np.uint64(_BIT_COUNTS[np.uint64(near)])
        upper[k] = further - np.uint64(_BIT_COUNTS[np.uint64(far)])
        bits = far | near << 3 | (own & 3) << 8
        pattern[k] = bits
        if cell < edge or j < left or j >= right or k < HEAD or k >= n - TAIL:
            listed[irregular] = k
            irregular += 1
        elif not solved[np.uint64(bits)]:
            unsolved = True
        own |= 4
        last = cell
    lines[line // ny + 1 :] = n
    return irregular, unsolved


@compiled
def _slide_window(cells, ahead, window, begin, end):
    """Move the cells up to `end`, from number `ahead` on, into a window whose first column is `begin`."""
    while cells[ahead] <= end:
        place = cells[ahead] - begin
        if place >= 0:
            window |= 1 << place
        ahead += np.uint64(1)
    return ahead, window


@compiled
def _connect_irregular(where, grid, offsets, solved, listed, columns, own, pattern):
    """Write the irregular rows, and their rows of the packed table; return whether a pattern is unsolved.

    Consecutive neighbours in a line take one search and a step each.
    """
    cells, lines = where
    nx, ny, wrap_x, wrap_y = grid
    m = offsets.shape[0]
    unsolved = False
    for q in range(listed.size):
        k = listed[q]
        i = cells[k] // ny
        j = cells[k] - i * ny
        bits = 0
        line, column, place, end = -1, -1, 0, 0  # the last place searched for, and the cell at or after it
        for a in range(m):
            ii = i + offsets[a, 0]
            jj = j + offsets[a, 1]
            if wrap_x and ii < 0:
                ii += nx
            if wrap_y:
                jj += ny if jj < 0 else -ny if jj >= ny else 0
            found = -1
            if ii >= 0 and jj >= 0 and jj < ny:
                cell = ii * ny + jj
                if ii == line and jj == column + 1:
                    place += place < end and cells[place] < cell
                else:
                    line, end = ii, lines[ii + 1]
                    place = first_from(cells, cell, lines[ii], end)
                column = jj
                found = place if place < end and cells[place] == cell else -1
            columns[q, a] = found if found >= 0 else k
            if found >= 0:
                bits |= 1 << a
        own[q] = bits
        pattern[k] = (1 << m) + bits
        unsolved |= solved[bits] == 0
    return unsolved


@compiled
def neighbours(rows, k, out):
    """Write the numbers of the active neighbours of a packed row, by offset, to `out` (10,)."""
    bits = rows.pattern[k]
    upper, lower, own = rows.upper[k], rows.lower[k], k
    for a in range(8):
        if bits >> a & 1:
            if a < 3:
                out[a] = upper
                upper += 1
            else:
                out[a] = lower
                lower += 1
    for a in range(9, 7, -1):
        if bits >> a & 1:
            own -= 1
            out[a] = own


@compiled
def write_row_sums(rows, out):
    """Write G applied to a constant."""
    for k in range(out.size):
        out[k] = rows.table[np.uint64(rows.pattern[k]), 11]


# sums are in the order written, so that packed and irregular rows with the same entries give the same bits
@compiled
def apply_factor(rows, irregular, residual, out):
    """Write G residual to `out`."""
    upper, lower, pattern, table = rows
    one, two, three, four = np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(4)
    for k in range(HEAD, residual.size - TAIL):
        row, up, low, own = np.uint64(pattern[k]), np.uint64(upper[k]), np.uint64(lower[k]), np.uint64(k)
        s = table[row, 10] * residual[own]
        s += table[row, 0] * residual[up]
        s += table[row, 1] * residual[up + one]
        s += table[row, 2] * residual[up + two]
        s += table[row, 3] * residual[low]
        s += table[row, 4] * residual[low + one]
        s += table[row, 5] * residual[low + two]
        s += table[row, 6] * residual[low + three]
        s += table[row, 7] * residual[low + four]
        s += table[row, 8] * residual[own - two]
        s += table[row, 9] * residual[own - one]
        out[k] = s
    cells, columns, pattern, table = irregular
    m = columns.shape[1]
    for q in range(cells.size):
        k, bits = cells[q], pattern[q]
        s = table[bits, m] * residual[k]
        for a in range(m):
            s += table[bits, a] * residual[columns[q, a]]
        out[k] = s


@compiled
def apply_transpose(rows, irregular, values, out):
    """Write G^T values to `out`; return its sum."""
    upper, lower, pattern, table = rows
    out[:] = 0.0
    first, last = HEAD, values.size - TAIL
    if first < last:
        one, two, three, four = np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(4)
        before, latest = 0.0, 0.0  # pending contributions of the last two rows to their own line
        for k in range(first, last):
            row, up, low, own = np.uint64(pattern[k]), np.uint64(upper[k]), np.uint64(lower[k]), np.uint64(k)
            s = values[k]
            out[low] += table[row, 3] * s
            out[low + one] += table[row, 4] * s
            out[low + two] += table[row, 5] * s
            out[low + three] += table[row, 6] * s
            out[low + four] += table[row, 7] * s
            out[up] += table[row, 0] * s
            out[up + one] += table[row, 1] * s
            out[up + two] += table[row, 2] * s
            out[own - two] += before + table[row, 8] * s
            before = latest + table[row, 9] * s
            latest = table[row, 10] * s
        out[last - 2] += before
        out[last - 1] += latest
    total = 0.0
    for k in range(out.size):
        total += out[k]
    extra = 0.0
    cells, columns, pattern, table = irregular
    m = columns.shape[1]
    for q in range(cells.size):
        k, bits = cells[q], pattern[q]
        s = values[k]
        for a in range(m):
            out[columns[q, a]] += table[bits, a] * s
            extra += table[bits, a] * s
        out[k] += table[bits, m] * s
        extra += table[bits, m] * s
    return total + extra


@compiled
def row_of_inverse(factor, active, row, out):
    """Write the last row of (L L^T)^-1, over the root of its last entry, to the entries `active` (n,) of `out`.

    factor : L, with n rows. row : scratch.
    """
    n = active.size
    row[n - 1] = 1 / factor[n - 1, n - 1] ** 2
    for a in range(n - 2, -1, -1):
        s = 0.0
        for c in range(a + 1, n):
            s -= factor[c, a] * row[c]
        row[a] = s / factor[a, a]
    scale = 1 / np.sqrt(row[n - 1])
    for a in range(n):
        out[active[a]] = row[a] * scale


@compiled
def pack(row, bits, out):
    """Pack a row (m + 1,) as `ENTRIES` describes; for any other stencil store the row sum only."""
    m = row.size - 1
    total = 0.0
    for a in range(m + 1):
        total += row[a]
    out[:] = 0.0
    out[11] = total
    if m != NEIGHBOURS:
        return
    upper, lower, own = 0, 3, 9
    for a in range(3):
        if bits >> a & 1:
            out[upper] = row[a]
            upper += 1
    for a in range(3, 8):
        if bits >> a & 1:
            out[lower] = row[a]
            lower += 1
    for a in range(9, 7, -1):
        if bits >> a & 1:
            out[own] = row[a]
            own -= 1
    out[10] = row[10]


@compiled
def _solve_patterns(pattern, offsets, near_field, table, packed, solved):
    m = offsets.shape[0]
    count = 1 << m
    middle = near_field.shape[0] // 2
    factor = np.empty((m + 1, m + 1))
    active = np.empty(m + 1, np.int64)
    row = np.empty(m + 1)
    for k in range(pattern.size):
        bits = pattern[k] & (count - 1)
        if solved[bits]:
            continue
        solved[bits] = 1
        n = 0
        for a in range(m):
            if bits >> a & 1:
                active[n] = a
                n += 1
        active[n] = m
        n += 1
        regular = True
        for a in range(n):
            for b in range(a + 1):
                di = (offsets[active[a], 0] if active[a] < m else 0) - (offsets[active[b], 0] if active[b] < m else 0)
                dj = (offsets[active[a], 1] if active[a] < m else 0) - (offsets[active[b], 1] if active[b] < m else 0)
                s = near_field[middle + di, middle + dj]
                for c in range(b):
                    s -= factor[a, c] * factor[b, c]
                if a == b:
                    if s <= 1e-12 * near_field[middle, middle]:
                        regular = False
                        s = near_field[middle, middle]
                    factor[a, a] = np.sqrt(s)
                else:
                    factor[a, b] = s / factor[b, b]
        if regular:
            row_of_inverse(factor, active[:n], row, table[bits])
        else:
            table[bits, m] = 1 / np.sqrt(abs(near_field[middle, middle]))
        pack(table[bits], bits, packed[bits])
        packed[count + bits, 11] = packed[bits, 11]


@compiled
def _solve_rows_with_diagonal(rows, irregular, offsets, near_field, table, diagonal):
    """Return the rows of G (n, m + 1), one for each cell, and the packed rows (n, ENTRIES).

    A row whose cells have a zero diagonal is that of its pattern in `table`.
    """
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
        is_irregular = listed < irregular.cells.size and irregular.cells[listed] == k
        if is_irregular:
            columns[:] = irregular.columns[listed]
            listed += 1
        else:
            neighbours(rows, k, columns)
        largest = diagonal[k]
        count = 0
        for a in range(m):
            if bits >> a & 1:
                active[count] = a
                count += 1
                largest = max(largest, diagonal[columns[a]])
        active[count] = m
        count += 1
        if largest > 0:
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
        if is_irregular:
            packed[k, : packed.shape[1] - 1] = 0.0
    return out, packed
