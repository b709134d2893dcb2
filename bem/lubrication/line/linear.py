"""Linear equations of a Newton step of the steady line contact: their form, and their direct solution.

Unknowns are the changes of the pressures P_1 .. P_{n-1}, of the rigid-body separation H0 and of the exit X_e. Rows
0 .. n-1 are the flow through the cells,

    before_i dH_{i-1} + here_i dH_i + after_i dH_{i+1} + exit_i dH_n + (terms in dP_{i-1}, dP_i, dP_{i+1}) = right_i,

and the last row is the load. Films follow the unknowns through the elastic deflection.

1. On a mesh of up to `deflection.HIERARCHICAL_FROM` cells the deflection is substituted, and the dense system is solved
   by LU decomposition. Cost: 2/3 n^3.
2. On finer meshes rows 1 .. n-1 over P_1 .. P_{n-1} are a HODLR matrix, because the deflection is one
   (`deflection.LineOperator`); `bem.numerics.hodlr` factorises it. H0, X_e and the film at the exit are a border of
   three columns. Row i goes with P_i: in the Hertz zone the Couette flow out of cell i is that of nodes i and i - 1;
   where pressure drives the flow it is integrated from the exit backwards, which is the stable direction. So every
   diagonal block is the film problem of a piece of the contact and well conditioned. Cost: O(n r^2 log^2 n) with ranks
   r of about 10, for 2000 nodes below a hundredth of LU: rows `line-film` and `line-film-dense` of the benchmark.
3. The residual of the hierarchical solution is evaluated. Where it exceeds `LARGEST_LINEAR_RESIDUAL`, the dense system
   is solved.

Verified in tests/lubrication/test_line_operator.py.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.lubrication.line.deflection import DEFLECTION, Level, LineOperator
from bem.numerics.hodlr import HodlrFactors, LowRank
from bem.numerics.hodlr import factorise as factorise_hodlr

LARGEST_LINEAR_RESIDUAL = 0.05
"""Relative residual of the hierarchical solution above which the dense system is solved."""
BORDER = 3
"""Columns of the border: H0, X_e and the film at the exit."""


@dataclass(frozen=True)
class NewtonEquations:
    """Coefficients of the equations on n cells, (n,) each where nothing else is said.

    before, here, after : of the films at nodes i - 1, i, i + 1.
    exit : of the film at the exit.
    low, diagonal, high : of the pressures at nodes i - 1, i, i + 1, without their effect on the films.
    load : (n+1,) of the pressures in the last row.
    load_exit : of X_e in the last row, by way of the pressure at the inlet.
    position : (n+1,) abscissae of the nodes.
    inlet_slope : dP_0/dX_e.
    units : scales of P, H0 and X_e that balance the columns.
    right : (n+1,) right-hand side.
    mismatch : (n+1,) by which the film exceeds the film of the pressure; a whole step removes it.
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
class NewtonStep:
    """Changes of the interior pressures (n-1,), of H0, of X_e, and of the film (n+1,) by these."""

    pressure: FloatArray
    rigid_separation: float
    exit: float
    film: FloatArray


@dataclass(frozen=True, eq=False)
class BorderedFactors:
    """Factors of the hierarchical equations with their border.

    operator : elastic deflection on the mesh.
    interior : factors of rows 1 .. n-1 over P_1 .. P_{n-1}.
    border : (n-1, BORDER) columns of the border, solved with the interior.
    last_rows : (3, n-1) rows of the flow through the first cell, of the load and of the film at the exit.
    schur : (3, 3) Schur complement of the border.
    """

    operator: LineOperator
    interior: HodlrFactors
    border: FloatArray
    last_rows: FloatArray
    schur: FloatArray

    def solve(self, right: FloatArray) -> FloatArray:
        """Return the solution (n+1,), in the units of the equations, of a right-hand side (n+1,)."""
        inner = len(right) - 2
        values = np.zeros(len(self.interior.leaves) * self.operator.leaf)
        values[:inner] = right[1:-1]
        solved = self.interior.solve(values)[:inner]
        known = np.array([right[0], right[-1], 0.0]) - self.last_rows @ solved
        scalars = np.linalg.solve(self.schur, known)
        return np.concatenate([solved - self.border @ scalars, scalars[:2]])


@dataclass(frozen=True, eq=False)
class FactoredEquations:
    """Equations of an iterate with their factors, for chord steps."""

    equations: NewtonEquations
    factors: BorderedFactors

    @property
    def cells(self) -> int:
        """Number of cells of the mesh."""
        return len(self.equations.here)


def film_terms(equations: NewtonEquations, film: FloatArray) -> FloatArray:
    """Return the terms of rows 0 .. n-1 in changes of the film (n+1,)."""
    e = equations
    out: FloatArray = e.here * film[:-1] + e.after * film[1:] + e.exit * film[-1]
    out[1:] += e.before[1:] * film[:-2]
    return out


