"""Number of threads of the numerical work, blocks of work shared between threads, and locks that survive a fork.

Blocks do not depend on the number of threads, so the bits of a result do not either. A pass over few entries is done by
the caller alone, and work inside a shared block is not shared again. Linear algebra gets one thread
(`one_blas_thread`): the order of its sums would depend on their number.

`share` hands blocks to the threads of one pool and to the caller, each taking the next block as it gets free. Threads
that have not begun when no block is left are not waited for.
"""

from __future__ import annotations

import functools
import itertools
import os
import sys
import threading
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

from bem.errors import InputError

if TYPE_CHECKING:
    from concurrent.futures import Future, ThreadPoolExecutor

SHARED_FROM = 1 << 19
"""Entries of a pass or a transform from which threads share it."""


class ForkSafeLock:
    """Reentrant lock that is free in a forked process, whose other threads do not exist.

    Every lock of this package that outlives a call is a `ForkSafeLock`.

    Parameters
    ----------
    whole : True makes a fork wait until the lock is free, so that the child finds complete what the lock guards; only
        for a lock whose holders take no second lock. False gives the child a new lock; the guarded data must then be
        usable in every state in which a holder leaves them.
    """

    def __init__(self, *, whole: bool = False) -> None:
        self._lock, self._whole, self._held = threading.RLock(), whole, False
        _LOCKS.add(self)

    def acquire(self, *, blocking: bool = True) -> bool:
        """Take the lock; return whether this thread has it now."""
        return self._lock.acquire(blocking=blocking)

    def release(self) -> None:
        """Give the lock back."""
        self._lock.release()

    def __enter__(self) -> None:
        self._lock.acquire()

    def __exit__(self, *error: object) -> None:
        self._lock.release()

    def before_fork(self) -> None:
        """Wait until what the lock guards is complete."""
        if self._whole:
            self._lock.acquire()
            self._held = True

    def in_parent(self) -> None:
        """Release the lock after a fork."""
        if self._held:
            self._held = False
            self._lock.release()

    def in_child(self) -> None:
        """Leave the lock free, or with the thread that forked."""
        self.in_parent()
        self._lock = _free(self._lock)


def _free(lock: Any) -> Any:
    """Return the reentrant lock, or a new one in place of one that another thread holds."""
    if not lock.acquire(blocking=False):
        return threading.RLock()
    lock.release()
    return lock


_LOCKS: weakref.WeakSet[ForkSafeLock] = weakref.WeakSet()


def _from_environment() -> int:
    try:
        return max(1, int(os.environ.get("BEM_THREADS", "1")))
    except ValueError:
        return 1


class _Inside(threading.local):
    """Thread-local flag: `shared` is True while the thread works on a shared block."""

    shared = False


_INSIDE = _Inside()


class _Pool:
    """Threads beside the caller's, started when needed, and the number of threads that users asked for."""

    def __init__(self, threads: int) -> None:
        self.threads = threads
        self.busy = threading.Lock()
        self._executor: ThreadPoolExecutor | None = None
        self._size = 0

    def submit(self, take: Callable[[int], None], helpers: int) -> list[Future[None]]:
        """Call `take(1)` ... `take(helpers)`, each in a thread of its own; the caller holds `busy`."""
        if self._executor is None or self._size < helpers:
            from concurrent.futures import ThreadPoolExecutor

            if self._executor is not None:
                self._executor.shutdown(wait=False)
            self._executor, self._size = ThreadPoolExecutor(helpers, thread_name_prefix="bem"), helpers
        return [self._executor.submit(take, worker) for worker in range(1, helpers + 1)]


_POOL = _Pool(_from_environment())


def _before_fork() -> None:
    for lock in list(_LOCKS):
        lock.before_fork()


def _in_parent() -> None:
    for lock in list(_LOCKS):
        lock.in_parent()


def _in_child() -> None:
    """Begin without threads, and without a lock that a thread of the parent holds."""
    for lock in list(_LOCKS):
        lock.in_child()
    if sys.version_info < (3, 12):
        _renew_locks_of_cached_properties()
    _POOL.__init__(_POOL.threads)  # type: ignore[misc]


def _renew_locks_of_cached_properties() -> None:
    """Before Python 3.12 each cached property has a lock, held while a value is computed."""
    package = __name__.partition(".")[0]
    modules = [module for name, module in list(sys.modules.items()) if name.partition(".")[0] == package]
    classes = {found for module in modules for found in list(vars(module).values()) if isinstance(found, type)}
    for owner in classes:
        for found in list(vars(owner).values()):
            if isinstance(found, functools.cached_property):
                found.lock = _free(found.lock)  # type: ignore[attr-defined]


if hasattr(os, "register_at_fork"):
    os.register_at_fork(before=_before_fork, after_in_parent=_in_parent, after_in_child=_in_child)


def set_threads(count: int) -> None:
    """Set the number of threads of transforms and elementwise passes (default 1, or the variable BEM_THREADS).

    Raises
    ------
    InputError : `count` is not a positive integer.
    """
    if isinstance(count, bool) or not isinstance(count, int) or count < 1:
        raise InputError(f"set_threads: count {count!r} must be a positive integer")
    _POOL.threads = count


def get_threads() -> int:
    """Number of threads that the next computation may use; 1 inside a shared block."""
    return 1 if _INSIDE.shared else _POOL.threads


def threads_for(entries: int) -> int:
    """Number of threads for a pass over `entries` entries, at most the number of cores."""
    return min(get_threads(), cores()) if entries >= SHARED_FROM else 1


def cores() -> int:
    """Number of cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)


def share(work: Callable[[int, int], None], blocks: int, entries: int) -> None:
    """Call `work(worker, block)` once for every block in 0..blocks-1.

    Parameters
    ----------
    work : must release the interpreter lock in its heavy parts. `worker` (0..get_threads()-1) numbers the thread, to
        index scratch arrays. A nested `share` runs in its caller's thread, and so does a second one at the same time.
    blocks : number of blocks.
    entries : of all blocks together; few entries are not shared.

    Raises
    ------
    BaseException : the exception of the first block that is known to have failed.
    """
    workers = min(threads_for(entries), blocks)
    if workers <= 1 or not _POOL.busy.acquire(blocking=False):
        for block in range(blocks):
            work(0, block)
        return
    following = itertools.count()
    errors: list[tuple[int, BaseException]] = []

    def take(worker: int) -> None:
        _INSIDE.shared, block = True, 0
        try:
            for block in following:
                if block >= blocks or errors:
                    return
                work(worker, block)
        except BaseException as error:
            errors.append((block, error))
        finally:
            _INSIDE.shared = False

    try:
        futures = _POOL.submit(take, workers - 1)
        take(0)
        for future in futures:
            if not future.cancel():  # it has begun
                future.result()
    finally:
        _POOL.busy.release()
    if errors:
        raise min(errors, key=lambda found: found[0])[1]


_Arguments = ParamSpec("_Arguments")
_Result = TypeVar("_Result")


def one_blas_thread(function: Callable[_Arguments, _Result]) -> Callable[_Arguments, _Result]:
    """Decorate a function to run with one thread of the linear algebra."""

    @functools.wraps(function)
    def alone(*arguments: _Arguments.args, **keywords: _Arguments.kwargs) -> _Result:
        with _blas(len([name for name in ("numpy", "scipy.linalg") if name in sys.modules])).limit(limits=1):
            return function(*arguments, **keywords)

    return alone


@functools.cache
def _blas(loaded: int) -> Any:
    """Controller of the linear algebra of `loaded` packages; each package brings its own library."""
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController().select(user_api="blas")
