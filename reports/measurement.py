"""A published value beside what is computed for it, with both uncertainties: a row of the page on friction."""

from __future__ import annotations

import math
from dataclasses import dataclass

MOST = math.inf
"""Upper end of what is only known to be larger than something."""


@dataclass(frozen=True)
class Row:
    """A measurement and what is computed for it.

    group : its table. what : quantity and conditions. low, high : interval of the measurement, its uncertainty in it.
    ours : computed. down, up : its scatter from the oil's constants. numerical : of its numerical error. source : key
    of the sources in `reports/prose/friction.toml`. remark : conditions that were assumed, or why it is missed.
    computed : True if others computed the value; else it was measured. assumed : True if the source states no
    uncertainty and that of the interval is an assumption. apart : True if the row counts neither as measured nor as
    computed: a formula beyond its tests, a standard, a statement by purpose, or ours not resolved. most : largest value
    that the quantity can have.
    """

    group: str
    what: str
    low: float
    high: float
    ours: float
    down: float
    up: float
    numerical: float
    source: str
    remark: str = ""
    computed: bool = False
    assumed: bool = False
    apart: bool = False
    most: float = MOST

    @property
    def one_sided(self) -> bool:
        """Return True if the interval has one side only, begins at zero, or ends where the quantity does."""
        return self.low <= 0 or self.high >= self.most

    @property
    def inside(self) -> bool:
        """Return True if the interval of the measurement and that of the computed value overlap."""
        return self.ours - self.down - self.numerical <= self.high and self.ours + self.up + self.numerical >= self.low

    @property
    def middle_inside(self) -> bool:
        """Return True if the computed value itself is within the interval of the measurement."""
        return self.low <= self.ours <= self.high
