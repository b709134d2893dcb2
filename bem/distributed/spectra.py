"""Spectra of the displacement operator and of its preconditioner, on the columns that one rank owns.

A column is a wavenumber along y. Doubly periodic grids have the response to harmonic pressures, computed for the own
columns alone. Other grids have influence coefficients (`bem.kernels.coefficients`): every rank computes those of its
own rows for bare half-spaces; of layers, crystals, surfaces under tension and one periodic axis rank 0 computes the
table and sends rows. A transform along y, one transposition and a transform along x follow, as in
`bem.transforms.kernel_spectra`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.convolution import pressure_terms
from bem.distributed.ranks import Ranks, computed_on_first, edges, own_slice
from bem.distributed.transpose import blocks_of_columns, to_columns
from bem.grid import Grid
from bem.kernels import half_space
from bem.kernels.coefficients import Load, surface_coefficients
from bem.kernels.spectral import pressure_response
from bem.materials import Body
from bem.transforms import half_spectrum, padded_shape

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class ColumnSpectra:
    """Spectra at non-negative wavenumbers along x, on own columns: each (px // 2 + 1, own columns).

    response : displacement over pressure [m/Pa]. stiffness : pressure over displacement [Pa/m], of waves on the padded
    grid: the preconditioner. largest : the largest response of all columns [m/Pa]. mean_compliance : response to the
    mean pressure that is included on doubly periodic grids, where the bodies have none [m/Pa]; else zero.
    """

    response: FloatArray
    stiffness: NDArray[np.float32]
    largest: float
    mean_compliance: float


def responds_evenly(body: Body) -> bool:
    """Return True if the displacement under pressure is even along both axes: all but tilted crystals."""
    stiffness = body.material.stiffness
    return stiffness is None or stiffness.mirror_symmetric


def column_spectra(grid: Grid, bodies: tuple[Body, ...], ranks: Ranks) -> ColumnSpectra:
    """Compute the spectra of own columns; collective."""
    padded = padded_shape(grid.shape, grid.periodic)
    columns = own_slice(padded[1] // 2 + 1, ranks)
    stiffness, mean_compliance = _stiffness(grid, bodies, padded, columns)
    if all(grid.periodic):
        response = 1 / stiffness
    else:
        response, mean_compliance = _coefficients(grid, bodies, padded, ranks), 0.0
    own_largest = float(np.abs(response).max(initial=0.0))
    largest = float(ranks.allgather_rows(np.full((1, 1), own_largest), ranks.size).max())
    return ColumnSpectra(response, stiffness.astype(np.float32), largest, mean_compliance)


def _waves(grid: Grid, bodies: tuple[Body, ...], columns: slice) -> FloatArray:
    """Return the response to harmonic pressures: (nx // 2 + 1, columns)."""
    terms = pressure_terms(bodies)
    return np.asarray(sum(factor * pressure_response(grid, body, columns) for body, factor in terms))


def _stiffness(
    grid: Grid, bodies: tuple[Body, ...], padded: tuple[int, int], columns: slice
) -> tuple[FloatArray, float]:
    """Return the inverse of the response to harmonic pressures on the padded grid, and the response given to the mean.

    The mean, which has no response, gets twice that of the longest wave.
    """
    whole = Grid(padded, grid.spacing, periodic=(True, True))
    response = _waves(whole, bodies, columns)
    longest = _waves(whole, bodies, slice(0, min(2, padded[1] // 2 + 1)))[:2]
    mean = 2 * float(longest.max()) or 1.0
    if columns.start == 0 and columns.stop > 0:
        response[0, 0] = mean
    return 1 / response, mean


def _coefficients(grid: Grid, bodies: tuple[Body, ...], padded: tuple[int, int], ranks: Ranks) -> FloatArray:
    """Return the spectrum of the influence coefficients: (px // 2 + 1, own columns)."""
    nx, ny = grid.shape
    rows = own_slice(nx, ranks)
    table = np.zeros((rows.stop - rows.start, ny))
    for body, factor in pressure_terms(bodies):
        if body.boussinesq and body.homogeneous and not any(grid.periodic):
            # the response to pressure is the same with the axes exchanged
            shape, spacing = (ny, rows.stop - rows.start), grid.spacing[::-1]
            own = half_space.surface_table(shape, spacing, body.material, Load.NORMAL, first=rows.start).T
        else:
            own = np.empty(table.shape)
            ranks.scatter_rows(_table_on_first(grid, body, ranks), own)
        table += factor * own
    along_y = half_spectrum(table, padded[1], 1)
    width = padded[1] // 2 + 1
    buffer, bounds = np.empty(along_y.size), edges(width, ranks.size)
    for block, first, last in zip(blocks_of_columns(buffer, len(along_y), bounds), bounds, bounds[1:], strict=False):
        block[:] = along_y[:, first:last]
    by_columns = to_columns(buffer, (nx, width), ranks)
    return np.ascontiguousarray(half_spectrum(np.ascontiguousarray(by_columns.T), padded[0], 1).T)


def _table_on_first(grid: Grid, body: Body, ranks: Ranks) -> FloatArray | None:
    """Return the coefficients (nx, ny) on rank 0, None on the others; a failure on rank 0 is raised on all."""
    tables: list[FloatArray] = []
    computed_on_first(ranks, lambda: tables.append(surface_coefficients(grid, body, Load.NORMAL)))
    return tables[0] if tables else None
