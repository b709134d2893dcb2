"""Mean gaps that do not exist: a proof for elastic bodies that cannot be pressed flat.

A stiff layer on a soft base bends: however hard it is pressed on a flat (or the deeper, the more) it stands off
somewhere on a free grid, so the mean gap m has a least value over all approaches d, and less may be asked for. That is
proved by weights y of the cells. With the gap g = h + K p - d, let

    (1) K^T y >= 0,    (2) sum y = 0,    (3) y <= 1/n.

For every p >= 0 and every d with g >= 0

    m = sum g / n >= y.g = y.h + (K^T y).p - d sum y >= y.h,

so y.h bounds every mean gap from below, with contact or without. A contact that touches on the cells C and is open on O
gives such weights but for (2): 1/n on O, and on C what makes K^T y vanish there; then y.h - d sum y is its own mean
gap, and -sum y the slope of m over d. Two contacts with slopes of either sign, mixed so that (2) holds, cut m off from
below by their tangents; the next approach is where those meet.

(1) and (3) are not taken for granted but checked of the weights that are used, with the round-off and the error of the
linear solution covered by a uniform weight (a uniform pressure sinks every cell); a negative sum will do for (2), since
bodies that touch have come closer than their first touch, d >= 0. Where any of them fails nothing is proved: contacts
of layers so thin and stiff that a pressure lifts cells next to it may have K^T y < 0. Their tangents bound nothing and
can meet where a contact was found already; the search ends there, with the least mean gap it has seen.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.contact.level import LevelResult
from bem.contact.search import mean_opening
from bem.convolution import DisplacementOperator

FloatArray = NDArray[np.float64]

_STEPS = 40
"""Contacts that are tried; six to twelve are usual."""

_SAME = 1e-9
"""Of an approach: tangents of the same contacts meet there but for round-off and the weights' linear equations."""

_PRECISE = 1e-11
"""Residual of the weights' linear equations, relative to their right side."""


@dataclass(frozen=True)
class LeastGap:
    """Outcome: an approach bracket (low, high) across which the wanted mean gap is reached, or a bound above it; with
    neither, `result` has the least mean gap that was found, and nothing is proved."""

    result: LevelResult
    bracket: tuple[float, float] | None
    bound: float | None


@dataclass(frozen=True)
class _Cut:
    """A contact with its weights: at an approach, its mean gap, sum of weights, and y.h."""

    result: LevelResult
    mean_gap: float
    weights: FloatArray
    total: float
    bound: float


def least_gap(
    mean_gap: float,
    operator: DisplacementOperator,
    gap: FloatArray,
    first: LevelResult,
    scale: float,
    tolerance: float,
    solve: Callable[[float, FloatArray | None], LevelResult],
) -> LeastGap | None:
    """Close in on the least mean gap until the wanted one is passed, or proved not to exist, or contacts repeat; else
    None.

    `gap` flat, its lowest value zero; `first` a converged contact with a larger mean gap; `solve` the contact at an
    approach, from a start.
    """
    left = _cut(operator, gap, first)
    right: _Cut | None = None
    if left is None:
        return None
    if left.total <= 0:
        left, right = None, left
    approach, nearest = first.approach, left or right
    tried = {approach}
    for _ in range(_STEPS):
        if left is None:
            assert right is not None
            approach = 0.25 * right.result.approach
            start = right.result.pressure
        elif right is None:
            approach = max(4 * left.result.approach, left.result.approach + scale)
            start = left.result.pressure
        else:
            bound = _proved(operator, gap, left, right)
            if bound is not None and bound > mean_gap + tolerance:
                return LeastGap(min((left, right), key=lambda cut: cut.mean_gap).result, None, bound)
            approach = (left.bound - right.bound) / (left.total - right.total)
            start = left.result.pressure
            if any(abs(approach - one) <= _SAME * abs(one) for one in tried):
                assert nearest is not None
                return LeastGap(nearest.result, None, None)
        tried.add(approach)
        result = solve(approach, start)
        if not result.converged or not math.isfinite(approach):
            return None
        reached = mean_opening(gap, result)
        if reached <= mean_gap:
            return LeastGap(result, (left.result.approach if left is not None else 0.0, approach), None)
        cut = _cut(operator, gap, result)
        if cut is None:
            return None
        left, right = (cut, right) if cut.total > 0 else (left, cut)
        nearest = cut if nearest is None or cut.mean_gap < nearest.mean_gap else nearest
    return None


def _proved(operator: DisplacementOperator, gap: FloatArray, left: _Cut, right: _Cut) -> float | None:
    """The bound on the mean gap from both contacts' weights together; None where they do not qualify."""
    shape = operator.grid.shape
    apply = _transposed(operator).scaled().apply
    one = np.ones(gap.size)
    uniform = apply(one.reshape(shape), np.empty(shape)).reshape(-1)
    share = -right.total / (left.total - right.total)
    mixed = share * left.weights + (1 - share) * right.weights
    response = apply(mixed.reshape(shape), np.empty(shape)).reshape(-1)
    if not uniform.min() > 0:
        return None
    size = float(np.abs(response).max())
    # what round-off and the linear solution may have left below zero
    lift = max(0.0, float((1e-13 * size - response).max())) / float(uniform.min())
    mixed += lift
    # back to a sum that is not positive: the approach of any contact is not negative
    steeper = (mixed.sum() + 1e-13 * np.abs(mixed).sum()) / (left.total - right.total)
    if not 0 <= share - steeper <= 1:
        return None
    mixed -= steeper * (left.weights - right.weights)
    response = apply(mixed.reshape(shape), np.empty(shape)).reshape(-1)
    if response.min() < 0 or mixed.sum() > 0:
        return None
    return float(mixed @ gap) / max(1.0, float(mixed.max()) * gap.size)


def _cut(operator: DisplacementOperator, gap: FloatArray, contact: LevelResult) -> _Cut | None:
    """The weights of a contact, by a linear solution on its cells; None if that fails."""
    import scipy.sparse.linalg  # only where a mean gap is not found

    touching = contact.pressure > 0
    cells = np.flatnonzero(touching)
    shape = operator.grid.shape
    scaled = _transposed(operator).scaled()
    weights = np.where(touching, 0.0, 1.0 / gap.size)
    field = np.empty(shape)

    def on_cells(values: FloatArray) -> FloatArray:
        field.reshape(-1)[:] = 0.0
        field.reshape(-1)[cells] = np.asarray(values).reshape(-1)
        return np.array(scaled.apply(field, field).reshape(-1)[cells])

    right_side = -scaled.apply(weights.reshape(shape), np.empty(shape)).reshape(-1)[cells]
    matrix = scipy.sparse.linalg.LinearOperator((cells.size, cells.size), matvec=on_cells, dtype=np.float64)
    if operator.symmetric:
        found, failed = scipy.sparse.linalg.cg(matrix, right_side, rtol=_PRECISE, atol=0.0, maxiter=2000)
    else:
        found, failed = scipy.sparse.linalg.gmres(matrix, right_side, rtol=_PRECISE, atol=0.0, restart=100, maxiter=20)
    if failed:
        return None
    weights[cells] = found
    return _Cut(contact, mean_opening(gap, contact), weights, float(weights.sum()), float(weights @ gap))


def _transposed(operator: DisplacementOperator) -> DisplacementOperator:
    """The transposed operator: the coupling of friction is odd, so friction changes its sign."""
    return operator if operator.symmetric else replace(operator, friction=-operator.friction)
