"""Factorised sparse approximate inverse of the kernel on the cells in contact: G^T G, no transform needed.

It sees the near neighbours only; `long_waves` adds the rest, between G and its transpose. `patterns` has G's rows by
pattern of neighbours. The cells ascend, so those in contact among a line's neighbours follow one another: a row is kept
as the number of the first of them in each line, and its pattern. Rows whose neighbours lie across a periodic edge, and
those of stencils other than the usual, are kept with the number of every neighbour (`Seam`). Verified against G by its
definition in tests/contact/test_sparse_rows.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact import passes
from bem.contact.patterns import NEIGHBOURS, PACKED, Patterns, patterns
from bem.transforms.loops import first_from

FloatArray = NDArray[np.float64]

HEAD, TAIL = 2, 4
"""Cells at the list's ends that are of the seam, so that no packed row reaches beyond it: a row's first neighbour in a
line before has a number no higher than the cell's own."""

_COUNTS = np.array([bits.bit_count() for bits in range(32)], np.int64)


class Rows(NamedTuple):
    """G's rows, packed: of each cell the number of its first neighbour two lines before and in the line before, (n,),
    and which row of `table`, as `patterns.ENTRIES` says, has its values; those of the seam's cells are zero there."""

    upper: NDArray[np.int32]
    lower: NDArray[np.int32]
    pattern: NDArray[np.int32]
    table: FloatArray


class Seam(NamedTuple):
    """Rows of G with all their columns: cells (s,), numbers of their neighbours (s, m), a missing one being the cell
    itself, and which row of `table` (., m + 1) has the values, zero where a neighbour is missing."""

    cells: NDArray[np.int32]
    columns: NDArray[np.int32]
    pattern: NDArray[np.int32]
    table: FloatArray


class Outside(NamedTuple):
    """What blocks add to cells before their own: those of block b begin at number `heads[b]`, are kept in `amounts`
    from `starts[b]` on, and end where the block begins."""

    heads: NDArray[np.int64]
    starts: NDArray[np.int64]
    amounts: FloatArray


@dataclass(frozen=True)
class SparseInverse:
    """Rows of G by pattern, on a grid."""

    shape: tuple[int, int]
    periodic: tuple[bool, bool]
    patterns: Patterns

    @property
    def near(self) -> float:
        """Response to a uniform unit pressure on a cell with all its neighbours, as G has it."""
        return float(1 / self.patterns.table[-1].sum() ** 2)

    def on(self, cells: NDArray[Any]) -> SparseInverseOnCells:
        """The inverse on some cells (ascending flat indices)."""
        n, known = cells.size, self.patterns
        upper, lower, pattern, listed = np.empty((4, n), np.int32)
        grid, lines = (*self.shape, *self.periodic), np.empty(self.shape[0] + 1, np.int32)
        if known.offsets.shape[0] == NEIGHBOURS:
            rows = (upper, lower, pattern, listed, lines)
            found = passes.in_blocks(n, 2, _connect, cells, grid, known.solved, rows)
            unsolved = bool(found[:, 1].any())
            parts = [listed[b * passes.BLOCK :][: int(count)] for b, count in enumerate(found[:, 0])]
            listed = parts[0] if len(parts) == 1 else np.concatenate([listed[:0], *parts])
        else:
            unsolved = True
            listed[:] = upper[:] = lower[:] = np.arange(n)
            lines[:] = np.searchsorted(cells, np.arange(lines.size) * self.shape[1])
        columns, own = np.empty((listed.size, known.offsets.shape[0]), np.int32), np.empty(listed.size, np.int32)
        if _look_up((cells, lines), grid, known.offsets, known.solved, listed, columns, own, pattern):
            unsolved = True
        known.solve(pattern, unsolved=unsolved)
        return self.of_rows((upper, lower, pattern), (listed, columns, own))

    def of_rows(
        self,
        rows: tuple[NDArray[Any], NDArray[Any], NDArray[Any]],
        seam: tuple[NDArray[Any], NDArray[Any], NDArray[Any]],
    ) -> SparseInverseOnCells:
        """The inverse from first neighbours and patterns, and from the seam's cells, columns and patterns; solved."""
        known = self.patterns
        return SparseInverseOnCells(Rows(*rows, known.packed), Seam(*seam, known.table), _outside(rows[0]))


