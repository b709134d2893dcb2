"""Error bars of a wear loop: the same cycles on the grid of twice the cell, at every second depth.

Wear converges with about first order: against an eighth of the cell, the volume worn in a cycle was 60 % too large with
five to nine cells to a correlation length, 25 and 10 % on halves and quarters of them. The order in which particles
leave is chance, so that a difference may pass zero where others do not: a bar is the figure's own difference to the
coarser loop and a fraction of the figure as large as the relative difference of the wear.

What wears wrongly changes a figure by no more than wear can. The rms height Sq is a seminorm: its error after wear is
at most that of the unworn heights and the rms of what is worn too much (`worn_change`); loads, friction and areas
follow as far as the depths count beside the roughness (`_worn_part`).

Sizes of particles hardly improve with the cell: their bars hold a fraction of the figure whatever the grid, so that no
accuracy can be asked of them. Numbers and means by number follow the cell; so do lengths and widths as long as a
correlation length has few cells (40 % off with three to eight, against a quarter of the cell). They have no bars.

Verified in tests/accuracy/test_wear_bars.py and test_running_in_bars.py; judged by the experiments that the tables
name, on other seeds than those that the numbers were chosen on.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from bem.accuracy.bars import GRID, ErrorBars
from bem.accuracy.richardson import Table, follow, relative, rows, to_half
from bem.notes.accuracy import NoBar

FEWEST = 24
"""Cells along an axis, and twice as many as the coarser loop has."""
_WORN_ROUGHNESS = rows(
    "Sq_final",
    0.9,
    "First order, as wear: of its change by wear. The bar of the unworn surface is added.",
    order=1,
    worn=0.45,
)
"""Row of the rms height after wear; its floor holds the relative difference of the wear times `worn_change` (worn)."""
_MOST_OF_CHANGE = 2.0
"""Largest error of the change of Sq by wear over `worn_change`: as much again may wear as does, or nothing."""
_DEPTHS_COUNT = 10.0
"""Factor on the rms of the worn depths over the rms height of the surface, above which wear decides loads, friction and
areas. Depths are those of the few per cent of the surface in contact, where they are five to ten times their rms."""
RULES = Table(
    "wear_error_bars",
    rows("Sq_initial", 0.9, "Heights on every second cell: another sample of the surface.", order=1, wear=0.12),
    _WORN_ROUGHNESS,
    rows(
        "contact_area_fraction mean_contact_pressure",
        1.0,
        "First order; the load is given, so that the pressure follows the area.",
        order=1,
        wear=1.0,
    ),
    rows("worn_volume_per_cycle", 1.2, "First order; the volume scatters by single particles.", order=1, wear=0.4),
    rows("worn_depth", 0.8, "First order; a sum over all cycles scatters less.", order=1, wear=0.6, figure=0.0005),
    rows(
        "first_cycles_radius",
        0.6,
        "Second order before surfaces differ: the first cycles wear the same surface.",
        wear=0.05,
        figure=0.025,
    ),
    rows(
        " ".join(f"{by}_mean_{size}" for by in ("area", "volume") for size in ("equivalent_radius", "thickness")),
        1.0,
        "Sizes hardly improve with the cell.",
        order=1,
        figure=0.1,
    ),
)
"""Factors on the difference, and floors on the relative difference of the wear times the figure (wear) and on the
figure itself (figure)."""
FROM_START = ("friction_initial", "contact_load_initial", "Sq_initial")
"""Figures before any wear."""
_OF_CONTACT = ("boundary_friction_part", "contact_load", "contact_area_fraction")
_OF_FRICTION = ("friction_run_in", "friction")
BY_LOAD = "wear_volume"
"""Volume worn by a law of pressure and distance, V = k F s (Archard 1953): it has the error of the load F, as its rate
has, and the depth within the contact region that of the region's share of the volume besides. Volumes of pieces have no
row: they follow the depth."""
_RATE = "criterion_wear_rate"
"""Wear rate of the last cycles; of a law by pressure and distance it follows the load, as the volume does."""
MIXED_RULES = Table(
    "running_in_error_bars",
    rows(" ".join(FROM_START), 0.8, "As load sharing, before any wear.", figure=0.0002),
    rows(" ".join(_OF_FRICTION), 1.2, "First order, as wear, which passes load.", order=1, figure=0.0005, passed=0.8),
    rows(" ".join(_OF_CONTACT), 1.2, "First order, as wear, which passes load.", order=1, passed=0.8),
    rows(
        BY_LOAD,
        1.2,
        "Of a law by pressure and distance: proportional to the contact load, and as wrong.",
        order=1,
        passed=0.8,
    ),
    rows(
        "film_load minimum_film film_friction_part",
        1.0,
        "First order; the film follows the contact load.",
        order=1,
        figure=0.001,
    ),
    rows("lambda_ratio", 0.6, "Roughness by wear, film by second order.", wear=0.2, figure=0.002),
    _WORN_ROUGHNESS,
    rows("worn_depth criterion_wear_rate", 2.0, "First order; few cycles scatter most.", order=1, wear=1.2),
    rows(
        "contact_temperature flash_temperature",
        1.5,
        "First order: heat enters through whole cells. The rise counts.",
        order=1,
        wear=0.3,
        figure=0.002,
    ),
)
"""The same in mixed lubrication, where a floor holds the relative difference of the wear times the part of the figure
that can pass between film and contact (passed). There is no wear rate where nothing slides."""
_PASSES = 0.005
"""Part of the load of the lighter of film and contact that another surface passes between them without any wear."""
_FILM_FACTOR = 0.6
"""Factor on the difference to half the points of the film, as in load sharing."""
OF_FILM = ("friction_initial", "friction_run_in", "friction", "film_friction_part", "minimum_film", "lambda_ratio")
"""Figures that follow the film."""
_HEAT = 1.0
"""Factor on the difference of figures that follow a film with full heat, whose columns and layers are of first order;
for the oil's friction on the film's relative difference, too."""
_FRICTION_OF_FILM = 0.5
"""Relative error of the film's friction over that of its load: an oil's shear follows the thickness half as much."""
_WEARS = ("Sq_final", "worn_volume_per_cycle", "worn_depth")
"""Figures whose relative differences are that of the wear."""


def wear_bars(
    found: Mapping[str, Any],
    coarser: Mapping[str, Any] | None,
    reported: Mapping[str, str] | None = None,
    *,
    worn_rms: float | None = None,
    tracked: bool = False,
    by_load: bool = False,
) -> ErrorBars:
    """Return the error bars of the figures of a wear loop.

    Parameters
    ----------
    found, coarser : figures of the loop, and on the grid of twice the cell, None where there is no such grid.
    reported : further names of figures, which have the same bars.
    worn_rms : rms of the worn depths about their mean, in the region of Sq [m]; None where it is not known.
    tracked : the body moves through the contact, so that the region of Sq is the same on all grids.
    by_load : the worn volume is that of a law of pressure and distance, which the given load decides.
    """
    bars = _wear_bars(found, coarser, worn_rms, tracked=tracked, by_load=by_load)
    volume, rate = found["worn_volume_per_cycle"], found.get("criterion_wear_rate")
    bars |= bars.renamed(reported or {})
    if rate is None or not volume > 0:
        return bars
    return bars | bars.renamed({"worn_volume_per_cycle": "criterion_wear_rate"}, lambda error: rate / volume * error)


def _wear_bars(
    found: Mapping[str, Any], coarser: Mapping[str, Any] | None, worn_rms: float | None, *, tracked: bool, by_load: bool
) -> ErrorBars:
    if coarser is None:
        return ErrorBars.unknown(RULES, NoBar.EVEN_CELLS_OF_LOOP, fewest=FEWEST)
    if not (found["worn_volume_per_cycle"] > 0 and coarser["worn_volume_per_cycle"] > 0):
        return ErrorBars.unknown(RULES, NoBar.NOTHING_WEARS)
    own = {name: found[name] for name in RULES if name in found}
    differs = wear_difference(found, coarser)
    indicators = {"wear": relative(differs, own), "figure": relative(1.0, own)}
    for name, known in (("Sq_initial", tracked), ("worn_volume_per_cycle", by_load)):
        if known:
            indicators["wear"][name] = 0.0
    errors = _errors(RULES, own, coarser, indicators, worn_rms)
    area = own["contact_area_fraction"]
    if area > 0:
        errors["mean_contact_pressure"] = own["mean_contact_pressure"] / area * errors["contact_area_fraction"]
    return ErrorBars.together({GRID: errors})


def running_in_bars(
    found: Mapping[str, float],
    coarser: Mapping[str, float] | None,
    finer_film: Mapping[str, float] | None = None,
    *,
    full_heat: bool = False,
    unworn_error: float | None = None,
    worn_rms: float | None = None,
) -> ErrorBars:
    """Return the error bars of a loop in mixed lubrication, and of one in full film, where nothing can wear.

    Parameters
    ----------
    found, coarser : figures of the loop, and on the grid of twice the cell with half the points of the film, or as many
        where half are too few.
    finer_film : figures of the coarser loop with twice the points of its film, where half are too few.
    full_heat : the coarser loop has half the columns and layers of heat.
    unworn_error : error of Sq before any wear [m]; None estimates it from the coarser loop.
    worn_rms : rms of the worn depths about their mean, in the region of Sq [m]; None where it is not known.
    """
    if coarser is None:
        return ErrorBars.unknown(MIXED_RULES, NoBar.EVEN_CELLS_OF_LOOP, fewest=FEWEST)
    errors = _mixed_errors(found, coarser, unworn_error, worn_rms)
    if finer_film is not None:
        factor = _FILM_FACTOR * to_half(2.0)
        errors = {name: error + factor * abs(coarser[name] - finer_film[name]) for name, error in errors.items()}
    if full_heat:
        for name in OF_FILM:
            errors[name] += _HEAT * abs(found[name] - coarser[name])
        if found["minimum_film"] > 0:
            thinner = abs(coarser["minimum_film"] / found["minimum_film"] - 1)
            errors["film_friction_part"] += _HEAT * thinner * abs(found["film_friction_part"])
    bars = ErrorBars.together({GRID: errors})
    wear, contact = (tuple(each[name] > 0 for each in (found, coarser)) for name in ("worn_depth", "contact_load"))
    if all(wear) or not any(contact):
        return bars
    known = ErrorBars.together({GRID: {name: bars.values[name] for name in FROM_START}})
    return ErrorBars.unknown([name for name in MIXED_RULES if name not in FROM_START], NoBar.NOTHING_WEARS) | known


def _mixed_errors(
    found: Mapping[str, float], coarser: Mapping[str, float], unworn_error: float | None, worn_rms: float | None
) -> dict[str, float]:
    """Return the errors of the loop's cells and depths, with the load that wear may pass between film and contact."""
    own = {name: found[name] for name in MIXED_RULES if name in found}
    differs = wear_difference(found, coarser)
    decides = differs * (1.0 if worn_rms is None else _worn_part(found, worn_rms))
    contact, film = found["contact_load"], found["film_load"]
    # no more load can pass than the lighter of film and contact carries
    lighter = min(film / contact, 1.0) if contact > 0 else 0.0
    passed = relative(decides * lighter, own)
    passed |= dict.fromkeys(_OF_FRICTION, passed["boundary_friction_part"])
    wear = relative(decides, own) | {name: differs * own[name] for name in ("worn_depth", _RATE) if name in own}
    if worn_rms is not None and found["Sq_final"] > 0:  # the ratio follows the roughness alone
        change = worn_change(found["Sq_initial"], found["Sq_final"], worn_rms)
        wear["lambda_ratio"] = min(_MOST_OF_CHANGE * change / found["Sq_final"], 1.0) * differs * found["lambda_ratio"]
    indicators = {"wear": wear, "figure": relative(1.0, own), "passed": passed}
    errors = _errors(MIXED_RULES, own, coarser, indicators, worn_rms, unworn_error)
    if BY_LOAD in own and _RATE in own:
        errors[_RATE] = MIXED_RULES[BY_LOAD].error(own[_RATE] - coarser[_RATE], {"passed": passed[_RATE]})
    first, load = found["contact_load_initial"], contact + film
    passes_first = _PASSES * min(first, load - first)
    errors["contact_load_initial"] += passes_first
    errors["friction_initial"] += passes_first / load * abs(found["friction_initial"])
    for name in (*_OF_CONTACT, *_OF_FRICTION, *((BY_LOAD, _RATE) if BY_LOAD in own else ())):
        if name in errors:
            passes = "boundary_friction_part" if name in _OF_FRICTION else name
            errors[name] += _PASSES * lighter * abs(found[passes])
    follow(errors, "contact_area_fraction", "contact_load", found)
    if BY_LOAD in own and min(own[BY_LOAD], coarser[BY_LOAD]) > 0:  # the region's share of the volume is not the load's
        there = coarser["worn_depth"] * own[BY_LOAD] / coarser[BY_LOAD]
        errors["worn_depth"] = own["worn_depth"] * errors[BY_LOAD] / own[BY_LOAD] + MIXED_RULES["worn_depth"].error(
            own["worn_depth"] - there, {}
        )
    # both loads sum to the given one: a film under less load is at most as much thicker (rigid walls)
    fraction = min(errors["contact_load"] / film, 1.0) if film > 0 else 1.0
    errors["film_load"] = errors["contact_load"]
    errors["minimum_film"] += fraction * found["minimum_film"]
    errors["film_friction_part"] += _FRICTION_OF_FILM * fraction * found["film_friction_part"]
    return errors


