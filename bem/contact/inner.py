"""Conjugate gradients of a round on cells that fit one block of `passes`: one compiled call, transforms included.

The same passes in the same order as `face` makes one by one; verified against them in
tests/contact/test_contact_passes.py. Where several threads share a transform, the call returns for each and is made
again after it: what is compiled is the same, and so are the bits.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact import gradients, inverse
from bem.contact.inverse import Inverse, Step
from bem.convolution import ScaledConvolution
from bem.threads import threads_for
from bem.transforms.loops import convolve_cells

FloatArray = NDArray[np.float64]


class Ends(NamedTuple):
    """When a round's conjugate gradients end: at a sum of squared residuals (`lowest`), at a largest residual (`goal`),
    or, from a sum of squares on (`enough`), at a largest residual of `clipping` times what is outside the bounds.

    `most` : iterations. `trusted` : whether a step of known length may be the last one. `left`, `left_at_last` : shares
    of the largest residual that it is taken to leave, beside what clipping undoes or single precision can, and beside
    the goal.
    """

    lowest: float
    enough: float
    goal: float
    clipping: float
    most: int
    trusted: bool
    left: float
    left_at_last: float


@compiled
def ended(ends, squares, largest, outside):
    """Whether a residual is small enough: clipping will bring back one of about the size of what is outside the bounds,
    and it is of no use to go far below that."""
    if squares <= ends.lowest or largest <= ends.goal:
        return True
    return squares <= ends.enough and largest <= ends.clipping * outside


@compiled
def strides(ends, squares, largest, outside):
    """Whether a step of a length known beforehand ends the round.

    The preconditioned kernel is close to one, so the convolution that would tell the length says little: the round to
    come applies the operator anyway, and goes back along the way if it was too long. The step is the last where it is
    to reach the tolerance, what clipping will undo, or what single precision can.
    """
    if not ends.trusted:
        return False
    if ends.left**2 * squares <= ends.lowest or ends.left * largest <= ends.clipping * outside:
        return True
    return ends.left_at_last * largest <= ends.goal


_DUE, _MADE, _LAST, _SLOPE, _SQUARES, _LENGTH, _STRODE, _COARSE, _APPLIED = range(9)
"""What is known between two calls: whether a convolution is due; iterations; z.r of the one before; the direction's
product with the residual; the latter's sum of squares; the last step's length; whether one known beforehand was the
last; convolutions of long waves; and convolutions made inside."""


class Reached(NamedTuple):
    """Pressures; how many iterations they took, the length of the last step, and whether that was known beforehand."""

    pressure: FloatArray
    iterations: int
    length: float
    strode: bool


def solve_in_one_call(
    preconditioner: Inverse,
    balance: tuple[FloatArray, float, FloatArray],
    cells: NDArray[np.int64],
    pressure: FloatArray,
    residual: tuple[FloatArray, float],
    convolved: NDArray[np.float32],
    quick: ScaledConvolution,
    ends: Ends,
    first: Step,
) -> Reached:
    """Conjugate gradients from a pressure and its residual (with its sum of squares), both overwritten.

    balance : as `inverse._descend` takes it. convolved : room for what `quick` gives. first : the length of
    a first step known beforehand, and the cap.
    """
    transform, coarse = quick.transform, preconditioner.convolution
    way = np.zeros((4, cells.size))
    vectors = pressure, residual[0], way[0], way[1], way[2], way[3]
    now = np.array([0.0, 0.0, first.last, 0.0, residual[1], first.length, 0.0, 0.0, 0.0])
    alone = threads_for(transform.entries) == 1
    with transform.lock, transform.lock if coarse is None else coarse.transform.lock:
        engine = quick.compiled()
        inverted = preconditioner.compiled()
        while _iterate(now, inverted, vectors, balance, cells, convolved, engine, ends, first.cap, alone):
            quick.apply_to_cells(cells, way[1], convolved)
    _, made, _, _, _, length, strode, on_coarse, applied = now.tolist()
    quick.counted(int(applied))
    if coarse is not None:
        coarse.counted(int(on_coarse))
    return Reached(way[3] if strode else pressure, int(made), length, strode == 1)


@compiled
def _iterate(now, inverted, vectors, balance, cells, convolved, engine, ends, cap, alone):
    """From one convolution on to the next, all of them if `alone`; whether one is to be made before it is called again.

    vectors : p, r, r before, t, z, q; the last is p where the step known beforehand leads.
    """
    own, far = inverted
    room, scratch, factor = engine
    flat = convolved.reshape(-1)
    while True:
        if now[_DUE] and _advance(now, vectors, balance, cells, flat, ends, cap):
            return False
        if now[_MADE] == ends.most or _turn(now, own, far, vectors, balance, ends, cap):
            return False
        now[_DUE] = 1
        if not alone:
            return True
        convolve_cells(room, scratch, factor, cells, vectors[3], convolved)
        now[_APPLIED] += 1


@compiled
def _turn(now, own, far, vectors, balance, ends, cap):
    """The next direction, whose convolution is due; whether the round ends without it."""
    pressure, residual, previous, direction, preconditioned, response = vectors
    state, way = (pressure, residual, previous), (preconditioned, direction, response)
    full, change, outside, largest, coarse = inverse._descend(
        own, far, state, way, balance, Step(now[_LAST], now[_LENGTH], cap)
    )
    now[_COARSE] += coarse
    if not full > 0:
        return True
    beta = max(0.0, change / now[_LAST])
    now[_LAST] = full
    now[_MADE] += 1
    if strides(ends, now[_SQUARES], largest, outside):
        now[_STRODE] = 1
        return True
    slope = np.zeros(1)
    gradients._new_direction(0, residual.size, slope, direction, preconditioned, beta, residual)
    now[_SLOPE] = slope[0]
    return False


@compiled
def _advance(now, vectors, balance, cells, convolved, ends, cap):
    """As far along the direction as its convolution says; whether the round ends there."""
    pressure, residual, previous, direction, _, response = vectors
    found = np.zeros(3)
    gradients._gather_dot(0, cells.size, found, convolved, cells, response, direction)
    if not found[1] > 0:
        return True
    # under load control the residual is without its mean
    shift = found[0] / cells.size if balance[2].size else 0.0
    step = now[_SLOPE] / found[1]
    now[_LENGTH] = step
    gradients._advance(0, cells.size, found, (pressure, residual, previous), (direction, response), shift, step, cap)
    now[_SQUARES] = found[0]
    return ended(ends, found[0], found[1], found[2])
