"""What a gate gives: curves of both codes over each other, and the rows of the table that are made of them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from bem.grid import FloatArray

DISPLACEMENT_LIMIT = 3e-3
STRESS_LIMIT = 1e-2
"""No tolerance may exceed these: what the project promises for displacements and lengths, and for stresses."""
FLOOR = 1e-2
"""A stress below this share of the load counts as so much: a small difference of large stresses is no result."""

CLOSED_FORM = "closed form; what is left is for the reference's error bars being estimates"
"""Reason of the tolerance where bem's side is a closed form."""


@dataclass(frozen=True)
class Row:
    """One line of the table.

    Attributes
    ----------
    case, quantity : what was compared.
    bem, reference : both figures at the point where they differ most, in the case's own unit.
    error_bar, difference, tolerance : relative to the largest value of the curve; the error bar is the reference's.
    passed : difference <= tolerance.
    undecided : difference > tolerance, but within the reference's own error bar, which is wider than any tolerance may
        be: the row says nothing of bem, and is no pass.
    unit, where, reason : for people: the unit, the point, and why the tolerance is what it is.
    """

    case: str
    quantity: str
    bem: float
    reference: float
    error_bar: float
    difference: float
    tolerance: float
    passed: bool
    unit: str = ""
    where: str = ""
    reason: str = ""

    @property
    def undecided(self) -> bool:
        """Return True if the reference's error bar exceeds both the difference and the tolerance."""
        return not self.passed and self.difference <= self.error_bar


@dataclass(frozen=True)
class Curve:
    """A quantity of both codes at the same points.

    Attributes
    ----------
    quantity : name of the row it belongs to; curves of one name are judged together, against their largest value.
    along : which points.
    coordinates : (n, 3), as in the stored result.
    bem, reference, error_bar : (n,) in `unit`.
    allowance : the part of the tolerance that is bem's own discretisation, relative.
    reason : why.
    """

    quantity: str
    along: str
    unit: str
    coordinates: FloatArray
    bem: FloatArray
    reference: FloatArray
    error_bar: FloatArray
    allowance: float
    reason: str

    @property
    def floor(self) -> float:
        """Least value that differences are taken relative to."""
        return FLOOR if self.quantity.startswith("stress") else 0.0

    @property
    def limit(self) -> float:
        """Bound on the tolerance."""
        if self.quantity.startswith("order"):
            return np.inf
        stress = self.quantity.startswith(("stress", "von_mises", "pressure", "central_pressure"))
        return STRESS_LIMIT if stress else DISPLACEMENT_LIMIT


@dataclass(frozen=True)
class Gate:
    """A comparison that must hold.

    Attributes
    ----------
    name : what `--case` matches.
    family : the module that runs it.
    sentence : what is compared with what.
    curves : computes both sides.
    """

    name: str
    family: str
    sentence: str
    curves: Callable[[], Sequence[Curve]]

    def run(self) -> list[Row]:
        """Compute and judge."""
        return judge(self.name, self.curves())


def judge(case: str, curves: Iterable[Curve]) -> list[Row]:
    """One row for each quantity: the point whose difference uses up most of its tolerance.

    A point beyond its tolerance and beyond the reference's error bar goes before any that the bar leaves undecided.
    """
    groups: dict[str, list[Curve]] = {}
    for curve in curves:
        groups.setdefault(curve.quantity, []).append(curve)
    return [_row(case, quantity, group) for quantity, group in groups.items()]


def _row(case: str, quantity: str, group: Sequence[Curve]) -> Row:
    scale = max(group[0].floor, *(float(np.max(np.abs(curve.reference))) for curve in group))
    worst: tuple[tuple[bool, float], Row] | None = None
    for curve in group:
        difference = np.abs(curve.bem - curve.reference) / scale
        bar = curve.error_bar / scale
        tolerance = np.minimum(curve.allowance + bar, curve.limit)
        use = np.where(np.isfinite(difference), difference / tolerance, np.inf)
        failed = (use > 1) & ~(difference <= bar)
        i = int(np.argmax(np.where(failed, use, -1.0) if failed.any() else use))
        rank = (bool(failed[i]), float(use[i]))
        if worst is None or rank > worst[0]:
            where = f"{curve.along}: " + ", ".join(f"{c:.6g}" for c in curve.coordinates[i])
            row = Row(
                case,
                quantity,
                float(curve.bem[i]),
                float(curve.reference[i]),
                float(bar[i]),
                float(difference[i]),
                float(tolerance[i]),
                bool(difference[i] <= tolerance[i]),
                curve.unit,
                where,
                curve.reason,
            )
            worst = (rank, row)
    assert worst is not None
    return worst[1]
