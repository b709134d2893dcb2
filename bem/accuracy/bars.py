"""Error bars of figures, their parts by origin, and tables of them."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from bem.grid import FloatArray
from bem.notes import Note
from bem.notes.accuracy import NoBar, no_error_bar

GRID, DEPTHS, POINTS, STEPS, RESIDUAL = "grid", "depths", "film points", "time steps", "residual"
REUSE, INLET, PRESSING = "reused contacts", "inlet", "pressing steps"
"""Origins of errors, in the words of summary, dataset and report: discretisations, and the residual of solvers. Over
repetitions there is `bem.scenes.records.SCATTER` besides."""

PRESSING_FACTOR = 1.5
"""Factor on the difference to half of the steps in which a load comes: first order leaves one."""


@dataclass(frozen=True)
class ErrorBars:
    """Errors of figures by the names of their fields, in SI units, arrays of those that are arrays.

    values : errors; None where the figure does not converge or its error is not known.
    notes : the reasons why figures have no error bar.
    parts : contributions to the errors by origin and figure.
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
        """Return the sum of parts: errors of different origins may all be of one sign. A part may lack figures."""
        names = dict.fromkeys(name for part in parts.values() for name in part)
        return cls({name: sum(part.get(name, 0.0) for part in parts.values()) for name in names}, notes, parts)

    def without(self, name: str, reason: NoBar) -> ErrorBars:
        """Return the bars but for one figure that has none, for a reason."""
        parts = {origin: {n: v for n, v in part.items() if n != name} for origin, part in self.parts.items()}
        return ErrorBars({**self.values, name: None}, (*self.notes, no_error_bar([name], reason)), parts)

    def with_prescribed(self, names: Collection[str]) -> ErrorBars:
        """Return the bars with those of prescribed figures, which are inputs without an error: zero in each part."""
        exact = dict.fromkeys(names, 0.0)
        parts = {origin: {**part, **exact} for origin, part in self.parts.items()}
        return ErrorBars({**self.values, **exact}, self.notes, parts)

    def renamed(self, names: Mapping[str, str], change: Callable[[Any], Any] = lambda error: error) -> ErrorBars:
        """Return the bars that have a new name, under this name and changed; without the notes."""

        def new(old: Mapping[str, Any]) -> dict[str, Any]:
            return {names[n]: None if v is None else change(v) for n, v in old.items() if n in names}

        return ErrorBars(new(self.values), (), {origin: new(part) for origin, part in self.parts.items()})

    @classmethod
    def unknown(
        cls, names: Iterable[str], reason: NoBar, *, prescribed: Collection[str] = (), **values: Any
    ) -> ErrorBars:
        """Return no bars, for a reason, but of prescribed figures; `values` : of its sentence."""
        missing = dict.fromkeys(name for name in names if name not in prescribed)
        return cls(missing, (no_error_bar(missing, reason, **values),)).with_prescribed(prescribed)


def table(
    errors: Mapping[str, Any], parts: Mapping[str, Mapping[str, Any]], names: Iterable[str], origins: Iterable[str]
) -> FloatArray:
    """Return the bars, and below them their parts, as one array (1 + origins, names); not-a-number where there is
    none."""
    names = tuple(names)
    rows = [errors, *(parts.get(origin, {}) for origin in origins)]
    return np.array([[row.get(name) for name in names] for row in rows], dtype=np.float64)


def from_tables(
    tables: Sequence[FloatArray], names: Iterable[str], origins: Iterable[str]
) -> tuple[dict[str, FloatArray], dict[str, dict[str, FloatArray]]]:
    """Return the `errors` and `error_parts` of a record from the tables of all entries of its lists."""
    names = tuple(names)
    rows = [dict(zip(names, row.T, strict=True)) for row in np.swapaxes(np.array(tables), 0, 1)] if tables else [{}]
    return rows[0], dict(zip(origins, rows[1:], strict=False))
