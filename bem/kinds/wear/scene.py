"""Kind `wear`: wear particles and running-in of a cylinder on a flat in boundary lubrication (thesis, paper C).

A case is one load, one variant and one pair of surfaces; sizes are means over the settled cycles.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np
from pydantic import model_validator

from bem.errors import InfeasibleError
from bem.grid import FloatArray, Grid
from bem.kinds.wear.tables import CyclesScene, CylinderScene, DomainScene, WearVariantScene
from bem.scenes import build, pieces, plans, wearing
from bem.scenes.axes import Axis, listed, variants, with_keys
from bem.scenes.common import BodyScene, Repetitions, SceneModel, problem
from bem.scenes.context import Context, error_bars
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, Series, filled, grid_map
from bem.scenes.resolutions import first_domain, of_loop
from bem.scenes.tables.shape import ShapeScene
from bem.scenes.tables.wear_model import WearScenePart
from bem.scenes.third_bodies import THIRD_BODIES, tell_of_third_bodies
from bem.wear.criterion import WearCriterion

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.scenes.checks.hertz import SmoothContact
    from bem.wear import RunningIn

_CONVOLUTIONS = 18  # of one warm-started contact solve, coarse levels included
_SHARING = 7  # contacts until particles that stay have their share of the load
_DEPTHS_NEEDED = 8  # before a depth is met at which nothing yields, on average
_DEPTHS_AT_FIRST = 40  # the same in the first cycle, of sharp asperities


class WearScene(SceneModel):
    """A rough cylinder slides on a rough flat; what yields and reaches the surface leaves."""

    kind: Literal["wear"] = key("Kind of computation.", "basic", default="wear")
    lower: BodyScene = key("Lower body, on which friction acts along +x.", "basic")
    upper: BodyScene = key("Upper body, the cylinder.", "basic")
    cylinder: CylinderScene = key("Cylinder, loads and friction.", "basic")
    domain: DomainScene = key("The slice of the contact that is computed.", "basic")
    depths: wearing.WearDepthsScene = key("Depths at which stresses are computed.", "basic")
    wear: WearScenePart = key(
        "Wear model: detachment criterion or wear law, and how material leaves.", "advanced", default=WearScenePart()
    )
    cycles: CyclesScene = key("Number of wear cycles.", "basic", default=CyclesScene())
    sizes: pieces.SizesScene = key("Statistics of the wear particle sizes.", "advanced", default=pieces.SizesScene())
    archard: pieces.WearRateScene | None = key(
        "Archard's wear law, which gives the number of particles.", "advanced", default=None
    )
    variants: list[WearVariantScene] = key(
        "Cases with other mesh, roughness, film or wear model, compared in one result.", "advanced", default=[]
    )
    repetitions: Repetitions = key(
        "Number of runs with other random surfaces, for means and standard deviations.", "advanced", default=1
    )

    @model_validator(mode="after")
    def _flat_needs_lengths(self) -> WearScene:
        if self.cylinder.radius == 0 and self.domain.lengths is None:
            raise problem("half_widths for a flat", "domain.lengths where cylinder.radius is 0")
        return self

    def smooth_contact(self, lengths: tuple[float, float] | None = None) -> SmoothContact | None:
        """Hertz contact of the substrates under the smallest of the loads; the domain's `lengths` have no say in it."""
        from bem.scenes.checks.hertz import smooth_contact

        cylinder = self.cylinder
        radii = (cylinder.radius or np.inf, np.inf)
        return smooth_contact(self.lower.build(), self.upper.build(), radii, load=min(cylinder.loads) / cylinder.width)


def axes(scene: WearScene) -> tuple[Axis, ...]:
    """Loads, then variants."""
    return (
        listed(scene, "cylinder.loads", "load", Figure("N", "load on the full width")),
        variants(scene),
    )


