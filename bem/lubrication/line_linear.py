"""Newton's linear equations of the steady line contact: dense for few nodes, hierarchical for many.

Unknowns are the pressures P_1 .. P_{n-1}, the datum H0 and the exit X_e. Rows 0 .. n-1 are the flow through the cells,

    before_i dH_{i-1} + here_i dH_i + after_i dH_{i+1} + exit_i dH_n + (terms in dP_{i-1}, dP_i, dP_{i+1}) = right_i,

and the last one is the load. Films follow the unknowns through the elastic deflection.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from bem.grid import FloatArray
from bem.lubrication.line_kernel import LineOperator

DEFLECTION = 4 / np.pi
LARGEST_LINEAR_RESIDUAL = 0.05
"""Of the hierarchical solution, relative; beyond it the equations are solved once more with a dense matrix."""


@dataclass(frozen=True)
class Equations:
    """Coefficients of the rows (n,) each; `low`, `diagonal`, `high` of P_{i-1}, P_i, P_{i+1} directly.

    load : (n+1,) coefficients of the pressures in the last row; load_exit : of X_e there, inlet pressure included.
    position : abscissae of the nodes. inlet_slope : dP_0/dX_e. units : sizes of P, H0 and X_e.
    right : (n+1,). mismatch : (n+1,) by which the films change besides.
    """

    before: FloatArray
    here: FloatArray
    after: FloatArray
    exit: FloatArray
    low: FloatArray
    diagonal: FloatArray
    high: FloatArray
    load: FloatArray
    load_exit: float
    position: FloatArray
    inlet_slope: float
    units: tuple[float, float, float]
    right: FloatArray
    mismatch: FloatArray


@dataclass(frozen=True)
class Change:
    """Changes of the interior pressures, datum, exit, and of the film without the mismatch."""

    pressure: FloatArray
    datum: float
    exit: float
    film: FloatArray


def solve(operator: LineOperator, equations: Equations) -> Change:
    """The Newton step."""
    right = equations.right.copy()
    right[:-1] += _by_film(equations, equations.mismatch)
    if operator.hierarchical:
        solution = _hierarchical(operator, equations, right)
        change, missing = _applied(operator, equations, solution, right)
        size = float(np.linalg.norm(right))
        if np.isfinite(missing).all() and np.linalg.norm(missing) <= LARGEST_LINEAR_RESIDUAL * size:
            return change
    return _applied(operator, equations, _dense(operator, equations, right), right)[0]


def _by_film(e: Equations, film: FloatArray) -> FloatArray:
    """What changes of the films do to the flow through the cells."""
    out: FloatArray = e.here * film[:-1] + e.after * film[1:] + e.exit * film[-1]
    out[1:] += e.before[1:] * film[:-2]
    return out


def _applied(
    operator: LineOperator, e: Equations, solution: FloatArray, right: FloatArray
) -> tuple[Change, FloatArray]:
    """The step that a scaled solution means, and what is missing in the equations."""
    unit_p, unit_h, unit_x = e.units
    pressure = np.zeros(len(e.position))
    pressure[1:-1] = solution[:-2] * unit_p
    datum, exit_ = float(solution[-2] * unit_h), float(solution[-1] * unit_x)
    pressure[0] = e.inlet_slope * exit_
    film = datum + e.position * exit_ - DEFLECTION * (operator @ pressure)
    flow = _by_film(e, film) + e.diagonal * pressure[:-1] + e.high * pressure[1:]
    flow[1:] += e.low[1:] * pressure[:-2]
    load = e.load[1:-1] @ pressure[1:-1] + e.load_exit * exit_
    return Change(pressure[1:-1], datum, exit_, film), right - np.append(flow, load)


def _dense(operator: LineOperator, e: Equations, right: FloatArray) -> FloatArray:
    unit_p, unit_h, unit_x = e.units
    n = len(e.here)
    response = np.empty((n + 1, n + 1))
    np.multiply(operator.dense[:, 1:-1], -DEFLECTION * unit_p * operator.factor, out=response[:, :-2])
    response[:, -2] = unit_h
    response[:, -1] = (e.position - DEFLECTION * e.inlet_slope * operator.factor * operator.dense[:, 0]) * unit_x
    matrix = np.empty((n + 1, n + 1))
    np.multiply(response[:-1], e.here[:, None], out=matrix[:-1])
    matrix[:-1] += response[1:] * e.after[:, None]
    matrix[1:-1] += response[:-2] * e.before[1:, None]
    matrix[:-1] += response[-1] * e.exit[:, None]
    index = np.arange(n)
    matrix[index[:-1], index[:-1]] += e.high[:-1] * unit_p
    matrix[index[1:], index[:-1]] += e.diagonal[1:] * unit_p
    matrix[index[2:], index[:-2]] += e.low[2:] * unit_p
    matrix[0, -1] += e.diagonal[0] * e.inlet_slope * unit_x
    matrix[1, -1] += e.low[1] * e.inlet_slope * unit_x
    matrix[-1, :-2] = e.load[1:-1] * unit_p
    matrix[-1, -2] = 0.0
    matrix[-1, -1] = e.load_exit * unit_x
    factors = lu_factor(matrix.T, overwrite_a=True, check_finite=False)
    return np.asarray(lu_solve(factors, right, trans=1, check_finite=False))


def _hierarchical(operator: LineOperator, e: Equations, right: FloatArray) -> FloatArray:
    """Block elimination from the leaves up (Woodbury's formula at every pair); H0, X_e and the exit's film as border.

    Row i goes with P_i: in the Hertz zone the Couette flow out of cell i is that of nodes i and i - 1, where pressure
    drives the flow it is integrated from the exit backwards, which is the stable direction. So every diagonal block
    is the film problem of a piece of the contact and well conditioned.
    """
    unit_p, unit_h, unit_x = e.units
    n, size, leaves = len(e.here), operator.leaf, 2**operator.depth
    slots = leaves * size
    elastic = -DEFLECTION * unit_p * operator.factor

    def filled(values: FloatArray) -> FloatArray:
        out = np.zeros(slots)
        out[: n - 1] = values
        return out

    before, here, after = filled(e.before[1:]), filled(e.here[1:]), filled(e.after[1:])
    low, diagonal, high = filled(e.low[1:] * unit_p), filled(e.diagonal[1:] * unit_p), filled(e.high[1:] * unit_p)
    diagonal[n - 1 :] = 1.0
    high[n - 2] = 0.0  # P_n stays zero

    # how the films answer to datum, exit and inlet pressure: (n+1, 2)
    response = np.empty((n + 1, 2))
    response[:, 0] = unit_h
    response[:, 1] = (e.position - DEFLECTION * e.inlet_slope * operator.factor * operator.ends[:, 0]) * unit_x
    border = np.zeros((slots, 4))
    border[: n - 1, 0] = right[1:-1]
    border[: n - 1, 1:3] = (
        e.here[1:, None] * response[1:-1] + e.after[1:, None] * response[2:] + e.before[1:, None] * response[:-2]
    )
    border[0, 2] += e.low[1] * e.inlet_slope * unit_x
    border[: n - 1, 3] = e.exit[1:]

    # thin factors of every level, deepest first, behind the border's columns
    lefts, rights = [], []
    for level in reversed(operator.levels):
        (clusters, width, _), rank = level.right.shape, level.short
        factor, shape = level.left[:, :, :rank], (clusters, width, 1)
        left = np.empty((clusters, width, rank + 1))
        left[:, :, :-1] = elastic * (
            before.reshape(shape) * factor[:, :-2]
            + here.reshape(shape) * factor[:, 1:-1]
            + after.reshape(shape) * factor[:, 2:]
        )
        left[:, :, -1] = 0.0
        left[0::2, -1, -1] = 1.0  # its next node lies in the neighbour,
        left[1::2, 0, -1] = 1.0  # its last one too
        right_factor = np.empty((clusters, width, rank + 1))
        right_factor[:, :, :-1] = level.right[:, :, :rank]
        last, first = np.arange(0, clusters, 2) * width + width - 1, np.arange(1, clusters, 2) * width
        right_factor[1::2, :, -1] = elastic * after[last, None] * level.edge[1::2]
        right_factor[1::2, 0, -1] += high[last]
        right_factor[0::2, :, -1] = elastic * before[first, None] * level.edge[0::2]
        right_factor[0::2, -1, -1] += low[first]
        lefts.append(left.reshape(slots, rank + 1))
        rights.append(right_factor)
    columns = np.concatenate([border, *lefts], axis=1)

    shape = (leaves, size, 1)
    blocks = elastic * (
        before.reshape(shape) * operator.blocks[:, :-2]
        + here.reshape(shape) * operator.blocks[:, 1:-1]
        + after.reshape(shape) * operator.blocks[:, 2:]
    )
    index = np.arange(size)
    blocks[:, index, index] += diagonal.reshape(leaves, size)
    blocks[:, index[:-1], index[1:]] += high.reshape(leaves, size)[:, :-1]
    blocks[:, index[1:], index[:-1]] += low.reshape(leaves, size)[:, 1:]
    columns = np.linalg.solve(blocks, columns.reshape(leaves, size, -1)).reshape(slots, -1)

    for right_factor in rights:
        clusters, width, rank = right_factor.shape
        own = np.ascontiguousarray(columns[:, 4 : 4 + rank]).reshape(clusters, width, rank)
        kept = np.concatenate([columns[:, :4], columns[:, 4 + rank :]], axis=1).reshape(clusters, width, -1)
        transposed = right_factor.transpose(0, 2, 1)
        coupling, seen = transposed @ own, transposed @ kept
        pairs = clusters // 2
        system = np.zeros((pairs, 2 * rank, 2 * rank))
        unit = np.arange(2 * rank)
        system[:, unit, unit] = 1.0
        # z_1 = V_2' x_2 multiplies the left cluster's factor, z_2 = V_1' x_1 the right one's
        system[:, :rank, rank:] = coupling[1::2]
        system[:, rank:, :rank] = coupling[0::2]
        known = np.concatenate([seen[1::2], seen[0::2]], axis=1)
        mixed = np.linalg.solve(system, known).reshape(clusters, rank, -1)
        columns = (kept - own @ mixed).reshape(slots, -1)
    solved = columns[: n - 1]

    # border: flow through the first cell, the load, and what the exit's film is
    rows = elastic * operator.rows[:, 1:-1]
    first_row = e.here[0] * rows[0] + e.after[0] * rows[1]
    first_row[0] += e.high[0] * unit_p
    last_rows = np.stack([first_row, e.load[1:-1] * unit_p, rows[2]])
    corner = np.zeros((3, 3))
    corner[0, :2] = e.here[0] * response[0] + e.after[0] * response[1]
    corner[0, 1] += e.diagonal[0] * e.inlet_slope * unit_x
    corner[0, 2] = e.exit[0]
    corner[1, 1] = e.load_exit * unit_x
    corner[2, :2] = response[-1]
    corner[2, 2] = -1.0
    product = last_rows @ solved
    scalars = np.linalg.solve(corner - product[:, 1:], np.array([right[0], right[-1], 0.0]) - product[:, 0])
    return np.concatenate([solved[:, 0] - solved[:, 1:] @ scalars, scalars[:2]])
