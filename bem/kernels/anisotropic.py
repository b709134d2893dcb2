"""Surface of an anisotropic half-space under pressure: point force, loaded cells, and harmonic pressure.

A harmonic pressure of wavevector q at the angle phi from x gives u = A(phi) p / q (`bem.stiffness`). A has the period
pi, so that A(phi) = sum over m of a_m cos(2 m phi) + b_m sin(2 m phi). In the inverse transform the integral over |q|
is a delta function across the direction of the point, so that a unit point force displaces the surface at (r, theta) by

    u = g(theta) / r,   g(theta) = A(theta + pi/2) / (2 pi):

the m-th harmonic changes its sign with m. An isotropic solid has A = 2/E* and g = 1/(pi E*).

The part a_m is even along each axis, the part b_m is odd along both; each has a table of its own. The latter is zero
where the x axis is a line of mirror symmetry of the response.

1. Near the cell: a rectangle from the point to a corner (x, y) contributes x P(theta) + y Q(theta), with the integrals
   P of g / cos from 0 to theta and Q of g / sin from theta to pi/2, in closed form (`_Corner`, `_OddCorner`), summed
   over corners.
2. Far from it: Gauss rules of the point force (`cell_integrals`).
3. One periodic axis: an isotropic surface that is as stiff under a line load along that axis carries the mean over the
   period and the logarithm of the distance. The difference of both has g(pi/2) = 0, so that it decays like 1 / k^3
   along the axis; it is summed over the images (`cell_integrals.image_sum`). The odd part has no mean over the period,
   and images on both sides together decay like 1 / k^3.

The formula of g: J. R. Willis, J. Mech. Phys. Solids 14 (1966) 163, and J. R. Barber & M. Ciavarella, J. Tribol. 136
(2014) 031402; not read, derived here. Verified in tests/kernels/test_anisotropic.py: relative error below 1e-12.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from bem.grid import FloatArray, Grid
from bem.kernels import semi_periodic
from bem.kernels.cell_integrals import PointResponse, cell_table, image_sum
from bem.kernels.loads import Load
from bem.materials import Material
from bem.numerics.clenshaw import cosine_sum, sine_sum
from bem.stiffness import Stiffness


def angular_function(stiffness: Stiffness, angles: FloatArray) -> FloatArray:
    """Return g(theta) [m^2/N]: a unit point force displaces the surface by g / r at a distance r."""
    even, odd = stiffness.harmonics
    found = np.zeros(np.shape(angles))
    for m, value in enumerate(even):
        found += (-1) ** m * value * np.cos(2 * m * angles)
    for m, value in enumerate(odd, start=1):
        found += (-1) ** m * value * np.sin(2 * m * angles)
    return found / (2 * np.pi)


def surface_response(kx: FloatArray, ky: FloatArray, material: Material) -> FloatArray:
    """Return the part of u / p [m/Pa] of harmonic pressures that is even in kx and ky; 0 at the mean mode.

    kx, ky : broadcast together [rad/m].
    """
    q, cosine, _ = _polar(kx, ky)
    return np.where(q > 0, cosine_sum(_harmonics(material)[0], cosine) / np.where(q > 0, q, 1.0), 0.0)


def odd_surface_response(kx: FloatArray, ky: FloatArray, material: Material) -> FloatArray:
    """Return the part of u / p [m/Pa] of harmonic pressures that is odd in kx and in ky; see `surface_response`."""
    q, cosine, sine = _polar(kx, ky)
    return np.where(q > 0, sine_sum(_harmonics(material)[1], cosine, sine) / np.where(q > 0, q, 1.0), 0.0)


def _polar(x: FloatArray, y: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the distance, and cosine and sine of twice the angle from x (0 at the origin)."""
    distance = np.hypot(x, y)
    safe = np.where(distance > 0, distance, 1.0)
    return distance, (x - y) * (x + y) / safe**2, 2 * (x / safe) * (y / safe)


def surface_table(grid: Grid, material: Material) -> FloatArray:
    """Return the normal surface displacement [m/Pa] at offsets (i dx, j dy) from a cell under unit pressure, (nx, ny).

    The part that is even along each axis. On a grid with one periodic axis the images of the cell are summed; the datum
    is that of `semi_periodic`.
    """
    even = _harmonics(material)[0]
    if grid.periodic[0]:  # with the axes exchanged: theta becomes pi/2 - theta
        turned = even * _signs(0, len(even))
        return np.ascontiguousarray(_even_table(_exchanged(grid), turned).T)
    return _even_table(grid, even)


