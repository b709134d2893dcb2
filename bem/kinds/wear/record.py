"""Record of a case of kind `wear`."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any, ClassVar

from bem.grid import FloatArray
from bem.kinds.wear.scene import WearScene, slice_of
from bem.scenes import pieces, wearing
from bem.scenes.records import Figure, Series, grid_map
from bem.scenes.third_bodies import THIRD_BODIES

SETTLED = "mean over the last cycles.settled cycles"
"""Window of means, which are taken even if the surface still changes."""
_STRIP = (
    "of the wearing body, the lower one of two, in the contact region "
    "(rows in contact in the last cycle; on a body that moves its whole track)"
)
_over, _map = partial(Series, ("cycle",)), partial(grid_map, of="last")


@dataclass(frozen=True, eq=False, kw_only=True)
class WearRecord(pieces.MeanSizes, pieces.ParticleTable, wearing.WornRecord):
    """Results of a wear loop: means over its settled cycles, tables over cycles and particles, the worn surface."""

    scatters: ClassVar[tuple[str, ...]] = (
        *pieces.MeanSizes.scatters,
        *("Sq_initial", "Sq_final", "contact_area_fraction", "mean_contact_pressure", "worn_volume_per_cycle"),
        *("first_cycles_radius", "criterion_wear_rate"),
    )
    particles_per_cycle: Annotated[
        float | None,
        Figure("", f"particles per cycle of one body, {SETTLED}", headline=True, no_bar=pieces.FOLLOWS_CELL),
    ]
    Sq_initial: Annotated[float, Figure("nm", f"Sq {_STRIP}, unworn", headline=True)]
    Sq_final: Annotated[float, Figure("nm", f"Sq {_STRIP}, after the last cycle", headline=True)]
    worn_depth: Annotated[float, Figure("nm", f"mean depth worn {_STRIP}")]
    contact_area_fraction: Annotated[
        float, Figure("", f"real contact area over that of the slice, {SETTLED}", headline=True)
    ]
    mean_contact_pressure: Annotated[float, Figure("Pa", f"mean pressure over the real contact area, {SETTLED}")]
    worn_volume_per_cycle: Annotated[
        float, Figure("um3", f"volume worn per cycle, with the cuts of third bodies in both bodies, {SETTLED}")
    ]
    first_cycles_radius: Annotated[
        float, Figure("nm", "volume-mean radius of the particles of the first five cycles", chance=pieces.OF_PIECES)
    ]
    step_error: Annotated[
        float | None,
        Figure(
            "nm",
            "what its step leaves open of a depth worn by pressure, last cycle",
            optional=True,
            headline=True,
            unjudged=True,
        ),
    ]
    criterion_wear_rate: Annotated[
        float | None,
        Figure(
            "mm3_Nm",
            f"volume that leaves (criterion and cuts of third bodies) by load and distance, {SETTLED}",
            headline=True,
        ),
    ]
    cycles: Annotated[int, Figure("", "cycles", headline=True, unjudged=True)]
    cell: Annotated[float, Figure("nm", "root of the cell's area", unjudged=True)]
    contact_seconds: Annotated[float, Figure("", "seconds in contacts", unjudged=True)]
    stress_seconds: Annotated[float, Figure("", "seconds in stresses", unjudged=True)]
    particles_seconds: Annotated[float, Figure("", "seconds in pieces", unjudged=True)]
    depths_computed_per_cycle: Annotated[
        float, Figure("", "depths at which stress was computed, per cycle", unjudged=True)
    ]
    wear_volume: Annotated[
        float | None, Figure("mm3", "worn volume by the wear rate of table archard", optional=True, unjudged=True)
    ] = None
    particle_number: Annotated[
        float | None, Figure("", "number of particles in it", optional=True, no_bar=pieces.FOLLOWS_CELL)
    ] = None
    particles_per_mm_and_N: Annotated[
        float | None, Figure("", "particles per mm and N", optional=True, no_bar=pieces.FOLLOWS_CELL)
    ] = None
    third_body_friction: Annotated[
        float | None, Figure("", "friction coefficient with rolling particles", optional=True, no_bar=THIRD_BODIES)
    ] = None
    radius: Annotated[FloatArray, _over("m", "volume-mean equivalent radius of the particles")]
    particles: Annotated[FloatArray, _over("1", f"particles per cycle of one body{wearing.STRETCHES}")]
    volume: Annotated[FloatArray, _over("m^3", "volume worn per cycle, with the cuts of third bodies in both bodies")]
    contact_area: Annotated[FloatArray, _over("m^2", "contact area")]
    plastic_area: Annotated[FloatArray, _over("m^2", "area at the hardness")]
    contact_load: Annotated[FloatArray, _over("N", "load carried by asperities")]
    rms_height: Annotated[
        FloatArray, _over("m", "rms height Sq of the worn surface in the rows in contact in each cycle")
    ]
    depths_computed: Annotated[FloatArray, _over("1", "depths at which stress was computed")]
    convolutions: Annotated[FloatArray, _over("1", "convolutions of the contact solve")]
    particle_cycle: Annotated[wearing.IntArray, pieces.particle_rows("1", "cycle in which a particle came off")]
    particle_body: Annotated[wearing.IntArray, pieces.particle_rows("1", "body that it came off: 0 lower, 1 upper")]
    x: Annotated[FloatArray, Series(("x",), "m", "x, along sliding", of="last")]
    y: Annotated[FloatArray, Series(("y",), "m", "y", of="last")]
    height_before: Annotated[FloatArray, _map("m", "height of the wearing body in its own rows, unworn")]
    height_after: Annotated[FloatArray, _map("m", "height of the wearing body in its own rows, run in")]
    pressure: Annotated[FloatArray, _map("Pa", "contact pressure in the last cycle")]
    removed: Annotated[FloatArray | None, _map("m", "what the criterion took from the body in the last cycle")]


def summarise(scene: WearScene, axes: Any, records: Any) -> dict[str, Any]:
    """Summarise what the means are of."""
    told = {"reported_mean": scene.sizes.report, "smallest_radius_nm": 1e9 * scene.sizes.smallest}
    return told | pieces.particles_of(scene)


def scattering(scene: WearScene) -> tuple[str, ...]:
    """Figures that follow the mesh under the source's criterion, where they converge."""
    return pieces.scattering(WearRecord, scene, slice_of(scene)[0])
