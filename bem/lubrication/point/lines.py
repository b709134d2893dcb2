"""Line relaxation of a point contact: sweeps over lines of cells along x, each solved with the films its own pressures
make. Compiled loops; the equations are those of `loops`.

Rows of a line are eliminated as they are built, in plain numbers, from tables of what a change makes: a sixth of the
time of a matrix filled by calls and solved after that (66 to 80 ns a cell of 256 x 256, 388 to 425). What is eliminated
is kept, nine numbers a cell, for all sweeps of a Newton step: sweeps were half of a film's time and are a fifth.
Verified in tests/lubrication/point/test_point_lines.py.
"""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from bem.grid import FloatArray
from bem.lubrication.point.loops import COMPILE, fill_row

BAND = 3
"""Cells on either side whose coupling along a line is solved for."""
TOUCHES, OWN_FILM = 3, 7
"""Kinds of cells from which on surfaces touch; of what `_derivatives` gives, that with the cell's own film."""
KEPT = 9
"""Numbers a cell of a line's factors."""
REACH = BAND + 2
"""Cells along a line from one that changes to the furthest that a balance within the band hears of."""


@nb.njit(**COMPILE)
def _weights(spacing: tuple[float, float]) -> tuple[float, float]:
    """Of a counterpart, on either neighbour along x and along y."""
    dx, dy = spacing
    return 0.5 * dy * dy / (dx * dx + dy * dy), 0.5 * dx * dx / (dx * dx + dy * dy)


@nb.njit(**COMPILE)
def _changes(near: FloatArray, weights: tuple[float, float], oblique: bool, tables: FloatArray) -> None:
    """Tables (5, 11, 7): what a unit change of each kind, of the cell so far along the line, makes of what
    `_derivatives` puts beside it; nothing of one that is held, and of one that touches films alone."""
    tables[:, :, :] = 0.0
    for s in range(-BAND, BAND + 1):
        for kind in range(1, 3):
            table = tables[kind, :, BAND + s]
            for t in range(4):
                distance = abs(t - 2 - s)
                if distance == 0:
                    table[t] = 1.0
                elif distance == 1 and kind == 2:
                    table[t] = -weights[0]
                table[5 + t] = near[kind - 1, distance, 0]
            if s == 0 and kind == 2:
                table[4] = -weights[1]
            if oblique:
                table[9] = near[kind - 1, abs(s), 1]
                table[10] = near[kind - 1, abs(s), 2]
            tables[kind + 2, 5:, BAND + s] = table[5:]


@nb.njit(**COMPILE)
def _derivatives(rows: FloatArray, out: FloatArray) -> None:
    """Of a balance (11,), from `fill_row`: with pressures of four cells along the line, of both beside; with films of
    the four, of both beside, of the one upstream of them."""
    for by in range(2):
        for t in range(4):
            out[5 * by + t] = rows[by, t]
        out[5 * by + 4] = rows[by, 5] + rows[by, 6]
    out[10] = rows[1, 4]


@nb.njit(**COMPILE)
def _eliminate(  # reason: Numba compiles plain arrays; they are the parts of one equation
    stencil: Any,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    storing: float,
    tables: FloatArray,
    kinds: Any,
    j: int,
    kept: Any,
) -> None:
    """Factors (nx, KEPT) of line j by Gaussian elimination without exchange of rows: of a cell, all over its pivot,
    one; what comes of the three cells before, the nearest first, and of the three behind; what changes of the lines on
    either side make of its balance. Of cells that are held, zero. kinds : of the line, with BAND zeros before and
    behind."""
    rows, by = np.zeros((2, 7)), np.zeros(11)
    # of the three rows before, the nearest first: one over the pivot, what is right of it
    p1 = p2 = p3 = 1.0
    a1 = a2 = a3 = b1 = b2 = b3 = c1 = c2 = c3 = 0.0
    for i in range(kept.shape[0]):
        m0 = m1 = m2 = m3 = m4 = m5 = m6 = 0.0
        p, taken = 1.0, 0.0
        if kinds[BAND + i] != 0:
            if kinds[BAND + i] < TOUCHES:
                fill_row(stencil, spacing, drag, storing, i, j, rows)
                _derivatives(rows, by)
            else:
                rows[:, :], by[:] = 0.0, 0.0
                by[OWN_FILM] = 1.0
            k0, k1, k2, k3 = kinds[i], kinds[i + 1], kinds[i + 2], kinds[i + 3]
            k4, k5, k6 = kinds[i + 4], kinds[i + 5], kinds[i + 6]
            for c in range(11):
                v = by[c]
                m0 += v * tables[k0, c, 0]
                m1 += v * tables[k1, c, 1]
                m2 += v * tables[k2, c, 2]
                m3 += v * tables[k3, c, 3]
                m4 += v * tables[k4, c, 4]
                m5 += v * tables[k5, c, 5]
                m6 += v * tables[k6, c, 6]
            f = m0 * p3
            m1, m2, m3 = m1 - f * a3, m2 - f * b3, m3 - f * c3
            f = m1 * p2
            m2, m3, m4 = m2 - f * a2, m3 - f * b2, m4 - f * c2
            f = m2 * p1
            m3, m4, m5 = m3 - f * a1, m4 - f * b1, m5 - f * c1
            p = taken = 1.0 / m3
        p3, a3, b3, c3 = p2, a2, b2, c2
        p2, a2, b2, c2 = p1, a1, b1, c1
        p1, a1, b1, c1 = p, m4, m5, m6
        kept[i, 0], kept[i, 1], kept[i, 2], kept[i, 3] = taken, p * m2, p * m1, p * m0
        kept[i, 4], kept[i, 5], kept[i, 6] = p * m4, p * m5, p * m6
        kept[i, 7], kept[i, 8] = taken * rows[0, 5], taken * rows[0, 6]


