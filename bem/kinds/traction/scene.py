"""Kind `traction`: friction of a rolling and sliding line contact, with the heat that it makes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, Literal

from pydantic import model_validator

from bem.kinds.traction.along import AlongScene, with_first_row
from bem.kinds.traction.rolling import FilmPointsScene, RollerScene, RollingScene
from bem.scenes import sources
from bem.scenes.axes import Axis
from bem.scenes.common import BodyScene, OutputsScene, PositiveLength, SceneModel, check_smooth, problem
from bem.scenes.keys import key
from bem.scenes.oil import OilScene
from bem.scenes.records import Figure
from bem.scenes.tables.bush import BushScene
from bem.scenes.tables.heat import HEAT_REASON, check_film_heat, check_supply_of_heat, knows_film_heat
from bem.scenes.tables.passing import PatchScene
from bem.scenes.tables.supply import SupplyScene
from bem.scenes.waves import WHERE, check_waves


class TractionScene(SceneModel):
    """A roller on a flat with oil between them, in steady motion. Bodies are smooth, or rough on a `patch` with
    `film.roughness = "waves"`."""

    kind: Literal["traction"] = key("Kind of computation.", "basic", default="traction")
    lower: BodyScene = key("Lower body, the flat.", "basic")
    upper: BodyScene = key("Upper body, the roller.", "basic")
    roller: RollerScene = key("Roller and load.", "basic")
    oil: OilScene = key("Lubricant.", "basic")
    rolling: RollingScene = key("Surface speeds of both bodies.", "basic")
    thermal: Literal["off", "lumped", "full"] = key(
        "Frictional heat: off (isothermal), lumped (mean film temperature) or full (across the film too).",
        "basic",
        default="lumped",
        reason=HEAT_REASON,
    )
    supply: SupplyScene | None = key(
        "Oil supply of a starved contact; without it the inlet is flooded.", "advanced", default=None
    )
    along: AlongScene | None = key(
        "Contact conditions row by row, such as along a gear's path of contact; each row is a case.",
        "advanced",
        default=None,
    )
    roughness: PositiveLength | None = key(
        "Combined rms roughness Sq of both surfaces, for the lambda ratio.", "basic", default=None, example="0.2 um"
    )
    film: FilmPointsScene = key(
        "Mesh of the oil film, and how roughness enters it.", "basic", default=FilmPointsScene()
    )
    patch: PatchScene | None = key("Grid of the rough patch; needed where a body is rough.", "advanced", default=None)
    bush: BushScene | None = key(
        "Bush of which the cylinder is the equivalent: films too thick for its clearance are noted.",
        "expert",
        default=None,
    )
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )

    @model_validator(mode="before")
    @classmethod
    def _first_row(cls, data: Any) -> Any:
        given = isinstance(data, Mapping) and data.get("along") is not None
        return with_first_row(data) if given else data

    @model_validator(mode="after")
    def _complete(self) -> TractionScene:
        if self.bush is not None and self.along is None:
            self.bush.check_radius(self.roller.radius, "roller.radius")
        elif self.bush is not None:
            raise problem("along beside a table bush", "one of them")
        if self.by_waves:
            check_waves(self)
            if self.along is not None:
                raise problem(f"along with {WHERE}", "one place at a time, or smooth surfaces")
        else:
            check_smooth(self, 'smooth surfaces, film.roughness = "waves", or kind = "friction"')
            if self.patch is not None:
                raise problem("a patch of smooth surfaces", f"no patch, or rough surfaces with {WHERE}")
        if "thermal" not in self.model_fields_set and not knows_film_heat(self.oil, self.lower, self.upper):
            object.__setattr__(self, "thermal", "off")
        if self.thermal == "off":
            return self
        check_supply_of_heat(self.thermal, self.supply)
        check_film_heat(self.oil, self.lower, self.upper)
        return self

    def cited_methods(self) -> Iterator[Mapping[str, str]]:
        """See `SceneModel`."""
        yield from super().cited_methods()
        if self.thermal != "off":
            yield from (sources.HEAT[self.thermal], sources.MOVING_HEAT)
        if self.by_waves:
            yield sources.WAVES

    @property
    def by_waves(self) -> bool:
        """Return True if the waves of the roughness are followed through the smooth film."""
        return self.film.roughness == "waves"


def axes(scene: TractionScene) -> tuple[Axis, ...]:
    """The rows of `along`."""
    if scene.along is None:
        return ()
    places = tuple(float(place) for place in scene.along.position)
    return (Axis("position", places, Figure("m", "place along the way"), _at_row),)


def _at_row(scene: TractionScene, i: int) -> TractionScene:
    """The scene with what one row says."""
    assert scene.along is not None
    radius, load, mean, ratio = scene.along.row(i)
    roller = scene.roller.model_copy(update={"radius": radius, "load": load})
    rolling = scene.rolling.model_copy(update={"mean_speed": mean, "slide_roll_ratio": ratio})
    return scene.model_copy(update={"roller": roller, "rolling": rolling, "along": None})
