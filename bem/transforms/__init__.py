"""Convolutions by real fast Fourier transforms of zero-padded fields, in double or single precision.

A field (nx, ny) is padded to (px, py). A two-dimensional real transform is a pass of one-dimensional transforms of rows
along y and a pass of columns along x. The passes are pruned: they leave out rows and columns that are zero or not
needed. A convolution takes these steps:

1. `padding` chooses the padded lengths: at least 2 n - 1 on a free axis, n on a periodic one.
2. `kernel_spectra` computes the real spectrum of a kernel that is even or odd along each axis, from a quarter of its
   values. `multipliers` adds kernels to one `Multiplier`. Cost: one transform for each kernel; the caller caches it.
3. `cache` returns the `PaddedTransform` of a shape (`padded`), with its plans (`plans`) and buffers.
4. Rows forward (`loops.rows_forward`): the nx rows of the field, not the px - nx rows of padding, are transformed along
   y in blocks, and written transposed to the array of row spectra, so that columns are contiguous. For a field on a few
   cells (`loops.rows_forward_of_cells`), blocks of rows without a cell are left out.
5. Columns (`loops.columns_through`): the py // 2 + 1 columns (py // 2 where rows are packed) are padded, transformed
   along x, multiplied, and transformed back, in blocks that stay in cache. The padded spectrum as a whole is not
   stored.
6. Rows back (`loops.rows_back`): the nx rows of the field are transformed back along y, and cut to ny.

Cost of a convolution: 2 nx transforms of length py between real rows and their half-complex spectra, and two complex
ones of length px for each of the py // 2 + 1 columns, n log n each. An even kernel needs less if py is even
(`packed_real_fft`): real rows are packed as complex rows of half the length, so that there are py // 2 columns, and
columns k and py // 2 - k go in pairs in step 5, because FFTW has vector instructions for complex rows only.

`addresses` has pointers for these loops. A convolution is one call of compiled code on one thread; several threads
share the blocks of each pass, so a result does not depend on their number. `plans` creates FFTW's plans without timing,
so a result does not depend on the load of the machine. `count` counts transforms.

Layout of a spectrum: `spectrum[iy, ix]`, shape (py // 2 + 1, px), wavenumbers of `numpy.fft.rfft2(...).T`. The forward
transform has no factor, the inverse one 1/(px py): `inverse(forward(field)) == field`.

The package knows arrays and threads; no grid, no body, no contact. Verified in tests/test_transforms.py against numpy's
and scipy's transforms.
"""

from bem.transforms.cache import set_transform_memory, transform_memory, transform_of
from bem.transforms.count import COUNT, TransformCount
from bem.transforms.kernel_spectra import half_spectrum, kernel_spectrum, offset_cosines
from bem.transforms.multipliers import Multiplier, multiplier
from bem.transforms.padded import PaddedTransform
from bem.transforms.padding import narrowed_lengths, padded_length, padded_shape

__all__ = [
    "COUNT",
    "Multiplier",
    "PaddedTransform",
    "TransformCount",
    "half_spectrum",
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
