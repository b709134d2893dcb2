"""One engine for many cases: the same bits wherever they run, whatever is killed, and what fails is named."""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest

from bem.campaigns import campaign_of, compute, jobs, plan
from bem.campaigns.engine import Board, notes_of, notes_of_path
from bem.campaigns.local import compute_locally
from bem.errors import ConvergenceError, InputError, interrupts_as_they_are
from bem.kinds.wear.kind import KIND
from bem.notes.note import as_note
from bem.notes.scenes import FILM_THINNER_THAN_ROUGHNESS
from bem.results import open_run
from bem.runs import plan_scene, run_scene
from bem.scenes import load_scene, wearing

TIMES = ("wall_time_s", "seconds_by_stage")
SCENE = {
    "kind": "wear",
    "name": "small",
    "repetitions": 2,
    "lower": {
        "material": "steel-disk",
        "surface": {"kind": "generated", "rms_height": "120 nm", "correlation_length": "0.4 um"},
    },
    "upper": {
        "material": "steel-cylinder",
        "surface": {"kind": "generated", "rms_height": "30 nm", "correlation_length": "0.3 um"},
    },
    "cylinder": {"radius": "2 mm", "width": "6 mm", "loads": ["2.5 N", "5 N"], "friction": 0.16},
    "domain": {"cells": 24, "lengths": "4 um"},
    "depths": {"count": 10, "spacing": "95 nm"},
    "cycles": {"count": 4, "settled": 2},
}


class Telling:
    def __init__(self, act=lambda what, done: None):
        self.act, self.notes, self.seen = act, [], []

    def progress(self, done, total, what, figures):
        self.seen.append((what, done, total))
        self.act(what, done)

    def note(self, text):
        self.notes.append(text)


def content(run):
    """Arrays as bytes, the summary without times."""
    summary = {key: value for key, value in run.summary.items() if key not in TIMES and "seconds" not in key}
    arrays = {
        name: item.values.tobytes() for name, item in run.dataset.variables.items() if not name.endswith("_seconds")
    }
    return arrays, summary


@pytest.fixture(scope="module")
def alone(tmp_path_factory):
    return run_scene(SCENE, tmp_path_factory.mktemp("alone") / "run", figures=False, workers=1)


@pytest.mark.internal
def test_two_workers_each_get_cases_and_the_bits_are_the_same(alone, tmp_path, monkeypatch):
    by_worker = {}
    given = []
    hand_out = __import__("bem.campaigns.local", fromlist=["_hand_out"])._hand_out

    def counting(worker, waiting, attempts):
        by_worker.setdefault(worker.process.pid, []).append(waiting[0].index)
        given.append(waiting[0].index)
        hand_out(worker, waiting, attempts)

    monkeypatch.setattr("bem.campaigns.local._hand_out", counting)
    both = run_scene(SCENE, tmp_path / "run", figures=False, workers=2)
    assert sorted(given) == [0, 1, 2, 3]
    assert len(by_worker) == 2
    assert content(both) == content(alone)


def test_workers_execute_no_python_file_of_the_folder_that_they_are_started_in(alone, tmp_path, monkeypatch):
    for name in ("numba", "numpy", "bem"):
        (tmp_path / f"{name}.py").write_text("open('executed', 'w').close()\n")
    monkeypatch.chdir(tmp_path)
    # this process may have the current folder on its path, as one that runs `python -c` has; workers share the path
    monkeypatch.setattr(sys, "path", [path for path in sys.path if path])
    both = run_scene(SCENE, tmp_path / "run", figures=False, workers=2)
    assert not (tmp_path / "executed").exists()
    assert content(both) == content(alone)


@pytest.mark.internal
def test_the_last_of_three_has_both_cores_and_the_same_bits(tmp_path, monkeypatch):
    threads = []
    outright = jobs.compute_locally
    monkeypatch.setattr(
        jobs, "compute_locally", lambda sent, *how: threads.extend(one.threads for one in sent) or outright(sent, *how)
    )
    three = {"settings": ['cylinder.loads=["2.5 N", "5 N", "10 N"]', "repetitions=1"], "figures": False}
    both = run_scene(SCENE, tmp_path / "both", workers=2, **three)
    assert threads == [1, 1, 2]
    assert content(both) == content(run_scene(SCENE, tmp_path / "one", workers=1, **three))


