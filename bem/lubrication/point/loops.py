"""Reynolds' equation of a point contact on cells, its derivatives and line relaxation: compiled loops over arrays.

In similarity units (`scales`), with the flow between neighbouring cells

    F = -rho h^3/m dP/dx + 6 c rho h

the balance of a cell is div F, in time div F + 6 d(rho h)/dT with d(rho h)/dT = `storing` rho h + what was there
(`InTime`). Fluidity 1/m is its mean between the two pressures; h^3 is that of a film which is linear between both
cells, 1/(mean of 1/h^3) = 2 a^2 b^2/(a + b): where one cell is thin, nothing flows past it. With ((a + b)/2)^3 oil went
through constrictions as narrow as a cell, films were off twice as much at M 200, L 5, and heavy ellipses had none.
What is dragged is interpolated from two cells upstream and one downstream by logarithms, (a^3 b^6/c)^(1/8) of the
cells ahead, here and behind (third order; Leonard 1979 without logarithms): films were ten times as accurate as with
the two upstream ones, and there still is no wave of pressure that the oil does not feel where it is too viscous to
flow. Without logarithms oil went backwards through faces behind which the film is more than six times as thick, and of
150 random contacts 18 had no film on 48 cells a side (1 with them). Heavy piezoviscous films pay for it: on 192 cells
those at M 1000, L 10 are 0.3 % too thick, of a narrow ellipse (Rx/Ry 5) 1.4 %.
Entrainment c points to larger indices along both axes. Outermost cells hold no balance.

Arrays are [ix, iy]; a face [i, j] lies between cell [i, j] and the next one along its axis. `oil` (4, nx, ny): ln m and
its slope with pressure, rho and its slope. `stencil` (13, nx, ny): derivatives of the pressure flow through the faces
along x with the pressure on the left, on the right, and with both films; the same along y; rho h, and its relative
derivatives with film and pressure; what is dragged through the faces along x, and along y.
"""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from bem.grid import FloatArray

COMPILE: dict[str, Any] = {"cache": True, "error_model": "numpy", "nogil": True}
BAND = 3
"""Cells on either side whose coupling along a line is solved for."""
AHEAD, HERE, BEHIND = 0.375, 0.75, 0.125
"""Shares of the cells around a face in what is dragged through it."""


@nb.njit(**COMPILE)
def _mean_fluidity(first: float, second: float) -> tuple[float, float, float]:
    """Mean of exp(-ln m), ln m linear between two cells, and its derivatives with both ends."""
    half = 0.5 * (second - first)
    if abs(half) < 0.05:
        square = half * half
        middle = np.exp(-0.5 * (first + second))
        mean = middle * (1.0 + square / 6.0 + square * square / 120.0)
        odd = 0.5 * middle * (half / 3.0 + half * square / 30.0)
        return mean, -0.5 * mean - odd, -0.5 * mean + odd
    low, high = np.exp(-first), np.exp(-second)
    mean = (low - high) / (2.0 * half)
    return mean, (mean - low) / (2.0 * half), (high - mean) / (2.0 * half)


@nb.njit(**COMPILE)
def pressure_flow(
    p: FloatArray, h: FloatArray, oil: FloatArray, step: float, along_y: int, flow: FloatArray, stencil: FloatArray
) -> None:
    """Pressure flow through the faces along one axis, and its derivatives (4, nx, ny)."""
    nx, ny = p.shape
    di, dj = 1 - along_y, along_y
    for i in range(nx - di):
        for j in range(ny - dj):
            k, n = i + di, j + dj
            phi, phi_left, phi_right = _mean_fluidity(oil[0, i, j], oil[0, k, n])
            left, right = h[i, j], h[k, n]
            total = left + right
            cube = 2.0 * (left * right) ** 2 / total
            dense = 0.5 * (oil[2, i, j] + oil[2, k, n])
            gradient = (p[k, n] - p[i, j]) / step
            flow[i, j] = -dense * cube * phi * gradient
            easy = dense * cube * phi / step
            steep = gradient * cube
            stencil[0, i, j] = easy - steep * (dense * phi_left * oil[1, i, j] + 0.5 * phi * oil[3, i, j])
            stencil[1, i, j] = -easy - steep * (dense * phi_right * oil[1, k, n] + 0.5 * phi * oil[3, k, n])
            thin = -2.0 * left * right * dense * phi * gradient / (total * total)
            stencil[2, i, j] = thin * right * (left + 2.0 * right)
            stencil[3, i, j] = thin * left * (2.0 * left + right)


