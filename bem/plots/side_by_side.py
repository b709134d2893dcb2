"""Pieces of work done by copies of this process on idle cores (`fork`): all that is loaded, and all arrays, are there.

Only where a copy is safe and costs next to nothing: on Linux, and with this process's one thread. Elsewhere, and for
whatever a copy could not do, the caller does the work itself, so nothing but the clock knows the difference.
"""

from __future__ import annotations

import os
import pickle
import select
import signal
import sys
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from typing import Any

from bem.campaigns.local import end_with_parent
from bem.threads import cores

_MOST = 4
"""Copies and this process together: each holds a picture in memory."""
INTERRUPTS = (signal.SIGINT, signal.SIGTERM)
PATIENCE = 600.0
"""Seconds after which a copy that is waited for counts as one that hangs: pictures of the largest runs take minutes.
Whoever is only slow costs time, no picture: what it has not answered is done by the one who waits."""


def side_by_side(work: Callable[[int], Any], count: int, processes: int | None = None) -> dict[int, Any]:
    """What `work(i)` gives for i in 0..count-1, as far as it could be had in `processes` (as many as cores where None).

    Results must be picklable. Whoever is free takes the next number. Missing are the numbers whose work raised, or all
    where nothing can be gained: the caller does these.
    """
    number = min(at_once(processes), count)
    if number < 2:
        return {}
    tasks, fill = os.pipe()
    os.write(fill, bytes(range(min(count, 256))))
    os.close(fill)
    copies: list[tuple[int, int]] = []
    found: dict[int, Any] = {}
    try:
        # an interrupt between a copy's start and its place in the list would leave it behind, or let it return
        usual = signal.pthread_sigmask(signal.SIG_BLOCK, INTERRUPTS)
        try:
            with suppress(OSError):  # the system allows no further process: this one does what is left
                for _ in range(number - 1):
                    copies.append(copied(lambda: _do(work, tasks), usual))
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, usual)
        found = _do(work, tasks)
        for _, answers in copies:
            found |= answer_of(answers) or {}
    finally:
        os.close(tasks)
        for copy in copies:
            ended(*copy)
    return found


def at_once(processes: int | None) -> int:
    """How many processes can draw at once, this one among them, where so many are asked for; 1 where it may not be
    copied."""
    number = min(processes or cores(), _MOST)
    return number if number > 1 and _alone() else 1


def answer_of(answers: int) -> Any:
    """What a copy sends through the pipe; None of one that dies, or hangs for `PATIENCE`."""
    pieces: list[bytes] = []
    until, waiting = time.monotonic() + PATIENCE, select.poll()
    waiting.register(answers, select.POLLIN)
    while waiting.poll(1e3 * max(0.0, until - time.monotonic())):
        piece = os.read(answers, 1 << 20)
        if not piece:
            with suppress(EOFError, pickle.UnpicklingError):
                return pickle.loads(b"".join(pieces))
            return None
        pieces.append(piece)
    return None


def taken(orders: int, order: bytes) -> bool:
    """Return True if what is sent through a pipe is taken at the other end: not where nobody is there, or hangs for
    `PATIENCE`."""
    until, waiting = time.monotonic() + PATIENCE, select.poll()
    waiting.register(orders, select.POLLOUT)
    os.set_blocking(orders, False)
    # whoever has given a broken pipe back to the system would be ended by it
    usual = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGPIPE})
    try:
        with suppress(BrokenPipeError):
            while order and waiting.poll(1e3 * max(0.0, until - time.monotonic())):
                order = order[os.write(orders, order) :]
    finally:
        signal.sigtimedwait({signal.SIGPIPE}, 0)
        signal.pthread_sigmask(signal.SIG_SETMASK, usual)
    return not order


def ended(process: int, answers: int) -> None:
    """End a copy that has answered, or that nobody waits for any more."""
    os.close(answers)
    with suppress(ProcessLookupError):
        os.kill(process, signal.SIGKILL)
    os.waitpid(process, 0)


def _alone() -> bool:
    """Return True if this process has one thread: a copy of several may wait for ever for what another one had locked.

    And nobody else who waits for processes that end (a handler of SIGCHLD): copies would be taken for theirs.
    """
    try:
        one = sys.platform == "linux" and len(os.listdir("/proc/self/task")) == 1
        return one and signal.getsignal(signal.SIGCHLD) is signal.SIG_DFL
    except OSError:
        return False


def copied(work: Callable[[], Any], signals: Iterable[int]) -> tuple[int, int]:
    """Start a copy of this process that does `work()`; its number, and the pipe that what it gives comes through,
    pickled.

    Interrupts are held back meanwhile; `signals` are those that are held back in the copy.
    """
    parent, (answers, theirs) = os.getpid(), os.pipe()
    try:
        process = os.fork()
    except OSError:
        os.close(answers)
        os.close(theirs)
        raise
    if process:
        os.close(theirs)
        return process, answers
    try:  # from here on in the copy, which never returns
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # the terminal interrupts all; this one's parent decides
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        end_with_parent()
        signal.pthread_sigmask(signal.SIG_SETMASK, signals)
        if os.getppid() == parent:  # else it ended before it could be watched
            with os.fdopen(theirs, "wb") as stream:
                pickle.dump(work(), stream)
    finally:
        os._exit(0)


def _do(work: Callable[[int], Any], tasks: int) -> dict[int, Any]:
    found = {}
    while task := os.read(tasks, 1):
        with suppress(Exception):  # the caller does it again and sees what is wrong
            found[task[0]] = work(task[0])
    return found
