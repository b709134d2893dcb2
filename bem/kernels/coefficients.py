"""Influence coefficients on a grid: the kernel is selected by the periodicity of the grid and by the body.

A coefficient is the response at the centre of one cell to a unit load on another, at an offset of (i dx, j dy). Along a
periodic axis the images of the loaded cell are summed. Doubly periodic grids have no coefficients: their operator is
diagonal in Fourier space, see `spectral`.

Linear algebra has one thread here: its rounding depends on the number of threads, and callers cache the coefficients.
"""

from __future__ import annotations

from types import ModuleType

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray, Grid
from bem.kernels import half_space, semi_periodic, subsurface
from bem.kernels.loads import (
    IN_PLANE_PARITY,
    STRESS_PARITY,
    SURFACE_PARITY,
    Load,
    refuse_special_surface,
)
from bem.kernels.special_surfaces import special_surface
from bem.materials import Body
from bem.threads import one_blas_thread

__all__ = [
    "IN_PLANE_PARITY",
    "STRESS_PARITY",
    "SURFACE_PARITY",
    "Load",
    "in_plane_coefficients",
    "odd_surface_coefficients",
    "stress_coefficients",
    "surface_coefficients",
]


@one_blas_thread
def surface_coefficients(grid: Grid, body: Body, load: Load) -> FloatArray:
    """Return the normal surface displacement [m/Pa] of a unit load on the cell at the origin, shape (nx, ny).

    Entry [i, j] belongs to the offset (i dx, j dy), i = 0..nx-1, j = 0..ny-1. Other offsets follow from
    `SURFACE_PARITY`. On a grid with one periodic axis the datum is that of `semi_periodic`. Of a crystal it is the part
    that is even along each axis; `odd_surface_coefficients` has the rest.

    Raises
    ------
    InputError : a doubly periodic grid; a crystal, or surface tension, under traction.
    """
    _refuse_doubly_periodic(grid)
    if load is Load.TANGENTIAL:
        refuse_special_surface(body, "displacements under traction")
    if not body.boussinesq and body.homogeneous:
        return special_surface(body.material).surface_table(grid, body.material)
    if grid.periodic == (False, False):
        table = half_space.surface_table(grid.shape, grid.spacing, body.surface_material, load)
    else:
        table = semi_periodic.surface_table(grid, body.surface_material, load)
    if not body.homogeneous:
        table += _layered(grid).surface_remainder(grid, body, load)
    return table


@one_blas_thread
def odd_surface_coefficients(grid: Grid, body: Body) -> FloatArray | None:
    """Return the part of the displacement under pressure that is odd along both axes, shape (nx, ny) [m/Pa].

    None of a body that responds alike on both sides of the x axis: all but crystals do.

    Raises
    ------
    InputError : a doubly periodic grid.
    """
    _refuse_doubly_periodic(grid)
    if body.material.stiffness is None or body.material.stiffness.mirror_symmetric:
        return None
    from bem.kernels.anisotropic import odd_surface_table  # late, because few bodies need it

    return odd_surface_table(grid, body.material)


@one_blas_thread
def in_plane_coefficients(grid: Grid, body: Body) -> FloatArray:
    """Return the in-plane surface displacements [m/Pa] of unit tractions on the cell at the origin, shape (3, nx, ny).

    Components: ux under traction along x, uy under traction along y, ux under traction along y (equal to uy under
    traction along x). Entry
    [:, i, j] belongs to the offset (i dx, j dy); others follow from `IN_PLANE_PARITY`. On a grid with one periodic axis
    the datum is that of `semi_periodic`.

    Raises
    ------
    InputError : a doubly periodic grid; a crystal or surface tension.
    """
    _refuse_doubly_periodic(grid)
    refuse_special_surface(body, "displacements under traction")
    if grid.periodic == (False, False):
        table = half_space.in_plane_table(grid.shape, grid.spacing, body.surface_material)
    else:
        table = semi_periodic.in_plane_table(grid, body.surface_material)
    if not body.homogeneous:
        table += _layered(grid).in_plane_remainder(grid, body)
    return table


@one_blas_thread
def stress_coefficients(grid: Grid, body: Body, depth: float, load: Load) -> FloatArray:
    """Return the stresses (xx yy zz yz xz xy) at `depth` [m] of a unit load on the cell at the origin: (6, nx, ny).

    Stress per unit load [Pa/Pa]. Entry [:, i, j] belongs to the offset (i dx, j dy); others follow from
    `STRESS_PARITY`.

    Raises
    ------
    InputError : a doubly periodic grid; a depth that is negative or not finite; a crystal or surface tension.
    """
    _refuse_doubly_periodic(grid)
    refuse_special_surface(body, "stresses below the surface")
    if not (np.isfinite(depth) and depth >= 0):
        raise InputError(f"depth: {depth!r} must be finite and not negative [m]")
    if body.medium_at(depth) > 0:  # below the outermost layer nothing is split off
        whole: FloatArray = _layered(grid).stress_remainder(grid, body, float(depth), load)
        return whole
    nu = body.surface_material.poissons_ratio
    if grid.periodic == (False, False):
        table = subsurface.stress_table(grid.shape, grid.spacing, float(depth), nu, load)
    else:
        table = semi_periodic.stress_table(grid, float(depth), nu, load)
    if not body.homogeneous:
        table += _layered(grid).stress_remainder(grid, body, float(depth), load)
    return table


def _layered(grid: Grid) -> ModuleType:
    """Return the module with the remainder of layers on a grid; imported late, because it loads scipy.special."""
    if any(grid.periodic):
        from bem.kernels.layered import semi_periodic as images

        return images
    from bem.kernels.layered import cells

    return cells


def _refuse_doubly_periodic(grid: Grid) -> None:
    if grid.periodic == (True, True):
        raise InputError("grid: periodic along both axes; use the spectral responses, not influence coefficients")