def odd_surface_table(grid: Grid, material: Material) -> FloatArray:
    """Return the part of the displacement of `surface_table` that is odd along both axes, (nx, ny)."""
    odd = _harmonics(material)[1]
    if grid.periodic[0]:
        return np.ascontiguousarray(_odd_table(_exchanged(grid), -odd * _signs(1, len(odd))).T)
    return _odd_table(grid, odd)


def _exchanged(grid: Grid) -> Grid:
    """Return the grid, periodic along x, with its axes exchanged."""
    return Grid(grid.shape[::-1], grid.spacing[::-1], periodic=(False, True))


def _even_table(grid: Grid, even: FloatArray) -> FloatArray:
    """Return the table of a surface with the harmonics a_m on a grid that is free along x at least."""
    point = even * _signs(0, len(even)) / (2 * np.pi)
    if not grid.periodic[1]:
        return _table_of_point(grid, CrystalPoint(point))
    material = Material("as stiff under a line load", youngs_modulus=2 / float(even.sum()), poissons_ratio=0.0)
    mean: FloatArray = semi_periodic.surface_table(grid, material, Load.NORMAL)
    if grid.shape[1] == 1:
        return mean
    point[0] -= float(even.sum()) / (2 * np.pi)  # g(pi/2), of a line load along y
    return mean + _table_of_point(grid, CrystalPoint(point))


def _odd_table(grid: Grid, odd: FloatArray) -> FloatArray:
    """Return the table of a surface with the harmonics b_m on a grid that is free along x at least."""
    return _table_of_point(grid, OddCrystalPoint(odd * _signs(1, len(odd)) / (2 * np.pi)))


def _table_of_point(grid: Grid, response: PointResponse) -> FloatArray:
    """Return a point response integrated over a cell, and summed over its images where y is periodic, (nx, ny)."""
    unit = math.sqrt(grid.cell_area)
    dx, dy = grid.spacing[0] / unit, grid.spacing[1] / unit
    x, y = dx * np.arange(grid.shape[0], dtype=np.float64), dy * np.arange(grid.shape[1], dtype=np.float64)
    integrate = image_sum if grid.periodic[1] else cell_table
    return unit * integrate(x, y, (dx, dy), response)


def _harmonics(material: Material) -> tuple[FloatArray, FloatArray]:
    """Return the coefficients a_m and b_m [1/Pa]."""
    assert material.stiffness is not None
    return material.stiffness.harmonics


def _signs(first: int, count: int) -> FloatArray:
    """Return (-1)^m of the orders m from the first one on."""
    return np.asarray((-1.0) ** np.arange(first, first + count))


