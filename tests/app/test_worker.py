"""What a run's process tells its page: pace, what is left, figures on the way."""

import itertools
import json

import pytest

from bem.app.worker import Stage, Told
from bem.app.workspace import HISTORY, PROGRESS

pytestmark = pytest.mark.internal


def test_what_is_left_follows_the_mean_pace():
    stage = Stage(done=2, total=10, now=100.0)
    assert stage.left(2, 105.0) is None  # no step yet
    assert stage.left(3, 100.5) is None  # too short a time to tell
    assert stage.left(4, 106.0) == pytest.approx(18.0)  # 3 s a step, six to go
    assert stage.left(10, 120.0) == 0.0


def test_figures_are_thinned_evenly_and_nothing_infinite_is_kept():
    stage = Stage(0, 10_000, 0.0)
    for step in range(10_000):
        stage.tell(step, {"residual": 1.0 / (step + 1), "odd": float("nan")})
    steps = [done for done, _ in stage.points]
    assert 100 < len(steps) <= 301
    assert {b - a for a, b in itertools.pairwise(steps)} == {steps[1] - steps[0]}
    assert steps[-1] > 9_900
    assert all(set(figures) == {"residual"} for _, figures in stage.points)


def test_steps_of_all_cases_count_beside_the_number_of_finished_ones(tmp_path):
    told = Told(tmp_path)
    told.progress(30, 300, "cycles", {"friction": 0.1})
    told.progress(1, 3, "cases", {})
    told.progress(130, 300, "cycles", {"friction": 0.2})
    told.end("done")
    state = json.loads((tmp_path / PROGRESS).read_text())
    assert (state["what"], state["done"], state["total"]) == ("cycles", 130, 300)
    assert state["cases"] == [1, 3]
    history = json.loads((tmp_path / HISTORY).read_text())
    assert history == {"cycles": {"total": 300, "points": [[30, {"friction": 0.1}], [130, {"friction": 0.2}]]}}


def test_a_resumed_run_keeps_its_curve_and_its_time_without_the_pause(tmp_path):
    first = Told(tmp_path)
    for step in range(0, 50, 10):
        first.progress(step, 100, "cycles", {"friction": 0.1 + step})
    first.progress(1, 4, "distances", {"Sq": 1.0})
    first.end("paused")
    told = json.loads((tmp_path / PROGRESS).read_text())
    assert told["began"] <= told["written"]
    (tmp_path / PROGRESS).write_text(json.dumps({"began": told["began"] - 30.0}))  # as the page writes it
    second = Told(tmp_path)
    second.progress(30, 100, "cycles", {"friction": 7.0})  # from its checkpoint, a little before
    second.end("paused")
    history = json.loads((tmp_path / HISTORY).read_text())
    assert [done for done, _ in history["cycles"]["points"]] == [0, 10, 20, 30]
    assert history["cycles"]["points"][-1][1] == {"friction": 7.0}
    assert history["distances"]["points"] == [[1, {"Sq": 1.0}]]
    assert json.loads((tmp_path / PROGRESS).read_text())["began"] == told["began"] - 30.0
