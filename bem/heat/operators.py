"""Linear maps from heat flux to surface temperature: convolutions on a grid, and the matrix of a line contact.

On a free axis the flux is constant in a cell; on a periodic axis it is sampled at the cell's centre, as for
displacements. A kernel is stored as an even and an odd part along x, the direction of motion: only the odd part changes
sign with the speed.

In a line contact bands of heat extend without end along y. A unit flux from x1 to x2 raises the surface by

    1/(pi k) integral exp(w (x - x')) K0(|w (x - x')|) dx',    w = U/(2 kappa)

(Jaeger 1942; Carslaw and Jaeger, Conduction of Heat in Solids (1959), section 10.7), with the integral in closed form
(Abramowitz and Stegun, 11.3.16). A body at rest has no steady temperature under a line of heat.

Verified in tests/heat.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.special import erfc, k0e, k1e

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.heat.bodies import Conductor
from bem.heat.coefficients import Rows, temperature_table
from bem.transforms import Multiplier, PaddedTransform, kernel_spectrum, multiplier, padded_shape, transform_of

EVEN, ODD_IN_X = (1, 1), (-1, 1)
_FAR_UPSTREAM = 20.0
"""Peclet number upstream of which a band's heat is below round-off."""


@dataclass(frozen=True)
class HeatOperator:
    """Convolution from heat into a body (nx, ny) [W/m^2] to its temperature rise (nx, ny) [K]."""

    transform: PaddedTransform
    multiplier: Multiplier

    def __call__(self, heat: FloatArray) -> FloatArray:
        """Temperature rise under `heat`."""
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


def heat_operator(grid: Grid, body: Conductor, begin: float = 0.0, end: float = math.inf) -> HeatOperator:
    """Operator of heat that was generated for a while; of the steady temperature by default.

    Parameters
    ----------
    grid : free along x.
    body : a half-space.
    begin, end : times since the heat ended and since it began [s].
    """
    nx, ny = grid.shape
    dx, dy = grid.spacing
    periodic = grid.periodic[1]
    rows = Rows(ny // 2 + 1, 2 * math.pi / (ny * dy), True) if periodic else Rows(ny, dy, False)
    spread = (math.sqrt(4 * body.diffusivity * begin), math.sqrt(4 * body.diffusivity * end))
    table = temperature_table(nx, dx, rows, abs(body.wavenumber), *spread) / body.conductivity
    if periodic:
        # the kernel sampled at the centres of cells is the sum of its cosines
        table = np.fft.irfft(table, ny, axis=1)
    downstream, upstream = table[nx - 1 :], table[nx - 1 :: -1]
    padded = padded_shape(grid.shape, grid.periodic)
    parts = [(kernel_spectrum(0.5 * (downstream + upstream), padded, EVEN), EVEN, 1.0)]
    if body.speed:
        odd = kernel_spectrum(0.5 * (downstream - upstream), padded, ODD_IN_X)
        parts.append((odd, ODD_IN_X, math.copysign(1.0, body.speed)))
    return HeatOperator(transform_of(grid.shape, padded), multiplier(parts))


def periodic_operator(grid: Grid, body: Conductor, begin: float, end: float) -> HeatOperator:
    """Operator of heat generated from `end` to `begin` ago [s] on a doubly periodic grid, exact for each wave.

    With l = kappa q^2 + i U q_x the transfer function is sqrt(kappa / l) / k [erf(sqrt(l t))] between the two times,
    and 2 sqrt(kappa t / pi) / k for the mean.
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
    kernel = Multiplier(np.ascontiguousarray(spectrum.real), imaginary if body.speed else None)
    return HeatOperator(transform_of(grid.shape, padded_shape(grid.shape, grid.periodic)), kernel)


def approximate_inverse(grid: Grid, bodies: tuple[Conductor, ...], rate: float = 0.0) -> HeatOperator:
    """Preconditioner: the inverse of the sum of all bodies' transfer functions, periodic in the padded lengths.

    The transfer function of a half-space is 1 / (k sqrt(q^2 + i U q_x / kappa + rate / kappa)) (Carslaw and Jaeger);
    `rate` [1/s] stands for the inverse of the time since the heat began. The wavenumber is bounded from below by that
    of the longest wave.
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
    kernel = Multiplier(np.ascontiguousarray(inverse.real), imaginary if moves else None)
    return HeatOperator(transform_of(grid.shape, (px, py)), kernel)


def band_temperatures(edges: FloatArray, body: Conductor) -> FloatArray:
    """Temperature rise at the centres of the cells of a line contact per unit flux into each cell, (m, m) [K m^2/W].

    Parameters
    ----------
    edges : (m + 1,) edges of the cells, ascending [m].
    body : a half-space that moves.

    Raises
    ------
    InputError : a body at rest.
    """
    if body.wavenumber == 0:
        raise InputError(
            "band_temperatures: the body is at rest (speed 0): under a line of heat no steady state exists"
        )
    centres = 0.5 * (edges[1:] + edges[:-1])
    primitive = _primitive(body.wavenumber * (centres[:, None] - edges[None, :]))
    return np.asarray((primitive[:, :-1] - primitive[:, 1:]) / (np.pi * body.conductivity * body.wavenumber))


def _primitive(t: FloatArray) -> FloatArray:
    """Integral of exp(s) K0(|s|) from 0 to t."""
    out = np.where(t == 0, 0.0, -1.0)
    near = (t != 0) & (t > -_FAR_UPSTREAM)
    size = np.abs(t[near])
    zeroth, first = k0e(size), k1e(size)
    downstream = size * (zeroth + first) - 1
    upstream = -1 - size * np.exp(-2 * size) * (zeroth - first)
    out[near] = np.where(t[near] > 0, downstream, upstream)
    return out
