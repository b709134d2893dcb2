"""Compiled passes of a padded transform over blocks of rows (along y) or columns (along x).

The row spectra lie transposed between both passes, [wavenumber along y, x], so that columns are contiguous. A whole
convolution is one call of compiled code (`convolve`), which other compiled loops may call. Threads share the
blocks of each pass; the result of a block does not depend on the thread.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.transforms.addresses import LINE, pointer_to, prefetch
from bem.transforms.packed_real_fft import packed_columns_through
from bem.transforms.plans import ALIGNMENT, execute

BEGINS, GOES_ON, ENDS = range(3)
"""Role of a field in a sum of squares: first term, middle term, last term with the square root."""

ONE = 2
"""Value of `Factor.real_parity` for the multiplier that is one everywhere."""

WHOLE = 3
"""Value of `Factor.real_parity` for a real part of no parity along x, of which all wavenumbers are stored."""


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
    lengths, scales : (blocks,), length of the columns' transforms, and the scale 1 / (length py) of the inverse real
        transform; with packed rows that is half the scale of the packed transform.
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
    """Buffers of one thread.

    rows, rows_out : block of rows before the transform (zero beyond the field), and after the inverse transform.
    rows_spectrum : spectra of a block of rows.
    columns, columns_out : block of columns, source and target of a transform.
    """

    rows: NDArray[Any]
    rows_out: NDArray[Any]
    rows_spectrum: NDArray[Any]
    columns: NDArray[Any]
    columns_out: NDArray[Any]


class SingleColumnPlans(NamedTuple):
    """Plans of inverse transforms in small portions: single columns, and groups of rows.

    Attributes
    ----------
    columns : (py // 2 + 1,), plan of each column.
    lengths, scales : (py // 2 + 1,), length of each column's transform, and scale of the inverse.
    cumulative_lengths : (py // 2 + 2,), sum of the lengths of the first k columns.
    rows : (2,), plans for `GROUP` rows, and for the last group.
    """

    columns: NDArray[Any]
    lengths: NDArray[Any]
    scales: NDArray[Any]
    cumulative_lengths: NDArray[Any]
    rows: NDArray[Any]


GROUP = 8
"""Rows in a group: whole cache lines of the row spectra."""


class Squares(NamedTuple):
    """Buffers for the root of a weighted sum of squares of fields, computed for some groups of rows only.

    Attributes
    ----------
    row_spectra : (terms, py // 2 + 1, stride), row spectra of each term.
    columns : (terms,), number of columns of each term that are not zero.
    weights : (terms,), weight of each square.
    rows : (GROUP, stride), scratch for the rows of a group.
    begun : (groups,), True for groups whose rows are transformed and added term by term in `terms_back`.
    """

    row_spectra: NDArray[Any]
    columns: NDArray[Any]
    weights: NDArray[Any]
    rows: NDArray[Any]
    begun: NDArray[Any]


class Factor(NamedTuple):
    """Multiplier in one precision, as compiled code takes it (see `Multiplier`).

    A parity of 0 means that the part is zero, `ONE` that it is one everywhere; its array is empty then. Beside a real
    part that is `WHOLE` there is no imaginary part.
    """

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
    row_spectra, rows, ny = plan.row_spectra, scratch.rows, plan.ny
    for block in range(first, last):
        start = block * plan.row_block
        count = min(plan.nx, start + plan.row_block) - start
        begin = first_from(cells, start * ny, 0, cells.size)
        end = first_from(cells, (start + count) * ny, begin, cells.size)
        if begin == end:
            for j in range(plan.spectra):
                row_spectra[j, start : start + count] = 0
            continue
        rows[:count, :ny] = 0
        i, stop = 0, (start + 1) * ny
        for k in range(begin, end):
            while cells[k] >= stop:
                i += 1
                stop += ny
            rows[i, cells[k] - stop + ny] = values[k]
        _transform_row_block(plan, scratch, rows.ctypes.data, start, count)


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
def _transform_row_block(plan, scratch, source, start, count):
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
        _transform_row_block(plan, scratch, source, start, count)


@compiled
def _transpose(spectra, row_spectra, start, rows, length):
    """Write the spectra of a block of rows, (rows, length), transposed into the row spectra."""
    for block in range(0, length, 8):
        for j in range(block, min(length, block + 8)):
            for i in range(rows):
                row_spectra[j, start + i] = spectra[i, j]


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
        multiply_block(plan, factor, scratch.columns_out, scratch.columns, block, 0)
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
        multiply_block(plan, factor, spectrum, scratch.columns, block, plan.columns[block])
        _columns_back(plan, scratch, block)


@compiled
def terms_back(plan, single_columns, scratch, factors, spectrum, squares, terms, share, out):
    """Transform terms of a sum of squares back along x into their row spectra; add the rows of the groups begun.

    terms : (first, last), range of the terms.
    factors : one multiplier for each term.
    share : number of this thread, and of threads; a thread takes a share of the columns.
    """
    spectrum_at, source, column_out = spectrum.ctypes.data, scratch.columns[0].ctypes.data, scratch.columns_out[0]
    result, (stride, itemsize), line = column_out.ctypes.data, spectrum.strides, squares.row_spectra.shape[2]
    columns, lengths, scales, executor = (
        single_columns.columns,
        single_columns.lengths,
        single_columns.scales,
        plan.executors[1],
    )
    for term in range(terms[0], terms[1]):
        row_spectra, count, rows = squares.row_spectra[term], squares.columns[term], factor_rows(factors[term])
        row_spectra_at, end = row_spectra.ctypes.data, (share[0] + 1) * count // share[1]
        for number in range(share[0] * count // share[1], end):
            length = lengths[number]
            multiply_column(rows, number, spectrum_at + number * stride, source, scales[number], length)
            _prefetch_rows(rows, number + 1, (length // 2 + 1) * itemsize // 2)
            if length <= (end - number) * line:
                # entries beyond the field fall on columns that this thread writes next
                execute(executor, columns[number], source, row_spectra_at + number * line * itemsize)
                continue
            execute(executor, columns[number], source, result)
            for j in range(plan.nx):
                row_spectra[number, j] = column_out[j]
        if share[0] == 0:
            row_spectra[count:] = 0
        for group in range(squares.begun.size):
            if squares.begun[group]:
                term_of_group(plan, single_columns, squares, term, group, out)


@compiled
def term_of_group(plan, single_columns, squares, term, group, out):
    """Transform a group of rows of one term back along y and add their weighted squares to the sum in `out`.

    The group's row spectra are destroyed.
    """
    start = group * GROUP
    count = min(plan.nx, start + GROUP) - start
    rows, weight, last = squares.rows, squares.weights[term], squares.weights.size - 1
    fftw_plan = single_columns.rows[0 if count == GROUP else 1]
    execute(plan.executors[2], fftw_plan, squares.row_spectra[term, 0, start:].ctypes.data, rows.ctypes.data)
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
    """Transform a block of columns of the row spectra along x into `scratch.columns_out`."""
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
    """Transform a block of `scratch.columns` back along x into the row spectra."""
    start, fftw_plan = plan.columns[block], plan.column_plans[1, block]
    if plan.unpadded_columns:
        execute(plan.executors[1], fftw_plan, scratch.columns.ctypes.data, plan.row_spectra[start:].ctypes.data)
        return
    execute(plan.executors[1], fftw_plan, scratch.columns.ctypes.data, scratch.columns_out.ctypes.data)
    for i in range(plan.columns[block + 1] - start):
        for j in range(plan.nx):
            plan.row_spectra[start + i, j] = scratch.columns_out[i, j]


@compiled
def multiply_block(plan, factor, given, target, block, offset):
    """Multiply a block of columns of `given`, from column `offset` on, by the factor and the scale of the inverse."""
    start, count, rows = plan.columns[block], plan.columns[block + 1] - plan.columns[block], factor_rows(factor)
    source, result, scale, length = given.ctypes.data, target.ctypes.data, plan.scales[block], plan.lengths[block]
    for i in range(count):
        own = source + (offset + i) * given.strides[0], result + i * target.strides[0]
        multiply_column(rows, start + i, own[0], own[1], scale, length)


@compiled
def factor_rows(factor):
    """Return the addresses of a factor's parts, bytes from row to row, and parities, for `multiply_column`."""
    real, imaginary = factor.real, factor.imaginary
    begins, strides = (real.ctypes.data, imaginary.ctypes.data), (real.strides[0], imaginary.strides[0])
    return begins, strides, (factor.real_parity, factor.imaginary_parity)


@compiled
def _prefetch_rows(rows, number, size):
    """Prefetch `size` bytes of a column's row of both parts of a factor."""
    begins, strides, parities = rows
    for part in range(2):
        if parities[part] == 1 or parities[part] == -1:
            begin = begins[part] + number * strides[part]
            for line in range(begin, begin + size, LINE):
                prefetch(line)


@compiled
def multiply_column(rows, number, given, target, scale, length):
    """Multiply the column `number` by a factor (given by `factor_rows`) and a scale; `given`, `target` are addresses.

    The loop runs over real numbers, two for each complex number: a third less time than complex arithmetic.
    """
    begins, strides, parities = rows
    real, imaginary = (
        pointer_to(begins[0] + number * strides[0], scale),
        pointer_to(begins[1] + number * strides[1], scale),
    )
    source, result = pointer_to(given, scale), pointer_to(target, scale)
    half = length // 2 + 1
    first = scale if parities[0] > 0 else -scale
    second = scale if parities[1] > 0 else -scale
    if parities[0] == ONE:
        for j in range(2 * length):
            result[j] = source[j] * scale
    elif parities[0] == WHOLE:
        for j in range(length):
            a = real[j] * scale
            result[2 * j], result[2 * j + 1] = source[2 * j] * a, source[2 * j + 1] * a
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
