"""Machine elements by name: their files, what they give in a table, scenes of their contacts."""

from __future__ import annotations

import csv
import io
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from importlib import resources
from pathlib import Path
from types import MappingProxyType
from typing import Any

from bem.arguments import read_small
from bem.elements.bush_answer import bush_temperature, friction_power_of, journal_beside, journal_words
from bem.elements.bush_friction import SharedFriction, shared_friction
from bem.elements.cam_follower import CamModel
from bem.elements.contact import EVEN, WIDE, ElementContact
from bem.elements.gear_pair import GearModel
from bem.elements.model import Contacts, ElementModel, HeatBalanceScene
from bem.elements.passes import time_words
from bem.elements.piston_ring import PistonRingModel
from bem.elements.plain_bush import (
    HOUSING,
    PlainBushModel,
    has_assumed_coefficient,
    with_pressure_viscosity,
    with_temperature,
)
from bem.elements.rolling_bearing import BearingModel
from bem.elements.rough_scenes import (
    bush_rubbing_scene,
    bush_scene,
    conducts,
    finish_words,
    life_scene,
    mixed_scene,
    passes_in,
    rubbing_scene,
)
from bem.errors import InputError
from bem.materials import Body, Material, contact_modulus
from bem.notes import Note
from bem.notes.checks import SLOPES_LARGE, YIELDS
from bem.notes.elements import (
    BODIES_COLDER,
    GLYCOL_ASSUMED,
    NO_HEAT,
    OIL_FOLLOWS_BALANCE,
    SPEED_IN_TURNS,
    SPEED_WITHOUT_UNIT,
    SURFACES_TOUCH,
)
from bem.physical_constants import ZERO_CELSIUS
from bem.quantities import with_unit
from bem.scenes.checks.hertz import smooth_contact
from bem.scenes.checks.plausible import notes_on_bare_numbers, notes_on_table
from bem.scenes.oil import OilScene
from bem.scenes.template import without_description
from bem.scenes.units import turns_without_angle
from bem.scenes.validate import nearest, show, validate
from bem.scenes.values import parse_toml

OTHER_BEARINGS = (
    "angular-contact-bearing",
    "angular-contact-ball-bearing",
    "tapered-roller-bearing",
    "taper-roller-bearing",
    "spherical-roller-bearing",
    "self-aligning-ball-bearing",
    "thrust-bearing",
    "thrust-ball-bearing",
)
"""Names of rolling bearings that are none of the elements."""
RADIAL_BEARINGS = (
    "ball-bearing",
    "deep-groove-ball-bearing",
    "deep-groove-bearing",
    "roller-bearing",
    "cylindrical-roller-bearing",
    "needle-bearing",
)
"""Names of rolling bearings that are elements."""

