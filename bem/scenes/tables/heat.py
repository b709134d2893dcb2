"""How the surfaces of a rubbing contact move and how warm the bodies are: the table of the kind surface-temperature."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from pydantic import Field

from bem.grid import Grid
from bem.scenes import build
from bem.scenes.common import Table
from bem.scenes.tables.pressing import PressedScene
from bem.scenes.units import Speed, Temperature

if TYPE_CHECKING:
    from bem.accuracy import RubbingCase

BulkTemperature = Annotated[Temperature, Field(ge=150, le=2000)]
ROOM = 293.15


class RubbingHeatScene(Table):
    """Speeds of the surfaces over the contact, along x, and temperatures far below them."""

    lower_speed: Speed
    upper_speed: Speed = 0.0
    lower_bulk: BulkTemperature = ROOM
    upper_bulk: BulkTemperature = ROOM


class RubbingScene(PressedScene):
    """A contact whose friction makes heat; all of it enters the lower body where the upper one has no material."""

    heat: RubbingHeatScene

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
