"""Stress at depths below a loaded surface: six components, or von Mises stress only.

A plane (nx, ny) of six components takes six inverse transforms. A plane of von Mises stress takes five: the square of
von Mises stress is a sum of squares (`spectra`), which are added during the last pass of each transform. Threads share
the depths.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from bem.compiled import compiled
from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.stress.request import StressRequest, check_out
from bem.threads import share, threads_for


def subsurface_stress(
    pressure: ArrayLike,
    grid: Grid,
    body: Body,
    depths: ArrayLike,
    *,
    friction: float = 0.0,
    traction: ArrayLike | None = None,
    out: FloatArray | None = None,
) -> FloatArray:
    """Compute the stress in `body` under `pressure` and the traction friction x pressure along +x.

    Parameters
    ----------
    pressure : (nx, ny) [Pa], positive in compression.
    grid : free or periodic along each axis. On a doubly periodic grid the pressure is its trigonometric interpolant
        and the mean pressure gives the laterally constrained uniform state; otherwise it is constant on each cell.
    body : a half-space under any number of layers.
    depths : (nz,) [m], any order, each >= 0; on a layer's interface the layer's side.
    friction : f of the traction on the body.
    traction : (2, nx, ny) [Pa] on the body along +x and +y, instead of friction x pressure (partial slip).
    out : (6, nz, nx, ny) to write into.

    Returns
    -------
    (6, nz, nx, ny) [Pa], xx yy zz yz xz xy, tension positive.

    Raises
    ------
    InputError : shapes that do not match, values that are not finite, depths above the surface, friction and traction.
    """
    request = StressRequest.of("subsurface_stress", pressure, grid, body, depths, friction, traction)
    shape = (6, len(request.depths), *grid.shape)
    result = check_out("subsurface_stress", out, shape)

    def write_plane(own: StressRequest, index: int) -> None:
        own.write_components(index, result[:, index])
        _from_deviatoric(result[:, index])

    _for_each_depth(request, write_plane)
    return result


def von_mises_planes(
    pressure: ArrayLike,
    grid: Grid,
    body: Body,
    depths: ArrayLike,
    *,
    friction: float = 0.0,
    traction: ArrayLike | None = None,
    out: FloatArray | None = None,
) -> Iterator[FloatArray]:
    """Return an iterator over planes (nx, ny) of von Mises stress [Pa], one for each depth in the given order.

    A plane is computed when it is requested. With n threads it is computed together with the next n - 1 planes.

    Parameters
    ----------
    pressure, grid, body, depths, friction, traction : as in `subsurface_stress`.
    out : (nx, ny) for each plane in turn, or (nz, nx, ny) for all planes; a new array for each plane if None.
    """
    request = StressRequest.of("von_mises_planes", pressure, grid, body, depths, friction, traction)
    if out is None:
        return _planes(request, None)
    stack = np.ndim(out) == 3
    checked = check_out("von_mises_planes", out, (len(request.depths), *grid.shape) if stack else grid.shape)
    return _planes(request, checked)


def von_mises_field(
    pressure: ArrayLike,
    grid: Grid,
    body: Body,
    depths: ArrayLike,
    *,
    friction: float = 0.0,
    traction: ArrayLike | None = None,
    out: FloatArray | None = None,
) -> FloatArray:
    """Compute von Mises stress (nz, nx, ny) [Pa] without storing six components.

    Parameters
    ----------
    pressure, grid, body, depths, friction, traction : as in `subsurface_stress`.
    out : (nz, nx, ny) to write into; a new array if None.
    """
    request = StressRequest.of("von_mises_field", pressure, grid, body, depths, friction, traction)
    result = check_out("von_mises_field", out, (len(request.depths), *grid.shape))
    _for_each_depth(request, partial(_write_von_mises, result, 0))
    return result


def von_mises(stress: ArrayLike) -> FloatArray:
    """Return the von Mises stress (...) of a stress (6, ...), xx yy zz yz xz xy.

    Raises
    ------
    InputError : a first axis that does not hold six components.
    """
    components = np.asarray(stress, dtype=np.float64)
    if components.ndim < 1 or components.shape[0] != 6:
        raise InputError(f"von_mises: shape {components.shape} must start with 6 components (xx yy zz yz xz xy)")
    flat = components.reshape(6, -1)
    result = np.empty(flat.shape[1])
    _von_mises(flat, result)
    return result.reshape(components.shape[1:])


@compiled
def _von_mises(s, out):
    """Write the von Mises stress (n,) of stresses `s` (6, n)."""
    for i in range(out.size):
        d = s[0, i] - s[1, i]
        e = s[2, i] - 0.5 * (s[0, i] + s[1, i])
        shear = s[3, i] * s[3, i] + s[4, i] * s[4, i] + s[5, i] * s[5, i]
        out[i] = np.sqrt(0.75 * d * d + e * e + 3.0 * shear)


@compiled
def _from_deviatoric(stress):
    """Replace t, d, e by xx, yy, zz in (6, nx, ny): the inverse of `spectra._to_deviatoric`."""
    for i in range(stress.shape[1]):
        for j in range(stress.shape[2]):
            t, d, e = stress[0, i, j], stress[1, i, j], stress[2, i, j]
            mean = (t - e) / 3.0
            stress[0, i, j] = mean + 0.5 * d
            stress[1, i, j] = mean - 0.5 * d
            stress[2, i, j] = mean + e


def _for_each_depth(
    request: StressRequest, work: Callable[[StressRequest, int], None], first: int = 0, last: int | None = None
) -> None:
    """Call `work` with a request and an index for depths `first` to `last` - 1; each thread has its own transforms."""
    number = (len(request.depths) if last is None else last) - first
    entries = number * request.entries
    own = [request, *(request.for_worker(worker) for worker in range(1, min(threads_for(entries), number)))]
    share(lambda worker, block: work(own[worker], first + block), number, entries)


def _write_von_mises(planes: FloatArray, first: int, request: StressRequest, index: int) -> None:
    """Write von Mises stress of the depth `index` into `planes`, which begin at the depth `first`."""
    request.write_von_mises(index, planes[index - first])


def _planes(request: StressRequest, out: FloatArray | None) -> Iterator[FloatArray]:
    """Yield von Mises stress depth by depth, in new arrays or in `out`."""
    number, shape = len(request.depths), request.grid.shape
    at_once = max(1, min(threads_for(number * request.entries), number))
    for first in range(0, number, at_once):
        last = min(first + at_once, number)
        if out is not None and out.ndim == 3:
            planes = out[first:last]
        elif out is not None and at_once == 1:
            planes = out[None]
        else:
            planes = np.empty((last - first, *shape))
        _for_each_depth(request, partial(_write_von_mises, planes, first), first, last)
        for plane in planes:
            if out is None or out.ndim == 3:
                yield plane
                continue
            if at_once > 1:
                out[...] = plane
            yield out
