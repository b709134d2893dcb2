"""Hardness and stiffness of a tribofilm as functions of its thickness and temperature.

The source takes both from other papers and only plots them (Demmou et al. 2006 for the rise of hardness towards the
substrate, Bosman and Schipper 2011 for the factor with temperature), so they are inputs: any callable
`(thickness [m], temperature [K]) -> Pa` will do, and these are the ones that a scene can name.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from bem.errors import InputError

FilmProperty = Callable[[float, float], float]
"""(thickness [m], temperature [K]) -> [Pa]"""


@dataclass(frozen=True)
class Constant:
    """The same value [Pa] at every thickness and temperature."""

    value: float

    def __post_init__(self) -> None:
        if not (math.isfinite(self.value) and self.value > 0):
            raise InputError(f"Constant: value {self.value!r} must be positive and finite [Pa]")

    def __call__(self, thickness: float, temperature: float) -> float:
        """Value [Pa]."""
        return self.value

    def lowest(self, thickness: float, temperature: float) -> float:
        """Lowest value from no film to this thickness [Pa]."""
        return self.value

    def highest(self, temperature: float) -> float:
        """Highest value at any thickness [Pa]."""
        return self.value


@dataclass(frozen=True)
class FadingSubstrate:
    """From the substrate's value at zero thickness to the film's own, `film + (substrate - film) exp(-h / length)`,
    times a factor that falls linearly with temperature above the reference, and never below `lowest_factor`.

    Parameters
    ----------
    substrate, film : [Pa] at the reference temperature. length : decay length [m].
    temperature_slope : fall of the factor per kelvin [1/K]; the factor acts on the film's own value only, because the
        substrate (steel) does not soften below 200 degrees Celsius.
    reference_temperature : [K]. lowest_factor : what is left of the film's own value at any temperature.
    """

    substrate: float
    film: float
    length: float
    temperature_slope: float = 0.0
    reference_temperature: float = 298.15
    lowest_factor: float = 0.1

    def __post_init__(self) -> None:
        messages = []
        for key in ("substrate", "film", "length", "reference_temperature", "lowest_factor"):
            value = getattr(self, key)
            if not (math.isfinite(value) and value > 0):
                messages.append(f"FadingSubstrate: {key} {value!r} must be positive and finite")
        if not math.isfinite(self.temperature_slope):
            messages.append(f"FadingSubstrate: temperature_slope {self.temperature_slope!r} must be finite [1/K]")
        if messages:
            raise InputError(messages)

    def __call__(self, thickness: float, temperature: float) -> float:
        """Value [Pa]."""
        factor = max(
            1 - self.temperature_slope * (temperature - self.reference_temperature),
            self.lowest_factor,
        )
        share = math.exp(-max(thickness, 0.0) / self.length)
        return self.substrate * share + self.film * factor * (1 - share)

    def lowest(self, thickness: float, temperature: float) -> float:
        """Lowest value from no film to this thickness [Pa]: it rises or falls all the way."""
        return min(self(0.0, temperature), self(thickness, temperature))

    def highest(self, temperature: float) -> float:
        """Highest value at any thickness [Pa]."""
        return max(self(0.0, temperature), self(math.inf, temperature))


@dataclass(frozen=True)
class Table:
    """Linear interpolation in thickness, times a factor linear in temperature; constant beyond both ends.

    Parameters
    ----------
    thickness : increasing [m]. value : [Pa] at each. temperature : increasing [K]. factor : at each.
    """

    thickness: tuple[float, ...]
    value: tuple[float, ...]
    temperature: tuple[float, ...] = (298.15,)
    factor: tuple[float, ...] = (1.0,)

    def __post_init__(self) -> None:
        messages = []
        for abscissa, ordinate in (("thickness", "value"), ("temperature", "factor")):
            x, y = np.asarray(getattr(self, abscissa)), np.asarray(getattr(self, ordinate))
            if x.ndim != 1 or x.size == 0 or x.shape != y.shape:
                messages.append(f"Table: {abscissa} and {ordinate} must be lists of the same length, at least one")
            elif not ((np.diff(x) > 0).all() and np.isfinite(x).all()):
                messages.append(f"Table: {abscissa} must increase")
            elif not ((y > 0).all() and np.isfinite(y).all()):
                messages.append(f"Table: {ordinate} must be positive")
        if messages:
            raise InputError(messages)

    @classmethod
    def from_lists(
        cls,
        thickness: Sequence[float],
        value: Sequence[float],
        temperature: Sequence[float] = (298.15,),
        factor: Sequence[float] = (1.0,),
    ) -> Table:
        """From any sequences."""
        return cls(tuple(thickness), tuple(value), tuple(temperature), tuple(factor))

    def __call__(self, thickness: float, temperature: float) -> float:
        """Value [Pa]."""
        return float(
            np.interp(thickness, self.thickness, self.value) * np.interp(temperature, self.temperature, self.factor)
        )

    def lowest(self, thickness: float, temperature: float) -> float:
        """Lowest value from no film to this thickness [Pa]: at a point of the curve or at either end."""
        points = [0.0, thickness, *(x for x in self.thickness if 0.0 < x < thickness)]
        return min(self(point, temperature) for point in points)

    def highest(self, temperature: float) -> float:
        """Highest value at any thickness [Pa]."""
        return max(self(point, temperature) for point in (0.0, *self.thickness))
