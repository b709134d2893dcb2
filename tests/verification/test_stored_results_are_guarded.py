"""CI recomputes stored finite-element results and refuses one that no longer reproduces."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
STORED = ROOT / "bem" / "verification" / "fem_results"
CASE = "strip-antiplane"
INTERPRETER = ROOT / ".venv-fem" / "bin" / "python"


def check(folder, *options):
    options = ["--check", "--only", CASE, "--out", str(folder), *options]
    command = [str(INTERPRETER), "-m", "fem_reference", "all", *options]
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False, timeout=300)


@pytest.mark.fem
def test_only_changed_cases_and_a_sample_are_solved_again(tmp_path):
    if not INTERPRETER.exists():
        pytest.skip("no .venv-fem: `make setup-fem` makes it")
    path = tmp_path / f"{CASE}.json"
    shutil.copy(STORED / path.name, path)
    same = check(tmp_path, "--changed")
    assert same.returncode == 0, same.stdout + same.stderr
    assert "0 of 0 cases reproduced" in same.stdout
    assert "1 of 1 cases reproduced" in check(tmp_path, "--changed", "--sample", "5", "--seed", "1").stdout

    document = json.loads(path.read_text())
    document["inputs"] = "of other sources"
    curve = document["quantities"][0]
    curve["values"][0] += 10 * curve["error_bar"][0] + 1e-6 * max(map(abs, curve["values"]))
    path.write_text(json.dumps(document))
    changed = check(tmp_path, "--changed")
    assert changed.returncode == 1
    assert f"FAILED {CASE}" in changed.stdout


@pytest.mark.fem
def test_a_stored_result_that_does_not_reproduce_is_refused(tmp_path):
    if not INTERPRETER.exists():
        pytest.skip("no .venv-fem: `make setup-fem` makes it")
    path = tmp_path / f"{CASE}.json"
    shutil.copy(STORED / path.name, path)
    healthy = check(tmp_path)
    assert healthy.returncode == 0, healthy.stdout + healthy.stderr
    assert path.read_text() == (STORED / path.name).read_text()

    document = json.loads(path.read_text())
    curve = document["quantities"][0]
    # ten error bars: small beside what an engineer would see, large beside what the mesh study allows
    curve["values"][0] += 10 * curve["error_bar"][0] + 1e-6 * max(map(abs, curve["values"]))
    path.write_text(json.dumps(document))
    tampered = check(tmp_path)
    assert tampered.returncode == 1
    assert curve["name"] in tampered.stdout
    assert "stored" in tampered.stdout
