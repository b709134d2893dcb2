"""How wrong a figure is: the guide's chapter, its numbers read from the stored experiments."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from bem.scenes import get_kind, kind_names
from bem.scenes.records import Figure, described, without_bars
from reports import reproduced
from reports.builder import Section, table, text
from reports.experiments.judging import judged
from reports.prose import prose

_WORDS = prose("guide")["error_bars"]
RESULTS = Path(__file__).parent / "results"
_KINDS = {
    "contact": "contact", "small_contact": "contact",
    "film": "friction", "mixed": "friction", "mixed_ball": "friction", "heated_mixed": "friction",
    "hot_mixed": "friction",
    "march": "film",
    "point": "point-film", "rough_point": "point-film",
    "asperities": "asperities", "flow": "flow-factors", "rubbing": "surface-temperature", "tribofilm": "tribofilm",
    "wear": "wear", "running_in": "running-in", "particle": "particles", "sticking": "partial-slip",
    "life": "running-in-life",
}  # fmt: skip
"""The kind of scene whose code an experiment runs."""


def measured() -> dict[str, dict[str, Any]]:
    """What each stored experiment on error bars found, by the name of what it drew, in the order of the prose."""
    return {name: json.loads((RESULTS / f"{name}_error_bars.json").read_text("utf-8")) for name in _WORDS["drawn"]}


def chapter() -> list[Section]:
    """What a bar is, what it covered, and what has none."""
    return [
        Section("How wrong a figure is", "".join(text(item) for item in _WORDS["lead"])),
        Section(
            "An accuracy instead of a grid",
            "".join(text(item) for item in _WORDS["asked"])
            + text(_WORDS["asked_measured"])
            + table(("figure", "scenes", "met", "allowed over true error, median"), list(_asked()))
            + reproduced.paragraph("accuracy_asked"),
            level=3,
        ),
        Section(
            "What bars are made of",
            table(("where", "what is solved again, and what its difference becomes"), list(_WORDS["made"].items())),
            level=3,
        ),
        Section(
            "What they covered",
            text(_WORDS["covered"])
            + table(
                ("drawn at random", "figure", "bars", "covered", "bar over error, median", "error, median"),
                list(_covered()),
            )
            + "".join(text(f"{words}: {reproduced.words(f'{name}_error_bars')}.") for name, words in _drawn()),
            level=3,
        ),
        Section("What has none", text(_WORDS["none"]) + table(("kind", "figures", "why"), list(_without())), level=3),
    ]


def _covered() -> Iterator[tuple[str, ...]]:
    found = measured()
    everything = [row for each in found.values() for row in each["rows"]]
    yield _row(f"{sum(each['cases'] for each in found.values())} cases", "all figures", together(everything))
    for name, each in found.items():
        yield from _rows_of(name, each)


def covered_of(kind: str) -> Iterator[tuple[str, ...]]:
    """The rows on experiments that ran the code of a kind."""
    for name, each in measured().items():
        if _KINDS.get(name) == kind:
            yield from _rows_of(name, each)


def _rows_of(name: str, each: Mapping[str, Any]) -> Iterator[tuple[str, ...]]:
    """Of one experiment: all its figures together, then each."""
    drawn = f"{each['cases']} {_WORDS['drawn'][name]}"
    yield _row(drawn, "all figures", together(each["rows"]))
    for figure, row in each["figures"].items():
        yield _row(drawn, figure.replace("_", " ").replace("von mises", "von Mises"), row)


def together(rows: Sequence[Mapping[str, Any]]) -> dict[str, float]:
    """The verdict on bars of several figures as if they were one."""
    return judged([{**row, "figure": "all"} for row in rows])["all"]


def _drawn() -> Iterator[tuple[str, str]]:
    """Name of each experiment and what it drew, with a capital letter."""
    return ((name, words[0].upper() + words[1:]) for name, words in _WORDS["drawn"].items())


def _row(drawn: str, figure: str, row: Mapping[str, float]) -> tuple[str, ...]:
    covered, ratio, error = (row[name] for name in ("covered", "median_ratio", "median_relative_error"))
    return drawn, figure, str(row["bars"]), f"{covered:.0%}", f"{ratio:.1f}", f"{error:.2g}"


def _asked() -> Iterator[tuple[str, ...]]:
    found = json.loads((RESULTS / "accuracy_asked.json").read_text("utf-8"))
    for figure, row in found["figures"].items():
        name = figure.replace("_", " ").replace("von mises", "von Mises")
        yield name, str(row["bars"]), f"{row['covered']:.0%}", f"{row['median_ratio']:.1f}"


def _without() -> Iterator[tuple[str, ...]]:
    for kind in kind_names():
        record = get_kind(kind).record
        known = described(record)
        reasons: dict[str, list[str]] = {}
        for name, why in without_bars(record).items():
            item = known[name]
            assert isinstance(item, Figure)
            reasons.setdefault(why, []).append(" ".join((item.name or name).split("_")))
        for why, names in reasons.items():
            yield kind, ", ".join(names), why
