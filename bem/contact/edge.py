"""The edge of contact inside cells: area and perimeter of second order from a solution on cells.

A count of the cells in contact is of first order: 8 % high on a rough surface at 256 cells a side. Next to an edge
p = k sqrt(d) at a distance d inside, and gap = 4 k d^(3/2) / (3 E*) outside (k as of a crack's tip: Johnson, *Contact
Mechanics*, section 5.1), so the pressure of the last cell inside and the gap of its neighbour outside say where the
edge crosses the link between their centres: k drops out of q = 3 E* gap / (4 p d n), d the link's length, n the cosine
between link and normal. What the discrete problem makes of that field is linear in the edge's place, so the place is
(a - b q) / (c + q) of the link, a, b, c depending on n and on how the operator represents a pressure: constant on
cells, or as waves (`spectral`). The polygon through the crossings, with what chords cut off from a curve, bounds the
contact.

The same holds with hardness less pressure in place of the pressure, and the overlap in place of the gap, where contact
turns plastic. At a step of the undeformed gap, as round a punch, the pressure has no root to follow: the edge is then
half-way between the centres.

The constants are fitted to contacts of known edge, Hertz' (cells) and Westergaard's (waves), as the cell becomes small;
crossings are met to 0.007 of a cell. `reports/experiments/contact_edge.py` fits them anew. What a narrow piece of
contact or of gap adds goes with the inverse of its number of cells along the link; those two constants are fitted to
areas of rough surfaces (`reports/experiments/contact_area.py`) and held against Hertz' and Westergaard's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numba import carray, njit
from numpy.typing import NDArray

from bem.grid import FloatArray, Grid
from bem.transforms.addresses import numbers

_strict: Any = njit(cache=True, nogil=True, error_model="numpy")

_CELLS = np.array(
    [
        [10.94914, -21.2896, 11.98124, -0.71223],
        [1.38997, -2.21007, 0.69655, 0.26603],
        [14.22922, -26.58799, 13.72025, -0.27714],
    ]
)
_WAVES = np.array(
    [
        [8.30757, -15.89243, 8.63777, -0.18753],
        [0.16653, 0.41132, -1.11791, 0.68662],
        [9.27729, -15.83725, 6.33764, 1.24422],
    ]
)
"""a, b and c as polynomials in the cosine n, highest power first; for n from 0.24 to 1."""

_CELLS_ENDS = (0.0, 0.42)
_WAVES_ENDS = (0.06, 0.217)
"""How far the edge lies out for a narrow region, and in for a narrow opening beyond it: in cells, times the number of
cells along the link. Fits that weigh 256 and 512 cells in other ways give 0.059 to 0.071 and 0.20 to 0.22 (waves),
-0.01 to 0.01 and 0.42 to 0.48 (cells)."""

_LEAST_COSINE = 0.24
_BEFORE, _BEYOND = -0.3, 1.0
"""How far from the cell inside, in links, a crossing may lie: behind the centre of a cell that barely touches."""

_ASLANT = 1.5
"""A chord counts with its length, backwards where it runs against the smoothed edge; but no longer than this many times
what it runs along it, for the chords that crossings at one place make lie in any direction."""

_STEP = 5.0
"""A parabola's steps grow by 3, 5/3, ...: on a smooth surface none is this many times both its neighbours."""

_LEAST_SHARE = 0.1
"""Of the cells' area: spots that barely touch a single cell have an area that no cell can tell."""


@dataclass(frozen=True)
class Region:
    """Part of the surface: area [m^2] and perimeter [m], of second order; the area of its cells as counted [m^2], and
    the length of the sides that they do not share [m]."""

    area: float
    perimeter: float
    counted_area: float
    sides: float

    def of_area(self, area: float) -> Region:
        """The same with another area [m^2], and a perimeter that is not shorter than its cells' sides leave it.

        A length of edge passes sides of at most sqrt(2) times its length, and the cells' edge is to that of the region
        as the roots of their areas. Where chords run back by far, as round single cells, nothing else is known of it.
        """
        share = min(area / self.counted_area, 1.0) if self.counted_area > 0 else 0.0
        return replace(self, area=area, perimeter=max(self.perimeter, math.sqrt(0.5 * share) * self.sides))


