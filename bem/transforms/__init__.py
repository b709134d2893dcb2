"""Convolutions by real transforms of zero-padded fields: pruned, in one or two precisions.

A two-dimensional real transform is two passes of one-dimensional transforms. A convolution takes these steps:

1. `kernel` chooses the padded lengths and computes the spectrum of a kernel that is even or odd along each axis, from a
   quarter of its values; `products` adds kernels to one `Multiplier`. Cost: once per kernel, cached by its owners.
2. `cache` returns the `PaddedTransform` of a shape, with its plans and buffers.
3. Forward along y: only the rows that are not known to be zero are transformed, real to complex, and written transposed
   to the array of row spectra, so that columns are contiguous (`loops.rows_forward`).
4. Along x: columns are transformed, multiplied and transformed back in blocks that stay in cache
   (`loops.columns_through`). For an even kernel the real rows are packed as complex rows of half the length, and
   columns go in pairs (`packed_real_fft`): FFTW has vector instructions for complex rows only. Cost: 0.7 of real rows
   in single precision, 0.8 to 0.9 in double.
5. Back along y: only the wanted rows (`loops.rows_back`).

A convolution is one call of compiled code on one thread; threads share the blocks of each pass, never one transform.
`plans` makes FFTW's plans without timing, so a result does not depend on the load of the machine; the transposed layout
with row lengths off the powers of two makes up for the slower plans. `count` counts transforms.

Layout of a spectrum: `spectrum[iy, ix]`, shape (py // 2 + 1, px), wavenumbers of `numpy.fft.rfft2(...).T`. The forward
transform has no factor, the inverse one 1/(px py): `inverse(forward(field)) == field`.

The package knows arrays and threads; no grid, no body, no contact. Verified in tests/test_transforms.py against numpy's
and scipy's transforms.
"""

from bem.transforms.cache import set_transform_memory, transform_memory, transform_of
from bem.transforms.count import COUNT, TransformCount
from bem.transforms.kernel import kernel_spectrum, narrowed_lengths, offset_cosines, padded_length, padded_shape
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