def plan(scene: WearScene) -> Plan:
    """What will be computed for one case.

    Raises
    ------
    InfeasibleError : a load beyond hardness times the slice's area. InputError : surfaces that cannot be generated.
    """
    grid, load = scene.domain.at(scene.cylinder, build.modulus_of(scene))
    if (scene.cylinder.hardness or np.inf) * grid.area < load:
        raise InfeasibleError(
            f"cylinder.loads: {scene.cylinder.loads[0]:g} N is beyond hardness x area of the domain; allowed: a "
            "smaller load, a larger domain or a higher hardness"
        )
    particles, _ = wearing.between(scene, grid, load)  # what these lack is said before any work
    solves = 1 if particles is None else _SHARING
    depths = {"usual": _DEPTHS_NEEDED, "first": _DEPTHS_AT_FIRST}
    cycles = {"convolutions": solves * _CONVOLUTIONS, "solves": solves, **depths}
    return Plan.of(
        *plans.of_bodies(scene, grid, scene.cylinder.friction, min(scene.depths.count, _DEPTHS_NEEDED)),
        *wearing.cycle_steps(
            scene, grid, contacts="each from the last pressure", friction=scene.cylinder.friction, **cycles
        ),
        Step("kernels of an earlier run", _KERNELS, skipped=True),
        *(
            [Step(f"deeper stresses, down to {scene.depths.count} depths", _DEEPER, skipped=True)]
            if isinstance(scene.wear.criterion, WearCriterion)
            else []
        ),
        wearing.bars_step(scene, grid, _CONVOLUTIONS, solves),
        plans.figures(grid.cells),
    )


_KERNELS = "not kept on disk: made once for all cycles, in a few per cent of the run's time"
_DEEPER = "no piece that reaches the surface gets past a depth at which nothing yields"
_over, _map = partial(Series, ("cycle",)), partial(grid_map, of="last")


@dataclass(frozen=True, eq=False, kw_only=True)
class WearRecord(pieces.MeanSizes, pieces.ParticleTable, wearing.WornRecord):
    """What a wear loop gives: means over its settled cycles, tables over cycles and particles, the worn surface."""

    scatters: ClassVar[tuple[str, ...]] = (
        *pieces.MeanSizes.scatters,
        *("Sq_initial", "Sq_final", "contact_area_fraction", "mean_contact_pressure", "worn_volume_per_cycle"),
        *("first_cycles_radius", "criterion_wear_rate"),
    )
    particles_per_cycle: Annotated[
        float, Figure("", "particles per cycle of one body, settled", headline=True, no_bar=pieces.FOLLOWS_CELL)
    ]
    Sq_initial: Annotated[float, Figure("nm", "Sq in the contact region (rows in contact), unworn", headline=True)]
    Sq_final: Annotated[float, Figure("nm", "Sq in the contact region (rows in contact), run in", headline=True)]
    worn_depth: Annotated[float, Figure("nm", "mean depth worn in the contact region (rows in contact)")]
    contact_area_fraction: Annotated[float, Figure("", "real contact area over that of the slice", headline=True)]
    mean_contact_pressure: Annotated[float, Figure("Pa", "mean pressure over the real contact area")]
    worn_volume_per_cycle: Annotated[float, Figure("um3", "volume worn per cycle, of all bodies that wear")]
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
        float | None, Figure("mm3_Nm", "volume that the criterion removes by load and distance", headline=True)
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
        float | None, Figure("mm3", "worn volume by Archard's law", optional=True, unjudged=True)
    ] = None
    particle_number: Annotated[
        float | None, Figure("", "number of particles in it", optional=True, no_bar=pieces.FOLLOWS_CELL)
    ] = None
    particles_per_mm_and_N: Annotated[
        float | None, Figure("", "particles per mm and N", optional=True, no_bar=pieces.FOLLOWS_CELL)
    ] = None
    third_body_friction: Annotated[
        float | None, Figure("", "friction of surfaces and rolling particles", optional=True, no_bar=THIRD_BODIES)
    ] = None
    radius: Annotated[FloatArray, _over("m", "volume-mean equivalent radius of the particles")]
    particles: Annotated[FloatArray, _over("1", "particles per cycle of one body")]
    volume: Annotated[FloatArray, _over("m^3", "volume worn per cycle, of all bodies that wear")]
    contact_area: Annotated[FloatArray, _over("m^2", "contact area")]
    plastic_area: Annotated[FloatArray, _over("m^2", "area at the hardness")]
    contact_load: Annotated[FloatArray, _over("N", "load carried by contact")]
    rms_height: Annotated[FloatArray, _over("m", "rms height Sq of the worn surface in the contact region")]
    depths_computed: Annotated[FloatArray, _over("1", "depths at which stress was computed")]
    convolutions: Annotated[FloatArray, _over("1", "convolutions of the contact solve")]
    particle_cycle: Annotated[wearing.IntArray, pieces.particle_rows("1", "cycle in which a particle came off")]
    particle_body: Annotated[wearing.IntArray, pieces.particle_rows("1", "body that it came off: 0 lower, 1 upper")]
    x: Annotated[FloatArray, Series(("x",), "m", "x, along sliding", of="last")]
    y: Annotated[FloatArray, Series(("y",), "m", "y", of="last")]
    height_before: Annotated[FloatArray, _map("m", "height of the wearing surface, unworn")]
    height_after: Annotated[FloatArray, _map("m", "height of the wearing surface, run in")]
    pressure: Annotated[FloatArray, _map("Pa", "contact pressure in the last cycle")]
    removed: Annotated[FloatArray | None, _map("m", "what left the body in the last cycle")]


