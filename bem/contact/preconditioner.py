"""Factorised sparse approximate inverse of the kernel on the cells in contact: G^T G, no transform needed.

It sees the near neighbours only; `long_waves` adds the rest, between G and its transpose.

Row k of the sparse triangular G solves the small system of the kernel on cell k and its earlier neighbours that are in
contact too, scaled to give (G K G^T)_kk = 1 (Kolotilina & Yeremin, SIAM J. Matrix Anal. Appl. 14, 1993). Which
neighbours are in contact is a bit pattern, and every pattern is solved once per kernel.
"""

from __future__ import annotations

import math
import threading
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from bem.contact import passes

FloatArray = NDArray[np.float64]

_fast: Any = njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "reassoc", "nsz", "arcp"})


def stencil(squared_radius: int) -> NDArray[np.int64]:
    """Offsets (i, j) before the cell itself in memory order and within the radius; shape (m, 2)."""
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
    """Rows of G by pattern of neighbours; `solved` says which have been filled in so far."""

    offsets: NDArray[np.int64]
    near_field: FloatArray
    table: FloatArray
    solved: NDArray[np.uint8]

    def solve(self, wanted: NDArray[np.int32]) -> None:
        """Fill in the rows of these patterns; one thread at a time, for contacts side by side share them."""
        with _SOLVING:
            _solve_patterns(wanted, self.offsets, self.near_field, self.table, self.solved)


_SOLVING = threading.Lock()


@dataclass(frozen=True)
class SparseInverse:
    """Rows of G by pattern, and room for the numbers of the cells in contact."""

    shape: tuple[int, int]
    periodic: tuple[bool, bool]
    patterns: Patterns
    position: NDArray[np.int32]

    @property
    def near(self) -> float:
        """Response to a uniform unit pressure on a cell with all its neighbours, as G has it."""
        return float(1 / self.patterns.table[-1].sum() ** 2)

    def on(self, cells: NDArray[Any], previous: NDArray[Any] | None) -> SparseInverseOnCells:
        """The inverse on some cells (ascending flat indices); `previous` are those of the call before."""
        if previous is not None:
            _mark(self.position, previous, False)
        _mark(self.position, cells, True)
        columns = np.empty((cells.size, self.patterns.offsets.shape[0]), np.int32)
        pattern = np.empty(cells.size, np.int32)
        distant = passes.in_blocks(
            cells.size,
            2,
            _connect,
            cells,
            self.position,
            (*self.shape, *self.periodic),
            self.patterns.offsets,
            columns,
            pattern,
        )
        self.patterns.solve(pattern)
        starts = np.zeros(len(distant) + 1, np.int64)
        if len(distant) > 1:  # a single block leads nowhere out of itself
            np.cumsum(distant[:, 0].astype(np.int64), out=starts[1:])
        outside = int(starts[-1])
        entries = Outside(distant[:, 1].astype(np.int64), starts, np.empty(outside, np.int32), np.empty(outside))
        return SparseInverseOnCells(Rows(columns, pattern, self.patterns.table), entries)


class Rows(NamedTuple):
    """G's rows: for each cell the numbers of its neighbours, (n, m), and the pattern that says where its values are."""

    columns: NDArray[np.int32]
    pattern: NDArray[np.int32]
    table: FloatArray


class Outside(NamedTuple):
    """Entries of G that lead out of their block of cells, numbered by `starts`: whereto, and what is added there.

    `inner` : for each block the first cell from which on no entry leads out.
    """

    inner: NDArray[np.int64]
    starts: NDArray[np.int64]
    targets: NDArray[np.int32]
    amounts: FloatArray


@dataclass(frozen=True)
class SparseInverseOnCells:
    """G on a given set of cells."""

    rows: Rows
    outside: Outside

    def row_sums(self) -> FloatArray:
        """G applied to a constant."""
        out = np.empty(self.rows.pattern.size)
        _row_sums(self.rows, out)
        return out

    def spread(self, residual: FloatArray, out: FloatArray) -> None:
        """out = G residual."""
        passes.in_blocks(residual.size, 0, _spread, self.rows, residual, out)

    def collect(self, values: FloatArray, out: FloatArray) -> float:
        """out = G^T values; returns its sum.

        Each block adds to its own cells at once; what belongs to the cells of other blocks is kept and added at the
        end, in order.
        """
        partial = passes.in_blocks(values.size, 1, _collect, self.rows, values, out, self.outside, passes.BLOCK)
        if partial.shape[0] == 1:
            return float(partial[0, 0])
        return float(partial[:, 0].sum() + _add(out, self.outside.targets, self.outside.amounts))


def sparse_inverse(
    shape: tuple[int, int], periodic: tuple[bool, bool], near_field: FloatArray, squared_radius: int = 2
) -> SparseInverse:
    """Prepare for an operator whose kernel near the origin is `near_field` (offset zero in the middle)."""
    # neighbours that would wrap on to one another on a very short axis are left out
    reach = 2 * math.isqrt(squared_radius)
    patterns = _patterns(
        squared_radius, shape[0] <= reach, shape[1] <= reach, near_field.shape[0], near_field.tobytes()
    )
    return SparseInverse(shape, periodic, patterns, np.full(shape[0] * shape[1], -1, np.int32))


@lru_cache(maxsize=64)
def _patterns(squared_radius: int, short_x: bool, short_y: bool, width: int, near_field: bytes) -> Patterns:
    """The rows of a kernel that are known so far; kept, so that the next contact under it begins with them."""
    offsets = stencil(squared_radius)
    keep = [not ((short_x and i != 0) or (short_y and j != 0)) for i, j in offsets]
    offsets = np.ascontiguousarray(offsets[np.array(keep, dtype=bool)])
    count = 1 << offsets.shape[0]
    kernel = np.frombuffer(near_field).reshape(width, width).copy()
    found = Patterns(offsets, kernel, np.zeros((count, offsets.shape[0] + 1)), np.zeros(count, np.uint8))
    found.solve(np.array([count - 1], np.int32))
    return found


