"""Runs side by side: where their scenes and their figures differ."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

from bem.notes import OUTSIDE
from bem.quantities import PREFIXED, si
from bem.results.differing import leaves
from bem.results.read import FinishedRun
from bem.scenes.kind import get_kind, kind_names
from bem.scenes.walk import walk

_NO_FIGURES = (
    *("scene", "kind", "version", "notes", "outside_model", "over", "seconds_by_stage", "wall_time_s", "where"),
)
_MOST_IN_A_LABEL = 2


@dataclass(frozen=True)
class Difference:
    """A key with its value in each run, None where a run does not have it."""

    key: str
    values: tuple[Any, ...]
    unpaired: frozenset[int] = frozenset()
    """Runs whose list holds other places (speeds, loads) than that of the first run."""

    @property
    def equal(self) -> bool:
        """Return True if all runs have the same value."""
        return all(value == self.values[0] for value in self.values)

    def relative(self, run: int) -> tuple[float, float] | None:
        """Least and largest of this run's value(s) over the first run's, less one; None where that means nothing."""
        if run in self.unpaired:
            return None
        pairs = list(zip(_numbers(self.values[0]), _numbers(self.values[run]), strict=False))
        if len(_numbers(self.values[0])) != len(_numbers(self.values[run])):
            return None
        ratios = [b / a - 1 for a, b in pairs if a != 0]
        return (min(ratios), max(ratios)) if ratios else None


def scene_differences(*runs: FinishedRun) -> list[Difference]:
    """Keys in which the resolved scenes differ, but for name and description, which change no contact."""
    found = _union([leaves(run.scene) for run in runs])
    return [item for item in found if item.key not in ("name", "description") and not item.equal]


def without_sources(found: Sequence[Difference]) -> list[Difference]:
    """Return the differences without the source of a material or surface of which another key differs, too."""
    tables = [item.key.rpartition(".")[0] for item in found if not item.key.endswith(".source")]
    return [
        item
        for item in found
        if not item.key.endswith(".source") or not any(one.startswith(item.key[: -len(".source")]) for one in tables)
    ]


LONGEST_TEXT = 60
"""Letters of a value in a table of differences; longer ones are cut."""


def shortened(texts: Sequence[str]) -> list[str]:
    """Return the texts of one row, cut to `LONGEST_TEXT` letters where one is longer.

    What they have in common at the beginning is left out, so that the difference is seen.
    """
    if all(len(text) <= LONGEST_TEXT for text in texts):
        return list(texts)
    columns = enumerate(zip(*texts, strict=False))
    alike = next((i for i, letters in columns if len(set(letters)) > 1), min(len(text) for text in texts))
    begin = texts[0].rfind(" ", 0, alike) + 1 if alike > LONGEST_TEXT // 2 else 0
    cut = [f"{'... ' if begin else ''}{text[begin:]}" for text in texts]
    return [text if len(text) <= LONGEST_TEXT else f"{text[: LONGEST_TEXT - 3]}..." for text in cut]


def figure_differences(*runs: FinishedRun) -> list[Difference]:
    """All figures of the summaries, equal or not, in the order of the first; a list of numbers is one figure."""
    unpaired = {
        (name, i): len(values)
        for name in PLACES
        if isinstance(values := runs[0].summary.get(name), list)
        for i, run in enumerate(runs)
        if run.summary.get(name) != values
    }
    return [
        replace(item, unpaired=frozenset(i for (_, i), length in unpaired.items() if length == len(item.values[0])))
        if isinstance(item.values[0], list)
        else item
        for item in _union([_figures(run.summary) for run in runs])
    ]


PLACES = ("speed_m_s", "load_N", "temperature_C", "hardness_Pa", "position_m", "spacing_um")
"""Figures that say of which speed, load or other input the entries of lists are."""


def unpaired_words(found: Sequence[Difference], names: Sequence[str]) -> list[str]:
    """Return a sentence for each run whose speeds, loads or other places differ from those of the first run."""
    said = []
    for item in found:
        others = [i for i in sorted(item.unpaired) if item.values[i] != item.values[0]]
        word = {"speed_m_s": "speeds", "load_N": "loads"}.get(item.key, f"values of {item.key.rpartition('_')[0]}")
        said += [
            f"{names[i]} has other {word} than {names[0]}: no change is given of figures listed over them."
            for i in (others if item.key in PLACES else ())
        ]
    return said


def headline_differences(found: Sequence[Difference], headline: Sequence[str]) -> list[Difference]:
    """Return the differences of headline figures, of further cases (`curves`) too."""
    rank = {name: i for i, name in enumerate(headline)}
    return sorted(
        (item for item in found if _bare(item.key) in rank), key=lambda d: (" (" in d.key, rank[_bare(d.key)])
    )


def beyond(runs: Sequence[FinishedRun], names: Sequence[str]) -> list[str]:
    """Return the parts of the runs that are solved but outside their model, with the name of the run before each."""
    return [
        f"{name}: {OUTSIDE}{text}"
        for run, name in zip(runs, names, strict=True)
        for text in run.summary.get("outside_model", ())
    ]


def run_labels(runs: Sequence[FinishedRun], names: Sequence[str]) -> list[str]:
    """Names of the runs with what tells their scenes apart, where that is one or two keys."""
    found = scene_differences(*runs)
    names = [
        f"{name} ({OUTSIDE.rstrip(': ')})" if run.summary.get("outside_model") else name
        for name, run in zip(names, runs, strict=True)
    ]
    if not 0 < len(found) <= _MOST_IN_A_LABEL:
        return names
    return [
        f"{name}: "
        + ", ".join(f"{_words(item.key)} = {shown(item.values[i], unit_of_key(run, item.key))}" for item in found)
        for i, (name, run) in enumerate(zip(names, runs, strict=True))
    ]


def unit_of_key(run: FinishedRun, key: str) -> str:
    """SI unit of a key of a run's scene, such as `lower.layers[0].thickness`; "" for none."""
    return _units(str(run.summary.get("kind"))).get(re.sub(r"\[\d+\]", "", key), "")