def _errors(
    rules: Table,
    found: Mapping[str, Any],
    coarser: Mapping[str, Any],
    indicators: Mapping[str, Mapping[str, Any]],
    worn_rms: float | None,
    unworn_error: float | None = None,
) -> dict[str, Any]:
    """Return the errors by a table; that of Sq after wear is the sum of that before wear and that of its change.

    worn_rms, unworn_error : as of `running_in_bars`.
    """
    before, after = found["Sq_initial"], found["Sq_final"]
    change = after if worn_rms is None else worn_change(before, after, worn_rms)
    other = {**coarser, "Sq_final": before + coarser["Sq_final"] - coarser["Sq_initial"]}
    worn = {"Sq_final": wear_difference(found, coarser) * change}
    errors = rules.errors(found, other, {**indicators, "worn": worn})
    if unworn_error is not None:
        errors["Sq_initial"] = unworn_error
    errors["Sq_final"] = errors["Sq_initial"] + min(errors["Sq_final"], _MOST_OF_CHANGE * change)
    return errors


def worn_change(before: float, after: float, worn_rms: float) -> float:
    """Return an upper estimate of how far wear changes the rms height of a surface [m].

    With heights h and worn depths w, Sq(h - w)^2 = Sq(h)^2 - 2 cov(h, w) + Sq(w)^2. The covariance lowers Sq and Sq(w)
    raises it; both count with one sign here, so that they do not cancel. Sq is a seminorm: it changes by Sq(w) at most.

    before, after : Sq of the surface [m]. worn_rms : Sq of the worn depths [m].
    """
    if not after > 0:
        return worn_rms
    covariance = 0.5 * (before**2 + worn_rms**2 - after**2)
    return min((abs(covariance) + worn_rms**2) / after, worn_rms)


def _worn_part(found: Mapping[str, float], worn_rms: float) -> float:
    """Return the part in which wear decides the contact: 1 where depths are as large as the roughness, 0 unworn."""
    return min(_DEPTHS_COUNT * worn_rms / found["Sq_final"], 1.0) if found["Sq_final"] > 0 else 1.0


def wear_difference(found: Mapping[str, float], coarser: Mapping[str, float]) -> float:
    """Return the relative difference of the wear of two loops: the root mean square over figures, at most 1 each; 0
    where nothing wears."""
    differences = [
        min(abs(found[name] - coarser[name]) / abs(found[name]), 1.0)
        for name in _WEARS
        if name in found and found["worn_depth"] != 0 != found[name]
    ]
    return math.sqrt(sum(value * value for value in differences) / len(differences)) if differences else 0.0
