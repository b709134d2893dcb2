"""Scatter of a film's friction from the scatter of its oil's constants in shear.

Oils of one base differ: each constant of the shear law "base_oil" has a range (`bem.lubrication.rheology`). The
friction of a solved film is evaluated anew with each constant at both ends of its range, at the film's own pressures,
thicknesses and temperatures, and the changes are added in quadrature, as of independent constants. A film whose heat is
solved for gets warmer where its friction is larger, so that the scatter of the solved friction is smaller than this
estimate: it is an upper bound. Verified in tests/lubrication/test_oil_scatter.py.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from bem.errors import InputError, Status
from bem.grid import FloatArray
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.point.film import PointFilmSolution
from bem.lubrication.point.rough_film import RoughPointFilm
from bem.lubrication.results import FilmSolution
from bem.lubrication.rheology import ShearRheology, bases_known, rheology_of
from bem.lubrication.shear import BaseOilShear
from bem.lubrication.thermal.full import FullThermalFilm
from bem.lubrication.thermal.hot_viscosity import HotViscosity
from bem.lubrication.thermal.lumped import ThermalFilm


@dataclass(frozen=True)
class OilScatter:
    """Sliding friction of a film and its scatter from the oil's constants.

    friction : sliding force over load. down, up : scatter to smaller and larger friction, positive.
    parts : change of the friction with each constant at its low and its high end, by the law's parameter.
    """

    friction: float
    down: float
    up: float
    parts: Mapping[str, tuple[float, float]]

    @property
    def half_width(self) -> float:
        """Mean of both scatters."""
        return 0.5 * (self.down + self.up)

    def __str__(self) -> str:
        return f"{self.friction:.3g} (-{self.down:.2g}, +{self.up:.2g} by the oil's constants)"


def friction_scatter(
    film: FilmSolution | PointFilmSolution | RoughPointFilm | ThermalFilm | FullThermalFilm,
    lubricant: Lubricant,
    friction: float,
) -> float | None:
    """Return the scatter of a friction coefficient from the oil's constants, as a half-width: the film's own relative
    scatter times the coefficient. Its cost is that of nine evaluations of the law.

    Parameters
    ----------
    film : steady film that the friction is of, or its part of the load.
    lubricant : the oil as it was given to the solver.
    friction : coefficient, or the part of one that is of the film.

    Returns
    -------
    None with another shear law than "base_oil", and where film or coefficient are not known; zero without sliding.
    """
    if not isinstance(lubricant.shear_law, BaseOilShear) or not math.isfinite(friction):
        return None
    if film.status is not Status.CONVERGED:
        return None
    found = oil_scatter(film, lubricant)
    return abs(friction / found.friction) * found.half_width if found.friction > 0 else 0.0


def oil_scatter(
    film: FilmSolution | PointFilmSolution | RoughPointFilm | ThermalFilm | FullThermalFilm,
    lubricant: Lubricant | None = None,
    rheology: ShearRheology | None = None,
) -> OilScatter:
    """Return the scatter of a film's sliding friction from the scatter of the oil's constants.

    Parameters
    ----------
    film : steady film of a line or a point contact, with or without heat; of rough surfaces the oil between those that
        do not touch.
    lubricant : the oil as it was given to the solver; by default the film's own, which a film with lumped heat has as
        thin as inlet heating leaves it.
    rheology : constants with their ranges; by default those of the oil. A constant that the lubricant has otherwise
        than as the central value was given by the user and counts as exact.

    Raises
    ------
    InputError : a lubricant with another shear law than "base_oil".
    """
    solved = film.as_film() if isinstance(film, ThermalFilm | FullThermalFilm) else film
    oil = lubricant or solved.lubricant
    law = oil.shear_law
    if not isinstance(law, BaseOilShear):
        raise InputError(f'oil_scatter: shear_law "{law.name}" has no known scatter; allowed: "base_oil"')
    if isinstance(solved, PointFilmSolution | RoughPointFilm):
        sheared, load = _sheared_point(solved, oil), solved.load
    else:
        sheared, load = _sheared_line(solved, oil), solved.load

    def friction(of: BaseOilShear) -> float:
        stress = of.shear_stress(sheared.newtonian, sheared.pressure, sheared.temperature)
        return float(np.sum(sheared.weight * stress)) / load

    return constants_scatter(oil, friction, rheology)


def constants_scatter(
    oil: Lubricant, friction: Callable[[BaseOilShear], float], rheology: ShearRheology | None = None
) -> OilScatter:
    """Return a friction and its scatter from the scatter of the oil's constants.

    Parameters
    ----------
    oil : with shear law "base_oil".
    friction : any measure of friction over the shear law, in whose unit the result is.
    rheology : as of `oil_scatter`.
    """
    law = oil.shear_law
    assert isinstance(law, BaseOilShear)
    known = rheology or _rheology(oil, law)
    middle, parts = friction(law), {}
    for name, constant in known.constants().items():
        if getattr(law, name) != constant.value:
            continue
        ends = (dataclasses.replace(law, **{name: end}) for end in (constant.low, constant.high))
        low, high = (friction(end) - middle for end in ends)
        parts[name] = (low, high)
    down = math.sqrt(sum(min(*ends, 0.0) ** 2 for ends in parts.values()))
    up = math.sqrt(sum(max(*ends, 0.0) ** 2 for ends in parts.values()))
    return OilScatter(middle, down, up, parts)


def _rheology(oil: Lubricant, law: BaseOilShear) -> ShearRheology:
    """Return the constants of an oil with their ranges; of one without a name those of the base whose central values
    are the law's in most places."""
    if oil.oil is not None and oil.oil.shear is not None:
        return oil.oil.shear
    if oil.oil is not None:
        return rheology_of(oil.oil.base)
    given = law.values()

    def agreeing(rheology: ShearRheology) -> int:
        return sum(given[name] == value for name, value in rheology.parameters().items())

    return max(map(rheology_of, bases_known()), key=agreeing)


