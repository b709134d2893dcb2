"""Flow factors of rough walls in Reynolds' equation (Patir and Cheng), for line and point contacts, in units of its
solvers.

    q = -phi_x h^3/(12 mu) dp/dx + (u1 + u2)/2 (h + k s phi_s),    k = (u1 - u2)/(u1 + u2) x share,

for roughness on wall 1 (share 1), wall 2 (-1) or both ((s1^2 - s2^2)/s^2): N. Patir and H. S. Cheng, *J. Lubr.
Technol.* 100 (1978) 12 and 101 (1979) 220. Pressure follows from the change of h + k s phi_s: where phi_s falls as h
grows, roughness on the faster wall thins the film. In the plane phi_y is the factor of the Poiseuille flow along y;
both walls move along x.

Knows curves and numbers; `bem.flow` computes tables. Verified in tests/lubrication/test_rough_walls.py and
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
from bem.notes.lubrication import FLOW_FACTORS_LIMIT

Curve = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
LEAST_FACTOR = 1e-4
"""Lower bound of pressure flow factors: where contact bars all flow the film is carried by Couette flow, and Newton's
equations still contain the pressure."""


@runtime_checkable
class WallFactors(Protocol):
    """Interface of a table of flow factors; `bem.FlowFactors` has it. Curves return a factor and its slope [1/m]."""

    @property
    def separations(self) -> FloatArray:
        """Separations of the table, ascending [m]."""

    @property
    def rms_height(self) -> float:
        """Rms height s of both walls together [m]."""

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
    """Interface of a table for films in the plane."""

    @property
    def pressure_y_curve(self) -> Curve:
        """phi_y over separation [m]."""


@dataclass(frozen=True)
class RoughWalls:
    """Flow factors along x, of films in units.

    film : unit of films [m]. drag : k s in that unit.
    """

    pressure_curve: Curve
    shear_curve: Curve
    film: float
    drag: float

    @classmethod
    def of(cls, factors: WallFactors, film: float, speeds: Sequence[float]) -> RoughWalls:
        """Return the factors for films in the unit `film` [m] and speeds (u1, u2)."""
        sliding = (speeds[0] - speeds[1]) / (speeds[0] + speeds[1])
        drag = sliding * factors.wall_share * factors.rms_height / film
        return cls(factors.pressure_x_curve, factors.shear_x_curve, film, float(drag))

    def poiseuille_cube(self, thickness: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return phi_x h^3 and half its derivative."""
        value, slope = _bounded(self.pressure_curve, thickness, self.film)
        return value * thickness**3, 0.5 * (3 * value * thickness**2 + slope * thickness**3)

    def couette_film(self, thickness: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return h + k s phi_s and its derivative."""
        if self.drag == 0:
            return thickness, np.ones_like(thickness)
        value, slope = self.shear_curve(thickness * self.film)
        return thickness + self.drag * value, 1 + self.drag * self.film * slope


@dataclass(frozen=True)
class PlaneWalls:
    """Flow factors of films in the plane: along x, and the curve of phi_y."""

    along: RoughWalls
    across_curve: Curve

    def on(self, thickness: FloatArray) -> FloatArray:
        """Return phi_x, phi_y and h + k s phi_s with their derivatives, (6, nx, ny), for films (nx, ny) in their
        unit."""
        along = _bounded(self.along.pressure_curve, thickness, self.along.film)
        across = _bounded(self.across_curve, thickness, self.along.film)
        return np.stack([*along, *across, *self.along.couette_film(thickness)])


def plane_walls_of(factors: WallFactors | str, film: float, speeds: Sequence[Sequence[float]]) -> PlaneWalls | None:
    """Return the flow factors of a film in the plane, in the unit `film` [m], for speeds ((u1x, u1y), (u2x, u2y)); None
    for "off".

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
    """Return a pressure flow factor, bounded from below, and its derivative with the film in its unit [m]."""
    value, slope = curve(thickness * film)
    low = value < LEAST_FACTOR
    return np.where(low, LEAST_FACTOR, value), np.where(low, 0.0, slope * film)


def walls_of(factors: WallFactors | str, film: float, speeds: Sequence[float]) -> RoughWalls | None:
    """Return the flow factors of a line film in the unit `film` [m]; None for "off".

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
    """Return a note where the film is thinner than the table of its flow factors; `thinnest` is its minimum [m]."""
    if isinstance(factors, str):
        return ()
    if float(factors.pressure_x_curve(np.array([thinnest]))[0][0]) <= LEAST_FACTOR:
        return (FLOW_FACTORS_LIMIT(thinnest=float(thinnest), least=LEAST_FACTOR, reason="film"),)
    least = float(np.min(factors.separations))
    if thinnest >= least:
        return ()
    return (FLOW_FACTORS_LIMIT(thinnest=float(thinnest), least=least, reason="extrapolated"),)
