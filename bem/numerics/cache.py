"""A bounded cache: values by key, evicted by last use when their memory exceeds a limit.

Two rules of eviction serve two patterns of use. Without a sweep number the least recently used value is evicted (LRU).
Values that are asked for in repeated sweeps carry the number of the sweep: entries that the last two sweeps did not use
are evicted, and a new value is stored only if it fits. LRU would fail there: in a sweep slightly larger than the cache
it evicts each value just before its next use.

Knows nothing of the values but their size. Verified in tests/test_convolution.py, tests/test_transforms.py,
tests/test_stress.py and tests/frugality/test_allocations.py.
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
    """Bounded cache of values by key.

    limit : memory that the values may take [bytes].
    least : number of values that stay however large they are.
    """

    def __init__(self, limit: int = DEFAULT_LIMIT, *, least: int = 0) -> None:
        self.limit = limit
        self.least = least
        self.kept: OrderedDict[Hashable, Any] = OrderedDict()
        """Values in the order of their last use."""
        self.lock = ForkSafeLock()
        self._sweeps: dict[Hashable, int] = {}
        """Number of the sweep that used a value last; none for values without a sweep."""
        self._latest_sweep = 0

    def begin_sweep(self) -> int:
        """Return the number of a new sweep."""
        with self.lock:
            self._latest_sweep += 1
            return self._latest_sweep

    def of(self, key: Hashable, make: Callable[[], _Value], sweep: int | None = None) -> _Value:
        """Return the value of a key, made where there is none; of two threads that make one, both get the first.

        sweep : number from `begin_sweep`, for values of repeated sweeps.
        """
        with self.lock:
            if key in self.kept:
                self._use(key, sweep)
                found: _Value = self.kept[key]
                return found
        made = make()
        if self.least == 0 and made.nbytes > self.limit:  # it would evict all others and itself
            return made
        with self.lock:
            if sweep is not None and key not in self.kept:
                self._evict(self.limit - made.nbytes, older_than=sweep - 1)
                if self.nbytes + made.nbytes > self.limit:
                    return made
            value = self.kept.setdefault(key, made)
            self._use(key, sweep)
            if sweep is None:
                self._evict(self.limit)
        return cast("_Value", value)

    @property
    def nbytes(self) -> int:
        """Memory held [bytes]."""
        return sum([value.nbytes for value in self.kept.values()])

    def resize(self, limit: int) -> None:
        """Set another limit [bytes]."""
        with self.lock:
            self.limit = limit
            self._evict(limit)

    def clear(self) -> None:
        """Evict all values."""
        with self.lock:
            self.kept.clear()
            self._sweeps.clear()

    def _use(self, key: Hashable, sweep: int | None) -> None:
        self.kept.move_to_end(key)
        if sweep is not None:
            self._sweeps[key] = sweep

    def _evict(self, target: int, older_than: int | None = None) -> None:
        """Evict the least recently used values until `target` bytes are held; with `older_than` stop at the first value
        that this or a later sweep used."""
        while len(self.kept) > self.least and self.nbytes > target:
            oldest = next(iter(self.kept))
            if older_than is not None and self._sweeps.get(oldest, 0) >= older_than:
                return
            del self.kept[oldest]
            self._sweeps.pop(oldest, None)


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
