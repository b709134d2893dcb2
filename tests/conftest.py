"""Shared by all tests.

A test is marked `internal` if it, or a helper of its file, uses a name that is neither in `bem.__all__`, nor in the
`__init__` of a package of bem, nor behind the command line, nor part of the closed forms that serve as references: such
a test belongs to its code and may go with it. Tests through public doors stay unmarked.
"""

import gc
import os
import signal
from collections.abc import Generator
from pathlib import Path

# many small factorisations: more than one BLAS thread only spins, and the bits would depend on their number
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    # a shell ignores it in commands in the background, and the runs that tests start would ignore it, too
    signal.signal(signal.SIGINT, signal.default_int_handler)

import drawn
import durations
import pytest
import worker_logs
from hypothesis import settings

from bem import threads

# the same examples in every run, so that a red run can be repeated; HYPOTHESIS_PROFILE=default hunts with fresh ones
settings.register_profile("seeded", derandomize=True, deadline=None)
settings.load_profile(os.environ.get("HYPOTHESIS_PROFILE", "seeded"))

SHARED_FROM = threads.SHARED_FROM
threads.SHARED_FROM = 1  # small fields, too, so that tests of threads need no large ones


def pytest_configure(config: pytest.Config) -> None:
    """Keep logs of workers."""
    worker_logs.register(config)


@pytest.hookimpl(wrapper=True)
def pytest_collection() -> Generator[None, object, object]:
    """Collect tests without the garbage collector, and keep libraries and tests out of its later rounds.

    It would go through half a million objects again and again, a third of the time of the collection.
    """
    gc.disable()
    try:
        return (yield)
    finally:
        gc.collect()
        gc.freeze()
        gc.enable()


@pytest.hookimpl(wrapper=True, tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> Generator[None]:
    """Draw cases by the commit; mark tests slow by their stored durations; deal files of the chosen tests to workers.

    Functions of which some cases are marked slow in the code are left as they are.
    """
    leave_out_cases(config, items)
    seconds = durations.stored()
    functions = [durations.function_of(item.nodeid) for item in items]
    marked = {f for f, item in zip(functions, items, strict=True) if item.get_closest_marker("slow")}
    slow = durations.slow_functions(seconds, durations.killers() | marked)
    for function, item in zip(functions, items, strict=True):
        if function in slow:
            item.add_marker(pytest.mark.slow)
    yield
    if "PYTEST_XDIST_WORKER" in os.environ:
        chosen = durations.file_seconds((durations.function_of(item.nodeid) for item in items), seconds)
        place = {file: number for number, file in enumerate(durations.deal_files(chosen))}
        items.sort(key=lambda item: place[item.nodeid.partition("::")[0]])


def leave_out_cases(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Deselect cases of functions marked `drawn` that the commit does not draw."""
    marks = {item.nodeid: item.get_closest_marker("drawn") for item in items}
    parts = {name: mark.args[0] for name, mark in marks.items() if mark is not None}
    seed = drawn.commit() if parts else ""
    if drawn.all_cases_run(config.args, seed):
        return
    without = drawn.left_out(parts, seed)
    config.hook.pytest_deselected(items=[item for item in items if item.nodeid in without])
    items[:] = [item for item in items if item.nodeid not in without]


MEASURED = Path(__file__).resolve().parents[2] / "shared" / "data" / "measured"


@pytest.fixture(scope="session")
def measured() -> Path:
    """Folder with the measured surfaces; the test is skipped, saying so, where it is not there."""
    if not MEASURED.is_dir():
        pytest.skip(f"no measured surfaces at {MEASURED}")
    return MEASURED


@pytest.fixture
def shared_as_it_is(monkeypatch):
    """Threads share what they do for users."""
    monkeypatch.setattr(threads, "SHARED_FROM", SHARED_FROM)
