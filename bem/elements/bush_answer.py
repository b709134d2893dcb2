"""Rows of `bem element` for a plain bush: pressure, p v, friction, heat balance, wear and life."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from bem.elements.bush_polymers import LARGEST_EXPANSION, LEAST_EXPANSION, SERVICE_TEMPERATURE
from bem.elements.model import FULL_FILM, LEAST_ASPERITY_SHARE
from bem.elements.plain_bush import (
    AREA_FACTOR,
    POLYMER,
    TRANSFER,
    WORN_IN,
    PlainBushModel,
    sliding_to_depth,
    worn_out_depth,
)
from bem.notes import Note
from bem.notes.elements import (
    BUSH_LIQUID_LOST,
    BUSH_OVER_LIMIT,
    BUSH_ROUGHNESS_MISSING,
    BUSH_SWELLS,
    BUSH_TOUCHES,
    BUSH_WARMER_THAN_OIL,
    BUSH_WEARS_IN_FILM,
)
from bem.physical_constants import ZERO_CELSIUS
from bem.quantities import plain_digits, si, with_unit
from bem.reference_solutions.journal_bearing import JournalFilm
from bem.scenes.tables import bush as bush_tables
from bem.scenes.tables.bush import THICK, thick_film_note

_HOUR = 3600.0
_WARMER = 15.0
"""Excess of the bush over the liquid of its film that is worth a note [K]: viscosities change by 2 to 5 % a kelvin."""
_JUMP = 1.0
"""Difference [K] by which a heat balance is not met where the estimate of the friction jumps."""
_RESOLVED = 0.05
"""Excess over a limit temperature [K] below which temperatures with a digit behind the point are alike."""
JOURNAL = "journal_bearing_film_estimate [m]"
"""Column of the estimated film of a rigid journal bearing: the lower bound beside a film that reaches far around."""


@dataclass(frozen=True)
class FilmOfBush:
    """Film of a lubricated bush.

    Attributes
    ----------
    power : friction of film and asperities [W].
    asperity_share : of the load; zero where it is not known. share_known : whether it is.
    solved : whether share and friction are those of kind friction; else they are estimated.
    touching : whether the smooth film is thinner than the roughness.
    rise : of the hotter surface at its hottest above the bodies [K].
    thickness : of the film of the equivalent cylinder if it carried the whole load, at its thinnest [m]; where that is
        more than the radial clearance, which is impossible, power and share are those of a journal bearing.
    friction : coefficient of film and asperities, without one of the file.
    """

    power: float
    asperity_share: float
    solved: bool = False
    touching: bool = False
    rise: float = 0.0
    thickness: float = 0.0
    friction: float = 0.0
    share_known: bool = True


def pressure_words(model: PlainBushModel) -> str:
    """Return contact angle and pressures in words."""
    found = model.shaft_contact
    if model.wall is None:
        around = f"bush of infinite thickness, of {model.second.build().name}"
    else:
        around = f"bush {with_unit(model.wall, 'm')} thick in a housing of {model.housing_material.name}"
    peak, mean = with_unit(found.maximum_pressure, "Pa"), with_unit(model.mean_pressure, "Pa")
    return (
        f"load line: half-angle {math.degrees(found.half_angle):.1f} deg, peak pressure {peak}, mean pressure F/(d L) "
        f"{mean}; {around} (equivalent cylinder on a flat: {with_unit(model.cylinder.maximum_pressure, 'Pa')})"
    )


def journal_of(model: PlainBushModel, film: FilmOfBush) -> JournalFilm | None:
    """Return the estimated film of a journal bearing beside a film that reaches far around; None of a thin one."""
    return journal_beside(model, film.thickness)


def journal_beside(model: PlainBushModel, thickness: float) -> JournalFilm | None:
    """Return the estimated film of a rigid journal bearing of the bush's length; None beside a thin film.

    thickness : of the film of the equivalent cylinder [m].
    """
    oil = model.film_oil
    if oil is None:
        return None
    return bush_tables.journal_beside(
        thickness,
        load=model.radial_load,
        radius=model.bodies.radius,
        clearance=model.radial_clearance,
        length=model.length,
        viscosity=oil.build().viscosity,
        sliding_speed=model.sliding_speed,
    )


def thick_film_words(model: PlainBushModel, film: FilmOfBush) -> str | None:
    """Return lambda ratio and film in words where a journal bearing's film stands beside it; None of a thin one."""
    journal = journal_of(model, film)
    if journal is None:
        return None
    beyond = film.thickness > model.radial_clearance
    said = beyond_words(model, film.thickness, journal) if beyond else bounds_words(film.thickness, journal)
    if model.rms_roughness is None:
        return f"not known: give rms_roughness, of both surfaces together; {said}"
    if beyond:
        return f"outside the model, about {journal.minimum_thickness / model.rms_roughness:.2g}: minimum film {said}"
    low, high = (f"{one / model.rms_roughness:.2g}" for one in (journal.minimum_thickness, film.thickness))
    if film.thickness < THICK * model.radial_clearance:
        return f"between about {low} and {high}: {said}"
    return f"outside the model, about {high} or {low}: {said}"


