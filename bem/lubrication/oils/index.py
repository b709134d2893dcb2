"""Viscosity index, ASTM D2270: how little the viscosity falls between 40 and 100 degrees Celsius.

Viscosities are kinematic [mm^2/s], as in the standard.
"""

from __future__ import annotations

import math
from functools import cache
from importlib.resources import files

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray

LEAST_VISCOSITY = 2.0
"""At 100 degrees Celsius [mm^2/s], below which the index is not defined."""
LARGEST_INDEX = 450.0
"""Up to where the viscosity at 100 degrees is looked for; silicone oils reach 423."""
_LAST_OF_TABLE = 70.0


@cache
def _table() -> FloatArray:
    text = files("bem.lubrication.oils").joinpath("viscosity_index.csv").read_text()
    return np.loadtxt(text.splitlines(), delimiter=",").T


def reference_oils(viscosity_100: float) -> tuple[float, float]:
    """L and H: viscosities at 40 degrees of the oils of index 0 and 100 that have `viscosity_100` at 100 degrees.

    Table 1 of the standard, linear between its rows; above 70 mm^2/s its equations.
    """
    y = viscosity_100
    if y > _LAST_OF_TABLE:
        return 0.8353 * y * y + 14.67 * y - 216.0, 0.1684 * y * y + 11.85 * y - 97.0
    at, low, high = _table()
    return float(np.interp(y, at, low)), float(np.interp(y, at, high))


def viscosity_index(viscosity_40: float, viscosity_100: float) -> float:
    """Viscosity index, not rounded, of kinematic viscosities at 40 and 100 degrees Celsius [mm^2/s].

    Procedure A up to 100, procedure B above.

    Raises
    ------
    InputError : a viscosity at 100 degrees below 2 mm^2/s, or one that does not fall with temperature.
    """
    if not (math.isfinite(viscosity_40) and math.isfinite(viscosity_100) and viscosity_40 > viscosity_100 > 0):
        raise InputError(
            f"viscosity_index: {viscosity_40!r} at 40 and {viscosity_100!r} mm^2/s at 100 degC must be finite and fall"
        )
    if viscosity_100 < LEAST_VISCOSITY:
        raise InputError(
            f"viscosity_index: {viscosity_100:g} mm^2/s at 100 degC is below {LEAST_VISCOSITY:g}, where no index is "
            "defined"
        )
    low, high = reference_oils(viscosity_100)
    if viscosity_40 >= high:
        return 100 * (low - viscosity_40) / (low - high)
    return 100 + (10 ** (math.log10(high / viscosity_40) / math.log10(viscosity_100)) - 1) / 0.00715


def viscosity_at_40(viscosity_100: float, index: float) -> float:
    """The viscosity at 40 degrees [mm^2/s] that makes an index with one at 100 degrees; the inverse in closed form."""
    low, high = reference_oils(viscosity_100)
    if index <= 100:
        return low - index * (low - high) / 100
    return float(high / viscosity_100 ** math.log10(1 + 0.00715 * (index - 100)))


def viscosity_at_100(viscosity_40: float, index: float) -> float:
    """The viscosity at 100 degrees [mm^2/s] that makes an index with one at 40 degrees, by bisection.

    Raises
    ------
    InputError : an index outside -100 to 450, or one that no viscosity above 2 mm^2/s makes.
    """
    if not -100 <= index <= LARGEST_INDEX:
        raise InputError(f"viscosity index {index:g}: must lie between -100 and {LARGEST_INDEX:g}")
    low, high = LEAST_VISCOSITY, viscosity_40
    if not (math.isfinite(viscosity_40) and high > low and viscosity_at_40(low, index) <= viscosity_40):
        raise InputError(
            f"viscosity index {index:g} with {viscosity_40:g} mm^2/s at 40 degC: less than {LEAST_VISCOSITY:g} mm^2/s "
            "would be left at 100 degC, where no index is defined; give both viscosities"
        )
    for _ in range(200):  # the index rises with the viscosity at 100 degrees; 60 halvings reach the last bit
        middle = math.sqrt(low * high)
        if not low < middle < high:
            break
        if viscosity_at_40(middle, index) <= viscosity_40:
            low = middle
        else:
            high = middle
    return low
