"""Pressures without bounds brought to zero where they pull: in the norm of the energy, as far as near neighbours go.

Pressures p that close the gap on the cells F + A are negative on A. On F alone the gap is closed by p - B y, where B is
the inverse of the kernel on F + A and B y = p on A: what pulls is taken off, and the neighbours make up for it. B is
that of `preconditioner`, the sparse G^T G; what that does not see, long waves, the next round does. Clipping alone
leaves a gap of two to three times what the iterations left: a convolution more in the first rounds.

Knows G's rows, and no contact. Verified in tests/contact/test_imposing.py against dense matrices.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact.preconditioner import HEAD, TAIL, SparseInverseOnCells

FloatArray = NDArray[np.float64]

_ITERATIONS = 2
"""Of conjugate gradients for y, whose matrix is near its diagonal: on A cells are mostly single, or in rows of two or
three along an edge. One to six count alike on rough contacts, but for 0.1 less of two at 512 cells."""

_ONE, _TWO, _THREE, _FIVE = np.uint64(1), np.uint64(2), np.uint64(3), np.uint64(5)


def impose(inverse: SparseInverseOnCells, pressure: FloatArray) -> None:
    """Bring negative pressures (n,) on the inverse's cells to zero, in place. Their neighbours may become negative
    then: those that do are brought there with them, once; others are left as they are."""
    _impose(inverse.rows, inverse.seam, pressure, _ITERATIONS)


@compiled
def _impose(rows, seam, pressure, iterations):
    pulls = np.empty(pressure.size, np.uint8)
    count = 0
    for k in range(pulls.size):
        pulls[k] = pressure[k] < 0
        count += pulls[k]
    if count == 0:
        return
    fields = np.zeros(pressure.size), np.zeros(pressure.size), np.zeros(pressure.size)
    taken = fields[2]
    _take_off(rows, seam, pulls, count, pressure, iterations, fields)
    more = 0
    for k in range(pulls.size):
        below = (pressure[k] < taken[k]) & (pulls[k] == 0)
        pulls[k] |= below
        more += below
    if more:
        _take_off(rows, seam, pulls, count + more, pressure, iterations, fields)
    for k in range(pressure.size):
        pressure[k] = 0.0 if pulls[k] else pressure[k] - taken[k]


@compiled
def _take_off(rows, seam, pulls, count, pressure, iterations, fields):
    """Add to the last of the fields what brings B y there nearer to the pressures on the `count` cells that pull.
    fields : amounts, and the response to them, both zero before and after; B y."""
    given, found, taken = fields
    near = _reaching(rows, seam, pulls)
    cells, missed = np.empty(count, np.int64), np.empty(count)
    a, squares = 0, 0.0
    for k in range(pulls.size):
        if pulls[k]:
            cells[a], missed[a] = k, pressure[k] - taken[k]
            squares += missed[a] ** 2
            a += 1
    way = missed.copy()
    for _ in range(iterations):
        if not squares > 0:
            break
        for a in range(count):
            given[cells[a]] = way[a]
        _respond(rows, seam, near, given, found)
        curvature = 0.0
        for a in range(count):
            curvature += way[a] * found[cells[a]]
        step, last, squares = squares / curvature, squares, 0.0
        for a in range(count):
            missed[a] -= step * found[cells[a]]
            squares += missed[a] ** 2
        for k in range(taken.size):
            taken[k] += step * found[k]
            found[k] = 0.0
        for a in range(count):
            way[a] = missed[a] + squares / last * way[a]
    for a in range(count):
        given[cells[a]] = 0.0


@compiled
def _reaching(rows, seam, marked):
    """Rows of G that may reach a cell that is marked: of the packed ones by cell, of the seam's by number."""
    upper, lower = rows.upper, rows.lower
    before = np.empty(marked.size + 1, np.int32)  # how many are marked before each cell
    before[0] = 0
    for k in range(marked.size):
        before[k + 1] = before[k] + marked[k]
    near, count = np.empty(marked.size, np.int32), 0
    for k in range(HEAD, marked.size - TAIL):
        up, low, own = np.uint64(upper[k]), np.uint64(lower[k]), np.uint64(k)
        reached = before[up + _THREE] - before[up] + before[low + _FIVE] - before[low]
        near[count] = k
        reached += before[own + _ONE] - before[own - _TWO]
        count += reached > 0
    edge, more = np.empty(seam.cells.size, np.int32), 0
    for q in range(edge.size):
        reached = marked[seam.cells[q]] != 0
        for a in range(seam.columns.shape[1]):
            reached |= marked[seam.columns[q, a]] != 0
        edge[more] = q
        more += reached
    return near[:count], edge[:more]


@compiled
def _respond(rows, seam, near, given, found):
    """found += G^T G given, by the rows listed."""
    upper, lower, pattern, table = rows
    for r in range(near[0].size):
        k = near[0][r]
        row, up, low, own = np.uint64(pattern[k]), np.uint64(upper[k]), np.uint64(lower[k]), np.uint64(k)
        s = table[row, 10] * given[own]
        for a in range(3):
            s += table[row, a] * given[up + np.uint64(a)]
        for a in range(5):
            s += table[row, 3 + a] * given[low + np.uint64(a)]
        s += table[row, 8] * given[own - _TWO] + table[row, 9] * given[own - _ONE]
        for a in range(3):
            found[up + np.uint64(a)] += table[row, a] * s
        for a in range(5):
            found[low + np.uint64(a)] += table[row, 3 + a] * s
        found[own - _TWO] += table[row, 8] * s
        found[own - _ONE] += table[row, 9] * s
        found[own] += table[row, 10] * s
    cells, columns, pattern, table = seam
    m = columns.shape[1]
    for r in range(near[1].size):
        q = near[1][r]
        s = table[pattern[q], m] * given[cells[q]]
        for a in range(m):
            s += table[pattern[q], a] * given[columns[q, a]]
        for a in range(m):
            found[columns[q, a]] += table[pattern[q], a] * s
        found[cells[q]] += table[pattern[q], m] * s
