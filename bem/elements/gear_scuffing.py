"""Scuffing and friction of a gear pair of an element's file, by the formulas of `bem.elements.scuffing`."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from bem.elements.contact import ElementContact
from bem.elements.element import Element
from bem.elements.gear_pair import GearModel, path_of_contact
from bem.elements.running import Running
from bem.elements.scuffing import (
    BULK_WEIGHT,
    flash_temperature,
    gear_test_friction,
    integral_temperature,
    lubricant_factor,
    permissible_contact_temperature,
    permissible_integral_temperature,
    scuffing_test_friction,
)
from bem.physical_constants import ZERO_CELSIUS

_AT_40 = 313.15
_RA_OVER_SQ = math.sqrt(2 / math.pi)
"""Mean roughness Ra over rms roughness Sq of Gaussian heights."""


@dataclass(frozen=True)
class TestFriction:
    """Mean friction coefficients of a gear pair by fits to gear tests.

    power : of the formula for power loss. scuffing : of the formula for the integral temperature.
    """

    power: float
    scuffing: float


@dataclass(frozen=True)
class Scuffing:
    """Temperatures of a gear pair [K], flash temperatures as differences, and safeties against scuffing.

    bulk : of the gears. estimated : True if it follows from the mean flash temperature. friction : mean
    coefficient of gear tests, under which scuffing temperatures of oils are known; None without roughness. flash,
    flash_at : highest flash temperature under that friction or, where larger or known alone, the film's; and where.
    contact : highest contact temperature. mean_flash : mean over the path under the friction of gear tests; None
    without roughness, as then `integral`.
    contact_safety, integral_safety : None without a load stage of the oil.
    """

    bulk: float
    estimated: bool
    friction: float | None
    flash: float
    flash_at: ElementContact
    contact: float
    mean_flash: float | None
    integral: float | None
    contact_safety: float | None
    integral_safety: float | None


def base_of(element: Element) -> str:
    """Return the base of the element's oil, mineral where none is known."""
    assert element.model.film_oil is not None
    oil = element.model.film_oil
    built = oil.build()
    return built.oil.base if built.oil is not None else oil.base or "mineral"


def friction_of_gear_tests(element: Element) -> TestFriction | None:
    """Return the mean friction coefficients by fits to gear tests; None without roughness or an oil."""
    model, oil = element.model, element.inlet_oil
    assert isinstance(model, GearModel)
    if model.rms_roughness is None or oil is None:
        return None
    path = path_of_contact(model)
    omega = (model.speed, model.speed * model.teeth[0] / model.teeth[1])
    sum_speed = omega[0] * path.pitch + omega[1] * (path.line - path.pitch)
    given = {
        "line_load": model.pinion_torque / (path.base_radii[0] * model.face_width),
        "sum_speed": sum_speed,
        "radius": path.pitch * (path.line - path.pitch) / path.line / math.cos(path.base_helix),
        "viscosity": oil.build().viscosity,
        "roughness": _RA_OVER_SQ * model.rms_roughness / math.sqrt(2),
        "factor": lubricant_factor(base_of(element), sum_speed),
    }
    return TestFriction(gear_test_friction(**given), scuffing_test_friction(**given))


def scuffing_of(element: Element, runs: Sequence[Running]) -> Scuffing | None:
    """Return temperatures and safeties against scuffing; None without the bodies' thermal constants or a temperature.

    runs : solved films; contacts that did not converge are left out.
    """
    model = element.model
    assert isinstance(model, GearModel)
    hot = [one for one in runs if one.converged and one.flash is not None]
    oil = None if element.inlet_oil is None else element.inlet_oil.temperature
    if not hot or oil is None:
        return None
    tests = friction_of_gear_tests(element)
    friction = None if tests is None else tests.scuffing
    flashes = {one.contact: max(one.flash or 0.0, _flash(element, one.contact, friction) or 0.0) for one in hot}
    where = max(flashes, key=lambda one: flashes[one])
    flash = flashes[where]
    mean = None if friction is None else mean_flash_temperature(element, friction)
    bulk, estimated = model.bulk_temperature, element.bulk_estimated
    if bulk is None:
        bulk, estimated = oil + BULK_WEIGHT * (mean or 0.0), mean is not None
    integral = None if mean is None else integral_temperature(bulk, mean)
    contact_safety = integral_safety = None
    if model.scuffing_load_stage is not None:
        factor = lubricant_factor(base_of(element), _sum_speed(model))
        allowed = permissible_contact_temperature(
            model.scuffing_load_stage, factor=factor, structure=model.structure_factor
        )
        contact_safety = (allowed + ZERO_CELSIUS - oil) / (bulk + flash - oil)
        viscosity = _viscosity_at_40(element)
        if integral is not None and viscosity is not None:
            integral_safety = permissible_integral_temperature(
                model.scuffing_load_stage, viscosity_40=viscosity, factor=factor, structure=model.structure_factor
            ) / (integral - ZERO_CELSIUS)
    return Scuffing(
        bulk, estimated, friction, flash, where, bulk + flash, mean, integral, contact_safety, integral_safety
    )


