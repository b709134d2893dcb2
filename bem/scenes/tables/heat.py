"""How the surfaces of a rubbing contact move and how warm the bodies are: the table of the kind surface-temperature."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from bem.scenes.common import Table
from bem.scenes.units import Speed, Temperature

BulkTemperature = Annotated[Temperature, Field(ge=150, le=2000)]
ROOM = 293.15


class RubbingHeatScene(Table):
    """Speeds of the surfaces over the contact, along x, and temperatures far below them."""

    lower_speed: Speed
    upper_speed: Speed = 0.0
    lower_bulk: BulkTemperature = ROOM
    upper_bulk: BulkTemperature = ROOM
