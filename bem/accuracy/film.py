"""Error bars of a steady line film: the same film on a mesh of half the points.

Thicknesses are of second order in the points; other figures take more of the difference, and a fraction of the change
of the film, since their differences may pass zero. Where half the points are too few for a film, twice as many are
taken. A pressure spike that no mesh resolves has no limit and its height no bar.

The inlet adds nothing: meshes begin 50 half-widths upstream of the contact and the far field carries what lies before
them; beginning at 200 changes thicknesses by 1e-5 and friction by 1e-4 at most.

Verified in tests/accuracy/test_film_bars.py; judged by the experiment that `FILM_RULES` names.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from bem.accuracy.bars import POINTS, RESIDUAL, ErrorBars
from bem.accuracy.coarsened import other_points
from bem.accuracy.richardson import Table, relative, residual_errors, rows, to_half
from bem.arguments import named
from bem.errors import Status
from bem.lubrication import FilmSolution, Lubricant, solve_line_film
from bem.lubrication.checks import Case, spike_unresolved
from bem.notes.accuracy import NoBar

FEWEST = 100
"""Points below which no film is solved."""
FILM_RULES = Table(
    "film_error_bars",
    rows("central_thickness minimum_thickness", 0.6, "Second order: 1.8 times Richardson.", film=0.02),
    rows("load", 0.6, "As thicknesses; the load is prescribed, and its residual counts besides."),
    rows(
        "shear_force",
        0.8,
        "The sliding and the rolling part cancel in differences: their changes were up to forty times that of the sum.",
        film=0.004,
        rolling=0.3,
    ),
    rows(
        "rolling_force", 0.8, "An integral of p dh/dx, whose two halves nearly cancel: it follows the film.", film=0.4
    ),
    rows(
        "maximum_pressure",
        1.0,
        "First order: the spike is a kink in the mesh. Its top lies above the highest node.",
        order=1,
        film=0.02,
        peak=1.0,
    ),
)
"""Factors on the difference, and floors on the relative change of the film times the figure (film) and times the
rolling force (rolling), and on the rise of the peak above the highest node (peak)."""
_SHARP, _SPIKE = 0.02, 0.5
"""Fall of the pressure from the highest node, relative, from which on it is a spike; and part of the fall by which the
top of a spike may be higher: 0.2 to 0.6 where half the points did not show it."""


@dataclass(frozen=True)
class FilmCase:
    """A solved steady film on its own mesh of so many points, and the arguments of `bem.solve_line_film`."""

    solution: FilmSolution
    load: float
    radius: float
    contact_modulus: float
    speeds: Sequence[float]
    lubricant: Lubricant
    points: int

    def on(self, points: int) -> FilmSolution:
        """Solve the film on a mesh of other points."""
        asked = named(self, "load radius contact_modulus speeds lubricant")
        return solve_line_film(**asked, points=points, initial=self.solution)


@dataclass(frozen=True)
class OtherFilm:
    """The film on another mesh of `ratio` times as many points: about 1/2, or 2."""

    solution: FilmSolution
    ratio: float


def solve_coarser_film(case: FilmCase) -> OtherFilm:
    """Solve the film on half the points, from itself; on twice as many where half are too few."""
    points = other_points(case.points, FEWEST)
    return OtherFilm(case.on(points), points / case.points)


def film_figures(solution: FilmSolution) -> dict[str, float]:
    """Return the headline figures of a steady film on its own mesh, per unit length, SI units."""
    return {
        "central_thickness": solution.central_thickness,
        "minimum_thickness": solution.minimum_thickness,
        "load": solution.load,
        "shear_force": solution.shear_force,
        "rolling_force": solution.rolling_force,
        "maximum_pressure": float(solution.pressure.max()),
    }


def film_bars(case: FilmCase, other: OtherFilm) -> ErrorBars:
    """Return the error bars of the figures of a film."""
    found = film_figures(case.solution)
    if other.solution.status is not Status.CONVERGED:
        return ErrorBars.unknown(found, NoBar.COARSER_UNSOLVED)
    there = film_figures(other.solution)
    changed = to_half(other.ratio) * film_change(found, there)
    rolling = changed * abs(found["rolling_force"])
    indicators = {
        "film": relative(changed, found),
        "rolling": {"shear_force": rolling},
        "peak": {"maximum_pressure": _above_highest_node(case.solution)},
    }
    residual = residual_errors(case.solution.residual, found)
    residual["load"] += abs(case.solution.load - case.load)
    points = FILM_RULES.errors(found, there, indicators, ratio=other.ratio)
    bars = ErrorBars.together({POINTS: points, RESIDUAL: residual})
    no_limit = spike_is_unresolved(case) or spike_is_unresolved(replace(case, solution=other.solution))
    return bars.without("maximum_pressure", NoBar.SPIKE) if no_limit else bars


def film_change(found: Mapping[str, float], there: Mapping[str, float]) -> float:
    """Return the larger relative change of the central and the minimum thickness."""
    names = ("central_thickness", "minimum_thickness")
    return max(abs(found[name] - there[name]) / abs(found[name]) if found[name] else math.inf for name in names)


def spike_is_unresolved(case: FilmCase) -> bool:
    """Return True if the mesh decides the height of the film's pressure spike."""
    solution = case.solution
    first, second = case.speeds
    there = Case(
        position=solution.position,
        pressure=np.maximum(solution.pressure, 0.0),
        thickness=solution.thickness,
        speeds=(float(first), float(second)),
        lubricant=case.lubricant,
        radius=case.radius,
        contact_modulus=case.contact_modulus,
    )
    return spike_unresolved(there) is not None


def _above_highest_node(solution: FilmSolution) -> float:
    """Return how far the highest pressure may lie above the highest node [Pa].

    It is the rise of a parabola through this node and its neighbours; half of the fall to the lower of them where that
    is a spike, to which no parabola fits.
    """
    x, pressure = solution.position, solution.pressure
    i = int(np.clip(pressure.argmax(), 1, len(x) - 2))
    bend, slope = np.polyfit(x[i - 1 : i + 2] - x[i], pressure[i - 1 : i + 2] - pressure[i], 2)[:2]
    rise = float(-slope * slope / (4 * bend)) if bend < 0 else 0.0
    falls = float(pressure[i] - min(pressure[i - 1], pressure[i + 1]))
    return max(rise, _SPIKE * falls) if falls > _SHARP * pressure[i] else rise
