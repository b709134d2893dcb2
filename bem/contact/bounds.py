"""Pressures within the bounds 0 <= p <= cap: active sets, projections and the removal of tension.

Step 10 of `bem.contact`, and the merging and blending of sets in steps 7 and 8. An `Iterate` stores a feasible pressure
as the cells strictly between the bounds, their values, and the cells at the cap. Trial pressures of the linear solver
leave the bounds. One of the first two operations prepares them, and one of the last two brings them back:

- `redistribute_clipped_load` scales the values between the bounds so that each square of 8 x 8 cells will keep its
  load when it is clipped, as far as a change of at most half allows, because load that moves across the surface excites
  long-wavelength displacement errors; it does not clip;
- `eliminate_tension` sets negative pressures to zero and corrects their neighbours with the sparse approximate
  inverse, which is the projection in the energy norm as far as near neighbours reach;
- `clip_to_bounds` clips, where no load is prescribed;
- `clip_to_load` clips and scales or, with a hardness, calls `shift_to_sum`, the Euclidean projection onto the bounds
  and a prescribed sum.

Verified in tests/contact/test_contact_reductions.py and tests/contact/test_tension_elimination.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact import reductions
from bem.contact.cell_states import CAPPED
from bem.contact.sparse_inverse import NEIGHBOURS, SparseInverseOnCells

FloatArray = NDArray[np.float64]
Indices = NDArray[np.int64]

SQUARE_SIDE = 8
"""Cells along the side of a square that keeps its load when pressures are clipped."""

LARGEST_CHANGE = 0.5
"""Largest relative change of the pressures of a square that makes up for clipped load."""

_TENSION_ITERATIONS = 2
"""CG iterations of the tension elimination; the matrix is close to its diagonal."""


@dataclass
class Iterate:
    """Feasible pressure.

    cells : (n,), ascending cell indices of the cells between the bounds; of all active cells after an activation, which
        adds cells exactly at a bound, and of all cells of a uniform first pressure.
    values : (n,), their pressures.
    capped : (m,), ascending cell indices of the cells at the cap.
    """

    cells: Indices
    values: FloatArray
    capped: Indices

    def as_field(self, size: int, cap: float) -> FloatArray:
        """Return the pressure as a one-dimensional field of `size` cells."""
        field = np.empty(size)
        reductions.scatter(field, self.cells, self.values, self.capped, cap)
        return field


def split_field(pressure: FloatArray, cap: float) -> Iterate:
    """Split a feasible field (one-dimensional) by its bounds."""
    return Iterate(*split_by_bounds(pressure, cap))


def split_cells(cells: Indices, values: FloatArray, cap: float) -> Iterate:
    """Split positive pressures on listed cells into cells below and at the cap."""
    capped = values >= cap
    if not capped.any():
        return Iterate(cells, values, cells[:0])
    return Iterate(cells[~capped], values[~capped], cells[capped])


def loaded_cells(iterate: Iterate, cap: float) -> tuple[Indices, FloatArray]:
    """Return all cells with pressure in ascending order, capped cells included, and their pressures."""
    return _with_capped(iterate.cells, iterate.values, iterate.capped, cap)


def _with_capped(cells: Indices, values: FloatArray, capped: Indices, cap: float) -> tuple[Indices, FloatArray]:
    """Return cells and capped cells in one ascending list, and their pressures."""
    if capped.size == 0:
        return cells, values
    cells = np.concatenate([cells, capped])
    values = np.concatenate([values, np.full(capped.size, cap)])
    order = np.argsort(cells, kind="stable")
    return cells[order], values[order]


def clip_to_bounds(iterate: Iterate, trial: FloatArray, cap: float) -> Iterate:
    """Make cells whose trial pressures leave the bounds open or capped."""
    below, above = trial <= 0, trial >= cap
    if not (below.any() or above.any()):
        return Iterate(iterate.cells, trial, iterate.capped)
    inside = ~(below | above)
    capped = np.sort(np.concatenate([iterate.capped, iterate.cells[above]])) if above.any() else iterate.capped
    return Iterate(iterate.cells[inside], trial[inside], capped)


def clip_to_load(iterate: Iterate, trial: FloatArray, cap: float, force: float, size: int) -> Iterate:
    """Bring trial pressures within the bounds and their sum, the cells at the cap included, to `force`.

    Without a hardness the trial is clipped, then all pressures are scaled. With a hardness the unclipped trial is
    shifted by one constant, then clipped, on the active cells; cells at the cap keep it where that suffices. If the
    capped cells carry more than the load, or the active ones cannot carry the rest, the capped cells are shifted too.
    If all of these at the cap carry less than the load, all cells of the grid are shifted, and open cells may get
    pressure. `size` is the number of cells of the grid.
    """
    cells, capped = iterate.cells, iterate.capped
    if math.isinf(cap):
        cells, trial, total = keep_positive(cells, trial)
        return Iterate(cells, trial * (force / total), capped)
    missing = force - cap * capped.size
    if not 0 <= missing <= cap * cells.size:
        # the capped cells carry too much, or the others cannot carry the rest: shift all of them
        cells, trial = _with_capped(cells, trial, capped, cap)
        capped = np.empty(0, np.int64)
        missing = force
        if missing > cap * cells.size:
            field = np.zeros(size)
            field[cells] = trial
            cells, trial = np.arange(size), field
    values = shift_to_sum(trial, missing, cap)
    above = values >= cap
    inside = (values > 0) & ~above
    if above.any():
        capped = np.sort(np.concatenate([capped, cells[above]]))
    return Iterate(cells[inside], values[inside], capped)


def shift_to_sum(trial: FloatArray, total: float, cap: float) -> FloatArray:
    """Return clip(trial + s, 0, cap) with the shift s that gives the sum `total`, which the bounds must allow.

    A safeguarded Newton iteration solves the piecewise linear equation for s. The values are measured from their
    maximum, so that s keeps all its digits however small the sum is.
    """
    if not total > 0:
        return np.zeros(trial.size)
    top = float(trial.max())
    shifted = trial - top
    high = cap - float(shifted.min())
    shifted += reductions.shift_to(shifted, max(top, 0.0), high, float(total), float(cap), reductions.BLOCK)
    return np.clip(shifted, 0.0, cap, out=shifted)


def shift_full_contact(iterate: Iterate, mean_gap: float, cap: float) -> Iterate | None:
    """Shift the pressure of doubly periodic full contact uniformly until one cell reaches a bound.

    A uniform pressure leaves the displacement unchanged, so only a cell that leaves the set can correct `mean_gap`.
    Returns None if a cell is at the bound already.
    """
    values = iterate.values
    first, bound = (values.min(), 0.0) if mean_gap > 0 else (values.max(), cap)
    if first == bound:
        return None
    values = bound + (values - first)
    inside = (values > 0) & (values < cap)
    return Iterate(iterate.cells[inside], values[inside], iterate.cells[values >= cap])


def eliminate_tension(inverse: SparseInverseOnCells, pressure: FloatArray) -> None:
    """Set negative pressures (n,) to zero and correct their neighbours, in place.

    Let p close the gap on the cells F + A and be negative on A. On F alone the gap is closed by p - B y with B y = p on
    A, where B is the inverse of the kernel on F + A. The sparse inverse G^T G stands for B; long wavelengths are left
    to the next outer iteration. Neighbours that become negative join A once.
    """
    _eliminate_tension(inverse.rows, pressure, _TENSION_ITERATIONS)


@compiled
def merge(old, found, state, cap, surface):
    """Add the cells `found` to the active cells (both ascending).

    old : (cells, values). found : open cells (pressure zero) and capped cells (pressure `cap`), as `state` says.
    surface : (displacement, gap, approach). Returns the cells, their values, their gaps and the mean gap.
    """
    cells, values = old
    displacement, gap, approach = surface
    count = cells.size + found.size
    all_cells, all_values, residual = np.empty(count, np.int64), np.empty(count), np.empty(count)
    a = 0
    b = 0
    total = 0.0
    for k in range(count):
        if b == found.size or (a < cells.size and cells[a] < found[b]):
            c = np.uint64(cells[a])
            all_values[k] = values[a]
            a += 1
        else:
            c = np.uint64(found[b])
            all_values[k] = cap if state[c] == CAPPED else 0.0
            b += 1
        all_cells[k] = c
        opening = gap[c] + displacement[c] - approach
        residual[k] = opening
        total += opening
    return all_cells, all_values, residual, total / max(1, count)


@compiled
def blend(old, new, fraction, cap):
    """Return (1 - fraction) old + fraction new of two pressures (cells, values) with ascending cells.

    A cell at the cap in both stays exactly there; cells without pressure are left out.
    """
    cells, values = old
    more, more_values = new
    count = cells.size + more.size
    both, mixed = np.empty(count, np.int64), np.empty(count)
    a = 0
    b = 0
    k = 0
    while a < cells.size or b < more.size:
        from_old = b == more.size or (a < cells.size and cells[a] <= more[b])
        from_new = a == cells.size or (b < more.size and more[b] <= cells[a])
        both[k] = cells[a] if from_old else more[b]
        value = 0.0
        if from_old:
            value = values[a] * (1 - fraction)
        if from_new:
            value += fraction * more_values[b]
        if from_old and from_new and values[a] == cap and more_values[b] == cap:
            value = cap
        mixed[k] = value
        a += from_old
        b += from_new
        k += value > 0
    return both[:k].copy(), mixed[:k].copy()


@compiled
def mix(start, stop, result, displacement, earlier, fraction):
    """Blend two displacements: fraction * displacement + (1 - fraction) * earlier."""
    displacement, earlier = displacement[start:stop], earlier[start:stop]
    rest = 1 - fraction
    for k in range(displacement.size):
        displacement[k] = displacement[k] * fraction + earlier[k] * rest


@compiled
def descend(start, stop, result, displacement, gap, approach, step, out):
    """Write the step of steepest descent, -step * (gap + displacement - approach)."""
    displacement, gap, out = displacement[start:stop], gap[start:stop], out[start:stop]
    for k in range(out.size):
        out[k] = -(step * (gap[k] + displacement[k] - approach))


@compiled
def split_by_bounds(pressure, cap):
    """Return the cells between the bounds, their pressures, and the cells at the cap."""
    inside, capped = 0, 0
    for k in range(pressure.size):
        inside += pressure[k] > 0
        capped += pressure[k] >= cap
    inside -= capped
    cells, values, others = np.empty(inside, np.int64), np.empty(inside), np.empty(capped, np.int64)
    a = 0
    b = 0
    for k in range(pressure.size):
        p = pressure[k]
        if p >= cap:
            others[b] = k
            b += 1
        elif p > 0:
            cells[a] = k
            values[a] = p
            a += 1
    return cells, values, others


@compiled
def keep_positive(cells, values):
    """Return the cells with positive values, these values and their sum; copies only if a cell is dropped."""
    kept = 0
    total = 0.0
    for k in range(cells.size):
        if values[k] > 0:
            kept += 1
            total += values[k]
    if kept == cells.size:
        return cells, values, total
    kept_cells, kept_values = np.empty(kept, cells.dtype), np.empty(kept)
    kept = 0
    for k in range(cells.size):
        if values[k] > 0:
            kept_cells[kept] = cells[k]
            kept_values[kept] = values[k]
            kept += 1
    return kept_cells, kept_values, total


@compiled
def redistribute_clipped_load(cells, values, cap, shape, side):
    """Scale the values between the bounds so that clipping changes the load of each square as little as possible.

    The values of a square of `side` x `side` cells change by at most half (`LARGEST_CHANGE`), and its load is kept as
    far as that allows. A square without a value between the bounds stays as it is. Scaled values may exceed the cap;
    the caller clips them. The cells ascend, so a square is looked up once for all cells of its row.
    """
    ny, across = shape[1], (shape[1] - 1) // side + 1
    outside = 0
    for k in range(cells.size):
        outside += not 0 <= values[k] < cap
    if outside == 0:
        return
    excess = np.zeros(((shape[0] - 1) // side + 1) * across)
    inside = np.zeros(excess.size)
    squares = np.empty(cells.size, np.int32)
    row, first, stop, b = 0, 0, 0, np.uint64(0)
    for k in range(cells.size):
        cell = cells[k]
        if cell >= stop:
            while cell >= first + ny:
                row += 1
                first += ny
            column = np.uint64(cell - first) // np.uint64(side)
            b = np.uint64(row // side * across) + column
            stop = first + min(ny, np.int64(column + np.uint64(1)) * side)
        squares[k] = b
        value = values[k]
        if value <= 0:
            excess[b] -= value
        elif value >= cap:
            excess[b] += cap - value
        else:
            inside[b] += value
    for square in range(excess.size):
        change = excess[square] / inside[square] if inside[square] > 0 else 0.0
        excess[square] = 1 - max(-LARGEST_CHANGE, min(LARGEST_CHANGE, change))
    for k in range(cells.size):
        if 0 < values[k] < cap:
            values[k] *= excess[np.uint64(squares[k])]


@compiled
def _eliminate_tension(rows, pressure, iterations):
    tensile = np.empty(pressure.size, np.uint8)
    count = 0
    for k in range(tensile.size):
        tensile[k] = pressure[k] < 0
        count += tensile[k]
    if count == 0:
        return
    fields = np.zeros(pressure.size), np.zeros(pressure.size), np.zeros(pressure.size)
    correction = fields[2]
    _correct_neighbours(rows, tensile, count, pressure, iterations, fields)
    added = 0
    for k in range(tensile.size):
        below = (pressure[k] < correction[k]) & (tensile[k] == 0)
        tensile[k] |= below
        added += below
    if added:
        _correct_neighbours(rows, tensile, count + added, pressure, iterations, fields)
    for k in range(pressure.size):
        pressure[k] = 0.0 if tensile[k] else pressure[k] - correction[k]


@compiled
def _correct_neighbours(rows, tensile, count, pressure, iterations, fields):
    """Improve B y towards the pressures of the `count` tensile cells by conjugate gradients.

    fields : a direction of y and the response to it (both zero before and after), and B y (updated).
    """
    field, response, correction = fields
    listed = _rows_reaching(rows, tensile)
    cells, residual = np.empty(count, np.int64), np.empty(count)
    a, squares = 0, 0.0
    for k in range(tensile.size):
        if tensile[k]:
            cells[a], residual[a] = k, pressure[k] - correction[k]
            squares += residual[a] ** 2
            a += 1
    direction = residual.copy()
    for _ in range(iterations):
        if not squares > 0:
            break
        for a in range(count):
            field[cells[a]] = direction[a]
        _add_response(rows, listed, field, response)
        curvature = 0.0
        for a in range(count):
            curvature += direction[a] * response[cells[a]]
        step, last, squares = squares / curvature, squares, 0.0
        for a in range(count):
            residual[a] -= step * response[cells[a]]
            squares += residual[a] ** 2
        for k in range(correction.size):
            correction[k] += step * response[k]
            response[k] = 0.0
        for a in range(count):
            direction[a] = residual[a] + squares / last * direction[a]
    for a in range(count):
        field[cells[a]] = 0.0


@compiled
def _rows_reaching(rows, marked):
    """Return the numbers of the rows of G that couple to a marked cell."""
    columns = rows.columns.reshape(-1)
    listed, count = np.empty(marked.size, np.int32), 0
    for k in range(marked.size):
        reached, first = marked[k], np.uint64(k) * np.uint64(NEIGHBOURS)
        for a in range(NEIGHBOURS):
            reached |= marked[np.uint64(columns[first + np.uint64(a)])]
        listed[count] = k
        count += reached
    return listed[:count]


@compiled
def _add_response(rows, listed, field, response):
    """Add G^T G field to `response`, over the listed rows."""
    columns, pattern, table = rows
    for r in range(listed.size):
        k = np.uint64(listed[r])
        row = np.uint64(pattern[k])
        s = table[row, NEIGHBOURS] * field[k]
        for a in range(NEIGHBOURS):
            s += table[row, a] * field[np.uint64(columns[k, a])]
        for a in range(NEIGHBOURS):
            response[np.uint64(columns[k, a])] += table[row, a] * s
        response[k] += table[row, NEIGHBOURS] * s