def bounds_words(thickness: float, journal: JournalFilm) -> str:
    """Return the films of the equivalent cylinder, of a thickness [m], and of the journal bearing in words."""
    return f"minimum film about {si(thickness, 'm', 2)} as of an endless cylinder on a flat, {journal_words(journal)}"


def beyond_words(model: PlainBushModel, thickness: float, journal: JournalFilm) -> str:
    """Return the film of the journal bearing in words where that of a thickness [m] is impossible."""
    return (
        f"{journal_words(journal)} (an endless cylinder on a flat would have {si(thickness, 'm', 2)}, more than the "
        f"radial clearance of {si(model.radial_clearance, 'm', 3)})"
    )


def journal_words(journal: JournalFilm) -> str:
    """Return the minimum film of the journal bearing in words."""
    return f"about {si(journal.minimum_thickness, 'm', 2)} by an estimate as a rigid journal bearing of this length"


def friction_power_of(model: PlainBushModel, film: FilmOfBush | None) -> tuple[float | None, str]:
    """Return the friction power [W] and where it comes from; None where no friction coefficient is known.

    film : None of a dry bush.
    """
    slid = model.radial_load * model.sliding_speed
    if model.friction is not None:
        return model.friction * slid, f"friction coefficient {model.friction:g}, given"
    if film is not None:
        coefficient = f"friction coefficient {film.power / slid:.3g}"
        if film.thickness > model.radial_clearance:
            return film.power, (
                f"friction coefficient about {film.power / slid:.2g} by an estimate as a full journal bearing"
            )
        if film.asperity_share < LEAST_ASPERITY_SHARE:
            journal = journal_of(model, film)
            around = (
                "" if journal is None else f"; about {journal.friction:.2g} by an estimate as a full journal bearing"
            )
            return film.power, f"{coefficient}, of the film{around}"
        if film.solved:
            return film.power, (
                f"{coefficient} of film and asperities, by kind friction with a ground shaft and a boundary friction "
                f"of {model.boundary_friction:g}"
            )
        return film.power, (
            f"{coefficient}, estimated from tests of ground steel with a boundary friction of "
            f"{model.boundary_friction:g}; a polymer may have several times more"
        )
    dry = "dry" if model.oil is None else "as if dry, as no film is solved"
    known, bush = model.dry_friction, model.second.build().name
    if known is None:
        return None, f"give friction, measured against this shaft: none is known of {bush}, {dry}"
    shaft = model.first.build()
    other = (
        f"; that is on steel, none is known against a shaft of {shaft.name}: give friction"
        if shaft.youngs_modulus < POLYMER
        else ""
    )
    return known.value * slid, f"friction coefficient {known.value:g} assumed for {bush}, {dry}: {known.source}{other}"