def solve_newton_step(
    operator: LineOperator, equations: NewtonEquations
) -> tuple[NewtonStep, FactoredEquations | None]:
    """Return the Newton step, and the factored equations for chord steps; None in place of these after a dense
    solution."""
    right = _right_side(equations)
    if operator.hierarchical:
        factored = FactoredEquations(equations, factorise(operator, equations))
        step, residual = _step_of(operator, equations, factored.factors.solve(right), right)
        size = float(np.linalg.norm(right))
        if np.isfinite(residual).all() and np.linalg.norm(residual) <= LARGEST_LINEAR_RESIDUAL * size:
            return step, factored
    return _step_of(operator, equations, _solve_dense(operator, equations, right), right)[0], None


def chord_step(factored: FactoredEquations, error: FloatArray, mismatch: FloatArray) -> NewtonStep:
    """Return the step for errors (n+1,) and a mismatch (n+1,) with the equations of an earlier iterate."""
    equations = replace(factored.equations, right=-error, mismatch=mismatch)
    right = _right_side(equations)
    return _step_of(factored.factors.operator, equations, factored.factors.solve(right), right)[0]


def _right_side(equations: NewtonEquations) -> FloatArray:
    """Return the right-hand side with the terms of the mismatch."""
    right = equations.right.copy()
    right[:-1] += film_terms(equations, equations.mismatch)
    return right


def _step_of(
    operator: LineOperator, equations: NewtonEquations, solution: FloatArray, right: FloatArray
) -> tuple[NewtonStep, FloatArray]:
    """Return the step of a solution in the units of the equations, and the residual of the equations."""
    e = equations
    unit_p, unit_h, unit_x = e.units
    pressure = np.zeros(len(e.position))
    pressure[1:-1] = solution[:-2] * unit_p
    rigid_separation, exit_ = float(solution[-2] * unit_h), float(solution[-1] * unit_x)
    pressure[0] = e.inlet_slope * exit_
    film = rigid_separation + e.position * exit_ - DEFLECTION * (operator @ pressure)
    flow = film_terms(e, film) + e.diagonal * pressure[:-1] + e.high * pressure[1:]
    flow[1:] += e.low[1:] * pressure[:-2]
    load = e.load[1:-1] @ pressure[1:-1] + e.load_exit * exit_
    return NewtonStep(pressure[1:-1], rigid_separation, exit_, film), right - np.append(flow, load)


def _solve_dense(operator: LineOperator, equations: NewtonEquations, right: FloatArray) -> FloatArray:
    """Return the solution (n+1,), in the units of the equations, by LU decomposition of the dense matrix."""
    e = equations
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


def factorise(operator: LineOperator, equations: NewtonEquations) -> BorderedFactors:
    """Return the factors of the hierarchical equations."""
    rows = _interior_rows(operator, equations)
    responses = _film_responses(operator, equations)
    levels = (_coupling(level, rows) for level in operator.levels)
    ranks = [level.coarse_rank + 1 for level in operator.levels]
    columns = _border_columns(operator, equations, responses)
    interior, solved = factorise_hodlr(_diagonal_blocks(operator, rows), levels, ranks, columns)
    border = np.ascontiguousarray(solved[: len(equations.here) - 1])
    last_rows, corner = _last_rows(operator, equations, responses)
    return BorderedFactors(operator, interior, border, last_rows, corner - last_rows @ border)


@dataclass(frozen=True)
class InteriorRows:
    """Coefficients of rows 1 .. n-1, padded to the leaves, (rows,) each.

    before, here, after : of the films at nodes i - 1, i, i + 1.
    low, diagonal, high : of the pressures there, in their unit; padded rows have one on the diagonal and nothing else.
    elastic : film per weight of the deflection and unit of pressure.
    """

    before: FloatArray
    here: FloatArray
    after: FloatArray
    low: FloatArray
    diagonal: FloatArray
    high: FloatArray
    elastic: float

    def through_films(self, weights: FloatArray, clusters: int) -> FloatArray:
        """Return the terms of the rows in pressures by way of the films, (clusters, rows, k).

        weights : (clusters, rows + 2, k) of the deflection, with one row more at each end.
        """
        out = np.empty((clusters, weights.shape[1] - 2, weights.shape[2]))
        _through_films(out, weights, self.before, self.here, self.after, self.elastic)
        return out


@compiled
def _through_films(
    out: FloatArray, weights: FloatArray, before: FloatArray, here: FloatArray, after: FloatArray, elastic: float
) -> None:
    """Fill in the result of `InteriorRows.through_films` in one pass."""
    clusters, size, columns = out.shape
    for c in range(clusters):
        for i in range(size):
            row = c * size + i
            low, middle, high = elastic * before[row], elastic * here[row], elastic * after[row]
            for j in range(columns):
                out[c, i, j] = low * weights[c, i, j] + middle * weights[c, i + 1, j] + high * weights[c, i + 2, j]