def test_dataset_has_the_axes_as_dimensions(alone):
    data = alone.dataset
    assert data["radius"].dims == ("load", "variant", "repetition", "cycle")
    assert data.attrs["axes"] == "load variant repetition"
    assert list(data["load"].values) == [2.5, 5.0]
    assert data["load"].attrs["units"] == "N"
    each = alone.summary["Sq_final_nm_each"]
    np.testing.assert_array_equal(1e9 * data["Sq_final"].values[:, 0, :], each)
    assert alone.summary["Sq_final_nm"] == pytest.approx(np.mean(each, axis=1), rel=1e-15)
    case = data["particle_case"].values
    assert set(case) <= {0, 1, 2, 3}
    assert len(case) == data["particles"].values.sum()  # a count of every cycle, and a row for every particle


def test_one_case_alone_is_that_case_among_many(alone):
    scene, _ = plan_scene(SCENE, ['cylinder.loads=["5 N"]', "repetitions=1"])
    outcome = compute(campaign_of(scene)).outcome
    assert outcome.summary["Sq_final_nm"] == alone.summary["Sq_final_nm_each"][1][0]


def test_a_single_case_starts_no_process(tmp_path, monkeypatch):
    def refuse(*arguments, **keywords):
        raise AssertionError("a process was started")

    monkeypatch.setattr("subprocess.Popen", refuse)
    run = run_scene(
        SCENE, tmp_path / "run", settings=['cylinder.loads=["5 N"]', "repetitions=1"], figures=False, workers=4
    )
    assert run.summary["status"] == "converged"


@pytest.mark.internal
@pytest.mark.parametrize("stop", [("cycles", 2), ("cycles", 7), ("cases", 2)])
def test_stopped_between_and_inside_cases_it_ends_in_the_same_bits(alone, tmp_path, stop, monkeypatch):
    monkeypatch.setattr(wearing, "_CHECKPOINT_EVERY", 1)

    def interrupt(what, done):
        if (what, done) == stop:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        run_scene(SCENE, tmp_path / "run", figures=False, workers=1, watcher=Telling(interrupt))
    assert list((tmp_path / "run" / "cases").glob("*.bin"))
    telling = Telling()
    resumed = run_scene(SCENE, tmp_path / "run", figures=False, workers=1, resume=True, watcher=telling)
    assert content(resumed) == content(alone)
    assert not (tmp_path / "run" / "cases").exists()
    steps = [done for what, done, _ in telling.seen if what == "cycles"]
    assert len(steps) <= 16 - (stop[1] if stop[0] == "cycles" else 4 * stop[1]) + 1 + 4  # what was done is not redone


@pytest.mark.internal
def test_a_case_that_fails_is_named_and_the_others_are_kept(tmp_path, monkeypatch):
    run = KIND.run

    def failing(scene, context):
        if scene.cylinder.loads == [5.0]:
            raise ConvergenceError("cycle 3: the contact stalled")
        context.note("about all")
        if scene.cylinder.loads == [2.5]:
            context.note("of one load")
        return run(scene, context)

    kind = __import__("dataclasses").replace(KIND, run=failing)
    monkeypatch.setattr("bem.campaigns.engine.get_kind", lambda name: kind)
    telling = Telling()
    done = run_scene(SCENE, tmp_path / "run", figures=False, workers=1, watcher=telling)
    assert done.summary["status"] == "stalled"
    assert "load 5 N, repetition 0: cycle 3: the contact stalled" in done.summary["where"]
    assert done.summary["Sq_final_nm"][0] > 0
    assert done.summary["Sq_final_nm"][1] is None
    assert np.isnan(done.dataset["radius"].values[1]).all()
    assert any("failed: cycle 3" in text for text in telling.notes)
    with pytest.raises(ConvergenceError, match="stalled"):
        run_scene(SCENE, tmp_path / "all", settings=['cylinder.loads=["5 N"]'], figures=False, workers=1)


@pytest.mark.internal
@pytest.mark.parametrize("arrays", [0, 1, 5])
def test_an_interrupt_that_falls_into_a_compiled_call_pauses_the_run(tmp_path, monkeypatch, arrays):
    """numba rebuilds what a loop returns by Python; what is raised there Python tells as a SystemError, once more for
    every array that is still to be returned. A paused run was called failed."""

    def interrupted(*given):
        error = KeyboardInterrupt()
        for _ in range(arrays + 1):
            outer = SystemError("returned a result with an exception set")
            outer.__cause__ = error
            error = outer
        raise error

    monkeypatch.setattr("bem.campaigns.engine.solve_case", interrupted)
    with pytest.raises(KeyboardInterrupt):
        run_scene({**SCENE, "repetitions": 1}, tmp_path / "run", figures=False, workers=1)
    monkeypatch.undo()
    with pytest.raises(SystemError), interrupts_as_they_are():
        raise SystemError("of its own")


