"""Relaxation of a linear viscoelastic solid as a Prony series, and its exact creep compliance.

Source: R. M. Christensen, Theory of Viscoelasticity (1982), chapters 1 and 2, for both forms; the original was not read
for this code. Verified in tests/viscoelastic/test_relaxation.py.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from bem.arguments import is_positive
from bem.errors import InputError
from bem.representation import tabled

__all__ = ["Creep", "PronySeries"]

_FLUID = 1e-12
"""Distance of the sum of shares from one, below which the solid relaxes completely and flows."""


@dataclass(frozen=True)
class Creep:
    """Creep compliance over the instantaneous one: J(t) = 1 + sum of amounts (1 - exp(-t / times)) + flow t.

    amounts : positive. times : retardation times [s]. flow : rate of flow [1/s]; zero for a solid.
    """

    amounts: tuple[float, ...]
    times: tuple[float, ...]
    flow: float

    def compliance(self, time: float) -> float:
        """Return J at a time [s] after a step of stress, over the instantaneous compliance."""
        delayed = sum(-c * math.expm1(-time / theta) for c, theta in zip(self.amounts, self.times, strict=True))
        return 1.0 + delayed + self.flow * time

    @property
    def relaxed(self) -> float:
        """Return J at infinite time; infinite for a fluid."""
        return math.inf if self.flow > 0 else 1.0 + sum(self.amounts)


@tabled
@dataclass(frozen=True)
class PronySeries:
    """Relaxation of the modulus: E(t) = E [1 - sum of shares (1 - exp(-t / times))], E the instantaneous modulus.

    One term with a share below one is a Zener solid, one with a share of one a Maxwell fluid. Poisson's ratio is
    constant, so that all moduli relax alike.

    Parameters
    ----------
    shares : parts of the instantaneous modulus that relax, positive; their sum is at most one.
    times : relaxation times [s], positive, as many as shares.

    Raises
    ------
    InputError : one message for each mistake.
    """

    shares: tuple[float, ...]
    times: tuple[float, ...]

    def __init__(self, shares: Sequence[float], times: Sequence[float]) -> None:
        messages = []
        if len(shares) != len(times) or len(shares) == 0:
            messages.append(f"PronySeries: {len(shares)} shares and {len(times)} times; give one or more of each alike")
        messages += [
            f"PronySeries: {name} {value!r} must be positive and finite"
            for name, values in (("share", shares), ("time", times))
            for value in values
            if not is_positive(value)
        ]
        if not messages and sum(shares) > 1 + _FLUID:
            messages.append(f"PronySeries: the sum of shares is {sum(shares):.6g}; it must be at most one")
        if messages:
            raise InputError(messages)
        object.__setattr__(self, "shares", tuple(float(value) for value in shares))
        object.__setattr__(self, "times", tuple(float(value) for value in times))

    @classmethod
    def zener(cls, share: float, time: float) -> PronySeries:
        """Return a solid with one relaxation time [s]."""
        return cls((share,), (time,))

    @classmethod
    def maxwell(cls, time: float) -> PronySeries:
        """Return a fluid with one relaxation time [s]."""
        return cls((1.0,), (time,))

    @property
    def fluid(self) -> bool:
        """Return True if the modulus relaxes to zero."""
        return sum(self.shares) > 1 - _FLUID

    def modulus(self, time: float) -> float:
        """Return E at a time [s] after a step of strain, over the instantaneous modulus."""
        return 1.0 + sum(g * math.expm1(-time / tau) for g, tau in zip(self.shares, self.times, strict=True))

    def complex_modulus(self, frequency: float) -> complex:
        """Return storage and loss modulus at a circular frequency [rad/s], over the instantaneous modulus."""
        return 1.0 - sum(g / (1 + 1j * frequency * tau) for g, tau in zip(self.shares, self.times, strict=True))

    def creep(self) -> Creep:
        """Return the creep compliance, exact to round-off.

        Its retardation rates are the zeros of 1 - sum g_k / (1 - x tau_k), one below each relaxation rate 1 / tau_k and
        above the next lower one; the lowest is zero for a fluid, which then flows.
        """
        merged: dict[float, float] = {}
        for share, time in zip(self.shares, self.times, strict=True):
            merged[time] = merged.get(time, 0.0) + share
        pairs = sorted(merged.items(), reverse=True)  # rising rates
        amounts, times, below = [], [], 0.0
        for number, (tau, _) in enumerate(pairs):
            if number == 0 and self.fluid:
                below = 1 / tau
                continue
            rate = _zero(pairs, below, 1 / tau)
            below = 1 / tau
            slope = sum(g * t / (1 - rate * t) ** 2 for t, g in pairs)
            amounts.append(1 / (rate * slope))
            times.append(1 / rate)
        flow = 1 / sum(g * t for t, g in pairs) if self.fluid else 0.0
        return Creep(tuple(amounts), tuple(times), flow)


def _zero(pairs: Sequence[tuple[float, float]], low: float, high: float) -> float:
    """Return the rate between two relaxation rates at which the modulus vanishes, by bisection to round-off."""
    while True:
        middle = 0.5 * (low + high)
        if not low < middle < high:
            return middle
        if 1 - sum(g / (1 - middle * t) if middle * t != 1 else math.inf for t, g in pairs) > 0:
            low = middle
        else:
            high = middle
