"""Error bars of a point film: the same film on a grid of half as many cells.

Films are of second order in the cells; other figures take more of the difference, and a fraction of the change of the
film. The highest pressure has no bar, since the spike before the outlet is narrower than the cells, nor has the central
one where the spike lies there. Films that change by a fifth or more are not of second order yet: more of the difference
counts, up to 1.8 times (`order_missed`).

The place where the grid begins changes films, too: by `rectangle_error`, and friction by the shear of oil as far again
(`inlet_shear`), which counts at light loads.

Verified in tests/accuracy/test_point_spike.py; judged by the experiment that `POINT_RULES` names.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from bem.accuracy.bars import GRID, INLET, RESIDUAL, ErrorBars
from bem.accuracy.film import film_change
from bem.accuracy.richardson import Table, relative, residual_errors, rows, to_half
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
POINT_RULES = Table(
    "point_error_bars",
    rows(
        "central_thickness central_pressure oil_layer flooded_layer",
        0.6,
        "Second order: 1.8 times Richardson.",
        film=0.05,
    ),
    rows(
        "minimum_thickness lambda_ratio traction_coefficient friction_power",
        0.6,
        "Second order, but differences may pass zero: the constriction may be narrower than cells (at least "
        "`narrow_error` then), and friction follows the film.",
        film=0.3,
    ),
    rows(
        "film_reduction meniscus_position",
        0.8,
        "A ratio of two films, and a place on whole cells; not judged by a stored experiment.",
        film=0.3,
    ),
)
"""Factors on the difference, and a floor on the relative change of the film times the figure (film)."""
_IN_CONSTRICTION = ("minimum_thickness", "lambda_ratio")
_STEEP, _HIGH = 0.5, 0.5
"""The spike is at the centre where pressure falls by the first fraction to a neighbouring cell and is more than the
second of the highest pressure: 3 of 30 random films, whose central pressures were 44 to 120 % off. Films below had at
most 7 %."""


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
        """Solve the film on so many cells."""
        asked = named(self, "load radii contact_modulus speeds lubricant bodies supply")
        film = solve_point_film(**asked, shape=cells, cavitation="mass_conserving")
        return replace(film, notes=without_argument_notes(film.notes))


def point_figures(case: PointCase, film: PointFilmSolution) -> dict[str, float]:
    """Return the headline figures, SI units."""
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
    """Return the error bars of the figures of a solution."""
    figures = point_figures(case, film)
    nx, ny = case.cells
    halved = min(nx, ny) >= 2 * FEWEST
    other = case.on((nx // 2, ny // 2) if halved else (2 * nx, 2 * ny))
    if other.status is not Status.CONVERGED:
        return ErrorBars.unknown(figures, NoBar.COARSER_UNSOLVED)
    there = figures | point_figures(case, other)  # a nearly flooded film may have a meniscus on one grid alone
    ratio = 0.5 if halved else 2.0
    # films that change much are not of second order yet
    beyond = {
        name: value + order_missed(abs(value - there[name]), value) * (there[name] - value)
        for name, value in figures.items()
    }
    changed = to_half(ratio) * film_change(figures, there)
    grid = POINT_RULES.errors(figures, beyond, {"film": relative(changed, figures)}, ratio=ratio)
    for name in _IN_CONSTRICTION:
        if name in grid:
            grid[name] = max(grid[name], narrow_error(film.thickness) * figures[name])
    assert film.state is not None
    inlet = relative(rectangle_error(film.state.case), figures)
    shear = inlet_shear(film, film.state.case)
    inlet["traction_coefficient"] += shear / film.load
    inlet["friction_power"] += shear * float(np.hypot(*np.subtract(*film.speeds)))
    bars = ErrorBars.together({GRID: grid, INLET: inlet, RESIDUAL: residual_errors(film.residual, figures)})
    spiked = spike_at_centre(film.x, film.y, film.pressure)
    return bars.without("central_pressure", NoBar.SPIKE_AT_CENTRE) if spiked else bars
