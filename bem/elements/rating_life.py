"""Rating life of radial bearings by ISO 281:2007: load ratings from geometry, basic and modified life.

Basic life L10 = (C / P)^p million revolutions, p = 3 for balls and 10/3 for rollers. Modified life L = a1 a_ISO L10
with the viscosity ratio kappa = nu / nu1 and the contamination factor e_C. Load ratings follow Lundberg and Palmgren,
whose formula for f_c gives the tables of ISO 281 within 0.5 %; static ratings are those of ISO 76.

Formulas are those of the standards as textbooks and catalogues print them; they were not checked against the standards'
own text. Verified in tests/elements/test_rating_life.py against tabulated f_c and f_0, worked examples of a
manufacturer's catalogue, continuity of a_ISO between its ranges and its limits.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from bem.errors import InputError
from bem.reference_solutions.hertz import ellipse_contact

CITES = ("lundberg1947", "iso281", "iso76", "harris2006")
"""Sources of the formulas, as keys of `bem/references.bib`."""

Rolling = Literal["ball", "roller"]
Cleanliness = Literal["extreme", "high", "normal", "slight", "typical", "severe", "very-severe"]

CONTAMINATION: Mapping[str, tuple[tuple[float, float], tuple[float, float]]] = {
    "extreme": ((1.0, 1.0), (1.0, 1.0)),
    "high": ((0.6, 0.8), (0.8, 0.9)),
    "normal": ((0.5, 0.6), (0.6, 0.8)),
    "slight": ((0.3, 0.5), (0.4, 0.6)),
    "typical": ((0.1, 0.3), (0.2, 0.4)),
    "severe": ((0.0, 0.1), (0.0, 0.1)),
    "very-severe": ((0.0, 0.0), (0.0, 0.0)),
}
"""Range of e_C by cleanliness, for pitch diameters below 100 mm and from 100 mm (ISO 281, table 13)."""
RELIABILITY: Mapping[float, float] = {90: 1.0, 95: 0.64, 96: 0.55, 97: 0.47, 98: 0.37, 99: 0.25}
"""Factor a1 by reliability in per cent (ISO 281:2007, table 12)."""
EXPONENT: Mapping[str, float] = {"ball": 3.0, "roller": 10 / 3}
"""Exponent p of the basic rating life."""
MOST_A_ISO, LEAST_KAPPA, MOST_KAPPA = 50.0, 0.1, 4.0
"""Largest a_ISO, and the range of kappa in which its formulas hold; above it kappa counts as its end."""

_BALL_CONSTANT = 40.2 * 0.95
"""Constant of f_c of deep groove ball bearings in N and mm, with the reduction 0.95 of this type."""
_ROLLER_CONSTANT = 207.9
LINE_REDUCTION = 0.83
"""Reduction lambda nu of rollers for uneven load along their length."""
_BALL_FACTOR, _ROLLER_FACTOR = 1.3, 1.1
"""Factor b_m of contemporary steel and manufacture."""
_LARGE_BALL = 25.4e-3
_STATIC_PRESSURE = 4.2e9
"""Hertz pressure of the most loaded ball at the static load rating [Pa]."""
_AXIAL_TABLE = (
    (0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89),
    (2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00),
)
"""Of deep groove ball bearings with normal clearance (ISO 281, table 3): f_0 F_a / C_0 and Y, with X = 0.56; between
them Y is interpolated linearly in the logarithm of the former."""
_RADIAL_FACTOR = 0.56
_STATIC_MODULUS = 207e9 / (2 * (1 - 0.3**2))
_LARGE_PITCH = 100e-3
_LIMIT_RATIO: Mapping[str, tuple[float, float]] = {"ball": (22.0, 0.5), "roller": (8.2, 0.3)}
"""C_0 over the fatigue load limit, and the exponent of its fall above a pitch diameter of 100 mm."""


@dataclass(frozen=True)
class BearingGeometry:
    """Internal geometry of a single-row radial bearing with contact angle zero; lengths [m].

    rolling : "ball" or "roller". diameter : of the rolling elements. pitch : diameter of their pitch circle.
    count : number of rolling elements. length : effective length of a roller. groove : groove radius over ball
    diameter.
    """

    rolling: Rolling
    diameter: float
    pitch: float
    count: int
    length: float | None = None
    groove: float = 0.52

    @property
    def gamma(self) -> float:
        """Rolling element diameter over pitch diameter."""
        return self.diameter / self.pitch


@dataclass(frozen=True)
class RatingLife:
    """Basic and modified rating life; loads [N], lives in revolutions.

    dynamic_rating : C. load : equivalent dynamic load P. basic : L10. viscosity_ratio : kappa; None where the oil's
    kinematic viscosity is not known, as then are `a_iso` and `modified`. contamination : e_C. fatigue_limit : C_u.
    a_iso : life modification factor; None where kappa is below its range. modified : a1 a_ISO L10.
    """

    dynamic_rating: float
    load: float
    basic: float
    viscosity_ratio: float | None
    contamination: float
    fatigue_limit: float
    a_iso: float | None
    modified: float | None


def dynamic_rating(bearing: BearingGeometry) -> float:
    """Return the basic dynamic radial load rating C [N] of the bearing's geometry."""
    gamma, diameter = bearing.gamma, 1e3 * bearing.diameter
    if bearing.length is not None:
        both = 1.04 * ((1 - gamma) / (1 + gamma)) ** (143 / 108)
        factor = (
            LINE_REDUCTION * _ROLLER_CONSTANT * gamma ** (2 / 9) * (1 - gamma) ** (29 / 27) / (1 + gamma) ** 0.25
        ) / (1 + both**4.5) ** (2 / 9)
        rating = factor * (1e3 * bearing.length) ** (7 / 9) * bearing.count**0.75 * diameter ** (29 / 27)
        return _ROLLER_FACTOR * rating
    rating = ball_factor(gamma, bearing.groove) * bearing.count ** (2 / 3)
    if bearing.diameter > _LARGE_BALL:
        return _BALL_FACTOR * rating * 3.647 * diameter**1.4
    return _BALL_FACTOR * rating * diameter**1.8


