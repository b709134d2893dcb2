"""Stored records: reading, comparing, writing."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from reports.golden.record import Figure, Record
from reports.golden.tolerances import EACH_COUNT, FEW, MEAN_COUNT, allowed, rounded

FOLDER = Path(__file__).resolve().parents[2] / "tests" / "golden"
MISSING = "missing"


@dataclass(frozen=True)
class Difference:
    """A figure or a count that is not as stored."""

    case: str
    figure: str
    before: Figure
    after: Figure
    allowed: float

    def __str__(self) -> str:
        return f"{self.case}: {self.figure}: {self.before} stored, {self.after} now, allowed +-{self.allowed:.2g}"


def stored(group: str) -> dict[str, Record]:
    """Stored records of a group by case; none where nothing is stored."""
    path = FOLDER / f"{group}.json"
    if not path.exists():
        return {}
    return {name: Record.of(table) for name, table in json.loads(path.read_text("utf-8")).items()}


def differences(group: str, case: str, before: Record, after: Record) -> list[Difference]:
    """Return the differences of a case: figures beyond their tolerances, counts beyond the limit of a single case."""
    found = []
    for name in sorted(before.figures.keys() | after.figures.keys()):
        old, new = before.figures.get(name, MISSING), after.figures.get(name, MISSING)
        change = allowed(group, case, name, before.figures) if name in before.figures else 0.0
        if not _same(old, new, change):
            found.append(Difference(case, name, old, new, change))
    for name in sorted(before.counts.keys() | after.counts.keys()):
        old, new = before.counts.get(name, MISSING), after.counts.get(name, MISSING)
        change = EACH_COUNT * old + FEW if isinstance(old, float) else 0.0
        if not _same(old, new, change):
            found.append(Difference(case, name, old, new, change))
    return found


def _same(old: Figure, new: Figure, change: float) -> bool:
    if isinstance(old, float) and isinstance(new, float):
        return abs(new - old) <= change
    return old == new and type(old) is type(new)


def mean_differences(before: Mapping[str, Record], after: Mapping[str, Record]) -> list[Difference]:
    """Counts whose mean over the cases of a group moved."""
    old, new = mean_counts(before), mean_counts(after)
    return [
        Difference(
            "mean of the group", name, old.get(name, MISSING), new.get(name, MISSING), MEAN_COUNT * old.get(name, 0)
        )
        for name in sorted(old.keys() | new.keys())
        if not _same(old.get(name, MISSING), new.get(name, MISSING), MEAN_COUNT * old.get(name, 0.0))
    ]


def mean_counts(records: Mapping[str, Record]) -> dict[str, float]:
    """Means over the cases that have a count; indices of lists and the name's place in the results do not matter."""
    values: dict[str, list[float]] = {}
    for record in records.values():
        for name, value in record.counts.items():
            values.setdefault(name.rpartition("/")[2].partition(".")[0], []).append(value)
    return {name: sum(several) / len(several) for name, several in values.items()}


def store(group: str, records: Mapping[str, Record]) -> list[Difference]:
    """Store the records of a group; figures and counts within their tolerances keep the stored values.

    Returns
    -------
    What moved, of cases that were stored before.
    """
    before, moved, kept = stored(group), [], {}
    drift = {one.figure for one in mean_differences(before, records)} if before else set()
    for case, record in records.items():
        old = before.get(case, Record())
        apart = differences(group, case, old, record) if case in before else []
        moved += apart
        changed = {one.figure for one in apart}
        kept[case] = _rounded(group, case, record, old, changed, drift)
    (FOLDER / f"{group}.json").write_text(as_text({name: one.plain() for name, one in kept.items()}), "utf-8")
    return moved + (mean_differences(before, records) if before else [])


def as_text(table: Mapping[str, Any], indent: int = 0) -> str:
    """The table as JSON with sorted keys, one figure or list of figures a line."""
    rows = [
        f"{' ' * (indent + 1)}{json.dumps(key)}: "
        + (as_text(value, indent + 1) if isinstance(value, dict) else json.dumps(value, allow_nan=False))
        for key, value in sorted(table.items())
    ]
    end = "\n" if indent == 0 else ""
    return "{\n" + ",\n".join(rows) + "\n" + " " * indent + "}" + end if rows else "{}" + end


def _rounded(group: str, case: str, record: Record, old: Record, changed: set[str], drift: set[str]) -> Record:
    figures: dict[str, Figure] = {}
    for name, value in record.figures.items():
        if name in old.figures and name not in changed:
            figures[name] = old.figures[name]
        elif isinstance(value, float):
            figures[name] = rounded(value, allowed(group, case, name, record.figures))
        else:
            figures[name] = value
    counts = {}
    for name, value in record.counts.items():
        keep = name in old.counts and name not in changed and name.rpartition("/")[2].partition(".")[0] not in drift
        counts[name] = old.counts[name] if keep else round(value, 2)
    return Record(figures, counts)
