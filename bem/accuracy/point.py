"""Error bars of a point film: the same film on a grid of half as many cells.

The bar is an estimate by Richardson, as that of line films (`bem.accuracy.film`): films are of second order in the
cells, which leaves a third of the difference, times a safety factor; other figures take more of it, and a share of what
the film changes by, since their differences may pass zero. The highest pressure has none: the spike before the outlet
is narrower than the cells; nor has the central one where the spike lies there.

Where the grid begins changes films, too: bars are widened by `rectangle_error`, as the errors of the film itself are;
friction by the shear of oil as far again (`inlet_shear`), which counts where loads are light. Films that change by a
fifth or more are not of second order yet, and more of the difference counts, up to 1.8 times.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bem.accuracy.bars import GRID, INLET, RESIDUAL, TWICE, ErrorBars
from bem.accuracy.film import FilmRule
from bem.arguments import named
from bem.errors import Status
from bem.grid import FloatArray
from bem.lubrication import Lubricant, PointFilmSolution, solve_point_film
from bem.lubrication.point.certificate import narrow_error, order_missed, rectangle_error
from bem.lubrication.point.validity import inlet_shear
from bem.lubrication.supply import Supply
from bem.materials import Body
from bem.notes.accuracy import NoBar
from bem.plausibility import without_argument_notes

FEWEST = 32
"""Cells along an axis below which no film is solved."""
POINT_RULES = {
    "central_thickness": FilmRule(0.6, 0.05),
    "minimum_thickness": FilmRule(0.6, 0.3),
    "central_pressure": FilmRule(0.8, 0.05),
    "traction_coefficient": FilmRule(0.8, 0.3),
    "friction_power": FilmRule(0.8, 0.3),
    "lambda_ratio": FilmRule(0.6, 0.3),
    "film_reduction": FilmRule(0.8, 0.3),
    "oil_layer": FilmRule(0.6, 0.05),
    "flooded_layer": FilmRule(0.6, 0.05),
    "meniscus_position": FilmRule(0.8, 0.3),
}
_LEAST = ("minimum_thickness", "lambda_ratio")
"""In a constriction, which may be narrower than cells: differences then show no order, and how steep it is tells."""
_ALGEBRAIC = 10.0
"""Relative change of a figure over the residual of the equations."""
_STEEP, _HIGH = 0.5, 0.5
"""The spike is at the centre where pressure falls by that share to one of the cells around it, and is more than that
share of the highest: of 30 random films three, whose central pressures were 44 to 120 % off; steep ones below were not
(by 7 % at most, within their bars)."""


@dataclass(frozen=True)
class PointCase:
    """Arguments of `bem.solve_point_film`; roughness [m] for the lambda ratio."""

    load: float
    radii: tuple[float, float]
    contact_modulus: float
    speeds: tuple[tuple[float, float], tuple[float, float]]
    lubricant: Lubricant
    cells: tuple[int, int]
    bodies: tuple[Body, ...] | None = None
    roughness: float | None = None
    supply: Supply | None = None

    def on(self, cells: tuple[int, int]) -> PointFilmSolution:
        """The film on so many cells."""
        asked = named(self, "load radii contact_modulus speeds lubricant bodies supply")
        film = solve_point_film(**asked, shape=cells, cavitation="mass_conserving")
        return replace(film, notes=without_argument_notes(film.notes))


def point_figures(case: PointCase, film: PointFilmSolution) -> dict[str, float]:
    """Headline figures, SI units."""
    slide = np.subtract(*film.speeds)
    sliding = 0.5 * (film.shear_force[1] - film.shear_force[0])
    figures = {
        "central_thickness": film.central_thickness,
        "minimum_thickness": film.minimum_thickness,
        "central_pressure": film.central_pressure,
        "traction_coefficient": film.friction,
        "friction_power": float(sliding @ slide),
    }
    if case.roughness is not None:
        figures["lambda_ratio"] = film.minimum_thickness / case.roughness
    if film.starvation is not None:
        lacking = film.starvation
        figures |= {"film_reduction": lacking.reduction, "oil_layer": lacking.layer}
        figures["flooded_layer"] = lacking.flooded_layer
        if not lacking.flooded:
            figures["meniscus_position"] = lacking.meniscus_position
    return figures


def spike_at_centre(x: FloatArray, y: FloatArray, pressure: FloatArray) -> bool:
    """Return True if the pressure (nx, ny) [Pa] has its spike around the origin, at x (nx,) and y (ny,) [m]."""
    i, j = (int(np.abs(axis).argmin()) for axis in (x, y))
    around = pressure[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2]
    steep = float(around.min()) < (1 - _STEEP) * float(around.max())
    return steep and float(pressure[i, j]) > _HIGH * float(pressure.max())


def point_bars(case: PointCase, film: PointFilmSolution) -> ErrorBars:
    """Bars of the figures of a solution."""
    figures = point_figures(case, film)
    halved = all(n >= 2 * FEWEST for n in case.cells)
    nx, ny = case.cells
    other = case.on((nx // 2, ny // 2) if halved else (2 * nx, 2 * ny))
    if other.status is not Status.CONVERGED:
        return ErrorBars.unknown(figures, NoBar.COARSER_UNSOLVED)
    there = figures | point_figures(case, other)  # nearly flooded, one grid may have no meniscus
    share = 1.0 if halved else TWICE
    films = ("central_thickness", "minimum_thickness")
    changed = max(abs(there[name] / figures[name] - 1) for name in films)
    assert film.state is not None
    shear, begins = inlet_shear(film, film.state.case), rectangle_error(film.state.case)
    slide = float(np.hypot(*np.subtract(*film.speeds)))
    beyond = {"traction_coefficient": shear / film.load, "friction_power": shear * slide}
    grid: dict[str, Any] = {}
    inlet: dict[str, Any] = {}
    residual: dict[str, Any] = {}
    for name, value in figures.items():
        rule = POINT_RULES[name]
        difference = abs(value - there[name])
        factor = rule.factor * order_missed(difference, value)
        grid[name] = share * (factor * difference + rule.film * changed * abs(value))
        if name in _LEAST:
            grid[name] = max(grid[name], narrow_error(film.thickness) * value)
        inlet[name] = begins * abs(value) + beyond.get(name, 0.0)
        residual[name] = _ALGEBRAIC * film.residual * abs(value)
    bars = ErrorBars.together({GRID: grid, INLET: inlet, RESIDUAL: residual})
    spiked = spike_at_centre(film.x, film.y, film.pressure)
    return bars.without("central_pressure", NoBar.SPIKE_AT_CENTRE) if spiked else bars
