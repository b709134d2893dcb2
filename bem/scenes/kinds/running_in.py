"""Kind `running-in`: the wear cycle in mixed lubrication, load shared between film and rough contact (thesis, paper D).

A case is one wear loop: one hardness, one speed, one pair of surfaces. Initial friction is that of the first cycle,
run-in friction the mean of the last ones.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from bem.errors import InputError
from bem.grid import FloatArray
from bem.scenes import build
from bem.scenes.axes import Axis, changed
from bem.scenes.common import BodyScene, LineGridScene, PositivePressure, SceneModel, Table, problem
from bem.scenes.context import Context
from bem.scenes.kinds import Kind
from bem.scenes.kinds.friction import check_load, check_patch, half_width, load_of
from bem.scenes.lubrication import FilmMeshScene, LubricatedScene, SpeedsScene
from bem.scenes.oil import OilScene
from bem.scenes.planner import Plan, Step
from bem.scenes.records import Figure, Record, Series
from bem.scenes.units import Ratio
from bem.scenes.wearing import (
    Count,
    IntArray,
    SizesScene,
    WearDepthsScene,
    WearScenePart,
    cycle_steps,
    size_statistics,
)

if TYPE_CHECKING:
    from bem.friction.film_table import FilmTable
    from bem.friction.setup import MixedSetup
    from bem.wear import RunningIn
    from bem.wear.mixed import MixedContact

_CONVOLUTIONS = 80  # of the two or three contacts of a cycle
_DEPTHS_NEEDED = 6
_CHECKPOINT_EVERY = 10


class RunningInCycles(Table):
    """How many cycles; run-in friction is the mean of the last `averaged`, particles those of the last `settled`."""

    count: Count = 200
    averaged: Count = 10
    settled: Count = 50

    @model_validator(mode="after")
    def _enough(self) -> RunningInCycles:
        for name in ("averaged", "settled"):
            if getattr(self, name) > self.count:
                raise problem(f"{name} {getattr(self, name)} is more than count {self.count}", f"{name} <= count")
        return self


class RunningInSharing(Table):
    """Accuracy of the load sharing in each cycle.

    `film_points`: nodes of the film's mesh; films are tabulated over the load they carry, once per speed.
    """

    tolerance: Annotated[Ratio, Field(ge=1e-8, le=0.01)] = 5e-4
    contact_tolerance: Annotated[Ratio, Field(gt=0, le=1e-2)] = 1e-4
    film_points: Annotated[int, Field(strict=True, ge=100, le=5000)] = 400


class RunningInScene(SceneModel):
    """A rough cylinder slides on a rough flat in oil; what yields and reaches the surface leaves."""

    kind: Literal["running-in"] = "running-in"
    lower: BodyScene
    upper: BodyScene
    contact: LubricatedScene
    oil: OilScene
    speeds: SpeedsScene
    grid: LineGridScene = LineGridScene()
    depths: WearDepthsScene
    wear: WearScenePart = WearScenePart()
    cycles: RunningInCycles = RunningInCycles()
    sharing: RunningInSharing = RunningInSharing()
    sizes: SizesScene = SizesScene()
    hardnesses: list[PositivePressure] = []  # noqa: RUF012
    repetitions: Annotated[int, Field(strict=True, ge=1, le=1000)] = 1

    @model_validator(mode="after")
    def _one_load(self) -> RunningInScene:
        given = self.contact.loads or self.contact.hertz_pressures or []
        if len(given) != 1:
            raise problem(f"{len(given)} loads", "one load; run the scene again for others")
        return self


def resolve(scene: RunningInScene) -> RunningInScene:
    """Fill in the grid and the softer surface's hardness."""
    grid = build.resolved_grid(scene.grid, scene.lower.surface, scene.upper.surface)
    contact = scene.contact
    if contact.hardness is None and not scene.hardnesses:
        contact = contact.model_copy(
            update={"hardness": build.softer_hardness(scene.lower.build(), scene.upper.build())}
        )
    return scene.model_copy(update={"grid": grid, "contact": contact})


def with_hardness(scene: RunningInScene, hardness: float) -> RunningInScene:
    """The scene with that hardness of the lower body; its yield stress follows it."""
    material = scene.lower.material.model_copy(update={"hardness": hardness, "yield_stress": None})
    upper = scene.upper.build().surface_material.hardness
    scene = changed(scene, "lower.material", material)
    return changed(scene, "contact.hardness", hardness if upper is None else min(hardness, upper))


