"""Integrals of a point response over cells and their images, for responses that are even, or odd, along both axes.

A `PointResponse` gives its value at a distance, its integral over a near rectangle, and, where images are summed, its
integral along y beyond a distance. Here they become tables of influence coefficients:

1. Far from the cell: Gauss rules, since sums over the corners lose (distance / side)^2 digits.
2. Near it: the response's own integral. Long cells are cut into pieces of at most twice their width where even more
   Gauss points do not serve.
3. Images along a periodic y axis (`image_sum`): those up to k = 1 as cells; the others form a function that is smooth
   on the scale of the period and is interpolated from Chebyshev nodes. From k = 9.5 its sum is an integral and the
   Euler-Maclaurin terms (`euler_maclaurin`). The response must decay like 1 / k^3.

Used by `anisotropic` and `surface_tension`; verified with them.
"""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from bem.grid import FloatArray
from bem.kernels.euler_maclaurin import euler_maclaurin
from bem.numerics.blocks import row_blocks

_NEAR = 12.0
"""The response's own integral is used up to this distance in half sides, Gauss points beyond."""

_LONG_NEAR = 3.0
"""The same of cells longer than twice their width."""

_RULES = ((1000.0, 3), (100.0, 4), (30.0, 6), (_NEAR, 8), (_LONG_NEAR, 20))
"""Gauss points a side beyond a distance in half sides.

One or two more than for 1/r: other responses are analytic only in a narrower strip about real distances.
"""

_FIRST_INTEGRATED = 10
"""Number of the first image that is summed by the integral, as in `semi_periodic`."""

_NODES, _LINE_POINTS = 24, 6
"""Chebyshev nodes along half a period, and Gauss points a side of a cell for images that are summed by the integral."""


class PointResponse(Protocol):
    """Displacement under a point force, times a constant.

    parity : 1 if it is even along each axis, -1 if it is odd along both.
    """

    parity: int

    def value(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return the response at offsets x and y from the force, of either sign."""
        ...

    def near(self, x: FloatArray, y: FloatArray, a: float, b: float) -> FloatArray:
        """Return its integral over |x'| < a, |y'| < b at near points (n,)."""
        ...

    def beyond(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return its integral from y > 0 to infinity along y, at offsets x (nx, 1) and y (1, ny)."""
        ...


def cell_table(x: FloatArray, y: FloatArray, sides: tuple[float, float], response: PointResponse) -> FloatArray:
    """Return the integral of the response over a cell of given sides at the points of a table (x, y): (nx, ny)."""
    a, b = 0.5 * sides[0], 0.5 * sides[1]
    long = max(a, b) > 2 * min(a, b)
    out = np.empty((len(x), len(y)))
    for first, last in row_blocks((len(x), 8 * len(y))):
        at_x, at_y = np.broadcast_arrays(x[first:last, None], y[None, :])
        ratio = np.hypot(at_x, at_y) / max(a, b)
        block = np.empty(ratio.shape)
        near = ratio < (_LONG_NEAR if long else _NEAR)
        if near.any():
            block[near] = (
                _cut(at_x[near], at_y[near], a, b, response) if long else response.near(at_x[near], at_y[near], a, b)
            )
        above = math.inf
        for least, count in _RULES:
            far = ~near & (ratio >= least) & (ratio < above)
            above = least
            if far.any():
                block[far] = _gauss(at_x[far], at_y[far], a, b, response, count)
        out[first:last] = block
    return out


def _cut(x: FloatArray, y: FloatArray, a: float, b: float, response: PointResponse) -> FloatArray:
    """Return the integral over a long rectangle at the points (n,) as a sum over pieces."""
    pieces = math.ceil(max(a, b) / (2 * min(a, b)))
    total = np.zeros_like(x)
    along_x = a > b
    half = max(a, b) / pieces
    sides = (2 * half, 2 * b) if along_x else (2 * a, 2 * half)
    for i in range(pieces):
        shift = (2 * i + 1 - pieces) * half
        px, py = (x - shift, y) if along_x else (x, y - shift)
        ratio = np.hypot(px, py) / (0.5 * max(sides))
        near = ratio < _NEAR
        above = math.inf
        if near.any():
            total[near] += response.near(px[near], py[near], 0.5 * sides[0], 0.5 * sides[1])
        for least, count in _RULES:
            far = ~near & (ratio >= least) & (ratio < above)
            above = least
            if far.any():
                total[far] += _gauss(px[far], py[far], 0.5 * sides[0], 0.5 * sides[1], response, count)
    return total


def _gauss(x: FloatArray, y: FloatArray, a: float, b: float, response: PointResponse, count: int) -> FloatArray:
    nodes, weights = np.polynomial.legendre.leggauss(count)
    total = np.zeros_like(x)
    for u, along in zip(a * nodes, weights, strict=True):
        for v, across in zip(b * nodes, weights, strict=True):
            total += along * across * response.value(x - u, y - v)
    return a * b * total


def image_sum(x: FloatArray, y: FloatArray, sides: tuple[float, float], response: PointResponse) -> FloatArray:
    """Return the sum of the integrals over a cell and its images along y, whose period is len(y) cells: (nx, ny)."""
    count, period = len(y), len(y) * sides[1]
    half = y[: count // 2 + 1]
    out = np.zeros((len(x), len(half)))
    for k in (-1, 0, 1):
        out += cell_table(x, half + k * period, sides, response)
    angles = (np.arange(_NODES) + 0.5) * np.pi / _NODES
    middle = 0.25 * period
    nodes = middle * (1 + np.cos(angles))
    tail = np.zeros((len(x), _NODES))
    places = [(float(k), 1.0) for k in range(2, _FIRST_INTEGRATED)]
    start = _FIRST_INTEGRATED - 0.5
    for t, weight in zip(*euler_maclaurin(16, 2), strict=True):
        places += [(start + t, weight), (start - t, -weight)]
    for place, weight in places:
        for side in (-1.0, 1.0):
            tail += weight * cell_table(x, nodes + side * place * period, sides, response)
    tail += _beyond(x, nodes, start * period, sides, response) / period
    orders = np.arange(_NODES)
    cardinal = np.cos(orders[:, None] * angles) * np.where(orders > 0, 2.0, 1.0)[:, None] / _NODES
    basis = np.cos(orders[:, None] * np.arccos(np.clip(half / middle - 1, -1, 1)))
    out += tail @ cardinal.T @ basis
    return np.concatenate([out, response.parity * out[:, 1 : (count + 1) // 2][:, ::-1]], axis=1)


def _beyond(
    x: FloatArray, y: FloatArray, start: float, sides: tuple[float, float], response: PointResponse
) -> FloatArray:
    """Return the integral of the response over a cell, integrated along y beyond `start` on both sides: (nx, ny)."""
    nodes, weights = np.polynomial.legendre.leggauss(_LINE_POINTS)
    total = np.zeros((len(x), len(y)))
    for u, along in zip(0.5 * sides[0] * nodes, weights, strict=True):
        for v, across in zip(0.5 * sides[1] * nodes, weights, strict=True):
            for side in (-1.0, 1.0):
                sign = side if response.parity < 0 else 1.0
                rest = response.beyond((x - u)[:, None], start + side * (y - v)[None, :])
                total += sign * along * across * rest
    return 0.25 * sides[0] * sides[1] * total
