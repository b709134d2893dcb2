"""Hierarchical matrices against dense ones: product, solution with borders, sizes of leaves."""

import numpy as np
import pytest

from bem.numerics.hodlr import factorise, multiply, tree_depth


def matrix(depth, leaf, rank, columns=0, seed=0):
    """Diagonal blocks, low-rank factors of all levels, border columns, and the dense matrix."""
    rng = np.random.default_rng(seed)
    size = leaf * 2**depth
    blocks = rng.standard_normal((2**depth, leaf, leaf)) + 3 * leaf * np.eye(leaf)
    levels = [
        tuple(rng.standard_normal((2**level, size // 2**level, rank + level)) for _ in range(2))
        for level in range(1, depth + 1)
    ]
    dense = np.zeros((size, size))
    for k, block in enumerate(blocks):
        dense[k * leaf : (k + 1) * leaf, k * leaf : (k + 1) * leaf] = block
    for left, right in levels:
        width = left.shape[1]
        for cluster in range(len(left)):
            rows = slice(cluster * width, (cluster + 1) * width)
            of_sibling = slice((cluster ^ 1) * width, ((cluster ^ 1) + 1) * width)
            dense[rows, of_sibling] = left[cluster] @ right[cluster ^ 1].T
    return blocks, levels, rng.standard_normal((size, columns)), dense


@pytest.mark.parametrize("depth", [1, 2, 4])
def test_product_is_that_of_the_dense_matrix(depth):
    blocks, levels, _, dense = matrix(depth, 5, 2)
    vector = np.random.default_rng(1).standard_normal(len(dense))
    np.testing.assert_allclose(multiply(blocks, levels, vector), dense @ vector, rtol=0, atol=1e-12 * len(dense))


@pytest.mark.parametrize("depth", [1, 2, 4])
@pytest.mark.parametrize("columns", [0, 3])
def test_solution_is_that_of_the_dense_matrix(depth, columns):
    blocks, levels, border, dense = matrix(depth, 5, 2, columns)
    factors, solved = factorise(blocks, levels, [right.shape[2] for _, right in levels], border)
    right = np.random.default_rng(1).standard_normal(len(dense))
    np.testing.assert_allclose(dense @ factors.solve(right), right, rtol=0, atol=1e-10)
    np.testing.assert_allclose(dense @ solved, border, rtol=0, atol=1e-10)


@pytest.mark.parametrize("unknowns", [299, 2058, 19998])
def test_no_leaf_is_empty(unknowns):
    depth = tree_depth(unknowns, 64)
    leaf = -(-unknowns // 2**depth)
    assert (2**depth - 1) * leaf < unknowns <= 2**depth * leaf
