"""Line relaxation of a point contact: sweeps over lines of cells along x or y, each solved with the films its own
pressures make, and with what the lines before it have made of its own balance, nearby films included. Compiled loops;
the equations are those of `loops`, but for what is dragged across lines, which is of the cell before alone: with what
is dragged of third order, and films that lines ahead still change, waves across the flow grew from sweep to sweep (of
oil at an angle films took three times the cycles, heavy ones along x half as many again).

Rows of a line are eliminated as they are built, in plain numbers, from tables of what a change makes: a sixth of the
time of a matrix filled by calls and solved after that. What is eliminated is kept, seven numbers a cell, for all sweeps
of a Newton step. Verified in tests/lubrication/point/test_point_lines.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.lubrication.point.loops import fill_row

BAND = 3
"""Cells on either side whose coupling along a line is solved for."""
TOUCHES, OWN_FILM = 3, 7
"""Kinds of cells from which on surfaces touch; of what `_derivatives` gives, that with the cell's own film."""
KEPT = 7
"""Numbers a cell of a line's factors."""
ACROSS = 2
"""Lines ahead whose films hear of a change."""
REACH = BAND + 2
"""Cells along a line from one that changes to the furthest that a balance within the band hears of."""


@compiled
def _weights(spacing: tuple[float, float]) -> tuple[float, float]:
    """Of a counterpart, on either neighbour along x and along y."""
    dx, dy = spacing
    return 0.5 * dy * dy / (dx * dx + dy * dy), 0.5 * dx * dx / (dx * dx + dy * dy)


