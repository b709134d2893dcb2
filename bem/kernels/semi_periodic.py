"""Homogeneous half-space with one free and one periodic axis: a loaded cell and all its images, summed to round-off.

Lengths are in periods; f is the offset along the free axis, a the offset along the period.

1. Near images: the loaded cell in closed form (`half_space`, `subsurface`), and its two neighbours too, unless cells
   are at most 1/16 of a period along both axes and the grid is not longer than 6.5 periods.
2. Tail: the other images form a function of (f, a) that is smooth on the scale of the period. It is sampled at
   Chebyshev nodes along the period (`_interpolation_along_period`), and along the free axis at Chebyshev nodes of
   panels (`_panels_along_free_axis`) or, if cells are longer than half a period or the grid is longer than 6.5 periods,
   at Gauss nodes over each cell. Weights turn the samples into means over cells.
3. A sample of the tail is a sum over k = 1 (or 2), 2, 3, ... of point forces at +-k periods (`_add_tail`): explicit up
   to k = 9, then the integral from k = 9.5 to infinity by a Gauss rule in a variable in which the integrand is
   analytic, plus the Euler-Maclaurin terms of the midpoint rule, from samples around the lower end in place of
   derivatives (`euler_maclaurin`).
4. Far away: parts of a cell more than 6.5 periods away, along the free axis or in depth, act as a line load, with an
   error of exp(-2 pi 6.5) = 2e-18. There the plane-strain forms of `half_plane` are used.
5. Offsets beyond half a period follow by parity (`_coefficients`).

Cost: a closed form or Gauss rule for each cell and near image, and a fixed number of samples for each panel, or for
each cell along the free axis.

Datum of the displacement. Under pressure the mean along the periodic axis is that of a line load, -2 P / (pi E*) ln|x /
reference|, P per unit length: it grows without bound and has no natural zero. The reference length taken here is the
length of the grid along its free axis, so that scaling a problem scales its answer, and the operator stays positive
definite. A different reference length adds a constant to the displacement, proportional to the load. Under traction the
mean is antisymmetric about the cell (it rises from -c to c across the cell if x is free, and is 0 if y is free).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray, Grid
from bem.kernels import half_space, subsurface
from bem.kernels.blocks import BLOCK, X_AT, Y_AT, begin_block
from bem.kernels.cell_rules import NODES, WEIGHTS
from bem.kernels.euler_maclaurin import euler_maclaurin
from bem.kernels.half_plane import add_strip, log_strip
from bem.kernels.loads import IN_PLANE_PARITY, STRESS_PARITY, SURFACE_PARITY, Load, clear_odd_offsets
from bem.materials import Material

_LINE_LOAD_DISTANCE = 6.5
"""Distance in periods from which the images act as a line load: exp(-2 pi 6.5) = 2e-18."""
_FIRST_INTEGRATED = 10
"""Number of the first image that is summed by the integral."""
_SPAN = 2.0
"""Half width, in periods, of the samples for the Euler-Maclaurin terms."""
_EULER_POINTS = 16
_GAUSS_POINTS = 24
_MANY_CELLS = 16
"""Cells in a period, along both axes, from which the neighbouring images belong to a tail that is sampled at panels."""


_EULER_NODES, _EULER_WEIGHTS = euler_maclaurin(_EULER_POINTS, int(_SPAN))
_LEGENDRE = np.polynomial.legendre.leggauss(_GAUSS_POINTS)
_TAIL_NODES = 0.5 * (_LEGENDRE[0] + 1)
_TAIL_WEIGHTS = 0.5 * _LEGENDRE[1]

_STRESS, _PRESSURE_DISPLACEMENT, _TRACTION_DISPLACEMENT, _IN_PLANE = 0, 1, 2, 3
"""Kind of summand: 2 pi times six stresses; V, integral of 1/r; chi_x (see `half_space`); integrals of f^2/r^3 and
f a/r^3, of which, with V, in-plane displacements are combined."""


class _Summand(NamedTuple):
    """Response that is summed over images, and its load; lengths in periods.

    kind : kind of summand.
    swap : True if the periodic axis is x.
    z, nu : depth, and Poisson's ratio.
    pressure, traction : load.
    reference : distance at which the displacement of a line load is zero.
    first : number of the nearest image that belongs to the tail.
    """

    kind: int
    swap: bool
    z: float
    nu: float
    pressure: float
    traction: float
    reference: float
    first: int


class _Cells(NamedTuple):
    """Cells of the grid: sides along the free axis and along the period [periods], Gauss points over a piece."""

    step: float
    step_along: float
    points: int


class _Means(NamedTuple):
    """Weights that turn samples along the period into means over cells.

    nodes : (nodes,), positions of the samples along the period.
    even, odd : (nodes, cells), weights for even and for odd functions.
    parity : (parts,), parity of each part along the period.
    """

    nodes: FloatArray
    even: FloatArray
    odd: FloatArray
    parity: FloatArray


@compiled
def _add_pair(summand: _Summand, shift: float, weight: float, count: int, scratch: FloatArray) -> None:
    """Add `weight` times the responses to point forces at +-`shift` along the period to the sums of a block."""
    if summand.kind == _STRESS:
        pressure, traction = weight * summand.pressure, weight * summand.traction
        for side in (-1.0, 1.0):
            at = -side * shift
            right, on = (at, 0.0) if summand.swap else (0.0, at)
            subsurface.add_points(right, on, summand.z, summand.nu, pressure, traction, count, scratch)
        return
    for k in range(count):
        x, y = scratch[X_AT + k], scratch[Y_AT + k]
        free, along = (y, x) if summand.swap else (x, y)
        plus = (along + shift) ** 2 + free * free
        minus = (along - shift) ** 2 + free * free
        if summand.kind == _PRESSURE_DISPLACEMENT:
            scratch[k] += weight * (1.0 / np.sqrt(plus) + 1.0 / np.sqrt(minus))
        elif summand.kind == _IN_PLANE:
            one, other = weight * free / (plus * np.sqrt(plus)), weight * free / (minus * np.sqrt(minus))
            scratch[k] += free * (one + other)
            scratch[BLOCK + k] += one * (along + shift) + other * (along - shift)
        elif summand.swap:
            scratch[k] += weight * 2.0 * along * (along * along + free * free - shift * shift) / (plus * minus)
        else:
            scratch[k] += weight * free * (1.0 / plus + 1.0 / minus)


@compiled
def _add_tail(
    summand: _Summand, free: float, along: FloatArray, weight: float, scratch: FloatArray, out: FloatArray
) -> None:
    """Add the responses to the point forces at +-k periods, k >= first, to `out` (parts, points).

    free, along : offset along the free axis, and (points,) offsets along the period.
    """
    count = along.size
    across = np.full(count, free)
    if summand.swap:
        begin_block(along, across, scratch)
    else:
        begin_block(across, along, scratch)
    for k in range(summand.first, _FIRST_INTEGRATED):
        _add_pair(summand, float(k), weight, count, scratch)
    start = _FIRST_INTEGRATED - 0.5
    for i in range(_EULER_NODES.size):
        t = _EULER_NODES[i]
        w = weight * _EULER_WEIGHTS[i]
        _add_pair(summand, start + t, w, count, scratch)
        _add_pair(summand, start - t, -w, count, scratch)
    _add_integral(summand, start, free, along, weight, scratch)
    for c in range(out.shape[0]):
        for k in range(count):
            out[c, k] += scratch[c * BLOCK + k]


@compiled
def _add_integral(
    summand: _Summand, start: float, free: float, along: FloatArray, weight: float, scratch: FloatArray
) -> None:
    """Add the integral of the pairs of point forces over k from `start` to infinity to the sums of a block."""
    if summand.kind == _PRESSURE_DISPLACEMENT:
        for k in range(along.size):
            for t in (start + along[k], start - along[k]):
                scratch[k] -= weight * np.log((t + np.sqrt(t * t + free * free)) / summand.reference)
        return
    stretch = np.sqrt(start * start + free * free + summand.z * summand.z)
    for i in range(_TAIL_NODES.size):
        left = 1.0 - _TAIL_NODES[i]
        w = weight * _TAIL_WEIGHTS[i] * stretch / (left * left)
        _add_pair(summand, start + stretch * _TAIL_NODES[i] / left, w, along.size, scratch)


@compiled
def _add_line_load(
    summand: _Summand, free: float, half: float, fraction: float, out: FloatArray, strip: FloatArray
) -> None:
    """Add 2 pi times the stress (or V, or chi_x) of a strip |free'| < half; `fraction`: loaded fraction of a period."""
    if summand.kind == _STRESS:
        strip[:] = 0.0
        across = 0.0 if summand.swap else summand.traction
        add_strip(free, summand.z, half, summand.nu, summand.pressure, across, summand.traction - across, strip)
        # the strip's x is the free axis
        x, y = (1, 0) if summand.swap else (0, 1)
        out[0] += 2.0 * fraction * strip[x]
        out[1] += 2.0 * fraction * strip[y]
        out[2] += 2.0 * fraction * strip[2]
        out[3] += 2.0 * fraction * strip[3 + x]
        out[4] += 2.0 * fraction * strip[3 + y]
        out[5] += 2.0 * fraction * strip[5]
    elif summand.kind == _PRESSURE_DISPLACEMENT:
        out[0] -= 2.0 * fraction * summand.reference * log_strip(free / summand.reference, half / summand.reference)
    elif summand.kind == _IN_PLANE:
        out[0] += 4.0 * fraction * half
    elif not summand.swap:
        out[0] += fraction * np.pi * 2.0 * min(max(free, -half), half)


