"""Error bars of a rolling and sliding line contact, with or without heat: the same on half the points.

The bar is the difference to half the points, which order two makes three times the error, and a share of what the film
changes by, since differences may pass zero: an estimate and no proved bound, of the mesh alone. What the lumped model
of heat leaves out is not in it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from bem.accuracy.bars import POINTS, RESIDUAL, ErrorBars
from bem.accuracy.film import FEWEST
from bem.errors import Status
from bem.lubrication import FilmSolution, Lubricant, ThermalFilm, solve_line_film, solve_thermal_line_film
from bem.materials import Body

FILM_SHARE = 0.3
"""Of the relative change of the film, in the bar of every figure that is no temperature."""
RISE_SHARE = 0.3
"""Of the same, over the rise, in that of temperatures."""
_ALGEBRAIC = 10.0
"""Relative change of a figure over the residual of the equations, relative to the film."""
_UNSOLVED = "no error bars of traction: on half the points the film did not converge"
_BARE = ("energy_imbalance", "inlet_factor")
"""Rounding, and a formula that no mesh changes."""
_TEMPERATURES = ("film_temperature", "lower_temperature", "upper_temperature")


@dataclass(frozen=True)
class TractionCase:
    """Arguments of `bem.solve_line_film`, or with `bodies` of `bem.solve_thermal_line_film`; `bulk` [K] then;
    the power is that on a width [m]."""

    load: float
    radius: float
    contact_modulus: float
    speeds: tuple[float, float]
    lubricant: Lubricant
    points: int
    width: float = 1.0
    bodies: tuple[Body, Body] | None = None
    bulk: tuple[float, ...] = ()

    @property
    def hot(self) -> bool:
        """Whether heat is solved for."""
        return self.bodies is not None

    def on(self, points: int, initial: FilmSolution | None = None) -> Any:
        """The film on a mesh of so many points: a `ThermalFilm` with heat, else a `FilmSolution`."""
        asked: dict[str, Any] = {
            "load": self.load,
            "radius": self.radius,
            "contact_modulus": self.contact_modulus,
            "speeds": self.speeds,
            "lubricant": self.lubricant,
            "points": points,
            "initial": initial,
        }
        if self.bodies is None:
            return solve_line_film(**asked)
        return solve_thermal_line_film(**asked, bodies=self.bodies, bulk=self.bulk)


def traction_figures(case: TractionCase, found: FilmSolution | ThermalFilm) -> dict[str, float]:
    """Headline figures, SI units; the power is that on the case's width."""
    film = found.film if isinstance(found, ThermalFilm) else found
    force, rolling = found.shear_force, 0.25 * _rolling(film)
    figures = {
        "traction_coefficient": force / film.load,
        "sliding_traction": (found.sliding_force if isinstance(found, ThermalFilm) else force - rolling) / film.load,
        "minimum_thickness": film.minimum_thickness,
        "central_thickness": film.central_thickness,
        "maximum_pressure": float(film.pressure.max()),
    }
    if not isinstance(found, ThermalFilm):
        return figures
    power = found.friction_power or 1.0
    return figures | {
        "film_temperature": found.highest_film_temperature,
        "lower_temperature": float(found.surface_temperatures[0].max()),
        "upper_temperature": float(found.surface_temperatures[1].max()),
        "inlet_factor": found.inlet.factor,
        "friction_power": found.friction_power * case.width,
        "share_of_lower": found.power_into[0] / power,
        "share_of_upper": found.power_into[1] / power,
        "share_of_oil": found.power_carried / power,
        "energy_imbalance": found.energy_imbalance,
    }


def _rolling(film: FilmSolution) -> float:
    """Four times the integral of (h/2) dp/dx on the mesh."""
    return float(np.sum((film.thickness[1:] + film.thickness[:-1]) * np.diff(film.pressure)))


def traction_bars(case: TractionCase, found: FilmSolution | ThermalFilm) -> ErrorBars:
    """Bars of the figures of a solution on all points."""
    figures = {name: value for name, value in traction_figures(case, found).items() if name not in _BARE}
    film = found.film if isinstance(found, ThermalFilm) else found
    other = case.on(max(case.points // 2, FEWEST) if case.points > FEWEST else 2 * case.points)
    if other.status is not Status.CONVERGED:
        return ErrorBars.unknown(figures, _UNSOLVED)
    there = traction_figures(case, other)
    changed = max(abs(there[name] / figures[name] - 1) for name in ("minimum_thickness", "central_thickness"))
    points, residual = {}, {}
    for name, value in figures.items():
        size = abs(value if name not in _TEMPERATURES else value - min(case.bulk))
        share = RISE_SHARE if name in _TEMPERATURES else FILM_SHARE
        points[name] = abs(there[name] - value) + share * changed * size
        residual[name] = _ALGEBRAIC * film.residual * size
    return ErrorBars.together({POINTS: points, RESIDUAL: residual})
