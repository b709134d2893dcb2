"""Rows of `bem element` for a plain bush: pressure, p v, friction, heat balance, wear and life."""

from __future__ import annotations

import math
from dataclasses import dataclass

from bem.elements.plain_bush import (
    AREA_FACTOR,
    DRY_FRICTION,
    SERVICE_TEMPERATURES,
    TRANSFER,
    WORN_IN,
    PlainBushModel,
    sliding_to_depth,
)
from bem.notes import Note
from bem.notes.elements import BUSH_OVER_LIMIT, BUSH_WARMER_THAN_OIL, BUSH_WEARS_IN_FILM
from bem.quantities import plain_digits, with_unit

CELSIUS = 273.15
_HOUR = 3600.0
_WARMER = 15.0
"""Excess of the bush over the liquid of its film that is worth a note [K]: viscosities change by 2 to 5 % a kelvin."""


LEAST_SHARE = 0.01
"""Share of the load on asperities below which friction is that of the film."""


@dataclass(frozen=True)
class FilmOfBush:
    """Film of a lubricated bush.

    Attributes
    ----------
    power : friction of film and asperities [W]. asperity_share : of the load, an estimate.
    """

    power: float
    asperity_share: float


def pressure_words(model: PlainBushModel) -> str:
    """Return contact angle and pressures in words."""
    found = model.conforming
    if model.wall is None:
        around = f"bush of infinite thickness, of {model.second.build().name}"
    else:
        around = f"bush {with_unit(model.wall, 'm')} thick in a housing of {model.housing_material.name}"
    peak, mean = with_unit(found.maximum_pressure, "Pa"), with_unit(model.mean_pressure, "Pa")
    return (
        f"load line: half-angle {math.degrees(found.half_angle):.1f} deg, peak pressure {peak}, mean pressure F/(d L) "
        f"{mean}; {around} (equivalent cylinder on a flat: {with_unit(model.cylinder.maximum_pressure, 'Pa')})"
    )


def friction_power_of(model: PlainBushModel, film: FilmOfBush | None) -> tuple[float, str]:
    """Return the friction power [W] and where it comes from.

    film : None of a dry bush.
    """
    slid = model.radial_load * model.sliding_speed
    if model.friction is not None:
        return model.friction * slid, f"friction coefficient {model.friction:g}, given"
    if film is not None:
        coefficient = f"friction coefficient {film.power / slid:.3g}"
        if film.asperity_share < LEAST_SHARE:
            return film.power, f"{coefficient}, of the film"
        return film.power, (
            f"{coefficient}, an estimate with a boundary friction of {model.boundary_friction:g}: the share of "
            "asperities is by tests of ground steel, and may be several times too low for polymers; a scene of kind "
            "friction computes it"
        )
    dry = "" if model.oil is None else ", as if dry: no film is solved"
    return (
        DRY_FRICTION * slid,
        f"friction coefficient {DRY_FRICTION:g} assumed{dry}: dry thermoplastics have 0.15 to 0.40",
    )


def bush_temperature(model: PlainBushModel, power: float) -> float:
    """Return the bush temperature [K]: given, or by the heat balance of a friction power [W]."""
    return model.bulk_temperature or model.surroundings + power / model.conductance


def bush_rows(model: PlainBushModel, film: FilmOfBush | None) -> list[tuple[str, str]]:
    """Return rows of name and words; `film` as in `friction_power_of`."""
    power, source = friction_power_of(model, film)
    rows = [
        ("pressure x velocity", _pv(model)),
        ("friction power", f"{plain_digits(power, 3)} W ({source})"),
        ("temperatures", _temperature(model, power)),
        ("wear per hour", _wear(model)),
    ]
    if model.specific_wear_rate:
        rows.append(("wear life", _life(model)))
    return rows


