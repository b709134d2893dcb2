"""The compiled passes of a padded transform over blocks of rows or columns, transforms included.

A whole convolution is one call (`convolve`), so that a small grid does not wait for Python, and another compiled loop
may call it. Threads share the blocks of each pass; what a block does never depends on who does it.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.transforms.addresses import LINE, fetch, numbers
from bem.transforms.pairs import pairs_through
from bem.transforms.plans import ALIGNMENT, execute

BEGINS, GOES_ON, ENDS = range(3)
"""What a field does to a sum of squares."""

ONE = 2
"""In place of the real part's parity: the multiplier is one."""


class Room(NamedTuple):
    """What all threads share: lengths, blocks, plans, and the half-way array (py // 2 + 1, stride).

    `executors` : addresses of FFTW's functions, real to complex, complex, complex to real. `row_plans` : (2, 2),
    addresses for rows forward and back; for a whole block and for the last one. `columns` : (blocks + 1,), where blocks
    of columns begin. `column_plans` : (2, blocks), addresses for columns forward and back. `lengths`, `scales` :
    (blocks,), of the columns' transforms, and one over what a field's transforms multiply it by. `fits` : rows of a
    field are rows of scratch. `whole` : columns are not padded, so they need no copy either. `turns` : (2, pairs),
    sines and cosines where columns go in pairs (`pairs`), none where they do not; a block is then of so many pairs, a
    plan of one column, and rows are complex ones half as long.
    """

    nx: int
    ny: int
    row_block: int
    spectra: int
    fits: bool
    whole: bool
    executors: NDArray[Any]
    row_plans: NDArray[Any]
    columns: NDArray[Any]
    column_plans: NDArray[Any]
    lengths: NDArray[Any]
    scales: NDArray[Any]
    half: NDArray[Any]
    turns: NDArray[Any]


class Scratch(NamedTuple):
    """One thread's: blocks of rows in (zero beyond the field) and out, of their spectra, and of columns likewise."""

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
    """A multiplier's parts; parity 0 says that a part is zero, `ONE` that it is one, and its array is empty."""

    real: NDArray[Any]
    imaginary: NDArray[Any]
    real_parity: int
    imaginary_parity: int


