"""Line relaxation of a point contact: the smoother of the multigrid cycle.

1. A sweep visits the lines of cells along x, or along y, one after another. Each line is solved for its pressures, with
   the films that these pressures make (band of `BAND` cells on either side), and with the changes of the lines before
   it: their pressures, and the films that those make nearby.
2. Where the oil hardly flows, a change comes with its negative spread over the four neighbours, so that its deflection
   decays fast (distributive relaxation; Brandt and Lubrecht 1990, Venner and Lubrecht 2000).
3. Equations are those of `reynolds`, except that Couette flow across lines is of first order (upwind). With third order
   across lines, and films that later lines still change, waves across the flow grow from sweep to sweep: films with
   oblique entrainment take three times the cycles, heavily loaded ones along x half as many again.
4. In contact the equation of a cell is the film itself: the oil does not feel the change (`linear_system`).

Rows are eliminated while they are assembled, in scalars: a sixth of the time of an assembled matrix. The factors, seven
numbers a cell, serve all sweeps of a Newton step.

Cost: some 300 operations a cell for the factors, 60 for a sweep. Verified in
tests/lubrication/point/test_point_lines.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from bem.compiled import compiled, inlined
from bem.grid import FloatArray
from bem.lubrication.point.reynolds import jacobian_row

FIXED, OWN, DISTRIBUTED, CONTACT, CONTACT_DISTRIBUTED = range(5)
"""Kinds of cells: pressure fixed; change of the cell alone; change with its negative on the neighbours; the last two
in contact."""
BAND = 3
"""Cells on either side whose coupling along a line is solved for."""
OWN_FILM = 7
"""Index of the cell's own film in the result of `_line_derivatives`."""
FACTORS = 7
"""Numbers a cell of the factors of a line."""
COUPLED_LINES = 2
"""Number of following lines whose films feel the change of a line."""
REACH = BAND + 2
"""Distance in cells along a line up to which a balance in the band feels a change."""


@compiled
def _neighbour_weights(spacing: tuple[float, float]) -> tuple[float, float]:
    """Return the weights of a distributed change on each neighbour along x and along y."""
    dx, dy = spacing
    return 0.5 * dy * dy / (dx * dx + dy * dy), 0.5 * dx * dx / (dx * dx + dy * dy)


@inlined
def _kind_in_line(kinds: Any, along_y: int, i: int, j: int) -> int:
    """Return the kind of cell i of line j."""
    return kinds[j, i] if along_y else kinds[i, j]


@compiled
def _fill_change_tables(near: FloatArray, weights: tuple[float, float], oblique: bool, tables: FloatArray) -> None:
    """Fill tables (5, 10, 7): what a unit change of each kind of cell does to the quantities of `_line_derivatives`.

    The last index is the distance along the line, from -BAND to BAND. A fixed cell changes nothing, a cell in contact
    changes films alone.
    """
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
def _line_derivatives(rows: FloatArray, out: FloatArray) -> None:
    """Collect the derivatives (10,) of a balance from `reynolds.jacobian_row`.

    With the pressures of four cells along the line and of both cells beside it, then with the films of the same cells.
    """
    for by in range(2):
        for t in range(4):
            out[5 * by + t] = rows[by, t]
        out[5 * by + 4] = rows[by, 5] + rows[by, 6]


