"""Stress fields at depths below a loaded surface: six components, or von Mises stress only.

One forward transform of the pressure serves all depths and components. The traction `friction x pressure` is part of
the kernel and costs no transform. A prescribed traction (2, nx, ny) takes a forward transform for each direction; a
traction along +y is computed as one along +x with the axes exchanged. A plane of von Mises stress takes five inverse
transforms, whose squares are added during the last pass; a plane of six components takes six.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.compiled import compiled
from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.stress.spectra import (
    SPECTRA,
    TRACTION,
    Loads,
    StressSpectra,
    check_request,
    column_lengths,
    compute_spectra,
    elastic_ratios,
    padded_lengths,
    pressure_and_friction,
)
from bem.threads import share, threads_for
from bem.transforms import PaddedTransform, transform_of
from bem.transforms.loops import BEGINS, ENDS, GOES_ON


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
        _recombine(result[:, index])

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
    """Return an iterator over planes (nx, ny) of von Mises stress [Pa], one for each depth.

    Arguments as in `subsurface_stress`. A plane is computed when it is requested, together with as many of the next
    planes as there are further threads. Each plane is a new array, or `out` (nx, ny) overwritten, or the next plane of
    `out` (nz, nx, ny).
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

    Arguments as in `subsurface_stress`, but `out` : (nz, nx, ny) to write into, a new array if None.
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
    for i in range(out.size):
        d = s[0, i] - s[1, i]
        e = s[2, i] - 0.5 * (s[0, i] + s[1, i])
        shear = s[3, i] * s[3, i] + s[4, i] * s[4, i] + s[5, i] * s[5, i]
        out[i] = np.sqrt(0.75 * d * d + e * e + 3.0 * shear)


@compiled
def _recombine(stress):
    """Replace (t, d, e, ...) by (xx, yy, zz, ...) in place."""
    for i in range(stress.shape[1]):
        for j in range(stress.shape[2]):
            t, d, e = stress[0, i, j], stress[1, i, j], stress[2, i, j]
            mean = (t - e) / 3.0
            stress[0, i, j] = mean + 0.5 * d
            stress[1, i, j] = mean - 0.5 * d
            stress[2, i, j] = mean + e


@compiled
def _add_square(values, weight, stage, out):
    """Add weight x values^2 to the sum in `out`, which `stage` starts, continues, or ends with its root."""
    for i in range(out.shape[0]):
        for j in range(out.shape[1]):
            square = weight * values[i, j] * values[i, j]
            total = square if stage == BEGINS else out[i, j] + square
            out[i, j] = np.sqrt(total) if stage == ENDS else total


VON_MISES_WEIGHTS = (0.0, 0.75, 1.0, 3.0, 3.0, 3.0)
"""Weights of the squares of t, d, e, yz, xz, xy in the square of von Mises stress."""
_STAGES = {1: BEGINS, 5: ENDS}
"""Stages of the first and the last term of that sum."""


def _for_each_depth(
    request: StressRequest, work: Callable[[StressRequest, int], None], first: int = 0, last: int | None = None
) -> None:
    """Call `work` for the depths from `first` to before `last`; threads share the depths, each with own transforms."""
    number = (len(request.depths) if last is None else last) - first
    entries = number * request.entries
    own = [request, *(request.for_worker(worker) for worker in range(1, min(threads_for(entries), number)))]
    share(lambda worker, block: work(own[worker], first + block), number, entries)


def _write_von_mises(planes: FloatArray, first: int, request: StressRequest, index: int) -> None:
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


def check_out(name: str, out: FloatArray | None, shape: tuple[int, ...]) -> FloatArray:
    """Return the array to write into: `out` if it fits, a new one if it is None."""
    if out is None:
        return np.empty(shape)
    if not (isinstance(out, np.ndarray) and out.shape == shape and out.dtype == np.float64 and out.flags.writeable):
        found = f"{out.dtype} {out.shape}" if isinstance(out, np.ndarray) else type(out).__name__
        raise InputError(f"{name}: out ({found}) must be a writeable float64 array of shape {shape}")
    return out


