"""From heat to temperature: the table of a heated cell as a convolution, on free and mixed grids.

On a free axis the flux is constant on a cell, on a periodic one it is sampled at its middle, as for displacements.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import erfc

from bem.grid import FloatArray, Grid
from bem.heat.bodies import Conductor
from bem.heat.coefficients import Rows, temperature_table
from bem.transforms import Multiplier, PaddedTransform, kernel_spectrum, multiplier, padded_shape, transform_of

EVEN, ODD_IN_X = (1, 1), (-1, 1)


@dataclass(frozen=True)
class HeatOperator:
    """Callable: heat into a body (nx, ny) [W/m^2] -> rise of its surface temperature (nx, ny) [K]."""

    transform: PaddedTransform
    factor: Multiplier

    def __call__(self, heat: FloatArray) -> FloatArray:
        """The convolution."""
        return self.transform.convolve(heat, self.factor)

    def add_product(self, spectrum: NDArray[np.complex128], total: NDArray[np.complex128]) -> None:
        """Add the rise that heat of a spectrum makes to a spectrum, both (py // 2 + 1, px)."""
        assert self.factor.real is not None
        half = self.factor.real.shape[1]
        mirror = slice(total.shape[1] - half, 0, -1)  # wavenumber px - k of a kernel is that of k, conjugate
        factor = self.factor.real if self.factor.imaginary is None else self.factor.real + 1j * self.factor.imaginary
        total[:, :half] += factor * spectrum[:, :half]
        total[:, half:] += factor[:, mirror].conj() * spectrum[:, half:]


def heat_operator(grid: Grid, body: Conductor, begin: float = 0.0, end: float = math.inf) -> HeatOperator:
    """The rise that heat made between two times leaves; the steady one by default. Not for grids periodic along x.

    Parameters
    ----------
    grid : free along x.
    body : a half-space.
    begin, end : since the heat ended and began to be made [s].
    """
    nx, ny = grid.shape
    dx, dy = grid.spacing
    periodic = grid.periodic[1]
    rows = Rows(ny // 2 + 1, 2 * math.pi / (ny * dy), True) if periodic else Rows(ny, dy, False)
    spread = (math.sqrt(4 * body.diffusivity * begin), math.sqrt(4 * body.diffusivity * end))
    table = temperature_table(nx, dx, rows, abs(body.wavenumber), *spread) / body.conductivity
    if periodic:
        # cosines of the middles of cells: their sum is the sampled kernel
        table = np.fft.irfft(table, ny, axis=1)
    downstream, upstream = table[nx - 1 :], table[nx - 1 :: -1]
    padded = padded_shape(grid.shape, grid.periodic)
    parts = [(kernel_spectrum(0.5 * (downstream + upstream), padded, EVEN), EVEN, 1.0)]
    if body.speed:
        odd = kernel_spectrum(0.5 * (downstream - upstream), padded, ODD_IN_X)
        parts.append((odd, ODD_IN_X, math.copysign(1.0, body.speed)))
    return HeatOperator(transform_of(grid.shape, padded), multiplier(parts))


def periodic_operator(grid: Grid, body: Conductor, begin: float, end: float) -> HeatOperator:
    """The same on a doubly periodic grid, exact in each wave: with l = kappa q^2 + i U q_x,

    sqrt(kappa / l) / k [erf(sqrt(l t))] between the two times; 2 sqrt(kappa t / pi) / k of the mean.
    """
    nx, ny = grid.shape
    dx, dy = grid.spacing
    along = 2 * math.pi * np.arange(nx // 2 + 1) / (nx * dx)
    across = 2 * math.pi * np.arange(ny // 2 + 1) / (ny * dy)
    rate = body.diffusivity * (across[:, None] ** 2 + along**2) + 1j * body.speed * along
    rate[0, 0] = 1.0
    decay = erfc(np.sqrt(rate * begin)) - erfc(np.sqrt(rate * end))
    spectrum = np.sqrt(body.diffusivity / rate) * decay / body.conductivity
    mean = 2 * math.sqrt(body.diffusivity / math.pi) * (math.sqrt(end) - math.sqrt(begin))
    spectrum[0, 0] = mean / body.conductivity
    imaginary = spectrum.imag.copy()
    if nx % 2 == 0:
        imaginary[:, -1] = 0.0
    factor = Multiplier(np.ascontiguousarray(spectrum.real), imaginary if body.speed else None)
    return HeatOperator(transform_of(grid.shape, padded_shape(grid.shape, grid.periodic)), factor)


def approximate_inverse(grid: Grid, bodies: tuple[Conductor, ...], rate: float = 0.0) -> HeatOperator:
    """Heat from a common rise of two bodies' surfaces, with the grid taken as periodic in its padded lengths.

    The exact spectrum of a half-space is 1 / (k sqrt(q^2 + i U q_x / kappa + rate / kappa)) (Carslaw and Jaeger);
    `rate` [1/s] stands for the time since the heat began. Wavenumbers stay above that of the longest wave.
    """
    px, py = padded_shape(grid.shape, grid.periodic)
    dx, dy = grid.spacing
    along = 2 * math.pi * np.arange(px // 2 + 1) / (px * dx)
    across = 2 * math.pi * np.arange(py // 2 + 1) / (py * dy)
    longest = math.pi / math.hypot(px * dx, py * dy)
    squares = np.maximum(across[:, None] ** 2 + along**2, longest**2)
    total = np.zeros(squares.shape, dtype=np.complex128)
    for body in bodies:
        total += 1 / (body.conductivity * np.sqrt(squares + (1j * body.speed * along + rate) / body.diffusivity))
    inverse = 1 / total
    imaginary = inverse.imag.copy()
    if px % 2 == 0:
        imaginary[:, -1] = 0.0  # an odd function has no component at the highest wavenumber
    moves = any(body.speed for body in bodies)
    factor = Multiplier(np.ascontiguousarray(inverse.real), imaginary if moves else None)
    return HeatOperator(transform_of(grid.shape, (px, py)), factor)
