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


def check(folder):
    command = [str(INTERPRETER), "-m", "fem_reference", "all", "--check", "--only", CASE, "--out", str(folder)]
    environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, check=False, timeout=300)


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
