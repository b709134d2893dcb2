"""Compilation of recorded loops before their first use, on several cores.

A loop is compiled after the loops that it calls, which are then read from numba's cache; so each specialisation is
compiled once, whichever process needs it.

Knows numba's dispatchers, nothing of what is computed. Verified in tests/packaging/test_warm_up.py.
"""

from __future__ import annotations

import importlib
import multiprocessing
import os
import signal
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from types import CodeType, ModuleType
from typing import Any

from bem.startup.signatures import SignatureRecord

Loop = tuple[str, str]
"""Module and name of a compiled loop."""
Progress = Callable[[int, int], None]
"""Called with the number of loops that are compiled and the number of all."""


def compile_loops(record: SignatureRecord, workers: int, progress: Progress, *, main: bool = False) -> list[str]:
    """Compile the recorded loops into numba's cache; return the loops that could not be compiled, with the reason.

    Parameters
    ----------
    record : loops and their signatures.
    workers : number of processes.
    progress : called at the start and after every loop.
    main : only what the main job needs.
    """
    failed, loops = [], {}
    for loop in record.loops(main=main):
        try:
            loops[loop] = _dispatcher(loop)
        except (ImportError, AttributeError) as error:
            failed.append(f"{'.'.join(loop)}: {error}")
    calls = {loop: _recorded_callees(dispatcher, loops) - {loop} for loop, dispatcher in loops.items()}
    order = _callees_first(calls)
    progress(0, len(order))
    outcomes = _in_turn(record, order, main) if workers < 2 else _in_processes(record, order, calls, workers, main)
    for number, reason in enumerate(outcomes, 1):
        if reason:
            failed.append(reason)
        progress(number, len(order))
    return failed


def find_dispatchers() -> Iterator[tuple[Loop, Any]]:
    """Every compiled loop of this package's modules that are loaded."""
    from numba.core.dispatcher import Dispatcher

    package = __name__.partition(".")[0] + "."
    for name, module in sorted(sys.modules.items()):
        if name.startswith(package):
            for item in list(vars(module).values()):
                if isinstance(item, Dispatcher) and item.py_func.__module__ == name:
                    yield (name, item.py_func.__name__), item


def _dispatcher(loop: Loop) -> Any:
    module, name = loop
    return getattr(importlib.import_module(module), name)


def _compile(record: SignatureRecord, loop: Loop, main: bool) -> str:
    """Compile all signatures of a loop, or read them from the cache; return why that failed, or an empty text."""
    try:
        dispatcher = _dispatcher(loop)
        for signature in record.signatures(*loop, main=main):
            dispatcher.compile(signature)
    except Exception as error:  # numba raises anything over a signature that no longer fits
        return f"{'.'.join(loop)}: {str(error).strip().splitlines()[0] if str(error).strip() else repr(error)}"
    return ""


def _in_turn(record: SignatureRecord, order: Iterable[Loop], main: bool) -> Iterator[str]:
    for loop in order:
        yield _compile(record, loop, main)


def _in_processes(
    record: SignatureRecord, order: list[Loop], calls: Mapping[Loop, set[Loop]], workers: int, main: bool
) -> Iterator[str]:
    """Hand out loops whose callees are compiled, the first in `order` first."""
    context = multiprocessing.get_context("fork" if sys.platform == "linux" else "spawn")
    _ready_compiler()
    waiting, left = list(order), {loop: set(callees) for loop, callees in calls.items()}
    running: dict[Future[str], Loop] = {}
    with ProcessPoolExecutor(workers, context, _die_of_signals) as pool:
        try:
            while waiting or running:
                ready = [loop for loop in waiting if not left[loop]][: workers - len(running)]
                if not ready and not running:  # loops that name one another
                    ready = waiting[:1]
                for loop in ready:
                    waiting.remove(loop)
                    running[pool.submit(_compile, record, loop, main)] = loop
                for future in wait(running, return_when=FIRST_COMPLETED).done:
                    done = running.pop(future)
                    for callees in left.values():
                        callees.discard(done)
                    yield future.result()
        except BrokenProcessPool as error:
            yield f"{len(waiting) + len(running)} loops: a process that compiled them died ({error})"


def _ready_compiler() -> None:
    """Load what numba needs to compile anything, so that forked processes have it."""
    from numba import njit

    njit(_nothing).compile(())


def _nothing() -> None:
    """Have the compiler of loops compile something."""


def _die_of_signals() -> None:
    """End a worker without a traceback when the command is interrupted."""
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, signal.SIG_DFL)


def _callees_first(calls: Mapping[Loop, set[Loop]]) -> list[Loop]:
    """Loops sorted so that each follows those that it calls, and the longest chains of callers begin first."""
    height: dict[Loop, int] = {}
    callers: dict[Loop, set[Loop]] = {loop: set() for loop in calls}
    for loop, callees in calls.items():
        for callee in callees:
            callers[callee].add(loop)

    def chain(loop: Loop) -> int:
        if loop not in height:
            height[loop] = 0  # a loop that calls itself by way of others ends here
            height[loop] = 1 + max(map(chain, callers[loop]), default=0)
        return height[loop]

    return sorted(calls, key=chain, reverse=True)


def _recorded_callees(dispatcher: Any, loops: Mapping[Loop, Any]) -> set[Loop]:
    """Loops with a record of their own that a loop calls, directly or from within an inlined one."""
    keys = {id(item): loop for loop, item in loops.items()}
    found, seen, ahead = set(), {id(dispatcher)}, [dispatcher]
    while ahead:
        for callee in _callees(ahead.pop().py_func):
            if id(callee) not in seen:
                seen.add(id(callee))
                if id(callee) in keys:
                    found.add(keys[id(callee)])
                else:
                    ahead.append(callee)
    return found


def _callees(function: Any) -> Iterator[Any]:
    """Compiled loops among the names that a function uses, also by way of a module (`passes.total`)."""
    names, codes = set(), [function.__code__]
    while codes:
        code = codes.pop()
        names |= set(code.co_names)
        codes += [constant for constant in code.co_consts if isinstance(constant, CodeType)]
    values = [function.__globals__[name] for name in names if name in function.__globals__]
    for module in [value for value in values if isinstance(value, ModuleType)]:
        values += [getattr(module, name) for name in names if hasattr(module, name)]
    yield from (value for value in values if hasattr(value, "py_func"))


def use_cache_folder(folder: str) -> None:
    """Keep the compiled code of loops that are defined from now on in this folder."""
    os.environ["NUMBA_CACHE_DIR"] = folder
