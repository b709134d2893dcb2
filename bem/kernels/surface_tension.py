"""Surface of an isotropic half-space with surface tension under pressure: point force, loaded cells, harmonic pressure.

A surface of tension gamma pulls a wave of wavenumber q flat with the pressure gamma q^2 u, beside the elastic E q / 2 u
(E the plane-strain modulus; slopes are small, and the tension does not change with the strain of the surface):

    u = 2 p / (E q + 2 gamma q^2) = 2 p / (E q (1 + q s)),   s = 2 gamma / E the elastocapillary length.

The inverse transform of a unit point force at a distance r is

    u = f(r / s) / (pi E s),   f(t) = pi/2 [H_0(t) - Y_0(t)] = integral over w from 0 to infinity of exp(-t sinh w),

with Struve's function H_0 and Neumann's Y_0: -ln(t / 2) - 0.5772 within s, the 1 / t of Boussinesq beyond.

1. Near the cell: in polar coordinates about the point, the radial integral of f is a function of the distance to the
   edge of the cell, and Gauss rules along each edge integrate it over the angle.
2. Far from it: Gauss rules of the point force (`cell_integrals`).
3. One periodic axis: `semi_periodic` of the half-space without tension, and the difference f(t) - 1 / t ~ 1 / t^3
   summed over the images (`cell_integrals.image_sum`).
4. f and its radial integral are interpolated from tables of Chebyshev polynomials, with a factor of two in t for each
   (`RadialFunction`); series below and above.

M. A. Hajji, J. Appl. Mech. 45 (1978) 320, and J. M. Long & G. F. Wang, Mech. Mater. 56 (2013) 65, have the point force;
not read, derived here. Verified in tests/kernels/test_surface_tension.py: relative error below 1e-12.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

import numpy as np
from numpy.typing import NDArray

from bem.grid import FloatArray, Grid
from bem.kernels import semi_periodic
from bem.kernels.cell_integrals import cell_table, image_sum
from bem.kernels.loads import Load
from bem.materials import Material
from bem.numerics.clenshaw import cosine_sum

_LOWEST, _HIGHEST = -30, 6
"""Powers of two of t between which f is a table; below, the logarithm and t are exact, above the series is."""

_ORDER = 18
"""Chebyshev nodes for each factor of two in t."""

_SERIES = [math.prod(range(1, 2 * k, 2)) ** 2 for k in range(9)]
"""Coefficients of the asymptotic series of f: sum of (-1)^k ((2k-1)!!)^2 / t^(2k+1)."""

_EDGE_POINTS = 28
"""Gauss points along an edge of a near cell."""


class RadialFunction:
    """f(t) = pi/2 [H_0(t) - Y_0(t)], and the integral of t f(t) from 0 to t; relative error below 1e-14."""

    def __init__(self) -> None:
        angles = (np.arange(_ORDER) + 0.5) * np.pi / _ORDER
        orders = np.arange(_ORDER)
        analysis = np.cos(orders[:, None] * angles) * np.where(orders > 0, 2.0, 1.0)[:, None] / _ORDER
        middles = 1.5 * 2.0 ** np.arange(_LOWEST, _HIGHEST)
        at = middles[:, None] * (1 + np.cos(angles) / 3)
        self.values = _laplace(at) @ analysis.T
        nodes, weights = np.polynomial.legendre.leggauss(_ORDER)
        gauss = middles[:, None] * (1 + nodes / 3)
        panels = (gauss * _laplace(gauss)) @ weights * (middles / 3)
        first = 2.0**_LOWEST
        start = 0.5 * first**2 * (0.5 - math.log(first / 2) - np.euler_gamma) + first**3 / 3
        ends = start + np.concatenate([[0.0], np.cumsum(panels)])
        # the integral to each node, from the antiderivative of the interpolant of t f
        derivative = (at * _laplace(at)) @ analysis.T
        integrals = np.polynomial.chebyshev.chebint(derivative, axis=1, lbnd=-1) * (middles / 3)[:, None]
        integrals[:, 0] += ends[:-1]
        self.integrals = integrals

    def value(self, t: FloatArray) -> FloatArray:
        """Return f(t), t > 0."""
        out, low, high = self._table(self.values, t)
        if low.any():
            out[low] = -np.log(0.5 * t[low]) - np.euler_gamma + t[low]
        if high.any():
            inverse = 1 / t[high]
            out[high] = inverse * _horner([(-1) ** k * a for k, a in enumerate(_SERIES)], inverse * inverse)
        return out

    def excess(self, t: FloatArray) -> FloatArray:
        """Return f(t) - 1/t, which falls as -1/t^3."""
        out = self.value(t) - 1 / t
        high = t >= 2.0**_HIGHEST
        if high.any():
            inverse = 1 / t[high]
            out[high] = inverse**3 * _horner([(-1) ** k * a for k, a in enumerate(_SERIES)][1:], inverse * inverse)
        return out

    def integral(self, t: FloatArray) -> FloatArray:
        """Return the integral of t f(t) from 0 to t."""
        out, low, high = self._table(self.integrals, t)
        if low.any():
            small = t[low]
            out[low] = 0.5 * small**2 * (0.5 - np.log(0.5 * small) - np.euler_gamma) + small**3 / 3
        if high.any():
            inverse = 1 / t[high]
            terms = [(-1) ** k * a / (1 - 2 * k) for k, a in enumerate(_SERIES)]
            out[high] = t[high] * _horner(terms, inverse * inverse) - 1
        return out

    def _table(
        self, coefficients: FloatArray, t: FloatArray
    ) -> tuple[FloatArray, NDArray[np.bool_], NDArray[np.bool_]]:
        """Return the values between the ends of the table, and where t lies below and above it."""
        low, high = t < 2.0**_LOWEST, t >= 2.0**_HIGHEST
        out, inside = np.empty_like(t), ~(low | high)
        within = t[inside]
        exponent = np.frexp(within)[1] - 1
        x = 3 * (within / (1.5 * np.exp2(exponent)) - 1)
        out[inside] = cosine_sum(coefficients.T[:, exponent - _LOWEST], x)
        return out, low, high


@cache
def radial_function() -> RadialFunction:
    """Return the tables of f, made once."""
    return RadialFunction()


def _laplace(t: FloatArray) -> FloatArray:
    """Return f(t) as the integral of exp(-t sinh w), by 16 Gauss panels up to where the exponential is 1e-18."""
    nodes, weights = np.polynomial.legendre.leggauss(20)
    panels = 16
    width = np.arcsinh(41.5 / t) / panels
    total = np.zeros_like(t)
    for panel in range(panels):
        for node, weight in zip(nodes, weights, strict=True):
            total += 0.5 * weight * np.exp(-t * np.sinh((panel + 0.5 * (1 + node)) * width))
    return total * width


def _horner(coefficients: list[float], x: FloatArray) -> FloatArray:
    total = np.full_like(x, coefficients[-1])
    for value in coefficients[-2::-1]:
        total = value + x * total
    return total


class TensePoint:
    """Point response f(r / s) / s."""

    parity = 1

    def __init__(self, length: float) -> None:
        self.length, self.radial = length, radial_function()

    def value(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return f(r / s) / s at offsets x and y."""
        return self.radial.value(np.sqrt(x**2 + y**2) / self.length) / self.length

    def near(self, x: FloatArray, y: FloatArray, a: float, b: float) -> FloatArray:
        """Return the integral of f(r / s) / s over |x'| < a, |y'| < b at points (n,)."""
        return _edges(x, y, a, b, lambda r: self.length * self.radial.integral(r / self.length))

    def beyond(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Raise: without Boussinesq's part taken off the integral does not exist."""
        raise NotImplementedError("the integral over the rest of the plane diverges; take TenseExcess")


class TenseExcess(TensePoint):
    """Point response f(r / s) / s - 1 / r: what tension takes off."""

    far: tuple[tuple[float, bytes], FloatArray] | None = None
    """The last integral beyond a power of two, with its key: images differ in what lies below."""

    def value(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return the response at offsets x and y."""
        return self.radial.excess(np.sqrt(x**2 + y**2) / self.length) / self.length

    def near(self, x: FloatArray, y: FloatArray, a: float, b: float) -> FloatArray:
        """Return the integral of the response over |x'| < a, |y'| < b at points (n,)."""
        return _edges(x, y, a, b, lambda r: self.length * self.radial.integral(r / self.length) - r)

    def beyond(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return the integral along y from y to infinity.

        One Gauss rule from y to the next power of two, and from there panels of twice the length up to 1e8 s, beyond
        which the excess is lost in round-off.
        """
        nodes, weights = np.polynomial.legendre.leggauss(16)
        start = 2.0 ** math.ceil(math.log2(float(y.max())))
        total = np.zeros(np.broadcast_shapes(x.shape, y.shape))
        for node, weight in zip(nodes, weights, strict=True):
            at = y + 0.5 * (1 + node) * (start - y)
            total += 0.5 * weight * (start - y) * self.value(x, at)
        key = (start, x.tobytes())
        if self.far is None or self.far[0] != key:
            panels = max(1, math.ceil(math.log2(1e8 * self.length / start)))
            lows = start * 2.0 ** np.arange(panels)
            at = (lows[:, None] * (1.5 + 0.5 * nodes)).reshape(1, -1)
            weight_of = (0.5 * lows[:, None] * weights).reshape(-1)
            self.far = key, (self.value(x, at) @ weight_of)[:, None]
        return np.asarray(total + self.far[1])


def _edges(x: FloatArray, y: FloatArray, a: float, b: float, radial: Callable[[FloatArray], FloatArray]) -> FloatArray:
    """Return the integral over |x'| < a, |y'| < b at points (n,) of a function of the distance.

    radial : integral of r times the function from 0 to r. Each edge at a distance d contributes its integral over the
    angles from its normal, at the distances d / cos(angle).
    """
    nodes, weights = np.polynomial.legendre.leggauss(_EDGE_POINTS)
    total = np.zeros_like(x)
    for side in (-1.0, 1.0):
        for distance, along, half in ((a + side * x, y, b), (b + side * y, x, a)):
            d = np.abs(distance)
            inside = d > 0
            safe = np.where(inside, d, 1.0)
            first, last = np.arctan((along - half) / safe), np.arctan((along + half) / safe)
            for node, weight in zip(nodes, weights, strict=True):
                angle = 0.5 * (first + last) + 0.5 * node * (last - first)
                part = radial(safe / np.cos(angle))
                total += np.where(inside, np.sign(distance) * 0.5 * weight * (last - first) * part, 0.0)
    return total


def _strip_excess(x: FloatArray, half: float, length: float) -> FloatArray:
    """Return what tension adds under a strip |x'| < half that is endless along y, in the units of `TenseExcess`.

    A line load has the excess -2 g(|x| / s), g(z) = integral over u from 0 to infinity of cos(z u) / (1 + u), the
    auxiliary function of the cosine integral, whose integral from 0 is pi/2 - f(z) (NIST Handbook, section 6.2).
    """
    from scipy.special import sici  # loads slowly

    def integral(at: FloatArray) -> FloatArray:
        z = np.maximum(np.abs(at) / length, np.finfo(np.float64).tiny)
        sine, cosine = sici(z)
        auxiliary = cosine * np.sin(z) - (sine - 0.5 * np.pi) * np.cos(z)
        return np.asarray(np.sign(at) * (0.5 * np.pi - auxiliary))

    return -2 * length * (integral(x + half) - integral(x - half))


def surface_response(kx: FloatArray, ky: FloatArray, material: Material) -> FloatArray:
    """Return u / p [m/Pa] of harmonic pressures, kx and ky broadcast together [rad/m]; 0 at the mean mode."""
    q = np.hypot(kx, ky)
    safe = np.where(q > 0, q, 1.0)
    return np.where(
        q > 0, 2 / (material.plane_strain_modulus * safe * (1 + safe * material.elastocapillary_length)), 0.0
    )


def surface_table(grid: Grid, material: Material) -> FloatArray:
    """Return the normal surface displacement [m/Pa] at offsets (i dx, j dy) from a cell under unit pressure, (nx, ny).

    On a grid with one periodic axis the images of the cell are summed; the datum is that of `semi_periodic`.
    """
    if grid.periodic[0]:
        swapped = Grid(grid.shape[::-1], grid.spacing[::-1], periodic=(False, True))
        return np.ascontiguousarray(surface_table(swapped, material).T)
    unit = math.sqrt(grid.cell_area)
    dx, dy = grid.spacing[0] / unit, grid.spacing[1] / unit
    x, y = dx * np.arange(grid.shape[0], dtype=np.float64), dy * np.arange(grid.shape[1], dtype=np.float64)
    length, factor = material.elastocapillary_length / unit, unit / (math.pi * material.plane_strain_modulus)
    if not grid.periodic[1]:
        return factor * cell_table(x, y, (dx, dy), TensePoint(length))
    mean: FloatArray = semi_periodic.surface_table(grid, material, Load.NORMAL)
    if grid.shape[1] == 1:
        return mean + factor * _strip_excess(x, 0.5 * dx, length)[:, None]
    return mean + factor * image_sum(x, y, (dx, dy), TenseExcess(length))
