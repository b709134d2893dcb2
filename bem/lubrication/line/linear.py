"""Newton's step of the steady line contact: solved for hierarchically (`elimination`), densely where that fails or
there are few nodes. Verified in tests/lubrication/test_line_operator.py."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from bem.grid import FloatArray
from bem.lubrication.line.deflection import DEFLECTION, LineOperator
from bem.lubrication.line.elimination import Elimination, eliminate
from bem.lubrication.line.equations import Equations, by_film

LARGEST_LINEAR_RESIDUAL = 0.05
"""Of the hierarchical solution, relative; beyond it the equations are solved once more with a dense matrix."""


@dataclass(frozen=True)
class Change:
    """Changes of the interior pressures, datum, exit, and of the film without the mismatch."""

    pressure: FloatArray
    datum: float
    exit: float
    film: FloatArray


@dataclass(frozen=True, eq=False)
class Linear:
    """Newton's equations at an iterate, taken apart."""

    equations: Equations
    elimination: Elimination

    @property
    def cells(self) -> int:
        """Of the mesh that they are on."""
        return len(self.equations.here)


def solve(operator: LineOperator, equations: Equations) -> tuple[Change, Linear | None]:
    """The Newton step, and what `again` gives the next ones by without taking the equations apart once more; None of it
    where that is done densely."""
    right = _right(equations)
    if operator.hierarchical:
        linear = Linear(equations, eliminate(operator, equations))
        change, missing = _applied(operator, equations, linear.elimination.solve(right), right)
        size = float(np.linalg.norm(right))
        if np.isfinite(missing).all() and np.linalg.norm(missing) <= LARGEST_LINEAR_RESIDUAL * size:
            return change, linear
    return _applied(operator, equations, _dense(operator, equations, right), right)[0], None


def again(linear: Linear, error: FloatArray, mismatch: FloatArray) -> Change:
    """A step by equations that were taken apart at an iterate nearby, for other errors (n+1,) and mismatch (n+1,)."""
    equations = replace(linear.equations, right=-error, mismatch=mismatch)
    right = _right(equations)
    return _applied(linear.elimination.operator, equations, linear.elimination.solve(right), right)[0]


def _right(equations: Equations) -> FloatArray:
    right = equations.right.copy()
    right[:-1] += by_film(equations, equations.mismatch)
    return right


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
    flow = by_film(e, film) + e.diagonal * pressure[:-1] + e.high * pressure[1:]
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