def axes(scene: RunningInScene) -> tuple[Axis, ...]:
    """Hardnesses, then speeds."""
    given, pairs = scene.hardnesses, scene.speeds.build()
    caps = tuple(with_hardness(scene, h).contact.hardness for h in given) if given else (scene.contact.hardness,)

    def at_hardness(scene: RunningInScene, i: int) -> RunningInScene:
        return changed(with_hardness(scene, given[i]), "hardnesses", []) if given else scene

    def at_speed(scene: RunningInScene, i: int) -> RunningInScene:
        return changed(scene, "speeds", SpeedsScene(values=[pairs[i][0]], cylinder=scene.speeds.cylinder))

    return (
        Axis("hardness", caps, Figure("Pa", "hardness of the softer body"), at_hardness),
        Axis("speed", tuple(pair[0] for pair in pairs), Figure("m_s", "speed of the flat"), at_speed),
    )


def plan(scene: RunningInScene) -> Plan:
    """What will be computed for one wear loop.

    Raises
    ------
    InputError : a patch that does not fit, a wearing body without yield stress. InfeasibleError : too much load.
    """
    grid, load, cycles = build.grid_of(scene.grid), load_of(scene), scene.cycles.count
    check_patch(grid, FilmMeshScene(), half_width(scene, load))
    build.check_surfaces(grid, lower=scene.lower.surface, upper=scene.upper.surface)
    check_load(scene, load)
    strengths = [body.build().surface_material.yield_stress for body in (scene.lower, scene.upper)]
    if all(value is None for value in strengths):
        raise InputError(
            "lower.material: neither body has a yield_stress or a hardness, so nothing can wear; allowed: one of them"
        )
    depths = min(scene.depths.count, _DEPTHS_NEEDED)
    deepest = min(scene.depths.count, 4 * _DEPTHS_NEEDED)  # in the first cycles
    contacts = "two or three contacts each, from the last pressure; none in full film"
    return Plan(
        (
            Step("surfaces", "a pair for each case", transforms=40.0, points=grid.cells),
            Step(
                "film tables",
                "about 20 films for each speed, shared by all cycles and repetitions",
                per="grid",
                seconds=20 * 2e-7 * scene.sharing.film_points**2,
                memory=16.0 * scene.sharing.film_points**2,
            ),
            Step("a film for every balance", "films are interpolated in the tables", skipped=True),
            *cycle_steps(grid, cycles, depths, deepest, _CONVOLUTIONS, contacts),
            Step("figures and report", "pictures of the results", seconds=5.0, memory=2e8, per="run"),
        )
    )


def _over(unit: str, text: str) -> Series:
    return Series(("cycle",), unit, text)


def _shown(unit: str, text: str) -> Series:
    return Series(("x", "y"), unit, text, of="first")


