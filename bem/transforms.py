"""Real transforms of padded fields: pruned, in one or two precisions, the same bits in every process.

A two-dimensional real transform is two passes of one-dimensional ones. Along y the rows that are not known to be zero
are transformed (real to complex) and written transposed; along x the columns, now contiguous, are transformed in blocks
that stay in cache, where they are also multiplied and transformed back. On the way out only the wanted rows are made.

Layout of a spectrum: `spectrum[iy, ix]`, shape (py // 2 + 1, px), wavenumbers of `numpy.fft.rfft2(...).T`. The forward
transform has no factor, the inverse one 1/(px py): `inverse(forward(field)) == field`.

Plans are made without timing (FFTW_ESTIMATE), so a result does not depend on the mood of the machine; the transposed
layout with row lengths off the powers of two makes up for it (measured against FFTW_MEASURE in two dimensions, one
thread: equal to 10 % faster from 512 to 4096 cells a side). Blocks are split over threads, never inside a transform.
"""

from __future__ import annotations

import math
import threading
from collections import OrderedDict
from dataclasses import dataclass, field
from typing import Any, cast

import numpy as np
import scipy.fft
from numba import njit
from numpy.typing import DTypeLike, NDArray

from bem.errors import InputError
from bem.fftw import pyfftw
from bem.threads import get_threads, share

FloatArray = NDArray[Any]
ComplexArray = NDArray[Any]

_ALIGNMENT = 64
_BLOCK_BYTES = 1 << 18
_COMPLEX: dict[np.dtype[Any], np.dtype[Any]] = {
    np.dtype(np.float64): np.dtype(np.complex128),
    np.dtype(np.float32): np.dtype(np.complex64),
}


@dataclass
class TransformCount:
    """How much was transformed since the last reset: two-dimensional transforms, and one-dimensional ones in them."""

    forward: int = 0
    inverse: int = 0
    rows: int = 0
    columns: int = 0
    kernels: int = 0

    def reset(self) -> None:
        """Back to zero."""
        self.forward = self.inverse = self.rows = self.columns = self.kernels = 0


COUNT = TransformCount()
"""Counts of this process, for tests and reports."""


def padded_length(cells: int, periodic: bool) -> int:
    """Length of the transform along an axis: the axis itself if periodic, else an even fast length >= 2 cells - 1.

    A power of two serves where it is little longer, since plans made without timing are so much better for it: up to a
    tenth for 512, up to 3 % beyond. Measured, a convolution of 240 cells along x gains a seventh with 512 for 480, of
    500 or 1000 cells a tenth to a third; 1024 for 960 would lose.
    """
    if periodic or cells == 1:
        return cells
    fast = 2 * int(scipy.fft.next_fast_len(cells, real=True))
    power = 1 << (fast - 1).bit_length()
    return power if power >= 512 and power <= (1.1 if power == 512 else 1.03) * fast else fast


def kernel_spectrum(coefficients: FloatArray, padded: tuple[int, int], parity: tuple[int, int]) -> FloatArray:
    """Spectrum of a kernel that is even (+1) or odd (-1) along each axis, from its non-negative offsets only.

    Parameters
    ----------
    coefficients : (mx, my), value at offset (i, j); at -i it is parity_x times that, likewise along y. Offsets beyond
        half the padded length are ignored (a periodic axis repeats them), missing ones are zero.
    padded : (px, py), lengths of the transform.
    parity : (+-1, +-1).

    Returns
    -------
    (py // 2 + 1, px // 2 + 1), real, in double precision. The true spectrum is this times i for each odd axis (a factor
    -1 if both are), and at px - k it is parity_x times that at k.
    """
    result = np.ascontiguousarray(_half_spectrum(coefficients, padded[1], parity[1]).T)
    COUNT.kernels += 1
    return np.ascontiguousarray(_half_spectrum(result, padded[0], parity[0]))


