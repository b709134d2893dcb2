"""Temperatures of uniformly or parabolically heated patches on a half-space, at rest and moving; closed forms.

H. S. Carslaw and J. C. Jaeger, *Conduction of Heat in Solids*, 2nd ed. (1959), sections 10.5 and 10.7; J. C. Jaeger,
Proc. R. Soc. NSW 76 (1942) 203; X. Tian and F. E. Kennedy, J. Tribol. 116 (1994) 167. The Peclet number is
U a / (2 kappa) with the half-width or radius a throughout.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import ellipe, k0e, k1e

FloatArray = NDArray[np.float64]

SQUARE_MAXIMUM = 4 * math.asinh(1.0) / math.pi
"""Of flux x half-side / conductivity, a square at rest under uniform flux, in its middle: 1.122."""
SQUARE_MEAN = (4 * math.asinh(1.0) + 4 * (1 - math.sqrt(2)) / 3) / math.pi
"""The same of the mean over the square: 0.946."""
DISC_MAXIMUM = 1.0
"""Of flux x radius / conductivity, a disc at rest under uniform flux."""
DISC_MEAN = 8 / (3 * math.pi)
"""The same of the mean over the disc: 0.849."""
HERTZ_MAXIMUM = math.pi / 4
"""Of largest flux x radius / conductivity, a disc at rest whose flux is a semi-ellipsoid."""
FAST_MAXIMUM = 2 / math.sqrt(math.pi)
"""Of flux x half-width / (conductivity sqrt(Peclet)), a fast band under uniform flux, at its trailing edge."""
FAST_MEAN = 4 / (3 * math.sqrt(math.pi))
"""The same of the mean over the band; with sqrt(kappa / (U a)) for 1/sqrt(Peclet) it is 1.064."""


def rectangle_at_rest(x: ArrayLike, y: ArrayLike, half_sides: tuple[float, float]) -> FloatArray:
    """Temperature x conductivity / flux [m] on the surface, a rectangle at rest (ibid. 10.5, as Love's potential)."""
    a, b = half_sides
    total = np.zeros(np.broadcast_shapes(np.shape(x), np.shape(y)))
    for u, sign_u in ((np.asarray(x) + a, 1), (np.asarray(x) - a, -1)):
        for v, sign_v in ((np.asarray(y) + b, 1), (np.asarray(y) - b, -1)):
            with np.errstate(divide="ignore", invalid="ignore"):
                first = np.where(u == 0, 0.0, u * np.arcsinh(v / np.abs(u)))
                second = np.where(v == 0, 0.0, v * np.arcsinh(u / np.abs(v)))
            total += sign_u * sign_v * (first + second)
    return np.asarray(total / (2 * math.pi))


def disc_at_rest(radius_ratio: ArrayLike) -> FloatArray:
    """Temperature x conductivity / (flux x radius) at r / radius <= 1, a disc at rest: 2 E(r) / pi."""
    return np.asarray(2 / math.pi * ellipe(np.asarray(radius_ratio, dtype=float) ** 2))


def moving_band(position: ArrayLike, peclet: float) -> FloatArray:
    """Temperature x conductivity / (flux x half-width) at x / half-width, Jaeger's band; the body moves along +x.

    exp(w u) K0(w |u|) / pi over the band, whose integral is u exp(w u) (K0 + sign(u) K1).
    """

    def integral(u: FloatArray) -> FloatArray:
        distance = np.maximum(np.abs(u), 1e-300)
        sign = np.where(u < 0, -1.0, 1.0)
        return np.asarray(u * np.exp(u - distance) * (k0e(distance) + sign * k1e(distance)))

    x = np.asarray(position, dtype=float)
    return np.asarray((integral(peclet * (x + 1)) - integral(peclet * (x - 1))) / (math.pi * peclet))


def tian_kennedy(patch: str, peclet: float) -> float:
    """Interpolated temperature x conductivity / (mean flux x half-width or radius); within 5 % at any Peclet number.

    patch : "disc maximum", "disc mean", "square maximum" (uniform flux) or "hertz maximum" (semi-ellipsoid).
    """
    factor, offset = {
        "disc maximum": (2.0, 1.273),
        "disc mean": (1.22, 0.6575),
        "square maximum": (2.0, 1.011),
        "hertz maximum": (2.32, 1.234),
    }[patch]
    return factor / math.sqrt(math.pi * (offset + peclet))
