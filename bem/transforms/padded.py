"""Padded real transforms and convolutions: a pass of rows along y and a pass of columns along x, in cached blocks."""

from __future__ import annotations

import math
import weakref
from bisect import bisect_left
from collections.abc import Sequence
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from bem.threads import ForkSafeLock, share, threads_for
from bem.transforms import loops
from bem.transforms.count import COUNT
from bem.transforms.loops import GROUP, Factor, Scratch, Singles, Squares, TransformPlan
from bem.transforms.plans import ALIGNMENT, aligned_empty, aligned_zeros, library
from bem.transforms.products import Multiplier, unit_factor

FloatArray = NDArray[Any]
ComplexArray = NDArray[Any]

_BLOCK_BYTES = 1 << 18
_PIECES = 2
"""Pieces of a pass per thread, so that a thread that begins late does less."""
_COUNTING = ForkSafeLock()
COMPLEX: dict[np.dtype[Any], np.dtype[Any]] = {
    np.dtype(np.float64): np.dtype(np.complex128),
    np.dtype(np.float32): np.dtype(np.complex64),
}
"""Precisions of fields, and those of their spectra."""


def _stride(length: int, itemsize: int) -> int:
    """Return the row length in memory: whole cache lines, not a multiple of 2 kB (rows would share cache sets)."""
    line = ALIGNMENT // itemsize
    stride = -(-length // line) * line
    if stride * itemsize % 2048 == 0 and stride > line:
        stride += line
    return stride


def _block(rows: int, row_bytes: int, granule: int) -> int:
    """Return the rows in a block: about a quarter of a megabyte, in whole cache lines of the transposed array."""
    wanted = max(1, _BLOCK_BYTES // max(1, row_bytes))
    return min(rows, max(granule, wanted // granule * granule))


def _blocks_of_columns(lengths: Sequence[int], largest: int) -> NDArray[np.int64]:
    """Return the edges of blocks of columns: at most `largest` columns each, all of one length."""
    edges = [0]
    for end in [*(k for k in range(1, len(lengths)) if lengths[k] != lengths[k - 1]), len(lengths)]:
        edges += [*range(edges[-1] + largest, end, largest), end]
    return np.array(edges, np.int64)


class PaddedTransform:
    """Transforms of fields of one shape, padded with zeros to another, in one precision. Get it from `transform_of`.

    beside : the double-precision transform whose `single` this is; both share one buffer.
    lengths : of the transforms along x, for each wavenumber along y, where not all are padded alike (`narrow`). Of a
        spectrum's row (px,) only the first so many numbers mean something then, and of a multiplier's half of them.
    """

    def __init__(
        self,
        shape: tuple[int, int],
        padded: tuple[int, int],
        dtype: DTypeLike = np.float64,
        lengths: tuple[int, ...] | None = None,
        beside: PaddedTransform | None = None,
    ) -> None:
        self.shape = shape
        self.padded = padded
        self.entries = padded[0] * padded[1]
        self.dtype: np.dtype[Any] = np.dtype(dtype)
        self.complex_dtype: np.dtype[Any] = COMPLEX[self.dtype]
        self.spectrum_shape = (padded[1] // 2 + 1, padded[0])
        self._half_stride = _stride(shape[0], self.complex_dtype.itemsize)
        self._spectrum_stride = _stride(padded[0], self.complex_dtype.itemsize)
        self._real_stride = -(-padded[1] * self.dtype.itemsize // ALIGNMENT) * (ALIGNMENT // self.dtype.itemsize)
        line = ALIGNMENT // self.complex_dtype.itemsize
        self._row_block = _block(shape[0], self._real_stride * self.dtype.itemsize, line)
        self._column_block = _block(self.spectrum_shape[0], self._spectrum_stride * self.complex_dtype.itemsize, 1)
        self._row_blocks = -(-shape[0] // self._row_block)
        given = (padded[0],) * self.spectrum_shape[0] if lengths is None else lengths
        columns = _blocks_of_columns(given, self._column_block)
        self._column_blocks = len(columns) - 1
        self._ends: list[int] = columns.tolist()
        """Columns in the first so many blocks, none first; and below how many numbers they are together."""
        self._numbers = [0, *np.cumsum(np.diff(columns) * [given[start] for start in columns[:-1]]).tolist()]
        self.lock: ForkSafeLock = ForkSafeLock() if beside is None else beside.lock
        self._unit = unit_factor(self.dtype)
        self._scratch: list[Scratch] = []
        self._prepared = 0
        half = self._half_way(beside)
        block_lengths = np.array([given[start] for start in columns[:-1]], np.int64)
        self.nbytes = int(half.nbytes) if beside is None else 0
        """Memory of buffers, those of `single` included."""
        self._beside, self.lengths = beside, lengths
        self.plan = TransformPlan(
            nx=shape[0],
            ny=shape[1],
            row_block=self._row_block,
            spectra=self.spectrum_shape[0],
            aligned_rows=padded[1] == shape[1] == self._real_stride,
            unpadded_columns=padded[0] == shape[0],
            executors=library(self.dtype).executors(),
            row_plans=np.zeros((2, 2), np.int64),
            columns=columns,
            column_plans=np.zeros((2, self._column_blocks), np.int64),
            lengths=block_lengths,
            scales=(1.0 / (block_lengths * padded[1])).astype(self.dtype),
            row_spectra=half,
            twiddles=np.empty((2, 0), self.dtype),
        )
        self._packed_plan = self._plan_of_packed_rows() if lengths is None and padded[1] % 2 == 0 else None

    @cached_property
    def single(self) -> PaddedTransform:
        """The transform in single precision; it shares this transform's buffer."""
        return PaddedTransform(self.shape, self.padded, np.float32, self.lengths, self)

    def _half_way(self, beside: PaddedTransform | None) -> ComplexArray:
        """Return the array of row spectra: a new one, or the memory of the double-precision transform's."""
        shape = (self.spectrum_shape[0], self._half_stride)
        if beside is None:
            return aligned_empty(shape, self.complex_dtype)
        return beside.plan.row_spectra.reshape(-1).view(self.complex_dtype)[: shape[0] * shape[1]].reshape(shape)

    def _plan_of_packed_rows(self) -> TransformPlan:
        """Return the plan for even kernels: rows are complex of half the length, columns go in pairs."""
        waves = self.padded[1] // 2
        number, most = waves // 2 + 1, max(1, self._column_block // 2)
        columns = np.array([*range(0, number, most), number], np.int64)
        angles = math.pi / waves * np.arange(number)
        twiddles = np.array([np.sin(angles), np.cos(angles)])
        blocks, complex_to_complex = len(columns) - 1, self.plan.executors[1]
        return self.plan._replace(
            spectra=waves,
            executors=np.array([complex_to_complex] * 3),
            row_plans=np.zeros((2, 2), np.int64),
            columns=columns,
            column_plans=np.zeros((2, 1), np.int64),
            lengths=np.full(blocks, self.padded[0], np.int64),
            scales=np.full(blocks, self.plan.scales[0]),
            twiddles=twiddles.astype(self.dtype),
        )

    def plan_for(self, factor: Factor) -> TransformPlan:
        """Return the plan that `loops.convolve` and `loops.convolve_cells` take, by the parity of the multiplier."""
        even = factor.real_parity == 1 and factor.imaginary_parity == 0
        return self.plan if self._packed_plan is None or not even else self._packed_plan

    def empty_spectrum(self) -> ComplexArray:
        """Return an uninitialised spectrum, aligned and strided so that no copy is needed."""
        full = aligned_empty((self.spectrum_shape[0], self._spectrum_stride), self.complex_dtype)
        return full[:, : self.padded[0]]

    def zeros_field(self) -> FloatArray:
        """Return a contiguous field of zeros, aligned so that rows of whole cache lines need no copy."""
        return aligned_zeros(self.shape, self.dtype)

    def empty_field(self) -> FloatArray:
        """Return an uninitialised field, aligned like `zeros_field`."""
        return aligned_empty(self.shape, self.dtype)

    def forward(self, values: FloatArray, out: ComplexArray | None = None) -> ComplexArray:
        """Return the spectrum (py // 2 + 1, px) of a field (nx, ny) padded with zeros."""
        out = self.empty_spectrum() if out is None else out
        with self.lock:
            self.ready(threads_for(self.entries))
            self._each(loops.rows_forward, self._row_blocks, self._plain(values))
            self._each(loops.columns_out, self._column_blocks, out)
        self._count(forward=1, blocks=self._column_blocks)
        return out

    def inverse(
        self,
        spectrum: ComplexArray,
        factor: Multiplier | None = None,
        out: FloatArray | None = None,
        *,
        columns: int | None = None,
    ) -> FloatArray:
        """Return the first (nx, ny) of the field whose spectrum is `spectrum` times `factor`; `spectrum` is kept.

        columns : how many wavenumbers along y count, from zero on; the others' columns are left out, by whole blocks.
        """
        out = np.empty(self.shape, self.dtype) if out is None else out
        plain = out if self._is_plain(out) else np.empty(self.shape, self.dtype)
        parts = self._unit if factor is None else factor.factor(self.dtype)
        with self.lock:
            self.ready(threads_for(self.entries))
            wanted = self.spectrum_shape[0] if columns is None else columns
            blocks = bisect_left(self._ends, wanted)
            self._each(loops.columns_in, blocks, parts, spectrum)
            self.plan.row_spectra[self._ends[blocks] :] = 0
            self._each(loops.rows_back, self._row_blocks, plain)
        self._count(inverse=1, blocks=blocks)
        if plain is not out:
            out[...] = plain
        return out

    def inverse_squared(
        self,
        spectrum: ComplexArray,
        factor: Multiplier,
        out: FloatArray,
        *,
        weight: float,
        stage: int,
        columns: int | None,
    ) -> None:
        """The square of what `inverse` gives, times a weight: `stage` says whether it begins the sum in `out`, goes on
        with it, or ends it with its root (`loops.BEGINS`, `GOES_ON`, `ENDS`). The field itself is nowhere stored."""
        parts, threads = factor.factor(self.dtype), threads_for(self.entries)
        with self.lock:
            scratch = self.ready(threads)
            blocks = bisect_left(self._ends, self.spectrum_shape[0] if columns is None else columns)
            if threads == 1:
                loops.inverse_squared(self.plan, scratch, parts, spectrum, blocks, weight, stage, out)
            else:
                self._each(loops.columns_in, blocks, parts, spectrum)
                self.plan.row_spectra[self._ends[blocks] :] = 0
                self._each(loops.rows_back_squared, self._row_blocks, weight, stage, out)
        self._count(inverse=1, blocks=blocks)

    def empty_squares(self, weights: FloatArray) -> Squares:
        """TransformPlan for the root of a sum of squares of so many fields, of which no group is begun."""
        shape = (len(weights), self.spectrum_shape[0], self._half_stride)
        halves = aligned_empty(shape, self.complex_dtype)
        rows = aligned_empty((GROUP, self._real_stride), self.dtype)
        columns, begun = np.zeros(len(weights), np.int64), np.zeros(-(-self.shape[0] // GROUP), np.bool_)
        return Squares(halves, columns, weights, rows, begun)

    def terms_back(
        self,
        spectrum: ComplexArray,
        factors: tuple[Factor, ...],
        squares: Squares,
        terms: tuple[int, int],
        out: FloatArray,
    ) -> None:
        """The first of the two passes of `inverse` for the terms (first, last) of a sum of squares, one factor each;
        the second one in the groups that are begun. `loops.term_of_group` does it in the others."""
        threads, singles = threads_for(self.entries), self.singles
        own = (factors, spectrum, squares, terms)
        with self.lock:
            self.ready(threads)

            def work(number: int, block: int) -> None:
                loops.terms_back(self.plan, singles, self._scratch[number], *own, (block, threads), out)

            if threads == 1:
                work(0, 0)
            else:
                share(work, threads, self.entries)
        for count in squares.columns[slice(*terms)].tolist():
            COUNT.inverse += 1
            COUNT.columns += count
            COUNT.numbers += int(singles.numbers[count])

    @cached_property
    def singles(self) -> Singles:
        """Plans for the way back in small portions, made when they are first asked for."""
        with self.lock:
            scratch, fftw = self.ready(1), library(self.dtype)
            each = np.diff(self.plan.columns)
            lengths, stride = np.repeat(self.plan.lengths, each), self._spectrum_stride
            data = (scratch.columns.ctypes.data, scratch.columns_out.ctypes.data)
            made = {
                length: fftw.complex(length, 1, (1, 1, stride, stride), data, back=True)
                for length in set(lengths.tolist())
            }
            across = (self._half_stride, 1, 1, self._real_stride)
            data = (self.plan.row_spectra.ctypes.data, self.empty_squares(np.ones(1)).rows.ctypes.data)
            rows = [
                fftw.complex_to_real(self.padded[1], count, across, data)
                for count in (min(GROUP, self.shape[0]), self.shape[0] % GROUP or GROUP)
            ]
            weakref.finalize(self, fftw.destroy, [*made.values(), *rows])
            plans = np.array([made[length] for length in lengths.tolist()], np.int64)
            scales, numbers = np.repeat(self.plan.scales, each), np.append(0, np.cumsum(lengths))
            return Singles(plans, lengths, scales, numbers, np.array(rows, np.int64))

    def convolve(self, values: FloatArray, factor: Multiplier, out: FloatArray | None = None) -> FloatArray:
        """Convolve a field without storing a whole padded spectrum; `out` may be `values`."""
        out = np.empty(self.shape, self.dtype) if out is None else out
        values = self._plain(values)
        plain = out if self._is_plain(out) else np.empty(self.shape, self.dtype)
        parts = factor.factor(self.dtype)
        threads, plan = threads_for(self.entries), self.plan_for(parts)
        with self.lock:
            scratch = self.ready(threads)
            if threads == 1:
                loops.convolve(plan, scratch, parts, values, plain)
            else:
                self._each(loops.rows_forward, self._row_blocks, values, plan=plan)
                self._each(loops.columns_through, plan.lengths.size, parts, plan=plan)
                self._each(loops.rows_back, self._row_blocks, plain, plan=plan)
        self.counted(1)
        if plain is not out:
            out[...] = plain
        return out

    def convolve_cells(
        self, cells: NDArray[np.int64], values: FloatArray, factor: Multiplier, out: FloatArray
    ) -> FloatArray:
        """Convolve a field with these values on some cells (flat indices, ascending) and zero elsewhere.

        `out` is a contiguous field of this precision.
        """
        parts, threads = factor.factor(self.dtype), threads_for(self.entries)
        plan = self.plan_for(parts)
        with self.lock:
            scratch = self.ready(threads)
            if threads == 1:
                loops.convolve_cells(plan, scratch, parts, cells, values, out)
            else:
                self._each(loops.rows_forward_of_cells, self._row_blocks, cells, values, plan=plan)
                self._each(loops.columns_through, plan.lengths.size, parts, plan=plan)
                self._each(loops.rows_back, self._row_blocks, out, plan=plan)
        self.counted(1)
        return out

    def counted(self, convolutions: int) -> None:
        """Add convolutions to this process's count: here, or by a compiled loop that called `loops.convolve`."""
        self._count(forward=convolutions, inverse=convolutions, blocks=self._column_blocks)

    def ready(self, threads: int) -> Scratch:
        """Prepare plans, and scratch for every thread; return the first thread's. The caller holds `lock`."""
        if self._prepared < threads:
            self._prepare(threads)
        return self._scratch[0]

    def _prepare(self, threads: int) -> None:
        while len(self._scratch) < threads:
            rows = (self._row_block, self._real_stride)
            spectra = (self._row_block, _stride(self.spectrum_shape[0], self.complex_dtype.itemsize))
            columns = (max(2, self._column_block), self._spectrum_stride)  # a pair at least
            scratch = Scratch(
                aligned_zeros(rows, self.dtype),
                aligned_zeros(rows, self.dtype),
                aligned_zeros(spectra, self.complex_dtype),
                aligned_zeros(columns, self.complex_dtype),
                aligned_zeros(columns, self.complex_dtype),
            )
            if not self._scratch:
                self._plan(scratch)
            self._scratch.append(scratch)
            (self._beside or self).nbytes += sum(array.nbytes for array in scratch)
        self._prepared = len(self._scratch)

    def _plan(self, scratch: Scratch) -> None:
        """Plans for whole blocks of rows, for the last one, and for each kind of blocks of columns; they go when this
        transform does."""
        fftw, plan = library(self.dtype), self.plan
        half, columns = plan.row_spectra.ctypes.data, scratch.columns.ctypes.data
        rows_in, rows_out = scratch.rows.ctypes.data, scratch.rows_out.ctypes.data
        real, spectra, stride = self._real_stride, scratch.rows_spectrum.shape[1], self._half_stride
        for last in range(2):
            rows = self.shape[0] - (self._row_blocks - 1) * self._row_block if last else self._row_block
            out = scratch.rows_spectrum.ctypes.data
            plan.row_plans[0, last] = fftw.real_to_complex(self.padded[1], rows, (1, 1, real, spectra), (rows_in, out))
            plan.row_plans[1, last] = fftw.complex_to_real(self.padded[1], rows, (stride, 1, 1, real), (half, rows_out))
        # from one array into another: plans made without timing are a quarter faster so than in place
        along = (1, 1, self._spectrum_stride, self._spectrum_stride)
        done = (columns, scratch.columns_out.ctypes.data)
        made: dict[tuple[int, int], list[int]] = {}
        for block, own in enumerate(zip(plan.lengths.tolist(), np.diff(plan.columns).tolist(), strict=True)):
            if own not in made:
                made[own] = [fftw.complex(*own, along, done, back=back) for back in (False, True)]
            plan.column_plans[:, block] = made[own]
        plans = [*plan.row_plans.ravel().tolist(), *(fftw_plan for pair in made.values() for fftw_plan in pair)]
        if self._packed_plan is not None:
            plans += self._plan_pairs(self._packed_plan, scratch)
        weakref.finalize(self, fftw.destroy, plans)

    def _plan_pairs(self, plan: TransformPlan, scratch: Scratch) -> list[int]:
        """Make plans for complex rows of half the length, and for one column."""
        fftw, half, columns = library(self.dtype), plan.row_spectra.ctypes.data, scratch.columns.ctypes.data
        rows_in, rows_out, spectra = (
            array.ctypes.data for array in (scratch.rows, scratch.rows_out, scratch.rows_spectrum)
        )
        row, stride, across = self._real_stride // 2, self._half_stride, scratch.rows_spectrum.shape[1]
        for last in range(2):
            rows = self.shape[0] - (self._row_blocks - 1) * self._row_block if last else self._row_block
            plan.row_plans[0, last] = fftw.complex(
                plan.spectra, rows, (1, 1, row, across), (rows_in, spectra), back=False
            )
            plan.row_plans[1, last] = fftw.complex(plan.spectra, rows, (stride, 1, 1, row), (half, rows_out), back=True)
        along, done = (1, 1, self._spectrum_stride, self._spectrum_stride), (columns, scratch.columns_out.ctypes.data)
        plan.column_plans[:, 0] = [fftw.complex(self.padded[0], 1, along, done, back=back) for back in (False, True)]
        return [*plan.row_plans.ravel().tolist(), *plan.column_plans.ravel().tolist()]

    def _each(self, loop: Any, blocks: int, *arguments: Any, plan: TransformPlan | None = None) -> None:
        """Run a compiled pass over blocks shared by threads, several blocks a call to spare calls of Python."""
        own, threads = self.plan if plan is None else plan, threads_for(self.entries)
        pieces = min(blocks, _PIECES * threads)
        if pieces <= 1 or threads == 1:
            loop(own, self._scratch[0], *arguments, 0, blocks)
            return

        def work(number: int, piece: int) -> None:
            loop(own, self._scratch[number], *arguments, piece * blocks // pieces, (piece + 1) * blocks // pieces)

        share(work, pieces, self.entries)

    def _is_plain(self, values: FloatArray) -> bool:
        return values.dtype == self.dtype and values.flags.c_contiguous and values.flags.writeable

    def _plain(self, values: FloatArray) -> FloatArray:
        """Return the field contiguous and in this precision."""
        return values if self._is_plain(values) else np.array(values, self.dtype, order="C")

    def _count(self, *, blocks: int, forward: int = 0, inverse: int = 0) -> None:
        """Add transforms whose columns are those of the first so many blocks."""
        times = forward + inverse
        with _COUNTING:
            COUNT.forward += forward
            COUNT.inverse += inverse
            COUNT.rows += times * self.shape[0]
            COUNT.columns += times * self._ends[blocks]
            COUNT.numbers += times * self._numbers[blocks]
