"""Usual ranges of the quantities that users give: the one list from which every plausibility note is written.

To add a quantity, add a `UsualRange` to `RANGES`. Scenes, machine elements (`bem.scenes.checks.plausible`) and the
Python entry points (`notes_on_arguments`) read the same list. A value outside its usual range is reported in a note; it
is never refused and never changes a result. Knows numbers and units; nothing of scenes or solvers. Verified in
tests/test_plausibility.py.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from bem.notes import Note, as_note
from bem.notes.general import VALUE_UNUSUAL
from bem.physical_constants import ATOM, ELECTRON_VOLT, ZERO_CELSIUS
from bem.quantities import with_unit

SOFTEST, STIFFEST = 1e3, 1.3e12
"""Young's moduli [Pa] beyond which no solid is known: gels, and above diamond; Ashby, *Materials Selection in
Mechanical Design*, chart of E."""
SMALLEST_RADIUS, LARGEST_RADIUS = 1e-10, 1e3
"""Radii [m] beyond which no body is in contact: an atom, and a flat that is hardly crowned."""
ARGUMENT = "argument "
"""How a note on an argument of a Python entry point begins; scenes report the same value under its key."""


@dataclass(frozen=True)
class UsualRange:
    """Usual range of a quantity.

    Attributes
    ----------
    quantity : what it is called in notes.
    unit : SI unit of the values; empty for a ratio.
    low, high : ends of the usual range, in that unit. Zero is usual unless `signed`.
    keys : keys of scenes and elements that give it: "key", or "table.key" which takes precedence.
    meant : units that users forget or mistake, with their factor to SI, the likeliest first.
    about : typical values, in words.
    signed : whether the sign counts; else sizes are compared.
    """

    quantity: str
    unit: str
    low: float
    high: float
    keys: tuple[str, ...] = ()
    meant: tuple[tuple[str, float], ...] = ()
    about: str = ""
    signed: bool = False

    def contains(self, value: float) -> bool:
        """Return True if a value is usual; what is not a finite number has no range."""
        if not math.isfinite(value):
            return True
        if self.signed:
            return self.low <= value <= self.high
        return value == 0 or self.low <= abs(value) <= self.high

    def note(self, key: str, value: float) -> Note | None:
        """Return a note on a value outside the range, None inside.

        Parameters
        ----------
        key : of the scene, or the name of the argument.
        value : in the SI unit.
        """
        if self.contains(value):
            return None
        ends = f"{with_unit(self.low, self.unit)} to {with_unit(self.high, self.unit)}"
        likely = self._likely_unit(value) or "check it"
        return VALUE_UNUSUAL(
            key,
            quantity=self.quantity,
            value=with_unit(value, self.unit),
            usual=f"{ends}: {self.about}" if self.about else ends,
            check=likely[0].upper() + likely[1:],
        )

    def _likely_unit(self, value: float) -> str:
        """The unit that makes the same number usual."""
        if not self.unit:
            shares = [unit for unit, factor in self.meant if self.contains(value * factor)]
            return f'a number alone is a share; if per cent is meant, write "{value:g} {shares[0]}"' if shares else ""
        if self.unit == "K":
            likely = "degC" if self.contains(value + ZERO_CELSIUS) else None
        else:
            value = _as_written(value)
            likely = next((unit for unit, factor in self.meant if self.contains(value * factor)), None)
        if likely is None:
            return "check its unit"
        return f'if the unit is wrong or missing (a number alone is in {self.unit}), write "{value:g} {likely}"'


_LEAST_BARE = 1e-2
"""Value in the SI unit from which it may be a number without a unit; smaller ones come from one with a prefix."""


def _as_written(value: float) -> float:
    """Return the number that was likely written before the unit: 141 of "141 um", 1.41e-4 in metres."""
    if abs(value) >= _LEAST_BARE or value == 0:
        return value
    return float(f"{value * 1000.0 ** -math.floor(math.log(abs(value), 1000) + 1e-9):.12g}")


_LENGTHS = (("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9))
_PRESSURES = (("GPa", 1e9), ("MPa", 1e6))
RANGES: tuple[UsualRange, ...] = (
    UsualRange(
        "Young's modulus", "Pa", 1e5, 2e12, ("youngs_modulus",), _PRESSURES,
        "rubber has 1 MPa to 100 MPa, polymers 1 to 5 GPa, steel 210 GPa, diamond 1.1 TPa",
    ),
    UsualRange(
        "Poisson's ratio", "", 0.05, 0.5, ("poissons_ratio",), (),
        "ceramics and glass have 0.15 to 0.3, metals 0.25 to 0.35, polymers 0.35 to 0.5", signed=True,
    ),
    UsualRange(
        "hardness", "Pa", 1e6, 1.5e11, ("hardness", "hardnesses"), (*_PRESSURES, ("HV", 9.807e6)),
        "polymers have 0.1 GPa, hardened steel 7 GPa, ceramics up to 30 GPa (1 HV is 9.81 MPa)",
    ),
    UsualRange(
        "yield stress", "Pa", 1e5, 7.5e10, ("yield_stress",), (("MPa", 1e6), ("GPa", 1e9)),
        "polymers have 50 MPa, steels 0.2 to 2.5 GPa",
    ),
    UsualRange(
        "thermal conductivity of an oil", "W/(m*K)", 0.05, 1.0, ("oil.thermal_conductivity",), (),
        "oils have 0.1 to 0.2 W/(m*K), water 0.6",
    ),
    UsualRange(
        "thermal conductivity", "W/(m*K)", 0.02, 2500.0, ("thermal_conductivity",), (),
        "polymers have 0.2 to 0.5 W/(m*K), steels 15 to 50, copper 400",
    ),
    UsualRange(
        "density of a liquid", "kg/m^3", 500.0, 2500.0, ("oil.density", "liquid_density"), (("g/cm^3", 1e3),),
        "oils have 800 to 1000 kg/m^3",
    ),
    UsualRange(
        "density", "kg/m^3", 100.0, 2.3e4, ("density", "particle_density"), (("g/cm^3", 1e3),),
        "polymers have 1000 to 2000 kg/m^3, steel 7800",
    ),
    UsualRange(
        "heat capacity", "J/(kg*K)", 100.0, 5000.0, ("heat_capacity",), (("kJ/(kg*K)", 1e3),),
        "steel has 470 J/(kg*K), oils 2000, water 4200",
    ),
    UsualRange(
        "radius", "m", 1e-9, 9.9, ("radius", "radius_y", "ball", "radii", "base_radius", "face_radius"), _LENGTHS
    ),
    UsualRange(
        "length of a body", "m", 1e-6, 5.0,
        ("width", "bore", "outside", "diameter", "pitch_diameter", "face_width", "lift", "stroke", "rod",
         "length", "tip_diameters", "shaft_diameter", "wall"),
        _LENGTHS,
    ),
    UsualRange("place of the contact over the ring's height", "", 0.02, 0.98, ("crown",), (), "rings have about 0.5"),
    UsualRange("module", "m", 5e-5, 0.1, ("module",), _LENGTHS, "gears of watches have 0.1 mm, of mills 30 mm"),
    UsualRange("mass", "kg", 1e-5, 50.0, ("mass",), (("g", 1e-3),), "tappets and valves have 20 to 500 g"),
    UsualRange(
        "clearance", "m", 1e-7, 3e-3, ("clearance",), (("um", 1e-6), ("mm", 1e-3)),
        "rolling bearings have 5 to 200 um, polymer bushes up to 1 mm",
    ),
    UsualRange(
        "tilt of the rings", "rad", 1e-6, 5e-3, ("tilt",), (),
        "catalogues permit some 1 mrad (3 minutes of arc) of cylindrical roller bearings",
    ),
    UsualRange(
        "amplitude of the oscillation", "rad", 1e-4, 3.1416, ("oscillation.amplitude",),
        (("deg", math.radians(1)), ("mrad", 1e-3)), "to either side; 180 deg is half a turn",
    ),
    UsualRange(
        "load", "N", 1e-12, 1e7, ("load", "loads", "load_end", "force", "radial_load", "preload", "tension"),
        (("mN", 1e-3), ("uN", 1e-6)),
    ),
    UsualRange("load per unit length", "N/m", 1e-6, 1e8, ("load_per_length",), (("N/mm", 1e3),)),
    UsualRange(
        "pressure", "Pa", 1e3, 2e10, ("hertz_pressure", "hertz_pressures"), _PRESSURES,
        "rolling contacts have 0.5 to 4 GPa",
    ),
    UsualRange(
        "mean pressure", "Pa", 1e3, 2e10, ("mean_pressure",), _PRESSURES[::-1],
        "joints have 1 to 100 MPa, rolling contacts 0.5 to 4 GPa",
    ),
    UsualRange("torque", "N*m", 1e-6, 1e7, ("torque",), (("N*mm", 1e-3),)),
    UsualRange(
        "speed", "m/s", 1e-10, 100.0,
        ("speed", "speeds", "mean_speed", "lower_speed", "upper_speed", "speeds.first", "speeds.last", "speeds.values"),
        (("mm/s", 1e-3), ("um/s", 1e-6)),
        "above about 100 m/s heat and inertia of the oil, which are left out, rule the contact",
    ),
    UsualRange("speed of rotation", "rad/s", 1e-6, 2e4, ("speed_of_rotation",), (("rpm", 0.10472),)),
    UsualRange(
        "viscosity", "Pa*s", 1e-4, 10.0, ("viscosity",), (("mPa*s", 1e-3),),
        "oils have 1 mPa*s (hot) to 2 Pa*s (VG 680, cold), water 1 mPa*s; 100 cSt of oil are 0.09 Pa*s",
    ),
    UsualRange(
        "pressure-viscosity coefficient", "1/Pa", 2e-10, 1e-7, ("pressure_viscosity",),
        (("1/GPa", 1e-9), ("1/MPa", 1e-6)), "mineral oils have 15 to 35 1/GPa, water 0.5 1/GPa",
    ),
    UsualRange(
        "softening of the oil with temperature", "1/K", 5e-3, 0.2, ("temperature_viscosity",), (),
        "mineral oils have 0.02 to 0.06 1/K",
    ),
    UsualRange(
        "temperature", "K", 233.15, 573.15,
        ("temperature", "temperatures", "lower_bulk", "upper_bulk", "bulk", "bulk_temperature", "ambient"), (),
        "oils are liquid and additives alive from -40 to 300 degrees Celsius",
    ),
    UsualRange(
        "rms height", "m", 1e-11, 1e-4,
        ("rms_height", "roughness", "rms_roughness", "lower_rms_height", "upper_rms_height"),
        (("um", 1e-6), ("nm", 1e-9)), "polished surfaces have 1 to 20 nm, ground ones 0.1 to 1 um",
    ),
    UsualRange(
        "length along the surface", "m", ATOM, 0.1,
        ("correlation_length", "cutoff_wavelength", "rolloff_wavelength", "wavelength"), (("um", 1e-6), ("mm", 1e-3)),
    ),
    UsualRange(
        "thickness of a layer", "m", ATOM, 0.02, ("thickness", "layer_thickness"), (("um", 1e-6), ("nm", 1e-9)),
        "hard coatings have 0.5 to 10 um",
    ),
    UsualRange(
        "residual stress", "Pa", 1e5, 1.5e10, ("residual_stress",), _PRESSURES,
        "hard coatings have 0.5 to 10 GPa of compression, peened steels 0.3 to 1 GPa",
    ),
    UsualRange("layer of oil", "m", 1e-9, 1e-3, ("supply.layer",), (("um", 1e-6), ("nm", 1e-9))),
    UsualRange(
        "cell of the grid", "m", ATOM, 1e-2, ("grid.spacing", "grid_cell"), (("um", 1e-6), ("nm", 1e-9)),
        "atoms are 0.2 to 0.3 nm apart, and below that no continuum is left",
    ),
    UsualRange(
        "friction", "", 1e-4, 1.0, ("friction", "boundary_friction", "friction_on_film"), (),
        "boundary lubrication has 0.05 to 0.2, dry metals 0.3 to 0.6; only clean metals in vacuum and rubber exceed 1",
    ),
    UsualRange(
        "creepage", "", 1e-7, 0.05, ("roll.creepage", "roll.creepage_across"), (("%", 0.01),),
        "steel slides over the whole contact from about 1 % on, tyres from 10 %",
    ),
    UsualRange(
        "specific wear rate", "m^2/N", 1e-22, 1e-11, ("specific_wear_rate",), (("mm^3/(N*m)", 1e-9),),
        "lubricated metals have 1e-10 to 1e-6 mm^3/(N*m), dry ones up to 1e-3",
    ),
    UsualRange(
        "barrier of growth", "J", 0.1 * ELECTRON_VOLT, 3 * ELECTRON_VOLT, ("activation_energy",),
        (("eV", ELECTRON_VOLT), ("kJ/mol", 1.66e-21)),
        "0.3 to 1.5 eV were measured (Gosvami et al. 2015), and growth goes with its exponential",
    ),
    UsualRange(
        "activation volume", "m^3", 1e-31, 1e-27, ("activation_volume",), (("angstrom^3", 1e-30), ("nm^3", 1e-27)),
        "3 to 200 cubic angstrom were measured (Spikes 2018)",
    ),
    UsualRange(
        "wear coefficient of a tribofilm", "1/s", 1e-12, 0.1, ("wear_coefficient",), (),
        "1e-5 to 1e-2 1/s were measured; at 0.1 1/s a film is gone within ten seconds",
    ),
)  # fmt: skip
"""Every quantity with a usual range, each once. Sources: Ashby (moduli, yield stress); Tabor (hardness); Bowden and
Tabor (friction); Hamrock, Schmid and Jacobson, chapter 4 (oils); Gosvami et al., Science 348 (2015) 102, and Spikes,
Lubricants 6 (2018) 31 (tribofilms)."""

BY_NAME: dict[str, UsualRange] = {one.quantity: one for one in RANGES}
BY_KEY: dict[str, UsualRange] = {key: one for one in RANGES for key in one.keys}


def range_of_key(path: str, unit: str | None = None) -> UsualRange | None:
    """The usual range of a key such as "lower.layers[0].material.youngs_modulus"; None of a key without one.

    unit : of the key's values, where it is known: a range of another unit is not meant.
    """
    steps = [step.partition("[")[0] for step in path.split(".")]
    for key in (".".join(steps[-2:]), steps[-1]):
        found = BY_KEY.get(key)
        if found is not None and unit in (None, found.unit):
            return found
    return BY_NAME["speed of rotation"] if unit == "rad/s" else None


def notes_on(values: Iterable[tuple[str, UsualRange, float]]) -> list[Note]:
    """Notes on (key, range, value), of the entries of a list only the one farthest outside at either end."""
    farthest: dict[tuple[str, bool], tuple[str, UsualRange, float]] = {}
    for key, usual, value in values:
        if usual.contains(value):
            continue
        high = value > usual.high if usual.signed else abs(value) > usual.high
        base = key.rpartition("[")[0] if key.endswith("]") else key
        before = farthest.get((base, high))
        if before is None or (abs(value) > abs(before[2])) == high:
            farthest[base, high] = (key, usual, value)
    return [note for key, usual, value in farthest.values() if (note := usual.note(key, value)) is not None]


def notes_on_arguments(arguments: Mapping[str, tuple[str, Any]]) -> tuple[Note, ...]:
    """Notes on arguments of a Python entry point.

    Parameters
    ----------
    arguments : by name, the quantity and its value in SI units: a number, None, or a sequence of them.
    """
    values = []
    for name, (quantity, value) in arguments.items():
        listed = value if isinstance(value, (list, tuple)) else (value,)
        values += [(ARGUMENT + name, BY_NAME[quantity], float(one)) for one in listed if one is not None]
    return tuple(notes_on(values))


def lubricant_arguments(lubricant: Any) -> dict[str, tuple[str, Any]]:
    """What a `bem.Lubricant` gives to `notes_on_arguments`; an oil of the catalogue has notes of its own."""
    if lubricant.oil is not None:
        return {}
    return {
        "lubricant.viscosity": ("viscosity", lubricant.viscosity),
        "lubricant.pressure_viscosity": ("pressure-viscosity coefficient", lubricant.pressure_viscosity),
        "lubricant.temperature": ("temperature", lubricant.temperature),
        "lubricant.density": ("density of a liquid", lubricant.density),
        "lubricant.heat_capacity": ("heat capacity", lubricant.heat_capacity),
        "lubricant.thermal_conductivity": ("thermal conductivity of an oil", lubricant.thermal_conductivity),
        "lubricant.temperature_viscosity": (
            "softening of the oil with temperature",
            lubricant.temperature_viscosity,
        ),
    }


def body_arguments(bodies: Any) -> dict[str, tuple[str, Any]]:
    """What one or several `bem.Body` give to `notes_on_arguments`; stiff stand-ins called rigid have no modulus."""
    found: dict[str, tuple[str, Any]] = {}
    listed = () if bodies is None else bodies if isinstance(bodies, (list, tuple)) else (bodies,)
    for number, body in enumerate(listed):
        parts = [(f"bodies[{number}].material", body.material)]
        for place, layer in enumerate(body.layers):
            key = f"bodies[{number}].layers[{place}]"
            parts.append((f"{key}.material", layer.material))
            found[f"{key}.thickness"] = ("thickness of a layer", layer.thickness)
            found[f"{key}.residual_stress"] = ("residual stress", layer.residual_stress)
        for key, material in parts:
            found |= material_arguments(key, material)
    return found


def material_arguments(key: str, material: Any) -> dict[str, tuple[str, Any]]:
    """Return a material's constants as arguments of `notes_on_arguments`; none for None and for a rigid stand-in."""
    if material is None or "rigid" in material.name.lower():
        return {}
    return {
        f"{key}.youngs_modulus": ("Young's modulus", material.youngs_modulus),
        f"{key}.poissons_ratio": ("Poisson's ratio", material.poissons_ratio),
        f"{key}.hardness": ("hardness", material.hardness),
        f"{key}.yield_stress": ("yield stress", material.yield_stress),
        f"{key}.thermal_conductivity": ("thermal conductivity", material.thermal_conductivity),
        f"{key}.density": ("density", material.density),
        f"{key}.heat_capacity": ("heat capacity", material.heat_capacity),
    }


def with_argument_notes(results: Sequence[Any], said: tuple[Note, ...]) -> list[Any]:
    """Results over time, frozen dataclasses, each with the notes on its entry point's arguments before its own."""
    return [replace(one, notes=said + one.notes) for one in results] if said else list(results)


def without_argument_notes(notes: Iterable[str]) -> tuple[Note, ...]:
    """Notes without those on arguments, for callers that check their own input."""
    return tuple(note for note in map(as_note, notes) if not note.where.startswith(ARGUMENT))
