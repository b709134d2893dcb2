"""Multipliers of spectra: transforms of sums of even and odd kernels, stored as a quarter of their values."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import DTypeLike, NDArray

from bem.errors import InputError
from bem.transforms.loops import ONE, WHOLE, Factor

FloatArray = NDArray[Any]
ComplexArray = NDArray[Any]


@dataclass(frozen=True)
class Multiplier:
    """Spectrum `real + i imaginary`; each part is stored on non-negative wavenumbers, with its parity along x.

    Attributes
    ----------
    real, imaginary : (py // 2 + 1, px // 2 + 1), or None for zero.
    real_parity, imaginary_parity : +1 or -1; the part at wavenumber px - k is its parity times the part at k. A real
        part that is neither has `WHOLE` for its parity, all wavenumbers (py // 2 + 1, px), and no imaginary part.
    """

    real: FloatArray | None = None
    imaginary: FloatArray | None = None
    real_parity: int = 1
    imaginary_parity: int = -1

    @property
    def nbytes(self) -> int:
        """Memory of the arrays [bytes]."""
        return sum(part.nbytes for part in (self.real, self.imaginary) if part is not None)

    def factor(self, dtype: np.dtype[Any]) -> Factor:
        """Return the parts in a precision, as arguments of the compiled passes; cached."""
        try:
            return self._factors[dtype.char]
        except KeyError:
            real, imaginary = (
                np.empty((0, 0), dtype) if part is None else np.ascontiguousarray(part, dtype)
                for part in (self.real, self.imaginary)
            )
            found = self._factors[dtype.char] = Factor(
                real,
                imaginary,
                0 if self.real is None else self.real_parity,
                0 if self.imaginary is None else self.imaginary_parity,
            )
            return found

    @cached_property
    def _factors(self) -> dict[str, Factor]:
        return {}

    def astype(self, dtype: DTypeLike) -> Multiplier:
        """Return the multiplier in another precision."""
        real, imaginary = (
            None if part is None else part.astype(dtype, copy=False) for part in (self.real, self.imaginary)
        )
        return Multiplier(real, imaginary, self.real_parity, self.imaginary_parity)


def multiplier(parts: list[tuple[FloatArray, tuple[int, int], float]], length: int | None = None) -> Multiplier:
    """Return the multiplier of a sum of kernels.

    parts : (spectrum from `kernel_spectrum`, parity along x and y, factor) of each kernel.
    length : px, of the transforms along x; only needed for kernels of both parities along x with real spectra.

    Raises
    ------
    InputError : imaginary parts of different parity along x, or real ones without `length` or with imaginary parts.
    """
    real: dict[int, FloatArray] = {}
    imaginary: dict[int, FloatArray] = {}
    for spectrum, (along_x, along_y), factor in parts:
        odd = (along_x == -1) + (along_y == -1)
        sign = -factor if odd == 2 else factor
        term = spectrum if sign == 1 else sign * spectrum  # large: no copy if it can be avoided
        sums = imaginary if odd == 1 else real
        sums[along_x] = sums[along_x] + term if along_x in sums else term
    if len(imaginary) > 1 or (len(real) > 1 and (imaginary or length is None)):
        raise InputError("multiplier: parts of different parity along x cannot share one quarter array")
    if len(real) > 1:
        assert length is not None
        negative = slice((length - 1) // 2, 0, -1)
        whole = np.concatenate([real[1] + real[-1], (real[1] - real[-1])[:, negative]], axis=1)
        return Multiplier(whole, real_parity=WHOLE)
    real_parity, imaginary_parity = next(iter(real), 1), next(iter(imaginary), -1)
    return Multiplier(real.get(real_parity), imaginary.get(imaginary_parity), real_parity, imaginary_parity)


def unit_factor(dtype: np.dtype[Any]) -> Factor:
    """Return the multiplier that is one everywhere."""
    nothing = np.empty((0, 0), dtype)
    return Factor(nothing, nothing, ONE, 0)
