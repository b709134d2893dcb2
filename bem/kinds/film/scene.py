"""Kind `film`: the film of a smooth line contact in time: start and stop, reciprocating sliding, changing load."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from bem.kinds.film.tables import FilmCylinderScene, MarchScene, MotionScene
from bem.scenes.common import BodyScene, OutputsScene, SceneModel, UpperBodyScene, check_smooth, problem
from bem.scenes.keys import key
from bem.scenes.oil import OilScene
from bem.scenes.tables.supply import SupplyScene


class FilmScene(SceneModel):
    """A smooth cylinder on a flat with oil between them, in time."""

    kind: Literal["film"] = key("Kind of computation.", "basic", default="film")
    lower: BodyScene = key("Lower body, the flat; it moves and must be smooth.", "basic")
    upper: UpperBodyScene = key(
        "Upper body, the cylinder; without a material it is rigid.", "basic", default=UpperBodyScene()
    )
    cylinder: FilmCylinderScene = key("Cylinder and load.", "basic")
    oil: OilScene = key("Lubricant.", "basic")
    motion: MotionScene = key("Speed of the flat over time.", "basic")
    march: MarchScene = key("Duration and time steps.", "basic")
    supply: SupplyScene | None = key(
        "Oil supply of a starved contact; without it the inlet is flooded.", "advanced", default=None
    )
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )

    @model_validator(mode="after")
    def _smooth(self) -> FilmScene:
        check_smooth(
            self,
            'smooth surfaces; of steady motion kind = "traction" with film.roughness = "waves" has the ripples of '
            'rough ones, and kind = "friction" their share of the load',
        )
        if self.motion.at(0.0) == 0 and self.march.initial_thickness is None:
            raise problem("the motion starts from rest, where no steady film exists", "march.initial_thickness")
        if self.supply is not None and self.supply.layer is None:
            raise problem("supply.distance: in time the meniscus moves", "supply.layer")
        if self.supply is not None and self.march.cavitation != "mass_conserving":
            raise problem(
                f'a supply of oil with march.cavitation "{self.march.cavitation}", which forgets oil',
                'march.cavitation = "mass_conserving"',
            )
        return self
