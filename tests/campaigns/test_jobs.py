"""Who gets which job when: by counts, not by the clock."""

from types import SimpleNamespace

import pytest

from bem.campaigns import campaign_of, jobs
from bem.campaigns.jobs import Staff, hand_out
from bem.runs import plan_scene
from bem.threads import get_threads, set_threads


class Telling:
    def __init__(self):
        self.notes = []

    def note(self, text):
        self.notes.append(text)


class Job:
    """So many seconds of work; its result is how many threads it had."""

    def __init__(self, index, seconds):
        self.index = index
        self.plan = SimpleNamespace(work=lambda rate: seconds, memory=1.0)

    def compute(self, watcher):
        return get_threads()

    def lost(self, why):
        raise AssertionError(why)


@pytest.fixture
def handed_out(monkeypatch):
    """hand_out(seconds of each, workers) -> what is sent to processes, in that order; done here."""
    sent = []
    monkeypatch.setattr(jobs, "machine_rate", lambda threads: 1.0)
    monkeypatch.setattr(jobs, "compute_locally", lambda given, *_: sent.extend(given) or iter(()))

    def call(seconds, workers):
        sent.clear()
        todo = [Job(i, one) for i, one in enumerate(seconds)]
        here = list(hand_out(todo, Staff(workers, threads=1), lambda index: None, Telling().note))
        return [one.index for one in sent], [one.threads for one in sent], here

    return call


@pytest.mark.internal
def test_the_longest_go_first_and_equal_ones_in_their_order(handed_out):
    assert handed_out([1.0, 9.0, 5.0, 9.0], 2)[0] == [1, 3, 2, 0]


@pytest.mark.internal
@pytest.mark.parametrize(
    ("seconds", "workers", "threads"),
    [
        ([7.0] * 15, 2, [1] * 14 + [2]),  # the last of fifteen has both cores
        ([7.0] * 6, 4, [1, 1, 1, 1, 2, 2]),
        ([7.0] * 7, 4, [1] * 7),
        ([7.0] * 4, 2, [1] * 4),
        ([9.0, 7.0, 2.0], 2, [1] * 3),  # the third begins while one of the others still runs
    ],
)
def test_a_last_round_that_is_not_full_shares_the_idle_cores(handed_out, seconds, workers, threads):
    assert handed_out(seconds, workers)[1] == threads


@pytest.mark.internal
def test_what_no_process_is_worth_is_done_here_in_order_with_the_threads_asked_for(handed_out):
    before = get_threads()
    try:
        set_threads(2)
        sent, _, here = handed_out([1.0, 2.0, 0.5], None)
        assert (sent, here) == ([], [(0, 1), (1, 1), (2, 1)])
        assert get_threads() == 2
    finally:
        set_threads(before)


def test_the_plan_knows_the_work_of_each_case():
    scene, plan = plan_scene("wear-steel-steel", ['cylinder.loads=["2.5 N", "5 N"]'])
    campaign = campaign_of(scene)
    assert len(plan.of_cases) == plan.cases == len(campaign.cases) == 10
    of_each = [step for one in plan.of_cases for step in one.steps if step.name == "contact"]
    (together,) = (step for step in plan.steps if step.name == "contact")
    assert sum(step.transforms for step in of_each) == pytest.approx(together.transforms, rel=1e-12)
    assert all(one.memory <= plan.memory for one in plan.of_cases)
