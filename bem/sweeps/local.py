"""Points on this machine: one process per worker, replaced when it dies."""

from __future__ import annotations

import multiprocessing
import signal
from collections import deque
from collections.abc import Iterable, Iterator
from contextlib import suppress
from multiprocessing.connection import Connection, wait
from typing import Any

from bem.sweeps.point import Done, Point, compute

_ATTEMPTS = 3
"""How often a point may take its process down (memory, a crash) before it is given up."""


class _Worker:
    """A process that computes points one after the other."""

    def __init__(self) -> None:
        context = multiprocessing.get_context("spawn")
        self.connection, theirs = context.Pipe()
        self.process = context.Process(target=_serve, args=(theirs,), daemon=True)
        self.process.start()
        theirs.close()  # so that the death of the process is the end of the pipe
        self.point: Point | None = None

    def give(self, point: Point) -> None:
        self.point = point
        self.connection.send(point)

    def end(self) -> None:
        self.connection.close()
        self.process.terminate()
        self.process.join()


def compute_locally(points: Iterable[Point], workers: int) -> Iterator[Done]:
    """Compute points in that many processes, yielding each as it ends.

    A process that dies is replaced and its point given out again, three times in all. Leaving the iteration early ends
    all processes; points they were at can be resumed.
    """
    waiting = deque((point, 1) for point in points)
    attempts: dict[int, int] = {}
    staff: list[_Worker] = []
    try:
        while waiting or any(worker.point is not None for worker in staff):
            for worker in staff:
                if worker.point is None and waiting:
                    _hand_out(worker, waiting, attempts)
            while waiting and len(staff) < workers:
                staff.append(_Worker())
                _hand_out(staff[-1], waiting, attempts)
            by_connection: dict[Any, _Worker] = {
                worker.connection: worker for worker in staff if worker.point is not None
            }
            for connection in wait(list(by_connection)):
                worker = by_connection[connection]
                point = worker.point
                assert point is not None
                try:
                    done = worker.connection.recv()
                except (EOFError, OSError):
                    staff.remove(worker)
                    worker.end()
                    code = worker.process.exitcode
                    if attempts[point.index] < _ATTEMPTS:
                        waiting.append((point, attempts[point.index] + 1))
                        continue
                    done = Done(point.index, f"its process died {_ATTEMPTS} times (exit code {code}), out of memory?")
                worker.point = None
                yield done
    finally:
        for worker in staff:
            worker.end()


def _hand_out(worker: _Worker, waiting: deque[tuple[Point, int]], attempts: dict[int, int]) -> None:
    point, attempt = waiting.popleft()
    attempts[point.index] = attempt
    with suppress(OSError):  # it died while idle: the end of its pipe says so in the next round
        worker.give(point)


def _serve(connection: Connection) -> None:
    """A worker's life: points in, results out, until the pipe closes."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the terminal interrupts all; the parent decides
    while True:
        try:
            point = connection.recv()
        except (EOFError, OSError):
            return
        try:
            done = compute(point)
        except Exception as error:
            done = Done(point.index, f"{type(error).__name__}: {error}")
        connection.send(done)