MODELS: dict[str, type[ElementModel]] = {
    "cam-follower": CamModel,
    "gear-pair": GearModel,
    "piston-ring": PistonRingModel,
    "plain-bush": PlainBushModel,
    "rolling-bearing": BearingModel,
}
_JOURNAL = (
    "Journal bearings are not modelled: the oil wedge around the whole shaft, its supply through grooves and its "
    "cavitation are missing. For dry, boundary and mixed lubricated bushes, of polymers above all, take plain-bush "
    "(bem new plain-bush): contact angle, pressure, p v, temperature, wear, and the film of the loaded zone."
)
_GREASE = (
    "Grease is not modelled; its contacts are films of its base oil, often starved. Use kind traction, friction or "
    "point-film with the base oil's grade or viscosities in [oil], and [supply] with layer, the oil thickness on the "
    "surfaces, or distance, where the filled inlet begins."
)
_SEAL = (
    "Seals are not modelled. Take a small flat patch of both surfaces under its mean pressure: kind contact shows "
    "contact area and gap, kind flow-factors the resistance to flow through the gap."
)
_OTHER_GEARS = (
    "Only external spur and helical gears are elements. Give load, radius and speeds along the path of contact to "
    "kind traction as [along], from a .csv file."
)
_OTHER_BEARINGS = (
    "Only radial deep groove ball and cylindrical roller bearings are elements (rolling-bearing). Give load, radii and "
    "speeds of one contact to kind traction (rollers) or point-film (balls), with roughness to kind friction."
)
NOT_MODELLED = {
    **dict.fromkeys(OTHER_BEARINGS, _OTHER_BEARINGS),
    **dict.fromkeys(("journal-bearing", "hydrodynamic-bearing"), _JOURNAL),
    **dict.fromkeys(("seal", "seals", "lip-seal"), _SEAL),
    **dict.fromkeys(("worm-gear", "bevel-gear", "hypoid-gear", "internal-gear", "planetary-gear"), _OTHER_GEARS),
    "grease": _GREASE,
}
"""Words for what the program does not model, each with what it can do instead."""
TITLES = {
    "rolling-bearing": "ball or roller bearing: film, friction, rating life (ISO 281), contacts of both rings",
    "gear-pair": "spur or helical gears: film, losses, temperatures, scuffing along the path of contact",
    "cam-follower": "cam under a flat-faced follower: film, friction and wear over the cam's angle",
    "piston-ring": "piston ring on its liner: film, friction and wear over the crank's angle",
    "plain-bush": "shaft in a bush, dry or lubricated: contact angle, pressure, p v, film, temperature, wear life",
}
"""A line about each element."""
ALIASES = {
    **dict.fromkeys(("bearing", *RADIAL_BEARINGS), "rolling-bearing"),
    "gear": "gear-pair",
    "gears": "gear-pair",
    "helical-gear": "gear-pair",
    **dict.fromkeys(("scuffing", "scoring"), "gear-pair"),
    **dict.fromkeys(("bearing-life", "rating-life", "l10"), "rolling-bearing"),
    "cam": "cam-follower",
    "ring": "piston-ring",
    **dict.fromkeys(("bush", "bushing", "bushes", "bushings"), "plain-bush"),
    **dict.fromkeys(("polymer-bush", "polymer-bushing", "polymer-bearing"), "plain-bush"),
    **dict.fromkeys(("plain-bearing", "sleeve-bearing", "sliding-bearing"), "plain-bush"),
}
"""Words for elements besides their names."""
AT_MARK = 1e-9
"""Distance from a marked place up to which a contact is there [m]."""
_ROUGHNESS = ("ra", "rq", "sq", "sa", "rz")
"""Keys that users expect in an element's file for its roughness."""
KINDS = ("traction", "contact", "point-film", "friction", "running-in", "surface-temperature", "running-in-life")
"""Kinds of scene that are made of a contact."""
MIXED = ("friction", "running-in")
"""Kinds of scene in which the oil film and the rough surfaces share the load, besides `LIFE`."""
LIFE = "running-in-life"
"""Kind of scene of a life in which they share the load and wear."""
_ALIKE = 1.0
"""Difference of temperatures [K] below which oil and bodies count as equally warm."""


