"""Remainder of the influence coefficients of a layered body: integrals of radial tables over the cells of a grid.

A unit load at the origin of a layered body gives, with S_n the Hankel transforms of `hankel` and phi the angle
from x to the point,

    pressure:   uz = S0                     traction:   uz = -cos(phi) S1
                xx = C0 - cos(2 phi) D2                 xx = -cos(phi) X1 + cos(3 phi) W3
                yy = C0 + cos(2 phi) D2                 yy = -cos(phi) Y1 - cos(3 phi) W3
                zz = A0                                 zz = -cos(phi) A1
                yz = -sin(phi) B1                       yz = sin(2 phi) B2
                xz = -cos(phi) B1                       xz = B0 + cos(2 phi) B2
                xy = -sin(2 phi) D2                     xy = -sin(phi) (X1 - Y1)/2 + sin(3 phi) W3

and in the plane, under traction along x and y,

    xx = I0 - cos(2 phi) I2        yy = I0 + cos(2 phi) I2        xy = yx = -sin(2 phi) I2.

The functions are analytic on the scale hypot(r, d), d the decay length of the table. Each axis has a Gauss rule of its
own (`_gauss_rules`): the smallest whose error is below 1e-13 for the ratio of D to half the side, from 2 points far
away to 16, where D is the length of (offset of the centre along this axis, clear distance of the cell along the other,
d). If none is accurate enough for a side, the cell is cut in halves along it. Near the origin of a layer much thinner
than a cell the pieces shrink geometrically, so any ratio of thickness to cell works.
"""

from __future__ import annotations

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray, Grid
from bem.kernels.blocks import BLOCK, Six, add_six
from bem.kernels.layered.hankel import (
    RadialTable,
    evaluate,
    in_plane_spectra,
    panel_of,
    radial_table,
    stress_spectra,
    surface_spectra,
)
from bem.kernels.loads import IN_PLANE_PARITY, STRESS_PARITY, SURFACE_PARITY, Load, clear_odd_offsets
from bem.materials import Body

# points n of each rule, and the least ratio R of D to half a side: (R + sqrt(R^2 - 1))^(-2 n) is 1e-15 for large n (the
# order of the singularity costs a factor), 1e-13 for small n, used where the response is small
_POINTS = np.array([2, 3, 4, 5, 6, 8, 10, 12, 16])
_MIN_RATIO = np.array([900.0, 100.0, 30.0, 15.0, 8.9, 4.4, 2.9, 2.2, 1.64])
# largest product kappa of half a side and the wavenumber of ripples: a rule errs by 1e-12 of the ripples there,
# 4^n n!^4 / ((2n+1) (2n)!^3) kappa^(2n)
_MAX_RIPPLE = np.array([4e-3, 0.055, 0.22, 0.54, 1.02, 2.3, 4.1, 6.1, 10.7])
_MAX_POINTS = int(_POINTS.max())
_NODES = np.zeros((_POINTS.size, _MAX_POINTS))
_WEIGHTS = np.zeros((_POINTS.size, _MAX_POINTS))
for _row, _n in enumerate(_POINTS):
    _NODES[_row, :_n], _WEIGHTS[_row, :_n] = np.polynomial.legendre.leggauss(int(_n))

SURFACE_NORMAL, SURFACE_TANGENTIAL, STRESS_NORMAL, STRESS_TANGENTIAL, IN_PLANE = range(5)
"""Kind of response: its number of tables, and the angular terms of its components (see the module)."""
SURFACE_KIND = {Load.NORMAL: SURFACE_NORMAL, Load.TANGENTIAL: SURFACE_TANGENTIAL}
STRESS_KIND = {Load.NORMAL: STRESS_NORMAL, Load.TANGENTIAL: STRESS_TANGENTIAL}


@compiled
def _direction(x: float, y: float, r: float) -> tuple[float, float]:
    """Return cosine and sine of the angle of (x, y) from x; zero at the origin, where their factors vanish."""
    r = max(r, 1e-300)
    return x / r, y / r


@compiled
def _stress_under_pressure(c: float, s: float, g0: float, g1: float, g2: float, g3: float) -> Six:
    """Return the six stresses under pressure from the direction and the tables A0, B1, C0, D2."""
    c2, s2 = (c - s) * (c + s), 2.0 * s * c
    return g2 - c2 * g3, g2 + c2 * g3, g0, -s * g1, -c * g1, -s2 * g3