@nb.njit(**COMPILE)
def _solve_line(kept: Any, beside: int, before: FloatArray, right: FloatArray) -> None:
    """Changes of the cells of a line of factors (nx, KEPT), in place of what they are to make of their balances,
    `right` (nx,). before : changes of the line relaxed before, whose part of the factors is `beside`."""
    x1 = x2 = x3 = 0.0
    for i in range(right.size):
        own = kept[i, 0] * right[i] - kept[i, beside] * before[i]
        x1, x2, x3 = own - kept[i, 3] * x3 - kept[i, 2] * x2 - kept[i, 1] * x1, x1, x2
        right[i] = x1
    x1 = x2 = x3 = 0.0
    for i in range(right.size - 1, -1, -1):
        x1, x2, x3 = right[i] - kept[i, 6] * x3 - kept[i, 5] * x2 - kept[i, 4] * x1, x1, x2
        right[i] = x1


@nb.njit(**COMPILE)
def factorise(
    stencil: Any,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    storing: float,
    near: FloatArray,
    kinds: Any,
    factors: Any,
) -> None:
    """Factors (ny, nx, KEPT) of all lines along x, of any precision as the derivatives are.

    kinds : 0 held, 1 a change of its own, 2 a change with its counterpart on the four neighbours, so that what is
    far away hardly feels it (distributive relaxation; Brandt and Lubrecht 1990, Venner and Lubrecht 2000). 3 and 4 the
    same where surfaces touch: the residual is one of the film there, and the oil does not feel the change.
    near : (2, n, 3) films under a unit change of either kind at distances 0 .. along and 0 .. 2 across the line.
    """
    nx, ny = kinds.shape
    tables = np.empty((5, 11, 2 * BAND + 1))
    _changes(near, _weights(spacing), drag[1] != 0.0, tables)
    line = np.zeros(nx + 2 * BAND, np.int64)
    for j in range(1, ny - 1):
        for i in range(nx):
            line[BAND + i] = kinds[i, j]
        _eliminate(stencil, spacing, drag, storing, tables, line, j, factors[j])


@nb.njit(**COMPILE)
def relax(
    factors: Any,
    spacing: tuple[float, float],
    kinds: Any,
    residual: FloatArray,
    damping: tuple[float, float],
    downwards: bool,
    dp: FloatArray,
) -> None:
    """One sweep of line relaxation along x: `dp` is what it adds to the pressures for a residual; factors and kinds as
    of `factorise`."""
    nx, ny = residual.shape
    weights = _weights(spacing)
    line = np.zeros(nx + 2 * BAND, np.int64)
    before, right = np.empty(nx), np.empty(nx)
    beside = 8 if downwards else 7
    dp[:, :] = 0.0
    for count in range(1, ny - 1):
        j = ny - 1 - count if downwards else count
        for i in range(nx):
            line[BAND + i] = kinds[i, j]
            last = j + 1 if downwards else j - 1
            right[i], before[i] = residual[i, j], 0.0 if kinds[i, last] >= TOUCHES else dp[i, last]
        _solve_line(factors[j], beside, before, right)
        for i in range(1, nx - 1):
            if line[BAND + i] == 1 or line[BAND + i] == 3:
                dp[i, j] += damping[0] * right[i]
            elif line[BAND + i] != 0:
                change = damping[1] * right[i]
                dp[i, j] += change
                dp[i - 1, j] -= weights[0] * change
                dp[i + 1, j] -= weights[0] * change
                dp[i, j - 1] -= weights[1] * change
                dp[i, j + 1] -= weights[1] * change
