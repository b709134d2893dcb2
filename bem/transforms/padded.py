"""Transforms and convolutions of real fields padded with zeros: a pass over rows along y, a pass over columns along x.

`PaddedTransform` owns the plans and buffers of one shape, and shares the blocks of each pass among threads. The passes
are compiled (`loops`).
"""

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
from bem.transforms.loops import GROUP, Factor, Scratch, SingleColumnPlans, Squares, TransformPlan
from bem.transforms.multipliers import Multiplier, unit_factor
from bem.transforms.plans import ALIGNMENT, aligned_empty, aligned_zeros, library

FloatArray = NDArray[Any]
ComplexArray = NDArray[Any]

_BLOCK_BYTES = 1 << 18
"""Size of a block of rows or columns [bytes]: it stays in the cache of a core."""
_PIECES = 2
"""Pieces of a pass per thread, so that a thread that begins late takes fewer."""
_COUNTING = ForkSafeLock()
COMPLEX: dict[np.dtype[Any], np.dtype[Any]] = {
    np.dtype(np.float64): np.dtype(np.complex128),
    np.dtype(np.float32): np.dtype(np.complex64),
}
"""Precisions of fields, and those of their spectra."""


def _stride(length: int, itemsize: int) -> int:
    """Return the distance of rows in memory, in entries: whole cache lines, but no multiple of 2 kB.

    Rows at multiples of 2 kB would share cache sets.
    """
    line = ALIGNMENT // itemsize
    stride = -(-length // line) * line
    if stride * itemsize % 2048 == 0 and stride > line:
        stride += line
    return stride


def _block(rows: int, row_bytes: int, granule: int) -> int:
    """Return the number of rows in a block of about `_BLOCK_BYTES`: a multiple of `granule`, at most `rows`."""
    rows_in_budget = max(1, _BLOCK_BYTES // max(1, row_bytes))
    return min(rows, max(granule, rows_in_budget // granule * granule))


def _blocks_of_columns(lengths: Sequence[int], largest: int) -> NDArray[np.int64]:
    """Return the edges of blocks of columns, (blocks + 1,): blocks of at most `largest` columns of one length."""
    edges = [0]
    for end in [*(k for k in range(1, len(lengths)) if lengths[k] != lengths[k - 1]), len(lengths)]:
        edges += [*range(edges[-1] + largest, end, largest), end]
    return np.array(edges, np.int64)


class PaddedTransform:
    """Transforms of fields of one shape, padded with zeros to another, in one precision; made by `transform_of`.

    shape : (nx, ny), shape of the field.
    padded : (px, py), lengths of the transforms.
    lengths : (py // 2 + 1,), lengths of the transforms along x for each wavenumber along y, if they differ
        (`narrowed_lengths`). Only the first entries of a spectrum's row (px,) are defined then, as many as its length,
        and half as many of a multiplier's row.
    double : double-precision transform whose `single` this is; both share one buffer of row spectra.
    """

    def __init__(
        self,
        shape: tuple[int, int],
        padded: tuple[int, int],
        dtype: DTypeLike = np.float64,
        lengths: tuple[int, ...] | None = None,
        double: PaddedTransform | None = None,
    ) -> None:
        self.shape = shape
        self.padded = padded
        self.entries = padded[0] * padded[1]
        self.dtype: np.dtype[Any] = np.dtype(dtype)
        self.complex_dtype: np.dtype[Any] = COMPLEX[self.dtype]
        self.spectrum_shape = (padded[1] // 2 + 1, padded[0])
        self._row_spectra_stride = _stride(shape[0], self.complex_dtype.itemsize)
        self._spectrum_stride = _stride(padded[0], self.complex_dtype.itemsize)
        self._real_stride = -(-padded[1] * self.dtype.itemsize // ALIGNMENT) * (ALIGNMENT // self.dtype.itemsize)
        line = ALIGNMENT // self.complex_dtype.itemsize
        self._row_block = _block(shape[0], self._real_stride * self.dtype.itemsize, line)
        self._column_block = _block(self.spectrum_shape[0], self._spectrum_stride * self.complex_dtype.itemsize, 1)
        self._row_blocks = -(-shape[0] // self._row_block)
        column_lengths = (padded[0],) * self.spectrum_shape[0] if lengths is None else lengths
        columns = _blocks_of_columns(column_lengths, self._column_block)
        self._column_blocks = len(columns) - 1
        self._column_edges: list[int] = columns.tolist()
        """Number of columns in the first k blocks, k = 0, 1, ...; and below, of entries in these columns."""
        self._column_entries = [
            0,
            *np.cumsum(np.diff(columns) * [column_lengths[start] for start in columns[:-1]]).tolist(),
        ]
        self.lock: ForkSafeLock = ForkSafeLock() if double is None else double.lock
        self._unit_factor = unit_factor(self.dtype)
        self._scratch: list[Scratch] = []
        self._prepared = 0
        row_spectra = self._allocate_row_spectra(double)
        block_lengths = np.array([column_lengths[start] for start in columns[:-1]], np.int64)
        self.nbytes = int(row_spectra.nbytes) if double is None else 0
        """Memory of the buffers [bytes], with those of `single`."""
        self._double, self.lengths = double, lengths
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
            row_spectra=row_spectra,
            twiddles=np.empty((2, 0), self.dtype),
        )
        self._packed_plan = self._packed_rows_plan() if lengths is None and padded[1] % 2 == 0 else None

    @cached_property
    def single(self) -> PaddedTransform:
        """Transform in single precision; it shares the buffer of row spectra with this one."""
        return PaddedTransform(self.shape, self.padded, np.float32, self.lengths, self)

    def _allocate_row_spectra(self, double: PaddedTransform | None) -> ComplexArray:
        """Return the array of row spectra, (py // 2 + 1, stride): new, or in the memory of the double-precision one."""
        shape = (self.spectrum_shape[0], self._row_spectra_stride)
        if double is None:
            return aligned_empty(shape, self.complex_dtype)
        return double.plan.row_spectra.reshape(-1).view(self.complex_dtype)[: shape[0] * shape[1]].reshape(shape)

    def _packed_rows_plan(self) -> TransformPlan:
        """Return the plan for even kernels: complex rows of half the length, columns in pairs (`packed_real_fft`)."""
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
        """Return the plan for `loops.convolve` and `loops.convolve_cells`: packed rows if the multiplier is even."""
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
            self._run_pass(loops.rows_forward, self._row_blocks, self._contiguous(values))
            self._run_pass(loops.columns_out, self._column_blocks, out)
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

        columns : number of wavenumbers along y, from zero on, that are not zero; other columns are left out, by whole
            blocks. Default: all.
        """
        out = np.empty(self.shape, self.dtype) if out is None else out
        contiguous = out if self._is_contiguous(out) else np.empty(self.shape, self.dtype)
        parts = self._unit_factor if factor is None else factor.factor(self.dtype)
        with self.lock:
            self.ready(threads_for(self.entries))
            kept = self.spectrum_shape[0] if columns is None else columns
            blocks = bisect_left(self._column_edges, kept)
            self._run_pass(loops.columns_in, blocks, parts, spectrum)
            self.plan.row_spectra[self._column_edges[blocks] :] = 0
            self._run_pass(loops.rows_back, self._row_blocks, contiguous)
        self._count(inverse=1, blocks=blocks)
        if contiguous is not out:
            out[...] = contiguous
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
        """Add the weighted square of an inverse transform to a sum of squares, without storing the field.

        spectrum, factor, columns : as in `inverse`.
        out : (nx, ny), the sum.
        stage : role of the term: first, middle, or last with the square root (`loops.BEGINS`, `GOES_ON`, `ENDS`).
        """
        parts, threads = factor.factor(self.dtype), threads_for(self.entries)
        with self.lock:
            scratch = self.ready(threads)
            blocks = bisect_left(self._column_edges, self.spectrum_shape[0] if columns is None else columns)
            if threads == 1:
                loops.inverse_squared(self.plan, scratch, parts, spectrum, blocks, weight, stage, out)
            else:
                self._run_pass(loops.columns_in, blocks, parts, spectrum)
                self.plan.row_spectra[self._column_edges[blocks] :] = 0
                self._run_pass(loops.rows_back_squared, self._row_blocks, weight, stage, out)
        self._count(inverse=1, blocks=blocks)

    def empty_squares(self, weights: FloatArray) -> Squares:
        """Return empty buffers for the root of a sum of squares of fields, one for each weight; no group is begun."""
        shape = (len(weights), self.spectrum_shape[0], self._row_spectra_stride)
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
        """Transform terms of a sum of squares back along x, and along y in the groups of rows that are begun.

        The other groups are transformed along y by `loops.term_of_group`.

        spectrum : spectrum of all terms, to be multiplied by one of the `factors` for each term.
        terms : (first, last), range of the terms.
        out : (nx, ny), the sum; only the rows of begun groups are written.
        """
        threads, single_columns = threads_for(self.entries), self.single_column_plans
        own = (factors, spectrum, squares, terms)
        with self.lock:
            self.ready(threads)

            def work(number: int, block: int) -> None:
                loops.terms_back(self.plan, single_columns, self._scratch[number], *own, (block, threads), out)

            if threads == 1:
                work(0, 0)
            else:
                share(work, threads, self.entries)
        for count in squares.columns[slice(*terms)].tolist():
            COUNT.inverse += 1
            COUNT.columns += count
            COUNT.numbers += int(single_columns.cumulative_lengths[count])

    @cached_property
    def single_column_plans(self) -> SingleColumnPlans:
        """Plans of single columns and of groups of rows, created on first use."""
        with self.lock:
            scratch, fftw = self.ready(1), library(self.dtype)
            each = np.diff(self.plan.columns)
            lengths, stride = np.repeat(self.plan.lengths, each), self._spectrum_stride
            data = (scratch.columns.ctypes.data, scratch.columns_out.ctypes.data)
            plans_by_length = {
                length: fftw.complex(length, 1, (1, 1, stride, stride), data, back=True)
                for length in set(lengths.tolist())
            }
            across = (self._row_spectra_stride, 1, 1, self._real_stride)
            data = (self.plan.row_spectra.ctypes.data, self.empty_squares(np.ones(1)).rows.ctypes.data)
            rows = [
                fftw.complex_to_real(self.padded[1], count, across, data)
                for count in (min(GROUP, self.shape[0]), self.shape[0] % GROUP or GROUP)
            ]
            weakref.finalize(self, fftw.destroy, [*plans_by_length.values(), *rows])
            plans = np.array([plans_by_length[length] for length in lengths.tolist()], np.int64)
            scales, numbers = np.repeat(self.plan.scales, each), np.append(0, np.cumsum(lengths))
            return SingleColumnPlans(plans, lengths, scales, numbers, np.array(rows, np.int64))

    def convolve(self, values: FloatArray, factor: Multiplier, out: FloatArray | None = None) -> FloatArray:
        """Return the field (nx, ny) convolved with the kernel of a multiplier; `out` may be `values`.

        The padded spectrum as a whole is not stored.
        """
        out = np.empty(self.shape, self.dtype) if out is None else out
        values = self._contiguous(values)
        contiguous = out if self._is_contiguous(out) else np.empty(self.shape, self.dtype)
        parts = factor.factor(self.dtype)
        threads, plan = threads_for(self.entries), self.plan_for(parts)
        with self.lock:
            scratch = self.ready(threads)
            if threads == 1:
                loops.convolve(plan, scratch, parts, values, contiguous)
            else:
                self._run_pass(loops.rows_forward, self._row_blocks, values, plan=plan)
                self._run_pass(loops.columns_through, plan.lengths.size, parts, plan=plan)
                self._run_pass(loops.rows_back, self._row_blocks, contiguous, plan=plan)
        self.counted(1)
        if contiguous is not out:
            out[...] = contiguous
        return out

    def convolve_cells(
        self, cells: NDArray[np.int64], values: FloatArray, factor: Multiplier, out: FloatArray
    ) -> FloatArray:
        """Return the convolution of a field that is zero except for `values` (n,) on `cells`.

        cells : (n,), flat indices, ascending. Blocks of rows without a cell are not transformed along y.
        out : contiguous field (nx, ny) of this precision.
        """
        parts, threads = factor.factor(self.dtype), threads_for(self.entries)
        plan = self.plan_for(parts)
        with self.lock:
            scratch = self.ready(threads)
            if threads == 1:
                loops.convolve_cells(plan, scratch, parts, cells, values, out)
            else:
                self._run_pass(loops.rows_forward_of_cells, self._row_blocks, cells, values, plan=plan)
                self._run_pass(loops.columns_through, plan.lengths.size, parts, plan=plan)
                self._run_pass(loops.rows_back, self._row_blocks, out, plan=plan)
        self.counted(1)
        return out

    def counted(self, convolutions: int) -> None:
        """Add a number of convolutions to the count of this process; for callers of `loops.convolve`."""
        self._count(forward=convolutions, inverse=convolutions, blocks=self._column_blocks)

    def ready(self, threads: int) -> Scratch:
        """Return the scratch of the first thread after preparing plans, and scratch for all threads.

        The caller holds `lock`.
        """
        if self._prepared < threads:
            self._prepare(threads)
        return self._scratch[0]

    def _prepare(self, threads: int) -> None:
        """Allocate scratch for the threads that have none; create the plans with the first."""
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
                self._make_plans(scratch)
            self._scratch.append(scratch)
            (self._double or self).nbytes += sum(array.nbytes for array in scratch)
        self._prepared = len(self._scratch)

    def _make_plans(self, scratch: Scratch) -> None:
        """Create plans for whole blocks of rows, for the last block, and for each shape of a block of columns.

        They are destroyed with this transform.
        """
        fftw, plan = library(self.dtype), self.plan
        half, columns = plan.row_spectra.ctypes.data, scratch.columns.ctypes.data
        rows_in, rows_out = scratch.rows.ctypes.data, scratch.rows_out.ctypes.data
        real, spectra, stride = self._real_stride, scratch.rows_spectrum.shape[1], self._row_spectra_stride
        for last in range(2):
            rows = self.shape[0] - (self._row_blocks - 1) * self._row_block if last else self._row_block
            out = scratch.rows_spectrum.ctypes.data
            plan.row_plans[0, last] = fftw.real_to_complex(self.padded[1], rows, (1, 1, real, spectra), (rows_in, out))
            plan.row_plans[1, last] = fftw.complex_to_real(self.padded[1], rows, (stride, 1, 1, real), (half, rows_out))
        # from one array into another: plans without timing are a quarter faster than in place
        along = (1, 1, self._spectrum_stride, self._spectrum_stride)
        done = (columns, scratch.columns_out.ctypes.data)
        plans_by_length: dict[tuple[int, int], list[int]] = {}
        for block, own in enumerate(zip(plan.lengths.tolist(), np.diff(plan.columns).tolist(), strict=True)):
            if own not in plans_by_length:
                plans_by_length[own] = [fftw.complex(*own, along, done, back=back) for back in (False, True)]
            plan.column_plans[:, block] = plans_by_length[own]
        plans = [
            *plan.row_plans.ravel().tolist(),
            *(fftw_plan for pair in plans_by_length.values() for fftw_plan in pair),
        ]
        if self._packed_plan is not None:
            plans += self._make_packed_plans(self._packed_plan, scratch)
        weakref.finalize(self, fftw.destroy, plans)

    def _make_packed_plans(self, plan: TransformPlan, scratch: Scratch) -> list[int]:
        """Create plans for packed rows (complex, half the length) and for one column; return their addresses."""
        fftw, half, columns = library(self.dtype), plan.row_spectra.ctypes.data, scratch.columns.ctypes.data
        rows_in, rows_out, spectra = (
            array.ctypes.data for array in (scratch.rows, scratch.rows_out, scratch.rows_spectrum)
        )
        row, stride, across = self._real_stride // 2, self._row_spectra_stride, scratch.rows_spectrum.shape[1]
        for last in range(2):
            rows = self.shape[0] - (self._row_blocks - 1) * self._row_block if last else self._row_block
            plan.row_plans[0, last] = fftw.complex(
                plan.spectra, rows, (1, 1, row, across), (rows_in, spectra), back=False
            )
            plan.row_plans[1, last] = fftw.complex(plan.spectra, rows, (stride, 1, 1, row), (half, rows_out), back=True)
        along, done = (1, 1, self._spectrum_stride, self._spectrum_stride), (columns, scratch.columns_out.ctypes.data)
        plan.column_plans[:, 0] = [fftw.complex(self.padded[0], 1, along, done, back=back) for back in (False, True)]
        return [*plan.row_plans.ravel().tolist(), *plan.column_plans.ravel().tolist()]

    def _run_pass(self, loop: Any, blocks: int, *arguments: Any, plan: TransformPlan | None = None) -> None:
        """Run a compiled pass over blocks that threads share, several blocks in each call."""
        own, threads = self.plan if plan is None else plan, threads_for(self.entries)
        pieces = min(blocks, _PIECES * threads)
        if pieces <= 1 or threads == 1:
            loop(own, self._scratch[0], *arguments, 0, blocks)
            return

        def work(number: int, piece: int) -> None:
            loop(own, self._scratch[number], *arguments, piece * blocks // pieces, (piece + 1) * blocks // pieces)

        share(work, pieces, self.entries)

    def _is_contiguous(self, values: FloatArray) -> bool:
        """Return True if a field is contiguous, writeable and of this precision."""
        return values.dtype == self.dtype and values.flags.c_contiguous and values.flags.writeable

    def _contiguous(self, values: FloatArray) -> FloatArray:
        """Return the field, or a contiguous copy of it in this precision."""
        return values if self._is_contiguous(values) else np.array(values, self.dtype, order="C")

    def _count(self, *, blocks: int, forward: int = 0, inverse: int = 0) -> None:
        """Add transforms to the count, with the columns of the first `blocks` blocks."""
        times = forward + inverse
        with _COUNTING:
            COUNT.forward += forward
            COUNT.inverse += inverse
            COUNT.rows += times * self.shape[0]
            COUNT.columns += times * self._column_edges[blocks]
            COUNT.numbers += times * self._column_entries[blocks]
