"""Kind `running-in`: the wear cycle in mixed lubrication, load shared between film and rough contact (thesis, paper D).

A case is one wear loop: one hardness, one speed, one pair of surfaces. Initial friction is that of the first cycle,
run-in friction the mean of the last ones.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Literal

from pydantic import model_validator

from bem.scenes import build, pieces, sources, wearing
from bem.scenes.axes import Axis, changed
from bem.scenes.common import PositivePressure, Repetitions
from bem.scenes.keys import key
from bem.scenes.records import (
    Figure,
)
from bem.scenes.tables.bush import BushScene, check_equivalent
from bem.scenes.tables.sharing import OneLoadScene, RunningInCycles, WearingSharing
from bem.scenes.tables.wear_model import WearScenePart
from bem.wear.criterion import StressCriterion


class RunningInScene(OneLoadScene):
    """A rough cylinder, ball or ellipsoid slides on a rough flat in oil; what yields and reaches the surface leaves."""

    kind: Literal["running-in"] = key("Kind of computation.", "basic", default="running-in")
    depths: wearing.WearDepthsScene = key("Depths at which stresses are computed.", "basic")
    wear: WearScenePart = key(
        "Wear model: detachment criterion or wear law, and how material leaves.", "basic", default=WearScenePart()
    )
    cycles: RunningInCycles = key("Number of wear cycles.", "basic", default=RunningInCycles())
    sharing: WearingSharing = key("Load sharing between oil film and asperities.", "advanced", default=WearingSharing())
    sizes: pieces.SizesScene = key("Statistics of the wear particle sizes.", "advanced", default=pieces.SizesScene())
    hardnesses: list[PositivePressure] = key(
        "Hardnesses of the lower body, one result for each.", "advanced", default=[], example=["1 GPa", "2 GPa"]
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
        if isinstance(self.wear.finds_particles, StressCriterion):
            yield sources.STRESSES

    @model_validator(mode="after")
    def _equivalent(self) -> RunningInScene:
        point = self.contact.point_radii is not None
        check_equivalent(self.bush, None if point else self.contact.radius, "contact.radius")
        return self


def resolve(scene: RunningInScene) -> RunningInScene:
    """Fill in the grid and the softer surface's hardness."""
    scene = build.with_grid(scene)
    return scene if scene.hardnesses else build.with_hardness(scene, needed=True)


def axes(scene: RunningInScene) -> tuple[Axis, ...]:
    """Hardnesses, then speeds."""
    given = scene.hardnesses
    caps = tuple(scene.with_hardness(h).contact.hardness for h in given) if given else (scene.contact.hardness,)

    def at(scene: RunningInScene, i: int) -> RunningInScene:
        return changed(scene.with_hardness(given[i]), "hardnesses", []) if given else scene

    return (Axis("hardness", caps, Figure("Pa", "hardness of the softer body"), at), scene.speed_axis())
