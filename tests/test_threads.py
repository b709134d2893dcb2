"""How blocks of work are handed over to threads: by whom they are done, and who is waited for."""

import multiprocessing
import os
import subprocess
import sys
import threading
import warnings

import numpy as np
import pytest

from bem import threads
from bem.threads import share
from bem.transforms import Multiplier, PaddedTransform, padded


@pytest.fixture(autouse=True)
def three_threads(monkeypatch):
    before = threads.get_threads()
    monkeypatch.setattr(threads, "SHARED_FROM", 1)
    monkeypatch.setattr(threads, "cores", lambda: 4)
    threads.set_threads(3)
    yield
    threads.set_threads(before)


@pytest.mark.internal
@pytest.mark.parametrize("count", [1, 2, 3, 9])
def test_every_block_is_done_once_and_no_worker_number_is_too_large(count):
    threads.set_threads(count)
    for blocks in (0, 1, 2, 7, 50):
        done = []
        threads.share(lambda worker, block, done=done: done.append((worker, block)), blocks, 100)
        assert sorted(block for _, block in done) == list(range(blocks))
        assert all(0 <= worker < max(1, min(count, 4, blocks)) for worker, _ in done)


@pytest.mark.internal
def test_two_threads_are_inside_at_once():
    """Each waits for the other: alone neither would go on."""
    meeting = threading.Barrier(2, timeout=60)
    seen = set()
    threads.share(lambda worker, block: (meeting.wait(), seen.add(worker)), 2, 100)
    assert seen == {0, 1}


@pytest.mark.internal
def test_threads_are_kept_and_no_more_are_used_than_there_are_cores():
    threads.share(lambda worker, block: None, 8, 100)
    before = threading.active_count()
    for _ in range(50):
        threads.share(lambda worker, block: None, 8, 100)
    assert threading.active_count() == before
    threads.set_threads(64)
    assert threads.threads_for(100) == 4


@pytest.mark.internal
def test_a_thread_that_has_not_begun_is_not_waited_for():
    threads.set_threads(2)
    threads.share(lambda worker, block: None, 2, 100)
    gate, done = threading.Event(), []
    try:
        with threads._POOL.busy:
            threads._POOL.submit(lambda worker: gate.wait(60), 2)  # all threads of the pool are at other work
        threads.share(lambda worker, block: done.append(worker), 4, 100)
    finally:
        gate.set()
    assert done == [0] * 4


@pytest.mark.internal
def test_a_failure_is_raised_and_the_next_call_works():
    def work(worker, block):
        if block in (1, 2):
            raise ValueError(str(block))

    for _ in range(20):
        with pytest.raises(ValueError, match=r"[12]"):
            threads.share(work, 6, 100)
        assert threads.get_threads() == 3  # what follows may share again
    done = []
    threads.share(lambda worker, block: done.append(block), 6, 100)
    assert sorted(done) == list(range(6))


@pytest.mark.internal
@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork here")
@pytest.mark.filterwarnings("ignore:This process")
def test_a_forked_process_has_threads_of_its_own():
    threads.share(lambda worker, block: None, 4, 100)
    child = os.fork()
    if child == 0:
        done = []
        threads.share(lambda worker, block: done.append(block), 4, 100)
        os._exit(0 if sorted(done) == [0, 1, 2, 3] else 1)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0


@pytest.mark.internal
def test_a_convolution_is_three_tasks_of_two_pieces_a_thread(monkeypatch):
    found = []
    monkeypatch.setattr(
        padded, "share", lambda work, blocks, entries: (found.append(blocks), share(work, blocks, entries))
    )
    transform = PaddedTransform((1024, 256), (1024, 512))
    field, factor = np.random.default_rng(1).random((1024, 256)), Multiplier(np.ones((257, 513)))
    together = transform.convolve(field, factor)
    assert found == [6, 6, 6]
    threads.set_threads(1)
    assert transform.convolve(field, factor).tobytes() == together.tobytes()


FORKS = """
import os, sys, threading, time, warnings
import numpy as np
from bem import Body, Grid, Material, displacement_operator, solve_contact
from bem.stress import summarise_stress

warnings.simplefilter("ignore")  # later Pythons warn of any fork beside threads
grid, steel = Grid((64, 64), (1e-6, 1e-6)), Body(Material("steel", youngs_modulus=210e9, poissons_ratio=0.3))
gap = grid.x[:, None] ** 2 / 2e-3 + grid.y**2 / 2e-3

def solve(load):
    found = solve_contact(gap, displacement_operator(grid, steel), load=load)
    summarise_stress(found.pressure, grid, steel, np.array([0.0, 1e-5 * load]))
    return found.pressure

def solve_forever():
    load = 1.0
    while True:
        load += 0.01
        solve(load)

whole = solve(1.0)
threading.Thread(target=solve_forever, daemon=True).start()
left = []
for number in range(8):
    time.sleep(0.05 + 0.013 * number)
    child = os.fork()
    if child == 0:
        os._exit(0 if np.array_equal(solve(1.0), whole) else 1)
    left.append(child)
end, codes = time.monotonic() + 60, []
while left and time.monotonic() < end:
    child = left.pop(0)
    done, status = os.waitpid(child, os.WNOHANG)
    if done:
        codes.append(os.waitstatus_to_exitcode(status))
    else:
        left.append(child)
        time.sleep(0.02)
for child in left:
    os.kill(child, 9)
print(len(left), codes, flush=True)
os._exit(0)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")
def test_children_forked_while_a_thread_solves_solve_the_same():
    done = subprocess.run([sys.executable, "-c", FORKS], capture_output=True, text=True, timeout=300, check=True)
    assert done.stdout.split("\n")[0] == f"0 {[0] * 8}"


@pytest.mark.internal
def test_a_lock_of_another_thread_is_free_in_the_child_and_one_that_guards_a_whole_is_waited_for():
    torn, whole = threads.ForkSafeLock(), threads.ForkSafeLock(whole=True)
    entered, state = threading.Event(), []

    def change():
        with torn, whole:
            entered.set()
            threading.Event().wait(0.2)
            state.append("complete")

    def child():
        for lock in (torn, whole):
            with lock:
                pass
        return state == ["complete"]

    thread = threading.Thread(target=change)
    thread.start()
    entered.wait()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # later Pythons warn of any fork beside threads
        process = multiprocessing.get_context("fork").Process(target=lambda: sys.exit(0 if child() else 1))
        process.start()
    process.join(60)
    code = process.exitcode
    process.kill()
    thread.join()
    assert code == 0


@pytest.mark.internal
def test_the_thread_that_forks_keeps_the_locks_that_it_holds():
    lock = threads.ForkSafeLock(whole=True)
    with lock:
        threads._before_fork()
        threads._in_parent()
        threads._before_fork()
        threads._in_child()
        taken = []
        other = threading.Thread(target=lambda: taken.append(lock.acquire(blocking=False)))
        other.start()
        other.join()
        assert taken == [False]
