"""Rolling cylinders with friction that falls with the slip speed, by Fourier series: a method apart from the solver's.

Like cylinders roll along +x; the traction q is on the first body, in plane strain. On x = a cos(theta) the series
q = sum b_n sin(n theta) strains the surfaces by u' = -2/E* sum b_n cos(n theta) (a Hilbert transform; Johnson, *Contact
Mechanics* (1985), section 2.7), and the slip over the rolling velocity is creepage - u'.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FloatArray = NDArray[np.float64]

_RELAXATION = 0.5
"""Part of the new bound that an iteration takes over."""

_ITERATIONS = 5000
"""Limit of the iterations for the bound."""

_EXACT = 1e-10
"""Relative change of the bound at which the iteration ends."""


@dataclass(frozen=True)
class FallingRollingCylinder:
    """Steady rolling of like cylinders whose friction coefficient depends on the slip.

    The traction is the bound g = coefficient x pressure less a traction q* on the zone that sticks, [c, a] next to
    where material enters (Carter's superposition). For a given zone both are series, and the creepage is the constant
    that they leave. Only the bound is iterated, because it depends on the slip behind the zone.

    half_width : a [m]. peak_pressure : of Hertz [Pa]. contact_modulus : E* [Pa]. coefficient : friction coefficient
    (n,) at a slip over the rolling velocity (n,). terms : number of terms, and of points.
    """

    half_width: float
    peak_pressure: float
    contact_modulus: float
    coefficient: Callable[[FloatArray], FloatArray]
    terms: int = 1000

    def rolling(self, stick_fraction: float) -> tuple[float, float]:
        """Return creepage and force over load if this fraction of the contact sticks, between 0 and 1.

        The force is along +x, and the creepage negative.

        Raises
        ------
        ArithmeticError : the iteration for the bound does not converge.
        """
        theta, sines, cosines = self._series()
        middle, half = 1 - stick_fraction, stick_fraction
        inner = np.clip(middle + half * np.cos(theta), -1.0, 1.0)
        inner_cosines = np.cos(np.outer(np.arccos(inner), np.arange(1, self.terms)))
        place = (np.cos(theta) - middle) / half
        slips = place < -1
        outside = np.ones(self.terms)
        outside[slips] = place[slips] + np.sqrt(place[slips] ** 2 - 1)
        powers = np.where(slips[:, None], outside[:, None] ** np.arange(1, self.terms), 0.0)

        def slip_of(bound: FloatArray) -> tuple[FloatArray, float, FloatArray]:
            series = self._sine_terms(bound, sines)
            strain = inner_cosines @ series
            creepage = -2 / self.contact_modulus * float(strain.mean())
            less = 2 / self.terms * (cosines.T @ strain)
            slip = creepage + 2 / self.contact_modulus * (cosines @ series - powers @ less)
            return np.where(slips, slip, 0.0), creepage, less

        bound = self._bound(lambda bound: slip_of(bound)[0], theta)
        _, creepage, less = slip_of(bound)
        # the integral of sin(n theta) sin(theta) over the contact is pi/2 for n = 1, else zero
        force = 0.5 * math.pi * self.half_width * (float(self._sine_terms(bound, sines)[0]) - half * float(less[0]))
        return creepage, force / (0.5 * math.pi * self.half_width * self.peak_pressure)

    def sliding(self, creepage: float) -> float:
        """Return force over load at a creepage (negative) at which all of the contact slips."""
        theta, sines, cosines = self._series()

        def slip_of(bound: FloatArray) -> FloatArray:
            return np.asarray(creepage + 2 / self.contact_modulus * (cosines @ self._sine_terms(bound, sines)))

        bound = self._bound(slip_of, theta)
        return float(self._sine_terms(bound, sines)[0]) / self.peak_pressure

    def _series(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return points (n,), and sines and cosines (n, n - 1) of the terms there."""
        theta = (np.arange(self.terms) + 0.5) * math.pi / self.terms
        angles = np.outer(theta, np.arange(1, self.terms))
        return theta, np.sin(angles), np.cos(angles)

    def _sine_terms(self, values: FloatArray, sines: FloatArray) -> FloatArray:
        return np.asarray(2 / self.terms * (sines.T @ values))

    def _bound(self, slip_of: Callable[[FloatArray], FloatArray], theta: FloatArray) -> FloatArray:
        """Return the bound (n,) [Pa] that belongs to its own slip."""
        pressure = self.peak_pressure * np.sin(theta)
        bound = self.coefficient(np.zeros_like(theta)) * pressure
        for _ in range(_ITERATIONS):
            change = self.coefficient(np.abs(slip_of(bound))) * pressure - bound
            bound = bound + _RELAXATION * change
            if float(np.abs(change).max()) <= _EXACT * float(bound.max()):
                return bound
        raise ArithmeticError("the bound of friction that falls with the slip does not converge")


@dataclass(frozen=True)
class TransientRollingCylinder:
    """Like cylinders pushed by a force below friction x load that then roll under the same force.

    The way from Cattaneo's traction to Carter's, as Kalker computed it first (J. Appl. Mech. 38 (1971) 875, whose text
    was not read). The traction is a series; the slip is formed at points by steps of the distance rolled, which do
    not depend on the points. In each step the points stick or slip by an active set.

    half_width : a [m]. peak_pressure : of Hertz [Pa]. contact_modulus : E* [Pa]. friction : coefficient. share : force
    over friction x load. terms : number of terms, and of points.
    """

    half_width: float
    peak_pressure: float
    contact_modulus: float
    friction: float
    share: float
    terms: int = 80

    def creepage(self, distance: float, steps: int) -> FloatArray:
        """Return the creepage in each of `steps` equal steps over a distance [m], (steps,); the force is along +x.

        Raises
        ------
        ArithmeticError : no set of sticking points is found in a step.
        """
        numbers = np.arange(1, self.terms + 1)
        theta = (numbers - 0.5) * math.pi / self.terms
        sines = np.sin(np.outer(theta, numbers))
        bound = self.friction * self.peak_pressure * np.sin(theta)
        step = distance / steps
        here = self._displacements(np.cos(theta))
        before = self._displacements(np.cos(theta) + step / self.half_width)
        series = self._cattaneo(theta, sines)
        sticks = np.abs(sines @ series) < bound * (1 - 1e-9)
        found = []
        for _ in range(steps):
            series, rigid, sticks = self._step(here, before @ series, sines, bound, sticks, series[0])
            found.append(rigid / step)
        return np.array(found)

    def _cattaneo(self, theta: FloatArray, sines: FloatArray) -> FloatArray:
        """Return the terms of Cattaneo's traction [Pa]; the first one carries the force exactly."""
        inner = math.sqrt(1 - self.share)
        less = np.sqrt(np.maximum(inner**2 - np.cos(theta) ** 2, 0.0))
        series = 2 / self.terms * (sines.T @ (self.friction * self.peak_pressure * (np.sin(theta) - less)))
        series[-1] *= 0.5
        series[0] = self.share * self.friction * self.peak_pressure
        return np.asarray(series)

    def _displacements(self, place: FloatArray) -> FloatArray:
        """Return the displacement of each term at places x/a (n,), (n, terms) [m/Pa], but for a constant."""
        n = np.arange(1, self.terms + 1)
        inside = np.minimum(place, 1.0)
        angle, outside = np.arccos(inside)[:, None], np.arccosh(np.maximum(place, 1.0))[:, None]
        lower = np.maximum(n - 1, 1)
        within = np.cos((n - 1) * angle) / lower - np.cos((n + 1) * angle) / (n + 1)
        ahead = np.exp(-(n - 1) * outside) / lower - np.exp(-(n + 1) * outside) / (n + 1)
        terms = np.where(place[:, None] > 1, ahead, within)
        terms[:, :1] = np.where(place[:, None] > 1, -outside - np.exp(-2 * outside) / 2, -np.cos(2 * angle) / 2)
        return np.asarray(self.half_width / self.contact_modulus * terms)

    def _step(
        self,
        here: FloatArray,
        earlier: FloatArray,
        sines: FloatArray,
        bound: FloatArray,
        sticks: NDArray[np.bool_],
        first: float,
    ) -> tuple[FloatArray, float, NDArray[np.bool_]]:
        """Return the terms (n,) [Pa], the rigid slip of the step [m] and the points that stick.

        Points that slip have the bound along +x: the force does not change its sign.
        """
        scale = self.half_width / self.contact_modulus
        for _ in range(200):
            matrix = np.where(sticks[:, None], np.column_stack([np.full(len(bound), scale), here[:, 1:]]), 0.0)
            matrix[~sticks, 1:] = scale * sines[~sticks, 1:]
            right = np.where(sticks, earlier - here[:, 0] * first, scale * (bound - sines[:, 0] * first))
            solved = np.linalg.solve(matrix, right)
            series = np.concatenate([[first], solved[1:]])
            traction, slip = sines @ series, scale * solved[0] + here @ series - earlier
            now = np.where(sticks, traction <= bound, slip > 0)
            if (now == sticks).all():
                return series, scale * float(solved[0]), sticks
            sticks = now
        raise ArithmeticError("a step of rolling finds no set of points that stick")
