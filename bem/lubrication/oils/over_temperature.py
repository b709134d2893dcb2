"""Viscosity over temperature at ambient pressure: Walther (ASTM D341), Vogel, Andrade, or a table.

A law gives ln(kinematic viscosity / 1 mm^2/s) at a temperature [K] and its slope; it says between which temperatures
it is measured. Laws are made from measured points, or from their constants.
"""

from __future__ import annotations

import itertools
import math
from abc import ABCMeta, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Self

from bem.errors import InputError

MM2_S = 1e-6
"""One mm^2/s in m^2/s."""
_SHIFT = 0.7
Points = Sequence[tuple[float, float]]
"""Temperatures [K] and kinematic viscosities [m^2/s]."""


@dataclass(frozen=True)
class OverTemperature(metaclass=ABCMeta):
    """Kinematic viscosity over temperature.

    lowest, highest : temperatures [K] between which the law was measured; it is extrapolated beyond.
    name : in messages. takes : how many points make one; None for two or more. least : viscosity [m^2/s] above which it
        holds.
    """

    name: ClassVar[str]
    takes: ClassVar[int | None] = None
    least: ClassVar[float] = 0.0
    lowest: float
    highest: float

    @classmethod
    def through(cls, points: Points) -> Self:
        """Through points, exactly.

        Raises
        ------
        InputError : other than as many points as the law takes, temperatures twice, viscosities that do not fall with
            temperature or are too low for the law, points that no such curve joins.
        """
        ordered = sorted((float(t), float(v)) for t, v in points)
        if (cls.takes is not None and len(ordered) != cls.takes) or len(ordered) < 2:
            raise InputError(f"{cls.name}: takes {cls.takes or 'two or more'} temperatures, not {len(ordered)}")
        good = all(math.isfinite(t) and math.isfinite(v) and t > 0 and v > cls.least for t, v in ordered)
        if not good or not all(t1 < t2 and v1 > v2 for (t1, v1), (t2, v2) in itertools.pairwise(ordered)):
            raise InputError(
                f"{cls.name}: temperatures must differ and viscosities fall with temperature, all positive"
                + (f" and above {cls.least / MM2_S:g} mm^2/s" if cls.least else "")
            )
        return cls._joining(ordered)

    @classmethod
    @abstractmethod
    def _joining(cls, points: list[tuple[float, float]]) -> Self:
        """That of points in rising order of temperature that are fit for it."""

    @abstractmethod
    def logarithm(self, temperature: float) -> tuple[float, float]:
        """ln(viscosity / 1 mm^2/s) at a temperature [K], and its slope [1/K], negative."""

    @property
    @abstractmethod
    def words(self) -> str:
        """The law, for a reader."""

    def kinematic(self, temperature: float) -> float:
        """Kinematic viscosity [m^2/s] at a temperature [K]."""
        return MM2_S * math.exp(self.logarithm(temperature)[0])

    def walther_slope(self, temperature: float) -> float:
        """-d lg lg(v + 0.7) / d lg T, v in mm^2/s: B of Walther's law that touches this one at a temperature [K]."""
        log, slope = self.logarithm(temperature)
        v = math.exp(log)
        return -slope * v * temperature / ((v + _SHIFT) * math.log(v + _SHIFT))


@dataclass(frozen=True)
class Walther(OverTemperature):
    """lg lg(v + 0.7) = A - B lg T, v in mm^2/s, T in K; ASTM D341 (its terms for v below 2 mm^2/s are left out)."""

    intercept: float
    slope: float

    name: ClassVar[str] = "Walther"
    takes: ClassVar[int | None] = 2
    least: ClassVar[float] = 0.31 * MM2_S

    @classmethod
    def _joining(cls, points: list[tuple[float, float]]) -> Self:
        (t1, v1), (t2, v2) = points
        z1, z2 = (math.log10(math.log10(v / MM2_S + _SHIFT)) for v in (v1, v2))
        slope = (z1 - z2) / math.log10(t2 / t1)
        return cls(t1, t2, z1 + slope * math.log10(t1), slope)

    def logarithm(self, temperature: float) -> tuple[float, float]:
        """As the class says."""
        inner = 10 ** (self.intercept - self.slope * math.log10(temperature))  # lg(v + 0.7)
        total = 10**inner
        v = max(total - _SHIFT, 1e-300)
        slope = -self.slope / temperature * total * math.log(total) / v
        return math.log(v), slope

    @property
    def words(self) -> str:
        """The formula with its constants."""
        return f"Walther (ASTM D341), lg lg(v + 0.7) = {self.intercept:.5g} - {self.slope:.5g} lg T"