@compiled
def _stress_under_traction(c: float, s: float, g0: float, g1: float, g2: float, g3: float, g4: float, g5: float) -> Six:
    """Return the six stresses under traction from the direction and the tables A1, B0, B2, X1, Y1, W3."""
    c2, s2 = (c - s) * (c + s), 2.0 * s * c
    c3, s3 = c2 * c - s2 * s, s2 * c + c2 * s
    xy = s3 * g5 - 0.5 * s * (g3 - g4)
    return c3 * g5 - c * g3, -(c3 * g5 + c * g4), -c * g0, s2 * g2, g1 + c2 * g2, xy


@compiled
def _add_point(kind: int, x: float, y: float, r: float, g: FloatArray, weight: float, out: FloatArray) -> None:
    """Add `weight` times the response at (x, y) to `out` (components,); `g` (tables,): the tables at r."""
    if kind == SURFACE_NORMAL:
        out[0] += weight * g[0]
        return
    c, s = _direction(x, y, r)
    if kind == SURFACE_TANGENTIAL:
        out[0] -= weight * c * g[0]
        return
    if kind == IN_PLANE:
        c2, s2 = (c - s) * (c + s), 2.0 * s * c
        out[0] += weight * (g[0] - c2 * g[1])
        out[1] += weight * (g[0] + c2 * g[1])
        out[2] -= weight * s2 * g[1]
        return
    if kind == STRESS_NORMAL:
        stress = _stress_under_pressure(c, s, g[0], g[1], g[2], g[3])
    else:
        stress = _stress_under_traction(c, s, g[0], g[1], g[2], g[3], g[4], g[5])
    for component in range(6):
        out[component] += weight * stress[component]


# Cells of a row that share a Gauss rule are integrated together in vector registers, with the operations of `_add_cell`
# in the same order for each cell. `scratch` holds rows of `BLOCK` numbers (a constant, so that the compiler
# vectorises): sums of six components, y of the cells; y, r and t (position in the panel) of the points; six tables at
# the points.
_CELL, _Y, _R, _T, _G = 6 * BLOCK, 7 * BLOCK, 8 * BLOCK, 9 * BLOCK, 10 * BLOCK
_SUM = 16 * BLOCK
_SCRATCH = 17 * BLOCK


@compiled
def _add_points_of_panel(
    kind: int, x: float, count: int, tables: int, panel: FloatArray, weight: float, scratch: FloatArray
) -> None:
    """Add `weight` times the response at `count` points that share x and a panel of r to their sums.

    panel : (powers, tables), coefficients of the panel.
    scratch : rows of a block, see above; y, r and t of the points are read.
    """
    highest = panel.shape[0] - 1
    for table in range(tables):
        value = panel[highest, table]
        for k in range(count):
            scratch[_SUM + k] = value
        for power in range(highest - 1, -1, -1):
            value = panel[power, table]
            for k in range(count):
                scratch[_SUM + k] = scratch[_SUM + k] * scratch[_T + k] + value
        at = _G + table * BLOCK
        for k in range(count):
            scratch[at + k] = scratch[_SUM + k]
    if kind == SURFACE_NORMAL:
        for k in range(count):
            scratch[k] += weight * scratch[_G + k]
    elif kind == SURFACE_TANGENTIAL:
        for k in range(count):
            c, _ = _direction(x, scratch[_Y + k], scratch[_R + k])
            scratch[k] -= weight * c * scratch[_G + k]
    elif kind == IN_PLANE:
        for k in range(count):
            c, s = _direction(x, scratch[_Y + k], scratch[_R + k])
            even, turned = weight * scratch[_G + k], weight * scratch[_G + BLOCK + k]
            c2, s2 = (c - s) * (c + s), 2.0 * s * c
            scratch[k] += even - c2 * turned
            scratch[BLOCK + k] += even + c2 * turned
            scratch[2 * BLOCK + k] -= s2 * turned
    elif kind == STRESS_NORMAL:
        for k in range(count):
            c, s = _direction(x, scratch[_Y + k], scratch[_R + k])
            stress = _stress_under_pressure(
                c, s, scratch[_G + k], scratch[_G + BLOCK + k], scratch[_G + 2 * BLOCK + k], scratch[_G + 3 * BLOCK + k]
            )
            add_six(weight, stress, k, scratch)
    else:
        for k in range(count):
            c, s = _direction(x, scratch[_Y + k], scratch[_R + k])
            stress = _stress_under_traction(
                c, s, scratch[_G + k], scratch[_G + BLOCK + k], scratch[_G + 2 * BLOCK + k],
                scratch[_G + 3 * BLOCK + k], scratch[_G + 4 * BLOCK + k], scratch[_G + 5 * BLOCK + k],
            )  # fmt: skip
            add_six(weight, stress, k, scratch)