@compiled
def convolve(room, scratch, factor, values, out):
    """A field padded, transformed, times the factor and back, by one thread; `out` may be `values`."""
    row_blocks = -(-room.nx // room.row_block)
    rows_forward(room, scratch, values, 0, row_blocks)
    columns_through(room, scratch, factor, 0, room.lengths.size)
    rows_back(room, scratch, out, 0, row_blocks)


@compiled
def convolve_cells(room, scratch, factor, cells, values, out):
    """The same of a field that is zero but on some cells (`rows_forward_of_cells`)."""
    row_blocks = -(-room.nx // room.row_block)
    rows_forward_of_cells(room, scratch, cells, values, 0, row_blocks)
    columns_through(room, scratch, factor, 0, room.lengths.size)
    rows_back(room, scratch, out, 0, row_blocks)


@compiled
def rows_forward_of_cells(room, scratch, cells, values, first, last):
    """`rows_forward` of a field with these values on `cells` (flat indices, ascending), zero elsewhere: it is nowhere
    but in scratch, and blocks of rows without a cell are not transformed."""
    half, rows, ny = room.half, scratch.rows, room.ny
    for block in range(first, last):
        start = block * room.row_block
        count = min(room.nx, start + room.row_block) - start
        begin = first_from(cells, start * ny, 0, cells.size)
        end = first_from(cells, (start + count) * ny, begin, cells.size)
        if begin == end:
            for j in range(room.spectra):
                half[j, start : start + count] = 0
            continue
        rows[:count, :ny] = 0
        i, stop = 0, (start + 1) * ny
        for k in range(begin, end):
            while cells[k] >= stop:
                i += 1
                stop += ny
            rows[i, cells[k] - stop + ny] = values[k]
        _rows_out(room, scratch, rows.ctypes.data, start, count)


@compiled
def first_from(cells, value, low, high):
    """The number of the first of the cells from `low` to before `high`, which ascend, that is no lower than a value;
    numpy's search would bring linear algebra into a run."""
    while low < high:
        middle = (low + high) >> 1
        if cells[middle] < value:
            low = middle + 1
        else:
            high = middle
    return low


@compiled
def _rows_out(room, scratch, source, start, count):
    """A block of rows at an address, transformed along y and written transposed, in whole cache lines: FFTW's own
    scattered writes take a third longer."""
    plan = room.row_plans[0, 0 if count == room.row_block else 1]
    execute(room.executors[0], plan, source, scratch.rows_spectrum.ctypes.data)
    _transpose(scratch.rows_spectrum, room.half, start, count, room.spectra)


@compiled
def rows_forward(room, scratch, values, first, last):
    """Blocks of rows of a contiguous field, transformed along y and written transposed."""
    direct = room.fits and values.ctypes.data % ALIGNMENT == 0
    rows = scratch.rows
    for block in range(first, last):
        start = block * room.row_block
        count = min(room.nx, start + room.row_block) - start
        if direct:
            source = values[start:].ctypes.data
        else:
            for i in range(count):
                for j in range(room.ny):
                    rows[i, j] = values[start + i, j]
            source = rows.ctypes.data
        _rows_out(room, scratch, source, start, count)


@compiled
def _transpose(spectra, half, start, rows, length):
    for block in range(0, length, 8):
        for j in range(block, min(length, block + 8)):
            for i in range(rows):
                half[j, start + i] = spectra[i, j]


@compiled
def rows_back(room, scratch, out, first, last):
    """Blocks of rows of a contiguous field from their transposed spectra, which are destroyed."""
    direct = room.fits and out.ctypes.data % ALIGNMENT == 0
    rows = scratch.rows_out
    for block in range(first, last):
        start = block * room.row_block
        count = min(room.nx, start + room.row_block) - start
        plan = room.row_plans[1, 0 if count == room.row_block else 1]
        source = room.half[0, start:].ctypes.data
        if direct:
            execute(room.executors[2], plan, source, out[start:].ctypes.data)
            continue
        execute(room.executors[2], plan, source, rows.ctypes.data)
        for i in range(count):
            for j in range(room.ny):
                out[start + i, j] = rows[i, j]


@compiled
def rows_back_squared(room, scratch, weight, stage, out, first, last):
    """The same, of which the squares times a weight begin a sum in `out`, go on with it, or end it with its root."""
    rows = scratch.rows_out
    for block in range(first, last):
        start = block * room.row_block
        count = min(room.nx, start + room.row_block) - start
        plan = room.row_plans[1, 0 if count == room.row_block else 1]
        execute(room.executors[2], plan, room.half[0, start:].ctypes.data, rows.ctypes.data)
        for i in range(count):
            if stage == BEGINS:
                for j in range(room.ny):
                    out[start + i, j] = weight * rows[i, j] * rows[i, j]
            elif stage == ENDS:
                for j in range(room.ny):
                    out[start + i, j] = np.sqrt(out[start + i, j] + weight * rows[i, j] * rows[i, j])
            else:
                for j in range(room.ny):
                    out[start + i, j] += weight * rows[i, j] * rows[i, j]


@compiled
def inverse_squared(room, scratch, factor, spectrum, blocks, weight, stage, out):
    """A spectrum times the factor, back by one thread, squares added as `rows_back_squared` does."""
    columns_in(room, scratch, factor, spectrum, 0, blocks)
    room.half[room.columns[blocks] :] = 0
    rows_back_squared(room, scratch, weight, stage, out, 0, -(-room.nx // room.row_block))


@compiled
def columns_through(room, scratch, factor, first, last):
    """Blocks of columns: along x, times the factor, and back."""
    if room.turns.size:
        pairs_through(room, scratch, factor.real, room.columns[first], room.columns[last])
        return
    for block in range(first, last):
        _columns_forward(room, scratch, block)
        multiply(room, factor, scratch.columns_out, scratch.columns, block, 0)
        _columns_back(room, scratch, block)


@compiled
def columns_out(room, scratch, spectrum, first, last):
    """Blocks of columns into a spectrum."""
    for block in range(first, last):
        start = room.columns[block]
        _columns_forward(room, scratch, block)
        for i in range(room.columns[block + 1] - start):
            for j in range(room.lengths[block]):
                spectrum[start + i, j] = scratch.columns_out[i, j]


@compiled
def columns_in(room, scratch, factor, spectrum, first, last):
    """Blocks of columns from a spectrum times the factor."""
    for block in range(first, last):
        multiply(room, factor, spectrum, scratch.columns, block, room.columns[block])
        _columns_back(room, scratch, block)


@compiled
def terms_back(room, singles, scratch, factors, spectrum, squares, terms, share, out):
    """The terms (first, last) of a spectrum times `factors` along x, into half-way arrays of their own, and along y in
    the groups that are begun, while they are near. share : this thread's number, and of how many."""
    given, source, done = spectrum.ctypes.data, scratch.columns[0].ctypes.data, scratch.columns_out[0]
    result, (stride, itemsize), line = done.ctypes.data, spectrum.strides, squares.halves.shape[2]
    columns, lengths, scales, executor = singles.columns, singles.lengths, singles.scales, room.executors[1]
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
            for j in range(room.nx):
                half[number, j] = done[j]
        if share[0] == 0:
            half[count:] = 0
        for group in range(squares.begun.size):
            if squares.begun[group]:
                term_of_group(room, singles, squares, term, group, out)


@compiled
def term_of_group(room, singles, squares, term, group, out):
    """Rows of a group from a half-way array, destroyed there, added as `rows_back_squared` does."""
    start = group * GROUP
    count = min(room.nx, start + GROUP) - start
    rows, weight, last = squares.rows, squares.weights[term], squares.weights.size - 1
    plan = singles.rows[0 if count == GROUP else 1]
    execute(room.executors[2], plan, squares.halves[term, 0, start:].ctypes.data, rows.ctypes.data)
    for i in range(count):
        if term == 0:
            for j in range(room.ny):
                out[start + i, j] = weight * rows[i, j] * rows[i, j]
        elif term == last:
            for j in range(room.ny):
                out[start + i, j] = np.sqrt(out[start + i, j] + weight * rows[i, j] * rows[i, j])
        else:
            for j in range(room.ny):
                out[start + i, j] += weight * rows[i, j] * rows[i, j]


@compiled
def _columns_forward(room, scratch, block):
    """From the half-way array to `columns_out`."""
    start, plan = room.columns[block], room.column_plans[0, block]
    if room.whole:
        source = room.half[start:].ctypes.data
    else:
        columns = scratch.columns
        for i in range(room.columns[block + 1] - start):
            for j in range(room.nx):
                columns[i, j] = room.half[start + i, j]
            for j in range(room.nx, room.lengths[block]):
                columns[i, j] = 0
        source = columns.ctypes.data
    execute(room.executors[1], plan, source, scratch.columns_out.ctypes.data)


@compiled
def _columns_back(room, scratch, block):
    """From `columns` to the half-way array."""
    start, plan = room.columns[block], room.column_plans[1, block]
    if room.whole:
        execute(room.executors[1], plan, scratch.columns.ctypes.data, room.half[start:].ctypes.data)
        return
    execute(room.executors[1], plan, scratch.columns.ctypes.data, scratch.columns_out.ctypes.data)
    for i in range(room.columns[block + 1] - start):
        for j in range(room.nx):
            room.half[start + i, j] = scratch.columns_out[i, j]


@compiled
def multiply(room, factor, given, target, block, offset):
    """A block of columns times the factor and the inverse transform's own scale; they begin in `given` at `offset`."""
    start, count, rows = room.columns[block], room.columns[block + 1] - room.columns[block], rows_of(factor)
    source, result, scale, length = given.ctypes.data, target.ctypes.data, room.scales[block], room.lengths[block]
    for i in range(count):
        own = source + (offset + i) * given.strides[0], result + i * target.strides[0]
        multiply_column(rows, start + i, own[0], own[1], scale, length)


@compiled
def rows_of(factor):
    """A factor as `multiply_column` takes it: where its parts begin, bytes from row to row of each, parities."""
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
    """The column of a number times a factor (`rows_of` it) and a scale; `given`, `target` : addresses.

    As real numbers, two for each: a third less time than a loop of complex ones, same bits.
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
