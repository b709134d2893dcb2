"""Steps of continuous integration: their times, and what the last lines of the output say after a failure."""

import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]


def run_script(body):
    """Run a script of named steps; return its exit code and its lines, of which the last tell the outcome."""
    text = f"set -euo pipefail\n. .ci/steps\n{body}"
    done = subprocess.run(["bash", "-c", text], cwd=ROOT, capture_output=True, text=True, timeout=60, check=False)
    assert done.stderr == ""
    lines = done.stdout.splitlines()
    return done.returncode, lines[: lines.index("Seconds of each step:")], lines[lines.index("Seconds of each step:") :]


def test_steps_that_pass_are_shown_with_their_seconds():
    code, shown, last = run_script(
        "waited() { wait $job; echo three; }\nsleep 0.1 & job=$!\n"
        "step first echo one\nstep second bash -c 'echo two >&2'\nstep third waited\n"
    )
    assert code == 0
    assert shown == ["== first", "one", "== second", "two", "== third", "three"]
    assert [line.split()[1] for line in last[1:]] == ["first", "second", "third"]


@pytest.mark.parametrize(
    ("printed", "repeated"),
    [
        (["FAILED tests/a.py::b - assert 1", "noise", "ERROR tests/c.py", "= 1 failed ="],
         ["FAILED tests/a.py::b - assert 1", "noise", "ERROR tests/c.py", "= 1 failed ="]),
        (["OUTSIDE one, row 2: a 3", "    python -m it --row='row 2'", *map(str, range(99))],
         ["OUTSIDE one, row 2: a 3", "    python -m it --row='row 2'"]),
        (list(map(str, range(99))), list(map(str, range(69, 99)))),
    ],
)  # fmt: skip
def test_after_a_failure_the_last_lines_say_which_step_and_what_in_it(printed, repeated, tmp_path):
    (tmp_path / "lines").write_text("\n".join(printed) + "\n")
    code, shown, last = run_script(
        f"fails() {{ cat {tmp_path}/lines; return 3; }}\nstep good true\nstep bad fails\nstep never true\n"
    )
    assert code == 3
    assert shown == ["== good", "== bad", *printed]
    assert last[3:] == ["FAILED: bad", *repeated]
