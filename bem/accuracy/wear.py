"""Error bars of a wear loop: the same cycles on the grid of twice the cell, at every second depth.

What wears converges, of first order about: against an eighth of the cell, the volume worn in a cycle was 60 % too large
with five to nine cells to a correlation length, 25 and 10 % on halves and quarters of them. But which piece leaves
first is chance in the small, and a difference may happen to pass zero where others do not: a bar is the figure's own
difference to the coarser loop and a share of the figure as large as what wears differs relatively, each times a factor.
Sizes of pieces do not get that much better with the cell: theirs hold a share of the figure whatever the grid, so that
no accuracy can be asked of them. Numbers and means by number follow the cell; lengths and widths do so as long as a
correlation length has few of them (against a quarter of the cell, 40 % off with three to eight, 20 % on half the cell):
no bars. Factors are set by experiment and judged by `reports/experiments/wear_error_bars.py` and
`running_in_error_bars.py`: an estimate, no proved bound.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

from bem.accuracy.bars import GRID, ErrorBars
from bem.notes.accuracy import NoBar

FEWEST = 24
"""Cells along an axis, and twice as many as the coarser loop has."""


class LoopRule(NamedTuple):
    """Factors on a figure's difference to the coarser loop, on the figure times the relative difference of what wears,
    and on the figure."""

    difference: float
    wear: float = 0.0
    share: float = 0.0


_SIZE = LoopRule(1.0, share=0.1)
RULES: dict[str, LoopRule] = {
    "Sq_initial": LoopRule(0.9, wear=0.12),
    "Sq_final": LoopRule(0.9, wear=0.45, share=0.001),
    "contact_area_fraction": LoopRule(1.0, wear=1.0),
    "mean_contact_pressure": LoopRule(1.0, wear=1.0),  # that of the area, relatively: the load is given
    "worn_volume_per_cycle": LoopRule(1.2, wear=0.4),
    "worn_depth": LoopRule(0.8, wear=0.6, share=0.0005),
    "first_cycles_radius": LoopRule(0.6, wear=0.05, share=0.025),
    **{f"{by}_mean_{size}": _SIZE for by in ("area", "volume") for size in ("equivalent_radius", "thickness")},
}
# chosen on loops of other seeds than the stored ones'
_OF_CONTACT = ("boundary_friction_part", "contact_load", "contact_area_fraction")
_OF_FRICTION = ("friction_run_in", "friction")
MIXED_RULES: dict[str, LoopRule] = {
    **dict.fromkeys(("friction_initial", "contact_load_initial", "Sq_initial"), LoopRule(0.8, share=0.0002)),
    **dict.fromkeys(_OF_FRICTION, LoopRule(1.2, share=0.0005)),
    **dict.fromkeys(_OF_CONTACT, LoopRule(1.2)),
    **dict.fromkeys(("film_load", "minimum_film"), LoopRule(1.0)),
    "film_friction_part": LoopRule(1.0, share=0.001),
    "lambda_ratio": LoopRule(0.6, wear=0.2, share=0.002),
    "Sq_final": LoopRule(1.2, wear=0.45, share=0.005),
    "worn_depth": LoopRule(1.5, wear=0.7),
    "criterion_wear_rate": LoopRule(2.0, wear=1.2),
    **dict.fromkeys(("contact_temperature", "flash_temperature"), LoopRule(1.5, wear=0.3, share=0.002)),
}
"""The same in mixed lubrication; `_of_film` adds to those of the film. There is no wear rate where nothing slides; of
temperatures the rise counts."""
_PASSES, _PASSES_FIRST = 0.8, 0.005
"""Of the load that can pass between film and contact, no more than the lighter of them has: times how much differently
the coarser loop wears, and of the first cycle's. Surfaces worn otherwise pass it from one to the other; where one has
nearly all, shares of the load (and the boundary friction) are known far better than the wear."""
_FILM_TWICE = 1.5
"""On what twice the points of a film change: order two leaves 4/3 of it, as in load sharing."""
OF_FILM = ("friction_initial", "friction_run_in", "friction", "film_friction_part", "minimum_film", "lambda_ratio")
"""Figures that follow the film."""
_HEAT = 1.0
"""Besides, of the difference in figures that follow a film with full heat, whose columns and layers are of first order;
in that of the oil's friction of the film's relative change as well (as of kind traction)."""
_WEARS = ("Sq_final", "worn_volume_per_cycle", "worn_depth")
"""Figures that say how much differently the coarser loop wears."""
FROM_START = ("friction_initial", "contact_load_initial", "Sq_initial")
"""Figures before anything wore."""


def wear_bars(
    found: Mapping[str, Any], coarser: Mapping[str, Any] | None, reported: Mapping[str, str] | None = None
) -> ErrorBars:
    """Bars of the figures of a wear loop from those on the grid of twice the cell, None where there is no such grid;
    with that of its `criterion_wear_rate`, where it has one, and those of sizes under further names, as they are
    `reported`."""
    bars, volume, rate = _wear_bars(found, coarser), found["worn_volume_per_cycle"], found.get("criterion_wear_rate")
    bars |= bars.renamed(reported or {})
    if rate is None or not volume > 0:
        return bars
    return bars | bars.renamed({"worn_volume_per_cycle": "criterion_wear_rate"}, lambda error: rate / volume * error)


def _wear_bars(found: Mapping[str, Any], coarser: Mapping[str, Any] | None) -> ErrorBars:
    if coarser is None:
        return ErrorBars.unknown(RULES, NoBar.EVEN_CELLS_OF_LOOP, fewest=FEWEST)
    if not (found["worn_volume_per_cycle"] > 0 and coarser["worn_volume_per_cycle"] > 0):
        return ErrorBars.unknown(RULES, NoBar.NOTHING_WEARS)
    bars, area = _bars(found, coarser, RULES), found["contact_area_fraction"]
    if area > 0:
        bars["mean_contact_pressure"] = found["mean_contact_pressure"] / area * bars["contact_area_fraction"]
    return ErrorBars.together({GRID: bars})


def running_in_bars(
    found: Mapping[str, float],
    coarser: Mapping[str, float] | None,
    finer_film: Mapping[str, float] | None = None,
    *,
    full_heat: bool = False,
) -> ErrorBars:
    """The same of a loop in mixed lubrication, and of one in full film, where nothing can wear; `finer_film` : the
    coarser loop with twice the points of its film, which it has as many of as `found` where half are too few; with
    `full_heat` the coarser loop has half its columns and layers."""
    if coarser is None:
        return ErrorBars.unknown(MIXED_RULES, NoBar.EVEN_CELLS_OF_LOOP, fewest=FEWEST)
    of_loop = _of_film(found, _of_passing(found, coarser, _bars(found, coarser, MIXED_RULES)))
    if finer_film is not None:
        of_loop = {name: bar + _FILM_TWICE * abs(coarser[name] - finer_film[name]) for name, bar in of_loop.items()}
    if full_heat:
        for name in OF_FILM:
            of_loop[name] += _HEAT * abs(found[name] - coarser[name])
        if found["minimum_film"] > 0:
            thinner = abs(coarser["minimum_film"] / found["minimum_film"] - 1)
            of_loop["film_friction_part"] += _HEAT * thinner * abs(found["film_friction_part"])
    bars = ErrorBars.together({GRID: of_loop})
    wear, contact = (tuple(each[name] > 0 for each in (found, coarser)) for name in ("worn_depth", "contact_load"))
    if all(wear) or not any(contact):
        return bars
    known = ErrorBars.together({GRID: {name: bars.values[name] for name in FROM_START}})
    return ErrorBars.unknown([name for name in MIXED_RULES if name not in FROM_START], NoBar.NOTHING_WEARS) | known


def _of_passing(found: Mapping[str, float], coarser: Mapping[str, float], bars: dict[str, float]) -> dict[str, float]:
    """With the load that wear may pass between film and contact."""
    contact, first = found["contact_load"], found["contact_load_initial"]
    load = contact + found["film_load"]
    passes_first = _PASSES_FIRST * min(first, load - first)
    bars = bars | {
        "contact_load_initial": bars["contact_load_initial"] + passes_first,
        "friction_initial": bars["friction_initial"] + passes_first / load * abs(found["friction_initial"]),
    }
    if not contact > 0:
        return bars
    passes = _PASSES * _differs(found, coarser) * min(found["film_load"] / contact, 1.0)
    changes = {name: passes * abs(found[name]) for name in _OF_CONTACT}
    changes |= dict.fromkeys(_OF_FRICTION, changes["boundary_friction_part"])
    return bars | {name: bars[name] + change for name, change in changes.items()}


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


def _bars(found: Mapping[str, float], coarser: Mapping[str, float], rules: Mapping[str, LoopRule]) -> dict[str, float]:
    differs = _differs(found, coarser)
    return {
        name: rule.difference * abs(found[name] - coarser[name]) + (rule.wear * differs + rule.share) * abs(found[name])
        for name, rule in rules.items()
        if name in found
    }


def _differs(found: Mapping[str, float], coarser: Mapping[str, float]) -> float:
    """How much differently a coarser loop wears: the root of the mean square of relative differences, 1 each at most;
    0 where nothing wears."""
    relative = [
        min(abs(found[name] - coarser[name]) / abs(found[name]), 1.0)
        for name in _WEARS
        if name in found and found["worn_depth"] != 0 != found[name]
    ]
    return math.sqrt(sum(value * value for value in relative) / len(relative)) if relative else 0.0
