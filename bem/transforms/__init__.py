"""Real transforms of padded fields: pruned, in one or two precisions, the same bits in every process.

A two-dimensional real transform is two passes of one-dimensional ones. Along y the rows that are not known to be zero
are transformed (real to complex) and written transposed; along x the columns, now contiguous, are transformed in blocks
that stay in cache, where they are also multiplied and transformed back. On the way out only the wanted rows are made.

Layout of a spectrum: `spectrum[iy, ix]`, shape (py // 2 + 1, px), wavenumbers of `numpy.fft.rfft2(...).T`. The forward
transform has no factor, the inverse one 1/(px py): `inverse(forward(field)) == field`.

Plans are made without timing (FFTW_ESTIMATE), so a result does not depend on the mood of the machine; the transposed
layout with row lengths off the powers of two makes up for it (measured against FFTW_MEASURE in two dimensions, one
thread: equal to 10 % faster from 512 to 4096 cells a side). Convolutions with even kernels take real rows as complex
ones half as long (`pairs`). Blocks are split over threads, never inside a transform.

Knows arrays and threads; no grid, no body, no contact. `kernel` makes spectra of kernels, `narrow` shortens those of
short waves, `products` sums and applies them, `padded` does the passes, `cache` keeps plans, `count` counts. Verified
in tests/test_transforms.py against numpy's and scipy's transforms.
"""

from bem.transforms.cache import set_transform_memory, transform_memory, transform_of
from bem.transforms.count import COUNT, TransformCount
from bem.transforms.kernel import kernel_spectrum, offset_cosines, padded_length, padded_shape
from bem.transforms.narrow import narrowed_lengths
from bem.transforms.padded import PaddedTransform
from bem.transforms.products import Multiplier, multiplier

__all__ = [
    "COUNT",
    "Multiplier",
    "PaddedTransform",
    "TransformCount",
    "kernel_spectrum",
    "multiplier",
    "narrowed_lengths",
    "offset_cosines",
    "padded_length",
    "padded_shape",
    "set_transform_memory",
    "transform_memory",
    "transform_of",
]
