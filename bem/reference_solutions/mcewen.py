"""Stresses below a cylindrical Hertz contact and below a sinusoidal pressure, at rest and sliding.

McEwen, *Phil. Mag.* 40 (1949) 454; Johnson, *Contact Mechanics* (1985), 4.49 and 7.6. Instead of McEwen's m and n the
half-plane is solved by one complex function: with w = x + i z and
F(w) = (1/pi) integral p(s)/(w - s) ds = (p0/a) (w - sqrt(w^2 - a^2)),

    pressure p:     xx = Im F + z Re F',  zz = Im F - z Re F',  xz = -z Im F'
    traction f p:   xx = f (-2 Re F + z Im F'),  zz = -f z Im F',  xz = f (Im F + z Re F')
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

FloatArray = NDArray[np.float64]


def cylinder_stress(
    x: ArrayLike,
    z: ArrayLike,
    *,
    half_width: float,
    maximum_pressure: float,
    poissons_ratio: float,
    friction: float = 0.0,
) -> FloatArray:
    """Stress (6, ...) [Pa], order xx yy zz yz xz xy, of a sliding cylinder; shapes of x and z [m] are broadcast.

    Plane strain in y; traction friction x pressure along +x on the body; z >= 0 into it; tension positive.
    """
    x, z = np.broadcast_arrays(np.asarray(x, dtype=np.float64), np.asarray(z, dtype=np.float64))
    w = (x + 1j * np.abs(z)) / half_width
    root = np.sqrt(w - 1) * np.sqrt(w + 1)  # the branch that goes like w at infinity, for z >= 0
    f = maximum_pressure / (w + root)
    depth = np.abs(z) / half_width
    with np.errstate(divide="ignore", invalid="ignore"):
        depth_slope = np.where(depth > 0, -depth * f / root, 0.0)  # z F'; bounded up to the edge of the contact
    xx = f.imag + depth_slope.real - friction * (2 * f.real - depth_slope.imag)
    zz = f.imag - depth_slope.real - friction * depth_slope.imag
    xz = -depth_slope.imag + friction * (f.imag + depth_slope.real)
    zero = np.zeros_like(xx)
    return np.stack([xx, poissons_ratio * (xx + zz), zz, zero, xz, zero])


def sinusoidal_stress(
    x: ArrayLike,
    z: ArrayLike,
    *,
    wavenumber: float,
    amplitude: float,
    poissons_ratio: float,
    friction: float = 0.0,
) -> FloatArray:
    """Stress (6, ...) [Pa], order xx yy zz yz xz xy, of pressure amplitude cos(wavenumber x) and friction times it.

    F = -i amplitude exp(i k w): xx = (kz - 1) p, zz = -(kz + 1) p, decaying like exp(-kz); plane strain in y
    (Johnson 2.7 for the general method). Wavenumber [rad/m], amplitude [Pa].
    """
    x, z = np.broadcast_arrays(np.asarray(x, dtype=np.float64), np.asarray(z, dtype=np.float64))
    depth = wavenumber * np.abs(z)
    decay = amplitude * np.exp(-depth)
    even, odd = decay * np.cos(wavenumber * x), decay * np.sin(wavenumber * x)
    xx = (depth - 1) * even + friction * (depth - 2) * odd
    zz = -(depth + 1) * even - friction * depth * odd
    xz = -depth * odd + friction * (depth - 1) * even
    zero = np.zeros_like(xx)
    return np.stack([xx, poissons_ratio * (xx + zz), zz, zero, xz, zero])
