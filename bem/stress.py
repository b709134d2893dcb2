"""Stresses below a loaded surface: six components or von Mises only, plane by plane.

One forward transform of the pressure serves all depths and components; the traction `friction x pressure` is part of
the kernel, so it costs none of its own. Spectra are kept as quarter arrays of reals, for

    t = xx + yy + zz,   d = xx - yy,   e = zz - (xx + yy)/2,   yz,   xz,   xy

of which von Mises, sqrt(3/4 d^2 + e^2 + 3 (yz^2 + xz^2 + xy^2)), needs the last five: it is a sixth cheaper than the
stress itself, and it is never stored but as one number a point.

Memory: a quarter array holds (px/2 + 1)(py/2 + 1) numbers (p: padded lengths); with traction there are twelve a depth:
6.3 MB for 256 x 256 free cells. They are bounded by `set_stress_memory`. Where a sweep through the depths does not fit,
the first ones are kept and the rest is computed anew every time, which is the best there is for a repeated sweep.

`von_mises_bound` says, from the pressure of whole tiles, what no point of a tile can exceed at a depth.
"""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import scipy.fft
from numba import njit
from numpy.typing import ArrayLike, NDArray

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.kernels.coefficients import STRESS_PARITY, Load, stress_coefficients
from bem.kernels.spectral import stress_response
from bem.materials import Body
from bem.threads import share
from bem.transforms import Multiplier, PaddedTransform, kernel_spectrum, multiplier, padded_length, transform_of

__all__ = [
    "COUNT",
    "bound_tile",
    "set_stress_memory",
    "stress_memory",
    "subsurface_stress",
    "von_mises",
    "von_mises_bound",
    "von_mises_field",
    "von_mises_planes",
    "von_mises_where_above",
]


@dataclass
class StressCount:
    """What was computed since the last reset: depths whose spectra, and depths whose bound tables, were made."""

    spectra: int = 0
    bounds: int = 0

    def reset(self) -> None:
        """Back to zero."""
        self.spectra = self.bounds = 0


COUNT = StressCount()
"""Kernels evaluated by this process; what the cache served is not counted."""


@dataclass
class _Kept:
    value: Any
    nbytes: int
    sweep: int


class _SweepCache:
    """Bounded store for values that are asked for in repeated sweeps.

    What the last two sweeps did not use gives way; what the present one used does not. Dropping the least recently
    used would, in a sweep a little too long for the memory, drop each value just before it is needed again.
    """

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.kept: dict[Any, _Kept] = {}
        self.used = 0
        self.sweep = 0
        self.lock = threading.Lock()

    def begin(self) -> int:
        with self.lock:
            self.sweep += 1
            return self.sweep

    def get(self, key: Any, sweep: int) -> Any:
        with self.lock:
            found = self.kept.get(key)
            if found is None:
                return None
            found.sweep = sweep
            return found.value

    def put(self, key: Any, value: Any, nbytes: int, sweep: int) -> None:
        with self.lock:
            if key in self.kept:
                return
            self._make_room(self.limit - nbytes, sweep - 1)
            if self.used + nbytes <= self.limit:
                self.kept[key] = _Kept(value, nbytes, sweep)
                self.used += nbytes

    def resize(self, limit: int) -> None:
        with self.lock:
            self.limit = limit
            self._make_room(limit, self.sweep + 1)

    def _make_room(self, target: int, before: int) -> None:
        """Drop values last used before a sweep, oldest first, until `target` bytes are held."""
        if self.used <= target:
            return
        for key in sorted((k for k, v in self.kept.items() if v.sweep < before), key=lambda k: self.kept[k].sweep):
            self.used -= self.kept.pop(key).nbytes
            if self.used <= target:
                return


_SPECTRA = _SweepCache(1 << 29)
_TABLES = _SweepCache(1 << 27)


def set_stress_memory(limit: int) -> None:
    """Bound the memory that cached stress spectra may hold [bytes]; default 512 MiB, 0 keeps none.

    Raises
    ------
    InputError : not a number of bytes.
    """
    if not (isinstance(limit, int | float) and math.isfinite(limit) and limit >= 0):
        raise InputError(f"set_stress_memory: limit {limit!r} must be a number of bytes >= 0")
    _SPECTRA.resize(int(limit))


def stress_memory() -> int:
    """Memory held by cached stress spectra [bytes]."""
    return _SPECTRA.used