def contact_region(
    pressure: FloatArray,
    gap: FloatArray,
    undeformed: FloatArray,
    grid: Grid,
    modulus: float,
    ends: tuple[float, float] | None = None,
) -> Region:
    """The cells in contact.

    Parameters
    ----------
    pressure : (nx, ny) [Pa], zero outside contact. gap, undeformed : (nx, ny), deformed and undeformed gap [m].
    grid : of the cells. modulus : E* as the length of a cell sees it [Pa]. ends : what narrow contact and narrow gaps
    add, in place of the fitted constants.
    """
    found = _region(pressure > 0, pressure, gap, undeformed, grid, modulus, ends)
    return found.of_area(found.area)


def plastic_region(
    pressure: FloatArray, gap: FloatArray, undeformed: FloatArray, hardness: float, grid: Grid, modulus: float
) -> Region:
    """The cells at the hardness [Pa], as in `contact_region`; there the gap is minus the overlap. Where plastic contact
    meets no contact at all, the edge lies half-way between centres."""
    elastic = pressure < hardness
    rest = _region(elastic, pressure, gap, undeformed, grid, modulus, hardness=hardness)
    area = grid.area - rest.area
    return replace(rest, counted_area=grid.area - rest.counted_area).of_area(area)


def _region(
    inside: NDArray[np.bool_],
    strength: FloatArray,
    opening: FloatArray,
    undeformed: FloatArray,
    grid: Grid,
    modulus: float,
    ends: tuple[float, float] | None = None,
    hardness: float = 0.0,
) -> Region:
    constants, fitted = (_WAVES, _WAVES_ENDS) if all(grid.periodic) else (_CELLS, _CELLS_ENDS)
    marks = np.ascontiguousarray(inside).view(np.uint8)
    blurred = _blur(marks, *grid.periodic)
    count = int(np.count_nonzero(inside))
    excess, length, sides, chords, cubes, turns = _sum_squares(
        (marks, *(np.ascontiguousarray(field) for field in (strength, opening, undeformed)), blurred),
        grid.spacing,
        grid.periodic,
        (0.75 * modulus, hardness),
        constants,
        ends or fitted,
    )
    # chords cut off curvature x chord^3 / 12; the curvature of all edges adds up to 2 pi a piece, less that of holes;
    # chords that run back count as well, or what is left of a jagged edge's length makes any area
    segments = 2 * math.pi * turns * (cubes / chords) / 12 if chords > 0 else 0.0
    area = count * grid.cell_area + excess + segments
    area = min(max(area, _LEAST_SHARE * count * grid.cell_area), grid.area)
    return Region(area, length, count * grid.cell_area, sides)


def count_spots(pressure: FloatArray, grid: Grid) -> int:
    """How many separate spots of contact a pressure (nx, ny) has; cells of one hang together through their sides."""
    inside = np.ascontiguousarray(pressure) > 0
    return int(_join_spots(inside, grid.periodic, np.arange(inside.size)))


def label_spots(pressure: FloatArray, grid: Grid) -> NDArray[np.int64]:
    """The number of the spot of contact that each cell (nx, ny) is in, 1, 2, ... in the order of their first cells, 0
    outside; as `count_spots` counts them."""
    inside = np.ascontiguousarray(pressure) > 0
    parent = np.arange(inside.size)
    _join_spots(inside, grid.periodic, parent)
    return np.asarray(_number_spots(inside, parent))


@_strict
def _join_spots(inside, wraps, parent):  # type: ignore[no-untyped-def]
    """Cells in contact less the sides that join two trees of them: the number of trees. Fills the union-find."""
    nx, ny = inside.shape
    count = 0
    for i in range(nx):
        for j in range(ny):
            if not inside[i, j]:
                continue
            count += 1
            for axis in range(2):
                k, m = _step(inside.shape, i, j, axis, 1, wraps)
                if inside[k, m]:
                    first, second = _root(parent, i * ny + j), _root(parent, k * ny + m)
                    count -= first != second
                    parent[first] = second
    return count


