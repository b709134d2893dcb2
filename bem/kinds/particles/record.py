"""Record of a case of kind `particles`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from bem.grid import FloatArray
from bem.scenes.pieces import ParticleTable, particle_rows
from bem.scenes.records import Figure, Series

_FEW_DECIDE = "the few largest particles decide it: it does not settle before there are thousands"


@dataclass(frozen=True, eq=False, kw_only=True)
class ParticlesRecord(ParticleTable):
    """The particles of a map."""

    count: Annotated[int, Figure("", "particles", headline=True)]
    number_mean_radius: Annotated[float, Figure("nm", "equivalent radius, mean by number", headline=True)]
    number_std_radius: Annotated[float, Figure("nm", "its standard deviation by number")]
    area_mean_radius: Annotated[float, Figure("nm", "equivalent radius, mean by area", headline=True)]
    area_std_radius: Annotated[float, Figure("nm", "its standard deviation by area", no_bar=_FEW_DECIDE)]
    volume_mean_radius: Annotated[float, Figure("nm", "equivalent radius, mean by volume", headline=True)]
    volume_std_radius: Annotated[float, Figure("nm", "its standard deviation by volume", no_bar=_FEW_DECIDE)]
    scattering_mean_radius: Annotated[
        float,
        Figure("nm", "equivalent radius, z-average of light scattering (sum R^6 / sum R^5)", no_bar=_FEW_DECIDE),
    ]
    length: Annotated[float, Figure("nm", "mean length by number", headline=True)]
    width: Annotated[float, Figure("nm", "mean width by number", headline=True)]
    thickness: Annotated[float, Figure("nm", "mean thickness by number", headline=True)]
    threshold: Annotated[float, Figure("nm", "height above the plate from which there is a particle")]
    width_over_thickness: Annotated[float | None, Figure("", "mean of width over thickness", optional=True)] = None
    wear_volume: Annotated[float | None, Figure("mm3", "worn volume by Archard's law", optional=True)] = None
    particle_number: Annotated[float | None, Figure("", "number of particles in it", optional=True)] = None
    particles_per_mm_and_N: Annotated[
        float | None, Figure("", "particles per mm and N", optional=True, headline=True)
    ] = None
    sedimentation_time: Annotated[
        float | None, Figure("h", "time until they have settled", optional=True, headline=True)
    ] = None
    sedimented: Annotated[bool | None, Figure("", "whether that time is available", optional=True)] = None
    x: Annotated[FloatArray, Series(("x",), "m", "x")]
    y: Annotated[FloatArray, Series(("y",), "m", "y")]
    level_height: Annotated[FloatArray, Series(("x", "y"), "m", "height above the plate")]
    particle_equivalent_radius: Annotated[FloatArray, particle_rows("m", "equivalent radius of a particle")]