@pytest.mark.internal
def test_notes_say_which_cases_they_are_of():
    by_case = [("load 1 N", ["a", "b"]), ("load 2 N", ["a"]), ("load 3 N", ["a", "c"]), ("load 4 N", ["a", "c"])]
    assert notes_of(by_case) == ["a", "load 1 N: b", "load 3 N; load 4 N: c"]


@pytest.mark.internal
def test_notes_of_a_path_say_at_how_many_positions_they_hold():
    """The first position's note stood for all 31, as if it were of that one alone."""
    touching, few = FILM_THINNER_THAN_ROUGHNESS(where=""), as_note("few cells").at("film")
    found = notes_of_path(
        [("position -1 mm", [touching]), ("position 0 m", [touching, few]), ("position 1 mm", [touching])]
    )
    assert [note.where for note in found] == ["at 3 of 3 positions", "at 1 of 3 positions (0 m), film"]


@pytest.mark.internal
def test_progress_is_of_all_cases_together():
    campaign = campaign_of(plan_scene(SCENE)[0])
    telling = Telling()
    board = Board(telling, campaign)
    board.watching(0).progress(1, 4, "cycles", {})
    board.watching(3).progress(2, 4, "cycles", {})
    board.over(0)
    assert [item for item in telling.seen if item[0] == "cycles"] == [
        ("cycles", 1, 16), ("cycles", 3, 16), ("cycles", 6, 16),
    ]  # fmt: skip
    assert telling.seen[-1] == ("cases", 1, 4)


def test_work_adds_up_in_the_plan_and_memory_does_not():
    one = plan_scene(SCENE, ['cylinder.loads=["5 N"]', "repetitions=1"])[1]
    four = plan_scene(SCENE)[1]
    steps = {step.name: step for step in four.steps}
    single = {step.name: step for step in one.steps}
    assert steps["contact"].transforms == pytest.approx(4 * single["contact"].transforms, rel=1e-12)
    assert steps["figures and report"].seconds == single["figures and report"].seconds
    assert four.memory == one.memory
    assert (one.cases, four.cases) == (1, 4)


@pytest.mark.internal
def test_every_mistake_of_the_cases_is_said_once():
    scene = load_scene(SCENE, ['cylinder.loads=["1 MN", "2 MN"]', "repetitions=3"])
    with pytest.raises(InputError) as caught:
        plan(campaign_of(KIND.resolve(scene)))
    assert len(caught.value.messages) == 2
    assert "1 MN" in caught.value.messages[0]


class Exploding:
    index = 0

    def compute(self, watcher):
        watcher.note("here")
        raise ZeroDivisionError("a bug")


@pytest.mark.internal
def test_a_bug_in_a_worker_is_raised_with_its_traceback():
    telling = Telling()
    sys.modules["exploding_for_tests"] = sys.modules[__name__]
    with pytest.raises(RuntimeError, match="ZeroDivisionError: a bug"):
        list(compute_locally([Exploding()], 1, lambda index: telling))
    assert telling.notes == ["here"]


UNGUARDED = """
import sys
from bem import run_scene
print("main part")
run_scene(sys.argv[1], sys.argv[2], figures=False, workers=2)
"""


@pytest.mark.slow
def test_a_script_without_a_guarded_main_part_runs_on_two_workers(alone, tmp_path):
    (tmp_path / "script.py").write_text(UNGUARDED)
    command = [sys.executable, "script.py", str(alone.path / "scene.toml"), "out"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("main part") == 1
    assert content(open_run(tmp_path / "out"))[0] == content(alone)[0]


@pytest.mark.slow
def test_a_killed_run_leaves_no_worker_behind_and_goes_on(alone, tmp_path):
    command = [sys.executable, "-m", "bem", "run", str(alone.path / "scene.toml"), "--out", str(tmp_path / "out")]
    command += ["--no-figures", "--workers", "2"]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    deadline = time.monotonic() + 100
    while not list((tmp_path / "out").glob("cases/*.bin")) and process.poll() is None:
        assert time.monotonic() < deadline
        time.sleep(0.02)
    marks = [pid for pid in map(int, filter(str.isdigit, os.listdir("/proc"))) if _is_worker_of(pid, process.pid)]
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    until = time.monotonic() + 20
    while any(Path(f"/proc/{pid}").exists() and _is_alive(pid) for pid in marks):
        assert time.monotonic() < until
        time.sleep(0.05)
    done = subprocess.run([*command, "--resume"], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    ours, theirs = content(open_run(tmp_path / "out")), content(alone)
    assert ours[0] == theirs[0]
    assert json.dumps(ours[1]) == json.dumps(theirs[1])


def _is_worker_of(pid, parent):
    with suppress(OSError):
        return int(Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[1]) == parent
    return False


def _is_alive(pid):
    with suppress(OSError):
        return Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()[0] != "Z"
    return False
