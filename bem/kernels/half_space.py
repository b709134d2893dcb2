"""Displacements of an elastic half-space under a uniformly loaded rectangle, at the surface and below.

With the potentials of Johnson, *Contact Mechanics* (1985), eq. 3.2-3.5 (Boussinesq, Cerruti; Love 1929),

    V   = integral of 1/R        chi = integral of ln(R + z)        F = integral of z ln(R + z) - R

over the loaded rectangle, G the shear modulus, unit pressure gives

    4 pi G (ux, uy, uz) = (-(1-2nu) chi_x - z V_x,  -(1-2nu) chi_y - z V_y,  2(1-nu) V - z V_z)

and unit traction along +x

    4 pi G (ux, uy, uz) = (2 V + 2nu F_xx - z chi_xx,  2nu F_xy - z chi_xy,  (1-2nu) chi_x - z V_x).

Each is a sum over the four corners near the rectangle and a Gauss rule of the point-force solution far from it. A
rectangle that is too long for either is cut across its long side until one of them serves.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from bem.compiled import compiled
from bem.errors import InputError
from bem.grid import FloatArray
from bem.kernels.cell_rules import NODES, WEIGHTS, angle, chi_xx, cut, log_ratio, powers, rule
from bem.kernels.loads import DISPLACEMENT_PARITY, IN_PLANE_PARITY, Load, clear_odd, clear_odd_offsets
from bem.materials import Material


@compiled
def _point(x: float, y: float, z: float, nu: float, tangential: bool, weight: float, out: FloatArray) -> None:
    """Add `weight` times 4 pi G u of a unit point force at the origin."""
    _, inv, inv3, s, curl = powers(x, y, z)
    if tangential:
        out[0] += weight * (2.0 * inv + 2.0 * nu * s * (x * x * inv * s - 1.0) - z * (inv * s - x * x * curl))
        out[1] += weight * x * y * (2.0 * nu * inv * s * s + z * curl)
        out[2] += weight * x * ((1.0 - 2.0 * nu) * inv * s + z * inv3)
    else:
        side = z * inv3 - (1.0 - 2.0 * nu) * inv * s
        out[0] += weight * x * side
        out[1] += weight * y * side
        out[2] += weight * (2.0 * (1.0 - nu) * inv + z * z * inv3)


@compiled
def _chi_x(x0: float, x1: float, y0: float, y1: float, z: float) -> float:
    """Return chi_x, the integral of d/dx ln(R + z) over the rectangle, from the corner differences."""
    total = 0.0
    for j in range(2):
        v = y1 if j else y0
        r0 = np.sqrt(x0 * x0 + v * v + z * z)
        r1 = np.sqrt(x1 * x1 + v * v + z * z)
        term = x1 * chi_xx(x1, v, z, r1) - x0 * chi_xx(x0, v, z, r0)
        if v != 0.0:
            # v ln[(r1 + z) / (r0 + z)], also where the rectangle is so long that both are nearly v
            term += v * np.log1p((x1 - x0) * (x1 + x0) / ((r1 + r0) * (r0 + z)))
        total += term if j else -term
    if z > 0.0:
        total += z * (log_ratio(y1, y0, np.sqrt(x1 * x1 + z * z)) - log_ratio(y1, y0, np.sqrt(x0 * x0 + z * z)))
    return total


@compiled
def _edge(far: float, near: float, side: float, z: float) -> float:
    """Return the integral of 1/R along an edge; 0 on the line of the edge, where its factor is 0 or it cancels."""
    across = np.sqrt(side * side + z * z)
    return log_ratio(far, near, across) if across > 0.0 else 0.0


@compiled
def _corners(x: float, y: float, z: float, a: float, b: float, nu: float, tangential: bool, out: FloatArray) -> None:
    """Add 4 pi G u of unit load on |x| < a, |y| < b."""
    x0, x1, y0, y1 = x - a, x + a, y - b, y + b
    v_x0 = _edge(y1, y0, x0, z)
    v_x1 = _edge(y1, y0, x1, z)
    v_y0 = _edge(x1, x0, y0, z)
    v_y1 = _edge(x1, x0, y1, z)
    newton = x1 * v_x1 - x0 * v_x0 + y1 * v_y1 - y0 * v_y0
    solid = 0.0  # -V_z
    chi_sum = 0.0  # chi_xx
    omega = 0.0  # F_xy
    logs = 0.0  # chi_xy
    for i in range(2):
        u = x1 if i else x0
        for j in range(2):
            v = y1 if j else y0
            sign = 1.0 if i == j else -1.0
            r = np.sqrt(u * u + v * v + z * z)
            solid += sign * angle(u, v, z, r)
            if tangential:
                chi_sum += sign * chi_xx(u, v, z, r)
                omega -= sign * r
                if z > 0.0:
                    logs += sign * np.log(r + z)
    newton -= z * solid
    v_x = v_x1 - v_x0
    if tangential:
        f_xx = -(x1 * v_x1 - x0 * v_x0) + z * chi_sum
        out[0] += 2.0 * newton + 2.0 * nu * f_xx - z * chi_sum
        out[1] += 2.0 * nu * (omega + z * logs) - z * logs
        out[2] += (1.0 - 2.0 * nu) * _chi_x(x0, x1, y0, y1, z)
        if z > 0.0:
            out[2] -= z * v_x
    else:
        out[0] -= (1.0 - 2.0 * nu) * _chi_x(x0, x1, y0, y1, z)
        out[1] -= (1.0 - 2.0 * nu) * _chi_x(y0, y1, x0, x1, z)
        out[2] += 2.0 * (1.0 - nu) * newton + z * solid
        if z > 0.0:
            out[0] -= z * v_x
            out[1] -= z * (v_y1 - v_y0)


@compiled
def _piece(
    n: int, x: float, y: float, z: float, a: float, b: float, nu: float, tangential: bool, out: FloatArray
) -> None:
    """Add 4 pi G u of unit load on |x| < a, |y| < b by rule n: corner sums (0), or n Gauss points a side."""
    if n == 0:
        _corners(x, y, z, a, b, nu, tangential, out)
        return
    area = 4.0 * a * b
    for i in range(n):
        for j in range(n):
            weight = area * WEIGHTS[n, i] * WEIGHTS[n, j]
            _point(x - a * NODES[n, i], y - b * NODES[n, j], z, nu, tangential, weight, out)


@compiled
def add_rectangle(
    x: float, y: float, z: float, a: float, b: float, nu: float, tangential: bool, out: FloatArray
) -> None:
    """Add 4 pi G u of unit load on |x| < a, |y| < b: closed form near, Gauss points far, cut where neither serves."""
    n = rule(x, y, z, a, b)
    if n >= 0:
        _piece(n, x, y, z, a, b, nu, tangential, out)
        return
    for cx, cy, ha, hb in cut(x, y, z, a, b):
        px = x - cx
        py = y - cy
        _piece(rule(px, py, z, ha, hb), px, py, z, ha, hb, nu, tangential, out)


@compiled
def _many(
    x: FloatArray, y: FloatArray, z: FloatArray, a: float, b: float, nu: float, tangential: bool, out: FloatArray
) -> None:
    scale = max(a, b)
    local = np.zeros(3)
    for i in range(x.size):
        local[:] = 0.0
        add_rectangle(x[i] / scale, y[i] / scale, z[i] / scale, a / scale, b / scale, nu, tangential, local)
        for c in range(3):
            out[c, i] = scale * local[c]


@compiled
def _surface_table(
    nx: int, ny: int, dx: float, dy: float, nu: float, tangential: bool, first: int, out: FloatArray
) -> None:
    """Compute 4 pi G uz on the surface at offsets (i dx, (j + first) dy) into `out` (nx, ny)."""
    scale = max(dx, dy)
    local = np.zeros(3)
    for i in range(nx):
        for j in range(ny):
            local[:] = 0.0
            x = i * (dx / scale)
            y = (j + first) * (dy / scale)
            add_rectangle(x, y, 0.0, 0.5 * dx / scale, 0.5 * dy / scale, nu, tangential, local)
            out[i, j] = scale * local[2]


@compiled
def _in_plane_table(nx: int, ny: int, dx: float, dy: float, nu: float, out: FloatArray) -> None:
    """Compute 4 pi G times ux, uy under traction along x, y, and uy under traction along x into `out` (3, nx, ny)."""
    scale = max(dx, dy)
    a, b = 0.5 * dx / scale, 0.5 * dy / scale
    local = np.zeros(3)
    for i in range(nx):
        for j in range(ny):
            x, y = i * (dx / scale), j * (dy / scale)
            local[:] = 0.0
            add_rectangle(x, y, 0.0, a, b, nu, True, local)
            out[0, i, j] = scale * local[0]
            out[2, i, j] = scale * local[1]
            local[:] = 0.0
            add_rectangle(y, x, 0.0, b, a, nu, True, local)
            out[1, i, j] = scale * local[0]


def check_points(
    x: ArrayLike, y: ArrayLike, depth: ArrayLike, sides: tuple[float, ...], poissons_ratio: float = 0.0
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Broadcast coordinates [m] and check them, the sides [m] and Poisson's ratio.

    Raises
    ------
    InputError : coordinates that are not finite, negative depths, sides that are not positive, nu outside (-1, 0.5].
    """
    messages = []
    arrays = []
    for name, values in (("x", x), ("y", y), ("depth", depth)):
        array = np.asarray(values, dtype=np.float64)
        if not np.isfinite(array).all():
            messages.append(f"{name}: every coordinate must be finite [m]")
        elif name == "depth" and (array < 0).any():
            messages.append(f"depth: {float(array.min())!r} lies above the surface; depths start at 0 [m]")
        arrays.append(array)
    if not all(np.isfinite(s) and s > 0 for s in sides):
        messages.append(f"sides: {sides!r} must be positive, finite lengths [m]")
    if not -1 < poissons_ratio <= 0.5:
        messages.append(f"poissons_ratio: {poissons_ratio!r} must lie above -1 and not above 0.5")
    if messages:
        raise InputError(messages)
    px, py, pz = np.broadcast_arrays(*arrays)
    return px, py, pz


