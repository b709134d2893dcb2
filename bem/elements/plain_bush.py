"""A plain bush: a shaft that turns or swings in a fixed bush under a load of fixed direction, dry or lubricated.

The contact is `bem.contact.shaft_in_bush`; films and scenes are of the equivalent cylinder on a flat, whose gap is that
of shaft and bush near the load line. A bush with a wall is bonded to its housing, and a layer on it in dry scenes. In
films it is the half-space on which a cylinder makes a contact of the same width, which is exact for a thick wall and
for one that vanishes. Wear follows Archard with the whole load and takes off the bush alone. Thermal expansion, which
may close the clearance of a polymer bush and is said where it may, its creep and its softening with temperature are
left out. Verified in tests/elements/test_plain_bush.py.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from functools import cached_property
from typing import Annotated, Any, ClassVar, Literal, Self

from pydantic import Field, TypeAdapter, ValidationError, model_validator

from bem.contact.shaft_in_bush import ShaftContact, ShaftInBush, solve_shaft_in_bush
from bem.elements.bush_polymers import DRY_FRICTION, SERVICE_TEMPERATURE, SourcedValue
from bem.elements.contact import ElementContact
from bem.elements.model import Contacts, ElementModel
from bem.lubrication.oils.catalogue import find_oil
from bem.materials import CATALOGUE, Material
from bem.notes import Note
from bem.notes.elements import BUSH_CONFORMS, BUSH_LEAKS, BUSH_SWINGS, GLYCOL_ASSUMED
from bem.physical_constants import ROOM_TEMPERATURE
from bem.quantities import with_unit
from bem.scenes.common import MaterialScene, PositiveLength, Table, problem
from bem.scenes.oil import OilScene
from bem.scenes.units import Angle, Dimension, Force, Rate, Ratio, RotationSpeed, Temperature

HOUSING = "steel-52100"
"""Material around a wall where none is given; any metal is nearly rigid beside a polymer."""
TRANSFER, AREA_FACTOR = 15.0, 15.0
"""Without a conductance heat leaves by 15 W/(m^2 K) through 15 times diameter times length: still air around a small
bearing block, the lower ends of the usual ranges 15 to 20 of both (DIN 31652, from memory, not checked)."""
FAR_FROM_CYLINDER = 0.05
"""Deviation of the equivalent cylinder's peak pressure from that of shaft and bush above which it is said."""
LONG = 5.0
"""Length over the width of the contact below which leakage at the ends is said: our choice, as no film of finite length
was solved. What leaks is of the order of the square of width over length."""
LARGEST_WEAR_RATE = 1e-10
"""Wear rate [m^2/N], 0.1 mm^3/(N m), beyond which the unit is missing; worn-out bushes have 1e-3 mm^3/(N m)."""
GLYCOL = 3e-9
"""Pressure-viscosity coefficient of water-glycol [1/Pa] where none is given, not measured by this program's sources.

Films of polyglycol solutions in rolling point contacts were about a third of those of mineral oils of their viscosity
(G. T. Y. Wan, P. Kenny & H. A. Spikes, Tribology International 17 (1984) 309; abstract read, pages not checked), and
thicknesses go with the power 0.49 to 0.54 of the coefficient: an eighth of 22 1/GPa. Up to 6 1/GPa is quoted, too.
"""
POLYMER = 20e9
"""Young's modulus [Pa] below which a bush is taken for a polymer; unfilled ones have up to 5 GPa, soft metals 15."""
WATERY = 4000.0
"""Heat capacity [J/(kg K)] from which a liquid is taken for water; glycol and water have up to 3900."""
PressureVelocity = Annotated[float, Dimension("W/m^2", "a pressure times a speed", "0.2 MPa*m/s")]


class OscillationScene(Table):
    """A shaft that swings: `amplitude` to either side of the middle, so many times per second."""

    amplitude: Annotated[Angle, Field(gt=0)]
    frequency: Annotated[Rate, Field(gt=0)]


