"""Reynolds' equation of a point contact on cells, its derivatives and line relaxation: compiled loops over arrays.

In similarity units (`scales`), with the flow between neighbouring cells

    F = -rho h^3/m dP/dx + 6 c rho h

the balance of a cell is div F, in time div F + 6 d(rho h)/dT with d(rho h)/dT = `storing` rho h + what was there
(`InTime`). Fluidity 1/m is its mean between the two pressures. What is dragged is interpolated from
two cells upstream and one downstream (third order; Leonard 1979): films were ten times as accurate as with the two
upstream ones, and there still is no wave of pressure that the oil does not feel where it is too viscous to flow.
Entrainment c points to larger indices along both axes. Outermost cells hold no balance.

Arrays are [ix, iy]; a face [i, j] lies between cell [i, j] and the next one along its axis. `oil` (4, nx, ny): ln m and
its slope with pressure, rho and its slope. `stencil` (8, nx, ny): derivatives of the pressure flow through the faces
along x with the pressure on the left, on the right, and with either film; the same along y; derivatives of rho h with
film and pressure.
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
def _pressure_flow(
    p: FloatArray, h: FloatArray, oil: FloatArray, step: float, along_y: int, flow: FloatArray, stencil: FloatArray
) -> None:
    """Pressure flow through the faces along one axis, and its derivatives (3, nx, ny)."""
    nx, ny = p.shape
    di, dj = 1 - along_y, along_y
    for i in range(nx - di):
        for j in range(ny - dj):
            k, n = i + di, j + dj
            phi, phi_left, phi_right = _mean_fluidity(oil[0, i, j], oil[0, k, n])
            thick = 0.5 * (h[i, j] + h[k, n])
            dense = 0.5 * (oil[2, i, j] + oil[2, k, n])
            cube = thick * thick * thick
            gradient = (p[k, n] - p[i, j]) / step
            flow[i, j] = -dense * cube * phi * gradient
            a = dense * cube * phi / step
            steep = gradient * cube
            stencil[0, i, j] = a - steep * (dense * phi_left * oil[1, i, j] + 0.5 * phi * oil[3, i, j])
            stencil[1, i, j] = -a - steep * (dense * phi_right * oil[1, k, n] + 0.5 * phi * oil[3, k, n])
            stencil[2, i, j] = -1.5 * dense * thick * thick * phi * gradient


@nb.njit(**COMPILE)
def _drag(m: FloatArray, share: float, along_y: int, flow: FloatArray) -> None:
    """Add what is dragged through the faces along one axis."""
    if share == 0.0:
        return
    nx, ny = m.shape
    if along_y:
        for i in range(nx):
            flow[i, 0] += 3.0 * share * (m[i, 0] + m[i, 1])
            for j in range(1, ny - 1):
                flow[i, j] += 6.0 * share * (AHEAD * m[i, j + 1] + HERE * m[i, j] - BEHIND * m[i, j - 1])
        return
    for j in range(ny):
        flow[0, j] += 3.0 * share * (m[0, j] + m[1, j])
    for i in range(1, nx - 1):
        for j in range(ny):
            flow[i, j] += 6.0 * share * (AHEAD * m[i + 1, j] + HERE * m[i, j] - BEHIND * m[i - 1, j])


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
    _pressure_flow(p, h, oil, spacing[0], 0, flow[0], stencil[0:3])
    _pressure_flow(p, h, oil, spacing[1], 1, flow[1], stencil[3:6])
    m = oil[2] * h
    _drag(m, drag[0], 0, flow[0])
    _drag(m, drag[1], 1, flow[1])
    stencil[6] = oil[2]
    stencil[7] = oil[3] * h


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
                films = dh[i, j] + dh[i + 1, j]
                flow[0, i, j] = s[0, i, j] * dp[i, j] + s[1, i, j] * dp[i + 1, j] + s[2, i, j] * films
            if j < ny - 1:
                films = dh[i, j] + dh[i, j + 1]
                flow[1, i, j] = s[3, i, j] * dp[i, j] + s[4, i, j] * dp[i, j + 1] + s[5, i, j] * films
    m = s[6] * dh + s[7] * dp
    _drag(m, drag[0], 0, flow[0])
    _drag(m, drag[1], 1, flow[1])
    divergence(flow, spacing, out)
    if storing != 0.0:
        for i in range(1, nx - 1):
            for j in range(1, ny - 1):
                out[i, j] += 6.0 * storing * m[i, j]


@nb.njit(**COMPILE)
def _dragged_row(m: FloatArray, i: int, j: int, wedge: float, across: float, row: FloatArray) -> None:
    """Add derivatives of what is dragged, rho h = m times an unknown, to a row: unknowns at [i - 2 .. i + 1, j], then
    at [i, j - 2], [i, j - 1], [i, j + 1]."""
    row[3] += AHEAD * wedge * m[i + 1, j]
    if i == 1:
        row[1] -= (BEHIND + 0.5) * wedge * m[0, j]
        row[2] += (HERE - 0.5) * wedge * m[1, j]
    else:
        row[0] += BEHIND * wedge * m[i - 2, j]
        row[1] -= (HERE + BEHIND) * wedge * m[i - 1, j]
        row[2] += (HERE - AHEAD) * wedge * m[i, j]
    if across == 0.0:
        return
    row[6] += AHEAD * across * m[i, j + 1]
    if j == 1:
        row[5] -= (BEHIND + 0.5) * across * m[i, 0]
        row[2] += (HERE - 0.5) * across * m[i, 1]
    else:
        row[4] += BEHIND * across * m[i, j - 2]
        row[5] -= (HERE + BEHIND) * across * m[i, j - 1]
        row[2] += (HERE - AHEAD) * across * m[i, j]


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
    rows[0, 2] = (s[0, i, j] - s[1, i - 1, j]) / dx + (s[3, i, j] - s[4, i, j - 1]) / dy
    rows[0, 3] = s[1, i, j] / dx
    rows[0, 5] = -s[3, i, j - 1] / dy
    rows[0, 6] = s[4, i, j] / dy
    rows[1, 1] = -s[2, i - 1, j] / dx
    rows[1, 2] = (s[2, i, j] - s[2, i - 1, j]) / dx + (s[5, i, j] - s[5, i, j - 1]) / dy
    rows[1, 3] = s[2, i, j] / dx
    rows[1, 5] = -s[5, i, j - 1] / dy
    rows[1, 6] = s[5, i, j] / dy
    wedge, across = 6.0 * drag[0] / dx, 6.0 * drag[1] / dy
    _dragged_row(s[7], i, j, wedge, across, rows[0])
    _dragged_row(s[6], i, j, wedge, across, rows[1])
    rows[0, 2] += 6.0 * storing * s[7, i, j]
    rows[1, 2] += 6.0 * storing * s[6, i, j]


@nb.njit(**COMPILE)
def own_flow(s: FloatArray, spacing: tuple[float, float], out: FloatArray) -> None:
    """Derivative of the pressure flow out of inner cells with their own pressure."""
    nx, ny = out.shape
    dx, dy = spacing
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            out[i, j] = (s[0, i, j] - s[1, i - 1, j]) / dx + (s[3, i, j] - s[4, i, j - 1]) / dy


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