@dataclass(frozen=True)
class Element:
    """An element as its file says it; `table` is that, `model` what it means.

    bulk_estimated : True if the bulk temperature is an estimate in place of one of the file.
    ambient : temperature of the surroundings whose heat balance gave the bulk temperature [K]; None of a bush, which
        has its own words, and without such a balance.
    balanced_from : temperature above which a heat balance raised the bulk temperature [K], of the surroundings or the
        oil; None without a balance.
    """

    model: ElementModel
    table: Mapping[str, Any]
    bulk_estimated: bool = False
    ambient: float | None = None
    balanced_from: float | None = None

    @cached_property
    def found(self) -> Contacts:
        """All contacts, with notes."""
        return self.model.contacts()

    @cached_property
    def modulus(self) -> float:
        """Contact modulus of both materials [Pa]."""
        return contact_modulus(*self.bodies)

    def worst(self) -> ElementContact:
        """Return the contact of the highest pressure along the path.

        Raises
        ------
        InputError : nowhere do the bodies touch.
        """
        if not self.found.contacts:
            raise self._no_contact()
        return max(self.found.contacts, key=lambda one: one.hertz(self.modulus).maximum_pressure)

    def critical(self) -> ElementContact:
        """Return the contact of highest pressure, marked ones included: at B of spur gears one pair carries alone.

        Raises
        ------
        InputError : as `worst`.
        """
        every = (self.worst(), *self.found.marked.values())
        return max(every, key=lambda one: one.hertz(self.modulus).maximum_pressure)

    def contact_for(self, kind: str) -> ElementContact:
        """Return the contact of which a scene of a kind is made where no place is chosen.

        Mixed lubrication and wear take the one of the thinnest steady film, other kinds that of highest pressure.

        Raises
        ------
        InputError : nowhere do the bodies touch.
        """
        mixed = kind in (*MIXED, LIFE) and self.model.oil is not None
        return self.thinnest_steady() if mixed else self.critical()

    def at_bulk(self, temperature: float, *, estimated: bool = False) -> Element:
        """Return the element with bodies of a temperature [K], in place of its bulk temperature or heat balance."""
        table = {key: value for key, value in self.table.items() if key not in ("bulk_temperature", "heat_balance")}
        changes: dict[str, Any] = {"bulk_temperature": temperature, "heat_balance": None}
        balance, ambient, start = self.model.heat_balance, None, None
        if isinstance(self.model, PlainBushModel):  # says to where the heat flows, and which conductance is assumed
            changes["heat_balance"] = balance or HeatBalanceScene()
        elif balance is not None:
            ambient = balance.ambient
            start = ambient if ambient is not None or self.model.oil is None else self.model.oil.temperature
        warm = table | {"bulk_temperature": temperature}
        return Element(self.model.model_copy(update=changes), warm, estimated, ambient, start)

    @property
    def _bulk_computed(self) -> bool:
        """Return True if the bulk temperature is of a heat balance or an estimate, and no key of the file."""
        of_bush = isinstance(self.model, PlainBushModel) and self.model.balanced
        return of_bush or self.bulk_estimated or self.balanced_from is not None

    @property
    def inlet_oil(self) -> OilScene | None:
        """The oil as it comes to the element: at the temperature of its heat balance if that has an `ambient`."""
        return self.model.oil if self.ambient is None else self.model.film_oil

    def _film_oil(self) -> OilScene:
        assert self.model.film_oil is not None
        return self.model.film_oil

    def _oil_table(self) -> dict[str, Any]:
        """Return the table of the oil as it comes into the contacts."""
        table = dict(self.table["oil"])
        if self.model.bulk_temperature is None:
            return table
        warm = self._film_oil()
        table["temperature"] = warm.temperature
        return table if warm.viscosity is None else table | {"viscosity": warm.viscosity}

    def _no_contact(self) -> InputError:
        return InputError(f"{self.model.name}: no contact is left: {'; '.join(self.found.notes[:1])}")

    def thinnest(self) -> ElementContact:
        """Return the contact of the thinnest film; InputError without an oil, or where the bodies touch nowhere."""
        return self._thinnest_of(self.found.contacts)

    def thinnest_steady(self) -> ElementContact:
        """Return the contact of the thinnest steady film, of those whose surfaces do not run against each other.

        Raises
        ------
        InputError : as `thinnest`.
        """
        steady = [one for one in self.found.contacts if abs(one.slide_roll_ratio) <= 2]
        return self._thinnest_of(steady or self.found.contacts)

    def _thinnest_of(self, contacts: Sequence[ElementContact]) -> ElementContact:
        """Return the contact of the thinnest film of some contacts; raises as `thinnest`."""
        if self.model.oil is None:
            raise InputError(f"{self.model.name}: no oil is given, so no film is the thinnest; allowed: a table [oil]")
        if not self.found.contacts:
            raise self._no_contact()
        oil = self._film_oil().build()
        return min(contacts, key=lambda one: one.minimum_film(self.modulus, oil))

    def columns(self) -> dict[str, list[float]]:
        """Return all contacts as columns, units in the names: keys of a scene over a path, Hertz' contact and film."""
        contacts, modulus = self.found.contacts, self.modulus
        found = {
            f"{self.found.along} [{self.found.along_unit}]": [one.place for one in contacts],
            "load [N]": [one.carried for one in contacts],
            "load_per_length [N/m]": [one.line_load(modulus) for one in contacts],
            "radius_1 [m]": [one.radii[0] for one in contacts],
            "radius_2 [m]": [one.radii[1] for one in contacts],
            "radius [m]": [one.radius for one in contacts],
            "speed_1 [m/s]": [one.speeds[0] for one in contacts],
            "speed_2 [m/s]": [one.speeds[1] for one in contacts],
            "hertz_pressure [Pa]": [one.hertz(modulus).maximum_pressure for one in contacts],
            "half_width [m]": [one.half_width(modulus) for one in contacts],
        }
        if isinstance(self.model, PlainBushModel):
            found["peak_pressure [Pa]"] = [self.model.shaft_contact.maximum_pressure]
            found["half_angle [rad]"] = [self.model.shaft_contact.half_angle]
            if self._layered:  # no contact of Hertz
                del found["hertz_pressure [Pa]"], found["half_width [m]"]
        if self.model.oil is not None:
            oil = self._film_oil().build()
            films = [one.minimum_film(self._patch_modulus, oil) for one in contacts]
            found["minimum_film [m]"] = films
            if self.model.rms_roughness is not None:
                found["film_over_roughness"] = [film / self.model.rms_roughness for film in films]
        return found

    def csv(self, more: Mapping[str, Sequence[float]] = MappingProxyType({})) -> str:
        """Return `columns`, and more of them, as comma-separated text, with a column of letters if there are marks."""
        marks = {"mark": self.letters()} if self.found.marks else {}
        return csv_text({**self.columns(), **more, **marks})

    def letters(self) -> list[str]:
        """Return the letters of the marked places at the nearest contacts, "C" or "near C"; empty elsewhere."""
        letters = [""] * len(self.found.contacts)
        for name, place in self.found.marks.items():
            nearest = min(range(len(letters)), key=lambda i: abs(self.found.contacts[i].place - place))
            exact = abs(self.found.contacts[nearest].place - place) < AT_MARK
            letters[nearest] = f"{letters[nearest]} {'' if exact else 'near '}{name}".strip()
        return letters

    def path(self) -> dict[str, list[float]]:
        """Return the table `along` of a scene of kind traction: a row for each place, in SI units.

        Raises
        ------
        InputError : an element without a path, or surfaces that run against each other on it.
        """
        contacts = self.found.contacts
        if self.found.along_unit != "m":
            raise InputError(f"{self.model.name}: a {self.model.element} has no path of contact; allowed: gear-pair")
        return {
            "position": [one.place for one in contacts],
            "radius": [one.radius for one in contacts],
            "load": [one.load for one in contacts],
            "lower_speed": [one.speeds[0] for one in contacts],
            "upper_speed": [one.speeds[1] for one in contacts],
        }

    def path_csv(self) -> str:
        """Return `path` as the file that a scene's `along = { path = ... }` names."""
        columns = self.path()
        units = {"position": "m", "radius": "m", "load": "N", "lower_speed": "m/s", "upper_speed": "m/s"}
        lines = [",".join(f"{name} [{units[name]}]" for name in columns)]
        lines += [",".join(f"{value:.9g}" for value in row) for row in zip(*columns.values(), strict=True)]
        return "\n".join(lines) + "\n"

    def path_scene(self) -> dict[str, Any]:
        """Return the table of a scene of kind traction over the whole path, as the built-in scene gear-flank is.

        Raises
        ------
        InputError : as `path`; no oil.
        """
        columns, whole = self.path(), self.scene(self.worst(), "traction")
        width = {"width": self.found.contacts[0].length}
        rest = {key: value for key, value in whole.items() if key not in ("rolling", "roller", "description")}
        about = {"description": f"{self.model.element}: {self.model.description or 'along its path'}"}
        marks = {"marks": dict(self.found.marks)} if self.found.marks else {}
        return rest | about | {"roller": width, "along": columns | marks}

    def notes(self) -> tuple[Note, ...]:
        """Return the notes on the element, and on places where half-space and line film do not carry."""
        given = self.model.model_copy(update={"bulk_temperature": None}) if self._bulk_computed else self.model
        notes = [*notes_on_table(given), *self.found.notes, *self.model.viscosity_notes()]
        if (unused := self._unused_oil_temperature()) is not None:
            notes.append(unused)
        if (colder := self._colder_than_oil()) is not None:
            notes.append(colder)
        if (bare := self.speed_note()) is not None:
            notes.append(bare)
        if not isinstance(self.model, PlainBushModel) and has_assumed_coefficient(self.model.oil):
            notes.append(GLYCOL_ASSUMED(reason="rolling"))
        wide = [one.name for one in self.found.contacts if one.is_wide(self.modulus)]
        if wide and not isinstance(self.model, PlainBushModel):  # a bush is solved as round as it is
            others = f" and {len(wide) - 1} more place{'s' if len(wide) > 2 else ''}" if len(wide) > 1 else ""
            notes.append(SLOPES_LARGE(first=wide[0], others=others, limit=WIDE, reason="element"))
        if (soft := self._yielding()) is not None:
            notes.append(soft)
        cold = dict.fromkeys(one.name for one in self.bodies if not one.thermal_diffusivity)
        if self.model.oil is not None and cold:
            notes.append(NO_HEAT(bodies=" and ".join(cold), reason="bodies"))
        elif self.model.film_oil is not None and not conducts(self.model):
            notes.append(NO_HEAT(reason="oil"))
        if (touching := self.touching_note(self.columns().get("film_over_roughness", []))) is not None:
            notes.append(touching)
        return tuple(notes)

    def touching_note(self, ratios: Sequence[float]) -> Note | None:
        """Return a note on the places whose lambda ratio is below one; None without such places.

        ratios : of all contacts, or none. A bush has words of its own.
        """
        touching = sum(ratio < 1 for ratio in ratios)
        if not touching or isinstance(self.model, PlainBushModel):
            return None
        reason = "slides" if any(one.slide_roll_ratio for one in self.found.contacts) else "rolls"
        return SURFACES_TOUCH(touching=touching, places=len(ratios), reason=reason)

    def _colder_than_oil(self) -> Note | None:
        """Return a note on a bulk temperature of the file below that of the oil, None without one."""
        given, oil = self.table.get("bulk_temperature"), self.model.oil
        bulk = self.model.bulk_temperature
        if given is None or bulk is None or oil is None or oil.temperature is None or self.ambient is not None:
            return None
        if self.model.heat_balance is not None or bulk > oil.temperature - _ALIKE:
            return None
        return BODIES_COLDER(bulk=bulk - ZERO_CELSIUS, oil=oil.temperature - ZERO_CELSIUS)

    def _unused_oil_temperature(self) -> Note | None:
        """Return a note on an oil temperature beside a heat balance with an ambient, which gives another one."""
        oil, bulk = self.model.oil, self.model.bulk_temperature
        if self.ambient is None or bulk is None or oil is None or oil.temperature is None:
            return None
        if oil.temperature == self.ambient or abs(oil.temperature - bulk) < _ALIKE:
            return None
        return OIL_FOLLOWS_BALANCE(bulk=bulk - ZERO_CELSIUS, oil=oil.temperature - ZERO_CELSIUS)

    def speed_note(self) -> Note | None:
        """Return a note on a speed of rotation without a unit, or whose unit says no angle; None of others."""
        given = self.table.get("speed")
        if turns_without_angle(given):
            return SPEED_IN_TURNS(given=given, rpm=rpm(self.model.speed))  # type: ignore[attr-defined]
        if not isinstance(given, int | float):
            return None
        return SPEED_WITHOUT_UNIT(speed=float(given), rpm=rpm(float(given)))

    def _yielding(self) -> Note | None:
        """Return a note where Hertz' pressure is beyond what the softer material carries elastically."""
        bodies = [Body(one) for one in self.bodies]
        found = []
        for one in self.found.contacts:
            force = one.load if one.length is None else one.load / one.length
            smooth = smooth_contact(bodies[0], bodies[1], (one.radius, one.across), load=force)
            assert smooth is not None
            onset = smooth.yields_from(*bodies)
            if onset is not None and smooth.maximum_pressure > onset:
                found.append((smooth.maximum_pressure / onset, onset, one))
        if not found:
            return None
        ratio, onset, one = max(found, key=lambda each: each[0])
        everywhere = len(self.found.contacts)
        reason = "element of one material" if self.bodies[0] == self.bodies[1] else "element"
        return YIELDS(places=len(found), all=everywhere, ratio=ratio, onset=onset, place=one.name, reason=reason)

    @cached_property
    def bodies(self) -> tuple[Material, Material]:
        """Materials of both bodies."""
        return self.model.first.build(), self.model.second.build()

    def scene(self, contact: ElementContact, kind: str) -> dict[str, Any]:
        """Return the table of a scene of one contact; body 1 is the lower one.

        Raises
        ------
        InputError : a kind that is none of `KINDS`, a film without oil or entrainment.
        """
        if kind not in KINDS:
            raise InputError(
                f"kind {show(kind)}: not made of an element{nearest(kind, KINDS)}; allowed: {', '.join(KINDS)}"
            )
        if kind == LIFE and isinstance(self.model, PlainBushModel):
            raise InputError(
                f"{self.model.name}: kind {kind} wears two bodies that pass through the contact; a bush wears at one "
                "place. Allowed: the wear life of the answer (specific_wear_rate), or kind running-in"
            )
        assumed = []
        if kind in (*MIXED, LIFE, "surface-temperature"):
            own = isinstance(self.model, PlainBushModel) and kind == "surface-temperature"
            if "boundary_friction" not in self.model.model_fields_set and not own:
                assumed.append(f"boundary friction {self.model.boundary_friction:g} is assumed")
            if self.model.rms_roughness is not None:
                assumed.append(finish_words(self.model))
        base = {
            "kind": kind,
            "name": self.model.name,
            "description": "; ".join([f"{self.model.element}: {contact.name}", *_slice_words(contact), *assumed]),
        }
        bodies = self._body_tables()
        bush = self._bush_table()
        if kind == "contact":
            made = base | self._dry_scene(contact, bodies) | bush
            if contact.length is not None:
                slice_width = with_unit(made["grid"]["lengths"][1], "m")
                made["description"] += f"; a slice of {slice_width} of its {with_unit(contact.length, 'm')}"
            return made
        if kind == "surface-temperature":
            self._check_heat()
            if isinstance(self.model, PlainBushModel):
                base["description"] += "; the bush, at rest, creeps so that the slice has a steady temperature"
                return base | self._rubbing_bush(self.model, contact, bodies) | bush
            return base | rubbing_scene(self.model, contact, bodies, self._patch_modulus)
        film, more = self._film_scene(contact, bodies, kind)
        if kind == LIFE:
            more.append(self._cycle_words(film))
        if isinstance(self.model, PlainBushModel) and kind in ("traction", *MIXED, LIFE):
            more = [*more, *self._film_bounds(self.model, contact)]
        base["description"] = "; ".join([base["description"], *more])
        return base | film | bush

    def _bush_table(self) -> dict[str, Any]:
        """Return the table `bush` of a scene in its key; none of other elements."""
        if not isinstance(self.model, PlainBushModel):
            return {}
        bore = self.model.shaft_diameter + self.model.clearance
        return {"bush": {"bore": bore, "clearance": self.model.clearance}}

    def _cycle_words(self, film: Mapping[str, Any]) -> str:
        """Return the number of cycles of a life, what a cycle is and how long they take, in words."""
        passes, count = passes_in(film, self.model, self.found.passes), film["life"]["count"]
        lasting = "" if passes.rate is None else f", take {time_words(count / passes.rate)}"
        remark = f"; {passes.remark}" if passes.remark else ""
        return f"{count} cycles, {passes.unit}{lasting}{remark}"

    def _film_bounds(self, bush: PlainBushModel, contact: ElementContact) -> list[str]:
        """Return the lower bound of a film in words where, by the film formula, a bush's scene takes it too thick."""
        thickness = contact.minimum_film(self._patch_modulus, self._film_oil().build())
        journal = journal_beside(bush, thickness)
        if journal is None:
            return []
        found = f"{journal_words(journal)}, at {with_unit(bush.sliding_speed, 'm/s')}"
        if thickness > bush.radial_clearance:
            return [f"the film of this scene is impossible, thicker than the radial clearance; it is {found}"]
        return [f"the film of this scene is an upper bound, too thick; its lower bound is {found}"]

    def shared_friction(self, contact: ElementContact) -> SharedFriction | None:
        """Solve the load sharing of one contact of a bush between its film and a ground shaft of the given roughness.

        Return None for other elements, without roughness, where no such scene can be made, and where the balance does
        not converge.
        """
        model = self.model
        if not isinstance(model, PlainBushModel) or model.rms_roughness is None or model.oil is None:
            return None
        try:
            return shared_friction(self.scene(contact, "friction"), contact.load)
        except InputError:
            return None

    def _rubbing_bush(self, bush: PlainBushModel, contact: ElementContact, bodies: dict[str, Any]) -> dict[str, Any]:
        """Return the keys of a scene of kind surface-temperature with the bush's own friction and temperature.

        The friction is the one given, in a liquid that of film and asperities, of a dry bush the usual one; the
        boundary friction where none of them is known.
        """
        slid = bush.radial_load * bush.sliding_speed
        friction, bulk = bush.boundary_friction, bush.bulk_temperature or bush.surroundings
        if bush.oil is None or bush.friction is not None:
            power, _ = friction_power_of(bush, None)
            if power is not None:
                friction, bulk = power / slid, bush_temperature(bush, power)
        elif (shared := self.shared_friction(contact)) is not None:
            friction = shared.friction
        return bush_rubbing_scene(bush, contact, bodies, modulus=self._patch_modulus, friction=friction, bulk=bulk)

    @property
    def _layered(self) -> bool:
        """Return True if body 2 is a layer: a bush with a wall."""
        return isinstance(self.model, PlainBushModel) and self.model.wall is not None

    @property
    def _patch_modulus(self) -> float:
        """Contact modulus of films by a fit, and by which scenes choose their patch [Pa]."""
        return self.model.film_modulus if isinstance(self.model, PlainBushModel) else self.modulus

    def _film_body_tables(self) -> dict[str, Any]:
        """Return the tables of both bodies of a film between smooth surfaces.

        The wall of a bush is a half-space on which the contact is as wide.
        """
        upper: Any = self.table["second"]
        if isinstance(self.model, PlainBushModel) and self.model.wall is not None:
            shaft, bush = self.bodies
            compliance = 1 / self.model.film_modulus - 1 / shaft.plane_strain_modulus
            stiffer = (1 - bush.poissons_ratio**2) / compliance
            upper = ({"catalogue": upper} if isinstance(upper, str) else dict(upper)) | {"youngs_modulus": stiffer}
        return {"lower": {"material": self.table["first"]}, "upper": {"material": upper}}

    def _body_tables(self) -> dict[str, Any]:
        """Return the tables of both bodies with their materials; the wall of a bush is a layer on its housing."""
        upper = {"material": self.table["second"]}
        if isinstance(self.model, PlainBushModel) and self.model.wall is not None:
            layer = {**upper, "thickness": self.model.wall}
            upper = {"material": self.table.get("housing", HOUSING), "layer": layer}
        return {"lower": {"material": self.table["first"]}, "upper": upper}

    def _film_scene(
        self, contact: ElementContact, bodies: dict[str, Any], kind: str
    ) -> tuple[dict[str, Any], list[str]]:
        """Return the keys of a scene of one contact with an oil film and what it assumes; raises as `scene`."""
        if self.model.oil is None:
            raise InputError(
                f"{self.model.name}: kind {kind} has an oil film, and the file no [oil]; allowed: a table [oil], or "
                "kind contact or surface-temperature, which are dry"
            )
        ratio = contact.slide_roll_ratio
        if not abs(ratio) <= 2:
            raise InputError(
                f"{contact.name}: the surfaces run against each other (speeds {contact.speeds[0]:.3g} and "
                f"{contact.speeds[1]:.3g} m/s), where no steady film of kind {kind} is; allowed: kind contact, or "
                f"a place of the table where they do not: {self._numbers_with_film()}"
            )
        if kind == "friction" and isinstance(self.model, PlainBushModel):
            return bush_scene(self.model, contact, self._oil_table(), self.table["first"], self.table["second"]), []
        if kind in (*MIXED, LIFE):
            if kind == LIFE:
                made, more = life_scene(
                    self.model, contact, bodies, self._oil_table(), self._patch_modulus, self.found.passes
                )
            else:
                if self._layered:
                    bodies = self._film_body_tables()
                made, more = mixed_scene(self.model, contact, bodies, self._oil_table(), kind, self._patch_modulus)
                if self._layered:
                    stiffer = with_unit(bodies["upper"]["material"]["youngs_modulus"], "Pa")
                    more.append(
                        f"the bush on its housing is a half-space of {stiffer}, on which the contact is as wide: its "
                        "asperities are too stiff"
                    )
            return made, more
        shared = {
            **self._film_body_tables(),
            "oil": self._oil_table(),
            **({} if self.model.rms_roughness is None else {"roughness": self.model.rms_roughness}),
            "rolling": {"mean_speed": abs(contact.mean_speed), "slide_roll_ratio": ratio},
            **({"supply": {"distance": contact.inlet}} if math.isfinite(contact.inlet) else {}),
        }
        if kind == "point-film":
            if contact.length is not None:
                refused = ("point-film", LIFE) if isinstance(self.model, PlainBushModel) else ("point-film",)
                others = ", ".join(one for one in KINDS if one not in refused)
                raise InputError(f"{contact.name}: a line contact has no film of kind point-film; allowed: {others}")
            ball = {"radius": contact.radius, "radius_y": contact.across, "load": contact.load}
            return {**shared, "ball": ball}, []
        line_load = contact.line_load(self.modulus)
        width = contact.load / line_load
        return {
            "thermal": self.model.thermal if conducts(self.model) else "off",
            **shared,
            "roller": {"radius": contact.radius, "width": width, "load": contact.load},
        }, []

    def _check_heat(self) -> None:
        cold = dict.fromkeys(one.name for one in self.bodies if not one.thermal_diffusivity)
        if cold:
            raise InputError(
                f"{self.model.name}: kind surface-temperature needs thermal_conductivity, heat_capacity and density of "
                f"{' and '.join(cold)}"
            )

    def _numbers_with_film(self) -> str:
        """Return the numbers of the places whose surfaces do not run against each other: "1 to 20, 54 to 73"."""
        runs: list[list[int]] = []
        for number, one in enumerate(self.found.contacts, start=1):
            if abs(one.slide_roll_ratio) <= 2:
                if runs and runs[-1][-1] == number - 1:
                    runs[-1].append(number)
                else:
                    runs.append([number])
        return ", ".join(f"{run[0]} to {run[-1]}" if len(run) > 1 else str(run[0]) for run in runs) or "none"

    def _dry_scene(self, contact: ElementContact, bodies: dict[str, Any]) -> dict[str, Any]:
        """Return the keys of a scene of kind contact of one contact: grid, bodies, shape and load."""
        hertz = contact.hertz(self.modulus)
        half = contact.half_width(self._patch_modulus)
        if contact.length is not None:
            side = 4 * half
            return {
                "grid": {"shape": [128, 32], "lengths": [side, side / 4], "periodic": [False, True]},
                **bodies,
                "shape": {"kind": "cylinder", "radius": contact.radius},
                "contact": {"load": contact.load / contact.length * side / 4},
            }
        return {
            "grid": {"shape": 128, "lengths": [3 * semi for semi in hertz.semi_axes]},  # type: ignore[union-attr]
            **bodies,
            "shape": {"kind": "ellipsoid", "radius": contact.radius, "radius_y": contact.across},
            "contact": {"load": contact.load},
        }