@_strict
def _number_spots(inside, parent):  # type: ignore[no-untyped-def]
    nx, ny = inside.shape
    names = np.zeros(nx * ny, np.int64)
    labels = np.zeros((nx, ny), np.int64)
    count = 0
    for i in range(nx):
        for j in range(ny):
            if inside[i, j]:
                root = _root(parent, i * ny + j)
                if names[root] == 0:
                    count += 1
                    names[root] = count
                labels[i, j] = names[root]
    return labels


@_strict
def _root(parent, cell):  # type: ignore[no-untyped-def]
    while parent[cell] != cell:
        parent[cell] = parent[parent[cell]]
        cell = parent[cell]
    return cell


@_strict
def _bare(field):  # type: ignore[no-untyped-def]
    """A contiguous field by its address: counted by none of its holders (`transforms.addresses`)."""
    return carray(numbers(field.ctypes.data, field[0, 0]), field.shape)


@_strict
def _sum_squares(given, spacing, wraps, factors, constants, ends):  # type: ignore[no-untyped-def]
    """Over the squares between four centres: area within the polygons beyond a quarter of a cell for each centre inside
    [m^2], length of the edge [m], that of sides between cells inside and not [m], sums of chords [m] and of their cubes
    [m^3], Euler's number of the region.

    given : (inside, strength, opening, shape, inside blurred), which the caller keeps. strength : vanishes like the
    root of the distance to the edge inside; opening : grows with its power 3/2 outside. shape : the undeformed gap.
    factors : of the opening, and the hardness
    where contact turns plastic as it opens, seen from its elastic part: strength is then what the pressure that is
    given is below it, and the opening has its sign turned. Zero for none.
    """
    inside, strength, opening, shape = _bare(given[0]), _bare(given[1]), _bare(given[2]), _bare(given[3])
    blurred = _bare(given[4])
    dx, dy = spacing
    wraps_x, wraps_y = wraps
    nx, ny = inside.shape
    place = (spacing, wraps, factors, ends)
    area, length, sides, chords, cubes, corners = 0.0, 0.0, 0.0, 0.0, 0.0, 0
    # each link is cut once: a square's upper sides are the lower ones of the next
    rights = np.full(ny, 0.5)
    for i in range(nx if wraps_x else nx - 1):
        k = i + 1 if i + 1 < nx else 0
        high = 0.5
        for j in range(ny if wraps_y else ny - 1):
            m = j + 1 if j + 1 < ny else 0
            low, high = high, 0.5
            left, rights[j] = rights[j], 0.5
            a, b, c, d = inside[i, j], inside[k, j], inside[k, m], inside[i, m]
            number = int(a) + int(b) + int(c) + int(d)
            if number == 0 or number == 4:
                continue
            # where the edge crosses the four sides, from their lower end; 0.5 where it does not
            sides += dy * (c != d) + dx * (b != c)
            if j == 0:
                low = _cut(inside, strength, opening, shape, blurred, (i, j, 0), place, constants)
                sides += 0.0 if wraps_y else dy * (a != b)
            high = _cut(inside, strength, opening, shape, blurred, (i, m, 0), place, constants)
            if i == 0:
                left = _cut(inside, strength, opening, shape, blurred, (i, j, 1), place, constants)
                sides += 0.0 if wraps_x else dx * (a != d)
            right = _cut(inside, strength, opening, shape, blurred, (k, j, 1), place, constants)
            rights[j] = right
            share, u, v, turn = _polygon((a, b, c, d), number, (low, high, left, right))
            corners += turn
            # across the smoothed edge: where it runs at 45 degrees crossings change places and a chord runs back
            lower, upper = float(blurred[i, j]), float(blurred[k, m])
            ahead, aside = float(blurred[k, j]), float(blurred[i, m])
            along, across = (upper + ahead - lower - aside) / dx, (upper + aside - lower - ahead) / dy
            chord = _chord(u * dx, v * dy, along, across)
            area += (share - 0.25 * number) * dx * dy
            length += chord
            chords += abs(chord)
            cubes += abs(chord) ** 3
    return area, length, sides, chords, cubes, 0.25 * corners