def run(scene: WearScene, context: Context) -> WearRecord:
    """One wear loop, and where its errors are asked for the same on a coarser grid."""
    initial = build.both_heights(scene, _slice(scene)[0], context)
    found = wear_down(scene, initial, context)
    tell_of_third_bodies(context, found.third_body_load_share)
    made = error_bars(context, scene.cycles.coarser_grid, lambda: bars(scene, initial, found))
    return replace(found, errors={**found.errors, **made.get("errors", {})}, error_parts=made.get("error_parts", {}))


def bars(scene: WearScene, initial: tuple[FloatArray, FloatArray], found: WearRecord) -> ErrorBars:
    """Of the loop on every second cell, with the reported sizes."""
    from bem.accuracy import wear_bars

    there = wearing.on_twice_the_cell(scene, initial, _slice(scene)[0], wear_down, at_resolution)
    reported = {f"{scene.sizes.report}_mean_{size}": f"reported_{size}" for size in pieces.QUANTITIES}
    judged = wear_bars(vars(found), None if there is None else vars(there), reported)
    return wearing.with_least_area(judged, found, scene.cylinder.hardness)


def _slice(scene: WearScene) -> tuple[Grid, float]:
    """The grid of a case and its load [N]."""
    return scene.domain.at(scene.cylinder, build.modulus_of(scene))


def at_resolution(scene: WearScene, factor: float, across: float | None = None) -> WearScene:
    """The scene with so many times the cells and depths, that slides as far in a cycle; `across` : times the cells
    along y, where that is another number."""
    nx, ny = scene.domain.cells
    cells = {"domain.cells": (round(factor * nx), round((factor if across is None else across) * ny))}
    return with_keys(scene, cells | wearing.resolution_keys(scene, factor))


