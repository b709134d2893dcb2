"""Checked request of stresses: depths, and the loads on the surface with their transforms.

The transform of a load serves all depths and components. The traction friction x pressure is part of the kernel and
takes no transform. A prescribed traction (2, nx, ny) takes a forward transform for each direction; a traction along +y
is computed as one along +x with the axes exchanged.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from bem.arguments import is_finite
from bem.compiled import compiled
from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.materials import Body
from bem.stress.spectra import (
    SPECTRA,
    TRACTION,
    Loads,
    StressSpectra,
    column_lengths,
    compute_spectra,
    elastic_ratios,
    padded_lengths,
    pressure_and_friction,
)
from bem.transforms import PaddedTransform, transform_of
from bem.transforms.loops import BEGINS, ENDS, GOES_ON


def check_request(
    name: str, grid: object, body: object, depths: ArrayLike, friction: float
) -> tuple[tuple[float, ...], float]:
    """Return depths and friction of a request as numbers.

    Raises
    ------
    InputError : a grid, body, depth or friction coefficient that is not valid; all mistakes are listed.
    """
    messages = []
    if not isinstance(grid, Grid):
        messages.append(f"{name}: grid {grid!r} must be a Grid")
    if not isinstance(body, Body):
        messages.append(f"{name}: body {body!r} must be a Body")
    if not is_finite(friction):
        messages.append(f"{name}: friction {friction!r} must be a finite number")
    values = np.asarray(depths)
    if values.dtype.kind not in "fiu" or values.ndim != 1:
        messages.append(f"{name}: depths must be a one-dimensional sequence of numbers [m]")
    elif not np.isfinite(values).all() or (values < 0).any():
        messages.append(f"{name}: depths must be finite and not negative (0 is the surface) [m]")
    if messages:
        raise InputError(messages)
    return tuple(float(z) for z in values), float(friction)


def check_out(name: str, out: FloatArray | None, shape: tuple[int, ...]) -> FloatArray:
    """Return the array to write into: `out` if it fits, a new one if it is None."""
    if out is None:
        return np.empty(shape)
    if not (isinstance(out, np.ndarray) and out.shape == shape and out.dtype == np.float64 and out.flags.writeable):
        found = f"{out.dtype} {out.shape}" if isinstance(out, np.ndarray) else type(out).__name__
        raise InputError(f"{name}: out ({found}) must be a writeable float64 array of shape {shape}")
    return out


@compiled
def _add_square(values, weight, stage, out):
    """Add weight x values^2 to the sum in `out`; `stage` starts the sum, continues it, or ends it with its root."""
    for i in range(out.shape[0]):
        for j in range(out.shape[1]):
            square = weight * values[i, j] * values[i, j]
            total = square if stage == BEGINS else out[i, j] + square
            out[i, j] = np.sqrt(total) if stage == ENDS else total


VON_MISES_WEIGHTS = (0.0, 0.75, 1.0, 3.0, 3.0, 3.0)
"""Weights of the squares of t, d, e, yz, xz, xy in the square of von Mises stress."""
_STAGES = {1: BEGINS, 5: ENDS}
"""Stage of the first and the last component of the sum; the others have `GOES_ON`."""


@dataclass(frozen=True)
class TransformedLoad:
    """Transform of one field on the surface: the pressure, or one direction of a prescribed traction.

    acting : loads proportional to the field, each with its factor.
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
        """Return a work array for one field."""
        return self.transform.empty_field()

    @cached_property
    def _key(self) -> tuple[Any, ...]:
        return self.grid, elastic_ratios(self.body), self.acting

    def spectra(self, depth: float) -> StressSpectra:
        """Return the spectra of t, d, e, yz, xz, xy at a depth [m], from the cache or computed."""
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


_D, _E = 1, 2
"""Positions of d and e among the components t, d, e, yz, xz, xy."""
_EXCHANGED = (0, 1, 2, 4, 3, 5)
"""Component that t, d, e, yz, xz, xy become when x and y are exchanged."""


@dataclass(frozen=True)
class StressRequest:
    """A checked request.

    depths : (nz,) [m].
    loads : the pressure with friction x pressure, then the directions of a prescribed traction that are not zero.
    residual : (nz,) residual stress xx = yy of the body at each depth, which adds to the stress under the loads [Pa].
    """

    grid: Grid
    depths: tuple[float, ...]
    loads: tuple[TransformedLoad, ...]
    residual: tuple[float, ...]

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
        sheared = None if traction is None else _check_traction(name, traction, grid, coefficient)
        loads = [TransformedLoad.of(field, grid, body, pressure_and_friction(coefficient))]
        if sheared is not None:
            loads += [
                TransformedLoad.of(along, grid, body, TRACTION, exchanged=axis == 1)
                for axis, along in enumerate(sheared)
                if along.any()
            ]
        return cls(grid, places, tuple(loads), tuple(body.residual_stress_at(place) for place in places))

    @property
    def entries(self) -> int:
        """Return how many numbers the transforms of one depth have, for the choice of threads."""
        return 5 * len(self.loads) * self.loads[0].transform.entries

    def for_worker(self, worker: int) -> StressRequest:
        """Return the same request with the transforms of another thread."""
        return replace(self, loads=tuple(load.for_worker(worker) for load in self.loads))

    def write_von_mises(self, index: int, out: FloatArray) -> None:
        """Write von Mises stress of a depth into a contiguous array."""
        first, *others = self.loads
        spectra, residual = self._spectra(index), self.residual[index]
        if not others and residual == 0:
            first.write_von_mises(spectra[0], out)
            return
        scratch = first.scratch
        for component in range(1, 6):
            self._write_component(spectra, component, scratch)
            if component == _E and residual != 0:
                scratch -= residual
            _add_square(scratch, VON_MISES_WEIGHTS[component], _STAGES.get(component, GOES_ON), out)

    def write_components(self, index: int, out: FloatArray) -> None:
        """Write t, d, e, yz, xz, xy of a depth into `out` (6, nx, ny)."""
        spectra, residual = self._spectra(index), self.residual[index]
        for component in range(6):
            self._write_component(spectra, component, out[component])
        if residual != 0:
            out[0] += 2 * residual
            out[_E] -= residual

    def _spectra(self, index: int) -> list[StressSpectra]:
        return [load.spectra(self.depths[index]) for load in self.loads]

    def _write_component(self, spectra: list[StressSpectra], component: int, out: FloatArray) -> None:
        first, *others = self.loads
        first.write_component(spectra[0], component, out)
        for load, own in zip(others, spectra[1:], strict=True):
            load.add_component(own, component, out)


def _check_traction(name: str, traction: ArrayLike, grid: Grid, friction: float) -> FloatArray:
    """Return the traction (2, nx, ny) [Pa] of a request without friction."""
    values = np.asarray(traction, dtype=np.float64)
    if values.shape != (2, *grid.shape) or not np.isfinite(values).all():
        raise InputError(f"{name}: traction {values.shape} must be finite numbers of shape {(2, *grid.shape)} [Pa]")
    if friction != 0:
        raise InputError(f"{name}: friction = {friction!r} and a traction: give one of them")
    return values
