"""Displacement of the own rows under a pressure of which every rank has its rows.

Rows are transformed forward along y and transposed among ranks, columns go forward along x, through the spectrum and
back, and are transposed back; rows are transformed back. Cost: two all-to-all exchanges of nx (py // 2 + 1) complex
numbers in all. Fields are padded along free axes as in `bem.transforms`. Search directions and the preconditioner go in
single precision, at half the time and half the exchange.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.fft
from numpy.typing import NDArray

from bem.distributed.ranks import Ranks, edges
from bem.distributed.spectra import ColumnSpectra, column_spectra
from bem.distributed.transpose import blocks_of_columns, to_columns, to_rows
from bem.grid import Grid
from bem.materials import Body
from bem.transforms import padded_shape

FloatArray = NDArray[np.float64]

_BLOCK = 1 << 15
"""Numbers of a block of padded rows or columns: half a MiB, which stays in the cache of a core."""


@dataclass
class ConvolutionCount:
    """Number of convolutions so far, preconditioning included."""

    number: int = 0


@dataclass(frozen=True)
class SlabConvolution:
    """Convolutions of the own rows (own rows, ny) of fields (nx, ny); all methods are collective.

    grid, ranks, spectra : see `slab_convolution`. count : convolutions so far.
    """

    grid: Grid
    ranks: Ranks
    spectra: ColumnSpectra
    count: ConvolutionCount = field(default_factory=ConvolutionCount, compare=False)

    def displacement(self, pressure: FloatArray) -> FloatArray:
        """Return the displacement [m] under a pressure [Pa], in double precision."""
        return self._filtered(pressure, self.spectra.response)

    def response(self, direction: FloatArray) -> FloatArray:
        """Return the displacement [m] under a search direction [Pa], computed in single precision."""
        return self._filtered(direction.astype(np.float32), self.spectra.response).astype(np.float64)

    def precondition(self, residual: FloatArray) -> FloatArray:
        """Return an approximate pressure [Pa] for a displacement [m], computed in single precision."""
        return self._filtered(residual.astype(np.float32), self.spectra.stiffness).astype(np.float64)

    def _filtered(self, rows: NDArray[Any], spectrum: NDArray[Any]) -> NDArray[Any]:
        """Return own rows of a field after its spectrum on own columns is multiplied by another."""
        self.count.number += 1
        nx, ny = self.grid.shape
        px, py = padded_shape(self.grid.shape, self.grid.periodic)
        shape = (nx, py // 2 + 1)
        columns = to_columns(self._rows_forward(rows, py), shape, self.ranks)
        _multiply(columns, spectrum, px)
        return self._rows_back(to_rows(columns, shape, self.ranks), py, np.empty((len(rows), ny), rows.dtype))

    def _rows_forward(self, rows: NDArray[Any], length: int) -> NDArray[Any]:
        """Return the transforms of own rows along y, as `blocks_of_columns`."""
        width = length // 2 + 1
        bounds = edges(width, self.ranks.size)
        buffer = np.empty(len(rows) * width, np.result_type(rows.dtype, np.complex64))
        blocks = blocks_of_columns(buffer, len(rows), bounds)
        for part in _parts(len(rows), length):
            waves = scipy.fft.rfft(rows[part], n=length, axis=1)
            for block, first, last in zip(blocks, bounds, bounds[1:], strict=False):
                block[part] = waves[:, first:last]
        return buffer

    def _rows_back(self, buffer: NDArray[Any], length: int, out: NDArray[Any]) -> NDArray[Any]:
        """Write the inverse transforms of `blocks_of_columns` along y to `out` (own rows, ny)."""
        blocks = blocks_of_columns(buffer, len(out), edges(length // 2 + 1, self.ranks.size))
        for part in _parts(len(out), length):
            waves = np.concatenate([block[part] for block in blocks], axis=1)
            out[part] = scipy.fft.irfft(waves, n=length, axis=1)[:, : out.shape[1]]
        return out


def _parts(count: int, length: int) -> list[slice]:
    """Return ranges of rows or columns of a length, each of about `_BLOCK` entries."""
    block = max(1, _BLOCK // length)
    return [slice(first, min(first + block, count)) for first in range(0, count, block)]


def _multiply(columns: NDArray[Any], spectrum: NDArray[Any], length: int) -> None:
    """Convolve columns (nx, own columns) with an even spectrum (length // 2 + 1, own columns), in place."""
    nx, own = columns.shape
    half = length // 2 + 1
    for part in _parts(own, length):
        waves = scipy.fft.fft(columns[:, part], n=length, axis=0)
        factor = spectrum[:, part].astype(waves.real.dtype, copy=False)
        waves[:half] *= factor
        waves[half:] *= factor[(length - 1) // 2 : 0 : -1]
        columns[:, part] = scipy.fft.ifft(waves, axis=0, overwrite_x=True)[:nx]


def slab_convolution(grid: Grid, bodies: tuple[Body, ...], ranks: Ranks) -> SlabConvolution:
    """Compute the spectra of own columns and return the convolution; collective."""
    return SlabConvolution(grid, ranks, column_spectra(grid, bodies, ranks))
