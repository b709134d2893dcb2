"""Reynolds' equation of a point contact on cells: fluxes through faces, their derivatives, and the balance of a cell.

Equations in similarity variables (`similarity`). The flux through the face between two neighbouring cells is

    F = -rho h^3/m dP/dx + 6 c rho h        (Poiseuille flow + Couette flow, entrainment c)

and the balance of a cell is div F; in time div F + 6 d(rho h)/dT, with d(rho h)/dT = storage_rate rho h + history
(`problem.TimeTerms`). Entrainment points to larger indices along both axes. Outermost cells have no balance.

Discretisation:

1. The fluidity 1/m of a face is the mean of exp(-ln m) with ln m linear between both cells.
2. h^3 of a face is that of a film with h linear between both cells: 1/mean(1/h^3) = 2 a^2 b^2/(a + b). Where one of the
   cells is thin, nothing flows past it. With ((a + b)/2)^3 oil passes constrictions as narrow as a cell: films have
   twice the error at M 200, L 5, and heavily loaded ellipses have no solution.
3. Couette flow is interpolated from two cells upstream and one downstream, (a^3 b^6/c)^(1/8) of the cells downstream,
   upstream and second upstream (third order; Leonard 1979, here of the logarithm). It is ten times as accurate as the
   second-order upwind scheme; like that scheme it admits no pressure oscillation where the oil is too viscous to flow.
   Without the logarithm the flux is negative where the film upstream is more than six times as thick, and 18 of 150
   random contacts have no solution on 48 cells a side (1 with it). Error of heavily loaded piezoviscous films on 192
   cells: 0.3 % at M 1000, L 10; 1.4 % of an ellipse with Rx/Ry 5.
4. Between rough walls (`bem.lubrication.flow_factors`) Poiseuille flow goes with phi h^3 and Couette flow with
   h + k s phi_s. The flow factor of a face is the harmonic mean of those of both cells: where contact bars one of them,
   nothing flows past it.

Arrays are [ix, iy]; face [i, j] lies between cell [i, j] and the next cell along its axis.

oil (4, nx, ny) : ln m and its derivative with pressure; rho and its derivative.
walls (6, nx, ny) : phi_x, phi_y and the Couette film, each with its derivative with the film.
derivatives (13, nx, ny) : of the Poiseuille flux along x with the pressure before and behind the face [0, 1] and with
both films [2, 3]; the same along y [4:8]; rho h [8] and its relative derivatives with film [9] and pressure [10]; the
Couette flux along x [11] and along y [12] (left out where no oil is entrained along y).

Verified in tests/lubrication/point/test_point_film.py and test_rough_point.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from bem.compiled import compiled, inlined
from bem.grid import FloatArray

DOWNSTREAM, UPSTREAM, SECOND_UPSTREAM = 0.375, 0.75, 0.125
"""Weights of the cells around a face in the Couette flux; that of the second cell upstream is subtracted."""


@compiled
def _mean_fluidity(first: float, second: float) -> tuple[float, float, float]:
    """Return the mean of exp(-ln m), ln m linear between two cells, and its derivatives with both ends."""
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
def _poiseuille_flux(
    p: FloatArray, h: FloatArray, oil: FloatArray, step: float, along_y: int, flux: FloatArray, derivatives: FloatArray
) -> None:
    """Compute the Poiseuille flux (nx, ny) through the faces along one axis and its derivatives (4, nx, ny)."""
    nx, ny = p.shape
    di, dj = 1 - along_y, along_y
    for i in range(nx - di):
        for j in range(ny - dj):
            k, n = i + di, j + dj
            phi, phi_left, phi_right = _mean_fluidity(oil[0, i, j], oil[0, k, n])
            left, right = h[i, j], h[k, n]
            total = left + right
            cube = 2.0 * (left * right) ** 2 / total
            density = 0.5 * (oil[2, i, j] + oil[2, k, n])
            gradient = (p[k, n] - p[i, j]) / step
            flux[i, j] = -density * cube * phi * gradient
            conductance = density * cube * phi / step
            drive = gradient * cube
            derivatives[0, i, j] = conductance - drive * (density * phi_left * oil[1, i, j] + 0.5 * phi * oil[3, i, j])
            derivatives[1, i, j] = -conductance - drive * (
                density * phi_right * oil[1, k, n] + 0.5 * phi * oil[3, k, n]
            )
            by_film = -2.0 * left * right * density * phi * gradient / (total * total)
            derivatives[2, i, j] = by_film * right * (left + 2.0 * right)
            derivatives[3, i, j] = by_film * left * (2.0 * left + right)


@compiled
def _apply_flow_factors(
    factor: FloatArray, slope: FloatArray, along_y: int, flux: FloatArray, derivatives: FloatArray
) -> None:
    """Multiply the Poiseuille flux along one axis and its derivatives by the flow factors (nx, ny) of rough walls."""
    nx, ny = factor.shape
    di, dj = 1 - along_y, along_y
    for i in range(nx - di):
        for j in range(ny - dj):
            k, n = i + di, j + dj
            left, right = factor[i, j], factor[k, n]
            total = left + right
            mean = 2.0 * left * right / total
            smooth = flux[i, j]
            derivatives[0, i, j] *= mean
            derivatives[1, i, j] *= mean
            derivatives[2, i, j] = mean * derivatives[2, i, j] + 2.0 * (right / total) ** 2 * slope[i, j] * smooth
            derivatives[3, i, j] = mean * derivatives[3, i, j] + 2.0 * (left / total) ** 2 * slope[k, n] * smooth
            flux[i, j] = mean * smooth


@compiled
def _couette_flux(oil_mass: FloatArray, speed: float, along_y: int, couette: FloatArray) -> None:
    """Compute the Couette flux (nx, ny) through the faces along one axis from rho h > 0 of the cells."""
    nx, ny = oil_mass.shape
    di, dj = 1 - along_y, along_y
    root = np.sqrt(np.sqrt(np.sqrt(oil_mass)))  # the weights are eighths
    for i in range(nx - di):
        for j in range(ny - dj):
            k, n = i + di, j + dj
            if i < di or j < dj:
                couette[i, j] = 6.0 * speed * np.sqrt(oil_mass[i, j] * oil_mass[k, n])
                continue
            upstream, downstream = root[i, j], root[k, n]
            cube = upstream * upstream * downstream
            couette[i, j] = 6.0 * speed * cube * cube * downstream * upstream * upstream / root[i - di, j - dj]


@compiled
def _add_couette_change(couette: FloatArray, relative: FloatArray, along_y: int, flux: FloatArray) -> None:
    """Add the change of the Couette flux under relative changes (nx, ny) of rho h."""
    nx, ny = relative.shape
    di, dj = 1 - along_y, along_y
    for i in range(nx - di):
        for j in range(ny - dj):
            downstream, upstream = relative[i + di, j + dj], relative[i, j]
            if i < di or j < dj:
                flux[i, j] += 0.5 * couette[i, j] * (upstream + downstream)
            else:
                second = relative[i - di, j - dj]
                flux[i, j] += couette[i, j] * (DOWNSTREAM * downstream + UPSTREAM * upstream - SECOND_UPSTREAM * second)


@compiled
def divergence(flux: FloatArray, spacing: tuple[float, float], out: FloatArray) -> None:
    """Compute the balance of inner cells from the fluxes (2, nx, ny); outermost cells stay as they are."""
    nx, ny = out.shape
    dx, dy = spacing
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            out[i, j] = (flux[0, i, j] - flux[0, i - 1, j]) / dx + (flux[1, i, j] - flux[1, i, j - 1]) / dy


@compiled
def _add_couette(entrainment: tuple[float, float], flux: FloatArray, derivatives: FloatArray) -> None:
    """Add the Couette flux of the oil `derivatives[8]` to the flux (2, nx, ny), and store it in `derivatives`."""
    for axis in range(2):
        if entrainment[axis] != 0.0:
            _couette_flux(derivatives[8], entrainment[axis], axis, derivatives[11 + axis])
            flux[axis] += derivatives[11 + axis]


@inlined
def _add_couette_of(
    couette_film: FloatArray,
    oil: FloatArray,
    entrainment: tuple[float, float],
    flux: FloatArray,
    derivatives: FloatArray,
) -> None:
    """Add the Couette flux of a Couette film (nx, ny), and store the mass and its relative change with pressure."""
    derivatives[8] = oil[2] * couette_film
    derivatives[10] = oil[3] / oil[2]
    _add_couette(entrainment, flux, derivatives)


@compiled
def smooth_wall_flux(
    p: FloatArray,
    h: FloatArray,
    oil: FloatArray,
    spacing: tuple[float, float],
    entrainment: tuple[float, float],
    flux: FloatArray,
    derivatives: FloatArray,
) -> None:
    """Compute the flux (2, nx, ny) through all faces between smooth walls, and its derivatives."""
    _poiseuille_flux(p, h, oil, spacing[0], 0, flux[0], derivatives[0:4])
    _poiseuille_flux(p, h, oil, spacing[1], 1, flux[1], derivatives[4:8])
    derivatives[9] = 1.0 / h
    _add_couette_of(h, oil, entrainment, flux, derivatives)


@compiled
def rough_wall_flux(
    p: FloatArray,
    h: FloatArray,
    oil: FloatArray,
    walls: FloatArray,
    spacing: tuple[float, float],
    entrainment: tuple[float, float],
    flux: FloatArray,
    derivatives: FloatArray,
) -> None:
    """Compute the flux (2, nx, ny) through all faces between rough walls, and its derivatives."""
    _poiseuille_flux(p, h, oil, spacing[0], 0, flux[0], derivatives[0:4])
    _apply_flow_factors(walls[0], walls[1], 0, flux[0], derivatives[0:4])
    _poiseuille_flux(p, h, oil, spacing[1], 1, flux[1], derivatives[4:8])
    _apply_flow_factors(walls[2], walls[3], 1, flux[1], derivatives[4:8])
    derivatives[9] = walls[5] / walls[4]
    _add_couette_of(walls[4], oil, entrainment, flux, derivatives)


@inlined
def _poiseuille_change(
    s: FloatArray, first: int, i: int, j: int, k: int, n: int, dp: FloatArray, dh: FloatArray
) -> float:
    """Return the change of the Poiseuille flux through the face between cells [i, j] and [k, n].

    first : index of the axis' first derivative in `s`; see the module.
    """
    by_film = s[first + 2, i, j] * dh[i, j] + s[first + 3, i, j] * dh[k, n]
    return s[first, i, j] * dp[i, j] + s[first + 1, i, j] * dp[k, n] + by_film


@compiled
def apply_jacobian(
    derivatives: FloatArray,
    spacing: tuple[float, float],
    entrainment: tuple[float, float],
    storage_rate: float,
    dp: FloatArray,
    dh: FloatArray,
    out: FloatArray,
) -> None:
    """Compute the change of the balance of inner cells under changes of pressure and film (nx, ny)."""
    nx, ny = dp.shape
    flux = np.zeros((2, nx, ny))
    s = derivatives
    for i in range(nx):
        for j in range(ny):
            if i < nx - 1:
                flux[0, i, j] = _poiseuille_change(s, 0, i, j, i + 1, j, dp, dh)
            if j < ny - 1:
                flux[1, i, j] = _poiseuille_change(s, 4, i, j, i, j + 1, dp, dh)
    relative = s[9] * dh + s[10] * dp
    for axis in range(2):
        if entrainment[axis] != 0.0:
            _add_couette_change(s[11 + axis], relative, axis, flux[axis])
    divergence(flux, spacing, out)
    if storage_rate != 0.0:
        for i in range(1, nx - 1):
            for j in range(1, ny - 1):
                out[i, j] += 6.0 * storage_rate * s[8, i, j] * relative[i, j]


@compiled
def _couette_weights(inflow: float, outflow: float, first: bool) -> tuple[float, float, float, float]:
    """Return the derivatives of the net Couette outflow of a cell with relative changes of rho h.

    Cells, in this order: second upstream, upstream, the cell itself, downstream. The face before the `first` inner cell
    of a line has the mean of two cells.
    """
    if first:
        return 0.0, -SECOND_UPSTREAM * outflow - 0.5 * inflow, UPSTREAM * outflow - 0.5 * inflow, DOWNSTREAM * outflow
    return (
        SECOND_UPSTREAM * inflow,
        -SECOND_UPSTREAM * outflow - UPSTREAM * inflow,
        UPSTREAM * outflow - DOWNSTREAM * inflow,
        DOWNSTREAM * outflow,
    )


@compiled
def jacobian_row(
    s: FloatArray,
    spacing: tuple[float, float],
    entrainment: tuple[float, float],
    storage_rate: float,
    along_y: int,
    upwind_across: bool,
    i: int,
    j: int,
    rows: FloatArray,
) -> None:
    """Compute the derivatives of the balance of one inner cell with pressures and with films of its neighbours.

    Scalars in place of array slices, whose reference counts would triple the time.

    Parameters
    ----------
    s : derivatives of the flux, see the module.
    spacing, entrainment : of the cells, and components of the entrainment, along x and y.
    storage_rate : weight of the storage d(rho h)/dT in the balance; zero of steady films.
    along_y : 1 for a cell of a line along y, 0 along x.
    upwind_across : whether Couette flow across the lines is of first order, from the cell upstream alone.
    i, j : index along the line and number of the line: cell [i, j] of lines along x, [j, i] of lines along y.
    rows : (2, 7) result, with pressures (films fixed) and with films; cells -2, -1, 0, +1 along the line, then -2, -1,
        +1 across it.
    """
    x, y = 1.0 / spacing[along_y], 1.0 / spacing[1 - along_y]
    along, across = 4 * along_y, 4 - 4 * along_y
    e, f = (j, i) if along_y else (i, j)
    ei, ej, fi, fj = 1 - along_y, along_y, along_y, 1 - along_y
    ahead_i, ahead_j, back_i, back_j = e + ei, f + ej, e - ei, f - ej
    over_i, over_j, under_i, under_j = e + fi, f + fj, e - fi, f - fj
    # before the first cell the weights are zero, any index does
    first_i, first_j = max(back_i - ei, 0), max(back_j - ej, 0)
    last_i, last_j = max(under_i - fi, 0), max(under_j - fj, 0)
    w0, w1, w2, w3, v0, v1, v3 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    if entrainment[along_y] != 0.0:
        w0, w1, w2, w3 = _couette_weights(s[11 + along_y, back_i, back_j] * x, s[11 + along_y, e, f] * x, i == 1)
    w2 += 6.0 * storage_rate * s[8, e, f]
    if entrainment[1 - along_y] != 0.0:
        inflow, outflow = s[12 - along_y, under_i, under_j] * y, s[12 - along_y, e, f] * y
        v2 = outflow
        if upwind_across:
            v1 = -inflow
        else:
            v0, v1, v2, v3 = _couette_weights(inflow, outflow, j == 1)
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
def poiseuille_diagonal(s: FloatArray, spacing: tuple[float, float], out: FloatArray) -> None:
    """Compute the derivative of the Poiseuille outflow of inner cells with their own pressure."""
    nx, ny = out.shape
    dx, dy = spacing
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            out[i, j] = (s[0, i, j] - s[1, i - 1, j]) / dx + (s[4, i, j] - s[5, i, j - 1]) / dy


@compiled
def fill_jacobian(
    derivatives: FloatArray,
    spacing: tuple[float, float],
    entrainment: tuple[float, float],
    storage_rate: float,
    matrix: Any,
    columns: Any,
    by_film: FloatArray,
) -> None:
    """Assemble the Jacobian of `apply_jacobian`, n cells, into arrays of zeros.

    Parameters
    ----------
    derivatives : of the flux, see the module.
    spacing, entrainment, storage_rate : of `jacobian_row`.
    matrix : (n, n) or larger; derivatives with pressures, films fixed, are added to it.
    columns, by_film : (n, 7) cells of the films that a balance depends on, and derivatives with those films.
    """
    _, nx, ny = derivatives.shape
    rows = np.zeros((2, 7))
    for i in range(1, nx - 1):
        for j in range(1, ny - 1):
            jacobian_row(derivatives, spacing, entrainment, storage_rate, 0, False, i, j, rows)
            for t in range(7):
                k = i + t - 2 if t < 4 else i
                m = j if t < 4 else j + (t - 6 if t < 6 else 1)
                if k >= 0 and m >= 0:
                    matrix[i * ny + j, k * ny + m] += rows[0, t]
                    columns[i * ny + j, t] = k * ny + m
                    by_film[i * ny + j, t] = rows[1, t]


@compiled
def add_deflection(columns: Any, by_film: FloatArray, influence: FloatArray, matrix: Any) -> None:
    """Add the derivatives with pressures through the elastic deflection, by_film x influence, to a matrix (n, n).

    Parameters
    ----------
    columns, by_film : (n, 7) of `fill_jacobian`.
    influence : (nx, ny) deflection under a unit pressure at distances 0, 1, ... along x and y.
    matrix : (n, n) or larger, changed in place.
    """
    nx, ny = influence.shape
    for row in range(columns.shape[0]):
        for t in range(columns.shape[1]):
            value = by_film[row, t]
            if value == 0.0:
                continue
            i, j = columns[row, t] // ny, columns[row, t] % ny
            for k in range(nx):
                for m in range(ny):
                    matrix[row, k * ny + m] += value * influence[abs(i - k), abs(j - m)]
