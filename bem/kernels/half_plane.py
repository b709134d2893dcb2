"""Plane strain: uniform load on a strip |x| < a of infinite length along y on an elastic half-space.

The formulas are the limits of those of the rectangle for b -> infinity; Johnson (1985), sections 2.2-2.5. Unit pressure
gives

    pi xx = X z / s^2 - atan(X/z)     pi zz = -X z / s^2 - atan(X/z)     pi xz = z^2 / s^2      s^2 = X^2 + z^2
    pi E* uz = -2 X (ln|X / reference| - 1)                                                     on the surface

and unit traction along +x

    pi xx = -2 ln s - z^2 / s^2       pi zz = z^2 / s^2                  pi xz = X z / s^2 - atan(X/z)
    4 G uz = (1 - 2nu) |X|                                                                      on the surface

each as the difference between X = x + a and X = x - a; yy = nu (xx + zz), yz = xy = 0. Traction across the strip, along
its length, is anti-plane shear: pi xz -> -atan(X/z), pi xy -> -ln s with the axes exchanged.

Datum. A line load displaces a half-plane without bound: the displacement under pressure is measured from that of the
line load itself at the distance `reference_length` (2 P / (pi E*) ln(reference / |x|) for P per unit length). Under
traction the displacement far away is a constant, of opposite sign on either side; its datum is the symmetric one.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from bem.compiled import compiled
from bem.errors import InputError
from bem.grid import FloatArray
from bem.kernels.cell_rules import NEAR, NODES, WEIGHTS, points_needed
from bem.kernels.half_space import check_points
from bem.kernels.loads import Load
from bem.materials import Material


@compiled
def _wedge(x0: float, x1: float, z: float) -> float:
    """Return atan(x1/z) - atan(x0/z), the angle that the strip subtends; on z = 0 the limit from inside."""
    if z == 0.0:
        return 0.5 * np.pi * (np.sign(x1) - np.sign(x0))
    return np.arctan2((x1 - x0) * z, z * z + x0 * x1)


@compiled
def log_strip(x: float, a: float) -> float:
    """Return the integral of ln|x - x'| over |x'| < a, accurate at any distance; x, a in reference lengths."""
    ratio = abs(x) / a
    if ratio >= NEAR:
        n = points_needed(ratio)
        total = 0.0
        for i in range(n):
            total += WEIGHTS[n, i] * np.log1p(-NODES[n, i] / ratio)
        return 2.0 * a * (np.log(abs(x)) + total)
    total = -2.0 * a
    for u in (x + a, a - x):
        if u != 0.0:
            total += u * np.log(abs(u))
    return total


@compiled
def add_strip(
    x: float, z: float, a: float, nu: float, pressure: float, traction: float, along: float, out: FloatArray
) -> None:
    """Add pi times the six stresses at (x, z) of a loaded strip |x'| < a to `out` (6,).

    pressure, traction, along : loads into the body, along +x (across the strip) and along +y.
    """
    zz = z * z
    ratio = np.sqrt(x * x + zz) / a
    across = 0.0  # X z / s^2 - atan(X / z)
    down = 0.0  # -X z / s^2 - atan(X / z)
    dip = 0.0  # z^2 / s^2
    wedge = 0.0  # atan(X / z)
    log = 0.0  # ln s
    if ratio >= NEAR:
        n = points_needed(ratio)
        for i in range(n):
            u = x - a * NODES[n, i]
            s2 = u * u + zz
            w = 2.0 * a * WEIGHTS[n, i] / s2
            across -= w * 2.0 * z * u * u / s2
            down -= w * 2.0 * z * zz / s2
            dip -= w * 2.0 * zz * u / s2
            wedge += w * z
            log += w * u
    else:
        x1 = x + a
        x0 = x - a
        s1 = x1 * x1 + zz
        s0 = x0 * x0 + zz
        arc = 0.0
        if z > 0.0:
            arc = z * (x1 / s1 - x0 / s0)
            dip = zz * (1.0 / s1 - 1.0 / s0)
        wedge = _wedge(x0, x1, z)
        across = arc - wedge
        down = -arc - wedge
        log = 0.5 * np.log(s1 / s0)
    # a traction of zero keeps the infinities of its edges out
    xx = pressure * across
    zz_stress = pressure * down
    if traction != 0.0:
        xx -= traction * (2.0 * log + dip)
        zz_stress += traction * dip
    out[0] += xx
    out[1] += nu * (xx + zz_stress)
    out[2] += zz_stress
    out[4] += pressure * dip + traction * across
    if along != 0.0:
        out[3] -= along * wedge
        out[5] -= along * log


@compiled
def _many(
    x: FloatArray, z: FloatArray, a: float, nu: float, pressure: float, traction: float, along: float, out: FloatArray
) -> None:
    local = np.zeros(6)
    for i in range(x.size):
        local[:] = 0.0
        add_strip(x[i] / a, z[i] / a, 1.0, nu, pressure, traction, along, local)
        for c in range(6):
            out[c, i] = local[c] / np.pi


@compiled
def _logs(x: FloatArray, a: float, out: FloatArray) -> None:
    for i in range(x.size):
        out[i] = log_strip(x[i], a)


def strip_displacement(
    x: ArrayLike, width: float, material: Material, load: Load = Load.NORMAL, *, reference_length: float
) -> FloatArray:
    """Normal surface displacement [m/Pa] per unit load on a strip of full `width` [m] centred at x = 0.

    Parameters
    ----------
    x : positions on the surface [m].
    width : full width of the strip [m].
    material : of the half-plane.
    load : unit pressure, or unit traction along +x.
    reference_length : distance [m] at which a line load of pressure would displace nothing (no effect on traction).

    Raises
    ------
    InputError : positions that are not finite, a width or reference length that is not positive.
    """
    px, _, _ = check_points(x, 0.0, 0.0, (width,))
    if not (np.isfinite(reference_length) and reference_length > 0):
        raise InputError(f"reference_length: {reference_length!r} must be positive and finite [m]")
    a = 0.5 * width
    if load is Load.TANGENTIAL:
        step = np.clip(px, -a, a) * 2
        return np.asarray((1 - 2 * material.poissons_ratio) / (4 * material.shear_modulus) * step)
    out = np.empty(px.size)
    _logs(px.ravel() / reference_length, a / reference_length, out)
    return out.reshape(px.shape) * (-2 * reference_length / (np.pi * material.plane_strain_modulus))


def strip_stress(
    x: ArrayLike, depth: ArrayLike, width: float, poissons_ratio: float, load: Load = Load.NORMAL
) -> FloatArray:
    """Stresses (xx yy zz yz xz xy), array (6, ...) [Pa/Pa], per unit load on a strip of full `width` [m] at x = 0.

    On the surface: the limit from inside the body, on an edge the mean of both sides; xx, yy under traction are
    infinite on the edges.

    Raises
    ------
    InputError : coordinates that are not finite, negative depths, a width that is not positive, nu outside (-1, 0.5].
    """
    px, _, pz = check_points(x, 0.0, depth, (width,), poissons_ratio)
    out = np.empty((6, px.size))
    normal = load is Load.NORMAL
    _many(px.ravel(), pz.ravel(), 0.5 * width, float(poissons_ratio), float(normal), float(not normal), 0.0, out)
    return out.reshape(6, *px.shape)