@compiled
def _add_block(
    kind: int,
    x: float,
    a: float,
    b: float,
    along_x: int,
    along_y: int,
    count: int,
    table: RadialTable,
    scratch: FloatArray,
) -> None:
    """Add the integrals over the first `count` cells of a block, all at `x`, to its sums."""
    edges, coefficients = table.edges, table.coefficients
    end = edges[-1]
    for i in range(_POINTS[along_x]):
        px = x + a * _NODES[along_x, i]
        for j in range(_POINTS[along_y]):
            shift = b * _NODES[along_y, j]
            weight = a * b * _WEIGHTS[along_x, i] * _WEIGHTS[along_y, j]
            for k in range(count):
                py = scratch[_CELL + k] + shift
                scratch[_Y + k] = py
                scratch[_R + k] = np.sqrt(px * px + py * py)
            start = 0
            while start < count:
                r = scratch[_R + start]
                stop = start + 1
                if r < end:
                    low = panel_of(r, edges)
                    lower, upper = edges[low], edges[low + 1]
                    while stop < count and lower <= scratch[_R + stop] < upper:
                        stop += 1
                    part = scratch[start:]  # loops that count from zero are vectorised
                    for k in range(stop - start):
                        part[_T + k] = (2.0 * part[_R + k] - lower - upper) / (upper - lower)
                    tables = coefficients.shape[2]
                    _add_points_of_panel(kind, px, stop - start, tables, coefficients[low], weight, part)
                start = stop


@compiled
def _gauss_rule_for(ratio: float, ripple: float, fall: float) -> int:
    """Return the row of the smallest Gauss rule that is accurate enough; the number of rules if none is.

    ratio : D over half a side.
    ripple : wavenumber of the table's ripples times half a side; 0 without ripples.
    fall : the ripples have an amplitude of exp(-fall).
    """
    row = 0
    while row < _POINTS.size and ratio < _MIN_RATIO[row]:
        row += 1
    if ripple > 0.0:
        while row < _POINTS.size and ripple * np.exp(-0.5 * fall / _POINTS[row]) > _MAX_RIPPLE[row]:
            row += 1
    return row


@compiled
def _gauss_rules(x: float, y: float, a: float, b: float, table: RadialTable) -> tuple[int, int]:
    """Return the Gauss rules along x and y for a piece of half sides a, b at (x, y).

    (-1, -1) where the whole piece lies beyond the end of the table.
    """
    gap_x, gap_y = max(abs(x) - a, 0.0), max(abs(y) - b, 0.0)
    decay, wavenumber, width, end = table.decay, table.wavenumber, table.width, table.edges[-1]
    if gap_x * gap_x + gap_y * gap_y >= end * end:
        return -1, -1
    fall = width * width * (gap_x * gap_x + gap_y * gap_y)
    along_x = _gauss_rule_for(np.sqrt(x * x + gap_y * gap_y + decay * decay) / a, wavenumber * a, fall)
    along_y = _gauss_rule_for(np.sqrt(y * y + gap_x * gap_x + decay * decay) / b, wavenumber * b, fall)
    return along_x, along_y


@compiled
def _add_cell(
    kind: int,
    x: float,
    y: float,
    half_x: float,
    half_y: float,
    table: RadialTable,
    stack: FloatArray,
    g: FloatArray,
    out: FloatArray,
) -> None:
    """Add the integral over the cell centred at (x, y), cut in pieces where needed, to `out` (components,).

    stack : (pieces, 4), scratch for pieces; g : (tables,), scratch.
    """
    end = table.edges[-1]
    stack[0, 0], stack[0, 1], stack[0, 2], stack[0, 3] = x, y, half_x, half_y
    height = 1
    while height > 0:
        height -= 1
        x0, y0, a, b = stack[height, 0], stack[height, 1], stack[height, 2], stack[height, 3]
        along_x, along_y = _gauss_rules(x0, y0, a, b, table)
        if along_x < 0:
            continue
        split_x, split_y = along_x == _POINTS.size, along_y == _POINTS.size
        if split_x or split_y:  # halve each side that is too long
            parts_x, parts_y = (2 if split_x else 1), (2 if split_y else 1)
            for i in range(parts_x):
                for j in range(parts_y):
                    stack[height, 2], stack[height, 3] = a / parts_x, b / parts_y
                    stack[height, 0] = x0 + (i - 0.5) * a if split_x else x0
                    stack[height, 1] = y0 + (j - 0.5) * b if split_y else y0
                    height += 1
            continue
        for i in range(_POINTS[along_x]):
            px = x0 + a * _NODES[along_x, i]
            for j in range(_POINTS[along_y]):
                py = y0 + b * _NODES[along_y, j]
                r = np.sqrt(px * px + py * py)
                if r < end:
                    evaluate(r, table.edges, table.coefficients, g)
                    _add_point(kind, px, py, r, g, a * b * _WEIGHTS[along_x, i] * _WEIGHTS[along_y, j], out)


