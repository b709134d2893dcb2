"""Elastic deflection of a half-plane under a pressure that is linear between nodes.

1. The weights of ln|x - x'| are exact: second differences of its second primitive, moment series where these cancel.
2. Above `HIERARCHICAL_FROM` cells the matrix is a HODLR matrix (`bem.numerics.hodlr`): dense diagonal blocks, and for
   each pair of sibling clusters a product of two thin matrices by adaptive cross approximation (M. Bebendorf, *Numer.
   Math.* 86 (2000) 565), since ln|x - x'| is smooth away from x = x'. Storage, product and the solution of Newton's
   equations cost O(n log^2 n).
3. At other points than the nodes (`logarithmic_integral`) distant groups of cells act by their moments.

Verified in tests/lubrication/test_line_operator.py.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.grid import FloatArray
from bem.lubrication.line.mesh import trapezoidal_weights
from bem.numerics.hodlr import multiply, tree_depth

DEFLECTION = 4 / math.pi
"""Film over (weights times pressures) in similarity variables: 4/pi."""
HIERARCHICAL_FROM = 300
"""Largest number of cells with dense weights, which are as fast up to there."""
LEAF = 64
"""Nodes of a diagonal block, about."""
CROSS_TOLERANCE = 1e-11
"""Relative tolerance of the cross approximation. A film is up to 1e4 times thinner than the deflection: 1e-7 of it."""
NEWTON_CROSS_TOLERANCE = 1e-6
"""Relative tolerance of the cross approximation in Newton's equations. The number of steps is the same as with exact
equations, each with a quarter less work."""
LARGEST_RANK = 48
"""Largest rank of a cross approximation."""
LOG_UNIT_LENGTHS = 4.0
"""Unit of distance in ln|x - x'|, in lengths of the mesh: -ln is then positive everywhere and every block definite."""


_MOMENT_COEFFICIENTS = tuple(1 / (k * (k + 1) * (k + 2)) for k in range(1, 14))
"""Far-field expansion coefficients of ln|t - s| integrated over a hat function, by powers of its half-widths over t."""


@compiled
def _second_primitive(t: float) -> float:
    """Return the second primitive of ln|t|: t^2/2 ln|t| - 3 t^2/4."""
    return 0.0 if t == 0 else t * t * (0.5 * math.log(abs(t)) - 0.75)


@compiled
def _hat_weight(t: float, left: float, right: float) -> float:
    """Return the integral of a hat function times ln|t - s|.

    t : target from the node of the hat. left, right : half-widths, 0 for half a hat. Near: second difference of the
        second primitive. Far: moments of the hat, where that difference would cancel.
    """
    width = max(left, right)
    if abs(t) <= 12 * width:
        first = 0.0 if t == 0 else t * (math.log(abs(t)) - 1)
        total = 0.0
        if right > 0:
            total += (_second_primitive(t - right) - _second_primitive(t)) / right + first
        if left > 0:
            total -= (_second_primitive(t) - _second_primitive(t + left)) / left + first
        return total
    total = 0.5 * (left + right) * math.log(abs(t))
    inverse = 1 / t
    ratio_right, ratio_left, size = right * inverse, -left * inverse, width * abs(inverse)
    power_right, power_left, reach = right, left, 1.0
    for share in _MOMENT_COEFFICIENTS:
        power_right *= ratio_right
        power_left *= ratio_left
        reach *= size
        if reach * share < 1e-17:
            break
        total -= (power_right + power_left) * share
    return total


@compiled
def _fill_weights(out: FloatArray, targets: FloatArray, nodes: FloatArray, first: int) -> None:
    """Fill columns of weights of the hats at nodes first, first + 1, ... at the targets."""
    last = len(nodes) - 1
    for j in range(out.shape[1]):
        k = first + j
        left = nodes[k] - nodes[k - 1] if k > 0 else 0.0
        right = nodes[k + 1] - nodes[k] if k < last else 0.0
        for i in range(len(targets)):
            out[i, j] = _hat_weight(targets[i] - nodes[k], left, right)


@compiled
def _mean_kernel(nodes: FloatArray, i: int, k: int, log_unit: float) -> float:
    """Return ln(|x - x'|/unit) at node i, averaged over the hat of interior node k."""
    before, after = nodes[k] - nodes[k - 1], nodes[k + 1] - nodes[k]
    return _hat_weight(nodes[i] - nodes[k], before, after) / (0.5 * (before + after)) - log_unit


@compiled
def _residual_row(
    out: FloatArray, nodes: FloatArray, i: int, first: int, log_unit: float, of_row: FloatArray, right: FloatArray
) -> None:
    """Fill in the row of node i over columns first, first + 1, ... less the products found so far."""
    for j in range(len(out)):
        out[j] = _mean_kernel(nodes, i, first + j, log_unit)
    for r in range(len(of_row)):
        for j in range(len(out)):
            out[j] -= of_row[r] * right[r, j]


