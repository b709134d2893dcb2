"""Hardness and stiffness of a tribofilm as functions of its thickness and temperature.

The source takes both from other papers and only plots them (Demmou et al. 2006 for the rise of hardness towards the
substrate, Bosman and Schipper 2011 for the factor with temperature), so they are inputs: any callable
`(thickness [m], temperature [K]) -> Pa` will do. The laws here are those that a scene can name.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import ClassVar

import numpy as np

from bem.laws import Law, parameter, register

FilmProperty = Callable[[float, float], float]
"""(thickness [m], temperature [K]) -> [Pa]"""


@dataclass(frozen=True)
class PropertyLaw(Law):
    """Base class of film properties; to add one, derive from it and register it, here or in a file of your own."""

    family: ClassVar[str] = "film_property"

    @abstractmethod
    def __call__(self, thickness: float, temperature: float) -> float:
        """Return the value [Pa] for a film of a thickness [m] at a temperature [K]."""

    def lowest(self, thickness: float, temperature: float) -> float:
        """Return the lowest value up to a thickness [Pa]; by default over 400 thicknesses."""
        return min(self(fraction * thickness, temperature) for fraction in (0.0, *np.geomspace(1e-6, 1.0, 399)))

    def highest(self, temperature: float) -> float:
        """Return the highest value at any thickness [Pa]; by default over 400 thicknesses up to 1 mm."""
        return max(self(float(h), temperature) for h in (0.0, *np.geomspace(1e-11, 1e-3, 399)))


@register
@dataclass(frozen=True)
class Constant(PropertyLaw):
    """The same value [Pa] at every thickness and temperature."""

    name: ClassVar[str] = "constant"
    value: float = parameter("value of the property", "Pa", above=0)

    def __call__(self, thickness: float, temperature: float) -> float:
        """Return the value [Pa]."""
        return self.value

    def lowest(self, thickness: float, temperature: float) -> float:
        """Return the lowest value up to a thickness [Pa]."""
        return self.value

    def highest(self, temperature: float) -> float:
        """Return the highest value at any thickness [Pa]."""
        return self.value


@register
@dataclass(frozen=True)
class FadingSubstrate(PropertyLaw):
    """Curve from the substrate's value at zero thickness to the film's own, with a temperature factor on each.

    Value = `substrate f_s exp(-h / length) + film f_f (1 - exp(-h / length))` at the film thickness h. Each factor
    falls linearly with temperature above the reference, `f = 1 - slope (T - reference)`, down to `lowest_factor`.

    The source (paper E, figures 1 and 2) multiplies the whole curve by one factor: give both slopes the same value, as
    the scenes that redo it do. The default of `substrate_temperature_slope` is 0, so that the factor acts on the film's
    part only: without a film the value is the substrate's, and steel keeps its hardness below 200 degrees Celsius.

    Attributes
    ----------
    substrate, film : [Pa] at the reference temperature.
    length : decay length [m].
    temperature_slope, substrate_temperature_slope : fall of the film's and of the substrate's factor per kelvin [1/K].
    reference_temperature : temperature at which both factors are 1 [K].
    lowest_factor : lower bound of both factors.
    """

    name: ClassVar[str] = "fading_substrate"
    cites: ClassVar[tuple[str, ...]] = ("demmou2006", "akchurin2017")
    substrate: float = parameter("value at zero film thickness", "Pa", above=0)
    film: float = parameter("value of a thick film at the reference temperature", "Pa", above=0)
    length: float = parameter("film thickness over which the influence of the substrate decays to 1/e", "m", above=0)
    temperature_slope: float = parameter("relative decrease of the film's own value per kelvin", "1/K", default=0.0)
    reference_temperature: float = parameter("reference temperature of both values", "K", default=298.15, above=0)
    lowest_factor: float = parameter("lower bound of the temperature factors", default=0.1, above=0)
    substrate_temperature_slope: float = parameter(
        "relative decrease of the substrate's value per kelvin",
        "1/K",
        default=0.0,
        source="0: steel keeps its hardness below 200 degrees Celsius",
    )

    def __call__(self, thickness: float, temperature: float) -> float:
        """Return the value [Pa]."""
        fraction = math.exp(-max(thickness, 0.0) / self.length)
        substrate = self.substrate * self._factor(self.substrate_temperature_slope, temperature)
        film = self.film * self._factor(self.temperature_slope, temperature)
        return substrate * fraction + film * (1 - fraction)

    def _factor(self, slope: float, temperature: float) -> float:
        """Temperature factor of one part of the curve."""
        return max(1 - slope * (temperature - self.reference_temperature), self.lowest_factor)

    def lowest(self, thickness: float, temperature: float) -> float:
        """Return the lowest value up to a thickness [Pa]; the curve is monotone."""
        return min(self(0.0, temperature), self(thickness, temperature))

    def highest(self, temperature: float) -> float:
        """Return the highest value at any thickness [Pa]."""
        return max(self(0.0, temperature), self(math.inf, temperature))


@register
@dataclass(frozen=True)
class Table(PropertyLaw):
    """Linear interpolation in thickness, times a factor linear in temperature; constant beyond both ends.

    Attributes
    ----------
    thickness : increasing [m].
    value : [Pa] at each.
    temperature : increasing [K].
    factor : at each.
    """

    name: ClassVar[str] = "table"
    thickness: tuple[float, ...] = parameter("film thicknesses of the table, increasing", "m", at_least=0, several=True)
    value: tuple[float, ...] = parameter("values at these thicknesses", "Pa", above=0, several=True)
    temperature: tuple[float, ...] = parameter(
        "temperatures of the factors, increasing", "K", default=(298.15,), above=0, several=True
    )
    factor: tuple[float, ...] = parameter("factors at these temperatures", default=(1.0,), above=0, several=True)

    def rules(self) -> Iterator[str]:
        """Check that each pair of lists is a curve."""
        for abscissa, ordinate in (("thickness", "value"), ("temperature", "factor")):
            x, y = getattr(self, abscissa), getattr(self, ordinate)
            if not x or len(x) != len(y) or any(b <= a for a, b in pairwise(x)):
                yield f"{abscissa} and {ordinate} do not make a curve: as many of both, {abscissa} must increase"

    @classmethod
    def from_lists(
        cls,
        thickness: Sequence[float],
        value: Sequence[float],
        temperature: Sequence[float] = (298.15,),
        factor: Sequence[float] = (1.0,),
    ) -> Table:
        """Return the table of any sequences."""
        return cls(tuple(thickness), tuple(value), tuple(temperature), tuple(factor))

    def __call__(self, thickness: float, temperature: float) -> float:
        """Return the value [Pa]."""
        return float(
            np.interp(thickness, self.thickness, self.value) * np.interp(temperature, self.temperature, self.factor)
        )

    def lowest(self, thickness: float, temperature: float) -> float:
        """Return the lowest value up to a thickness [Pa], at a point of the curve or at an end."""
        points = [0.0, thickness, *(x for x in self.thickness if 0.0 < x < thickness)]
        return min(self(point, temperature) for point in points)

    def highest(self, temperature: float) -> float:
        """Return the highest value at any thickness [Pa]."""
        return max(self(point, temperature) for point in (0.0, *self.thickness))
