"""How many threads the numerical work may use, and one way to share blocks of work between them.

Blocks never depend on the number of threads, so neither do the bits of a result. What is small is not shared, and what
is shared shares nothing further. Linear algebra is another matter: how many threads BLAS takes is the environment's
choice, and the order of its sums follows it. It gets one, wherever a result is made.

Threads besides the caller's wait on a lock each, which is let go for them. They take one block after the other, and who
has not come when all are taken is not waited for: on a busy machine the caller does them alone.
"""

from __future__ import annotations

import functools
import itertools
import os
import sys
import threading
import weakref
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar

from bem.errors import InputError

SHARED_FROM = 1 << 19
"""Entries of a pass or a transform from which threads share it."""


class ForkSafeLock:
    """Reentrant lock that a forked process never finds held by a thread that stayed behind.

    Every lock of this package that outlives a call is one.

    whole : True makes a fork wait until the lock is free, so that the child finds what it guards complete; only for a
        lock whose holders take no other one. False gives the child a new lock; what it guards must then be usable in
        every state that its holder leaves it in.
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
    """Of each thread, whether it is at work that is shared."""

    shared = False


_INSIDE = _Inside()


class _Task:
    """Blocks that threads take one after the other, until there are none or one has failed."""

    def __init__(self, work: Callable[[int, int], None], blocks: int, count: int) -> None:
        self.work, self.blocks, self.count = work, blocks, count
        self.next = itertools.count()
        self.lock, self.done = threading.Lock(), threading.Lock()
        self.inside, self.closed = 0, False
        self.errors: list[tuple[int, BaseException]] = []
        self.done.acquire()

    def take(self, worker: int) -> None:
        """Do blocks while there are any, sharing nothing further."""
        _INSIDE.shared, block = True, 0
        try:
            for block in self.next:
                if block >= self.blocks or self.errors:
                    return
                self.work(worker, block)
        except BaseException as error:
            self.errors.append((block, error))
        finally:
            _INSIDE.shared = False

    def help(self, worker: int) -> None:
        """The same, by a thread that the caller waits for from now on, if it does not come too late."""
        with self.lock:
            if self.closed or worker >= self.count:  # called for another task, and late
                return
            self.inside += 1
        self.take(worker)
        with self.lock:
            self.inside -= 1
            if self.closed and self.inside == 0:
                self.done.release()

    def close(self) -> None:
        """Wait for those who came; nobody else may come."""
        with self.lock:
            self.closed = True
            waits = self.inside > 0
        if waits:
            self.done.acquire()


class _Pool:
    """Threads besides the caller's; made when first needed, and made anew in a forked process."""

    def __init__(self, threads: int) -> None:
        self.threads = threads
        self.busy = threading.Lock()
        self.bells: list[Any] = []
        self.task: _Task | None = None

    def share(self, task: _Task) -> None:
        """Do a task with others; the caller holds `busy`."""
        self.task = task
        while len(self.bells) < task.count - 1:
            self._engage()
        for bell in self.bells[: task.count - 1]:
            if bell.locked():  # otherwise it has not heard the last one yet
                bell.release()
        try:
            task.take(0)
        finally:
            task.close()
            self.task = None

    def _engage(self) -> None:
        bell, number = threading.Lock(), len(self.bells) + 1
        bell.acquire()

        def serve() -> None:
            while True:
                bell.acquire()
                task = self.task
                if task is not None:
                    task.help(number)
                del task  # what it holds is not kept while waiting

        threading.Thread(target=serve, name=f"bem_{number}", daemon=True).start()
        self.bells.append(bell)


_POOL = _Pool(_from_environment())


def _before_fork() -> None:
    for lock in list(_LOCKS):
        lock.before_fork()


def _in_parent() -> None:
    for lock in list(_LOCKS):
        lock.in_parent()


def _in_child() -> None:
    """Threads stay behind: the process begins with none, and with no lock that one of them holds."""
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
    """Number of threads that a pass over so many entries may use: no more than there are cores."""
    return min(get_threads(), cores()) if entries >= SHARED_FROM else 1


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else (os.cpu_count() or 1)


def share(work: Callable[[int, int], None], blocks: int, entries: int) -> None:
    """Call `work(worker, block)` once for every block in 0..blocks-1, which are passes over so many entries together.

    `worker` numbers the thread (0..get_threads()-1): scratch that may not be shared is indexed by it. `work` must
    release the interpreter lock in its heavy parts for this to be worth anything; what it calls has one thread, so
    that `share` within it does its blocks itself, as does one while another thread's is under way. Threads take blocks
    as they come. The exception of the first block that is known to have failed is raised here.
    """
    workers = min(threads_for(entries), blocks)
    if workers <= 1 or not _POOL.busy.acquire(blocking=False):
        for block in range(blocks):
            work(0, block)
        return
    task = _Task(work, blocks, workers)
    try:
        _POOL.share(task)
    finally:
        _POOL.busy.release()
    if task.errors:
        raise min(task.errors, key=lambda found: found[0])[1]


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
