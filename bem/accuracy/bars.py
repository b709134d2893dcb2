"""Error bars of figures, and the rule that turns a difference into one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class ErrorBars:
    """Errors of figures by the names of their fields, in SI units, arrays of those that are arrays; None where the
    figure does not converge or its error is not known, which `notes` then explain.

    parts : where an error has several origins, each by itself, by the words for the origin and the names of the fields.
    """

    values: Mapping[str, Any] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    parts: Mapping[str, Mapping[str, float]] = field(default_factory=dict)

    def __or__(self, other: ErrorBars) -> ErrorBars:
        parts = {
            origin: {**self.parts.get(origin, {}), **other.parts.get(origin, {})}
            for origin in dict.fromkeys([*self.parts, *other.parts])
        }
        return ErrorBars({**self.values, **other.values}, self.notes + other.notes, parts)

    @classmethod
    def together(cls, parts: Mapping[str, Mapping[str, float]], notes: tuple[str, ...] = ()) -> ErrorBars:
        """The sum of parts that all have the same figures: errors of different origins may all be of one sign."""
        names = next(iter(parts.values()))
        return cls({name: float(sum(part[name] for part in parts.values())) for name in names}, notes, parts)

    @classmethod
    def unknown(cls, names: Iterable[str], why: str) -> ErrorBars:
        """No bars, for a reason."""
        return cls(dict.fromkeys(names), (why,))


@dataclass(frozen=True)
class Rule:
    """How a difference between a grid and one of twice the cell becomes a bar, in factors set by experiment.

    resolved : on the difference where the coarser grid resolves the surface; 1/3 is that of second order.
    rough : on it elsewhere.
    edge, rough_edge : of the share of a contact that lies within a cell of its edge: what stays where a difference
        happens to pass zero.
    """

    resolved: float
    rough: float
    edge: float = 0.0
    rough_edge: float = 0.0

    def bar(self, difference: float, at_edge: float, *, resolved: bool) -> float:
        """The discretisation error of the finer of the two; `at_edge` is the figure times the share at the edge."""
        if resolved:
            return self.resolved * abs(difference) + self.edge * abs(at_edge)
        return self.rough * abs(difference) + self.rough_edge * abs(at_edge)
