"""What a case of the golden net returns, and how it may be run."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

Figure = float | str | None
"""A number, a word (a status, a unit) or nothing."""


@dataclass(frozen=True)
class Trial:
    """Perturbation under which a case is run.

    nudge : relative change of the inputs, for measuring how far figures follow rounding errors.
    tighter : factor on the tolerance of the solvers, for measuring how far figures follow it.
    """

    nudge: float = 0.0
    tighter: float = 1.0


@dataclass
class Record:
    """Figures and counts of one case, by name."""

    figures: dict[str, Figure] = field(default_factory=dict)
    counts: dict[str, float] = field(default_factory=dict)

    def plain(self) -> dict[str, Any]:
        """The record as JSON holds it: figures NAME.0, NAME.1, ... as a list."""
        return {"figures": _folded(self.figures), "counts": _folded(self.counts)}

    @classmethod
    def of(cls, table: Mapping[str, Any]) -> Record:
        """The record in a table of `plain`."""
        return cls(_unfolded(table["figures"]), _unfolded(table["counts"]))


def _folded(values: Mapping[str, Any]) -> dict[str, Any]:
    lists: dict[str, list[Any]] = {}
    for name, value in values.items():
        stem, _, index = name.rpartition(".")
        if index.isdigit() and int(index) == len(lists.get(stem, ())):
            lists.setdefault(stem, []).append(value)
    single = {name: value for name, value in values.items() if not _in_list(name, lists)}
    return single | lists


def _in_list(name: str, lists: Mapping[str, list[Any]]) -> bool:
    stem, _, index = name.rpartition(".")
    return index.isdigit() and int(index) < len(lists.get(stem, ()))


def _unfolded(values: Mapping[str, Any]) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for name, value in values.items():
        found |= {f"{name}.{at}": one for at, one in enumerate(value)} if isinstance(value, list) else {name: value}
    return found


Case = Callable[[Trial, Path], Record]
"""Runs a case; the folder is empty and belongs to it."""


def plain_figure(value: Any) -> Figure:
    """A figure as JSON can hold it: None, a text, or a finite number (others as text)."""
    if value is None or isinstance(value, str):
        return value
    number = float(value)
    return number if math.isfinite(number) else str(number)


def attributes(solution: Any, names: Iterable[str]) -> dict[str, Figure]:
    """Named attributes of a solution as figures."""
    return {name: plain_figure(getattr(solution, name)) for name in names}
