"""Error bars of a rough point film with contact inside: the same film on a grid of half as many cells a side.

Bumps are a few cells long, so that neither shares of the load nor areas in contact show an order. A bar is the whole
difference and more, and no less than the relative change of the mean film. Shares in contact move with the film above
the least one, areas scatter with whole cells, friction follows the share of the surfaces, and a minimum has the error
of the mean film where contact is not sure. Places between bumps (the centre) and the highest pressure have no bar.

The table was chosen on four sets of random balls (seeds 77 and 2611 to 2613; 64 to 68 cells a side, waves from 0.35 of
Hertz' radius on, against three times the cells). Verified in tests/accuracy/test_rough_point_bars.py; judged by the
experiment that `RULES` names, of another seed.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from bem.accuracy.bars import GRID, RESIDUAL, ErrorBars
from bem.accuracy.point import FEWEST
from bem.accuracy.richardson import Table, relative, residual_errors, rows
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

RULES = Table(
    "rough_point_error_bars",
    rows("minimum_thickness", 3.5, "No order; smaller factors on the difference covered 17 of 21 minima.", order=1),
    rows("mean_thickness", 3.0, "No order: 2.5 of the difference covered 24 of 28 mean films.", order=1),
    rows(
        "contact_load_share contact_area_share",
        1.5,
        "No order: the difference alone covered 5 of 6 shares of the load.",
        order=1,
        film=1.0,
    ),
    rows("traction_coefficient friction_power", 1.0, "Friction follows the film and the shares.", order=1, film=1.0),
)
"""Factors on the difference, and the least error over the relative change of the mean film times the figure (film)."""
STEEP = 5.0
"""Change of a share s in contact over s (1 - s) and over the relative error of the mean film above the least one: half
as many cells may by chance have the same share (2 of 8 films that stood a few tenths of the least film above it)."""
COUNT = 0.6
"""Error of a count of whole cells over the root of those at edges: twice 1 / sqrt(12)."""
SMALL, NARROW = 0.1, 1.0
"""Largest share of the load that the rim of the contact may bear alone; and cells across the opening of the rim, below
which shares are multiples of their limit: 3 to 13 times on 0.2 to 0.5 cells, 1.4 and 2.3 times on 0.7 and 0.9, 1.1 and
1.35 times on 1.3 and 1.7 (reports/experiments/touching_cells.py)."""
RIM, MOSTLY = 0.85, 0.5
"""Fraction of Hertz' half-axes where the rim begins; and part of the surfaces' load from which on the rim bears it."""
MET = 1e-6
"""Height of the thinnest film above the least one, relative, up to which both are equal."""


@dataclass(frozen=True)
class RoughPointCase:
    """Arguments of `bem.solve_rough_point_film`, and the coefficient of friction of surfaces in contact."""

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
        """Solve the film on so many cells."""
        asked = named(self, "load radii contact_modulus speeds lubricant heights least_film bodies")
        return solve_rough_point_film(**asked, shape=cells, errors=False)


def rough_point_figures(case: RoughPointCase, film: RoughPointFilm, hertz_fraction: float) -> dict[str, float]:
    """Return the figures that have error bars, SI units."""
    friction = film.friction(case.boundary_friction)
    return {
        "minimum_thickness": film.minimum_thickness,
        "mean_thickness": film.mean_thickness,
        "contact_load_share": film.contact_share,
        "contact_area_share": film.contact_area / hertz_fraction,
        "traction_coefficient": friction,
        "friction_power": friction * film.load * math.hypot(*np.subtract(*film.speeds)),
    }


def _grid_errors(
    case: RoughPointCase,
    film: RoughPointFilm,
    figures: dict[str, float],
    there: dict[str, float],
    hertz_fraction: float,
) -> dict[str, float]:
    """Return the errors of the cells from the figures here and on half as many."""
    mean, least_film = figures["mean_thickness"], case.least_film
    changed = relative(abs(there["mean_thickness"] - mean) / mean, figures)
    errors = RULES.errors(figures, there)
    for name, row in RULES.items():
        errors[name] = max(errors[name], row.error(0.0, {"film": changed[name]}))
    # shares in contact go with the film above the least one, and cannot pass none and all
    over = errors["mean_thickness"] / max(mean - least_film, errors["mean_thickness"], MET * least_film)
    for name in ("contact_load_share", "contact_area_share"):
        share = min(figures[name], 1.0)
        errors[name] = max(errors[name], STEEP * share * (1 - share) * over)
    errors["contact_area_share"] += COUNT * math.sqrt(_at_edges(film.touching)) * _cell_area(film) / hertz_fraction
    rubbed = case.boundary_friction * errors["contact_load_share"]
    errors["traction_coefficient"] = max(errors["traction_coefficient"], rubbed)
    slide = math.hypot(*np.subtract(*film.speeds))
    errors["friction_power"] = max(errors["friction_power"], rubbed * film.load * slide)
    # where contact is sure, all grids reach the least film; a minimum above it moves as the film around it
    met = figures["minimum_thickness"] < (1 + MET) * least_film
    if not (met and figures["contact_load_share"] > errors["contact_load_share"]):
        errors["minimum_thickness"] = max(errors["minimum_thickness"], errors["mean_thickness"])
    return errors


def _at_edges(touching: BoolArray) -> int:
    """Return the number of cells that touch beside one that does not."""
    around = np.pad(touching, 1)
    inner = around[2:, 1:-1] & around[:-2, 1:-1] & around[1:-1, 2:] & around[1:-1, :-2]
    return int((touching & ~inner).sum())


def _cell_area(film: RoughPointFilm) -> float:
    """Return the area of a cell [m^2]."""
    return float((film.x[1] - film.x[0]) * (film.y[1] - film.y[0]))


def rough_point_bars(case: RoughPointCase, film: RoughPointFilm, hertz_fraction: float) -> ErrorBars:
    """Return the error bars of the figures of a film."""
    figures = rough_point_figures(case, film, hertz_fraction)
    missing = ("central_thickness", "central_pressure")
    nx, ny = film.thickness.shape
    if min(nx, ny) < 2 * FEWEST:
        return ErrorBars.unknown((*figures, *missing), NoBar.TOO_SMALL)
    other = case.on((nx // 2, ny // 2))
    if other.status is not Status.CONVERGED:
        return ErrorBars.unknown((*figures, *missing), NoBar.COARSER_UNSOLVED)
    there = rough_point_figures(case, other, hertz_fraction)
    grid = _grid_errors(case, film, figures, there, hertz_fraction)
    bars = ErrorBars.together(
        {GRID: grid, RESIDUAL: residual_errors(film.residual, figures)}, notes=(BARS_PARTIAL(reason="half-cells"),)
    )
    return bars | ErrorBars.unknown(missing, NoBar.ONE_PLACE_AMONG_BUMPS)


def _dry(case: RoughPointCase) -> PointContact:
    return ellipse_contact(radii=case.radii, contact_modulus=case.contact_modulus, load=case.load)


def opening(case: RoughPointCase, film: float) -> tuple[float, float]:
    """Return the lengths [m] beside Hertz' contact, along x and y, over which its dry gap opens to a film [m]."""
    dry = _dry(case)

    def length(half: float, gap: Callable[[float], float]) -> float:
        further = 2.0
        while gap(further * half) < film:
            further *= 2
        return half * (float(brentq(lambda s: gap(s * half) - film, 1 + 1e-9, further)) - 1)

    a, b = dry.semi_axes
    return length(a, lambda s: float(dry.gap(s, 0.0))), length(b, lambda s: float(dry.gap(0.0, s)))


def at_rim(case: RoughPointCase, film: RoughPointFilm) -> float:
    """Return the part of the surfaces' load at the rim of Hertz' contact (`RIM` of it) and beyond."""
    a, b = _dry(case).semi_axes
    outer = np.hypot(film.x[:, None] / a, film.y / b) > RIM
    bears = film.contact_pressure
    return float(bears[outer].sum() / max(float(bears.sum()), 1e-300))


def narrow_notes(case: RoughPointCase, film: RoughPointFilm) -> list[Note]:
    """Return the note on a share in contact that lies in constrictions narrower than a cell."""
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
