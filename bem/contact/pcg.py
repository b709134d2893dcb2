"""Preconditioned conjugate gradients on the active cells: pressures without bounds that close the gap.

Step 9 of `bem.contact` where the contact has an energy (`gcr` otherwise). One compiled call makes all iterations,
single-precision convolutions included. Where several threads share a transform, the call returns for each convolution
and is resumed after it; the arithmetic between transforms is the same, so results have the same bits for every number
of threads.

- Under load control the residual is the gap less its plain mean over the active cells (`_start`, `_advance`), which all
  ends of the iteration refer to, and directions carry no net load. The preconditioner gets a copy of the residual less
  its mean weighted by the pressure of a unit approach (`unit_approach`), which keeps it symmetric (`_turn`).
- The direction is that of Polak and Ribiere with beta >= 0, which tolerates the inexact coarse correction.
- The iteration ends at a relative residual, at the tolerance, or where clipping to the bounds would bring back a
  residual of the same size (`grid_workspace.SolverParameters`).
- The last step may be extrapolated: it reuses the length of the step before, takes no convolution, and counts as an
  iteration. It may be the only step, so that no convolution is taken; on a new grid the length is one. The
  preconditioned kernel is close to one, and the next outer iteration applies the operator anyway and can
  backtrack. The length is carried over between outer iterations (`grid_workspace.Extrapolation`).

Notation: p pressure, r residual (gap), z preconditioned residual, t direction, q response of the gap to t.
Verified in tests/contact/test_contact_pcg.py.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.contact.coarse_correction import assign_cells, correct
from bem.contact.controls import Control
from bem.contact.grid_workspace import ActiveCells, GridWorkspace, IterationBudget
from bem.contact.sparse_inverse import apply_factor, apply_transpose, write_row_sums
from bem.threads import threads_for
from bem.transforms.loops import convolve_cells

FloatArray = NDArray[np.float64]

REMAINING = 0.05
"""Fraction of the largest residual that a step of extrapolated length is assumed to leave."""

REMAINING_AT_GOAL = 0.1
"""The same fraction where the tolerance is to be met: a missed tolerance costs a whole outer iteration."""

_NO_UNIT_APPROACH = np.empty(0), 0.0


class StoppingCriteria(NamedTuple):
    """When conjugate gradients end.

    relative_squares : relative squared residual at which they end.
    clip_allowed_below_squares : relative squared residual from which on clipping ends them; an extrapolated step may be
        taken for clipping at any residual.
    goal : largest residual at which they end.
    residual_per_excess : largest residual at which they end, per pressure out of bounds.
    iterations : their limit.
    extrapolate : True if a step of extrapolated length may be the last.
    remaining, remaining_at_goal : fractions of the residual that such a step is assumed to leave.
    """

    relative_squares: float
    clip_allowed_below_squares: float
    goal: float
    residual_per_excess: float
    iterations: int
    extrapolate: bool
    remaining: float
    remaining_at_goal: float


(
    _FIRST,
    _RESPONSE_READY,
    _ITERATIONS,
    _LAST,
    _SLOPE,
    _SQUARES,
    _FIRST_SQUARES,
    _STEP_LENGTH,
    _EXTRAPOLATED,
    _COARSE,
    _APPLIED,
) = range(11)
"""Entries of the solver's state: whether it is at its start; whether the field holds the response of the search
direction; iterations; z.r of the last iteration; t.r; r.r now and at the start; last step length; whether the last step
was extrapolated; coarse and fine convolutions."""


def close_gap(
    grid: GridWorkspace, active: ActiveCells, control: Control, goal: float, budget: IterationBudget
) -> FloatArray:
    """Return pressures without bounds on the active cells that bring their gap (overwritten) closer to zero.

    Under a prescribed load the gap is brought closer to a uniform value, which is a change of the approach.

    goal : tolerance of the gap.
    """
    cells, n = active.iterate.cells, active.iterate.cells.size
    pressure = active.iterate.values.copy()
    if n == 0 or (control.zero_sum and n == 1):  # a single cell carries the whole load
        return pressure
    unit_approach = grid.find_unit_approach(active)[1:] if control.zero_sum else _NO_UNIT_APPROACH
    parameters, extrapolation, single = grid.parameters, grid.extrapolation, grid.single
    criteria = StoppingCriteria(
        parameters.relative_residual**2,
        parameters.clip_allowed_below**2,
        parameters.tolerance_fraction * goal,
        parameters.clip_residual_ratio * grid.self_response,
        min(parameters.iterations_per_round, budget.left),
        extrapolation.trusted,
        REMAINING,
        REMAINING_AT_GOAL,
    )
    work = np.zeros((4, n))
    vectors = (pressure, active.gap, work[0], work[1], work[2], work[3], np.empty(n), np.empty(unit_approach[0].size))
    state = np.zeros(11)
    state[_FIRST], state[_LAST], state[_STEP_LENGTH] = 1.0, math.inf, extrapolation.step_length
    coarse = None if grid.coarse is None else grid.coarse.allocated(np.empty(n))
    alone = threads_for(single.transform.entries) == 1
    lock = single.transform.lock
    with lock, lock if coarse is None else coarse.coarse.convolution.transform.lock:
        far = None if coarse is None else (coarse.coarse.mapping, coarse.compiled())
        near = active.near.rows
        engine = single.compiled()
        while _iterate(
            state,
            cells,
            vectors,
            near,
            far,
            unit_approach,
            criteria,
            grid.single_field,
            engine,
            grid.cap,
            active.mean_residual,
            alone,
        ):
            single.apply_to_cells(cells, work[1], grid.single_field)
    found = state.tolist()
    single.counted(int(found[_APPLIED]))
    if coarse is not None:
        coarse.coarse.convolution.counted(int(found[_COARSE]))
    budget.iterations += int(found[_ITERATIONS])
    extrapolation.step_length, extrapolation.taken = found[_STEP_LENGTH], found[_EXTRAPOLATED] == 1
    return work[3] if extrapolation.taken else pressure


@compiled
def _iterate(state, cells, vectors, near, far, unit_approach, criteria, convolved, engine, cap, mean, alone):
    """Iterate up to the end or, unless `alone`, up to the next convolution; return True if that is due.

    vectors : p, r, r of the last iteration, t, z, q (in the end the extrapolated p), scratch of the preconditioner, and
    the residual without its weighted mean (empty without a zero-sum constraint). unit_approach : pressure of a unit
    approach and its sum. mean : of the residual.
    """
    plan, scratch, factor = engine
    response_field = convolved.reshape(-1)
    if state[_FIRST]:
        _start(state, cells, vectors, near, far, mean)
    while True:
        if state[_RESPONSE_READY] and _advance(state, cells, vectors, response_field, criteria, cap):
            return False
        if state[_ITERATIONS] == criteria.iterations or _turn(state, vectors, near, far, unit_approach, criteria, cap):
            return False
        state[_RESPONSE_READY] = 1
        if not alone:
            return True
        convolve_cells(plan, scratch, factor, cells, vectors[3], convolved)
        state[_APPLIED] += 1


@compiled
def _start(state, cells, vectors, near, far, mean):
    """Prepare residual (the gap, less its plain mean where directions carry no net load) and coarse correction."""
    residual = vectors[1]
    if vectors[7].size:
        for k in range(residual.size):
            residual[k] -= mean
    state[_SQUARES] = state[_FIRST_SQUARES] = sum_of_squares(residual)
    if far is not None:
        mapping, ((blocks, weights), (root, inverse_root), _, _) = far
        write_row_sums(near, weights)
        assign_cells(cells, mapping, weights, blocks, root, inverse_root)
    state[_FIRST] = 0


@compiled
def _turn(state, vectors, near, far, unit_approach, criteria, cap):
    """Write the next direction; return True if the iteration ends without its convolution."""
    pressure, residual, previous, direction, preconditioned, response, values, projected_residual = vectors
    right_side, coefficient = residual, 0.0
    if projected_residual.size:
        subtract_mean(residual, unit_approach[0], unit_approach[1], projected_residual)
        right_side, coefficient = projected_residual, 1 / unit_approach[1]
    apply_factor(near, right_side, values)
    if far is not None:
        state[_COARSE] += correct(values, far[1])
    total = apply_transpose(near, values, preconditioned)
    full, change = constrain(preconditioned, unit_approach[0], coefficient * total, residual, previous)
    beta = max(0.0, change / state[_LAST])
    outside, largest = extrapolate(
        pressure, preconditioned, direction, beta, state[_STEP_LENGTH], cap, residual, response
    )
    if not full > 0:
        return True
    state[_LAST] = full
    state[_ITERATIONS] += 1
    if _ends_extrapolated(criteria, state[_SQUARES] / state[_FIRST_SQUARES], largest, outside):
        state[_EXTRAPOLATED] = 1
        return True
    state[_SLOPE] = new_direction(direction, preconditioned, beta, residual)
    return False


@compiled
def _advance(state, cells, vectors, convolved, criteria, cap):
    """Step to the minimum along the direction; return True if the iteration ends there."""
    pressure, residual, previous, direction, _, response, _, projected_residual = vectors
    total, curvature = gather(convolved, cells, response, direction)
    if not curvature > 0:
        return True
    mean = total / cells.size if projected_residual.size else 0.0
    state[_STEP_LENGTH] = state[_SLOPE] / curvature
    squares, largest, outside = advance(
        pressure, residual, previous, direction, response, mean, state[_STEP_LENGTH], cap
    )
    state[_SQUARES] = squares
    relative = squares / state[_FIRST_SQUARES]
    if relative <= criteria.relative_squares or largest <= criteria.goal:
        return True
    return relative <= criteria.clip_allowed_below_squares and largest <= criteria.residual_per_excess * outside


@compiled
def _ends_extrapolated(criteria, relative, largest, outside):
    """Return True if a step of extrapolated length is expected to meet a criterion."""
    if not criteria.extrapolate:
        return False
    if (
        criteria.remaining**2 * relative <= criteria.relative_squares
        or criteria.remaining * largest <= criteria.residual_per_excess * outside
    ):
        return True
    return criteria.remaining_at_goal * largest <= criteria.goal


@compiled
def sum_of_squares(values):
    """Return the sum of squares."""
    total = 0.0
    for k in range(values.size):
        total += values[k] * values[k]
    return total


@compiled
def subtract_mean(values, weights, total, out):
    """Write the values less their mean with the weights, which sum to `total`."""
    mean = 0.0
    for k in range(values.size):
        mean += weights[k] * values[k]
    mean /= total
    for k in range(values.size):
        out[k] = values[k] - mean


@compiled
def constrain(preconditioned, unit_approach, coefficient, residual, previous):
    """Subtract a multiple of the pressure of a unit approach from z; return z.r and z.(r - previous r)."""
    if coefficient:
        for k in range(unit_approach.size):
            preconditioned[k] -= coefficient * unit_approach[k]
    full = 0.0
    change = 0.0
    for k in range(residual.size):
        z = preconditioned[k]
        full += z * residual[k]
        change += z * (residual[k] - previous[k])
    return full, change


@compiled
def new_direction(direction, preconditioned, beta, residual):
    """Write t = z + beta t; return t.r."""
    slope = 0.0
    for k in range(residual.size):
        t = preconditioned[k] + beta * direction[k]
        direction[k] = t
        slope += t * residual[k]
    return slope


@compiled
def gather(field, cells, out, direction):
    """Gather the field on the cells; return its sum and its product with the direction."""
    total = 0.0
    product = 0.0
    for k in range(cells.size):
        value = np.float64(field[np.uint64(cells[k])])
        out[k] = value
        total += value
        product += value * direction[k]
    return total, product


@compiled
def advance(pressure, residual, previous, direction, response, mean, step, cap):
    """Update p -= step t and r -= step (q - mean), keeping the previous r.

    Returns r.r, the maximum of abs(r), and how far p leaves its bounds.
    """
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


@compiled
def extrapolate(pressure, preconditioned, direction, beta, step, cap, residual, out):
    """Write p - step (z + beta t); return how far it leaves the bounds, and the maximum of abs(r)."""
    outside = 0.0
    largest = 0.0
    for k in range(pressure.size):
        p = pressure[k] - step * (preconditioned[k] + beta * direction[k])
        out[k] = p
        outside = max(outside, max(-p, p - cap))
        largest = max(largest, abs(residual[k]))
    return outside, largest
