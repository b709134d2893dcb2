"""In-plane and normal displacements of bodies that touch on a curved surface, under tractions along the surface.

Companion of `curved_surface`, with the same cells: rows along x, at the angle a of their tangent t to the horizontal,
and the half-space of a row turned with it (Vollebregt 2021; abstract and outline read). Under tractions (qx, qs) along
x and along its own t, and under a pressure p along its normal, a row j displaces the first body against the second by
(Ux, Us) in its own plane, and both together by Up into the bodies. With the coefficients C of its half-space at the
distance x along the rail and the chord d across it,

    Ux = Cxx qx + Cxs qs,    Us = Cxs qx + Css qs,    Up = Cpp p.

A row i whose angle is larger by D = ai - aj is displaced along x, along its own tangent and into the bodies by

    ux = Ux,    us = Us cos D + Up sin D,    up = Up cos D - Us sin D.

Of bodies with Dundurs' beta = 0 there is no other coupling of pressure and traction. Css and Cpp differ, so that the
coupling is not symmetric: half-spaces turned with the surface are no one elastic body, and what they exchange along
the normals and the tangents balances to the order of Poisson's ratio times the angle only.

Along x the influence is a convolution, applied by FFT with zeros beyond the grid; across it a dense matrix for each
wavenumber. cos D and sin D are sums of products of functions of i and of j, applied before and after the matrix.
Verified in tests/profiles/test_curved_rolling.py.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bem.convolution import ConvolutionCount
from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.kernels.half_space import rectangle_displacement
from bem.kernels.loads import Load
from bem.profiles.curved_surface import CurvedSurface

ComplexArray = NDArray[np.complex128]

MOST_ROWS = 256
"""Most rows of cells across: the matrices then take 0.7 GiB with 256 cells along x."""


@dataclass(frozen=True)
class _Spectra:
    """Influence of rows on rows for each wavenumber along x, (nx + 1, ny, ny) [m/Pa].

    xx, ss : displacement along an axis under traction along it. xs : imaginary part of that along one axis under
    traction along the other. normal : displacement along the normal under pressure, times sin D.
    """

    xx: FloatArray
    ss: FloatArray
    xs: FloatArray
    normal: FloatArray


@dataclass(frozen=True, eq=False)
class CurvedTraction:
    """Displacements under tractions on a curved surface; a `bem.tangential.operator.SlipOperator`.

    Raises
    ------
    InputError : too many rows.
    """

    surface: CurvedSurface
    count: ConvolutionCount = field(default_factory=ConvolutionCount, repr=False)

    def __post_init__(self) -> None:
        if self.grid.shape[1] > MOST_ROWS:
            raise InputError(
                f"rolling on a curved surface: {self.grid.shape[1]} cells across; allowed: {MOST_ROWS} at most"
            )

    @property
    def grid(self) -> Grid:
        """Cells along x and along the arc length of the profile."""
        return self.surface.grid

    @cached_property
    def stiffness(self) -> float:
        """Return the traction over the displacement [Pa/m] of a cell that is loaded alone, mean of both directions."""
        (dx, dy), materials = self.grid.spacing, [body.material for body in self.surface.bodies]
        along = sum(float(rectangle_displacement(0, 0, 0, (dx, dy), one, Load.TANGENTIAL)[0]) for one in materials)
        across = sum(float(rectangle_displacement(0, 0, 0, (dy, dx), one, Load.TANGENTIAL)[0]) for one in materials)
        return 2 / (along + across)

    @cached_property
    def _spectra(self) -> _Spectra:
        (nx, ny), (dx, dy), surface = self.grid.shape, self.grid.spacing, self.surface
        i, j = np.tril_indices(ny)
        chord = np.hypot(surface.y[i] - surface.y[j], surface.z[i] - surface.z[j])
        along = dx * np.arange(nx + 1)[:, None]
        parts = np.zeros((4, nx + 1, len(i)))
        for body in surface.bodies:
            under_x = rectangle_displacement(along, chord, 0.0, (dx, dy), body.material, Load.TANGENTIAL)
            under_s = rectangle_displacement(chord, along, 0.0, (dy, dx), body.material, Load.TANGENTIAL)
            pressed = rectangle_displacement(along, chord, 0.0, (dx, dy), body.material)
            parts += np.stack([under_x[0], under_s[0], under_x[1], pressed[2]])
        parts[3] *= np.sin(surface.angles[i] - surface.angles[j])
        xx, ss, normal = (np.fft.rfft(np.concatenate([one, one[-2:0:-1]]), axis=0).real for one in parts[[0, 1, 3]])
        mixed = parts[2]
        mixed[nx] = 0.0  # no two cells are that far apart
        xs = np.fft.rfft(np.concatenate([mixed, -mixed[-2:0:-1]]), axis=0).imag

        def full(half: FloatArray, sign: float) -> FloatArray:
            out = np.empty((nx + 1, ny, ny))
            out[:, j, i] = sign * half
            out[:, i, j] = half
            return out

        return _Spectra(full(xx, 1.0), full(ss, 1.0), full(xs, -1.0), full(normal, -1.0))

    def apply(self, traction: FloatArray) -> FloatArray:
        """Return the displacement along x and along the rows' tangents (2, nx, ny) [m], first body less second."""
        along, turned = self._in_plane(traction)
        cosine, sine = np.cos(self.surface.angles), np.sin(self.surface.angles)
        return np.stack([along, cosine * turned[0] + sine * turned[1]])

    def normal_displacement(self, traction: FloatArray) -> FloatArray:
        """Return the displacement into the bodies along the rows' normals (nx, ny) [m], both together."""
        turned = self._in_plane(traction)[1]
        cosine, sine = np.cos(self.surface.angles), np.sin(self.surface.angles)
        return np.asarray(cosine * turned[1] - sine * turned[0])

    def displacement_under_pressure(self, pressure: FloatArray) -> FloatArray:
        """Return the displacement along x and along the rows' tangents (2, nx, ny) [m], first body less second."""
        (moved,) = _from_spectra(_multiply(self._spectra.normal, _spectra_of(pressure)), self.grid.shape[0])
        return np.stack([np.zeros_like(moved), moved])

    def _in_plane(self, traction: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return Ux (nx, ny), and the sums over the rows of Us cos(aj) and Us sin(aj), (2, nx, ny) [m].

        (cos aj, sin aj) is the tangent along which the row j displaces.
        """
        self.count.applications += 1
        self.count.weighted += 1.0
        spectra, nx = self._spectra, self.grid.shape[0]
        cosine, sine = np.cos(self.surface.angles), np.sin(self.surface.angles)
        along, across = traction
        x, s = _spectra_of(along), _spectra_of(across)
        sides = _spectra_of(cosine * across, sine * across)
        turned_x = _spectra_of(cosine * along, sine * along)
        ux = _multiply(spectra.xx, x) + 1j * _multiply(spectra.xs, s)
        us = _multiply(spectra.ss, sides) + 1j * _multiply(spectra.xs, turned_x)
        (moved,) = _from_spectra(ux, nx)
        return moved, _from_spectra(us, nx)


def _spectra_of(*fields: FloatArray) -> ComplexArray:
    """Return the spectra along x of fields (nx, ny), with zeros beyond them, (nx + 1, ny, fields)."""
    return np.stack([np.fft.rfft(one, 2 * len(one), axis=0) for one in fields], axis=2)


def _multiply(matrices: FloatArray, spectra: ComplexArray) -> ComplexArray:
    """Return the products of real matrices (n, ny, ny) and complex columns (n, ny, fields)."""
    count = spectra.shape[2]
    product = matrices @ np.concatenate([spectra.real, spectra.imag], axis=2)
    return product[..., :count] + 1j * product[..., count:]


def _from_spectra(spectra: ComplexArray, nx: int) -> FloatArray:
    """Return the fields (fields, nx, ny) of spectra (nx + 1, ny, fields)."""
    return np.moveaxis(np.fft.irfft(spectra, 2 * nx, axis=0)[:nx], 2, 0)