def bush_temperature(model: PlainBushModel, power: float) -> float:
    """Return the bush temperature [K]: given, or by the heat balance of a friction power [W]."""
    return model.bulk_temperature or model.surroundings + power / model.conductance


def bush_rows(model: PlainBushModel, film: FilmOfBush | None) -> list[tuple[str, str]]:
    """Return rows of name and words; `film` as in `friction_power_of`."""
    power, source = friction_power_of(model, film)
    given = model.friction is not None
    about = film is not None and not given and film.thickness > model.radial_clearance
    said = "" if power is None else f"about {plain_digits(power, 2)} W" if about else f"{plain_digits(power, 3)} W"
    rows = [
        ("pressure x velocity", _pv(model)),
        ("friction power", f"not known: {source}" if power is None else f"{said} ({source})"),
        ("temperatures", _temperature(model, power)),
        ("wear per hour", _wear(model, film)),
    ]
    if model.specific_wear_rate:
        highest = model.service_temperature
        hot = power is not None and _too_hot(model, bush_temperature(model, power))
        lost = f"; the life does not hold above {(highest or 0.0) - ZERO_CELSIUS:.3g} °C" if hot else ""
        rows.append(("wear life", _life(model) + lost))
    return rows


def bush_notes(model: PlainBushModel, film: FilmOfBush | None) -> tuple[Note, ...]:
    """Return notes on limits that the bush exceeds; `film` as in `friction_power_of`."""
    notes = []
    pv = model.mean_pressure * model.sliding_speed
    if model.pv_limit is not None and pv > model.pv_limit:
        notes.append(
            BUSH_OVER_LIMIT(value=1e-6 * pv, limit=1e-6 * model.pv_limit, ratio=pv / model.pv_limit, reason="pv")
        )
    peak, strength = model.shaft_contact.maximum_pressure, model.second.build().yield_stress
    if strength is not None and peak > strength:
        notes.append(BUSH_OVER_LIMIT(value=1e-6 * peak, limit=1e-6 * strength, reason="yield"))
    power = friction_power_of(model, film)[0] if film is not None or model.oil is None or model.friction else None
    temperature = model.bulk_temperature if power is None else bush_temperature(model, power)
    if temperature is not None:
        notes += _temperature_notes(model, film, temperature)
    journal = None if film is None else journal_of(model, film)
    if film is not None and model.rms_roughness is None:
        notes += _roughness_missing(model)
    elif (
        film is not None
        and film.share_known
        and film.asperity_share < LEAST_ASPERITY_SHARE
        and model.specific_wear_rate
    ):
        notes.append(_wears_in_film(model, film, journal))
    if film is not None and journal is not None:
        asperities = model.boundary_friction * film.asperity_share
        notes.append(
            thick_film_note(
                film.thickness,
                film.friction,
                journal,
                model.radial_clearance,
                impossible="beyond",
                rubbing=min(asperities / film.friction, 1.0) if asperities else 0.0,
            )
        )
    if film is not None and film.touching:
        notes.append(_touching(model, film))
    return tuple(notes)


def _wears_in_film(model: PlainBushModel, film: FilmOfBush, journal: JournalFilm | None) -> Note:
    """Return the note on the wear of a bush with next to no load on asperities; `journal` the lower bound of its film,
    None where the film is known."""
    assert model.rms_roughness is not None
    ratio = math.inf if journal is None else journal.minimum_thickness / model.rms_roughness
    if model.oscillation is not None:
        return BUSH_WEARS_IN_FILM(share=film.asperity_share, reason="swings")
    if ratio < FULL_FILM:
        return BUSH_WEARS_IN_FILM(share=film.asperity_share, ratio=ratio, reason="bounds")
    return BUSH_WEARS_IN_FILM(share=film.asperity_share, reason="turns")


