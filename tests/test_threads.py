"""How blocks of work are handed over to threads: by whom they are done, and who is waited for."""

import os
import threading

import numpy as np
import pytest

from bem import threads
from bem.transforms import Multiplier, PaddedTransform


@pytest.fixture(autouse=True)
def three_threads(monkeypatch):
    before = threads.get_threads()
    monkeypatch.setattr(threads, "SHARED_FROM", 1)
    monkeypatch.setattr(threads, "cores", lambda: 4)
    threads.set_threads(3)
    yield
    threads.set_threads(before)


@pytest.mark.parametrize("count", [1, 2, 3, 9])
def test_every_block_is_done_once_and_no_worker_number_is_too_large(count):
    threads.set_threads(count)
    for blocks in (0, 1, 2, 7, 50):
        done = []
        threads.share(lambda worker, block, done=done: done.append((worker, block)), blocks, 100)
        assert sorted(block for _, block in done) == list(range(blocks))
        assert all(0 <= worker < max(1, min(count, 4, blocks)) for worker, _ in done)


def test_two_threads_are_inside_at_once():
    """Each waits for the other: alone neither would go on."""
    meeting = threading.Barrier(2, timeout=60)
    seen = set()
    threads.share(lambda worker, block: (meeting.wait(), seen.add(worker)), 2, 100)
    assert seen == {0, 1}


def test_threads_are_kept_and_no_more_are_used_than_there_are_cores():
    threads.share(lambda worker, block: None, 8, 100)
    before = threading.active_count()
    for _ in range(50):
        threads.share(lambda worker, block: None, 8, 100)
    assert threading.active_count() == before
    threads.set_threads(64)
    assert threads.threads_for(100) == 4


def test_who_comes_late_or_was_called_for_another_task_does_nothing():
    done = []
    task = threads._Task(lambda worker, block: done.append(worker), 4, 2)
    task.help(2)  # two share this one: 0 and 1
    assert done == []
    task.help(1)
    task.close()  # nobody is inside: returns
    task.help(1)
    assert done == [1] * 4
    assert task.inside == 0


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


def test_a_convolution_is_three_tasks_of_two_pieces_a_thread(monkeypatch):
    found, plain = [], threads._Pool.share
    monkeypatch.setattr(threads._Pool, "share", lambda pool, task: (found.append(task.blocks), plain(pool, task))[1])
    transform = PaddedTransform((1024, 256), (1024, 512))
    field, factor = np.random.default_rng(1).random((1024, 256)), Multiplier(np.ones((257, 513)))
    together = transform.convolve(field, factor)
    assert found == [6, 6, 6]
    threads.set_threads(1)
    assert transform.convolve(field, factor).tobytes() == together.tobytes()
