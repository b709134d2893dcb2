"""Reference rating life by ISO/TS 16281: from the loads of all rolling elements, of rollers slice by slice.

Balls: Q_j of every ball gives the equivalent loads of the turning and of the standing ring, Q_ei with the power 3 and
Q_ee with 10/3, and L10r = [(Q_ei / Q_ci)^(10/3) + (Q_ee / Q_ce)^(10/3)]^(-9/10). Rollers: each is cut into slices that
carry q = c delta^(10/9) on their own compression delta_j - x tan(psi_j) - 2 P(x), with tilt psi_j = psi cos(phi_j) and
profile P; the powers are 4 and 9/2 and the lives of all slices are added.

Modified life of rollers: a_ISO of every slice, at the equivalent load P_k that a bearing of n slices all like this one
would have, then [sum over k of (a_ISO,k L_k)^(-9/8)]^(-8/9). L_k is the life of slice k of all rollers, n^(-8/9) L_k
that of n alike (Weibull's slope 9/8).

The ratings of single contacts Q_ci, Q_ce come back to the basic life (C / P)^p for a radial load, no clearance and many
rolling elements; rollers with an even load along their length live 0.83^-4 times longer, since C counts an uneven one.

Formulas were not checked against the standard's own text. Verified in tests/elements/test_reference_life.py by these
identities, by a tilt that halves are mirrored in, and against Hertz and Lundberg's limits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from bem.elements.rating_life import EXPONENT, LINE_REDUCTION, BearingGeometry
from bem.errors import InputError
from bem.grid import FloatArray

CITES = ("iso16281", "lundberg1947", "harris2006")
"""Sources of the formulas, as keys of `bem/references.bib`."""

SLICES = 41
"""Slices of a roller; ISO/TS 16281 asks for 30 or more."""
_LINE_POWER = 10 / 9
_LINE_SLOPE = 9 / 8
"""Weibull slope of line contacts."""
_LINE_STIFFNESS = 35948.0
"""c_L [N/mm^(2)] of steel: load of a roller between both rings, over l^(8/9) delta^(10/9), l and delta in mm."""
_DROP, _LONG = 0.00035, 2.5
"""Logarithmic reference profile: drop over diameter, and length over diameter above which it has a straight part."""
_LONG_DROP = 0.0005


@dataclass(frozen=True)
class ReferenceLife:
    """Reference rating life.

    basic : L10r [revolutions]. load : P_ref [N], the load with which C gives it.
    slice_lives : (n,) lives of the slices of all rollers at one position along them [revolutions], infinite without
    load; None for balls. slice_loads : (n,) P_k [N], the equivalent load of the bearing if all slices were as this one.
    highest_slice : load per length of the most loaded slice of a roller [N/m]; None for balls.
    mean_of_roller : mean load per length of the most loaded roller [N/m]; None for balls.
    """

    basic: float
    load: float
    highest_slice: float | None = None
    mean_of_roller: float | None = None
    slice_lives: FloatArray | None = None
    slice_loads: FloatArray | None = None

    def modified(self, factor: Callable[[float], float | None]) -> float | None:
        """Return the life with a_ISO [revolutions], of rollers slice by slice; None where a_ISO is not defined.

        factor : a_ISO of an equivalent load [N].
        """
        if self.slice_lives is None or self.slice_loads is None:
            whole = factor(self.load)
            return None if whole is None else whole * self.basic
        failing = 0.0
        for life, load in zip(self.slice_lives.tolist(), self.slice_loads.tolist(), strict=True):
            if load == 0:
                continue
            own = factor(load)
            if own is None:
                return None
            failing += (own * life) ** -_LINE_SLOPE
        return float(failing ** (-1 / _LINE_SLOPE))


def ball_reference_life(bearing: BearingGeometry, rating: float, loads: Sequence[float]) -> ReferenceLife:
    """Return the reference rating life of a ball bearing with a turning inner ring.

    rating : basic dynamic load rating C [N]. loads : of all balls [N].
    """
    g = 1.044 * ((1 - bearing.gamma) / (1 + bearing.gamma)) ** 1.72
    inner = rating / (0.407 * bearing.count) * (1 + g ** (10 / 3)) ** 0.3
    outer = rating / (0.389 * bearing.count) * (1 + g ** (-10 / 3)) ** 0.3
    q = np.asarray(loads)
    turning = float(np.mean(q**3)) ** (1 / 3)
    standing = float(np.mean(q ** (10 / 3))) ** 0.3
    basic = 1e6 * ((turning / inner) ** (10 / 3) + (standing / outer) ** (10 / 3)) ** -0.9
    return ReferenceLife(basic, _reference_load(rating, basic, "ball"))


@dataclass(frozen=True)
class SlicedRollers:
    """Loads of the slices of all rollers.

    loads : [roller, slice] in N, without edge stress. length : of a roller [m].
    """

    loads: FloatArray
    length: float

    @property
    def load_per_length(self) -> FloatArray:
        """Load per length [roller, slice] in N/m."""
        return self.loads * self.loads.shape[1] / self.length

    def along(self, roller: int, highest: float) -> tuple[float, ...]:
        """Return the loads per length of a roller's slices [N/m] whose most loaded one would carry `highest` [N] on the
        whole length: what they carry beside their own load, such as centrifugal force, is even along the roller."""
        own = self.load_per_length[roller]
        even = highest / self.length - own.max()
        rounding = 1e-9 * own.max()
        return tuple(float(one) for one in own + (even if even > rounding else 0.0))


def profile_drop(position: FloatArray, diameter: float, length: float) -> FloatArray:
    """Return P [m], how far a roller's logarithmic reference profile lies below its straight line.

    position : from the middle [m]. The profile is infinitely deep at the ends; slices have their middles inside.
    """
    drop, depth = np.zeros_like(position), _DROP
    x, reach = np.abs(position), length
    if length > _LONG * diameter:
        x, reach, depth = x - 0.5 * (length - _LONG * diameter), _LONG * diameter, _LONG_DROP
    curved = x > 0
    drop[curved] = depth * diameter * -np.log(1 - (2 * x[curved] / reach) ** 2)
    return drop


def slice_rollers(
    bearing: BearingGeometry, load: float, *, clearance: float = 0.0, tilt: float = 0.0, profiled: bool = True
) -> SlicedRollers:
    """Share a radial load [N] between the slices of all rollers.

    clearance : diametral [m]. tilt : of the rings against each other about the axis across the load [rad].
    profiled : rollers with the logarithmic reference profile; straight ones otherwise.
    """
    from scipy.optimize import brentq

    assert bearing.length is not None
    length, count = bearing.length, bearing.count
    x = (np.arange(SLICES) + 0.5) * length / SLICES - 0.5 * length
    angles = 2 * math.pi * np.arange(count) / count
    relief = 2 * profile_drop(x, bearing.diameter, length) if profiled else np.zeros_like(x)
    lean = np.outer(np.tan(tilt * np.cos(angles)), x)
    stiffness = _LINE_STIFFNESS * (1e3 * length) ** (8 / 9) / SLICES

    def loads(shift: float) -> FloatArray:
        pressed = (shift * np.cos(angles) - 0.5 * clearance)[:, None] - lean - relief
        return np.asarray(stiffness * np.maximum(1e3 * pressed, 0.0) ** _LINE_POWER)

    def missing(shift: float) -> float:
        return float(np.sum(loads(shift) * np.cos(angles)[:, None])) / load - 1

    high = 0.5 * clearance + 1e-3 * (load / stiffness) ** (1 / _LINE_POWER)
    while missing(high) < 0:
        high *= 2
        if high > length:
            raise InputError("the rollers' slices cannot carry this load at this tilt")
    return SlicedRollers(loads(float(brentq(missing, -high, high, xtol=1e-18, rtol=1e-14))), length)


def edge_stress_factors(count: int = SLICES) -> FloatArray:
    """Return the factor on the load of every slice for stress at the ends of a roller: 1 in the middle."""
    k = np.arange(1, count + 1)
    share = np.abs(2 * k - count - 1) / (2 * count - 2)
    with np.errstate(divide="ignore"):
        return np.asarray(1 - 0.01 / np.log(1.985 * share))


def roller_reference_life(bearing: BearingGeometry, rating: float, rollers: SlicedRollers) -> ReferenceLife:
    """Return the reference rating life of a cylindrical roller bearing with a turning inner ring.

    rating : basic dynamic load rating C [N].
    """
    slices = rollers.loads.shape[1]
    g = 1.038 * ((1 - bearing.gamma) / (1 + bearing.gamma)) ** (143 / 108)
    single = rating / (LINE_REDUCTION * bearing.count) / slices ** (7 / 9)
    inner = single / 0.378 * (1 + g**4.5) ** (2 / 9)
    outer = single / 0.364 * (1 + g**-4.5) ** (2 / 9)
    q = rollers.loads * edge_stress_factors(slices)
    turning = np.mean(q**4, axis=0) ** 0.25
    standing = np.mean(q**4.5, axis=0) ** (2 / 9)
    failing = (turning / inner) ** 4.5 + (standing / outer) ** 4.5
    basic = 1e6 * float(np.sum(failing)) ** (-1 / _LINE_SLOPE)
    with np.errstate(divide="ignore"):
        lives = 1e6 * failing ** (-1 / _LINE_SLOPE)
    of_slices = np.array([_reference_load(rating, life, "roller") for life in lives * slices ** (-1 / _LINE_SLOPE)])
    along = rollers.load_per_length
    most = int(np.argmax(rollers.loads.sum(axis=1)))
    return ReferenceLife(
        basic,
        _reference_load(rating, basic, "roller"),
        float(along.max()),
        float(along[most].mean()),
        lives,
        of_slices,
    )


def _reference_load(rating: float, basic: float, rolling: str) -> float:
    """Return P_ref = C / L10r^(1/p), L10r in million revolutions."""
    return float(rating / (basic / 1e6) ** (1 / EXPONENT[rolling]))
