"""Kind `surface-temperature`: how hot rubbing makes the surfaces of two bodies in contact, rough or smooth."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from bem.scenes.keys import key
from bem.scenes.tables.bush import BushScene, check_equivalent
from bem.scenes.tables.heat import RubbingScene


class SurfaceTemperatureScene(RubbingScene):
    """Two bodies, a load, and speeds."""

    kind: Literal["surface-temperature"] = key("Kind of computation.", "basic", default="surface-temperature")
    bush: BushScene | None = key(
        "Bush of which the cylinder is the equivalent: its bore and clearance confirm the radius.",
        "expert",
        default=None,
    )

    @model_validator(mode="after")
    def _equivalent(self) -> SurfaceTemperatureScene:
        check_equivalent(self.bush, self.shape.radius if self.shape.kind == "cylinder" else None, "shape.radius")
        return self
