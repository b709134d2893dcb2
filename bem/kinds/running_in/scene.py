"""Kind `running-in`: the wear cycle in mixed lubrication, load shared between film and rough contact (thesis, paper D).

A case is one wear loop: one hardness, one speed, one pair of surfaces. Initial friction is that of the first cycle,
run-in friction the mean of the last ones.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

import numpy as np

from bem.grid import FloatArray
from bem.scenes import build, film_plans, pieces, plans, wearing
from bem.scenes.axes import Axis, changed, over_last, with_keys
from bem.scenes.common import PositivePressure, Repetitions
from bem.scenes.context import Context, error_bars, tell
from bem.scenes.keys import key
from bem.scenes.kind import Kind
from bem.scenes.lubrication import notes_of_balance
from bem.scenes.planner import Plan, Step
from bem.scenes.records import (
    LAMBDA_MIXED,
    LAMBDA_WHOLE,
    MINIMUM_FILM,
    Figure,
    GridRecord,
    Series,
    filled,
    without_bars,
)
from bem.scenes.resolutions import CELLS, of_loop
from bem.scenes.tables.sharing import TEMPERATURES, OneLoadScene, RunningInCycles, WearingSharing
from bem.scenes.tables.wear_model import WearScenePart
from bem.scenes.third_bodies import tell_of_third_bodies

if TYPE_CHECKING:
    from bem.accuracy import ErrorBars
    from bem.wear import RunningIn, RunningInState
    from bem.wear.mixed import MixedCycles

_CONVOLUTIONS = 15  # of the two or three contacts of a cycle: 14 and 15 were counted
_SOLVES = 2.5
_CONTACTS = "two or three contacts each, from the last pressure; none in full film"
_DEPTHS_NEEDED = 6


class RunningInScene(OneLoadScene):
    """A rough cylinder, ball or ellipsoid slides on a rough flat in oil; what yields and reaches the surface leaves."""

    kind: Literal["running-in"] = key("Kind of computation.", "basic", default="running-in")
    depths: wearing.WearDepthsScene = key("Depths at which stresses are computed.", "basic")
    wear: WearScenePart = key(
        "Wear model: detachment criterion or wear law, and how material leaves.", "advanced", default=WearScenePart()
    )
    cycles: RunningInCycles = key("Number of wear cycles.", "basic", default=RunningInCycles())
    sharing: WearingSharing = key("Load sharing between oil film and asperities.", "advanced", default=WearingSharing())
    sizes: pieces.SizesScene = key("Statistics of the wear particle sizes.", "advanced", default=pieces.SizesScene())
    hardnesses: list[PositivePressure] = key(
        "Hardnesses of the lower body, one result for each.", "advanced", default=[], example=["1 GPa", "2 GPa"]
    )
    repetitions: Repetitions = key(
        "Number of runs with other random surfaces, for means and standard deviations.", "advanced", default=1
    )


def resolve(scene: RunningInScene) -> RunningInScene:
    """Fill in the grid and the softer surface's hardness."""
    scene = build.with_grid(scene)
    return scene if scene.hardnesses else build.with_hardness(scene, needed=True)


def axes(scene: RunningInScene) -> tuple[Axis, ...]:
    """Hardnesses, then speeds."""
    given = scene.hardnesses
    caps = tuple(scene.with_hardness(h).contact.hardness for h in given) if given else (scene.contact.hardness,)

    def at(scene: RunningInScene, i: int) -> RunningInScene:
        return changed(scene.with_hardness(given[i]), "hardnesses", []) if given else scene

    return (Axis("hardness", caps, Figure("Pa", "hardness of the softer body"), at), scene.speed_axis())


