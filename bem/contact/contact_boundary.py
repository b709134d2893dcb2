"""Crossings of the contact boundary with the links between cell centres, and the area that it cuts off.

The compiled part of `contact_area` (step 12 of `bem.contact`), which derives the position of a crossing. Three passes:
one over cells finds the links between a cell inside and a cell outside, and the distance to the next links along the
line; one over links finds the crossings; one over squares of four centres adds up area and length. The last two take
time in proportion to the length of the boundary. Verified in tests/contact/test_contact_area.py against every link in
plain Python.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact import reductions
from bem.grid import FloatArray
from bem.threads import share
from bem.transforms.addresses import prefetch

_LEAST_COSINE = 0.24
"""Least cosine between link and normal for which the crossing law is fitted."""

_BEFORE, _BEYOND = -0.3, 1.0
"""Bounds of a crossing from the cell inside, in links; negative for a cell that barely touches."""

_ASLANT = 1.5
"""Largest length of a chord over its component along the smoothed boundary; coincident crossings give chords in any
direction."""

_STEP = 5.0
"""Ratio of a step of the gap to both neighbouring steps above which the gap is discontinuous; a parabola has 3."""

_PREFETCH = 12
"""Links ahead whose values are prefetched; nearly each lies on its own cache line."""


class Field(NamedTuple):
    """Fields (nx, ny) that determine the boundary.

    inside : 0 or 1. strength : vanishes like the root of the distance to the boundary inside.
    opening : grows with the power 3/2 of the distance outside. shape : undeformed gap.
    """

    inside: NDArray[np.uint8]
    strength: FloatArray
    opening: FloatArray
    shape: FloatArray


class Law(NamedTuple):
    """Law of the crossing.

    factor : of the opening.
    hardness : at the boundary of plastic contact, else zero. The strength is then hardness less pressure, the opening
        has the opposite sign.
    constants : polynomials in the cosine. ends : contributions of narrow regions inside and outside.
    give : factor times the compliance of a cell by its own pressure [m/Pa].
    """

    factor: float
    hardness: float
    constants: FloatArray
    ends: tuple[float, float]
    give: float = 0.0


class Sums(NamedTuple):
    """Sums over the squares of four centres.

    area : of the polygons, less a quarter of a cell for each centre inside [m^2]. length : of the boundary [m].
    sides : length of the sides between cells inside and outside [m]. chords, cubes : sums of chords [m] and of their
    cubes [m^3]. turns : Euler number of the region.
    """

    area: float
    length: float
    sides: float
    chords: float
    cubes: float
    turns: float


class Crossed(NamedTuple):
    """Crossings of the boundary.

    blurred : smoothed indicator. links : along either axis, columns of the first cells and run lengths behind and
    ahead.
    squares : columns of the lowest cells, and bits of the four centres. starts : first link and square of each row.
    crossings : along either axis, as fractions of each link.
    """

    blurred: NDArray[np.uint16]
    links: tuple[tuple[NDArray[np.int32], FloatArray], tuple[NDArray[np.int32], FloatArray]]
    squares: tuple[NDArray[np.int32], NDArray[np.uint8]]
    starts: NDArray[np.int64]
    crossings: tuple[FloatArray, FloatArray]


def cross_links(field: Field, spacing: tuple[float, float], wraps: tuple[bool, bool], law: Law) -> Crossed:
    """Find all links between cells inside and outside, and the crossings of the boundary."""
    nx, ny = field.inside.shape
    blurred = blur(field.inside, *wraps)
    links, squares, starts = _find_links(field.inside, *wraps)
    crossings = (np.empty(links[0][0].size), np.empty(links[1][0].size))
    lines = max(1, reductions.BLOCK // ny)

    def work(_worker: int, block: int) -> None:
        first, last = block * lines, min(nx, (block + 1) * lines)
        _write_crossings(first, last, links, starts, field, blurred, (spacing, wraps), law, crossings)

    share(work, -(-nx // lines), nx * ny)
    return Crossed(blurred, links, squares, starts, crossings)


def sum_squares(crossed: Crossed, spacing: tuple[float, float], wraps: tuple[bool, bool]) -> Sums:
    """Add up areas, lengths and turns over the squares between four centres."""
    return Sums(*_sum_over_squares(crossed.squares, crossed.starts, crossed.crossings, crossed.blurred, spacing, wraps))


class Links(NamedTuple):
    """Links (m,) along an axis between a cell inside and a cell outside.

    first, second : indices of both cells along the axis. aside : their index across it. crossing : fraction of the
    link.
    cosine : between link and normal.
    """

    first: NDArray[np.int64]
    second: NDArray[np.int64]
    aside: NDArray[np.int64]
    crossing: FloatArray
    cosine: FloatArray


def links_along(crossed: Crossed, axis: int, spacing: tuple[float, float], wraps: tuple[bool, bool]) -> Links:
    """Return the links along an axis with their crossings, and the cosines by the smoothed indicator."""
    shape = crossed.blurred.shape
    count = int(crossed.starts[shape[0], axis])
    row = np.repeat(np.arange(shape[0]), np.diff(crossed.starts[:, axis]))
    column = crossed.links[axis][0][:count].astype(np.int64)
    first, aside = (row, column) if axis == 0 else (column, row)

    def blurred(along: int, across: int) -> NDArray[np.int64]:
        places = [_wrapped_indices(first + along, shape[axis], wraps[axis])]
        places.insert(1 - axis, _wrapped_indices(aside + across, shape[1 - axis], wraps[1 - axis]))
        return crossed.blurred[places[0], places[1]].astype(np.int64)

    along = (blurred(2, 0) + blurred(1, 0) - blurred(0, 0) - blurred(-1, 0)) / spacing[axis]
    across = (blurred(0, 1) + blurred(1, 1) - blurred(0, -1) - blurred(1, -1)) / spacing[1 - axis]
    norm = np.hypot(along, across)
    cosine = np.divide(np.abs(along), norm, out=np.ones(count), where=norm > 0)
    second = _wrapped_indices(first + 1, shape[axis], wraps[axis])
    return Links(first, second, aside, crossed.crossings[axis][:count], cosine)


def cells_at_edge(
    crossed: Crossed, inside: NDArray[np.uint8], spacing: tuple[float, float], wraps: tuple[bool, bool]
) -> tuple[NDArray[np.int64], FloatArray]:
    """Return the cell indices (m,) of the cells at the boundary, and the fraction of each cell beyond it (m,).

    To first order the fraction is half a link less the distance of the crossing from the centre, summed over the links
    of the cell with the squared cosine between link and normal; the squares of both cosines sum to one.
    """
    cells, beyond = [], []
    for axis in (0, 1):
        links = links_along(crossed, axis, spacing, wraps)
        ends = [(end, links.aside) if axis == 0 else (links.aside, end) for end in (links.first, links.second)]
        lower = inside[ends[0]] != 0
        first, second = (row * inside.shape[1] + column for row, column in ends)
        cells.append(np.where(lower, first, second))
        beyond.append(links.cosine**2 * (0.5 - np.where(lower, links.crossing, 1 - links.crossing)))
    numbers, order = np.unique(np.concatenate(cells), return_inverse=True)
    total = np.bincount(order.reshape(-1), np.concatenate(beyond), numbers.size)
    return numbers.astype(np.int64), total.astype(np.float64)


def _wrapped_indices(numbers: NDArray[np.int64], n: int, wraps: bool) -> NDArray[np.int64]:
    """Return `wrapped_index` of an array."""
    return np.asarray(numbers % n if wraps else np.clip(numbers, 0, n - 1))


@compiled
def _find_links(inside, wraps_x, wraps_y):
    """Return links, squares and starts as in `Crossed`.

    A gap that reaches a free edge has infinite run length; the bits of a square run counter-clockwise from its lowest
    cell.
    """
    nx, ny = inside.shape
    capacity = 8 * (nx + ny)
    down, down_runs = np.empty(capacity, np.int32), np.empty((capacity, 2))
    across, across_runs = np.empty(capacity, np.int32), np.empty((capacity, 2))
    squares, codes = np.empty(capacity, np.int32), np.empty(capacity, np.uint8)
    starts = np.zeros((nx + 1, 3), np.int64)
    first, last = np.full((2, ny), -1), np.full((2, ny), -1)  # of the links down each column: which, and its row
    row = np.zeros(8 * ((ny + 7) // 8), np.uint8)
    words = row.view(np.uint64)
    u = v = w = 0
    for i in range(nx):
        starts[i, 0], starts[i, 1], starts[i, 2] = u, v, w
        down, down_runs = _with_capacity(down, u + ny), _with_capacity(down_runs, u + ny)
        across, across_runs = _with_capacity(across, v + ny), _with_capacity(across_runs, v + ny)
        squares, codes = _with_capacity(squares, w + ny), _with_capacity(codes, w + ny)
        ends = i + 1 == nx and not wraps_x
        here = inside[i]
        _write_corner_bits(here, inside[i if ends else (i + 1) % nx], wraps_y, row)
        for word in range(words.size):
            if words[word] == 0:
                continue
            for j in range(8 * word, 8 * word + 8):
                code = row[j]
                if code & 2:
                    down[u] = j
                    if last[0, j] < 0:
                        first[0, j], first[1, j] = u, i
                    else:
                        down_runs[u, 0] = down_runs[last[0, j], 1] = i - last[1, j]
                    last[0, j], last[1, j] = u, i
                    u += 1
                if code & 8:
                    across[v] = j
                    if v > starts[i, 1]:
                        across_runs[v, 0] = across_runs[v - 1, 1] = j - across[v - 1]
                    v += 1
                if code != 0 and not ends and (wraps_y or j < ny - 1):
                    squares[w], codes[w] = j, code ^ 15 if here[j] else code
                    w += 1
        if v > starts[i, 1]:
            at, to = across[starts[i, 1]], across[v - 1]
            across_runs[starts[i, 1], 0], across_runs[v - 1, 1] = _ends(here, at, to, wraps_y)
    starts[nx, 0], starts[nx, 1], starts[nx, 2] = u, v, w
    for j in range(ny):
        if last[0, j] >= 0:
            before, behind = _ends(inside[:, j], first[1, j], last[1, j], wraps_x)
            down_runs[first[0, j], 0], down_runs[last[0, j], 1] = before, behind
    return ((down, down_runs), (across, across_runs)), (squares, codes), starts


@compiled
def _write_corner_bits(here, above, wraps, row):
    """Write the bits (1, 2 and 3) of the centres of each square that differ from its lowest cell."""
    n = here.size
    for j in range(n - 1):
        row[j] = (here[j] ^ above[j]) << 1 | (here[j] ^ above[j + 1]) << 2 | (here[j] ^ here[j + 1]) << 3
    j, m = n - 1, 0 if wraps else n - 1
    row[j] = (here[j] ^ above[j]) << 1 | (here[j] ^ above[m]) << 2 | (here[j] ^ here[m]) << 3


@compiled
def _ends(line, first, last, wraps):
    """Return the run lengths of a line before its first link and after its last link."""
    if wraps:
        return float(first + line.size - last), float(first + line.size - last)
    before, behind = float(first + 1), float(line.size - 1 - last)
    return before if line[first] else np.inf, behind if line[last + 1] else np.inf


@compiled
def _with_capacity(array, size):
    """Return the array, or a copy with twice the rows."""
    if array.shape[0] >= size:
        return array
    larger = np.empty((2 * size, *array.shape[1:]), array.dtype)
    larger[: array.shape[0]] = array
    return larger


@compiled
def _write_crossings(first, last, links, starts, field, blurred, where, law, crossings):
    """Write the crossings of the links of some rows, as fractions of each link."""
    spacing, (wraps_x, wraps_y) = where
    nx, ny = field[0].shape
    inside, strength, opening = field[0].reshape(-1), field[1].reshape(-1), field[2].reshape(-1)
    shape, blurred = field[3].reshape(-1), blurred.reshape(-1)
    factor, hardness, constants, ends, give = law
    addresses = strength.ctypes.data, opening.ctypes.data, shape.ctypes.data
    for i in range(first, last):
        # cell indices of the rows before, here, beyond and behind
        before, here = wrapped_index(i - 1, nx, wraps_x) * ny, i * ny
        beyond = wrapped_index(i + 1, nx, wraps_x) * ny
        behind = wrapped_index(i + 2, nx, wraps_x) * ny
        for axis in range(2):
            (columns, runs), fractions = links[axis], crossings[axis]
            for link in range(starts[i, axis], starts[i + 1, axis]):
                j, later = columns[link], columns[min(link + _PREFETCH, starts[i + 1, axis] - 1)]
                for address in addresses:
                    prefetch(address + 8 * (here + later))
                    if axis == 0:
                        prefetch(address + 8 * (beyond + later))
                if axis == 0:
                    prefetch(addresses[2] + 8 * (behind + later))
                left, right = wrapped_index(j - 1, ny, wraps_y), wrapped_index(j + 1, ny, wraps_y)
                if axis == 0:
                    previous, first_cell, second_cell, following = before + j, here + j, beyond + j, behind + j
                    first_left, first_right = here + left, here + right
                    second_left, second_right = beyond + left, beyond + right
                else:
                    previous, first_cell, second_cell = here + left, here + j, here + right
                    following = here + wrapped_index(j + 2, ny, wraps_y)
                    first_left, first_right = before + j, beyond + j
                    second_left, second_right = before + right, beyond + right
                lower = inside[first_cell] != 0
                run_before, run_after = runs[link, 0], runs[link, 1]
                strength_inside, opening_outside = strength[first_cell], opening[second_cell]
                run_lengths = run_before, run_after
                if not lower:
                    strength_inside, opening_outside = strength[second_cell], opening[first_cell]
                    run_lengths = run_after, run_before
                if hardness > 0.0:
                    strength_inside = hardness - strength_inside if strength_inside > 0.0 else strength_inside
                    opening_outside = -opening_outside
                jump = abs(shape[second_cell] - shape[first_cell])
                slope_before = abs(shape[first_cell] - shape[previous])
                slope_after = abs(shape[following] - shape[second_cell])
                if strength_inside <= 0.0 or jump > _STEP * max(slope_before, slope_after):
                    fractions[link] = 0.5
                    continue
                along = np.int64(blurred[following]) + blurred[second_cell] - blurred[first_cell] - blurred[previous]
                across = np.int64(blurred[first_right]) + blurred[second_right]
                across -= np.int64(blurred[first_left]) + blurred[second_left]
                normal = along / spacing[axis], across / spacing[1 - axis]
                crossing = _crossing(
                    strength_inside,
                    opening_outside,
                    run_lengths,
                    normal,
                    spacing[axis],
                    (factor, give),
                    constants,
                    ends,
                )
                fractions[link] = crossing if lower else 1 - crossing


@compiled
def _crossing(strength, opening, cells, normal, link, factors, constants, ends):
    """Return the distance of the crossing from the cell inside, in links of length `link`.

    cells : run lengths inside and outside. Where cells give way by their own pressure alone, the overlap give *
    pressure and the gap are linear across the boundary, so that it crosses at give / (give + ratio). Adding `give` to
    numerator and denominator of the elastic law joins both: it is exact without `give` and for a large one.
    """
    factor, give = factors
    along, across = normal
    norm = math.sqrt(along * along + across * across)
    cosine = max(abs(along) / norm, _LEAST_COSINE) if norm > 0 else 1.0
    ratio = factor * max(opening, 0.0) / (strength * link * cosine)
    give = give / (link * cosine)
    a = ((constants[0, 0] * cosine + constants[0, 1]) * cosine + constants[0, 2]) * cosine + constants[0, 3]
    b = ((constants[1, 0] * cosine + constants[1, 1]) * cosine + constants[1, 2]) * cosine + constants[1, 3]
    c = ((constants[2, 0] * cosine + constants[2, 1]) * cosine + constants[2, 2]) * cosine + constants[2, 3]
    crossing = (a - b * ratio + give) / (c + ratio + give) + ends[0] / cells[0] - ends[1] / cells[1]
    return min(max(crossing, _BEFORE), _BEYOND)


@compiled
def _sum_over_squares(squares, starts, crossings, blurred, spacing, wraps):
    """Add up `Sums` over the squares."""
    dx, dy = spacing
    wraps_x, wraps_y = wraps
    (places, codes), (rows, columns) = squares, crossings
    nx, ny = blurred.shape
    area, length, sides, chords, cubes, corners = 0.0, 0.0, 0.0, 0.0, 0.0, 0
    for i in range(nx):
        k = i + 1 if i + 1 < nx else 0
        # a row's squares have its links, and the next row's, on their sides in the order of both
        row, column, above = starts[i, 0], starts[i, 1], starts[k, 1]
        for square in range(starts[i, 2], starts[i + 1, 2]):
            j, code = places[square], codes[square]
            m = j + 1 if j + 1 < ny else 0
            a, b, c, d = code & 1, code >> 1 & 1, code >> 2 & 1, code >> 3
            # where the edge crosses the four sides, from their lower end; 0.5 where it does not
            low, high, left, right = 0.5, 0.5, 0.5, 0.5
            if a != b:
                low = rows[row]
                row += 1
            if c != d:
                high = rows[starts[i, 0] if m == 0 else row]
            if a != d:
                left = columns[column]
                column += 1
            if b != c:
                right = columns[above]
                above += 1
            sides += dy * (c != d) + dx * (b != c)
            if j == 0 and not wraps_y:
                sides += dy * (a != b)
            if i == 0 and not wraps_x:
                sides += dx * (a != d)
            number = a + b + c + d
            share, u, v, turn = _polygon((a, b, c, d), number, (low, high, left, right))
            corners += turn
            # across the smoothed edge: where it runs at 45 degrees crossings change places and a chord runs back
            lower, upper = np.int64(blurred[i, j]), np.int64(blurred[k, m])
            ahead, aside = np.int64(blurred[k, j]), np.int64(blurred[i, m])
            along, across = (upper + ahead - lower - aside) / dx, (upper + aside - lower - ahead) / dy
            chord = _chord(u * dx, v * dy, along, across)
            area += (share - 0.25 * number) * dx * dy
            length += chord
            chords += abs(chord)
            cubes += abs(chord) ** 3
    return area, length, sides, chords, cubes, 0.25 * corners


@compiled
def _polygon(centres, number, crossings):
    """Return the fraction of a square inside, the chord with the region on its left [sides], and its quarter turn.

    The turn is 1 to the left, -1 to the right, or 0. centres : 0 or 1, counter-clockwise from the lowest; `number` are
    inside. crossings : of the lower, upper, left and right side, from their lower end.
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


