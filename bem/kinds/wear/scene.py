"""Kind `wear`: wear particles and running-in of a cylinder on a flat in boundary lubrication (thesis, paper C).

A case is one load, one variant and one pair of surfaces; sizes are means over the settled cycles.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Literal

import numpy as np
from pydantic import model_validator

from bem.grid import Grid
from bem.kinds.wear.tables import CyclesScene, CylinderScene, DomainScene, WearVariantScene
from bem.scenes import build, pieces, sources, wearing
from bem.scenes.axes import Axis, changed, listed, variants
from bem.scenes.common import BodyScene, Repetitions, SceneModel, problem
from bem.scenes.keys import key
from bem.scenes.records import Figure
from bem.scenes.tables.wear_model import WearScenePart
from bem.wear.criterion import StressCriterion

if TYPE_CHECKING:
    from bem.scenes.checks.hertz import SmoothContact


class WearScene(SceneModel):
    """A rough cylinder slides on a rough flat; what yields and reaches the surface leaves."""

    kind: Literal["wear"] = key("Kind of computation.", "basic", default="wear")
    lower: BodyScene = key("Lower body, on which friction acts along +x.", "basic")
    upper: BodyScene = key("Upper body, the cylinder; smooth without [upper.surface].", "basic")
    cylinder: CylinderScene = key("Cylinder, loads and friction.", "basic")
    domain: DomainScene = key("The slice of the contact that is computed.", "basic")
    depths: wearing.WearDepthsScene = key("Depths at which stresses are computed.", "basic")
    wear: WearScenePart = key(
        "Wear model: detachment criterion or wear law, and how material leaves.", "basic", default=WearScenePart()
    )
    cycles: CyclesScene = key(
        "Wear cycles. One cycle: contact solved, particles removed by wear.criterion (by default where the von Mises "
        "stress exceeds the yield stress), surfaces shifted by wear.shift (3 cells).",
        "basic",
        default=CyclesScene(),
    )
    sizes: pieces.SizesScene = key("Statistics of the wear particle sizes.", "advanced", default=pieces.SizesScene())
    archard: pieces.WearRateScene | None = key(
        "Measured wear rate, which turns mean particle sizes into a number of particles; it wears nothing.",
        "advanced",
        default=None,
    )
    variants: list[WearVariantScene] = key(
        "Cases with other mesh, roughness, film or wear model, compared in one result.", "advanced", default=[]
    )
    repetitions: Repetitions = key(
        "Number of runs with other random surfaces, for means and standard deviations.", "advanced", default=1
    )

    def cited_methods(self) -> Iterator[Mapping[str, str]]:
        """See `SceneModel`."""
        yield from super().cited_methods()
        if isinstance(self.wear.finds_particles, StressCriterion):
            yield sources.STRESSES

    @model_validator(mode="after")
    def _flat_needs_lengths(self) -> WearScene:
        if self.cylinder.radius == 0 and self.domain.lengths is None:
            raise problem("half_widths for a flat", "domain.lengths where cylinder.radius is 0")
        return self

    def smooth_contact(self, lengths: tuple[float, float] | None = None) -> SmoothContact | None:
        """Hertz contact of the substrates under the smallest of the loads; the domain's `lengths` have no say in it."""
        from bem.scenes.checks.hertz import smooth_contact

        cylinder, loads = self.cylinder, self.cylinder.forces(build.modulus_of(self))
        radii = (cylinder.radius or np.inf, np.inf)
        return smooth_contact(self.lower.build(), self.upper.build(), radii, load=min(loads) / cylinder.width)


def resolve(scene: WearScene) -> WearScene:
    """Fill in the loads of Hertz pressures, and the softer surface's hardness."""
    loads = scene.cylinder.forces(build.modulus_of(scene))
    cylinder = scene.cylinder.model_copy(update={"loads": loads, "hertz_pressures": None})
    return build.with_hardness(changed(scene, "cylinder", cylinder), table="cylinder", needed=False)


def axes(scene: WearScene) -> tuple[Axis, ...]:
    """Loads, then variants."""
    return (
        listed(scene, "cylinder.loads", "load", Figure("N", "load on the full width")),
        variants(scene),
    )


def slice_of(scene: WearScene) -> tuple[Grid, float]:
    """The grid of a case and its load [N]."""
    return scene.domain.at(scene.cylinder, build.modulus_of(scene))
