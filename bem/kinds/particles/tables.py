"""A map of particles, how it is separated, and what is asked of them: tables of the kind particles."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field

from bem.scenes.common import Cells, PositiveLength, Table
from bem.scenes.keys import key
from bem.scenes.pieces import WearRateScene
from bem.scenes.units import Density, Force, Length, Ratio, Time, Viscosity


class SyntheticMapScene(Table):
    """Synthetic height map with particles of known sizes, to try the method."""

    shape: tuple[Cells, Cells] = key("Number of points of the map along x and y.", "basic", default=(1024, 1024))
    lengths: tuple[PositiveLength, PositiveLength] = key("Side lengths of the map.", "basic", default=(20e-6, 20e-6))
    count: Annotated[int, Field(strict=True, ge=1, le=100_000)] = key("Number of particles.", "basic", default=120)
    number_mean_radius: PositiveLength = key("Mean radius of the particles by number.", "advanced", default=175e-9)
    volume_mean_radius: PositiveLength = key("Mean radius of the particles by volume.", "advanced", default=358e-9)


class SeparationScene(Table):
    """Method that finds particles in the height map."""

    threshold: PositiveLength = key(
        "Height above the plate from which on a point belongs to a particle.", "basic", default=50e-9
    )
    background: Literal["plane", "curvature", "offset", "none"] = key(
        "Form removal of the plate: mean plane, second-order surface, offset or nothing.", "advanced", default="plane"
    )
    level_lines: bool = key("Level each scan line first.", "advanced", default=False, strict=True)
    separate: Annotated[Ratio, Field(ge=0, lt=1)] | None = key(
        "Depth of the saddle between touching particles, as a fraction of the summit, from which on they count as two.",
        "advanced",
        default=None,
        reason="touching particles count as one",
        example=0.1,
    )
    border: Literal["exclude", "include"] = key(
        "Particles cut by the edge of the map: exclude or include.", "advanced", default="exclude"
    )
    rectangle: Literal["axis_aligned", "minimum_area"] = key(
        "Rectangle that gives length and width: along the axes, or the smallest one.",
        "advanced",
        default="axis_aligned",
    )
    smallest_radius: Annotated[Length, Field(ge=0)] = key(
        "Equivalent radius below which particles are left out.", "advanced", default=0.0
    )


class ArchardScene(WearRateScene):
    """Archard's wear law, which gives the number of particles."""

    load: Annotated[Force, Field(gt=0)] = key("Normal load.", "basic")


class SedimentationScene(Table):
    """Centrifuge run: the time until particles of a radius have settled."""

    distance: PositiveLength = key("Sedimentation distance.", "basic", example="90 mm")
    viscosity: Annotated[Viscosity, Field(gt=0)] = key("Dynamic viscosity of the liquid.", "basic", example="55 mPa*s")
    relative_centrifugal_force: Annotated[Ratio, Field(gt=0)] = key(
        "Relative centrifugal force, in multiples of gravity.", "basic", example=10000
    )
    particle_density: Annotated[Density, Field(gt=0)] = key("Density of the particles.", "basic", example="7900 kg/m^3")
    liquid_density: Annotated[Density, Field(ge=0)] = key("Density of the liquid.", "basic", example="800 kg/m^3")
    particle_radius: PositiveLength = key("Smallest particle radius that must settle.", "basic", example="25 nm")
    available: Annotated[Time, Field(gt=0)] | None = key(
        "Time in the centrifuge, compared with the sedimentation time.", "advanced", default=None, example="15 hour"
    )

    def figures(self) -> dict[str, Any]:
        """Time that particles take to settle [s], and whether there is so much, where that is known."""
        from bem.particles import sedimentation_time

        needed = sedimentation_time(**self.model_dump(exclude={"available"}))
        return {
            "sedimentation_time": needed,
            "sedimented": None if self.available is None else needed <= self.available,
        }
