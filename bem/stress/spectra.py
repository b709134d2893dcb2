"""Kernels of a stress request: checked, their spectra made once and kept in bounded memory.

Spectra are quarter arrays of reals, for

    t = xx + yy + zz,   d = xx - yy,   e = zz - (xx + yy)/2,   yz,   xz,   xy

of which von Mises, sqrt(3/4 d^2 + e^2 + 3 (yz^2 + xz^2 + xy^2)), needs the last five.

Memory: a quarter array holds (px/2 + 1)(py/2 + 1) numbers (p: padded lengths); with traction there are twelve a depth.
Large ones are packed into six bytes a number, and one of the twelve follows from two others: 4.4 MB a depth for 256 x
256 free cells instead of 6.3 MB. They are bounded by `set_stress_memory`. Where a sweep through the depths does not
fit, the first ones are kept and the rest is computed anew every time: the best there is for a repeated sweep.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from bem.arguments import is_finite
from bem.compiled import compiled
from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.kernels.coefficients import STRESS_PARITY, Load, stress_coefficients
from bem.kernels.spectral import stress_response
from bem.materials import Body
from bem.numerics.cache import DEFAULT_LIMIT, bytes_of
from bem.stress.packed import Packed, pack
from bem.threads import ForkSafeLock
from bem.transforms import Multiplier, kernel_spectrum, multiplier, narrowed_lengths, padded_shape


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


MOST_FAMILIES = 256
"""Bodies on grids that a store tells apart at a time: a session of sweeps over materials would name more and more."""


class SweepCache:
    """Bounded store for values that are asked for in repeated sweeps.

    What the last two sweeps did not use gives way; what the present one used does not. Dropping the least recently
    used would, in a sweep a little too long for the memory, drop each value just before it is needed again.
    """

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.kept: dict[Any, _Kept] = {}
        self.used = 0
        self.sweep = 0
        self.families: dict[Any, int] = {}
        self.named = 0
        self.lock = ForkSafeLock()

    def begin(self) -> int:
        """Number of a new sweep."""
        with self.lock:
            self.sweep += 1
            return self.sweep

    def family(self, key: Any) -> int:
        """A number for what the keys of a sweep have in common: hashed once, not for each depth. One that has not been
        asked for in a long time gets a new one; what is kept under the old one gives way as what is not used does."""
        with self.lock:
            number = self.families.pop(key, self.named)
            self.named = max(self.named, number + 1)
            self.families[key] = number  # the latest last
            if len(self.families) > MOST_FAMILIES:
                del self.families[next(iter(self.families))]
            return number

    def get(self, key: Any, sweep: int) -> Any:
        """What is kept under a key, from now on in use by this sweep; None if nothing."""
        with self.lock:
            found = self.kept.get(key)
            if found is None:
                return None
            found.sweep = sweep
            return found.value

    def put(self, key: Any, value: Any, nbytes: int, sweep: int) -> None:
        """Keep a value if there is room for it."""
        with self.lock:
            if key in self.kept:
                return
            self._evict(self.limit - nbytes, sweep - 1)
            if self.used + nbytes <= self.limit:
                self.kept[key] = _Kept(value, nbytes, sweep)
                self.used += nbytes

    def resize(self, limit: int) -> None:
        """Another limit [bytes]."""
        with self.lock:
            self.limit = limit
            self._evict(limit, self.sweep + 1)

    def _evict(self, target: int, before: int) -> None:
        """Drop values last used before a sweep, oldest first, until `target` bytes are held."""
        if self.used <= target:
            return
        for key in sorted((k for k, v in self.kept.items() if v.sweep < before), key=lambda k: self.kept[k].sweep):
            self.used -= self.kept.pop(key).nbytes
            if self.used <= target:
                return


SPECTRA = SweepCache(DEFAULT_LIMIT)


def set_stress_memory(limit: int) -> None:
    """Bound the memory that cached stress spectra may hold [bytes]; default 512 MiB, 0 keeps none.

    Raises
    ------
    InputError : not a number of bytes.
    """
    SPECTRA.resize(bytes_of("set_stress_memory", limit))


def stress_memory() -> int:
    """Memory held by cached stress spectra [bytes]."""
    return SPECTRA.used


def elastic(body: Body) -> tuple[float, ...]:
    """What of a body decides its stresses: Poisson's ratios, moduli over the half-space's, depths of interfaces."""
    ratios = (solid.youngs_modulus / body.material.youngs_modulus for solid in body.media[:-1])
    return (*(solid.poissons_ratio for solid in body.media), *ratios, *body.interfaces)


def check_request(
    name: str, grid: object, body: object, depths: ArrayLike, friction: object
) -> tuple[tuple[float, ...], float]:
    """Depths and friction of a request as numbers.

    Raises
    ------
    InputError : any of them is not what its name says.
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
    return tuple(float(z) for z in values), float(friction)  # type: ignore[arg-type]