@compiled
def _residual_column(
    out: FloatArray, nodes: FloatArray, k: int, first: int, log_unit: float, left: FloatArray, of_column: FloatArray
) -> None:
    """Fill in the column of node k at rows first, first + 1, ... less the products found so far."""
    for i in range(len(out)):
        out[i] = _mean_kernel(nodes, first + i, k, log_unit)
    for r in range(len(of_column)):
        for i in range(len(out)):
            out[i] -= left[r, i] * of_column[r]


@compiled
def _dot(one: FloatArray, other: FloatArray) -> float:
    """Return the dot product in four partial sums, which a processor computes side by side."""
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    whole = len(one) - len(one) % 4
    for i in range(0, whole, 4):
        a += one[i] * other[i]
        b += one[i + 1] * other[i + 1]
        c += one[i + 2] * other[i + 2]
        d += one[i + 3] * other[i + 3]
    for i in range(whole, len(one)):
        a += one[i] * other[i]
    return (a + b) + (c + d)


@compiled
def _largest_unused(values: FloatArray, used: NDArray[np.bool_]) -> int:
    """Return the index of the largest unused value; -1 if all are used."""
    best, found = -1.0, -1
    for i in range(len(values)):
        if not used[i] and abs(values[i]) > best:
            best, found = abs(values[i]), i
    return found


@compiled
def _cross_approximation(
    nodes: FloatArray,
    rows: tuple[int, int],
    columns: tuple[int, int],
    pivot: int,
    unit: float,
    tolerances: tuple[float, float],
    rank: int,
) -> tuple[int, FloatArray, FloatArray]:
    """Return the adaptive cross approximation of ln(|x - x'|/unit) between ranges of rows and columns.

    Columns are averaged over hats. The first pivot is row `pivot`.

    Returns
    -------
    Number of products that meet the second tolerance, and all products, which meet the first: (rank, rows), (rank,
    columns).
    """
    row0, col0, height, width = rows[0], columns[0], rows[1] - rows[0], columns[1] - columns[0]
    rank = min(rank, height, width)
    left, right = np.zeros((rank, height)), np.zeros((rank, width))
    log_unit = math.log(unit)
    used = np.zeros(height, dtype=np.bool_)
    squared = 0.0
    row, done, coarse_rank = pivot - row0, 0, 0
    while done < rank and row >= 0:
        used[row] = True
        _residual_row(right[done], nodes, row0 + row, col0, log_unit, left[:done, row], right)
        col = int(np.argmax(np.abs(right[done])))
        top = right[done, col]
        if top == 0.0:
            break
        _residual_column(left[done], nodes, col0 + col, row0, log_unit, left, right[:done, col])
        left[done] /= top
        new = _dot(left[done], left[done]) * _dot(right[done], right[done])
        squared += new
        for r in range(done):
            squared += 2 * _dot(left[r], left[done]) * _dot(right[r], right[done])
        done += 1
        if coarse_rank == 0 and new <= tolerances[1] ** 2 * squared:
            coarse_rank = done
        if new <= tolerances[0] ** 2 * squared:
            break
        row = _largest_unused(left[done - 1], used)
    for j in range(width):
        right[:done, j] *= 0.5 * (nodes[col0 + j + 1] - nodes[col0 + j - 1])
    return (coarse_rank if coarse_rank > 0 else done), left[:done], right[:done]


def logarithmic_weights(targets: FloatArray, nodes: FloatArray) -> FloatArray:
    """Return the weights W with W @ p = integral of p(x') ln|x - x'| dx' at the targets, p linear between the nodes.

    Exact: the second difference over the nodes of t^2/2 ln|t| - 3 t^2/4, the second primitive of ln|t|. At the two ends
    the first primitive t ln|t| - t closes the half hat. The deflection of both bodies is -2/(pi E*) times this, up to a
    constant that the load fixes.

    Parameters
    ----------
    targets : (m,) positions, any order.
    nodes : (n,) ascending positions, n >= 2, in the same unit.

    Returns
    -------
    (m, n) weights, in that unit.
    """
    weights = np.empty((len(targets), len(nodes)))
    _fill_weights(
        weights, np.ascontiguousarray(targets, dtype=np.float64), np.ascontiguousarray(nodes, dtype=np.float64), 0
    )
    return weights


GROUP = 64
"""Cells of a group that acts by its moments at distant targets."""
MOMENTS = 30
"""Moments of a group. The distance is at least three half-widths of the group: 3^-30 is below rounding."""


