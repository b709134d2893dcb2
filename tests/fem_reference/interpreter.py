"""Runs the finite-element package in its own interpreter; skips, saying so, where there is none."""

import os
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PYTHON = ROOT / ".venv-fem" / "bin" / "python"
STORED = ROOT / "bem" / "verification" / "fem_results"


def fem(*arguments, code=0, timeout=600):
    """Run the interpreter with these arguments; what it printed, on both streams."""
    if not PYTHON.exists():
        pytest.skip("no .venv-fem: run `make setup-fem` to have the finite-element tests")
    given = {"OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [PYTHON, *arguments], cwd=ROOT, capture_output=True, text=True, env={**os.environ, **given}, timeout=timeout
    )
    assert done.returncode == code, done.stdout + done.stderr
    return done.stdout + done.stderr
