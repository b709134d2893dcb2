"""Record of a case of kind `running-in`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Annotated, Any, ClassVar

import numpy as np

from bem.grid import FloatArray
from bem.kinds.running_in.scene import RunningInScene
from bem.scenes import pieces, wearing
from bem.scenes.axes import Axis, over_last
from bem.scenes.records import (
    CONTACT,
    LAMBDA_MIXED,
    LAMBDA_WHOLE,
    MINIMUM_FILM,
    OIL,
    OIL_SCATTER,
    TRACK,
    Figure,
    GridRecord,
    Series,
    without_bars,
)
from bem.scenes.tables.sharing import TEMPERATURES

_over, _shown, _line = (partial(Series, ("cycle",)), partial(Series, ("x", "y"), of="first"), partial(Series, ("x",)))
SETTLED, RUN_IN = (f"mean over the last cycles.{window} cycles" for window in ("settled", "averaged"))
"""Windows of means: `settled` for particles and worn volume, `averaged` for friction, film and contact. Means are taken
even if the surface still changes."""
_STRIP = (
    "of the wearing body, the lower one of two, in the contact region "
    "(Hertz' contact; on a body that moves through it the track, a strip as wide over the whole grid)"
)
_RADIUS = "equivalent radius of the particles of the last cycles.settled cycles"


def _turn(which: str) -> Figure:
    """Figure of the mean friction over a whole turn of the moving roughness."""
    text = f"friction coefficient, mean over the {which} repeat of the moving roughness patch, where two fit"
    return Figure("", text, headline=True, optional=True, unjudged=True)


_heated = partial(Figure, "C", optional=True)


@dataclass(frozen=True, eq=False)
class RunningInRecord(GridRecord, wearing.WornRecord):
    """A lubricated wear loop: friction before and after, particles, histories, the last film and surface."""

    scatters: ClassVar[tuple[str, ...]] = (
        *("friction_initial", "friction_run_in", "friction", "boundary_friction_part", "film_friction_part"),
        *("Sq_initial", "Sq_final", "worn_depth", "wear_volume", "contact_load_initial", "contact_load", "film_load"),
        *("lambda_ratio", "lambda_ratio_mixed"),
        *("minimum_film", "contact_area_fraction", "criterion_wear_rate", *TEMPERATURES),
    )
    friction_initial: Annotated[float, Figure("", "friction coefficient in the first cycle", headline=True)]
    friction_run_in: Annotated[float, Figure("", f"friction coefficient, {RUN_IN}", headline=True)]
    friction_first_turn: Annotated[float | None, _turn("first")] = field(default=None, kw_only=True)
    friction_last_turn: Annotated[float | None, _turn("last")] = field(default=None, kw_only=True)
    contact_region_width: Annotated[
        float | None,
        Figure(
            "um",
            "width of the contact region of Sq and worn depth (along y of a track), where it is not the whole grid",
            optional=True,
            unjudged=True,
        ),
    ] = field(default=None, kw_only=True)
    volume_outside_region: Annotated[
        float,
        Figure("", "share of the volume worn from the body of Sq that lies outside the contact region", unjudged=True),
    ] = field(default=0.0, kw_only=True)
    oil_scatter: Annotated[
        float | None, Figure("", OIL_SCATTER, name=f"friction_run_in{OIL}", optional=True, unjudged=True)
    ] = field(default=None, kw_only=True)
    particle_equivalent_radius: Annotated[
        float,
        Figure(
            "nm",
            f"{_RADIUS}, the mean that sizes.report names",
            headline=True,
            no_bar=pieces.FOLLOWS_CELL,
        ),
    ]
    number_mean_radius: Annotated[
        float,
        Figure(
            "nm", f"{_RADIUS}, mean by number: every particle counts once", headline=True, no_bar=pieces.FOLLOWS_CELL
        ),
    ]
    Sq_initial: Annotated[float, Figure("nm", f"Sq {_STRIP}, unworn", headline=True)]
    Sq_final: Annotated[float, Figure("nm", f"Sq {_STRIP}, after the last cycle", headline=True)]
    contact_load: Annotated[float, Figure("N", f"load carried by asperities, {RUN_IN}", headline=True)]
    film_load: Annotated[float, Figure("N", f"load carried by the film, {RUN_IN}", headline=True)]
    lambda_ratio: Annotated[float, Figure("", f"{LAMBDA_WHOLE}, {RUN_IN}", headline=True)]
    lambda_ratio_mixed: Annotated[float, Figure("", f"{LAMBDA_MIXED}, {RUN_IN}")]
    friction: Annotated[float, Figure("", f"friction coefficient, {RUN_IN}: friction_run_in, beside its parts")]
    boundary_friction_part: Annotated[float, Figure("", f"boundary part of the friction coefficient, {RUN_IN}")]
    film_friction_part: Annotated[float, Figure("", f"film part of the friction coefficient, {RUN_IN}")]
    contact_load_initial: Annotated[float, Figure("N", "load carried by asperities in the first cycle")]
    minimum_film: Annotated[float, Figure("nm", f"{MINIMUM_FILM}, {RUN_IN}")]
    contact_area_fraction: Annotated[float, Figure("", f"real contact area over patch, {RUN_IN}")]
    worn_depth: Annotated[float, Figure("nm", f"mean depth worn {_STRIP}", headline=True)]
    wear_volume: Annotated[
        float,
        Figure("um3", "volume worn in all cycles, of both bodies, with the cuts of third bodies", headline=True),
    ]
    step_error: Annotated[
        float | None,
        Figure("nm", "what its step leaves open of a depth worn by pressure, last cycle", optional=True, unjudged=True),
    ]
    criterion_wear_rate: Annotated[
        float | None,
        Figure(
            "mm3_Nm",
            f"volume that leaves (criterion and cuts of third bodies) by load and distance, {SETTLED}",
            headline=True,
        ),
    ]
    particles_per_cycle: Annotated[
        float | None,
        Figure("", f"particles per cycle of one body, {SETTLED}", headline=True, no_bar=pieces.FOLLOWS_CELL),
    ]
    particles_per_distance: Annotated[
        float | None,
        Figure(
            "per_m",
            f"particles per distance that the surfaces slide, of one body on the grid, {SETTLED}",
            headline=True,
            no_bar=pieces.FOLLOWS_CELL,
            optional=True,
        ),
    ]
    particles_per_volume: Annotated[
        float | None,
        Figure(
            "per_mm3",
            f"particles per volume worn from their body, {SETTLED}: one over their mean volume",
            headline=True,
            no_bar=pieces.FOLLOWS_CELL,
            optional=True,
        ),
    ]
    particles_first_cycle: Annotated[
        float | None, Figure("", "particles of the first cycle, of one body", no_bar=pieces.FOLLOWS_CELL)
    ]
    particles_last_cycles: Annotated[
        float | None,
        Figure(
            "", "number of particles of all of the last cycles.averaged cycles, of one body", no_bar=pieces.FOLLOWS_CELL
        ),
    ]
    film_table_error: Annotated[float, Figure("", "error of the film that is interpolated in the table", unjudged=True)]
    contact_temperature: Annotated[float | None, _heated(f"surfaces in contact, mean by pressure, {RUN_IN}")]
    flash_temperature: Annotated[float | None, _heated(f"surfaces in contact, highest, {RUN_IN}")]
    evaluations_per_cycle: Annotated[float, Figure("", "films per cycle", unjudged=True)]
    volume_mean_radius: Annotated[
        float, Figure("nm", f"{_RADIUS}, mean by volume: large particles count more", no_bar=pieces.FOLLOWS_CELL)
    ]
    scattering_mean_radius: Annotated[
        float, Figure("nm", f"{_RADIUS}, z-average of light scattering (sum R^6 / sum R^5)", no_bar=pieces.FEW_LARGEST)
    ]
    friction_over_cycles: Annotated[FloatArray, _over("1", "friction coefficient")]
    film_load_over_cycles: Annotated[FloatArray, _over("N", "load carried by the film")]
    minimum_film_over_cycles: Annotated[FloatArray, _over("m", MINIMUM_FILM)]
    contact_share: Annotated[FloatArray, _over("1", "asperity load share")]
    Sq_over_cycles: Annotated[
        FloatArray, _over("m", f"Sq {_STRIP}, after each cycle; after the last one it is Sq_final")
    ]
    rms_height_over_cycles: Annotated[
        FloatArray,
        _over(
            "m",
            "Sq of the worn surface in the rows in contact in each cycle; on a body that moves these are other rows in"
            " every cycle",
        ),
    ]
    volume_over_cycles: Annotated[
        FloatArray, _over("m^3", "volume worn per cycle, with the cuts of third bodies in both bodies")
    ]
    particles_over_cycles: Annotated[FloatArray, _over("1", f"particles per cycle of one body{wearing.STRETCHES}")]
    film_thickness_patch: Annotated[FloatArray, _line("m", "film")]
    film_pressure_patch: Annotated[FloatArray, _line("Pa", "film pressure")]
    separation: Annotated[FloatArray, _line("m", "distance of mean planes")]
    height_before: Annotated[FloatArray, _shown("m", "height of the wearing surface, unworn")]
    height_after: Annotated[FloatArray, _shown("m", "height of the wearing surface, run in")]
    pressure: Annotated[FloatArray, _shown("Pa", "contact pressure in the last cycle")]
    frame: Annotated[wearing.IntArray, Series(("frame",), "1", "cycle of the frame", of="first")]
    pressure_frames: Annotated[
        FloatArray, Series(("frame", "x", "y"), "Pa", "contact pressure over the cycles", of="first")
    ]


def summarise(scene: RunningInScene, axes: Sequence[Axis], records: Sequence[RunningInRecord | None]) -> dict[str, Any]:
    """Summarise what is the same for all cases, and the hardness of least friction where several were tried."""
    from bem.wear.mixed_figures import least_friction

    summary: dict[str, Any] = {"cycles": scene.cycles.count, "load_N": scene.load, "reported_mean": scene.sizes.report}
    summary |= {"averaged_cycles": scene.cycles.averaged, "settled_cycles": scene.cycles.settled}
    summary |= {"contact_region": TRACK if wearing.wears_on_a_track(scene) else CONTACT}
    summary |= pieces.particles_of(scene)
    if len(scene.hardnesses) <= 2:
        return summary
    (hardnesses, _, _), friction = over_last(3, axes, [np.nan if r is None else r.friction_run_in for r in records])
    best = least_friction(hardnesses, friction.astype(np.float64))
    inside = best not in (min(scene.hardnesses), max(scene.hardnesses))
    return summary | {"hardness_of_least_friction_Pa": best, "least_friction_inside_range": inside}


def scattering(scene: RunningInScene) -> tuple[str, ...]:
    """Figures of pieces where there are none; that any converge here was shown of no criterion."""
    return () if scene.wear.finds_particles.needs_strength else tuple(without_bars(RunningInRecord))