@cache
def _units(kind: str) -> dict[str, str]:
    """Units of a kind's keys by their dotted paths."""
    if kind not in kind_names():
        return {}
    units: dict[str, str] = {}
    for key in walk(get_kind(kind).model):
        if key.unit:
            units.setdefault(".".join(key.path), key.unit)
    return units


def shown(value: Any, unit: str = "", digits: int = 5) -> str:
    """A value in few characters: of a list of more than three numbers the least and the largest."""
    if value is None:
        return "-"
    if isinstance(value, list):
        numbers = _numbers(value)
        if len(numbers) == len(value) > 3:
            return f"{shown(min(numbers), '', digits)} to {shown(max(numbers), unit, digits)}"
        text = ", ".join(shown(item, "", digits) for item in value)
    elif isinstance(value, float):
        if unit in PREFIXED:
            return si(value, unit, digits)
        text = f"{value:.{digits}g}"
    else:
        text = str(value)
    return f"{text} {unit}".rstrip()


def _figures(summary: Mapping[str, Any]) -> dict[str, Any]:
    """A summary's figures; those of a list of cases as `friction (uncoupled, 5.5 N)`, by what tells the cases apart."""
    found: dict[str, Any] = {}
    for key, value in summary.items():
        if key in _NO_FIGURES:
            continue
        if isinstance(value, list) and value and all(isinstance(item, Mapping) for item in value):
            found |= _cases(key, value, summary)
        else:
            found |= leaves(value, key)
    return found


def _cases(key: str, cases: Sequence[Mapping[str, Any]], summary: Mapping[str, Any]) -> dict[str, Any]:
    known = [
        name
        for name in cases[0]
        if isinstance(cases[0][name], str) or name in ("load_N", "temperature_C", "hardness_Pa", "speed_m_s")
    ]
    telling = [name for name in known if len({str(case.get(name)) for case in cases}) > 1]
    found: dict[str, Any] = {}
    for i, case in enumerate(cases):
        words = ", ".join(shown(case.get(name), name.split("_", 1)[1] if "_" in name else "") for name in telling)
        for name, value in case.items():
            if name in known or (i == 0 and summary.get(name) == value):
                continue
            found |= leaves(value, f"{name} ({words or (f'{key} {i}' if len(cases) > 1 else key)})")
    return found


def _union(tables: Sequence[Mapping[str, Any]]) -> list[Difference]:
    keys = dict.fromkeys(key for table in tables for key in table)
    return [Difference(key, tuple(table.get(key) for table in tables)) for key in keys]


def _numbers(value: Any) -> list[float]:
    items = value if isinstance(value, list) else [value]
    plain = [item for item in items if isinstance(item, int | float) and not isinstance(item, bool)]
    return [float(item) for item in plain if math.isfinite(item)]


def _bare(key: str) -> str:
    return key.split(" (")[0]


def _words(key: str) -> str:
    return key.rsplit(".", 1)[-1].replace("_", " ")