@compiled
def _add_cell(
    summand: _Summand,
    free: float,
    along: FloatArray,
    half: float,
    half_along: float,
    scratch: FloatArray,
    out: FloatArray,
) -> None:
    """Add the response to one uniformly loaded cell of half sides `half`, `half_along` to `out` (parts, points)."""
    across = np.full(along.size, free)
    x, y, a, b = (along, across, half_along, half) if summand.swap else (across, along, half, half_along)
    if summand.kind == _STRESS:
        subsurface.add_rectangles(x, y, summand.z, a, b, summand.nu, summand.pressure, summand.traction, scratch, out)
        return
    displacement = np.zeros(3)
    if summand.kind == _IN_PLANE:
        for k in range(along.size):
            # at nu = 1, traction along the free axis: 4 pi G u = 2 (integral of f^2 / r^3, of f a / r^3)
            displacement[:] = 0.0
            half_space.add_rectangle(free, along[k], summand.z, half, half_along, 1.0, True, displacement)
            out[0, k] += 0.5 * displacement[0]
            out[1, k] += 0.5 * displacement[1]
        return
    for k in range(along.size):
        # at nu = 0: 4 pi G uz = 2 V under pressure, chi_x under traction
        displacement[:] = 0.0
        half_space.add_rectangle(x[k], y[k], summand.z, a, b, 0.0, summand.kind == _TRACTION_DISPLACEMENT, displacement)
        out[0, k] += 0.5 * displacement[2] if summand.kind == _PRESSURE_DISPLACEMENT else displacement[2]


