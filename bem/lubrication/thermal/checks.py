"""Notes on the limits of films with heat."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.checks import Case, notes_on, why_no_line_film
from bem.lubrication.inlet_heating import InletHeating
from bem.lubrication.line.state import FilmState
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.oils.oil import EXTRAPOLATED, HOTTEST, Oil
from bem.lubrication.results import FilmSolution
from bem.notes import Note, without
from bem.notes.lubrication import HEAT_LEFT_OUT, LUMPED_HEAT_LIMIT, OIL_DATA_SHORT, OIL_TOO_HOT
from bem.notes.note import Span
from bem.physical_constants import ZERO_CELSIUS

LARGEST_LOADING = 0.05
"""Thermal loading of the inlet up to which lumped heat is accurate: film and friction within 6 % of full heat up to a
slide-to-roll ratio of 0.5 (`reports/experiments/lumped_heat.py`)."""
LARGEST_SLIDE, LARGEST_RISE = 1.0, 5.0
"""Slide-to-roll ratio, and rise of the mean temperature of the oil [K], above which lumped films are too thick: up to
2.8 times at a ratio of 2, up to 1.17 times at 1 (the same experiment)."""
FULL_SLIDE = 2.0
"""Slide-to-roll ratio, one surface at rest, from which films are too thick at any loading: 1.03 to 2.8 times. Below it
the heat of a loaded inlet, which makes films too thin, may outweigh: 30 % too thin to 15 % too thick at a ratio of 1,
24 % too thin to 26 % too thick at 1.25 and 1.5 (`row` of the same experiment, loadings above `LARGEST_LOADING`)."""
COMPARED_LOADINGS = (0.024, 0.24, 1.4)
"""Thermal loadings of the inlet of Moes' L 12, 16 and 20, at which lumped heat was compared with full heat."""
LUMPED_ERRORS: Mapping[float, tuple[tuple[float, float, float, float], ...]] = {
    0.0: ((-4.4, -1.3, -5.0, -0.8), (-14.0, -3.5, -15.9, -3.7), (-33.0, -4.7, -39.2, -11.2)),
    0.02: ((-4.6, -1.5, -1.1, 1.3), (-14.4, -4.2, -4.3, 6.4), (-33.8, -6.6, -12.3, 34.5)),
    0.1: ((-4.7, -2.0, -1.2, 1.8), (-15.0, -6.1, -4.8, 10.1), (-34.3, -11.3, -13.5, 32.0)),
    0.5: ((-4.0, -0.4, -1.2, 5.5), (-15.7, -10.4, -5.0, 21.3), (-37.2, -21.2, -14.1, 54.4)),
    1.0: ((-5.7, 14.9, -0.9, 7.6), (-21.1, -1.7, -3.6, 26.5), (-45.9, -21.7, -10.6, 58.4)),
    2.0: ((-8.3, -5.8, -0.4, 0.8), (-28.4, -12.2, -4.7, 0.0), (-55.5, -22.6, -16.9, 2.7)),
}
"""By slide-to-roll ratio, at each of `COMPARED_LOADINGS`: smallest and largest error of the film thickness, and of the
friction, of lumped heat beside full heat [%], under Moes' M from 0.02 to 200; at a ratio of 2 up to `COOL_LOAD`
(`reports/experiments/lumped_heat.py`)."""
COOL_LOAD = 0.5
"""Moes' M up to which the oil warms little at a slide-to-roll ratio of 2, so that `LARGEST_RISE` is not reached."""
_ROUNDING = 1e-6


def notes_of_film(
    film: FilmSolution,
    lubricant: Lubricant,
    radius: float,
    contact_modulus: float,
    stress: FloatArray | None = None,
    temperature: float | None = None,
    *,
    found: bool,
) -> tuple[Note, ...]:
    """Return the notes on a film of the oil as supplied, without those that its heat makes obsolete.

    stress : Newtonian at the nodes (n,) [Pa]; that of the oil at its own temperature by default. temperature : of the
        film, its mean weighted by pressure [K]; None or not finite where it was not found. found : whether there is a
        film without heat.
    """
    state = film.state
    assert isinstance(state, FilmState)
    load = state.load * state.scales.pressure * state.scales.length
    case = Case(
        position=state.state.position * state.scales.length,
        pressure=np.maximum(state.state.pressure, 0.0) * state.scales.pressure,
        thickness=state.state.film * state.scales.film,
        speeds=film.speeds,
        lubricant=lubricant,
        radius=radius,
        contact_modulus=contact_modulus,
        hot_stress=stress,
        temperature=temperature if temperature is not None and math.isfinite(temperature) else None,
        not_found=None if found else why_no_line_film(lubricant, load, radius, contact_modulus),
    )
    return without(notes_on(case), HEAT_LEFT_OUT)