def plan(scene: RunningInScene) -> Plan:
    """What will be computed for one wear loop.

    Raises
    ------
    InputError : a patch that does not fit, a wearing body without yield stress. InfeasibleError : too much load.
    """
    grid = scene.check()
    # what these lack is said before any work
    wearing.between(scene, grid, scene.contact.on_patch(scene.load, grid.lengths))
    loops = 1 if wearing.film_is_halved(scene) else 2  # a film that cannot be halved takes a second one
    return Plan.of(
        plans.surfaces(grid, scene.lower.surface, scene.upper.surface),
        film_plans.tables(scene.sharing.film_points, "cycles and repetitions"),
        Step("a film for every balance", "films are interpolated in the tables", skipped=True),
        *wearing.cycle_steps(
            scene,
            grid,
            convolutions=_CONVOLUTIONS,
            solves=_SOLVES,
            contacts=_CONTACTS,
            usual=_DEPTHS_NEEDED,
            first=4 * _DEPTHS_NEEDED,
            friction=float(scene.contact.boundary_friction != 0),
        ),
        wearing.bars_step(scene, grid, _CONVOLUTIONS * loops, _SOLVES * loops),
        plans.figures(grid.cells),
    )


_over, _shown, _line = (partial(Series, ("cycle",)), partial(Series, ("x", "y"), of="first"), partial(Series, ("x",)))
_FOLLOWS_CELL = f"{pieces.FOLLOWS_CELL}; in mixed lubrication the mean by volume follows it too"


_heated = partial(Figure, "C", optional=True)


@dataclass(frozen=True, eq=False)
class RunningInRecord(GridRecord, wearing.WornRecord):
    """A lubricated wear loop: friction before and after, particles, histories, the last film and surface."""

    scatters: ClassVar[tuple[str, ...]] = (
        *("friction_initial", "friction_run_in", "friction", "boundary_friction_part", "film_friction_part"),
        *("Sq_initial", "Sq_final", "worn_depth", "contact_load_initial", "contact_load", "film_load"),
        *("lambda_ratio", "lambda_ratio_mixed"),
        *("minimum_film", "contact_area_fraction", "criterion_wear_rate", *TEMPERATURES),
    )
    friction_initial: Annotated[float, Figure("", "friction in the first cycle", headline=True)]
    friction_run_in: Annotated[float, Figure("", "friction, mean of the last cycles", headline=True)]
    particle_equivalent_radius: Annotated[
        float, Figure("nm", "equivalent radius of the particles, settled", headline=True, no_bar=_FOLLOWS_CELL)
    ]
    Sq_initial: Annotated[float, Figure("nm", "Sq in the contact region (Hertz' contact), unworn", headline=True)]
    Sq_final: Annotated[float, Figure("nm", "Sq in the contact region (Hertz' contact), run in", headline=True)]
    contact_load: Annotated[float, Figure("N", "load carried by contact, run in", headline=True)]
    film_load: Annotated[float, Figure("N", "load carried by the film, run in", headline=True)]
    lambda_ratio: Annotated[float, Figure("", f"{LAMBDA_WHOLE}, run in", headline=True)]
    lambda_ratio_mixed: Annotated[float, Figure("", f"{LAMBDA_MIXED}, run in")]
    friction: Annotated[float, Figure("", "friction, mean of the last cycles")]
    boundary_friction_part: Annotated[float, Figure("", "boundary part of the run-in friction")]
    film_friction_part: Annotated[float, Figure("", "film part of the run-in friction")]
    contact_load_initial: Annotated[float, Figure("N", "load carried by contact in the first cycle")]
    minimum_film: Annotated[float, Figure("nm", f"{MINIMUM_FILM}, run in")]
    contact_area_fraction: Annotated[float, Figure("", "real contact area over patch, run in")]
    worn_depth: Annotated[float, Figure("nm", "mean depth worn in the contact region (Hertz' contact)")]
    step_error: Annotated[
        float | None,
        Figure("nm", "what its step leaves open of a depth worn by pressure, last cycle", optional=True, unjudged=True),
    ]
    criterion_wear_rate: Annotated[
        float | None, Figure("mm3_Nm", "volume that the criterion removes by load and distance")
    ]
    particles_per_cycle: Annotated[
        float, Figure("", "particles per cycle of one body, settled", no_bar=pieces.FOLLOWS_CELL)
    ]
    particles_first_cycle: Annotated[
        float, Figure("", "particles of the first cycle, of one body", no_bar=pieces.FOLLOWS_CELL)
    ]
    particles_last_cycles: Annotated[
        float, Figure("", "particles of the last cycles, of one body", no_bar=pieces.FOLLOWS_CELL)
    ]
    film_table_error: Annotated[float, Figure("", "error of the film that is interpolated in the table", unjudged=True)]
    contact_temperature: Annotated[float | None, _heated("surfaces in contact, mean by pressure, run in")]
    flash_temperature: Annotated[float | None, _heated("surfaces in contact, highest, run in")]
    evaluations_per_cycle: Annotated[float, Figure("", "films per cycle", unjudged=True)]
    number_mean_radius: Annotated[float, Figure("nm", "the same, mean by number", no_bar=pieces.FOLLOWS_CELL)]
    volume_mean_radius: Annotated[float, Figure("nm", "the same, mean by volume", no_bar=_FOLLOWS_CELL)]
    scattering_mean_radius: Annotated[
        float, Figure("nm", "the same, z-average of light scattering (sum R^6 / sum R^5)", no_bar=pieces.FEW_LARGEST)
    ]
    friction_over_cycles: Annotated[FloatArray, _over("1", "coefficient of friction")]
    film_load_over_cycles: Annotated[FloatArray, _over("N", "load carried by the film")]
    minimum_film_over_cycles: Annotated[FloatArray, _over("m", MINIMUM_FILM)]
    contact_share: Annotated[FloatArray, _over("1", "share of the load carried by contact")]
    rms_height_over_cycles: Annotated[FloatArray, _over("m", "Sq of the worn surface in the contact region")]
    volume_over_cycles: Annotated[FloatArray, _over("m^3", "volume worn per cycle, of all bodies that wear")]
    particles_over_cycles: Annotated[FloatArray, _over("1", "particles per cycle of one body")]
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