@dataclass(frozen=True)
class Vogel(OverTemperature):
    """ln v = A + B / (T - C), v in mm^2/s; Vogel, Phys. Z. 22 (1921) 645."""

    a: float
    b: float
    c: float

    name: ClassVar[str] = "Vogel"
    takes: ClassVar[int | None] = 3

    @classmethod
    def _joining(cls, points: list[tuple[float, float]]) -> Self:
        # C by equating the slopes between the points, in closed form
        (t1, v1), (t2, v2), (t3, v3) = points
        y1, y2, y3 = (math.log(v / MM2_S) for v in (v1, v2, v3))
        # (y1 - y2)(t2 - c)... : ratio r = (y1-y2)(t3-t2) / ((y2-y3)(t2-t1)) = (t3 - c)/(t1 - c)
        r = (y1 - y2) * (t3 - t2) / ((y2 - y3) * (t2 - t1))
        if r <= 1:
            raise InputError("Vogel: no such curve joins the three viscosities; Andrade's or a table may")
        c = (r * t1 - t3) / (r - 1)
        b = (y1 - y2) * (t1 - c) * (t2 - c) / (t2 - t1)
        return cls(t1, t3, y1 - b / (t1 - c), b, c)

    def logarithm(self, temperature: float) -> tuple[float, float]:
        """As the class says.

        Raises
        ------
        InputError : a temperature at or below C, where the viscosity is infinite.
        """
        above = temperature - self.c
        if above <= 0:
            raise InputError(f"Vogel: the viscosity is infinite at {self.c:g} K and below")
        return self.a + self.b / above, -self.b / above**2

    @property
    def words(self) -> str:
        """The formula with its constants."""
        return f"Vogel, ln v = {self.a:.5g} + {self.b:.5g} / (T - {self.c:.5g})"


@dataclass(frozen=True)
class Andrade(OverTemperature):
    """ln v = A + B / T, v in mm^2/s; Andrade, Nature 125 (1930) 309. Good over some tens of kelvins."""

    a: float
    b: float

    name: ClassVar[str] = "Andrade"
    takes: ClassVar[int | None] = 2

    @classmethod
    def _joining(cls, points: list[tuple[float, float]]) -> Self:
        (t1, v1), (t2, v2) = points
        b = math.log(v1 / v2) / (1 / t1 - 1 / t2)
        return cls(t1, t2, math.log(v1 / MM2_S) - b / t1, b)

    def logarithm(self, temperature: float) -> tuple[float, float]:
        """As the class says."""
        return self.a + self.b / temperature, -self.b / temperature**2

    @property
    def words(self) -> str:
        """The formula with its constants."""
        return f"Andrade, ln v = {self.a:.5g} + {self.b:.5g} / T"


@dataclass(frozen=True)
class ViscosityTable(OverTemperature):
    """Walther's law between neighbouring points of a table, and those of its ends beyond."""

    pieces: tuple[Walther, ...]

    name: ClassVar[str] = "table"
    least: ClassVar[float] = Walther.least

    @classmethod
    def _joining(cls, points: list[tuple[float, float]]) -> Self:
        pieces = tuple(Walther._joining(list(pair)) for pair in itertools.pairwise(points))
        return cls(points[0][0], points[-1][0], pieces)

    def logarithm(self, temperature: float) -> tuple[float, float]:
        """That of the piece the temperature is in."""
        piece = next((piece for piece in self.pieces if temperature <= piece.highest), self.pieces[-1])
        return piece.logarithm(temperature)

    @property
    def words(self) -> str:
        """What it is."""
        return f"table of {len(self.pieces) + 1} viscosities, Walther between them"


LAWS: dict[str, type[Walther] | type[Vogel] | type[Andrade] | type[ViscosityTable]] = {
    "walther": Walther,
    "vogel": Vogel,
    "andrade": Andrade,
    "table": ViscosityTable,
}
"""Laws that points make, by name."""
