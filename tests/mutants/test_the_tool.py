"""The mutation tool on a tree of one function: what is killed, what survives, what is gone, and what is left behind."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

OWN = Path(__file__).parent
HALF = "def half(value):\n    return abs(value) / 2\n"
TEST = "from bem.half import half\n\n\ndef test_half_of_four():\n    assert half(4) == 2\n"
LIST = """
[[mutant]]
file = "bem/half.py"
old = "/ 2"
new = "/ 3"
slip = "a third"

[[mutant]]
file = "bem/half.py"
old = "abs(value)"
new = "value"
slip = "missing abs"
reason = "gap: no test of a negative number"

[[mutant]]
file = "bem/half.py"
old = "/ 4"
new = "/ 5"
slip = "of a line that was rewritten"
"""


@pytest.fixture
def tree(tmp_path):
    """A repository with one function, one test and three mutants."""
    root = tmp_path / "tree"
    (root / "bem").mkdir(parents=True)
    shutil.copytree(OWN, root / "tests" / "mutants", ignore=shutil.ignore_patterns("seeds", "test_*", "__pycache__"))
    (root / "tests" / "particles").mkdir()
    (root / "tests" / "mutants" / "seeds").mkdir()
    (root / "reports" / "results").mkdir(parents=True)
    (root / ".gitignore").write_text("build/\n__pycache__/\n")
    (root / "pyproject.toml").write_text("[tool.pytest.ini_options]\nmarkers = ['slow', 'fem', 'browser']\n")
    (root / "bem" / "__init__.py").touch()
    (root / "bem" / "half.py").write_text(HALF)
    (root / "tests" / "particles" / "test_half.py").write_text(TEST)
    (root / "tests" / "mutants" / "seeds" / "particles.toml").write_text(LIST)
    subprocess.run(["git", "init", "-q"], cwd=root, check=True)
    return root


def mutants(tree, *arguments):
    """Run the tool in a tree; its exit code, and the stored outcomes by slip."""
    command = [sys.executable, "-m", "tests.mutants", *arguments]
    done = subprocess.run(command, cwd=tree, capture_output=True, text=True, timeout=300, check=False)
    stored = json.loads((tree / "reports" / "results" / "mutants.json").read_text())["mutants"]
    return done.returncode, {entry["slip"]: entry for entry in stored.values()}, done.stdout + done.stderr


def test_mutants_are_killed_survive_or_are_gone(tree):
    code, found, said = mutants(tree)
    assert code == 1, said
    assert found["a third"]["result"] == "killed"
    assert found["a third"]["by"] == "tests/particles/test_half.py::test_half_of_four"
    assert found["missing abs"]["result"] == "survived"
    assert found["missing abs"]["reason"] == "gap: no test of a negative number"
    assert found["of a line that was rewritten"]["result"] == "gone"
    assert (tree / "bem" / "half.py").read_text() == HALF
    assert [path.name for path in (tree / "build" / "mutants").glob("*/")] == ["unchanged"]
    assert (tree / "build" / "mutants" / "unchanged" / "bem" / "half.py").read_text() == HALF

    # a test for the gap kills the survivor; what is stored is not run again
    with (tree / "tests" / "particles" / "test_half.py").open("a") as file:
        file.write("\n\ndef test_half_of_a_negative_number():\n    assert half(-4) == 2\n")
    _, found, said = mutants(tree, "--only", "missing abs", "--renew")
    assert found["missing abs"]["result"] == "killed", said
    assert "0 of 1 mutants to run" in mutants(tree, "--only", "a third")[2]


def test_a_test_that_fails_without_any_change_kills_nothing(tree):
    path = tree / "tests" / "particles" / "test_half.py"
    path.write_text(path.read_text() + "\n\ndef test_that_always_fails():\n    assert half(-4) == -2\n")
    _, found, said = mutants(tree, "--only", "missing abs")
    assert found["missing abs"]["result"] == "survived", said
