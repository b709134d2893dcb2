"""Kind `wear`: wear particles and running-in of a cylinder on a flat in boundary lubrication (thesis, paper C).

One scene runs over its loads and over repetitions with surfaces of their own; sizes are means over the settled cycles.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field, model_validator

from bem.errors import InfeasibleError, InputError
from bem.grid import Grid
from bem.materials import contact_modulus
from bem.scenes import build
from bem.scenes.common import BodyScene, Cells, Force, PositiveLength, PositivePressure, SceneModel, Table, problem
from bem.scenes.context import Context, Outcome, Variable
from bem.scenes.kinds import Kind
from bem.scenes.planner import (
    Plan,
    Step,
    convolution_memory,
    layered_kernel_seconds,
    padded_points,
    stress_kernel_seconds,
)
from bem.scenes.records import pack_record, unpack_record
from bem.scenes.units import Length, Ratio, WearCoefficient

Count = Annotated[int, Field(strict=True, ge=1)]
_CONVOLUTIONS = 15  # of one warm-started contact solve, coarse levels included
_DEPTHS_NEEDED = 8  # before a depth is met at which nothing yields, on average
_DEPTHS_AT_FIRST = 40  # the same in the first cycle, of sharp asperities
_CHECKPOINT_EVERY = 10


class CylinderScene(Table):
    """The contact as a whole: a cylinder along y on a flat, and the loads on its full width; radius 0 is a flat."""

    radius: Annotated[Length, Field(ge=0)] = 0.0
    width: PositiveLength
    loads: Annotated[list[Annotated[Force, Field(gt=0)]], Field(min_length=1, max_length=64)]
    friction: Annotated[Ratio, Field(ge=0, le=2)] = 0.0
    hardness: PositivePressure | None = None


class DomainScene(Table):
    """The slice that is computed: `cells` over a square of `half_widths` Hertz half-widths, or of given `lengths`.

    The half-width is that at each load, as in the thesis, or that at `half_widths_at`, so that cells stay the same over
    loads. Free in x and periodic in y, or periodic in both.
    """

    cells: tuple[Cells, Cells] = (240, 240)
    half_widths: Annotated[Ratio, Field(gt=0, le=100)] | None = None
    half_widths_at: Annotated[Force, Field(gt=0)] | None = None
    lengths: tuple[PositiveLength, PositiveLength] | None = None
    periodic: Literal["y", "both"] = "y"

    @model_validator(mode="before")
    @classmethod
    def _one_for_both(cls, data: Any) -> Any:
        if isinstance(data, dict):
            data = dict(data)
            for key in ("cells", "lengths"):
                if isinstance(data.get(key), int | float | str):
                    data[key] = (data[key], data[key])
        return data

    @model_validator(mode="after")
    def _one_size(self) -> DomainScene:
        if (self.half_widths is None) == (self.lengths is None):
            raise problem("half_widths and lengths", "exactly one of half_widths, lengths")
        if self.half_widths is None and self.half_widths_at is not None:
            raise problem("half_widths_at without half_widths", "half_widths with half_widths_at, or lengths alone")
        return self


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

    criterion: Literal["von_mises", "tresca", "maximum_tension"] = "von_mises"
    stress_range: bool = Field(default=False, strict=True)
    refine: Annotated[int, Field(strict=True, ge=1, le=100)] = 10
    refinement: Literal["monotone_cubic", "linear", "exact"] = "monotone_cubic"
    connectivity: Literal[6, 18, 26] = 6
    removal: Literal["cap", "top_run"] = "cap"
    wears: Literal["softer", "lower", "upper", "both"] = "softer"
    shift: Annotated[int, Field(strict=True, ge=-10_000, le=10_000)] = 3
    within_layer: bool = Field(default=True, strict=True)


class SizesScene(Table):
    """How particle sizes are reported.

    `report` names the mean that stands as `particle_equivalent_radius_nm`; `smallest` is the equivalent radius under
    which particles are left out of the means "above".
    """

    report: Literal["number", "area", "volume", "number_above"] = "volume"
    smallest: Annotated[Length, Field(ge=0)] = 25e-9
    particles_of: Literal["wearing", "lower", "upper"] = "wearing"


class CyclesScene(Table):
    """How long: `count` cycles, or until settled; means are over the last `settled` cycles."""

    count: Count = 200
    settled: Count = 50
    stop_when_settled: bool = Field(default=False, strict=True)
    tolerance: Annotated[Ratio, Field(gt=0, lt=1)] = 0.02

    @model_validator(mode="after")
    def _enough(self) -> CyclesScene:
        if self.settled > self.count:
            raise problem(f"settled {self.settled} is more than count {self.count}", "settled <= count")
        return self


class WearRateScene(Table):
    """Archard's law: the wear volume that the criterion cannot give, and so the number of particles."""

    specific_wear_rate: Annotated[WearCoefficient, Field(gt=0)]
    distance: PositiveLength


