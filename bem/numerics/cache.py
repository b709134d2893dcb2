"""Values that are kept between uses, within a bound on memory; the least recently used give way first.

Knows nothing of what is kept but its size. Verified in tests/test_convolution.py, tests/test_transforms.py and
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
"""Bytes that a store may hold where nobody says otherwise."""


class Sized(Protocol):
    """What can be kept."""

    @property
    def nbytes(self) -> int:
        """Memory [bytes]."""


_Value = TypeVar("_Value", bound=Sized)


class KeptValues:
    """Values by what decides them; `least` of them stay however large they are."""

    def __init__(self, limit: int = DEFAULT_LIMIT, *, least: int = 0) -> None:
        self.limit = limit
        self.least = least
        self.kept: OrderedDict[Hashable, Any] = OrderedDict()
        self.lock = ForkSafeLock()

    def of(self, key: Hashable, make: Callable[[], _Value]) -> _Value:
        """The value of a key, made where there is none; of two threads that make one, both get the first."""
        with self.lock:
            if key in self.kept:
                self.kept.move_to_end(key)
                found: _Value = self.kept[key]
                return found
        made = make()
        if self.least == 0 and made.nbytes > self.limit:  # it would drive out all others and go itself
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
        """Another limit [bytes]."""
        with self.lock:
            self.limit = limit
            self._trim()

    def clear(self) -> None:
        """Keep nothing of what there is."""
        with self.lock:
            self.kept.clear()

    def _trim(self) -> None:
        while len(self.kept) > self.least and self.nbytes > self.limit:
            self.kept.popitem(last=False)


_FREED = 31 << 20
"""Bytes of one array, freed at once, after which the C library keeps twice as much of what is freed; it heeds none of
32 MiB and above."""


def keep_freed_memory() -> None:
    """Let what is freed stay with the process for the next of its kind, up to 62 MiB.

    Else whether each solve of a loop fetches its fields from the system anew, page by page, hangs on what happens to
    lie behind them: contacts of 256 x 256 cells met with none or 556 page faults, a tenth of their time. The C library
    (glibc) sets this by the largest array that it saw freed, so one is made, of which no page is touched.
    """
    np.empty(_FREED, np.uint8)


def bytes_of(name: str, limit: object) -> int:
    """A limit in bytes that a user gives to the function `name`.

    Raises
    ------
    InputError : not a number of bytes.
    """
    if not (isinstance(limit, int | float) and math.isfinite(limit) and limit >= 0):
        raise InputError(f"{name}: limit {limit!r} must be a number of bytes >= 0")
    return int(limit)