@_strict
def _polygon(centres, number, crossings):  # type: ignore[no-untyped-def]
    """Of a square with some of its four centres inside: share of it inside, chord from crossing to crossing with the
    region on the left [sides], and a quarter turn to the left (1), to the right (-1) or neither.

    centres : whether inside, counter-clockwise from the lowest; `number` of them are. crossings : of the lower, upper,
    left and right side, from their lower end.
    """
    a, b, c, d = centres
    low, high, left, right = crossings
    if number == 2 and a == c:
        # a saddle: the mean of both centres joined and parted
        first = 0.5 * (low * left + (1 - high) * (1 - right))
        second = 0.5 * ((1 - low) * right + high * (1 - left))
        return 0.5 * (first + 1 - second) if a else 0.5 * (second + 1 - first), 0.0, 0.0, 0
    turn = 0
    if number == 2 and a == b:
        share, u, v = 0.5 * (left + right), -1.0, left - right
    elif number == 2:
        share, u, v = 0.5 * (low + high), high - low, 1.0
    else:
        one = number == 1
        turn = 1 if one else -1
        if a == one and b != one and c != one and d != one:
            share, u, v = 0.5 * low * left, -low, left
        elif b == one and a != one and c != one and d != one:
            share, u, v = 0.5 * (1 - low) * right, low - 1, -right
        elif c == one and a != one and b != one and d != one:
            share, u, v = 0.5 * (1 - high) * (1 - right), 1 - high, right - 1
        else:
            share, u, v = 0.5 * high * (1 - left), high, 1 - left
    if (number == 2 and not a) or number == 3:
        share, u, v = 1 - share, -u, -v
    return share, u, v, turn


@_strict
def _chord(u, v, along, across):  # type: ignore[no-untyped-def]
    """Length of the chord (u, v) [m], negative where it runs backwards along an edge whose normal is (along, across);
    that of a saddle is none."""
    length, norm = np.hypot(u, v), np.hypot(along, across)
    if not norm > 0:
        return length
    forward = (u * across - v * along) / norm
    return math.copysign(min(length, _ASLANT * abs(forward)), forward)


@_strict
def _cut(inside, strength, opening, shape, blurred, link, place, constants):  # type: ignore[no-untyped-def]
    """Where the edge crosses the link from (i, j) along an axis, as a fraction of it; 0.5 where it does not.

    Fields are arguments of their own, by address: others are counted as held, and as no longer, at every call.
    link : (i, j, axis).
    """
    i, j, axis = link
    (dx, dy), wraps, (factor, hardness), (within, beyond) = place
    size = inside.shape
    k, m = _step(size, i, j, axis, 1, wraps)
    first = inside[i, j]
    if first == inside[k, m]:
        return 0.5
    held = strength[i, j] if first else strength[k, m]
    if hardness > 0.0 and held > 0.0:
        held = hardness - held
    before, behind = _step(size, i, j, axis, -1, wraps), _step(size, i, j, axis, 2, wraps)
    jump = abs(shape[k, m] - shape[i, j])
    beside = max(abs(shape[i, j] - shape[before]), abs(shape[behind] - shape[k, m]))
    if held <= 0.0 or jump > _STEP * beside:
        return 0.5
    opened = opening[k, m] if first else opening[i, j]
    if hardness > 0.0:
        opened = -opened
    step, side = (dx, dy) if axis == 0 else (dy, dx)
    along = (float(blurred[behind]) + blurred[k, m] - blurred[i, j] - blurred[before]) / step
    across = 0.0
    for u, v in ((i, j), (k, m)):
        across += float(blurred[_step(size, u, v, 1 - axis, 1, wraps)])
        across -= float(blurred[_step(size, u, v, 1 - axis, -1, wraps)])
    across /= side
    norm = np.hypot(along, across)
    cosine = max(abs(along) / norm, _LEAST_COSINE) if norm > 0 else 1.0
    ratio = factor * max(opened, 0.0) / (held * step * cosine)
    a = ((constants[0, 0] * cosine + constants[0, 1]) * cosine + constants[0, 2]) * cosine + constants[0, 3]
    b = ((constants[1, 0] * cosine + constants[1, 1]) * cosine + constants[1, 2]) * cosine + constants[1, 3]
    c = ((constants[2, 0] * cosine + constants[2, 1]) * cosine + constants[2, 2]) * cosine + constants[2, 3]
    closed = wraps[axis]
    ahead, back = _count_like(inside, k, m, axis, 1, closed), _count_like(inside, i, j, axis, -1, closed)
    held_cells, open_cells = (back, ahead) if first else (ahead, back)
    crossing = (a - b * ratio) / (c + ratio) + within / held_cells - beyond / open_cells
    crossing = min(max(crossing, _BEFORE), _BEYOND)
    return crossing if first else 1 - crossing