class WearVariantScene(Table):
    """A run that differs from the scene in what is given here: mesh, roughness, film, sliding per cycle."""

    name: Annotated[str, Field(min_length=1, max_length=60)]
    cells: Annotated[int, Field(strict=True, ge=2, le=8192)] | None = None
    depths: WearDepthsScene | None = None
    shift: Annotated[int, Field(strict=True, ge=-10_000, le=10_000)] | None = None
    lower_rms_height: PositiveLength | None = None
    upper_rms_height: PositiveLength | None = None
    layer_thickness: PositiveLength | None = None
    connectivity: Literal[6, 18, 26] | None = None
    refinement: Literal["monotone_cubic", "linear", "exact"] | None = None
    criterion: Literal["von_mises", "tresca", "maximum_tension"] | None = None
    removal: Literal["cap", "top_run"] | None = None


class WearScene(SceneModel):
    """A rough cylinder slides on a rough flat; what yields and reaches the surface leaves."""

    kind: Literal["wear"] = "wear"
    lower: BodyScene
    upper: BodyScene
    cylinder: CylinderScene
    domain: DomainScene
    depths: WearDepthsScene
    wear: WearScenePart = WearScenePart()
    cycles: CyclesScene = CyclesScene()
    sizes: SizesScene = SizesScene()
    archard: WearRateScene | None = None
    variants: list[WearVariantScene] = []  # noqa: RUF012
    repetitions: Annotated[int, Field(strict=True, ge=1, le=1000)] = 1

    @model_validator(mode="after")
    def _flat_needs_lengths(self) -> WearScene:
        if self.cylinder.radius == 0 and self.domain.lengths is None:
            raise problem("half_widths for a flat", "domain.lengths where cylinder.radius is 0")
        return self


def variant_of(scene: WearScene, variant: WearVariantScene | None) -> WearScene:
    """The scene with a variant's changes in it.

    Raises
    ------
    InputError : a roughness for a surface that is not generated, a film thickness without a film.
    """
    if variant is None:
        return scene
    update: dict[str, Any] = {}
    if variant.cells is not None:
        update["domain"] = scene.domain.model_copy(update={"cells": (variant.cells, variant.cells)})
    if variant.depths is not None:
        update["depths"] = variant.depths
    parts = {
        key: getattr(variant, key)
        for key in ("shift", "connectivity", "refinement", "criterion", "removal")
        if getattr(variant, key) is not None
    }
    update["wear"] = scene.wear.model_copy(update=parts)
    for name, rms_height in (("lower", variant.lower_rms_height), ("upper", variant.upper_rms_height)):
        if rms_height is not None:
            body = getattr(scene, name)
            if body.surface.kind == "smooth":
                raise InputError(f"variants.{name}_rms_height: the {name} surface is smooth; allowed: a rough one")
            surface = body.surface.model_copy(update={"rms_height": rms_height})
            update[name] = body.model_copy(update={"surface": surface})
    if variant.layer_thickness is not None:
        coated = [name for name in ("lower", "upper") if getattr(scene, name).layer is not None]
        if not coated:
            raise InputError("variants.layer_thickness: neither body is coated; allowed: a scene with a layer")
        for name in coated:
            body = update.get(name, getattr(scene, name))
            layer = body.layer.model_copy(update={"thickness": variant.layer_thickness})
            update[name] = body.model_copy(update={"layer": layer})
    return scene.model_copy(update=update)


def hertz_half_width(scene: WearScene, load: float) -> float:
    """Half-width of the smooth line contact at a load on the full width [m]; Johnson (1985), eq. 4.43."""
    modulus = contact_modulus(scene.lower.build().material, scene.upper.build().material)
    return float(np.sqrt(4 * load / scene.cylinder.width * scene.cylinder.radius / (np.pi * modulus)))


