"""Nested iteration: the solution on a coarser grid, interpolated, starts each grid.

Step 3 of `bem.contact`. The coarsest grid that is solved has 17 to 32 cells along its longer side, or 16 below a finest
grid of 31 or 32; a finest grid of up to 30 cells has no coarser one (`convolution.SMALLEST_GRID`). The square of the
pressure falls linearly to zero at the edge of a contact, and the gap outside grows like the distance to the power 3/2.
The interpolated function is therefore phi = p^2 inside and -c gap^(2/3) outside, which is smooth across the edge of an
elastic contact. Capped cells enter as the square of the cap, whatever their depth, so that the finer grid starts with a
larger violation. The interpolation changes the load of each square by its edges; load errors between squares excite
long-wavelength displacement errors, so each square of 8 x 8 coarse cells keeps its coarse-grid load, as far as a change
of its pressures by at most half allows. Squares with a cell at the cap are left as they are. A prescribed load is
restored by `Control.initial_iterate` when the finer grid starts.

Coarse grids are solved until a tenth of their first violation is left, which is what the interpolation to them cost,
but no further than the final tolerance; and in any case to 6 % of the rms gap and 6 % of the displacement, which decide
only where a first violation is above 0.6 of these, as with nearly all contact at the cap. The coarsest grid, which has
no interpolated start, has the same bounds. A result that misses its goal is still interpolated up to twice the bound of
6 %, whatever a tenth of its first violation was (`_is_useful`); beyond, it is dropped. Verified in
tests/contact/test_nested_iteration.py.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact import reductions
from bem.contact.bounds import LARGEST_CHANGE, SQUARE_SIDE, split_cells
from bem.contact.controls import Control
from bem.contact.grid_workspace import GridResult, Tolerance
from bem.contact.problem import GridProblem
from bem.contact.solve_on_grid import COARSE_TOLERANCE, Start, solve_on_grid, without_contact
from bem.threads import share

FloatArray = NDArray[np.float64]
Table = tuple[NDArray[np.int64], FloatArray]

_COARSEST = 32
"""Cells along the longer side up to which a coarse grid is not coarsened again; smaller grids save nothing."""

_COARSE_BUDGET = 0.2
"""Fraction of the remaining iterations that a coarse grid may use; a start that takes more is not worth its cost."""

_USEFUL_EXCESS = 2.0
"""Violation over the bound by `COARSE_TOLERANCE` up to which a result that did not converge is interpolated all the
same; a larger one is worse than a uniform pressure."""

COARSE_REDUCTION = 0.1
"""Fraction of the first violation that coarse grids are solved to. On large grids both that violation and the next
grid's first one are far below `COARSE_TOLERANCE`, because most of the roughness has long wavelengths."""


def start_from_coarser(problem: GridProblem, control: Control) -> Start:
    """Return the initial pressure interpolated from the next coarser grid, which is started in the same way."""
    nothing = Start(None, -math.inf)
    operator, settings = problem.operator, problem.settings
    coarse = operator.coarsened()
    if coarse is None or coarse.grid.cells == operator.grid.cells:
        return nothing
    shape, periodic = coarse.grid.shape, operator.grid.periodic
    # the units of the kernels may differ by a power of two
    factor = coarse.unit / operator.unit
    gap = sample(problem.gap.reshape(operator.grid.shape), shape, periodic)
    coarser = GridProblem(
        replace(settings, coarse_reduction=COARSE_REDUCTION), coarse, gap.reshape(-1), problem.cap * factor
    )
    prescribed = control.on_coarser(
        problem.gap,
        coarser.gap,
        force_factor=factor * operator.grid.cell_area / coarse.grid.cell_area,
        mean_free=operator.mean_free,
    )
    if without_contact(prescribed, coarser.gap) is not None:
        return nothing
    start = start_from_coarser(coarser, prescribed) if max(shape) > _COARSEST else nothing
    tolerance = max(settings.tolerance, COARSE_TOLERANCE * settings.scale)
    budget = settings.budget.part(_COARSE_BUDGET)
    limited = replace(coarser, settings=replace(coarser.settings, budget=budget))
    result = solve_on_grid(limited, prescribed, start, tolerance, guarded_rerun=False)
    settings.budget.iterations = budget.iterations
    if not _is_useful(result, settings.allowed(tolerance)):
        return nothing
    cells, pressure = prolong(
        result.pressure.reshape(shape),
        result.displacement.reshape(shape),
        gap,
        result.approach,
        coarser.cap,
        operator.grid.shape,
        periodic,
    )
    pressure /= factor
    return Start(split_cells(cells, pressure, problem.cap), result.approach)


