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
derivatives with film and pressure; what is dragged through the faces along x, and along y (12 where none is).
"""

from __future__ import annotations

from typing import Any

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray

AHEAD, HERE, BEHIND = 0.375, 0.75, 0.125
"""Shares of the cells around a face in what is dragged through it."""


@compiled
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


@compiled
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


@compiled
def _dragged_flow(m: FloatArray, share: float, along_y: int, dragged: FloatArray) -> None:
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


@compiled
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


@compiled
def divergence(flow: FloatArray, spacing: tuple[float, float], out: FloatArray) -> None:
    """Balance of the inner cells under flows (2, nx, ny) through faces; outermost cells are left alone."""
    nx, ny = out.shape
    dx, dy = spacing
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            out[i, j] = (flow[0, i, j] - flow[0, i - 1, j]) / dx + (flow[1, i, j] - flow[1, i, j - 1]) / dy


@compiled
def add_dragged(drag: tuple[float, float], flow: FloatArray, stencil: FloatArray) -> None:
    """What is dragged through all faces, of the oil in `stencil[8]`, into the flow (2, nx, ny) and the stencil."""
    for axis in range(2):
        if drag[axis] != 0.0:
            _dragged_flow(stencil[8], drag[axis], axis, stencil[11 + axis])
            flow[axis] += stencil[11 + axis]


@compiled
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
    add_dragged(drag, flow, stencil)


@compiled
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


@compiled
def _shares(comes: float, leaves: float, first: bool) -> tuple[float, float, float, float]:
    """Derivatives of what is dragged out of a cell along an axis, less what is dragged in, with relative changes of
    the oil two cells upstream, one upstream, in the cell and downstream; of the first cell along the axis, whose oil
    comes from two cells alone."""
    if first:
        return 0.0, -BEHIND * leaves - 0.5 * comes, HERE * leaves - 0.5 * comes, AHEAD * leaves
    return BEHIND * comes, -BEHIND * leaves - HERE * comes, HERE * leaves - AHEAD * comes, AHEAD * leaves


@compiled
def fill_row(
    s: FloatArray,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    storing: float,
    along_y: int,
    upwind: bool,
    i: int,
    j: int,
    rows: FloatArray,
) -> None:
    """Derivatives (2, 7) of the balance of an inner cell with pressures, films held, and with films, at the cells - 2
    .. + 1 of its line, then at those - 2, - 1, + 1 across it: i along the line and j across, which is [i, j] of lines
    along x and [j, i] of those along y. upwind : whether what is dragged across lines is of the cell before alone.
    Plain numbers: parts of arrays, which are counted as they come and go, cost three times as much here."""
    x, y = 1.0 / spacing[along_y], 1.0 / spacing[1 - along_y]
    along, across = 4 * along_y, 4 - 4 * along_y
    e, f = (j, i) if along_y else (i, j)
    ei, ej, fi, fj = 1 - along_y, along_y, along_y, 1 - along_y
    ahead_i, ahead_j, back_i, back_j = e + ei, f + ej, e - ei, f - ej
    over_i, over_j, under_i, under_j = e + fi, f + fj, e - fi, f - fj
    # shares of those before the first cell are zero
    first_i, first_j = max(back_i - ei, 0), max(back_j - ej, 0)
    last_i, last_j = max(under_i - fi, 0), max(under_j - fj, 0)
    w0, w1, w2, w3, v0, v1, v3 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if drag[along_y] != 0.0:
        w0, w1, w2, w3 = _shares(s[11 + along_y, back_i, back_j] * x, s[11 + along_y, e, f] * x, i == 1)
    w2 += 6.0 * storing * s[8, e, f]
    if drag[1 - along_y] != 0.0:
        comes, leaves = s[12 - along_y, under_i, under_j] * y, s[12 - along_y, e, f] * y
        v2 = leaves
        if upwind:
            v1 = -comes
        else:
            v0, v1, v2, v3 = _shares(comes, leaves, j == 1)
        w2 += v2
    for by in range(2):
        c, b, oil = along + 2 * by, across + 2 * by, 10 - by
        rows[by, 0] = w0 * s[oil, first_i, first_j]
        rows[by, 1] = w1 * s[oil, back_i, back_j] - s[c, back_i, back_j] * x
        own = (s[c, e, f] - s[c + 1, back_i, back_j]) * x + (s[b, e, f] - s[b + 1, under_i, under_j]) * y
        rows[by, 2] = w2 * s[oil, e, f] + own
        rows[by, 3] = w3 * s[oil, ahead_i, ahead_j] + s[c + 1, e, f] * x
        rows[by, 4] = v0 * s[oil, last_i, last_j]
        rows[by, 5] = v1 * s[oil, under_i, under_j] - s[b, under_i, under_j] * y
        rows[by, 6] = v3 * s[oil, over_i, over_j] + s[b + 1, e, f] * y


@compiled
def own_flow(s: FloatArray, spacing: tuple[float, float], out: FloatArray) -> None:
    """Derivative of the pressure flow out of inner cells with their own pressure."""
    nx, ny = out.shape
    dx, dy = spacing
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            out[i, j] = (s[0, i, j] - s[1, i - 1, j]) / dx + (s[4, i, j] - s[5, i, j - 1]) / dy


@compiled
def fill_rows(
    stencil: FloatArray,
    spacing: tuple[float, float],
    drag: tuple[float, float],
    storing: float,
    matrix: Any,
    places: Any,
    by_film: FloatArray,
) -> None:
    """Derivatives of `applied`: with pressures added to `matrix`, (n, n) or more; with films `by_film` (n, 7), of the
    cells `places` (n, 7); both are zero before."""
    _, nx, ny = stencil.shape
    rows = np.zeros((2, 7))
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            fill_row(stencil, spacing, drag, storing, 0, False, i, j, rows)
            for t in range(7):
                k = i + t - 2 if t < 4 else i
                m = j if t < 4 else j + (t - 6 if t < 6 else 1)
                if k >= 0 and m >= 0:
                    matrix[i * ny + j, k * ny + m] += rows[0, t]
                    places[i * ny + j, t] = k * ny + m
                    by_film[i * ny + j, t] = rows[1, t]


@compiled
def add_deflected(places: Any, by_film: FloatArray, table: FloatArray, matrix: Any) -> None:
    """Add what pressures make of equations through films: derivatives with films (n, 7) of the cells `places` (n, 7),
    films `table` (nx, ny) under a unit pressure at distances 0 .. along x and y."""
    nx, ny = table.shape
    for row in range(places.shape[0]):
        for t in range(places.shape[1]):
            value = by_film[row, t]
            if value == 0.0:
                continue
            i, j = places[row, t] // ny, places[row, t] % ny
            for k in range(nx):
                for m in range(ny):
                    matrix[row, k * ny + m] += value * table[abs(i - k), abs(j - m)]


@compiled
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
