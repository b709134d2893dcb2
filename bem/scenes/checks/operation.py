"""Checks of friction, speeds, oil, temperature and tribofilm constants."""

from __future__ import annotations

import math
from collections.abc import Iterator

from bem.scenes.checks.facts import Facts
from bem.scenes.checks.registry import scene_check
from bem.scenes.checks.words import si

_SPEED = 100.0
_VISCOSITIES = (1e-4, 100.0)
_PRESSURE_VISCOSITIES = (2e-10, 1e-7)
_TEMPERATURES = (233.15, 573.15)
_ELECTRON_VOLT = 1.602176634e-19


@scene_check
def friction_above_one(facts: Facts) -> Iterator[str]:
    """Clean metals in vacuum, and soft rubber, exceed one; lubricated and worn contacts have 0.05 to 0.6.

    Bowden & Tabor, Friction and Lubrication of Solids (1950).
    """
    largest = max((abs(case.friction) for case in facts.cases), default=0.0)
    if largest > 1:
        yield (
            f"friction {largest:g}: only clean metals in vacuum and rubber have more than 1; boundary lubrication has "
            "0.05 to 0.2, dry metals 0.3 to 0.6"
        )


@scene_check
def speed_beyond_machines(facts: Facts) -> Iterator[str]:
    """Above 100 m/s heat and inertia rule the contact, and neither is here; often a speed in mm/s without its unit."""
    scene = facts.scene
    found: list[float] = []
    if getattr(scene, "speeds", None) is not None:
        found = [abs(speed) for pair in scene.speeds.build() for speed in pair]
    elif getattr(scene, "motion", None) is not None:
        found = [abs(speed) for speed in (scene.motion.speeds or [scene.motion.speed or 0.0])]
    if found and max(found) > _SPEED:
        yield (
            f"speed {max(found):g} m/s: heat in the film and the oil's inertia, which are left out, rule above about "
            f"{_SPEED:g} m/s; a number without a unit is in m/s"
        )


@scene_check
def implausible_viscosity(facts: Facts) -> Iterator[str]:
    """Oils have 1 mPa s (hot) to 100 Pa s (VG 1500 in the cold), liquid gases 0.1 mPa s; 1 cP is 1 mPa s."""
    table = getattr(facts.scene, "oil", None)
    oil = None if table is None else table.build()
    if oil is not None and not _VISCOSITIES[0] <= oil.viscosity <= _VISCOSITIES[1]:
        thick = oil.viscosity > _VISCOSITIES[1]
        yield (
            f"oil.viscosity {si(oil.viscosity, 'Pa s')} is that of {'pitch' if thick else 'a gas'}, not of an oil; a "
            "number without a unit is in Pa s"
            + (f': write viscosity = "{oil.viscosity:g} mPa*s" if cP or mPa s are meant' if thick else "")
        )


@scene_check
def implausible_pressure_viscosity(facts: Facts) -> Iterator[str]:
    """Water has 0.5 1/GPa, mineral oils 15 to 35, traction fluids up to 45 1/GPa at room temperature.

    Hamrock, Schmid & Jacobson, Fundamentals of Fluid Film Lubrication (2004), chapter 4.
    """
    oil = getattr(facts.scene, "oil", None)
    value = 0.0 if oil is None else oil.build().pressure_viscosity
    if value and not _PRESSURE_VISCOSITIES[0] <= value <= _PRESSURE_VISCOSITIES[1]:
        hint = f' ("{value:g} 1/GPa"?)' if value > 1e-3 else ""
        yield (
            f"oil.pressure_viscosity {value:g} 1/Pa is {value * 1e9:.3g} 1/GPa; mineral oils have 15 to 35 1/GPa, "
            f"water 0.5{hint}"
        )


@scene_check
def oil_outside_its_range(facts: Facts) -> Iterator[str]:
    """Viscosities extrapolated, an oil above its flash point or too thick to flow."""
    oil = getattr(facts.scene, "oil", None)
    yield from () if oil is None else oil.build().notes


@scene_check
def implausible_temperature(facts: Facts) -> Iterator[str]:
    """Oils are liquid and additives alive from -40 to 300 degrees Celsius; 60 without a unit is 60 K."""
    rubbing = getattr(facts.scene, "rubbing", None)
    for temperature in getattr(rubbing, "temperatures", ()):
        if not _TEMPERATURES[0] <= temperature <= _TEMPERATURES[1]:
            yield (
                f"rubbing.temperatures: {temperature:g} K is {temperature - 273.15:.0f} degrees Celsius, outside -40 "
                "to 300; a "
                f'number without a unit is in K: write "{temperature:g} degC" if that is meant'
            )


@scene_check
def tribofilm_constants(facts: Facts) -> Iterator[str]:
    """Barriers of tribochemical growth are 0.3 to 1.5 eV, activation volumes 3 to 200 cubic angstrom (Gosvami et al.,
    Science 348 (2015) 102; Spikes, Lubricants 6 (2018) 31); wear above 0.1 1/s takes a film off within ten seconds."""
    if not facts.of_kind("tribofilm"):
        return
    film = facts.scene.film
    barriers = {v.activation_energy or film.activation_energy for v in facts.scene.variants} or {film.activation_energy}
    volumes = [film.activation_volume, *(v.activation_volume or 0.0 for v in facts.scene.variants)]
    rates = [film.wear_coefficient, *(v.wear_coefficient or 0.0 for v in facts.scene.variants)]
    for barrier in sorted(barriers):
        if not 0.1 <= barrier / _ELECTRON_VOLT <= 3:
            yield (
                f"film.activation_energy {barrier / _ELECTRON_VOLT:.3g} eV is outside 0.1 to 3 eV; growth goes with "
                "its exponential: check the unit (1 kJ/mol is 0.0104 eV)"
            )
    if max(volumes) > 1e-27:
        yield (
            f"film.activation_volume {max(volumes) * 1e30:.3g} cubic angstrom is a thousand molecules' bonds; 3 to 200 "
            "have been found: check the unit"
        )
    if max(rates) > 0.1:
        yield (
            f"film.wear_coefficient {max(rates):g} 1/s takes a film off within {1 / max(rates):.2g} s; 1e-5 to 1e-2 "
            "1/s have been found: check the unit"
        )


@scene_check
def growth_without_a_barrier(facts: Facts) -> Iterator[str]:
    """Where friction x pressure x activation volume reaches the barrier, growth runs at its prefactor whatever the
    heat."""
    if not facts.of_kind("tribofilm"):
        return
    film = facts.scene.film
    for case in facts.cases:
        pressure = case.cap if case.cap is not None else (case.smooth.maximum_pressure if case.smooth else 0.0)
        lowered = case.friction * pressure * film.activation_volume
        if lowered > film.activation_energy and math.isfinite(lowered):
            yield (
                f"film: shear stress {si(case.friction * pressure, 'Pa')} x activation volume is "
                f"{lowered / _ELECTRON_VOLT:.2g} eV, above the barrier of "
                f"{film.activation_energy / _ELECTRON_VOLT:.2g} eV{case.at}: growth runs at its prefactor, without "
                "temperature; check activation_volume and its unit"
            )
            return
