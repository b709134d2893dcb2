"""The rectangular grid that every field lives on."""

from __future__ import annotations

import math
from dataclasses import dataclass
from numbers import Integral

import numpy as np
from numpy.typing import NDArray

from bem.errors import InputError
from bem.representation import tabled

FloatArray = NDArray[np.float64]


@tabled
@dataclass(frozen=True)
class Grid:
    """A rectangle of equal cells; fields are constant on a cell (free axes) or sampled at its centre (periodic).

    Parameters
    ----------
    shape : (nx, ny), number of cells along x (sliding direction) and y.
    spacing : (dx, dy), cell sides [m].
    periodic : (along x, along y). A free axis has nothing outside the grid; a periodic one repeats for ever.

    Raises
    ------
    InputError : a shape that is not two positive integers, or spacings that are not positive and finite.
    """

    shape: tuple[int, int]
    spacing: tuple[float, float]
    periodic: tuple[bool, bool] = (False, False)

    def __init__(
        self,
        shape: tuple[int, int],
        spacing: tuple[float, float],
        *,
        periodic: tuple[bool, bool] = (False, False),
    ) -> None:
        try:
            nx, ny = shape
            dx, dy = spacing
            along_x, along_y = periodic
        except (TypeError, ValueError):
            raise InputError(
                f"Grid: shape {shape!r}, spacing {spacing!r} and periodic {periodic!r} must each be a pair"
            ) from None
        messages = []
        if not all(isinstance(n, Integral) and not isinstance(n, bool) and n > 0 for n in (nx, ny)):
            messages.append(f"Grid: shape {shape!r} must be two positive integers")
        try:
            sides = (float(dx), float(dy))
        except (TypeError, ValueError):
            sides = (math.nan, math.nan)
        if not all(math.isfinite(d) and d > 0 for d in sides):
            messages.append(f"Grid: spacing {spacing!r} must be two positive, finite lengths in metres")
        if messages:
            raise InputError(messages)
        object.__setattr__(self, "shape", (int(nx), int(ny)))
        object.__setattr__(self, "spacing", sides)
        object.__setattr__(self, "periodic", (bool(along_x), bool(along_y)))

    @property
    def lengths(self) -> tuple[float, float]:
        """Sides of the whole rectangle [m]."""
        return (self.shape[0] * self.spacing[0], self.shape[1] * self.spacing[1])

    @property
    def cells(self) -> int:
        """Number of cells."""
        return self.shape[0] * self.shape[1]

    @property
    def varying_axes(self) -> tuple[int, ...]:
        """Axes along which fields vary: not a periodic one of one cell, whose length means nothing.

        Of a grid with such axes alone both are returned.
        """
        return tuple(axis for axis in (0, 1) if self.shape[axis] > 1 or not self.periodic[axis]) or (0, 1)

    @property
    def cell_area(self) -> float:
        """Area of one cell [m^2]."""
        return self.spacing[0] * self.spacing[1]

    @property
    def area(self) -> float:
        """Area of the whole rectangle [m^2]."""
        return self.cells * self.cell_area

    @property
    def x(self) -> FloatArray:
        """Cell centres along x, shape (nx,) [m]; the origin is the middle of the rectangle."""
        return _centres(self.shape[0], self.spacing[0])

    @property
    def y(self) -> FloatArray:
        """Cell centres along y, shape (ny,) [m]; the origin is the middle of the rectangle."""
        return _centres(self.shape[1], self.spacing[1])

    def wavevectors(self) -> tuple[FloatArray, FloatArray]:
        """Angular wavevectors (kx, ky) of the real transform, shapes (nx, 1) and (1, ny//2 + 1) [rad/m]."""
        nx, ny = self.shape
        dx, dy = self.spacing
        kx = 2 * np.pi * np.fft.fftfreq(nx, dx).astype(np.float64)
        ky = 2 * np.pi * np.fft.rfftfreq(ny, dy).astype(np.float64)
        return kx[:, None], ky[None, :]

    def coarsened(self) -> Grid:
        """A grid of half as many cells along each axis: on a free axis point k is point 2k of this one, a periodic axis
        keeps its length.
        """
        shape = tuple((cells + 1) // 2 for cells in self.shape)
        spacing = tuple(
            cells * side / coarse if periodic else (2 * side if cells > 1 else side)
            for cells, side, periodic, coarse in zip(self.shape, self.spacing, self.periodic, shape, strict=True)
        )
        return Grid((shape[0], shape[1]), (spacing[0], spacing[1]), periodic=self.periodic)

    def check_field(self, field: object, name: str) -> FloatArray:
        """Return `field` as a float64 array of this grid's shape.

        Raises
        ------
        InputError : another shape, a complex or non-numeric type, or values that are not finite.
        """
        array = np.asarray(field)
        if array.dtype.kind not in "fiub":
            raise InputError(f"{name}: expected real numbers, got dtype {array.dtype}")
        if array.shape != self.shape:
            raise InputError(f"{name}: shape {array.shape} does not match the grid's shape {self.shape}")
        array = np.ascontiguousarray(array, dtype=np.float64)
        if not np.isfinite(array).all():
            bad = int(array.size - np.isfinite(array).sum())
            raise InputError(f"{name}: {bad} of {array.size} values are not finite; fill or crop them first")
        return array


def _centres(cells: int, spacing: float) -> FloatArray:
    return (np.arange(cells, dtype=np.float64) - 0.5 * (cells - 1)) * spacing
