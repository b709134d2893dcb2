"""Processes that compute for the server of the page: plans, surfaces, pictures.

The server itself only reads small files, so no field of a form can stop it or take its memory. A process may allocate
what is available on the machine when a job begins, ends after a job that took much memory or when nobody asks it for a
while, and is replaced when it dies. Knows nothing of what is computed. Verified in tests/app/test_computing.py.
"""

from __future__ import annotations

import asyncio
import os
import pickle
import signal
import subprocess
import sys
from collections.abc import Callable
from contextlib import suppress
from multiprocessing.connection import Connection, Pipe
from pathlib import Path
from typing import Any, ParamSpec, TypeVar, cast

from bem.errors import BemError, InputError, ResultsError

P = ParamSpec("P")
R = TypeVar("R")

PROCESSES = 2
"""Jobs that run at the same time; others wait."""
IDLE = 180.0
"""Seconds without a job after which a process ends."""
MOST_KEPT = 3e8
"""Bytes by which a process may grow; beyond, it ends after its job and its memory is free again."""
USABLE = 0.9
"""Fraction of the available memory that a job may allocate."""
_SERVE = "from bem.app.computing import serve; serve({descriptor})"
TOO_MUCH = "memory: there is not enough for this; allowed: fewer cells, a smaller file, or fewer runs at once"
DIED = "the process that computed this died, probably for want of memory; allowed: fewer cells, a smaller file"


class Mistake(BemError):
    """An error that the program did not expect; where it came from is printed by the process."""


class Computing:
    """Up to `PROCESSES` processes, each started when it is first needed."""

    def __init__(self) -> None:
        self._idle: list[_Process] = []
        self._free: asyncio.Semaphore | None = None

    async def call(
        self, wanted: Callable[[], bool], function: Callable[P, R], *given: P.args, **named: P.kwargs
    ) -> R | None:
        """Call a function of a module in one of the processes, and return what it returns.

        Parameters
        ----------
        wanted : asked once a process is free; if it returns False, nothing is computed and None is returned.
        function : found by its name; arguments and result travel by `pickle`.
        *given, **named : its arguments.

        Raises
        ------
        BemError : the function raised it, memory is short, the process died, or (`Mistake`) the program is at fault.
        """
        self._free = self._free or asyncio.Semaphore(PROCESSES)
        async with self._free:
            if not wanted():
                return None
            job = pickle.dumps((function, given, named))
            # a page that is closed meanwhile does not take the process with it
            kind, found = await asyncio.shield(asyncio.ensure_future(self._do(job)))
        if kind == "error":
            raise found
        done: R = found
        return done

    async def _do(self, job: bytes) -> tuple[str, Any]:
        kind, found = "gone", None
        while kind == "gone":
            process = self._idle.pop() if self._idle else await asyncio.to_thread(_Process)
            kind, found = await asyncio.to_thread(process.do, job)
            if process.lives:
                self._idle.append(process)
        return kind, found

    def end(self) -> None:
        """End the processes that have no job."""
        while self._idle:
            self._idle.pop().end()


_COMPUTING = Computing()


async def compute(function: Callable[P, R], *given: P.args, **named: P.kwargs) -> R:
    """Call a function in a process of the page; see `Computing.call`."""
    found = await _COMPUTING.call(lambda: True, function, *given, **named)
    return cast("R", found)  # always wanted, so always computed


async def compute_if(
    wanted: Callable[[], bool], function: Callable[P, R], *given: P.args, **named: P.kwargs
) -> R | None:
    """Call a function in a process of the page unless nobody wants the result any more; see `Computing.call`."""
    return await _COMPUTING.call(wanted, function, *given, **named)


class _Process:
    """A process that does one job at a time."""

    def __init__(self) -> None:
        self._connection, theirs = Pipe()
        paths = [path or os.getcwd() for path in sys.path]
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", _SERVE.format(descriptor=theirs.fileno())],
            pass_fds=[theirs.fileno()],
            stdin=subprocess.DEVNULL,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(paths), "OPENBLAS_NUM_THREADS": "1"},
        )
        theirs.close()  # so that the death of the process is the end of the pipe
        self.lives = True

    def do(self, job: bytes) -> tuple[str, Any]:
        """Return ("done", result), ("error", exception) or ("gone", None): it had ended before the job came."""
        if self._process.poll() is not None:
            self.end()
            return "gone", None
        try:
            self._connection.send_bytes(job)
            kind, found, self.lives = self._connection.recv()
        except (EOFError, OSError):
            self.end()
            if self._process.returncode == 0:
                return "gone", None
            return "error", ResultsError(DIED)
        if not self.lives:
            self.end()
        return kind, found

    def end(self) -> None:
        """End it now."""
        self.lives = False
        self._connection.close()
        with suppress(subprocess.TimeoutExpired):
            self._process.wait(2.0)  # one that ends by itself has an exit code of its own
        self._process.kill()
        self._process.wait()


def serve(descriptor: int) -> None:
    """Do jobs until the pipe closes or nobody asks for `IDLE` seconds."""
    from bem.campaigns.local import end_with_parent
    from bem.extensions import load_extensions

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the terminal interrupts all; the server decides
    end_with_parent()
    with suppress(OSError):
        Path("/proc/self/oom_score_adj").write_text("800")  # the system ends this process before the server
    connection = Connection(descriptor)
    load_extensions()
    before = _memory()[1]
    with suppress(EOFError, OSError):
        while connection.poll(IDLE):
            kind, found = _answer(connection.recv_bytes())
            lives = _memory()[1] - before < MOST_KEPT
            connection.send((kind, found, lives))
            if not lives:
                return


def _answer(job: bytes) -> tuple[str, Any]:
    """Run a job; return "done" with its result, or "error" with the error to show.

    Any error becomes one: a process that ended with it would leave the page without an answer.
    """
    try:
        _limit_memory()
        function, given, named = pickle.loads(job)
        found = function(*given, **named)
        pickle.dumps(found)
        return "done", found
    except MemoryError:
        return "error", InputError(TOO_MUCH)
    except BemError as error:
        return "error", _portable(error)
    except Exception as error:
        import traceback

        traceback.print_exc()
        return "error", Mistake(f"{type(error).__name__}: {error}")


def _portable(error: BemError) -> BemError:
    """The same error, of a class that every process knows, with all its messages."""
    if isinstance(error, InputError):
        return InputError(error.messages) if type(error).__module__ != "bem.errors" else type(error)(error.messages)
    return ResultsError(str(error)) if type(error).__module__ != "bem.errors" else type(error)(str(error))


def _limit_memory() -> None:
    """Let this process allocate no more than what is available: a larger array raises MemoryError."""
    import resource

    from bem.memory import available_memory

    _, most = resource.getrlimit(resource.RLIMIT_AS)
    limit = int(_memory()[0] + USABLE * available_memory())
    if most != resource.RLIM_INFINITY:
        limit = min(limit, most)
    resource.setrlimit(resource.RLIMIT_AS, (limit, most))


def _memory() -> tuple[int, int]:
    """Address space and resident memory of this process [bytes]; zeros where the system does not say."""
    try:
        pages = Path("/proc/self/statm").read_text().split()
    except OSError:
        return 0, 0
    size = os.sysconf("SC_PAGE_SIZE")
    return int(pages[0]) * size, int(pages[1]) * size
