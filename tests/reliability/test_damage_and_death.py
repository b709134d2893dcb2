"""Processes killed while they write, and files damaged afterwards."""

import hashlib
import json
import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from bem.errors import ResultsError
from bem.results import open_run
from bem.results.checkpoint import load_checkpoint, save_checkpoint
from bem.results.read import damaged_files
from bem.runs import run_scene

SCENE = {
    "kind": "contact",
    "name": "small",
    "grid": {"shape": 16, "spacing": "0.5 um", "periodic": True},
    "lower": {"material": "steel-disk"},
    "shape": {"kind": "sinusoid", "amplitude": "10 nm", "wavelength": "8 um"},
    "contact": {"mean_pressure": "20 MPa"},
    "outputs": {"von_mises": True, "depths": ["0 um", "1 um"]},
}

WRITER = """
import sys, numpy as np
from pathlib import Path
from bem.results.checkpoint import save_checkpoint
from bem.results.dataset import write_variables
from bem.scenes.context import Variable
i = 0
while True:
    i += 1
    values = np.full(300_000, float(i))
    save_checkpoint(Path("checkpoint.bin"), {"i": i, "a": values})
    write_variables(Path("results.nc"), {"a": Variable(("n",), values, "m", "a")}, {"i": i})
    print(i, flush=True)
"""


@pytest.mark.internal
@pytest.mark.slow
@pytest.mark.parametrize("delay", [0.0, 0.003, 0.01])
def test_a_killed_writer_leaves_whole_files(tmp_path, delay):
    command = [sys.executable, "-c", WRITER]
    with subprocess.Popen(command, cwd=tmp_path, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        for _ in range(3):
            written = int(process.stdout.readline())
        time.sleep(delay)
        process.send_signal(signal.SIGKILL)
    state = load_checkpoint(tmp_path / "checkpoint.bin")
    assert state["i"] >= written
    assert np.all(state["a"] == state["i"])
    import h5py

    with h5py.File(tmp_path / "results.nc") as file:
        assert np.all(file["a"][:] == file.attrs["i"])


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    return run_scene(SCENE, tmp_path_factory.mktemp("finished") / "run").path


def files(folder):
    return sorted(str(item.relative_to(folder)) for item in folder.rglob("*") if item.is_file())


@pytest.mark.internal
@pytest.mark.slow
def test_a_flipped_bit_in_any_file_is_found(finished):
    names = [name for name in files(finished) if name != "checksums.json"]
    assert len(names) > 6
    assert damaged_files(finished) == []
    for name in names:
        path = finished / name
        whole = path.read_bytes()
        for place in (0, len(whole) // 2, len(whole) - 1):
            path.write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
            assert damaged_files(finished) == [name]
            if name in ("summary.json", "scene.toml"):
                with pytest.raises(ResultsError, match="checksum"):
                    open_run(finished)
            elif name == "results.nc":
                with pytest.raises(ResultsError, match="checksum"):
                    open_run(finished).dataset.load()
        path.write_bytes(whole)
    path = finished / "figures" / sorted(os.listdir(finished / "figures"))[0]
    whole = path.read_bytes()
    path.unlink()
    assert damaged_files(finished) == [str(path.relative_to(finished))]
    path.write_bytes(whole)
    assert damaged_files(finished) == []


@pytest.mark.slow
@pytest.mark.parametrize("content", [b"", b"{", b"\xff\xfe", b"[" * 3000])
def test_damaged_checksums_are_said(finished, content):
    path = finished / "checksums.json"
    whole = path.read_bytes()
    try:
        path.write_bytes(content)
        with pytest.raises(ResultsError, match="checksums"):
            open_run(finished)
    finally:
        path.write_bytes(whole)


@pytest.fixture
def plain(tmp_path):
    """A finished run without figures, to be damaged."""
    return run_scene(SCENE, tmp_path / "run", figures=False).path


@pytest.mark.parametrize("content", [None, "", "{}", "[]", "null", '{"results.nc": 3}'])
def test_a_run_without_its_checksums_is_damaged(plain, content):
    """Else any damage would be accepted with them: this opened 25 of 41 damaged runs."""
    path = plain / "checksums.json"
    if content is None:
        path.unlink()
    else:
        path.write_text(content)
    with pytest.raises(ResultsError, match=r"checksums\.json"):
        open_run(plain)


@pytest.mark.internal
@pytest.mark.parametrize("name", ["summary.json", "scene.toml", "results.nc"])
def test_a_file_without_a_checksum_is_damaged(plain, name):
    known = json.loads((plain / "checksums.json").read_text())
    del known[name]
    (plain / "checksums.json").write_text(json.dumps(known))
    assert damaged_files(plain) == [name]
    with pytest.raises(ResultsError, match=rf"{name}: is damaged.*missing from checksums"):
        open_run(plain).dataset  # noqa: B018


@pytest.mark.internal
def test_a_file_that_was_put_there_is_named(plain):
    (plain / "report.html").write_text("not ours")
    assert damaged_files(plain) == ["report.html"]


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda summary: [summary], "not a table"),
        (lambda summary: summary | {"notes": "one"}, "notes is not a list"),
        (lambda summary: summary | {"notes": [1]}, "notes is not a list"),
        (lambda summary: summary | {"notes": [{"text": "one"}]}, "notes is not a list"),
        (lambda summary: summary | {"seconds_by_stage": {"contact": "long"}}, "seconds_by_stage is not"),
        (lambda summary: summary | {"wall_time_s": True}, "wall_time_s is not a number"),
        (lambda summary: {key: value for key, value in summary.items() if key != "status"}, "status is missing"),
    ],
)
def test_a_summary_of_another_form_is_refused(plain, change, words):
    """With its right checksum: not damaged, but not ours."""
    text = json.dumps(change(json.loads((plain / "summary.json").read_text())))
    (plain / "summary.json").write_text(text)
    known = json.loads((plain / "checksums.json").read_text())
    known["summary.json"] = hashlib.sha256(text.encode()).hexdigest()
    (plain / "checksums.json").write_text(json.dumps(known))
    with pytest.raises(ResultsError, match=rf"summary\.json: is not the summary of a run.*{words}"):
        open_run(plain)


