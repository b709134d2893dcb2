"""Flow between rough walls in Reynolds' equation of line and point contacts: Patir and Cheng's factors in its units.

    q = -phi_x h^3/(12 mu) dp/dx + (u1 + u2)/2 (h + k s phi_s),    k = (u1 - u2)/(u1 + u2) x share,

for roughness on wall 1 (share 1), wall 2 (-1) or both ((s1^2 - s2^2)/s^2): J. Lubr. Technol. 101 (1979) 220. What makes
pressure is the change of h + k s phi_s: where phi_s falls as h grows, roughness on the faster wall thins the film. In
the plane phi_y has its part in what the pressure drives along y; both walls move along x.
Knows curves and numbers; `bem.flow` makes them. Verified in tests/lubrication/test_rough_walls.py and
tests/lubrication/point/test_rough_point.py.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np

from bem.errors import InputError
from bem.grid import FloatArray
from bem.notes import Note
from bem.notes.contact import FLOW_BARRED
from bem.notes.lubrication import FACTORS_EXTRAPOLATED

Curve = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
LEAST_FACTOR = 1e-4
"""Pressure flow factors are kept from below at this: where contact bars all flow the film is what is dragged along, and
Newton's equations still have a pressure in them."""


@runtime_checkable
class WallFactors(Protocol):
    """What a table of flow factors must offer: `bem.FlowFactors` does. Curves give a factor and its slope [1/m]."""

    @property
    def separations(self) -> FloatArray:
        """Where the table has values, rising [m]."""

    @property
    def rms_height(self) -> float:
        """s [m]."""

    @property
    def wall_share(self) -> float:
        """(s1^2 - s2^2)/s^2."""

    @property
    def pressure_x_curve(self) -> Curve:
        """phi_x over separation [m]."""

    @property
    def shear_x_curve(self) -> Curve:
        """phi_s over separation [m]."""


@runtime_checkable
class PlaneWallFactors(WallFactors, Protocol):
    """What it must offer for films in the plane besides."""

    @property
    def pressure_y_curve(self) -> Curve:
        """phi_y over separation [m]."""


@dataclass(frozen=True)
class RoughWalls:
    """Factors of films in the unit `film` [m]; `drag` is k s in that unit."""

    pressure_curve: Curve
    shear_curve: Curve
    film: float
    drag: float

    @classmethod
    def of(cls, factors: WallFactors, film: float, speeds: Sequence[float]) -> RoughWalls:
        """In the unit of films `film` [m], for speeds (u1, u2)."""
        sliding = (speeds[0] - speeds[1]) / (speeds[0] + speeds[1])
        drag = sliding * factors.wall_share * factors.rms_height / film
        return cls(factors.pressure_x_curve, factors.shear_x_curve, film, float(drag))

    def cube(self, thickness: FloatArray) -> tuple[FloatArray, FloatArray]:
        """phi_x h^3 and half its derivative."""
        value, slope = _bounded(self.pressure_curve, thickness, self.film)
        return value * thickness**3, 0.5 * (3 * value * thickness**2 + slope * thickness**3)

    def dragged(self, thickness: FloatArray) -> tuple[FloatArray, FloatArray]:
        """h + k s phi_s and its derivative."""
        if self.drag == 0:
            return thickness, np.ones_like(thickness)
        value, slope = self.shear_curve(thickness * self.film)
        return thickness + self.drag * value, 1 + self.drag * self.film * slope


@dataclass(frozen=True)
class PlaneWalls:
    """Factors of films in the plane: what goes along x, and the curve of what pressure drives along y."""

    along: RoughWalls
    across_curve: Curve

    def on(self, thickness: FloatArray) -> FloatArray:
        """Of films (nx, ny) in their unit (6, nx, ny): phi_x, phi_y and h + k s phi_s, each with its derivative."""
        along = _bounded(self.along.pressure_curve, thickness, self.along.film)
        across = _bounded(self.across_curve, thickness, self.along.film)
        return np.stack([*along, *across, *self.along.dragged(thickness)])


def plane_walls_of(factors: WallFactors | str, film: float, speeds: Sequence[Sequence[float]]) -> PlaneWalls | None:
    """The walls of a film in the plane in the unit `film` [m], for speeds ((u1x, u1y), (u2x, u2y)); None where factors
    are "off".

    Raises
    ------
    InputError : neither "off" nor a table with both pressure factors; speeds across x, for which a table has no shear
        flow.
    """
    if isinstance(factors, str) and factors == "off":
        return None
    if not isinstance(factors, PlaneWallFactors):
        raise InputError(f'flow_factors: {factors!r} must be "off" or a table of bem.flow_factors')
    if any(speed[1] for speed in speeds):
        raise InputError("flow_factors: a table has the shear flow of walls that move along x; give speeds along x")
    return PlaneWalls(RoughWalls.of(factors, film, [speed[0] for speed in speeds]), factors.pressure_y_curve)


def _bounded(curve: Curve, thickness: FloatArray, film: float) -> tuple[FloatArray, FloatArray]:
    """A pressure flow factor, kept from below, and its derivative with the film in its unit [m]."""
    value, slope = curve(thickness * film)
    low = value < LEAST_FACTOR
    return np.where(low, LEAST_FACTOR, value), np.where(low, 0.0, slope * film)


def walls_of(factors: WallFactors | str, film: float, speeds: Sequence[float]) -> RoughWalls | None:
    """The walls of a film in the unit `film` [m]; None where factors are "off".

    Raises
    ------
    InputError : neither "off" nor a table.
    """
    if isinstance(factors, str) and factors == "off":
        return None
    if not isinstance(factors, WallFactors):
        raise InputError(f'flow_factors: {factors!r} must be "off" or a table of bem.flow_factors')
    return RoughWalls.of(factors, film, speeds)


def notes_on_factors(factors: WallFactors | str, thinnest: float) -> tuple[Note, ...]:
    """Return a note where a film needs factors that its table does not hold; `thinnest` : its thinnest place [m]."""
    if isinstance(factors, str):
        return ()
    if float(factors.pressure_x_curve(np.array([thinnest]))[0][0]) <= LEAST_FACTOR:
        return (FLOW_BARRED(thinnest=float(thinnest), least=LEAST_FACTOR, reason="film"),)
    least = float(np.min(factors.separations))
    if thinnest >= least:
        return ()
    return (FACTORS_EXTRAPOLATED(thinnest=float(thinnest), least=least),)
