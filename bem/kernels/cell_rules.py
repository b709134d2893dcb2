"""What every rectangle kernel needs: Gauss rules chosen by distance, and logarithms that do not cancel.

A cell seen from a distance is integrated by Gauss points of the point-force solution: closed forms are second
differences over the corners and lose (distance / cell)^2 of their digits. A rule of n points on a cell of half side a
seen from distance d errs by about (2 d / a)^(-2 n), so few points do far away.
"""

from __future__ import annotations

import numba as nb
import numpy as np

NEAR = 12.0
"""Closed forms are used up to this distance in half sides, Gauss points beyond."""

MAX_POINTS = 6
# rows: number of points; abscissae on (-1, 1), weights that sum to 1 (a mean over the cell)
NODES = np.zeros((MAX_POINTS + 1, MAX_POINTS))
WEIGHTS = np.zeros((MAX_POINTS + 1, MAX_POINTS))
for _n in range(1, MAX_POINTS + 1):
    NODES[_n, :_n], WEIGHTS[_n, :_n] = np.polynomial.legendre.leggauss(_n)
    WEIGHTS[_n, :_n] *= 0.5

COMPILE = {"cache": True, "error_model": "numpy", "nogil": True}


@nb.njit(**COMPILE)
def points_needed(ratio: float) -> int:
    """Gauss points per side for a relative error near 1e-16 at `ratio` = distance / half side >= NEAR."""
    if ratio >= 5000.0:
        return 2
    if ratio >= 300.0:
        return 3
    if ratio >= 50.0:
        return 4
    if ratio >= 20.0:
        return 5
    return 6


@nb.njit(**COMPILE)
def log_ratio(upper: float, lower: float, across: float) -> float:
    """ln[(upper + R(upper)) / (lower + R(lower))] with R(t) = sqrt(t^2 + across^2), upper > lower, no cancellation.

    It is the integral of dt / R from lower to upper.
    """
    r_upper = np.sqrt(upper * upper + across * across)
    r_lower = np.sqrt(lower * lower + across * across)
    if lower >= 0.0:
        step = (upper - lower) * (1.0 + (upper + lower) / (r_upper + r_lower))
        return np.log1p(step / (lower + r_lower))
    if upper <= 0.0:
        step = (upper - lower) * (1.0 - (upper + lower) / (r_upper + r_lower))
        return np.log1p(step / (r_upper - upper))
    return np.log((upper + r_upper) / across) + np.log((r_lower - lower) / across)


@nb.njit(**COMPILE)
def angle(u: float, v: float, z: float, r: float) -> float:
    """arctan(u v / (z r)); on z = 0 its limit from inside the body, 0 on an edge (the mean of both sides)."""
    return np.arctan2(u * v, z * r) if z > 0.0 else 0.5 * np.pi * np.sign(u) * np.sign(v)


@nb.njit(**COMPILE)
def slant(u: float, v: float, z: float, r: float) -> float:
    """arctan(v/u) - arctan(z v / (u r)) as one angle: the corner form of d2/du2 of the integral of ln(R + z)."""
    return np.arctan2(u * v * (u * u + v * v) / (r + z), u * u * r + z * v * v) if r > 0.0 else 0.0
