"""Values put back in the order of heights: sorting is most of the work of surfaces with prescribed moments."""

from __future__ import annotations

import numpy as np

from bem.compiled import compiled
from bem.grid import FloatArray

_BITS = 11
_DIGITS = 6  # of 64 bits
_SIGN = np.uint64(1 << 63)


def in_order_of(heights: FloatArray, ascending: FloatArray) -> FloatArray:
    """The k-th of the ascending values where the k-th lowest height is, equal heights in order of place: (nx, ny).

    `heights` (nx, ny), C-ordered, is overwritten. Digit by digit from the last (radix sort): three times as fast as
    numpy's stable sort and in no more memory, with the same order.
    """
    ranked = np.empty(heights.shape)
    keys, spare = heights.reshape(-1).view(np.uint64), ranked.reshape(-1).view(np.uint64)
    _make_keys(keys)
    kind = np.uint32 if keys.size <= 1 << 32 else np.uint64
    order = _sorted(keys, spare, np.arange(keys.size, dtype=kind), np.empty(keys.size, kind))
    _put(order, ascending, ranked.reshape(-1))
    return ranked


@compiled
def _make_keys(keys):
    """Bits of numbers as unsigned integers of the same order; both zeros are one."""
    for i in range(keys.size):
        key = keys[i]
        if key == _SIGN:
            key = np.uint64(0)
        keys[i] = ~key if key & _SIGN else key | _SIGN


@compiled
def _sorted(keys, spare, order, other):
    mask = np.uint64((1 << _BITS) - 1)
    counts = np.zeros((_DIGITS, 1 << _BITS), np.int64)
    for i in range(keys.size):
        key = keys[i]
        for digit in range(_DIGITS):
            counts[digit, (key >> np.uint64(_BITS * digit)) & mask] += 1
    for digit in range(_DIGITS):
        shift, start = np.uint64(_BITS * digit), counts[digit]
        if start.max() == keys.size:  # they do not differ in this one
            continue
        total = 0
        for value in range(start.size):
            start[value], total = total, total + start[value]
        for i in range(keys.size):
            key = keys[i]
            value = (key >> shift) & mask
            place = start[value]
            start[value] = place + 1
            spare[place] = key
            other[place] = order[i]
        keys, spare = spare, keys
        order, other = other, order
    return order


@compiled
def _put(order, ascending, ranked):
    for k in range(order.size):
        ranked[order[k]] = ascending[k]
