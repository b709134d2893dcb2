"""Compiled passes of a padded transform over blocks of rows or columns, with their one-dimensional transforms.

A whole convolution is one call of compiled code (`convolve`), which other compiled loops may call. Threads share the
blocks of each pass; the result of a block does not depend on the thread.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.transforms.addresses import LINE, fetch, numbers
from bem.transforms.packed_real_fft import packed_columns_through
from bem.transforms.plans import ALIGNMENT, execute

BEGINS, GOES_ON, ENDS = range(3)
"""Role of a field in a sum of squares: first term, middle term, last term with the square root."""

ONE = 2
"""Value of `Factor.real_parity` for the multiplier that is one everywhere."""


class TransformPlan(NamedTuple):
    """Lengths, blocks, FFTW plans and the array of row spectra, shared by all threads.

    Attributes
    ----------
    nx, ny : shape of the field.
    row_block : rows in a block.
    spectra : wavenumbers along y.
    aligned_rows : whether rows of a field are contiguous and aligned like those of scratch, so that no copy is needed.
    unpadded_columns : whether columns are not padded, so that no copy is needed.
    executors : addresses of FFTW's functions: real to complex, complex, complex to real.
    row_plans : (2, 2), plans of rows forward and back, for a whole block and for the last block.
    columns : (blocks + 1,), first column of each block.
    column_plans : (2, blocks), plans of columns forward and back.
    lengths, scales : (blocks,), length of the columns' transforms, and the scale of the inverse transform.
    row_spectra : (py // 2 + 1, stride), the rows' spectra, transposed, between both passes.
    twiddles : (2, pairs), sines and cosines for packed rows (`packed_real_fft`), empty otherwise. With packed rows a
        block is of pairs of columns, column plans are of one column, and rows are complex of half the length.
    """

    nx: int
    ny: int
    row_block: int
    spectra: int
    aligned_rows: bool
    unpadded_columns: bool
    executors: NDArray[Any]
    row_plans: NDArray[Any]
    columns: NDArray[Any]
    column_plans: NDArray[Any]
    lengths: NDArray[Any]
    scales: NDArray[Any]
    row_spectra: NDArray[Any]
    twiddles: NDArray[Any]


class Scratch(NamedTuple):
    """Buffers of one thread: blocks of rows in (zero beyond the field) and out, of their spectra, and of columns."""

    rows: NDArray[Any]
    rows_out: NDArray[Any]
    rows_spectrum: NDArray[Any]
    columns: NDArray[Any]
    columns_out: NDArray[Any]


class Singles(NamedTuple):
    """The way back in small portions: `columns`, `lengths`, `scales` : (py // 2 + 1,), plans, lengths and scales of one
    column each. `numbers` : (py // 2 + 2,), how many in the first so many columns. `rows` : (2,), plans for `GROUP`
    rows, and for the last group."""

    columns: NDArray[Any]
    lengths: NDArray[Any]
    scales: NDArray[Any]
    numbers: NDArray[Any]
    rows: NDArray[Any]


GROUP = 8
"""Rows in a group: whole cache lines of the half-way array."""


class Squares(NamedTuple):
    """A root of a sum of squares of fields, on its way: half-way arrays (terms, py // 2 + 1, stride), how many columns
    of each count, weights (terms,), and scratch for a group's rows. `begun` : groups whose rows are added term by term.
    """

    halves: NDArray[Any]
    columns: NDArray[Any]
    weights: NDArray[Any]
    rows: NDArray[Any]
    begun: NDArray[Any]


class Factor(NamedTuple):
    """Parts of a multiplier; parity 0 means that the part is zero, `ONE` that it is one, and its array is empty."""

    real: NDArray[Any]
    imaginary: NDArray[Any]
    real_parity: int
    imaginary_parity: int


@compiled
def convolve(plan, scratch, factor, values, out):
    """Pad a field, transform it, multiply by the factor and transform back, on one thread; `out` may be `values`."""
    row_blocks = -(-plan.nx // plan.row_block)
    rows_forward(plan, scratch, values, 0, row_blocks)
    columns_through(plan, scratch, factor, 0, plan.lengths.size)
    rows_back(plan, scratch, out, 0, row_blocks)


@compiled
def convolve_cells(plan, scratch, factor, cells, values, out):
    """Convolve a field that is zero except on some cells (see `rows_forward_of_cells`)."""
    row_blocks = -(-plan.nx // plan.row_block)
    rows_forward_of_cells(plan, scratch, cells, values, 0, row_blocks)
    columns_through(plan, scratch, factor, 0, plan.lengths.size)
    rows_back(plan, scratch, out, 0, row_blocks)


@compiled
def rows_forward_of_cells(plan, scratch, cells, values, first, last):
    """Transform blocks of rows of a field with these values on `cells` (flat indices, ascending) and zero elsewhere.

    The field itself is not stored, and blocks of rows without a cell are not transformed.
    """
    half, rows, ny = plan.row_spectra, scratch.rows, plan.ny
    for block in range(first, last):
        start = block * plan.row_block
        count = min(plan.nx, start + plan.row_block) - start
        begin = first_from(cells, start * ny, 0, cells.size)
        end = first_from(cells, (start + count) * ny, begin, cells.size)
        if begin == end:
            for j in range(plan.spectra):
                half[j, start : start + count] = 0
            continue
        rows[:count, :ny] = 0
        i, stop = 0, (start + 1) * ny
        for k in range(begin, end):
            while cells[k] >= stop:
                i += 1
                stop += ny
            rows[i, cells[k] - stop + ny] = values[k]
        _rows_out(plan, scratch, rows.ctypes.data, start, count)


@compiled
def first_from(cells, value, low, high):
    """Return the index of the first of the ascending cells `low` to before `high` that is at least `value`."""
    while low < high:
        middle = (low + high) >> 1
        if cells[middle] < value:
            low = middle + 1
        else:
            high = middle
    return low


@compiled
def _rows_out(plan, scratch, source, start, count):
    """Transform a block of rows at an address along y and write it transposed, in whole cache lines.

    FFTW's own strided writes take a third longer.
    """
    fftw_plan = plan.row_plans[0, 0 if count == plan.row_block else 1]
    execute(plan.executors[0], fftw_plan, source, scratch.rows_spectrum.ctypes.data)
    _transpose(scratch.rows_spectrum, plan.row_spectra, start, count, plan.spectra)


@compiled
def rows_forward(plan, scratch, values, first, last):
    """Transform blocks of rows of a contiguous field along y and write them transposed."""
    direct = plan.aligned_rows and values.ctypes.data % ALIGNMENT == 0
    rows = scratch.rows
    for block in range(first, last):
        start = block * plan.row_block
        count = min(plan.nx, start + plan.row_block) - start
        if direct:
            source = values[start:].ctypes.data
        else:
            for i in range(count):
                for j in range(plan.ny):
                    rows[i, j] = values[start + i, j]
            source = rows.ctypes.data
        _rows_out(plan, scratch, source, start, count)


@compiled
def _transpose(spectra, half, start, rows, length):
    for block in range(0, length, 8):
        for j in range(block, min(length, block + 8)):
            for i in range(rows):
                half[j, start + i] = spectra[i, j]


@compiled
def rows_back(plan, scratch, out, first, last):
    """Transform blocks of rows of a contiguous field back along y; their row spectra are destroyed."""
    direct = plan.aligned_rows and out.ctypes.data % ALIGNMENT == 0
    rows = scratch.rows_out
    for block in range(first, last):
        start = block * plan.row_block
        count = min(plan.nx, start + plan.row_block) - start
        fftw_plan = plan.row_plans[1, 0 if count == plan.row_block else 1]
        source = plan.row_spectra[0, start:].ctypes.data
        if direct:
            execute(plan.executors[2], fftw_plan, source, out[start:].ctypes.data)
            continue
        execute(plan.executors[2], fftw_plan, source, rows.ctypes.data)
        for i in range(count):
            for j in range(plan.ny):
                out[start + i, j] = rows[i, j]


@compiled
def rows_back_squared(plan, scratch, weight, stage, out, first, last):
    """Transform blocks of rows back along y and add their weighted squares to the sum in `out` (see `stage`)."""
    rows = scratch.rows_out
    for block in range(first, last):
        start = block * plan.row_block
        count = min(plan.nx, start + plan.row_block) - start
        fftw_plan = plan.row_plans[1, 0 if count == plan.row_block else 1]
        execute(plan.executors[2], fftw_plan, plan.row_spectra[0, start:].ctypes.data, rows.ctypes.data)
        for i in range(count):
            if stage == BEGINS:
                for j in range(plan.ny):
                    out[start + i, j] = weight * rows[i, j] * rows[i, j]
            elif stage == ENDS:
                for j in range(plan.ny):
                    out[start + i, j] = np.sqrt(out[start + i, j] + weight * rows[i, j] * rows[i, j])
            else:
                for j in range(plan.ny):
                    out[start + i, j] += weight * rows[i, j] * rows[i, j]


@compiled
def inverse_squared(plan, scratch, factor, spectrum, blocks, weight, stage, out):
    """Multiply a spectrum by the factor, transform it back on one thread, and add squares (`rows_back_squared`)."""
    columns_in(plan, scratch, factor, spectrum, 0, blocks)
    plan.row_spectra[plan.columns[blocks] :] = 0
    rows_back_squared(plan, scratch, weight, stage, out, 0, -(-plan.nx // plan.row_block))


@compiled
def columns_through(plan, scratch, factor, first, last):
    """Transform blocks of columns along x, multiply by the factor, and transform back."""
    if plan.twiddles.size:
        packed_columns_through(plan, scratch, factor.real, plan.columns[first], plan.columns[last])
        return
    for block in range(first, last):
        _columns_forward(plan, scratch, block)
        multiply(plan, factor, scratch.columns_out, scratch.columns, block, 0)
        _columns_back(plan, scratch, block)


@compiled
def columns_out(plan, scratch, spectrum, first, last):
    """Transform blocks of columns along x into a spectrum."""
    for block in range(first, last):
        start = plan.columns[block]
        _columns_forward(plan, scratch, block)
        for i in range(plan.columns[block + 1] - start):
            for j in range(plan.lengths[block]):
                spectrum[start + i, j] = scratch.columns_out[i, j]


@compiled
def columns_in(plan, scratch, factor, spectrum, first, last):
    """Multiply blocks of columns of a spectrum by the factor and transform them back along x."""
    for block in range(first, last):
        multiply(plan, factor, spectrum, scratch.columns, block, plan.columns[block])
        _columns_back(plan, scratch, block)


@compiled
def terms_back(plan, singles, scratch, factors, spectrum, squares, terms, share, out):
    """The terms (first, last) of a spectrum times `factors` along x, into half-way arrays of their own, and along y in
    the groups that are begun, while they are near. share : this thread's number, and of how many."""
    given, source, done = spectrum.ctypes.data, scratch.columns[0].ctypes.data, scratch.columns_out[0]
    result, (stride, itemsize), line = done.ctypes.data, spectrum.strides, squares.halves.shape[2]
    columns, lengths, scales, executor = singles.columns, singles.lengths, singles.scales, plan.executors[1]
    for term in range(terms[0], terms[1]):
        half, count, rows = squares.halves[term], squares.columns[term], rows_of(factors[term])
        begin, end = half.ctypes.data, (share[0] + 1) * count // share[1]
        for number in range(share[0] * count // share[1], end):
            length = lengths[number]
            multiply_column(rows, number, given + number * stride, source, scales[number], length)
            _fetch_rows(rows, number + 1, (length // 2 + 1) * itemsize // 2)
            if length <= (end - number) * line:
                # what goes beyond the field lies where this thread writes its next columns
                execute(executor, columns[number], source, begin + number * line * itemsize)
                continue
            execute(executor, columns[number], source, result)
            for j in range(plan.nx):
                half[number, j] = done[j]
        if share[0] == 0:
            half[count:] = 0
        for group in range(squares.begun.size):
            if squares.begun[group]:
                term_of_group(plan, singles, squares, term, group, out)


@compiled
def term_of_group(plan, singles, squares, term, group, out):
    """Rows of a group from a half-way array, destroyed there, added as `rows_back_squared` does."""
    start = group * GROUP
    count = min(plan.nx, start + GROUP) - start
    rows, weight, last = squares.rows, squares.weights[term], squares.weights.size - 1
    fftw_plan = singles.rows[0 if count == GROUP else 1]
    execute(plan.executors[2], fftw_plan, squares.halves[term, 0, start:].ctypes.data, rows.ctypes.data)
    for i in range(count):
        if term == 0:
            for j in range(plan.ny):
                out[start + i, j] = weight * rows[i, j] * rows[i, j]
        elif term == last:
            for j in range(plan.ny):
                out[start + i, j] = np.sqrt(out[start + i, j] + weight * rows[i, j] * rows[i, j])
        else:
            for j in range(plan.ny):
                out[start + i, j] += weight * rows[i, j] * rows[i, j]


@compiled
def _columns_forward(plan, scratch, block):
    """Transform a block of columns of the row spectra along x into `columns_out`."""
    start, fftw_plan = plan.columns[block], plan.column_plans[0, block]
    if plan.unpadded_columns:
        source = plan.row_spectra[start:].ctypes.data
    else:
        columns = scratch.columns
        for i in range(plan.columns[block + 1] - start):
            for j in range(plan.nx):
                columns[i, j] = plan.row_spectra[start + i, j]
            for j in range(plan.nx, plan.lengths[block]):
                columns[i, j] = 0
        source = columns.ctypes.data
    execute(plan.executors[1], fftw_plan, source, scratch.columns_out.ctypes.data)


@compiled
def _columns_back(plan, scratch, block):
    """Transform a block of `columns` back along x into the row spectra."""
    start, fftw_plan = plan.columns[block], plan.column_plans[1, block]
    if plan.unpadded_columns:
        execute(plan.executors[1], fftw_plan, scratch.columns.ctypes.data, plan.row_spectra[start:].ctypes.data)
        return
    execute(plan.executors[1], fftw_plan, scratch.columns.ctypes.data, scratch.columns_out.ctypes.data)
    for i in range(plan.columns[block + 1] - start):
        for j in range(plan.nx):
            plan.row_spectra[start + i, j] = scratch.columns_out[i, j]


@compiled
def multiply(plan, factor, given, target, block, offset):
    """Multiply a block of columns, from `offset` on in `given`, by the factor and the inverse transform's scale."""
    start, count, rows = plan.columns[block], plan.columns[block + 1] - plan.columns[block], rows_of(factor)
    source, result, scale, length = given.ctypes.data, target.ctypes.data, plan.scales[block], plan.lengths[block]
    for i in range(count):
        own = source + (offset + i) * given.strides[0], result + i * target.strides[0]
        multiply_column(rows, start + i, own[0], own[1], scale, length)


@compiled
def rows_of(factor):
    """Return the addresses of a factor's parts, bytes from row to row, and parities, for `multiply_column`."""
    real, imaginary = factor.real, factor.imaginary
    begins, strides = (real.ctypes.data, imaginary.ctypes.data), (real.strides[0], imaginary.strides[0])
    return begins, strides, (factor.real_parity, factor.imaginary_parity)


@compiled
def _fetch_rows(rows, number, size):
    """Ask for a column's row of both parts, of so many bytes."""
    begins, strides, parities = rows
    for part in range(2):
        if parities[part] == 1 or parities[part] == -1:
            begin = begins[part] + number * strides[part]
            for line in range(begin, begin + size, LINE):
                fetch(line)


@compiled
def multiply_column(rows, number, given, target, scale, length):
    """Multiply the column `number` by a factor (given by `rows_of`) and a scale; `given`, `target` are addresses.

    The loop runs over real numbers, two for each complex number: a third less time than complex arithmetic.
    """
    begins, strides, parities = rows
    real, imaginary = numbers(begins[0] + number * strides[0], scale), numbers(begins[1] + number * strides[1], scale)
    source, result = numbers(given, scale), numbers(target, scale)
    half = length // 2 + 1
    first = scale if parities[0] > 0 else -scale
    second = scale if parities[1] > 0 else -scale
    if parities[0] == ONE:
        for j in range(2 * length):
            result[j] = source[j] * scale
    elif parities[0] == 0 and parities[1] == 0:
        for j in range(2 * length):
            result[j] = 0
    elif parities[1] == 0:
        for j in range(half):
            a = real[j] * scale
            result[2 * j], result[2 * j + 1] = source[2 * j] * a, source[2 * j + 1] * a
        for j in range(half, length):
            a = real[length - j] * first
            result[2 * j], result[2 * j + 1] = source[2 * j] * a, source[2 * j + 1] * a
    elif parities[0] == 0:
        for j in range(half):
            b = imaginary[j] * scale
            result[2 * j], result[2 * j + 1] = -b * source[2 * j + 1], b * source[2 * j]
        for j in range(half, length):
            b = imaginary[length - j] * second
            result[2 * j], result[2 * j + 1] = -b * source[2 * j + 1], b * source[2 * j]
    else:
        for j in range(half):
            a, b = real[j] * scale, imaginary[j] * scale
            x, y = source[2 * j], source[2 * j + 1]
            result[2 * j], result[2 * j + 1] = a * x - b * y, a * y + b * x
        for j in range(half, length):
            a, b = real[length - j] * first, imaginary[length - j] * second
            x, y = source[2 * j], source[2 * j + 1]
            result[2 * j], result[2 * j + 1] = a * x - b * y, a * y + b * x