@compiled
def _add_group_integral(targets: FloatArray, nodes: FloatArray, pressure: FloatArray, out: FloatArray) -> None:
    """Add the integral of the pressure between the first and the last node times ln|t - s| at the targets t."""
    last = len(nodes) - 1
    centre, half = 0.5 * (nodes[0] + nodes[last]), 0.5 * (nodes[last] - nodes[0])
    moments, below, above = np.zeros(MOMENTS), np.empty(MOMENTS + 2), np.empty(MOMENTS + 2)
    for k in range(len(nodes)):
        u, above[0] = (nodes[k] - centre) / half, 1.0
        for m in range(1, MOMENTS + 2):
            above[m] = above[m - 1] * u
        if k > 0:
            slope = (pressure[k] - pressure[k - 1]) * half / (nodes[k] - nodes[k - 1])
            constant = pressure[k] - slope * u
            for m in range(MOMENTS):
                moments[m] += constant * (above[m + 1] - below[m + 1]) / (m + 1)
                moments[m] += slope * (above[m + 2] - below[m + 2]) / (m + 2)
        below[:] = above
    for i in range(len(targets)):
        away = (targets[i] - centre) / half
        if abs(away) >= 3:
            total, power = moments[0] * math.log(abs(away) * half), 1.0
            for m in range(1, MOMENTS):
                power /= away
                total -= moments[m] * power / m
            out[i] += half * total
        else:
            for k in range(len(nodes)):
                left = nodes[k] - nodes[k - 1] if k > 0 else 0.0
                right = nodes[k + 1] - nodes[k] if k < last else 0.0
                out[i] += pressure[k] * _hat_weight(targets[i] - nodes[k], left, right)


@compiled
def logarithmic_integral(targets: FloatArray, nodes: FloatArray, pressure: FloatArray) -> FloatArray:
    """Return `logarithmic_weights(targets, nodes) @ pressure` (m,), distant groups of cells by their moments.

    Equal to rounding; for many nodes a tenth of the work.
    """
    out = np.zeros(len(targets))
    for first in range(0, len(nodes) - 1, GROUP):
        last = min(first + GROUP, len(nodes) - 1) + 1
        _add_group_integral(targets, nodes[first:last], pressure[first:last], out)
    return out


@dataclass(frozen=True, eq=False)
class Level:
    """Couplings of one level of the HODLR matrix: 2^k clusters of interior nodes, in pairs of siblings.

    left : (clusters, size + 2, rank), row factors of a cluster, with the row before and the row after it.
    right : (clusters, size, rank), column factors of a cluster, for the rows of its sibling.
    edge : (clusters, size), weights of a cluster in its own row next to the sibling.
    coarse_rank : number of leading columns of `left` and `right` that Newton's equations use.
    """

    left: FloatArray
    right: FloatArray
    edge: FloatArray
    coarse_rank: int


