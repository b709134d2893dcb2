"""The edge of contact square by square and link by link, in plain Python: for the walk and cuts of
`bem.contact.contact_boundary`. What a square's polygon and chord are is the same there, and tested by itself."""

import numpy as np

from bem.contact import contact_boundary


def sum_squares(given, spacing, wraps, factors, constants, ends):
    """See `contact_boundary.Sums`; given : (inside, strength, opening, shape, inside blurred)."""
    inside, strength, opening, shape, blurred = given
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
            a, b, c, d = (int(inside[centre]) for centre in ((i, j), (k, j), (k, m), (i, m)))
            number = a + b + c + d
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
            share, u, v, turn = contact_boundary._polygon.py_func((a, b, c, d), number, (low, high, left, right))
            corners += turn
            # across the smoothed edge: where it runs at 45 degrees crossings change places and a chord runs back
            lower, upper = float(blurred[i, j]), float(blurred[k, m])
            ahead, aside = float(blurred[k, j]), float(blurred[i, m])
            along, across = (upper + ahead - lower - aside) / dx, (upper + aside - lower - ahead) / dy
            chord = contact_boundary._chord.py_func(u * dx, v * dy, along, across)
            area += (share - 0.25 * number) * dx * dy
            length += chord
            chords += abs(chord)
            cubes += abs(chord) ** 3
    return area, length, sides, chords, cubes, 0.25 * corners


def _cut(inside, strength, opening, shape, blurred, link, place, constants):
    """Where the edge crosses the link from (i, j) along an axis, as a fraction of it; 0.5 where it does not.

    link : (i, j, axis).
    """
    i, j, axis = link
    (dx, dy), wraps, (factor, hardness), (within, beyond) = place
    size = inside.shape
    k, m = neighbour(size, i, j, axis, 1, wraps)
    first = inside[i, j]
    if first == inside[k, m]:
        return 0.5
    held = strength[i, j] if first else strength[k, m]
    if hardness > 0.0 and held > 0.0:
        held = hardness - held
    before, behind = neighbour(size, i, j, axis, -1, wraps), neighbour(size, i, j, axis, 2, wraps)
    jump = abs(shape[k, m] - shape[i, j])
    beside = max(abs(shape[i, j] - shape[before]), abs(shape[behind] - shape[k, m]))
    if held <= 0.0 or jump > contact_boundary._STEP * beside:
        return 0.5
    opened = opening[k, m] if first else opening[i, j]
    if hardness > 0.0:
        opened = -opened
    step, side = (dx, dy) if axis == 0 else (dy, dx)
    along = (float(blurred[behind]) + blurred[k, m] - blurred[i, j] - blurred[before]) / step
    across = 0.0
    for u, v in ((i, j), (k, m)):
        across += float(blurred[neighbour(size, u, v, 1 - axis, 1, wraps)])
        across -= float(blurred[neighbour(size, u, v, 1 - axis, -1, wraps)])
    across /= side
    norm = np.hypot(along, across)
    cosine = max(abs(along) / norm, contact_boundary._LEAST_COSINE) if norm > 0 else 1.0
    ratio = factor * max(opened, 0.0) / (held * step * cosine)
    a = ((constants[0, 0] * cosine + constants[0, 1]) * cosine + constants[0, 2]) * cosine + constants[0, 3]
    b = ((constants[1, 0] * cosine + constants[1, 1]) * cosine + constants[1, 2]) * cosine + constants[1, 3]
    c = ((constants[2, 0] * cosine + constants[2, 1]) * cosine + constants[2, 2]) * cosine + constants[2, 3]
    closed = wraps[axis]
    ahead, back = count_like(inside, k, m, axis, 1, closed), count_like(inside, i, j, axis, -1, closed)
    held_cells, open_cells = (back, ahead) if first else (ahead, back)
    crossing = (a - b * ratio) / (c + ratio) + within / held_cells - beyond / open_cells
    crossing = min(max(crossing, contact_boundary._BEFORE), contact_boundary._BEYOND)
    return crossing if first else 1 - crossing


def count_like(inside, i, j, axis, way, wraps):
    """How many cells from (i, j) on, along `axis` one way, are like it, of a line with others on it; a gap that reaches
    a free edge has no end."""
    line, place = (inside[:, j], i) if axis == 0 else (inside[i], j)
    ahead = np.roll(line[::way], -(place if way > 0 else line.size - 1 - place))
    like = inside[i, j]
    count, room = int(np.argmax(ahead != like)), line.size - place if way > 0 else place + 1
    return count if count < room or wraps else room if like else np.inf


def neighbour(size, i, j, axis, ahead, wraps):
    """The cell at an offset along `axis` of a field of that size; beyond a free edge the last one."""
    place = [i, j]
    place[axis] += ahead
    n = size[axis]
    place[axis] = place[axis] % n if wraps[axis] else min(max(place[axis], 0), n - 1)
    return tuple(place)