@compiled
def _chord(u, v, along, across):
    """Return the length of the chord (u, v) [m], negative where it runs against a boundary with normal (along,
    across)."""
    length, norm = math.sqrt(u * u + v * v), math.sqrt(along * along + across * across)
    if not norm > 0:
        return length
    forward = (u * across - v * along) / norm
    return math.copysign(min(length, _ASLANT * abs(forward)), forward)


@compiled
def blur(inside, wraps_x, wraps_y):
    """Return 256 times the indicator, smoothed twice by 1 2 1 along each axis; free edges repeat the last cell."""
    nx, ny = inside.shape
    blurred = np.empty((nx, ny), np.uint16)
    row = np.empty(ny, np.uint8)
    for i in range(nx):
        a, b = wrapped_index(i - 2, nx, wraps_x), wrapped_index(i - 1, nx, wraps_x)
        c, d = wrapped_index(i + 1, nx, wraps_x), wrapped_index(i + 2, nx, wraps_x)
        for j in range(ny):
            row[j] = inside[a, j] + 4 * inside[b, j] + 6 * inside[i, j] + 4 * inside[c, j] + inside[d, j]
        for j in range(2, ny - 2):  # apart from the ends, where places wrap: a loop without branches
            blurred[i, j] = row[j - 2] + 4 * row[j - 1] + 6 * row[j] + 4 * row[j + 1] + row[j + 2]
        for j in range(ny):
            if 2 <= j < ny - 2:
                continue
            a, b = wrapped_index(j - 2, ny, wraps_y), wrapped_index(j - 1, ny, wraps_y)
            c, d = wrapped_index(j + 1, ny, wraps_y), wrapped_index(j + 2, ny, wraps_y)
            blurred[i, j] = row[a] + 4 * row[b] + 6 * row[j] + 4 * row[c] + row[d]
    return blurred


@compiled
def wrapped_index(i, n, wraps):
    """Return the index of a cell along an axis of n cells; free ends repeat the last cell."""
    if 0 <= i < n:  # avoids a remainder in nearly all cases
        return i
    return i % n if wraps else min(max(i, 0), n - 1)
