"""Profiles of published arcs, lines and polynomials: `60e1`, `s1002`, `en15302-rail-a`, `en15302-wheel-a`.

Numbers are in mm, z down, and no standard was read in the original:

- `60e1` (UIC 60, EN 13674-1), origin at the middle of its top: arcs of 300, 80 and 13 mm that meet without a kink at
  20.456/2 and 52.053/2 mm, and a side of 1:20 from 72/2 mm on; as a public page on drawing rail profiles gives it.
- `s1002` (UIC 510-2, EN 13715), origin at the tape circle, flange to the left: lines, two polynomials and arcs with the
  coefficients of H. Netter (DLR), as course material in public repositories quotes them.
- `en15302-rail-a`, `en15302-wheel-a`: reference profiles of EN 15302:2021, right side, origins 750 mm from the middle
  of the track: a rail of the same radii inclined by 1:20, and a wheel of arcs near S1002, as the open-source program
  EN15302 has them.

Pieces meet to the digits of their sources: the points, 0.2 mm apart, are joined by a spline. `60e1` inclined by 1:20 is
within 0.05 mm of `en15302-rail-a`, whose arcs of 300 and 80 mm meet 10.5 instead of 10.2 mm from the middle
(tests/profiles/test_catalogue.py); the rail of the Manchester benchmark in the examples of CONTACT, UIC 60, is within
10 um of rail A on the top and 40 um at the corners.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import lru_cache

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.profiles.profile import Profile

_STEP = 0.2
"""Distance of points along a piece [mm]: the spline's error on an arc of 13 mm is below 1e-6 mm."""

SOURCES = {
    "60e1": "profile UIC 60, EN 13674-1 (arcs of 300, 80 and 13 mm), as a public page on drawing rail profiles gives "
    "it; the standard was not read",
    "s1002": "profile S1002, UIC 510-2 and EN 13715, with the polynomials and arcs of H. Netter (DLR), as course "
    "material quotes them; the standards were not read",
    "en15302-rail-a": "reference rail A of EN 15302:2021, as the open-source program EN15302 has it; the standard was "
    "not read",
    "en15302-wheel-a": "reference wheel A of EN 15302:2021, as the open-source program EN15302 has it; the standard "
    "was not read",
}
"""Sources of the profiles by their names."""

Points = tuple[FloatArray, FloatArray]


def _function(values: Callable[[FloatArray], FloatArray], start: float, end: float) -> Points:
    """Return points of z(y) [mm] without the last one."""
    count = max(math.ceil((end - start) / _STEP), 2)
    y = np.linspace(start, end, count + 1)[:-1]
    return y, values(y)


def _arc(centre: tuple[float, float], radius: float, start: float, end: float, side: int) -> Points:
    """Return points of an arc between two values of y [mm] without the last one; side: -1 above, 1 below the centre."""
    first, last = (math.asin(min(max((y - centre[0]) / radius, -1.0), 1.0)) for y in (start, end))
    count = max(math.ceil(radius * (last - first) / _STEP), 2)
    angle = np.linspace(first, last, count + 1)[:-1]
    return centre[0] + radius * np.sin(angle), centre[1] + side * radius * np.cos(angle)


def _polynomial(y: FloatArray, coefficients: tuple[float, ...]) -> FloatArray:
    """Return the polynomial of these coefficients, that of y^0 first."""
    values: FloatArray = np.polynomial.polynomial.polyval(y, np.array(coefficients))
    return values


def _joined(pieces: list[Points], end: tuple[float, float]) -> Points:
    y, z = (np.concatenate([*parts, [last]]) for parts, last in zip(zip(*pieces, strict=True), end, strict=True))
    return y, z


def _rail_60e1() -> Points:
    """Half of the head from its middle, and its mirror image."""
    first, second, third = 300.0, 80.0, 13.0
    end_1, end_2, end_3 = 20.456 / 2, 52.053 / 2, 72.0 / 2
    angle_1 = math.asin(end_1 / first)
    centre_2 = ((first - second) * math.sin(angle_1), first - (first - second) * math.cos(angle_1))
    angle_2 = math.asin((end_2 - centre_2[0]) / second)
    centre_3 = (
        centre_2[0] + (second - third) * math.sin(angle_2),
        centre_2[1] - (second - third) * math.cos(angle_2),
    )
    angle_3 = math.asin((end_3 - centre_3[0]) / third)
    corner = (end_3, centre_3[1] - third * math.cos(angle_3))
    side = 10.0  # of the straight side [mm]
    down = np.arange(0.0, side, _STEP)
    pieces = [
        _arc((0.0, first), first, 0.0, end_1, -1),
        _arc(centre_2, second, end_1, end_2, -1),
        _arc(centre_3, third, end_2, end_3, -1),
        (corner[0] + down / 20, corner[1] + down),
    ]
    y, z = _joined(pieces, (corner[0] + side / 20, corner[1] + side))
    return np.concatenate([-y[:0:-1], y]), np.concatenate([z[:0:-1], z])