@nb.njit(**COMPILE)
def dragged_flow(m: FloatArray, share: float, along_y: int, dragged: FloatArray) -> None:
    """What is dragged through the faces along one axis (nx, ny), of oil m > 0 in the cells."""
    nx, ny = m.shape
    di, dj = 1 - along_y, along_y
    root = np.sqrt(np.sqrt(np.sqrt(m)))  # shares are eighths
    for i in range(nx - di):
        for j in range(ny - dj):
            k, n = i + di, j + dj
            if i < di or j < dj:
                dragged[i, j] = 6.0 * share * np.sqrt(m[i, j] * m[k, n])
                continue
            here, ahead = root[i, j], root[k, n]
            cube = here * here * ahead
            dragged[i, j] = 6.0 * share * cube * cube * ahead * here * here / root[i - di, j - dj]


@nb.njit(**COMPILE)
def _drag_change(dragged: FloatArray, g: FloatArray, along_y: int, flow: FloatArray) -> None:
    """Add its change under relative changes g of the oil in the cells."""
    nx, ny = g.shape
    di, dj = 1 - along_y, along_y
    for i in range(nx - di):
        for j in range(ny - dj):
            ahead, here = g[i + di, j + dj], g[i, j]
            if i < di or j < dj:
                flow[i, j] += 0.5 * dragged[i, j] * (here + ahead)
            else:
                flow[i, j] += dragged[i, j] * (AHEAD * ahead + HERE * here - BEHIND * g[i - di, j - dj])


@nb.njit(**COMPILE)
def divergence(flow: FloatArray, spacing: tuple[float, float], out: FloatArray) -> None:
    """Balance of the inner cells under flows (2, nx, ny) through faces; outermost cells are left alone."""
    nx, ny = out.shape
    dx, dy = spacing
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            out[i, j] = (flow[0, i, j] - flow[0, i - 1, j]) / dx + (flow[1, i, j] - flow[1, i, j - 1]) / dy


@nb.njit(**COMPILE)
def flows(
    p: FloatArray,
    h: FloatArray,
    oil: FloatArray,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    flow: FloatArray,
    stencil: FloatArray,
) -> None:
    """Flow (2, nx, ny) through all faces, and the stencil of its derivatives."""
    pressure_flow(p, h, oil, spacing[0], 0, flow[0], stencil[0:4])
    pressure_flow(p, h, oil, spacing[1], 1, flow[1], stencil[4:8])
    stencil[8] = oil[2] * h
    stencil[9] = 1.0 / h
    stencil[10] = oil[3] / oil[2]
    for axis in range(2):
        if drag[axis] != 0.0:
            dragged_flow(stencil[8], drag[axis], axis, stencil[11 + axis])
            flow[axis] += stencil[11 + axis]


@nb.njit(**COMPILE)
def applied(
    stencil: FloatArray,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    storing: float,
    dp: FloatArray,
    dh: FloatArray,
    out: FloatArray,
) -> None:
    """Change of the balance of inner cells with pressures and films."""
    nx, ny = dp.shape
    flow = np.zeros((2, nx, ny))
    s = stencil
    for i in range(nx):
        for j in range(ny):
            if i < nx - 1:
                films = s[2, i, j] * dh[i, j] + s[3, i, j] * dh[i + 1, j]
                flow[0, i, j] = s[0, i, j] * dp[i, j] + s[1, i, j] * dp[i + 1, j] + films
            if j < ny - 1:
                films = s[6, i, j] * dh[i, j] + s[7, i, j] * dh[i, j + 1]
                flow[1, i, j] = s[4, i, j] * dp[i, j] + s[5, i, j] * dp[i, j + 1] + films
    g = s[9] * dh + s[10] * dp
    for axis in range(2):
        if drag[axis] != 0.0:
            _drag_change(s[11 + axis], g, axis, flow[axis])
    divergence(flow, spacing, out)
    if storing != 0.0:
        for i in range(1, nx - 1):
            for j in range(1, ny - 1):
                out[i, j] += 6.0 * storing * s[8, i, j] * g[i, j]


