"""What the test suite catches: the stored outcome of the mutation run (`make mutants`), for the verification report."""

from __future__ import annotations

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from reports.builder import table, text
from reports.prose import prose

STORED = Path(__file__).with_name("results") / "mutants.json"


def outcomes(path: Path = STORED) -> list[dict[str, Any]]:
    """Return the stored outcomes, room by room; none where the run was never made."""
    if not path.is_file():
        return []
    entries: dict[str, dict[str, Any]] = json.loads(path.read_text(encoding="utf-8"))["mutants"]
    return [entry for _, entry in sorted(entries.items())]


def body(entries: Sequence[dict[str, Any]]) -> str:
    """Return the section: numbers killed of those run, by room, and a table of survivors with their reasons."""
    words = prose("verification")["caught"]
    if not entries:
        return text(words["introduction"]) + text("Not run: make mutants")
    rooms = list(dict.fromkeys(entry["room"] for entry in entries))
    rows = [_row(room, [entry for entry in entries if entry["room"] == room]) for room in rooms]
    rows.append(_row("all", entries))
    found = text(words["introduction"]) + table(_HEADERS, rows)
    closed = [entry for entry in entries if "survived_before" in entry]
    if closed:
        found += text(words["closed"]) + table(
            ["file", "slip", "killed now by", "what was missing"],
            [[f"`{e['file']}`", e["slip"], f"`{e['by']}`", e.get("reason", "")] for e in closed],
        )
    survivors = [entry for entry in entries if entry["result"] == "survived"]
    if survivors:
        found += text(words["survivors"]) + table(
            ["file", "slip", "tests survived", "why"],
            [
                [f"`{e['file']}`", e["slip"], _SUITES[e["suite"]], e.get("reason") or "not yet judged"]
                for e in survivors
            ],
        )
    return found


_HEADERS = (
    "room",
    "run",
    "killed",
    "of these survived once",
    "survived: equivalent",
    "survived: gap",
    "gone",
    "median time to kill [s]",
)
_SUITES = {"fast": "the room's fast tests", "full": "all tests of the room", "gates": "all, and the gates"}


def _row(room: str, entries: Sequence[dict[str, Any]]) -> list[Any]:
    killed = [entry for entry in entries if entry["result"] == "killed"]
    survived = [entry for entry in entries if entry["result"] == "survived"]
    equivalent = sum(str(entry.get("reason", "")).startswith("equivalent") for entry in survived)
    gone = sum(entry["result"] == "gone" for entry in entries)
    times = sorted(entry["processor_s"] for entry in killed)
    median = float(times[len(times) // 2]) if times else None
    closed = sum("survived_before" in entry for entry in entries)
    return [room, len(entries), len(killed), closed, equivalent, len(survived) - equivalent, gone, median]
