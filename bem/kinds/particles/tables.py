"""A map of particles, how it is separated, and what is asked of them: tables of the kind particles."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from bem.scenes.common import Cells, PositiveLength, Table
from bem.scenes.pieces import WearRateScene
from bem.scenes.units import Density, Force, Length, Ratio, Time, Viscosity


class SyntheticMapScene(Table):
    """A made-up map with a known distribution of sizes, to try things out; see `bem.particles.synthetic_afm_map`."""

    shape: tuple[Cells, Cells] = (1024, 1024)
    lengths: tuple[PositiveLength, PositiveLength] = (20e-6, 20e-6)
    count: Annotated[int, Field(strict=True, ge=1, le=100_000)] = 120
    number_mean_radius: PositiveLength = 175e-9
    volume_mean_radius: PositiveLength = 358e-9


class SeparationScene(Table):
    """How a map is turned into particles; see `bem.particles_from_height_map`."""

    threshold: PositiveLength = 50e-9
    background: Literal["plane", "curvature", "offset", "none"] = "plane"
    level_lines: bool = Field(default=False, strict=True)
    separate: Annotated[Ratio, Field(ge=0, lt=1)] | None = None
    border: Literal["exclude", "include"] = "exclude"
    rectangle: Literal["axis_aligned", "minimum_area"] = "axis_aligned"
    smallest_radius: Annotated[Length, Field(ge=0)] = 0.0


class ArchardScene(WearRateScene):
    """Specific wear rate, load and sliding distance: how many particles that makes."""

    load: Annotated[Force, Field(gt=0)]


class SedimentationScene(Table):
    """A centrifuge run: how long until particles of a radius have settled."""

    distance: PositiveLength
    viscosity: Annotated[Viscosity, Field(gt=0)]
    relative_centrifugal_force: Annotated[Ratio, Field(gt=0)]
    particle_density: Annotated[Density, Field(gt=0)]
    liquid_density: Annotated[Density, Field(ge=0)]
    particle_radius: PositiveLength
    available: Annotated[Time, Field(gt=0)] | None = None

    def figures(self) -> dict[str, Any]:
        """Time that particles take to settle [s], and whether there is so much, where that is known."""
        from bem.particles import sedimentation_time

        needed = sedimentation_time(**self.model_dump(exclude={"available"}))
        return {
            "sedimentation_time": needed,
            "sedimented": None if self.available is None else needed <= self.available,
        }