def rectangle_displacement(
    x: ArrayLike,
    y: ArrayLike,
    depth: ArrayLike,
    sides: tuple[float, float],
    material: Material,
    load: Load = Load.NORMAL,
) -> FloatArray:
    """Displacement (ux, uy, uz) per unit load on a rectangle centred at the origin.

    Parameters
    ----------
    x, y, depth : coordinates of the points [m], broadcast together; depth >= 0.
    sides : (along x, along y), full sides of the rectangle [m].
    material : of the half-space.
    load : unit pressure, or unit traction along +x.

    Returns
    -------
    array (3, ...) [m/Pa], z positive into the body; zero at infinity.

    Raises
    ------
    InputError : coordinates that are not finite, negative depths, sides that are not positive.
    """
    px, py, pz = check_points(x, y, depth, sides)
    out = np.empty((3, px.size))
    _many(
        px.ravel(),
        py.ravel(),
        pz.ravel(),
        0.5 * float(sides[0]),
        0.5 * float(sides[1]),
        material.poissons_ratio,
        load is Load.TANGENTIAL,
        out,
    )
    out /= 4 * np.pi * material.shear_modulus
    return clear_odd(out.reshape(3, *px.shape), px, py, DISPLACEMENT_PARITY[load])


def surface_table(
    shape: tuple[int, int], spacing: tuple[float, float], material: Material, load: Load, first: int = 0
) -> FloatArray:
    """Return the normal surface displacement [m/Pa] at offsets (i dx, (j + first) dy) from a loaded cell: (nx, ny)."""
    out = np.empty(shape)
    tangential = load is Load.TANGENTIAL
    _surface_table(shape[0], shape[1], spacing[0], spacing[1], material.poissons_ratio, tangential, first, out)
    out /= 4 * np.pi * material.shear_modulus
    if tangential:
        out[0] = 0.0
    return out


def in_plane_table(shape: tuple[int, int], spacing: tuple[float, float], material: Material) -> FloatArray:
    """Return the in-plane surface displacements [m/Pa] at offsets (i dx, j dy) from a loaded cell: (3, nx, ny).

    Components as in `coefficients.in_plane_coefficients`.
    """
    out = np.empty((3, *shape))
    _in_plane_table(shape[0], shape[1], spacing[0], spacing[1], material.poissons_ratio, out)
    out /= 4 * np.pi * material.shear_modulus
    return clear_odd_offsets(out, IN_PLANE_PARITY)
