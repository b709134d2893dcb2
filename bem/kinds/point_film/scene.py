"""Kind `point-film`: the film of a ball or barrel on a flat in steady motion: smooth, or rough at rest or by waves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal

from pydantic import model_validator

from bem.grid import Grid
from bem.kinds.point_film.touching import TouchingScene, check_touching
from bem.kinds.point_film.waves import PointFilmCellsScene, check_point_waves
from bem.scenes import build, sources
from bem.scenes.common import BodyScene, OutputsScene, PositiveLength, SceneModel
from bem.scenes.keys import key
from bem.scenes.oil import OilScene
from bem.scenes.tables.ball import BallRollingScene, BallScene
from bem.scenes.tables.passing import PatchScene
from bem.scenes.tables.supply import SupplyScene, check_layer


class PointFilmScene(SceneModel):
    """A ball or barrel on a flat with oil between them, in steady motion. `roughness`: rms height of both surfaces
    together, taken smooth, for the lambda ratio. Or one of the bodies is rough (its `surface`, on a `patch`) and stands
    still, and `contact` says how they touch where the film is no more; or both are rough and move, and
    `film.roughness = "waves"` follows the waves of their roughness."""

    kind: Literal["point-film"] = key("Kind of computation.", "basic", default="point-film")
    lower: BodyScene = key("Lower body, the flat.", "basic")
    upper: BodyScene = key("Upper body, the ball.", "basic")
    ball: BallScene = key("Ball or barrel, and its load.", "basic")
    oil: OilScene = key("Lubricant.", "basic")
    rolling: BallRollingScene = key("Surface speeds of both bodies.", "basic")
    roughness: PositiveLength | None = key(
        "Combined rms roughness Sq of both surfaces, for the lambda ratio.", "basic", default=None, example="50 nm"
    )
    film: PointFilmCellsScene = key(
        "Mesh of the oil film, and how roughness enters it.", "basic", default=PointFilmCellsScene()
    )
    supply: SupplyScene | None = key(
        "Oil supply of a starved contact; without it the inlet is flooded.", "advanced", default=None
    )
    patch: PatchScene | None = key("Grid of the rough patch; needed where a body is rough.", "advanced", default=None)
    contact: TouchingScene | None = key("Asperity contact; needed where a body is rough.", "advanced", default=None)
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )

    @model_validator(mode="after")
    def _together(self) -> PointFilmScene:
        (check_point_waves if self.by_waves else check_touching)(self)
        self.oil.check_point_film()
        check_layer(self.supply, self.rolling)
        return self

    def cited_methods(self) -> Iterator[Mapping[str, str]]:
        """See `SceneModel`."""
        yield from super().cited_methods()
        if self.by_waves:
            yield sources.WAVES

    @property
    def by_waves(self) -> bool:
        """Return True if the waves of the roughness are followed through the film of smooth bodies."""
        return self.film.roughness == "waves"


def patch_grid(scene: PointFilmScene) -> Grid:
    """Grid of the patch of a rough body."""
    assert scene.patch is not None
    return build.grid_of(build.resolved_grid(scene.patch, scene.lower.surface, scene.upper.surface))
