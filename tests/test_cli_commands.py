"""The command line as a user meets it: real processes, exit codes, one message per mistake."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from command_line import run_command

from bem.results import open_run

SMALL = """
kind = "contact"
seed = 3
grid = {shape = 24, spacing = "0.5 um", periodic = true}
[lower]
material = "steel-disk"
surface = {kind = "generated", rms_height = "100 nm", correlation_length = "2 um"}
[contact]
mean_pressure = "80 MPa"
behaviour = "capped"
"""


def bem(*arguments, cwd, timeout=300, env=None):
    return subprocess.run(
        [sys.executable, "-W", "error", "-m", "bem", *map(str, arguments)],
        cwd=cwd, capture_output=True, text=True, timeout=timeout, check=False, env={**os.environ, **(env or {})},
    )  # fmt: skip


@pytest.fixture
def small(tmp_path):
    (tmp_path / "small.toml").write_text(SMALL)
    return tmp_path


def test_bad_scene_is_exit_code_2_and_writes_nothing(small):
    done = bem(
        "run", "small.toml", "--out", "out",
        "--set", "contact.behaviour=caped", "--set", "lower.material=steel-disc", "--set", "grid.spacing=5 N",
        cwd=small,
    )  # fmt: skip
    assert done.returncode == 2
    lines = done.stderr.splitlines()
    assert len(lines) == 3
    assert 'contact.behaviour = "caped": not allowed - did you mean "capped"?' in done.stderr
    assert 'did you mean "steel-disk"?' in done.stderr
    assert 'grid.spacing = "5 N": is not a length' in done.stderr
    assert "Traceback" not in done.stderr
    assert os.listdir(small) == ["small.toml"]


def test_plan_prints_steps_reasons_memory_and_time_and_writes_nothing(small):
    done = bem("plan", "small.toml", cwd=small, env={"XDG_CACHE_HOME": str(small / "cache")})
    assert done.returncode == 0
    assert "contact" in done.stdout
    assert re.search(r"skipped +no body is coated", done.stdout)
    assert "MiB" in done.stdout
    assert done.stderr == ""
    rates = json.loads((small / "cache" / "bem" / "machine.json").read_text())
    assert all(1e7 < rate < 1e13 for rate in rates.values())
    assert sorted(os.listdir(small)) == ["cache", "small.toml"]
    shared = bem("plan", "small.toml", "--ranks", "3", cwd=small, env={"XDG_CACHE_HOME": str(small / "cache")})
    assert "shared by 3 processes" in shared.stdout
    assert "the others need about" in " ".join(shared.stdout.split())


@pytest.mark.slow
def test_run_report_plot_and_the_same_bits_again(small):
    done = bem("run", "small.toml", "--out", "out", cwd=small)
    assert done.returncode == 0, done.stderr
    notes = done.stderr.splitlines()
    summary = json.loads((small / "out" / "summary.json").read_text())
    codes = {note["code"] for note in summary["notes"]}
    assert "hardness-decides" in codes, "93 % of this contact is at the cap"
    assert all(line.startswith("bem: caution: ") for line in notes), "piped: no progress, no warnings of libraries"
    assert "contact area fraction" in done.stdout
    assert "out/report.html" in done.stdout
    before = (small / "out" / "results.nc").read_bytes()

    again = bem("run", "small.toml", "--out", "out", cwd=small)
    assert again.returncode == 4
    assert "holds a run already" in again.stderr
    resumed = run_command("run", "out", "--resume", cwd=small)
    assert resumed.returncode == 0
    assert "contact area fraction" in resumed.stdout
    other = run_command("run", "out/scene.toml", "--no-figures", cwd=small)
    assert other.returncode == 0
    assert "runs/small-001" in other.stdout
    assert (small / "runs" / "small-001" / "results.nc").read_bytes() == before

    (small / "out" / "report.html").unlink()
    report = run_command("report", "out", cwd=small)
    assert report.returncode == 0
    assert (small / "out" / "report.html").stat().st_size > 50_000
    names = run_command("plot", "out", cwd=small)
    assert "pressure-map" in names.stdout
    plot = run_command("plot", "out", "--figure", "pressure-map", "--size", "85x60 mm", "--format", "pdf", cwd=small)
    assert plot.returncode == 0
    assert (small / "pressure-map.pdf").read_bytes().startswith(b"%PDF")
    wrong = bem("plot", "out", "--figure", "presure-map", cwd=small)
    assert wrong.returncode == 2
    assert "pressure-map" in wrong.stderr


@pytest.mark.slow
def test_not_converged_is_exit_code_3_says_where_and_keeps_the_results(small):
    done = bem("run", "small.toml", "--out", "out", "--no-figures", "--set", "contact.max_iterations=1", cwd=small)
    assert done.returncode == 3
    assert "not converged: contact solve" in done.stderr
    assert open_run(small / "out").summary["status"] == "max_iterations"
    assert open_run(small / "out").dataset["pressure"].shape == (24, 24)


@pytest.mark.parametrize("out", ["small.toml", "/proc/nothing"])
def test_folder_that_cannot_be_written_is_exit_code_4(small, out):
    done = bem("run", "small.toml", "--out", out, cwd=small)
    assert done.returncode == 4
    assert len(done.stderr.splitlines()) == 1
    assert "cannot be used as the run's folder" in done.stderr
    assert (small / "small.toml").read_text() == SMALL


@pytest.mark.slow
def test_a_disk_that_fills_is_exit_code_4_one_message_nothing_half_written(small):
    """RLIMIT_FSIZE stands for the full disk; a tmpfs of 32 kB behaves the same."""
    code = (
        "import resource, sys; resource.setrlimit(resource.RLIMIT_FSIZE, (22000, 22000)); "
        "sys.argv = ['bem', 'run', 'small.toml', '--out', 'out', '--no-figures']; from bem.cli import main; main()"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=small, capture_output=True, text=True, timeout=300, check=False
    )
    assert done.returncode == 4, done.stderr
    assert len([line for line in done.stderr.splitlines() if not line.startswith("bem: caution: ")]) == 1
    assert "results.nc: cannot be written" in done.stderr
    assert sorted(os.listdir(small / "out")) == ["checkpoint.bin", "scene.toml"]
    rest = bem("run", "small.toml", "--out", "out", "--resume", "--no-figures", cwd=small)
    assert rest.returncode == 0


LONG = """
kind = "contact"
grid = {shape = 192, spacing = "0.5 um", periodic = true}
lower = {material = "steel-disk", surface = {kind = "generated", rms_height = "100 nm", correlation_length = "3 um"}}
contact = {mean_pressure = "80 MPa", behaviour = "capped"}
outputs = {von_mises = true, vtk = false, depths = {deepest = "20 um", count = 200}}
"""


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """The long scene run without interruption."""
    folder = tmp_path_factory.mktemp("whole")
    (folder / "long.toml").write_text(LONG)
    done = bem("run", "long.toml", "--out", "whole", "--no-figures", cwd=folder)
    assert done.returncode == 0
    assert not (folder / "whole" / "figures").exists()
    return open_run(folder / "whole").dataset


@pytest.mark.slow
def test_interrupted_runs_resume_to_the_same_bits(tmp_path, whole):
    (tmp_path / "long.toml").write_text(LONG)
    command = [sys.executable, "-m", "bem", "run", "long.toml", "--out", "cut", "--no-figures"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    deadline = time.monotonic() + 250
    while not (tmp_path / "cut" / "checkpoint.bin").exists():
        assert time.monotonic() < deadline
        assert process.poll() is None, process.communicate()
        time.sleep(0.01)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "Traceback" not in errors
    assert not (tmp_path / "cut" / "summary.json").exists()
    assert "--resume goes on" in errors
    resumed = bem("run", "long.toml", "--out", "cut", "--resume", "--no-figures", cwd=tmp_path)
    assert resumed.returncode == 0, resumed.stderr
    found = open_run(tmp_path / "cut").dataset
    for name in whole.variables:
        np.testing.assert_array_equal(found[name].values, whole[name].values, err_msg=name)


def test_help_lists_commands_and_is_light():
    code = (
        "import sys, time; sys.argv = ['bem', '--help']\n"
        "from bem.cli import main\n"
        "try: main()\n"
        "except SystemExit: pass\n"
        "heavy = {'numpy', 'scipy', 'pydantic', 'pint', 'matplotlib', 'xarray', 'numba', 'pyfftw'} & set(sys.modules)\n"
        "print('HEAVY', sorted(heavy))"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60, check=False)
    for name in ("run", "plan", "scenes", "report", "plot"):
        assert f" {name} " in done.stdout
    assert "HEAVY []" in done.stdout, done.stdout[-300:]


def test_scenes_lists_every_built_in_scene(tmp_path):
    from bem.scenes import library

    done = bem("scenes", cwd=tmp_path)
    assert done.returncode == 0
    for name in library():
        assert any(line.startswith(name) for line in done.stdout.splitlines())
    shown = bem("scenes", "--show", "rough-contact", cwd=tmp_path)
    assert shown.stdout.startswith("#")
    Path(tmp_path / "mine.toml").write_text(shown.stdout)
    assert bem("plan", "mine.toml", cwd=tmp_path).returncode == 0


def test_version(tmp_path):
    done = bem("--version", cwd=tmp_path)
    assert done.returncode == 0
    assert done.stdout.startswith("bem ")


def test_usage_mistakes_are_exit_code_2(tmp_path):
    for arguments in (["run"], ["run", "x", "--nope"], ["nope"], ["plan", "nowhere.toml"]):
        done = bem(*arguments, cwd=tmp_path)
        assert done.returncode == 2, arguments
        assert "Traceback" not in done.stderr


def test_tab_completion_knows_the_built_in_scenes():
    from bem.cli.run import complete_scene
    from bem.scenes import library

    assert complete_scene("") == sorted(library())
    assert complete_scene("hertz") == ["hertz-cylinder", "hertz-sphere"]


@pytest.mark.internal
def test_completion_of_figures_and_formats(tmp_path):
    from types import SimpleNamespace

    from bem.cli.plot import complete_figure, complete_format
    from bem.plots.draw import FORMATS

    (tmp_path / "figures").mkdir()
    for name in ("pressure-map.png", "pressure-map.pdf", "contact-map.png"):
        (tmp_path / "figures" / name).touch()
    context = SimpleNamespace(params={"run": tmp_path})
    assert complete_figure(context, "") == ["contact-map", "pressure-map"]
    assert complete_figure(context, "p") == ["pressure-map"]
    assert complete_format("") == list(FORMATS)


def test_every_example_in_a_help_text_is_of_that_command():
    """Commands, options and built-in scenes in the examples are there."""
    import re
    import shlex

    from typer.main import get_command

    from bem.cli import build

    app = get_command(build())
    found = 0
    for name, command in app.commands.items():
        for line in re.findall(r"^ +(bem .*)$", command.help or "", re.MULTILINE):
            words = shlex.split(line.split(" > ")[0])
            assert words[1] == name
            known = {option for parameter in command.params for option in (*parameter.opts, *parameter.secondary_opts)}
            assert {word for word in words if word.startswith("--")} <= known, line
            found += 1
    assert found >= 15


@pytest.mark.internal
def test_progress_is_shown_on_a_terminal_only_and_not_for_short_work(monkeypatch, capsys):
    from bem.cli import _terminal

    clock = [0.0]
    monkeypatch.setattr(_terminal.time, "monotonic", lambda: clock[0])
    monkeypatch.setenv("TERM", "xterm")
    for live, shown in ((False, False), (True, True)):
        clock[0] = 0.0
        with _terminal.Terminal() as terminal:
            terminal._live = live
            terminal.progress(1, 10, "cycles", {"radius_nm": 140.0})
            assert capsys.readouterr().err == ""
            clock[0] = 5.0
            terminal.progress(5, 10, "cycles", {"radius_nm": 150.0})
            terminal.note("a note")
        text = capsys.readouterr().err
        assert "a note" in text
        assert ("cycles" in text) is shown
        assert ("5/10" in text) is shown
