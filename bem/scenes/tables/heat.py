"""Motion of the surfaces of a rubbing contact and bulk temperatures: the table of the kind surface-temperature."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from pydantic import Field
from pydantic_core import PydanticCustomError

from bem.friction.setup import HEAT_NEEDS
from bem.grid import Grid
from bem.physical_constants import ROOM_TEMPERATURE
from bem.scenes import build
from bem.scenes.common import BodyScene, Table, problem
from bem.scenes.keys import key
from bem.scenes.oil import OilScene
from bem.scenes.tables.pressing import PressedScene
from bem.scenes.tables.supply import SupplyScene
from bem.scenes.units import Speed, Temperature

if TYPE_CHECKING:
    from bem.accuracy import RubbingCase

BulkTemperature = Annotated[Temperature, Field(ge=150, le=2000)]


class RubbingHeatScene(Table):
    """Surface speeds over the contact along x, and bulk temperatures of both bodies."""

    lower_speed: Speed = key("Surface speed of the lower body over the contact, along x.", "basic")
    upper_speed: Speed = key("Surface speed of the upper body over the contact, along x.", "basic", default=0.0)
    lower_bulk: BulkTemperature = key(
        "Bulk temperature of the lower body, far from the contact.",
        "basic",
        default=ROOM_TEMPERATURE,
        reason="room temperature, 20 degC",
    )
    upper_bulk: BulkTemperature = key(
        "Bulk temperature of the upper body, far from the contact.",
        "basic",
        default=ROOM_TEMPERATURE,
        reason="room temperature, 20 degC",
    )


HEAT_REASON = (
    "lumped, as sliding warms and thins the oil; off where oil or materials have no thermal constants, or the model "
    "of the film has no heat"
)
"""Reason of the default of `thermal`, the same in every kind of scene with a film that may have heat."""


def knows_film_heat(oil: OilScene, lower: BodyScene, upper: BodyScene) -> bool:
    """Return True if oil and bodies have the constants that heat needs."""
    try:
        check_film_heat(oil, lower, upper)
    except PydanticCustomError:
        return False
    return True


def check_film_heat(oil: OilScene, lower: BodyScene, upper: BodyScene) -> None:
    """Refuse heat of an oil or of bodies without the constants that it needs."""
    lubricant = oil.build()
    missing = [key for key in HEAT_NEEDS if getattr(lubricant, key) is None]
    if missing:
        raise problem(
            f"heat of an oil without {', '.join(missing)}",
            'an oil by grade and temperature, those keys of the oil, or thermal = "off"',
        )
    for name, table in (("lower", lower), ("upper", upper)):
        body = table.build()
        if body.layers or None in (body.material.thermal_conductivity, body.material.thermal_diffusivity):
            raise problem(
                f"heat of {name}, which has layers or a material without thermal constants",
                'materials with thermal_conductivity, density and heat_capacity, or thermal = "off"',
            )


def check_supply_of_heat(thermal: str, supply: SupplyScene | None) -> None:
    """Refuse a supply where heat is found along and across the film, which is flooded."""
    if supply is not None and thermal == "full":
        raise problem('a supply of oil with thermal = "full"', 'thermal = "lumped" or "off" with it, or no supply')


class RubbingScene(PressedScene):
    """A contact whose friction makes heat; all of it enters the lower body where the upper one has no material."""

    heat: RubbingHeatScene = key(
        "Surface speeds and bulk temperatures; the heat flux is friction coefficient x pressure x sliding speed.",
        "basic",
    )

    def case(self, grid: Grid) -> RubbingCase:
        """As `bem.accuracy.RubbingCase`."""
        from bem.accuracy import RubbingCase

        bodies, heat, contact = build.bodies_of(self), self.heat, self.contact
        return RubbingCase(
            bodies=bodies,
            speeds=(heat.lower_speed, heat.upper_speed),
            bulk=(heat.lower_bulk, heat.upper_bulk) if isinstance(bodies, tuple) else (heat.lower_bulk,),
            friction=contact.friction,
            asked=contact.prescribed(grid.area) | contact.accuracy(),
        )