def estimated_bulk(element: Element) -> float | None:
    """Return the bulk temperature of a gear pair [K]: the oil's plus 0.7 times the mean flash temperature.

    None where the file has a bulk temperature or a heat balance, and without the oil's temperature, a viscosity that
    follows it, roughness or the bodies' thermal constants. The mean flash temperature is that of scuffing, under the
    friction of gear tests at the oil's temperature.
    """
    model = element.model
    assert isinstance(model, GearModel)
    oil, tests = model.oil, friction_of_gear_tests(element)
    if model.bulk_temperature is not None or model.heat_balance is not None or tests is None:
        return None
    assert oil is not None
    if oil.temperature is None or (oil.viscosity is not None and oil.temperature_viscosity is None):
        return None
    mean = mean_flash_temperature(element, tests.scuffing)
    return None if mean is None else oil.temperature + BULK_WEIGHT * mean


def mean_flash_temperature(element: Element, friction: float) -> float | None:
    """Return the mean flash temperature over the path of contact [K] under one friction coefficient."""
    if _flash(element, element.found.contacts[0], friction) is None:
        return None
    return element.found.mean(lambda one: _flash(element, one, friction) or 0.0)


def _flash(element: Element, contact: ElementContact, friction: float | None) -> float | None:
    """Return the flash temperature of a contact [K] under a friction coefficient; None where either is not known."""
    if friction is None:
        return None
    return flash_temperature(contact, friction, modulus=element.modulus, bodies=element.bodies)


def _sum_speed(model: GearModel) -> float:
    path = path_of_contact(model)
    return model.speed * (path.pitch + model.teeth[0] / model.teeth[1] * (path.line - path.pitch))


def _viscosity_at_40(element: Element) -> float | None:
    """Return the oil's kinematic viscosity at 40 degC [m^2/s]; None of an oil that is known at one temperature."""
    assert element.model.oil is not None
    oil = element.model.oil.build().oil
    return None if oil is None else oil.viscosity.kinematic(_AT_40)


def sliding_power(element: Element, friction: float) -> float:
    """Return the friction power of the gear mesh [W] under one friction coefficient at all places."""
    found = element.found
    return friction * found.mean(lambda one: one.load * abs(one.speeds[0] - one.speeds[1])) * found.at_once


def tooth_loss_power(model: GearModel, friction: float) -> float:
    """Return the friction power of the gear mesh [W] by the tooth loss factor of textbooks, P mu H_v.

    H_v = pi (u + 1) / (z1 u cos(beta_b)) (1 - eps_alpha + eps_1^2 + eps_2^2), eps_1 and eps_2 the parts of the contact
    ratio from C to E and from A to C: each of two pairs carries half of the load, of helical teeth as of spur ones
    (Niemann and Winter, Maschinenelemente, Band 2; Ohlendorf's factor as textbooks print it). `sliding_power` has the
    load shared as the films have it.
    """
    path, (pinion, wheel) = path_of_contact(model), model.teeth
    leaving, approaching = (path.end - path.pitch) / path.base_pitch, (path.pitch - path.start) / path.base_pitch
    factor = math.pi * (1 + pinion / wheel) / (pinion * math.cos(path.base_helix))
    factor *= 1 - leaving - approaching + leaving**2 + approaching**2
    return model.pinion_torque * model.speed * friction * factor