def ball_factor(gamma: float, groove: float = 0.52) -> float:
    """Return f_c of deep groove ball bearings with both groove radii of `groove` ball diameters."""
    both = 1.04 * ((1 - gamma) / (1 + gamma)) ** 1.72
    conformity = (2 * groove / (2 * groove - 1)) ** 0.41
    inner = gamma**0.3 * (1 - gamma) ** 1.39 / (1 + gamma) ** (1 / 3)
    return _BALL_CONSTANT * conformity * inner / (1 + both ** (10 / 3)) ** 0.3


def roller_factor(gamma: float) -> float:
    """Return f_c of radial roller bearings."""
    unit = BearingGeometry("roller", 1e-3, 1e-3 / gamma, 1, length=1e-3)
    return dynamic_rating(unit) / _ROLLER_FACTOR


def static_rating(bearing: BearingGeometry) -> float:
    """Return the basic static radial load rating C_0 [N]: 4.2 GPa under the most loaded ball; 4 GPa under a roller."""
    if bearing.length is not None:
        return 44e6 * (1 - bearing.gamma) * bearing.count * bearing.length * bearing.diameter
    loads = []
    for ring in (0.5 * (bearing.pitch - bearing.diameter), -0.5 * (bearing.pitch + bearing.diameter)):
        along = 1 / (2 / bearing.diameter + 1 / ring)
        across = 1 / (2 / bearing.diameter - 1 / (bearing.groove * bearing.diameter))
        unit = ellipse_contact(radii=(along, across), contact_modulus=_STATIC_MODULUS, load=1.0)
        loads.append((_STATIC_PRESSURE / unit.maximum_pressure) ** 3)  # pressure grows with the cube root of load
    return min(loads) * bearing.count / 5


def fatigue_limit(static: float, bearing: BearingGeometry) -> float:
    """Return the fatigue load limit C_u [N] from the static rating [N], simplified method of ISO 281, annex B."""
    ratio, power = _LIMIT_RATIO[bearing.rolling]
    return static / ratio * min(1.0, _LARGE_PITCH / bearing.pitch) ** power


