"""Ranks that are threads of one process, so that tests of several ranks need no MPI."""

from __future__ import annotations

import queue
import threading
from collections.abc import Callable
from typing import Any

import numpy as np

from bem.distributed.ranks import ExchangeCount, edges


class ThreadRanks:
    """A rank that exchanges arrays with the threads of the other ranks through lists; see `bem.distributed.Ranks`."""

    def __init__(
        self, rank: int, size: int, barrier: threading.Barrier, table: list[Any], letters: list[queue.Queue[Any]]
    ) -> None:
        self.rank, self.size, self.count = rank, size, ExchangeCount()
        self._barrier, self._table, self._letters = barrier, table, letters

    def _all(self, value: Any) -> list[Any]:
        self._table[self.rank] = value
        self._barrier.wait()
        values = list(self._table)
        self._barrier.wait()
        return values

    def allgather_rows(self, rows: np.ndarray, total: int) -> np.ndarray:
        self.count.reductions += 1
        bounds = edges(total, self.size)
        values = self._all(rows.copy())
        assert [len(part) for part in values] == np.diff(bounds).tolist()
        return np.concatenate(values)

    def all_to_all(self, blocks: np.ndarray, sent: list[int], received: list[int]) -> np.ndarray:
        self.count.transposes += 1
        assert blocks.size == sum(sent)
        parts = self._all(np.split(blocks, np.cumsum(sent)[:-1]))
        mine = [part[self.rank].copy() for part in parts]
        self._barrier.wait()
        assert [part.size for part in mine] == received
        return np.concatenate(mine)

    def broadcast(self, value: Any) -> Any:
        return self._all(value)[0]

    def scatter_rows(self, field: np.ndarray | None, rows: np.ndarray) -> None:
        fields, lengths = self._all(field), self._all(len(rows))
        first = sum(lengths[: self.rank])
        rows[...] = fields[0][first : first + len(rows)]
        self._barrier.wait()

    def collect_rows(self, rows: np.ndarray, field: np.ndarray | None) -> None:
        parts = self._all(rows.copy())
        if field is not None:
            field[...] = np.concatenate(parts)

    def send_to_all(self, value: Any) -> None:
        for letters in self._letters[1:]:
            letters.put(value)

    def next_from_first(self) -> Any:
        return self._letters[self.rank].get(timeout=60)

    def abort(self, code: int) -> None:
        self._barrier.abort()
        raise SystemExit(code)


def on_ranks(size: int, function: Callable[[ThreadRanks], Any]) -> list[Any]:
    """Call a function in a thread for each rank; return the results, or raise the first failure."""
    barrier, table = threading.Barrier(size), [None] * size
    letters: list[queue.Queue[Any]] = [queue.Queue() for _ in range(size)]
    results: list[Any] = [None] * size
    failures: list[BaseException] = []

    def work(rank: int) -> None:
        try:
            results[rank] = function(ThreadRanks(rank, size, barrier, table, letters))
        except threading.BrokenBarrierError:
            pass
        except BaseException as error:
            failures.append(error)
            barrier.abort()

    threads = [threading.Thread(target=work, args=(rank,)) for rank in range(size)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if failures:
        raise failures[0]
    return results
