"""In-plane surface displacements from tractions along x and y: free and periodic axes, coated bodies.

What a pair of bodies does is the displacement of the first body's surface less the second's, under `traction` on the
first and the opposite one on the second; pressure presses on both. Each kernel is even or odd along each axis, so a
spectrum is a quarter array of reals; both tractions are transformed once, and both displacements once.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.convolution import COUNT, SMALLEST, ConvolutionCount, couples, elastic, shared
from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.kernels import spectral
from bem.kernels.coefficients import IN_PLANE_PARITY, Load, in_plane_coefficients, surface_coefficients
from bem.materials import Body
from bem.transforms import kernel_spectrum, offset_cosines, padded_shape, transform_of

ComplexArray = NDArray[np.complex128]


class InPlaneSpectra(NamedTuple):
    """Of displacement along x under traction along x, along y under y, and of one under the other (odd in both)."""

    xx: FloatArray
    yy: FloatArray
    xy: FloatArray

    @property
    def nbytes(self) -> int:
        """Memory [bytes]."""
        return self.xx.nbytes + self.yy.nbytes + self.xy.nbytes


class PushedSpectra(NamedTuple):
    """Of displacements along x (odd in x) and along y (odd in y) under pressure, imaginary."""

    x: FloatArray
    y: FloatArray

    @property
    def nbytes(self) -> int:
        """Memory [bytes]."""
        return self.x.nbytes + self.y.nbytes


@compiled
def _combine(spectra: InPlaneSpectra, along_x: ComplexArray, along_y: ComplexArray) -> None:
    """Spectra of the displacements in place of those of the tractions, (py // 2 + 1, px)."""
    rows, length = along_x.shape
    half = length // 2 + 1
    for i in range(rows):
        for j in range(length):
            k = j if j < half else length - j
            mixed = spectra.xy[i, k] if j < half else -spectra.xy[i, k]
            one, two = along_x[i, j], along_y[i, j]
            along_x[i, j] = spectra.xx[i, k] * one + mixed * two
            along_y[i, j] = mixed * one + spectra.yy[i, k] * two


@compiled
def _push(odd_x: FloatArray, odd_y: FloatArray, pressure: ComplexArray, out: ComplexArray) -> None:
    """Spectra of displacement along x into `out` and along y in place of the pressure's; imaginary, odd in x or y."""
    rows, length = pressure.shape
    half = length // 2 + 1
    for i in range(rows):
        for j in range(length):
            k = j if j < half else length - j
            turned = complex(-pressure[i, j].imag, pressure[i, j].real)
            out[i, j] = (odd_x[i, k] if j < half else -odd_x[i, k]) * turned
            pressure[i, j] = odd_y[i, k] * turned


@compiled
def _normal(odd_x: FloatArray, odd_y: FloatArray, along_x: ComplexArray, along_y: ComplexArray) -> None:
    """Spectrum of the normal displacement in place of that of the traction along x: the adjoint of `_push`."""
    rows, length = along_x.shape
    half = length // 2 + 1
    for i in range(rows):
        for j in range(length):
            k = j if j < half else length - j
            mixed = odd_y[i, k] * along_y[i, j] + (odd_x[i, k] if j < half else -odd_x[i, k]) * along_x[i, j]
            along_x[i, j] = complex(mixed.imag, -mixed.real)


@dataclass(frozen=True)
class TangentialOperator:
    """Callable: traction (2, nx, ny) [Pa] on the first body -> displacement (2, nx, ny) [m], first less second.

    On a doubly periodic grid displacements are mean-free: a mean traction moves the datum only.
    """

    grid: Grid
    bodies: tuple[Body, ...]
    count: ConvolutionCount = field(default_factory=ConvolutionCount, compare=False, repr=False)
    weight: float = field(default=1.0, compare=False, repr=False)

    @property
    def padded(self) -> tuple[int, int]:
        """Lengths of the transforms."""
        return padded_shape(self.grid.shape, self.grid.periodic)

    @property
    def _key(self) -> tuple[Any, ...]:
        return self.grid, tuple(elastic(body) for body in self.bodies)

    @cached_property
    def spectra(self) -> InPlaneSpectra:
        """Of both bodies together [m/Pa]; shared between operators."""

        def make() -> InPlaneSpectra:
            COUNT.in_plane += len(self.bodies)
            parts = [_in_plane(self.grid, body, self.padded) for body in self.bodies]
            return InPlaneSpectra(*(np.ascontiguousarray(part) for part in np.sum(parts, axis=0)))

        return shared(("in plane", *self._key), make)

    @cached_property
    def _pushed(self) -> PushedSpectra | None:
        """Of displacements under pressure, first body less second; None where they cancel."""
        if not self.coupled:
            return None

        def make() -> PushedSpectra:
            COUNT.tangential += 2 * len(self.bodies)
            signs = (1.0, -1.0)
            found = [_pressed(self.grid, body, self.padded) for body in self.bodies]
            parts = (sum(sign * part[axis] for sign, part in zip(signs, found, strict=False)) for axis in range(2))
            return PushedSpectra(*(np.ascontiguousarray(part) for part in parts))

        return shared(("pushed", *self._key), make)

    @property
    def coupled(self) -> bool:
        """Whether pressure alone makes the surfaces slip: Dundurs' beta is not zero, or layered bodies differ."""
        return couples(self.bodies)

    @property
    def compliance(self) -> tuple[float, float]:
        """Displacements [m/Pa] of a cell along x and along y under a unit traction on itself alone."""
        px, py = self.padded
        here = np.zeros(1, np.int64)
        across, along = offset_cosines(px, here)[0], offset_cosines(py, here)[0]
        xx, yy = (float(np.einsum("i,ij,j->", along, part, across)) for part in self.spectra[:2])
        return xx, yy

    def near_field(self, radius: int) -> FloatArray:
        """Coefficients of the mean of both directions' kernels, (2 radius + 1,) squared, offset zero in the middle."""
        px, py = self.padded
        offsets = np.arange(-radius, radius + 1)
        mean = 0.5 * (self.spectra.xx + self.spectra.yy)
        rows = np.einsum("jk,kl->jl", offset_cosines(py, offsets), mean)
        return np.einsum("il,jl->ij", offset_cosines(px, offsets), rows)

    def coarsened(self) -> TangentialOperator | None:
        """The same bodies on a grid of half as many cells along each axis; None where that grid is too small."""
        grid = self.grid.coarsened()
        return None if max(grid.shape) < SMALLEST else _coarse(self, grid)

    def __call__(self, traction: FloatArray) -> FloatArray:
        """Displacement [m] under `traction` [Pa], both (2, nx, ny).

        Raises
        ------
        InputError : another shape, or values that are not finite.
        """
        traction = np.asarray(traction, dtype=np.float64)
        if traction.shape != (2, *self.grid.shape):
            raise InputError(f"traction: shape {traction.shape!r} must be {(2, *self.grid.shape)!r}")
        if not np.isfinite(traction).all():
            raise InputError("traction: every value must be finite [Pa]")
        return self.apply(traction)

    def apply(self, traction: FloatArray) -> FloatArray:
        """The same unchecked."""
        transform = transform_of(self.grid.shape, self.padded)
        along_x, along_y = transform.forward(traction[0]), transform.forward(traction[1])
        _combine(self.spectra, along_x, along_y)
        return self._back(along_x, along_y)

    def under_pressure(self, pressure: FloatArray) -> FloatArray:
        """In-plane displacement (2, nx, ny) [m] of the first surface less the second under `pressure` (nx, ny) [Pa]."""
        pressure = self.grid.check_field(pressure, "pressure")
        if self._pushed is None:
            return np.zeros((2, *self.grid.shape))
        transform = transform_of(self.grid.shape, self.padded)
        along_y = transform.forward(pressure)
        along_x = transform.empty_spectrum()
        _push(*self._pushed, along_y, along_x)
        return self._back(along_x, along_y)

    def normal_displacement(self, traction: FloatArray) -> FloatArray:
        """Normal displacement (nx, ny) [m] of both surfaces together under `traction` (2, nx, ny) [Pa].

        Into the bodies. By reciprocity the adjoint of `under_pressure`: zero where that is.
        """
        if self._pushed is None:
            return np.zeros(self.grid.shape)
        transform = transform_of(self.grid.shape, self.padded)
        along_x, along_y = transform.forward(traction[0]), transform.forward(traction[1])
        _normal(*self._pushed, along_x, along_y)
        out = np.empty(self.grid.shape)
        transform.inverse(along_x, out=out)
        return out

    def _back(self, along_x: ComplexArray, along_y: ComplexArray) -> FloatArray:
        """Displacements (2, nx, ny) of their spectra, counted."""
        self.count.applications += 1
        self.count.weighted += self.weight
        transform = transform_of(self.grid.shape, self.padded)
        out = np.empty((2, *self.grid.shape))
        for spectrum, part in ((along_x, out[0]), (along_y, out[1])):
            transform.inverse(spectrum, out=part)
        return out


def _coarse(fine: TangentialOperator, grid: Grid) -> TangentialOperator:
    weight = ConvolutionCount.share(fine.weight * grid.cells / fine.grid.cells)
    return TangentialOperator(grid, fine.bodies, fine.count, weight)


def _in_plane(grid: Grid, body: Body, padded: tuple[int, int]) -> FloatArray:
    """Spectra (3, py // 2 + 1, px // 2 + 1) of one body."""
    if all(grid.periodic):
        response = spectral.in_plane_response(grid, body)
        return np.ascontiguousarray(response[:, : padded[0] // 2 + 1].swapaxes(1, 2))
    table = in_plane_coefficients(grid, body)
    # odd along both axes: the true spectrum is minus the one of the quarter
    signs = (1.0, 1.0, -1.0)
    parts = zip(signs, table, IN_PLANE_PARITY, strict=True)
    return np.stack([sign * kernel_spectrum(part, padded, parity) for sign, part, parity in parts])


def _pressed(grid: Grid, body: Body, padded: tuple[int, int]) -> tuple[FloatArray, FloatArray]:
    """Imaginary spectra of (ux, uy) under pressure: by reciprocity, minus those of uz under tractions along x and y."""
    turned = Grid(grid.shape[::-1], grid.spacing[::-1], periodic=grid.periodic[::-1])
    if all(grid.periodic):
        along_x = spectral.surface_response(grid, body, Load.TANGENTIAL)[: padded[0] // 2 + 1].T.copy()
        if padded[0] % 2 == 0:
            along_x[:, -1] = 0.0
        along_y = spectral.surface_response(turned, body, Load.TANGENTIAL)[: padded[1] // 2 + 1].copy()
        if padded[1] % 2 == 0:
            along_y[-1] = 0.0
        return -along_x, -along_y
    along_x = kernel_spectrum(surface_coefficients(grid, body, Load.TANGENTIAL), padded, (-1, 1))
    along_y = kernel_spectrum(surface_coefficients(turned, body, Load.TANGENTIAL).T, padded, (1, -1))
    return -along_x, -along_y
