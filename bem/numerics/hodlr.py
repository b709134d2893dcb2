"""Hierarchical off-diagonal low-rank (HODLR) matrices: product with a vector, and direct solution.

The unknowns are divided by halves into 2^depth leaves. The matrix is the dense diagonal blocks of the leaves plus, on
every level, a product of two thin matrices for each pair of sibling clusters: rows of cluster c couple to its sibling s
by L_c R_s'. With n unknowns and ranks r, storage and product cost O(n r log n), a factorisation O(n r^2 log^2 n).

`factorise` eliminates from the leaves up. A level that is solved cluster by cluster is coupled pair by pair with
Woodbury's formula: for z_1 = R_2' x_2 and z_2 = R_1' x_1,

    x_c = y_c - Y_c z_c,    y = solution of the clusters alone,    Y_c = (cluster c)^-1 L_c,

and the z of a pair solve a dense system of 2 r equations (S. Ambikasaran and E. Darve, J. Sci. Comput. 57 (2013) 477).
Verified in tests/numerics/test_hodlr.py and tests/lubrication/test_line_operator.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

LowRank = tuple[FloatArray, FloatArray]
"""Factors of the couplings of one level: left (clusters, size, rank), right (clusters, size, rank). Rows of cluster c
couple to its sibling by left[c] and the right factor of the sibling."""


def tree_depth(unknowns: int, leaf: int) -> int:
    """Return the number of halvings for leaves of about `leaf` unknowns; fewer where the last leaf would be empty."""
    levels = max(1, math.ceil(math.log2(unknowns / leaf)))
    while (2**levels - 1) * math.ceil(unknowns / 2**levels) >= unknowns:
        levels -= 1
    return levels


def multiply(blocks: FloatArray, levels: Sequence[LowRank], vector: FloatArray) -> FloatArray:
    """Return the product of a HODLR matrix with a vector.

    Parameters
    ----------
    blocks : (leaves, leaf, leaf) diagonal blocks.
    levels : low-rank factors, from two clusters down to the leaves.
    vector : (leaves * leaf,).
    """
    out = np.matmul(blocks, vector.reshape(len(blocks), -1, 1)).ravel()
    for left, right in levels:
        clusters, width, _ = right.shape
        projected = np.matmul(right.transpose(0, 2, 1), vector.reshape(clusters, width, 1))
        of_sibling = projected.reshape(-1, 2, *projected.shape[1:])[:, ::-1].reshape(projected.shape)
        out += np.matmul(left, of_sibling).ravel()
    return np.asarray(out)


@dataclass(frozen=True, eq=False)
class SiblingCoupling:
    """Low-rank coupling of the sibling clusters of one level, prepared for Woodbury's formula.

    right : (clusters, size, rank) right factors R.
    solved : (clusters, size, rank) left factors solved with their own cluster, Y.
    inverse : (pairs, 2 rank, 2 rank) inverse of the systems of the z of the pairs.
    """

    right: FloatArray
    solved: FloatArray
    inverse: FloatArray

    def project(self, values: FloatArray) -> FloatArray:
        """Return R' times the values of the sibling for both clusters of each pair: (clusters, size, k) to
        (pairs, 2 rank, k)."""
        own = self.right.transpose(0, 2, 1) @ values
        return np.concatenate([own[1::2], own[0::2]], axis=1)

    def correct(self, values: FloatArray, projected: FloatArray) -> None:
        """Turn solutions of the clusters alone into solutions of the pairs, in place."""
        clusters, _, rank = self.right.shape
        values -= self.solved @ (self.inverse @ projected).reshape(clusters, rank, -1)


@dataclass(frozen=True, eq=False)
class HodlrFactors:
    """Factorisation of a HODLR matrix.

    leaves : (leaves, leaf, leaf) inverses of the diagonal blocks.
    couplings : of the levels, from the leaves up.
    """

    leaves: FloatArray
    couplings: tuple[SiblingCoupling, ...]

    def solve(self, right: FloatArray) -> FloatArray:
        """Return the solution (n,) of a right-hand side (n,)."""
        values = (self.leaves @ right.reshape(len(self.leaves), -1, 1)).reshape(-1, 1)
        for coupling in self.couplings:
            of_level = values.reshape(len(coupling.right), -1, 1)
            coupling.correct(of_level, coupling.project(of_level))
        return np.asarray(values[:, 0])


def factorise(
    blocks: FloatArray, levels: Iterable[LowRank], ranks: Sequence[int], border: FloatArray
) -> tuple[HodlrFactors, FloatArray]:
    """Factorise a HODLR matrix, and solve it for further columns at once.

    Parameters
    ----------
    blocks : (leaves, leaf, leaf) diagonal blocks.
    levels : low-rank factors, from two clusters down to the leaves; each is asked for once, its left factor dropped.
    ranks : of the levels.
    border : (n, k) columns to solve for.

    Returns
    -------
    The factors, and the solutions (n, k) of the border.
    """
    ends = border.shape[1] + np.concatenate([[0], np.cumsum(ranks)])
    columns = np.empty((len(border), ends[-1]))
    columns[:, : border.shape[1]] = border
    rights = []
    for (left, right), start, end in zip(levels, ends[:-1], ends[1:], strict=True):
        columns[:, start:end] = left.reshape(len(border), -1)
        rights.append(right)
    inverses = np.asarray(np.linalg.inv(blocks), dtype=np.float64)
    columns = np.matmul(inverses, columns.reshape(*inverses.shape[:2], -1)).reshape(columns.shape)
    couplings = tuple(_couple(rights[k], columns, ends[k]) for k in reversed(range(len(rights))))
    return HodlrFactors(inverses, couplings), columns[:, : border.shape[1]]


def _couple(right: FloatArray, columns: FloatArray, start: int) -> SiblingCoupling:
    """Return the coupling of a level whose solved left factors begin at column `start`; columns before `start` are
    corrected in place."""
    clusters, width, rank = right.shape
    of_level = columns.reshape(clusters, width, -1)
    earlier, own = of_level[:, :, :start], np.ascontiguousarray(of_level[:, :, start : start + rank])
    products = right.transpose(0, 2, 1) @ own
    system = np.zeros((clusters // 2, 2 * rank, 2 * rank))
    diagonal = np.arange(2 * rank)
    system[:, diagonal, diagonal] = 1.0
    # z_1 = R_2' x_2 multiplies the left factor of the first cluster, z_2 = R_1' x_1 that of the second one
    system[:, :rank, rank:] = products[1::2]
    system[:, rank:, :rank] = products[0::2]
    coupling = SiblingCoupling(right, own, np.linalg.inv(system))
    coupling.correct(earlier, coupling.project(earlier))
    return coupling
