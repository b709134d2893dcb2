"""Linear maps from heat flux to surface temperature: convolutions on a grid.

On a free axis the flux is constant in a cell; on a periodic axis it is sampled at the cell's centre, as for
displacements. A kernel is stored as an even and an odd part along x, the direction of motion: only the odd part changes
sign with the speed.

The *age* of heat is the time since it was generated. An operator takes heat of ages between two values; from 0 to
infinity it gives the steady temperature.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import erfc

from bem.grid import FloatArray, Grid
from bem.heat.bodies import Conductor
from bem.heat.coefficients import TransverseBasis, temperature_table
from bem.heat.layers import added_impedance, added_table
from bem.transforms import Multiplier, PaddedTransform, kernel_spectrum, multiplier, padded_shape, transform_of

EVEN, ODD_IN_X = (1, 1), (-1, 1)


@dataclass(frozen=True)
class HeatOperator:
    """Convolution from heat into a body (nx, ny) [W/m^2] to its temperature rise (nx, ny) [K]."""

    transform: PaddedTransform
    multiplier: Multiplier

    def __call__(self, heat: FloatArray) -> FloatArray:
        """Return the temperature rise (nx, ny) [K] under `heat` (nx, ny) [W/m^2]."""
        return self.transform.convolve(heat, self.multiplier)

    def add_product(self, heat_spectrum: NDArray[np.complex128], total: NDArray[np.complex128]) -> None:
        """Add the spectrum of the temperature rise to `total`, both spectra (py // 2 + 1, px)."""
        real, imaginary = self.multiplier.real, self.multiplier.imaginary
        assert real is not None
        half = real.shape[1]
        mirror = slice(total.shape[1] - half, 0, -1)  # the kernel at wavenumber px - k is the conjugate of that at k
        kernel = real if imaginary is None else real + 1j * imaginary
        total[:, :half] += kernel * heat_spectrum[:, :half]
        total[:, half:] += kernel[:, mirror].conj() * heat_spectrum[:, half:]


def heat_operator(grid: Grid, body: Conductor, least_age: float = 0.0, largest_age: float = math.inf) -> HeatOperator:
    """Return the operator of heat of these ages; of the steady temperature by default.

    Parameters
    ----------
    grid : free along x; along y free or periodic.
    body : a half-space; its layers count in the steady temperature alone.
    least_age, largest_age : times since the heat ended and since it began [s].
    """
    nx, ny = grid.shape
    dx, dy = grid.spacing
    periodic = grid.periodic[1]
    basis = TransverseBasis(ny // 2 + 1, 2 * math.pi / (ny * dy), True) if periodic else TransverseBasis(ny, dy, False)
    spread = (math.sqrt(4 * body.diffusivity * least_age), math.sqrt(4 * body.diffusivity * largest_age))
    table = temperature_table(nx, dx, basis, abs(body.peclet_per_length), *spread) / body.conductivity
    if periodic:
        # the kernel sampled at the centres of cells is the sum of its cosines
        table = np.fft.irfft(table, ny, axis=1)
    if body.layers:
        table = table + added_table(grid, body)
    downstream, upstream = table[nx - 1 :], table[nx - 1 :: -1]
    padded = padded_shape(grid.shape, grid.periodic)
    parts = [(kernel_spectrum(0.5 * (downstream + upstream), padded, EVEN), EVEN, 1.0)]
    if body.speed:
        odd = kernel_spectrum(0.5 * (downstream - upstream), padded, ODD_IN_X)
        parts.append((odd, ODD_IN_X, math.copysign(1.0, body.speed)))
    return HeatOperator(transform_of(grid.shape, padded), multiplier(parts))


def periodic_operator(grid: Grid, body: Conductor, least_age: float, largest_age: float) -> HeatOperator:
    """Return the operator of heat of these ages on a doubly periodic grid, exact for each wave.

    With the rate l = kappa q^2 + i U q_x of a wave the transfer function is

        sqrt(kappa / l) / k [erf(sqrt(l largest_age)) - erf(sqrt(l least_age))],

    and 2 sqrt(kappa / pi) / k [sqrt(largest_age) - sqrt(least_age)] for the mean.

    Parameters
    ----------
    grid : periodic along both axes.
    body : a half-space.
    least_age, largest_age : times since the heat ended and since it began [s].
    """
    nx, ny = grid.shape
    dx, dy = grid.spacing
    along = 2 * math.pi * np.arange(nx // 2 + 1) / (nx * dx)
    across = 2 * math.pi * np.arange(ny // 2 + 1) / (ny * dy)
    rate = body.diffusivity * (across[:, None] ** 2 + along**2) + 1j * body.speed * along
    rate[0, 0] = 1.0
    decay = erfc(np.sqrt(rate * least_age)) - erfc(np.sqrt(rate * largest_age))
    spectrum = np.sqrt(body.diffusivity / rate) * decay / body.conductivity
    mean = 2 * math.sqrt(body.diffusivity / math.pi) * (math.sqrt(largest_age) - math.sqrt(least_age))
    spectrum[0, 0] = mean / body.conductivity
    imaginary = spectrum.imag.copy()
    if nx % 2 == 0:
        imaginary[:, -1] = 0.0
    kernel = Multiplier(np.ascontiguousarray(spectrum.real), imaginary if body.speed else None)
    return HeatOperator(transform_of(grid.shape, padded_shape(grid.shape, grid.periodic)), kernel)


def approximate_inverse(grid: Grid, bodies: tuple[Conductor, ...], rate: float = 0.0) -> HeatOperator:
    """Return the preconditioner: the inverse of the sum of all bodies' transfer functions, periodic in padded lengths.

    The transfer function of a half-space is 1 / (k sqrt(q^2 + i U q_x / kappa + rate / kappa)) (Carslaw and Jaeger);
    `rate` [1/s] replaces the time derivative: 0 for the steady state, pi / (4 t) for heat of ages up to t, which is
    exact for the mean. The wavenumber is bounded from below by that of the longest wave.
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
        if body.layers:
            total += added_impedance(body, squares, np.broadcast_to(along, squares.shape))
    inverse = 1 / total
    imaginary = inverse.imag.copy()
    if px % 2 == 0:
        imaginary[:, -1] = 0.0  # an odd function has no component at the highest wavenumber
    moves = any(body.speed for body in bodies)
    kernel = Multiplier(np.ascontiguousarray(inverse.real), imaginary if moves else None)
    return HeatOperator(transform_of(grid.shape, (px, py)), kernel)
