"""Kind `running-in`: the wear cycle in mixed lubrication, load shared between film and rough contact (thesis, paper D).

One wear loop per hardness, speed and repetition; initial friction is that of the first cycle, run-in friction the mean
of the last ones.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from bem.errors import InputError
from bem.grid import Grid
from bem.scenes import build
from bem.scenes.common import BodyScene, GridScene, PositivePressure, SceneModel, Table, problem
from bem.scenes.context import Context, Outcome, Variable
from bem.scenes.kinds import Kind
from bem.scenes.kinds.friction import check_loads, check_patch, half_width, modulus_of
from bem.scenes.lubrication import LubricatedScene, OilScene, SpeedsScene
from bem.scenes.planner import Plan, Step, convolution_memory, padded_points, stress_kernel_seconds
from bem.scenes.units import Ratio
from bem.scenes.wearing import Count, SizesScene, WearDepthsScene, WearScenePart, size_statistics


def pack_record(record: Any, tables: Any) -> dict[str, Any]:
    """A record with each of its `tables` (name -> fields) as columns."""
    from bem.wear.running_in import pack_table

    return {**record, **{name: pack_table(record[name]) for name in tables}}


def unpack_record(packed: Any, tables: Any) -> dict[str, Any]:
    """The record that `pack_record` was given."""
    from bem.wear.running_in import unpack_table

    return {**packed, **{name: unpack_table(packed[name], fields) for name, fields in tables.items()}}


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
    grid: GridScene = GridScene(periodic=(False, True))
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


def with_hardness(scene: RunningInScene, hardness: float | None) -> RunningInScene:
    """The scene with that hardness of the lower body; its yield stress follows it."""
    if hardness is None:
        return scene
    material = scene.lower.material.model_copy(update={"hardness": hardness, "yield_stress": None})
    lower = scene.lower.model_copy(update={"material": material})
    upper = scene.upper.build().surface_material.hardness
    cap = hardness if upper is None else min(hardness, upper)
    return scene.model_copy(update={"lower": lower, "contact": scene.contact.model_copy(update={"hardness": cap})})


def _hardnesses(scene: RunningInScene) -> list[float | None]:
    return [*scene.hardnesses] or [None]


def plan(scene: RunningInScene) -> Plan:
    """What will be computed.

    Raises
    ------
    InputError : a patch that does not fit, a wearing body without yield stress. InfeasibleError : too much load.
    """
    grid = build.grid_of(scene.grid)
    loads = scene.contact.forces(modulus_of(scene))
    from bem.scenes.lubrication import FilmMeshScene

    check_patch(grid, FilmMeshScene(), [half_width(scene, load) for load in loads])
    build.check_surfaces(grid, lower=scene.lower.surface, upper=scene.upper.surface)
    for hardness in _hardnesses(scene):
        check_loads(with_hardness(scene, hardness), loads)
    strengths = [body.build().surface_material.yield_stress for body in (scene.lower, scene.upper)]
    if all(value is None for value in strengths) and not scene.hardnesses:
        raise InputError(
            "lower.material: neither body has a yield_stress or a hardness, so nothing can wear; allowed: one of them"
        )
    runs = len(scene.speeds.build()) * max(1, len(scene.hardnesses)) * scene.repetitions
    cycles = runs * scene.cycles.count
    points = padded_points(grid.shape, grid.periodic)
    depths = min(scene.depths.count, _DEPTHS_NEEDED)
    deepest = min(scene.depths.count, 4 * _DEPTHS_NEEDED)  # in the first cycles
    films = len(scene.speeds.build()) * 20
    return Plan(
        (
            Step("surfaces", f"{scene.repetitions} pairs", transforms=40.0 * scene.repetitions, points=grid.cells),
            Step(
                "film tables",
                f"about 20 films for each of {len(scene.speeds.build())} speeds, shared by all cycles and repetitions",
                seconds=films * 2e-7 * scene.sharing.film_points**2,
                memory=16.0 * scene.sharing.film_points**2,
            ),
            Step(f"a film for every balance ({3 * cycles})", "films are interpolated in the tables", skipped=True),
            Step(
                "contact",
                f"{cycles} cycles, two or three contacts each, from the last pressure; none in full film",
                transforms=2.0 * _CONVOLUTIONS * cycles,
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
            Step("figures and report", "pictures of the results", seconds=5.0, memory=2e8),
        )
    )


def run(scene: RunningInScene, context: Context) -> Outcome:
    """All hardnesses, speeds and repetitions, one wear loop each."""
    from bem.friction.film_table import FilmTable
    from bem.friction.setup import MixedSetup
    from bem.wear import WearModel, pack_state, run_in, unpack_state
    from bem.wear.mixed import MIXED_FIELDS, MixedContact, MixedState, film_table
    from bem.wear.running_in import CYCLE_FIELDS, PARTICLE_FIELDS, RunningInState, pack_table, unpack_table

    records = {"cycles": CYCLE_FIELDS, "particles": PARTICLE_FIELDS, "rows": MIXED_FIELDS}
    grid = build.grid_of(scene.grid)
    load = scene.contact.forces(modulus_of(scene))[0]
    oil = scene.oil.build()
    runs = [
        (hardness, speeds, repetition)
        for hardness in _hardnesses(scene)
        for speeds in scene.speeds.build()
        for repetition in range(scene.repetitions)
    ]
    saved = context.saved() or {"finished": [], "current": None}
    finished: list[dict[str, Any]] = [unpack_record(record, records) for record in saved["finished"]]
    current = saved["current"]
    tables: dict[tuple[float, float], FilmTable] = {}
    for index, (hardness, speeds, repetition) in enumerate(runs):
        if index < len(finished):
            continue
        own = with_hardness(scene, hardness)
        bodies = (own.lower.build(), own.upper.build())
        with context.timer("surfaces"):
            initial = [
                build.heights_of(body.surface, grid, context.seed(name, repetition), context.note)
                for name, body in (("lower", own.lower), ("upper", own.upper))
            ]
        state, mixed_state, rows = None, None, None
        if current is not None:
            state = unpack_state(current["wear"])
            mixed_state = MixedState(current["film_load"], current["slope"])
            rows = unpack_table(current["rows"], MIXED_FIELDS)
            frames = [np.asarray(frame) for frame in current["frames"]]
        else:
            frames = []
        current = None
        setup = MixedSetup(
            grid=grid,
            bodies=bodies,
            radius=scene.contact.radius,
            width=scene.contact.width,
            load=load,
            lubricant=oil,
            boundary_friction=scene.contact.boundary_friction,
            hardness=own.contact.hardness,
            film_points=scene.sharing.film_points,
            tolerance=scene.sharing.tolerance,
            contact_tolerance=scene.sharing.contact_tolerance,
        )
        if speeds not in tables:
            tables[speeds] = film_table(setup, speeds)
        step = MixedContact(setup, speeds, table=tables[speeds], state=mixed_state, rows=rows)
        shown = index == 0 or len(runs) == 1

        def watch(
            now: RunningInState, index: int = index, step: Any = step, frames: Any = frames, shown: bool = shown
        ) -> None:
            if shown and now.cycle in _frame_cycles(scene.cycles.count):
                frames.append(now.pressure)
            if now.cycle % _CHECKPOINT_EVERY == 0:
                context.save(
                    {
                        "finished": [pack_record(record, records) for record in finished],
                        "current": {
                            "wear": pack_state(now),
                            "film_load": step.state.film_load,
                            "slope": step.state.slope,
                            "rows": pack_table(step.rows),
                            "frames": list(frames),
                        },
                    }
                )
            context.progress(
                index * scene.cycles.count + now.cycle,
                len(runs) * scene.cycles.count,
                "cycles",
                friction=float(step.rows["friction"][-1]),
                contact_share=float(step.rows["contact_load"][-1]) / load,
            )

        with context.timer("cycles"):
            result = run_in(
                initial[0],
                initial[1],
                grid=grid,
                bodies=bodies,
                load=load * grid.lengths[1] / scene.contact.width,
                depths=own.depths.build(),
                friction=scene.contact.boundary_friction,
                hardness=own.contact.hardness,
                cycles=scene.cycles.count,
                model=WearModel(**own.wear.model_dump()),
                contact_step=step,
                state=state,
                callback=watch,
            )
        for note in step.notes:
            # the film's model is the same at all speeds: said once
            context.note(f"film: {note}" if note in step.film_notes else f"speed {speeds[0]:g} m/s: {note}")
        with context.timer("films"):
            film_error = step.table.error(float(step.rows["film_load"][-1]))
        finished.append(_record(scene, own, speeds, repetition, grid, initial, result, step, frames, film_error))
        context.save({"finished": [pack_record(record, records) for record in finished], "current": None})
    return _outcome(scene, grid, finished)


def _frame_cycles(count: int) -> list[int]:
    """Cycles whose pressure is kept for the animation: early ones close together."""
    return sorted({1, count, *(round(v) for v in np.geomspace(1, count, 24))})


def _record(
    scene: RunningInScene,
    own: RunningInScene,
    speeds: tuple[float, float],
    repetition: int,
    grid: Grid,
    initial: list[NDArray[np.float64]],
    result: Any,
    step: Any,
    frames: list[NDArray[np.float64]],
    film_error: float,
) -> dict[str, Any]:
    """What is kept of a finished run: tables and surfaces."""
    final = (result.lower_heights, result.upper_heights)
    body = 1 if (final[1] != initial[1]).any() and not (final[0] != initial[0]).any() else 0
    pick = {"wearing": body, "lower": 0, "upper": 1}[scene.sizes.particles_of]
    film = step.film if step.film is not None else step.table.under(float(step.rows["film_load"][-1]))
    separation = step.separation if step.separation is not None else film.thickness[:, 0]
    return {
        "speed": speeds[0],
        "hardness": own.contact.hardness,
        "repetition": repetition,
        "cycles": result.cycles,
        "particles": result.particles[result.particles["body"] == pick],
        "rows": step.rows,
        "before": initial[body],
        "after": final[body][: grid.shape[0]],
        "pressure": result.pressure,
        "film_thickness": film.thickness[:, 0],
        "film_pressure": film.pressure[:, 0],
        "separation": separation,
        "contact_strip": half_width(scene, scene.contact.forces(modulus_of(scene))[0]),
        "film_error": film_error,
        "frames": np.array(frames) if frames else np.zeros((0, *grid.shape)),
    }


def _figures(scene: RunningInScene, record: dict[str, Any], grid: Grid) -> dict[str, float]:
    """The summary's figures of one run."""
    rows, cycles, particles = record["rows"], record["cycles"], record["particles"]
    load = scene.contact.forces(modulus_of(scene))[0]
    last = rows[-scene.cycles.averaged :]
    late = particles[particles["cycle"] > cycles["cycle"][-1] - scene.cycles.settled]
    strip = np.abs(grid.x) <= record["contact_strip"]  # Hertz' strip: the same before and after, at all speeds
    figures = {
        "friction_initial": float(rows["friction"][0]),
        "friction_run_in": float(last["friction"].mean()),
        "friction": float(last["friction"].mean()),
        "boundary_friction_part": float(last["boundary_force"].mean()) / load,
        "film_friction_part": float(last["film_force"].mean()) / load,
        "contact_load_N": float(last["contact_load"].mean()),
        "contact_load_initial_N": float(rows["contact_load"][0]),
        "film_load_N": float(last["film_load"].mean()),
        "minimum_film_nm": 1e9 * float(last["minimum_film"].mean()),
        "lambda_ratio": float(last["lambda_ratio"].mean()),
        "contact_area_fraction": float(cycles["contact_area"][-scene.cycles.averaged :].mean() / grid.area),
        "Sq_initial_nm": 1e9 * float(record["before"][strip].std()),
        "Sq_final_nm": 1e9 * float(record["after"][strip].std()),
        "worn_depth_nm": 1e9 * float((record["before"] - record["after"])[strip].mean()),
        "particles_per_cycle": late.size / scene.cycles.settled,
        "particles_first_cycle": float((particles["cycle"] == 1).sum()),
        "particles_last_cycles": float((particles["cycle"] > cycles["cycle"][-1] - scene.cycles.averaged).sum()),
        "film_table_error": record["film_error"],
        "evaluations_per_cycle": float(rows["evaluations"].mean()),
        "convolutions_per_cycle": float(cycles["convolutions"].mean()),
    }
    sizes = size_statistics(late, scene.sizes.smallest) if late.size else None
    figures["particle_equivalent_radius_nm"] = (
        1e9 * sizes[scene.sizes.report]["equivalent_radius"] if sizes is not None else 0.0
    )
    for weight in ("number", "volume"):
        figures[f"{weight}_mean_radius_nm"] = 1e9 * sizes[weight]["equivalent_radius"] if sizes is not None else 0.0
    return figures


