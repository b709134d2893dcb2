"""Quantities on axes and in tables, with prefixed units; without matplotlib, for who only prints them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from bem.numerics.blocks import BLOCK, row_blocks
from bem.physical_constants import ZERO_CELSIUS
from bem.quantities import plain_digits, prefix_for
from bem.scenes.context import release

UNIFORM = 1e-5
"""A field that differs by less than this fraction of its largest value is drawn as uniform: solvers leave 1e-6."""
FEWEST_CELLS = 8
"""Maps with fewer cells along one axis are drawn as lines along the other."""
LONE = 1.5
"""Range of a field over that between percentiles of it, from which lone values would take all colours."""
_DIFFERENCES = ("rise", "difference", "error", "spread")
_KEY_WORDS = {
    "slide_roll_ratio": "slide-to-roll ratio",
    "roll.creepage": "creepage along x",
    "roll.creepage_across": "creepage along y",
    "roll.share": "force over friction x load",
}
"""Names of keys whose words are not the key's with spaces."""


def prefix(values: Any, unit: str) -> tuple[float, str]:
    """Return factor and unit label that bring the largest of `values` between 1 and 1000; see `prefix_for`."""
    return prefix_for(largest_of(values), unit)


def largest_of(values: Any) -> float:
    """The largest finite absolute value, 0 where there is none; large arrays are read block by block."""
    array = np.asarray(values, dtype=np.float64)
    array = array if array.ndim else array[np.newaxis]
    largest = 0.0
    for first, last in row_blocks(array.shape):
        block = array[first:last]
        if block.size > BLOCK and len(block) == 1 and array.ndim > 1:
            largest = max(largest, largest_of(block[0]))
        else:
            finite = np.abs(block[np.isfinite(block)])
            largest = max(largest, float(finite.max()) if finite.size else 0.0)
        release(array)
    return largest


def is_difference(name: str, words: str = "") -> bool:
    """Return True if a quantity in kelvin is a difference of temperatures, which stays in kelvin.

    name, words : name of the variable and its description; rises, differences, errors and spreads are differences.
    """
    said = f"{name} {words}".lower()
    return any(word in said for word in _DIFFERENCES)


def in_celsius(values: Any, unit: str, name: str, words: str = "") -> tuple[Any, str]:
    """Temperatures in °C with that unit; differences of temperature, and other quantities, as they are."""
    if unit != "K" or is_difference(name, words):
        return values, unit
    return np.asarray(values) - ZERO_CELSIUS, "°C"


def key_words(key: str, words: str = "") -> str:
    """A key of a scene as an axis names it: `rolling.slide_roll_ratio` is "slide-to-roll ratio".

    words : description of its values; used where it is not the key again.
    """
    if words and words != key:
        return words
    *tables, name = key.split(".")
    side = next((table for table in tables if table in ("lower", "upper")), "")
    plain = _KEY_WORDS.get(".".join([*tables[-1:], name]), _KEY_WORDS.get(name, name.replace("_", " ")))
    return f"{plain} ({side})" if side else plain


def beyond_ends(ends: tuple[float, float], reached: tuple[float, float]) -> tuple[str, str]:
    """Return the extension of a colour bar ("neither", "min", "max", "both"), and its words on values beyond its
    ends.

    ends : of the colours. reached : least and largest value, in the same unit.
    """
    slack = 1e-6 * max(abs(ends[0]), abs(ends[1]))
    below, above = reached[0] < ends[0] - slack, reached[1] > ends[1] + slack
    low, high = plain_digits(ends[0], 3), plain_digits(ends[1], 3)
    if below and above:
        said = f"colours end at ±{high}" if low == f"-{high}" else f"colours end at {low}, {high}"
        words = f"{said};\nvalues {plain_digits(reached[0], 3)} to {plain_digits(reached[1], 3)}"
    elif above:
        words = f"colours end at {high};\nmaximum {plain_digits(reached[1], 3)}"
    elif below:
        words = f"colours end at {low};\nminimum {plain_digits(reached[0], 3)}"
    else:
        return "neither", ""
    return {(True, True): "both", (True, False): "min", (False, True): "max"}[below, above], words


def colour_ends(values: NDArray[np.float64], low: float, high: float) -> tuple[float, float]:
    """Return the ends of a field's colours: percentiles where lone values would take them all, else its extremes.

    low, high : percentiles.
    """
    finite = values[np.isfinite(values)]
    if not finite.size:
        return 0.0, 1.0
    first, last = (float(end) for end in np.percentile(finite, [low, high]))
    least, most = float(finite.min()), float(finite.max())
    return (first, last) if last > first and most - least > LONE * (last - first) else (least, most)


FILM_HEIGHTS = 4.0
"""Upper end of the axis of a smooth film's thickness over its minimum: the inlet opens to many times that."""


def loaded_part(x: NDArray[np.float64], pressure: NDArray[np.float64]) -> tuple[float, float]:
    """Return the ends of the part of a film that figures show [m]: 1.5 times where it has 1 % of its highest pressure.

    x : (n,) places [m]. pressure : (..., n), of one film or several.
    """
    highest = pressure.reshape(-1, x.size).max(axis=0)
    wide = x[highest > 0.01 * highest.max()]
    if not wide.size:
        return float(x[0]), float(x[-1])
    middle, half = 0.5 * float(wide[-1] + wide[0]), 0.75 * float(wide[-1] - wide[0])
    return middle - half, middle + half


def uniform_value(values: NDArray[np.float64]) -> float | None:
    """The value of a field that is the same everywhere but for rounding; None of any other field, and of an empty one.

    Not-a-number is not looked at.
    """
    finite = np.isfinite(values)
    low, high = (
        float(np.min(values, where=finite, initial=np.inf)),
        float(np.max(values, where=finite, initial=-np.inf)),
    )
    if not low <= high or high - low > UNIFORM * max(abs(low), abs(high)):
        return None
    return 0.5 * (low + high)


def label(text: str, unit: str) -> str:
    """Text for an axis: `x (µm)`."""
    return f"{text} ({unit})" if unit else text