@compiled
def _eliminate_line(
    derivatives: Any,
    spacing: tuple[float, float],
    entrainment: tuple[float, float],
    storage_rate: float,
    along_y: int,
    tables: FloatArray,
    kinds: Any,
    j: int,
    factors: Any,
) -> None:
    """Compute the factors (cells, FACTORS) of line j by Gaussian elimination without pivoting.

    Factors of a cell, all divided by its pivot: one; multipliers of the three cells before, nearest first; entries of
    the three cells behind. They are zero for fixed cells. `kinds` of the line has BAND zeros before and behind.
    """
    rows, by = np.zeros((2, 7)), np.zeros(10)
    # of the three rows before, nearest first: one over the pivot, entries right of the pivot
    p1 = p2 = p3 = 1.0
    a1 = a2 = a3 = b1 = b2 = b3 = c1 = c2 = c3 = 0.0
    for i in range(factors.shape[0]):
        m0 = m1 = m2 = m3 = m4 = m5 = m6 = 0.0
        p, own = 1.0, 0.0
        if kinds[BAND + i] != FIXED:
            if kinds[BAND + i] < CONTACT:
                jacobian_row(derivatives, spacing, entrainment, storage_rate, along_y, True, i, j, rows)
                _line_derivatives(rows, by)
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
            p = own = 1.0 / m3
        p3, a3, b3, c3 = p2, a2, b2, c2
        p2, a2, b2, c2 = p1, a1, b1, c1
        p1, a1, b1, c1 = p, m4, m5, m6
        factors[i, 0], factors[i, 1], factors[i, 2], factors[i, 3] = own, p * m2, p * m1, p * m0
        factors[i, 4], factors[i, 5], factors[i, 6] = p * m4, p * m5, p * m6


@compiled
def _solve_line(factors: Any, right: FloatArray) -> None:
    """Solve a line with its factors (cells, FACTORS): `right` (cells,) becomes the changes of its cells."""
    x1 = x2 = x3 = 0.0
    for i in range(right.size):
        own = factors[i, 0] * right[i]
        x1, x2, x3 = own - factors[i, 3] * x3 - factors[i, 2] * x2 - factors[i, 1] * x1, x1, x2
        right[i] = x1
    x1 = x2 = x3 = 0.0
    for i in range(right.size - 1, -1, -1):
        x1, x2, x3 = right[i] - factors[i, 6] * x3 - factors[i, 5] * x2 - factors[i, 4] * x1, x1, x2
        right[i] = x1


@compiled
def factorise(
    derivatives: Any,
    spacing: tuple[float, float],
    entrainment: tuple[float, float],
    storage_rate: float,
    along_y: int,
    near: FloatArray,
    kinds: Any,
    factors: Any,
) -> None:
    """Compute the factors (lines, cells, FACTORS) of all lines along x, or y; of any precision, as are `derivatives`.

    Parameters
    ----------
    derivatives : of the flux, see `reynolds`.
    spacing, entrainment : of the cells, and components of the entrainment, along x and y.
    storage_rate : weight of the storage d(rho h)/dT in the balance; zero of steady films.
    along_y : 1 for lines along y, 0 along x.
    near : (2, REACH + 1, 3) films under a unit change, of the cell alone and distributed, at distances 0, 1, ... along
        and 0, 1, 2 across the line.
    kinds : (nx, ny) kinds of cells, see FIXED.
    factors : (lines, cells, FACTORS) result.
    """
    count, cells = kinds.shape[1 - along_y], kinds.shape[along_y]
    tables = np.empty((5, 10, 2 * BAND + 1))
    weights = _neighbour_weights((spacing[along_y], spacing[1 - along_y]))
    _fill_change_tables(near, weights, entrainment[1 - along_y] != 0.0, tables)
    line = np.zeros(cells + 2 * BAND, np.int64)
    for j in range(1, count - 1):
        for i in range(cells):
            line[BAND + i] = _kind_in_line(kinds, along_y, i, j)
        _eliminate_line(derivatives, spacing, entrainment, storage_rate, along_y, tables, line, j, factors[j])


@compiled
def _known_balance(rows: FloatArray, oil: FloatArray, film: FloatArray, i: int, j: int) -> float:
    """Return the change of the balance of cell i of line j under known changes of oil and film (lines, cells)."""
    back = max(i - 2, 0)
    change = rows[0, 0] * oil[j, back] + rows[1, 0] * film[j, back]
    for t in range(1, 4):
        change += rows[0, t] * oil[j, i + t - 2] + rows[1, t] * film[j, i + t - 2]
    change += rows[0, 5] * oil[j - 1, i] + rows[1, 5] * film[j - 1, i]
    return change + rows[0, 6] * oil[j + 1, i] + rows[1, 6] * film[j + 1, i]