def grid_at(scene: WearScene, load: float) -> Grid:
    """The grid at a load."""
    lengths = scene.domain.lengths
    if lengths is None:
        assert scene.domain.half_widths is not None
        side = scene.domain.half_widths * hertz_half_width(scene, scene.domain.half_widths_at or load)
        lengths = (side, side)
    (nx, ny) = scene.domain.cells
    return Grid(
        scene.domain.cells, (lengths[0] / nx, lengths[1] / ny), periodic=(scene.domain.periodic == "both", True)
    )


def load_on(scene: WearScene, grid: Grid, load: float) -> float:
    """The slice's share of a load on the full width [N]."""
    return load * grid.lengths[1] / scene.cylinder.width


def resolve(scene: WearScene) -> WearScene:
    """Fill in the hardness of the softer surface, where either has one."""
    if scene.cylinder.hardness is not None:
        return scene
    known = [scene.lower.build().surface_material.hardness, scene.upper.build().surface_material.hardness]
    given = [value for value in known if value is not None]
    if not given:
        return scene
    return scene.model_copy(update={"cylinder": scene.cylinder.model_copy(update={"hardness": min(given)})})


def plan(scene: WearScene) -> Plan:
    """What will be computed.

    Raises
    ------
    InfeasibleError : a load beyond hardness times the slice's area. InputError : surfaces that cannot be generated.
    """
    hardness = scene.cylinder.hardness
    for load in scene.cylinder.loads:
        grid = grid_at(scene, load)
        if hardness is not None and load_on(scene, grid, load) > hardness * grid.area:
            raise InfeasibleError(
                f"cylinder.loads: {load:g} N is beyond hardness x area of the domain; allowed: a smaller load, "
                "a larger domain or a higher hardness"
            )
    grid = grid_at(scene, max(scene.cylinder.loads))
    points = padded_points(grid.shape, grid.periodic)
    for variant in (*scene.variants,) or (None,):
        own = variant_of(scene, variant)
        for load in scene.cylinder.loads:
            build.check_surfaces(grid_at(own, load), lower=own.lower.surface, upper=own.upper.surface)
    runs = len(scene.cylinder.loads) * max(1, len(scene.variants)) * scene.repetitions
    cycles = runs * scene.cycles.count
    grids = len(scene.cylinder.loads) * max(1, len(scene.variants))
    depths = min(scene.depths.count, _DEPTHS_NEEDED)
    deepest = min(scene.depths.count, _DEPTHS_AT_FIRST)
    lower, upper = scene.lower.build(), scene.upper.build()
    layered = [name for name, body in (("lower", lower), ("upper", upper)) if body.layer is not None]
    coupled = build.traction_couples(lower, upper, scene.cylinder.friction)
    return Plan(
        (
            Step(
                "surfaces",
                f"{runs} pairs: {len(scene.cylinder.loads)} loads, {max(1, len(scene.variants))} variants, "
                f"{scene.repetitions} repetitions",
                transforms=40.0 * runs,
                points=grid.cells,
                memory=8.0 * grid.cells * 8,
            ),
            Step(
                "layered kernels",
                f"the {' and '.join(layered)} body is coated" if layered else "no body is coated",
                skipped=not layered,
                seconds=grids * len(layered) * layered_kernel_seconds(grid.cells, depths),
                memory=8.0 * points / 4 * 7 * len(layered),
            ),
            Step(
                "tangential kernels in the normal gap",
                "friction between elastically dissimilar bodies"
                if coupled
                else "traction does not move the gap of these bodies",
                skipped=not coupled,
                transforms=4,
                points=points,
                memory=8.0 * points / 4,
            ),
            Step(
                "contact",
                f"{cycles} cycles, each from the last pressure",
                transforms=2.0 * _CONVOLUTIONS * cycles,
                points=points,
                memory=convolution_memory(grid.shape, grid.periodic),
            ),
            Step(
                "stresses",
                "from the surface down to the first depth at which nothing yields",
                transforms=7.0 * depths * cycles,
                points=points,
                seconds=grids * stress_kernel_seconds(grid.cells, deepest),
                memory=8.0 * (points / 4 * 12 * deepest + grid.cells * (deepest + 8)),
            ),
            Step(
                "kernels of an earlier run",
                "not kept on disk: made once for all cycles, in a few per cent of the run's time",
                skipped=True,
            ),
            Step(
                f"deeper stresses, down to {scene.depths.count} depths",
                "no piece that reaches the surface gets past a depth at which nothing yields",
                skipped=True,
            ),
            Step("pieces", "runs of yielded voxels along depth", seconds=0.004 * cycles, memory=8.0 * grid.cells * 8),
            Step("figures and report", "pictures of the results", seconds=4.0, memory=2e8),
        )
    )