def subsurface_stress(
    pressure: ArrayLike,
    grid: Grid,
    body: Body,
    depths: ArrayLike,
    *,
    friction: float = 0.0,
    out: FloatArray | None = None,
) -> FloatArray:
    """Stress in `body` under `pressure` and the traction friction x pressure along +x, at the grid's points.

    Parameters
    ----------
    pressure : (nx, ny) [Pa], positive in compression.
    grid : free or periodic along each axis. On a doubly periodic grid the pressure is its trigonometric interpolant
        and the mean pressure gives the laterally constrained uniform state; otherwise it is constant on each cell.
    depths : (nz,) [m], any order, each >= 0; on a layer's interface the layer's side.
    friction : f of the traction on the body.
    out : (6, nz, nx, ny) to write into.

    Returns
    -------
    (6, nz, nx, ny) [Pa], xx yy zz yz xz xy, tension positive.

    Raises
    ------
    InputError : shapes that do not match, values that are not finite, depths above the surface.
    """
    sweep = _Sweep.of("subsurface_stress", pressure, grid, body, depths, friction)
    shape = (6, len(sweep.depths), *grid.shape)
    result = _check_out("subsurface_stress", out, shape)
    for index in range(len(sweep.depths)):
        factors = sweep.factors(index)
        for component in range(6):
            sweep.transform.inverse(sweep.spectrum, factors[component], result[component, index])
        _share_rows(_recombine, grid.shape[0], result[:, index])
    return result


def von_mises_planes(
    pressure: ArrayLike,
    grid: Grid,
    body: Body,
    depths: ArrayLike,
    *,
    friction: float = 0.0,
    out: FloatArray | None = None,
) -> Iterator[FloatArray]:
    """Von Mises stress, one plane (nx, ny) [Pa] for each depth in turn; arguments as in `subsurface_stress`.

    The next plane is computed when it is asked for. Each is a new array, or `out` written over.
    """
    sweep = _Sweep.of("von_mises_planes", pressure, grid, body, depths, friction)
    if out is not None:
        _check_out("von_mises_planes", out, grid.shape)
    return _planes(sweep, [out] * len(sweep.depths))


def von_mises_field(
    pressure: ArrayLike,
    grid: Grid,
    body: Body,
    depths: ArrayLike,
    *,
    friction: float = 0.0,
    out: FloatArray | None = None,
) -> FloatArray:
    """Von Mises stress (nz, nx, ny) [Pa] without ever storing six components; arguments as in `subsurface_stress`.

    `out` : (nz, nx, ny) to write into, made if not given.
    """
    sweep = _Sweep.of("von_mises_field", pressure, grid, body, depths, friction)
    result = _check_out("von_mises_field", out, (len(sweep.depths), *grid.shape))
    for _ in _planes(sweep, list(result)):
        pass
    return result


