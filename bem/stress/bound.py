"""What von Mises stress can at most reach at a depth - anywhere, or in a tile - and what that allows to skip."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy.fft
from numba import njit
from numpy.typing import ArrayLike, NDArray

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.kernels.coefficients import STRESS_PARITY, stress_coefficients
from bem.kernels.spectral import stress_response
from bem.materials import Body
from bem.stress.spectra import COUNT, SweepCache, check_request, elastic, loads
from bem.stress.sweeps import Sweep, check_out, planes

_TABLES = SweepCache(1 << 27)


def von_mises_bound(
    pressure: ArrayLike,
    grid: Grid,
    body: Body,
    depths: ArrayLike,
    *,
    friction: float = 0.0,
    tile: int | None = None,
) -> FloatArray:
    """What von Mises stress can at most reach, per depth and tile of cells, from tile sums and maxima of the pressure.

    Proof. Each of d, e, yz, xz, xy at a point is the sum over the cells j of p_j k_j (traction included in k). For
    p >= 0 it lies between minus the sum of p_j k_j^- and the sum of p_j k_j^+, where k^+ and k^- are the positive and
    negative parts of k: the larger of the two sums bounds its magnitude, and von Mises grows with every magnitude.
    (Where p has negative values their sum bounds it, with |p|.) The part of such a sum over a source tile J is, for
    every point of a target tile I, at most

        sum over J of p  x  max over i in I, j in J of k(i - j),     and at most
        max over J of p  x  max over i in I of the sum over j in J of k(i - j).

    Within two tiles the lower of both is taken (a cell's own k is large), beyond them the first. Both tables depend on
    the offset between the tiles only; they are made once per depth and kept. A factor 1 + 1e-12 covers round-off here;
    the transforms behind `von_mises_field` have some 1e-15 of the largest pressure of their own.

    For single cells this is (Minkowski) never above the sum of p times the von Mises stress w of k, and far below where
    loads on either side undo each other: 1.2 to 1.5 times the true maximum of a rough contact. With tiles half as long
    as the depth it is about 2 times the true maximum.

    Parameters
    ----------
    pressure, grid, body, depths, friction : as in `subsurface_stress`.
    tile : cells along a side of a tile, default such that there are at most 40 tiles a side.

    Returns
    -------
    (nz, ceil(nx / tile), ceil(ny / tile)) [Pa]; tile (a, b) holds the cells from (a tile, b tile) on.

    Raises
    ------
    InputError : as `subsurface_stress`; a tile that is not a positive integer.
    """
    places, coefficient = check_request("von_mises_bound", grid, body, depths, friction)
    size = bound_tile(grid) if tile is None else tile
    if isinstance(size, bool) or not isinstance(size, int | np.integer) or size < 1:
        raise InputError(f"von_mises_bound: tile {tile!r} must be a positive integer number of cells")
    field = grid.check_field(pressure, "pressure")
    either_sign = bool((field < 0).any())
    size = int(size)
    tiles = (-(-grid.shape[0] // size), -(-grid.shape[1] // size))
    whole = np.zeros((tiles[0] * size, tiles[1] * size))
    whole[: grid.shape[0], : grid.shape[1]] = np.abs(field)
    blocks = whole.reshape(tiles[0], size, tiles[1], size)
    largest = np.ascontiguousarray(blocks.max(axis=(1, 3)))
    total = np.ascontiguousarray(blocks.sum(axis=(1, 3)))
    padded = (scipy.fft.next_fast_len(2 * tiles[0] - 1), scipy.fft.next_fast_len(2 * tiles[1] - 1, real=True))
    waves = scipy.fft.rfft2(total, s=padded)
    bound = np.zeros((len(places), *tiles))
    sweep = _TABLES.begin()
    for index, depth in enumerate(places):
        key = (grid, elastic(body), depth, coefficient, size)
        tables: _BoundTables | None = _TABLES.get(key, sweep)
        if tables is None:
            tables = _bound_tables(grid, body, depth, coefficient, tiles, size, padded)
            _TABLES.put(key, tables, tables.nbytes, sweep)
        far = scipy.fft.irfft2(tables.far * waves, s=padded)
        _bound(largest, total, tables.near, np.ascontiguousarray(far), either_sign, bound[index])
        bound[index] *= 1 + 1e-12
        bound[index] += 1e-13 * bound[index].max()  # round-off of the transform over tiles
    return bound


def von_mises_limit(
    pressure: ArrayLike, grid: Grid, body: Body, depths: ArrayLike, *, friction: float = 0.0
) -> FloatArray:
    """What von Mises stress can at most reach at each depth, from the largest pressure and the sum of pressures alone.

    Costs next to nothing once its table (one pass over the kernel of a depth) is made; two to three times the true
    maximum of a rough contact, where `von_mises_bound` is nearer and dearer than the stress at that depth itself.

    Proof. As for `von_mises_bound`, d, e, yz, xz, xy are bounded by sums of p_j k_j^+ or p_j k_j^-. With p_j <= m and
    sum p_j = P, any t >= 0 gives

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
    sweep = _TABLES.begin()
    for index, depth in enumerate(places):
        key = (grid, elastic(body), depth, coefficient, "limit")
        above: FloatArray | None = _TABLES.get(key, sweep)
        if above is None:
            COUNT.bounds += 1
            kernels = _kernel_values(grid, body, depth, coefficient)
            above = np.zeros((_PARTS, _LEVELS + 1))
            _sums_above(kernels[0], kernels[1], grid.periodic[0], grid.periodic[1], above)
            _TABLES.put(key, above, above.nbytes, sweep)
        parts = (largest * above + total * _THRESHOLDS).min(axis=1).reshape(5, 2)
        reach = parts.sum(axis=1) if either_sign else parts.max(axis=1)
        # the last factor covers the round-off of sums over all cells
        limit[index] = math.sqrt(0.75 * reach[0] ** 2 + reach[1] ** 2 + 3 * float((reach[2:] ** 2).sum())) * (1 + 1e-9)
    return limit


def von_mises_where_above(
    threshold: float,
    pressure: ArrayLike,
    grid: Grid,
    body: Body,
    depths: ArrayLike,
    *,
    friction: float = 0.0,
    margin: int = 1,
    tile: int | None = None,
    out: FloatArray | None = None,
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Von Mises stress at those depths only where it can exceed `threshold` [Pa] anywhere, and their neighbours.

    The planes left out are certain not to reach it (`von_mises_bound`) and hold zeros; the others are bit for bit those
    of `von_mises_field`. `margin` neighbours in the order of `depths` are computed on either side, for interpolation.

    Returns
    -------
    field (nz, nx, ny) [Pa], and computed (nz,), which planes hold numbers.

    Raises
    ------
    InputError : as `von_mises_field`; a threshold that is not a number, a negative margin.
    """
    if not (isinstance(threshold, int | float | np.floating | np.integer) and not math.isnan(threshold)):
        raise InputError(f"von_mises_where_above: threshold {threshold!r} must be a number [Pa]")
    if isinstance(margin, bool) or not isinstance(margin, int | np.integer) or margin < 0:
        raise InputError(f"von_mises_where_above: margin {margin!r} must be a number of planes, 0 or more")
    places = np.asarray(depths, dtype=np.float64)
    reaches = von_mises_limit(pressure, grid, body, depths, friction=friction) > threshold
    if reaches.any():
        bound = von_mises_bound(pressure, grid, body, places[reaches], friction=friction, tile=tile)
        reaches[reaches] = bound.max(axis=(1, 2), initial=0.0) > threshold
    computed = reaches.copy()
    for shift in range(1, int(margin) + 1):
        computed[shift:] |= reaches[:-shift]
        computed[:-shift] |= reaches[shift:]
    field = check_out("von_mises_where_above", out, (reaches.size, *grid.shape))
    field[~computed] = 0.0
    wanted = np.flatnonzero(computed)
    if wanted.size:
        sweep = Sweep.of("von_mises_where_above", pressure, grid, body, places[wanted], friction)
        for _ in planes(sweep, [field[index] for index in wanted]):
            pass
    return field, computed


def bound_tile(grid: Grid) -> int:
    """Cells along a side of a tile that `von_mises_bound` takes by default."""
    return max(1, -(-max(grid.shape) // _TILES))


_TILES = 40
_NEAR = 2
_PARTS = 10  # positive and negative parts of d, e, yz, xz, xy
_LEVELS = 48
_HIGHEST = 4  # thresholds 2^4, 2^3, ... and 0: coefficients of a cell are at most of order one
_THRESHOLDS: FloatArray = np.append(2.0 ** (_HIGHEST - np.arange(_LEVELS)), 0.0)


@dataclass(frozen=True)
class _BoundTables:
    """Near: (2, 10, 5, 5), largest values and largest sums over a source tile; far: spectra of the largest values."""

    near: FloatArray
    far: NDArray[np.complex128]

    @property
    def nbytes(self) -> int:
        return self.near.nbytes + self.far.nbytes


@njit(cache=True, nogil=True, error_model="numpy")  # type: ignore[untyped-decorator]
def _bound(largest, total, near, far, either_sign, out):  # type: ignore[no-untyped-def]
    nx, ny = largest.shape
    parts = np.empty(near.shape[1])
    for ix in range(nx):
        for iy in range(ny):
            for c in range(parts.size):
                parts[c] = max(far[c, ix, iy], 0.0)
            for jx in range(max(0, ix - _NEAR), min(nx, ix + _NEAR + 1)):
                for jy in range(max(0, iy - _NEAR), min(ny, iy + _NEAR + 1)):
                    top = largest[jx, jy]
                    load = total[jx, jy]
                    if top > 0.0:
                        k = ix - jx + _NEAR
                        m = iy - jy + _NEAR
                        for c in range(parts.size):
                            parts[c] += min(load * near[0, c, k, m], top * near[1, c, k, m])
            value = 0.0
            for c in range(5):
                plus, minus = parts[2 * c], parts[2 * c + 1]
                reach = plus + minus if either_sign else max(plus, minus)
                value += (0.75 if c == 0 else (1.0 if c == 1 else 3.0)) * reach * reach
            out[ix, iy] = np.sqrt(value)


def _kernel_values(grid: Grid, body: Body, depth: float, friction: float) -> FloatArray:
    """Six stresses of a cell under pressure and under traction, (2, 6, nx, ny), at offsets from zero on."""
    kernels = np.zeros((2, 6, *grid.shape))
    for load, factor in loads(friction):
        if all(grid.periodic):
            response = stress_response(grid, body, depth, load)
            for component, (px, py) in enumerate(STRESS_PARITY[load]):
                spectrum = response[component] * (1.0 if px * py > 0 else 1j)
                kernels[load.value, component] = factor * scipy.fft.irfft2(spectrum, s=grid.shape)
        else:
            kernels[load.value] = factor * stress_coefficients(grid, body, depth, load)
    return kernels


@njit(cache=True, nogil=True, error_model="numpy")  # type: ignore[untyped-decorator]
def _sums_above(normal, tangential, wraps_x, wraps_y, above):  # type: ignore[no-untyped-def]
    """Sum of max(k - t, 0) over all offsets of a grid, for the thresholds t of `_THRESHOLDS`, (parts, levels + 1)."""
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


def _bound_tables(
    grid: Grid,
    body: Body,
    depth: float,
    friction: float,
    tiles: tuple[int, int],
    size: int,
    padded: tuple[int, int],
) -> _BoundTables:
    COUNT.bounds += 1
    kernels = _kernel_values(grid, body, depth, friction)
    tops = np.zeros((_PARTS, 2 * tiles[0] - 1, 2 * tiles[1] - 1))
    near = np.zeros((2, _PARTS, 2 * _NEAR + 1, 2 * _NEAR + 1))
    _largest_values(kernels[0], kernels[1], size, tops)
    _largest_sums(kernels[0], kernels[1], size, near[1])
    middle = (tiles[0] - 1, tiles[1] - 1)
    for k in range(-min(_NEAR, middle[0]), min(_NEAR, middle[0]) + 1):
        for m in range(-min(_NEAR, middle[1]), min(_NEAR, middle[1]) + 1):
            near[0, :, k + _NEAR, m + _NEAR] = tops[:, middle[0] + k, middle[1] + m]
            tops[:, middle[0] + k, middle[1] + m] = 0.0
    wrapped = np.zeros((_PARTS, *padded))
    x = np.arange(-middle[0], middle[0] + 1) % padded[0]
    y = np.arange(-middle[1], middle[1] + 1) % padded[1]
    wrapped[:, x[:, None], y[None, :]] = tops
    return _BoundTables(near, scipy.fft.rfft2(wrapped))


@njit(cache=True, nogil=True, error_model="numpy")  # type: ignore[untyped-decorator]
def _signed_parts(normal, tangential, i, j, out):  # type: ignore[no-untyped-def]
    """Parts of the kernel (see _PARTS) at offset (i, j), by the parities of both loads."""
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


@njit(cache=True, nogil=True, error_model="numpy")  # type: ignore[untyped-decorator]
def _largest_values(normal, tangential, size, tops):  # type: ignore[no-untyped-def]
    """Largest kernel between two tiles `a` apart: offsets from (a - 1) size + 1 to (a + 1) size - 1 along each axis.

    That is block a of offsets, and block a - 1 without its first.
    """
    count, across, along = tops.shape
    _, nx, ny = normal.shape
    tx = (across + 1) // 2
    ty = (along + 1) // 2
    whole = np.zeros((count, 2 * tx, 2 * ty))
    less_x = np.zeros((count, 2 * tx, 2 * ty))
    less_y = np.zeros((count, 2 * tx, 2 * ty))
    less_both = np.zeros((count, 2 * tx, 2 * ty))
    parts = np.empty(count)
    for i in range(-(nx - 1), nx):
        k = (i + tx * size) // size
        for j in range(-(ny - 1), ny):
            m = (j + ty * size) // size
            _signed_parts(normal, tangential, i, j, parts)
            for c in range(count):
                value = parts[c]
                whole[c, k, m] = max(whole[c, k, m], value)
                if i % size != 0:
                    less_x[c, k, m] = max(less_x[c, k, m], value)
                    if j % size != 0:
                        less_both[c, k, m] = max(less_both[c, k, m], value)
                if j % size != 0:
                    less_y[c, k, m] = max(less_y[c, k, m], value)
    for c in range(count):
        for k in range(across):
            for m in range(along):
                one = max(whole[c, k + 1, m + 1], less_x[c, k, m + 1])
                tops[c, k, m] = max(one, max(less_y[c, k + 1, m], less_both[c, k, m]))


@njit(cache=True, nogil=True, error_model="numpy")  # type: ignore[untyped-decorator]
def _largest_sums(normal, tangential, size, near):  # type: ignore[no-untyped-def]
    """Largest sum of the kernel over a source tile, over the points of a target tile, for near offsets of tiles."""
    parts_count = near.shape[0]
    _, nx, ny = normal.shape
    # offsets from low to low + reach - 1 along each axis; prefix sums along y of sums of rows
    reach = 2 * (_NEAR + 1) * size - 1
    low = -(_NEAR + 1) * size + 1
    values = np.zeros((reach, reach, parts_count))
    parts = np.empty(parts_count)
    for a in range(reach):
        for b in range(reach):
            if abs(low + a) < nx and abs(low + b) < ny:
                _signed_parts(normal, tangential, low + a, low + b, parts)
                values[a, b] = parts
    rows = np.zeros((reach, reach, parts_count))
    for a in range(reach):
        for b in range(reach):
            for s in range(max(0, b - size + 1), b + 1):
                for c in range(parts_count):
                    rows[a, b, c] += values[a, s, c]
    for k in range(near.shape[1]):
        for m in range(near.shape[2]):
            for a in range(size):
                for b in range(size):
                    first = (k - _NEAR) * size + a - low
                    last = (m - _NEAR) * size + b - low
                    for c in range(parts_count):
                        total = 0.0
                        for s in range(first - size + 1, first + 1):
                            total += rows[s, last, c]
                        near[c, k, m] = max(near[c, k, m], total)
