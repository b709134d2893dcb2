"""Shared by all tests."""

from pathlib import Path

import pytest

MEASURED = Path(__file__).resolve().parents[2] / "shared" / "data" / "measured"


@pytest.fixture(scope="session")
def measured() -> Path:
    """Folder with the measured surfaces; the test is skipped, saying so, where it is not there."""
    if not MEASURED.is_dir():
        pytest.skip(f"no measured surfaces at {MEASURED}")
    return MEASURED
