"""Error bars of figures, and the rule that turns a difference into one."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bem.grid import FloatArray
from bem.notes import Note
from bem.notes.accuracy import NoBar, no_error_bar

GRID, DEPTHS, POINTS, STEPS, RESIDUAL = "grid", "depths", "film points", "time steps", "residual"
REUSE, INLET, PRESSING = "reused contacts", "inlet", "pressing steps"
"""Where errors come from, in the words of summary, dataset and report: what discretisation leaves, and the residual of
solvers. Over repetitions there is `bem.scenes.records.SCATTER` besides."""

TWICE = 2.5
"""Where another solution has twice the points or cells, its difference counts as that of half of them so many times:
order two would make four, but the difference is the error itself but for a quarter."""

PRESSING_FACTOR = 1.5
"""On the difference to half the steps in which a load comes: what first order leaves."""


@dataclass(frozen=True)
class ErrorBars:
    """Errors of figures by the names of their fields, in SI units, arrays of those that are arrays; None where the
    figure does not converge or its error is not known, which `notes` then explain.

    parts : where an error has several origins, each by itself, by the words for the origin and the names of the fields.
    """

    values: Mapping[str, Any] = field(default_factory=dict)
    notes: tuple[Note, ...] = ()
    parts: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)

    def __or__(self, other: ErrorBars) -> ErrorBars:
        parts = {
            origin: {**self.parts.get(origin, {}), **other.parts.get(origin, {})}
            for origin in dict.fromkeys([*self.parts, *other.parts])
        }
        return ErrorBars({**self.values, **other.values}, self.notes + other.notes, parts)

    @classmethod
    def together(cls, parts: Mapping[str, Mapping[str, Any]], notes: tuple[Note, ...] = ()) -> ErrorBars:
        """The sum of parts: errors of different origins may all be of one sign. A part leaves out figures that it is
        not of."""
        names = dict.fromkeys(name for part in parts.values() for name in part)
        return cls({name: sum(part.get(name, 0.0) for part in parts.values()) for name in names}, notes, parts)

    def without(self, name: str, reason: NoBar) -> ErrorBars:
        """Return the bars but for one figure that has none, for a reason."""
        parts = {origin: {n: v for n, v in part.items() if n != name} for origin, part in self.parts.items()}
        return ErrorBars({**self.values, name: None}, (*self.notes, no_error_bar([name], reason)), parts)

    def renamed(self, names: Mapping[str, str], change: Callable[[Any], Any] = lambda error: error) -> ErrorBars:
        """Those bars that have a new name, under it and changed; without the notes."""

        def new(old: Mapping[str, Any]) -> dict[str, Any]:
            return {names[n]: None if v is None else change(v) for n, v in old.items() if n in names}

        return ErrorBars(new(self.values), (), {origin: new(part) for origin, part in self.parts.items()})

    @classmethod
    def unknown(cls, names: Iterable[str], reason: NoBar, **values: Any) -> ErrorBars:
        """Return no bars, for a reason; `values` : of its sentence."""
        missing = dict.fromkeys(names)
        return cls(missing, (no_error_bar(missing, reason, **values),))


def table(
    errors: Mapping[str, Any], parts: Mapping[str, Mapping[str, Any]], names: Iterable[str], origins: Iterable[str]
) -> FloatArray:
    """Bars and below them their parts as one array (1 + origins, names); not-a-number where there is none."""
    names = tuple(names)
    rows = [errors, *(parts.get(origin, {}) for origin in origins)]
    return np.array([[row.get(name) for name in names] for row in rows], dtype=np.float64)


def from_tables(
    tables: Sequence[FloatArray], names: Iterable[str], origins: Iterable[str]
) -> tuple[dict[str, FloatArray], dict[str, dict[str, FloatArray]]]:
    """What `errors` and `error_parts` of a record are, from the tables of all entries of its lists."""
    names = tuple(names)
    rows = [dict(zip(names, row.T, strict=True)) for row in np.swapaxes(np.array(tables), 0, 1)] if tables else [{}]
    return rows[0], dict(zip(origins, rows[1:], strict=False))


@dataclass(frozen=True)
class Rule:
    """How a difference between a grid and one of twice the cell becomes a bar, in factors set by experiment.

    resolved : on the difference where the coarser grid resolves the surface; 1/3 is that of second order.
    rough : on it elsewhere.
    edge, rough_edge : of the share of a contact that lies within a cell of its edge: what stays where a difference
        happens to pass zero.
    sampled, sampled_edge : both where the coarser grid does not resolve the surface but has all its waves, none shorter
        than two of its cells: it is the same surface there, and what is left is the grid's error; where it has not,
        heights in between are lost, and the difference is that of another surface. As elsewhere if None.
    """

    resolved: float
    rough: float
    edge: float = 0.0
    rough_edge: float = 0.0
    sampled: float | None = None
    sampled_edge: float = 0.0

    def bar(self, difference: float, at_edge: float, *, resolved: bool, sampled: bool = False) -> float:
        """The discretisation error of the finer of the two; `at_edge` is the figure times the share at the edge."""
        if resolved:
            return self.resolved * abs(difference) + self.edge * abs(at_edge)
        if sampled and self.sampled is not None:
            return self.sampled * abs(difference) + self.sampled_edge * abs(at_edge)
        return self.rough * abs(difference) + self.rough_edge * abs(at_edge)