@compiled
def _part_of_cell_near(summand: _Summand, free: float, half: float) -> tuple[float, float]:
    """Return the ends of the part of a cell within `_LINE_LOAD_DISTANCE`; no part if the ends coincide.

    free : offset from the cell. half : half side. The ends are positions in the cell, from -half to half.
    """
    reach = np.sqrt(max(_LINE_LOAD_DISTANCE * _LINE_LOAD_DISTANCE - summand.z * summand.z, 0.0))
    return min(max(free - reach, -half), half), min(max(free + reach, -half), half)


@compiled
def _sample_tail_over_cell(
    summand: _Summand, cells: _Cells, free: float, ends: tuple[float, float], nodes: FloatArray, scratch: FloatArray,
    out: FloatArray,
) -> None:  # fmt: skip
    """Add the integral of the tail over the part of a cell between `ends`, at the nodes, to `out` (parts, nodes)."""
    low, high = ends
    pieces = int(np.ceil((high - low) / 0.5))
    width = (high - low) / pieces
    for piece in range(pieces):
        centre = low + (piece + 0.5) * width
        for g in range(cells.points):
            source = centre + 0.5 * width * NODES[cells.points, g]
            _add_tail(summand, free - source, nodes, width * WEIGHTS[cells.points, g], scratch, out)


