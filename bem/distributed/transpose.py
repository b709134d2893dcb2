"""Transposition of a field among ranks: from own rows of all columns to own columns of all rows, and back.

Each is one all-to-all exchange. A rank cuts its rows at the edges of the columns that the others own; the blocks that
it receives, one above the other, are its columns.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

from numpy.typing import NDArray

from bem.distributed.ranks import Ranks, edges

Array = NDArray[Any]


def blocks_of_columns(buffer: Array, rows: int, bounds: list[int]) -> list[Array]:
    """Return views of a one-dimensional buffer, one above the other: for each rank the (rows, its columns)."""
    views, start = [], 0
    for first, last in pairwise(bounds):
        size = rows * (last - first)
        views.append(buffer[start : start + size].reshape(rows, last - first))
        start += size
    return views


def to_columns(buffer: Array, shape: tuple[int, int], ranks: Ranks) -> Array:
    """Exchange own rows of all columns for own columns of all rows (rows of all ranks, own columns).

    buffer : the own rows as `blocks_of_columns`. shape : (rows of all ranks, columns of all ranks).
    """
    sent, received, own = _sizes(shape, ranks)
    return ranks.all_to_all(buffer, sent, received).reshape(shape[0], own)


def to_rows(columns: Array, shape: tuple[int, int], ranks: Ranks) -> Array:
    """Exchange own columns of all rows for own rows of all columns, as `blocks_of_columns`: the way back."""
    received, sent, _ = _sizes(shape, ranks)
    return ranks.all_to_all(columns.reshape(-1), sent, received)


def _sizes(shape: tuple[int, int], ranks: Ranks) -> tuple[list[int], list[int], int]:
    """Return numbers of entries of own rows by the columns of each rank, of own columns by rows, and own columns."""
    rows, columns = edges(shape[0], ranks.size), edges(shape[1], ranks.size)
    own_rows = rows[ranks.rank + 1] - rows[ranks.rank]
    own_columns = columns[ranks.rank + 1] - columns[ranks.rank]
    by_columns = [own_rows * (last - first) for first, last in pairwise(columns)]
    by_rows = [own_columns * (last - first) for first, last in pairwise(rows)]
    return by_columns, by_rows, own_columns
