"""The two passes of a padded transform: rows along y, then columns along x, in blocks that stay in cache."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np
from numba import njit
from numpy.typing import DTypeLike, NDArray

from bem.fftw import pyfftw
from bem.threads import get_threads, share
from bem.transforms.count import COUNT
from bem.transforms.products import Multiplier, multiply

FloatArray = NDArray[Any]
ComplexArray = NDArray[Any]

_ALIGNMENT = 64
_BLOCK_BYTES = 1 << 18
COMPLEX: dict[np.dtype[Any], np.dtype[Any]] = {
    np.dtype(np.float64): np.dtype(np.complex128),
    np.dtype(np.float32): np.dtype(np.complex64),
}
"""Precisions of fields, and those of their spectra."""

_PLANNER = threading.Lock()


def _stride(length: int, itemsize: int) -> int:
    """Row length in memory: whole cache lines, and not a multiple of 2 kB (rows would share cache sets)."""
    line = _ALIGNMENT // itemsize
    stride = -(-length // line) * line
    if stride * itemsize % 2048 == 0 and stride > line:
        stride += line
    return stride


def _block(rows: int, row_bytes: int, granule: int) -> int:
    """Rows in a block: about a quarter of a megabyte, in whole cache lines of the transposed array."""
    wanted = max(1, _BLOCK_BYTES // max(1, row_bytes))
    return min(rows, max(granule, wanted // granule * granule))


@dataclass
class _Worker:
    """Plans and scratch of one thread; FFTW objects hold pointers, so threads may not share them."""

    rows_in: FloatArray
    rows_out: FloatArray
    rows_spectrum: ComplexArray
    columns: ComplexArray
    columns_out: ComplexArray
    plans: dict[tuple[str, int], Any] = field(default_factory=dict)


class PaddedTransform:
    """Transforms of fields of one shape, padded with zeros to another, in one precision. Get it from `transform_of`."""

    def __init__(self, shape: tuple[int, int], padded: tuple[int, int], dtype: DTypeLike = np.float64) -> None:
        self.shape = shape
        self.padded = padded
        self.dtype: np.dtype[Any] = np.dtype(dtype)
        self.complex_dtype: np.dtype[Any] = COMPLEX[self.dtype]
        self.spectrum_shape = (padded[1] // 2 + 1, padded[0])
        self._half_stride = _stride(shape[0], self.complex_dtype.itemsize)
        self._spectrum_stride = _stride(padded[0], self.complex_dtype.itemsize)
        self._real_stride = -(-padded[1] * self.dtype.itemsize // _ALIGNMENT) * (_ALIGNMENT // self.dtype.itemsize)
        self._half = pyfftw.empty_aligned(
            (self.spectrum_shape[0], self._half_stride), self.complex_dtype, n=_ALIGNMENT
        )[:, : shape[0]]
        line = _ALIGNMENT // self.complex_dtype.itemsize
        self._row_block = _block(shape[0], self._real_stride * self.dtype.itemsize, line)
        self._column_block = _block(self.spectrum_shape[0], self._spectrum_stride * self.complex_dtype.itemsize, 1)
        self._row_blocks = -(-shape[0] // self._row_block)
        self._column_blocks = -(-self.spectrum_shape[0] // self._column_block)
        # in single precision FFTW's own scattered writes are slower than a transposition in whole cache lines
        self._transposes = self.dtype == np.float32
        self._workers: list[_Worker] = []
        self._lock = threading.RLock()
        self._scale = np.full((), 1.0 / (padded[0] * padded[1]), self.dtype)[()]

    @property
    def nbytes(self) -> int:
        """Memory of buffers."""
        scratch = sum(
            w.rows_in.nbytes + w.rows_out.nbytes + w.rows_spectrum.nbytes + 2 * w.columns.nbytes for w in self._workers
        )
        return self.spectrum_shape[0] * self._half_stride * self.complex_dtype.itemsize + scratch

    def empty_spectrum(self) -> ComplexArray:
        """An uninitialised array for a spectrum, aligned and strided so that no copy is needed."""
        full = pyfftw.empty_aligned((self.spectrum_shape[0], self._spectrum_stride), self.complex_dtype, n=_ALIGNMENT)
        return cast(ComplexArray, full[:, : self.padded[0]])

    def zeros_field(self) -> FloatArray:
        """A contiguous field of zeros, aligned so that rows of whole cache lines need no copy."""
        return cast(FloatArray, pyfftw.zeros_aligned(self.shape, self.dtype, n=_ALIGNMENT))

    def empty_field(self) -> FloatArray:
        """The same with values that mean nothing, for results."""
        return cast(FloatArray, pyfftw.empty_aligned(self.shape, self.dtype, n=_ALIGNMENT))

    def forward(self, values: FloatArray, out: ComplexArray | None = None) -> ComplexArray:
        """Spectrum (py // 2 + 1, px) of a field (nx, ny) padded with zeros."""
        out = self.empty_spectrum() if out is None else out
        with self._lock:
            self._prepare()
            self._rows_forward(values)
            self._columns_pass(None, out, None)
            COUNT.forward += 1
        return out

    def inverse(
        self, spectrum: ComplexArray, factor: Multiplier | None = None, out: FloatArray | None = None
    ) -> FloatArray:
        """The first (nx, ny) of the field whose spectrum is `spectrum` times `factor`; `spectrum` is kept."""
        out = np.empty(self.shape, self.dtype) if out is None else out
        with self._lock:
            self._prepare()
            self._columns_pass(spectrum, None, factor)
            self._rows_inverse(out)
            COUNT.inverse += 1
        return out

    def convolve(self, values: FloatArray, factor: Multiplier, out: FloatArray | None = None) -> FloatArray:
        """Forward, times `factor`, and back, without ever storing a whole padded spectrum. `out` may be `values`."""
        out = np.empty(self.shape, self.dtype) if out is None else out
        with self._lock:
            self._prepare()
            self._rows_forward(values)
            self._columns_pass(None, None, factor)
            self._rows_inverse(out)
            COUNT.forward += 1
            COUNT.inverse += 1
        return out

    def _prepare(self) -> None:
        while len(self._workers) < get_threads():
            rows = (self._row_block, self._real_stride)
            spectra = (self._row_block, _stride(self.spectrum_shape[0], self.complex_dtype.itemsize))
            columns = (self._column_block, self._spectrum_stride)
            self._workers.append(
                _Worker(
                    pyfftw.zeros_aligned(rows, self.dtype, n=_ALIGNMENT)[:, : self.padded[1]],
                    pyfftw.zeros_aligned(rows, self.dtype, n=_ALIGNMENT)[:, : self.padded[1]],
                    pyfftw.zeros_aligned(spectra, self.complex_dtype, n=_ALIGNMENT)[:, : self.spectrum_shape[0]],
                    pyfftw.zeros_aligned(columns, self.complex_dtype, n=_ALIGNMENT)[:, : self.padded[0]],
                    pyfftw.zeros_aligned(columns, self.complex_dtype, n=_ALIGNMENT)[:, : self.padded[0]],
                )
            )

    def _plan(self, worker: _Worker, kind: str, rows: int) -> Any:
        plan = worker.plans.get((kind, rows))
        if plan is None:
            half = self._half[:, :rows].T
            if kind == "rows forward":
                target = worker.rows_spectrum[:rows] if self._transposes else half
                arguments = (worker.rows_in[:rows], target, "FFTW_FORWARD")
            elif kind == "rows backward":
                arguments = (half, worker.rows_out[:rows], "FFTW_BACKWARD")
            else:
                # from one array into another: plans made without timing are a quarter faster so than in place
                direction = "FFTW_FORWARD" if kind == "columns forward" else "FFTW_BACKWARD"
                arguments = (worker.columns[:rows], worker.columns_out[:rows], direction)
            flags = ("FFTW_ESTIMATE",) if kind == "rows forward" else ("FFTW_ESTIMATE", "FFTW_DESTROY_INPUT")
            with _PLANNER:
                plan = pyfftw.FFTW(
                    arguments[0], arguments[1], axes=(1,), direction=arguments[2], flags=flags, threads=1
                )
            worker.plans[kind, rows] = plan
        return plan

    def _rows_forward(self, values: FloatArray) -> None:
        width = self.shape[1]
        direct = self._fits(values)

        def work(number: int, block: int) -> None:
            worker = self._workers[number]
            start = block * self._row_block
            stop = min(self.shape[0], start + self._row_block)
            plan = self._plan(worker, "rows forward", stop - start)
            if direct:
                source = values[start:stop]
            else:
                source = worker.rows_in[: stop - start]
                source[:, :width] = values[start:stop]
            if self._transposes:
                spectra = worker.rows_spectrum[: stop - start]
                plan.update_arrays(source, spectra)
                plan.execute()
                _transpose(spectra, self._half, start)
            else:
                plan.update_arrays(source, self._half[:, start:stop].T)
                plan.execute()

        share(work, self._row_blocks)
        COUNT.rows += self.shape[0]

    def _rows_inverse(self, out: FloatArray) -> None:
        width = self.shape[1]
        direct = self._fits(out)

        def work(number: int, block: int) -> None:
            worker = self._workers[number]
            start = block * self._row_block
            stop = min(self.shape[0], start + self._row_block)
            plan = self._plan(worker, "rows backward", stop - start)
            target = out[start:stop] if direct else worker.rows_out[: stop - start]
            plan.update_arrays(self._half[:, start:stop].T, target)
            plan.execute()
            if not direct:
                out[start:stop] = target[:, :width]

        share(work, self._row_blocks)
        COUNT.rows += self.shape[0]

    def _fits(self, values: FloatArray) -> bool:
        """Whether the plan for scratch rows can run on these rows in place."""
        return (
            self.padded[1] == self.shape[1]
            and values.dtype == self.dtype
            and values.strides == (self._real_stride * self.dtype.itemsize, self.dtype.itemsize)
            and pyfftw.is_byte_aligned(values, n=_ALIGNMENT)
        )

    def _columns_pass(self, source: ComplexArray | None, out: ComplexArray | None, factor: Multiplier | None) -> None:
        """Along x, block by block: forward unless `source` is given, times `factor`, back unless `out` is given."""
        if factor is not None:
            factor = factor.astype(self.dtype)

        def work(number: int, block: int) -> None:
            worker = self._workers[number]
            start = block * self._column_block
            stop = min(self.spectrum_shape[0], start + self._column_block)
            rows = stop - start
            half = self._half[start:stop]
            scratch, result = worker.columns[:rows], worker.columns_out[:rows]
            if source is None:
                _pad(half, scratch)
                self._plan(worker, "columns forward", rows).execute()
                if out is not None:
                    out[start:stop] = result
                    return
            given = result if source is None else source[start:stop]
            scale = self._scale
            if factor is not None:
                multiply(given, scratch, factor, scale, start, stop)
            else:
                np.multiply(given, scale, out=scratch)
            self._plan(worker, "columns backward", rows).execute()
            _crop(result, half)

        share(work, self._column_blocks)
        COUNT.columns += self.spectrum_shape[0] * (1 if out is not None or source is not None else 2)


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _transpose(spectra, half, start):  # type: ignore[no-untyped-def]
    rows, length = spectra.shape
    for block in range(0, length, 8):
        for j in range(block, min(length, block + 8)):
            for i in range(rows):
                half[j, start + i] = spectra[i, j]


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _pad(half, scratch):  # type: ignore[no-untyped-def]
    rows, width = half.shape
    for i in range(rows):
        for j in range(width):
            scratch[i, j] = half[i, j]
        for j in range(width, scratch.shape[1]):
            scratch[i, j] = 0


@njit(cache=True, nogil=True)  # type: ignore[untyped-decorator]
def _crop(result, half):  # type: ignore[no-untyped-def]
    rows, width = half.shape
    for i in range(rows):
        for j in range(width):
            half[i, j] = result[i, j]