class PlainBushModel(ElementModel):
    """A shaft in a bush. Body 1 is the shaft, body 2 the bush.

    `clearance`: bore less shaft diameter; `bore` may stand in place of either. `wall`: thickness of the bush; without
    it the material of the bush has no end. `housing`: material around a bush with a wall, steel without it. `speed` or
    `oscillation`. `friction`: coefficient of the whole bush; without it that of `DRY_FRICTION`, or with an oil that of
    film and asperities. `correlation_length`: of the ground shaft; `lay`: grooves around the shaft or along its axis.
    `pv_limit`: highest mean pressure times sliding speed. `maximum_temperature`: of the bush. `permitted_wear`: depth
    at the load line at which the bush is worn out.
    """

    OTHER_KEYS: ClassVar = ("bore",)
    UNUSED_KEYS: ClassVar = ("permissible_film_ratio",)

    element: Literal["plain-bush"] = "plain-bush"
    shaft_diameter: PositiveLength
    clearance: PositiveLength
    length: PositiveLength
    wall: PositiveLength | None = None
    housing: MaterialScene | None = None
    radial_load: Annotated[Force, Field(gt=0)]
    speed: Annotated[RotationSpeed, Field(gt=0)] | None = None
    oscillation: OscillationScene | None = None
    friction: Annotated[Ratio, Field(gt=0, lt=2)] | None = None
    lay: Literal["around", "axial"] = "around"
    pv_limit: Annotated[PressureVelocity, Field(gt=0)] | None = None
    maximum_temperature: Temperature | None = None
    permitted_wear: PositiveLength | None = None

    @model_validator(mode="before")
    @classmethod
    def _from_bore(cls, data: Any) -> Any:
        if not isinstance(data, dict) or data.get("bore") is None:
            return data
        table = {key: value for key, value in data.items() if key != "bore"}
        given = [key for key in ("shaft_diameter", "clearance") if data.get(key) is not None]
        if len(given) != 1:
            raise problem(
                f"bore beside {'both' if given else 'neither'} of shaft_diameter and clearance",
                "two of bore, shaft_diameter and clearance",
            )
        length = TypeAdapter(PositiveLength)
        try:
            bore, other = (length.validate_python(data[key]) for key in ("bore", given[0]))
        except ValidationError:
            return table | {"clearance": data["bore"]} if given[0] == "shaft_diameter" else table
        if not bore > other:
            raise problem(f"bore is not above {given[0]}", "bore = shaft_diameter + clearance")
        return table | {"clearance" if given[0] == "shaft_diameter" else "shaft_diameter": bore - other}

    @model_validator(mode="after")
    def _one_temperature(self) -> Self:  # in place of the check that a heat balance has an oil: dry bushes have none
        if self.bulk_temperature is not None and self.heat_balance is not None:
            raise problem("bulk_temperature and heat_balance are given", "one of both: the balance gives the other")
        return self

    @model_validator(mode="after")
    def _fits(self) -> Self:
        if (self.speed is None) == (self.oscillation is None):
            both = self.speed is not None
            raise problem(f"{'both' if both else 'neither'} of speed and oscillation given", "one of them")
        shaft, bush = self.first.build(), self.second.build()
        if shaft.youngs_modulus < POLYMER <= bush.youngs_modulus:
            raise problem(
                f"first (shaft, {shaft.name}) is softer than second (bush, {bush.name}), which is the body that wears",
                "the polymer as second: swap first and second",
            )
        if not self.clearance < 0.1 * self.shaft_diameter:
            most = with_unit(0.1 * self.shaft_diameter, "m")
            raise problem(
                "clearance is above a tenth of the shaft diameter", f"below {most} (bore less shaft diameter)"
            )
        if self.wall is not None and not self.wall >= 0.01 * self.shaft_diameter:
            least = f"{math.ceil(1e4 * self.shaft_diameter)} um"
            raise problem(
                "wall is below 1 % of the shaft diameter",
                f"at least {least}; for the pressure of a thinner lining write the scene of that wall "
                "(bem element FILE --scene lining.toml --kind contact) and set upper.layer.thickness in it",
            )
        if self.housing is not None and self.wall is None:
            raise problem("housing without wall", "wall beside housing")
        rate = self.specific_wear_rate
        if rate is not None and rate > LARGEST_WEAR_RATE:
            raise problem(
                f"specific_wear_rate {rate:g} m^2/N is ten decades or so beyond that of any bush",
                f'a unit beside the number, such as "{rate:g} mm^3/(N*m)"',
            )
        if self.wall is not None and (self.permitted_wear or 0.0) >= self.wall:
            raise problem("permitted_wear is not below the wall", "a worn depth that leaves some wall")
        return self

    @property
    def sliding_speed(self) -> float:
        """Speed of sliding, of a swinging shaft its mean over time [m/s]."""
        radius = 0.5 * self.shaft_diameter
        if self.oscillation is None:
            assert self.speed is not None
            return radius * self.speed
        return radius * 4 * self.oscillation.amplitude * self.oscillation.frequency

    @property
    def line_load(self) -> float:
        """Load per length [N/m]."""
        return self.radial_load / self.length

    @property
    def mean_pressure(self) -> float:
        """Load over diameter and length [Pa]."""
        return self.line_load / self.shaft_diameter

    @property
    def radial_clearance(self) -> float:
        """Difference of the radii [m]."""
        return 0.5 * self.clearance

    @cached_property
    def bodies(self) -> ShaftInBush:
        """Shaft and bush, as the contact takes them."""
        return ShaftInBush(
            self.first.build(), self.second.build(), 0.5 * (self.shaft_diameter + self.clearance),
            self.radial_clearance, self.wall, None if self.wall is None else self.housing_material,
        )  # fmt: skip

    @property
    def housing_material(self) -> Material:
        """Material around the wall."""
        return CATALOGUE[HOUSING].material if self.housing is None else self.housing.build()

    @cached_property
    def cylinder(self) -> ShaftContact:
        """Contact of the equivalent cylinder on a flat, of which films and scenes are."""
        return solve_shaft_in_bush(self.bodies.cylinder, self.line_load)

    @cached_property
    def shaft_contact(self) -> ShaftContact:
        """Contact of shaft and bush under the load."""
        return solve_shaft_in_bush(self.bodies, self.line_load)

    @property
    def service_temperature(self) -> float | None:
        """Highest temperature of the bush [K], given or of its material; None where neither is known."""
        known = SERVICE_TEMPERATURE.get(self.second.build().name)
        return self.maximum_temperature or (None if known is None else known.value)

    @property
    def balanced(self) -> bool:
        """True if the bulk temperature is that of a heat balance, which `Element.at_bulk` puts in its place."""
        return self.bulk_temperature is not None and self.heat_balance is not None

    @property
    def dry_friction(self) -> SourcedValue | None:
        """Friction coefficient of the dry bush; None of a material that has none."""
        return DRY_FRICTION.get(self.second.build().name)

    @cached_property
    def liquid_limits(self) -> tuple[float, float, float] | None:
        """Temperatures [K] at which the liquid freezes, from which its water evaporates, and at which it boils.

        None where they are not known. A liquid of given viscosity is water from a heat capacity of `WATERY` on.
        """
        liquid = None if self.oil is None else self.oil.oil
        if liquid is None and self.oil is not None and (self.oil.heat_capacity or 0.0) >= WATERY:
            liquid = find_oil("water")
        if liquid is None or liquid.boiling_point is None or liquid.freezing_point is None:
            return None
        return liquid.freezing_point, liquid.largest_service or liquid.boiling_point, liquid.boiling_point

    @property
    def film_temperature(self) -> float | None:
        """Temperature of the liquid in the film [K], within those at which it is one."""
        found = super().film_temperature
        if found is None or self.liquid_limits is None:
            return found
        return min(max(found, self.liquid_limits[0]), self.liquid_limits[2])

    def closing_expansion(self, temperature: float) -> float | None:
        """Return the linear expansion coefficient [1/K] that closes the clearance at a bush temperature [K].

        None of a bush without a wall, of a metal, and of one that is not warmer than `ROOM_TEMPERATURE`, at which the
        clearance is taken to be that of the file.

        The wall from the radius a to b is held at b, in a housing that does not expand, and along its axis; its bore
        moves inward by (1 + nu) alpha dT a (b^2 - a^2) / ((1 - 2 nu) b^2 + a^2) (Lame's cylinder in plane strain,
        derived here), of a thin wall of thickness t by (1 + nu)/(1 - nu) alpha dT t.
        """
        bush = self.second.build()
        if self.wall is None or bush.youngs_modulus > POLYMER or temperature <= ROOM_TEMPERATURE:
            return None
        ratio, bore = bush.poissons_ratio, self.bodies.radius
        outer = bore + self.wall
        moved = (1 + ratio) * bore * (outer**2 - bore**2) / ((1 - 2 * ratio) * outer**2 + bore**2)
        return self.radial_clearance / (moved * (temperature - ROOM_TEMPERATURE))

    @property
    def surroundings(self) -> float:
        """Temperature to which the heat flows [K]."""
        if self.heat_balance is not None and self.heat_balance.ambient is not None:
            return self.heat_balance.ambient
        return ROOM_TEMPERATURE if self.oil is None or self.oil.temperature is None else self.oil.temperature

    @property
    def conductance(self) -> float:
        """Heat conductance to the surroundings, given or usual [W/K]."""
        if self.heat_balance is not None and self.heat_balance.conductance is not None:
            return self.heat_balance.conductance
        return TRANSFER * AREA_FACTOR * self.shaft_diameter * self.length

    @property
    def conductance_known(self) -> bool:
        """Return True unless the bush's temperature hangs on the usual conductance."""
        given = self.heat_balance is not None and self.heat_balance.conductance is not None
        return given or (self.bulk_temperature is not None and not self.balanced)

    def contact(self) -> ElementContact:
        """The equivalent cylinder at the load line."""
        radii = (0.5 * self.shaft_diameter, -0.5 * (self.shaft_diameter + self.clearance))
        return ElementContact("load line", 0.0, self.radial_load, radii, (self.sliding_speed, 0.0), length=self.length)

    @property
    def film_modulus(self) -> float:
        """Contact modulus [Pa] with which a plain cylinder is as wide as the equivalent one, under its layer or not."""
        half_width = self.cylinder.half_angle * self.bodies.cylinder.radius
        return 4 * self.line_load * self.bodies.equivalent_radius / (math.pi * half_width**2)

    def cylinder_deviation(self) -> tuple[float, float]:
        """Return the relative deviations of the equivalent cylinder's peak pressure and width from the bush's."""
        width = self.cylinder.half_angle * self.bodies.cylinder.radius / self.bodies.radius
        pressure = self.cylinder.maximum_pressure / self.shaft_contact.maximum_pressure
        return pressure - 1, width / self.shaft_contact.half_angle - 1

    def contacts(self) -> Contacts:
        """Return the one contact, at the load line."""
        return Contacts((self.contact(),), "angle", "rad", self._notes())

    def _notes(self) -> tuple[Note, ...]:
        notes = []
        pressure, width = self.cylinder_deviation()
        if self.oil is not None and abs(pressure) > FAR_FROM_CYLINDER:
            angle = math.degrees(self.shaft_contact.half_angle)
            notes.append(BUSH_CONFORMS(angle=angle, pressure=pressure, width=width))
        slender = self.length / (2 * self.cylinder.half_angle * self.bodies.cylinder.radius)
        if self.oil is not None and slender < LONG:
            notes.append(BUSH_LEAKS(ratio=slender))
        if has_assumed_coefficient(self.oil):
            change = math.expm1(GLYCOL * self.shaft_contact.maximum_pressure)
            notes.append(GLYCOL_ASSUMED(change=change, reason="bush"))
        if self.oscillation is not None and self.oil is not None:
            notes.append(BUSH_SWINGS())
        return tuple(notes)


