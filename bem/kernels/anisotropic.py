"""Surface of an anisotropic half-space under pressure: point force, loaded cells, and harmonic pressure.

A harmonic pressure of wavevector q at the angle phi from x gives u = A(phi) p / q (`bem.stiffness`). A has the period
pi, so that A(phi) = sum over m of a_m cos(2 m phi) + b_m sin(2 m phi). In the inverse transform the integral over |q|
is a delta function across the direction of the point, so that a unit point force displaces the surface at (r, theta) by

    u = g(theta) / r,   g(theta) = A(theta + pi/2) / (2 pi):

the m-th harmonic changes its sign with m. An isotropic solid has A = 2/E* and g = 1/(pi E*).

1. Near the cell: a rectangle from the point to a corner (x, y) contributes x P(theta) + y Q(theta), with the integrals
   P of g / cos from 0 to theta and Q of g / sin from theta to pi/2, in closed form (`_Corner`), summed over corners.
2. Far from it: Gauss rules of the point force, as in `half_space`. Corner sums lose (distance / side)^2 digits.
3. Long cells are cut into pieces of at most twice their width.
4. One periodic axis: an isotropic surface that is as stiff under a line load along that axis carries the mean over the
   period and the logarithm of the distance; the difference of both is summed over the images (`_images`).

Kernels here are even along each axis: the x axis must be a line of mirror symmetry of the response (b_m = 0).

The formula of g: J. R. Willis, J. Mech. Phys. Solids 14 (1966) 163, and J. R. Barber & M. Ciavarella, J. Tribol. 136
(2014) 031402; not read, derived here. Verified in tests/kernels/test_anisotropic.py: relative error below 1e-12.
"""

from __future__ import annotations

import math

import numpy as np

from bem.grid import FloatArray, Grid
from bem.kernels import semi_periodic
from bem.kernels.euler_maclaurin import euler_maclaurin
from bem.kernels.loads import Load
from bem.materials import Material
from bem.numerics.blocks import row_blocks
from bem.stiffness import Stiffness

_NEAR = 12.0
"""Corner sums are used up to this distance in half sides, Gauss points beyond."""

_RULES = ((1000.0, 3), (100.0, 4), (30.0, 6), (0.0, 8))
"""Gauss points a side beyond a distance in half sides.

One or two more than for 1/r: g(theta) is analytic only in a strip about the real angles, which narrows with the
anisotropy.
"""

_FIRST_INTEGRATED = 10
"""Number of the first image that is summed by the integral, as in `semi_periodic`."""

_NODES, _LINE_POINTS = 24, 12
"""Chebyshev nodes along half a period, and Gauss points a side of a cell for images that are summed by the integral."""


def angular_function(stiffness: Stiffness, angles: FloatArray) -> FloatArray:
    """Return g(theta) [m^2/N]: a unit point force displaces the surface by g / r at a distance r."""
    even, odd = stiffness.harmonics
    found = np.zeros(np.shape(angles))
    for m, value in enumerate(even):
        found += (-1) ** m * value * np.cos(2 * m * angles)
    for m, value in enumerate(odd, start=1):
        found += (-1) ** m * value * np.sin(2 * m * angles)
    return found / (2 * np.pi)


def surface_response(kx: FloatArray, ky: FloatArray, stiffness: Stiffness) -> FloatArray:
    """Return u / p [m/Pa] of harmonic pressures, kx and ky broadcast together [rad/m]; 0 at the mean mode.

    Raises
    ------
    InputError : a response that is not symmetric about x.
    """
    even = _even_harmonics(stiffness)
    q = np.hypot(kx, ky)
    safe = np.where(q > 0, q, 1.0)
    cosine = (kx - ky) * (kx + ky) / safe**2
    return np.where(q > 0, _clenshaw(even, cosine) / safe, 0.0)


def surface_table(grid: Grid, stiffness: Stiffness) -> FloatArray:
    """Return the normal surface displacement [m/Pa] at offsets (i dx, j dy) from a cell under unit pressure, (nx, ny).

    On a grid with one periodic axis the images of the cell are summed; the datum is that of `semi_periodic`.

    Raises
    ------
    InputError : a response that is not symmetric about x.
    """
    even = _even_harmonics(stiffness)
    if grid.periodic[0]:  # with the axes exchanged: theta becomes pi/2 - theta
        turned = even * (-1.0) ** np.arange(len(even))
        swapped = Grid(grid.shape[::-1], grid.spacing[::-1], periodic=(False, True))
        return np.ascontiguousarray(_table(swapped, turned).T)
    return _table(grid, even)


