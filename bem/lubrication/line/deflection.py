"""Deflection of a half-plane under a line-contact pressure that is linear between nodes.

For many nodes the weights are kept hierarchically (HODLR): dense blocks on the diagonal, and for each pair of
neighbouring halves a product of two thin matrices by adaptive cross approximation (Bebendorf 2000), since ln|x - x'|
is smooth away from x = x'. Storage, product and the solution of Newton's equations then grow like n (ln n)^2.
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

DEFLECTION = 4 / math.pi
"""Times the weights and the pressures in similarity variables (`newton`): by how much a film is thinner."""
HIERARCHICAL_FROM = 300
"""Cells from which weights are kept hierarchically; below, dense matrices are as fast."""
LEAF = 64
CROSS_TOLERANCE = 1e-11
"""Of the kernel between two halves. A film is up to 1e4 times thinner than what the kernel adds up to: 1e-7 of it."""
ROUGH_TOLERANCE = 1e-6
"""Of the same in Newton's equations, which need not be solved exactly: as many steps, a quarter less work each."""
LARGEST_RANK = 48
UNIT_REACH = 4.0
"""Distances are measured in this many lengths of the mesh: -ln is then positive everywhere, every block definite."""


_OF_MOMENTS = tuple(1 / (k * (k + 1) * (k + 2)) for k in range(1, 14))
"""What the k-th powers of a hat's half-widths over a distance are worth of ln, seen from there."""


@compiled
def _primitive(t: float) -> float:
    """Second primitive of ln|t|: t^2/2 ln|t| - 3 t^2/4."""
    return 0.0 if t == 0 else t * t * (0.5 * math.log(abs(t)) - 0.75)


@compiled
def _weight(t: float, left: float, right: float) -> float:
    """Integral of a hat of half-widths `left`, `right` (0: half a hat) times ln|t - s|, t from the hat's node.

    Near: the second difference of the second primitive. Far: moments of the hat, where that difference would cancel.
    """
    width = max(left, right)
    if abs(t) <= 12 * width:
        first = 0.0 if t == 0 else t * (math.log(abs(t)) - 1)
        total = 0.0
        if right > 0:
            total += (_primitive(t - right) - _primitive(t)) / right + first
        if left > 0:
            total -= (_primitive(t) - _primitive(t + left)) / left + first
        return total
    total = 0.5 * (left + right) * math.log(abs(t))
    inverse = 1 / t
    ratio_right, ratio_left, size = right * inverse, -left * inverse, width * abs(inverse)
    power_right, power_left, reach = right, left, 1.0
    for share in _OF_MOMENTS:
        power_right *= ratio_right
        power_left *= ratio_left
        reach *= size
        if reach * share < 1e-17:
            break
        total -= (power_right + power_left) * share
    return total


@compiled
def _fill(out: FloatArray, targets: FloatArray, nodes: FloatArray, first: int) -> None:
    """Rows of weights for hats at nodes first, first + 1, ... at the targets."""
    last = len(nodes) - 1
    for j in range(out.shape[1]):
        k = first + j
        left = nodes[k] - nodes[k - 1] if k > 0 else 0.0
        right = nodes[k + 1] - nodes[k] if k < last else 0.0
        for i in range(len(targets)):
            out[i, j] = _weight(targets[i] - nodes[k], left, right)


@compiled
def _mean(nodes: FloatArray, i: int, k: int, log_unit: float) -> float:
    """The kernel ln(|x - x'|/unit) at node i, averaged over the hat of interior node k."""
    before, after = nodes[k] - nodes[k - 1], nodes[k + 1] - nodes[k]
    return _weight(nodes[i] - nodes[k], before, after) / (0.5 * (before + after)) - log_unit


@compiled
def _missing_row(
    out: FloatArray, nodes: FloatArray, i: int, first: int, log_unit: float, of_row: FloatArray, right: FloatArray
) -> None:
    """Node i's row of the kernel over columns first, first + 1, ... less what the products have of it."""
    for j in range(len(out)):
        out[j] = _mean(nodes, i, first + j, log_unit)
    for r in range(len(of_row)):
        for j in range(len(out)):
            out[j] -= of_row[r] * right[r, j]


