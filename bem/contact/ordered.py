"""Numbers in the order of their bits: the largest and the smallest are found in vectors, which the order of numbers,
with those that are none, forbids.

Bits of numbers above zero are integers in the same order; those of numbers below zero are turned. What is no number
counts for nothing, as where numbers are compared. Knows no contact. Verified in tests/contact/test_contact_passes.py.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types
from numba.extending import intrinsic

from bem.compiled import compiled

_INFINITE = int(np.float64(np.inf).view(np.int64))
ABOVE_ALL, BELOW_ALL = _INFINITE, ~_INFINITE
"""Places of infinity, and of minus infinity."""

_MAGNITUDE = np.iinfo(np.int64).max


@compiled
def place_of(value):
    """The place of a number among all; it is not to be asked of what is none."""
    bits = _bits(value)
    return bits ^ ((bits >> 63) & _MAGNITUDE)


@compiled
def number_at(place):
    """The number that has a place."""
    return _number(place ^ ((place >> 63) & _MAGNITUDE))


@intrinsic
def _bits(typing: Any, value: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], context.get_value_type(types.int64))

    return types.int64(types.float64), generate


@intrinsic
def _number(typing: Any, bits: Any) -> Any:
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.bitcast(arguments[0], context.get_value_type(types.float64))

    return types.float64(types.int64), generate
