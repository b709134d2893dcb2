"""Fused passes over a field or over the cells in contact; each reads and writes memory once."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit

FREE, CONTACT, CAPPED = 0, 1, 2
"""State of a cell: no pressure; pressure between the bounds; pressure at the cap."""

_fast: Any = njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract", "reassoc", "nsz", "arcp"})


@_fast
def gather_sum(displacement, gap, cells, out):  # type: ignore[no-untyped-def]
    """out = (gap + displacement)[cells]; returns its sum."""
    total = 0.0
    for k in range(cells.size):
        c = cells[k]
        value = gap[c] + displacement[c]
        out[k] = value
        total += value
    return total


@_fast
def find_violations(displacement, gap, state, approach, found):  # type: ignore[no-untyped-def]
    """Cells that should not stay free (overlap) or at the cap (opening).

    Writes them to `found`; returns their number, the largest violation and the sum of its squares.
    """
    count = 0
    largest = 0.0
    squares = 0.0
    for c in range(gap.size):
        if state[c] == 0:
            value = approach - gap[c] - displacement[c]
        elif state[c] == 2:
            value = gap[c] + displacement[c] - approach
        else:
            continue
        if value > 0:
            if count < found.size:
                found[count] = c
            count += 1
            squares += value * value
            if value > largest:
                largest = value
    return count, largest, squares


@_fast
def separation_sums(displacement, gap, state):  # type: ignore[no-untyped-def]
    """Sum of gap + displacement over the cells that are not at the cap, and their number."""
    total = 0.0
    count = 0
    for c in range(gap.size):
        if state[c] != 2:
            total += gap[c] + displacement[c]
            count += 1
    return total, count


@_fast
def energy(displacement, gap, cells, values):  # type: ignore[no-untyped-def]
    """Sum of p (gap + displacement / 2), of its magnitude, and of p over some cells."""
    total = 0.0
    size = 0.0
    force = 0.0
    for k in range(cells.size):
        c = cells[k]
        term = values[k] * (gap[c] + 0.5 * displacement[c])
        total += term
        size += abs(values[k] * gap[c]) + abs(values[k] * displacement[c])
        force += values[k]
    return total, size, force


@_fast
def scatter(field, cells, values):  # type: ignore[no-untyped-def]
    """field[cells] = values."""
    for k in range(cells.size):
        field[cells[k]] = values[k]


@_fast
def scatter_value(field, cells, value):  # type: ignore[no-untyped-def]
    """field[cells] = value."""
    for k in range(cells.size):
        field[cells[k]] = value


@_fast
def gather(field, cells, out):  # type: ignore[no-untyped-def]
    """out = field[cells]."""
    for k in range(cells.size):
        out[k] = field[cells[k]]


@_fast
def turn(preconditioned, mean, residual, previous):  # type: ignore[no-untyped-def]
    """Take the mean from z; return z.r and z.(r - r_previous)."""
    full = 0.0
    change = 0.0
    for k in range(residual.size):
        z = preconditioned[k] - mean
        preconditioned[k] = z
        full += z * residual[k]
        change += z * (residual[k] - previous[k])
    return full, change


@_fast
def new_direction(direction, preconditioned, beta, cells, field, residual):  # type: ignore[no-untyped-def]
    """t = z + beta t, also written to field[cells]; returns t.r."""
    slope = 0.0
    for k in range(cells.size):
        t = preconditioned[k] + beta * direction[k]
        direction[k] = t
        field[cells[k]] = t
        slope += t * residual[k]
    return slope


@_fast
def gather_dot(field, cells, out, direction):  # type: ignore[no-untyped-def]
    """out = field[cells]; returns its sum and its product with the direction."""
    total = 0.0
    product = 0.0
    for k in range(cells.size):
        value = np.float64(field[cells[k]])
        out[k] = value
        total += value
        product += value * direction[k]
    return total, product


@_fast
def advance(pressure, residual, previous, direction, response, mean, step, cap):  # type: ignore[no-untyped-def]
    """p -= step t, r -= step (q - mean), keeping the old r; returns |r|^2, max |r| and how far p left the bounds."""
    squares = 0.0
    largest = 0.0
    outside = 0.0
    for k in range(pressure.size):
        p = pressure[k] - step * direction[k]
        pressure[k] = p
        outside = max(outside, max(-p, p - cap))
        r = residual[k]
        previous[k] = r
        r -= step * (response[k] - mean)
        residual[k] = r
        squares += r * r
        largest = max(largest, abs(r))
    return squares, largest, outside


@_fast
def shifted_sum(values, shift, cap):  # type: ignore[no-untyped-def]
    """Sum of clip(values + shift, 0, cap) and how many of them are strictly inside."""
    total = 0.0
    inside = 0
    for k in range(values.size):
        p = values[k] + shift
        if p >= cap:
            total += cap
        elif p > 0:
            total += p
            inside += 1
    return total, inside


@_fast
def moments(values):  # type: ignore[no-untyped-def]
    """Minimum, mean and root mean square about the mean; sums are of differences from the first value."""
    first = values[0]
    lowest = first
    total = 0.0
    for k in range(values.size):
        total += values[k] - first
        lowest = min(lowest, values[k])
    mean = total / values.size
    squares = 0.0
    for k in range(values.size):
        d = values[k] - first - mean
        squares += d * d
    return lowest, first + mean, np.sqrt(squares / values.size)


@_fast
def rescale(values, datum, factor, out):  # type: ignore[no-untyped-def]
    """out = (values - datum) factor."""
    for k in range(values.size):
        out[k] = (values[k] - datum) * factor


@njit(cache=True, nogil=True, error_model="numpy")  # type: ignore[untyped-decorator]
def assemble(  # type: ignore[no-untyped-def]
    pressure, displacement, gap, to_pressure, length, approach, cap, deformed, depth
):
    """Turn scaled results into SI units in place, and judge them from the pressure's own values.

    Writes the deformed gap and the plastic depth; returns the largest violation of the contact conditions, the largest
    displacement, the sum of pressures, the numbers of cells in contact and at the cap, and the sum of positive gaps.
    """
    largest = 0.0
    reach = 0.0
    force = 0.0
    contact = 0
    capped = 0
    volume = 0.0
    for c in range(gap.size):
        p = min(pressure[c] * to_pressure, cap)
        u = displacement[c] * length
        pressure[c] = p
        displacement[c] = u
        reach = max(reach, abs(u))
        opening = gap[c] + u - approach
        depth[c] = 0.0
        if p <= 0:
            violation = -opening
            opening = max(opening, 0.0)
            volume += opening
        else:
            contact += 1
            force += p
            if p >= cap:
                violation = opening
                capped += 1
                depth[c] = max(-opening, 0.0)
            else:
                violation = abs(opening)
        deformed[c] = opening
        if not violation <= largest:
            largest = violation
    return largest, reach, force, contact, capped, volume
