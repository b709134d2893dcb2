"""Gauss rules by distance, and corner terms without cancellation, for the closed forms of a loaded rectangle.

Closed forms are second differences over the corners: their relative error grows like (distance / cell)^2. Far cells are
therefore integrated by a Gauss rule of the point-force solution. A rule of n points on a cell of half side a at a
distance d errs by about (2 d / a)^(-2 n), so few points suffice far away.
"""

from __future__ import annotations

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray

NEAR = 12.0
"""Closed forms are used up to this distance in half sides, Gauss points beyond."""

MAX_POINTS = 12
# rows: number of points; abscissae on (-1, 1), weights that sum to 1 (a mean over the cell)
NODES = np.zeros((MAX_POINTS + 1, MAX_POINTS))
WEIGHTS = np.zeros((MAX_POINTS + 1, MAX_POINTS))
for _n in range(1, MAX_POINTS + 1):
    NODES[_n, :_n], WEIGHTS[_n, :_n] = np.polynomial.legendre.leggauss(_n)
    WEIGHTS[_n, :_n] *= 0.5


@compiled
def points_needed(ratio: float) -> int:
    """Return the number of Gauss points per side at `ratio` = distance / half side >= NEAR.

    The error is near 1e-16 of the stress of the point force. Straight below a cell under traction, where symmetry
    leaves only a part (a / z)^2 smaller, it is near 1e-13 of that part.
    """
    if ratio >= 1000.0:
        return 3
    if ratio >= 100.0:
        return 4
    if ratio >= 30.0:
        return 5
    return 6


@compiled
def log_ratio(upper: float, lower: float, across: float) -> float:
    """Return ln[(upper + R(upper)) / (lower + R(lower))] with R(t) = sqrt(t^2 + across^2), upper > lower.

    It is the integral of dt / R from lower to upper, evaluated without cancellation.
    """
    r_upper = np.sqrt(upper * upper + across * across)
    r_lower = np.sqrt(lower * lower + across * across)
    if lower >= 0.0:
        step = (upper - lower) * (1.0 + (upper + lower) / (r_upper + r_lower))
        return np.log1p(step / (lower + r_lower))
    if upper <= 0.0:
        step = (upper - lower) * (1.0 - (upper + lower) / (r_upper + r_lower))
        return np.log1p(step / (r_upper - upper))
    return np.arcsinh(upper / across) + np.arcsinh(-lower / across)


@compiled
def powers(x: float, y: float, z: float) -> tuple[float, float, float, float, float]:
    """Return the terms of point-force solutions: R, 1/R, 1/R^3, s = 1/(R + z) and (2 R + z) s^2 / R^3."""
    r = np.sqrt(x * x + y * y + z * z)
    inv = 1.0 / r
    inv3 = inv * inv * inv
    s = 1.0 / (r + z)
    return r, inv, inv3, s, (2.0 * r + z) * inv3 * s * s


@compiled
def angle(u: float, v: float, z: float, r: float) -> float:
    """Return arctan(u v / (z r)); on z = 0 its limit from inside the body, 0 on an edge (the mean of both sides)."""
    return np.arctan2(u * v, z * r) if z > 0.0 else 0.5 * np.pi * np.sign(u) * np.sign(v)


@compiled
def chi_xx(u: float, v: float, z: float, r: float) -> float:
    """Return arctan(v/u) - arctan(z v / (u r)) as one angle: the corner form of d2/du2 of the integral of ln(R + z)."""
    return np.arctan2(u * v * (u * u + v * v) / (r + z), u * u * r + z * v * v) if r > 0.0 else 0.0


@compiled
def rule(x: float, y: float, z: float, a: float, b: float) -> int:
    """Return the rule for the rectangle |x'| < a, |y'| < b at the point (x, y, z).

    n > 0: n Gauss points a side. 0: corner sums. -1: cut the rectangle, which is too long for either.
    """
    long = max(a, b)
    short = min(a, b)
    ratio = np.sqrt(x * x + y * y + z * z) / long
    if ratio >= NEAR:
        return points_needed(ratio)
    if long <= 2.0 * short:
        return 0
    gap = np.sqrt(max(abs(x) - a, 0.0) ** 2 + max(abs(y) - b, 0.0) ** 2 + z * z)
    return 0 if gap <= short else -1


@compiled
def cut(x: float, y: float, z: float, a: float, b: float) -> FloatArray:
    """Cut a long rectangle into pieces (k, 4): centre x, centre y, half side, half side, each with its own rule.

    Halving the long side ends after about log2(a / b) levels; pieces far from the point stay long.
    """
    pieces = np.zeros((64, 4))
    waiting = np.zeros((64, 4))
    waiting[0, 2] = a
    waiting[0, 3] = b
    count = 0
    top = 1
    while top > 0:
        top -= 1
        cx, cy, ha, hb = waiting[top, 0], waiting[top, 1], waiting[top, 2], waiting[top, 3]
        if rule(x - cx, y - cy, z, ha, hb) >= 0:
            if count == pieces.shape[0]:
                grown = np.zeros((2 * count, 4))
                grown[:count] = pieces
                pieces = grown
            pieces[count] = waiting[top]
            count += 1
            continue
        if ha > hb:
            ha *= 0.5
            sx, sy = ha, 0.0
        else:
            hb *= 0.5
            sx, sy = 0.0, hb
        for side in (-1.0, 1.0):
            waiting[top, 0] = cx + side * sx
            waiting[top, 1] = cy + side * sy
            waiting[top, 2] = ha
            waiting[top, 3] = hb
            top += 1
    return pieces[:count]
