"""Transforms that are kept with their plans and buffers, within a bound on memory."""

from __future__ import annotations

import math
import threading
from collections import OrderedDict
from typing import Any

import numpy as np
from numpy.typing import DTypeLike

from bem.errors import InputError
from bem.transforms.padded import COMPLEX, PaddedTransform


class _TransformCache:
    """Transforms by shape, least recently used dropped first when their buffers exceed a limit."""

    def __init__(self, limit: int) -> None:
        self.limit = limit
        self.kept: OrderedDict[tuple[Any, ...], PaddedTransform] = OrderedDict()
        self.lock = threading.Lock()

    def get(self, shape: tuple[int, int], padded: tuple[int, int], dtype: np.dtype[Any]) -> PaddedTransform:
        key = (shape, padded, dtype.char)
        with self.lock:
            transform = self.kept.get(key)
            if transform is None:
                transform = self.kept[key] = PaddedTransform(shape, padded, dtype)
            self.kept.move_to_end(key)
            self.trim()
            return transform

    def trim(self) -> None:
        while len(self.kept) > 1:
            held = 0
            for transform in self.kept.values():
                held += transform.nbytes
            if held <= self.limit:
                return
            self.kept.popitem(last=False)


_CACHE = _TransformCache(1 << 29)


def transform_of(shape: tuple[int, int], padded: tuple[int, int], dtype: DTypeLike = np.float64) -> PaddedTransform:
    """The cached transform of fields of `shape` padded to `padded`, in float64 or float32.

    Raises
    ------
    InputError : a precision that is neither, or a padded length shorter than the field.
    """
    kind = np.dtype(dtype)
    if kind not in COMPLEX:
        raise InputError(f"transform_of: dtype {kind} must be float64 or float32")
    if min(shape) < 1 or padded[0] < shape[0] or padded[1] < shape[1]:
        raise InputError(f"transform_of: padded lengths {padded!r} must not be below the field's shape {shape!r} >= 1")
    return _CACHE.get((int(shape[0]), int(shape[1])), (int(padded[0]), int(padded[1])), kind)


def set_transform_memory(limit: int) -> None:
    """Bound the memory that cached plans and buffers may hold between uses [bytes]; default 512 MiB."""
    if not (math.isfinite(limit) and limit >= 0):
        raise InputError(f"set_transform_memory: limit {limit!r} must be a number of bytes >= 0")
    with _CACHE.lock:
        _CACHE.limit = int(limit)
        _CACHE.trim()


def transform_memory() -> int:
    """Memory held by cached plans and buffers [bytes]."""
    return sum(t.nbytes for t in _CACHE.kept.values())
