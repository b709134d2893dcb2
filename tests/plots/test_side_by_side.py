"""Copies of this process: each number once, nothing left over, and whatever fails is the caller's."""

import os
import signal
import subprocess
import sys
import threading
import time

import pytest

from bem.plots import side_by_side as module
from bem.plots.side_by_side import side_by_side

ALONE = pytest.mark.skipif(sys.platform != "linux", reason="copies are made on Linux only")


@pytest.fixture
def copies(monkeypatch):
    """Processes started; test runners have threads, so that the question for them is answered by hand."""
    started = []
    real = os.fork

    def fork():
        process = real()
        if process:
            started.append(process)
        return process

    monkeypatch.setattr(os, "fork", fork)
    monkeypatch.setattr(module, "_alone", lambda: True)
    return started


@pytest.mark.internal
@ALONE
def test_every_number_is_done_once_and_no_process_is_left(copies):
    found = side_by_side(lambda i: (i, os.getpid()), 40, 3)
    assert sorted(found) == list(range(40))
    assert all(i == first for i, (first, _) in found.items())
    assert len(copies) == 2
    for process in copies:
        with pytest.raises(ChildProcessError):
            os.waitpid(process, 0)


@pytest.mark.internal
@ALONE
def test_what_fails_or_dies_is_left_to_the_caller(copies):
    here = os.getpid()

    def work(i):
        if i == 3:
            raise ValueError("no picture")
        if os.getpid() != here:
            os._exit(1)
        return i

    found = side_by_side(work, 6, 2)
    assert 3 not in found
    assert all(i == value for i, value in found.items())
    assert len(copies) == 1


@pytest.mark.internal
@ALONE
def test_where_no_process_can_be_had_the_caller_does_it_all(monkeypatch):
    def refused():
        raise BlockingIOError(11, "Resource temporarily unavailable")

    monkeypatch.setattr(os, "fork", refused)
    monkeypatch.setattr(module, "_alone", lambda: True)
    before = os.listdir("/proc/self/fd")
    assert side_by_side(lambda i: i, 5, 3) == {i: i for i in range(5)}
    assert os.listdir("/proc/self/fd") == before


@pytest.mark.internal
@ALONE
def test_an_interrupt_leaves_no_copy_and_one_right_after_a_start_waits(copies, monkeypatch):
    """The copy sleeps for longer than the test may take."""
    here, real = os.getpid(), os.fork

    def fork():
        process = real()
        if process:  # to this thread: others of the test runner's would take it, which no caller of copies has
            signal.pthread_kill(threading.get_ident(), signal.SIGINT)
        return process

    def work(i):
        time.sleep(0.01 if os.getpid() == here else 600)

    monkeypatch.setattr(os, "fork", fork)
    with pytest.raises(KeyboardInterrupt):
        side_by_side(work, 6, 2)
    assert len(copies) == 1
    with pytest.raises(ChildProcessError):
        os.waitpid(copies[0], 0)
    assert not signal.pthread_sigmask(signal.SIG_BLOCK, ()) & {signal.SIGINT, signal.SIGTERM}


@pytest.mark.internal
@ALONE
def test_a_copy_that_hangs_is_not_waited_for(copies, monkeypatch):
    monkeypatch.setattr(module, "PATIENCE", 0.5)
    here = os.getpid()

    def work(i):
        if os.getpid() != here:
            os.kill(os.getpid(), signal.SIGSTOP)
        time.sleep(0.05)
        return i

    found = side_by_side(work, 6, 2)
    assert len(found) >= 5
    assert all(i == value for i, value in found.items())
    with pytest.raises(ChildProcessError):
        os.waitpid(copies[0], 0)


@pytest.mark.skipif(sys.platform != "linux", reason="copies are made on Linux alone")
def test_an_order_that_nobody_reads_ends_nobody():
    """Whatever is to become of broken pipes in the user's program."""
    code = """
import os, signal
from bem.plots.side_by_side import taken
signal.signal(signal.SIGPIPE, signal.SIG_DFL)
reads, writes = os.pipe()
os.close(reads)
assert not taken(writes, b"order")
assert signal.SIGPIPE not in signal.pthread_sigmask(signal.SIG_BLOCK, ())
"""
    subprocess.run([sys.executable, "-c", code], check=True, timeout=60)


@pytest.mark.internal
@pytest.mark.skipif(sys.platform != "linux", reason="copies are made on Linux alone")
def test_an_order_is_taken_where_somebody_reads_it(monkeypatch):
    monkeypatch.setattr(module, "PATIENCE", 0.2)
    much = bytes(1 << 20)  # more than a pipe holds
    reads, writes = os.pipe()
    assert module.taken(writes, b"little")
    assert os.read(reads, 100) == b"little"
    assert not module.taken(writes, much)
    os.close(reads)
    assert not module.taken(writes, much)
    os.close(writes)
    reads, writes = os.pipe()
    got = []
    reader = threading.Thread(target=lambda: got.extend(iter(lambda: os.read(reads, 1 << 16), b"")))
    reader.start()
    assert module.taken(writes, much)
    os.close(writes)
    reader.join()
    os.close(reads)
    assert b"".join(got) == much


@ALONE
@pytest.mark.parametrize("handler", ["signal.SIG_IGN", "lambda *_: None"])
def test_who_waits_for_processes_of_its_own_is_not_copied(handler):
    code = f"""
import signal
from bem.plots.side_by_side import _alone
assert _alone()
signal.signal(signal.SIGCHLD, {handler})
assert not _alone()
"""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    subprocess.run([sys.executable, "-c", code], timeout=60, check=True, env=environment)


@pytest.mark.internal
def test_a_process_of_several_threads_is_not_copied(monkeypatch):
    monkeypatch.setattr(module, "_alone", lambda: False)
    assert side_by_side(lambda i: i, 5, 4) == {}


@ALONE
def test_a_run_from_the_command_line_can_be_copied(tmp_path):
    """No thread is left over from computing and writing, so that figures are drawn on all cores."""
    code = """
import os, sys
import bem.plots.side_by_side as module
module.cores = lambda: 2
real, started = os.fork, []
os.fork = lambda: started.append(real()) or started[-1]
from bem.runs import run_scene
run_scene("hertz-sphere", sys.argv[1], settings=["grid.shape=32", "outputs.depths=[0.0]"])
assert len(started) == 1, started
"""
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    subprocess.run([sys.executable, "-c", code, tmp_path / "run"], timeout=400, check=True, env=environment)