def _rail_a() -> Points:
    pieces = [
        _arc((-19.63949, 15.899044), 13.0, -32.6340, -23.2401, -1),
        _arc((-1.08250, 80.277908), 80.0, -23.2401, -7.87490, -1),
        _arc((17.59660, 299.483490), 300.0, -7.87490, 13.09890, -1),
        _arc((14.29829, 79.508225), 80.0, 13.09890, 28.67090, -1),
        _arc((26.33535, 13.598369), 13.0, 28.67090, 39.27050, -1),
    ]
    return _joined(pieces, (39.27050, 13.598369 - math.sqrt(13.0**2 - (39.27050 - 26.33535) ** 2)))


def _flange(crown: float, inner: float, face: float, corner: float) -> list[Points]:
    """Return the flange's arcs, from its back to the face of 70 degrees, which ends at y = corner [mm].

    crown, inner, face : depth of the centres of the arcs of 20.5, 12 and 20 mm, which S1002 and wheel A share but for
    digits.
    """
    return [
        _arc((-49.5, crown), 20.5, -69.9, -62.764705882, 1),
        _arc((-55.0, inner), 12.0, -62.764705882, -49.662510381, 1),
        _arc((-58.558326413, face), 20.0, -49.662510381, corner, 1),
    ]


def _wheel_a() -> Points:
    pieces = [
        *_flange(9.51926, 16.00065, 8.83556, -39.7645),
        _function(lambda y: -93.57685 - 2.7475 * y, -39.7645, -38.7372),
        _arc((-25.5816, 17.64215), 14.0, -38.7372, -29.4591, -1),
        _arc((-2.6594, 97.16493), 96.76055, -29.4591, -10.8749, -1),
        _arc((18.4173, 344.50806), 345.0, -10.8749, 18.4173, -1),
        _function(lambda y: np.full_like(y, -0.49194), 18.4173, 30.0),
        _function(lambda y: 1.50804 - 0.066666 * y, 30.0, 60.0),
    ]
    return _joined(pieces, (60.0, 1.50804 - 0.066666 * 60.0))


def _s1002() -> Points:
    root = (-4.320221063e3, -1.038384026e3, -1.065501873e2, -6.051367875, -2.054332446e-1, -4.169739389e-3,
            -4.687195829e-5, -2.252755540e-7)  # fmt: skip
    tread = (0.0, -3.358537058e-2, 1.565681624e-3, -2.810427944e-5, 5.844240864e-8, -1.562379023e-8, 5.309217349e-15,
             -5.957839843e-12, 2.646656573e-13)  # fmt: skip
    pieces = [
        *_flange(9.519259302, 16.0, 8.834924130, -39.764473993),
        _function(lambda y: -93.576667419 - 2.747477419 * y, -39.764473993, -38.426669071),
        _arc((-26.210665, 16.446), 13.0, -38.426669071, -35.0, -1),
        _function(lambda y: _polynomial(y, root), -35.0, -26.0),
        _function(lambda y: _polynomial(y, tread), -26.0, 32.15796),
        _function(lambda y: 1.364323640 - 0.066666667 * y, 32.15796, 60.0),
    ]
    return _joined(pieces, (60.0, 1.364323640 - 0.066666667 * 60.0))


_POINTS: dict[str, Callable[[], Points]] = {
    "60e1": _rail_60e1,
    "s1002": _s1002,
    "en15302-rail-a": _rail_a,
    "en15302-wheel-a": _wheel_a,
}
PROFILE_NAMES = tuple(_POINTS)
"""Names of the profiles that come with the package."""


@lru_cache
def catalogued_profile(name: str) -> Profile:
    """Return a profile of the catalogue.

    Raises
    ------
    InputError : no profile has that name.
    """
    if name not in _POINTS:
        raise InputError(f"profile {name!r}: unknown; allowed: {', '.join(PROFILE_NAMES)}")
    y, z = _POINTS[name]()
    return Profile.through(1e-3 * y, 1e-3 * z)