def run(scene: WearScene, context: Context) -> Outcome:
    """All loads and repetitions, one wear loop each."""
    from bem.wear import RunningInState, Settled, WearModel, pack_state, run_in, unpack_state
    from bem.wear.running_in import CYCLE_FIELDS, PARTICLE_FIELDS, TIME_FIELDS

    tables = {"cycles": CYCLE_FIELDS, "particles": PARTICLE_FIELDS, "times": TIME_FIELDS}

    stop = Settled(tolerance=scene.cycles.tolerance) if scene.cycles.stop_when_settled else None
    runs = [
        (load, variant, repetition)
        for load in scene.cylinder.loads
        for variant in (*scene.variants,) or (None,)
        for repetition in range(scene.repetitions)
    ]
    saved = context.saved() or {"finished": [], "current": None}
    finished: list[dict[str, Any]] = [unpack_record(record, tables) for record in saved["finished"]]
    current = saved["current"]
    for index, (load, variant, repetition) in enumerate(runs):
        if index < len(finished):
            continue
        own = variant_of(scene, variant)
        grid = grid_at(own, load)
        with context.timer("surfaces"):
            initial = [
                build.heights_of(body.surface, grid, context.seed(name, repetition), context.note)
                for name, body in (("lower", own.lower), ("upper", own.upper))
            ]
        state = None if current is None else unpack_state(current)
        current = None

        def watch(now: RunningInState, index: int = index, area: float = grid.area) -> None:
            if now.cycle % _CHECKPOINT_EVERY == 0 or now.cycle == scene.cycles.count:
                context.save({"finished": [pack_record(r, tables) for r in finished], "current": pack_state(now)})
            row = now.cycles[-1]
            last = now.particles[now.particles["cycle"] == now.cycle]
            context.progress(
                index * scene.cycles.count + now.cycle,
                len(runs) * scene.cycles.count,
                "cycles",
                radius_nm=1e9 * _volume_mean_radius(last["volume"]),
                contact_fraction=float(row["contact_area"]) / area,
            )

        with context.timer("cycles"):
            result = run_in(
                initial[0],
                initial[1],
                grid=grid,
                bodies=(own.lower.build(), own.upper.build()),
                load=load_on(own, grid, load),
                depths=own.depths.build(),
                gap=_cylinder(own, grid),
                friction=scene.cylinder.friction,
                hardness=scene.cylinder.hardness,
                cycles=scene.cycles.count,
                model=WearModel(**own.wear.model_dump()),
                stop=stop,
                state=state,
                callback=watch,
            )
        finished.append(_record(scene, load, variant, repetition, grid, initial, result))
        context.save({"finished": [pack_record(r, tables) for r in finished], "current": None})
    return _outcome(scene, finished)


def _cylinder(scene: WearScene, grid: Grid) -> NDArray[np.float64]:
    if scene.cylinder.radius == 0:
        return np.zeros(grid.shape)
    return np.ascontiguousarray(np.broadcast_to(grid.x[:, None] ** 2 / (2 * scene.cylinder.radius), grid.shape))


def _record(
    scene: WearScene,
    load: float,
    variant: WearVariantScene | None,
    repetition: int,
    grid: Grid,
    initial: list[NDArray[np.float64]],
    result: Any,
) -> dict[str, Any]:
    """What is kept of a finished run: tables and the worn surface, no more."""
    wears_lower = bool((result.lower_heights != initial[0]).any()) or not bool(
        (result.upper_heights != initial[1]).any()
    )
    body = 0 if wears_lower else 1
    pick = {"wearing": body, "lower": 0, "upper": 1}[scene.sizes.particles_of]
    return {
        "load": load,
        "variant": "" if variant is None else variant.name,
        "repetition": repetition,
        "area": grid.area,
        "cell_area": grid.cell_area,
        "x": grid.x,
        "y": grid.y,
        "cycles": result.cycles,
        "particles": result.particles[result.particles["body"] == pick],
        "times": result.times,
        "before": initial[body],
        "after": (result.lower_heights, result.upper_heights)[body][: grid.shape[0]],
        "pressure": result.pressure,
        "removed": result.state.removed,
        "body": "lower" if body == 0 else "upper",
    }


