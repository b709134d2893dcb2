"""Error bars of a steady line film: the same film on a mesh of half the points.

The bar is an estimate by Richardson: thicknesses converge with order two in the points (a quarter to a third of the
difference to half of them is left), times a safety factor; other figures take more of it, and a share of what the film
changes by, since their differences may pass zero. Where half the points are too few for a film, twice as many are taken
instead. A pressure spike that no mesh resolves has no limit and its height no bar.

The inlet adds nothing that counts: meshes begin 50 lengths upstream of the contact and the far field carries what lies
before them; beginning 200 upstream changes thicknesses by 1e-5 and friction by 1e-4 at most.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from bem.accuracy.bars import POINTS, RESIDUAL, TWICE, ErrorBars
from bem.arguments import named
from bem.errors import Status
from bem.lubrication import FilmSolution, Lubricant, solve_line_film
from bem.lubrication.checks import Case, spike_unresolved
from bem.notes.accuracy import NoBar

FEWEST = 100
"""Points below which no film is solved."""


@dataclass(frozen=True)
class FilmRule:
    """How differences to half the points become a bar.

    factor : on the difference; 1/3 is that of order two, which thicknesses have closely.
    film : on the relative change of the film, times the figure: what stays where a difference happens to pass zero.
    peak : on how far the highest pressure may lie above the highest node.
    rolling : on the relative change of the film, times the rolling force: shear holds that as one of two shares, whose
        changes were up to forty times their sum's.
    """

    factor: float
    film: float
    peak: float = 0.0
    rolling: float = 0.0


_FRICTION = FilmRule(0.8, 0.004, rolling=0.3)
FILM_RULES: dict[str, FilmRule] = {
    "central_thickness": FilmRule(0.6, 0.02),
    "minimum_thickness": FilmRule(0.6, 0.02),
    "load": FilmRule(0.6, 0.0),
    "shear_force": _FRICTION,
    "striated_shear_force": _FRICTION,
    "rolling_force": FilmRule(0.8, 0.4),
    "maximum_pressure": FilmRule(1.0, 0.02, peak=1.0),
}
"""Figures of a film that have bars; set by `reports/experiments/film_error_bars.py` with seeds that it does not store.
"""
_SHARP, _SPIKE = 0.02, 0.5
"""Pressure falls by more than this share from the highest node where that is a spike; of the fall, how much higher its
top may be: 0.2 to 0.6 in those that half the points did not tell."""
_ALGEBRAIC = 10.0
"""Relative change of a figure over the residual of the equations, relative to the film."""


@dataclass(frozen=True)
class FilmCase:
    """A steady film that was solved, and the arguments of `bem.solve_line_film` that it was solved with; the solution
    is on its own mesh of so many points."""

    solution: FilmSolution
    load: float
    radius: float
    contact_modulus: float
    speeds: Sequence[float]
    lubricant: Lubricant
    points: int

    def on(self, points: int) -> FilmSolution:
        """The same film on a mesh of other points."""
        asked = named(self, "load radius contact_modulus speeds lubricant")
        return solve_line_film(**asked, points=points, initial=self.solution)


@dataclass(frozen=True)
class OtherFilm:
    """The film on another mesh, and how many times as many points it has: 1/2 or so, or 2."""

    solution: FilmSolution
    ratio: float


def solve_coarser_film(case: FilmCase) -> OtherFilm:
    """The film on half the points, from itself; on twice as many where half of them are too few."""
    points = case.points // 2 if case.points >= 2 * FEWEST else 2 * case.points
    return OtherFilm(case.on(points), points / case.points)


def film_figures(solution: FilmSolution) -> dict[str, float]:
    """Headline figures of a steady film on its own mesh, per unit length, SI units."""
    return {
        "central_thickness": solution.central_thickness,
        "minimum_thickness": solution.minimum_thickness,
        "load": solution.load,
        "shear_force": solution.shear_force,
        "striated_shear_force": solution.striated_shear_force,
        "rolling_force": solution.rolling_force,
        "maximum_pressure": float(solution.pressure.max()),
    }


def film_bars(case: FilmCase, other: OtherFilm) -> ErrorBars:
    """Bars of the figures of a film."""
    found = film_figures(case.solution)
    if other.solution.status is not Status.CONVERGED:
        return ErrorBars.unknown(found, NoBar.COARSER_UNSOLVED)
    there = film_figures(other.solution)
    # what the difference would be to half the points, by order two
    halved = TWICE if other.ratio > 1 else 3 / (1 / other.ratio**2 - 1)
    changed = max(_relative(found[name], there[name]) for name in ("central_thickness", "minimum_thickness"))
    rise = _above_highest_node(case.solution)
    points, residual = {}, {}
    for name, rule in FILM_RULES.items():
        figure = abs(found[name])
        follows = rule.film * figure + rule.rolling * abs(found["rolling_force"])
        discretisation = halved * (rule.factor * abs(found[name] - there[name]) + changed * follows)
        points[name] = discretisation + rule.peak * rise
        residual[name] = _ALGEBRAIC * case.solution.residual * figure
    residual["load"] += abs(case.solution.load - case.load)
    bars = ErrorBars.together({POINTS: points, RESIDUAL: residual})
    no_limit = spike_is_unresolved(case) or spike_is_unresolved(replace(case, solution=other.solution))
    return bars.without("maximum_pressure", NoBar.SPIKE) if no_limit else bars


def spike_is_unresolved(case: FilmCase) -> bool:
    """Return True if the height of the film's pressure spike is the mesh's."""
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


def _relative(one: float, other: float) -> float:
    return abs(one - other) / abs(one) if one else math.inf


def _above_highest_node(solution: FilmSolution) -> float:
    """How far the highest pressure may lie above the highest node [Pa]: as a parabola through it and its neighbours
    does, and half-way again as far as it falls to the lower of them where that is a spike, to which no parabola fits.
    """
    x, pressure = solution.position, solution.pressure
    i = int(np.clip(pressure.argmax(), 1, len(x) - 2))
    bend, slope = np.polyfit(x[i - 1 : i + 2] - x[i], pressure[i - 1 : i + 2] - pressure[i], 2)[:2]
    rise = float(-slope * slope / (4 * bend)) if bend < 0 else 0.0
    falls = float(pressure[i] - min(pressure[i - 1], pressure[i + 1]))
    return max(rise, _SPIKE * falls) if falls > _SHARP * pressure[i] else rise