def _is_useful(result: GridResult, allowed: Tolerance) -> bool:
    """Return True if a coarse result is worth interpolating: converged, near its goal, or the least mean gap.

    allowed : of the grid; its `coarse_reduction` has no effect here: the first violation is given as infinite.
    """
    if result.converged or result.least_found is not None or result.least_mean_gap is not None:
        return True
    displacement = float(np.abs(result.displacement).max())
    return result.violation <= _USEFUL_EXCESS * allowed.bound(result.approach, displacement, math.inf)


def _spacing(cells: int, onto: int, periodic: bool) -> float:
    """Return the spacing of `onto` points in that of `cells` points, on the same axis."""
    if periodic:
        return cells / onto
    return 0.5 if onto > cells else 2.0 if onto < cells else 1.0


@lru_cache(maxsize=64)
def interpolation(cells: int, onto: int, periodic: bool) -> Table:
    """Return four indices and weights (onto, 4) of cubic interpolation from `cells` to `onto` points along an axis.

    Periodic axes have the same length on both grids; on a free axis point k of the coarser is point 2k of the finer.
    """
    position = np.arange(onto) * _spacing(cells, onto, periodic)
    base = np.floor(position).astype(np.int64)
    t = position - base
    weights = np.stack(
        [
            -t * (t - 1) * (t - 2) / 6,
            (t + 1) * (t - 1) * (t - 2) / 2,
            -(t + 1) * t * (t - 2) / 2,
            (t + 1) * t * (t - 1) / 6,
        ],
        axis=1,
    )
    indices = base[:, None] + np.arange(-1, 3)
    indices = indices % cells if periodic else np.clip(indices, 0, cells - 1)
    indices.flags.writeable = weights.flags.writeable = False
    return indices, weights


def sample(field: FloatArray, shape: tuple[int, int], periodic: tuple[bool, bool]) -> FloatArray:
    """Restrict a field to a coarser grid: every second point, or interpolation along a periodic axis of odd length.

    Nothing is averaged, so short waves alias. On a free axis the coarse rectangle reaches half a fine cell beyond the
    fine one at the first point, because coarse point k is fine point 2k.
    """
    for axis in (0, 1):
        n, m = field.shape[axis], shape[axis]
        if n == m:
            continue
        if not periodic[axis] or n == 2 * m:
            field = field[::2] if axis == 0 else field[:, ::2]
            continue
        indices, weights = interpolation(n, m, True)
        moved = np.moveaxis(field, axis, 0)
        mixed = sum(moved[indices[:, k]] * weights[:, k, None] for k in range(4))
        field = np.moveaxis(np.asarray(mixed), 0, axis)
    return np.ascontiguousarray(field)


