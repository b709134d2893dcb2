"""The groups of cases, and how a case is run."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from pathlib import Path

from reports.golden import contacts, films, heat, loops, points, scenes, surfaces, tribofilms
from reports.golden.record import Case, Record, Trial

GROUPS: dict[str, Callable[[], dict[str, Case]]] = {
    "surfaces": surfaces.cases,
    "contacts": contacts.cases,
    "films": films.cases,
    "heat": heat.cases,
    "tribofilms": tribofilms.cases,
    "points": points.cases,
    "loops": loops.cases,
    "scenes": scenes.cases,
}
"""Cases of each group by name."""


def run_case(group: str, case: str, trial: Trial | None = None, folder: Path | None = None) -> Record:
    """Run a case in a folder, a temporary one where none is given."""
    given = trial or Trial()
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
        return GROUPS[group]()[case](given, folder)
    with tempfile.TemporaryDirectory(prefix="bem-golden-") as temporary:
        return GROUPS[group]()[case](given, Path(temporary))