def _table(grid: Grid, even: FloatArray) -> FloatArray:
    """Return the table of a surface with the harmonics a_m on a grid that is free along x at least."""
    point = even * (-1.0) ** np.arange(len(even)) / (2 * np.pi)
    unit = math.sqrt(grid.cell_area)
    dx, dy = grid.spacing[0] / unit, grid.spacing[1] / unit
    x, y = dx * np.arange(grid.shape[0], dtype=np.float64), dy * np.arange(grid.shape[1], dtype=np.float64)
    if not grid.periodic[1]:
        return unit * _cells(x, y, (dx, dy), point)
    material = Material("as stiff under a line load", youngs_modulus=2 / float(even.sum()), poissons_ratio=0.0)
    point[0] -= float(even.sum()) / (2 * np.pi)  # g(pi/2), of a line load along y
    mean: FloatArray = semi_periodic.surface_table(grid, material, Load.NORMAL)
    return mean + unit * _images(x, y, (dx, dy), point)


def _cells(x: FloatArray, y: FloatArray, sides: tuple[float, float], point: FloatArray) -> FloatArray:
    """Return the integral of g / r over a cell at the points of a table (x, y): (nx, ny)."""
    dx, dy = sides
    pieces_x, pieces_y = max(1, math.ceil(dx / (2 * dy))), max(1, math.ceil(dy / (2 * dx)))
    a, b = 0.5 * dx / pieces_x, 0.5 * dy / pieces_y
    out = np.zeros((len(x), len(y)))
    for i in range(pieces_x):
        for j in range(pieces_y):
            left, low = (2 * i + 1 - pieces_x) * a, (2 * j + 1 - pieces_y) * b
            for first, last in row_blocks((len(x), 8 * len(y))):
                out[first:last] += _pieces(x[first:last, None] - left, y[None, :] - low, a, b, point)
    return out


