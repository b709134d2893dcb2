"""What error bars covered on random cases, and how often an accuracy was met, from the stored experiments."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from reports.experiments.judging import judged

RESULTS = Path(__file__).parent / "results"
DRAWN = {
    "contact": "contacts",
    "small_contact": "contacts 3 to 9 cells wide",
    "film": "steady films",
    "point": "films of points",
    "rough_point": "rough balls with contact inside their film",
    "mixed": "balances of film and contact",
    "mixed_ball": "balances under balls",
    "heated_mixed": "balances with heat",
    "hot_mixed": "balances with full heat (points, columns and layers alone, against 2.5 times as many)",
    "march": "films in time",
    "asperities": "arrays of asperities",
    "flow": "patches between walls",
    "rubbing": "rubbing contacts",
    "tribofilm": "tribofilms",
    "particle": "maps of particles",
    "wear": "wear loops",
    "sticking": "contacts that stick and slip",
    "running_in": "running-in loops",
    "life": "lives in cycle jumps",
}
"""What each stored experiment on error bars drew at random."""


def measured() -> dict[str, dict[str, Any]]:
    """What each stored experiment on error bars found, by the name of what it drew."""
    return {name: json.loads((RESULTS / f"{name}_error_bars.json").read_text("utf-8")) for name in DRAWN}


def together(rows: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """The verdict on bars of several figures as if they were one."""
    return judged([{**row, "figure": "all"} for row in rows])["all"]


def asked() -> Iterator[tuple[str, ...]]:
    """Rows of how often an accuracy that was asked for was met, by figure."""
    found = json.loads((RESULTS / "accuracy_asked.json").read_text("utf-8"))
    for figure, row in found["figures"].items():
        name = figure.replace("_", " ").replace("von mises", "von Mises")
        yield name, str(row["bars"]), f"{row['covered']:.0%}", f"{row['median_ratio']:.1f}"