def size_statistics(particles: NDArray[np.void], smallest: float) -> dict[str, dict[str, float]]:
    """Means of radius, length, width and thickness [m] by number, area and volume, and by number above a size."""
    from bem.particles import particle_statistics

    statistics = {weight: particle_statistics(particles, weight=weight) for weight in ("number", "area", "volume")}
    statistics["number_above"] = particle_statistics(particles, smallest_radius=smallest)
    return {
        name: {
            quantity: getattr(each, f"mean_{quantity}")
            for quantity in ("equivalent_radius", "length", "width", "thickness")
        }
        for name, each in statistics.items()
    }


def _volume_mean_radius(volume: NDArray[np.float64]) -> float:
    total = float(volume.sum())
    return float((volume * np.cbrt(3 * volume / (4 * np.pi))).sum() / total) if total > 0 else 0.0


def _outcome(scene: WearScene, finished: list[dict[str, Any]]) -> Outcome:
    each = scene.repetitions
    rows = [_figures(scene, record) for record in finished]
    groups = [rows[start : start + each] for start in range(0, len(rows), each)]  # one per load and variant

    def listed(values: list[Any]) -> Any:
        return values[0] if len(groups) == 1 else values

    summary: dict[str, Any] = {"load_N": listed([group[0]["load"] for group in groups]), "repetitions": each}
    if scene.variants:
        summary["variant"] = listed([group[0]["variant"] for group in groups])
    for key in (key for key in rows[0] if key not in ("load", "variant", "repetition")):
        by_group = [[row[key] for row in group] for group in groups]
        summary[key] = listed([_mean(values) if each > 1 else values[0] for values in by_group])
        if each > 1:
            summary[f"{key}_spread"] = listed([_spread(values) for values in by_group])
            summary[f"{key}_each"] = listed(by_group)
    summary["reported_mean"] = scene.sizes.report
    summary["smallest_radius_nm"] = 1e9 * scene.sizes.smallest
    return Outcome(summary, _variables(scene, finished))


def _mean(values: list[Any]) -> float:
    finite = [float(v) for v in values if v is not None and np.isfinite(v)]
    return float(np.mean(finite)) if finite else float("nan")


def _spread(values: list[Any]) -> float:
    finite = [float(v) for v in values if v is not None and np.isfinite(v)]
    return float(np.std(finite, ddof=1)) if len(finite) > 1 else 0.0


def _figures(scene: WearScene, record: dict[str, Any]) -> dict[str, Any]:
    """The summary's figures of one run."""
    cycles, particles = record["cycles"], record["particles"]
    settled = cycles[-scene.cycles.settled :]
    late = particles[particles["cycle"] > cycles["cycle"][-1] - scene.cycles.settled]
    sizes = size_statistics(late, scene.sizes.smallest)
    figures: dict[str, Any] = {key: record[key] for key in ("load", "variant", "repetition")}
    for quantity in ("equivalent_radius", "length", "width", "thickness"):
        figures[f"particle_{quantity}_nm"] = 1e9 * sizes[scene.sizes.report][quantity]
    for weight, values in sizes.items():
        for quantity, value in values.items():
            figures[f"{weight}_mean_{quantity}_nm"] = 1e9 * value
    contact_area = settled["contact_area"].mean()
    strip = record["pressure"].any(axis=1)
    strip = strip if strip.any() else np.ones_like(strip)
    figures |= {
        "particles_per_cycle": float(late.size / len(settled)),
        "Sq_initial_nm": 1e9 * float(record["before"][strip].std()),
        "Sq_final_nm": 1e9 * float(record["after"][strip].std()),
        "contact_area_fraction": float(contact_area / record["area"]),
        "mean_contact_pressure_Pa": float((settled["contact_load"] / settled["contact_area"]).mean()),
        "worn_volume_per_cycle_um3": 1e18 * float(settled["volume"].mean()),
        "first_cycles_radius_nm": 1e9 * _volume_mean_radius(particles[particles["cycle"] <= 5]["volume"]),
        "cycles": int(cycles["cycle"][-1]),
        "truncated_particles": int(late["truncated"].sum()),
        "cell_nm": 1e9 * float(np.sqrt(record["cell_area"])),
        "contact_seconds": float(record["times"]["contact"].sum()),
        "stress_seconds": float(record["times"]["stress"].sum()),
        "particles_seconds": float(record["times"]["particles"].sum()),
        "depths_computed_per_cycle": float(cycles["depths_computed"].mean()),
        "convolutions_per_cycle": float(cycles["convolutions"].mean()),
    }
    if scene.archard is not None and late.size:
        from bem.particles import archard_volume, particle_coefficient, particle_number

        rate, mean = scene.archard.specific_wear_rate, float(late["volume"].mean())
        volume = archard_volume(rate, record["load"], scene.archard.distance)
        figures["wear_volume_mm3"] = 1e9 * volume
        figures["particle_number"] = particle_number(volume, mean)
        figures["particles_per_mm_and_N"] = 1e-3 * particle_coefficient(rate, mean)
    return figures


