"""Notes on where models of films with heat end."""

from __future__ import annotations

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.film import FilmSolution
from bem.lubrication.inlet_heating import InletHeating
from bem.lubrication.line_kept import KeptSteady
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.oils.oil import EXTRAPOLATED, HOTTEST, Oil
from bem.lubrication.oils.over_temperature import CELSIUS
from bem.lubrication.validity import Case, notes_on, why_no_line_film
from bem.notes import Note, without
from bem.notes.lubrication import (
    BODY_AT_REST,
    FILM_HEATING,
    INLET_FAST,
    INLET_FORMULA_EXTRAPOLATED,
    INLET_HEATING,
    OIL_BOILS,
    OIL_CRACKS,
    OIL_HOT_EXTRAPOLATED,
    SLOW_SURFACE_WARMS,
)

LARGEST_LOADING = 0.05
"""Thermal loading of the inlet up to which film and friction were within 5 % of full heat's at slide-to-roll ratios
up to 0.5, at 0.004 and 0.02; at 0.24 friction was up to 27 %, at 1.4 up to 58 % off:
reports/experiments/lumped_heat.py."""
LARGEST_SLIDE, LARGEST_RISE = 1.0, 5.0
"""Slide-to-roll ratio above which, with a rise of the oil's mean temperature [K] of more than that, films were up to
2.8 times as thick as full heat's: the same experiment; at a ratio of 1 up to 1.17 times, and that at 3 GPa."""


def notes_of_film(
    film: FilmSolution,
    lubricant: Lubricant,
    radius: float,
    contact_modulus: float,
    stress: FloatArray | None = None,
    *,
    found: bool,
) -> tuple[Note, ...]:
    """Those of the film, of the oil as it is, but for what they say of heat; stress : Newtonian at the nodes (n,) [Pa],
    that of the oil at its own temperature where it is not given; found : whether there is a film without heat."""
    kept = film.state
    assert isinstance(kept, KeptSteady)
    load = kept.load * kept.scales.pressure * kept.scales.length
    case = Case(
        position=kept.state.position * kept.scales.length,
        pressure=np.maximum(kept.state.pressure, 0.0) * kept.scales.pressure,
        thickness=kept.state.film * kept.scales.film,
        speeds=film.speeds,
        lubricant=lubricant,
        radius=radius,
        contact_modulus=contact_modulus,
        hot_stress=stress,
        not_found=None if found else why_no_line_film(lubricant, load, radius, contact_modulus),
    )
    return without(notes_on(case), INLET_HEATING, FILM_HEATING)


def notes_of_heat(
    lubricant: Lubricant, hottest: float, speeds: tuple[float, float], cool_at: str = "the cylinder's radius"
) -> tuple[Note, ...]:
    """Of the highest temperature of oil and surfaces [K], and of where a body at rest is taken as cool."""
    notes = []
    if hottest > HOTTEST:
        notes.append(OIL_CRACKS(limit=HOTTEST - CELSIUS))
    elif lubricant.oil is not None:
        notes += _hot_oil(lubricant.oil, hottest)
    if min(abs(speed) for speed in speeds) == 0:
        notes.append(BODY_AT_REST(distance=cool_at))
    return tuple(notes)


def _hot_oil(oil: Oil, hottest: float) -> list[Note]:
    """Return a note where the oil's properties are not known at its highest temperature [K]."""
    if oil.boiling_point is not None and hottest > oil.boiling_point:
        return [OIL_BOILS(oil=oil.name)]
    if hottest > oil.viscosity.highest + EXTRAPOLATED:
        return [OIL_HOT_EXTRAPOLATED(oil=oil.name, beyond=EXTRAPOLATED, highest=oil.viscosity.highest - CELSIUS)]
    return []


def heat_limits(inlet: InletHeating, speeds: tuple[float, float], rise: float) -> tuple[Note, ...]:
    """Of inlet heating, speeds of both walls [m/s] and the rise of the oil's mean temperature [K]."""
    first, second = speeds
    slides = abs(first - second) > LARGEST_SLIDE * 0.5 * abs(first + second) and rise > LARGEST_RISE
    notes = []
    if inlet.extrapolated:
        notes.append(INLET_FORMULA_EXTRAPOLATED())
    if inlet.loading > LARGEST_LOADING:
        notes.append(INLET_FAST(loading=inlet.loading, limit=LARGEST_LOADING))
    if slides:
        notes.append(SLOW_SURFACE_WARMS())
    return tuple(notes)
