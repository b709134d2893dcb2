"""Kind `particles`: sizes of the wear particles in an atomic force microscope's height map (thesis, paper B)."""

from __future__ import annotations

from typing import Literal

from pydantic import field_validator

from bem.kinds.particles.tables import ArchardScene, SedimentationScene, SeparationScene, SyntheticMapScene
from bem.scenes.common import MeasuredSurface, OutputsScene, SceneModel, one_of
from bem.scenes.keys import key
from bem.scenes.table import problem


class ParticlesScene(SceneModel):
    """A height map, and what is wanted of it."""

    kind: Literal["particles"] = key("Kind of computation.", "basic", default="particles")
    map: MeasuredSurface | None = key(
        "Measured height map of dried wear particles; instead of synthetic.", "basic", default=None
    )
    synthetic: SyntheticMapScene | None = key(
        "Synthetic height map with particles of known sizes; instead of map.", "basic", default=None
    )
    separation: SeparationScene = key("Separation of particles in the height map.", "basic", default=SeparationScene())
    archard: ArchardScene | None = key(
        "Archard's wear law, which gives the number of particles.", "basic", default=None
    )
    sedimentation: SedimentationScene | None = key(
        "Centrifuge run: whether small particles had time to settle.", "advanced", default=None
    )
    outputs: OutputsScene = key(
        "Results besides the standard ones: error estimates.", "advanced", default=OutputsScene()
    )

    _one_map = one_of("map", "synthetic")

    @field_validator("map")
    @classmethod
    def _as_measured(cls, table: MeasuredSurface | None) -> MeasuredSurface | None:
        """Refuse keys of a rough surface that would change particles or are left to the table separation."""
        if table is None:
            return None
        if table.detrend == "curvature":
            raise problem('detrend = "curvature" has no effect on particles', 'separation.background = "curvature"')
        if table.mirror != "none":
            raise problem("a mirrored map would count particles twice", 'no mirror, or mirror = "none"')
        if table.rms_height is not None:
            raise problem("rms_height would scale the particles", "no rms_height; heights as measured")
        return table