@nb.njit(**COMPILE)
def _dragged_row(
    s: FloatArray, m: FloatArray, i: int, j: int, spacing: tuple[float, float], oblique: bool, row: FloatArray
) -> None:
    """Add derivatives of what is dragged with unknowns, m the relative change of the oil with them, to a row: unknowns
    at [i - 2 .. i + 1, j], then at [i, j - 2], [i, j - 1], [i, j + 1]."""
    comes, leaves = s[11, i - 1, j] / spacing[0], s[11, i, j] / spacing[0]
    row[3] += AHEAD * leaves * m[i + 1, j]
    row[2] += HERE * leaves * m[i, j]
    row[1] -= BEHIND * leaves * m[i - 1, j]
    if i == 1:
        row[2] -= 0.5 * comes * m[1, j]
        row[1] -= 0.5 * comes * m[0, j]
    else:
        row[2] -= AHEAD * comes * m[i, j]
        row[1] -= HERE * comes * m[i - 1, j]
        row[0] += BEHIND * comes * m[i - 2, j]
    if not oblique:
        return
    comes, leaves = s[12, i, j - 1] / spacing[1], s[12, i, j] / spacing[1]
    row[6] += AHEAD * leaves * m[i, j + 1]
    row[2] += HERE * leaves * m[i, j]
    row[5] -= BEHIND * leaves * m[i, j - 1]
    if j == 1:
        row[2] -= 0.5 * comes * m[i, 1]
        row[5] -= 0.5 * comes * m[i, 0]
    else:
        row[2] -= AHEAD * comes * m[i, j]
        row[5] -= HERE * comes * m[i, j - 1]
        row[4] += BEHIND * comes * m[i, j - 2]


@nb.njit(**COMPILE)
def _rows(
    s: FloatArray,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    storing: float,
    i: int,
    j: int,
    rows: FloatArray,
) -> None:
    """Derivatives (2, 7) of the balance of inner cell [i, j] with pressures, films held, and with films, at
    [i - 2 .. i + 1, j], then at [i, j - 2], [i, j - 1], [i, j + 1]."""
    dx, dy = spacing
    rows[:, :] = 0.0
    rows[0, 1] = -s[0, i - 1, j] / dx
    rows[0, 2] = (s[0, i, j] - s[1, i - 1, j]) / dx + (s[4, i, j] - s[5, i, j - 1]) / dy
    rows[0, 3] = s[1, i, j] / dx
    rows[0, 5] = -s[4, i, j - 1] / dy
    rows[0, 6] = s[5, i, j] / dy
    rows[1, 1] = -s[2, i - 1, j] / dx
    rows[1, 2] = (s[2, i, j] - s[3, i - 1, j]) / dx + (s[6, i, j] - s[7, i, j - 1]) / dy
    rows[1, 3] = s[3, i, j] / dx
    rows[1, 5] = -s[6, i, j - 1] / dy
    rows[1, 6] = s[7, i, j] / dy
    _dragged_row(s, s[10], i, j, spacing, drag[1] != 0.0, rows[0])
    _dragged_row(s, s[9], i, j, spacing, drag[1] != 0.0, rows[1])
    rows[0, 2] += 6.0 * storing * s[8, i, j] * s[10, i, j]
    rows[1, 2] += 6.0 * storing * s[8, i, j] * s[9, i, j]


@nb.njit(**COMPILE)
def own_flow(s: FloatArray, spacing: tuple[float, float], out: FloatArray) -> None:
    """Derivative of the pressure flow out of inner cells with their own pressure."""
    nx, ny = out.shape
    dx, dy = spacing
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            out[i, j] = (s[0, i, j] - s[1, i - 1, j]) / dx + (s[4, i, j] - s[5, i, j - 1]) / dy


@nb.njit(**COMPILE)
def _solve_band(matrix: FloatArray, right: FloatArray, n: int) -> None:
    """Gaussian elimination without exchange of rows: matrix (n, 2 BAND + 1), column BAND the diagonal."""
    for k in range(n):
        pivot = matrix[k, BAND]
        for i in range(k + 1, min(k + BAND + 1, n)):
            factor = matrix[i, BAND + k - i] / pivot
            if factor != 0.0:
                for c in range(k + 1, min(k + BAND + 1, n)):
                    matrix[i, BAND + c - i] -= factor * matrix[k, BAND + c - k]
                right[i] -= factor * right[k]
    for k in range(n - 1, -1, -1):
        total = right[k]
        for c in range(k + 1, min(k + BAND + 1, n)):
            total -= matrix[k, BAND + c - k] * right[c]
        right[k] = total / matrix[k, BAND]


@nb.njit(**COMPILE)
def _coupling(
    rows: FloatArray, near: FloatArray, spread: bool, weights: tuple[float, float], s: int, oblique: bool
) -> float:
    """Balance of a cell under a unit change, alone or spread, of the cell s further along the line."""
    value = 0.0
    for t in range(4):
        value += rows[1, t] * near[abs(t - 2 - s), 0]
    if oblique:
        value += rows[1, 4] * near[abs(s), 2] + (rows[1, 5] + rows[1, 6]) * near[abs(s), 1]
    for t in range(4):
        distance = abs(t - 2 - s)
        if distance == 0:
            value += rows[0, t]
        elif distance == 1 and spread:
            value -= weights[0] * rows[0, t]
    if s == 0 and spread:
        value -= weights[1] * (rows[0, 5] + rows[0, 6])
    return value


