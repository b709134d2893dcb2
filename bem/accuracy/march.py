"""Error bars of a film in time, of a line or a point contact: fewer points, and fewer steps on these.

Mesh and steps of `bem.march_line_film` and `bem.march_point_film` are of second order. The march on half the points
(along either axis; on twice as many where half are too few) shows the error of the mesh, a third one, on the fewer of
both, of steps twice as long that of the steps; with half the points both take about half as long as the march itself.
The bar is the sum of both errors. The time of the thinnest film jumps between minima and has no bar.

Verified in tests/accuracy/test_march_bars.py; judged by the experiment that the tables name, of line contacts.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bem.accuracy.bars import POINTS, RESIDUAL, STEPS, ErrorBars
from bem.accuracy.richardson import Table, residual_errors, rows
from bem.arguments import named
from bem.errors import Status
from bem.grid import FloatArray
from bem.lubrication import (
    Cavitation,
    FilmSolution,
    Lubricant,
    MovingSurface,
    PointFilmSolution,
    march_line_film,
    march_point_film,
)
from bem.materials import Body
from bem.notes.accuracy import NoBar

FIGURES = ("thinnest_film", "film_at_end", "largest_shear_force")
"""Figures of a line film."""
FEWEST = 101
"""Points of a line film below which none is marched."""
FEWEST_CELLS = 32
"""Cells of a point film along an axis below which none is marched."""
_FIGURES = "thinnest_film film_at_end largest_shear_force central_film_at_end thickest_central_film"
MESH_RULES = Table(
    "march_error_bars",
    rows(_FIGURES, 1.3, "Second order; coarse motions are not there yet, and 0.8 covered eight in ten of fresh ones."),
)
"""Factor on the difference to half the points."""
STEP_RULES = Table(
    "march_error_bars",
    rows(_FIGURES, 3.0, "Second order; the steps are compared on the coarser mesh, and 2 covered eight in ten."),
)
"""Factor on the difference to steps twice as long."""
_APART = 1.5
"""Points over those of the coarser mesh, below which twice as many are taken: between meshes of 101 and 102 points the
thinnest film differed by little, of which second order made a bar of 0.3 % where the error was 16 %."""
_TOLERANCE = 1e-7
"""Largest residual of a step, relative to the film and the load."""


@dataclass(frozen=True, eq=False)
class MarchCase:
    """Films of a march, and the arguments of `bem.march_line_film`."""

    films: Sequence[FilmSolution]
    times: FloatArray
    load: Callable[[float], float]
    speeds: Callable[[float], Sequence[float]]
    radius: float
    contact_modulus: float
    lubricant: Lubricant
    points: int
    initial_thickness: float | None = None
    cavitation: Cavitation | str = Cavitation.SWIFT_STIEBER
    layer: float | None = None

    def again(self, points: int, every: int = 1, **going_on: Any) -> list[FilmSolution]:
        """March with other points, at every so many of the times and the last one.

        going_on : further arguments: a state to start from, a function to call after each step.
        """
        asked = named(self, "load speeds radius contact_modulus lubricant initial_thickness cavitation")
        times = every_so_many(self.times, every)
        return march_line_film(times, **asked, points=points, supply=self.layer, **going_on)


def march_figures(films: Sequence[FilmSolution]) -> dict[str, float]:
    """Return the headline figures of a march: the thinnest of all minimum thicknesses [m], the last one [m] and the
    largest shear force per unit length [N/m]."""
    minimum = np.array([film.minimum_thickness for film in films])
    return {
        "thinnest_film": float(minimum.min()),
        "film_at_end": float(minimum[-1]),
        "largest_shear_force": float(max(abs(film.shear_force) for film in films)),
    }


@dataclass(frozen=True, eq=False)
class PointMarchCase:
    """Films of a march, and the arguments of `bem.march_point_film`, with surfaces that pass through."""

    films: Sequence[PointFilmSolution]
    times: FloatArray
    load: Callable[[float], float]
    speeds: Callable[[float], Any]
    radii: tuple[float, float]
    contact_modulus: float
    lubricant: Lubricant
    cells: tuple[int, int]
    surfaces: tuple[MovingSurface, ...] = ()
    extent: tuple[float, float, float, float] | None = None
    bodies: tuple[Body, ...] | None = None
    initial_thickness: float | None = None

    def done(self, films: Sequence[PointFilmSolution]) -> PointMarchCase:
        """Return the case with its films."""
        return replace(self, films=films)

    def again(self, cells: tuple[int, int], every: int = 1, **going_on: Any) -> list[PointFilmSolution]:
        """March on other cells, at every so many of the times and the last one."""
        asked = named(self, "load speeds radii contact_modulus lubricant extent bodies initial_thickness")
        times = every_so_many(self.times, every)
        return march_point_film(times, **asked, roughness=self.surfaces, shape=cells, **going_on)


def point_march_figures(films: Sequence[PointFilmSolution]) -> dict[str, float]:
    """Return the headline figures of a march of a point film [m]."""
    minimum = np.array([film.minimum_thickness for film in films])
    return {
        "thinnest_film": float(minimum.min()),
        "film_at_end": float(minimum[-1]),
        "central_film_at_end": films[-1].central_thickness,
        "thickest_central_film": max(film.central_thickness for film in films),
    }


def point_march_bars(case: PointMarchCase) -> ErrorBars:
    """Return the error bars of the figures of a march; solves two more marches, on half the cells."""
    found = point_march_figures(case.films)
    if len(case.times) < 5:
        return ErrorBars.unknown(tuple(found), NoBar.SHORT_MARCH)
    nx, ny = case.cells
    halved = min(nx, ny) >= 2 * FEWEST_CELLS
    other = (nx // 2, ny // 2) if halved else (2 * nx, 2 * ny)
    marches = case.again(other), case.again(other if halved else case.cells, 2)
    return _bars_of(case.films, marches, point_march_figures, other[0] / nx)


def march_bars(case: MarchCase) -> ErrorBars:
    """Return the error bars of the figures of a march; solves two more marches."""
    if len(case.times) < 5:
        return ErrorBars.unknown(FIGURES, NoBar.SHORT_MARCH)
    fewer = max(FEWEST, case.points // 2 + 1)
    other = fewer if case.points >= _APART * fewer else 2 * case.points - 1
    marches = case.again(other), case.again(min(other, case.points), 2)
    return _bars_of(case.films, marches, march_figures, other / case.points)


def every_so_many(times: FloatArray, every: int) -> FloatArray:
    """Return every so many of the times, and the last one."""
    return np.unique(np.append(times[::every], times[-1]))


def _bars_of(
    films: Any, marches: tuple[Any, Any], figures: Callable[[Any], dict[str, float]], ratio: float
) -> ErrorBars:
    """Return the error bars from two more marches: on `ratio` times as many points, and, on the fewer of both, of steps
    twice as long."""
    found, mesh, steps = (figures(one) for one in (films, *marches))
    if {one[-1].status for one in (*marches, films)} != {Status.CONVERGED}:
        return ErrorBars.unknown(found, NoBar.COARSER_UNSOLVED)
    return ErrorBars.together(
        {
            POINTS: MESH_RULES.errors(found, mesh, ratio=ratio),
            STEPS: STEP_RULES.errors(mesh if ratio < 1 else found, steps),
            RESIDUAL: residual_errors(_TOLERANCE, found),
        }
    )
