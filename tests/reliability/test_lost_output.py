"""Closed, full and broken standard streams: runs end with whole results, other commands end quietly."""

import itertools
import os
import signal
import subprocess
import sys

import pytest

from bem import run_scene
from bem.cli._streams import OutputStream
from bem.results.read import damaged_files, open_run

SCENE = """
kind = "contact"
grid = {shape = 16, spacing = "0.5 um", periodic = true}
[lower]
material = "steel-disk"
surface = {kind = "generated", rms_height = "100 nm", correlation_length = "2 um"}
[contact]
mean_pressure = "80 MPa"
"""

BEM = f"{sys.executable} -m bem"
PRINTS_ONLY = (
    "plan small.toml",
    "scenes",
    "materials",
    "oils",
    "verify --help",
    "compare one one --no-figures",
)
OUTPUT_LOST = (">&-", ">/dev/full", ">&- 2>&-", "<&- >&- 2>&-", ">/dev/full 2>&1", "2>&1 | true; exit ${PIPESTATUS[0]}")
ERRORS_LOST = ("2>&-", "2>/dev/full")


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "small.toml").write_text(SCENE)
    return tmp_path


def shell(line, folder):
    return subprocess.run(
        ["bash", "-c", f"{BEM} {line}"], cwd=folder, capture_output=True, text=True, timeout=300, check=False
    )


@pytest.mark.internal
@pytest.mark.parametrize("streams", ["<&- >&- 2>&-", ">/dev/full 2>&1", OUTPUT_LOST[-1], "2>/dev/full"])
def test_a_run_is_finished_whatever_happens_to_its_terminal(folder, streams):
    done = shell(f"run small.toml --out one --no-figures {streams}", folder)
    assert done.returncode == 0
    assert "Traceback" not in done.stderr
    assert open_run(folder / "one").summary["status"] == "converged"
    assert damaged_files(folder / "one") == []


@pytest.mark.internal
def test_the_exit_code_of_a_run_is_that_of_its_results(folder):
    """Not converged (3) and a bad scene (2), with all streams closed."""
    done = shell("run small.toml --out one --no-figures --set contact.max_iterations=1 >&- 2>&-", folder)
    assert done.returncode == 3
    assert damaged_files(folder / "one") == []
    assert shell("run small.toml --set contact.load=foo >/dev/full 2>&1", folder).returncode == 2


@pytest.mark.parametrize("streams", [">&- 2>&-", "2>&1 | true; exit ${PIPESTATUS[0]}"])
def test_a_sweep_is_finished_whatever_happens_to_its_terminal(folder, streams):
    done = shell(f"sweep small.toml --over seed=1,2 --workers 2 --out all {streams}", folder)
    assert done.returncode == 0
    assert "Traceback" not in done.stderr
    assert {"sweep.nc", "sweep.csv", "sweep.png"} <= set(os.listdir(folder / "all"))


def test_commands_that_only_print_end_quietly_with_1(folder):
    run_scene(folder / "small.toml", folder / "one", figures=False)
    for command, streams in zip(PRINTS_ONLY, itertools.cycle((">&-", ">/dev/full"))):
        done = shell(f"{command} {streams}", folder)
        assert (done.returncode, done.stderr) == (1, ""), command


@pytest.mark.parametrize("streams", OUTPUT_LOST)
def test_more_than_a_pipe_holds_ends_quietly_with_1(folder, streams):
    done = shell(f"schema contact {streams}", folder)
    assert (done.returncode, done.stderr) == (1, "")


def test_a_lost_error_stream_takes_nothing_from_the_output(folder):
    for command in ("oils", "scenes"):
        whole = shell(command, folder).stdout
        assert whole
        for streams in ERRORS_LOST:
            done = shell(f"{command} {streams}", folder)
            assert done.returncode == 0, (command, streams)
            assert done.stdout == whole


def test_a_file_is_written_though_its_name_cannot_be_printed(folder):
    assert shell("new contact mine.toml >&- 2>&-", folder).returncode == 0
    assert shell("new contact other.toml >/dev/full", folder).returncode == 0
    assert (folder / "mine.toml").read_text() == (folder / "other.toml").read_text()


def test_no_file_of_a_command_takes_the_place_of_a_closed_stream(folder):
    """A file opened on descriptor 1 would hold what is printed."""
    code = "import os; from bem.cli._streams import protect_streams; protect_streams(); f = open('file', 'w'); "
    code += "os.write(1, b'out'); os.write(2, b'err'); raise SystemExit(0 if f.fileno() > 2 else 9)"
    line = f'{sys.executable} -c "{code}" <&- >&- 2>&-'
    assert subprocess.run(["bash", "-c", line], cwd=folder, timeout=60, check=False).returncode == 0
    assert (folder / "file").read_bytes() == b""


def test_text_after_a_failed_write_is_dropped():
    """The reader leaves in the middle: what it has read is whole, what follows is dropped."""
    usual = signal.signal(signal.SIGPIPE, signal.SIG_IGN)  # as Python sets it, whatever a test before has done
    reader, writer = os.pipe()
    stream = OutputStream(writer)
    assert stream.write(b"first") == 5
    assert os.read(reader, 100) == b"first"
    os.close(reader)
    assert not stream.lost
    assert stream.write(b"second") == 6
    assert stream.lost
    os.close(writer)
    assert stream.write(b"third") == 5, "a lost stream is not written to again"
    signal.signal(signal.SIGPIPE, usual)
