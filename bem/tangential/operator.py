"""In-plane surface displacements from tangential tractions: free and periodic axes, coated bodies.

The displacement of a pair of bodies is that of the first surface less that of the second, under a traction on the first
body and the opposite traction on the second; the pressure acts on both. Every kernel is even or odd along each axis, so
its spectrum is a quarter array of real numbers. One application transforms both components of the traction once, and
both components of the displacement once back.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.convolution import (
    COUNT,
    SMALLEST_GRID,
    ConvolutionCount,
    DisplacementOperator,
    KernelSpectra,
    cached_spectra,
    couples,
    elastic_constants,
)
from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.kernels import spectral
from bem.kernels.coefficients import IN_PLANE_PARITY, Load, in_plane_coefficients, surface_coefficients
from bem.materials import Body
from bem.transforms import kernel_spectrum, offset_cosines, padded_shape, transform_of

ComplexArray = NDArray[np.complex128]


class SlipOperator(Protocol):
    """Displacement under tractions, as steady rolling needs it: of flat surfaces or of curved ones."""

    @property
    def grid(self) -> Grid:
        """Cells along the rolling and across it."""

    @property
    def count(self) -> ConvolutionCount:
        """Applications so far."""

    @property
    def stiffness(self) -> float:
        """Return the traction over the displacement [Pa/m] of a cell that is loaded alone."""

    def apply(self, traction: FloatArray) -> FloatArray:
        """Return the displacement (2, nx, ny) [m], first body less second, under tractions on the first one [Pa]."""


class InPlaneSpectra(NamedTuple):
    """Spectra of the in-plane kernels.

    xx, yy : displacement along an axis under traction along that axis, even in x and y.
    xy : displacement along one axis under traction along the other, odd in x and y.
    """

    xx: FloatArray
    yy: FloatArray
    xy: FloatArray

    @property
    def nbytes(self) -> int:
        """Return the memory [bytes]."""
        return self.xx.nbytes + self.yy.nbytes + self.xy.nbytes


class PressureSpectra(NamedTuple):
    """Imaginary parts of the spectra of displacement along x (odd in x) and along y (odd in y) under pressure."""

    x: FloatArray
    y: FloatArray

    @property
    def nbytes(self) -> int:
        """Return the memory [bytes]."""
        return self.x.nbytes + self.y.nbytes


@compiled
def _multiply_traction(spectra: InPlaneSpectra, along_x: ComplexArray, along_y: ComplexArray) -> None:
    """Replace the spectra (py // 2 + 1, px) of the traction by those of the displacement."""
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
def _multiply_pressure(odd_x: FloatArray, odd_y: FloatArray, pressure: ComplexArray, out: ComplexArray) -> None:
    """Write the spectrum of the displacement along x to `out`, and replace the pressure's by that along y."""
    rows, length = pressure.shape
    half = length // 2 + 1
    for i in range(rows):
        for j in range(length):
            k = j if j < half else length - j
            turned = complex(-pressure[i, j].imag, pressure[i, j].real)
            out[i, j] = (odd_x[i, k] if j < half else -odd_x[i, k]) * turned
            pressure[i, j] = odd_y[i, k] * turned


@compiled
def _multiply_normal(odd_x: FloatArray, odd_y: FloatArray, along_x: ComplexArray, along_y: ComplexArray) -> None:
    """Replace the spectrum of the traction along x by that of the normal displacement; adjoint of the pressure's."""
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

    On a doubly periodic grid the mean displacement is zero by definition: a mean traction moves the datum only.
    """

    grid: Grid
    bodies: tuple[Body, ...]
    count: ConvolutionCount = field(default_factory=ConvolutionCount, compare=False, repr=False)
    weight: float = field(default=1.0, compare=False, repr=False)

    @property
    def padded(self) -> tuple[int, int]:
        """Return the lengths of the transforms."""
        return padded_shape(self.grid.shape, self.grid.periodic)

    @property
    def _key(self) -> tuple[Any, ...]:
        return self.grid, tuple(elastic_constants(body) for body in self.bodies)

    @cached_property
    def spectra(self) -> InPlaneSpectra:
        """Return the spectra of both bodies together [m/Pa]; operators share them."""

        def compute() -> InPlaneSpectra:
            COUNT.in_plane += len(self.bodies)
            parts = [_spectra_under_traction(self.grid, body, self.padded) for body in self.bodies]
            return InPlaneSpectra(*(np.ascontiguousarray(part) for part in np.sum(parts, axis=0)))

        return cached_spectra(("in plane", *self._key), compute)

    @cached_property
    def _pressure_spectra(self) -> PressureSpectra | None:
        """Return the spectra under pressure [m/Pa], first body less second; None if both cancel."""
        if not self.displaced_by_pressure:
            return None

        def compute() -> PressureSpectra:
            COUNT.tangential += 2 * len(self.bodies)
            signs = (1.0, -1.0)
            responses = [_spectra_under_pressure(self.grid, body, self.padded) for body in self.bodies]
            parts = (sum(sign * part[axis] for sign, part in zip(signs, responses, strict=False)) for axis in range(2))
            return PressureSpectra(*(np.ascontiguousarray(part) for part in parts))

        return cached_spectra(("under pressure", *self._key), compute)

    @property
    def displaced_by_pressure(self) -> bool:
        """Return True if pressure displaces the surfaces against each other in the plane.

        It does if Dundurs' beta is not zero or layers differ. Tractions then change the gap too.
        """
        return couples(self.bodies)

    @property
    def compliance(self) -> tuple[float, float]:
        """Return the displacements [m/Pa] of a cell along x and along y under a unit traction on that cell alone."""
        px, py = self.padded
        here = np.zeros(1, np.int64)
        across, along = offset_cosines(px, here)[0], offset_cosines(py, here)[0]
        xx, yy = (float(np.einsum("i,ij,j->", along, part, across)) for part in self.spectra[:2])
        return xx, yy

    @property
    def stiffness(self) -> float:
        """Return the traction over the displacement [Pa/m] of a cell that is loaded alone, mean of both directions."""
        return 2 / sum(self.compliance)

    def along(self, direction: tuple[float, float]) -> DisplacementOperator:
        """Return the displacement along a unit vector under traction along it, as the operator of a normal contact.

        One application counts as half of an application of this operator.
        """
        kernel = DirectionalKernel(self.bodies, direction)
        return DisplacementOperator(
            self.grid, self.bodies, count=self.count, weight=0.5 * self.weight, spectra_on=kernel
        )

    def coarsened(self) -> TangentialOperator | None:
        """Return the operator on a grid of half as many cells along each axis; None if that grid is too small."""
        grid = self.grid.coarsened()
        if max(grid.shape) < SMALLEST_GRID:
            return None
        weight = ConvolutionCount.round_weight(self.weight * grid.cells / self.grid.cells)
        return TangentialOperator(grid, self.bodies, self.count, weight)

    def __call__(self, traction: FloatArray) -> FloatArray:
        """Return the displacement [m] under `traction` [Pa], both (2, nx, ny).

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
        """Return the displacement [m] under a traction [Pa] without checks."""
        transform = transform_of(self.grid.shape, self.padded)
        along_x, along_y = transform.forward(traction[0]), transform.forward(traction[1])
        _multiply_traction(self.spectra, along_x, along_y)
        return self._inverse(along_x, along_y)

    def displacement_under_pressure(self, pressure: FloatArray) -> FloatArray:
        """Return the in-plane displacement (2, nx, ny) [m], first less second, under `pressure` (nx, ny) [Pa].

        Zero without a convolution if the bodies respond alike.
        """
        pressure = self.grid.check_field(pressure, "pressure")
        if self._pressure_spectra is None:
            return np.zeros((2, *self.grid.shape))
        transform = transform_of(self.grid.shape, self.padded)
        along_y = transform.forward(pressure)
        along_x = transform.empty_spectrum()
        _multiply_pressure(*self._pressure_spectra, along_y, along_x)
        return self._inverse(along_x, along_y)

    def normal_displacement(self, traction: FloatArray) -> FloatArray:
        """Return the normal displacement (nx, ny) [m], sum of both surfaces, under `traction` (2, nx, ny) [Pa].

        Positive into the bodies. By reciprocity this map is the adjoint of `displacement_under_pressure`; both vanish
        together.
        """
        if self._pressure_spectra is None:
            return np.zeros(self.grid.shape)
        transform = transform_of(self.grid.shape, self.padded)
        along_x, along_y = transform.forward(traction[0]), transform.forward(traction[1])
        _multiply_normal(*self._pressure_spectra, along_x, along_y)
        out = np.empty(self.grid.shape)
        transform.inverse(along_x, out=out)
        return out

    def _inverse(self, along_x: ComplexArray, along_y: ComplexArray) -> FloatArray:
        """Return the displacement (2, nx, ny) [m] of the spectra of its components, and count one application."""
        self.count.applications += 1
        self.count.weighted += self.weight
        transform = transform_of(self.grid.shape, self.padded)
        out = np.empty((2, *self.grid.shape))
        for spectrum, part in ((along_x, out[0]), (along_y, out[1])):
            transform.inverse(spectrum, out=part)
        return out


@dataclass(frozen=True)
class DirectionalKernel:
    """Kernel of the displacement along a unit vector under traction along it, without its odd part."""

    bodies: tuple[Body, ...]
    direction: tuple[float, float]

    def __call__(self, grid: Grid) -> KernelSpectra:
        """Return its spectrum on a grid, divided by a power of two [m/Pa]."""
        x, y = self.direction
        spectra = TangentialOperator(grid, self.bodies).spectra
        even = x * x * spectra.xx + y * y * spectra.yy
        unit = 2.0 ** round(math.log2(float(np.abs(even).max())))
        return KernelSpectra(even / unit, None, unit)


def tangential_operator(grid: Grid, bodies: Body | tuple[Body, Body]) -> TangentialOperator:
    """Return the operator from the traction on the first of one or two bodies to their relative displacement.

    Raises
    ------
    InputError : not a Grid, not one or two bodies.
    """
    messages = []
    pair = (bodies,) if isinstance(bodies, Body) else bodies
    if not isinstance(grid, Grid):
        messages.append(f"grid: {grid!r} must be a Grid")
    if not isinstance(pair, tuple | list) or len(pair) not in (1, 2) or not all(isinstance(b, Body) for b in pair):
        messages.append(f"bodies: {bodies!r} must be one Body or a pair of them")
    if not messages and grid.cells == 1 and all(grid.periodic):
        messages.append("grid: one cell that is periodic along both axes has no displacement; give at least two cells")
    if messages:
        raise InputError(messages)
    return TangentialOperator(grid, tuple(pair))


def _spectra_under_traction(grid: Grid, body: Body, padded: tuple[int, int]) -> FloatArray:
    """Return the spectra xx, yy and xy of one body under tractions [m/Pa], (3, py // 2 + 1, px // 2 + 1)."""
    if all(grid.periodic):
        response = spectral.in_plane_response(grid, body)
        return np.ascontiguousarray(response[:, : padded[0] // 2 + 1].swapaxes(1, 2))
    table = in_plane_coefficients(grid, body)
    # odd along both axes: the true spectrum is minus the one of the quarter
    signs = (1.0, 1.0, -1.0)
    parts = zip(signs, table, IN_PLANE_PARITY, strict=True)
    return np.stack([sign * kernel_spectrum(part, padded, parity) for sign, part, parity in parts])


def _spectra_under_pressure(grid: Grid, body: Body, padded: tuple[int, int]) -> tuple[FloatArray, FloatArray]:
    """Return the imaginary parts of the spectra of (ux, uy) of one body under pressure [m/Pa].

    By reciprocity they are minus those of uz under traction.
    """
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
