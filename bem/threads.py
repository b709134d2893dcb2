"""How many threads the numerical work may use, and one way to share blocks of work between them.

Blocks never depend on the number of threads, so neither do the bits of a result. What is small is not shared, and what
is shared shares nothing further. Linear algebra is another matter: how many threads BLAS takes is the environment's
choice, and the order of its sums follows it. It gets one, wherever a result is made.
"""

from __future__ import annotations

import functools
import os
import sys
import threading
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any, ParamSpec, TypeVar

from bem.errors import InputError

SHARED_FROM = 1 << 19
"""Entries of a pass or a transform from which threads share it."""


def _from_environment() -> int:
    try:
        return max(1, int(os.environ.get("BEM_THREADS", "1")))
    except ValueError:
        return 1


class _Pool:
    """Threads besides the caller's; made when first needed, and made anew in a forked process."""

    def __init__(self) -> None:
        self.threads = _from_environment()
        self.lock = threading.Lock()
        self.executor: ThreadPoolExecutor | None = None
        self.size = 0
        self.process = 0

    def helpers(self, count: int) -> ThreadPoolExecutor:
        with self.lock:
            if self.executor is None or self.size < count or self.process != os.getpid():
                self.executor = ThreadPoolExecutor(count, thread_name_prefix="bem")
                self.size, self.process = count, os.getpid()
            return self.executor


_POOL = _Pool()


class _Inside(threading.local):
    """Of each thread, whether it is at work that is shared."""

    shared = False


_INSIDE = _Inside()


def set_threads(count: int) -> None:
    """Let transforms and elementwise passes use `count` threads (default 1, or the variable BEM_THREADS).

    Raises
    ------
    InputError : `count` is not a positive integer.
    """
    if isinstance(count, bool) or not isinstance(count, int) or count < 1:
        raise InputError(f"set_threads: count {count!r} must be a positive integer")
    _POOL.threads = count


def get_threads() -> int:
    """Number of threads that the next computation may use: one within work that is shared already."""
    return 1 if _INSIDE.shared else _POOL.threads


def threads_for(entries: int) -> int:
    """Number of threads that a pass over so many entries may use."""
    return get_threads() if entries >= SHARED_FROM else 1


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)


def share(work: Callable[[int, int], None], blocks: int, entries: int) -> None:
    """Call `work(worker, block)` once for every block in 0..blocks-1, which are passes over so many entries together.

    `worker` numbers the thread (0..get_threads()-1): scratch that may not be shared is indexed by it. `work` must
    release the interpreter lock in its heavy parts for this to be worth anything; what it calls has one thread, so
    that `share` within it does its blocks itself. The first exception of any block is raised here.
    """
    workers = min(threads_for(entries), blocks)
    if workers <= 1:
        for block in range(blocks):
            work(0, block)
        return

    def run(worker: int) -> None:
        _INSIDE.shared = True
        try:
            for block in range(worker, blocks, workers):
                work(worker, block)
        finally:
            _INSIDE.shared = False

    executor = _POOL.helpers(workers - 1)
    futures = [executor.submit(run, worker) for worker in range(1, workers)]
    try:
        run(0)
    finally:
        errors = [future.exception() for future in futures]
    for error in errors:
        if error is not None:
            raise error


_Arguments = ParamSpec("_Arguments")
_Result = TypeVar("_Result")


def one_blas_thread(function: Callable[_Arguments, _Result]) -> Callable[_Arguments, _Result]:
    """The function with one thread for linear algebra while it runs, as many as before after it."""

    @functools.wraps(function)
    def alone(*arguments: _Arguments.args, **keywords: _Arguments.kwargs) -> _Result:
        with _blas(len([name for name in ("numpy", "scipy.linalg") if name in sys.modules])).limit(limits=1):
            return function(*arguments, **keywords)

    return alone


@functools.cache
def _blas(loaded: int) -> Any:
    """The linear algebra of so many packages, which bring one each."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController().select(user_api="blas")