@compiled
def _add_films(near: FloatArray, changes: FloatArray, across: int, film: FloatArray) -> None:
    """Add to the films (cells,) of a line the deflection under changes of the line `across` lines away.

    changes (2, cells + 2 BAND) : changes of cells alone, and distributed changes.
    """
    for kind in range(2):
        n0, n1, n2, n3 = near[kind, 0, across], near[kind, 1, across], near[kind, 2, across], near[kind, 3, across]
        c = changes[kind]
        for i in range(film.size):
            beside = n1 * (c[i + 2] + c[i + 4]) + n2 * (c[i + 1] + c[i + 5]) + n3 * (c[i] + c[i + 6])
            film[i] += n0 * c[i + 3] + beside


@compiled
def relax(
    factors: Any,
    derivatives: Any,
    spacing: tuple[float, float],
    entrainment: tuple[float, float],
    storage_rate: float,
    along_y: int,
    near: FloatArray,
    kinds: Any,
    residual: FloatArray,
    backward: bool,
    damping: tuple[float, float],
    couple_films: bool,
    dp: FloatArray,
) -> None:
    """Sweep once over the lines along x, or y: `dp` (nx, ny) is the change of pressure for a residual.

    Parameters
    ----------
    factors, derivatives, spacing, entrainment, storage_rate, along_y, near, kinds : of `factorise`.
    residual : (nx, ny) of balances; in contact of the film.
    backward : from the last line to the first; not where oil is entrained across the lines.
    damping : factors of changes of a cell alone, and of distributed changes.
    couple_films : whether a line feels all that lines before it changed, films included, or the pressures of the last
        line alone.
    dp : (nx, ny) result, change of pressure.
    """
    count, cells = kinds.shape[1 - along_y], kinds.shape[along_y]
    weights = _neighbour_weights((spacing[along_y], spacing[1 - along_y]))
    right, rows, changes = np.empty(cells), np.zeros((2, 7)), np.zeros((2, cells + 2 * BAND))
    pressure, oil, film = np.zeros((count, cells)), np.zeros((count, cells)), np.zeros((count, cells))
    for number in range(1, count - 1):
        j = count - 1 - number if backward else number
        for i in range(cells):
            e, f = (j, i) if along_y else (i, j)
            kind = _kind_in_line(kinds, along_y, i, j)
            right[i] = 0.0
            if kind >= CONTACT:
                right[i] = residual[e, f] - (film[j, i] if couple_films else 0.0)
            elif kind != FIXED:
                jacobian_row(derivatives, spacing, entrainment, storage_rate, along_y, True, i, j, rows)
                if couple_films:
                    right[i] = residual[e, f] - _known_balance(rows, oil, film, i, j)
                else:
                    before = rows[0, 6] * oil[j + 1, i] if backward else rows[0, 5] * oil[j - 1, i]
                    right[i] = residual[e, f] - before
        _solve_line(factors[j], right)
        for i in range(1, cells - 1):
            kind = _kind_in_line(kinds, along_y, i, j)
            changes[:, BAND + i] = 0.0
            if kind in (OWN, CONTACT):
                changes[0, BAND + i] = damping[0] * right[i]
                pressure[j, i] += damping[0] * right[i]
            elif kind != FIXED:
                change = damping[1] * right[i]
                changes[1, BAND + i] = change
                pressure[j, i] += change
                pressure[j, i - 1] -= weights[0] * change
                pressure[j, i + 1] -= weights[0] * change
                pressure[j - 1, i] -= weights[1] * change
                pressure[j + 1, i] -= weights[1] * change
        for m in range(j - 1, j + 2):
            for i in range(cells):
                kind = _kind_in_line(kinds, along_y, i, m)
                oil[m, i] = 0.0 if kind >= CONTACT else pressure[m, i]
        for across in range(COUPLED_LINES + 1):
            m = j - across if backward else j + across
            if 0 <= m < count:
                _add_films(near, changes, across, film[m])
    for j in range(count):
        for i in range(cells):
            if along_y:
                dp[j, i] = pressure[j, i]
            else:
                dp[i, j] = pressure[j, i]
