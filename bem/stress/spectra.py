"""Spectra of the stress kernels at a depth, computed once and cached.

The six spectra are those of the hydrostatic and deviatoric combinations

    t = xx + yy + zz,   d = xx - yy,   e = zz - (xx + yy)/2,   yz,   xz,   xy,

because von Mises stress needs only the last five:

    von Mises^2 = 3/4 d^2 + e^2 + 3 (yz^2 + xz^2 + xy^2).

Every kernel is even or odd along each axis, so a spectrum is a real or an imaginary quarter array of
(px/2 + 1)(py/2 + 1) numbers, where px, py are the padded lengths. A depth has six quarter arrays under pressure alone
and twelve with traction: 6.3 MB for 256 x 256 free cells. `set_stress_memory` bounds the cache; where a sweep over the
depths does not fit, the first depths stay and the others are computed again in every sweep.

Two savings leave results within rounding error: columns of negligible coefficients are dropped (`StressSpectra`), and
transforms of short waves have fewer cells of padding (`column_lengths`).
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray, Grid
from bem.kernels.coefficients import STRESS_PARITY, Load, stress_coefficients
from bem.kernels.spectral import stress_response
from bem.materials import Body
from bem.numerics.cache import KeptValues, bytes_of
from bem.threads import ForkSafeLock
from bem.transforms import Multiplier, kernel_spectrum, multiplier, narrowed_lengths, padded_shape


@dataclass
class StressCount:
    """Number of depths whose spectra, and of depths whose tables of the bound, were computed since the last reset."""

    spectra: int = 0
    bounds: int = 0

    def reset(self) -> None:
        """Set all counts to zero."""
        self.spectra = self.bounds = 0


COUNT = StressCount()
"""Counts of this process; values from caches are not counted."""

_COUNTING = ForkSafeLock()

SPECTRA = KeptValues()
"""Cache of `StressSpectra` by grid, elastic ratios, loads and depth."""


def set_stress_memory(limit: int) -> None:
    """Bound the memory of cached stress spectra [bytes]; default 512 MiB, 0 caches none.

    Raises
    ------
    InputError : not a number of bytes.
    """
    SPECTRA.resize(bytes_of("set_stress_memory", limit))


def stress_memory() -> int:
    """Return the memory of the cached stress spectra [bytes]."""
    return SPECTRA.nbytes


def elastic_ratios(body: Body) -> tuple[float, ...]:
    """Return what stress under given loads depends on, the key of caches.

    Poisson's ratios, Young's moduli of layers over that of the half-space, depths of interfaces [m].
    """
    ratios = (solid.youngs_modulus / body.material.youngs_modulus for solid in body.media[:-1])
    return (*(solid.poissons_ratio for solid in body.media), *ratios, *body.interfaces)


def padded_lengths(grid: Grid) -> tuple[int, int]:
    """Return the lengths of the transforms along x and y."""
    return padded_shape(grid.shape, grid.periodic)


def column_lengths(grid: Grid, body: Body) -> tuple[int, ...] | None:
    """Return the lengths of the transforms along x for each wavenumber along y; None where all are equal.

    Where x is free, y is periodic and the body is homogeneous, the kernel of a wave along y decays exponentially along
    x, so short waves need less padding. Kernels of layers may decay more slowly.
    """
    if grid.periodic != (False, True) or not body.homogeneous:
        return None
    decay = 2 * math.pi * grid.spacing[0] / (grid.shape[1] * grid.spacing[1])
    return narrowed_lengths(grid.shape[0], padded_lengths(grid), decay)


Loads = tuple[tuple[Load, float], ...]
"""Loads that are proportional to one field on the surface, each with its factor."""

TRACTION: Loads = ((Load.TANGENTIAL, 1.0),)
"""A traction along +x alone."""


def pressure_and_friction(friction: float) -> Loads:
    """Return the loads proportional to a pressure: the pressure, and the traction friction x pressure along +x."""
    return ((Load.NORMAL, 1.0), *(((Load.TANGENTIAL, friction),) if friction != 0 else ()))


@dataclass(frozen=True, eq=False)
class StressSpectra:
    """Spectra of the kernels of t, d, e, yz, xz, xy at one depth.

    multipliers : (6,), spectrum of each component.
    columns : (6,), number of wavenumbers along y, from zero on, whose coefficients are not negligible. On a periodic
        axis coefficients fall exponentially with depth: 20 cells below the surface half of the wavenumbers are left.
        The others are below the rounding error of the largest.
    """

    multipliers: tuple[Multiplier, ...]
    columns: tuple[int, ...]

    @property
    def nbytes(self) -> int:
        """Return the memory [bytes]."""
        return sum(one.nbytes for one in self.multipliers)


@compiled
def _to_deviatoric(stress):
    """Replace xx, yy, zz by t, d, e in (6, nx, ny)."""
    for i in range(stress.shape[1]):
        for j in range(stress.shape[2]):
            xx, yy, zz = stress[0, i, j], stress[1, i, j], stress[2, i, j]
            stress[0, i, j] = xx + yy + zz
            stress[1, i, j] = xx - yy
            stress[2, i, j] = zz - 0.5 * (xx + yy)


def compute_spectra(grid: Grid, body: Body, depth: float, acting: Loads) -> StressSpectra:
    """Compute the spectra of the kernels at a depth [m] under loads proportional to one field."""
    with _COUNTING:
        COUNT.spectra += 1
    padded, lengths = padded_lengths(grid), column_lengths(grid, body)
    doubly_periodic = all(grid.periodic)
    parts: list[list[tuple[FloatArray, tuple[int, int], float]]] = [[] for _ in range(6)]
    for load, factor in acting:
        response = stress_response if doubly_periodic else stress_coefficients
        kernels = response(grid, body, depth, load)
        _to_deviatoric(kernels)
        for component, parity in enumerate(STRESS_PARITY[load]):
            if doubly_periodic:
                # `multiplier` takes i^2 = -1 for a kernel odd along both axes; the response has it already
                sign = -1.0 if parity == (-1, -1) else 1.0
                quarter = np.ascontiguousarray(kernels[component][: padded[0] // 2 + 1].T) * sign
            else:
                quarter = kernel_spectrum(kernels[component], padded, parity, lengths)
            parts[component].append((quarter, parity, factor))
    multipliers = tuple(multiplier(part) for part in parts)
    return StressSpectra(multipliers, tuple(_significant_columns(one) for one in multipliers))


def _significant_columns(spectrum: Multiplier) -> int:
    """Return the number of wavenumbers along y up to the last with a coefficient above rounding error."""
    parts = [np.abs(part).max(axis=1) for part in (spectrum.real, spectrum.imaginary) if part is not None]
    if not parts:
        return 0
    largest = np.max(parts, axis=0)
    return int(np.flatnonzero(largest >= _SIGNIFICANT * largest.max())[-1]) + 1


_SIGNIFICANT = 2.0**-53
"""Coefficients below this fraction of the largest are dropped: half of a double's last digit."""
