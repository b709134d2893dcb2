"""Ranks of a parallel run: which rows each owns, and the few exchanges that the solver needs.

`Ranks` is the protocol. `OneRank` is a single process; `bem.distributed.mpi.MpiRanks` has one process a rank.
Reductions gather one value a row, and every rank adds them in the order of the rows. A sum is therefore the same to the
last bit on any number of ranks.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

Array = NDArray[Any]
_Value = TypeVar("_Value")


@dataclass
class ExchangeCount:
    """Number of collective exchanges of a rank.

    transposes : all-to-all exchanges of a whole field. reductions : gathers of one value or a few for each row.
    """

    transposes: int = 0
    reductions: int = 0


class Ranks(Protocol):
    """The processes that share one contact. All methods are collective: every rank calls them in the same order.

    rank, size : number of this process, from zero, and number of processes.
    count : exchanges so far.
    """

    rank: int
    size: int
    count: ExchangeCount

    def allgather_rows(self, rows: Array, total: int) -> Array:
        """Return the rows of all ranks together (total, k) from those of each rank (own, k)."""

    def all_to_all(self, blocks: Array, sent: list[int], received: list[int]) -> Array:
        """Send a block of entries to every rank and return the blocks received, both in the order of the ranks.

        blocks : one-dimensional, `sent[j]` entries for rank j. received : number of entries from each rank.
        """

    def broadcast(self, value: _Value) -> _Value:
        """Return the value of rank 0 on every rank."""

    def scatter_rows(self, field: Array | None, rows: Array) -> None:
        """Write each rank's rows of a field to `rows`; only rank 0 has the field."""

    def collect_rows(self, rows: Array, field: Array | None) -> None:
        """Write the rows of all ranks to the field of rank 0."""


@dataclass
class OneRank:
    """A single process that owns all rows; see `Ranks`."""

    rank: int = 0
    size: int = 1
    count: ExchangeCount = field(default_factory=ExchangeCount)

    def allgather_rows(self, rows: Array, total: int) -> Array:
        """See `Ranks`."""
        self.count.reductions += 1
        return rows

    def all_to_all(self, blocks: Array, sent: list[int], received: list[int]) -> Array:
        """See `Ranks`."""
        self.count.transposes += 1
        return blocks

    def broadcast(self, value: _Value) -> _Value:
        """See `Ranks`."""
        return value

    def scatter_rows(self, field: Array | None, rows: Array) -> None:
        """See `Ranks`."""
        rows[...] = field

    def collect_rows(self, rows: Array, field: Array | None) -> None:
        """See `Ranks`."""
        if field is not None:
            field[...] = rows


def edges(count: int, parts: int) -> list[int]:
    """Return the edges (parts + 1,) that divide a number of rows or columns into parts as equal as possible."""
    return [part * count // parts for part in range(parts + 1)]


def own_slice(count: int, ranks: Ranks) -> slice:
    """Return the rows or columns of a number of them that this rank owns."""
    bounds = edges(count, ranks.size)
    return slice(bounds[ranks.rank], bounds[ranks.rank + 1])


def own_length(count: int, ranks: Ranks, rank: int) -> int:
    """Return how many of a number of rows or columns a rank owns."""
    bounds = edges(count, ranks.size)
    return bounds[rank + 1] - bounds[rank]


def computed_on_first(ranks: Ranks, function: Callable[[], _Value]) -> _Value:
    """Return the result of a function that only rank 0 calls.

    Raises
    ------
    Exception : what the function raises, on all ranks.
    """
    value: Any = None
    failure: Exception | None = None
    if ranks.rank == 0:
        try:
            value = function()
        except Exception as error:
            failure = error
    value, failure = ranks.broadcast((value, failure))
    if failure is not None:
        raise failure
    return value


def reduce_rows(
    ranks: Ranks, total: int, sums: tuple[Array, ...] = (), maxima: tuple[Array, ...] = ()
) -> tuple[list[float], list[float]]:
    """Return sums and maxima over all rows of all ranks, from one value for each own row.

    sums, maxima : each (own rows,). total : number of rows of all ranks.
    """
    values = np.stack([np.asarray(column, np.float64) for column in (*sums, *maxima)], axis=1)
    everywhere = ranks.allgather_rows(values, total)
    added = [float(everywhere[:, k].sum()) for k in range(len(sums))]
    return added, [float(everywhere[:, len(sums) + k].max()) for k in range(len(maxima))]