@dataclass(frozen=True)
class SparseInverseOnCells:
    """G on a given set of cells."""

    rows: Rows
    seam: Seam
    outside: Outside

    def row_sums(self) -> FloatArray:
        """G applied to a constant."""
        out = np.empty(self.rows.pattern.size)
        _row_sums(self.rows, out)
        return out

    def spread(self, residual: FloatArray, out: FloatArray) -> None:
        """out = G residual."""
        passes.in_blocks(residual.size, 0, _spread, self.rows, residual, out)
        _spread_seam(self.seam, residual, out)

    def collect(self, values: FloatArray, out: FloatArray) -> float:
        """out = G^T values; returns its sum.

        Each block adds to its own cells at once; what belongs to the cells before them is kept and added at the end, in
        order, and what the seam adds after that.
        """
        partial = passes.in_blocks(values.size, 1, _collect, self.rows, values, out, self.outside, passes.BLOCK)
        total = float(partial[:, 0].sum())
        if partial.shape[0] > 1:
            total += _add(out, self.outside)
        return total + float(_collect_seam(self.seam, values, out))


def sparse_inverse(
    shape: tuple[int, int], periodic: tuple[bool, bool], near_field: FloatArray, squared_radius: int = PACKED
) -> SparseInverse:
    """Prepare for an operator whose kernel near the origin is `near_field` (offset zero in the middle)."""
    # neighbours that would wrap on to one another on a very short axis are left out
    reach = 2 * math.isqrt(squared_radius)
    short = shape[0] <= reach, shape[1] <= reach
    return SparseInverse(shape, periodic, patterns(squared_radius, *short, near_field.shape[0], near_field.tobytes()))


def _outside(upper: NDArray[np.int32]) -> Outside:
    """Room for what the blocks of cells with these first neighbours add to cells before their own."""
    if upper.size <= passes.BLOCK:
        return _NOTHING_OUTSIDE
    begins = np.arange(0, upper.size, passes.BLOCK)
    heads = upper[begins].astype(np.int64)
    starts = np.zeros(begins.size + 1, np.int64)
    np.cumsum(begins - heads, out=starts[1:])
    return Outside(heads, starts, np.empty(int(starts[-1])))


_NOTHING_OUTSIDE = Outside(np.zeros(1, np.int64), np.zeros(2, np.int64), np.empty(0))


