"""Pressures without bounds brought to zero where they pull: in the norm of the energy, as far as near neighbours go.

Pressures p that close the gap on the cells F + A are negative on A. On F alone the gap is closed by p - B y, where B is
the inverse of the kernel on F + A and B y = p on A: what pulls is taken off, and the neighbours make up for it. B is
that of `preconditioner`, the sparse G^T G; what that does not see, long waves, the next round does. Clipping alone
leaves a gap of two to three times what the iterations left: a convolution more in the first rounds.

Knows G's rows, and no contact. Verified in tests/contact/test_imposing.py against dense matrices.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from bem.contact.preconditioner import SparseInverseOnCells

FloatArray = NDArray[np.float64]

_ITERATIONS = 3
"""Of conjugate gradients for y, whose matrix is near its diagonal: on A cells are mostly single, or in rows of two or
three along an edge. One to six count alike on rough contacts."""

_fast: Any = njit(cache=True, nogil=True, error_model="numpy")


def impose(inverse: SparseInverseOnCells, pressure: FloatArray) -> None:
    """Bring negative pressures (n,) on the inverse's cells to zero, in place. Their neighbours may become negative
    then: those that do are brought there with them, once; others are left as they are."""
    _impose(inverse.rows, inverse.seam, pressure, _ITERATIONS)


@_fast
def _impose(rows, seam, pressure, iterations):  # type: ignore[no-untyped-def]
    pulls = pressure < 0
    count = 0
    for k in range(pulls.size):  # numpy's `any` would bring linear algebra into a run
        count += pulls[k]
    if count == 0:
        return
    given, found = np.zeros(pressure.size), np.zeros(pressure.size)
    near = _reaching(rows, seam, pulls)
    _answer(near, pulls, pressure, iterations, given, found)
    columns, values = near
    more = False
    for c in columns.flat:
        if not pulls[c] and pressure[c] - found[c] < 0:
            pulls[c] = True
            more = True
    if more:
        columns, values = _reaching(rows, seam, pulls)
        _answer((columns, values), pulls, pressure, iterations, given, found)
    for c in columns.flat:  # a cell is met many times: what was found is taken off it at the first
        pressure[c] -= found[c]
        found[c] = 0.0
    for k in range(pressure.size):
        if pulls[k]:
            pressure[k] = 0.0


@_fast
def _reaching(rows, seam, marked):  # type: ignore[no-untyped-def]
    """The rows of G that reach a cell that is marked: columns and values (r, w), the cell itself where none is."""
    upper, lower, pattern, table = rows
    listed, seam_columns, seam_pattern, seam_table = seam
    m = seam_columns.shape[1]
    near, edge = np.empty(marked.size, np.int32), np.empty(listed.size, np.int32)
    count, more = 0, 0
    for k in range(marked.size):
        row = pattern[k]
        for a in range(11):
            # without a value the place is another row's, or none; rows of the seam have no values here
            if table[row, a] != 0 and marked[_column(upper, lower, k, a)]:
                near[count] = k
                count += 1
                break
    for q in range(listed.size):
        reaches = marked[listed[q]]
        for a in range(m):
            reaches |= marked[seam_columns[q, a]]
        if reaches:
            edge[more] = q
            more += 1
    columns, values = np.empty((count + more, max(11, m + 1)), np.int32), np.zeros((count + more, max(11, m + 1)))
    for r in range(count):
        k = near[r]
        columns[r] = k
        for a in range(11):
            value = table[pattern[k], a]
            if value != 0:
                columns[r, a] = _column(upper, lower, k, a)
                values[r, a] = value
    for r in range(more):
        q = edge[r]
        columns[count + r] = listed[q]
        for a in range(m):
            columns[count + r, a] = seam_columns[q, a]
        for a in range(m + 1):
            values[count + r, a] = seam_table[seam_pattern[q], a]
    return columns, values


@_fast
def _column(upper, lower, k, a):  # type: ignore[no-untyped-def]
    """Whereto entry `a` of a packed row leads."""
    return upper[k] + a if a < 3 else lower[k] + a - 3 if a < 8 else k + a - 10


@_fast
def _answer(near, pulls, pressure, iterations, given, found):  # type: ignore[no-untyped-def]
    """found = B y, for B y = p on the cells marked."""
    cells, count = np.empty(pulls.size, np.int64), 0
    for k in range(pulls.size):  # numpy's search would bring linear algebra into a run
        if pulls[k]:
            cells[count] = k
            count += 1
    cells = cells[:count]
    missed, y = np.empty(cells.size), np.zeros(cells.size)
    squares = 0.0
    for a in range(cells.size):
        missed[a] = pressure[cells[a]]
        squares += missed[a] ** 2
    way = missed.copy()
    for _ in range(iterations):
        if not squares > 0:
            break
        _apply(near, cells, way, given, found)
        curvature = 0.0
        for a in range(cells.size):
            curvature += way[a] * found[cells[a]]
        step, last = squares / curvature, squares
        squares = 0.0
        for a in range(cells.size):
            y[a] += step * way[a]
            missed[a] -= step * found[cells[a]]
            squares += missed[a] ** 2
        for a in range(cells.size):
            way[a] = missed[a] + squares / last * way[a]
    _apply(near, cells, y, given, found)


@_fast
def _apply(near, cells, amounts, given, found):  # type: ignore[no-untyped-def]
    """found = G^T G of amounts on some cells, on all that it reaches; `given` is zero before and after."""
    columns, values = near
    for a in range(cells.size):
        given[cells[a]] = amounts[a]
    for c in columns.flat:
        found[c] = 0.0
    for r in range(columns.shape[0]):
        s = 0.0
        for a in range(columns.shape[1]):
            s += values[r, a] * given[columns[r, a]]
        for a in range(columns.shape[1]):
            found[columns[r, a]] += values[r, a] * s
    for a in range(cells.size):
        given[cells[a]] = 0.0
