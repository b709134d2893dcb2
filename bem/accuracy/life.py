"""Error bars of a life: errors of its cycle jumps, its positions, its cells and the points of its films.

1. Jumps: the errors of all steps add up (`jump_bars`). Step doubling computes them along the life; there is no factor.
2. Cells and positions: the differences to two more lives, one on the grid of twice the cell, and there one of half the
   positions. The scatter of the last round over its positions is a second estimate, and the larger one counts. Heights
   and the film over them have a better estimate (`bem.life.sampling`).
3. Points of the films: the differences of rounds with half the points (twice as many where half are too few), on the
   surfaces of the start and of the end; wear follows the share of the load in contact.
4. The error bar is the sum.

Cost: three eighths of the life. Verified in tests/life/test_life.py; judged by the experiment that the tables name.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from bem.accuracy.bars import GRID, POINTS, ErrorBars
from bem.accuracy.richardson import Table, follow, relative, rows, to_half
from bem.grid import FloatArray
from bem.life.march import LifeState
from bem.life.positions import Passing, PositionContact
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
    "friction": ("boundary_friction", "oil_friction"),
    "contact_share": ("contact_share",),
    "area_share": ("area_share",),
    "minimum_film": ("minimum_film",),
    "lambda_ratio": ("lambda_ratio",),
}
"""Columns that are means over positions, by the fields of a pass that they average."""
_DEPTHS = "worn_depth upper_worn_depth wear_volume"
"""Figures that are proportional to the wear."""
_FILM, _AREA = "tribofilm_thickness", "contact_area_fraction"
_HEIGHTS = {"Sq_final": "Sq_initial", "upper_Sq_final": "upper_Sq_initial"}
"""Rms heights at the end, by those of the unworn surfaces."""

GRID_RULES = Table(
    "life_error_bars",
    rows(" ".join([*END, *START, "wear_volume"]), 1.0, "First order, as wear.", order=1),
    rows(_FILM, 1.0, "First order, as the contact area on which it grows.", order=1),
)
"""Factors on the difference to the grid of twice the cell."""
POSITION_RULES = Table(
    "life_error_bars",
    rows(f"{_DEPTHS} friction_final minimum_film {_FILM}", 1.0, "First order: an even sample of all offsets.", order=1),
    rows("friction_initial", 0.7, "First order; unworn surfaces are alike wherever they meet.", order=1),
    rows("contact_share_final", 1.3, "First order; half the positions may share some of the scatter.", order=1),
    rows("contact_share_initial", 0.5, "First order; unworn surfaces are alike wherever they meet.", order=1),
    rows(_AREA, 0.75, "First order; touching cells of all positions average.", order=1),
    rows(
        f"{' '.join(_HEIGHTS)} {' '.join(_HEIGHTS.values())}",
        1.0,
        "First order; at the end of lives of a single position alone, which have no better estimate.",
        order=1,
    ),
)
"""Factors on the difference to half the positions."""
SCATTER_RULES = Table(
    "life_error_bars",
    rows("friction_final", 0.0, "Positions are spread evenly: their mean scatters less than if drawn.", scatter=0.5),
    rows("friction_initial", 0.0, "As at the end; unworn surfaces are alike wherever they meet.", scatter=0.35),
    rows("contact_share_final", 0.0, "Positions are spread evenly: their mean scatters less.", scatter=0.65),
    rows("contact_share_initial", 0.0, "As at the end; unworn surfaces are alike.", scatter=0.5),
    rows(_AREA, 0.0, "Positions are spread evenly: their mean scatters less.", scatter=0.75),
    rows(f"minimum_film {_FILM}", 0.0, "As if drawn at random.", scatter=1.0),
)
"""Factors on the standard error of a mean over positions drawn at random (scatter): a second estimate of the error of
the positions."""
SAMPLING_RULES = Table(
    "life_error_bars",
    rows("Sq_final", 0.0, "The covariance of heights and depths is exact to first order.", sampled=0.75),
    rows("upper_Sq_final", 0.0, "As of the lower surface, which has more places.", sampled=1.0),
    rows("lambda_ratio_initial lambda_ratio", 0.0, "Roughness of many more positions costs nothing.", sampled=1.0),
)
"""Factors on the estimates of `bem.life.sampling` (sampled), which stand in place of those from half the positions."""
POINT_RULES = Table(
    "life_error_bars",
    rows(
        f"friction_final friction_initial contact_share_final contact_share_initial {_AREA}",
        1.0,
        "Second order: three times Richardson, of figures that hang on the balance of film and contact.",
    ),
    rows("lambda_ratio lambda_ratio_initial", 1.0, "Second order: three times Richardson, as those."),
    rows("minimum_film", 0.6, "Second order: 1.8 times Richardson, as thicknesses of line films."),
    rows(f"{_DEPTHS} {' '.join(_HEIGHTS)}", 0.0, "They follow the share of the load in contact.", share=1.0),
)
"""Factors on the difference to half the points of the films, and on the relative change of the share of the load in
contact times the figure, or times the change of the rms height (share)."""


def fewer_positions(positions: int) -> int:
    """Return half of the positions; two where there is one."""
    return positions // 2 if positions > 1 else 2


def life_figures(end: LifeState) -> dict[str, float]:
    """Return the figures of a life that have error bars, in SI units."""
    found = {name: float(end.over(column)[-1]) for name, column in END.items()}
    found |= {name: float(end.over(column)[0]) for name, column in START.items()}
    found["wear_volume"] = float(sum(end.surfaces.volume))
    if end.surfaces.tribofilm is not None:
        found["tribofilm_thickness"] = float(end.over("tribofilm_thickness")[-1])
    return found


@dataclass(frozen=True, eq=False)
class OtherLives:
    """Lives and rounds that a life is compared with.

    passing : of the life itself.
    coarser, fewer : ends on the grid of twice the cell, and there with `fewer_positions`.
    rounds, other_rounds : means of a round by column of the march on the surfaces of (start, end), with all points of
        the films and with `ratio` times as many.
    """

    passing: Passing
    coarser: LifeState
    fewer: LifeState
    rounds: tuple[dict[str, float], dict[str, float]]
    other_rounds: tuple[dict[str, float], dict[str, float]]
    ratio: float = 0.5


def two_rounds(case: LifeCase, end: LifeState) -> tuple[dict[str, float], dict[str, float]]:
    """Return means over the positions by column of the march, on the unworn surfaces and on those of the end."""
    film = end.surfaces.tribofilm
    grown = (
        None
        if film is None or case.tribofilm is None
        else np.full(film.shape, case.tribofilm.balance.initial_thickness)
    )
    unworn = replace(end.surfaces, heights=end.first, tribofilm=grown)
    first, last = (solve_round(case, surfaces, 0.0).contacts for surfaces in (unworn, end.surfaces))
    return _means(first), _means(last)


def life_bars(end: LifeState, other: OtherLives | None) -> ErrorBars:
    """Return the error bars of a life from its end and from other lives; unknown without them."""
    found = life_figures(end)
    if other is None:
        return ErrorBars.unknown(found, NoBar.EVEN_CELLS_OF_LOOP, fewest=24)
    grid = GRID_RULES.errors(found, life_figures(other.coarser))
    if _FILM in found:
        follow(grid, _FILM, _AREA, found)
    return ErrorBars.together(
        {JUMPS: jump_bars(end), POSITIONS: _position_part(end, other), GRID: grid, POINTS: _point_part(end, other)}
    )


def _position_part(end: LifeState, other: OtherLives) -> dict[str, float]:
    """Return the errors of the positions: by half of them or by their scatter, and by `bem.life.sampling`."""
    found = life_figures(end)
    one, two = life_figures(other.coarser), life_figures(other.fewer)
    errors = POSITION_RULES.errors(one, two)
    for name, scatter in SCATTER_RULES.errors(found, found, {"scatter": _scatter(end)}).items():
        errors[name] = max(errors[name], scatter)
    heights = missed_roughness(end, other.passing)
    if heights is not None:
        errors |= _sampling_errors(found, dict(zip(_HEIGHTS, heights, strict=True)))
    squares = sum(found[name] ** 2 for name in _HEIGHTS)
    rougher = sum(found[name] * errors[name] for name in _HEIGHTS) / squares if squares > 0 else 0.0
    first, last = missed_ratio(end, other.passing)
    ratios = {
        "lambda_ratio_initial": first * found["lambda_ratio_initial"],
        "lambda_ratio": (last + rougher) * found["lambda_ratio"],
    }
    return errors | _sampling_errors(found, ratios)


def _sampling_errors(found: Mapping[str, float], sampled: Mapping[str, float]) -> dict[str, float]:
    """Return the errors of the figures for which there is an estimate."""
    own = {name: found[name] for name in sampled}
    return SAMPLING_RULES.errors(own, own, {"sampled": sampled})


def _point_part(end: LifeState, other: OtherLives) -> dict[str, float]:
    """Return the errors of the points of the films.

    The wear, and figures that follow it, change by the same fraction as the share of the load in contact.
    """
    scale, found = to_half(other.ratio), life_figures(end)
    changed = max(
        scale * abs(whole["contact_share"] - there["contact_share"]) / whole["contact_share"]
        if whole["contact_share"] > 0
        else 0.0
        for whole, there in zip(other.rounds, other.other_rounds, strict=True)
    )
    worn = {name: found[name] for name in _DEPTHS.split()}
    worn |= {name: found[name] - found[unworn] for name, unworn in _HEIGHTS.items()}
    own, there = (
        {name: rounds[0][column] for name, column in START.items() if column in _SAMPLED}
        | {name: rounds[1][column] for name, column in END.items() if column in _SAMPLED}
        for rounds in (other.rounds, other.other_rounds)
    )
    return POINT_RULES.errors(worn | own, worn | there, {"share": relative(changed, worn)}, ratio=other.ratio)


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
    columns = END if end.surfaces.tribofilm is None else END | {"tribofilm_thickness": "tribofilm_thickness"}
    # rows hold mean depths over whole surfaces, whose areas turn them into volumes
    areas = [v / d for v, d in zip(end.surfaces.volume, _depths(end), strict=True) if d > 0]
    return errors_of_jumps(end, columns) | {"wear_volume": float(end.over("depth_error")[-1]) * max(areas, default=0.0)}


def _depths(end: LifeState) -> tuple[float, float]:
    return float(end.over("lower_depth")[-1]), float(end.over("upper_depth")[-1])


def _means(contacts: Sequence[PositionContact]) -> dict[str, float]:
    return {column: float(np.mean(_of_contacts(contacts, column))) for column in _SAMPLED}


def _of_contacts(contacts: Sequence[PositionContact], column: str) -> FloatArray:
    """Return a column of the march, position by position."""
    return np.sum([[getattr(one, part) for one in contacts] for part in _SAMPLED[column]], axis=0)


def _scatter(end: LifeState) -> dict[str, float]:
    """Return standard errors of the means over the positions of the last round, taken as drawn at random."""
    scatter: dict[str, float] = {}
    if len(end.contacts) < 2:
        return scatter
    for name, column in {**START, **END}.items():
        if column in _SAMPLED:
            values = _of_contacts(end.contacts, column)
            scatter[name] = float(values.std(ddof=1)) / math.sqrt(len(end.contacts))
    found = life_figures(end)
    if _FILM in found and found[_AREA] > 0:
        scatter[_FILM] = found[_FILM] * scatter[_AREA] / found[_AREA]
    return scatter
