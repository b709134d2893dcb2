"""Error bars of a rough point film with contact inside: the same film on a grid of half as many cells a side.

Bumps are a few cells long, and neither shares of the load nor areas in contact show an order on such grids: the bar is
the whole difference and more (`FACTORS`), and no less than the share by which the mean film changed. Shares in contact
have what the film above the least one may move them by (`STEEP`), areas what whole cells scatter (`COUNT`), friction
what the surfaces' share makes of it, and a minimum what the mean film has, the least film, too, where contact is not
sure. Chosen on four sets of random balls (64 to 68 cells a side, waves from 0.35 of Hertz' radius on, against three
times the cells): 15, where the difference alone covered 11 mean films, 6 of 9 minima above the least film and 5 of 6
shares of the load, and 27, where factors on it alone covered 17 of 21 minima, 6 of 8 shares and 5 of 8 areas, and 28,
where shares with a third of that were covered in 12 of 16, and 28, where 2.5 of the difference covered 24 mean films.
At a place between bumps (the centre) and for the highest pressure there is none.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from bem.accuracy.bars import GRID, RESIDUAL, ErrorBars
from bem.accuracy.point import FEWEST
from bem.arguments import named
from bem.errors import Status
from bem.lubrication import Lubricant, RoughPointFilm, solve_rough_point_film
from bem.lubrication.point.linear_system import BoolArray
from bem.lubrication.point.moving_surfaces import Heights
from bem.materials import Body
from bem.notes import Note
from bem.notes.accuracy import BARS_PARTIAL, NoBar
from bem.notes.lubrication import FILM_CELLS_FEW
from bem.reference_solutions.hertz import PointContact, ellipse_contact

FACTORS = {"minimum_thickness": 3.5, "mean_thickness": 3.0, "contact_load_share": 1.5, "contact_area_share": 1.5}
"""On the difference."""
STEEP = 5.0
"""Shares s in contact move by this times s(1 - s) and the bar of the mean film over its height above the least one:
where that is a few tenths of the least film, half as many cells may by chance have the same share (2 of 8 films)."""
COUNT = 0.6
"""Cells that a count of whole ones is off by, over the root of those at edges: twice 1/sqrt(12)."""
SMALL, NARROW = 0.1, 1.0
"""Share of the load up to which a share may be of the rim of the contact alone, and cells that the opening there has
from which on shares are not multiples of their limit: 3 to 13 times on 0.2 to 0.5 cells, 1.4 and 2.3 times on 0.7 and
0.9, 1.1 and 1.35 times on 1.3 and 1.7 (reports/experiments/touching_cells.py)."""
RIM, MOSTLY = 0.85, 0.5
"""Of Hertz' half-axes, where the rim begins; and of what surfaces bear, what is of the rim where it is said to be."""
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


def _grid(
    case: RoughPointCase, film: RoughPointFilm, figures: dict[str, float], there: dict[str, float], hertz_area: float
) -> dict[str, float]:
    """What cells leave, of figures here and on half as many."""
    mean, least_film = figures["mean_thickness"], case.least_film
    moved = abs(there["mean_thickness"] - mean)
    bars = {
        name: max(FACTORS.get(name, 1.0) * abs(value - there[name]), moved / mean * value)
        for name, value in figures.items()
    }
    # shares in contact go with the film above the least one, and cannot pass none and all
    over = bars["mean_thickness"] / max(mean - least_film, bars["mean_thickness"], MET * least_film)
    for name in ("contact_load_share", "contact_area_share"):
        share = min(figures[name], 1.0)
        bars[name] = max(bars[name], STEEP * share * (1 - share) * over)
    bars["contact_area_share"] += COUNT * math.sqrt(_at_edges(film.touching)) * _cell(film) / hertz_area
    rubbed = case.boundary_friction * bars["contact_load_share"]
    bars["traction_coefficient"] = max(bars["traction_coefficient"], rubbed)
    slide = math.hypot(*np.subtract(*film.speeds))
    bars["friction_power"] = max(bars["friction_power"], rubbed * film.load * slide)
    # a least film is met on all grids where some contact is sure; a minimum above it moves as the film around it
    met = figures["minimum_thickness"] < (1 + MET) * least_film
    sure = met and figures["contact_load_share"] > bars["contact_load_share"]
    bars["minimum_thickness"] = FACTORS["minimum_thickness"] * abs(
        figures["minimum_thickness"] - there["minimum_thickness"]
    )
    if not sure:
        bars["minimum_thickness"] = max(bars["minimum_thickness"], bars["mean_thickness"])
    return bars