@compiled
def _connect(start, stop, result, cells, grid, solved, rows):
    """Patterns and first neighbours of a block of cells, by windows that go along the lines before with them; the cells
    of the seam are listed, and where lines begin. Result: how many the former are, whether a pattern is unsolved."""
    _, ny, wrap_x, wrap_y = grid
    upper, lower, pattern, listed, lines = rows
    n = cells.size
    cell = cells[start]
    ahead = np.uint64(first_from(cells, cell - ny - 2, 0, start))  # the cells after both windows
    further = np.uint64(first_from(cells, cell - 2 * ny - 1, 0, start))
    line = cell // ny * ny
    for i in range(0 if start == 0 else cells[start - 1] // ny + 1, line // ny + 1):
        lines[i] = start
    last = cell - ny
    near, far, own = 0, 0, 0  # bits from the left: five columns a line before, three two lines before, two in this one
    edge = 2 * ny if wrap_x else 0
    left, right = (2, ny - 2) if wrap_y else (0, ny)
    seam, unsolved = 0, False
    if start > 0 and cell - cells[start - 1] <= 2:
        own |= 4 >> (cell - cells[start - 1])
        if start > 1 and cell - cells[start - 2] == 2:
            own |= 1
    for k in range(start, stop):
        cell = cells[np.uint64(k)]
        if cell >= line + ny:
            for i in range(line // ny + 1, cell // ny + 1):
                lines[i] = k
            line = cell // ny * ny
            near, far, own = 0, 0, 0
        step = min(cell - last, 8)
        near >>= step
        far >>= step
        if k > start:
            own >>= step
        ahead, near = _enter(cells, ahead, near, cell - ny - 2, min(cell - ny + 2, line - 1))
        further, far = _enter(cells, further, far, cell - 2 * ny - 1, min(cell - 2 * ny + 1, line - ny - 1))
        j = cell - line
        if j < 2:  # what the windows have of the ends of the lines before
            near &= 28 if j == 0 else 30
            far &= 6 if j == 0 else 7
            own &= 0 if j == 0 else 2
        lower[k] = ahead - np.uint64(_COUNTS[np.uint64(near)])
        upper[k] = further - np.uint64(_COUNTS[np.uint64(far)])
        bits = far | near << 3 | (own & 3) << 8
        pattern[k] = bits
        if cell < edge or j < left or j >= right or k < HEAD or k >= n - TAIL:
            listed[start + seam] = k
            seam += 1
        elif not solved[np.uint64(bits)]:
            unsolved = True
        own |= 4
        last = cell
    if stop == n:
        lines[line // ny + 1 :] = n
    result[0] = seam
    result[1] = unsolved


@compiled
def _enter(cells, ahead, window, begin, end):
    """Cells from number `ahead` on and up to `end` go into a window whose first column is `begin`."""
    while cells[ahead] <= end:
        place = cells[ahead] - begin
        if place >= 0:
            window |= 1 << place
        ahead += np.uint64(1)
    return ahead, window


@compiled
def _look_up(where, grid, offsets, solved, listed, columns, own, pattern):
    """The seam's rows, and where their sums are in the packed table; returns whether a pattern is unsolved.

    Neighbours one after the other in a line are one search, and a step for each."""
    cells, lines = where
    nx, ny, wrap_x, wrap_y = grid
    m = offsets.shape[0]
    unsolved = False
    for q in range(listed.size):
        k = listed[q]
        i = cells[k] // ny
        j = cells[k] - i * ny
        bits = 0
        line, column, place, end = -1, -1, 0, 0  # the last place that was sought, and what is there or next in its line
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
    """The numbers of a packed row's neighbours by offset, where they are there, into `out` (10,)."""
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
def _row_sums(rows, out):
    for k in range(out.size):
        out[k] = rows.table[np.uint64(rows.pattern[k]), 11]


# in the order written, here and below: rows of the seam and others of the same entries have the same bits
@compiled
def _spread(start, stop, result, rows, residual, out):
    upper, lower, pattern, table = rows
    first, last = max(start, HEAD), min(stop, residual.size - TAIL)
    one, two, three, four = np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(4)
    for k in range(first, last):
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


@compiled
def _spread_seam(seam, residual, out):
    cells, columns, pattern, table = seam
    m = columns.shape[1]
    for q in range(cells.size):
        k, bits = cells[q], pattern[q]
        s = table[bits, m] * residual[k]
        for a in range(m):
            s += table[bits, a] * residual[columns[q, a]]
        out[k] = s


@compiled
def _collect(start, stop, result, rows, values, out, outside, block):
    upper, lower, pattern, table = rows
    out[start:stop] = 0.0
    halo = outside.amounts[outside.starts[start // block] : outside.starts[start // block + 1]]
    halo[:] = 0.0
    # within: rows that lead to no cell before the block and, zeros included, to no place beyond it
    end = min(stop, values.size - TAIL)
    first, last = max(start, HEAD), min(stop - TAIL, end)
    while start > 0 and first < last and (upper[first] < start or first < start + 2):
        first += 1
    _collect_with_care(start if start > 0 else first, first, start, rows, values, out, halo)
    if first < last:
        one, two, three, four = np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(4)
        before, latest = 0.0, 0.0  # what the last two cells have of the rows so far
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
    _collect_with_care(max(first, last), end, start, rows, values, out, halo)
    total = 0.0
    for k in range(start, stop):
        total += out[k]
    result[0] = total


@compiled
def _collect_with_care(first, last, start, rows, values, out, halo):
    """Rows of a block from `start` on, place by place; what is for cells before goes to the halo, which ends there."""
    upper, lower, pattern, table = rows
    shift = halo.size - start
    for k in range(first, last):
        row, s = pattern[k], values[k]
        for a in range(11):
            column = upper[k] + a if a < 3 else lower[k] + a - 3 if a < 8 else k + a - 10
            if table[row, a] == 0:  # no neighbour: the place is another row's
                continue
            if column < start:
                halo[column + shift] += table[row, a] * s
            else:
                out[column] += table[row, a] * s


@compiled
def _collect_seam(seam, values, out):
    cells, columns, pattern, table = seam
    m = columns.shape[1]
    total = 0.0
    for q in range(cells.size):
        k, bits = cells[q], pattern[q]
        s = values[k]
        for a in range(m):
            out[columns[q, a]] += table[bits, a] * s
            total += table[bits, a] * s
        out[k] += table[bits, m] * s
        total += table[bits, m] * s
    return total


@compiled
def _add(out, outside):
    total = 0.0
    for b in range(outside.heads.size):
        for t in range(outside.starts[b + 1] - outside.starts[b]):
            amount = outside.amounts[outside.starts[b] + t]
            out[outside.heads[b] + t] += amount
            total += amount
    return total