def prolong(
    pressure: FloatArray,
    displacement: FloatArray,
    gap: FloatArray,
    approach: float,
    cap: float,
    shape: tuple[int, int],
    periodic: tuple[bool, bool],
) -> tuple[NDArray[np.int64], FloatArray]:
    """Prolong a solution, given as arrays (nx, ny) of the coarser grid, to the finer grid `shape`.

    Returns the cell indices of the cells with pressure, and their pressures, at most the cap. A cell gets no pressure
    where none of the sixteen cells that it is interpolated from has any.
    """
    phi, marks = _evaluate_phi(pressure, displacement, gap, approach, *periodic)
    _scale_outside(phi, _edge_scale(pressure, phi, marks, cap))
    rows = interpolation(pressure.shape[0], shape[0], periodic[0])
    columns = interpolation(pressure.shape[1], shape[1], periodic[1])
    begins = _first_points(pressure.shape[1], shape[1], periodic[1])
    lines = max(1, reductions.BLOCK // shape[1])
    cells, values = np.empty(shape[0] * shape[1], np.int64), np.empty(shape[0] * shape[1])  # partly written
    parts = [slice(0)] * -(-shape[0] // lines)

    def work(_worker: int, block: int) -> None:
        first, last = block * lines, min(shape[0], (block + 1) * lines)
        part = slice(first * shape[1], last * shape[1])
        count = _prolong_phi(phi, marks, rows, (first, last), columns, begins, cap, cells[part], values[part])
        parts[block] = slice(part.start, part.start + count)

    share(work, len(parts), shape[0] * shape[1])
    if len(parts) > 1:
        cells, values = (np.concatenate([array[part] for part in parts]) for array in (cells, values))
    else:
        cells, values = cells[parts[0]].copy(), values[parts[0]].copy()
    along = [_squares_along(n, m, wraps) for n, m, wraps in zip(pressure.shape, shape, periodic, strict=True)]
    _restore_square_loads(pressure, (cells, values), shape[1], along[0], along[1], cap)
    return cells, values


@lru_cache(maxsize=64)
def _first_points(cells: int, onto: int, periodic: bool) -> NDArray[np.int64]:
    """Return the first of `onto` points at or beyond each of `cells` points along an axis, and `onto`."""
    position = np.arange(onto) * _spacing(cells, onto, periodic)
    begins = np.searchsorted(position, np.arange(cells + 1))
    begins[-1] = onto
    begins.flags.writeable = False
    return begins


class _Squares(NamedTuple):
    """Regions along an axis.

    number : of squares. coarse : square of each coarse point. first, second : squares of each fine point.
    share : weight of the second. length : spacing of fine points in that of coarse points.
    """

    number: int
    coarse: NDArray[np.int64]
    first: NDArray[np.int64]
    second: NDArray[np.int64]
    share: FloatArray
    length: float


@lru_cache(maxsize=64)
def _squares_along(cells: int, onto: int, periodic: bool) -> _Squares:
    """Assign points to squares; a fine point between two coarse points belongs to both, by linear interpolation."""
    spacing = _spacing(cells, onto, periodic)
    position = np.arange(onto) * spacing
    below = np.floor(position).astype(np.int64)
    above = (below + 1) % cells if periodic else np.minimum(below + 1, cells - 1)
    coarse = np.arange(cells) // SQUARE_SIDE
    return _Squares(int(coarse[-1]) + 1, coarse, coarse[below], coarse[above], position - below, spacing)


def _edge_scale(pressure: FloatArray, phi: FloatArray, marks: NDArray[np.uint8], cap: float) -> float:
    """Return c of phi outside: phi then has the same mean slope on both sides of the edges.

    Edges of cells at the cap do not count: the pressure does not fall to zero like a root there. Without an opening at
    an edge that counts, the slope is unknown, and c is zero: cells outside then count as closed, as at the edge.
    """
    squares, opening = _edge_means(pressure, phi, marks, cap)
    return float(squares / opening) if opening > 0 else 0.0


_NEAR_CONTACT, _IN_STENCIL = 1, 2
"""Bits of a cell's mark: a cell with pressure lies within three columns; the interpolation beyond the cell uses one."""


@compiled
def _evaluate_phi(pressure, displacement, gap, approach, wraps_x, wraps_y):
    """Return phi with c = 1 outside, and the marks; phi is zero where no cell with pressure is within three cells."""
    nx, ny = pressure.shape
    marks = np.empty((nx, ny), np.uint8)
    wide = np.zeros(ny + 6, np.uint8)  # with three columns before and behind
    for i in range(nx):
        line = pressure[i]
        for j in range(ny):
            wide[j + 3] = line[j] > 0
        if wraps_y:
            for j in range(3):
                wide[j], wide[ny + 3 + j] = wide[3 + (j - 3) % ny], wide[3 + j % ny]
        for j in range(ny):
            within = wide[j + 2] | wide[j + 3] | wide[j + 4] | wide[j + 5]
            marks[i, j] = _IN_STENCIL * within | wide[j] | wide[j + 1] | within | wide[j + 6]
    phi = np.empty((nx, ny))
    near = np.empty(ny, np.uint8)
    for i in range(nx):
        near[:] = 0
        for k in range(i - 3, i + 4):
            if 0 <= k < nx or wraps_x:
                line = marks[k % nx]
                for j in range(ny):
                    near[j] |= line[j]
        for j in range(ny):
            p = pressure[i, j]
            if p > 0:
                phi[i, j] = p * p
            elif near[j]:
                phi[i, j] = -(max(gap[i, j] + displacement[i, j] - approach, 0.0) ** (2.0 / 3.0))
            else:
                phi[i, j] = 0.0
    return phi, marks


@compiled
def _edge_means(pressure, phi, marks, cap):
    """Return the sums of p^2 and of -phi over the links from cells between the bounds to cells without pressure."""
    nx, ny = pressure.shape
    squares = 0.0
    opening = 0.0
    for i in range(nx):
        for j in range(ny):
            if marks[i, j] | marks[min(i + 1, nx - 1), j] == 0:
                continue
            p = pressure[i, j]
            for axis in range(2):
                k = i + (axis == 0)
                m = j + (axis == 1)
                if k == nx or m == ny:
                    continue
                q = pressure[k, m]
                if p > 0 and p < cap and q <= 0:
                    squares += p * p
                    opening -= phi[k, m]
                elif q > 0 and q < cap and p <= 0:
                    squares += q * q
                    opening -= phi[i, j]
    return squares, opening


@compiled
def _scale_outside(phi, scale):
    """Multiply phi outside by c."""
    phi = phi.reshape(-1)
    for cell in range(phi.size):
        phi[cell] *= scale if phi[cell] < 0 else 1.0


@compiled
def _prolong_phi(phi, marks, rows, lines, columns, begins, cap, cells, values):
    """Write the cells with pressure on some lines of the finer grid and their pressures; return their number."""
    (rows, row_weights), (columns, column_weights) = rows, columns
    width, ny = phi.shape[1], columns.shape[0]
    line = np.empty(width)
    within = np.zeros(8 * ((width + 7) // 8), np.uint8)
    words = within.view(np.uint64)
    count = 0
    for i in range(*lines):
        a, b, c, d = rows[i, 0], rows[i, 1], rows[i, 2], rows[i, 3]
        u, v, w, x = row_weights[i, 0], row_weights[i, 1], row_weights[i, 2], row_weights[i, 3]
        for j in range(width):
            line[j] = u * phi[a, j] + v * phi[b, j] + w * phi[c, j] + x * phi[d, j]
            within[j] = (marks[a, j] | marks[b, j] | marks[c, j] | marks[d, j]) & _IN_STENCIL
        for word in range(words.size):
            if words[word] == 0:
                continue
            for k in range(8 * word, min(8 * word + 8, width)):
                begin = begins[k]
                if within[k] == 0 or begin == begins[k + 1]:
                    continue
                # all points up to the next coarse column use the same four values
                e, f = line[columns[begin, 0]], line[columns[begin, 1]]
                g, h = line[columns[begin, 2]], line[columns[begin, 3]]
                for j in range(begin, begins[k + 1]):
                    value = (
                        column_weights[j, 0] * e
                        + column_weights[j, 1] * f
                        + column_weights[j, 2] * g
                        + column_weights[j, 3] * h
                    )
                    if value > 0:
                        cells[count] = i * ny + j
                        values[count] = min(np.sqrt(value), cap)
                        count += 1
    return count


@compiled
def _restore_square_loads(pressure, fine, width, rows, columns, cap):
    """Scale each square without a cell at the cap on the finer grid to its load on the coarser one, by at most half.

    fine : cells of the finer grid, which has `width` columns, and their pressures.
    """
    cells, values = fine
    missing = np.zeros((rows.number, columns.number))
    inside = np.zeros(missing.shape)
    for i in range(pressure.shape[0]):
        square = missing[rows.coarse[i]]
        for j in range(pressure.shape[1]):
            if pressure[i, j] != 0:
                square[columns.coarse[j]] += pressure[i, j]
    cell_fraction = rows.length * columns.length
    i = 0
    for n in range(cells.size):
        while cells[n] >= (i + 1) * width:
            i += 1
        j = cells[n] - i * width
        a, b, s = rows.first[i], rows.second[i], rows.share[i]
        c, d, t = columns.first[j], columns.second[j], columns.share[j]
        p = values[n] * cell_fraction
        if a == b and c == d:  # nearly always
            rest = missing[a, c] - (1 - s) * (1 - t) * p
            missing[a, c] = rest - (1 - s) * t * p - s * (1 - t) * p - s * t * p
        else:
            missing[a, c] -= (1 - s) * (1 - t) * p
            missing[a, d] -= (1 - s) * t * p
            missing[b, c] -= s * (1 - t) * p
            missing[b, d] -= s * t * p
        inside[a, c] += p if values[n] < cap else -np.inf
    factor = np.empty(missing.shape)
    for i in range(rows.number):
        for j in range(columns.number):
            change = missing[i, j] / inside[i, j] if inside[i, j] > 0 else 0.0
            factor[i, j] = 1 + max(-LARGEST_CHANGE, min(LARGEST_CHANGE, change))
    i = 0
    for n in range(cells.size):
        while cells[n] >= (i + 1) * width:
            i += 1
        j = cells[n] - i * width
        values[n] = min(values[n] * factor[rows.first[i], columns.first[j]], cap)
