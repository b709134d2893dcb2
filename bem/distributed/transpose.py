"""Transposition of a field among ranks: from own rows of all columns to own columns of all rows, and back.

Each is one all-to-all exchange. A rank cuts its rows at the edges of the columns that the others own; the blocks that
it receives, one above the other, are its columns.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.distributed.ranks import Ranks, edges

Array = NDArray[Any]


def transposed(rows: Array, total: int, ranks: Ranks) -> Array:
    """Return own columns of all rows (total, own columns) from own rows of all columns (own rows, columns)."""
    if ranks.size == 1:
        return ranks.exchange(rows.reshape(-1), [rows.size], [rows.size]).reshape(rows.shape)
    bounds, row_bounds = edges(rows.shape[1], ranks.size), edges(total, ranks.size)
    own = bounds[ranks.rank + 1] - bounds[ranks.rank]
    blocks = [rows[:, first:last].ravel() for first, last in pairwise(bounds)]
    sent = [block.size for block in blocks]
    received = [(last - first) * own for first, last in pairwise(row_bounds)]
    return ranks.exchange(np.concatenate(blocks), sent, received).reshape(total, own)


def transposed_back(columns: Array, width: int, ranks: Ranks) -> Array:
    """Return own rows of all columns (own rows, width) from own columns of all rows: the inverse of `transposed`."""
    if ranks.size == 1:
        return ranks.exchange(columns.reshape(-1), [columns.size], [columns.size]).reshape(columns.shape)
    total, own_columns = columns.shape
    bounds, row_bounds = edges(width, ranks.size), edges(total, ranks.size)
    own_rows = row_bounds[ranks.rank + 1] - row_bounds[ranks.rank]
    sent = [(last - first) * own_columns for first, last in pairwise(row_bounds)]
    received = [own_rows * (last - first) for first, last in pairwise(bounds)]
    blocks = ranks.exchange(np.ascontiguousarray(columns).reshape(-1), sent, received)
    rows = np.empty((own_rows, width), columns.dtype)
    start = 0
    for first, last, size in zip(bounds, bounds[1:], received, strict=False):
        rows[:, first:last] = blocks[start : start + size].reshape(own_rows, last - first)
        start += size
    return rows
