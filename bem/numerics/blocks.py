"""Sums and means of large fields block by block, without a second field in memory, and blocks of rows.

Knows only arrays. Verified in tests/numerics/test_blocks.py.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

BLOCK = 1 << 18
"""Entries of a block: 2 MB in double precision, so that the cost of a call is negligible."""
_ALIGNED = 8
"""numpy's pairwise summation halves an array at a multiple of this number of entries."""


def total(field: FloatArray, of: Callable[[FloatArray], FloatArray] | None = None) -> float:
    """Return the sum of a field, or of a function of its entries, by pairwise summation.

    The bits are those of `of(field).sum()` for a contiguous field (Higham, SIAM J. Sci. Comput. 14 (1993) 783).
    """
    return _part(field.reshape(-1), of)


def _part(flat: FloatArray, of: Callable[[FloatArray], FloatArray] | None) -> float:
    if flat.size <= BLOCK:
        return float(np.add.reduce(flat if of is None else of(flat)))
    half = flat.size // 2 - flat.size // 2 % _ALIGNED
    return _part(flat[:half], of) + _part(flat[half:], of)


def mean(field: FloatArray, of: Callable[[FloatArray], FloatArray] | None = None) -> float:
    """Return the mean of a field, or of a function of its entries; see `total`."""
    return total(field, of) / field.size


def deviation(field: FloatArray) -> float:
    """Return the standard deviation of a field, with the bits of `field.std()`."""
    middle = mean(field)
    return math.sqrt(mean(field, lambda block: np.square(block - middle)))


def row_blocks(shape: tuple[int, ...], least: int = 1) -> Iterator[tuple[int, int]]:
    """Yield the first and last row (exclusive) of blocks of about `BLOCK` entries and at least `least` rows."""
    rows = max(least, BLOCK // max(1, math.prod(shape[1:])))
    for first in range(0, shape[0], rows):
        yield first, min(shape[0], first + rows)


def around(field: NDArray[Any], axis: int, first: int, last: int, reach: int) -> NDArray[Any]:
    """Return a copy of the rows from `first` to before `last` with `reach` periodic neighbours along `axis`, which
    becomes the first axis."""
    if axis == 0:
        return field[np.arange(first - reach, last + reach) % field.shape[0]]
    columns = np.arange(-reach, field.shape[1] + reach) % field.shape[1]
    return np.moveaxis(field[first:last][:, columns], 1, 0)