def padded_lengths(grid: Grid) -> tuple[int, int]:
    """Lengths of the transforms."""
    return padded_shape(grid.shape, grid.periodic)


def column_lengths(grid: Grid, body: Body) -> tuple[int, ...] | None:
    """Lengths of the transforms along x for each wavenumber along y, where they may be shorter: the waves of a periodic
    y under a homogeneous body (those of layers may fall more slowly along a free x)."""
    if grid.periodic != (False, True) or not body.homogeneous:
        return None
    decay = 2 * math.pi * grid.spacing[0] / (grid.shape[1] * grid.spacing[1])
    return narrowed_lengths(grid.shape[0], padded_lengths(grid), decay)


Loads = tuple[tuple[Load, float], ...]
"""The loads that act, each with its factor of one field."""

TRACTION: Loads = ((Load.TANGENTIAL, 1.0),)
"""A traction along +x alone."""


def loads(friction: float) -> Loads:
    """A pressure, and friction x pressure along +x."""
    return ((Load.NORMAL, 1.0), *(((Load.TANGENTIAL, friction),) if friction != 0 else ()))


@dataclass(frozen=True, eq=False)
class Factors:
    """Spectra of t, d, e, yz, xz, xy at a depth, as they are kept.

    parts : real and imaginary part of each, quarter arrays or `Packed`; None for zero.
    columns : of each, how many wavenumbers along y count; the coefficients of all others are less than the rounding of
        the largest. Below the surface they fall exponentially on a periodic axis: half of them are left 20 cells down.
    traction : f where the imaginary part of e is left out: in a homogeneous body zz under traction is xz under pressure
        (-z V_xz both), so that part is f (3/2 xz - t/2) of what is kept; None where it is kept.
    """

    parts: tuple[tuple[FloatArray | Packed | None, FloatArray | Packed | None], ...]
    parities: tuple[tuple[int, int], ...]
    columns: tuple[int, ...]
    traction: float | None

    @property
    def nbytes(self) -> int:
        """Memory of the arrays."""
        return sum(part.nbytes for pair in self.parts for part in pair if part is not None)

    def multiplier(self, component: int, workspace: FloatArray) -> Multiplier:
        """The spectrum of one of t, d, e, yz, xz, xy, in `workspace` (3, rows, columns) where it has to be unpacked;
        kept where it has not."""
        found = self._whole.get(component)
        if found is not None:
            return found
        real, imaginary = (
            part.unpack(workspace[index]) if isinstance(part, Packed) else part
            for index, part in enumerate(self.parts[component])
        )
        if component == _E and self.traction is not None:
            xz, trace = self.parts[_XZ][1], self.parts[_T][1]
            assert isinstance(xz, Packed)
            assert isinstance(trace, Packed)
            imaginary = xz.unpack(workspace[1])
            _join_traction(imaginary, trace.unpack(workspace[2]), 1.5 * self.traction)
        result = Multiplier(real, imaginary, *self.parities[component])
        if not any(isinstance(part, Packed) for part in self.parts[component]) and self.traction is None:
            self._whole[component] = result
        return result

    @cached_property
    def _whole(self) -> dict[int, Multiplier]:
        return {}


