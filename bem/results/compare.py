"""Two runs side by side: where their scenes and their figures differ."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from bem.results.read import FinishedRun

_NO_FIGURES = ("scene", "kind", "version", "notes", "seconds_by_stage", "wall_time_s", "where")


@dataclass(frozen=True)
class Difference:
    """A key with its value in the first and the second run; None where a run does not have it.

    `relative` is second / first - 1 where both are numbers, else not-a-number.
    """

    key: str
    first: Any
    second: Any
    relative: float = math.nan


def scene_differences(first: FinishedRun, second: FinishedRun) -> list[Difference]:
    """Keys in which the resolved scenes differ, but for the name."""
    a, b = leaves(first.scene), leaves(second.scene)
    return [
        Difference(key, a.get(key), b.get(key)) for key in _union(a, b) if key != "name" and a.get(key) != b.get(key)
    ]


def figure_differences(first: FinishedRun, second: FinishedRun) -> list[Difference]:
    """All figures of the summaries, equal or not, in the order of the first."""
    a, b = (
        leaves({key: value for key, value in run.summary.items() if key not in _NO_FIGURES}) for run in (first, second)
    )
    return [Difference(key, a.get(key), b.get(key), _relative(a.get(key), b.get(key))) for key in _union(a, b)]


def leaves(value: Any, key: str = "") -> dict[str, Any]:
    """The plain values of nested tables and lists by dotted key: `grid.shape[0]`."""
    if isinstance(value, Mapping):
        parts = [leaves(item, f"{key}.{name}" if key else str(name)) for name, item in value.items()]
    elif isinstance(value, list):
        parts = [leaves(item, f"{key}[{i}]") for i, item in enumerate(value)]
    else:
        return {key: value}
    return {name: item for part in parts for name, item in part.items()}


def _union(a: Mapping[str, Any], b: Mapping[str, Any]) -> list[str]:
    return list(dict.fromkeys([*a, *b]))


def _relative(a: Any, b: Any) -> float:
    numbers = all(isinstance(item, int | float) and not isinstance(item, bool) for item in (a, b))
    return float(b / a - 1) if numbers and a != 0 else math.nan
