"""Flow through a network of conductances: conjugate gradients preconditioned by aggregation multigrid.

The matrix is the Laplacian of the network. Its conductances span 1e12 and more, because they are cubes of gaps.
Aggregates are pairs of pairs along the strongest links, so coarse nodes follow the channels and never join across a
weak link (Notay, Electronic Transactions on Numerical Analysis 37 (2010) 123). A K-cycle takes two steps of conjugate
gradients on every level, which makes the number of iterations nearly independent of size and contrast (Notay and
Vassilevski, Numerical Linear Algebra with Applications 15 (2008) 473). The smoother is Gauss-Seidel; the coarsest level
is solved by star-to-mesh elimination, which adds positive numbers only.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix

from bem.compiled import compiled
from bem.grid import FloatArray

Index = NDArray[np.int32]

_COARSEST = 120
"""Largest number of nodes that is solved by elimination."""
_STRONG = 0.1
"""Smallest conductance of a link that joins two nodes, over the smaller diagonal of the two."""
_ONE_STEP = 0.25
"""Relative residual of a coarse level below which one step of conjugate gradients is enough."""
_CHECKS = 4
"""Largest number of times that the recomputed residual may be too large although the updated residual is not."""
_AIM = 0.5
"""Goal of the updated residual over the allowed residual; the updated residual drifts by round-off."""
_LARGEST_RATIO = 0.9
"""Largest number of aggregates over nodes for which a coarser level is built."""


@dataclass(frozen=True, eq=False)
class Network:
    """Graph Laplacian in compressed rows; each link is stored at both its ends.

    Attributes
    ----------
    start : (nodes + 1,); the links of node i are entries `start[i]` to `start[i + 1]`.
    neighbour : node at the other end of each link.
    conductance : of each link.
    diagonal : (nodes,), sum of a node's conductances.
    """

    start: Index
    neighbour: Index
    conductance: FloatArray
    diagonal: FloatArray

    @property
    def nodes(self) -> int:
        """Number of nodes."""
        return len(self.diagonal)

    @classmethod
    def of_links(cls, nodes: int, first: Index, second: Index, conductance: FloatArray) -> Network:
        """Build a network from a list of links; parallel links add up, and links of a node with itself are dropped."""
        kept = (first != second) & (conductance > 0)
        a, b, value = first[kept], second[kept], conductance[kept]
        both = (np.concatenate([value, value]), (np.concatenate([a, b]), np.concatenate([b, a])))
        matrix = coo_matrix(both, shape=(nodes, nodes)).tocsr()
        matrix.sort_indices()
        start, neighbour = matrix.indptr.astype(np.int32), matrix.indices.astype(np.int32)
        return cls(start, neighbour, matrix.data, _row_sums(start, matrix.data))

    def residual(self, potential: FloatArray, source: FloatArray) -> FloatArray:
        """Return the residual, source less matrix times potential, (nodes,)."""
        return np.asarray(_residual(self.start, self.neighbour, self.conductance, self.diagonal, potential, source))

    def aggregated(self, group: Index, groups: int) -> Network:
        """Return the coarse network, whose nodes are the aggregates.

        group : (nodes,), aggregate of each node, -1 for none. groups : number of aggregates.
        """
        row = np.repeat(np.arange(self.nodes), np.diff(self.start))
        once = row < self.neighbour
        a, b = group[row[once]], group[self.neighbour[once]]
        both = (a >= 0) & (b >= 0)
        return Network.of_links(groups, a[both], b[both], self.conductance[once][both])


@dataclass(frozen=True, eq=False)
class _Level:
    """A network, and the aggregate of each of its nodes on the next coarser level."""

    network: Network
    group: Index


@dataclass(frozen=True, eq=False)
class Hierarchy:
    """Multigrid hierarchy; the coarsest network is solved by elimination with `factors` and `pivots`."""

    levels: tuple[_Level, ...]
    coarsest: Network
    factors: FloatArray
    pivots: FloatArray

    @classmethod
    def of(cls, network: Network) -> Hierarchy:
        """Build the hierarchy of a network."""
        levels: list[_Level] = []
        while network.nodes > _COARSEST:
            group, groups = _aggregates(network)
            if groups > _LARGEST_RATIO * network.nodes:
                break
            levels.append(_Level(network, group))
            network = network.aggregated(group, groups)
        return cls(tuple(levels), network, *_eliminate(network))

    def apply(self, residual: FloatArray, depth: int = 0) -> FloatArray:
        """Apply one cycle from a level on: pre-smoothing, coarse-grid correction, post-smoothing."""
        if depth == len(self.levels):
            return np.asarray(_substitute(self.factors, self.pivots, residual))
        level = self.levels[depth]
        network, group = level.network, level.group
        parts = (network.start, network.neighbour, network.conductance, network.diagonal)
        potential = np.zeros(network.nodes)
        _relax(*parts, potential, residual, True)
        coarse_nodes = self.levels[depth + 1].network.nodes if depth + 1 < len(self.levels) else self.coarsest.nodes
        coarse = self._solve_level(_restrict_residual(*parts, potential, residual, group, coarse_nodes), depth + 1)
        _prolong(potential, coarse, group)
        _relax(*parts, potential, residual, False)
        return potential

    def _solve_level(self, right: FloatArray, depth: int) -> FloatArray:
        """Take at most two steps of conjugate gradients on a level, each preconditioned by one cycle (K-cycle)."""
        if depth == len(self.levels):
            return self.apply(right, depth)
        network = self.levels[depth].network
        first = self.apply(right, depth)
        image = -network.residual(first, np.zeros_like(first))
        energy, work = _dot(first, image), _dot(first, right)
        if energy <= 0:
            return first
        length = work / energy
        residual = right - length * image
        if _dot(residual, residual) <= _ONE_STEP**2 * _dot(right, right):
            return length * first
        second = self.apply(residual, depth)
        image_two = -network.residual(second, np.zeros_like(second))
        mixed, energy_two, work_two = _dot(second, image), _dot(second, image_two), _dot(second, residual)
        left = energy_two - mixed**2 / energy
        if left <= 0:
            return length * first
        return (length - mixed * work_two / (energy * left)) * first + work_two / left * second


def solve_network(
    network: Network, source: FloatArray, max_residual: Callable[[FloatArray], float], max_iterations: int
) -> tuple[FloatArray, int]:
    """Solve for the potentials under sources that sum to zero over every connected part of the network.

    Parameters
    ----------
    network : the nodes and links.
    source : (nodes,), flow into each node.
    max_residual : bound on the 1-norm of the residual, as a function of the potentials.
    max_iterations : limit of the iterations.

    Returns
    -------
    Potentials (up to a constant in every part), and the number of iterations.
    """
    hierarchy = Hierarchy.of(network)
    nothing = np.zeros(network.nodes)
    potential, residual, direction, image, energy = nothing.copy(), source.copy(), nothing, nothing, 1.0
    checks = 0
    for iteration in range(max_iterations):
        if float(np.abs(residual).sum()) <= _AIM * max_residual(potential):
            residual = network.residual(potential, source)
            checks += 1
            # after several checks the residual is the round-off of the potentials
            if checks == _CHECKS or float(np.abs(residual).sum()) <= max_residual(potential):
                return potential, iteration
        step = hierarchy.apply(residual)
        # flexible conjugate gradients: a K-cycle is not a linear map
        step -= _dot(step, image) / energy * direction
        direction, image = step, -network.residual(step, nothing)
        energy = _dot(direction, image)
        if not energy > 0:
            return potential, iteration
        length = _dot(direction, residual) / energy
        potential += length * direction
        residual -= length * image
    return potential, max_iterations


def _aggregates(network: Network) -> tuple[Index, int]:
    """Return aggregates of about four nodes, pairs of pairs, and their number.

    Links are weighed against the sum of the diagonals of the original nodes, because the smoother must reduce the error
    inside an aggregate. A dead end behind a throat so stays a node of its own until it has no other link.
    """
    first, pairs = _pair_nodes(network.start, network.neighbour, network.conductance, network.diagonal)
    paired_network = network.aggregated(first, pairs)
    weight = np.bincount(first[first >= 0], network.diagonal[first >= 0], pairs)
    second, groups = _pair_nodes(paired_network.start, paired_network.neighbour, paired_network.conductance, weight)
    return np.where(first >= 0, np.append(second, -1)[first], -1).astype(np.int32), int(groups)


def _eliminate(network: Network) -> tuple[FloatArray, FloatArray]:
    """Eliminate node after node, replacing each star by a mesh of links between its neighbours.

    All terms are positive, so weak links between strong ones lose no digit. A node without a link has potential zero.
    """
    conductance = np.zeros((network.nodes, network.nodes))
    row = np.repeat(np.arange(network.nodes), np.diff(network.start))
    conductance[row, network.neighbour] = network.conductance
    factors, pivots = _star_to_mesh(conductance)
    return np.asarray(factors), np.asarray(pivots)


@compiled
def _star_to_mesh(conductance):
    """Return the factors (nodes, nodes) and pivots (nodes,) of the elimination; overwrites `conductance`."""
    nodes = len(conductance)
    pivots = np.zeros(nodes)
    for k in range(nodes):
        for j in range(k + 1, nodes):
            pivots[k] += conductance[k, j]
        if pivots[k] == 0:
            continue
        for i in range(k + 1, nodes):
            share = conductance[k, i] / pivots[k]
            if share > 0:
                for j in range(k + 1, nodes):
                    if j != i:
                        conductance[i, j] += share * conductance[k, j]
        for j in range(k + 1, nodes):
            conductance[k, j] /= pivots[k]
    return conductance, pivots


@compiled
def _substitute(factors, pivots, source):
    """Return the potentials (nodes,) by forward and back substitution."""
    nodes = len(pivots)
    potential = source.copy()
    for k in range(nodes):
        if pivots[k] > 0:
            for j in range(k + 1, nodes):
                potential[j] += factors[k, j] * potential[k]
    for k in range(nodes - 1, -1, -1):
        if pivots[k] > 0:
            potential[k] /= pivots[k]
            for j in range(k + 1, nodes):
                potential[k] += factors[k, j] * potential[j]
        else:
            potential[k] = 0.0
    return potential


@compiled
def _row_sums(start, values):
    """Return the sum of the values of each row of a matrix in compressed rows."""
    sums = np.zeros(len(start) - 1)
    for i in range(len(sums)):
        for k in range(start[i], start[i + 1]):
            sums[i] += values[k]
    return sums


@compiled
def _dot(a, b):
    """Return the scalar product, summed in order."""
    total = 0.0
    for i in range(len(a)):
        total += a[i] * b[i]
    return total


@compiled
def _residual(start, neighbour, conductance, diagonal, potential, source):
    """Return source less matrix times potential, (nodes,)."""
    out = np.empty(len(diagonal))
    for i in range(len(diagonal)):
        # differences, not products: a constant must leave nothing at all
        value, here = source[i], potential[i]
        for k in range(start[i], start[i + 1]):
            value += conductance[k] * (potential[neighbour[k]] - here)
        out[i] = value
    return out


@compiled
def _relax(start, neighbour, conductance, diagonal, potential, source, forward):
    """Apply one Gauss-Seidel sweep, forward or backward."""
    last = len(diagonal) - 1
    for j in range(last + 1):
        i = j if forward else last - j
        if diagonal[i] > 0:
            value = source[i]
            for k in range(start[i], start[i + 1]):
                value += conductance[k] * potential[neighbour[k]]
            potential[i] = value / diagonal[i]


@compiled
def _restrict_residual(start, neighbour, conductance, diagonal, potential, source, group, groups):
    """Return the residual summed over the nodes of each aggregate, (groups,)."""
    out = np.zeros(groups)
    for i in range(len(diagonal)):
        if group[i] >= 0:
            value, here = source[i], potential[i]
            for k in range(start[i], start[i + 1]):
                value += conductance[k] * (potential[neighbour[k]] - here)
            out[group[i]] += value
    return out


@compiled
def _prolong(potential, coarse, group):
    """Add the potential of its aggregate to each node."""
    for i in range(len(potential)):
        if group[i] >= 0:
            potential[i] += coarse[group[i]]


@compiled
def _pair_nodes(start, neighbour, conductance, weight):
    """Pair each node with its free neighbour of the strongest link, and return the pair of each node and their number.

    A node whose strong neighbours are all paired joins the strongest of these pairs: dead ends would otherwise stay
    behind on every level. A node without a link belongs to no pair (-1).
    """
    nodes = len(weight)
    group = np.full(nodes, -2, np.int32)
    paired = np.zeros(nodes, np.bool_)
    count = 0
    for i in range(nodes):
        if group[i] != -2:
            continue
        best, partner = 0.0, -1
        for k in range(start[i], start[i + 1]):
            value, j = conductance[k], neighbour[k]
            if group[j] == -2 and value > best and value >= _STRONG * min(weight[i], weight[j]):
                best, partner = value, j
        if start[i] == start[i + 1]:
            group[i] = -1
        elif partner >= 0:
            group[i] = group[partner] = count
            paired[i] = paired[partner] = True
            count += 1
    for i in range(nodes):
        if group[i] != -2:
            continue
        best, partner = 0.0, -1
        for k in range(start[i], start[i + 1]):
            value, j = conductance[k], neighbour[k]
            # joins pairs only: chains of single nodes would make long aggregates
            if paired[j] and value > best and value >= _STRONG * weight[i]:
                best, partner = value, j
        if partner >= 0:
            group[i] = group[partner]
        else:
            group[i] = count
            count += 1
    return group, count