def _outcome(scene: RunningInScene, grid: Grid, finished: list[dict[str, Any]]) -> Outcome:
    each = scene.repetitions
    figures = [_figures(scene, record, grid) for record in finished]
    groups = [figures[start : start + each] for start in range(0, len(figures), each)]
    heads = finished[::each]
    summary: dict[str, Any] = {
        "speed_m_s": [record["speed"] for record in heads],
        "hardness_Pa": [record["hardness"] for record in heads],
        "repetitions": each,
        "cycles": scene.cycles.count,
        "load_N": scene.contact.forces(modulus_of(scene))[0],
        "reported_mean": scene.sizes.report,
    }
    for key in figures[0]:
        values = [np.array([row[key] for row in group]) for group in groups]
        summary[key] = [float(v.mean()) for v in values]
        if each > 1:
            summary[f"{key}_spread"] = [float(v.std(ddof=1)) for v in values]
    if scene.hardnesses and len(scene.hardnesses) > 2:
        best = int(np.argmin(summary["friction_run_in"]))
        summary["hardness_of_least_friction_Pa"] = summary["hardness_Pa"][best]
        summary["least_friction_inside_range"] = heads[best]["hardness"] not in (
            min(scene.hardnesses),
            max(scene.hardnesses),
        )
    return Outcome(summary, _variables(scene, grid, finished, figures))


