"""Pieces that come off, or lie on a map: the record of their sizes, which mean of them is reported and which of the
means converge, how many Archard's law makes of them.

Knows tables, records and what criteria say of themselves; statistics are `bem.particles`. Verified in
tests/scenes/test_wear_kind.py and tests/accuracy/test_wear_bars.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from bem.grid import FloatArray, Grid
from bem.scenes.common import BODIES, PositiveLength, Table
from bem.scenes.keys import key
from bem.scenes.records import Figure, Record, Series, without_bars
from bem.scenes.units import Length, WearCoefficient
from bem.wear.setup import LOWER, UPPER, wearing_bodies

if TYPE_CHECKING:
    from bem.wear import RunningIn

QUANTITIES = ("equivalent_radius", "length", "width", "thickness")


class WearRateScene(Table):
    """Measured wear rate: its volume over the mean particle volume is the number of particles; it wears nothing."""

    specific_wear_rate: Annotated[WearCoefficient, Field(gt=0)] = key(
        "Measured specific wear rate k: worn volume per load and sliding distance.", "basic"
    )
    distance: PositiveLength = key("Sliding distance.", "basic", example="100 m")

    def figures(self, load: float, mean_particle_volume: float) -> dict[str, float]:
        """Figures of a record about the particles, for a load [N] and particles of a mean volume [m^3]."""
        from bem.particles import archard_wear

        wear = archard_wear(self.specific_wear_rate, load, self.distance, mean_particle_volume)
        values = (wear.volume, wear.number, 1e-3 * wear.coefficient)
        return dict(zip(ARCHARD_FIGURES, values, strict=True))


ARCHARD_FIGURES = ("wear_volume", "particle_number", "particles_per_mm_and_N")


class SizesScene(Table):
    """Statistics of the wear particle sizes."""

    report: Literal["number", "area", "volume", "number_above"] = key(
        "Mean that is reported as the particle size: by number, area or volume, or number above smallest.",
        "advanced",
        default="volume",
        reason="volume, because it converges with the grid",
    )
    smallest: Annotated[Length, Field(ge=0)] = key(
        "Equivalent radius below which particles are left out of the mean number_above.", "advanced", default=25e-9
    )
    particles_of: Literal["wearing", "lower", "upper"] = key(
        "Body whose particles are reported.", "advanced", default="wearing"
    )

    def particles(self, result: RunningIn) -> NDArray[np.void]:
        """The particles that are reported of a wear loop."""
        return result.particles[result.particles["body"] == self.body(result.wearing)]

    def body(self, wearing: Sequence[int]) -> int:
        """Index of the body whose they are, of those that wear; the first of these where none is named."""
        return {"wearing": wearing[0], "lower": LOWER, "upper": UPPER}[self.particles_of]


def particles_of(scene: Any) -> dict[str, str]:
    """For summaries, the body whose particles are reported; nothing where cases may differ in it (`over`)."""
    if scene.over is not None:
        return {}
    wearing = wearing_bodies((scene.lower.build(), scene.upper.build()), scene.wear.wears)
    return {"particles_of": BODIES[scene.sizes.body(wearing)]}


particle_rows = partial(Series, ("particle",), rows=True)
"""A column of the table of particles."""


@dataclass(frozen=True, eq=False, kw_only=True)
class ParticleTable(Record):
    """Size and place of every particle."""

    particle_volume: Annotated[FloatArray, particle_rows("m^3", "volume of a particle")]
    particle_length: Annotated[FloatArray, particle_rows("m", "length of a particle's bounding rectangle")]
    particle_width: Annotated[FloatArray, particle_rows("m", "width of a particle's bounding rectangle")]
    particle_thickness: Annotated[FloatArray, particle_rows("m", "largest thickness of a particle")]
    particle_x: Annotated[FloatArray, particle_rows("m", "x of a particle's centre")]
    particle_y: Annotated[FloatArray, particle_rows("m", "y of a particle's centre")]


OF_PIECES = "which pieces leave first decides the sizes of those that follow, and repetitions narrow that, no cells"


def _reported(quantity: str) -> Figure:
    return Figure(
        "nm",
        f"{quantity} of the particles, the reported mean",
        name=f"particle_{quantity.replace(' ', '_')}",
        headline=True,
        chance=OF_PIECES,
    )


FOLLOWS_CELL = "it follows the mesh, or was not shown to converge with it: many pieces may be only a few cells wide"
"""Reason why a mean by number, and a count, has no error bar."""


FEW_LARGEST = "the few largest pieces decide it: light scattering weights a radius R with its sixth power"
"""Reason why a mean by light scattering has no error bar."""


def _by(weight: str, quantity: str) -> Figure:
    follows = "number" in weight
    return Figure(
        "nm",
        f"{quantity} of the particles, mean {weight}",
        no_bar=FOLLOWS_CELL if follows else "",
        chance="" if follows else OF_PIECES,
    )


@dataclass(frozen=True, eq=False)
class MeanSizes(Record):
    """Mean sizes of the settled particles: the reported one, by number, area, volume, and number above a size; and the
    radius that dynamic light scattering would report."""

    scatters: ClassVar[tuple[str, ...]] = (
        *(f"{weight}_{quantity}" for weight in ("reported", "area_mean", "volume_mean") for quantity in QUANTITIES),
    )
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
    scattering_mean_equivalent_radius: Annotated[
        float,
        Figure(
            "nm",
            "equivalent radius of the particles, z-average of light scattering (sum R^6 / sum R^5)",
            no_bar=FEW_LARGEST,
        ),
    ]
    number_above_mean_equivalent_radius: Annotated[float, _by("by number above the smallest", "equivalent radius")]
    number_above_mean_length: Annotated[float, _by("by number above the smallest", "length")]
    number_above_mean_width: Annotated[float, _by("by number above the smallest", "width")]
    number_above_mean_thickness: Annotated[float, _by("by number above the smallest", "thickness")]


def mean_sizes(particles: NDArray[np.void], sizes: SizesScene) -> dict[str, Any]:
    """The fields of `MeanSizes` [m] of a table of particles."""
    statistics = size_statistics(particles, sizes.smallest)
    reported = {f"reported_{quantity}": statistics[sizes.report][quantity] for quantity in QUANTITIES}
    reported["scattering_mean_equivalent_radius"] = statistics.pop("scattering")["equivalent_radius"]
    return reported | {
        f"{weight}_mean_{quantity}": value
        for weight, values in statistics.items()
        for quantity, value in values.items()
    }


def sizes_converge(scene: Any, grid: Grid) -> bool:
    """Return True if sizes by number were found to converge under the scene's criterion, on cells as small as a
    case's."""
    bodies, law = (scene.lower.build(), scene.upper.build()), scene.wear.finds_particles
    wearing = (bodies[body].surface_material for body in wearing_bodies(bodies, scene.wear.wears))
    return law.sizes_converge and all(law.resolved(material, grid) for material in wearing)