def _interior_rows(operator: LineOperator, e: NewtonEquations) -> InteriorRows:
    """Return rows 1 .. n-1, padded to the leaves."""
    unit, inner, slots = e.units[0], len(e.here) - 1, operator.leaf * 2**operator.depth

    def padded(values: FloatArray) -> FloatArray:
        out = np.zeros(slots)
        out[:inner] = values
        return out

    before, here, after = padded(e.before[1:]), padded(e.here[1:]), padded(e.after[1:])
    low, diagonal, high = padded(e.low[1:] * unit), padded(e.diagonal[1:] * unit), padded(e.high[1:] * unit)
    diagonal[inner:] = 1.0
    high[inner - 1] = 0.0  # P_n stays zero
    return InteriorRows(before, here, after, low, diagonal, high, -DEFLECTION * unit * operator.factor)


def _film_responses(operator: LineOperator, e: NewtonEquations) -> FloatArray:
    """Return the films (n+1, 2) per unit of H0 and of X_e, the pressure at the inlet included."""
    _, unit_h, unit_x = e.units
    out = np.empty((len(e.position), 2))
    out[:, 0] = unit_h
    out[:, 1] = (e.position - DEFLECTION * e.inlet_slope * operator.factor * operator.ends[:, 0]) * unit_x
    return out


def _border_columns(operator: LineOperator, e: NewtonEquations, responses: FloatArray) -> FloatArray:
    """Return the columns (rows, BORDER) of H0, X_e and the film at the exit."""
    inner = len(e.here) - 1
    out = np.zeros((operator.leaf * 2**operator.depth, BORDER))
    out[:inner, :2] = (
        e.here[1:, None] * responses[1:-1] + e.after[1:, None] * responses[2:] + e.before[1:, None] * responses[:-2]
    )
    out[0, 1] += e.low[1] * e.inlet_slope * e.units[2]
    out[:inner, 2] = e.exit[1:]
    return out


def _coupling(level: Level, rows: InteriorRows) -> LowRank:
    """Return the low-rank factors of the coupling of sibling clusters.

    The last column stands for the one row next to the sibling that is not a product: its own pressure and the film one
    node on.
    """
    (clusters, width, _), rank = level.right.shape, level.coarse_rank
    left = np.empty((clusters, width, rank + 1))
    left[:, :, :-1] = rows.through_films(level.left[:, :, :rank], clusters)
    left[:, :, -1] = 0.0
    left[0::2, -1, -1] = 1.0  # the next node of the last row lies in the sibling,
    left[1::2, 0, -1] = 1.0  # and so does the node before the first row
    right = np.empty((clusters, width, rank + 1))
    right[:, :, :-1] = level.right[:, :, :rank]
    last, first = np.arange(0, clusters, 2) * width + width - 1, np.arange(1, clusters, 2) * width
    right[1::2, :, -1] = rows.elastic * rows.after[last, None] * level.edge[1::2]
    right[1::2, 0, -1] += rows.high[last]
    right[0::2, :, -1] = rows.elastic * rows.before[first, None] * level.edge[0::2]
    right[0::2, -1, -1] += rows.low[first]
    return left, right


def _diagonal_blocks(operator: LineOperator, rows: InteriorRows) -> FloatArray:
    """Return the diagonal blocks (leaves, leaf, leaf)."""
    leaves, size = 2**operator.depth, operator.leaf
    blocks = rows.through_films(operator.blocks, leaves)
    index = np.arange(size)
    blocks[:, index, index] += rows.diagonal.reshape(leaves, size)
    blocks[:, index[:-1], index[1:]] += rows.high.reshape(leaves, size)[:, :-1]
    blocks[:, index[1:], index[:-1]] += rows.low.reshape(leaves, size)[:, 1:]
    return blocks


def _last_rows(operator: LineOperator, e: NewtonEquations, responses: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return the last rows over the pressures (3, n-1) and over the border (3, 3): flow through the first cell, load,
    and the film at the exit."""
    unit_p, _, unit_x = e.units
    rows = -DEFLECTION * unit_p * operator.factor * operator.rows[:, 1:-1]
    first_row = e.here[0] * rows[0] + e.after[0] * rows[1]
    first_row[0] += e.high[0] * unit_p
    corner = np.zeros((3, 3))
    corner[0, :2] = e.here[0] * responses[0] + e.after[0] * responses[1]
    corner[0, 1] += e.diagonal[0] * e.inlet_slope * unit_x
    corner[0, 2] = e.exit[0]
    corner[1, 1] = e.load_exit * unit_x
    corner[2, :2] = responses[-1]
    corner[2, 2] = -1.0
    return np.stack([first_row, e.load[1:-1] * unit_p, rows[2]]), corner
