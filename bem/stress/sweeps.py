"""Stresses plane by plane: six components, or von Mises only.

One forward transform of the pressure serves all depths and components; the traction `friction x pressure` is part of
the kernel, so it costs none of its own. A traction of its own, of both directions, is two sweeps more: that along y is
the one along x with the axes exchanged. Von Mises needs five of the six spectra (see `spectra`): it is a sixth cheaper
than the stress itself, and it is never stored but as one number a point.
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
    Factors,
    Loads,
    check_request,
    column_lengths,
    elastic,
    factors_of,
    loads,
    packs,
    padded_lengths,
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
    """Stress in `body` under `pressure` and the traction friction x pressure along +x, at the grid's points.

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
    sweep = Sweep.of("subsurface_stress", pressure, grid, body, depths, friction, traction)
    shape = (6, len(sweep.depths), *grid.shape)
    result = check_out("subsurface_stress", out, shape)

    def plane(own: Sweep, index: int) -> None:
        field = own.at(index)
        for component in range(6):
            field(component, result[component, index])
        _recombine(result[:, index])

    _each_depth(sweep, plane)
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
    """Von Mises stress, one plane (nx, ny) [Pa] for each depth in turn; arguments as in `subsurface_stress`.

    The next plane is computed when it is asked for, with as many after it as there are further threads. Each is a new
    array; or `out` (nx, ny) written over; or the next of `out` (nz, nx, ny).
    """
    sweep = Sweep.of("von_mises_planes", pressure, grid, body, depths, friction, traction)
    if out is None:
        return _planes(sweep, None)
    stack = np.ndim(out) == 3
    checked = check_out("von_mises_planes", out, (len(sweep.depths), *grid.shape) if stack else grid.shape)
    return _planes(sweep, checked)


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
    """Von Mises stress (nz, nx, ny) [Pa] without ever storing six components; arguments as in `subsurface_stress`.

    `out` : (nz, nx, ny) to write into, made if not given.
    """
    sweep = Sweep.of("von_mises_field", pressure, grid, body, depths, friction, traction)
    result = check_out("von_mises_field", out, (len(sweep.depths), *grid.shape))
    _each_depth(sweep, partial(_into, result, 0))
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


@compiled
def _von_mises(s, out):
    for i in range(out.size):
        d = s[0, i] - s[1, i]
        e = s[2, i] - 0.5 * (s[0, i] + s[1, i])
        shear = s[3, i] * s[3, i] + s[4, i] * s[4, i] + s[5, i] * s[5, i]
        out[i] = np.sqrt(0.75 * d * d + e * e + 3.0 * shear)


@compiled
def _recombine(stress):
    """In place from (t, d, e, ...) to (xx, yy, zz, ...)."""
    for i in range(stress.shape[1]):
        for j in range(stress.shape[2]):
            t, d, e = stress[0, i, j], stress[1, i, j], stress[2, i, j]
            mean = (t - e) / 3.0
            stress[0, i, j] = mean + 0.5 * d
            stress[1, i, j] = mean - 0.5 * d
            stress[2, i, j] = mean + e


@compiled
def _add_square(values, weight, stage, out):
    """A term of the sum in `out`, which it begins, goes on with, or ends with its root."""
    for i in range(out.shape[0]):
        for j in range(out.shape[1]):
            square = weight * values[i, j] * values[i, j]
            total = square if stage == BEGINS else out[i, j] + square
            out[i, j] = np.sqrt(total) if stage == ENDS else total


SHARES = (0.0, 0.75, 1.0, 3.0, 3.0, 3.0)  # of t, d, e, yz, xz, xy squared in von Mises squared
_STAGES = {1: BEGINS, 5: ENDS}
"""Of the sum's terms; the others go on with it."""


def _each_depth(sweep: Sweep, work: Callable[[Sweep, int], None], first: int = 0, last: int | None = None) -> None:
    """Depths of a request, from `first` on and before `last`, shared by threads: each has transforms of its own."""
    number = (len(sweep.depths) if last is None else last) - first
    entries = number * sweep.entries
    own = [sweep, *(sweep.beside(worker) for worker in range(1, min(threads_for(entries), number)))]
    share(lambda worker, block: work(own[worker], first + block), number, entries)


def _into(made: FloatArray, first: int, sweep: Sweep, index: int) -> None:
    sweep.von_mises(index, made[index - first])


def _planes(sweep: Sweep, out: FloatArray | None) -> Iterator[FloatArray]:
    """Von Mises stress of one depth after the other: new arrays, or the one or those of `out`."""
    number, shape = len(sweep.depths), sweep.grid.shape
    at_once = max(1, min(threads_for(number * sweep.entries), number))
    for first in range(0, number, at_once):
        last = min(first + at_once, number)
        if out is not None and out.ndim == 3:
            made = out[first:last]
        elif out is not None and at_once == 1:
            made = out[None]
        else:
            made = np.empty((last - first, *shape))
        _each_depth(sweep, partial(_into, made, first), first, last)
        for plane in made:
            if out is None or out.ndim == 3:
                yield plane
                continue
            if at_once > 1:
                out[...] = plane
            yield out


def check_out(name: str, out: FloatArray | None, shape: tuple[int, ...]) -> FloatArray:
    """The array to write into: `out` if it fits, a new one if it is None."""
    if out is None:
        return np.empty(shape)
    if not (isinstance(out, np.ndarray) and out.shape == shape and out.dtype == np.float64 and out.flags.writeable):
        found = f"{out.dtype} {out.shape}" if isinstance(out, np.ndarray) else type(out).__name__
        raise InputError(f"{name}: out ({found}) must be a writeable float64 array of shape {shape}")
    return out


