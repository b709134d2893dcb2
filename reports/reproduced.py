"""Record of stored results that were computed anew: when, on which commit, which rows, and which were outside a bar.

`python -m reports.reproduce` writes the record; the pages read it.
"""

from __future__ import annotations

import json
from datetime import date
from pathlib import Path
from typing import Any

from reports.builder import text
from reports.validation_origin import commit

RECORD = Path(__file__).parent / "results" / "reproduced.json"
INSIDE = "in"
"""Verdict on a row whose figures all lie within their bars; any other verdict says which figure does not."""
TIMES = {
    "enter_to_report": "processor times of commands",
    "large_peers": "processor times beside other codes",
    "large_published": "processor time and memory of one large contact beside a published time",
    "performance": "run times and peak memory (python -m reports.benchmarks)",
    "shared_work": "processor times of threads",
    "slab_transforms": "processor times of transforms",
    "wear_cycle_times": "processor times of wear cycles",
    "work_precision": "run times beside other codes (python -m reports.benchmarks)",
}
"""Results that hold for the machine they were measured on: measured again, not reproduced."""


def read() -> dict[str, dict[str, Any]]:
    """Return the record by result; empty where nothing was reproduced yet."""
    return json.loads(RECORD.read_text("utf-8")) if RECORD.exists() else {}


def write(record: dict[str, dict[str, Any]]) -> None:
    """Store the record."""
    RECORD.write_text(json.dumps(record, indent=1, sort_keys=True) + "\n", encoding="utf-8")


def add(name: str, verdicts: dict[str, str], rows: int) -> None:
    """Record the verdicts on rows of a result, today and on this commit.

    rows : number of rows that the result has. A row recorded outside its bar stays until it is computed again.
    """
    record = read()
    open_rows = {row: verdict for row, verdict in outside(name).items() if row not in verdicts}
    record[name] = {
        "date": date.today().isoformat(),
        "commit": commit(),
        "of": rows,
        "rows": {**open_rows, **verdicts},
    }
    write(record)


def forget(name: str) -> None:
    """Remove a result from the record: it was stored anew."""
    record = read()
    if record.pop(name, None) is not None:
        write(record)


def forget_row(name: str, row: str) -> None:
    """Remove one row of a result from the record: it was stored anew."""
    record = read()
    if record.get(name, {}).get("rows", {}).pop(row, None) is not None:
        write(record)


def outside(name: str) -> dict[str, str]:
    """Return the rows of a result that were outside their bars when last computed, with the verdicts."""
    rows = read().get(name, {}).get("rows", {})
    return {row: verdict for row, verdict in rows.items() if verdict != INSIDE}


def words(name: str) -> str:
    """Say when a result was last reproduced, on which commit, how many rows, and which were outside their bars."""
    if name in TIMES:
        return f"measured on one machine ({TIMES[name]}), not reproduced"
    entry = read().get(name)
    if entry is None:
        return "not reproduced since it was stored"
    wrong = outside(name)
    verdict = "all within their bars" if not wrong else f"outside their bars: {'; '.join(sorted(wrong))}"
    said = f"last reproduced on {entry['date']}, commit {entry['commit']}"
    return f"{said}: {len(entry['rows'])} of {entry['of']} rows, {verdict}"


def row_words(name: str, row: str) -> str:
    """Say whether a row was among those last reproduced, and when."""
    entry = read().get(name, {})
    if row not in entry.get("rows", {}):
        return "not in the last sample"
    return f"reproduced on {entry['date']}, commit {entry['commit']}"


def paragraph(name: str) -> str:
    """Return the same as an HTML paragraph below a result."""
    return text(f"Result of {name}: {words(name)}.")
