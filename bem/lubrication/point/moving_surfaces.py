"""Surfaces that move through a point contact with their body: dents, waviness, measured heights; amplitude reduction.

1. A surface gives its heights at points of its body (`Dent`, `Waves`, `MeasuredHeights`, any function).
2. `Travel` integrates the speeds of both bodies; heights at a time are those of the points that lie in the contact then
   (`heights_at`).
3. `amplitude_reduction` is the published fit for the amplitude of waviness that rolls through a contact,
   `amplitude_in_centre` that of computed films.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, Literal

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.lubrication.point.film import PointFilmSolution
from bem.lubrication.point.similarity import point_scales
from bem.reference_solutions.hertz import ellipse_contact
from bem.representation import readable

Heights = Callable[[FloatArray, FloatArray], FloatArray]
"""Heights out of the body [m] at points (x, y) on it [m], arrays of one shape."""
Roughness = Callable[[float], FloatArray]
"""Heights (nx, ny) of both surfaces out of the bodies [m] at a time [s]."""

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)
FRONT = 0.5
"""Length in wavelengths over which waves grow behind their front."""
WAVES_PASSED = 1.5
"""Number of waves that have passed the centre before the amplitude of a wave is taken."""


@dataclass(frozen=True)
class MovingSurface:
    """Heights on one of the bodies, which carries them with its speed.

    heights : function of x, y on the body [m], which are those of the contact at the first time; a `Dent`, `Waves`,
        `MeasuredHeights` or any other.
    of : the body; "lower" is the flat of the first speed.
    """

    heights: Heights
    of: Literal["lower", "upper"] = "lower"


@dataclass(frozen=True)
class Dent:
    """A round dent: heights -depth cos(pi s/2) exp(-2 s^2) with s = r/(1.2 radius).

    The shape fits cavities made by a laser (Mourier, Mazuyer, Lubrecht and Donnet, Tribol. Int. 39 (2006) 1745, as in
    Hansen et al., Tribol. Lett. 70 (2022) 80).

    depth : [m]; negative of a bump.
    radius : [m].
    at : centre on the body [m].
    """

    depth: float
    radius: float
    at: tuple[float, float] = (0.0, 0.0)

    def __call__(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return the heights [m] at points on the body [m]."""
        s = np.hypot(x - self.at[0], y - self.at[1]) / (1.2 * self.radius)
        return -self.depth * np.cos(0.5 * np.pi * s) * np.exp(-2 * s**2)