@dataclass(frozen=True, eq=False)
class LineOperator:
    """Weights of ln(|x - x'|/unit) from nodes to the same nodes, dense or hierarchical; `operator @ pressure` applies
    them.

    nodes : (n+1,) ascending; n counts the cells.
    unit : length.
    factor : stretching of all lengths. The weights are proportional to it, so that a stretched operator shares its
        arrays.
    """

    nodes: FloatArray
    unit: float
    factor: float = 1.0

    @classmethod
    def of(cls, nodes: FloatArray) -> LineOperator:
        """Return the operator of a mesh (n+1,)."""
        return cls(nodes, LOG_UNIT_LENGTHS * float(nodes[-1] - nodes[0]))

    @property
    def hierarchical(self) -> bool:
        """Return True if the weights are a HODLR matrix."""
        return len(self.nodes) > HIERARCHICAL_FROM

    def rescale(self, factor: float) -> LineOperator:
        """Return the operator of the same mesh with all lengths multiplied by a factor."""
        other = replace(self, factor=self.factor * factor)
        # the arrays are those of the nodes as they were
        other.__dict__.update({key: value for key, value in self.__dict__.items() if key in _SCALE_FREE})
        return other

    @property
    def log_unit(self) -> float:
        """ln of the stretched unit: the difference between this kernel and ln|x - x'|."""
        return math.log(self.unit * self.factor)

    @cached_property
    def dense(self) -> FloatArray:
        """Dense weights (n+1, n+1) before stretching."""
        weights = logarithmic_weights(self.nodes, self.nodes)
        weights -= math.log(self.unit) * self.quadrature
        return weights

    @cached_property
    def quadrature(self) -> FloatArray:
        """Trapezoidal weights (n+1,) before stretching."""
        return trapezoidal_weights(self.nodes)

    @cached_property
    def depth(self) -> int:
        """Number of levels, for leaves of about `LEAF` nodes."""
        return tree_depth(len(self.nodes) - 2, LEAF)

    @cached_property
    def leaf(self) -> int:
        """Interior nodes in a diagonal block; the last blocks are padded."""
        return math.ceil((len(self.nodes) - 2) / 2**self.depth)

    @cached_property
    def rows(self) -> FloatArray:
        """Weights (3, n+1) at nodes 0, 1 and n."""
        weights = logarithmic_weights(self.nodes[[0, 1, -1]], self.nodes)
        return weights - math.log(self.unit) * self.quadrature

    @cached_property
    def ends(self) -> FloatArray:
        """Weights (n+1, 2) of the hats at nodes 0 and n, at every node."""
        n = len(self.nodes) - 1
        out = np.empty((n + 1, 2))
        _fill_weights(out[:, :1], self.nodes, self.nodes, 0)
        _fill_weights(out[:, 1:], self.nodes, self.nodes, n)
        return out - math.log(self.unit) * self.quadrature[[0, -1]]

    @cached_property
    def blocks(self) -> FloatArray:
        """Diagonal blocks (leaves, leaf + 2, leaf): rows of a leaf with one row before and one after, columns of the
        leaf."""
        n, size = len(self.nodes) - 1, self.leaf
        out = np.zeros((2**self.depth, size + 2, size))
        for k in range(2**self.depth):
            start, stop = 1 + k * size, min(1 + (k + 1) * size, n)
            out[k, : stop - start + 2, : stop - start] = self.block(start, stop)
        return out

    def block(self, first: int, last: int) -> FloatArray:
        """Return the weights of interior nodes first .. last - 1, at these, one node before and one after, before
        stretching."""
        out = np.empty((last - first + 2, last - first))
        _fill_weights(out, self.nodes[first - 1 : last + 1], self.nodes, first)
        return out - math.log(self.unit) * self.quadrature[first:last]

    @cached_property
    def levels(self) -> tuple[Level, ...]:
        """Couplings of all levels, from two clusters down to the leaves."""
        return tuple(self._level(2 ** (k + 1)) for k in range(self.depth))

    def _level(self, clusters: int) -> Level:
        """Return the couplings between `clusters` clusters."""
        n = len(self.nodes) - 1
        size = self.leaf * (2**self.depth // clusters)
        found, coarse_rank = [], 0
        edge = np.zeros((clusters, size))
        for k in range(clusters):
            other = k ^ 1
            start, stop = 1 + k * size, min(1 + (k + 1) * size, n)
            first, last = 1 + other * size, min(1 + (other + 1) * size, n)
            even = k % 2 == 0  # the neighbour's columns lie to the right
            rows = (start - 1, stop) if even else (start, stop + 1)
            pivot = stop - 1 if even else start
            rank, left, right = _cross_approximation(
                self.nodes,
                rows,
                (first, last),
                pivot,
                self.unit,
                (CROSS_TOLERANCE, NEWTON_CROSS_TOLERANCE),
                LARGEST_RANK,
            )
            coarse_rank = max(coarse_rank, rank)
            found.append((k, rows[0] - (start - 1), left.T, right.T))
            row = stop - 1 if even else start
            part = np.empty((1, stop - start))
            _fill_weights(part, self.nodes[row : row + 1], self.nodes, start)
            edge[k, : stop - start] = part[0] - math.log(self.unit) * self.quadrature[start:stop]
        rank = max(left.shape[1] for _, _, left, _ in found)
        lefts, rights = np.zeros((clusters, size + 2, rank)), np.zeros((clusters, size, rank))
        for k, offset, left, right in found:
            lefts[k, offset : offset + len(left), : left.shape[1]] = left
            rights[k ^ 1, : len(right), : right.shape[1]] = right
        return Level(lefts, rights, edge, coarse_rank)

    def __matmul__(self, pressure: FloatArray) -> FloatArray:
        """Return the integral of p ln(|x - x'|/unit) at the nodes (n+1,)."""
        if not self.hierarchical:
            return np.asarray(self.factor * (self.dense @ pressure))
        n, size = len(self.nodes) - 1, self.leaf
        inner = np.zeros(size * 2**self.depth)
        inner[: n - 1] = pressure[1:-1]
        levels = [(level.left[:, 1:-1], level.right) for level in self.levels]
        out = multiply(self.blocks[:, 1:-1], levels, inner)
        total = self.ends[:, 0] * pressure[0] + self.ends[:, 1] * pressure[-1]
        total[1:-1] += out[: n - 1]
        total[[0, -1]] = self.rows[[0, 2]] @ pressure
        return np.asarray(self.factor * total)


_SCALE_FREE = ("dense", "quadrature", "depth", "leaf", "rows", "ends", "blocks", "levels")