@pytest.mark.internal
def test_a_report_does_not_pass_damage_off_as_whole(plain):
    from typer.testing import CliRunner

    from bem.cli import build

    path = plain / "volume.vtu"
    path.write_bytes(path.read_bytes() + b" ")
    done = CliRunner().invoke(build(), ["report", str(plain)])
    assert isinstance(done.exception, ResultsError)
    assert "volume.vtu" in str(done.exception)
    assert damaged_files(plain) == ["volume.vtu"]


@pytest.mark.internal
@given(st.binary(max_size=200), st.integers(0, 400), st.integers(0, 400))
@settings(deadline=None, max_examples=80, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_any_checkpoint_file_is_read_or_refused(tmp_path, noise, start, end):
    path = tmp_path / "checkpoint.bin"
    save_checkpoint(path, {"a": np.arange(20.0), "b": [1, None, "x"]})
    whole = path.read_bytes()
    path.write_bytes(whole[:start] + noise + whole[end:])
    if path.read_bytes() == whole:
        return
    with pytest.raises(ResultsError, match="damaged"):
        load_checkpoint(path)


@pytest.mark.internal
@pytest.mark.slow
def test_two_processes_in_one_folder(tmp_path):
    """The second is refused while the first runs, and the first is not disturbed."""
    (tmp_path / "long.toml").write_text(
        'kind = "contact"\ngrid = {shape = 128, spacing = "0.5 um", periodic = true}\n'
        'lower = {material = "steel-disk"}\nshape = {kind = "sinusoid", amplitude = "10 nm", wavelength = "64 um"}\n'
        'contact = {mean_pressure = "2 MPa"}\n'
        'outputs = {von_mises = true, vtk = false, depths = {deepest = "20 um", count = 300}}\n'
    )
    command = [sys.executable, "-m", "bem", "run", "long.toml", "--out", "out", "--no-figures"]
    first = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 60
    while not (tmp_path / "out" / "scene.toml").exists():
        assert time.monotonic() < deadline
        time.sleep(0.005)
    os.kill(first.pid, signal.SIGSTOP)
    try:
        for more in ([], ["--resume"], ["--overwrite"]):
            second = subprocess.run([*command, *more], cwd=tmp_path, capture_output=True, text=True, timeout=60)
            assert second.returncode == 4
            assert f"another run is using this folder (process {first.pid})" in second.stderr
    finally:
        os.kill(first.pid, signal.SIGCONT)
    _, errors = first.communicate(timeout=100)
    assert first.returncode == 0, errors
    assert damaged_files(tmp_path / "out") == []