def _touching(model: PlainBushModel, film: FilmOfBush) -> Note:
    """Return the note on a film that is thinner than the roughness."""
    roughness = model.rms_roughness
    assert roughness is not None
    if model.radial_clearance < roughness:
        return BUSH_TOUCHES(clearance=model.radial_clearance, roughness=roughness, reason="clearance")
    if not film.share_known:
        return BUSH_TOUCHES(reason="unknown")
    return BUSH_TOUCHES(share=film.asperity_share, reason="solved" if film.solved else "estimated")


def _roughness_missing(model: PlainBushModel) -> list[Note]:
    """Return a note on what hangs on the touching of surfaces whose roughness is not given; none where nothing does."""
    wears = bool(model.specific_wear_rate)
    if model.friction is None:
        return [BUSH_ROUGHNESS_MISSING(reason="friction and wear" if wears else "friction")]
    return [BUSH_ROUGHNESS_MISSING(reason="wear")] if wears else []


def _temperature_notes(model: PlainBushModel, film: FilmOfBush | None, temperature: float) -> list[Note]:
    """Return notes on a bush temperature [K] that the bush or its liquid does not stand, or its film does not have."""
    notes, highest = [], model.service_temperature
    if highest is not None and _too_hot(model, temperature):
        reason = "temperature" if model.maximum_temperature is None else "given"
        notes.append(BUSH_OVER_LIMIT(value=temperature - ZERO_CELSIUS, limit=highest - ZERO_CELSIUS, reason=reason))
    closing = model.closing_expansion(temperature)
    low, high = LEAST_EXPANSION.value, LARGEST_EXPANSION.value
    if closing is not None and closing < high:
        notes.append(
            BUSH_SWELLS(
                bush=temperature - ZERO_CELSIUS, closing=closing, clearance=model.radial_clearance, low=low, high=high
            )
        )
    lost = _liquid_lost(model, temperature, 0.0 if film is None else film.rise)
    if lost is not None:
        notes.append(lost)
    liquid = None if model.film_oil is None or film is None else model.film_oil.temperature
    if lost is None and liquid is not None and temperature > liquid + _WARMER:
        notes.append(BUSH_WARMER_THAN_OIL(bush=temperature - ZERO_CELSIUS, oil=liquid - ZERO_CELSIUS))
    return notes


def _too_hot(model: PlainBushModel, temperature: float) -> bool:
    """Return True if a bush temperature [K] is above the limit by more than is shown of it."""
    highest = model.service_temperature
    return highest is not None and temperature > highest + _RESOLVED


def _liquid_lost(model: PlainBushModel, temperature: float, rise: float) -> Note | None:
    """Return a note on a liquid that freezes, evaporates or boils at the bush's temperature and its rise [K]."""
    limits = model.liquid_limits
    if limits is None:
        return None
    freezing, service, boiling = limits
    hottest = temperature + rise
    cooled = "" if model.conductance_known else " in still air"
    said: dict[str, Any] = {"bush": temperature - ZERO_CELSIUS, "rise": rise}
    if hottest >= boiling:
        return BUSH_LIQUID_LOST(**said, limit=boiling - ZERO_CELSIUS, reason=f"boils{cooled}")
    if hottest > service:
        return BUSH_LIQUID_LOST(**said, limit=service - ZERO_CELSIUS, reason=f"evaporates{cooled}")
    if temperature <= freezing:
        return BUSH_LIQUID_LOST(**said, limit=freezing - ZERO_CELSIUS, reason="freezes")
    return None


def _pv(model: PlainBushModel) -> str:
    """Return pressure times speed of a bush in words, beside its limit."""
    pv = 1e-6 * model.mean_pressure * model.sliding_speed
    mean = "mean " if model.oscillation is not None else ""
    said = f"{pv:.3g} MPa m/s at a {mean}sliding speed of {with_unit(model.sliding_speed, 'm/s')}"
    if model.pv_limit is None:
        return f"{said}; no limit given (pv_limit, of the maker at this speed and cooling)"
    return f"{said}; limit {1e-6 * model.pv_limit:.3g} MPa m/s, safety factor {1e-6 * model.pv_limit / pv:.3g}"