@compiled
def _missing_column(
    out: FloatArray, nodes: FloatArray, k: int, first: int, log_unit: float, left: FloatArray, of_column: FloatArray
) -> None:
    """Node k's column of the kernel at rows first, first + 1, ... less what the products have of it."""
    for i in range(len(out)):
        out[i] = _mean(nodes, first + i, k, log_unit)
    for r in range(len(of_column)):
        for i in range(len(out)):
            out[i] -= left[r, i] * of_column[r]


@compiled
def _dot(one: FloatArray, other: FloatArray) -> float:
    """In four sums, which a processor adds up side by side."""
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
    """Where `values` is largest among those not used yet; -1 where all are."""
    best, found = -1.0, -1
    for i in range(len(values)):
        if not used[i] and abs(values[i]) > best:
            best, found = abs(values[i]), i
    return found


@compiled
def _cross(
    nodes: FloatArray,
    rows: tuple[int, int],
    columns: tuple[int, int],
    pivot: int,
    unit: float,
    tolerances: tuple[float, float],
    rank: int,
) -> tuple[int, FloatArray, FloatArray]:
    """Adaptive cross approximation of the kernel ln(|x - x'|/unit) between ranges of rows and of columns, with hats at
    the columns, from row `pivot` on.

    Returns how many of the products are good to the second of the tolerances, and all of them, good to the first:
    (rank, rows), (rank, columns).
    """
    row0, col0, height, width = rows[0], columns[0], rows[1] - rows[0], columns[1] - columns[0]
    rank = min(rank, height, width)
    left, right = np.zeros((rank, height)), np.zeros((rank, width))
    log_unit = math.log(unit)
    used = np.zeros(height, dtype=np.bool_)
    squared = 0.0
    row, done, short = pivot - row0, 0, 0
    while done < rank and row >= 0:
        used[row] = True
        _missing_row(right[done], nodes, row0 + row, col0, log_unit, left[:done, row], right)
        col = int(np.argmax(np.abs(right[done])))
        top = right[done, col]
        if top == 0.0:
            break
        _missing_column(left[done], nodes, col0 + col, row0, log_unit, left, right[:done, col])
        left[done] /= top
        new = _dot(left[done], left[done]) * _dot(right[done], right[done])
        squared += new
        for r in range(done):
            squared += 2 * _dot(left[r], left[done]) * _dot(right[r], right[done])
        done += 1
        if short == 0 and new <= tolerances[1] ** 2 * squared:
            short = done
        if new <= tolerances[0] ** 2 * squared:
            break
        row = _largest_unused(left[done - 1], used)
    for j in range(width):
        right[:done, j] *= 0.5 * (nodes[col0 + j + 1] - nodes[col0 + j - 1])
    return (short if short > 0 else done), left[:done], right[:done]


def logarithmic_weights(targets: FloatArray, nodes: FloatArray) -> FloatArray:
    """Weights W with `W @ p = integral of p(x') ln|x - x'| dx'` at the targets, p linear between the nodes.

    Exact: the second difference over the nodes of t^2/2 ln|t| - 3 t^2/4, the second primitive of ln|t|;
    at the two ends the first primitive t ln|t| - t closes the half hat.
    The deflection of both bodies is -2/(pi E*) times this, up to a constant that the load fixes.

    Parameters
    ----------
    targets : (m,) positions, any order.
    nodes : (n,) ascending positions, n >= 2, in the same unit.

    Returns
    -------
    (m, n) weights, in that unit.
    """
    weights = np.empty((len(targets), len(nodes)))
    _fill(weights, np.ascontiguousarray(targets, dtype=np.float64), np.ascontiguousarray(nodes, dtype=np.float64), 0)
    return weights


GROUP = 64
"""Cells that are seen as one from far away."""
MOMENTS = 30
"""Of a group, seen from three times its half-width or farther: 3^-30 is below rounding."""