def _images(x: FloatArray, y: FloatArray, sides: tuple[float, float], point: FloatArray) -> FloatArray:
    """Return the sum of the integrals of g / r over a cell and its images along y: (nx, ny), for g(pi/2) = 0.

    Since g is even about y, its sum converges like that of 1 / k^3. The images up to k = 1 are cells; the others form a
    function that is smooth on the scale of the period and is interpolated from Chebyshev nodes. From k = 9.5 its sum is
    an integral, in closed form for a point force, and the Euler-Maclaurin terms.
    """
    count, period = len(y), len(y) * sides[1]
    half = y[: count // 2 + 1]
    out = np.zeros((len(x), len(half)))
    for k in (-1, 0, 1):
        out += _cells(x, half + k * period, sides, point)
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
            tail += weight * _cells(x, nodes + side * place * period, sides, point)
    tail += _line_beyond(x, nodes, start * period, sides, point) / period
    orders = np.arange(_NODES)
    cardinal = np.cos(orders[:, None] * angles) * np.where(orders > 0, 2.0, 1.0)[:, None] / _NODES
    basis = np.cos(orders[:, None] * np.arccos(np.clip(half / middle - 1, -1, 1)))
    out += tail @ cardinal.T @ basis
    return np.concatenate([out, out[:, 1 : (count + 1) // 2][:, ::-1]], axis=1)


def _line_beyond(
    x: FloatArray, y: FloatArray, start: float, sides: tuple[float, float], point: FloatArray
) -> FloatArray:
    """Return the integral of g / r over a cell, integrated along y beyond `start` on both sides: (nx, ny)."""
    nodes, weights = np.polynomial.legendre.leggauss(_LINE_POINTS)
    corner, zero = _Corner(point), np.zeros(1)
    whole = float(corner(zero + 1e-300, zero + 1.0)[0])  # at theta = pi/2
    total = np.zeros((len(x), len(y)))
    for u, along in zip(0.5 * sides[0] * nodes, weights, strict=True):
        for v, across in zip(0.5 * sides[1] * nodes, weights, strict=True):
            right = np.broadcast_to(np.abs(x - u)[:, None], total.shape)
            for side in (-1.0, 1.0):
                total += along * across * (whole - corner(right, start + side * (y - v)[None, :]))
    return 0.25 * sides[0] * sides[1] * total


def _even_harmonics(stiffness: Stiffness) -> FloatArray:
    stiffness.check_mirror_symmetric()
    return stiffness.harmonics[0]


def _clenshaw(coefficients: FloatArray, cosine: FloatArray) -> FloatArray:
    """Return the sum of c_m cos(2 m theta) at cos(2 theta)."""
    later, latest = np.zeros_like(cosine), np.zeros_like(cosine)
    twice = 2 * cosine
    for value in coefficients[:0:-1]:
        later, latest = latest, value + twice * latest - later
    return coefficients[0] + cosine * latest - later


def _pieces(x: FloatArray, y: FloatArray, a: float, b: float, point: FloatArray) -> FloatArray:
    """Return the integral of g / r over |x'| < a, |y'| < b at the points (x, y), which broadcast together."""
    x, y = np.broadcast_arrays(x, y)
    ratio = np.hypot(x, y) / max(a, b)
    out = np.empty(x.shape)
    near = ratio < _NEAR
    if near.any():
        out[near] = _near(x[near], y[near], a, b, point)
    above = math.inf
    for least, count in _RULES:
        far = (ratio >= max(least, _NEAR)) & (ratio < above)
        above = least
        if far.any():
            out[far] = _gauss(x[far], y[far], a, b, point, count)
    return out


def _gauss(x: FloatArray, y: FloatArray, a: float, b: float, point: FloatArray, count: int) -> FloatArray:
    nodes, weights = np.polynomial.legendre.leggauss(count)
    total = np.zeros_like(x)
    for u, along in zip(a * nodes, weights, strict=True):
        for v, across in zip(b * nodes, weights, strict=True):
            squared_x, squared_y = (x - u) ** 2, (y - v) ** 2
            squared = squared_x + squared_y
            total += along * across * _clenshaw(point, (squared_x - squared_y) / squared) / np.sqrt(squared)
    return a * b * total


def _near(x: FloatArray, y: FloatArray, a: float, b: float, point: FloatArray) -> FloatArray:
    along_x, along_y = _Corner(point), _Corner(point * (-1.0) ** np.arange(len(point)))
    total = np.zeros_like(x)
    for i in (-1, 1):
        for j in (-1, 1):
            u, v = x + i * a, y + j * b
            right, up = np.abs(u), np.abs(v)
            corner = right * along_x(right, up) + up * along_y(up, right)
            total += i * j * np.sign(u) * np.sign(v) * corner
    return total


class _Corner:
    """P: the integral of g / cos from 0 to theta = arctan(v / u), for g = sum of c_m cos(2 m theta).

    The integrals I_m of cos(2 m theta) / cos(theta) obey I_m + I_(m-1) = 2 sin((2 m - 1) theta) / (2 m - 1), and I_0 =
    arsinh(tan theta). So P = g(pi/2) arsinh(tan theta) + sum of s_j sin((2 j - 1) theta), with s_j = 2 / (2 j - 1)
    times the sum of (-1)^(m - j) c_m over m from j.
    """

    def __init__(self, coefficients: FloatArray) -> None:
        signs = (-1.0) ** np.arange(len(coefficients))
        tails = np.cumsum((signs * coefficients)[::-1])[::-1]
        self.logarithmic = float(tails[0])
        orders = np.arange(1, len(coefficients))
        self.sines = 2 * signs[1:] * tails[1:] / (2 * orders - 1)

    def __call__(self, u: FloatArray, v: FloatArray) -> FloatArray:
        """Return P at corners (u, v), not negative; 0 at u = 0, where it is multiplied by u."""
        u, v = np.broadcast_arrays(u, v)
        safe = np.where(u > 0, u, 1.0)
        found = self.logarithmic * np.arcsinh(v / safe)
        theta = np.arctan2(v, u)
        for number, value in enumerate(self.sines):
            found += value * np.sin((2 * number + 1) * theta)
        return np.where(u > 0, found, 0.0)