def wear_down(scene: WearScene, initial: tuple[FloatArray, FloatArray], context: Context) -> WearRecord:
    """The wear loop of a scene from these heights [m] on its grid."""
    from bem.particles import volume_mean_radius
    from bem.wear import RunningInState, Settled

    (grid, load), radius = _slice(scene), scene.cylinder.radius

    def watch(now: RunningInState) -> dict[str, float]:
        last = now.particles[now.particles["cycle"] == now.cycle]
        return {
            "radius_nm": 1e9 * volume_mean_radius(last["volume"]),
            "contact_fraction": float(now.cycles[-1]["contact_area"]) / grid.area,
        }

    cylinder = ShapeScene(kind="cylinder", radius=radius) if radius else ShapeScene()
    result = wearing.wear_loop(
        scene,
        context,
        initial,
        watch=watch,
        grid=grid,
        load=load,
        gap=build.shape_of(cylinder, grid),
        friction=scene.cylinder.friction,
        hardness=scene.cylinder.hardness,
        stop=Settled(tolerance=scene.cycles.tolerance) if scene.cycles.stop_when_settled else None,
    )
    return _record(scene, grid, load, initial, result)


def _record(
    scene: WearScene, grid: Grid, share: float, initial: tuple[FloatArray, FloatArray], result: RunningIn
) -> WearRecord:
    """The figures of a wear loop, means over its settled cycles, and its tables."""
    from bem.particles import volume_mean_radius
    from bem.wear.outcome import contact_strip, settled_means, sizes_over_cycles

    assert result.pressure is not None
    strip = contact_strip(result.pressure, result.state.strip)
    worn = wearing.WornSurface.of(scene, initial, result, grid, share, strip)
    cycles, particles, late, (load,) = result.cycles, worn.particles, worn.late, scene.cylinder.loads
    radius, number = sizes_over_cycles(cycles["cycle"], particles)
    between, borne = scene.wear.third_bodies, worn.figures.get("third_body_load_share", 0.0)
    return filled(
        WearRecord,
        worn,
        worn.figures,
        settled_means(cycles[-scene.cycles.settled :], grid.area),
        pieces.mean_sizes(late, scene.sizes),
        scene.archard.figures(load, float(late["volume"].mean())) if scene.archard and late.size else {},
        {name: cycles[name].astype(np.float64) for name in _PER_CYCLE},
        {f"particle_{name}": np.ascontiguousarray(particles[name]) for name in _PER_PARTICLE},
        {f"{part}_seconds": float(result.times[part].sum()) for part in ("contact", "stress", "particles")},
        grid,
        third_body_friction=between and (1 - borne) * scene.cylinder.friction + borne * between.friction,
        first_cycles_radius=volume_mean_radius(particles[particles["cycle"] <= 5]["volume"]),
        cycles=len(cycles),
        cell=float(np.sqrt(grid.cell_area)),
        depths_computed_per_cycle=float(cycles["depths_computed"].mean()),
        radius=radius,
        particles=number,
        removed=result.state.removed,
        errors=pieces.sizes_without_bars(scene, grid),
    )


_PER_CYCLE = ("volume", "contact_area", "plastic_area", "contact_load", "rms_height", "depths_computed", "convolutions")
_PER_PARTICLE = ("cycle", "body", "volume", "length", "width", "thickness", "x", "y")


def summarise(scene: WearScene, axes: Any, records: Any) -> dict[str, Any]:
    """What the means are of."""
    told = {"reported_mean": scene.sizes.report, "smallest_radius_nm": 1e9 * scene.sizes.smallest}
    return told | pieces.particles_of(scene)


def scattering(scene: WearScene) -> tuple[str, ...]:
    """Figures that follow the mesh under the source's criterion, where they converge."""
    return pieces.scattering(WearRecord, scene, _slice(scene)[0])


KIND = Kind.of(
    vars(),
    WearScene,
    WearRecord,
    "wear particles and running-in of a cylinder on a flat in boundary lubrication",
    resolve=partial(build.with_hardness, table="cylinder", needed=False),
    resolutions=(of_loop(first_domain, lambda scene: scene.domain.cells, at_resolution),),
    figures=(
        "particle-radius-over-cycles",
        "wear-volume-over-cycles",
        "contact-pressure-over-cycles",
        "roughness-over-cycles",
        "particle-distribution",
        "radius-over-load",
        "worn-surface",
        "particle-shapes",
        "pressure-map",
        "slip-and-wear",
    ),
)