@compiled
def _group_seen(targets: FloatArray, nodes: FloatArray, pressure: FloatArray, out: FloatArray) -> None:
    """Add the integral of the pressure between the first and the last of the nodes times ln|t - s| at the targets t."""
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
                out[i] += pressure[k] * _weight(targets[i] - nodes[k], left, right)


@compiled
def logarithmic_integral(targets: FloatArray, nodes: FloatArray, pressure: FloatArray) -> FloatArray:
    """`logarithmic_weights(targets, nodes) @ pressure`, groups of cells by their moments where they are far away: to
    rounding the same, and for many nodes a tenth of the work."""
    out = np.zeros(len(targets))
    for first in range(0, len(nodes) - 1, GROUP):
        last = min(first + GROUP, len(nodes) - 1) + 1
        _group_seen(targets, nodes[first:last], pressure[first:last], out)
    return out


@dataclass(frozen=True, eq=False)
class Level:
    """One division of the interior nodes into 2^k clusters, in pairs of neighbours: rows of one, columns of the other.

    left : (clusters, size + 2, rank), rows of a cluster, with the row before and the row after it.
    right : (clusters, size, rank), columns of a cluster, as its neighbour's rows see them.
    edge : (clusters, size), columns of a cluster as the first row seen from the neighbour *inside* it: its own row
        next to the neighbour.
    short : the first columns of `left` and `right` that Newton's equations take.
    """

    left: FloatArray
    right: FloatArray
    edge: FloatArray
    short: int


