"""A real Dask scheduler and two workers, started for the test, on the loopback interface only."""

import json
import os
import signal
import subprocess
import sys
import time
from contextlib import contextmanager

import pytest
from small_scenes import CONTACT as SCENE

from bem import run_scene, run_sweep
from bem.campaigns import engine
from bem.cli import main

pytest.importorskip("distributed")

CASES = SCENE | {"over": {"contact.mean_pressure": ["40 MPa", "80 MPa"]}, "repetitions": 3}


@pytest.fixture(scope="module")
def cluster(tmp_path_factory):
    """Address of a scheduler and its two worker processes; ended after the tests."""
    tmp_path = tmp_path_factory.mktemp("cluster")
    file = tmp_path / "scheduler.json"
    log = open(tmp_path / "cluster.log", "w")  # noqa: SIM115
    quiet = {"cwd": tmp_path, "stdout": log, "stderr": log, "env": {**os.environ, "OPENBLAS_NUM_THREADS": "1"}}
    started = [
        subprocess.Popen(
            [sys.executable, "-m", "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0",
             "--no-dashboard", "--scheduler-file", file], **quiet,
        )
    ]  # fmt: skip
    try:
        deadline = time.monotonic() + 60
        while not file.exists() or not file.read_text().strip():
            assert time.monotonic() < deadline, (tmp_path / "cluster.log").read_text()
            assert started[0].poll() is None, (tmp_path / "cluster.log").read_text()
            time.sleep(0.05)
        address = json.loads(file.read_text())["address"]
        for name in ("one", "two"):
            started.append(
                subprocess.Popen(
                    [sys.executable, "-m", "distributed.cli.dask_worker", address, "--host", "127.0.0.1", "--name",
                     name, "--nthreads", "1", "--no-nanny", "--no-dashboard", "--local-directory", tmp_path / name],
                    **quiet,
                )
            )  # fmt: skip
        yield address, started[1:]
    finally:
        for process in started:
            process.kill()
            process.wait()
        log.close()


def arrays(dataset):
    """The bits of a dataset, without times."""
    return {
        name: item.values.tobytes()
        for name, item in dataset.variables.items()
        if name != "wall_time_s" and not str(name).endswith("_seconds")
    }


class Acting:
    """A watcher that does something once so many of what is counted are done; it keeps what it is told."""

    def __init__(self, what, at, act):
        self.what, self.at, self.act = what, at, act
        self.acted = False
        self.notes = []

    def progress(self, done, total, what, figures):
        if what == self.what and done >= self.at and not self.acted:
            self.acted = True
            self.act()

    def note(self, text):
        self.notes.append(text)


def interrupt():
    raise KeyboardInterrupt


@contextmanager
def other_disk(folder):
    """What workers find where they see another disk: no secret of this run."""
    yield "a secret that nobody finds"


@pytest.mark.internal
@pytest.mark.slow
@pytest.mark.parametrize("seen", [True, False], ids=["disk", "no-disk"])
def test_cases_of_one_scene_on_a_cluster(tmp_path, cluster, seen, monkeypatch):
    """Interrupted and resumed, the bits are those of one process, whether workers see the disk or not."""
    if not seen:
        monkeypatch.setattr("bem.campaigns.jobs.marked", other_disk)
    more = {"scheduler": cluster[0], "figures": False}
    stopping = Acting("cases", 2, interrupt)
    with pytest.raises(KeyboardInterrupt):
        run_scene(CASES, tmp_path / "run", watcher=stopping, **more)
    assert not stopping.notes
    kept = {path.name: path.read_bytes() for path in (tmp_path / "run" / "cases").glob("*.bin")}
    finished = [name for name, content in kept.items() if b"_record" in content]
    assert 2 <= len(finished) < 6
    given = []
    outright = engine.hand_out
    monkeypatch.setattr(
        engine, "hand_out", lambda jobs, *how: given.extend(job.index for job in jobs) or outright(jobs, *how)
    )
    done = run_scene(CASES, tmp_path / "run", resume=True, **more)
    assert sorted([*given, *(int(name.removesuffix(".bin")) for name in finished)]) == list(range(6))
    alone = run_scene(CASES, tmp_path / "alone", workers=1, figures=False)
    assert arrays(done.dataset) == arrays(alone.dataset)
    assert done.dataset["pressure"].dims == ("contact.mean_pressure", "repetition", "x", "y")
    assert not (tmp_path / "run" / ".campaign-token").exists()


@pytest.mark.slow
def test_sweep_survives_a_killed_worker_and_equals_the_local_one(tmp_path, cluster):
    address, workers = cluster
    killing = Acting("points", 4, lambda: workers[0].send_signal(signal.SIGKILL))
    done = run_sweep(SCENE, ["seed=1:20"], tmp_path / "cluster", scheduler=address, watcher=killing)
    assert killing.acted
    assert workers[0].wait(timeout=20) == -signal.SIGKILL
    assert (done.computed, done.failed) == (20, {})
    watching = Acting("points", 21, interrupt)
    local = run_sweep(SCENE, ["seed=1:20"], tmp_path / "local", workers=1, watcher=watching)
    assert arrays(done.dataset) == arrays(local.dataset)
    # What the points themselves note, and nothing of the worker: its work was given to the other.
    assert [note.replace("/cluster/", "/local/") for note in killing.notes] == watching.notes


@pytest.mark.slow
def test_no_scheduler_is_said_in_words(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr("bem.campaigns.cluster._ANSWER_WITHIN", "1s")
    monkeypatch.chdir(tmp_path)
    command = "bem sweep rough-contact --over seed=1:2 --scheduler tcp://127.0.0.1:9"
    monkeypatch.setattr("sys.argv", command.split())
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code == 2
    (line,) = capsys.readouterr().err.strip().splitlines()
    assert "no Dask scheduler answers there" in line