@compiled
def _add_means(means: _Means, samples: FloatArray, row: FloatArray) -> None:
    """Add the means over cells of a function sampled at the nodes, (parts, nodes), to `row` (parts, cells)."""
    for c in range(row.shape[0]):
        for n in range(means.nodes.size):
            value = samples[c, n]
            shape = means.even[n] if means.parity[c] > 0 else means.odd[n]
            for j in range(row.shape[1]):
                row[c, j] += value * shape[j]


@compiled
def _fill_coefficients(summand: _Summand, cells: _Cells, means: _Means, tail: FloatArray, out: FloatArray) -> None:
    """Compute the coefficients at offsets up to half a period.

    tail : (parts, free offsets, nodes), integrals of the tail over cells; no free offsets if they are to be sampled
    here.
    out : (parts, free offsets, offsets along the period).
    """
    parts = out.shape[0]
    half = 0.5 * cells.step
    samples = np.zeros((parts, means.nodes.size))
    line = np.zeros(parts)
    strip = np.zeros(6)
    scratch = np.zeros(8 * BLOCK)
    row = np.zeros((parts, out.shape[2]))
    offsets = np.arange(out.shape[2]) * cells.step_along
    for i in range(out.shape[1]):
        free = i * cells.step
        low, high = _part_of_cell_near(summand, free, half)
        line[:] = 0.0
        for start, stop in ((-half, low), (high, half)):  # strips on either side
            if stop > start:
                _add_line_load(
                    summand, free - 0.5 * (start + stop), 0.5 * (stop - start), cells.step_along, line, strip
                )
        for c in range(parts):
            out[c, i, :] = line[c]
        if not high > low:
            continue
        if tail.shape[1] > 0:
            samples[:] = tail[:, i, :]
        else:
            samples[:] = 0.0
            _sample_tail_over_cell(summand, cells, free, (low, high), means.nodes, scratch, samples)
        middle = 0.5 * (low + high)
        row[:] = 0.0
        for k in range(1 - summand.first, summand.first):
            _add_cell(summand, free - middle, offsets + k, 0.5 * (high - low), 0.5 * cells.step_along, scratch, row)
        _add_means(means, samples, row)
        for c in range(parts):
            for j in range(row.shape[1]):
                out[c, i, j] += row[c, j]


@compiled
def _sample_tail(
    summand: _Summand, free_nodes: FloatArray, free_means: FloatArray, nodes: FloatArray, out: FloatArray
) -> None:
    """Add the integrals of the tail over each cell along the free axis to `out` (parts, free offsets, nodes).

    free_nodes : (samples,), positions of the samples along the free axis.
    free_means : (free offsets, samples), weights from `_panels_along_free_axis`.
    nodes : (nodes,), positions along the period.
    """
    parts = out.shape[0]
    samples = np.zeros((parts, nodes.size))
    scratch = np.zeros(8 * BLOCK)
    for s in range(free_nodes.size):
        samples[:] = 0.0
        _add_tail(summand, free_nodes[s], nodes, 1.0, scratch, samples)
        for i in range(out.shape[1]):
            w = free_means[i, s]
            if w != 0.0:
                for c in range(parts):
                    for n in range(nodes.size):
                        out[c, i, n] += w * samples[c, n]


