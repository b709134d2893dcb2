"""Logs of workers: a worker that ends without a report leaves its last test, its memory and its exit status."""

import itertools
import os
import subprocess
import sys
from pathlib import Path

CONFTEST = """
from worker_logs import register as pytest_configure
"""
ENDINGS = """
import os, signal
import pytest

def test_passes():
    pass

@pytest.mark.parametrize("end", [lambda: os._exit(3), lambda: os.kill(os.getpid(), signal.SIGTERM),
                                 lambda: os.kill(os.getpid(), signal.SIGKILL)], ids=["exit", "term", "kill"])
def test_ends(end):
    end()
"""
TEST = "test_endings.py::test_ends"
CAUSES = {"exit": "exit status 3", "term": "signal 15 (Terminated)", "kill": "signal 9 (Killed)"}


def run_tests(folder, *options):
    (folder / "conftest.py").write_text(CONFTEST)
    (folder / "test_endings.py").write_text(ENDINGS)
    start = f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r}); import pytest; "
    arguments = ["-q", "-p", "no:cacheprovider", "-p", "xdist", *options, "test_endings.py"]
    command = [sys.executable, "-c", start + "sys.exit(pytest.main(sys.argv[1:]))", *arguments]
    environment = os.environ | {"PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}  # others take most of a start
    done = subprocess.run(
        command, cwd=folder, capture_output=True, text=True, timeout=300, check=False, env=environment
    )
    section = done.stdout.partition("= workers =")[2]
    assert section, done.stdout + done.stderr
    return done.returncode, section.splitlines()


def test_the_summary_says_how_each_worker_ended(tmp_path):
    code, lines = run_tests(tmp_path, "-n", "1")
    assert code == 1
    places = [number for number, line in enumerate(lines) if line.startswith("gw")]
    *crashed, last = (lines[one:other] for one, other in itertools.pairwise([*places, None]))
    assert ": peak " in last[0]
    found = {name: own for own in crashed for name in CAUSES if any(f"::test_ends[{name}]" in line for line in own)}
    for name, cause in CAUSES.items():
        assert cause in found[name][0]
        assert any(line.startswith("    began ") and line.endswith(f"MB: {TEST}[{name}]") for line in found[name])
    assert any("in <lambda>" in line for line in found["term"])  # the trace, which a signal that is caught leaves


def test_without_workers_the_summary_has_the_memory_of_the_session(tmp_path):
    code, lines = run_tests(tmp_path, "-n", "0", "-k", "passes")
    assert code == 0
    assert any(line.startswith("peak ") for line in lines)
