"""The energy of a pressure, and the lowest point on the way from one pressure to another.

The energy is p.Kp/2 + p.gap; at an approach d it is less by d times the sum of p.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from bem.contact import passes, sets
from bem.contact.controls import ApproachControl, Control
from bem.contact.feasible import everywhere
from bem.contact.judging import Survey
from bem.contact.level import Indices, Iterate, Level

FloatArray = NDArray[np.float64]

_ROUND_OFF = 1e-12
"""Energies closer than this, relative to the sum of their terms, are taken as equal."""

_LEAST_SHARE = 0.02
"""Of the way of a round, below which it is not worth to go at all."""

_GREATEST_SHARE = 0.75
"""Of the way of a round to its lowest point, above which its end is taken. 0.5, where the energy just rises, lets the
sets swing for long on some capped and free contacts; at 0.8 rounds that only lack precision are spoiled."""


class Accepted(NamedTuple):
    """A pressure with its approach, its energy at approach zero, the size of the terms in that, and its sum."""

    iterate: Iterate
    approach: float
    energy: float
    size: float
    force: float

    @classmethod
    def of(cls, iterate: Iterate, approach: float, seen: Survey) -> Accepted:
        """A pressure with what was seen of it."""
        return cls(iterate, approach, seen.energy, seen.size, seen.force)

    def potential(self, control: Control) -> float:
        """The energy that falls under a control: at the approach where that is given."""
        return self.energy - (control.approach * self.force if isinstance(control, ApproachControl) else 0.0)

    def above(self, other: Accepted, approach: float) -> bool:
        """Whether the energy is higher than the other's by more than round-off."""
        rise = self.energy - other.energy - approach * (self.force - other.force)
        return rise > _ROUND_OFF * max(self.size, other.size)


def lowest_point(level: Level, before: Accepted, iterate: Iterate, now: Survey) -> tuple[Iterate, float] | None:
    """The lowest point between a round's ends, if the round went well beyond it; the displacement there replaces the
    one in the buffer, without a convolution; and its share of the way. None where the round's end, which is `now` (the
    other pressure's work is that of the beginning), will do.

    Changes of the sets that are each right by themselves can be too many together: without this they swing ever wider,
    or for long.
    """
    displacement, approach = level.flat["displacement"], before.approach
    # the energy's slope where the round ended, along the way from its beginning
    slope = now.work - now.work_of_other - approach * (now.force - before.force)
    rise = now.energy - before.energy - approach * (now.force - before.force)
    curvature = 2 * (slope - rise)
    if not curvature > 10 * _ROUND_OFF * max(now.size, before.size):
        return None
    share = 1 - slope / curvature
    if not _LEAST_SHARE < share < _GREATEST_SHARE:
        return None
    passes.in_blocks(displacement.size, 0, sets.mix, displacement, level.flat["before"], share)
    cells, values = sets.blend(_pressed(before.iterate, level.cap), _pressed(iterate, level.cap), share, level.cap)
    if before.iterate.capped.size == 0 and iterate.capped.size == 0:
        return Iterate(cells, values, iterate.capped), share
    capped = values >= level.cap
    return Iterate(cells[~capped], values[~capped], cells[capped]), share


def _pressed(iterate: Iterate, cap: float) -> tuple[Indices, FloatArray]:
    """All cells with pressure in one ascending array, with their values."""
    if iterate.capped.size == 0:
        return iterate.cells, iterate.values
    cells = np.concatenate([iterate.cells, iterate.capped])
    values = np.concatenate([iterate.values, np.full(iterate.capped.size, cap)])
    order = np.argsort(cells, kind="stable")
    return cells[order], values[order]


def best_share(level: Level, old: Accepted, new: Accepted, approach: float) -> float:
    """Where on the way from one pressure to the next the energy is least, from both energies and the slope at the end.

    The displacement of the new pressure is in the buffer. 0 if the energy rises from the start.
    """
    change = everywhere(level, new.iterate) - everywhere(level, old.iterate)
    slope = float((change * (level.gap + level.flat["displacement"] - approach)).sum())
    rise = new.energy - old.energy - approach * (new.force - old.force)
    curvature = 2 * (slope - rise)
    if not curvature > 0:
        return 0.0
    share = 1 - slope / curvature
    return share if _LEAST_SHARE < share < 0.98 else 0.0
