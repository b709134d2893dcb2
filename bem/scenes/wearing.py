"""What the kinds with wear share: depths, the wear model's parts, how sizes of particles are reported."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from bem.grid import FloatArray, Grid
from bem.scenes.common import PositiveLength, Table
from bem.scenes.laws import LawKey
from bem.scenes.planner import Step, convolution_memory, padded_points, stress_kernel_seconds
from bem.scenes.records import Figure, Record, Series
from bem.scenes.units import Length
from bem.wear.criterion import VonMises, WearCriterion
from bem.wear.removal import Cap, RemovalLaw

Count = Annotated[int, Field(strict=True, ge=1)]
IntArray = NDArray[np.int_]
_QUANTITIES = ("equivalent_radius", "length", "width", "thickness")


class WearDepthsScene(Table):
    """Equally spaced depths: `first`, `first + spacing`, ..."""

    count: Annotated[int, Field(strict=True, ge=2, le=1024)] = 64
    spacing: PositiveLength
    first: Annotated[Length, Field(ge=0)] = 0.0

    def build(self) -> NDArray[np.float64]:
        """Depths [m]."""
        return self.first + self.spacing * np.arange(self.count, dtype=np.float64)


class WearScenePart(Table):
    """The replaceable parts of the wear model; see `bem.wear.WearModel`."""

    criterion: Annotated[WearCriterion, LawKey("criterion")] = VonMises()
    stress_range: bool = Field(default=False, strict=True)
    refine: Annotated[int, Field(strict=True, ge=1, le=100)] = 10
    refinement: Literal["monotone_cubic", "linear", "exact"] = "monotone_cubic"
    connectivity: Literal[6, 18, 26] = 6
    removal: Annotated[RemovalLaw, LawKey("removal")] = Cap()
    wears: Literal["softer", "lower", "upper", "both"] = "softer"
    shift: Annotated[int, Field(strict=True, ge=-10_000, le=10_000)] = 3
    within_layer: bool = Field(default=True, strict=True)


def cycle_steps(
    grid: Grid, cycles: int, depths: int, deepest: int, convolutions: int, contacts: str
) -> tuple[Step, Step, Step]:
    """Contact, stresses and pieces of a case of so many cycles.

    depths : computed in a usual cycle; deepest : in the first ones. convolutions : of the contacts of a cycle.
    contacts : what is solved, in words.
    """
    points = padded_points(grid.shape, grid.periodic)
    return (
        Step(
            "contact",
            f"{cycles} cycles a case, {contacts}",
            transforms=2.0 * convolutions * cycles,
            points=points,
            memory=convolution_memory(grid.shape, grid.periodic),
        ),
        Step(
            "stresses",
            "from the surface down to the first depth at which nothing yields",
            transforms=7.0 * depths * cycles,
            points=points,
            seconds=stress_kernel_seconds(grid.cells, deepest),
            memory=8.0 * (points / 4 * 12 * deepest + grid.cells * (deepest + 8)),
        ),
        Step("pieces", "runs of yielded voxels along depth", seconds=0.004 * cycles, memory=8.0 * grid.cells * 8),
    )


class SizesScene(Table):
    """How particle sizes are reported.

    `report` names the mean that stands as `particle_equivalent_radius_nm`; `smallest` is the equivalent radius under
    which particles are left out of the means "above".
    """

    report: Literal["number", "area", "volume", "number_above"] = "volume"
    smallest: Annotated[Length, Field(ge=0)] = 25e-9
    particles_of: Literal["wearing", "lower", "upper"] = "wearing"

    def body(self, wearing: int) -> int:
        """The body whose particles are reported, given the one that wears."""
        return {"wearing": wearing, "lower": 0, "upper": 1}[self.particles_of]


def particle_rows(unit: str, text: str) -> Series:
    """A column of the table of particles."""
    return Series(("particle",), unit, text, rows=True)


def _reported(quantity: str) -> Figure:
    return Figure(
        "nm", f"{quantity} of the particles, the reported mean", name=f"particle_{quantity.replace(' ', '_')}"
    )


def _by(weight: str, quantity: str) -> Figure:
    return Figure("nm", f"{quantity} of the particles, mean {weight}")


@dataclass(frozen=True, eq=False)
class MeanSizes(Record):
    """Mean sizes of the settled particles: the reported one, and by number, area, volume, and number above a size."""

    reported_equivalent_radius: Annotated[float, _reported("equivalent radius")]
    reported_length: Annotated[float, _reported("length")]
    reported_width: Annotated[float, _reported("width")]
    reported_thickness: Annotated[float, _reported("thickness")]
    number_mean_equivalent_radius: Annotated[float, _by("by number", "equivalent radius")]
    number_mean_length: Annotated[float, _by("by number", "length")]
    number_mean_width: Annotated[float, _by("by number", "width")]
    number_mean_thickness: Annotated[float, _by("by number", "thickness")]
    area_mean_equivalent_radius: Annotated[float, _by("by area", "equivalent radius")]
    area_mean_length: Annotated[float, _by("by area", "length")]
    area_mean_width: Annotated[float, _by("by area", "width")]
    area_mean_thickness: Annotated[float, _by("by area", "thickness")]
    volume_mean_equivalent_radius: Annotated[float, _by("by volume", "equivalent radius")]
    volume_mean_length: Annotated[float, _by("by volume", "length")]
    volume_mean_width: Annotated[float, _by("by volume", "width")]
    volume_mean_thickness: Annotated[float, _by("by volume", "thickness")]
    number_above_mean_equivalent_radius: Annotated[float, _by("by number above the smallest", "equivalent radius")]
    number_above_mean_length: Annotated[float, _by("by number above the smallest", "length")]
    number_above_mean_width: Annotated[float, _by("by number above the smallest", "width")]
    number_above_mean_thickness: Annotated[float, _by("by number above the smallest", "thickness")]


def mean_sizes(particles: NDArray[np.void], sizes: SizesScene) -> dict[str, Any]:
    """The fields of `MeanSizes` [m] of a table of particles."""
    statistics = size_statistics(particles, sizes.smallest)
    reported = {f"reported_{quantity}": statistics[sizes.report][quantity] for quantity in _QUANTITIES}
    return reported | {
        f"{weight}_mean_{quantity}": value
        for weight, values in statistics.items()
        for quantity, value in values.items()
    }


def size_statistics(particles: NDArray[np.void], smallest: float) -> dict[str, dict[str, float]]:
    """Means of radius, length, width and thickness [m] by number, area and volume, and by number above a size."""
    from bem.particles import particle_statistics

    statistics = {weight: particle_statistics(particles, weight=weight) for weight in ("number", "area", "volume")}
    statistics["number_above"] = particle_statistics(particles, smallest_radius=smallest)
    return {
        name: {quantity: getattr(each, f"mean_{quantity}") for quantity in _QUANTITIES}
        for name, each in statistics.items()
    }


def volume_mean_radius(volume: FloatArray) -> float:
    """Equivalent radius [m], each particle counted by its volume; 0 of none."""
    total = float(volume.sum())
    return float((volume * np.cbrt(3 * volume / (4 * np.pi))).sum() / total) if total > 0 else 0.0
