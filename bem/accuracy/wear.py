"""Error bars of a wear loop: the same cycles on the grid of twice the cell, at every second depth.

Wear is chaotic in the small: which piece leaves first decides which is left, so that the difference to the coarser loop
is discretisation and scatter in one, and so is the bar, the difference times a factor and a share of the figure where
it happens to pass zero. Numbers and means by number follow the cell; lengths and widths do so as long as a correlation
length has few of them (against a quarter of the cell, 40 % off with three to eight, 20 % on half the cell): no bars.
Factors are set by experiment and judged by `reports/experiments/wear_error_bars.py` and `running_in_error_bars.py`: an
estimate, no proved bound.
"""

from __future__ import annotations

from collections.abc import Mapping

from bem.accuracy.bars import GRID, ErrorBars

FEWEST = 24
"""Cells along an axis, and twice as many as the coarser loop has."""
_SIZE, _WORN, _CONTACT = (1.0, 0.1), (1.5, 0.15), (1.0, 0.02)
RULES: dict[str, tuple[float, float]] = {
    "Sq_initial": (0.5, 0.02),
    "Sq_final": _WORN,
    "contact_area_fraction": _CONTACT,
    "mean_contact_pressure": _CONTACT,
    "worn_volume_per_cycle": _WORN,
    "first_cycles_radius": _WORN,
    **{f"{by}_mean_{size}": _SIZE for by in ("area", "volume") for size in ("equivalent_radius", "thickness")},
}
"""Factor on the difference, and on the figure."""
# chosen on twelve loops of `reports/experiments/running_in_error_bars.py` with another seed than the stored one's
_LOAD = (1.2, 0.01)
MIXED_RULES: dict[str, tuple[float, float]] = {
    **dict.fromkeys(("friction_initial", "friction_run_in", "friction"), (1.2, 0.005)),
    **dict.fromkeys(("boundary_friction_part", "contact_load_initial", "contact_load"), _LOAD),
    **dict.fromkeys(("film_load", "film_friction_part", "minimum_film"), (1.0, 0.0)),
    "lambda_ratio": (1.0, 0.03),
    "contact_area_fraction": _CONTACT,
    "Sq_initial": (1.2, 0.005),
    "Sq_final": (1.2, 0.04),
    "worn_depth": _WORN,
}
"""The same in mixed lubrication; `_of_film` adds to those of the film."""
FROM_START = ("friction_initial", "contact_load_initial", "Sq_initial")
"""Figures before anything wore."""
_MIXED_NOTHING = (
    "run-in figures have no error bars: surfaces touch, and nothing wears on the grid of twice the cell, or here; "
    "whether anything does on finer cells is not known"
)
_ODD = (
    f"no error bars from a coarser loop: it needs even numbers of cells, {FEWEST} at least, and contacts that converge "
    "on the grid of twice the cell"
)
_NOTHING = "no error bars from a coarser loop: nothing wears on the grid of twice the cell, or here"


def wear_bars(found: Mapping[str, float], coarser: Mapping[str, float] | None) -> ErrorBars:
    """Bars of the figures of a wear loop from those on the grid of twice the cell, None where there is no such grid."""
    if coarser is None:
        return ErrorBars.unknown(RULES, _ODD)
    if not (found["worn_volume_per_cycle"] > 0 and coarser["worn_volume_per_cycle"] > 0):
        return ErrorBars.unknown(RULES, _NOTHING)
    return ErrorBars.together({GRID: _bars(found, coarser, RULES)})


def running_in_bars(found: Mapping[str, float], coarser: Mapping[str, float] | None) -> ErrorBars:
    """The same of a loop in mixed lubrication, and of one in full film, where nothing can wear."""
    if coarser is None:
        return ErrorBars.unknown(MIXED_RULES, _ODD)
    bars = ErrorBars.together({GRID: _of_film(found, _bars(found, coarser, MIXED_RULES))})
    wear, contact = (tuple(each[name] > 0 for each in (found, coarser)) for name in ("worn_depth", "contact_load"))
    if all(wear) or not any(contact):
        return bars
    known = ErrorBars.together({GRID: {name: bars.values[name] for name in FROM_START}})
    return ErrorBars.unknown([name for name in MIXED_RULES if name not in FROM_START], _MIXED_NOTHING) | known


def _of_film(found: Mapping[str, float], bars: dict[str, float]) -> dict[str, float]:
    """With what the contact's load leaves of the film's: together they are given, so that both have one error. A film
    that carries little is as thin as its load is large, at most (rigid walls); its friction was seen to follow half as
    much."""
    film = found["film_load"]
    share = min(bars["contact_load"] / film, 1.0) if film > 0 else 1.0
    return bars | {
        "film_load": bars["contact_load"],
        "minimum_film": bars["minimum_film"] + share * found["minimum_film"],
        "film_friction_part": bars["film_friction_part"] + 0.5 * share * found["film_friction_part"],
    }


def _bars(
    found: Mapping[str, float], coarser: Mapping[str, float], rules: Mapping[str, tuple[float, float]]
) -> dict[str, float]:
    return {n: factor * abs(found[n] - coarser[n]) + share * abs(found[n]) for n, (factor, share) in rules.items()}