def bush_notes(model: PlainBushModel, film: FilmOfBush | None) -> tuple[Note, ...]:
    """Return notes on limits that the bush exceeds; `film` as in `friction_power_of`."""
    notes = []
    pv = model.mean_pressure * model.sliding_speed
    if model.pv_limit is not None and pv > model.pv_limit:
        notes.append(
            BUSH_OVER_LIMIT(value=1e-6 * pv, limit=1e-6 * model.pv_limit, ratio=pv / model.pv_limit, reason="pv")
        )
    peak, strength = model.conforming.maximum_pressure, model.second.build().yield_stress
    if strength is not None and peak > strength:
        notes.append(BUSH_OVER_LIMIT(value=1e-6 * peak, limit=1e-6 * strength, reason="yield"))
    highest = model.service_temperature
    known = film is not None or model.oil is None or model.friction is not None
    temperature = bush_temperature(model, friction_power_of(model, film)[0]) if known else 0.0
    if highest is not None and temperature > highest:
        notes.append(BUSH_OVER_LIMIT(value=temperature - CELSIUS, limit=highest - CELSIUS, reason="temperature"))
    liquid = None if model.film_oil is None or film is None else model.film_oil.temperature
    if liquid is not None and temperature > liquid + _WARMER:
        notes.append(BUSH_WARMER_THAN_OIL(bush=temperature - CELSIUS, oil=liquid - CELSIUS))
    if film is not None and film.asperity_share < LEAST_SHARE and model.specific_wear_rate:
        notes.append(BUSH_WEARS_IN_FILM(share=film.asperity_share))
    return tuple(notes)


def _pv(model: PlainBushModel) -> str:
    pv = 1e-6 * model.mean_pressure * model.sliding_speed
    mean = "mean " if model.oscillation is not None else ""
    said = f"{pv:.3g} MPa m/s at a {mean}sliding speed of {with_unit(model.sliding_speed, 'm/s')}"
    if model.pv_limit is None:
        return f"{said}; no limit given (pv_limit, of the maker at this speed and cooling)"
    return f"{said}; limit {1e-6 * model.pv_limit:.3g} MPa m/s, safety factor {1e-6 * model.pv_limit / pv:.3g}"


def _temperature(model: PlainBushModel, power: float) -> str:
    temperature = bush_temperature(model, power) - CELSIUS
    around = model.surroundings - CELSIUS
    if model.bulk_temperature is not None:
        said = f"bush {temperature:.4g} °C, given or by the heat balance"
    else:
        said = (
            f"bush {temperature:.3g} °C: surroundings {around:.3g} °C plus {plain_digits(power, 3)} W over "
            f"{model.conductance:.3g} W/K"
        )
        if model.heat_balance is None:
            said += f", assumed as {TRANSFER:g} W/(m^2 K) x {AREA_FACTOR:g} d L (give heat_balance)"
    highest = model.service_temperature
    if highest is None:
        return f"{said}; no limit given (maximum_temperature)"
    source = "given" if model.maximum_temperature is not None else SERVICE_TEMPERATURES[model.second.build().name][1]
    return f"{said}; limit {highest - CELSIUS:.3g} °C ({source})"


def _wear(model: PlainBushModel) -> str:
    rate = model.specific_wear_rate
    if rate is None:
        return "not known: give specific_wear_rate of the bush, measured against this shaft, dry or in this lubricant"
    hourly = rate * model.sliding_speed * _HOUR
    peaks = (model.conforming.maximum_pressure, WORN_IN * model.mean_pressure)
    new, least = (1e6 * hourly * peak for peak in peaks)
    return (
        f"bush {new:.3g} um at the load line as new, {least:.3g} um worn in (4/pi of the "
        "mean pressure); Archard's law, the shaft does not wear"
    )


def wear_life(model: PlainBushModel) -> tuple[float, float]:
    """Return sliding distance [m] and hours to the permitted depth of wear; without one to the clearance."""
    distance = sliding_to_depth(model, model.permitted_wear or 2 * model.radial_clearance)
    return distance, distance / model.sliding_speed / _HOUR


def _life(model: PlainBushModel) -> str:
    depth = model.permitted_wear or 2 * model.radial_clearance
    assumed = "" if model.permitted_wear else " (the clearance; give permitted_wear)"
    distance, lasts = wear_life(model)
    angle = max(
        math.degrees(math.acos(model.radial_clearance / (model.radial_clearance + depth))),
        math.degrees(model.conforming.half_angle),
    )
    hours = plain_digits(lasts, 3)
    return (
        f"{hours} h ({plain_digits(1e-3 * distance, 3)} km) to a depth of {with_unit(depth, 'm')}{assumed}; the "
        f"contact then reaches {angle:.0f} deg to either side"
    )
