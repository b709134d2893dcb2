"""Spectra that others are multiplied by: sums of kernels, stored as a quarter, applied block by block."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from numba import njit
from numpy.typing import DTypeLike, NDArray

from bem.errors import InputError

FloatArray = NDArray[Any]
ComplexArray = NDArray[Any]


@dataclass(frozen=True)
class Multiplier:
    """A spectrum `real + i imaginary`, each part given on non-negative wavenumbers with its parity along x.

    `real`, `imaginary` : (py // 2 + 1, px // 2 + 1) or None for zero. At px - k the part is its parity times that at k.
    """

    real: FloatArray | None = None
    imaginary: FloatArray | None = None
    real_parity: int = 1
    imaginary_parity: int = -1

    @property
    def nbytes(self) -> int:
        """Memory of the arrays."""
        return sum(part.nbytes for part in (self.real, self.imaginary) if part is not None)

    def astype(self, dtype: DTypeLike) -> Multiplier:
        """The same in another precision."""
        real, imaginary = (
            None if part is None else part.astype(dtype, copy=False) for part in (self.real, self.imaginary)
        )
        return Multiplier(real, imaginary, self.real_parity, self.imaginary_parity)


def multiplier(parts: list[tuple[FloatArray, tuple[int, int], float]]) -> Multiplier:
    """Sum of kernels `(spectrum from kernel_spectrum, parity, factor)` as one multiplier.

    Raises
    ------
    InputError : two real or two imaginary parts of different parity along x.
    """
    real: FloatArray | None = None
    imaginary: FloatArray | None = None
    parities = [1, -1]
    for spectrum, (along_x, along_y), factor in parts:
        odd = (along_x == -1) + (along_y == -1)
        term = (-factor if odd == 2 else factor) * spectrum
        previous = imaginary if odd == 1 else real
        if previous is not None and parities[odd % 2] != along_x:
            raise InputError("multiplier: parts of different parity along x cannot share one quarter array")
        parities[odd % 2] = along_x
        total = term if previous is None else previous + term
        if odd == 1:
            imaginary = total
        else:
            real = total
    return Multiplier(real, imaginary, parities[0], parities[1])


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")  # type: ignore[untyped-decorator]
def _multiply_real(source, target, real, parity, scale, half):  # type: ignore[no-untyped-def]
    rows, length = source.shape
    for i in range(rows):
        for j in range(half):
            target[i, j] = source[i, j] * (real[i, j] * scale)
        if parity > 0:
            for j in range(half, length):
                target[i, j] = source[i, j] * (real[i, length - j] * scale)
        else:
            for j in range(half, length):
                target[i, j] = source[i, j] * (-real[i, length - j] * scale)


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")  # type: ignore[untyped-decorator]
def _multiply_imaginary(source, target, imaginary, parity, scale, half):  # type: ignore[no-untyped-def]
    rows, length = source.shape
    for i in range(rows):
        for j in range(half):
            a = imaginary[i, j] * scale
            z = source[i, j]
            target[i, j] = complex(-a * z.imag, a * z.real)
        for j in range(half, length):
            a = imaginary[i, length - j] * scale
            if parity < 0:
                a = -a
            z = source[i, j]
            target[i, j] = complex(-a * z.imag, a * z.real)


@njit(cache=True, nogil=True, fastmath={"contract"}, error_model="numpy")  # type: ignore[untyped-decorator]
def _multiply_complex(source, target, real, imaginary, parity_real, parity_imaginary, scale, half):  # type: ignore[no-untyped-def]
    rows, length = source.shape
    mirrored_real = scale if parity_real > 0 else -scale
    mirrored_imaginary = scale if parity_imaginary > 0 else -scale
    for i in range(rows):
        for j in range(half):
            a = real[i, j] * scale
            b = imaginary[i, j] * scale
            z = source[i, j]
            target[i, j] = complex(a * z.real - b * z.imag, a * z.imag + b * z.real)
        for j in range(half, length):
            a = real[i, length - j] * mirrored_real
            b = imaginary[i, length - j] * mirrored_imaginary
            z = source[i, j]
            target[i, j] = complex(a * z.real - b * z.imag, a * z.imag + b * z.real)


def multiply(source: ComplexArray, target: ComplexArray, factor: Multiplier, scale: Any, start: int, stop: int) -> None:
    """Rows `start` to `stop` of a spectrum, `source`, times the factor and `scale`, into `target`."""
    half = source.shape[1] // 2 + 1
    real = None if factor.real is None else factor.real[start:stop]
    imaginary = None if factor.imaginary is None else factor.imaginary[start:stop]
    if real is None and imaginary is None:
        target[...] = 0
    elif imaginary is None:
        _multiply_real(source, target, real, factor.real_parity, scale, half)
    elif real is None:
        _multiply_imaginary(source, target, imaginary, factor.imaginary_parity, scale, half)
    else:
        _multiply_complex(source, target, real, imaginary, factor.real_parity, factor.imaginary_parity, scale, half)
