"""What error bars covered on random cases, and how often an accuracy was met, from the stored experiments."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from importlib import import_module
from pathlib import Path
from typing import Any

from bem.accuracy.richardson import Row, Table, Value
from reports.experiments.judging import judged

RESULTS = Path(__file__).parent / "results"
DRAWN = {
    "contact": "contacts",
    "small_contact": "contacts 3 to 9 cells wide",
    "coating": "stresses in coatings",
    "adhesion": "adhesive contacts",
    "viscoelastic": "contacts of bodies that relax",
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

TABLES = {
    "contact": "contact.RULES",
    "stresses": "stress.RULES",
    "stresses in layers": "coating.RULES",
    "adhesion": "adhesion.RULES",
    "bodies that relax": "viscoelastic.RULES",
    "partial slip": "sticking.PUSH_RULES",
    "rolling": "sticking.ROLL_RULES",
    "surface temperature": "rubbing.RULES",
    "asperities": "asperities.RULES",
    "flow factors": "flow.RULES",
    "steady film": "film.FILM_RULES",
    "traction": "traction.RULES",
    "film of a point": "point.POINT_RULES",
    "film of a rough body": "rough_point.RULES",
    "film in time, points": "march.MESH_RULES",
    "film in time, steps": "march.STEP_RULES",
    "friction, cells": "mixed.RULES",
    "friction, film": "mixed.FILM_RULES",
    "friction, film of a line with heat": "mixed.HOT_FILM_RULES",
    "wear": "wear.RULES",
    "running-in": "wear.MIXED_RULES",
    "life, cells": "life.GRID_RULES",
    "life, positions": "life.POSITION_RULES",
    "life, scatter of positions": "life.SCATTER_RULES",
    "life, sampled surfaces": "life.SAMPLING_RULES",
    "life, film": "life.POINT_RULES",
    "tribofilm": "tribofilm.RULES",
    "particles in maps": "particles.RULES",
}
"""Tables of error bars by the words for what they are of: module of `bem.accuracy` and name."""


def table_of(name: str) -> Table:
    """Return a table of error bars by its module and name, as in `TABLES`."""
    module, _, attribute = name.partition(".")
    found = getattr(import_module(f"bem.accuracy.{module}"), attribute)
    assert isinstance(found, Table)
    return found


def measured() -> dict[str, dict[str, Any]]:
    """What each stored experiment on error bars found, by the name of what it drew."""
    return {name: json.loads((RESULTS / f"{name}_error_bars.json").read_text("utf-8")) for name in DRAWN}


def factors() -> Iterator[tuple[str, ...]]:
    """Rows of all tables; figures with the same row stand together."""
    for words, name in TABLES.items():
        figures: dict[int, list[str]] = {}
        rows: dict[int, Row] = {}
        for figure, row in table_of(name).items():
            figures.setdefault(id(row), []).append(" ".join(figure.split("_")))
            rows[id(row)] = row
        for key, row in rows.items():
            floors = ", ".join(f"{floor} {_numbers(value)}" for floor, value in row.floors.items())
            factors = row.factor if isinstance(row.factor, tuple) else (row.factor,)
            over = _numbers(tuple(factor * (2**row.order - 1) for factor in factors))
            yield words, ", ".join(figures[key]), str(row.order), _numbers(row.factor), over, floors, row.why


def _numbers(value: Value) -> str:
    """A number, or those of regimes with slashes between them."""
    return " / ".join(f"{one:.3g}" for one in (value if isinstance(value, tuple) else (value,)))


def together(rows: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """The verdict on bars of several figures as if they were one."""
    return judged([{**row, "figure": "all"} for row in rows])["all"]


def asked() -> Iterator[tuple[str, ...]]:
    """Rows of how often an accuracy that was asked for was met, by figure."""
    found = json.loads((RESULTS / "accuracy_asked.json").read_text("utf-8"))
    for figure, row in found["figures"].items():
        name = figure.replace("_", " ").replace("von mises", "von Mises")
        yield name, str(row["bars"]), f"{row['covered']:.0%}", f"{row['median_ratio']:.1f}"
