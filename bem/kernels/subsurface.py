"""Six stresses in an elastic half-space below a uniformly loaded rectangle, at any depth from the surface down.

With the potentials V, chi and F of `half_space` (Love, *Phil. Trans.* A 228 (1929) 377; Johnson (1985), eq. 3.2-3.9):
2 pi times the stress under unit pressure is

    xx = 2nu V_z - z V_xx - (1-2nu) chi_xx        yz = -z V_yz
    yy = 2nu V_z - z V_yy - (1-2nu) chi_yy        xz = -z V_xz
    zz = V_z - z V_zz                             xy = -z V_xy - (1-2nu) chi_xy

and under unit traction along +x

    xx = (2+2nu) V_x + 2nu F_xxx - z chi_xxx      yz = -z V_xy
    yy = 2nu V_x + 2nu F_xyy - z chi_xyy          xz = V_z - z V_xx
    zz = -z V_xz                                  xy = V_y + 2nu F_xxy - z chi_xxy

Near the rectangle they are sums over its corners, far from it Gauss rules of the point-force solution.

On the surface itself the limits from inside the body are given: inside, outside, and on an edge the mean of both.
Some stresses are singular there, like ln(distance): xx, yy under traction on the edges x = +-a, xy under traction on
the edges y = +-b, xy under pressure at the corners. These come out as infinities.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.kernels.blocks import BLOCK, X_AT, Y_AT, Six, add_block, add_six, begin_block
from bem.kernels.cell_rules import NODES, WEIGHTS, angle, chi_xx, cut, log_ratio, powers, rule
from bem.kernels.half_space import check_points
from bem.kernels.loads import STRESS_PARITY, Load, clear_odd, clear_odd_offsets

_TWO_PI = 2.0 * np.pi


@compiled
def _pressure_point(x: float, y: float, z: float, nu: float) -> Six:
    """Return 2 pi times the six stresses of a unit point force into the body."""
    _, inv, inv3, s, curl = powers(x, y, z)
    plane = inv * s  # chi_xx = plane - x^2 curl, chi_xy = -x y curl
    shear = 3.0 * z * inv3 * inv * inv  # z V_xy = x y shear
    k = 1.0 - 2.0 * nu
    direct = k * (z * inv3 - plane)  # 2nu V_z + z/R^3 - k plane
    common = k * curl - shear
    down = -z * shear
    return direct + x * x * common, direct + y * y * common, z * down, y * down, x * down, x * y * common


@compiled
def _traction_point(x: float, y: float, z: float, nu: float) -> Six:
    """Return 2 pi times the six stresses of a unit point force along +x."""
    r, inv, inv3, s, curl = powers(x, y, z)
    xx, yy = x * x, y * y
    plane = inv * s
    shear = 3.0 * z * inv3 * inv * inv
    # third derivatives; s_x = -x plane s, plane_x = -x curl, curl_x = -x twist
    twist = inv3 * s * s * (-2.0 * inv + (2.0 * r + z) * inv * (3.0 * inv + 2.0 * s))
    # F_x = -x s, F_xy = x y plane s, (plane s)_t = -t inner
    flat = plane * s
    inner = flat * (inv + 2.0 * s) * inv
    # 2nu F_xyy - z chi_xyy = x (mean - y^2 bend), with xxy by exchange, xxx = x (3 mean - x^2 bend)
    mean = 2.0 * nu * flat + z * curl
    bend = 2.0 * nu * inner + z * twist
    draw = 2.0 * nu * inv3
    pull = x * shear
    return (
        x * (3.0 * mean - xx * bend - 2.0 * inv3 - draw),
        x * (mean - yy * bend - draw),
        -z * pull,
        -y * pull,
        -x * pull,
        y * (mean - xx * bend - inv3),
    )


@compiled
def add_point(x: float, y: float, z: float, nu: float, pressure: float, traction: float, out: FloatArray) -> None:
    """Add 2 pi times the six stresses of point forces: `pressure` into the body, `traction` along +x."""
    if pressure != 0.0:
        stress = _pressure_point(x, y, z, nu)
        for component in range(6):
            out[component] += pressure * stress[component]
    if traction != 0.0:
        stress = _traction_point(x, y, z, nu)
        for component in range(6):
            out[component] += traction * stress[component]


@compiled
def add_points(
    right: float, on: float, z: float, nu: float, pressure: float, traction: float, count: int, scratch: FloatArray
) -> None:
    """Add 2 pi times the stresses of point forces at (right, on) to the sums of the first `count` points of a block."""
    if pressure != 0.0:
        for k in range(count):
            add_six(pressure, _pressure_point(scratch[X_AT + k] - right, scratch[Y_AT + k] - on, z, nu), k, scratch)
    if traction != 0.0:
        for k in range(count):
            add_six(traction, _traction_point(scratch[X_AT + k] - right, scratch[Y_AT + k] - on, z, nu), k, scratch)


@compiled
def _corners(
    x: float, y: float, z: float, a: float, b: float, nu: float, pressure: float, traction: float, out: FloatArray
) -> None:
    """Add 2 pi times the six stresses of uniform loads on |x| < a, |y| < b."""
    k = 1.0 - 2.0 * nu
    zz = z * z
    solid = 0.0  # -V_z
    arc_x = 0.0  # -z V_xx
    arc_y = 0.0  # -z V_yy
    chi_xx_sum = 0.0  # chi_xx
    chi_yy_sum = 0.0  # chi_yy
    z_xz = 0.0  # -z V_xz
    z_yz = 0.0  # -z V_yz
    z_xy = 0.0  # z V_xy
    chi_xy = 0.0
    mixed_x = 0.0  # (2nu + z/R) Y / (R + z)
    mixed_y = 0.0
    for i in range(2):
        u = x + a if i else x - a
        for j in range(2):
            v = y + b if j else y - b
            sign = 1.0 if i == j else -1.0
            r = np.sqrt(u * u + v * v + zz)
            solid += sign * angle(u, v, z, r)
            if z > 0.0:
                au = 1.0 / (r * (u * u + zz))
                av = 1.0 / (r * (v * v + zz))
                uv = sign * z * u * v
                arc_x += uv * au
                arc_y += uv * av
                z_xz += sign * zz * v * au
                z_yz += sign * zz * u * av
                z_xy += sign * z / r
            if pressure != 0.0:
                chi_xx_sum += sign * chi_xx(u, v, z, r)
                chi_yy_sum += sign * chi_xx(v, u, z, r)
                chi_xy += sign * np.log(r + z)
            if traction != 0.0 and r > 0.0:
                slope = sign * (2.0 * nu + z / r) / (r + z)
                mixed_x += slope * v
                mixed_y += slope * u
    if pressure != 0.0:
        out[0] += pressure * (arc_x - 2.0 * nu * solid - k * chi_xx_sum)
        out[1] += pressure * (arc_y - 2.0 * nu * solid - k * chi_yy_sum)
        out[2] -= pressure * (solid + arc_x + arc_y)
        out[3] += pressure * z_yz
        out[4] += pressure * z_xz
        out[5] -= pressure * (k * chi_xy + z_xy)
    if traction != 0.0:
        y0, y1, x0, x1 = y - b, y + b, x - a, x + a
        v_x = log_ratio(y1, y0, np.sqrt(x1 * x1 + zz)) - log_ratio(y1, y0, np.sqrt(x0 * x0 + zz))
        v_y = log_ratio(x1, x0, np.sqrt(y1 * y1 + zz)) - log_ratio(x1, x0, np.sqrt(y0 * y0 + zz))
        out[0] += traction * (2.0 * v_x + mixed_x - z_xz)
        out[1] += traction * (2.0 * nu * v_x - mixed_x)
        out[2] += traction * z_xz
        out[3] -= traction * z_xy
        out[4] += traction * (arc_x - solid)
        out[5] += traction * (v_y - mixed_y)


@compiled
def _piece(
    n: int,
    x: float,
    y: float,
    z: float,
    a: float,
    b: float,
    nu: float,
    pressure: float,
    traction: float,
    out: FloatArray,
) -> None:
    if n == 0:
        _corners(x, y, z, a, b, nu, pressure, traction, out)
        return
    area = 4.0 * a * b
    for i in range(n):
        for j in range(n):
            w = area * WEIGHTS[n, i] * WEIGHTS[n, j]
            add_point(x - a * NODES[n, i], y - b * NODES[n, j], z, nu, w * pressure, w * traction, out)


@compiled
def add_rectangle(
    x: float, y: float, z: float, a: float, b: float, nu: float, pressure: float, traction: float, out: FloatArray
) -> None:
    """Add 2 pi times the six stresses at (x, y, z) of uniform loads on |x| < a, |y| < b."""
    n = rule(x, y, z, a, b)
    if n >= 0:
        _piece(n, x, y, z, a, b, nu, pressure, traction, out)
        return
    for cx, cy, ha, hb in cut(x, y, z, a, b):
        px = x - cx
        py = y - cy
        _piece(rule(px, py, z, ha, hb), px, py, z, ha, hb, nu, pressure, traction, out)


@compiled
def add_rectangles(
    x: FloatArray,
    y: FloatArray,
    z: float,
    a: float,
    b: float,
    nu: float,
    pressure: float,
    traction: float,
    scratch: FloatArray,
    out: FloatArray,
) -> None:
    """Add 2 pi times the six stresses of a loaded rectangle at the points (x, y), (n,) each, to `out` (6, n).

    Consecutive far points with the same Gauss rule form a block (`blocks`). scratch : (8 BLOCK,).
    """
    area = 4.0 * a * b
    start = 0
    while start < x.size:
        n = rule(x[start], y[start], z, a, b)
        stop = start + 1
        if n <= 0:
            add_rectangle(x[start], y[start], z, a, b, nu, pressure, traction, out[:, start])
            start = stop
            continue
        while stop < min(x.size, start + BLOCK) and rule(x[stop], y[stop], z, a, b) == n:
            stop += 1
        begin_block(x[start:stop], y[start:stop], scratch)
        for i in range(n):
            for j in range(n):
                w = area * WEIGHTS[n, i] * WEIGHTS[n, j]
                right, on = a * NODES[n, i], b * NODES[n, j]
                add_points(right, on, z, nu, w * pressure, w * traction, stop - start, scratch)
        add_block(stop - start, scratch, out[:, start:stop])
        start = stop


@compiled
def _many(
    x: FloatArray,
    y: FloatArray,
    z: FloatArray,
    a: float,
    b: float,
    nu: float,
    pressure: float,
    traction: float,
    out: FloatArray,
) -> None:
    scale = max(a, b)
    local = np.zeros(6)
    for i in range(x.size):
        local[:] = 0.0
        add_rectangle(x[i] / scale, y[i] / scale, z[i] / scale, a / scale, b / scale, nu, pressure, traction, local)
        for c in range(6):
            out[c, i] = local[c] / _TWO_PI


@compiled
def _table(
    dx: float, dy: float, z: float, nu: float, pressure: float, traction: float, first: int, out: FloatArray
) -> None:
    scale = max(dx, dy)
    scratch = np.zeros(8 * BLOCK)
    x = np.zeros(out.shape[2])
    y = (np.arange(out.shape[2]) + first) * (dy / scale)
    row = np.zeros((6, out.shape[2]))
    for i in range(out.shape[1]):
        x[:] = i * (dx / scale)
        row[:] = 0.0
        add_rectangles(x, y, z / scale, 0.5 * dx / scale, 0.5 * dy / scale, nu, pressure, traction, scratch, row)
        for c in range(6):
            for j in range(out.shape[2]):
                out[c, i, j] = row[c, j] / _TWO_PI


def rectangle_stress(
    x: ArrayLike,
    y: ArrayLike,
    depth: ArrayLike,
    sides: tuple[float, float],
    poissons_ratio: float,
    load: Load = Load.NORMAL,
) -> FloatArray:
    """Stresses (xx yy zz yz xz xy) per unit load on a rectangle centred at the origin.

    Parameters
    ----------
    x, y, depth, sides, load : as in `half_space.rectangle_displacement`.
    poissons_ratio : of the half-space.

    Returns
    -------
    array (6, ...), dimensionless [Pa/Pa], tension positive.

    Raises
    ------
    InputError : coordinates that are not finite, negative depths, sides that are not positive, nu outside (-1, 0.5].
    """
    px, py, pz = check_points(x, y, depth, sides, poissons_ratio)
    out = np.empty((6, px.size))
    normal = load is Load.NORMAL
    a, b = 0.5 * float(sides[0]), 0.5 * float(sides[1])
    _many(px.ravel(), py.ravel(), pz.ravel(), a, b, float(poissons_ratio), float(normal), float(not normal), out)
    return clear_odd(out.reshape(6, *px.shape), px, py, STRESS_PARITY[load])


def stress_table(
    shape: tuple[int, int],
    spacing: tuple[float, float],
    depth: float,
    poissons_ratio: float,
    load: Load,
    first: int = 0,
) -> FloatArray:
    """Return the six stresses at offsets (i dx, (j + first) dy) and `depth` [m] from a loaded cell: (6, nx, ny)."""
    out = np.empty((6, *shape))
    normal = load is Load.NORMAL
    _table(spacing[0], spacing[1], depth, poissons_ratio, float(normal), float(not normal), first, out)
    return clear_odd_offsets(out, STRESS_PARITY[load], first)