def axial_factors(axial: float, static: float, bearing: BearingGeometry) -> tuple[float, float]:
    """Return X and Y of a deep groove ball bearing, normal clearance.

    axial : load F_a [N]. static : basic static load rating C_0 [N]. f_0 is C_0 / (Z D^2) in N and mm.
    """
    factor = static_rating(bearing) / (bearing.count * (1e3 * bearing.diameter) ** 2)
    steps, values = (np.array(row) for row in _AXIAL_TABLE)
    return _RADIAL_FACTOR, float(np.interp(math.log(factor * axial / static), np.log(steps), values))


def equivalent_load(radial: float, axial: float, factors: tuple[float, float]) -> float:
    """Return the equivalent dynamic load P = X F_r + Y F_a [N], F_r at least; factors : X and Y."""
    return max(radial, factors[0] * radial + factors[1] * axial)


def equivalent_static_load(radial: float, axial: float) -> float:
    """Return the equivalent static load P_0 = 0.6 F_r + 0.5 F_a of a radial ball bearing [N], F_r at least (ISO 76)."""
    return max(radial, 0.6 * radial + 0.5 * axial)


def reference_viscosity(pitch: float, speed: float) -> float:
    """Return nu1 [m^2/s], the kinematic viscosity for adequate lubrication.

    pitch : pitch diameter [m]. speed : of the inner ring [rad/s].
    """
    rpm, millimetres = speed * 30 / math.pi, 1e3 * pitch
    factor = 45000 * rpm**-0.83 if rpm < 1000 else 4500 * rpm**-0.5
    return 1e-6 * factor * millimetres**-0.5


def contamination_factor(cleanliness: str, pitch: float) -> float:
    """Return e_C, the middle of the range of a cleanliness, for a pitch diameter [m]."""
    if cleanliness not in CONTAMINATION:
        raise InputError(f'cleanliness "{cleanliness}": allowed: {", ".join(CONTAMINATION)}')
    low, high = CONTAMINATION[cleanliness][0 if pitch < _LARGE_PITCH else 1]
    return 0.5 * (low + high)


def life_modification_factor(
    rolling: Rolling, *, viscosity_ratio: float, contamination: float, limit_over_load: float
) -> float | None:
    """Return a_ISO; None where kappa is below 0.1, for which ISO 281 has none.

    viscosity_ratio : kappa. contamination : e_C. limit_over_load : C_u / P.
    """
    if viscosity_ratio < LEAST_KAPPA:
        return None
    kappa = min(viscosity_ratio, MOST_KAPPA)
    ball = rolling == "ball"
    if kappa < 0.4:
        inner = 2.5671 - 2.2649 / kappa**0.054381 if ball else 1.5859 - 1.3993 / kappa**0.054381
    else:
        power = 0.19087 if kappa < 1 else 0.071739
        inner = 2.5671 - 1.9987 / kappa**power if ball else 1.5859 - 1.2348 / kappa**power
    load = contamination * limit_over_load
    reached = inner**0.83 * load ** (1 / 3) if ball else inner * load**0.4
    if reached >= 1:
        return MOST_A_ISO
    return min(0.1 * (1 - reached) ** (-9.3 if ball else -9.185), MOST_A_ISO)


def rating_life(
    rolling: Rolling,
    *,
    rating: float,
    load: float,
    viscosity_ratio: float | None,
    contamination: float,
    limit: float,
    reliability: float = 90,
) -> RatingLife:
    """Return basic and modified rating life.

    Parameters
    ----------
    rolling : "ball" or "roller".
    rating : basic dynamic load rating C [N].
    load : equivalent dynamic load P [N].
    viscosity_ratio : kappa; None where it is not known.
    contamination : e_C.
    limit : fatigue load limit C_u [N].
    reliability : in per cent, one of `RELIABILITY`.
    """
    basic = 1e6 * (rating / load) ** EXPONENT[rolling]
    a_iso = None
    if viscosity_ratio is not None:
        a_iso = life_modification_factor(
            rolling, viscosity_ratio=viscosity_ratio, contamination=contamination, limit_over_load=limit / load
        )
    modified = None if a_iso is None else RELIABILITY[reliability] * a_iso * basic
    return RatingLife(rating, load, basic, viscosity_ratio, contamination, limit, a_iso, modified)


def hours(revolutions: float, speed: float) -> float:
    """Return a life in hours from revolutions at a speed [rad/s]."""
    return revolutions * 2 * math.pi / speed / 3600