def _panels_along_free_axis(cells: int, step: float, points: int, first: int) -> tuple[FloatArray, FloatArray]:
    """Return Chebyshev nodes of panels along the free axis, and weights (cells, nodes) of integrals over each cell.

    A panel is at most as long as the distance to the nearest image of the tail: 24 nodes reach round-off.
    """
    length = cells * step
    count = int(np.ceil(length / (first - 0.5 if first == 1 else 1.0)))
    width = length / count
    order = 24
    angles = (np.arange(order) + 0.5) * np.pi / order
    nodes = (-0.5 * step + (np.arange(count)[:, None] + 0.5 + 0.5 * np.cos(angles)) * width).ravel()
    at = (np.arange(cells)[:, None] + 0.5 * (1 + NODES[points, :points])) * step
    panel = np.minimum((at / width).astype(np.int64), count - 1)
    inside = np.clip(2 * (at / width - panel) - 1, -1, 1)
    orders = np.arange(order)
    scale = np.full(order, 2.0 / order)
    scale[0] *= 0.5
    basis = np.cos(orders * np.arccos(inside)[..., None])
    cardinal = np.einsum("igk,kn->ign", basis, np.cos(orders[:, None] * angles) * scale[:, None])
    means = np.zeros((cells, count, order))
    for g in range(points):
        means[np.arange(cells), panel[:, g]] += WEIGHTS[points, g] * step * cardinal[:, g]
    return nodes, means.reshape(cells, -1)


def _gauss_points(ratio: float) -> int:
    """Return the number of Gauss points for round-off on (-1, 1) if the integrand is singular at a distance `ratio`."""
    return min(NODES.shape[1], max(2, int(np.ceil(16 / (2 * np.log10(2 * ratio))))))