def _half_spectrum(values: FloatArray, length: int, parity: int) -> FloatArray:
    """Real or imaginary part of the transform along the last axis of an even or odd sequence."""
    kept = length // 2 + 1
    half = np.zeros((values.shape[0], kept))
    given = min(kept, values.shape[1])
    half[:, :given] = values[:, :given]
    if length == 1:
        return half if parity == 1 else np.zeros_like(half)
    if length % 2 == 0:
        if parity == 1:
            return cast(FloatArray, scipy.fft.dct(half, type=1, axis=-1))
        result = np.zeros_like(half)
        if kept > 2:
            result[:, 1:-1] = -scipy.fft.dst(half[:, 1:-1], type=1, axis=-1)
        return result
    full = np.concatenate([half, parity * half[:, :0:-1]], axis=1)
    if parity == -1:
        full[:, 0] = 0
    spectrum = scipy.fft.rfft(full, axis=-1)
    return np.ascontiguousarray(spectrum.real if parity == 1 else spectrum.imag)


@dataclass(frozen=True)
class Multiplier:
    """A spectrum `real + i imaginary`, each part given on non-negative wavenumbers with its parity along x.

    `real`, `imaginary` : (py // 2 + 1, px // 2 + 1) or None for zero. At px - k the part is its parity times that at k.
    """

    real: FloatArray | None = None
    imaginary: FloatArray | None = None
    real_parity: int = 1
    imaginary_parity: int = -1

    @property
    def nbytes(self) -> int:
        """Memory of the arrays."""
        return sum(part.nbytes for part in (self.real, self.imaginary) if part is not None)

    def astype(self, dtype: DTypeLike) -> Multiplier:
        """The same in another precision."""
        real, imaginary = (
            None if part is None else part.astype(dtype, copy=False) for part in (self.real, self.imaginary)
        )
        return Multiplier(real, imaginary, self.real_parity, self.imaginary_parity)


def multiplier(parts: list[tuple[FloatArray, tuple[int, int], float]]) -> Multiplier:
    """Sum of kernels `(spectrum from kernel_spectrum, parity, factor)` as one multiplier.

    Raises
    ------
    InputError : two real or two imaginary parts of different parity along x.
    """
    real: FloatArray | None = None
    imaginary: FloatArray | None = None
    parities = [1, -1]
    for spectrum, (along_x, along_y), factor in parts:
        odd = (along_x == -1) + (along_y == -1)
        term = (-factor if odd == 2 else factor) * spectrum
        previous = imaginary if odd == 1 else real
        if previous is not None and parities[odd % 2] != along_x:
            raise InputError("multiplier: parts of different parity along x cannot share one quarter array")
        parities[odd % 2] = along_x
        total = term if previous is None else previous + term
        if odd == 1:
            imaginary = total
        else:
            real = total
    return Multiplier(real, imaginary, parities[0], parities[1])


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")  # type: ignore[untyped-decorator]
def _multiply_real(source, target, real, parity, scale, half):  # type: ignore[no-untyped-def]
    rows, length = source.shape
    for i in range(rows):
        for j in range(half):
            target[i, j] = source[i, j] * (real[i, j] * scale)
        if parity > 0:
            for j in range(half, length):
                target[i, j] = source[i, j] * (real[i, length - j] * scale)
        else:
            for j in range(half, length):
                target[i, j] = source[i, j] * (-real[i, length - j] * scale)


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")  # type: ignore[untyped-decorator]
def _multiply_imaginary(source, target, imaginary, parity, scale, half):  # type: ignore[no-untyped-def]
    rows, length = source.shape
    for i in range(rows):
        for j in range(half):
            a = imaginary[i, j] * scale
            z = source[i, j]
            target[i, j] = complex(-a * z.imag, a * z.real)
        for j in range(half, length):
            a = imaginary[i, length - j] * scale
            if parity < 0:
                a = -a
            z = source[i, j]
            target[i, j] = complex(-a * z.imag, a * z.real)


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")  # type: ignore[untyped-decorator]
def _multiply_complex(source, target, real, imaginary, parity_real, parity_imaginary, scale, half):  # type: ignore[no-untyped-def]
    rows, length = source.shape
    mirrored_real = scale if parity_real > 0 else -scale
    mirrored_imaginary = scale if parity_imaginary > 0 else -scale
    for i in range(rows):
        for j in range(half):
            a = real[i, j] * scale
            b = imaginary[i, j] * scale
            z = source[i, j]
            target[i, j] = complex(a * z.real - b * z.imag, a * z.imag + b * z.real)
        for j in range(half, length):
            a = real[i, length - j] * mirrored_real
            b = imaginary[i, length - j] * mirrored_imaginary
            z = source[i, j]
            target[i, j] = complex(a * z.real - b * z.imag, a * z.imag + b * z.real)


