"""Goals of run times and what threads share, as the page shows them: verdicts, and reasons where a goal is missed."""

import dataclasses

import numpy as np
import pytest

from bem import threads
from bem.benchmarks.record import new_run
from reports import goals, performance, shared
from reports.benchmarks.history import read_history, stored_run
from reports.experiments import enter_to_report, kept, shared_work


@pytest.fixture(scope="module")
def run():
    return read_history(performance.RESULTS)[-1]


def test_every_goal_of_the_stored_run_has_a_verdict_and_a_reason_where_it_is_not_reached(run):
    found = goals.goals(run)
    whats = [goal.what for goal in found]
    assert len(set(whats)) == len(whats)
    for cells in (256, 512, 1024, 2048):
        assert any(what.endswith(f"FFTW pair, periodic {cells}") for what in whats)
    for goal in found:
        what, wanted, value, verdict, why = goal.row
        assert (value is None) == (verdict == "not measured"), what
        assert bool(why) == (verdict == "not yet"), what
        assert wanted.split()[0] in ("<=", ">=")
    body = goals.section(run)
    assert body.count("<tr>") == len(found) + 1
    assert run.commit in body


def test_a_goal_is_reached_at_its_number_and_missed_beyond_it():
    most = goals.Goal("a", 2.0, 2.0, "because")
    assert most.row[3:] == ("reached", "")
    assert dataclasses.replace(most, value=2.1).row[3:] == ("not yet", "because")
    least = dataclasses.replace(most, least=True)
    assert least.met
    assert dataclasses.replace(least, value=1.9).row[1:] == (">= 2", "1.9", "not yet", "because")
    assert dataclasses.replace(most, value=None).row[2:] == (None, "not measured", "")


def test_a_run_without_points_measures_nothing(run):
    empty = dataclasses.replace(stored_run(new_run([])), commit="aaaa")
    told = {goal.what for goal in goals.goals(run) if goal.met is not None}
    assert {goal.what for goal in goals.goals(empty) if goal.met is not None} < told


@pytest.mark.internal
def test_blocks_that_one_thread_does_are_counted_as_threads_would_share_them():
    """Half of the work in six blocks: two threads do three in a row, four two, eight one; the rest is serial."""

    def busy():
        field = np.ones(200_000)
        for _ in range(20):
            np.sqrt(field, out=field)

    def solve():
        for _ in range(6):
            busy()
        threads.share(lambda worker, block: busy(), 6, 1)

    for count, together in ((2, 0.5), (4, 1 / 3), (8, 1 / 6)):
        gains, serial = zip(*(shared_work.gain(solve, count) for _ in range(5)), strict=True)
        assert np.median(serial) == pytest.approx(0.5, abs=0.15)  # two halves that a busy machine does not do alike
        left = np.median(serial)
        assert np.median(gains) == pytest.approx(1 / (left + (1 - left) * together), rel=0.1)
    assert threads.share.__module__ == "bem.threads"
    assert threads.get_threads() == 1


def test_work_that_is_shared_is_found_wherever_it_is_done():
    """A contact goes through transforms and passes that hold `share` by name: none of these may be missed."""
    found = shared_work.row("contact-periodic", 256)
    assert 0.1 < found["serial"] < 0.98
    assert 1.0 <= found["gains"][0] <= 2.0
    assert found["gains"][0] <= found["gains"][2] + 0.1


def test_the_stored_shares_are_shown():
    body = shared.gains()
    for row in kept.found("shared_work"):
        assert f"{row['gains'][1]:.2f}" in body


def test_scenes_are_held_to_two_seconds_or_a_fifth_outside_their_solvers():
    excess = enter_to_report.excess
    assert excess({"processor_s": 3.0, "outside_s": 2.0}) == 1.0
    assert excess({"processor_s": 60.0, "outside_s": 3.0}) == 0.25
    assert excess({"processor_s": 5.0, "outside_s": 3.0}) == 1.5
    rows = kept.found("enter_to_report")["scenes"]
    body = goals.outside_solvers()
    assert body.count("<tr>") == len(rows) + 1
    assert all(scene in body for scene in rows)


def test_only_what_a_run_computes_counts_as_its_solvers(tmp_path, monkeypatch):
    monkeypatch.setattr(enter_to_report, "LONG", 0.0)  # once: it does not matter whether loops are compiled
    row = enter_to_report.outside("hertz-sphere", str(tmp_path / "run"))
    assert 0.2 < row["outside_s"] < row["processor_s"]  # imports alone take more
    assert (tmp_path / "run" / "report.html").is_file()


@pytest.mark.slow
def test_what_is_not_compared_says_why(run):
    body = "".join(section.body for section in performance.build().sections)
    for code, _, why in shared.MISSING:
        assert code in body
        assert why.split(",")[0].split(" (")[0] in body