def _slice_words(contact: ElementContact) -> list[str]:
    """Return the load of a scene of an unevenly loaded roller in words; none of other contacts."""
    if contact.load < EVEN * contact.carried:
        return []
    return [
        f"the load {with_unit(contact.load, 'N')} is that of its most loaded slice on the whole length; the roller "
        f"carries {with_unit(contact.carried, 'N')}"
    ]


def rpm(speed: float) -> float:
    """Return a speed of rotation [rad/s] in revolutions per minute."""
    return speed * 30 / math.pi


def csv_text(columns: Mapping[str, Sequence[float | str]]) -> str:
    """Return columns of one length as comma-separated text, numbers to the last digit."""
    sink = io.StringIO()
    writer = csv.writer(sink, lineterminator="\n")
    writer.writerow(columns)
    rows = zip(*columns.values(), strict=True)
    writer.writerows([one if isinstance(one, str) else repr(float(one)) for one in row] for row in rows)
    return sink.getvalue()


def load_element(source: str | Path | Mapping[str, Any]) -> Element:
    """Return an element from its TOML file, or from a table.

    Raises
    ------
    InputError : one message per mistake.
    """
    table = dict(source) if isinstance(source, Mapping) else read_element(source)
    kind = str(table.get("element"))
    if table.get("element") is None and "kind" in table:
        raise InputError(
            f"{table.get('name')}: a scene of kind {show(table['kind'])}, not a machine element. Use `bem plan` and "
            "`bem run`."
        )
    if kind in NOT_MODELLED:
        raise InputError(f'element = "{kind}": {NOT_MODELLED[kind]}')
    if kind not in MODELS:
        listed = ", ".join(f'"{name}"' for name in MODELS)
        if table.get("element") is None:
            raise InputError(f"element: missing; allowed: {listed}")
        found = show(table["element"])
        raise InputError(f"element = {found}: not allowed{nearest(kind, MODELS)}; allowed: {listed}")
    if isinstance(table.get("oil"), Mapping):
        table["oil"] = with_temperature(with_pressure_viscosity(table["oil"]), table)
    try:
        return Element(validate(table, MODELS[kind]), table)
    except InputError as error:  # what is wrong with the whole is said of the element
        unusual = notes_on_bare_numbers(MODELS[kind], table)
        raise InputError([*unusual, *(_of_element(kind, text) for text in error.messages)]) from None