def has_assumed_coefficient(oil: OilScene | None) -> bool:
    """Return True if an oil is a water-glycol with the coefficient `GLYCOL`."""
    return oil is not None and oil.grade is not None and oil.pressure_viscosity == GLYCOL


def with_pressure_viscosity(oil: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a table of an oil, of water-glycol with `GLYCOL` where it has no pressure-viscosity coefficient.

    The pressures of bushes raise its viscosity by a few per cent at most. Films of rolling contacts have thicknesses
    that go with its power 0.54 (Dowson and Higginson).
    """
    glycol = str(oil.get("grade", "")).lower().startswith("water-glycol")
    if not glycol or oil.get("pressure_viscosity") is not None:
        return oil
    return {**oil, "pressure_viscosity": GLYCOL}


def with_temperature(oil: Mapping[str, Any], bush: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a table of an element's oil, where it has none with the bodies' temperature or that of the surroundings.

    `bush` is the table of the element. Film and friction follow these, so that the oil needs no temperature of its own.
    A given viscosity keeps none.
    """
    if oil.get("temperature") is not None or oil.get("viscosity") is not None:
        return oil
    balance = bush.get("heat_balance")
    around = balance.get("ambient") if isinstance(balance, Mapping) else None
    warm = bush.get("bulk_temperature") if bush.get("bulk_temperature") is not None else around
    return oil if warm is None else {**oil, "temperature": warm}


WORN_IN = 4 / math.pi
"""Peak pressure of a bush that is worn far beyond its clearance, over the mean pressure F/(d L): p is as the cosine of
the angle, as the depth is that a sinking shaft takes off."""


def crescent_distance(depth: float, *, radius: float, clearance: float) -> float:
    """Return the sliding distance to a worn depth times wear rate and load per length, for rigid bodies [m^2].

    A shaft whose radius is smaller by the clearance c sinks by h beyond it and touches up to a = arccos(c/(c + h)) on
    either side. Archard's law at every angle, k p ds = cos(angle) dh, and the balance of the load give
    k W ds = R (a + sin a cos a) dh, whose integral is R [(c + h) a - c sin a]. Derived here.
    """
    angle = math.acos(clearance / (clearance + depth))
    return radius * ((clearance + depth) * angle - clearance * math.sin(angle))


def worn_out_depth(model: PlainBushModel) -> tuple[float, str]:
    """Return the depth [m] at which a bush is worn out, and its name: permitted, the clearance, or a thinner wall."""
    if model.permitted_wear is not None:
        return model.permitted_wear, "permitted_wear"
    if model.wall is not None and model.wall < model.clearance:
        return model.wall, "wall"
    return model.clearance, "clearance"


def sliding_to_depth(model: PlainBushModel, depth: float) -> float:
    """Return the sliding distance to a worn depth at the load line [m], an estimate on the safe side.

    It is the larger of the distance under the peak pressure of the new bush, and of that of rigid bodies, whose contact
    is narrower than that of elastic ones. A PEEK bush worn step by step lasts 0 to 16 % longer.
    """
    rate = model.specific_wear_rate
    assert rate is not None
    new = depth / (rate * model.shaft_contact.maximum_pressure)
    rigid = crescent_distance(depth, radius=model.bodies.radius, clearance=model.radial_clearance)
    return max(new, rigid / (rate * model.line_load))