def _interpolation_along_period(cells: int, first: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return nodes along the period, and weights (nodes, cells // 2 + 1) of integrals of even and of odd functions.

    The nodes are the positive Chebyshev nodes of the interval up to half a cell beyond half a period, in periods.
    """
    half = 0.5 / cells
    length = 0.5 + half
    order = 32 if first == 1 else 24  # the nearest image is `first` periods off
    angles = (np.arange(order) + 0.5) * np.pi / order
    points = _gauss_points((first - 0.5) / half)
    at = (np.arange(cells // 2 + 1)[:, None] / cells + half * NODES[points, :points]) / length
    orders = np.arange(order)
    basis = np.cos(orders * np.arccos(np.clip(at, -1, 1))[..., None])
    integrals = np.einsum("g,jgn->jn", WEIGHTS[points, :points], basis) * 2 * half
    positive = angles[: order // 2]
    # values at -node follow by parity, so each positive node counts twice for its own parity
    scale = np.full(order, 4.0 / order)
    scale[0] *= 0.5
    cardinal = np.cos(orders[:, None] * positive) * scale[:, None]
    even = integrals[:, 0::2] @ cardinal[0::2]
    odd = integrals[:, 1::2] @ cardinal[1::2]
    return length * np.cos(positive), np.ascontiguousarray(even.T), np.ascontiguousarray(odd.T)


def _coefficients(
    grid: Grid, kind: int, depth: float, nu: float, pressure: float, traction: float, parities: list[int]
) -> FloatArray:
    """Compute the sums over images at all offsets of the grid, (parts, nx, ny); lengths in periods."""
    swap = grid.periodic[0]
    free, along = (1, 0) if swap else (0, 1)
    cells, period = grid.shape[along], grid.lengths[along]
    step = grid.spacing[free] / period
    quarter = np.zeros((len(parities), grid.shape[free], cells // 2 + 1))
    parity = np.array(parities, dtype=np.float64)
    half = 0.5 * step
    z = depth / period
    # the tail is sampled at panels: the whole grid is within reach, and no cell is so wide that a panel is no gain
    smooth = half <= 0.25 and (grid.shape[free] * step) ** 2 + z * z <= _LINE_LOAD_DISTANCE**2
    first = 1 if smooth and cells >= _MANY_CELLS and step <= 1 / _MANY_CELLS else 2
    summand = _Summand(kind, swap, z, nu, pressure, traction, grid.lengths[free] / period, first)
    means = _Means(*_interpolation_along_period(cells, first), parity)
    points = _gauss_points((first - 0.5 if first == 1 else 1.0) / min(half, 0.25))
    tail = np.zeros((len(parities), grid.shape[free] if smooth else 0, means.nodes.size))
    if smooth:
        _sample_tail(summand, *_panels_along_free_axis(grid.shape[free], step, points, first), means.nodes, tail)
    _fill_coefficients(summand, _Cells(step, 1.0 / cells, points), means, tail, quarter)
    odd_parts = parity < 0
    quarter[odd_parts, :, 0] = 0.0
    if cells % 2 == 0:
        quarter[odd_parts, :, -1] = 0.0
    table = np.empty((len(parities), grid.shape[free], cells))
    table[:, :, : cells // 2 + 1] = quarter
    for c, sign in enumerate(parities):
        table[c, :, cells // 2 + 1 :] = sign * quarter[c, :, 1 : (cells + 1) // 2][:, ::-1]
    return np.ascontiguousarray(table.transpose(0, 2, 1)) if swap else table


def surface_table(grid: Grid, material: Material, load: Load) -> FloatArray:
    """Return the normal surface displacement of a loaded cell and its images, (nx, ny) [m/Pa]; datum: above."""
    along = 0 if grid.periodic[0] else 1
    traction = load is Load.TANGENTIAL
    kind = _TRACTION_DISPLACEMENT if traction else _PRESSURE_DISPLACEMENT
    table: FloatArray = _coefficients(grid, kind, 0.0, 0.0, 1.0, 1.0, [SURFACE_PARITY[load][along]])[0]
    nu = material.poissons_ratio
    factor = (1 - 2 * nu) if traction else 2 * (1 - nu)
    table *= factor * grid.lengths[along] / (4 * np.pi * material.shear_modulus)
    if traction:
        table[0] = 0.0
    return table


def in_plane_table(grid: Grid, material: Material) -> FloatArray:
    """Return the in-plane surface displacements of a loaded cell and its images, (3, nx, ny) [m/Pa].

    Components as in `coefficients.in_plane_coefficients`.

    With V, E and S the sums of the integrals of 1/r, f^2/r^3 and f a/r^3:
    2 pi G u = (1 - nu) V + nu E under traction along f, V - nu E under traction along a, nu S across the traction.
    Datum: as under pressure, the means along the period are those of line loads, zero at the reference length. The mean
    of E is uniform, so it is subtracted.
    """
    along = 0 if grid.periodic[0] else 1
    newton = _coefficients(grid, _PRESSURE_DISPLACEMENT, 0.0, 0.0, 1.0, 1.0, [1])[0]
    even, odd = _coefficients(grid, _IN_PLANE, 0.0, 0.0, 1.0, 1.0, [1, -1])
    even -= 2.0 * grid.cell_area / grid.lengths[along] ** 2
    nu = material.poissons_ratio
    out = np.empty((3, *grid.shape))
    out[1 - along] = (1 - nu) * newton + nu * even
    out[along] = newton - nu * even
    out[2] = nu * odd
    out *= grid.lengths[along] / (2 * np.pi * material.shear_modulus)
    return clear_odd_offsets(out, IN_PLANE_PARITY)


def stress_table(grid: Grid, depth: float, poissons_ratio: float, load: Load) -> FloatArray:
    """Return the six stresses at `depth` [m] of a loaded cell and its images, (6, nx, ny) [Pa/Pa]."""
    along = 0 if grid.periodic[0] else 1
    normal = load is Load.NORMAL
    parities = [parity[along] for parity in STRESS_PARITY[load]]
    table: FloatArray = _coefficients(grid, _STRESS, depth, poissons_ratio, float(normal), float(not normal), parities)
    table /= 2 * np.pi
    return clear_odd_offsets(table, STRESS_PARITY[load])
