"""Cache with a bound on memory and eviction of the least recently used values.

Knows of a value only its size. Verified in tests/test_convolution.py, tests/test_transforms.py and
tests/frugality/test_allocations.py.
"""

from __future__ import annotations

import math
from collections import OrderedDict
from collections.abc import Callable, Hashable
from typing import Any, Protocol, TypeVar, cast

import numpy as np

from bem.errors import InputError
from bem.threads import ForkSafeLock

DEFAULT_LIMIT = 1 << 29
"""Default bound on the memory of a cache [bytes]."""


class Sized(Protocol):
    """A value that can be cached."""

    @property
    def nbytes(self) -> int:
        """Memory [bytes]."""


_Value = TypeVar("_Value", bound=Sized)


class KeptValues:
    """Cache of values by key.

    Parameters
    ----------
    limit : bound on the memory [bytes].
    least : number of values that stay however large they are.
    """

    def __init__(self, limit: int = DEFAULT_LIMIT, *, least: int = 0) -> None:
        self.limit = limit
        self.least = least
        self.kept: OrderedDict[Hashable, Any] = OrderedDict()
        self.lock = ForkSafeLock()

    def of(self, key: Hashable, make: Callable[[], _Value]) -> _Value:
        """Return the value of a key, made if it is missing; two threads that make it both get the first one."""
        with self.lock:
            if key in self.kept:
                self.kept.move_to_end(key)
                found: _Value = self.kept[key]
                return found
        made = make()
        if self.least == 0 and made.nbytes > self.limit:  # it would evict all others and itself
            return made
        with self.lock:
            value = self.kept.setdefault(key, made)
            self.kept.move_to_end(key)
            self._trim()
        return cast("_Value", value)

    @property
    def nbytes(self) -> int:
        """Memory held [bytes]."""
        return sum([value.nbytes for value in self.kept.values()])

    def resize(self, limit: int) -> None:
        """Set the limit [bytes] and evict what exceeds it."""
        with self.lock:
            self.limit = limit
            self._trim()

    def clear(self) -> None:
        """Evict all values."""
        with self.lock:
            self.kept.clear()

    def _trim(self) -> None:
        while len(self.kept) > self.least and self.nbytes > self.limit:
            self.kept.popitem(last=False)


_FREED = 31 << 20
"""Size of an array that raises glibc's thresholds when it is freed [bytes]; glibc ignores arrays from 32 MiB on."""


def keep_freed_memory() -> None:
    """Raise glibc's mmap and trim thresholds so that freed arrays up to 62 MiB are reused.

    Otherwise each solve in a loop may get its arrays from the system anew, page by page: up to a tenth of the time of a
    contact of 256 x 256 cells. glibc raises the thresholds to the largest array that it has seen freed; no page of the
    array made here is touched.
    """
    np.empty(_FREED, np.uint8)


def bytes_of(name: str, limit: object) -> int:
    """Check a limit in bytes that a user gives to the function `name`.

    Raises
    ------
    InputError : not a number of bytes.
    """
    if not (isinstance(limit, int | float) and math.isfinite(limit) and limit >= 0):
        raise InputError(f"{name}: limit {limit!r} must be a number of bytes >= 0")
    return int(limit)