@dataclass(frozen=True, eq=False)
class RunningInRecord(Record):
    """A lubricated wear loop: friction before and after, particles, histories, the last film and surface."""

    friction_initial: Annotated[float, Figure("", "friction in the first cycle")]
    friction_run_in: Annotated[float, Figure("", "friction, mean of the last cycles")]
    friction: Annotated[float, Figure("", "friction, mean of the last cycles")]
    boundary_friction_part: Annotated[float, Figure("", "boundary part of the run-in friction")]
    film_friction_part: Annotated[float, Figure("", "film part of the run-in friction")]
    contact_load: Annotated[float, Figure("N", "load carried by contact, run in")]
    contact_load_initial: Annotated[float, Figure("N", "load carried by contact in the first cycle")]
    film_load: Annotated[float, Figure("N", "load carried by the film, run in")]
    minimum_film: Annotated[float, Figure("nm", "minimum film thickness, run in")]
    lambda_ratio: Annotated[float, Figure("", "film under the whole load over roughness, run in")]
    contact_area_fraction: Annotated[float, Figure("", "real contact area over patch, run in")]
    Sq_initial: Annotated[float, Figure("nm", "Sq in Hertz' strip, unworn")]
    Sq_final: Annotated[float, Figure("nm", "Sq in Hertz' strip, run in")]
    worn_depth: Annotated[float, Figure("nm", "mean depth worn in Hertz' strip")]
    particles_per_cycle: Annotated[float, Figure("", "particles per cycle, settled")]
    particles_first_cycle: Annotated[float, Figure("", "particles of the first cycle")]
    particles_last_cycles: Annotated[float, Figure("", "particles of the last cycles")]
    film_table_error: Annotated[float, Figure("", "error of the film that is interpolated in the table")]
    evaluations_per_cycle: Annotated[float, Figure("", "films per cycle")]
    convolutions_per_cycle: Annotated[float, Figure("", "convolutions of the contact per cycle")]
    particle_equivalent_radius: Annotated[float, Figure("nm", "equivalent radius of the particles, settled")]
    number_mean_radius: Annotated[float, Figure("nm", "the same, mean by number")]
    volume_mean_radius: Annotated[float, Figure("nm", "the same, mean by volume")]
    cycle: Annotated[IntArray, _over("1", "cycle")]
    friction_over_cycles: Annotated[FloatArray, _over("1", "coefficient of friction")]
    film_load_over_cycles: Annotated[FloatArray, _over("N", "load carried by the film")]
    minimum_film_over_cycles: Annotated[FloatArray, _over("m", "minimum film thickness")]
    contact_share: Annotated[FloatArray, _over("1", "share of the load carried by contact")]
    rms_height_over_cycles: Annotated[FloatArray, _over("m", "Sq of the worn surface in the strip in contact")]
    volume_over_cycles: Annotated[FloatArray, _over("m^3", "volume worn per cycle")]
    particles_over_cycles: Annotated[FloatArray, _over("1", "particles per cycle")]
    x: Annotated[FloatArray, Series(("x",), "m", "x, along sliding")]
    y: Annotated[FloatArray, Series(("y",), "m", "y")]
    film_thickness_patch: Annotated[FloatArray, Series(("x",), "m", "film")]
    film_pressure_patch: Annotated[FloatArray, Series(("x",), "Pa", "film pressure")]
    separation: Annotated[FloatArray, Series(("x",), "m", "distance of mean planes")]
    height_before: Annotated[FloatArray, _shown("m", "height of the wearing surface, unworn")]
    height_after: Annotated[FloatArray, _shown("m", "height of the wearing surface, run in")]
    pressure: Annotated[FloatArray, _shown("Pa", "contact pressure in the last cycle")]
    frame: Annotated[IntArray, Series(("frame",), "1", "cycle of the frame", of="first")]
    pressure_frames: Annotated[
        FloatArray, Series(("frame", "x", "y"), "Pa", "contact pressure over the cycles", of="first")
    ]


def run(scene: RunningInScene, context: Context) -> RunningInRecord:
    """One wear loop."""
    from bem.wear import WearModel, pack_state, run_in, unpack_state
    from bem.wear.mixed import MIXED_FIELDS, MixedContact, MixedState
    from bem.wear.running_in import RunningInState, pack_table, unpack_table

    setup, (speeds,) = _setup(scene), scene.speeds.build()
    grid = setup.grid
    with context.timer("surfaces"):
        initial = [
            build.heights_of(body.surface, grid, context.seed(name), context.note)
            for name, body in (("lower", scene.lower), ("upper", scene.upper))
        ]
    saved = context.saved()
    frames = [] if saved is None else [np.asarray(frame) for frame in saved["frames"]]
    step = MixedContact(
        setup,
        speeds,
        table=_shared_table(scene, setup, speeds),
        state=None if saved is None else MixedState(saved["film_load"], saved["slope"]),
        rows=None if saved is None else unpack_table(saved["rows"], MIXED_FIELDS),
    )

    def watch(now: RunningInState) -> None:
        if now.cycle in _frame_cycles(scene.cycles.count) and now.pressure is not None:
            frames.append(now.pressure)
        if now.cycle % _CHECKPOINT_EVERY == 0:
            balance = {"film_load": step.state.film_load, "slope": step.state.slope, "rows": pack_table(step.rows)}
            context.save({"wear": pack_state(now), "frames": list(frames), **balance})
        row = step.rows[-1]
        context.progress(
            now.cycle,
            scene.cycles.count,
            "cycles",
            friction=float(row["friction"]),
            contact_share=float(row["contact_load"]) / setup.load,
        )

    with context.timer("cycles"):
        result = run_in(
            initial[0],
            initial[1],
            grid=grid,
            bodies=(scene.lower.build(), scene.upper.build()),
            load=setup.load * grid.lengths[1] / scene.contact.width,
            depths=scene.depths.build(),
            friction=scene.contact.nominal_friction(
                setup.load, setup.line.contact_modulus, speeds, scene.oil.temperature
            ),
            hardness=scene.contact.hardness,
            cycles=scene.cycles.count,
            model=WearModel(**scene.wear.model_dump()),
            contact_step=step,
            state=None if saved is None else unpack_state(saved["wear"]),
            callback=watch,
        )
    for note in step.notes:
        # the film's model is the same in all cases: said once
        context.note(f"film: {note}" if note in step.film_notes else note)
    with context.timer("films"):
        film_error = step.table.error(float(step.rows["film_load"][-1]))
    return _record(scene, setup, initial, result, step, frames, film_error)