def sizes_without_bars(scene: Any, grid: Grid) -> dict[str, None]:
    """The reported sizes, where the mean that is reported follows the mesh."""
    follows = "number" in scene.sizes.report and not sizes_converge(scene, grid)
    return dict.fromkeys(f"reported_{quantity}" for quantity in QUANTITIES) if follows else {}


def scattering(record: type[Record], scene: Any, grid: Grid) -> tuple[str, ...]:
    """Figures of a record that follow the mesh under the source's criterion, where under the scene's they converge."""
    return tuple(without_bars(record)) if sizes_converge(scene, grid) else ()


def mean_radii(particles: NDArray[np.void], sizes: SizesScene, *names: str) -> dict[str, float]:
    """Mean equivalent radii [m] under four names: the reported one, by number, volume and scattering; 0 of none."""
    if not particles.size:
        return dict.fromkeys(names, 0.0)
    statistics = size_statistics(particles, sizes.smallest)
    weights = (sizes.report, "number", "volume", "scattering")
    return {name: statistics[weight]["equivalent_radius"] for name, weight in zip(names, weights, strict=True)}


def size_statistics(particles: NDArray[np.void], smallest: float) -> dict[str, dict[str, float]]:
    """Means of radius, length, width and thickness [m] by every weight, and by number above a size."""
    from bem.particles import particle_statistics
    from bem.particles.statistics import WEIGHTS

    statistics = {weight: particle_statistics(particles, weight=weight) for weight in WEIGHTS}
    statistics["number_above"] = particle_statistics(particles, smallest_radius=smallest)
    return {
        name: {quantity: getattr(each, f"mean_{quantity}") for quantity in QUANTITIES}
        for name, each in statistics.items()
    }
