"""Where models of films with heat end, in sentences."""

from __future__ import annotations

import numpy as np

from bem.grid import FloatArray
from bem.lubrication.film import FilmSolution
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
