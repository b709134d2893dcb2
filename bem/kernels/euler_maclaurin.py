"""Sums of smooth terms as integrals: the Euler-Maclaurin terms of the midpoint rule, from samples, not derivatives."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from bem.grid import FloatArray


def _bernoulli_half(order: int) -> list[Fraction]:
    """Bernoulli polynomials at 1/2: B_n(1/2) = (2^(1-n) - 1) B_n."""
    numbers = [Fraction(1)]
    for n in range(1, order + 1):
        row = Fraction(1)
        total = Fraction(0)
        for k in range(n):
            total += row * numbers[k]
            row = row * (n + 1 - k) / (k + 1)
        numbers.append(-total / (n + 1))
    return [(Fraction(2) / 2**n - 1) * b for n, b in enumerate(numbers)]


def euler_maclaurin(points: int, span: int) -> tuple[FloatArray, FloatArray]:
    """Positive nodes t and weights w: sum of g(k + 1/2), k >= 0, = integral of g from 0 + sum w (g(t) - g(-t)).

    Exact where g is a polynomial of degree below `points`: on t^p the correction is -B_{p+1}(1/2) / (p + 1).
    """
    halves = _bernoulli_half(points + 1)
    angles = (np.arange(points) + 0.5) * np.pi / points
    weights = np.zeros(points)
    previous, current = [Fraction(1)], [Fraction(0), Fraction(1)]
    for n in range(1, points):
        value = sum(c * (-halves[p + 1] / (p + 1)) * Fraction(1, span**p) for p, c in enumerate(current))
        weights += 2.0 / points * float(value) * np.cos(n * angles)
        following = [Fraction(0)] + [2 * c for c in current]
        for p, c in enumerate(previous):
            following[p] -= c
        previous, current = current, following
    half = points // 2
    return (span * np.cos(angles[:half])).copy(), weights[:half].copy()