class CrystalPoint:
    """Point response g(theta) / r, g = sum of c_m cos(2 m theta)."""

    parity = 1

    def __init__(self, coefficients: FloatArray) -> None:
        self.coefficients = coefficients
        self.along_x = _Corner(coefficients)
        self.along_y = _Corner(coefficients * _signs(0, len(coefficients)))

    def value(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return g / r at offsets x and y."""
        squared_x, squared_y = x**2, y**2
        squared = squared_x + squared_y
        return cosine_sum(self.coefficients, (squared_x - squared_y) / squared) / np.sqrt(squared)

    def near(self, x: FloatArray, y: FloatArray, a: float, b: float) -> FloatArray:
        """Return the integral of g / r over |x'| < a, |y'| < b at points (n,)."""
        return _over_rectangle(self._to_corner, x, y, a, b)

    def _to_corner(self, u: FloatArray, v: FloatArray) -> FloatArray:
        """Return the integral over the rectangle from the origin to the corner (u, v), odd in both."""
        right, up = np.abs(u), np.abs(v)
        corner: FloatArray = right * self.along_x(right, up) + up * self.along_y(up, right)
        return np.sign(u) * np.sign(v) * corner

    def beyond(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return the integral of g / r along y from y to infinity, for g(pi/2) = 0."""
        return self.along_x.whole - self.along_x(np.abs(x), y)


class OddCrystalPoint:
    """Point response g(theta) / r, g = sum of c_m sin(2 m theta), m from 1."""

    parity = -1

    def __init__(self, coefficients: FloatArray) -> None:
        self.coefficients = coefficients
        self.along_x = _OddCorner(coefficients)
        self.along_y = _OddCorner(-coefficients * _signs(1, len(coefficients)))  # sin(2 m (pi/2 - theta))

    def value(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return g / r at offsets x and y."""
        squared_x, squared_y = x**2, y**2
        squared = squared_x + squared_y
        cosine, sine = (squared_x - squared_y) / squared, 2 * x * y / squared
        return sine_sum(self.coefficients, cosine, sine) / np.sqrt(squared)

    def near(self, x: FloatArray, y: FloatArray, a: float, b: float) -> FloatArray:
        """Return the integral of g / r over |x'| < a, |y'| < b at points (n,)."""
        return _over_rectangle(self._to_corner, x, y, a, b)

    def _to_corner(self, u: FloatArray, v: FloatArray) -> FloatArray:
        """Return the integral over the rectangle from the origin to the corner (u, v), even in both."""
        right, up = np.abs(u), np.abs(v)
        corner: FloatArray = right * self.along_x(right, up) + up * self.along_y(up, right)
        return corner

    def beyond(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return the integral of g / r along y from y to infinity."""
        return np.sign(x) * self.along_x.rest(np.abs(x), y)


def _over_rectangle(
    to_corner: Callable[[FloatArray, FloatArray], FloatArray], x: FloatArray, y: FloatArray, a: float, b: float
) -> FloatArray:
    """Return an integral over |x'| < a, |y'| < b at points (n,) from those over rectangles from a point to a corner."""
    left, right, lower, upper = x - a, x + a, y - b, y + b
    return to_corner(left, lower) - to_corner(left, upper) - to_corner(right, lower) + to_corner(right, upper)


class _Corner:
    """P: the integral of g / cos from 0 to theta = arctan(v / u), for g = sum of c_m cos(2 m theta).

    The integrals I_m of cos(2 m theta) / cos(theta) obey I_m + I_(m-1) = 2 sin((2 m - 1) theta) / (2 m - 1), and I_0 =
    arsinh(tan theta). So P = g(pi/2) arsinh(tan theta) + sum of s_j sin((2 j - 1) theta), with s_j = 2 / (2 j - 1)
    times the sum of (-1)^(m - j) c_m over m from j.
    """

    def __init__(self, coefficients: FloatArray) -> None:
        signs = _signs(0, len(coefficients))
        tails = np.cumsum((signs * coefficients)[::-1])[::-1]
        self.logarithmic = float(tails[0])
        orders = np.arange(1, len(coefficients))
        self.sines = 2 * signs[1:] * tails[1:] / (2 * orders - 1)
        self.whole = float(np.sum(self.sines * (-1.0) ** (orders + 1)))
        """P at theta = pi/2 without its logarithm."""

    def __call__(self, u: FloatArray, v: FloatArray) -> FloatArray:
        """Return P at corners (u, v), not negative; 0 at u = 0, where it is multiplied by u."""
        u, v = np.broadcast_arrays(u, v)
        safe = np.where(u > 0, u, 1.0)
        found = self.logarithmic * np.arcsinh(v / safe)
        theta = np.arctan2(v, u)
        for number, value in enumerate(self.sines):
            found += value * np.sin((2 * number + 1) * theta)
        return np.where(u > 0, found, 0.0)


class _OddCorner:
    """P: the integral of g / cos from 0 to theta = arctan(v / u), for g = sum of c_m sin(2 m theta), m from 1.

    The integrals J_m of sin(2 m theta) / cos(theta) obey J_m + J_(m-1) = 2 [1 - cos((2 m - 1) theta)] / (2 m - 1), and
    J_0 = 0. So P = sum of s_j [1 - cos((2 j - 1) theta)], with s_j = 2 / (2 j - 1) times the sum of (-1)^(m - j) c_m
    over m from j.
    """

    def __init__(self, coefficients: FloatArray) -> None:
        signs = _signs(1, len(coefficients))
        tails = np.cumsum((signs * coefficients)[::-1])[::-1]
        self.factors = 2 * signs * tails / (2 * np.arange(1, len(coefficients) + 1) - 1)

    def __call__(self, u: FloatArray, v: FloatArray) -> FloatArray:
        """Return P at corners (u, v), not negative."""
        theta = np.arctan2(v, u)
        found = np.zeros(theta.shape)
        for number, value in enumerate(self.factors):
            found += 2 * value * np.sin((number + 0.5) * theta) ** 2
        return found

    def rest(self, u: FloatArray, v: FloatArray) -> FloatArray:
        """Return the integral from theta to pi/2 at corners (u, v), not negative."""
        theta = np.arctan2(v, u)
        found = np.zeros(theta.shape)
        for number, value in enumerate(self.factors):
            found += value * np.cos((2 * number + 1) * theta)
        return found
