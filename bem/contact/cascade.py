"""From coarse grids to fine ones: sampling the gap, and interpolating a pressure so that its contact area is right.

The square of the pressure falls linearly to zero at the edge of a contact, and the gap outside grows like the distance
to the power 3/2: phi = p^2 inside and -c gap^(2/3) outside is smooth across the edge, and is what is interpolated.

That gives a region more load or less, by its edges, and of load moved across the surface the bodies make long waves:
each region then gets the load that it has on the coarser grid.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from bem.contact import passes
from bem.threads import share

FloatArray = NDArray[np.float64]
Table = tuple[NDArray[np.int64], FloatArray]

_REGION = 8
"""Coarse cells along a region that keeps its load. Rough free contacts of 512 cells with a third in contact took 17.9
convolutions without, 14.0 with regions of 4 cells, 13.6 with 8, 15.2 with 16."""

_MOST = 0.5
"""Of its pressure between the bounds: the most that a region gets or gives."""


def _spacing(cells: int, onto: int, periodic: bool) -> float:
    """Of `onto` points in that of `cells`, on the same axis."""
    if periodic:
        return cells / onto
    return 0.5 if onto > cells else 2.0 if onto < cells else 1.0


@lru_cache(maxsize=64)
def interpolation(cells: int, onto: int, periodic: bool) -> Table:
    """Cubic interpolation along an axis, from `cells` points to `onto`: four indices and weights for each.

    Periodic axes have the same length on both grids; on a free axis point k of the coarser is point 2k of the finer.
    """
    position = np.arange(onto) * _spacing(cells, onto, periodic)
    base = np.floor(position).astype(np.int64)
    t = position - base
    weights = np.stack(
        [
            -t * (t - 1) * (t - 2) / 6,
            (t + 1) * (t - 1) * (t - 2) / 2,
            -(t + 1) * t * (t - 2) / 2,
            (t + 1) * t * (t - 1) / 6,
        ],
        axis=1,
    )
    indices = base[:, None] + np.arange(-1, 3)
    indices = indices % cells if periodic else np.clip(indices, 0, cells - 1)
    indices.flags.writeable = weights.flags.writeable = False  # kept for the next contact
    return indices, weights


def sample(field: FloatArray, shape: tuple[int, int], periodic: tuple[bool, bool]) -> FloatArray:
    """A field on a coarser grid of the same rectangle."""
    for axis in (0, 1):
        n, m = field.shape[axis], shape[axis]
        if n == m:
            continue
        if not periodic[axis] or n == 2 * m:
            field = field[::2] if axis == 0 else field[:, ::2]
            continue
        indices, weights = interpolation(n, m, True)
        moved = np.moveaxis(field, axis, 0)
        mixed = sum(moved[indices[:, k]] * weights[:, k, None] for k in range(4))
        field = np.moveaxis(np.asarray(mixed), 0, axis)
    return np.ascontiguousarray(field)


def prolong(
    pressure: FloatArray,
    displacement: FloatArray,
    gap: FloatArray,
    approach: float,
    cap: float,
    shape: tuple[int, int],
    periodic: tuple[bool, bool],
) -> FloatArray:
    """Pressure (nx, ny) on the finer grid `shape`; the other arrays are those of the coarser grid, two-dimensional."""
    phi = np.empty(pressure.shape)
    scale = _edge_scale(pressure, displacement, gap, approach, cap)
    _make_phi(pressure, displacement, gap, approach, cap, scale, phi)
    fine = np.zeros(shape)
    rows = interpolation(pressure.shape[0], shape[0], periodic[0])
    columns = interpolation(pressure.shape[1], shape[1], periodic[1])
    lines = max(1, passes.BLOCK // shape[1])

    def work(_worker: int, block: int) -> None:
        part = slice(block * lines, (block + 1) * lines)
        _prolong_phi(phi, rows[0][part], rows[1][part], *columns, cap, fine[part])

    share(work, -(-shape[0] // lines))
    along = [_regions(n, m, wraps) for n, m, wraps in zip(pressure.shape, shape, periodic, strict=True)]
    _keep_loads(pressure, fine, along[0], along[1], cap)
    return fine


class _Regions(NamedTuple):
    """Along an axis: how many regions, the one that each point of the coarser grid is in, the two that each of the
    finer is in, its share in the second, and its length in the coarser's spacings."""

    number: int
    coarse: NDArray[np.int64]
    first: NDArray[np.int64]
    second: NDArray[np.int64]
    share: FloatArray
    length: float


@lru_cache(maxsize=64)
def _regions(cells: int, onto: int, periodic: bool) -> _Regions:
    """A point of the finer grid between two of the coarser belongs to both, as in linear interpolation."""
    spacing = _spacing(cells, onto, periodic)
    position = np.arange(onto) * spacing
    below = np.floor(position).astype(np.int64)
    above = (below + 1) % cells if periodic else np.minimum(below + 1, cells - 1)
    coarse = np.arange(cells) // _REGION
    return _Regions(int(coarse[-1]) + 1, coarse, coarse[below], coarse[above], position - below, spacing)


