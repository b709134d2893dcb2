"""Error bars of a life: errors of its cycle jumps, its positions, its cells and the points of its films.

1. Jumps: the errors of all steps add up (`jump_bars`).
2. Cells and positions: the differences to two more lives, one on the grid of twice the cell, and there one of half the
   positions. The difference of the positions is replaced by the scatter of the last round's where it is smaller.
   Heights and the film over them have a better estimate (`bem.life.sampling`).
3. Points of the films: the differences of rounds with half the points, on the surfaces of the start and of the end;
   wear follows the share of the load in contact.
4. The error bar is the sum, each part times a factor.

Cost: three eighths of the life. The factors are set by experiment and judged by
`reports/experiments/life_error_bars.py`: an estimate, no proved bound.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from bem.accuracy.bars import GRID, POINTS, ErrorBars
from bem.grid import FloatArray
from bem.life.march import LifeState
from bem.life.passes import Pass, Passing
from bem.life.sampling import missed_ratio, missed_roughness
from bem.life.surfaces import LifeCase, solve_round
from bem.notes.accuracy import NoBar

JUMPS, POSITIONS = "cycle jumps", "positions"
"""The origins of errors of a life, beside `GRID` and `POINTS`."""
END = {
    "friction_final": "friction",
    "Sq_final": "lower_rms",
    "upper_Sq_final": "upper_rms",
    "worn_depth": "lower_depth",
    "upper_worn_depth": "upper_depth",
    "lambda_ratio": "lambda_ratio",
    "contact_share_final": "contact_share",
    "contact_area_fraction": "area_share",
    "minimum_film": "minimum_film",
}
"""Figures at the end by columns of the march."""
START = {
    "friction_initial": "friction",
    "Sq_initial": "lower_rms",
    "upper_Sq_initial": "upper_rms",
    "lambda_ratio_initial": "lambda_ratio",
    "contact_share_initial": "contact_share",
}
"""Figures of the unworn surfaces by columns of the march."""
_SAMPLED = {
    "friction": ("boundary_friction", "film_friction"),
    "contact_share": ("contact_share",),
    "area_share": ("area_share",),
    "minimum_film": ("minimum_film",),
    "lambda_ratio": ("lambda_ratio",),
}
"""Columns that are means over positions, by the fields of a pass that they average."""
_POSITIONS = {
    "friction_initial": 0.7,
    "contact_share_initial": 0.5,
    "contact_share_final": 1.3,
    "contact_area_fraction": 0.75,
}
"""Factors on the differences by half the positions; 1 elsewhere, and for cells and points of films."""
_SCATTERED = {
    "friction_final": 0.5,
    "friction_initial": 0.35,
    "contact_share_final": 0.65,
    "contact_share_initial": 0.5,
    "contact_area_fraction": 0.75,
}
"""Factors on the scatter of positions, which are spread evenly and not drawn; 1 elsewhere."""
_MINIMUM_FILM = 0.6
"""Factor on the difference of the minimum film by half the points."""
_HEIGHTS = {"Sq_final": 0.75, "upper_Sq_final": 1.0}
"""Factors on the estimates of `missed_roughness`."""


def fewer_positions(positions: int) -> int:
    """Return half of the positions; two where there is one."""
    return positions // 2 if positions > 1 else 2


def life_figures(end: LifeState) -> dict[str, float]:
    """Return the figures of a life that have error bars, in SI units."""
    found = {name: float(end.over(column)[-1]) for name, column in END.items()}
    found |= {name: float(end.over(column)[0]) for name, column in START.items()}
    found["wear_volume"] = float(sum(end.surfaces.volume))
    if end.surfaces.film is not None:
        found["tribofilm_thickness"] = float(end.over("film_thickness")[-1])
    return found


@dataclass(frozen=True, eq=False)
class OtherLives:
    """Lives and rounds that a life is compared with.

    passing : of the life itself.
    coarser, fewer : ends on the grid of twice the cell, and there with `fewer_positions`.
    rounds, half_rounds : means of a round by column of the march on the surfaces of (start, end), with all and with
        half the points of the films.
    """

    passing: Passing
    coarser: LifeState
    fewer: LifeState
    rounds: tuple[dict[str, float], dict[str, float]]
    half_rounds: tuple[dict[str, float], dict[str, float]]


def two_rounds(case: LifeCase, end: LifeState) -> tuple[dict[str, float], dict[str, float]]:
    """Return means over the positions by column of the march, on the unworn surfaces and on those of the end."""
    film = end.surfaces.film
    grown = None if film is None or case.film is None else np.full(film.shape, case.film.balance.initial_thickness)
    unworn = replace(end.surfaces, heights=end.first, film=grown)
    first, last = (solve_round(case, surfaces, 0.0).passes for surfaces in (unworn, end.surfaces))
    return _means(first), _means(last)


def life_bars(end: LifeState, other: OtherLives | None) -> ErrorBars:
    """Return the error bars of a life from its end and from other lives; unknown without them."""
    found = life_figures(end)
    if other is None:
        return ErrorBars.unknown(found, NoBar.EVEN_CELLS_OF_LOOP, fewest=24)
    one = life_figures(other.coarser)
    cells = {name: abs(found[name] - one[name]) for name in found}
    return ErrorBars.together(
        {
            JUMPS: jump_bars(end),
            POSITIONS: _of_positions(end, other),
            GRID: cells | _grown(found, cells, cells),
            POINTS: _of_films(end, other),
        }
    )


def _of_positions(end: LifeState, other: OtherLives) -> dict[str, float]:
    """Return the differences that half the positions make, at least the scatter of the positions; heights and films
    over them by the estimates of `bem.life.sampling`."""
    found, scatter = life_figures(end), _scatter(end)
    one, two = life_figures(other.coarser), life_figures(other.fewer)
    bars = {
        name: max(
            _POSITIONS.get(name, 1.0) * abs(one[name] - two[name]), _SCATTERED.get(name, 1.0) * scatter.get(name, 0.0)
        )
        for name in found
    }
    bars |= _grown(found, bars, scatter)
    heights = missed_roughness(end, other.passing)
    if heights is not None:
        bars |= {name: factor * off for (name, factor), off in zip(_HEIGHTS.items(), heights, strict=True)}
    first, last = missed_ratio(end, other.passing)
    squares = [found[name] ** 2 for name in _HEIGHTS]
    rougher = sum(found[name] * bars[name] for name in _HEIGHTS) / sum(squares) if sum(squares) > 0 else 0.0
    bars["lambda_ratio_initial"] = first * abs(found["lambda_ratio_initial"])
    bars["lambda_ratio"] = (last + rougher) * abs(found["lambda_ratio"])
    return bars


def _grown(found: dict[str, float], bars: dict[str, float], of_area: dict[str, float]) -> dict[str, float]:
    """Return the error bar of a tribofilm, at least the relative one of the contact area on which the film grows."""
    film, area = "tribofilm_thickness", "contact_area_fraction"
    if film not in found or not found[area] > 0:
        return {}
    return {film: max(bars[film], found[film] * of_area.get(area, 0.0) / found[area])}


def _of_films(end: LifeState, other: OtherLives) -> dict[str, float]:
    """Return the differences that half the points of the films make.

    The wear, and figures that follow it, change by the same fraction as the share of the load in contact.
    """
    apart = [
        {column: abs(value - half[column]) for column, value in whole.items()}
        for whole, half in zip(other.rounds, other.half_rounds, strict=True)
    ]
    shares = [whole["contact_share"] for whole in other.rounds]
    part = max(each["contact_share"] / share if share > 0 else 0.0 for each, share in zip(apart, shares, strict=True))
    found = {
        name: abs(value) * part for name, value in life_figures(end).items() if name.endswith(("_depth", "volume"))
    }
    for which, figures in zip(apart, (START, END), strict=True):
        found |= {name: which[column] for name, column in figures.items() if column in which}
    found["minimum_film"] *= _MINIMUM_FILM
    for name, start in (("Sq_final", "Sq_initial"), ("upper_Sq_final", "upper_Sq_initial")):
        found[name] = part * abs(float(end.over(END[name])[-1]) - float(end.over(START[start])[0]))
    return found


_LAST_ROWS = 4
"""Number of last rows whose slope gives how a figure follows the wear."""


def errors_of_jumps(state: LifeState, columns: Mapping[str, str]) -> dict[str, float]:
    """Return the errors of figures at the end from the errors of the steps; columns : of `ROW`, by figure.

    The errors of the steps' mean depths add up and are shared by the bodies in proportion to their wear, since the same
    pressure causes both. A figure follows the depth worn along the slope of its last rows. First order, our own.
    """
    missed = float(state.over("depth_error")[-1])
    depth = state.over("lower_depth") + state.over("upper_depth")
    first = max(len(depth) - _LAST_ROWS, 0)
    run = float(depth[-1] - depth[first])
    bars = {}
    for name, column in columns.items():
        values = state.over(column)
        if column.endswith("_depth"):
            bars[name] = missed * float(values[-1]) / float(depth[-1]) if depth[-1] > 0 else 0.0
        else:
            steepest = float(np.abs(np.diff(values[first:])).sum())
            bars[name] = steepest / run * missed if run > 0 else 0.0
    return bars


def jump_bars(end: LifeState) -> dict[str, float]:
    """Return the errors of the figures at the end that the steps of a life leave."""
    columns = END if end.surfaces.film is None else END | {"tribofilm_thickness": "film_thickness"}
    # rows hold mean depths over whole surfaces, whose areas turn them into volumes
    areas = [v / d for v, d in zip(end.surfaces.volume, _depths(end), strict=True) if d > 0]
    return errors_of_jumps(end, columns) | {"wear_volume": float(end.over("depth_error")[-1]) * max(areas, default=0.0)}


def _depths(end: LifeState) -> tuple[float, float]:
    return float(end.over("lower_depth")[-1]), float(end.over("upper_depth")[-1])


def _means(passes: Sequence[Pass]) -> dict[str, float]:
    return {column: float(np.mean(_of_passes(passes, column))) for column in _SAMPLED}


def _of_passes(passes: Sequence[Pass], column: str) -> FloatArray:
    """Return a column of the march, position by position."""
    return np.sum([[getattr(one, part) for one in passes] for part in _SAMPLED[column]], axis=0)


def _scatter(end: LifeState) -> dict[str, float]:
    """Return standard errors of the means over the positions of the last round, taken as drawn at random."""
    found = {}
    for name, column in {**START, **END}.items():
        if column in _SAMPLED and len(end.passes) > 1:
            values = _of_passes(end.passes, column)
            found[name] = float(values.std(ddof=1)) / math.sqrt(len(end.passes))
    return found