@compiled
def _changes(near: FloatArray, weights: tuple[float, float], oblique: bool, tables: FloatArray) -> None:
    """Tables (5, 10, 7): what a unit change of each kind, of the cell so far along the line, makes of what
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
            tables[kind + 2, 5:, BAND + s] = table[5:]


@compiled
def _derivatives(rows: FloatArray, out: FloatArray) -> None:
    """Of a balance (10,), from `fill_row`: with pressures of four cells along the line, of both beside; with films of
    the four, of both beside."""
    for by in range(2):
        for t in range(4):
            out[5 * by + t] = rows[by, t]
        out[5 * by + 4] = rows[by, 5] + rows[by, 6]


@compiled
def _eliminate(
    stencil: Any,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    storing: float,
    along_y: int,
    tables: FloatArray,
    kinds: Any,
    j: int,
    kept: Any,
) -> None:
    """Factors (nx, KEPT) of line j by Gaussian elimination without exchange of rows: of a cell, all over its pivot,
    one; what comes of the three cells before, the nearest first, and of the three behind. Of cells that are held, zero.
    kinds : of the line, with BAND zeros before and behind."""
    rows, by = np.zeros((2, 7)), np.zeros(10)
    # of the three rows before, the nearest first: one over the pivot, what is right of it
    p1 = p2 = p3 = 1.0
    a1 = a2 = a3 = b1 = b2 = b3 = c1 = c2 = c3 = 0.0
    for i in range(kept.shape[0]):
        m0 = m1 = m2 = m3 = m4 = m5 = m6 = 0.0
        p, taken = 1.0, 0.0
        if kinds[BAND + i] != 0:
            if kinds[BAND + i] < TOUCHES:
                fill_row(stencil, spacing, drag, storing, along_y, True, i, j, rows)
                _derivatives(rows, by)
            else:
                by[:] = 0.0
                by[OWN_FILM] = 1.0
            k0, k1, k2, k3 = kinds[i], kinds[i + 1], kinds[i + 2], kinds[i + 3]
            k4, k5, k6 = kinds[i + 4], kinds[i + 5], kinds[i + 6]
            for c in range(10):
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


@compiled
def _solve_line(kept: Any, right: FloatArray) -> None:
    """Changes of the cells of a line of factors (nx, KEPT), in place of what they are to make of their balances,
    `right` (nx,)."""
    x1 = x2 = x3 = 0.0
    for i in range(right.size):
        own = kept[i, 0] * right[i]
        x1, x2, x3 = own - kept[i, 3] * x3 - kept[i, 2] * x2 - kept[i, 1] * x1, x1, x2
        right[i] = x1
    x1 = x2 = x3 = 0.0
    for i in range(right.size - 1, -1, -1):
        x1, x2, x3 = right[i] - kept[i, 6] * x3 - kept[i, 5] * x2 - kept[i, 4] * x1, x1, x2
        right[i] = x1


@compiled
def factorise(
    stencil: Any,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    storing: float,
    along_y: int,
    near: FloatArray,
    kinds: Any,
    factors: Any,
) -> None:
    """Factors (lines, cells, KEPT) of all lines along x, or y, of any precision as the derivatives are.

    kinds : (nx, ny) 0 held, 1 a change of its own, 2 a change with its counterpart on the four neighbours, so that what
    is far away hardly feels it (distributive relaxation; Brandt and Lubrecht 1990, Venner and Lubrecht 2000). 3 and 4
    the same where surfaces touch: the residual is one of the film there, and the oil does not feel the change.
    near : (2, n, 3) films under a unit change of either kind at distances 0 .. along and 0 .. 2 across the line.
    """
    count, cells = kinds.shape[1 - along_y], kinds.shape[along_y]
    tables = np.empty((5, 10, 2 * BAND + 1))
    _changes(near, _weights((spacing[along_y], spacing[1 - along_y])), drag[1 - along_y] != 0.0, tables)
    line = np.zeros(cells + 2 * BAND, np.int64)
    for j in range(1, count - 1):
        for i in range(cells):
            line[BAND + i] = kinds[j, i] if along_y else kinds[i, j]
        _eliminate(stencil, spacing, drag, storing, along_y, tables, line, j, factors[j])


@compiled
def _wanted(rows: FloatArray, oil: FloatArray, film: FloatArray, i: int, j: int) -> float:
    """What changes of oil and film (lines, cells) that are there make of the balance of cell i of line j."""
    back = max(i - 2, 0)
    made = rows[0, 0] * oil[j, back] + rows[1, 0] * film[j, back]
    for t in range(1, 4):
        made += rows[0, t] * oil[j, i + t - 2] + rows[1, t] * film[j, i + t - 2]
    made += rows[0, 5] * oil[j - 1, i] + rows[1, 5] * film[j - 1, i]
    return made + rows[0, 6] * oil[j + 1, i] + rows[1, 6] * film[j + 1, i]


@compiled
def _films(near: FloatArray, changes: FloatArray, across: int, film: FloatArray) -> None:
    """Add to films (cells,) of a line so many lines away what changes make of them, (2, cells + 2 BAND) of either
    kind."""
    for kind in range(2):
        n0, n1, n2, n3 = near[kind, 0, across], near[kind, 1, across], near[kind, 2, across], near[kind, 3, across]
        c = changes[kind]
        for i in range(film.size):
            beside = n1 * (c[i + 2] + c[i + 4]) + n2 * (c[i + 1] + c[i + 5]) + n3 * (c[i] + c[i + 6])
            film[i] += n0 * c[i + 3] + beside


@compiled
def relax(
    factors: Any,
    stencil: Any,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    storing: float,
    along_y: int,
    near: FloatArray,
    kinds: Any,
    residual: FloatArray,
    downwards: bool,
    damping: tuple[float, float],
    hears: bool,
    dp: FloatArray,
) -> None:
    """One sweep of line relaxation along x, or y: `dp` (nx, ny) is what it adds to the pressures for a residual;
    factors, kinds and near as of `factorise`. downwards : from the last line to the first, not of oil that flows across
    lines. damping : of changes of a cell's own, and of those with a counterpart. hears : whether of all that lines
    before have changed, films nearby included, or of the pressures of the last one alone."""
    count, cells = kinds.shape[1 - along_y], kinds.shape[along_y]
    weights = _weights((spacing[along_y], spacing[1 - along_y]))
    right, rows, changes = np.empty(cells), np.zeros((2, 7)), np.zeros((2, cells + 2 * BAND))
    pressure, oil, film = np.zeros((count, cells)), np.zeros((count, cells)), np.zeros((count, cells))
    for number in range(1, count - 1):
        j = count - 1 - number if downwards else number
        for i in range(cells):
            e, f = (j, i) if along_y else (i, j)
            kind = kinds[e, f]
            right[i] = 0.0
            if kind >= TOUCHES:
                right[i] = residual[e, f] - (film[j, i] if hears else 0.0)
            elif kind != 0:
                fill_row(stencil, spacing, drag, storing, along_y, True, i, j, rows)
                if hears:
                    right[i] = residual[e, f] - _wanted(rows, oil, film, i, j)
                else:
                    before = rows[0, 6] * oil[j + 1, i] if downwards else rows[0, 5] * oil[j - 1, i]
                    right[i] = residual[e, f] - before
        _solve_line(factors[j], right)
        for i in range(1, cells - 1):
            kind = kinds[j, i] if along_y else kinds[i, j]
            changes[:, BAND + i] = 0.0
            if kind == 1 or kind == 3:
                changes[0, BAND + i] = damping[0] * right[i]
                pressure[j, i] += damping[0] * right[i]
            elif kind != 0:
                change = damping[1] * right[i]
                changes[1, BAND + i] = change
                pressure[j, i] += change
                pressure[j, i - 1] -= weights[0] * change
                pressure[j, i + 1] -= weights[0] * change
                pressure[j - 1, i] -= weights[1] * change
                pressure[j + 1, i] -= weights[1] * change
        for m in range(j - 1, j + 2):
            for i in range(cells):
                kind = kinds[m, i] if along_y else kinds[i, m]
                oil[m, i] = 0.0 if kind >= TOUCHES else pressure[m, i]
        for across in range(ACROSS + 1):
            m = j - across if downwards else j + across
            if 0 <= m < count:
                _films(near, changes, across, film[m])
    for j in range(count):
        for i in range(cells):
            if along_y:
                dp[j, i] = pressure[j, i]
            else:
                dp[i, j] = pressure[j, i]
