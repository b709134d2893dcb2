"""Error bars of figures, and the rule that turns a difference into one."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field


@dataclass(frozen=True)
class ErrorBars:
    """Errors of figures by the names of their fields, in SI units; None where the figure does not converge or its error
    is not known, which `notes` then explain."""

    values: Mapping[str, float | None] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def __or__(self, other: ErrorBars) -> ErrorBars:
        return ErrorBars({**self.values, **other.values}, self.notes + other.notes)

    @classmethod
    def unknown(cls, names: Iterable[str], why: str) -> ErrorBars:
        """No bars, for a reason."""
        return cls(dict.fromkeys(names), (why,))


@dataclass(frozen=True)
class Rule:
    """How a difference between a grid and one of twice the cell becomes a bar.

    order : of convergence, used where the coarser grid resolves the surface; elsewhere the difference counts whole.
    safety, rough_safety : factors on it in the two cases.
    """

    order: float = 2.0
    safety: float = 1.0
    rough_safety: float = 1.0

    def bar(self, difference: float, *, resolved: bool) -> float:
        """The discretisation error of the finer of the two."""
        if resolved:
            return self.safety * abs(difference) / (2.0**self.order - 1)
        return self.rough_safety * abs(difference)