def run(scene: RunningInScene, context: Context) -> RunningInRecord:
    """One wear loop, and where its errors are asked for the same on a coarser grid."""
    initial = build.both_heights(scene, build.grid_of(scene.grid), context)
    found = wear_down(scene, initial, context)
    return replace(found, **error_bars(context, scene.cycles.coarser_grid, lambda: bars(scene, initial, found)))


def bars(scene: RunningInScene, initial: tuple[FloatArray, FloatArray], found: RunningInRecord) -> ErrorBars:
    """Of the loop on every second cell and half the points of the film, columns and layers of full heat, cells of
    lumped heat; where half are too few for a film, of that loop with twice the points besides."""
    from bem.accuracy import running_in_bars
    from bem.accuracy.wear import MIXED_RULES

    def finer(scene: RunningInScene, factor: float, across: float) -> RunningInScene:
        coarser = at_resolution(scene, factor, across)
        return with_keys(coarser, wearing.film_keys(coarser, 2.0))

    loop = partial(wear_down, heat_mesh=0.5) if scene.thermal != "off" else wear_down
    coarser = partial(wearing.on_twice_the_cell, scene, initial, build.grid_of(scene.grid), loop)
    there, finer_film = coarser(at_resolution), None
    if there is not None and not wearing.film_is_halved(scene):
        finer_film = coarser(finer)
        there = None if finer_film is None else there
    known = [name for name in MIXED_RULES if getattr(found, name) is not None]
    # of temperatures the rise
    cool = dict.fromkeys(TEMPERATURES, scene.oil.temperature or 0.0)

    def figures(one: RunningInRecord) -> dict[str, float]:
        return {name: getattr(one, name) - cool.get(name, 0.0) for name in known}

    coarse, finer_points = (None if one is None else figures(one) for one in (there, finer_film))
    bars = running_in_bars(figures(found), coarse, finer_points, full_heat=scene.thermal == "full")
    bars = wearing.with_least_area(bars, found, scene.contact.hardness)
    if found.minimum_film > 0:
        to_ratio = found.lambda_ratio_mixed / found.minimum_film
        bars |= bars.renamed({"minimum_film": "lambda_ratio_mixed"}, lambda error: to_ratio * error)
    return bars if there is None else bars | _of_heights(scene, found)


