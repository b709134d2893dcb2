"""Processes of the page: they refuse what does not fit, die alone, give memory back, and leave the server free."""

import asyncio
import os
import signal
import time

import numpy as np
import pytest

from bem import InputError, ResultsError
from bem.app import computing
from bem.app.computing import Computing, Mistake

pytestmark = pytest.mark.internal


def number_of_process():
    return os.getpid()


def allocate(cells):
    return float(np.ones(cells).sum())


def die():
    os.kill(os.getpid(), signal.SIGKILL)


def refuse():
    raise InputError(["one: wrong", "two: wrong"])


def fail():
    raise ZeroDivisionError("by nothing")


def wait_for(path):
    while not os.path.exists(path):
        time.sleep(0.02)
    return "found"


def always():
    return True


def in_processes(use):
    """What a coroutine returns that is given processes of its own."""

    async def whole():
        processes = Computing()
        try:
            return await use(processes)
        finally:
            processes.end()

    return asyncio.run(asyncio.wait_for(whole(), 120))


def test_one_process_does_several_jobs_and_is_not_the_server():
    async def use(processes):
        return [await processes.call(always, number_of_process) for _ in range(2)]

    first, second = in_processes(use)
    assert first == second != os.getpid()


def test_what_does_not_fit_is_refused_and_the_process_goes_on():
    async def use(processes):
        with pytest.raises(InputError, match="memory"):
            await processes.call(always, allocate, 1 << 42)
        with pytest.raises(InputError) as refused:
            await processes.call(always, refuse)
        with pytest.raises(Mistake, match="ZeroDivisionError: by nothing"):
            await processes.call(always, fail)
        return refused.value.messages, await processes.call(always, allocate, 10)

    assert in_processes(use) == (("one: wrong", "two: wrong"), 10.0)


def test_a_process_that_dies_is_replaced():
    async def use(processes):
        with pytest.raises(ResultsError, match="died"):
            await processes.call(always, die)
        first = await processes.call(always, number_of_process)
        os.kill(first, signal.SIGKILL)  # while it has no job: nobody need know
        while processes._idle[0]._process.poll() is None:
            await asyncio.sleep(0.02)
        return first, await processes.call(always, number_of_process)

    first, second = in_processes(use)
    assert first != second


def test_memory_is_given_back_after_a_large_job():
    async def use(processes):
        first = await processes.call(always, number_of_process)
        await processes.call(always, keep, int(computing.MOST_KEPT / 8) + (1 << 20))
        return first, len(processes._idle), await processes.call(always, number_of_process)

    first, idle, second = in_processes(use)
    assert idle == 0
    assert first != second


KEPT = []


def keep(cells):
    KEPT.append(np.ones(cells))


def test_the_server_answers_while_something_is_computed(tmp_path):
    """The job ends only by what the event loop does meanwhile."""

    async def use(processes):
        job = asyncio.ensure_future(processes.call(always, wait_for, str(tmp_path / "there")))
        await asyncio.sleep(0.05)
        (tmp_path / "there").write_text("")
        return await job

    assert in_processes(use) == "found"


def test_what_nobody_wants_any_more_is_not_computed(tmp_path):
    async def use(processes):
        held = [
            asyncio.ensure_future(processes.call(always, wait_for, str(tmp_path / "there")))
            for _ in range(computing.PROCESSES)
        ]
        await asyncio.sleep(0.05)
        wanted = True
        late = asyncio.ensure_future(processes.call(lambda: wanted, die))
        await asyncio.sleep(0.05)
        wanted = False
        (tmp_path / "there").write_text("")
        await asyncio.gather(*held)
        return await late

    assert in_processes(use) is None