@nb.njit(**COMPILE)
def relax(  # reason: Numba compiles plain arrays; they are the parts of one equation
    stencil: FloatArray,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    storing: float,
    near: FloatArray,
    kinds: Any,
    residual: FloatArray,
    damping: tuple[float, float],
    downwards: bool,
    dp: FloatArray,
) -> None:
    """One sweep of line relaxation along x: `dp` is what it adds to the pressures for a residual.

    kinds : 0 held, 1 a change of its own, 2 a change with its counterpart on the four neighbours, so that what is
    far away hardly feels it (distributive relaxation; Brandt and Lubrecht 1990, Venner and Lubrecht 2000).
    near : (2, n, 3) films under a unit change of either kind at distances 0 .. along and 0 .. 2 across the line.
    """
    nx, ny = residual.shape
    dx, dy = spacing
    weights = (0.5 * dy * dy / (dx * dx + dy * dy), 0.5 * dx * dx / (dx * dx + dy * dy))
    oblique = drag[1] != 0.0
    matrix, right = np.zeros((nx, 2 * BAND + 1)), np.zeros(nx)
    rows = np.zeros((2, 7))
    dp[:, :] = 0.0
    for count in range(1, ny - 1):
        j = ny - 1 - count if downwards else count
        for i in range(nx):
            matrix[i, :] = 0.0
            right[i] = 0.0
            if kinds[i, j] == 0:
                matrix[i, BAND] = 1.0
                continue
            _rows(stencil, spacing, drag, storing, i, j, rows)
            right[i] = residual[i, j] - (rows[0, 6] * dp[i, j + 1] if downwards else rows[0, 5] * dp[i, j - 1])
            for s in range(max(-BAND, -i), min(BAND, nx - 1 - i) + 1):
                kind = kinds[i + s, j]
                if kind != 0:
                    matrix[i, BAND + s] = _coupling(rows, near[kind - 1], kind == 2, weights, s, oblique)
        _solve_band(matrix, right, nx)
        for i in range(1, nx - 1):
            if kinds[i, j] == 1:
                dp[i, j] += damping[0] * right[i]
            elif kinds[i, j] == 2:
                change = damping[1] * right[i]
                dp[i, j] += change
                dp[i - 1, j] -= weights[0] * change
                dp[i + 1, j] -= weights[0] * change
                dp[i, j - 1] -= weights[1] * change
                dp[i, j + 1] -= weights[1] * change


@nb.njit(**COMPILE)
def fill_rows(
    stencil: FloatArray,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    storing: float,
    by_pressure: FloatArray,
    by_film: FloatArray,
) -> None:
    """Matrices (n, n) of `applied` for changes of pressures and of films; they are zero before."""
    _, nx, ny = stencil.shape
    rows = np.zeros((2, 7))
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            _rows(stencil, spacing, drag, storing, i, j, rows)
            for t in range(7):
                k = i + t - 2 if t < 4 else i
                m = j if t < 4 else j + (t - 6 if t < 6 else 1)
                if k >= 0 and m >= 0:
                    by_pressure[i * ny + j, k * ny + m] += rows[0, t]
                    by_film[i * ny + j, k * ny + m] += rows[1, t]


@nb.njit(**COMPILE)
def carry_on(
    flow: FloatArray,
    content: FloatArray,
    full: Any,
    drag: tuple[float, float],
    spacing: tuple[float, float],
    share: FloatArray,
) -> None:
    """Share of the content of cells without pressure that is there: what comes in from full ones and from those
    upstream, over what would be dragged out of them full. Outermost cells take that of the cell before them."""
    nx, ny = content.shape
    dx, dy = spacing
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            if full[i, j]:
                continue
            comes = 0.0
            if full[i - 1, j]:
                comes += flow[0, i - 1, j] / dx
            else:
                comes += 6.0 * drag[0] * share[i - 1, j] * content[i - 1, j] / dx
            if full[i, j - 1]:
                comes += flow[1, i, j - 1] / dy
            else:
                comes += 6.0 * drag[1] * share[i, j - 1] * content[i, j - 1] / dy
            if full[i + 1, j]:
                comes -= flow[0, i, j] / dx
            if full[i, j + 1]:
                comes -= flow[1, i, j] / dy
            leaves = 6.0 * content[i, j] * (drag[0] / dx + drag[1] / dy)
            share[i, j] = min(max(comes / leaves, 0.0), 1.0)
    for i in range(nx):
        for j in range(ny):
            if not full[i, j] and (i == 0 or j == 0 or i == nx - 1 or j == ny - 1):
                share[i, j] = share[min(max(i, 1), nx - 2), min(max(j, 1), ny - 2)]
