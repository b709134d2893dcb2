"""Stresses plane by plane: six components, or von Mises only.

One forward transform of the pressure serves all depths and components; the traction `friction x pressure` is part of
the kernel, so it costs none of its own. A traction of its own, of both directions, is two sweeps more: that along y is
the one along x with the axes exchanged. Von Mises needs five of the six spectra (see `spectra`): it is a sixth cheaper
than the stress itself, and it is never stored but as one number a point.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray

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
from bem.threads import get_threads, share
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
    for index in range(len(sweep.depths)):
        field = sweep.at(index)
        for component in range(6):
            field(component, result[component, index])
        _share_rows(_recombine, grid.shape[0], result[:, index])
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

    The next plane is computed when it is asked for. Each is a new array; or `out` (nx, ny) written over; or the next of
    `out` (nz, nx, ny).
    """
    sweep = Sweep.of("von_mises_planes", pressure, grid, body, depths, friction, traction)
    if out is not None and np.ndim(out) == 3:
        return planes(sweep, list(check_out("von_mises_planes", out, (len(sweep.depths), *grid.shape))))
    if out is not None:
        check_out("von_mises_planes", out, grid.shape)
    return planes(sweep, [out] * len(sweep.depths))


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
    for _ in planes(sweep, list(result)):
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


@njit(cache=True, nogil=True, error_model="numpy", fastmath=False)
def _von_mises(s, out):  # type: ignore[no-untyped-def]
    for i in range(out.size):
        d = s[0, i] - s[1, i]
        e = s[2, i] - 0.5 * (s[0, i] + s[1, i])
        shear = s[3, i] * s[3, i] + s[4, i] * s[4, i] + s[5, i] * s[5, i]
        out[i] = np.sqrt(0.75 * d * d + e * e + 3.0 * shear)


@njit(cache=True, nogil=True, error_model="numpy", fastmath=False)
def _recombine(start, stop, stress):  # type: ignore[no-untyped-def]
    """In place from (t, d, e, ...) to (xx, yy, zz, ...)."""
    for i in range(start, stop):
        for j in range(stress.shape[2]):
            t, d, e = stress[0, i, j], stress[1, i, j], stress[2, i, j]
            mean = (t - e) / 3.0
            stress[0, i, j] = mean + 0.5 * d
            stress[1, i, j] = mean - 0.5 * d
            stress[2, i, j] = mean + e


@njit(cache=True, nogil=True, error_model="numpy", fastmath=False)
def _begin(start, stop, values, weight, out):  # type: ignore[no-untyped-def]
    for i in range(start, stop):
        for j in range(out.shape[1]):
            out[i, j] = weight * values[i, j] * values[i, j]


@njit(cache=True, nogil=True, error_model="numpy", fastmath=False)
def _accumulate(start, stop, values, weight, out):  # type: ignore[no-untyped-def]
    for i in range(start, stop):
        for j in range(out.shape[1]):
            out[i, j] += weight * values[i, j] * values[i, j]


@njit(cache=True, nogil=True, error_model="numpy", fastmath=False)
def _finish(start, stop, values, weight, out):  # type: ignore[no-untyped-def]
    for i in range(start, stop):
        for j in range(out.shape[1]):
            out[i, j] = np.sqrt(out[i, j] + weight * values[i, j] * values[i, j])


_ROWS = 64  # rows in a block of elementwise work


def _share_rows(work: Any, rows: int, *arguments: Any) -> None:
    def block(_: int, number: int) -> None:
        work(number * _ROWS, min(rows, (number + 1) * _ROWS), *arguments)

    if get_threads() == 1:
        work(0, rows, *arguments)
    else:
        share(block, -(-rows // _ROWS))


SHARES = (0.0, 0.75, 1.0, 3.0, 3.0, 3.0)  # of t, d, e, yz, xz, xy squared in von Mises squared


def planes(sweep: Sweep, outs: Sequence[FloatArray | None]) -> Iterator[FloatArray]:
    """Von Mises stress of one depth after the other, each into its own array, or a new one where that is None."""
    shape = sweep.grid.shape
    if len(sweep.parts) == 1:
        (part,) = sweep.parts
        for index, out in enumerate(outs):
            plane = np.empty(shape) if out is None else out
            part.von_mises(part.factors(sweep.depths[index]), plane)
            yield plane
        return
    scratch = sweep.parts[0].transform.zeros_field()  # aligned: written by the transform itself where y is not padded
    for index, out in enumerate(outs):
        plane = np.empty(shape) if out is None else out
        field = sweep.at(index)
        for component in range(1, 6):
            field(component, scratch)
            work = {1: _begin, 5: _finish}.get(component, _accumulate)
            _share_rows(work, shape[0], scratch, SHARES[component], plane)
        yield plane


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

    @cached_property
    def _scratch(self) -> FloatArray:
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
                stage={1: BEGINS, 5: ENDS}.get(component, GOES_ON),
                columns=factors.columns[component],
            )

    def add(self, factors: Factors, component: int, out: FloatArray) -> None:
        """The same added, in the axes of the request: turned, d changes its sign and yz is xz."""
        scratch = self._scratch
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
    def of(  # reason: a request as users make it
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