@compiled
def _add_cells(
    kind: int,
    sides: tuple[float, float],
    period: tuple[int, int],
    images: tuple[int, int],
    table: RadialTable,
    out: FloatArray,
) -> None:
    """Add the integrals over the cells [i, j] of `out` (components, nx, ny) and their images, `period` cells apart."""
    components, nx, ny = out.shape
    stack = np.empty((400, 4))
    g = np.empty(table.coefficients.shape[2])
    scratch = np.zeros(_SCRATCH)
    row = np.empty((components, ny))
    a, b = 0.5 * sides[0], 0.5 * sides[1]
    for i in range(nx):
        row[:] = 0.0
        for p in range(-images[0], images[0] + 1):
            x = (i + p * period[0]) * sides[0]
            for q in range(-images[1], images[1] + 1):
                start = 0
                while start < ny:
                    y = (start + q * period[1]) * sides[1]
                    rules = _gauss_rules(x, y, a, b, table)
                    if max(rules) == _POINTS.size or max(rules) < 0:
                        _add_cell(kind, x, y, a, b, table, stack, g, row[:, start])
                        start += 1
                        continue
                    count = 0
                    while count < BLOCK and start + count < ny:
                        y = (start + count + q * period[1]) * sides[1]
                        if _gauss_rules(x, y, a, b, table) != rules:
                            break
                        scratch[_CELL + count] = y
                        count += 1
                    for c in range(components):
                        for k in range(count):
                            scratch[c * BLOCK + k] = row[c, start + k]
                    _add_block(kind, x, a, b, *rules, count, table, scratch)
                    for c in range(components):
                        for k in range(count):
                            row[c, start + k] = scratch[c * BLOCK + k]
                    start += count
        out[:, i] += row


def add_cells(out: FloatArray, grid: Grid, table: RadialTable, kind: int, images: tuple[int, int] = (0, 0)) -> None:
    """Add the integrals of a response over the cells, and over their images on either side, to `out`.

    out : (components, n, m), offsets from 0 along both axes; it may cover a part of the grid.
    kind : kind of response.
    images : number of images on either side along x and y.
    """
    _add_cells(kind, grid.spacing, grid.shape, images, table, out)


def surface_remainder(grid: Grid, body: Body, load: Load) -> FloatArray:
    """Compute the remainder of the normal surface displacement: (nx, ny) [m/Pa].

    It is the displacement of the layered body less that of a half-space of the outermost material; see
    `coefficients.surface_coefficients`.
    """
    out = np.zeros((1, *grid.shape))
    add_cells(out, grid, radial_table(surface_spectra(body, load), _diagonal(grid)), SURFACE_KIND[load])
    return clear_odd_offsets(out, (SURFACE_PARITY[load],))[0]


def in_plane_remainder(grid: Grid, body: Body) -> FloatArray:
    """Compute the remainder of the in-plane displacements: (3, nx, ny) [m/Pa]; see `coefficients`."""
    out = np.zeros((3, *grid.shape))
    add_cells(out, grid, radial_table(in_plane_spectra(body), _diagonal(grid)), IN_PLANE)
    return clear_odd_offsets(out, IN_PLANE_PARITY)


def stress_remainder(grid: Grid, body: Body, depth: float, load: Load) -> FloatArray:
    """Compute the six stresses at `depth` [m]: the remainder in the outermost layer, else the whole.

    (6, nx, ny) [Pa/Pa]; see `coefficients`.
    """
    out = np.zeros((6, *grid.shape))
    add_cells(out, grid, radial_table(stress_spectra(body, depth, load), _diagonal(grid)), STRESS_KIND[load])
    return clear_odd_offsets(out, STRESS_PARITY[load])


def _diagonal(grid: Grid) -> float:
    """Return the largest distance between two points of the grid [m]."""
    return float(np.hypot(*grid.lengths))