def _of_heights(scene: RunningInScene, found: RunningInRecord) -> ErrorBars:
    """Of what the unworn heights alone decide: the coarser loop's lie half a cell beside where it has them."""
    from bem.accuracy.bars import GRID, ErrorBars
    from bem.wear.outcome import rms_error

    setup = scene.setup(**scene.sharing.model_dump(exclude={"film_shape"}), heat_mesh=1.0)
    along, across = setup.smooth.half_axes(setup.load)
    # on a body that moves through the contact, the whole length of the track counts
    along = math.inf if wearing.wears_on_a_track(scene) else along
    error = rms_error(found.height_before, setup.grid, (along, across))
    return ErrorBars.together({GRID: {"Sq_initial": error}})


def at_resolution(scene: RunningInScene, factor: float, across: float | None = None) -> RunningInScene:
    """The scene with so many times the cells, depths and points of the film, that slides as far in a cycle; `across` :
    times the cells along y, where that is another number."""
    return with_keys(scene, wearing.grid_keys(scene, factor, across) | wearing.resolution_keys(scene, factor))


def wear_down(
    scene: RunningInScene, initial: tuple[FloatArray, FloatArray], context: Context, *, heat_mesh: float = 1.0
) -> RunningInRecord:
    """The wear loop of a scene from these heights [m] on its grid, with times the columns and layers of full heat."""
    from bem.wear.mixed import MixedContact, MixedCycles, shared_film_table

    sharing, (speeds,), saved = scene.sharing, scene.speeds.build(), context.saved()
    setup = scene.setup(**sharing.model_dump(exclude={"film_shape"}), heat_mesh=heat_mesh)
    frames = [] if saved is None else [np.asarray(frame) for frame in saved["frames"]]
    load = scene.contact.on_patch(setup.load, setup.grid.lengths)
    table = shared_film_table(setup, speeds)
    step = MixedContact(setup, speeds, table=table, film_shape=sharing.film_shape)

    def watch(now: RunningInState) -> dict[str, float]:
        if now.cycle in _frame_cycles(scene.cycles.count) and now.pressure is not None:
            frames.append(now.pressure)
        assert now.sharing is not None
        row = now.sharing[-1]
        return {"friction": float(row["friction"]), "contact_share": float(row["contact_load"]) / setup.load}

    result = wearing.wear_loop(
        scene,
        context,
        initial,
        watch=watch,
        keep=lambda: {"frames": list(frames)},
        grid=setup.grid,
        load=load,
        friction=scene.contact.nominal_friction(
            setup.load, setup.smooth.contact_modulus, speeds, scene.oil.temperature
        ),
        hardness=scene.contact.hardness,
        contact_step=step,
    )
    assert result.state.sharing is not None
    shared = MixedCycles(step, result.state.sharing, result.state.contact)
    with context.timer("films"):
        film_error = step.table.error(float(shared.rows["film_load"][-1]))
    found = _record(scene, initial, result, shared, film_table_error=film_error, pressure_frames=np.array(frames))
    tell_of_third_bodies(context, found.third_body_load_share)
    tell(context, notes_of_balance(shared.notes, shared.film.notes))
    return found


def _frame_cycles(count: int) -> list[int]:
    """Cycles whose pressure is kept for the animation: early ones close together."""
    return sorted({1, count, *(round(v) for v in np.geomspace(1, count, 24))})


