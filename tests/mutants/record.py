"""The stored outcome of a mutation run, and tables of it."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from tests.mutants.seeds import Mutant
from tests.mutants.trees import ROOT

STORED = ROOT / "reports" / "results" / "mutants.json"
SUITES = ("fast", "full", "gates")
"""Fast tests of the room, all tests of the room, and the verification gates as well: each has those before."""
KILLED, SURVIVED, GONE = "killed", "survived", "gone"

Entry = dict[str, Any]


class Record:
    """Outcomes by mutant, written after each so that a run can go on where it was interrupted."""

    def __init__(self, path: Path = STORED) -> None:
        self.path = path
        self.entries: dict[str, Entry] = {}
        if path.is_file():
            self.entries = json.loads(path.read_text(encoding="utf-8"))["mutants"]

    def enter(self, mutant: Mutant, entry: Entry) -> None:
        """Store an outcome; one that is killed now keeps the suite that it survived before."""
        before = self.entries.get(mutant.key, {})
        survived = before["suite"] if before.get("result") == SURVIVED else before.get("survived_before")
        if survived is not None and entry["result"] == KILLED:
            entry = entry | {"survived_before": survived}
        described = {"file": mutant.file, "slip": mutant.slip, "old": mutant.old, "new": mutant.new}
        self.entries[mutant.key] = {"room": mutant.room, **described, **entry}
        self.write()

    def write(self) -> None:
        """Write the file, whole or not at all."""
        text = json.dumps({"mutants": dict(sorted(self.entries.items()))}, indent=1) + "\n"
        part = self.path.with_name(f".{self.path.name}.{os.getpid()}")
        part.write_text(text, encoding="utf-8")
        part.replace(self.path)

    def current(self, mutants: Sequence[Mutant]) -> dict[str, Entry]:
        """Return the outcomes of listed mutants, with the reasons given today."""
        return {m.key: self.entries[m.key] | {"reason": m.reason} for m in mutants if m.key in self.entries}

    def forget_unlisted(self, mutants: Sequence[Mutant]) -> None:
        """Drop outcomes of mutants that are no longer listed, and store the reasons of the others."""
        self.entries = self.current(mutants)
        self.write()


def by_room(entries: Mapping[str, Entry]) -> list[list[Any]]:
    """Return a row for each room and one for all: the columns of `HEADERS`."""
    rooms = sorted({entry["room"] for entry in entries.values()})
    rows = []
    for room in [*rooms, "all"]:
        own = [entry for entry in entries.values() if room in ("all", entry["room"])]
        survived = [entry for entry in own if entry["result"] == SURVIVED]
        equivalent = sum(entry.get("reason", "").startswith("equivalent") for entry in survived)
        killed, gone = (sum(entry["result"] == kind for entry in own) for kind in (KILLED, GONE))
        closed = sum("survived_before" in entry for entry in own)
        minutes = sum(entry.get("processor_s", 0.0) for entry in own) / 60
        rows.append([room, len(own), killed, closed, len(survived), equivalent, gone, round(minutes, 1)])
    return rows


HEADERS = [
    *("room", "run", "killed", "of these survived an earlier run", "survived", "of these equivalent", "gone"),
    "processor time [min]",
]


def survivors(entries: Mapping[str, Entry]) -> list[list[str]]:
    """Return a row for each survivor: room, file, slip, tests that it survived, reason."""
    return [
        [entry["room"], entry["file"], entry["slip"], entry["suite"], entry.get("reason") or "not yet judged"]
        for entry in entries.values()
        if entry["result"] == SURVIVED
    ]


def as_text(headers: Sequence[str], rows: Sequence[Sequence[Any]]) -> str:
    """Return a table in fixed columns."""
    lines = [[str(cell) for cell in row] for row in [headers, *rows]]
    widths = [max(len(line[k]) for line in lines) for k in range(len(headers))]
    return "\n".join("  ".join(cell.ljust(w) for cell, w in zip(line, widths, strict=True)).rstrip() for line in lines)
