"""Words of the reports as data: one TOML file for each page, so that prose is read and changed as prose."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any


def prose(page: str) -> dict[str, Any]:
    """The words of a page."""
    return tomllib.loads((Path(__file__).parent / f"{page}.toml").read_text("utf-8"))