def _edge_scale(pressure: FloatArray, displacement: FloatArray, gap: FloatArray, approach: float, cap: float) -> float:
    """c of phi outside, so that phi has the same slope on both sides of the edges: by mean values next to them."""
    squares, opening, edges = _edge_means(pressure, displacement, gap, approach, cap)
    if edges == 0 or not opening > 0:
        return 0.0 if not squares > 0 else squares
    return float(squares / opening)


@njit(cache=True, nogil=True, error_model="numpy")
def _edge_means(pressure, displacement, gap, approach, cap):  # type: ignore[no-untyped-def]
    nx, ny = pressure.shape
    squares = 0.0
    opening = 0.0
    edges = 0
    for i in range(nx):
        for j in range(ny):
            p = pressure[i, j]
            for axis in range(2):
                k = i + (axis == 0)
                m = j + (axis == 1)
                if k == nx or m == ny:
                    continue
                q = pressure[k, m]
                if p > 0 and p < cap and q <= 0:
                    g = gap[k, m] + displacement[k, m] - approach
                    squares += p * p
                elif q > 0 and q < cap and p <= 0:
                    g = gap[i, j] + displacement[i, j] - approach
                    squares += q * q
                else:
                    continue
                opening += max(g, 0.0) ** (2.0 / 3.0)
                edges += 1
    return squares, opening, edges


@njit(cache=True, nogil=True, error_model="numpy")
def _make_phi(pressure, displacement, gap, approach, cap, scale, phi):  # type: ignore[no-untyped-def]
    nx, ny = pressure.shape
    for i in range(nx):
        for j in range(ny):
            p = pressure[i, j]
            if p > 0:
                phi[i, j] = p * p
            else:
                g = max(gap[i, j] + displacement[i, j] - approach, 0.0)
                phi[i, j] = -scale * g ** (2.0 / 3.0)


@njit(cache=True, nogil=True, error_model="numpy")
def _prolong_phi(phi, rows, row_weights, columns, column_weights, cap, fine):  # type: ignore[no-untyped-def]
    nx, ny = fine.shape
    width = phi.shape[1]
    line = np.empty(width)
    for i in range(nx):
        a, b, c, d = rows[i, 0], rows[i, 1], rows[i, 2], rows[i, 3]
        u, v, w, x = row_weights[i, 0], row_weights[i, 1], row_weights[i, 2], row_weights[i, 3]
        for j in range(width):
            line[j] = u * phi[a, j] + v * phi[b, j] + w * phi[c, j] + x * phi[d, j]
        for j in range(ny):
            e, f, g, h = columns[j, 0], columns[j, 1], columns[j, 2], columns[j, 3]
            value = (
                column_weights[j, 0] * line[e]
                + column_weights[j, 1] * line[f]
                + column_weights[j, 2] * line[g]
                + column_weights[j, 3] * line[h]
            )
            if value > 0:
                fine[i, j] = min(np.sqrt(value), cap)


@njit(cache=True, nogil=True, error_model="numpy")
def _keep_loads(pressure, fine, rows, columns, cap):  # type: ignore[no-untyped-def]
    """Multiply each region without a cell at the cap so that it has the load that it has on the coarser grid."""
    missing = np.zeros((rows.number, columns.number))
    inside = np.zeros(missing.shape)
    for i in range(pressure.shape[0]):
        for j in range(pressure.shape[1]):
            missing[rows.coarse[i], columns.coarse[j]] += pressure[i, j]
    cell = rows.length * columns.length
    for i in range(fine.shape[0]):
        a, b, s = rows.first[i], rows.second[i], rows.share[i]
        for j in range(fine.shape[1]):
            p = fine[i, j] * cell
            if p == 0:
                continue
            c, d, t = columns.first[j], columns.second[j], columns.share[j]
            missing[a, c] -= (1 - s) * (1 - t) * p
            missing[a, d] -= (1 - s) * t * p
            missing[b, c] -= s * (1 - t) * p
            missing[b, d] -= s * t * p
            inside[a, c] += p if fine[i, j] < cap else -np.inf
    for i in range(rows.number):
        for j in range(columns.number):
            more = missing[i, j] / inside[i, j] if inside[i, j] > 0 else 0.0
            missing[i, j] = 1 + max(-_MOST, min(_MOST, more))
    for i in range(fine.shape[0]):
        for j in range(fine.shape[1]):
            if fine[i, j] > 0:
                fine[i, j] = min(fine[i, j] * missing[rows.first[i], columns.first[j]], cap)
