"""Surfaces that move through a point contact: dents, waviness and measured heights, carried along by their body."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.representation import readable

Heights = Callable[[FloatArray, FloatArray], FloatArray]
"""Heights out of the body [m] at points (x, y) on it [m], arrays of one shape."""
Roughness = Callable[[float], FloatArray]
"""Heights (nx, ny) of both surfaces out of the bodies [m] at a time [s]."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
SMOOTH = 0.5
"""Wavelengths over which waves grow behind their front."""


@dataclass(frozen=True)
class MovingSurface:
    """Heights on one of the bodies, which carries them with its speed.

    Attributes
    ----------
    heights : function of x, y on the body [m], equal to those of the contact at the first time; a `Dent`, `Waves`,
        `MeasuredHeights` or any other.
    of : the body; "lower" is the flat of the first speed.
    """

    heights: Heights
    of: Literal["lower", "upper"] = "lower"


@dataclass(frozen=True)
class Dent:
    """A round dent of this depth [m] (negative: a bump) and radius [m] around a point [m]: out of the body
    -depth cos(pi s/2) exp(-2 s^2) with s = r/(1.2 radius), which fits the cavities that a laser makes (Mourier,
    Mazuyer, Lubrecht and Donnet, Tribol. Int. 39 (2006) 1745, as in Hansen et al., Tribol. Lett. 70 (2022) 80)."""

    depth: float
    radius: float
    at: tuple[float, float] = (0.0, 0.0)

    def __call__(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Heights [m]."""
        s = np.hypot(x - self.at[0], y - self.at[1]) / (1.2 * self.radius)
        return -self.depth * np.cos(0.5 * np.pi * s) * np.exp(-2 * s**2)


@dataclass(frozen=True)
class Waves:
    """amplitude cos(2 pi s/wavelength) along a direction [rad from x]. begin : the front [m]
    along it, ahead of which the body is smooth (they grow over half a wave behind it); None: waves everywhere."""

    amplitude: float
    wavelength: float
    direction: float = 0.0
    begin: float | None = None

    def __call__(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Heights [m]."""
        along = x * math.cos(self.direction) + y * math.sin(self.direction)
        waves = self.amplitude * np.cos(2 * np.pi * along / self.wavelength)
        if self.begin is None:
            return waves
        into = np.clip((self.begin - along) / (SMOOTH * self.wavelength), 0.0, 1.0)
        return waves * into**2 * (3 - 2 * into)


@readable
@dataclass(frozen=True, eq=False)
class MeasuredHeights:
    """A patch of heights (nx, ny) [m] with sides of cells (dx, dy) [m], as `bem.read_surface` or `bem.generate_surface`
    give it, with its centre at a point [m] of the body. Between cells linear; around it smooth, its edges fade over
    `fading` of its sides, or it is repeated."""

    heights: FloatArray
    spacing: tuple[float, float]
    at: tuple[float, float] = (0.0, 0.0)
    repeated: bool = False
    fading: float = 0.1

    def __call__(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Heights [m]."""
        sides = np.array(self.heights.shape) * self.spacing
        share = [(v - c) / side + 0.5 for v, c, side in zip((x, y), self.at, sides, strict=True)]
        values, cells = self.heights, np.array(self.heights.shape)
        if self.repeated:
            values = np.pad(values, 1, mode="wrap")
            points = [np.mod(s, 1.0) for s in share]
        else:
            values = np.pad(values, 1, mode="edge")
            points = [np.clip(s, 0.0, 1.0) for s in share]
        # in cells of the padded patch, whose first centre lies half a cell before the edge
        found = bilinear(values, points[0] * cells[0] + 0.5, points[1] * cells[1] + 0.5)
        return found if self.repeated else found * self._fade(share[0]) * self._fade(share[1])

    def _fade(self, share: FloatArray) -> FloatArray:
        into = np.clip(np.minimum(share, 1 - share) / max(self.fading, 1e-12), 0.0, 1.0)
        return np.asarray(into**2 * (3 - 2 * into))


def bilinear(values: FloatArray, first: FloatArray, second: FloatArray) -> FloatArray:
    """Values (nx, ny) at places in cells from the first centre, along either axis; beyond the last ones as there."""
    lows, shares = [], []
    for place, n in zip((first, second), values.shape, strict=True):
        inside = np.clip(np.asarray(place, dtype=np.float64), 0.0, n - 1.0)
        low = np.minimum(inside.astype(int), n - 2)
        lows.append(low)
        shares.append(inside - low)
    (i, j), (s, t) = lows, shares
    before = (1 - t) * values[i, j] + t * values[i, j + 1]
    after = (1 - t) * values[i + 1, j] + t * values[i + 1, j + 1]
    return np.asarray((1 - s) * before + s * after)


@dataclass(frozen=True, eq=False)
class Travel:
    """How far both bodies have come since the first of some times [s], the integral of their speeds."""

    times: FloatArray
    come: FloatArray
    speeds: Callable[[float], Any]

    @staticmethod
    def over(times: FloatArray, speeds: Callable[[float], Any]) -> Travel:
        """From time to time by Gauss' eight points: jumps and kinks of the speeds belong on one of the times."""
        steps = [_travelled(speeds, a, b) for a, b in pairwise(times)]
        return Travel(times, np.concatenate([np.zeros((1, 2, 2)), np.cumsum(steps, axis=0)]), speeds)

    def at(self, time: float) -> FloatArray:
        """Of both bodies along x and y (2, 2) [m]."""
        before = int(np.clip(np.searchsorted(self.times, time, side="right") - 1, 0, len(self.times) - 1))
        start = float(self.times[before])
        return np.asarray(self.come[before] if time == start else self.come[before] + self._rest(start, time))

    def _rest(self, start: float, time: float) -> FloatArray:
        return _travelled(self.speeds, start, time)


def _travelled(speeds: Callable[[float], Any], start: float, end: float) -> FloatArray:
    half = 0.5 * (end - start)
    total = np.zeros((2, 2))
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        total += half * weight * np.asarray(speeds(float(start + half * (1 + node))), dtype=np.float64)
    return total


def heights_over(
    roughness: Roughness | MovingSurface | Sequence[MovingSurface] | None, travel: Travel, x: FloatArray, y: FloatArray
) -> Roughness | None:
    """Heights of both surfaces at a time on points (nx, ny) of the contact; None of smooth ones.

    Raises
    ------
    InputError : something else than a function of time or moving surfaces.
    """
    if roughness is None or (isinstance(roughness, Sequence) and not roughness):
        return None
    surfaces = [roughness] if isinstance(roughness, MovingSurface) else roughness
    if isinstance(surfaces, Sequence) and all(isinstance(one, MovingSurface) for one in surfaces):
        return _moved(tuple(surfaces), travel, x, y)
    if not callable(roughness):
        raise InputError(
            f"roughness: {type(roughness).__name__} must be a function of time to heights (nx, ny) [m], a "
            "MovingSurface or several"
        )
    given = roughness

    def checked(time: float) -> FloatArray:
        heights = np.asarray(given(time), dtype=np.float64)
        if heights.shape != x.shape or not np.isfinite(heights).all():
            raise InputError(f"roughness: at time {time:g} s not {x.shape[0]} x {x.shape[1]} finite heights [m]")
        return heights

    return checked


def _moved(surfaces: tuple[MovingSurface, ...], travel: Travel, x: FloatArray, y: FloatArray) -> Roughness:
    def total(time: float) -> FloatArray:
        come = travel.at(time)
        heights = np.zeros(x.shape)
        for one in surfaces:
            dx, dy = come[0 if one.of == "lower" else 1]
            heights += one.heights(x - dx, y - dy)
        return heights

    return total
