"""Kind `point-film-time`: the film of a ball or barrel in time, with dents, waves and roughness that pass through."""

from __future__ import annotations

from typing import Literal

from pydantic import model_validator

from bem.scenes.common import BodyScene, OutputsScene, SceneModel, problem
from bem.scenes.keys import key
from bem.scenes.oil import OilScene
from bem.scenes.tables.ball import BallRollingScene, BallScene
from bem.scenes.tables.passing import (
    BallMarchScene,
    DentScene,
    OverTimeScene,
    PassingCellsScene,
    PatchScene,
    WavesScene,
)


class PointFilmTimeScene(SceneModel):
    """A ball or barrel on a flat with oil between them, in time: speed and load that change (`over_time`), `dents`,
    `waves` and, on a `patch`, rough surfaces of the bodies, which carry them along."""

    kind: Literal["point-film-time"] = key("Kind of computation.", "basic", default="point-film-time")
    lower: BodyScene = key("Lower body, the flat.", "basic")
    upper: BodyScene = key("Upper body, the ball.", "basic")
    ball: BallScene = key("Ball or barrel, and its load.", "basic")
    oil: OilScene = key("Lubricant.", "basic")
    rolling: BallRollingScene = key("Surface speeds of both bodies.", "basic")
    over_time: OverTimeScene | None = key(
        "Changes of speed and load over time.", "advanced", default=None, reason="both constant"
    )
    dents: tuple[DentScene, ...] = key("Round dents or bumps that pass through the contact.", "basic", default=())
    waves: WavesScene | None = key("Waviness that passes through the contact.", "advanced", default=None)
    patch: PatchScene | None = key("Grid of the rough patch; needed where a body is rough.", "advanced", default=None)
    film: PassingCellsScene = key("Mesh of the oil film.", "basic", default=PassingCellsScene(cells=(64, 64)))
    march: BallMarchScene = key("Duration and time steps.", "basic")
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )

    @model_validator(mode="after")
    def _together(self) -> PointFilmTimeScene:
        rough = self.lower.surface.kind != "smooth" or self.upper.surface.kind != "smooth"
        if rough and self.patch is None:
            raise problem("a rough surface without a patch", "patch, with shape and spacing, or smooth surfaces")
        if self.patch is not None and not rough:
            raise problem("a patch of smooth surfaces", "lower.surface or upper.surface other than smooth, or no patch")
        self.oil.check_point_film()
        if self.factors(0.0)[0] == 0 and self.march.initial_thickness is None:
            raise problem("the motion starts from rest, where no steady film exists", "march.initial_thickness")
        return self

    def factors(self, time: float) -> tuple[float, float]:
        """Return the factors of speed and load at a time [s]."""
        return (1.0, 1.0) if self.over_time is None else self.over_time.factors(time)

    def speeds_at(self, time: float) -> tuple[tuple[float, float], tuple[float, float]]:
        """Return the speeds of flat and ball at a time [m/s]."""
        factor = self.factors(time)[0]
        first, second = self.rolling.speeds
        return (factor * first[0], factor * first[1]), (factor * second[0], factor * second[1])