def _record(
    scene: RunningInScene, initial: tuple[FloatArray, FloatArray], result: RunningIn, shared: MixedCycles, **own: Any
) -> RunningInRecord:
    """The figures of a wear loop and what is kept of it."""
    from bem.wear.mixed_figures import mixed_figures
    from bem.wear.outcome import hertz_area, sizes_over_cycles

    setup, cycles, rows, averaged = shared.contact.setup, result.cycles, shared.rows, scene.cycles.averaged
    grid, load = setup.grid, scene.contact.on_patch(setup.load, setup.grid.lengths)
    # the same strip before and after, at all speeds
    strip = hertz_area(grid, setup.smooth.half_axes(setup.load))
    worn = wearing.WornSurface.of(scene, initial, result, grid, load, strip)
    figures = mixed_figures(shared, cycles, averaged)
    over: dict[str, Any] = {f"{n}_over_cycles": rows[n].copy() for n in ("friction", "film_load", "minimum_film")}
    over |= {f"{n}_over_cycles": cycles[n].astype(np.float64) for n in ("rms_height", "volume")}
    over["particles_over_cycles"] = sizes_over_cycles(cycles["cycle"], worn.particles)[1]
    return filled(
        RunningInRecord,
        figures,
        worn,
        worn.figures,
        pieces.mean_radii(worn.late, scene.sizes, *_RADII),
        over,
        grid,
        friction_run_in=figures.friction,
        particles_first_cycle=float((worn.particles["cycle"] == 1).sum()),
        particles_last_cycles=float((worn.particles["cycle"] > len(cycles) - averaged).sum()),
        frame=np.array(_frame_cycles(scene.cycles.count)[: len(own["pressure_frames"])]),
        **dict.fromkeys(TEMPERATURES if scene.thermal == "off" else ()),
        **own,
    )


_RADII = ("particle_equivalent_radius", "number_mean_radius", "volume_mean_radius", "scattering_mean_radius")


def summarise(scene: RunningInScene, axes: Sequence[Axis], records: Sequence[RunningInRecord | None]) -> dict[str, Any]:
    """What is the same for all cases, and the hardness of least friction where several were tried."""
    from bem.wear.mixed_figures import least_friction

    summary: dict[str, Any] = {"cycles": scene.cycles.count, "load_N": scene.load, "reported_mean": scene.sizes.report}
    summary |= pieces.particles_of(scene)
    if len(scene.hardnesses) <= 2:
        return summary
    (hardnesses, _, _), friction = over_last(3, axes, [np.nan if r is None else r.friction_run_in for r in records])
    best = least_friction(hardnesses, friction.astype(np.float64))
    inside = best not in (min(scene.hardnesses), max(scene.hardnesses))
    return summary | {"hardness_of_least_friction_Pa": best, "least_friction_inside_range": inside}


def scattering(scene: RunningInScene) -> tuple[str, ...]:
    """Figures of pieces where there are none; that any converge here was shown of no criterion."""
    return () if scene.wear.criterion.needs_strength else tuple(without_bars(RunningInRecord))


def _film_shown(scene: RunningInScene) -> str:
    sharing = scene.sharing
    return f", {sharing.film_points if scene.contact.point_radii is None else sharing.film_cells} film points"


KIND = Kind.of(
    vars(),
    RunningInScene,
    RunningInRecord,
    "running-in in mixed lubrication: wear cycles with the load shared between film and contact",
    always_lists=True,
    resolutions=(of_loop(CELLS.first, lambda scene: build.grid_of(scene.grid).shape, at_resolution, _film_shown),),
    figures=(
        "running-in-stribeck",
        "friction-over-cycles",
        "contact-share-over-cycles",
        "particle-radius-over-speed",
        "friction-over-hardness",
        "worn-surface",
        "pressure-map",
        "running-in-frames",
        "slip-and-wear",
    ),
    headline=("speed_m_s",),
)
