"""A real Dask scheduler and two workers, started for the test, on the loopback interface only."""

import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

pytest.importorskip("distributed")

SCENE = """
kind = "contact"
grid = {shape = 16, spacing = "0.5 um", periodic = true}
lower = {material = "steel-disk", surface = {kind = "generated", rms_height = "100 nm", correlation_length = "2 um"}}
contact = {mean_pressure = "80 MPa", behaviour = "capped"}
"""


@pytest.fixture
def cluster(tmp_path):
    """Address of a scheduler and its two worker processes; ended after the test."""
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


@pytest.mark.slow
def test_sweep_survives_a_killed_worker_and_equals_the_local_one(tmp_path, cluster):
    from bem import run_sweep
    from bem.results.dataset import read_dataset

    address, workers = cluster
    (tmp_path / "small.toml").write_text(SCENE)
    killed = []

    class Killing:
        def progress(self, done, total, what, figures):
            if done >= 4 and not killed:
                killed.append(done)
                workers[0].send_signal(signal.SIGKILL)

        def note(self, text):
            raise AssertionError(text)

    done = run_sweep(tmp_path / "small.toml", ["seed=1:20"], tmp_path / "cluster", scheduler=address, watcher=Killing())
    assert killed
    assert workers[0].wait(timeout=20) == -signal.SIGKILL
    assert done.computed == 20
    assert done.failed == {}

    local = run_sweep(tmp_path / "small.toml", ["seed=1:20"], tmp_path / "local", workers=1)
    ours, theirs = (read_dataset(item.path / "sweep.nc") for item in (local, done))
    for name in ours.variables:
        if name != "wall_time_s":
            np.testing.assert_array_equal(ours[name].values, theirs[name].values, err_msg=str(name))


@pytest.mark.slow
def test_no_scheduler_is_said_in_words(tmp_path):
    (tmp_path / "small.toml").write_text(SCENE)
    done = subprocess.run(
        [sys.executable, "-m", "bem", "sweep", "small.toml", "--over", "seed=1:2", "--scheduler", "tcp://127.0.0.1:9"],
        cwd=tmp_path, capture_output=True, text=True, timeout=100, check=False,
    )  # fmt: skip
    assert done.returncode == 2, done.stderr
    assert "no Dask scheduler answers there" in done.stderr
    assert "Traceback" not in done.stderr
