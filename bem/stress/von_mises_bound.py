"""Upper bound on von Mises stress at a depth from the largest pressure and the sum of pressures; no transform.

Each component that von Mises stress depends on is a sum over the cells j of p_j k_j, where the kernel k includes the
traction friction x pressure. With k^+ and k^- the positive and negative parts of k, p >= 0 gives

    -sum p_j k_j^-  <=  sum p_j k_j  <=  sum p_j k_j^+,

and for either sign of k, p_j <= m, sum p_j = P and any t >= 0

    sum p_j k_j^+  <=  m sum max(k_j - t, 0) + t P.

The larger of both sums bounds the magnitude of the component, and von Mises stress grows with every magnitude. Where p
has negative values, abs(p) takes the place of p and the sum of both parts bounds the magnitude. The right-hand side is
minimised over t = 0 and powers of two. A residual stress of the body adds its magnitude to that of the component e. The
sums over max(k - t, 0) take one pass over the kernel and are cached for
each depth. The proof is this project's own.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from bem.compiled import compiled
from bem.grid import FloatArray, Grid
from bem.kernels.coefficients import STRESS_PARITY, stress_coefficients
from bem.kernels.spectral import stress_response
from bem.materials import Body
from bem.numerics.cache import KeptValues
from bem.stress.request import check_request
from bem.stress.spectra import COUNT, elastic_ratios, pressure_and_friction

_TABLES = KeptValues(1 << 27)
"""Cache of the tables of `_table` (128 MiB, apart from `set_stress_memory`)."""


def von_mises_upper_bound(
    pressure: ArrayLike, grid: Grid, body: Body, depths: ArrayLike, *, friction: float = 0.0
) -> FloatArray:
    """Return an upper bound on von Mises stress at each depth.

    Two to three times the maximum below a rough contact. A depth takes one pass over its kernel at first use.

    Parameters
    ----------
    pressure : (nx, ny) [Pa].
    grid, body, depths, friction : as in `subsurface_stress`.

    Returns
    -------
    (nz,) [Pa].

    Raises
    ------
    InputError : as `subsurface_stress`.
    """
    places, coefficient = check_request("von_mises_upper_bound", grid, body, depths, friction)
    field = grid.check_field(pressure, "pressure")
    either_sign = float(field.min()) < 0
    magnitude = np.abs(field) if either_sign else field
    largest, total = float(magnitude.max()), float(magnitude.sum())
    bound = np.empty(len(places))
    sweep = _TABLES.begin_sweep()
    for index, depth in enumerate(places):
        key = (grid, elastic_ratios(body), depth, coefficient)
        above = _TABLES.of(key, partial(_table, grid, body, depth, coefficient), sweep)
        parts = (largest * above + total * _THRESHOLDS).min(axis=1).reshape(5, 2)
        component = parts.sum(axis=1) if either_sign else parts.max(axis=1)
        component[1] += abs(body.residual_stress_at(depth))  # e = zz - (xx + yy)/2
        square = 0.75 * component[0] ** 2 + component[1] ** 2 + 3 * float((component[2:] ** 2).sum())
        # the last factor covers the round-off of sums over all cells
        bound[index] = math.sqrt(square) * (1 + 1e-9)
    return bound


def _table(grid: Grid, body: Body, depth: float, friction: float) -> FloatArray:
    """Return the sums of max(k - t, 0) over a kernel for each part of `_PARTS` and threshold t, (10, 49)."""
    COUNT.bounds += 1
    normal, tangential = _kernel_values(grid, body, depth, friction)
    above = np.zeros((_PARTS, _LEVELS + 1))
    _sums_above(normal, tangential, grid.periodic[0], grid.periodic[1], above)
    return above


_PARTS = 10
"""Number of positive and negative parts of the components d, e, yz, xz, xy (`spectra`)."""
_LEVELS = 48
"""Number of positive thresholds."""
_HIGHEST = 4
"""Exponent of the highest threshold 2^4; stresses under a loaded cell are of the order of its pressure."""
_THRESHOLDS: FloatArray = np.append(2.0 ** (_HIGHEST - np.arange(_LEVELS)), 0.0)


def _kernel_values(grid: Grid, body: Body, depth: float, friction: float) -> FloatArray:
    """Return six stresses at offsets >= 0 from a cell, under unit pressure and under friction, (2, 6, nx, ny)."""
    kernels = np.zeros((2, 6, *grid.shape))
    for load, factor in pressure_and_friction(friction):
        if all(grid.periodic):
            import scipy.fft

            response = stress_response(grid, body, depth, load)
            for component, (px, py) in enumerate(STRESS_PARITY[load]):
                spectrum = response[component] * (1.0 if px * py > 0 else 1j)
                kernels[load.value, component] = factor * scipy.fft.irfft2(spectrum, s=grid.shape)
        else:
            kernels[load.value] = factor * stress_coefficients(grid, body, depth, load)
    return kernels


@compiled
def _sums_above(normal, tangential, wraps_x, wraps_y, above):
    """Sum max(k - t, 0) over all offsets of a grid for the thresholds t of `_THRESHOLDS`, into (parts, levels + 1)."""
    count, levels = above.shape
    _, nx, ny = normal.shape
    sums = np.zeros((count, levels))
    numbers = np.zeros((count, levels))
    parts = np.empty(count)
    for i in range(0 if wraps_x else 1 - nx, nx):
        for j in range(0 if wraps_y else 1 - ny, ny):
            _signed_parts(normal, tangential, i, j, parts)
            for c in range(count):
                if parts[c] > 0.0:
                    # 2^(e - 1) <= k < 2^e: k counts for the threshold 2^(e - 1) and all lower ones
                    level = min(max(_HIGHEST - math.frexp(parts[c])[1] + 1, 0), levels - 1)
                    sums[c, level] += parts[c]
                    numbers[c, level] += 1.0
    for c in range(count):
        total = 0.0
        number = 0.0
        for level in range(levels):
            total += sums[c, level]
            number += numbers[c, level]
            threshold = 0.0 if level == levels - 1 else 2.0 ** (_HIGHEST - level)
            above[c, level] = total - threshold * number


@compiled
def _signed_parts(normal, tangential, i, j, out):
    """Write the parts (10,) of the kernel at offset (i, j) to `out`, by the parities of both loads."""
    k = abs(i)
    m = abs(j)
    sx = -1.0 if i < 0 else 1.0
    sy = -1.0 if j < 0 else 1.0
    xx = normal[0, k, m] + sx * tangential[0, k, m]
    yy = normal[1, k, m] + sx * tangential[1, k, m]
    zz = normal[2, k, m] + sx * tangential[2, k, m]
    yz = sy * (normal[3, k, m] + sx * tangential[3, k, m])
    xz = sx * normal[4, k, m] + tangential[4, k, m]
    xy = sy * (sx * normal[5, k, m] + tangential[5, k, m])
    for c in range(5):
        value = xx - yy
        if c == 1:
            value = zz - 0.5 * (xx + yy)
        elif c == 2:
            value = yz
        elif c == 3:
            value = xz
        elif c == 4:
            value = xy
        out[2 * c] = max(value, 0.0)
        out[2 * c + 1] = max(-value, 0.0)
