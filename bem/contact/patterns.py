"""Rows of the sparse triangular G by pattern of neighbours in contact; every pattern is solved once per kernel.

Row k of G solves the small system of the kernel on cell k and its earlier neighbours that are in contact too, scaled to
give (G K G^T)_kk = 1 (Kolotilina & Yeremin, SIAM J. Matrix Anal. Appl. 14, 1993). Which neighbours are in contact is a
bit pattern. Knows a kernel near its origin and no cells; `preconditioner` has rows of cells. Verified in
tests/contact/test_sparse_rows.py.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.threads import ForkSafeLock

FloatArray = NDArray[np.float64]

PACKED = 5
"""Squared radius of the stencil that rows are packed for: three neighbours two lines before a cell, five in the line
before, two in its own."""

NEIGHBOURS = 10
"""Of that stencil; no other has as many, whatever a short axis leaves of it."""

ENTRIES = 12
"""Of a packed row: neighbours two lines before from entry 0 on, a line before from 3 on, in the own line up to 9, the
cell itself, and the sum of all. The neighbours there are in a line follow one another in the list of cells: what is
missing leaves zeros at the other end."""


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
    """Rows of G by pattern of neighbours, 2^m of them; `solved` says which have been filled in so far.

    table : (2^m, m + 1), by offset, the cell itself last. packed : (2 * 2^m, ENTRIES), the same packed; in the latter
    half the sums alone.
    """

    offsets: NDArray[np.int64]
    near_field: FloatArray
    table: FloatArray
    packed: FloatArray
    solved: NDArray[np.uint8]

    def solve(self, wanted: NDArray[np.int32], *, unsolved: bool) -> None:
        """Fill in the rows of these patterns, if any is unsolved; one thread at a time, for contacts side by side share
        them, and waits for one that is at it."""
        with _SOLVING:
            if unsolved:
                _solve_patterns(wanted, self.offsets, self.near_field, self.table, self.packed, self.solved)


_SOLVING = ForkSafeLock(whole=True)


@lru_cache(maxsize=64)
def patterns(squared_radius: int, short_x: bool, short_y: bool, width: int, near_field: bytes) -> Patterns:
    """The rows of a kernel that are known so far; kept, so that the next contact under it begins with them."""
    offsets = stencil(squared_radius)
    keep = [not ((short_x and i != 0) or (short_y and j != 0)) for i, j in offsets]
    offsets = np.ascontiguousarray(offsets[np.array(keep, dtype=bool)])
    m, count = offsets.shape[0], 1 << offsets.shape[0]
    kernel = np.frombuffer(near_field).reshape(width, width).copy()
    tables = np.zeros((count, m + 1)), np.zeros((2 * count, ENTRIES))
    found = Patterns(offsets, kernel, *tables, np.zeros(count, np.uint8))
    found.solve(np.array([count - 1], np.int32), unsolved=True)
    return found


@compiled
def row_of_inverse(factor, active, row, out):
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


@compiled
def pack(row, bits, out):
    """A row (m + 1,) of the stencil that rows are packed for, as `ENTRIES` says; of any other stencil the sum alone."""
    m = row.size - 1
    total = 0.0
    for a in range(m + 1):
        total += row[a]
    out[:] = 0.0
    out[11] = total
    if m != NEIGHBOURS:
        return
    before, last, place = 0, 3, 9
    for a in range(3):
        if bits >> a & 1:
            out[before] = row[a]
            before += 1
    for a in range(3, 8):
        if bits >> a & 1:
            out[last] = row[a]
            last += 1
    for a in range(9, 7, -1):
        if bits >> a & 1:
            out[place] = row[a]
            place -= 1
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
