"""Pairs of lengths as people write them, for plans and warnings, and the numbers of a summary."""

from __future__ import annotations

from typing import Any

import numpy as np

from bem.quantities import si


def times(values: tuple[float, float], unit: str) -> str:
    """Write two values along x and y; one where they agree."""
    first, second = (si(value, unit) for value in values)
    return first if first == second else f"{first} x {second}"


def numbers(value: Any) -> list[float]:
    """Return a figure of the summary, or lists of them, as numbers that are finite."""
    if isinstance(value, list | tuple):
        return [number for item in value for number in numbers(item)]
    return [float(value)] if isinstance(value, int | float | np.number) and np.isfinite(value) else []