@dataclass(frozen=True)
class _Sheared:
    """State of sheared places of a film, arrays of one shape: size of the Newtonian stress [Pa], pressure [Pa],
    temperature [K], area or length that it counts with."""

    newtonian: FloatArray
    pressure: FloatArray
    temperature: FloatArray | float | None
    weight: FloatArray


def _sheared_line(film: FilmSolution, oil: Lubricant) -> _Sheared:
    """Nodes of a line film, weighted by the trapezoidal rule."""
    pressure = np.maximum(film.pressure, 0.0)
    weight = np.where(film.pressure > 0, np.gradient(film.position), 0.0)
    rate = abs(film.speeds[0] - film.speeds[1]) / film.thickness
    if film.heat is None:
        return _Sheared(oil.viscosity_at(pressure) * rate, pressure, oil.temperature, weight)
    at = np.interp(film.position, film.heat.position, film.heat.film_temperature)
    return _Sheared(HotViscosity.of(oil)(pressure, at)[0] * rate, pressure, at, weight)


def _sheared_point(film: PointFilmSolution | RoughPointFilm, oil: Lubricant) -> _Sheared:
    """Cells of a point film."""
    cell = float((film.x[1] - film.x[0]) * (film.y[1] - film.y[0]))
    weight = np.where(film.pressure > 0, cell, 0.0)
    slide = math.hypot(*np.subtract(film.speeds[1], film.speeds[0]))
    rate = slide / film.thickness
    if isinstance(film, RoughPointFilm):
        weight = np.where(film.touching, 0.0, weight)
        return _Sheared(oil.viscosity_at(film.oil_pressure) * rate, film.oil_pressure, oil.temperature, weight)
    if film.temperature is None:
        return _Sheared(oil.viscosity_at(film.pressure) * rate, film.pressure, oil.temperature, weight)
    flat = HotViscosity.of(oil)(film.pressure.ravel(), film.temperature.ravel())[0]
    return _Sheared(flat.reshape(film.pressure.shape) * rate, film.pressure, film.temperature, weight)