@contextmanager
def unusual_values_named(element: Element) -> Iterator[None]:
    """Say first which values of the file are outside their usual range where films of the element are refused.

    Raises
    ------
    InputError : the one that is raised within, with the notes on unusual values before it.
    """
    try:
        yield
    except InputError as error:
        raise InputError([*notes_on_table(element.model), *error.messages]) from None


def _of_element(kind: str, message: str) -> str:
    """Return the message on a mistake in an element's file in its words, which are made for scenes."""
    key = message.partition(":")[0]
    if key.lower() in _ROUGHNESS and "unknown key" in message:
        return (
            f'{key}: unknown key; write rms_roughness = "500 nm" of both surfaces together, sqrt(Sq1^2 + Sq2^2), Sq '
            "about 1.25 Ra"
        )
    if key.startswith("profile =") and kind == "rolling-bearing":
        return f"{message} (logarithmic: crowned or profiled rollers, whose ends fall away; straight: sharp ends)"
    return re.sub("^scene:", f"{kind}:", message).replace("at the top of the scene", "at the top of the file")


def read_element(path: str | Path) -> dict[str, Any]:
    """Return the table of an element's TOML file, under the file's name where it says none.

    Raises
    ------
    InputError : a file that cannot be read.
    """
    try:
        table = parse_toml(read_small(path).decode("utf-8-sig"))
    except FileNotFoundError:
        raise InputError(
            f"File {path} not found. `bem new rolling-bearing {path}`, or another element, writes one to start from."
        ) from None
    except (OSError, ValueError) as error:
        raise InputError(f"element {show(str(path))}: cannot be read ({error})") from None
    table.setdefault("name", Path(path).stem)
    return table


def element_template(name: str) -> str:
    """Return a commented file of an element, to start from.

    Raises
    ------
    InputError : none of that name, and why.
    """
    word = name.strip().lower().replace("_", "-").replace(" ", "-")
    word = ALIASES.get(word, word)
    if word in NOT_MODELLED:
        raise InputError(NOT_MODELLED[word])
    if word not in MODELS:
        raise InputError(f'"{name}": no machine element{nearest(word, MODELS)}; allowed: {", ".join(MODELS)}')
    return without_description((resources.files("bem.elements") / "templates" / f"{word}.toml").read_text("utf-8"))


def degrees(contact: ElementContact, unit: str) -> str:
    """Return the place of a contact in degrees or millimetres, for people."""
    return f"{math.degrees(contact.place):.1f} deg" if unit == "rad" else f"{1e3 * contact.place:.4g} mm"