def notes_of_heat(lubricant: Lubricant, hottest: float) -> tuple[Note, ...]:
    """Return notes on the highest temperature of oil and surfaces [K]."""
    notes = []
    oil = lubricant.oil
    if oil is not None and oil.boiling_point is not None and hottest > oil.boiling_point:
        limit, hot = oil.boiling_point - ZERO_CELSIUS, hottest - ZERO_CELSIUS
        notes.append(OIL_TOO_HOT(oil=oil.name, limit=limit, hottest=hot, reason="boils"))
    elif hottest > HOTTEST:
        notes.append(OIL_TOO_HOT(limit=HOTTEST - ZERO_CELSIUS, reason="cracks"))
    elif oil is not None:
        notes += _hot_oil(oil, hottest)
    return tuple(notes)


def _hot_oil(oil: Oil, hottest: float) -> list[Note]:
    """Return a note where the viscosity of the oil is extrapolated at its highest temperature [K]."""
    if hottest > oil.viscosity.highest + EXTRAPOLATED:
        return [
            OIL_DATA_SHORT(
                oil=oil.name, beyond=EXTRAPOLATED, highest=oil.viscosity.highest - ZERO_CELSIUS, reason="hot"
            )
        ]
    return []


def lumped_errors(loading: float, ratio: float) -> tuple[float, Span, Span]:
    """Return the slide-to-roll ratio compared with full heat that is nearest, and the errors of lumped heat there.

    Errors are those of film thickness and friction [%], each over heavy and light loads, interpolated over the
    logarithm of the loading and rounded outwards; beyond `COMPARED_LOADINGS` they are those of the last one.

    Parameters
    ----------
    loading : thermal loading of the inlet.
    ratio : slide-to-roll ratio.
    """
    nearest = min(LUMPED_ERRORS, key=lambda one: abs(one - ratio))
    columns = zip(*LUMPED_ERRORS[nearest], strict=True)
    low, high, less, more = (np.interp(np.log(loading), np.log(COMPARED_LOADINGS), column) for column in columns)
    film = Span(float(np.floor(low)), float(np.ceil(high)))
    return nearest, film, Span(float(np.floor(less)), float(np.ceil(more)))


def heat_limits(inlet: InletHeating, speeds: tuple[float, float], rise: float, remedy: str) -> tuple[Note, ...]:
    """Return notes on the limits of lumped heat, from inlet heating, speeds of both walls [m/s] and rise of the mean
    temperature of the oil [K]; `remedy` says in a sentence what to do in this film.

    Of high loading and much sliding, which err in opposite directions, one note says what was found of both.
    """
    first, second = speeds
    slide, mean = abs(first - second), 0.5 * abs(first + second)
    notes = []
    if inlet.extrapolated:
        notes.append(LUMPED_HEAT_LIMIT(remedy=remedy, reason="formula"))
    ratio = slide / mean if mean else np.inf
    fast, slides = inlet.loading > LARGEST_LOADING, slide > LARGEST_SLIDE * mean and rise > LARGEST_RISE
    if slides and (not fast or ratio > FULL_SLIDE - _ROUNDING):
        notes.append(LUMPED_HEAT_LIMIT(slide=ratio, remedy=remedy, reason="slides"))
    elif fast:
        about: dict[str, Any] = {"loading": inlet.loading, "limit": LARGEST_LOADING, "remedy": remedy}
        if slides:
            about |= {"slide": ratio, "reason": "fast-slides"}
        else:
            nearest, film, friction = lumped_errors(inlet.loading, ratio)
            about |= {"nearest": nearest, "film": film, "friction": friction, "reason": "fast"}
        notes.append(LUMPED_HEAT_LIMIT(**about))
    return tuple(notes)