@dataclass(frozen=True)
class Part:
    """One field on the surface: transformed, and the spectra of each depth as they are needed.

    turned : the field and its grid have their axes exchanged, so that a traction along +y is one along +x.
    """

    grid: Grid
    body: Body
    acting: Loads
    transform: PaddedTransform
    spectrum: NDArray[Any]
    workspace: FloatArray
    number: int
    turned: bool

    @classmethod
    def of(cls, field: FloatArray, grid: Grid, body: Body, acting: Loads, *, turned: bool = False) -> Part:
        """Transform a field."""
        if turned:
            field = np.ascontiguousarray(field.T)
            grid = Grid(grid.shape[::-1], grid.spacing[::-1], periodic=grid.periodic[::-1])
        padded = padded_lengths(grid)
        transform = transform_of(grid.shape, padded, lengths=column_lengths(grid, body))
        workspace = np.empty((3 if packs(grid) else 0, padded[1] // 2 + 1, padded[0] // 2 + 1))
        spectrum = transform.forward(field)
        return cls(grid, body, acting, transform, spectrum, workspace, SPECTRA.begin(), turned)

    def beside(self, worker: int) -> Part:
        """The same for another thread."""
        own = self.transform
        transform = transform_of(own.shape, own.padded, own.dtype, own.lengths, worker)
        return replace(self, transform=transform, workspace=np.empty_like(self.workspace))

    @cached_property
    def scratch(self) -> FloatArray:
        """Room for a field."""
        return self.transform.empty_field()

    @cached_property
    def _family(self) -> int:
        return SPECTRA.family((self.grid, elastic(self.body), self.acting))

    def factors(self, depth: float) -> Factors:
        """Spectra of t, d, e, yz, xz, xy at a depth."""
        key = (self._family, depth)
        found: Factors | None = SPECTRA.get(key, self.number)
        if found is None:
            found = factors_of(self.grid, self.body, depth, self.acting)
            SPECTRA.put(key, found, found.nbytes, self.number)
        return found

    def inverse(self, factors: Factors, component: int, out: FloatArray) -> None:
        """One of t, d, e, yz, xz, xy at the points of its own grid."""
        multiplier = factors.multiplier(component, self.workspace)
        self.transform.inverse(self.spectrum, multiplier, out, columns=factors.columns[component])

    def von_mises(self, factors: Factors, out: FloatArray) -> None:
        """Von Mises stress at the points of its own grid, into a contiguous array: no component is ever stored."""
        for component in range(1, 6):
            self.transform.inverse_squared(
                self.spectrum,
                factors.multiplier(component, self.workspace),
                out,
                weight=SHARES[component],
                stage=_STAGES.get(component, GOES_ON),
                columns=factors.columns[component],
            )

    def add(self, factors: Factors, component: int, out: FloatArray) -> None:
        """The same added, in the axes of the request: turned, d changes its sign and yz is xz."""
        scratch = self.scratch
        self.inverse(factors, _TURNED[component] if self.turned else component, scratch)
        if not self.turned:
            out += scratch
        elif component == _D:
            out -= scratch.T
        else:
            out += scratch.T


_D = 1
_TURNED = (0, 1, 2, 4, 3, 5)  # where each of t, d, e, yz, xz, xy lies with x and y exchanged


@dataclass(frozen=True)
class Sweep:
    """A checked request: the fields that act, the first of them the pressure."""

    grid: Grid
    depths: tuple[float, ...]
    parts: tuple[Part, ...]

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
    ) -> Sweep:
        """Check a request and transform its fields."""
        places, coefficient = check_request(name, grid, body, depths, friction)
        field = grid.check_field(pressure, "pressure")
        sheared = None if traction is None else _checked_traction(name, traction, grid, coefficient)
        parts = [Part.of(field, grid, body, loads(coefficient))]
        if sheared is not None:
            parts += [Part.of(t, grid, body, TRACTION, turned=k == 1) for k, t in enumerate(sheared) if t.any()]
        return cls(grid, places, tuple(parts))

    @property
    def entries(self) -> int:
        """Of the transforms of a depth."""
        return 5 * len(self.parts) * self.parts[0].transform.entries

    def beside(self, worker: int) -> Sweep:
        """The same for another thread."""
        return replace(self, parts=tuple(part.beside(worker) for part in self.parts))

    def von_mises(self, index: int, out: FloatArray) -> None:
        """Von Mises stress of a depth, into a contiguous array."""
        if len(self.parts) == 1:
            (part,) = self.parts
            part.von_mises(part.factors(self.depths[index]), out)
            return
        field, scratch = self.at(index), self.parts[0].scratch
        for component in range(1, 6):
            field(component, scratch)
            _add_square(scratch, SHARES[component], _STAGES.get(component, GOES_ON), out)

    def at(self, index: int) -> Callable[[int, FloatArray], None]:
        """What writes one of t, d, e, yz, xz, xy at a depth."""
        first, *others = self.parts
        factors = [part.factors(self.depths[index]) for part in self.parts]

        def write(component: int, out: FloatArray) -> None:
            first.inverse(factors[0], component, out)
            for part, own in zip(others, factors[1:], strict=True):
                part.add(own, component, out)

        return write


def _checked_traction(name: str, traction: ArrayLike, grid: Grid, friction: float) -> FloatArray:
    values = np.asarray(traction, dtype=np.float64)
    if values.shape != (2, *grid.shape) or not np.isfinite(values).all():
        raise InputError(f"{name}: traction {values.shape} must be finite numbers of shape {(2, *grid.shape)} [Pa]")
    if friction != 0:
        raise InputError(f"{name}: friction = {friction!r} and a traction: give one of them")
    return values
