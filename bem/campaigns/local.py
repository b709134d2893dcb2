"""Jobs on this machine: one process per worker, replaced when it dies.

Workers are started as `python -c` with a pipe, not by `multiprocessing`: a script that runs a scene need not guard its
main part, and nothing of it is run again. They import from where this process does, not from the folder it is in
(`-P`), and end with this process, however that ends. The pool is our own because a killed worker is survived here: the
executors of loky and of `concurrent.futures` fail all pending jobs then, and do not say which of them the worker had.
"""

from __future__ import annotations

import gc
import os
import pickle
import signal
import subprocess
import sys
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from multiprocessing.connection import Connection, Pipe, wait
from typing import TYPE_CHECKING, Any

from bem.campaigns.context import Watcher
from bem.extensions import load_extensions

if TYPE_CHECKING:
    from bem.campaigns.job import Sent

ATTEMPTS = 3
"""Deaths of a job's process (memory, a crash) after which the job is given up."""
_SERVE = "from bem.campaigns.local import serve; serve({descriptor})"


Tell = Callable[[int], Watcher]
"""Function that returns the watcher of the job with an index."""


class _Worker:
    """A process that does jobs one after the other."""

    def __init__(self) -> None:
        self.connection, theirs = Pipe()
        paths = [path or os.getcwd() for path in sys.path]
        self.process = subprocess.Popen(
            [sys.executable, "-P", "-c", _SERVE.format(descriptor=theirs.fileno())],
            pass_fds=[theirs.fileno()],
            stdin=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(paths), "OPENBLAS_NUM_THREADS": "1"},
        )
        theirs.close()  # so that the death of the process is the end of the pipe
        self.job: Sent | None = None

    def give(self, job: Sent) -> None:
        self.job = job
        with suppress(OSError):  # it died while idle: the end of its pipe says so in the next round
            self.connection.send(job)

    def end(self) -> None:
        self.connection.close()
        self.process.kill()
        self.process.wait()


def compute_locally(jobs: Iterable[Sent], workers: int, tell: Tell) -> Iterator[tuple[int, Any]]:
    """Do jobs in that many processes, yielding the index and the result of each as it ends.

    A process that dies is replaced and its job given out again, three times in all. Leaving the iteration early ends
    all processes; jobs they were at can be resumed.

    Raises
    ------
    RuntimeError : a job raised what it should have handled: a mistake in the program.
    """
    waiting = deque(jobs)
    attempts: dict[int, int] = {}
    staff: list[_Worker] = []
    try:
        while waiting or any(worker.job is not None for worker in staff):
            while waiting and len(staff) < workers:
                staff.append(_Worker())
                _hand_out(staff[-1], waiting, attempts)
            by_connection: dict[Any, _Worker] = {w.connection: w for w in staff if w.job is not None}
            for connection in wait(list(by_connection)):
                worker = by_connection[connection]
                job = worker.job
                assert job is not None
                try:
                    message = worker.connection.recv()
                except (EOFError, OSError):
                    staff.remove(worker)
                    worker.end()
                    if attempts[job.index] < ATTEMPTS:
                        waiting.append(job)
                        continue
                    code = worker.process.returncode
                    why = f"its process died {ATTEMPTS} times (exit code {code}), out of memory?"
                    message = ("done", job.lost(why))
                if message[0] == "done":
                    worker.job = None
                    if waiting and worker in staff:
                        _hand_out(worker, waiting, attempts)
                    yield job.index, message[1]
                else:
                    _pass_on(message, tell(job.index))
    finally:
        for worker in staff:
            worker.end()


def _hand_out(worker: _Worker, waiting: deque[Sent], attempts: dict[int, int]) -> None:
    job = waiting.popleft()
    attempts[job.index] = attempts.get(job.index, 0) + 1
    worker.give(job)


def _pass_on(message: tuple[Any, ...], watcher: Watcher) -> None:
    kind, *words = message
    if kind == "progress":
        watcher.progress(*words)
    elif kind == "note":
        watcher.note(*words)
    else:
        raise RuntimeError(words[0])


class _Reporting:
    """The watcher of a job in a worker: tells the process that started it."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection

    def progress(self, done: int, total: int, what: str, figures: Mapping[str, float]) -> None:
        self._connection.send(("progress", done, total, what, dict(figures)))

    def note(self, text: str) -> None:
        self._connection.send(("note", text))


def serve(descriptor: int) -> None:
    """A worker's life: jobs in, results out, until the pipe closes."""
    gc.disable()  # see `bem.startup.lazy.collecting`
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the terminal interrupts all; the parent decides
    end_with_parent()
    connection = Connection(descriptor)
    load_extensions()  # a job may hold what they define
    with suppress(EOFError, OSError):  # whoever started this is gone, and has no use for the rest
        while True:
            job = pickle.loads(connection.recv_bytes())
            try:
                message = ("done", job.compute(_Reporting(connection)))
            except (BrokenPipeError, ConnectionError):
                return
            except Exception:
                import traceback

                message = ("error", f"job {job.index} failed in its process\n{traceback.format_exc()}")
            connection.send(message)


def end_with_parent() -> None:
    """Ask Linux to end this process when the one that started it ends."""
    import ctypes

    with suppress(OSError, AttributeError):
        ctypes.CDLL(None).prctl(1, signal.SIGKILL)  # PR_SET_PDEATHSIG