def _setup(scene: RunningInScene) -> MixedSetup:
    from bem.friction.setup import MixedSetup

    return MixedSetup(
        grid=build.grid_of(scene.grid),
        bodies=(scene.lower.build(), scene.upper.build()),
        radius=scene.contact.radius,
        width=scene.contact.width,
        load=load_of(scene),
        lubricant=scene.oil.build(),
        boundary_friction=scene.contact.boundary_friction,
        hardness=scene.contact.hardness,
        film_points=scene.sharing.film_points,
        tolerance=scene.sharing.tolerance,
        contact_tolerance=scene.sharing.contact_tolerance,
    )


_TABLES: dict[str, FilmTable] = {}
"""Films of the last speeds of this process: what is in a table never depends on what was asked of it before."""
_MOST_TABLES = 8


def _shared_table(scene: RunningInScene, setup: MixedSetup, speeds: tuple[float, float]) -> FilmTable:
    """The films of the set-up at these speeds; those of other cases with the same contact and oil, where there are."""
    from bem.wear.mixed import film_table

    line = (setup.radius, setup.width, setup.load, setup.line.contact_modulus, setup.film_points)
    key = repr((scene.oil, line, speeds, setup.grid.shape, setup.grid.spacing))
    if key not in _TABLES:
        while len(_TABLES) >= _MOST_TABLES:
            del _TABLES[next(iter(_TABLES))]
        _TABLES[key] = film_table(setup, speeds)
    return _TABLES[key]


def _frame_cycles(count: int) -> list[int]:
    """Cycles whose pressure is kept for the animation: early ones close together."""
    return sorted({1, count, *(round(v) for v in np.geomspace(1, count, 24))})


def _hertz_strip(x: FloatArray, half_width: float) -> NDArray[np.bool_]:
    """The rows of cells within Hertz' contact; of one narrower than a cell, those next to the axis."""
    nearest = float(np.abs(x).min()) * (1 + 1e-9)  # on either side of it
    return np.abs(x) <= max(half_width, nearest)