def _at_edges(touching: BoolArray) -> int:
    """Cells that touch beside one that does not."""
    around = np.pad(touching, 1)
    inner = around[2:, 1:-1] & around[:-2, 1:-1] & around[1:-1, 2:] & around[1:-1, :-2]
    return int((touching & ~inner).sum())


def _cell(film: RoughPointFilm) -> float:
    """Its area [m^2]."""
    return float((film.x[1] - film.x[0]) * (film.y[1] - film.y[0]))


def rough_point_bars(case: RoughPointCase, film: RoughPointFilm, hertz_area: float) -> ErrorBars:
    """Bars of the figures of a film."""
    figures = rough_point_figures(case, film, hertz_area)
    missing = ("central_thickness", "central_pressure")
    nx, ny = film.thickness.shape
    if min(nx, ny) < 2 * FEWEST:
        return ErrorBars.unknown((*figures, *missing), NoBar.TOO_SMALL)
    other = case.on((nx // 2, ny // 2))
    if other.status is not Status.CONVERGED:
        return ErrorBars.unknown((*figures, *missing), NoBar.COARSER_UNSOLVED)
    there = rough_point_figures(case, other, hertz_area)
    grid = _grid(case, film, figures, there, hertz_area)
    residual = {name: _ALGEBRAIC * film.residual * abs(value) for name, value in figures.items()}
    bars = ErrorBars.together({GRID: grid, RESIDUAL: residual}, notes=(BARS_PARTIAL(reason="half-cells"),))
    return bars | ErrorBars.unknown(missing, NoBar.ONE_PLACE_AMONG_BUMPS)


def _dry(case: RoughPointCase) -> PointContact:
    return ellipse_contact(radii=case.radii, contact_modulus=case.contact_modulus, load=case.load)


def opening(case: RoughPointCase, film: float) -> tuple[float, float]:
    """Lengths [m] beside Hertz' contact, along x and y, over which its dry gap opens to a film [m]: the scale of what
    is narrow at its rim."""
    dry = _dry(case)

    def length(half: float, gap: Callable[[float], float]) -> float:
        further = 2.0
        while gap(further * half) < film:
            further *= 2
        return half * (float(brentq(lambda s: gap(s * half) - film, 1 + 1e-9, further)) - 1)

    a, b = dry.semi_axes
    return length(a, lambda s: float(dry.gap(s, 0.0))), length(b, lambda s: float(dry.gap(0.0, s)))


def at_rim(case: RoughPointCase, film: RoughPointFilm) -> float:
    """Share of what the surfaces bear that lies at the rim of Hertz' contact (`RIM` of it) and beyond."""
    a, b = _dry(case).semi_axes
    outer = np.hypot(film.x[:, None] / a, film.y / b) > RIM
    bears = film.contact_pressure
    return float(bears[outer].sum() / max(float(bears.sum()), 1e-300))


def narrow_notes(case: RoughPointCase, film: RoughPointFilm) -> list[Note]:
    """What a reader must know of a share in contact that lies in constrictions as narrow as a cell."""
    if film.status is not Status.CONVERGED or not 0 < film.contact_share < SMALL:
        return []
    steps = float(film.x[1] - film.x[0]), float(film.y[1] - film.y[0])
    widths = opening(case, film.mean_thickness)
    cells = min(width / step for width, step in zip(widths, steps, strict=True))
    if cells >= NARROW or at_rim(case, film) < MOSTLY:
        return []
    wanted = (
        max(n, math.ceil(n * NARROW * step / width))
        for n, step, width in zip(film.pressure.shape, steps, widths, strict=True)
    )
    return [FILM_CELLS_FEW(cells=cells, wanted=" x ".join(str(n) for n in wanted), reason="rim")]