def _variables(
    scene: RunningInScene, grid: Grid, finished: list[dict[str, Any]], figures: list[dict[str, float]]
) -> dict[str, Variable]:
    load = scene.contact.forces(modulus_of(scene))[0]
    run = ("run",)
    variables = {
        "run_speed": Variable(run, np.array([r["speed"] for r in finished]), "m/s", "speed of the flat"),
        "hardness": Variable(run, np.array([r["hardness"] for r in finished]), "Pa", "hardness of the softer body"),
        "repetition": Variable(run, np.array([r["repetition"] for r in finished]), "1", "repetition"),
        "cycle": Variable(("cycle",), np.arange(1, scene.cycles.count + 1), "1", "cycle"),
    }
    for key, unit, factor, text in (
        ("friction_initial", "1", 1.0, "friction in the first cycle"),
        ("friction_run_in", "1", 1.0, "friction, mean of the last cycles"),
        ("boundary_friction_part", "1", 1.0, "boundary part of the run-in friction"),
        ("film_friction_part", "1", 1.0, "film part of the run-in friction"),
        ("particle_equivalent_radius_nm", "m", 1e-9, "equivalent radius of the particles, settled"),
        ("particles_per_cycle", "1", 1.0, "particles per cycle, settled"),
    ):
        name = key.removesuffix("_nm")
        variables[name] = Variable(run, factor * np.array([f[key] for f in figures]), unit, text)
    over = ("run", "cycle")
    for name, unit, text in (
        ("friction", "1", "coefficient of friction"),
        ("film_load", "N", "load carried by the film"),
        ("minimum_film", "m", "minimum film thickness"),
    ):
        variables[f"{name}_over_cycles"] = Variable(over, np.array([r["rows"][name] for r in finished]), unit, text)
    share = np.array([r["rows"]["contact_load"] for r in finished]) / load
    variables["contact_share"] = Variable(over, share, "1", "share of the load carried by contact")
    for name, unit, text in (
        ("rms_height", "m", "rms height Sq of the worn surface in the strip in contact"),
        ("volume", "m^3", "volume worn per cycle"),
        ("particles", "1", "particles per cycle"),
    ):
        values = np.array([r["cycles"][name] for r in finished], dtype=np.float64)
        variables[f"{name}_over_cycles"] = Variable(over, values, unit, text)
    along = ("run", "x")
    variables |= {
        "x": Variable(("x",), grid.x, "m", "x, along sliding"),
        "y": Variable(("y",), grid.y, "m", "y"),
        "film_thickness_patch": Variable(along, np.array([r["film_thickness"] for r in finished]), "m", "film"),
        "film_pressure_patch": Variable(along, np.array([r["film_pressure"] for r in finished]), "Pa", "film pressure"),
        "separation": Variable(along, np.array([r["separation"] for r in finished]), "m", "distance of mean planes"),
        "height_before": Variable(("x", "y"), finished[0]["before"], "m", "height of the wearing surface, unworn"),
        "height_after": Variable(("x", "y"), finished[0]["after"], "m", "height of the wearing surface, run in"),
        "pressure": Variable(("x", "y"), finished[0]["pressure"], "Pa", "contact pressure in the last cycle"),
    }
    frames = finished[0]["frames"]
    if len(frames):
        cycles = np.array(_frame_cycles(scene.cycles.count)[: len(frames)])
        variables["frame"] = Variable(("frame",), cycles, "1", "cycle of the frame")
        variables["pressure_frames"] = Variable(("frame", "x", "y"), frames, "Pa", "contact pressure over the cycles")
    return variables


KIND = Kind(
    name="running-in",
    title="running-in in mixed lubrication: wear cycles with the load shared between film and contact",
    model=RunningInScene,
    plan=plan,
    run=run,
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
