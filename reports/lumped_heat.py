"""The table of the documentation of what lumped heat misses of full heat: what the stored experiment found."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from reports.builder import Section, table
from reports.experiments.kept import age

RESULT = Path(__file__).parent / "results" / "lumped_heat.json"
HEADERS = (
    "L",
    "M",
    "p_h (GPa)",
    "u (m/s)",
    "slide/roll",
    "rise, full (K)",
    "lumped: rise (K)",
    "film (%)",
    "friction (%)",
)


@cache
def rows() -> tuple[dict[str, Any], ...]:
    """The rows of the experiment."""
    return tuple(json.loads(RESULT.read_text("utf-8"))["found"])


def chapter() -> Section:
    """Return the table."""
    return Section("Lumped against full heat", table(HEADERS, _cells()) + age("lumped_heat"))


def _cells() -> Iterator[tuple[str, ...]]:
    for row in rows():
        case = (f"{row['L']:g}", f"{row['M']:g}", f"{row['hertz_pressure'] / 1e9:.2f}", f"{row['mean_speed']:.2g}")
        case += (f"{row['slide_roll_ratio']:g}",)
        if "film_error" not in row:
            said = {name: row[name]["status"] for name in ("full", "lumped")}
            yield (*case, *(f"{name} heat: {word}" for name, word in said.items()), "-", "-")
            continue
        errors = (f"{row['rise_error']:+.1f}", f"{100 * row['film_error']:+.0f}", f"{100 * row['traction_error']:+.0f}")
        yield (*case, f"{row['full']['rise']:.1f}", *errors)
