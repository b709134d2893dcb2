"""A profile: a smooth plane curve through measured or calculated points, parametrised by arc length.

Coordinates y (to the right) and z (down) of the points are smoothed by cubic splines in the arc length s,

    minimise  integral of (z - f)^2 ds + (L / 2 pi)^4 integral of f''^2 ds,

and y likewise, so that ripples of the wavelength L keep half of their amplitude, those of 2 L 94 % and those of L/2
6 %. Without smoothing the splines pass through the points. Verified in tests/profiles/test_profile.py.
"""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import BSpline, make_interp_spline, make_smoothing_spline

from bem.arguments import read_small
from bem.errors import InputError
from bem.grid import FloatArray

FEWEST_POINTS = 8
"""Fewest points of a profile: a spline of fewer has no curvature to speak of."""
SHORTEST, LONGEST = 5e-3, 1.0
"""Lengths of the profiles that files hold [m]: from a disc of a test rig to a whole rail; other units are beyond."""
_FAR = 5.0
"""Distance of a first line of numbers over the largest other step, from which it is no point if it is the count."""
_NEWTON_STEPS = 8
"""Newton steps of an inversion, from a linear interpolation between the points: quadratic, so that five are enough."""


@dataclass(frozen=True, eq=False)
class Profile:
    """A profile; `Profile.through` makes one from points.

    Attributes
    ----------
    lateral, depth : splines of y and z [m] over the arc length of the points [m].
    knots : arc length at the points, (n,) [m].
    """

    lateral: BSpline
    depth: BSpline
    knots: FloatArray

    @classmethod
    def through(cls, y: FloatArray, z: FloatArray, *, smoothing: float = 0.0) -> Profile:
        """Return the profile through points in the order of the curve, turned so that y rises from its first to its
        last point.

        Parameters
        ----------
        y, z : coordinates, (n,) [m]; z down.
        smoothing : wavelength that keeps half of its amplitude [m]; 0 passes through the points.

        Raises
        ------
        InputError : too few points, points that coincide, or values that are not finite.
        """
        y, z = np.asarray(y, dtype=np.float64), np.asarray(z, dtype=np.float64)
        if y.ndim != 1 or y.shape != z.shape:
            raise InputError(
                f"profile: y of shape {y.shape} and z of {z.shape}; allowed: two arrays (n,) of one length"
            )
        if len(y) < FEWEST_POINTS:
            raise InputError(f"profile: {len(y)} points; allowed: {FEWEST_POINTS} or more, each with y and z")
        if not (np.isfinite(y).all() and np.isfinite(z).all()):
            raise InputError("profile: a coordinate is not a finite number; allowed: finite numbers")
        if not (isinstance(smoothing, int | float | np.number) and math.isfinite(smoothing) and smoothing >= 0):
            raise InputError(f"profile: smoothing {smoothing!r} m must be finite and not negative")
        if y[0] > y[-1]:
            y, z = y[::-1], z[::-1]
        steps = np.hypot(np.diff(y), np.diff(z))
        if not (steps > 0).all():
            raise InputError("profile: two points one after the other are the same; allowed: distinct points")
        s = np.concatenate([[0.0], np.cumsum(steps)])
        if smoothing == 0:
            return cls(make_interp_spline(s, y), make_interp_spline(s, z), s)
        weights = np.gradient(s)
        # in units of the mean step: the solver of the penalised equations is not made for 1e-12 m^4
        unit = float(s[-1]) / (len(s) - 1)
        penalty = (smoothing / (2 * math.pi * unit)) ** 4
        smooth = [make_smoothing_spline(s / unit, values / unit, w=weights / unit, lam=penalty) for values in (y, z)]
        lateral, depth = (BSpline(one.t * unit, one.c * unit, one.k) for one in smooth)
        return cls(lateral, depth, s)

    def at(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return y and z at arc lengths [m]."""
        return self.lateral(s), self.depth(s)

    def slope_at(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the derivatives of y and z along the parameter."""
        return self._slopes[0](s), self._slopes[1](s)

    def curvature(self, s: FloatArray) -> FloatArray:
        """Return the curvature [1/m]: positive where the curve bends downwards, as the head of a rail."""
        (dy, dz), (ddy, ddz) = self.slope_at(s), (one(s) for one in self._bends)
        bend: FloatArray = (dy * ddz - dz * ddy) / (dy * dy + dz * dz) ** 1.5
        return bend

    def turned(self, angle: float, about: tuple[float, float] = (0.0, 0.0)) -> Profile:
        """Return the profile rotated from y towards z by an angle [rad] about a point [m]."""
        cosine, sine = math.cos(angle), math.sin(angle)
        y, z = self.lateral.c - about[0], self.depth.c - about[1]  # the basis sums to one
        lateral = BSpline(self.lateral.t, about[0] + cosine * y - sine * z, self.lateral.k)
        return Profile(lateral, BSpline(self.depth.t, about[1] + sine * y + cosine * z, self.depth.k), self.knots)

    def parameter_where(self, along: tuple[float, float], values: FloatArray) -> FloatArray:
        """Return the arc lengths at which `along . (y, z)` has the values, not-a-number where it has none.

        The part of the curve on which this coordinate rises without a turn is searched, the longest of several.
        """
        s = self.samples
        y, z = self.at(s)
        coordinate = along[0] * y + along[1] * z
        first, last = _longest_rise(np.diff(coordinate) > 0)
        part, inside = s[first : last + 1], coordinate[first : last + 1]
        if len(part) < 2:
            return np.full(np.shape(values), np.nan)
        found: FloatArray = np.interp(values, inside, part, left=np.nan, right=np.nan)
        for _ in range(_NEWTON_STEPS):
            y, z = self.at(found)
            dy, dz = self.slope_at(found)
            step = (along[0] * y + along[1] * z - values) / (along[0] * dy + along[1] * dz)
            found = np.clip(found - step, part[0], part[-1])
        return found

    @cached_property
    def samples(self) -> FloatArray:
        """Arc lengths at the points and in the middle between them [m]."""
        return np.sort(np.concatenate([self.knots, 0.5 * (self.knots[1:] + self.knots[:-1])]))

    @cached_property
    def _slopes(self) -> tuple[BSpline, BSpline]:
        return self.lateral.derivative(), self.depth.derivative()

    @cached_property
    def _bends(self) -> tuple[BSpline, BSpline]:
        return self.lateral.derivative(2), self.depth.derivative(2)


def _longest_rise(rises: NDArray[np.bool_]) -> tuple[int, int]:
    """Return the first and last point of the longest run of rising steps."""
    edges = np.flatnonzero(np.diff(np.concatenate([[0], rises.astype(np.int8), [0]])))
    starts, ends = edges[::2], edges[1::2]
    if not len(starts):
        return 0, 0
    longest = int(np.argmax(ends - starts))
    return int(starts[longest]), int(ends[longest])


def read_profile(path: str | os.PathLike[str], *, vertical: str = "down", smoothing: float = 0.0) -> Profile:
    """Read a profile file: two columns, y to the right and z, in mm, along the curve; other lines are left out.

    Columns are separated by blanks, commas or semicolons; beside blanks or semicolons, commas may be decimal ones.
    Lines that do not begin with two numbers are headers or comments.

    Parameters
    ----------
    path : text file.
    vertical : "down" or "up", the direction in which z is counted.
    smoothing : as in `Profile.through` [m].

    Raises
    ------
    InputError : a file that cannot be read or holds no profile, further columns, a length that is none of a profile in
        mm, or a `vertical` of another name.
    """
    name = os.fspath(path)
    if vertical not in ("down", "up"):
        raise InputError(f"profile: vertical {vertical!r}; allowed: down, up")
    try:
        text = read_small(name).decode("utf-8-sig", errors="replace")
    except OSError as error:
        raise InputError(f"{name}: cannot be read ({error.strerror or error}); allowed: a profile file") from None
    y, z = 1e-3 * _points(name, text).T
    distinct = np.concatenate([[True], (np.diff(y) != 0) | (np.diff(z) != 0)])
    sign = 1.0 if vertical == "down" else -1.0
    try:
        profile = Profile.through(y[distinct], sign * z[distinct], smoothing=smoothing)
    except InputError as error:
        raise InputError([f"{name}: {message}" for message in error.messages]) from None
    length = float(profile.knots[-1])
    if not SHORTEST <= length <= LONGEST:
        raise InputError(
            f"{name}: a profile {1e3 * length:.3g} mm long; allowed: {1e3 * SHORTEST:g} to {1e3 * LONGEST:g} mm, "
            "with y and z in mm"
        )
    return profile


def _numbers(line: str) -> list[float]:
    """Return the numbers that a line begins with.

    A comma is a decimal one beside semicolons, or where blanks part two words that have one; else it separates columns.
    """
    if ";" in line:
        words = [word.strip() for word in line.replace(",", ".").split(";")]
        words = [part for word in words for part in word.split()]
    else:
        words = line.split()
        inner = [("," in word.strip(",")) for word in words[:2]]
        words = line.replace(",", "." if len(inner) == 2 and all(inner) else " ").split()
    found: list[float] = []
    for word in words:
        try:
            found.append(float(word))
        except ValueError:
            break
    return found


def _points(name: str, text: str) -> FloatArray:
    """Return the points of a profile file, (n, 2) [mm], in the order of the lines.

    Raises
    ------
    InputError : lines of more than two numbers, too few points, or a first line that is a count of points.
    """
    points = []
    for count, line in enumerate(text.splitlines(), 1):
        numbers = _numbers(line)
        if len(numbers) > 2:
            raise InputError(
                f"{name}: line {count} has {len(numbers)} numbers; allowed: two columns, y and z in mm, without others"
            )
        if len(numbers) == 2:
            points.append(numbers)
    if len(points) < FEWEST_POINTS:
        raise InputError(
            f"{name}: {len(points)} lines begin with two numbers; allowed: {FEWEST_POINTS} or more points of a "
            "profile, y and z in mm"
        )
    found = np.array(points)
    steps = np.hypot(*np.diff(found, axis=0).T)
    if found[0, 0] == len(found) - 1 and steps[0] > _FAR * steps[1:].max():
        raise InputError(
            f"{name}: the first line of numbers counts the {len(found) - 1} points after it; allowed: points alone"
        )
    return found