_T, _E, _XZ = 0, 2, 4


@compiled
def _join_traction(xz, trace, factor):
    for i in range(xz.shape[0]):
        for j in range(xz.shape[1]):
            xz[i, j] = factor * xz[i, j] - 0.5 * trace[i, j]


@compiled
def _combine(stress):
    """In place from (xx, yy, zz, ...) to (t, d, e, ...)."""
    for i in range(stress.shape[1]):
        for j in range(stress.shape[2]):
            xx, yy, zz = stress[0, i, j], stress[1, i, j], stress[2, i, j]
            stress[0, i, j] = xx + yy + zz
            stress[1, i, j] = xx - yy
            stress[2, i, j] = zz - 0.5 * (xx + yy)


def packs(grid: Grid) -> bool:
    """Whether spectra are packed: arrays so large that memory counts for more than the 3 % of time it takes.

    Not on doubly periodic grids: their spectra fall exponentially with the wavenumber, and are exact however small.
    """
    padded = padded_lengths(grid)
    return not all(grid.periodic) and (padded[0] // 2 + 1) * (padded[1] // 2 + 1) >= _WORTH_PACKING


_WORTH_PACKING = 1 << 16


def factors_of(grid: Grid, body: Body, depth: float, acting: Loads) -> Factors:
    """Spectra of t, d, e, yz, xz, xy at a depth, computed now."""
    with SPECTRA.lock:
        COUNT.spectra += 1
    padded, lengths = padded_lengths(grid), column_lengths(grid, body)
    wraps, packed = all(grid.periodic), packs(grid)
    shared = packed and body.homogeneous and len(acting) == 2
    parts: list[list[tuple[FloatArray, tuple[int, int], float]]] = [[] for _ in range(6)]
    for load, factor in acting:
        kernels = stress_response(grid, body, depth, load) if wraps else stress_coefficients(grid, body, depth, load)
        _combine(kernels)
        for component, parity in enumerate(STRESS_PARITY[load]):
            if wraps:
                # `multiplier` takes i^2 = -1 for a kernel odd along both axes; the response has it already
                sign = -1.0 if parity == (-1, -1) else 1.0
                quarter = np.ascontiguousarray(kernels[component][: padded[0] // 2 + 1].T) * sign
            elif shared and load is Load.TANGENTIAL and component == _E:
                continue
            else:
                quarter = kernel_spectrum(kernels[component], padded, parity, lengths)
            parts[component].append((quarter, parity, factor))
    whole = [multiplier(part) for part in parts]

    def kept(values: FloatArray | None) -> FloatArray | Packed | None:
        return pack(values) if packed and values is not None else values

    columns = [_columns_of(m) for m in whole]
    if shared:
        columns[_E] = max(columns[_E], columns[_XZ], columns[_T])
    return Factors(
        tuple((kept(m.real), kept(m.imaginary)) for m in whole),
        tuple((m.real_parity, m.imaginary_parity) for m in whole),
        tuple(columns),
        acting[1][1] if shared else None,
    )


def _columns_of(spectrum: Multiplier) -> int:
    """How many wavenumbers along y, from zero on, have a coefficient that is not lost beside the largest."""
    parts = [np.abs(part).max(axis=1) for part in (spectrum.real, spectrum.imaginary) if part is not None]
    if not parts:
        return 0
    highest = np.max(parts, axis=0)
    return int(np.flatnonzero(highest >= _LOST * highest.max())[-1]) + 1


_LOST = 2.0**-53
"""Half of a double's last digit: sums of what is less differ by what the transforms themselves round off."""
