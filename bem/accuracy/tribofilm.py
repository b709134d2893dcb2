"""Error bars of a tribofilm: grown on the grid of twice the cell, and there with other growth or longer steps.

The mean growth is over cells that touch: it is of first order in the cell, and jumps as single cells come into contact.
The tolerance of reused contacts is put into the growth, and film and wear are integrated once more: their sensitivity
is computed and not assumed. Local films have steps in time, whose tolerance is taken four times as large. Costs a
quarter of the film's work, or half of it for local ones.

Verified in tests/accuracy/test_bars_of_kinds.py; judged by the experiment that `RULES` names.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bem.accuracy.bars import GRID, REUSE, STEPS, ErrorBars
from bem.accuracy.coarsened import half_grid
from bem.accuracy.richardson import Table, rows
from bem.contact.nested_iteration import sample
from bem.errors import ConvergenceError, InfeasibleError
from bem.grid import FloatArray
from bem.notes.accuracy import NoBar
from bem.tribofilm import (
    ContactSample,
    FilmContact,
    FilmHistory,
    LocalFilm,
    evolve_film,
    grow_local_film,
    grow_tribofilm,
)
from bem.tribofilm.evolution import steady_thickness

FIGURES = (
    "film_thickness",
    "largest_mean_thickness",
    "film_wear_rate",
    "wear_depth",
    "total_wear_depth",
    "final_concentration",
    "steady_thickness",
)
RULES = Table(
    "tribofilm_error_bars",
    rows(
        " ".join(FIGURES),
        1.15,
        "First order; single cells scatter by the rest. Touching cells are counted: a count is wrong by a fraction of "
        "those at the edge.",
        order=1,
        count=0.075,
    ),
)
"""Factors on the difference, and a floor on the fraction of the contact within a cell of its edge times the figure
(count)."""
_REUSE = 1.0
"""Error of all growth over the tolerance of reused contacts."""
_STEPS = 1.0
"""Factor on the difference to steps of four times the tolerance, twice as long: second order leaves a third."""
_TABLE = 2e-3
"""Tolerance of reused contacts on the coarser grid where the film has none."""
_FEWEST = 8
"""Cells along an axis, below which the coarser grid has too few."""


@dataclass(frozen=True, eq=False)
class TribofilmCase:
    """A film, and the contact that it grows in.

    times : [s].
    constants : of the balance, as `bem.tribofilm.grow_tribofilm` takes them.
    reuse_tolerance : of growth; None for a local film.
    local_tolerance : of the steps of a local film.
    report : times [s] between which wear is reported, or None.
    """

    contact: FilmContact
    times: FloatArray
    constants: Mapping[str, Any]
    reuse_tolerance: float | None
    local_tolerance: float = 1e-2
    report: tuple[float, float] | None = None


def history_figures(
    history: FilmHistory, steady: float | None, report: Sequence[float] | None
) -> dict[str, float | None]:
    """Return the headline figures of a film, SI units; None for a figure that it does not have."""
    return {
        "film_thickness": float(history.thickness[-1]),
        "largest_mean_thickness": float(history.thickness.max()),
        "film_wear_rate": float(history.wear_rate[-1]),
        "wear_depth": None if report is None else history.wear_depth(*report),
        "total_wear_depth": float(history.substrate_wear[-1]),
        "final_concentration": float(history.concentration[-1]),
        "steady_thickness": None if steady is None or math.isinf(steady) else steady,
    }


def tribofilm_bars(case: TribofilmCase, found: Mapping[str, float | None]) -> ErrorBars:
    """Return the error bars of the figures `found` of a film."""
    if min(n for n in case.contact.grid.shape if n > 1) < _FEWEST:
        return ErrorBars.unknown(FIGURES, NoBar.TOO_SMALL)
    coarse = _coarser(case)
    try:
        there, other, origin, share, pressure = (_mean if case.reuse_tolerance is not None else _local)(coarse)
    except (ConvergenceError, InfeasibleError):
        return ErrorBars.unknown(FIGURES, NoBar.COARSER_UNSOLVED)
    known = [name for name in FIGURES if None not in (found[name], there[name], other[name])]
    own, twice, moved = ({name: float(one[name] or 0.0) for name in known} for one in (found, there, other))
    count = {name: _edge_fraction(pressure) / 2 * abs(value) for name, value in own.items()}  # cells half as wide
    # exp(-C1 h) changes by C1 h times the relative change of h
    exponent = case.constants.get("concentration_constant", math.inf) * (found["film_thickness"] or 0.0)
    if "final_concentration" in count:
        count["final_concentration"] *= min(1.0, exponent)
    grid = RULES.errors(own, twice, {"count": count})
    further = {name: share * abs(twice[name] - moved[name]) for name in known}
    bars = ErrorBars.together({GRID: grid, origin: further})
    missing: dict[str, float | None] = {name: None for name in FIGURES if name not in known}
    return ErrorBars({**missing, **bars.values}, (), bars.parts)


def _coarser(case: TribofilmCase) -> TribofilmCase:
    contact = case.contact
    grid = half_grid(contact.grid)
    gap = sample(contact.gap, grid.shape, grid.periodic)
    area = contact.nominal_area
    if area is not None:
        area = np.round(sample(area, grid.shape, grid.periodic))
    return replace(case, contact=replace(contact, grid=grid, gap=gap, nominal_area=area))


_Found = tuple[dict[str, Any], dict[str, Any], str, float, FloatArray]


def _mean(case: TribofilmCase) -> _Found:
    """Return the figures of the mean film, and with all growth larger by the error of reused contacts."""
    assert case.reuse_tolerance is not None
    reuse = case.reuse_tolerance or _TABLE
    grown = grow_tribofilm(case.times, case.contact, **case.constants, reuse_tolerance=reuse)
    growth = _interpolated(grown.contacts, 1 + _REUSE * case.reuse_tolerance)
    history = evolve_film(case.times, growth, **case.constants)
    steady = steady_thickness(
        growth, case.constants["wear_coefficient"], longest=1.02 * float(history.thickness.max()) + 1e-12
    )
    figures = history_figures(grown.history, grown.steady, case.report)
    return figures, history_figures(history, steady, case.report), REUSE, 1.0, grown.contacts[-1].pressure


def _local(case: TribofilmCase) -> _Found:
    """Return the figures of the local film, and with longer steps."""

    def grown(factor: float) -> LocalFilm:
        tolerance = min(factor * case.local_tolerance, 0.5)
        return grow_local_film(case.times, case.contact, **case.constants, tolerance=tolerance)

    films = grown(1.0), grown(4.0)
    one, other = (history_figures(film.history, None, case.report) for film in films)
    return one, other, STEPS, _STEPS, films[0].film_pressure


def _edge_fraction(pressure: FloatArray) -> float:
    """Return the fraction of the touching cells at the contact's edge.

    pi/4 of the faces between cells in contact and not are the perimeter of a curve in all directions (Crofton).
    """
    touching = pressure > 0
    faces = sum(int(np.sum(np.diff(touching.astype(np.int8), axis=axis) != 0)) for axis in (0, 1))
    return math.pi / 4 * faces / max(int(touching.sum()), 1)


def _interpolated(contacts: Sequence[ContactSample], factor: float) -> Callable[[float], float]:
    """Return growth over thickness through solved contacts, times a factor; constant beyond the ends."""
    thickness = np.array([one.thickness for one in contacts])
    growth = np.log(np.maximum([one.growth for one in contacts], 1e-300))
    return lambda h: factor * math.exp(float(np.interp(h, thickness, growth)))
