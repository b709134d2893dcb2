"""Film of a journal bearing of finite length: an estimate from the closed forms of long and short bearings.

Sommerfeld numbers, mu N L D/W (R/c)^2, of the infinitely long bearing (half-Sommerfeld) and of the short one (Ocvirk)
are added, so that each limit is met. Against Reynolds' equation in finite differences, whose pressure ends where its
gradient does, the sum is 7 to 13 % too small at eccentricities from 0.6 to 0.9 and lengths from 0.5 to 1 diameters; the
film is then up to 12 % too thick. Verified in tests/elements/test_plain_bush.py against that solution and against
values of Raimondi and Boyd (1958), which are quoted from memory.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

_LEAST = 1e-6
"""Smallest distance of the eccentricity from 0 and 1."""


@dataclass(frozen=True)
class JournalFilm:
    """Film of a journal bearing under a load.

    Attributes
    ----------
    eccentricity : over the radial clearance. minimum_thickness : of the film [m]. friction : coefficient.
    """

    eccentricity: float
    minimum_thickness: float
    friction: float


def sommerfeld_number(eccentricity: float, slenderness: float) -> float:
    """Return the Sommerfeld number of a bearing whose length is `slenderness` times its diameter, an estimate."""
    e, pi = eccentricity, math.pi
    room = 1 - e * e
    long = (2 + e * e) * room / (6 * pi * e * math.sqrt(pi**2 - e * e * (pi**2 - 4)))
    short = room**2 / (pi * e * math.sqrt(pi**2 * room + 16 * e * e)) / slenderness**2
    return long + short


def journal_film(
    *, load: float, radius: float, clearance: float, length: float, viscosity: float, sliding_speed: float
) -> JournalFilm:
    """Return the film of a rigid journal bearing filled with oil of one viscosity.

    The friction is that of the sheared film all around, 2 pi^2 S/sqrt(1 - e^2), and of the load beside the centre,
    e sin(attitude)/2, over R/c; the attitude angle is that of the short bearing.

    Parameters
    ----------
    load : [N].
    radius : of the bearing [m].
    clearance : difference of the radii [m].
    length : of the bearing [m].
    viscosity : of the oil [Pa s].
    sliding_speed : of the shaft's surface [m/s].
    """
    from scipy.optimize import brentq

    wanted = viscosity * sliding_speed * length * radius**2 / (math.pi * load * clearance**2)
    slenderness = length / (2 * radius)

    def excess(eccentricity: float) -> float:
        return math.log(sommerfeld_number(eccentricity, slenderness) / wanted)

    if excess(1 - _LEAST) > 0:
        found = 1 - _LEAST
    elif excess(_LEAST) < 0:
        found = _LEAST
    else:
        found = float(brentq(excess, _LEAST, 1 - _LEAST))
    root = math.sqrt(1 - found**2)
    attitude = math.atan2(math.pi * root, 4 * found)
    friction = 2 * math.pi**2 * wanted / root + 0.5 * found * math.sin(attitude)
    return JournalFilm(found, clearance * (1 - found), friction * clearance / radius)
