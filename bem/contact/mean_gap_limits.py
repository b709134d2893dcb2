"""Least mean gap of elastic bodies that cannot be pressed flat, with a proof by duality.

A stiff layer on a soft base bends: however hard it is pressed, it stands off somewhere on a free grid, so the mean gap
m has a least value over all approaches d, and a smaller one may be prescribed. The bound follows from weights y of the
cells. With the gap g = h + K p - d, let

    (1) K^T y >= 0,    (2) sum y = 0,    (3) y <= 1/n.

For every p >= 0 and every d with g >= 0

    m = sum g / n >= y.g = y.h + (K^T y).p - d sum y >= y.h,

so y.h bounds every mean gap from below, with contact or without. A contact that touches on the cells C and is open on O
gives such weights except for (2): 1/n on O, and on C the values for which K^T y vanishes there. Then y.h - d sum y is
the contact's mean gap, and -sum y the slope of m over d. Two contacts with slopes of opposite sign, combined so that
(2) holds, bound m from below by their tangents; the next approach is the intersection of the tangents.

Conditions (1) and (3) are checked for the weights that are used; a uniform weight covers round-off and the error of the
linear solution, because a uniform pressure sinks every cell. A negative sum suffices for (2), because d >= 0 in
contact. Where a condition fails nothing is proved: a layer so thin and stiff that a pressure lifts the cells beside it
may have K^T y < 0. The tangents are then no bounds and may meet at an earlier contact; the search ends there with the
least mean gap found.

Last fallback of step 11 of `bem.contact`. Verified in tests/contact/test_least_gap.py against linear programming.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from bem.contact.grid_workspace import GridResult, mean_opening
from bem.convolution import DisplacementOperator

FloatArray = NDArray[np.float64]

_STEPS = 40
"""Limit of the contacts that are solved; six to twelve are usual."""

_SAME = 1e-9
"""Relative distance of two approaches that count as equal."""

_PRECISE = 1e-11
"""Residual of the weights' linear equations, relative to their right side."""


@dataclass(frozen=True)
class LeastMeanGap:
    """Outcome of the search.

    bracket : approaches (low, high) between which the prescribed mean gap is reached, or None.
    bound : lower bound on every mean gap, above the prescribed one, or None.
    result : with neither, the contact with the least mean gap found.
    """

    result: GridResult
    bracket: tuple[float, float] | None
    bound: float | None


@dataclass(frozen=True)
class _Tangent:
    """A contact with its mean gap, weights y, their sum, and y.h: a tangent of the mean gap over the approach."""

    result: GridResult
    mean_gap: float
    weights: FloatArray
    total: float
    bound: float


def least_mean_gap(
    mean_gap: float,
    operator: DisplacementOperator,
    gap: FloatArray,
    first: GridResult,
    scale: float,
    tolerance: float,
    solve: Callable[[float, FloatArray | None], GridResult],
) -> LeastMeanGap | None:
    """Approach the least mean gap until the prescribed one is passed, is proved not to exist, or contacts repeat.

    gap : one-dimensional, lowest value zero. first : converged contact with a larger mean gap. solve : contact at an
    approach from an initial pressure. Returns None where a contact does not converge or nothing is decided.
    """
    left = _tangent(operator, gap, first)
    right: _Tangent | None = None
    if left is None:
        return None
    if left.total <= 0:
        left, right = None, left
    approach, best = first.approach, left or right
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
                return LeastMeanGap(min((left, right), key=lambda cut: cut.mean_gap).result, None, bound)
            approach = (left.bound - right.bound) / (left.total - right.total)
            start = left.result.pressure
            if any(abs(approach - one) <= _SAME * abs(one) for one in tried):
                assert best is not None
                return LeastMeanGap(best.result, None, None)
        tried.add(approach)
        result = solve(approach, start)
        if not result.converged or not math.isfinite(approach):
            return None
        reached = mean_opening(gap, result)
        if reached <= mean_gap:
            return LeastMeanGap(result, (left.result.approach if left is not None else 0.0, approach), None)
        cut = _tangent(operator, gap, result)
        if cut is None:
            return None
        left, right = (cut, right) if cut.total > 0 else (left, cut)
        best = cut if best is None or cut.mean_gap < best.mean_gap else best
    return None


def _proved(operator: DisplacementOperator, gap: FloatArray, left: _Tangent, right: _Tangent) -> float | None:
    """Return the bound from the weights of both contacts; None where they do not meet the conditions."""
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
    # cover round-off and the error of the linear solution
    uniform_weight = max(0.0, float((1e-13 * size - response).max())) / float(uniform.min())
    mixed += uniform_weight
    # restore a sum that is not positive
    steeper = (mixed.sum() + 1e-13 * np.abs(mixed).sum()) / (left.total - right.total)
    if not 0 <= share - steeper <= 1:
        return None
    mixed -= steeper * (left.weights - right.weights)
    response = apply(mixed.reshape(shape), np.empty(shape)).reshape(-1)
    if response.min() < 0 or mixed.sum() > 0:
        return None
    return float(mixed @ gap) / max(1.0, float(mixed.max()) * gap.size)


def _tangent(operator: DisplacementOperator, gap: FloatArray, contact: GridResult) -> _Tangent | None:
    """Return the tangent of a contact, whose weights solve linear equations on its cells; None if that fails."""
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
    return _Tangent(contact, mean_opening(gap, contact), weights, float(weights.sum()), float(weights @ gap))


def _transposed(operator: DisplacementOperator) -> DisplacementOperator:
    """Return the transposed operator: the coupling of friction is odd, so friction changes sign."""
    return operator if operator.symmetric else replace(operator, friction=-operator.friction)
