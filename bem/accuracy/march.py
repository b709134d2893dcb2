"""Error bars of a film in time, of a line or a point contact: fewer points, and fewer steps on these.

Mesh and steps of `bem.march_line_film` and `bem.march_point_film` converge with order two. The march on half the points
(along either axis; on twice as many where half are too few) shows what the mesh does, a third one, on the fewer of
both, of steps twice as long what the steps do; with half the points they take together about half as long as the march
itself. Each part is its difference times a safety factor (`reports/experiments/march_error_bars.py`, of line contacts),
the bar their sum: an estimate, no proved bound, which covers nine errors in ten of coarse, random motions of line
contacts. The time of the thinnest film jumps between minima and has no bar.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bem.accuracy.bars import POINTS, RESIDUAL, STEPS, ErrorBars
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
FEWEST = 101
FEWEST_CELLS = 32
_MESH, _STEPS = 1.3, 3.0
"""Factors on the differences to half the points and to steps twice as long. Order two would leave 1/3 of either; coarse
motions are not there yet, and the steps are compared on the coarser mesh. On fresh seeds less covers too little: with
0.8 and 2 eight in ten."""
_APART = 1.5
"""Times the points of the coarser mesh, at least, or twice as many are taken: between meshes of 101 and 102 points the
thinnest film differed by little, of which order two made a bar of 0.3 % where the error was 16 %."""
_TOLERANCE = 1e-7
"""Largest residual of a step, relative to the film and the load."""


@dataclass(frozen=True, eq=False)
class MarchCase:
    """A march that was done, and the arguments of `bem.march_line_film` that it was done with."""

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
        """The same march with other points, at every so many of the times and the last one; `going_on` from a state,
        or calling back."""
        asked = named(self, "load speeds radius contact_modulus lubricant initial_thickness cavitation")
        times = every_so_many(self.times, every)
        return march_line_film(times, **asked, points=points, supply=self.layer, **going_on)


def march_figures(films: Sequence[FilmSolution]) -> dict[str, float]:
    """Headline figures of a march: the thinnest of all minimum thicknesses [m], the last one [m] and the largest shear
    force per unit length [N/m]."""
    minimum = np.array([film.minimum_thickness for film in films])
    return {
        "thinnest_film": float(minimum.min()),
        "film_at_end": float(minimum[-1]),
        "largest_shear_force": float(max(abs(film.shear_force) for film in films)),
    }


@dataclass(frozen=True, eq=False)
class PointMarchCase:
    """The same of `bem.march_point_film`, with surfaces that pass through."""

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
        """With the films that were found."""
        return replace(self, films=films)

    def again(self, cells: tuple[int, int], every: int = 1, **going_on: Any) -> list[PointFilmSolution]:
        """The same march on other cells, at every so many of the times and the last one."""
        asked = named(self, "load speeds radii contact_modulus lubricant extent bodies initial_thickness")
        times = every_so_many(self.times, every)
        return march_point_film(times, **asked, roughness=self.surfaces, shape=cells, **going_on)


def point_march_figures(films: Sequence[PointFilmSolution]) -> dict[str, float]:
    """Headline figures [m]."""
    minimum = np.array([film.minimum_thickness for film in films])
    return {
        "thinnest_film": float(minimum.min()),
        "film_at_end": float(minimum[-1]),
        "central_film_at_end": films[-1].central_thickness,
        "thickest_central_film": max(film.central_thickness for film in films),
    }


def point_march_bars(case: PointMarchCase) -> ErrorBars:
    """Bars of the figures of a march; two marches more, on half the cells."""
    found = point_march_figures(case.films)
    if len(case.times) < 5:
        return ErrorBars.unknown(tuple(found), NoBar.SHORT_MARCH)
    nx, ny = case.cells
    halved = min(nx, ny) >= 2 * FEWEST_CELLS
    other = (nx // 2, ny // 2) if halved else (2 * nx, 2 * ny)
    marches = case.again(other), case.again(other if halved else case.cells, 2)
    return _together(case.films, marches, point_march_figures, nx / other[0])


def march_bars(case: MarchCase) -> ErrorBars:
    """Bars of the figures of a march; two marches more."""
    if len(case.times) < 5:
        return ErrorBars.unknown(FIGURES, NoBar.SHORT_MARCH)
    fewer = max(FEWEST, case.points // 2 + 1)
    other = fewer if case.points >= _APART * fewer else 2 * case.points - 1
    marches = case.again(other), case.again(min(other, case.points), 2)
    return _together(case.films, marches, march_figures, case.points / other)


def every_so_many(times: FloatArray, every: int) -> FloatArray:
    """Every so many of the times, and the last one."""
    return np.unique(np.append(times[::every], times[-1]))


def _together(
    films: Any, marches: tuple[Any, Any], figures: Callable[[Any], dict[str, float]], finer: float
) -> ErrorBars:
    """Bars from a march on other cells and, on the coarser of both, one of steps twice as long; `finer`: how much finer
    than the first of them the films' own cells are."""
    found, mesh, steps = (figures(one) for one in (films, *marches))
    if {one[-1].status for one in (*marches, films)} != {Status.CONVERGED}:
        return ErrorBars.unknown(tuple(found), NoBar.COARSER_UNSOLVED)
    from_here = mesh if finer > 1 else found
    # the difference to half the points, by order two
    halved = 3 / abs(finer**2 - 1)
    return ErrorBars.together(
        {
            POINTS: {name: _MESH * halved * abs(found[name] - mesh[name]) for name in found},
            STEPS: {name: _STEPS * abs(from_here[name] - steps[name]) for name in found},
            RESIDUAL: {name: 10 * _TOLERANCE * abs(value) for name, value in found.items()},
        }
    )