@njit(cache=True, nogil=True)
def _mark(position, cells, numbered):  # type: ignore[no-untyped-def]
    for k in range(cells.size):
        position[cells[k]] = k if numbered else -1


@njit(cache=True, nogil=True)
def _connect(start, stop, result, cells, position, grid, offsets, columns, pattern):  # type: ignore[no-untyped-def]
    nx, ny, wrap_x, wrap_y = grid
    m = offsets.shape[0]
    reach = 0
    for a in range(m):
        reach = max(reach, abs(offsets[a, 0]), abs(offsets[a, 1]))
    shifts = offsets[:, 0] * ny + offsets[:, 1]
    distant = 0
    inner = start
    i = cells[start] // ny
    for k in range(start, stop):
        cell = cells[k]
        while cell >= (i + 1) * ny:
            i += 1
        j = cell - i * ny
        bits = 0
        before = distant
        # a missing neighbour is the cell itself, with a zero in the table: no branch where it is used
        if i >= reach and j >= reach and j < ny - reach:
            for a in range(m):
                neighbour = position[np.uint64(cell + shifts[a])]
                present = neighbour >= 0
                column = neighbour if present else k
                columns[k, a] = column
                bits |= present << a
                distant += (column < start) | (column >= stop)
        else:
            for a in range(m):
                ii = i + offsets[a, 0]
                jj = j + offsets[a, 1]
                if ii < 0:
                    ii = ii + nx if wrap_x else -1
                if jj < 0:
                    jj = jj + ny if wrap_y else -1
                elif jj >= ny:
                    jj = jj - ny if wrap_y else -1
                neighbour = position[ii * ny + jj] if ii >= 0 and jj >= 0 else -1
                present = neighbour >= 0
                column = neighbour if present else k
                columns[k, a] = column
                bits |= present << a
                distant += (column < start) | (column >= stop)
        pattern[k] = bits
        if distant > before:
            inner = k + 1
    result[0] = distant
    result[1] = inner


@njit(cache=True, nogil=True, error_model="numpy")
def row_of_inverse(factor, active, row, out):  # type: ignore[no-untyped-def]
    """The last row of (L L^T)^-1 over the root of its last entry, L the factor of n rows, into the places `active` (n,)
    of `out`; `row` is scratch."""
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


@njit(cache=True, nogil=True)
def _solve_patterns(pattern, offsets, near_field, table, solved):  # type: ignore[no-untyped-def]
    m = offsets.shape[0]
    middle = near_field.shape[0] // 2
    factor = np.empty((m + 1, m + 1))
    active = np.empty(m + 1, np.int64)
    row = np.empty(m + 1)
    for k in range(pattern.size):
        bits = pattern[k]
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
        if not regular:
            table[bits, m] = 1 / np.sqrt(abs(near_field[middle, middle]))
            continue
        row_of_inverse(factor, active[:n], row, table[bits])


@_fast
def _row_sums(rows, out):  # type: ignore[no-untyped-def]
    columns, pattern, table = rows
    for k in range(pattern.size):
        s = 0.0
        for a in range(columns.shape[1] + 1):
            s += table[np.uint64(pattern[k]), a]
        out[k] = s


@_fast
def _spread(start, stop, result, rows, residual, out):  # type: ignore[no-untyped-def]
    columns, pattern, table = rows
    m = columns.shape[1]
    if m == 10:  # the usual stencil, unrolled
        for k in range(start, stop):
            bits = np.uint64(pattern[k])
            s = table[bits, 10] * residual[k]
            for a in range(10):
                s += table[bits, a] * residual[np.uint64(columns[k, a])]
            out[k] = s
        return
    for k in range(start, stop):
        bits = pattern[k]
        s = table[bits, m] * residual[k]
        for a in range(m):
            s += table[bits, a] * residual[columns[k, a]]
        out[k] = s


@_fast
def _collect(start, stop, result, rows, values, out, outside, block):  # type: ignore[no-untyped-def]
    columns, pattern, table = rows
    inner, starts, targets, amounts = outside
    m = columns.shape[1]
    place = starts[start // block]
    first = inner[start // block]
    for k in range(start, stop):
        out[k] = 0
    for k in range(start, first):
        bits = pattern[k]
        s = values[k]
        for a in range(m):
            c = columns[k, a]
            if c >= start and c < stop:
                out[c] += table[bits, a] * s
            else:
                targets[place] = c
                amounts[place] = table[bits, a] * s
                place += 1
        out[k] += table[bits, m] * s
    if m == 10:  # the usual stencil, unrolled
        for k in range(first, stop):
            bits = np.uint64(pattern[k])
            s = values[k]
            for a in range(10):
                out[np.uint64(columns[k, a])] += table[bits, a] * s
            out[k] += table[bits, 10] * s
    else:
        for k in range(first, stop):
            bits = pattern[k]
            s = values[k]
            for a in range(m):
                out[columns[k, a]] += table[bits, a] * s
            out[k] += table[bits, m] * s
    total = 0.0
    for k in range(start, stop):
        total += out[k]
    result[0] = total


@njit(cache=True, nogil=True)
def _add(out, targets, amounts):  # type: ignore[no-untyped-def]
    total = 0.0
    for k in range(targets.size):
        out[targets[k]] += amounts[k]
        total += amounts[k]
    return total
