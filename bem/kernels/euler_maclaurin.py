"""Euler-Maclaurin summation with the midpoint rule, with samples of the summand in place of its derivatives."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from bem.grid import FloatArray


def _bernoulli_half(order: int) -> list[Fraction]:
    """Return the Bernoulli polynomials at 1/2 up to an order: B_n(1/2) = (2^(1-n) - 1) B_n."""
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
    """Return the positive nodes t and weights w of the end correction of the midpoint rule.

    The sum of g(k + 1/2) over k >= 0 is the integral of g from 0 plus the sum of w (g(t) - g(-t)). It is exact if g is
    a polynomial of degree below `points`: for t^p the correction is -B_{p+1}(1/2) / (p + 1).

    points : number of Chebyshev nodes on (-span, span), an even number.
    span : half width of the interval of the nodes, in terms of the sum.
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
