"""Cache of transforms with their plans and buffers, within a bound on memory."""

from __future__ import annotations

import numpy as np
from numpy.typing import DTypeLike

from bem.errors import InputError
from bem.numerics.cache import KeptValues, bytes_of, keep_freed_memory
from bem.transforms.padded import COMPLEX, PaddedTransform

_CACHE = KeptValues(least=1)


def transform_of(
    shape: tuple[int, int],
    padded: tuple[int, int],
    dtype: DTypeLike = np.float64,
    lengths: tuple[int, ...] | None = None,
    worker: int = 0,
) -> PaddedTransform:
    """Return the transform of fields of `shape` padded to `padded`, in float64 or float32, from the cache.

    lengths : (py // 2 + 1,), of the transforms along x for each wavenumber along y; px for all by default.
    worker : number of the thread that uses it, if several threads transform at a time; each has its own buffers.

    Raises
    ------
    InputError : a precision that is neither, or a padded length shorter than the field.
    """
    kind = np.dtype(dtype)
    if kind not in COMPLEX:
        raise InputError(f"transform_of: dtype {kind} must be float64 or float32")
    if min(shape) < 1 or padded[0] < shape[0] or padded[1] < shape[1]:
        raise InputError(f"transform_of: padded lengths {padded!r} must not be below the field's shape {shape!r} >= 1")
    waves = padded[1] // 2 + 1
    if lengths is not None and not (len(lengths) == waves and shape[0] <= min(lengths) <= max(lengths) <= padded[0]):
        raise InputError(f"transform_of: lengths {lengths!r} must be {waves}, from {shape[0]} to {padded[0]}")
    shapes = (int(shape[0]), int(shape[1])), (int(padded[0]), int(padded[1]))
    found = _CACHE.of((*shapes, lengths, worker), lambda: _create(*shapes, lengths))
    return found if kind == np.float64 else found.single


def _create(shape: tuple[int, int], padded: tuple[int, int], lengths: tuple[int, ...] | None) -> PaddedTransform:
    """Return a new transform in double precision; its `single` is the one in single precision."""
    keep_freed_memory()  # solvers allocate fields of the same size again and again
    return PaddedTransform(shape, padded, np.float64, lengths)


def set_transform_memory(limit: int) -> None:
    """Bound the memory that cached plans and buffers may hold between uses [bytes]; default 512 MiB.

    Raises
    ------
    InputError : not a number of bytes.
    """
    _CACHE.resize(bytes_of("set_transform_memory", limit))


def transform_memory() -> int:
    """Return the memory held by cached plans and buffers [bytes]."""
    return _CACHE.nbytes
