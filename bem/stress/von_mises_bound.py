"""Upper bound on von Mises stress at a depth, without any transform: depths that cannot yield are skipped."""

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
"""Cache of the sums over a kernel above the thresholds."""


def von_mises_limit(
    pressure: ArrayLike, grid: Grid, body: Body, depths: ArrayLike, *, friction: float = 0.0
) -> FloatArray:
    """Return an upper bound on von Mises stress at each depth from the largest pressure and the sum of pressures.

    A depth needs one pass over its kernel, whose table is cached; the bound itself then costs a few operations. It is
    two to three times the maximum of a rough contact.

    Proof. Each of d, e, yz, xz, xy at a point is the sum over the cells j of p_j k_j (traction included in k). For
    p >= 0 it lies between minus the sum of p_j k_j^- and the sum of p_j k_j^+, where k^+ and k^- are the positive and
    negative parts of k: the larger of the two sums bounds its magnitude, and von Mises grows with every magnitude.
    (Where p has negative values their sum bounds it, with |p|.) With p_j <= m and sum p_j = P, any t >= 0 gives

        sum p_j k_j  <=  m sum max(k_j - t, 0) + t P;

    the least over powers of two for t, and t = 0, is taken, and sums run over every offset the grid has.

    Returns
    -------
    (nz,) [Pa].

    Raises
    ------
    InputError : as `subsurface_stress`.
    """
    places, coefficient = check_request("von_mises_limit", grid, body, depths, friction)
    field = grid.check_field(pressure, "pressure")
    either_sign = float(field.min()) < 0
    magnitude = np.abs(field) if either_sign else field
    largest, total = float(magnitude.max()), float(magnitude.sum())
    limit = np.empty(len(places))
    sweep = _TABLES.begin_sweep()
    for index, depth in enumerate(places):
        key = (grid, elastic_ratios(body), depth, coefficient)
        above = _TABLES.of(key, partial(_table, grid, body, depth, coefficient), sweep)
        parts = (largest * above + total * _THRESHOLDS).min(axis=1).reshape(5, 2)
        reach = parts.sum(axis=1) if either_sign else parts.max(axis=1)
        # the last factor covers the round-off of sums over all cells
        limit[index] = math.sqrt(0.75 * reach[0] ** 2 + reach[1] ** 2 + 3 * float((reach[2:] ** 2).sum())) * (1 + 1e-9)
    return limit


def _table(grid: Grid, body: Body, depth: float, friction: float) -> FloatArray:
    """Compute the sums over the kernel of a depth above each threshold, (parts, levels + 1)."""
    COUNT.bounds += 1
    normal, tangential = _kernel_values(grid, body, depth, friction)
    above = np.zeros((_PARTS, _LEVELS + 1))
    _sums_above(normal, tangential, grid.periodic[0], grid.periodic[1], above)
    return above


_PARTS = 10
"""Positive and negative parts of d, e, yz, xz, xy."""
_LEVELS = 48
"""Number of thresholds above 0."""
_HIGHEST = 4
"""Exponent of the highest threshold; coefficients of a cell are of order one."""
_THRESHOLDS: FloatArray = np.append(2.0 ** (_HIGHEST - np.arange(_LEVELS)), 0.0)


def _kernel_values(grid: Grid, body: Body, depth: float, friction: float) -> FloatArray:
    """Compute six stresses of a cell under pressure and under traction at non-negative offsets, (2, 6, nx, ny)."""
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
    """Write the parts of the kernel (see _PARTS) at offset (i, j), by the parities of both loads."""
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
