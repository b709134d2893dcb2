"""Kind `friction`: load sharing between oil film and rough contact over speed, the Stribeck curve (thesis, paper A).

A case is one curve: one load, one surface, one contact model; each speed starts from the solution of the one before.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal

from pydantic import model_validator

from bem.kinds.friction.patch import with_patch
from bem.kinds.friction.waves import FrictionFilmScene, check_flattening
from bem.scenes import build, sources
from bem.scenes.axes import Axis, listed, variants
from bem.scenes.common import LineGridScene, OutputsScene, Repetitions
from bem.scenes.keys import key
from bem.scenes.records import Figure
from bem.scenes.tables.bush import BushScene, check_equivalent
from bem.scenes.tables.sharing import CurveScene, SurfaceVariant


class FrictionScene(CurveScene):
    """A rough cylinder, ball or ellipsoid on a rough flat with oil between them, at many speeds."""

    kind: Literal["friction"] = key("Kind of computation.", "basic", default="friction")
    film: FrictionFilmScene = key(
        "Mesh of the oil film, and whether it flattens the roughness.", "expert", default=FrictionFilmScene()
    )
    grid: LineGridScene = key(
        "Mesh of the rough contact; larger than the Hertz contact, or a periodic patch that repeats under it. Leave it "
        "out for a cylinder: the roughness decides.",
        "basic",
        default=LineGridScene(),
    )
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )
    variants: list[SurfaceVariant] = key(
        "Cases with other roughness of the lower surface, compared in one result.", "advanced", default=[]
    )
    repetitions: Repetitions = key(
        "Number of runs with other random surfaces, for means and standard deviations.", "advanced", default=1
    )
    bush: BushScene | None = key(
        "Bush of which the cylinder is the equivalent: films too thick for its clearance are noted.",
        "expert",
        default=None,
    )

    def cited_methods(self) -> Iterator[Mapping[str, str]]:
        """See `SceneModel`."""
        yield from super().cited_methods()
        if self.by_waves:
            yield sources.WAVES

    @model_validator(mode="after")
    def _equivalent(self) -> FrictionScene:
        point = self.contact.point_radii is not None
        check_equivalent(self.bush, None if point else self.contact.radius, "contact.radius")
        return self

    @model_validator(mode="after")
    def _flattened(self) -> FrictionScene:
        if self.by_waves:
            check_flattening(self)
        return self

    @property
    def by_waves(self) -> bool:
        """Return True if the film flattens the roughness before the surfaces touch."""
        return self.film.roughness == "waves"


def resolve(scene: FrictionScene) -> FrictionScene:
    """Fill in the grid and the softer surface's hardness."""
    scene = build.with_grid(with_patch(scene))
    return build.with_hardness(scene, needed=True) if scene.capped else scene


def axes(scene: FrictionScene) -> tuple[Axis, ...]:
    """Loads, then variants of the surface, then models."""
    return (
        scene.load_axis(),
        variants(scene, always=True),
        listed(scene, "sharing.models", "model", Figure("", "contact model")),
    )