def von_mises(stress: ArrayLike) -> FloatArray:
    """Von Mises stress (...) of a stress (6, ...), xx yy zz yz xz xy.

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


@njit(cache=True, nogil=True, error_model="numpy")  # type: ignore[untyped-decorator]
def _von_mises(s, out):  # type: ignore[no-untyped-def]
    for i in range(out.size):
        d = s[0, i] - s[1, i]
        e = s[2, i] - 0.5 * (s[0, i] + s[1, i])
        shear = s[3, i] * s[3, i] + s[4, i] * s[4, i] + s[5, i] * s[5, i]
        out[i] = np.sqrt(0.75 * d * d + e * e + 3.0 * shear)


@njit(cache=True, nogil=True, error_model="numpy")  # type: ignore[untyped-decorator]
def _recombine(start, stop, stress):  # type: ignore[no-untyped-def]
    """In place from (t, d, e, ...) to (xx, yy, zz, ...)."""
    for i in range(start, stop):
        for j in range(stress.shape[2]):
            t, d, e = stress[0, i, j], stress[1, i, j], stress[2, i, j]
            mean = (t - e) / 3.0
            stress[0, i, j] = mean + 0.5 * d
            stress[1, i, j] = mean - 0.5 * d
            stress[2, i, j] = mean + e


@njit(cache=True, nogil=True, error_model="numpy")  # type: ignore[untyped-decorator]
def _accumulate(start, stop, values, weight, out):  # type: ignore[no-untyped-def]
    for i in range(start, stop):
        for j in range(out.shape[1]):
            out[i, j] += weight * values[i, j] * values[i, j]


@njit(cache=True, nogil=True, error_model="numpy")  # type: ignore[untyped-decorator]
def _finish(start, stop, values, weight, out):  # type: ignore[no-untyped-def]
    for i in range(start, stop):
        for j in range(out.shape[1]):
            out[i, j] = np.sqrt(out[i, j] + weight * values[i, j] * values[i, j])


_ROWS = 64  # rows in a block of elementwise work


def _share_rows(work: Any, rows: int, *arguments: Any) -> None:
    def block(_: int, number: int) -> None:
        work(number * _ROWS, min(rows, (number + 1) * _ROWS), *arguments)

    share(block, -(-rows // _ROWS))


_SHARES = (0.0, 0.75, 1.0, 3.0, 3.0, 3.0)  # of t, d, e, yz, xz, xy squared in von Mises squared


def _planes(sweep: _Sweep, outs: Sequence[FloatArray | None]) -> Iterator[FloatArray]:
    shape = sweep.grid.shape
    scratch = np.empty(shape)
    for index, out in enumerate(outs):
        plane = np.empty(shape) if out is None else out
        plane[...] = 0.0
        factors = sweep.factors(index)
        for component in range(1, 6):
            sweep.transform.inverse(sweep.spectrum, factors[component], scratch)
            work = _finish if component == 5 else _accumulate
            _share_rows(work, shape[0], scratch, _SHARES[component], plane)
        yield plane


def _check_out(name: str, out: FloatArray | None, shape: tuple[int, ...]) -> FloatArray:
    if out is None:
        return np.empty(shape)
    if not (isinstance(out, np.ndarray) and out.shape == shape and out.dtype == np.float64 and out.flags.writeable):
        found = f"{out.dtype} {out.shape}" if isinstance(out, np.ndarray) else type(out).__name__
        raise InputError(f"{name}: out ({found}) must be a writeable float64 array of shape {shape}")
    return out


def _elastic(body: Body) -> tuple[float, ...]:
    """What of a body decides its stresses: nu alone if homogeneous, else the ratio of moduli too."""
    nu = body.material.poissons_ratio
    if body.layer is None:
        return (nu,)
    coating = body.layer.material
    return (nu, coating.poissons_ratio, coating.youngs_modulus / body.material.youngs_modulus, body.layer.thickness)


def _check(
    name: str, grid: object, body: object, depths: ArrayLike, friction: object
) -> tuple[tuple[float, ...], float]:
    messages = []
    if not isinstance(grid, Grid):
        messages.append(f"{name}: grid {grid!r} must be a Grid")
    if not isinstance(body, Body):
        messages.append(f"{name}: body {body!r} must be a Body")
    if not (isinstance(friction, int | float | np.floating | np.integer) and math.isfinite(friction)):
        messages.append(f"{name}: friction {friction!r} must be a finite number")
    values = np.asarray(depths)
    if values.dtype.kind not in "fiu" or values.ndim != 1:
        messages.append(f"{name}: depths must be a one-dimensional sequence of numbers [m]")
    elif not np.isfinite(values).all() or (values < 0).any():
        messages.append(f"{name}: depths must be finite and not negative (0 is the surface) [m]")
    if messages:
        raise InputError(messages)
    return tuple(float(z) for z in values), float(friction)  # type: ignore[arg-type]


@dataclass(frozen=True)
class _Sweep:
    """A checked request: the transformed pressure, and the spectra of each depth as they are needed."""

    grid: Grid
    body: Body
    depths: tuple[float, ...]
    friction: float
    transform: PaddedTransform
    spectrum: NDArray[Any]
    number: int

    @classmethod
    def of(cls, name: str, pressure: ArrayLike, grid: Grid, body: Body, depths: ArrayLike, friction: float) -> _Sweep:
        places, coefficient = _check(name, grid, body, depths, friction)
        field = grid.check_field(pressure, "pressure")
        padded = _padded(grid)
        transform = transform_of(grid.shape, padded)
        spectrum = transform.forward(field) if places else transform.empty_spectrum()
        return cls(grid, body, places, coefficient, transform, spectrum, _SPECTRA.begin())

    def factors(self, index: int) -> tuple[Multiplier, ...]:
        """Multipliers of t, d, e, yz, xz, xy at a depth."""
        depth = self.depths[index]
        key = (self.grid, _elastic(self.body), depth, self.friction)
        found: tuple[Multiplier, ...] | None = _SPECTRA.get(key, self.number)
        if found is None:
            found = _multipliers(self.grid, self.body, depth, self.friction)
            _SPECTRA.put(key, found, sum(m.nbytes for m in found), self.number)
        return found


def _padded(grid: Grid) -> tuple[int, int]:
    return padded_length(grid.shape[0], grid.periodic[0]), padded_length(grid.shape[1], grid.periodic[1])


def _loads(friction: float) -> list[tuple[Load, float]]:
    return [(Load.NORMAL, 1.0)] + ([(Load.TANGENTIAL, friction)] if friction != 0 else [])


def _multipliers(grid: Grid, body: Body, depth: float, friction: float) -> tuple[Multiplier, ...]:
    COUNT.spectra += 1
    padded = _padded(grid)
    parts: list[list[tuple[FloatArray, tuple[int, int], float]]] = [[] for _ in range(6)]
    for load, factor in _loads(friction):
        if all(grid.periodic):
            kernels = stress_response(grid, body, depth, load)
        else:
            kernels = stress_coefficients(grid, body, depth, load)
        xx, yy, zz = kernels[0].copy(), kernels[1].copy(), kernels[2].copy()
        kernels[0] = xx + yy + zz
        kernels[1] = xx - yy
        kernels[2] = zz - 0.5 * (xx + yy)
        for component in range(6):
            parity = STRESS_PARITY[load][component]
            if all(grid.periodic):
                # `multiplier` takes i^2 = -1 for a kernel odd along both axes; the response has it already
                sign = -1.0 if parity == (-1, -1) else 1.0
                quarter = np.ascontiguousarray(kernels[component][: padded[0] // 2 + 1].T) * sign
            else:
                quarter = kernel_spectrum(kernels[component], padded, parity)
            parts[component].append((quarter, parity, factor))
    return tuple(multiplier(part) for part in parts)


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
    places, coefficient = _check("von_mises_bound", grid, body, depths, friction)
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
        key = (grid, _elastic(body), depth, coefficient, size)
        tables: _BoundTables | None = _TABLES.get(key, sweep)
        if tables is None:
            tables = _bound_tables(grid, body, depth, coefficient, tiles, size, padded)
            _TABLES.put(key, tables, tables.nbytes, sweep)
        far = scipy.fft.irfft2(tables.far * waves, s=padded)
        _bound(largest, total, tables.near, np.ascontiguousarray(far), either_sign, bound[index])
        bound[index] *= 1 + 1e-12
        bound[index] += 1e-13 * bound[index].max()  # round-off of the transform over tiles
    return bound


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
    bound = von_mises_bound(pressure, grid, body, depths, friction=friction, tile=tile)
    reaches = bound.max(axis=(1, 2), initial=0.0) > threshold
    computed = reaches.copy()
    for shift in range(1, int(margin) + 1):
        computed[shift:] |= reaches[:-shift]
        computed[:-shift] |= reaches[shift:]
    field = _check_out("von_mises_where_above", out, (reaches.size, *grid.shape))
    field[~computed] = 0.0
    wanted = np.flatnonzero(computed)
    if wanted.size:
        places = np.asarray(depths, dtype=np.float64)[wanted]
        sweep = _Sweep.of("von_mises_where_above", pressure, grid, body, places, friction)
        for _ in _planes(sweep, [field[index] for index in wanted]):
            pass
    return field, computed


def bound_tile(grid: Grid) -> int:
    """Cells along a side of a tile that `von_mises_bound` takes by default."""
    return max(1, -(-max(grid.shape) // _TILES))


_TILES = 40
_NEAR = 2
_PARTS = 10  # positive and negative parts of d, e, yz, xz, xy


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
    kernels = np.zeros((2, 6, *grid.shape))
    for load, factor in _loads(friction):
        if all(grid.periodic):
            response = stress_response(grid, body, depth, load)
            for component, (px, py) in enumerate(STRESS_PARITY[load]):
                spectrum = response[component] * (1.0 if px * py > 0 else 1j)
                kernels[load.value, component] = factor * scipy.fft.irfft2(spectrum, s=grid.shape)
        else:
            kernels[load.value] = factor * stress_coefficients(grid, body, depth, load)
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