@dataclass(frozen=True)
class Waves:
    """Waviness amplitude cos(2 pi s/wavelength), s along a direction.

    amplitude, wavelength : [m].
    direction : [rad from x].
    begin : position of the front along the direction [m]: the body is smooth ahead of it, and waves grow over half a
        wavelength behind it. None: waves everywhere.
    """

    amplitude: float
    wavelength: float
    direction: float = 0.0
    begin: float | None = None

    def __call__(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return the heights [m] at points on the body [m]."""
        along = x * math.cos(self.direction) + y * math.sin(self.direction)
        waves = self.amplitude * np.cos(2 * np.pi * along / self.wavelength)
        if self.begin is None:
            return waves
        into = np.clip((self.begin - along) / (FRONT * self.wavelength), 0.0, 1.0)
        return waves * into**2 * (3 - 2 * into)


@readable
@dataclass(frozen=True, eq=False)
class MeasuredHeights:
    """A patch of heights, as `bem.read_surface` or `bem.generate_surface` give it, interpolated linearly.

    heights : (nx, ny) [m].
    spacing : sides of the cells (dx, dy) [m].
    at : centre of the patch on the body [m].
    repeated : whether the patch is repeated; else the body is smooth around it.
    fading : share of the sides over which the edges of a single patch fade.
    """

    heights: FloatArray
    spacing: tuple[float, float]
    at: tuple[float, float] = (0.0, 0.0)
    repeated: bool = False
    fading: float = 0.1

    def __call__(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Return the heights [m] at points on the body [m]."""
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
    """Interpolate values (nx, ny) linearly; places are in cells from the first centre, clipped to the last ones."""
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
    """Distances that both bodies have travelled since the first time.

    times : (n,) [s].
    distances : (n, 2, 2) of flat and ball along x and y at these times [m].
    speeds : function of time to the speeds of both bodies (2, 2) [m/s].
    """

    times: FloatArray
    distances: FloatArray
    speeds: Callable[[float], Any]

    @staticmethod
    def over(times: FloatArray, speeds: Callable[[float], Any]) -> Travel:
        """Integrate speeds from time to time by Gauss' rule with eight points.

        Jumps and kinks of the speeds belong on one of the times.
        """
        steps = [_travelled(speeds, a, b) for a, b in pairwise(times)]
        return Travel(times, np.concatenate([np.zeros((1, 2, 2)), np.cumsum(steps, axis=0)]), speeds)

    def at(self, time: float) -> FloatArray:
        """Return the distances of both bodies along x and y (2, 2) [m] at a time."""
        before = int(np.clip(np.searchsorted(self.times, time, side="right") - 1, 0, len(self.times) - 1))
        start = float(self.times[before])
        return np.asarray(
            self.distances[before] if time == start else self.distances[before] + _travelled(self.speeds, start, time)
        )


def _travelled(speeds: Callable[[float], Any], start: float, end: float) -> FloatArray:
    """Return the integral (2, 2) of both speeds over a time [m]."""
    half = 0.5 * (end - start)
    total = np.zeros((2, 2))
    for node, weight in zip(_NODES, _WEIGHTS, strict=True):
        total += half * weight * np.asarray(speeds(float(start + half * (1 + node))), dtype=np.float64)
    return total


def heights_at(
    roughness: Roughness | MovingSurface | Sequence[MovingSurface] | None, travel: Travel, x: FloatArray, y: FloatArray
) -> Roughness | None:
    """Return the heights of both surfaces on points (nx, ny) of the contact over time; None of smooth ones.

    Raises
    ------
    InputError : something else than a function of time or moving surfaces.
    """
    if roughness is None or (isinstance(roughness, Sequence) and not roughness):
        return None
    surfaces = [roughness] if isinstance(roughness, MovingSurface) else roughness
    if isinstance(surfaces, Sequence) and all(isinstance(one, MovingSurface) for one in surfaces):
        return _carried_heights(tuple(surfaces), travel, x, y)
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


def _carried_heights(surfaces: tuple[MovingSurface, ...], travel: Travel, x: FloatArray, y: FloatArray) -> Roughness:
    def total(time: float) -> FloatArray:
        distances = travel.at(time)
        heights = np.zeros(x.shape)
        for one in surfaces:
            dx, dy = distances[0 if one.of == "lower" else 1]
            heights += one.heights(x - dx, y - dy)
        return heights

    return total


# ---- amplitude reduction of waviness


def amplitude_reduction(waves: float, ratio: float = 0.0) -> float:
    """Return the amplitude of waviness in the centre over that of the body, in pure rolling.

    A_d/A_i = 1/(1 + 0.15 f n + 0.015 (f n)^2), f = exp(1 - 1/r) for r > 1 and 1 else (Venner and Lubrecht, Proc. IMechE
    J 213 (1999) 137; *Multilevel methods in lubrication*, 2000). The coefficients are not checked against the original.
    It is a fit with a scatter of about 10 %. Linear equations around the film, exact in time, agree within 4 % from
    n = 4.5 on, and exceed it by about 15 % at n = 2 to 3.5 with M 64 and 200
    (reports/experiments/waviness_reduction.py).

    Parameters
    ----------
    waves : n = (wavelength/half-axis) (M/L)^(1/2), the wavelength over the length of the inlet.
    ratio : r, of wavelengths along and across the flow; the shorter of them is the wavelength in n.
    """
    n = waves * (math.exp(1 - 1 / ratio) if ratio > 1 else 1.0)
    return 1 / (1 + 0.15 * n + 0.015 * n**2)


def rolling_reduction(
    wavelength: float, load: float, radius: float, contact_modulus: float, film: PointFilmSolution
) -> float:
    """Return `amplitude_reduction` of waves across the flow [m] under a ball, with the oil and the speeds of a film."""
    total = abs(film.speeds[0][0] + film.speeds[1][0])
    scales = point_scales(load, (radius, radius), contact_modulus, total, film.lubricant.viscosity)
    half = ellipse_contact(radii=(radius, radius), contact_modulus=contact_modulus, load=load).semi_axes[0]
    material = film.lubricant.pressure_viscosity * scales.pressure
    return amplitude_reduction(wavelength / half * math.sqrt(scales.load / material))


def amplitude_in_centre(films: Sequence[PointFilmSolution], wavelength: float, begin: float | None) -> float | None:
    """Return the amplitude of the film at the centre over the last wavelength [m]; None if too early or too coarse.

    Waves across the flow roll along x with both surfaces. None before `WAVES_PASSED` waves have passed the centre, or
    with fewer than eight time steps a wave.

    Parameters
    ----------
    films : at ascending times.
    wavelength : [m].
    begin : position of the front at first [m]; None of waves everywhere.
    """
    speed = abs(films[-1].speeds[0][0])
    time = np.array([film.time for film in films], dtype=np.float64)
    distance = speed * (time[-1] - time[0]) - (0.0 if begin is None else abs(begin))
    last = time > time[-1] - wavelength / speed
    if distance < WAVES_PASSED * wavelength or last.sum() < 8:
        return None
    film = np.array([film.central_thickness for film in films])[last]
    phase = 2 * np.pi * speed / wavelength * time[last]
    parts = np.linalg.lstsq(np.column_stack([np.ones_like(phase), np.cos(phase), np.sin(phase)]), film, rcond=None)[0]
    return float(np.hypot(*parts[1:]))
