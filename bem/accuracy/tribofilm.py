"""Error bars of a tribofilm: grown again on the grid of twice the cell, and there with other growth or longer steps.

The mean growth is over cells that touch: it is of first order in the cell, and takes steps as single cells come into
contact. What the tolerance of reused contacts leaves of the growth is put into the growth itself: film and wear are
integrated once more with it, so that their sensitivity is found and not assumed. Local films have steps in time, whose
tolerance is taken four times as large. A quarter of the film's work, or half of it for local ones. Factors are set by
`reports/experiments/tribofilm_error_bars.py`: an estimate, no proved bound.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from bem.accuracy.bars import GRID, REUSE, STEPS, ErrorBars
from bem.accuracy.mixed import half_grid
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
_GRID, _COUNT = 1.15, 0.075
"""On the difference to twice the cell: 1 is that of first order, the rest what single cells scatter by; and
on the share of the contact that lies within a cell of its edge: touching cells are counted, and the count is off by so
much of those at the edge."""
_LEFT = 1.0
"""Share of the tolerance of reused contacts that growth may be wrong by all along."""
_STEPS = 1.0
"""On the difference to steps in time of four times the tolerance, twice as long: order two would leave a third."""
_TABLE = 2e-3
"""Tolerance of reused contacts here where the film has none."""
_FEWEST = 8


@dataclass(frozen=True, eq=False)
class TribofilmCase:
    """A film, and what it grows in.

    times : [s]. constants : of the balance, as `bem.tribofilm.grow_tribofilm` takes them.
    reuse_tolerance : of growth; None for a local film. local_tolerance : of its steps.
    report : between which times [s] wear is reported, or None.
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
    """Headline figures of a film, SI units; None of what it has not."""
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
    """Bars of the figures `found` of a film."""
    if min(n for n in case.contact.grid.shape if n > 1) < _FEWEST:
        return ErrorBars.unknown(FIGURES, NoBar.TOO_SMALL)
    coarse = _coarser(case)
    try:
        there, other, origin, share, pressure = (_mean if case.reuse_tolerance is not None else _local)(coarse)
    except (ConvergenceError, InfeasibleError):
        return ErrorBars.unknown(FIGURES, NoBar.COARSER_UNSOLVED)
    grid, further = {}, {}
    missing: dict[str, float | None] = {}
    count = _COUNT * _at_edge(pressure) / 2  # of cells half as wide
    constant = case.constants.get("concentration_constant", math.inf)
    for name in FIGURES:
        value, twice, moved = found[name], there[name], other[name]
        if value is None or twice is None or moved is None:
            missing[name] = None
            continue
        # exp(-C1 h) changes by C1 h times what h does, relatively
        least = count * min(1.0, constant * (found["film_thickness"] or 0.0) if name == "final_concentration" else 1.0)
        grid[name] = _GRID * abs(value - twice) + least * abs(value)
        further[name] = share * abs(twice - moved)
    bars = ErrorBars.together({GRID: grid, origin: further})
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
    """Of the mean film, and with all growth larger by what reused contacts may miss."""
    assert case.reuse_tolerance is not None
    reuse = case.reuse_tolerance or _TABLE
    grown = grow_tribofilm(case.times, case.contact, **case.constants, reuse_tolerance=reuse)
    growth = _interpolated(grown.contacts, 1 + _LEFT * case.reuse_tolerance)
    history = evolve_film(case.times, growth, **case.constants)
    steady = steady_thickness(
        growth, case.constants["wear_coefficient"], longest=1.02 * float(history.thickness.max()) + 1e-12
    )
    figures = history_figures(grown.history, grown.steady, case.report)
    return figures, history_figures(history, steady, case.report), REUSE, 1.0, grown.contacts[-1].pressure


def _local(case: TribofilmCase) -> _Found:
    """Of the local film, and with longer steps."""

    def grown(factor: float) -> LocalFilm:
        tolerance = min(factor * case.local_tolerance, 0.5)
        return grow_local_film(case.times, case.contact, **case.constants, tolerance=tolerance)

    films = grown(1.0), grown(4.0)
    one, other = (history_figures(film.history, None, case.report) for film in films)
    return one, other, STEPS, _STEPS, films[0].film_pressure


def _at_edge(pressure: FloatArray) -> float:
    """Share of the touching cells at the contact's edge: faces between cells in contact and not, pi/4 of which are the
    perimeter of a curve in all directions (Crofton), over the cells."""
    touching = pressure > 0
    faces = sum(int(np.sum(np.diff(touching.astype(np.int8), axis=axis) != 0)) for axis in (0, 1))
    return math.pi / 4 * faces / max(int(touching.sum()), 1)


def _interpolated(contacts: Sequence[ContactSample], factor: float) -> Callable[[float], float]:
    """Growth over thickness through contacts that are solved, times a factor; as at the ends beyond them."""
    thickness = np.array([one.thickness for one in contacts])
    growth = np.log(np.maximum([one.growth for one in contacts], 1e-300))
    return lambda h: factor * math.exp(float(np.interp(h, thickness, growth)))
