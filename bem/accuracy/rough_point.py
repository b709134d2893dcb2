"""Error bars of a rough point film with contact inside: the same film on a grid of half as many cells a side.

Bumps are a few cells long, and neither shares of the load nor areas in contact show an order on such grids: the bar is
the whole difference and more (`FACTORS`), and no less than the share by which the mean film changed. On 15 random balls
(64 to 68 cells a side, waves from 0.4 of Hertz' radius on, against three times the cells) the difference alone covered
11 of 15 mean films, 6 of 9 minima above the least film and 5 of 6 shares of the load: from these the factors were
chosen (with them 15, 8 and 6). On others the coverage was not counted, which a note says; at a place between bumps (the
centre) and for the highest pressure there is none.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from bem.accuracy.bars import GRID, RESIDUAL, ErrorBars
from bem.accuracy.point import FEWEST
from bem.arguments import named
from bem.errors import Status
from bem.lubrication import Lubricant, RoughPointFilm, solve_rough_point_film
from bem.lubrication.point.moving import Heights
from bem.materials import Body

UNCOUNTED = (
    "error bars of films of rough bodies are what half as many cells a side change, times factors chosen on 15 random "
    "balls: how often they cover the error of others was not counted"
)
UNSOLVED = "no error bars of the film: on half as many cells a side no film was found"
FEW = f"no error bars of the film: half as many cells a side are fewer than {FEWEST}"
CENTRE = "film and pressure at the centre have no error bar: they are of one place among bumps a few cells long"
FACTORS = {"minimum_thickness": 3.5, "mean_thickness": 2.5, "contact_load_share": 1.5, "contact_area_share": 1.5}
"""On the difference."""
MET = 1e-6
"""Of a least film, what a thinnest one may lie above it and still be it."""
_ALGEBRAIC = 10.0
"""Relative change of a figure over the residual of the equations."""


@dataclass(frozen=True)
class RoughPointCase:
    """Arguments of `bem.solve_rough_point_film`, and the coefficient of friction of what surfaces carry."""

    load: float
    radii: tuple[float, float]
    contact_modulus: float
    speeds: tuple[tuple[float, float], tuple[float, float]]
    lubricant: Lubricant
    heights: Heights
    least_film: float
    boundary_friction: float
    bodies: tuple[Body, ...] | None = None

    def on(self, cells: tuple[int, int]) -> RoughPointFilm:
        """The film on so many cells."""
        asked = named(self, "load radii contact_modulus speeds lubricant heights least_film bodies")
        return solve_rough_point_film(**asked, shape=cells, errors=False)


def rough_point_figures(case: RoughPointCase, film: RoughPointFilm, hertz_area: float) -> dict[str, float]:
    """Figures that have bars, SI units."""
    friction = film.friction(case.boundary_friction)
    return {
        "minimum_thickness": film.minimum_thickness,
        "mean_thickness": film.mean_thickness,
        "contact_load_share": film.contact_share,
        "contact_area_share": film.contact_area / hertz_area,
        "traction_coefficient": friction,
        "friction_power": friction * film.load * math.hypot(*np.subtract(*film.speeds)),
    }


def rough_point_bars(case: RoughPointCase, film: RoughPointFilm, hertz_area: float) -> ErrorBars:
    """Bars of the figures of a film."""
    figures = rough_point_figures(case, film, hertz_area)
    missing = ("central_thickness", "central_pressure")
    nx, ny = film.thickness.shape
    if min(nx, ny) < 2 * FEWEST:
        return ErrorBars.unknown((*figures, *missing), FEW)
    other = case.on((nx // 2, ny // 2))
    if other.status is not Status.CONVERGED:
        return ErrorBars.unknown((*figures, *missing), UNSOLVED)
    there = rough_point_figures(case, other, hertz_area)
    changed = abs(there["mean_thickness"] / figures["mean_thickness"] - 1)
    least = {name: changed * value for name, value in figures.items()}
    # a least film is met on all grids; a minimum above it moves as far as the film around it
    met = figures["minimum_thickness"] < (1 + MET) * case.least_film
    least["minimum_thickness"] = 0.0 if met else changed * figures["mean_thickness"]
    grid = {
        name: max(FACTORS.get(name, 1.0) * abs(value - there[name]), least[name]) for name, value in figures.items()
    }
    residual = {name: _ALGEBRAIC * film.residual * abs(value) for name, value in figures.items()}
    bars = ErrorBars.together({GRID: grid, RESIDUAL: residual}, notes=(UNCOUNTED,))
    return bars | ErrorBars.unknown(missing, CENTRE)
