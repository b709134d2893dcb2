"""Kind `flow-factors`: how roughness, as deformed in its contact, changes the flow of a film through it."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from bem.kinds.flow_factors.tables import FlowScene, PatchGridScene
from bem.scenes import build
from bem.scenes.common import BodyScene, SceneModel, UpperBodyScene, problem
from bem.scenes.keys import key


class FlowFactorsScene(SceneModel):
    """Two surfaces, one of them rough at least, and separations."""

    kind: Literal["flow-factors"] = key("Kind of computation.", "basic", default="flow-factors")
    grid: PatchGridScene = key("Grid of the rough patch.", "basic", default=PatchGridScene())
    lower: BodyScene = key("Lower body.", "basic")
    upper: UpperBodyScene = key("Upper body; without a material it is rigid.", "basic", default=UpperBodyScene())
    flow: FlowScene = key("Separations of the surfaces, and how their asperities deform.", "basic")

    @model_validator(mode="after")
    def _rough(self) -> FlowFactorsScene:
        if self.lower.surface.kind == "smooth" and self.upper.surface.kind == "smooth":
            raise problem("both surfaces are smooth", "roughness on one of them, lower.surface or upper.surface")
        return self

    def smooth_contact(self, lengths: tuple[float, float] | None = None) -> None:
        """There is none between flat walls; see `bem.scenes.resolutions.CELLS`."""


def resolve(scene: FlowFactorsScene) -> FlowFactorsScene:
    """Fill in the grid where measured surfaces decide it, and the hardness of the softer surface."""
    scene = build.with_grid(scene)
    return build.with_hardness(scene, "flow", needed=True) if scene.flow.behaviour == "capped" else scene