def _temperature(model: PlainBushModel, power: float | None) -> str:
    """Return the temperature of a bush in words, beside its limit."""
    if power is None and model.bulk_temperature is None:
        return "not known: they follow from the friction"
    temperature = bush_temperature(model, power or 0.0) - ZERO_CELSIUS
    around = model.surroundings - ZERO_CELSIUS
    highest = model.service_temperature
    near = highest is not None and abs(temperature + ZERO_CELSIUS - highest) < 1
    said = f"bush {temperature:.{4 if near else 3}g} °C"
    if model.bulk_temperature is not None:
        said += f", {'by the heat balance' if model.balanced else 'given'}"
        film = model.film_temperature
        if film is not None and film != model.bulk_temperature:
            said += f" (film and friction are those of the liquid at {film - ZERO_CELSIUS:.3g} °C)"
        if model.viscosity_fixed and not model.viscosity_notes():
            said += " (the viscosity given is taken at this temperature)"
    if model.bulk_temperature is None or model.balanced:
        assert power is not None
        said += f": surroundings {around:.3g} °C plus {plain_digits(power, 3)} W over {model.conductance:.3g} W/K"
        if abs(around + power / model.conductance - temperature) > _JUMP:
            said += " (between two estimates: the friction jumps as the film exceeds the radial clearance)"
        if model.heat_balance is None or model.heat_balance.conductance is None:
            said += f", assumed as {TRANSFER:g} W/(m^2 K) x {AREA_FACTOR:g} d L (give heat_balance)"
    if highest is None:
        return f"{said}; no limit given (maximum_temperature)"
    given = model.maximum_temperature is not None
    source = "given" if given else SERVICE_TEMPERATURE[model.second.build().name].source
    return f"{said}; limit {highest - ZERO_CELSIUS:.3g} °C ({source})"


def _wear(model: PlainBushModel, film: FilmOfBush | None) -> str:
    """Return the wear of a bush in words."""
    rate = model.specific_wear_rate
    if rate is None:
        return "not known: give specific_wear_rate of the bush, measured against this shaft, dry or in this lubricant"
    hourly = rate * model.sliding_speed * _HOUR
    peaks = (model.shaft_contact.maximum_pressure, WORN_IN * model.mean_pressure)
    new, least = (1e6 * hourly * peak for peak in peaks)
    return (
        f"bush {new:.3g} um at the load line as new, {least:.3g} um worn in (4/pi of the "
        "mean pressure); Archard's law, the shaft does not wear"
        + (
            "; in mixed lubrication the rate given must be of a test in this liquid"
            if film is not None and film.asperity_share >= LEAST_ASPERITY_SHARE
            else ""
        )
    )


def wear_life(model: PlainBushModel) -> tuple[float, float]:
    """Return sliding distance [m] and hours to the depth at which the bush is worn out."""
    distance = sliding_to_depth(model, worn_out_depth(model)[0])
    return distance, distance / model.sliding_speed / _HOUR


def _life(model: PlainBushModel) -> str:
    """Return the wear life of a bush in words."""
    depth, name = worn_out_depth(model)
    assumed = "" if name == "permitted_wear" else f" (the {name}; give permitted_wear)"
    distance, lasts = wear_life(model)
    angle = max(
        math.degrees(math.acos(model.radial_clearance / (model.radial_clearance + depth))),
        math.degrees(model.shaft_contact.half_angle),
    )
    hours = plain_digits(lasts, 3)
    return (
        f"{hours} h ({plain_digits(1e-3 * distance, 3)} km) to a depth of {with_unit(depth, 'm')}{assumed}; the "
        f"contact then reaches {angle:.0f} deg to either side"
    )
