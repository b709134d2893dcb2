"""Error bars of a wear loop: the same cycles on the grid of twice the cell, at every second depth.

Wear converges with about first order: against an eighth of the cell, the volume worn in a cycle was 60 % too large with
five to nine cells to a correlation length, 25 and 10 % on halves and quarters of them. The order in which particles
leave is chance, so that a difference may pass zero where others do not: a bar is the figure's own difference to the
coarser loop and a fraction of the figure as large as the relative difference of the wear.

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
from bem.accuracy.richardson import Table, relative, rows, to_half
from bem.notes.accuracy import NoBar

FEWEST = 24
"""Cells along an axis, and twice as many as the coarser loop has."""
_WORN_ROUGHNESS = rows("Sq_final", 0.9, "First order, as wear.", order=1, wear=0.45, figure=0.001)
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
"""Volume worn by a law of pressure and distance, V = k F s (Archard 1953): it has the error of the load F, where the
depth within the contact region has that of the heights. Volumes of pieces have no row: they follow the depth."""
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
_PASSES_FIRST = 0.005
"""Part of the load of the lighter of film and contact that another surface passes between them in the first cycle."""
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
    found: Mapping[str, Any], coarser: Mapping[str, Any] | None, reported: Mapping[str, str] | None = None
) -> ErrorBars:
    """Return the error bars of the figures of a wear loop.

    Parameters
    ----------
    found, coarser : figures of the loop, and on the grid of twice the cell, None where there is no such grid.
    reported : further names of figures, which have the same bars.
    """
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
    own = {name: found[name] for name in RULES if name in found}
    wear = relative(wear_difference(found, coarser), own)
    errors = RULES.errors(own, coarser, {"wear": wear, "figure": relative(1.0, own)})
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
) -> ErrorBars:
    """Return the error bars of a loop in mixed lubrication, and of one in full film, where nothing can wear.

    Parameters
    ----------
    found, coarser : figures of the loop, and on the grid of twice the cell with half the points of the film, or as many
        where half are too few.
    finer_film : figures of the coarser loop with twice the points of its film, where half are too few.
    full_heat : the coarser loop has half the columns and layers of heat.
    """
    if coarser is None:
        return ErrorBars.unknown(MIXED_RULES, NoBar.EVEN_CELLS_OF_LOOP, fewest=FEWEST)
    errors = _mixed_errors(found, coarser)
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


def _mixed_errors(found: Mapping[str, float], coarser: Mapping[str, float]) -> dict[str, float]:
    """Return the errors of the loop's cells and depths, with the load that wear may pass between film and contact."""
    own = {name: found[name] for name in MIXED_RULES if name in found}
    differs = wear_difference(found, coarser)
    contact, film = found["contact_load"], found["film_load"]
    # no more load can pass than the lighter of film and contact carries
    passed = relative(differs * min(film / contact, 1.0) if contact > 0 else 0.0, own)
    passed |= dict.fromkeys(_OF_FRICTION, passed["boundary_friction_part"])
    indicators = {"wear": relative(differs, own), "figure": relative(1.0, own), "passed": passed}
    errors = MIXED_RULES.errors(own, coarser, indicators)
    first, load = found["contact_load_initial"], contact + film
    passes_first = _PASSES_FIRST * min(first, load - first)
    errors["contact_load_initial"] += passes_first
    errors["friction_initial"] += passes_first / load * abs(found["friction_initial"])
    # both loads sum to the given one: a film under less load is at most as much thicker (rigid walls)
    fraction = min(errors["contact_load"] / film, 1.0) if film > 0 else 1.0
    errors["film_load"] = errors["contact_load"]
    errors["minimum_film"] += fraction * found["minimum_film"]
    errors["film_friction_part"] += _FRICTION_OF_FILM * fraction * found["film_friction_part"]
    return errors


def wear_difference(found: Mapping[str, float], coarser: Mapping[str, float]) -> float:
    """Return the relative difference of the wear of two loops: the root mean square over figures, at most 1 each; 0
    where nothing wears."""
    differences = [
        min(abs(found[name] - coarser[name]) / abs(found[name]), 1.0)
        for name in _WEARS
        if name in found and found["worn_depth"] != 0 != found[name]
    ]
    return math.sqrt(sum(value * value for value in differences) / len(differences)) if differences else 0.0
