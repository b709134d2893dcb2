"""Scuffing of gears: flash temperature of a contact after Blok, contact and integral temperature, permissible values.

Flash temperature of a band of half-width a under the heat of Hertz' pressure, both surfaces fast,

    T = 1.11 mu w |u1 - u2| / ((B1 sqrt(u1) + B2 sqrt(u2)) sqrt(2 a)),    B = sqrt(k rho c)

(Blok 1937), w the load per length. Contact temperature: bulk plus flash temperature. Integral temperature: bulk plus
1.5 times the mean flash temperature over the path, with the mean friction coefficient of gear tests. Both permissible
temperatures follow from the load stage of the FZG test A/8.3/90 (ISO 14635-1), in which the pinion's torque is
3.726 N m times the square of the stage. These are the concepts of ISO/TS 6336-20 and -21 with the formulas of ISO/TR
13989 as textbooks print them; they were not checked against the standards' own text.

Verified in tests/elements/test_scuffing.py: the factor 1.11 against Jaeger's moving band, the FZG test gears against
the permissible temperature of their own load stage, and limits of one body at rest or of pure rolling.
"""

from __future__ import annotations

import math

from bem.elements.contact import ElementContact
from bem.materials import Material

CITES = ("blok1937", "isotr13989", "niemann2003")
"""Sources of the formulas, as keys of `bem/references.bib`."""

FLASH_FACTOR = 1.11
"""Maximum of the temperature under a semi-elliptical band of heat, over that of its mean flux by dimension."""
_INTEGRAL_WEIGHT = 1.5
"""Weight of the mean flash temperature in the integral temperature."""
BULK_WEIGHT = 0.7
"""Bulk temperature of dip-lubricated gears over the oil's, in mean flash temperatures."""
_TEST_TORQUE = 3.726
"""Pinion torque of the FZG test over the square of its load stage [N m]."""
LUBRICANT_FACTOR = {"mineral": 1.0, "naphthenic": 1.0, "pao": 0.8, "ester": 0.8, "traction": 1.5}
"""X_L by base of the oil. Polyglycols: see `lubricant_factor`."""


def flash_temperature(
    contact: ElementContact, friction: float, *, modulus: float, bodies: tuple[Material, Material]
) -> float | None:
    """Return the flash temperature of a contact [K]; None without the bodies' thermal constants.

    friction : friction coefficient, of either sign. modulus : contact modulus [Pa].
    """
    sliding = abs(contact.speeds[0] - contact.speeds[1])
    heat = abs(friction) * contact.line_load(modulus) * sliding / math.sqrt(2 * contact.half_width(modulus))
    return flash_of_heat(contact, heat, bodies)


def flash_of_heat(contact: ElementContact, heat: float, bodies: tuple[Material, Material]) -> float | None:
    """Return the flash temperature of a contact [K]; None without the bodies' thermal constants.

    heat : of friction per length across the motion over the root of the length along it [W/m^1.5].
    """
    effusivities = [_effusivity(body) for body in bodies]
    if any(one is None for one in effusivities):
        return None
    if heat == 0:
        return 0.0
    taken = sum((one or 0.0) * math.sqrt(abs(speed)) for one, speed in zip(effusivities, contact.speeds, strict=True))
    return FLASH_FACTOR * heat / taken


def _effusivity(body: Material) -> float | None:
    """Return sqrt(k rho c) [W s^0.5/(m^2 K)]."""
    if body.thermal_conductivity is None or body.density is None or body.heat_capacity is None:
        return None
    return math.sqrt(body.thermal_conductivity * body.density * body.heat_capacity)


def lubricant_factor(base: str, sum_speed: float) -> float:
    """Return X_L, friction of an oil over that of a mineral oil, in gear tests.

    base : of the oil. sum_speed : sum of both surfaces' speeds at the pitch point [m/s].
    """
    if base in ("pag", "water-glycol"):
        return 0.75 * (6 / sum_speed) ** 0.2
    return LUBRICANT_FACTOR.get(base, 1.0)


def gear_test_friction(
    line_load: float, *, sum_speed: float, radius: float, viscosity: float, roughness: float, factor: float = 1.0
) -> float:
    """Return the mean friction coefficient of gears after Schlenk, a fit to gear tests (Niemann and Winter).

    Parameters
    ----------
    line_load : base tangential load over face width [N/m].
    sum_speed : sum of both surfaces' speeds at the pitch point [m/s].
    radius : of relative curvature at the pitch point [m].
    viscosity : of the oil at its inlet temperature [Pa s].
    roughness : mean Ra of both flanks [m].
    factor : X_L of the oil.
    """
    load = 1e-3 * line_load / (sum_speed * 1e3 * radius)
    return 0.048 * load**0.2 * (1e3 * viscosity) ** -0.05 * (1e6 * roughness) ** 0.25 * factor


def scuffing_test_friction(
    line_load: float, *, sum_speed: float, radius: float, viscosity: float, roughness: float, factor: float = 1.0
) -> float:
    """Return the mean friction coefficient of the integral temperature, parameters as in `gear_test_friction`.

    0.045 (w / (v rho))^0.2 eta^-0.05 X_R X_L with X_R = 2.2 (Ra / rho)^0.25, Ra in um and rho in mm; speeds above
    50 m/s count as that.
    """
    load = 1e-3 * max(line_load, 150e3) / (min(sum_speed, 50.0) * 1e3 * radius)
    rough = 2.2 * (1e6 * roughness / (1e3 * radius)) ** 0.25
    return 0.045 * load**0.2 * (1e3 * viscosity) ** -0.05 * rough * factor


def permissible_contact_temperature(stage: float, *, factor: float = 1.0, structure: float = 1.0) -> float:
    """Return the scuffing temperature of the contact temperature [degC].

    stage : load stage at which the FZG test A/8.3/90 fails. factor : X_L of the oil. structure : X_W of the steel, 1
    for case-hardened ones.
    """
    return 80 + (0.85 + 1.4 * structure) * factor * stage**2


def permissible_integral_temperature(
    stage: float, *, viscosity_40: float, factor: float = 1.0, structure: float = 1.0
) -> float:
    """Return the scuffing temperature of the integral temperature [degC].

    viscosity_40 : kinematic viscosity at 40 degC [m^2/s]. Others as in `permissible_contact_temperature`.
    """
    torque = _TEST_TORQUE * stage**2
    bulk = 80 + 0.23 * torque * factor
    flash = 0.2 * torque * (100 / (1e6 * viscosity_40)) ** 0.02 * factor
    return bulk + _INTEGRAL_WEIGHT * structure * flash


def integral_temperature(bulk: float, mean_flash: float) -> float:
    """Return the integral temperature in the unit of `bulk`, from the mean flash temperature over the path [K]."""
    return bulk + _INTEGRAL_WEIGHT * mean_flash
