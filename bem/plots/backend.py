"""Matplotlib, loaded whatever the environment says of windows: pictures here are files, drawn with Agg.

Knows nothing of results. Verified in tests/plots/test_settings_of_the_user.py.
"""

from __future__ import annotations

import importlib
import os
import sys
from typing import Any


def load_matplotlib() -> Any:
    """The package, also where MPLBACKEND names no backend, with which it would not load: then its backend is Agg."""
    if "matplotlib" in sys.modules:
        return importlib.import_module("matplotlib")
    return _loaded(os.environ.get("MPLBACKEND"))


def _loaded(named: str | None) -> Any:
    if not named:
        return importlib.import_module("matplotlib")
    os.environ["MPLBACKEND"] = "agg"
    try:
        package = importlib.import_module("matplotlib")
    finally:
        os.environ["MPLBACKEND"] = named
    try:
        package.rcParams["backend"] = named  # as it does itself
    except ValueError:
        package.rcParams["backend"] = "agg"
    return package
