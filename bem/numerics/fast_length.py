"""Lengths at which a real fast Fourier transform is fast. Verified in tests/numerics/test_fast_length.py."""

from __future__ import annotations


def fast_length(length: int) -> int:
    """Smallest integer from `length` on without prime factors above 5."""
    while not _is_smooth(length):
        length += 1
    return length


def _is_smooth(number: int) -> bool:
    for prime in (2, 3, 5):
        while number % prime == 0:
            number //= prime
    return number == 1