def _multiply(
    source: ComplexArray, target: ComplexArray, factor: Multiplier, scale: Any, start: int, stop: int
) -> None:
    half = source.shape[1] // 2 + 1
    real = None if factor.real is None else factor.real[start:stop]
    imaginary = None if factor.imaginary is None else factor.imaginary[start:stop]
    if real is None and imaginary is None:
        target[...] = 0
    elif imaginary is None:
        _multiply_real(source, target, real, factor.real_parity, scale, half)
    elif real is None:
        _multiply_imaginary(source, target, imaginary, factor.imaginary_parity, scale, half)
    else:
        _multiply_complex(source, target, real, imaginary, factor.real_parity, factor.imaginary_parity, scale, half)


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
        self.complex_dtype: np.dtype[Any] = _COMPLEX[self.dtype]
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
            self._share_columns(None, out, None)
            COUNT.forward += 1
        return out

    def inverse(
        self, spectrum: ComplexArray, factor: Multiplier | None = None, out: FloatArray | None = None
    ) -> FloatArray:
        """The first (nx, ny) of the field whose spectrum is `spectrum` times `factor`; `spectrum` is kept."""
        out = np.empty(self.shape, self.dtype) if out is None else out
        with self._lock:
            self._prepare()
            self._share_columns(spectrum, None, factor)
            self._rows_inverse(out)
            COUNT.inverse += 1
        return out

    def convolve(self, values: FloatArray, factor: Multiplier, out: FloatArray | None = None) -> FloatArray:
        """Forward, times `factor`, and back, without ever storing a whole padded spectrum. `out` may be `values`."""
        out = np.empty(self.shape, self.dtype) if out is None else out
        with self._lock:
            self._prepare()
            self._rows_forward(values)
            self._share_columns(None, None, factor)
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

    def _share_columns(self, source: ComplexArray | None, out: ComplexArray | None, factor: Multiplier | None) -> None:
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
                _multiply(given, scratch, factor, scale, start, stop)
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


_PLANNER = threading.Lock()


class _TransformCache:
    """Transforms by shape, least recently used dropped first when their buffers exceed a limit."""

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.kept: OrderedDict[tuple[Any, ...], PaddedTransform] = OrderedDict()
        self.lock = threading.Lock()

    def get(self, shape: tuple[int, int], padded: tuple[int, int], dtype: np.dtype[Any]) -> PaddedTransform:
        key = (shape, padded, dtype.char)
        with self.lock:
            transform = self.kept.get(key)
            if transform is None:
                transform = self.kept[key] = PaddedTransform(shape, padded, dtype)
            self.kept.move_to_end(key)
            self.trim()
            return transform

    def trim(self) -> None:
        while len(self.kept) > 1 and sum(t.nbytes for t in self.kept.values()) > self.limit:
            self.kept.popitem(last=False)


_CACHE = _TransformCache(1 << 29)


def transform_of(shape: tuple[int, int], padded: tuple[int, int], dtype: DTypeLike = np.float64) -> PaddedTransform:
    """The cached transform of fields of `shape` padded to `padded`, in float64 or float32.

    Raises
    ------
    InputError : a precision that is neither, or a padded length shorter than the field.
    """
    kind = np.dtype(dtype)
    if kind not in _COMPLEX:
        raise InputError(f"transform_of: dtype {kind} must be float64 or float32")
    if min(shape) < 1 or padded[0] < shape[0] or padded[1] < shape[1]:
        raise InputError(f"transform_of: padded lengths {padded!r} must not be below the field's shape {shape!r} >= 1")
    return _CACHE.get((int(shape[0]), int(shape[1])), (int(padded[0]), int(padded[1])), kind)


def set_transform_memory(limit: int) -> None:
    """Bound the memory that cached plans and buffers may hold between uses [bytes]; default 512 MiB."""
    if not (math.isfinite(limit) and limit >= 0):
        raise InputError(f"set_transform_memory: limit {limit!r} must be a number of bytes >= 0")
    with _CACHE.lock:
        _CACHE.limit = int(limit)
        _CACHE.trim()


def transform_memory() -> int:
    """Memory held by cached plans and buffers [bytes]."""
    return sum(t.nbytes for t in _CACHE.kept.values())