@dataclass(frozen=True, eq=False)
class LineOperator:
    """Weights of ln(|x - x'|/unit) from nodes to the same nodes, dense or hierarchical; `self @ p`.

    nodes : (n+1,) ascending. unit : length. Multiplying all lengths by a factor multiplies the weights by it, so
    `factor` stands for that and a stretched operator shares its arrays. n counts the cells.
    """

    nodes: FloatArray
    unit: float
    factor: float = 1.0

    @classmethod
    def of(cls, nodes: FloatArray) -> LineOperator:
        """The operator of a mesh."""
        return cls(nodes, UNIT_REACH * float(nodes[-1] - nodes[0]))

    @property
    def hierarchical(self) -> bool:
        """Return True if weights are kept hierarchically."""
        return len(self.nodes) > HIERARCHICAL_FROM

    def stretched(self, factor: float) -> LineOperator:
        """The operator of the same mesh with lengths multiplied."""
        other = replace(self, factor=self.factor * factor)
        # the arrays are those of the nodes as they were
        other.__dict__.update({key: value for key, value in self.__dict__.items() if key in _SHARED})
        return other

    @property
    def log_unit(self) -> float:
        """ln of the unit, stretched: what separates this kernel from ln|x - x'|."""
        return math.log(self.unit * self.factor)

    @cached_property
    def dense(self) -> FloatArray:
        """(n+1, n+1) weights of the mesh before stretching."""
        weights = logarithmic_weights(self.nodes, self.nodes)
        weights -= math.log(self.unit) * self.quadrature
        return weights

    @cached_property
    def quadrature(self) -> FloatArray:
        """Trapezoidal weights of the mesh before stretching."""
        return trapezoidal_weights(self.nodes)

    @cached_property
    def depth(self) -> int:
        """Number of levels: leaves of about `LEAF` nodes, fewer where the last of them would be empty."""
        interior = len(self.nodes) - 2
        levels = max(1, math.ceil(math.log2(interior / LEAF)))
        while (2**levels - 1) * math.ceil(interior / 2**levels) >= interior:
            levels -= 1
        return levels

    @cached_property
    def leaf(self) -> int:
        """Interior nodes in a diagonal block; the last ones are filled up."""
        return math.ceil((len(self.nodes) - 2) / 2**self.depth)

    @cached_property
    def rows(self) -> FloatArray:
        """Weights at nodes 0, 1 and n: (3, n+1)."""
        weights = logarithmic_weights(self.nodes[[0, 1, -1]], self.nodes)
        return weights - math.log(self.unit) * self.quadrature

    @cached_property
    def ends(self) -> FloatArray:
        """Weights of the hats at nodes 0 and n at every node: (n+1, 2)."""
        n = len(self.nodes) - 1
        out = np.empty((n + 1, 2))
        _fill(out[:, :1], self.nodes, self.nodes, 0)
        _fill(out[:, 1:], self.nodes, self.nodes, n)
        return out - math.log(self.unit) * self.quadrature[[0, -1]]

    @cached_property
    def blocks(self) -> FloatArray:
        """Diagonal blocks, (leaves, leaf + 2, leaf): rows of a leaf with one before and one after, columns of it."""
        n, size = len(self.nodes) - 1, self.leaf
        out = np.zeros((2**self.depth, size + 2, size))
        for k in range(2**self.depth):
            start, stop = 1 + k * size, min(1 + (k + 1) * size, n)
            out[k, : stop - start + 2, : stop - start] = self.block(start, stop)
        return out

    def block(self, first: int, last: int) -> FloatArray:
        """Weights of the interior nodes first .. last - 1 at these, one before and one after, before stretching."""
        out = np.empty((last - first + 2, last - first))
        _fill(out, self.nodes[first - 1 : last + 1], self.nodes, first)
        return out - math.log(self.unit) * self.quadrature[first:last]

    @cached_property
    def levels(self) -> tuple[Level, ...]:
        """From two halves down to the leaves."""
        return tuple(self._level(2 ** (k + 1)) for k in range(self.depth))

    def _level(self, clusters: int) -> Level:
        n = len(self.nodes) - 1
        size = self.leaf * (2**self.depth // clusters)
        found, short = [], 0
        edge = np.zeros((clusters, size))
        for k in range(clusters):
            other = k ^ 1
            start, stop = 1 + k * size, min(1 + (k + 1) * size, n)
            first, last = 1 + other * size, min(1 + (other + 1) * size, n)
            even = k % 2 == 0  # the neighbour's columns lie to the right
            rows = (start - 1, stop) if even else (start, stop + 1)
            pivot = stop - 1 if even else start
            rank, left, right = _cross(
                self.nodes, rows, (first, last), pivot, self.unit, (CROSS_TOLERANCE, ROUGH_TOLERANCE), LARGEST_RANK
            )
            short = max(short, rank)
            found.append((k, rows[0] - (start - 1), left.T, right.T))
            row = stop - 1 if even else start
            part = np.empty((1, stop - start))
            _fill(part, self.nodes[row : row + 1], self.nodes, start)
            edge[k, : stop - start] = part[0] - math.log(self.unit) * self.quadrature[start:stop]
        rank = max(left.shape[1] for _, _, left, _ in found)
        lefts, rights = np.zeros((clusters, size + 2, rank)), np.zeros((clusters, size, rank))
        for k, offset, left, right in found:
            lefts[k, offset : offset + len(left), : left.shape[1]] = left
            rights[k ^ 1, : len(right), : right.shape[1]] = right
        return Level(lefts, rights, edge, short)

    def __matmul__(self, pressure: FloatArray) -> FloatArray:
        """Integral of p ln(|x - x'|/unit) at the nodes."""
        if not self.hierarchical:
            return np.asarray(self.factor * (self.dense @ pressure))
        n, size = len(self.nodes) - 1, self.leaf
        inner = np.zeros(size * 2**self.depth)
        inner[: n - 1] = pressure[1:-1]
        out = np.matmul(self.blocks[:, 1:-1], inner.reshape(-1, size, 1)).ravel()
        for level in self.levels:
            clusters, width, _ = level.right.shape
            seen = np.matmul(level.right.transpose(0, 2, 1), inner.reshape(clusters, width, 1))
            swapped = seen.reshape(-1, 2, *seen.shape[1:])[:, ::-1].reshape(seen.shape)
            out += np.matmul(level.left[:, 1:-1], swapped).ravel()
        total = self.ends[:, 0] * pressure[0] + self.ends[:, 1] * pressure[-1]
        total[1:-1] += out[: n - 1]
        total[[0, -1]] = self.rows[[0, 2]] @ pressure
        return np.asarray(self.factor * total)


_SHARED = ("dense", "quadrature", "depth", "leaf", "rows", "ends", "blocks", "levels")