@dataclass(frozen=True)
class TransformedLoad:
    """One field on the surface with its transform, and the spectra of the kernels that act on it.

    acting : loads proportional to the field.
    spectrum : transform of the field.
    sweep : number of the sweep in the cache of spectra.
    exchanged : True if field and grid have their axes exchanged, so that a traction along +y is one along +x.
    """

    grid: Grid
    body: Body
    acting: Loads
    transform: PaddedTransform
    spectrum: NDArray[Any]
    sweep: int
    exchanged: bool

    @classmethod
    def of(
        cls, field: FloatArray, grid: Grid, body: Body, acting: Loads, *, exchanged: bool = False
    ) -> TransformedLoad:
        """Transform a field (nx, ny)."""
        if exchanged:
            field = np.ascontiguousarray(field.T)
            grid = Grid(grid.shape[::-1], grid.spacing[::-1], periodic=grid.periodic[::-1])
        transform = transform_of(grid.shape, padded_lengths(grid), lengths=column_lengths(grid, body))
        spectrum = transform.forward(field)
        return cls(grid, body, acting, transform, spectrum, SPECTRA.begin_sweep(), exchanged)

    def for_worker(self, worker: int) -> TransformedLoad:
        """Return the same load with the transform of another thread."""
        own = self.transform
        return replace(self, transform=transform_of(own.shape, own.padded, own.dtype, own.lengths, worker))

    @cached_property
    def scratch(self) -> FloatArray:
        """Work array for one field."""
        return self.transform.empty_field()

    @cached_property
    def _key(self) -> tuple[Any, ...]:
        return self.grid, elastic_ratios(self.body), self.acting

    def spectra(self, depth: float) -> StressSpectra:
        """Spectra of t, d, e, yz, xz, xy at a depth, from the cache where it has them."""
        make = partial(compute_spectra, self.grid, self.body, depth, self.acting)
        return SPECTRA.of((self._key, depth), make, self.sweep)

    def write_component(self, spectra: StressSpectra, component: int, out: FloatArray) -> None:
        """Write one of t, d, e, yz, xz, xy at the points of this load's grid."""
        columns = spectra.columns[component]
        self.transform.inverse(self.spectrum, spectra.multipliers[component], out, columns=columns)

    def write_von_mises(self, spectra: StressSpectra, out: FloatArray) -> None:
        """Write von Mises stress at the points of this load's grid into a contiguous array."""
        for component in range(1, 6):
            self.transform.inverse_squared(
                self.spectrum,
                spectra.multipliers[component],
                out,
                weight=VON_MISES_WEIGHTS[component],
                stage=_STAGES.get(component, GOES_ON),
                columns=spectra.columns[component],
            )

    def add_component(self, spectra: StressSpectra, component: int, out: FloatArray) -> None:
        """Add one of t, d, e, yz, xz, xy in the axes of the request; with axes exchanged d is -d and yz is xz."""
        scratch = self.scratch
        self.write_component(spectra, _EXCHANGED[component] if self.exchanged else component, scratch)
        if not self.exchanged:
            out += scratch
        elif component == _D:
            out -= scratch.T
        else:
            out += scratch.T


_D = 1
"""Position of d among the components t, d, e, yz, xz, xy."""
_EXCHANGED = (0, 1, 2, 4, 3, 5)
"""Component that t, d, e, yz, xz, xy become when x and y are exchanged."""


@dataclass(frozen=True)
class StressRequest:
    """A checked request: grid, depths [m] and transformed loads, the pressure first."""

    grid: Grid
    depths: tuple[float, ...]
    loads: tuple[TransformedLoad, ...]

    @classmethod
    def of(
        cls,
        name: str,
        pressure: ArrayLike,
        grid: Grid,
        body: Body,
        depths: ArrayLike,
        friction: float,
        traction: ArrayLike | None = None,
    ) -> StressRequest:
        """Check a request of the function `name` and transform its fields."""
        places, coefficient = check_request(name, grid, body, depths, friction)
        field = grid.check_field(pressure, "pressure")
        sheared = None if traction is None else _checked_traction(name, traction, grid, coefficient)
        loads = [TransformedLoad.of(field, grid, body, pressure_and_friction(coefficient))]
        if sheared is not None:
            loads += [
                TransformedLoad.of(along, grid, body, TRACTION, exchanged=axis == 1)
                for axis, along in enumerate(sheared)
                if along.any()
            ]
        return cls(grid, places, tuple(loads))

    @property
    def entries(self) -> int:
        """Numbers in the transforms of one depth, for the choice of threads."""
        return 5 * len(self.loads) * self.loads[0].transform.entries

    def for_worker(self, worker: int) -> StressRequest:
        """Return the same request with the transforms of another thread."""
        return replace(self, loads=tuple(load.for_worker(worker) for load in self.loads))

    def write_von_mises(self, index: int, out: FloatArray) -> None:
        """Write von Mises stress of a depth into a contiguous array."""
        first, *others = self.loads
        spectra = self._spectra(index)
        if not others:
            first.write_von_mises(spectra[0], out)
            return
        scratch = first.scratch
        for component in range(1, 6):
            self._write_component(spectra, component, scratch)
            _add_square(scratch, VON_MISES_WEIGHTS[component], _STAGES.get(component, GOES_ON), out)

    def write_components(self, index: int, out: FloatArray) -> None:
        """Write t, d, e, yz, xz, xy of a depth into `out` (6, nx, ny)."""
        spectra = self._spectra(index)
        for component in range(6):
            self._write_component(spectra, component, out[component])

    def _spectra(self, index: int) -> list[StressSpectra]:
        return [load.spectra(self.depths[index]) for load in self.loads]

    def _write_component(self, spectra: list[StressSpectra], component: int, out: FloatArray) -> None:
        first, *others = self.loads
        first.write_component(spectra[0], component, out)
        for load, own in zip(others, spectra[1:], strict=True):
            load.add_component(own, component, out)


def _checked_traction(name: str, traction: ArrayLike, grid: Grid, friction: float) -> FloatArray:
    values = np.asarray(traction, dtype=np.float64)
    if values.shape != (2, *grid.shape) or not np.isfinite(values).all():
        raise InputError(f"{name}: traction {values.shape} must be finite numbers of shape {(2, *grid.shape)} [Pa]")
    if friction != 0:
        raise InputError(f"{name}: friction = {friction!r} and a traction: give one of them")
    return values