def _record(
    scene: RunningInScene,
    setup: MixedSetup,
    initial: list[FloatArray],
    result: RunningIn,
    step: MixedContact,
    frames: list[FloatArray],
    film_error: float,
) -> RunningInRecord:
    """The figures of a wear loop and what is kept of it."""
    grid, body, cycles, rows = setup.grid, result.wearing[0], result.cycles, step.rows
    before, after = initial[body], result.worn_heights()[: grid.shape[0]]
    particles = result.particles[result.particles["body"] == scene.sizes.body(body)]
    last, end = rows[-scene.cycles.averaged :], int(cycles["cycle"][-1])
    late = particles[particles["cycle"] > end - scene.cycles.settled]
    strip = _hertz_strip(grid.x, setup.line.half_width(setup.load))  # the same before and after, at all speeds
    film = step.film if step.film is not None else step.table.under(float(rows["film_load"][-1]))
    separation = step.separation if step.separation is not None else film.thickness[:, 0]
    over: dict[str, Any] = {f"{n}_over_cycles": rows[n].copy() for n in ("friction", "film_load", "minimum_film")}
    for name in ("rms_height", "volume", "particles"):
        over[f"{name}_over_cycles"] = cycles[name].astype(np.float64)
    assert result.pressure is not None
    return RunningInRecord(
        friction_initial=float(rows["friction"][0]),
        friction_run_in=float(last["friction"].mean()),
        friction=float(last["friction"].mean()),
        boundary_friction_part=float(last["boundary_force"].mean()) / setup.load,
        film_friction_part=float(last["film_force"].mean()) / setup.load,
        contact_load=float(last["contact_load"].mean()),
        contact_load_initial=float(rows["contact_load"][0]),
        film_load=float(last["film_load"].mean()),
        minimum_film=float(last["minimum_film"].mean()),
        lambda_ratio=float(last["lambda_ratio"].mean()),
        contact_area_fraction=float(cycles["contact_area"][-scene.cycles.averaged :].mean() / grid.area),
        Sq_initial=float(before[strip].std()),
        Sq_final=float(after[strip].std()),
        worn_depth=float((before - after)[strip].mean()),
        particles_per_cycle=late.size / scene.cycles.settled,
        particles_first_cycle=float((particles["cycle"] == 1).sum()),
        particles_last_cycles=float((particles["cycle"] > end - scene.cycles.averaged).sum()),
        film_table_error=film_error,
        evaluations_per_cycle=float(rows["evaluations"].mean()),
        convolutions_per_cycle=float(cycles["convolutions"].mean()),
        **_radii(scene, late),
        cycle=np.arange(1, len(rows) + 1),
        contact_share=rows["contact_load"] / setup.load,
        **over,
        x=grid.x,
        y=grid.y,
        film_thickness_patch=film.thickness[:, 0],
        film_pressure_patch=film.pressure[:, 0],
        separation=separation,
        height_before=before,
        height_after=after,
        pressure=result.pressure,
        frame=np.array(_frame_cycles(scene.cycles.count)[: len(frames)]),
        pressure_frames=np.array(frames),
    )


def _radii(scene: RunningInScene, particles: NDArray[np.void]) -> dict[str, Any]:
    """Mean equivalent radii [m] of the settled particles, 0 of none."""
    names = ("particle_equivalent_radius", "number_mean_radius", "volume_mean_radius")
    if not particles.size:
        return dict.fromkeys(names, 0.0)
    sizes = size_statistics(particles, scene.sizes.smallest)
    weights = (scene.sizes.report, "number", "volume")
    return {name: sizes[weight]["equivalent_radius"] for name, weight in zip(names, weights, strict=True)}


def summarise(scene: RunningInScene, axes: Sequence[Axis], records: Sequence[RunningInRecord | None]) -> dict[str, Any]:
    """What is the same for all cases, and the hardness of least friction where several were tried."""
    summary: dict[str, Any] = {
        "cycles": scene.cycles.count,
        "load_N": load_of(scene),
        "reported_mean": scene.sizes.report,
    }
    if len(scene.hardnesses) > 2:
        sizes = [len(axis) for axis in axes[-3:]]
        friction = np.array([np.nan if r is None else r.friction_run_in for r in records]).reshape(-1, *sizes)[0]
        caps = axes[-3].values
        best = caps[int(np.nanargmin(friction.mean(axis=2))) // sizes[1]]
        summary["hardness_of_least_friction_Pa"] = best
        summary["least_friction_inside_range"] = best not in (min(scene.hardnesses), max(scene.hardnesses))
    return summary


KIND = Kind(
    name="running-in",
    title="running-in in mixed lubrication: wear cycles with the load shared between film and contact",
    model=RunningInScene,
    axes=axes,
    plan=plan,
    run=run,
    record=RunningInRecord,
    summarise=summarise,
    always_lists=True,
    resolve=resolve,
    figures=(
        "running-in-stribeck",
        "friction-over-cycles",
        "contact-share-over-cycles",
        "particle-radius-over-speed",
        "friction-over-hardness",
        "worn-surface",
        "pressure-map",
        "running-in-frames",
    ),
    headline=(
        "speed_m_s",
        "friction_initial",
        "friction_run_in",
        "particle_equivalent_radius_nm",
        "Sq_initial_nm",
        "Sq_final_nm",
        "contact_load_N",
        "film_load_N",
        "lambda_ratio",
    ),
)
