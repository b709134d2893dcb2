"""Spectra in six bytes a number: whole multiples of a step of each row, so that a deep stack fits in less memory.

The step is the power of two that leaves 48 bits to the row's largest number: what is lost is at most 2^-47 = 7e-15 of
it, different from number to number, so that a stress computed from them differs by some 1e-15 of the largest pressure,
as the transforms themselves do. Zeros stay zeros, and a spectrum that was packed once comes back the same every time.

What it buys (the benchmark's row `stress` counts it, `spectra_MB` for `unpacked_MB`) on 256 x 256 free cells: 2.39 MB
a depth for 3.17 without traction, 4.38 for 6.34 with it (4.78 where a body is coated). 122 depths with traction fit
into the default 512 MiB instead of 84, so that a repeated sweep through 100 computes no spectrum anew instead of 16 and
takes 0.6 times as long; the first one takes half as long again. Six stresses at 64 depths stay within 0.5 GB with all
they need (tests/frugality/test_allocations.py). It does not save traffic: a number is read in six bytes and written and
read once more in eight, 22 bytes instead of 8 beside the 50 or so that its inverse transform moves. Line contacts of up
to 360 cells across, as in the built-in scenes, are too small to be packed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from bem.compiled import compiled
from bem.grid import FloatArray

_BITS = 47  # and a sign


@dataclass(frozen=True, eq=False)
class Packed:
    """Numbers (rows, columns) as `step (65536 high + low)`, with a step for each row."""

    high: NDArray[np.int32]
    low: NDArray[np.uint16]
    step: FloatArray

    @property
    def nbytes(self) -> int:
        """Memory of the arrays."""
        return self.high.nbytes + self.low.nbytes + self.step.nbytes

    def unpack(self, out: FloatArray) -> FloatArray:
        """Write the numbers into `out` (rows, columns)."""
        _unpack(self.high, self.low, self.step, out)
        return out


def pack(values: FloatArray) -> Packed:
    """Numbers (rows, columns), all finite, in six bytes each."""
    largest = np.abs(values).max(axis=1)
    # ldexp cannot make a step below the smallest number: rows of denormals become zeros
    step = np.ldexp(1.0, np.maximum(np.frexp(largest)[1] - _BITS, -1022))
    packed = Packed(np.empty(values.shape, np.int32), np.empty(values.shape, np.uint16), step)
    _pack(values, packed.high, packed.low, step)
    return packed


@compiled
def _pack(values, high, low, step):
    top = 2.0**_BITS - 1.0
    for i in range(values.shape[0]):
        for j in range(values.shape[1]):
            whole = min(np.rint(values[i, j] / step[i]), top)
            upper = np.floor(whole / 65536.0)
            high[i, j] = np.int32(upper)
            low[i, j] = np.uint16(whole - 65536.0 * upper)


@compiled
def _unpack(high, low, step, out):
    for i in range(out.shape[0]):
        for j in range(out.shape[1]):
            out[i, j] = (65536.0 * high[i, j] + low[i, j]) * step[i]