def _variables(scene: WearScene, finished: list[dict[str, Any]]) -> dict[str, Variable]:
    """Tables over runs and cycles; surfaces and pressure of the last run (others have grids of their own)."""
    longest = max(len(record["cycles"]) for record in finished)

    def over_cycles(values: list[NDArray[np.float64]]) -> NDArray[np.float64]:
        table = np.full((len(values), longest), np.nan)
        for row, series in zip(table, values, strict=True):
            row[: len(series)] = series
        return table

    radius, number = [], []
    for record in finished:
        series, counts = [], []
        for cycle in record["cycles"]["cycle"]:
            volume = record["particles"]["volume"][record["particles"]["cycle"] == cycle]
            series.append(_volume_mean_radius(volume) or np.nan)
            counts.append(float(volume.size))
        radius.append(np.array(series))
        number.append(np.array(counts))
    last = finished[-1]
    variables = {
        "load": Variable(("run",), np.array([r["load"] for r in finished]), "N", "load on the full width"),
        "variant": Variable(("run",), np.array([r["variant"] for r in finished]), "1", "variant"),
        "repetition": Variable(("run",), np.array([r["repetition"] for r in finished]), "1", "repetition"),
        "cycle": Variable(("cycle",), np.arange(1, longest + 1), "1", "cycle"),
        "radius": Variable(
            ("run", "cycle"), over_cycles(radius), "m", "volume-mean equivalent radius of the particles"
        ),
        "particles": Variable(("run", "cycle"), over_cycles(number), "1", "particles per cycle"),
        "x": Variable(("x",), last["x"], "m", "x, along sliding"),
        "y": Variable(("y",), last["y"], "m", "y"),
        "height_before": Variable(("x", "y"), last["before"], "m", f"height of the {last['body']} surface, unworn"),
        "height_after": Variable(("x", "y"), last["after"], "m", f"height of the {last['body']} surface, run in"),
        "pressure": Variable(("x", "y"), last["pressure"], "Pa", "contact pressure in the last cycle"),
        "removed": Variable(("x", "y"), last["removed"], "m", f"what left the {last['body']} body in the last cycle"),
    }
    for name, unit, text in (
        ("volume", "m^3", "volume worn per cycle"),
        ("contact_area", "m^2", "contact area"),
        ("plastic_area", "m^2", "area at the hardness"),
        ("contact_load", "N", "load carried by contact"),
        ("rms_height", "m", "rms height Sq of the worn surface in the contact strip"),
        ("depths_computed", "1", "depths at which stress was computed"),
        ("convolutions", "1", "convolutions of the contact solve"),
    ):
        variables[name] = Variable(
            ("run", "cycle"), over_cycles([r["cycles"][name].astype(np.float64) for r in finished]), unit, text
        )
    rows = [(index, record["particles"]) for index, record in enumerate(finished)]
    variables["particle_run"] = Variable(
        ("particle",), np.concatenate([np.full(p.size, i) for i, p in rows]), "1", "run that the particle came from"
    )
    for name, unit, text in (
        ("cycle", "1", "cycle in which it came off"),
        ("volume", "m^3", "volume"),
        ("length", "m", "length of the bounding rectangle"),
        ("width", "m", "width of the bounding rectangle"),
        ("thickness", "m", "deepest point"),
        ("x", "m", "x of its centre"),
        ("y", "m", "y of its centre"),
    ):
        values = np.concatenate([p[name] for _, p in rows])
        variables[f"particle_{name}"] = Variable(("particle",), values, unit, f"{text} of a particle")
    return variables


KIND = Kind(
    name="wear",
    title="wear particles and running-in of a cylinder on a flat in boundary lubrication",
    model=WearScene,
    plan=plan,
    run=run,
    resolve=resolve,
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
    ),
    headline=(
        "particle_equivalent_radius_nm",
        "particle_length_nm",
        "particle_width_nm",
        "particle_thickness_nm",
        "particles_per_cycle",
        "Sq_initial_nm",
        "Sq_final_nm",
        "contact_area_fraction",
        "cycles",
    ),
)
