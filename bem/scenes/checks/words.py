"""Numbers with units as people write them, for plans and warnings, and the numbers of a summary."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "u"), (1e-9, "n"))


def si(value: float, unit: str, digits: int = 3) -> str:
    """`45e-9, "m"` as "45 nm"; prefixes from nano to giga, powers of ten beyond."""
    if value == 0 or not math.isfinite(value):
        return f"{value:g} {unit}"
    rounded = float(f"{value:.{digits}g}")
    for factor, prefix in _PREFIXES:
        if factor <= abs(rounded) * (1 + 1e-12) < 1000 * factor:
            shown = rounded / factor
            return f"{shown:.{digits}g} {prefix}{unit}" if abs(shown) < 10**digits else f"{shown:.0f} {prefix}{unit}"
    return f"{value:.{digits}g} {unit}"


def times(values: tuple[float, float], unit: str) -> str:
    """Two values along x and y; one where they agree."""
    first, second = (si(value, unit) for value in values)
    return first if first == second else f"{first} x {second}"


def percent(share: float) -> str:
    """A share of one in per cent."""
    return f"{100 * share:.2g} %" if share < 0.995 else "100 %"


def joined(words: list[str]) -> str:
    """a, b and c."""
    return words[0] if len(words) == 1 else f"{', '.join(words[:-1])} and {words[-1]}"


def numbers(value: Any) -> list[float]:
    """A figure of the summary, or lists of them, as numbers that are finite."""
    if isinstance(value, list | tuple):
        return [number for item in value for number in numbers(item)]
    return [float(value)] if isinstance(value, int | float | np.number) and np.isfinite(value) else []
