"""Passes of conjugate gradients over the cells in contact, in the blocks of `passes`.

p pressure, r residual, z the preconditioned residual, t direction, q response to it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact import passes

FloatArray = NDArray[np.float64]


def squares(values: FloatArray) -> float:
    """Sum of squares."""
    return passes.sums(values.size, 1, _squares, values)[0]


@compiled
def _squares(start, stop, result, values):
    values = values[start:stop]
    total = 0.0
    for k in range(values.size):
        total += values[k] * values[k]
    result[0] = total


def weighed_free(values: FloatArray, weights: FloatArray, total: float, out: FloatArray) -> None:
    """out = values less their mean with these weights, `total` their sum."""
    if values.size <= passes.BLOCK:
        _weighed_free(values, weights, total, out)
        return
    mean = passes.sums(values.size, 1, _weighed, values, weights)[0] / total
    passes.in_blocks(values.size, 0, _less, values, mean, out)


@compiled
def _weighed_free(values, weights, total, out):
    mean = np.zeros(1)
    _weighed(0, values.size, mean, values, weights)
    _less(0, values.size, mean, values, mean[0] / total, out)


@compiled
def _weighed(start, stop, result, values, weights):
    values, weights = values[start:stop], weights[start:stop]
    total = 0.0
    for k in range(values.size):
        total += weights[k] * values[k]
    result[0] = total


@compiled
def _less(start, stop, result, values, shift, out):
    values, out = values[start:stop], out[start:stop]
    for k in range(values.size):
        out[k] = values[k] - shift


@compiled
def carry(before, values, total, cells, out):
    """out = the values on the cells `before` where these are among `cells` (both ascend), elsewhere their mean; returns
    the sum. `total` : of the values. Zero where those known are no more than half, or sum up to no more than half of
    what their number would have."""
    a = 0
    known = 0
    sum_known = 0.0
    for k in range(cells.size):
        while a < before.size and before[a] < cells[k]:
            a += 1
        if a < before.size and before[a] == cells[k]:
            out[k] = values[a]
            known += 1
            sum_known += values[a]
        else:
            out[k] = np.nan
    if not (2 * known > cells.size and 2 * sum_known * values.size > total * known > 0):
        return 0.0
    mean = sum_known / known
    carried = 0.0
    for k in range(cells.size):
        if np.isnan(out[k]):
            out[k] = mean
        carried += out[k]
    return carried


def turn(
    preconditioned: FloatArray, rise: FloatArray, share: float, residual: FloatArray, previous: FloatArray
) -> tuple[float, float]:
    """z -= share rise; return z.r and z.(r - r_previous)."""
    full, change = passes.sums(residual.size, 2, _turn, preconditioned, rise, share, residual, previous)
    return full, change


@compiled
def _turn(start, stop, result, preconditioned, rise, share, residual, previous):
    residual, previous, preconditioned = residual[start:stop], previous[start:stop], preconditioned[start:stop]
    if share:
        rise = rise[start:stop]
        for k in range(rise.size):
            preconditioned[k] -= share * rise[k]
    full = 0.0
    change = 0.0
    for k in range(residual.size):
        z = preconditioned[k]
        full += z * residual[k]
        change += z * (residual[k] - previous[k])
    result[0] = full
    result[1] = change


def new_direction(direction: FloatArray, preconditioned: FloatArray, beta: float, residual: FloatArray) -> float:
    """t = z + beta t; returns t.r."""
    return passes.sums(residual.size, 1, _new_direction, direction, preconditioned, beta, residual)[0]


@compiled
def _new_direction(start, stop, result, direction, preconditioned, beta, residual):
    residual, preconditioned, direction = residual[start:stop], preconditioned[start:stop], direction[start:stop]
    slope = 0.0
    for k in range(residual.size):
        t = preconditioned[k] + beta * direction[k]
        direction[k] = t
        slope += t * residual[k]
    result[0] = slope


def gather_dot(field: NDArray[Any], cells: NDArray[Any], out: FloatArray, direction: FloatArray) -> tuple[float, float]:
    """out = field[cells]; returns its sum and its product with the direction."""
    total, product = passes.sums(cells.size, 2, _gather_dot, field, cells, out, direction)
    return total, product


@compiled
def _gather_dot(start, stop, result, field, cells, out, direction):
    total = 0.0
    product = 0.0
    cells, out, direction = cells[start:stop], out[start:stop], direction[start:stop]
    for k in range(cells.size):
        value = np.float64(field[np.uint64(cells[k])])
        out[k] = value
        total += value
        product += value * direction[k]
    result[0] = total
    result[1] = product


def advance(
    state: tuple[FloatArray, FloatArray, FloatArray],
    way: tuple[FloatArray, FloatArray],
    mean: float,
    step: float,
    cap: float,
) -> tuple[float, float, float]:
    """p -= step t, r -= step (q - mean), keeping the old r; returns |r|^2, max |r| and how far p left the bounds.

    state : (p, r, r before). way : (t, q).
    """
    partial = passes.in_blocks(state[0].size, 3, _advance, state, way, mean, step, cap)
    if partial.shape[0] == 1:
        squares, largest, outside = partial[0].tolist()
        return squares, largest, outside
    return float(partial[:, 0].sum()), float(partial[:, 1].max()), float(partial[:, 2].max())


@compiled
def _advance(start, stop, result, state, way, mean, step, cap):
    pressure, residual, previous = state
    direction, response = way
    squares = 0.0
    largest = 0.0
    outside = 0.0
    pressure, residual, previous = pressure[start:stop], residual[start:stop], previous[start:stop]
    direction, response = direction[start:stop], response[start:stop]
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
    result[0] = squares
    result[1] = largest
    result[2] = outside


def stride(
    pressure: FloatArray,
    way: tuple[FloatArray, FloatArray, float],
    step: float,
    cap: float,
    residual: FloatArray,
    out: FloatArray,
) -> tuple[float, float]:
    """out = p - step (z + beta t); returns how far that leaves the bounds, and max |r|. way : (z, t, beta)."""
    partial = passes.in_blocks(pressure.size, 2, _stride, pressure, way, step, cap, residual, out)
    if partial.shape[0] == 1:
        outside, largest = partial[0].tolist()
        return outside, largest
    return float(partial[:, 0].max()), float(partial[:, 1].max())


@compiled
def _stride(start, stop, result, pressure, way, step, cap, residual, out):
    preconditioned, direction, beta = way
    outside = 0.0
    largest = 0.0
    pressure, residual, out = pressure[start:stop], residual[start:stop], out[start:stop]
    preconditioned, direction = preconditioned[start:stop], direction[start:stop]
    for k in range(pressure.size):
        p = pressure[k] - step * (preconditioned[k] + beta * direction[k])
        out[k] = p
        outside = max(outside, max(-p, p - cap))
        largest = max(largest, abs(residual[k]))
    result[0] = outside
    result[1] = largest