@_strict
def _count_like(inside, i, j, axis, way, wraps):  # type: ignore[no-untyped-def]
    """How many cells from (i, j) on, along `axis` one way, are like it, of a line with others on it; a gap that reaches
    a free edge has no end."""
    nx, ny = inside.shape
    flat, (place, most, stride) = inside.reshape(-1), (i, nx, way * ny) if axis == 0 else (j, ny, way)
    cell = i * ny + j
    like, left = flat[cell], most - place if way > 0 else place + 1
    count = _run(flat, cell, stride, like, left)
    if count < left:
        return float(count)
    if not wraps:
        return float(count) if like else np.inf
    cell -= (place if way > 0 else place - most + 1) * abs(stride)
    return float(count + _run(flat, cell, stride, like, most - left))


@_strict
def _run(flat, cell, stride, like, most):  # type: ignore[no-untyped-def]
    """How many cells from one on, at a stride, are like `like`, at most so many."""
    count = 0
    while count < most and flat[np.uint64(cell)] == like:
        cell += stride
        count += 1
    return count


@_strict
def _blur(inside, wraps_x, wraps_y):  # type: ignore[no-untyped-def]
    """256 times the indicator, blurred twice by 1 2 1 along each axis; beyond a free edge that of the last cell."""
    nx, ny = inside.shape
    blurred = np.empty((nx, ny), np.uint16)
    row = np.empty(ny, np.uint8)
    for i in range(nx):
        a, b = _place(i - 2, nx, wraps_x), _place(i - 1, nx, wraps_x)
        c, d = _place(i + 1, nx, wraps_x), _place(i + 2, nx, wraps_x)
        for j in range(ny):
            row[j] = inside[a, j] + 4 * inside[b, j] + 6 * inside[i, j] + 4 * inside[c, j] + inside[d, j]
        for j in range(2, ny - 2):  # apart from the ends, where places wrap: a loop without branches
            blurred[i, j] = row[j - 2] + 4 * row[j - 1] + 6 * row[j] + 4 * row[j + 1] + row[j + 2]
        for j in range(ny):
            if 2 <= j < ny - 2:
                continue
            a, b = _place(j - 2, ny, wraps_y), _place(j - 1, ny, wraps_y)
            c, d = _place(j + 1, ny, wraps_y), _place(j + 2, ny, wraps_y)
            blurred[i, j] = row[a] + 4 * row[b] + 6 * row[j] + 4 * row[c] + row[d]
    return blurred


@_strict
def _step(size, i, j, axis, ahead, wraps):  # type: ignore[no-untyped-def]
    """The cell at an offset along `axis` of a field of that size; beyond a free edge the last one."""
    return (_place(i + ahead, size[0], wraps[0]), j) if axis == 0 else (i, _place(j + ahead, size[1], wraps[1]))


@_strict
def _place(i, n, wraps):  # type: ignore[no-untyped-def]
    if 0 <= i < n:  # hardly any other: a remainder each time is what a certificate would spend its time on
        return i
    return i % n if wraps else min(max(i, 0), n - 1)
