"""Richardson's estimate of a discretisation error: factors and floors by figure, and rules for sums and ratios.

A figure f of order p has f_h = f + C h^p, so that the difference to half the resolution leaves |f_h - f_2h| / (2^p - 1)
as the error of the finer one. A row of a table holds the factor that stands in place of 1 / (2^p - 1): a safety factor
over it where differences scatter. A difference may pass zero where the error does not; floors remain there. A floor is
a factor on an indicator: a quantity of the figure's unit that says how much of the figure the mesh decides.

Knows numbers alone. Verified in tests/accuracy/test_richardson.py.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from typing import Any

RESIDUAL_FACTOR = 10.0
"""Relative change of a figure over the relative residual of the equations, at most: the condition of film, flow, heat
and slip problems as the stored experiments have it."""

Value = float | tuple[float, ...]
"""A number for all regimes, or numbers for (resolved, unresolved) or (resolved, sampled, unresolved) surfaces."""


class Regime(IntEnum):
    """Quality with which the coarser grid represents a surface; the index into a `Value`."""

    RESOLVED = 0
    """Curvature changes little from cell to cell, and spots are several cells wide: figures show their order."""
    SAMPLED = 1
    """No waves shorter than two cells of the coarser grid: both grids have the same surface, without an order yet."""
    UNRESOLVED = -1
    """Heights between the cells of the coarser grid are lost: its surface is another one."""


@dataclass(frozen=True)
class Row:
    """Row of a table: error of a figure = factor |f_h - f_2h| + sum of floor x indicator.

    factor : on the difference to half the resolution.
    why : the reason for the numbers, in a sentence or two.
    order : order of convergence p that is assumed.
    floors : factors on indicators, by the indicator's name.
    """

    factor: Value
    why: str
    order: int = 2
    floors: Mapping[str, Value] = field(default_factory=dict)

    def error(self, difference: Any, indicators: Mapping[str, Any], regime: Regime = Regime.RESOLVED) -> Any:
        """Return the error of the finer figure [its unit].

        Parameters
        ----------
        difference : between the figure and that on half the resolution; a number or an array.
        indicators : sizes of the floors' indicators [unit of the figure]; zero where one is missing.
        regime : how well the coarser grid resolves the surface.
        """
        error = at(self.factor, regime) * abs(difference)
        for name, floor in self.floors.items():
            error = error + at(floor, regime) * abs(indicators.get(name, 0.0))
        return error


def at(value: Value, regime: Regime) -> float:
    """Return a value in a regime."""
    return value[regime] if isinstance(value, tuple) else value


def rows(figures: str, factor: Value, why: str, *, order: int = 2, **floors: Value) -> dict[str, Row]:
    """Return one row for each of several figures, given by their names with spaces between them."""
    return dict.fromkeys(figures.split(), Row(factor, why, order, floors))


class Table(Mapping[str, Row]):
    """Rows of a kind by figure.

    experiments : stems of the results in reports/results by which the numbers are judged.
    """

    def __init__(self, experiments: str, *parts: Mapping[str, Row]) -> None:
        """Join rows to a table; `experiments` with spaces between them."""
        self.experiments = tuple(experiments.split())
        self._rows = {name: row for part in parts for name, row in part.items()}

    def __getitem__(self, figure: str) -> Row:
        return self._rows[figure]

    def __iter__(self) -> Iterator[str]:
        return iter(self._rows)

    def __len__(self) -> int:
        return len(self._rows)

    def errors(
        self,
        found: Mapping[str, Any],
        other: Mapping[str, Any],
        indicators: Mapping[str, Mapping[str, Any]] | None = None,
        *,
        regime: Regime = Regime.RESOLVED,
        ratio: float = 0.5,
    ) -> dict[str, Any]:
        """Return the errors of the figures that have a row.

        Parameters
        ----------
        found, other : figures on the resolution itself, and on `ratio` times as many cells or points.
        indicators : sizes of indicators by figure, by the indicator's name; see `relative`.
        regime : how well the coarser grid resolves the surface.
        ratio : cells or points of `other` over those of `found`, along each axis.
        """
        known = indicators or {}
        errors = {}
        for name, row in self.items():
            if name in found:
                difference = (found[name] - other[name]) * to_half(ratio, row.order)
                own = {indicator: sizes[name] for indicator, sizes in known.items() if name in sizes}
                errors[name] = row.error(difference, own, regime)
        return errors


def to_half(ratio: float, order: int = 2) -> float:
    """Return the factor from the difference to `ratio` times the points to that to half as many, by the order."""
    return abs((2**order - 1) / (ratio**-order - 1))


def relative(fraction: Any, figures: Mapping[str, Any]) -> dict[str, Any]:
    """Return a fraction of the size of each figure: the indicator of a floor."""
    return {name: fraction * abs(value) for name, value in figures.items()}


def residual_errors(residual: Any, sizes: Mapping[str, Any], factor: float = RESIDUAL_FACTOR) -> dict[str, Any]:
    """Return the errors that a relative residual leaves of figures of these sizes."""
    return relative(factor * residual, sizes)


def share_error(errors: dict[str, float], names: Iterable[str]) -> None:
    """Give figures whose sum is prescribed the largest error of any: one is as wrong as the other."""
    names = tuple(names)
    errors.update(dict.fromkeys(names, max(errors[name] for name in names)))


def follow(errors: dict[str, float], name: str, leader: str, sizes: Mapping[str, float]) -> None:
    """Raise the relative error of a figure that is proportional to another to that of the other, at least."""
    if sizes[leader]:
        errors[name] = max(errors[name], errors[leader] / abs(sizes[leader]) * abs(sizes[name]))


def cover_parts(errors: dict[str, float], name: str, parts: Iterable[str]) -> None:
    """Raise the error of a sum to the largest of its parts: differences of parts may cancel where their errors do
    not."""
    errors[name] = max(errors[name], *(errors[part] for part in parts))
