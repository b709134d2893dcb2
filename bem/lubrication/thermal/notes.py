"""Where models of films with heat end, in sentences."""

from __future__ import annotations

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.film import FilmSolution
from bem.lubrication.inlet_heating import InletHeating
from bem.lubrication.line_kept import KeptSteady
from bem.lubrication.lubricant import Lubricant
from bem.lubrication.oils.oil import EXTRAPOLATED, HOTTEST, Oil
from bem.lubrication.oils.over_temperature import CELSIUS
from bem.lubrication.validity import HEATING_NOTES, Case, notes_on, why_no_line_film

HEAT_NOT_FOUND = (
    "no temperatures of the oil were found that the heat made at them leaves: the film is shown without temperatures, "
    "friction and heat, which are not known"
)
"""Of lumped heat; a friction without a limiting shear stress is the usual cause."""
EXTRAPOLATED_INLET = (
    "the formula of inlet heating (Gupta et al. 1992) is extrapolated: so much load and speed was not in it, and the "
    "film's thickness is an estimate"
)
LARGEST_LOADING = 0.05
"""Thermal loading of the inlet up to which film and friction were within 5 % of full heat's at slide-to-roll ratios
up to 0.5, at 0.004 and 0.02; at 0.24 friction was up to 27 %, at 1.4 up to 58 % off:
reports/experiments/lumped_heat.py."""
LARGEST_SLIDE, LARGEST_RISE = 1.0, 5.0
"""Slide-to-roll ratio above which, with a rise of the oil's mean temperature [K] of more than that, films were up to
2.8 times as thick as full heat's: the same experiment; at a ratio of 1 up to 1.17 times, and that at 3 GPa."""
FAST_INLET = (
    "the inlet heats the oil beyond what lumped heat describes (mu0 beta u^2/k above 0.05): against full heat its film "
    "was found up to a third too thin, its friction 10 to 60 % off"
)
SLOW_SURFACE = (
    "heat of the slower surface warms the inlet, which lumped heat leaves out: at a slide-to-roll ratio of 2 its "
    "flooded film was found 1.2 to 2.8 times as thick as with full heat"
)


def notes_of_film(
    film: FilmSolution,
    lubricant: Lubricant,
    radius: float,
    contact_modulus: float,
    stress: FloatArray | None = None,
    *,
    found: bool,
) -> tuple[str, ...]:
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
    return tuple(note for note in notes_on(case) if note not in HEATING_NOTES)


def notes_of_heat(
    lubricant: Lubricant, hottest: float, speeds: tuple[float, float], cool_at: str = "the cylinder's radius"
) -> tuple[str, ...]:
    """Of the highest temperature of oil and surfaces [K], and of where a body at rest is taken as cool."""
    said = []
    if hottest > HOTTEST:
        said.append(
            f"oil or surfaces exceed {HOTTEST - CELSIUS:g} degC in the contact, where oils crack: viscosities there "
            "are extrapolated"
        )
    elif lubricant.oil is not None:
        said += _hot_oil(lubricant.oil, hottest)
    if min(abs(speed) for speed in speeds) == 0:
        said.append(f"a body at rest is taken as cool at a distance of {cool_at}")
    return tuple(said)


def _hot_oil(oil: Oil, hottest: float) -> list[str]:
    """What the oil's figures do not hold for at its hottest; without the temperature, which a curve has many of."""
    if oil.boiling_point is not None and hottest > oil.boiling_point:
        return [f"{oil.name} is above its boiling point in the contact: it is taken as a liquid there"]
    if hottest > oil.viscosity.highest + EXTRAPOLATED:
        return [
            f"{oil.name} is more than {EXTRAPOLATED:g} K hotter in the contact than where its viscosity is known, "
            f"{oil.viscosity.highest - CELSIUS:.6g} degC: it is extrapolated"
        ]
    return []


def heat_limits(inlet: InletHeating, speeds: tuple[float, float], rise: float) -> tuple[str, ...]:
    """Of inlet heating, speeds of both walls [m/s] and the rise of the oil's mean temperature [K]."""
    first, second = speeds
    slides = abs(first - second) > LARGEST_SLIDE * 0.5 * abs(first + second) and rise > LARGEST_RISE
    said = {
        EXTRAPOLATED_INLET: inlet.extrapolated,
        FAST_INLET: inlet.loading > LARGEST_LOADING,
        SLOW_SURFACE: slides,
    }
    return tuple(note for note, holds in said.items() if holds)
