"""Kind `surface-temperature`: how hot rubbing makes the surfaces of two bodies in contact, rough or smooth."""

from __future__ import annotations

from typing import Literal

from bem.scenes.keys import key
from bem.scenes.tables.heat import RubbingScene


class SurfaceTemperatureScene(RubbingScene):
    """Two bodies, a load, and speeds."""

    kind: Literal["surface-temperature"] = key("Kind of computation.", "basic", default="surface-temperature")
